//! The page: sections, the tables of numbers for the view, style and script, all in one file.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use minijinja::{AutoEscape, Environment, context};
use motet::{Error, Result};
use serde_json::{Value, json};

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
const SCRIPT: [&str; 16] = [
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
    include_str!("script/live.js"),
    include_str!("script/main.js"),
];

/// An input in the form that the page uses.
pub(crate) enum Part {
    Meshes(Box<Shown>),
    Log(Log),
}

/// How a page is to be rendered.
#[derive(Clone, Copy, Default)]
pub(crate) struct Look<'a> {
    /// By default the names of the inputs.
    pub(crate) title: Option<&'a str>,
    /// How many bytes meshes may take, if that is limited.
    pub(crate) budget: Option<usize>,
    /// Whether a program keeps the mesh up to date.
    pub(crate) is_live: bool,
}

/// What is on a page: the inputs, and the packed tables that it uses.
pub(crate) struct Page<'a> {
    pub(crate) parts: &'a [Part],
    pub(crate) store: &'a Store,
    pub(crate) used: &'a BTreeSet<BlockId>,
}

impl Page<'_> {
    /// Renders the page.
    pub(crate) fn rendered(&self, Look { title, budget, is_live }: Look<'_>) -> Result<String> {
        let mut sections = sections_of(self.parts);
        if is_live {
            // What would not follow the mesh.
            sections.iter_mut().for_each(Section::clear_texts);
        }
        let names: Vec<&str> = sections.iter().map(|section| section.name.as_str()).collect();
        let title = title.map_or_else(|| names.join(", "), str::to_owned);
        let payload = self.used.iter().map(|&id| self.store.get(id).cost()).sum();
        let has_view = self.parts.iter().any(|part| matches!(part, Part::Meshes(shown) if is_seen(shown)));
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
                is_live,
                version => env!("CARGO_PKG_VERSION"),
                style => STYLE,
                payload => megabytes(payload),
                budget => budget.map(megabytes),
            },
        );
        let page = page.map_err(|e| Error::options(format!("the page cannot be rendered: {e}")))?;
        // Inserted after templating: numbers and script are large and contain no template syntax.
        Ok(page.replace("<!--DATA-->", &self.data()).replace(
            "<!--SCRIPT-->",
            &format!("<script>\n(() => {{\n\"use strict\";\n{}\n}})();\n</script>", SCRIPT.join("\n")),
        ))
    }

    /// The data that the script reads: a description as JSON, and each block as base64.
    fn data(&self) -> String {
        // Escape `<`, which could end the element.
        let mut text = format!(
            "<script type=\"application/json\" id=\"manifest\">{}</script>\n",
            self.manifest().to_string().replace('<', "\\u003c")
        );
        for (new, block) in self.texts().into_iter().enumerate() {
            let _ = writeln!(text, "<script type=\"text/plain\" id=\"b{new}\">{block}</script>");
        }
        text
    }

    /// The description of all inputs and blocks, and as `texts` each block in base64: what replaces the data
    /// of a page that is open.
    pub(crate) fn update(&self) -> Value {
        let mut manifest = self.manifest();
        manifest["texts"] = json!(self.texts());
        manifest
    }

    fn texts(&self) -> Vec<String> {
        self.used.iter().map(|&id| STANDARD.encode(&self.store.get(id).data)).collect()
    }

    /// The description of all inputs and blocks.
    fn manifest(&self) -> Value {
        let inputs: Vec<Value> = self.parts.iter().filter_map(described).collect();
        let block = |&id: &BlockId| {
            let block = self.store.get(id);
            json!([block.rows, block.columns, block.planes, block.kind.word()])
        };
        let blocks: Vec<Value> = self.used.iter().map(block).collect();
        let new = self.used.iter().enumerate();
        let ids: BTreeMap<String, usize> = new.map(|(new, old)| (old.to_string(), new)).collect();
        json!({ "inputs": inputs, "blocks": blocks, "ids": ids })
    }
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
