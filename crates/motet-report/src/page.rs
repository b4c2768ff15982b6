//! The page: sections, the tables of numbers for the view, style and script, all in one file.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use minijinja::{AutoEscape, Environment, context};
use motet::{Error, Result};
use serde_json::{Value, json};

use crate::Options;
use crate::labels::{self, Label};
use crate::log::Log;
use crate::numbers::megabytes;
use crate::sections::{self, Section};
use crate::shown::{Shown, ShownFrame};
use crate::store::{BlockId, Store};
use crate::words;

const TEMPLATE: &str = include_str!("page.html");
const STYLE: &str = include_str!("style.css");
/// The parts of the script; together they form one function of the page.
const SCRIPT: [&str; 15] = [
    include_str!("script/unpack.js"),
    include_str!("script/colour.js"),
    include_str!("script/geometry.js"),
    include_str!("script/arrows.js"),
    include_str!("script/camera.js"),
    include_str!("script/draw.js"),
    include_str!("script/pointer.js"),
    include_str!("script/histogram.js"),
    include_str!("script/controls.js"),
    include_str!("script/parts.js"),
    include_str!("script/scene.js"),
    include_str!("script/save.js"),
    include_str!("script/link.js"),
    include_str!("script/panel.js"),
    include_str!("script/main.js"),
];

/// An input in the form that the page uses.
pub(crate) enum Part {
    Meshes(Box<Shown>),
    Log(Log),
}

/// Renders the whole page.
pub(crate) fn rendered(
    parts: &[Part],
    options: &Options,
    store: &Store,
    used: &BTreeSet<BlockId>,
) -> Result<String> {
    let sections = sections_of(parts);
    let names: Vec<&str> = sections.iter().map(|section| section.name.as_str()).collect();
    let title = options.title.clone().unwrap_or_else(|| names.join(", "));
    let payload = used.iter().map(|&id| store.get(id).cost()).sum();
    let has_view = parts.iter().any(|part| matches!(part, Part::Meshes(shown) if is_seen(shown)));
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.set_trim_blocks(true);
    environment.set_lstrip_blocks(true);
    let page = environment.render_str(
        TEMPLATE,
        context! {
            title,
            sections,
            has_view,
            version => env!("CARGO_PKG_VERSION"),
            style => STYLE,
            payload => megabytes(payload),
            budget => megabytes(options.budget),
        },
    );
    let page = page.map_err(|e| Error::options(format!("the page cannot be rendered: {e}")))?;
    // Inserted after templating: numbers and script are large and contain no template syntax.
    Ok(page.replace("<!--DATA-->", &data(parts, store, used)).replace(
        "<!--SCRIPT-->",
        &format!("<script>\n(() => {{\n\"use strict\";\n{}\n}})();\n</script>", SCRIPT.join("\n")),
    ))
}

fn is_seen(shown: &Shown) -> bool {
    !shown.frames.is_empty()
}

fn sections_of(parts: &[Part]) -> Vec<Section> {
    let mut view = 0;
    let section = |part: &Part| match part {
        Part::Log(log) => sections::of_log(log),
        Part::Meshes(shown) => {
            view += 1;
            sections::of_meshes(shown, view - 1)
        }
    };
    parts.iter().map(section).collect()
}

/// The data that the script reads: a description as JSON, and each block as base64.
fn data(parts: &[Part], store: &Store, used: &BTreeSet<BlockId>) -> String {
    let new: BTreeMap<BlockId, usize> = used.iter().enumerate().map(|(new, &old)| (old, new)).collect();
    let inputs: Vec<Value> = parts.iter().filter_map(described).collect();
    let blocks: Vec<Value> = used
        .iter()
        .map(|&id| {
            let block = store.get(id);
            json!([block.rows, block.columns, block.planes, block.kind.word()])
        })
        .collect();
    let ids: BTreeMap<String, usize> = new.iter().map(|(old, new)| (old.to_string(), *new)).collect();
    let manifest = json!({ "inputs": inputs, "blocks": blocks, "ids": ids });
    // Escape `<`, which could end the element.
    let mut text = format!(
        "<script type=\"application/json\" id=\"manifest\">{}</script>\n",
        manifest.to_string().replace('<', "\\u003c")
    );
    for (&old, new) in &new {
        let _ = writeln!(
            text,
            "<script type=\"text/plain\" id=\"b{new}\">{}</script>",
            STANDARD.encode(&store.get(old).data)
        );
    }
    text
}

/// The description of an input for the view.
fn described(part: &Part) -> Option<Value> {
    let Part::Meshes(shown) = part else { return None };
    let arrays: Vec<Value> = shown
        .keys
        .iter()
        .zip(&shown.names)
        .map(|(key, names)| {
            let (title, unit) = words::title_and_unit(key);
            json!({
                "name": key.name,
                "title": title,
                "unit": unit,
                "on": key.on,
                "is_label": key.is_label,
                "is_vector": key.is_vector,
                "names": names,
            })
        })
        .collect();
    let is_distinct = |label: &&Label| shown.with_arrays && shown.keys[label.array].is_label;
    let parts: Vec<&Label> = labels::listed(&shown.labels).filter(is_distinct).collect();
    let frame = |shown_frame: &ShownFrame| {
        let facts = &shown.facts[shown_frame.frame];
        let bars = facts.quality.as_ref().map(|q| json!({ "eas": q.eas_bars, "angle": q.angle_bars }));
        json!({
            "frame": shown_frame.frame,
            "time": facts.time,
            "skin": shown_frame.skin,
            "inside": shown_frame.inside,
            "bars": bars,
            "bad": facts.quality.as_ref().map(|q| q.bad),
            "tets": facts.quality.as_ref().map(|q| q.tets),
            "worst": facts.quality.as_ref().map(|q| json!({ "eas": q.eas_min, "at": q.worst_at })),
        })
    };
    let frames: Vec<Value> = shown.frames.iter().map(frame).collect();
    Some(json!({
        "name": shown.name,
        "is_series": shown.is_series,
        "n_frames": shown.facts.len(),
        "arrays": arrays,
        "parts": parts,
        "frames": frames,
    }))
}
