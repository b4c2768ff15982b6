//! Writes a mesh.

use std::io::Write as _;

use crate::base::{Csr, Point, Result, Threads};
use crate::io::format::{Encoding, WriteOptions, Written};
use crate::io::owned_faces::{Face, NONE, Sorted, UNLABELLED, cell_numbers, word};
use crate::io::text::push_floats;
use crate::mesh::{Mesh, unused_name};

const FORMAT: &str = "a polyMesh";

/// The patch of faces without a label.
const DEFAULT: &str = "defaultFaces";

pub(super) fn write(mesh: &Mesh, options: &WriteOptions, _: &Threads) -> Result<Written> {
    let mut lost = Vec::new();
    let numbers = cell_numbers(mesh, FORMAT)?;
    let mut sorted = Sorted::of(mesh, &numbers)?;
    let points = sorted.renumber(mesh)?;
    sorted.report_losses(FORMAT, mesh, points.len(), &mut lost);
    let n_cells = numbers.iter().filter(|&&n| n != NONE).count();
    let out = Out { is_text: options.encoding == Encoding::Ascii };
    let inner = sorted.inner.len();
    let outer = sorted.outer.values().flatten();
    let faces: Vec<&Face> = sorted.inner.iter().chain(outer).collect();
    let note =
        format!("nPoints:{} nCells:{n_cells} nFaces:{} nInternalFaces:{inner}", points.len(), faces.len());
    let owner: Vec<u32> = faces.iter().map(|face| face.owner).collect();
    let neighbour: Vec<u32> = sorted.inner.iter().map(|face| face.neighbour).collect();
    let mut files = vec![
        ("points".to_owned(), out.points(&points)),
        ("faces".to_owned(), out.faces(&faces)),
        ("owner".to_owned(), out.label_file("owner", &note, &owner)),
        ("neighbour".to_owned(), out.label_file("neighbour", &note, &neighbour)),
        ("boundary".to_owned(), out.boundary(mesh, &sorted)),
    ];
    files.extend(out.zones(mesh, &numbers).map(|zones| ("cellZones".to_owned(), zones)));
    Ok(Written { files, lost })
}

/// How numbers are stored.
struct Out {
    is_text: bool,
}

impl Out {
    fn header(&self, class: &str, object: &str, note: &str) -> Vec<u8> {
        let format = if self.is_text { "ascii" } else { "binary" };
        let note = if note.is_empty() { String::new() } else { format!("    note \"{note}\";\n") };
        format!(
            "FoamFile\n{{\n    version 2.0;\n    format {format};\n    arch \"LSB;label=32;scalar=64\";\n    class {class};\n{note}    \
             location \"constant/polyMesh\";\n    object {object};\n}}\n\n"
        )
        .into_bytes()
    }

    fn labels(&self, out: &mut Vec<u8>, labels: &[u32]) {
        line(out, format_args!("{}", labels.len()));
        out.push(b'(');
        if self.is_text {
            out.push(b'\n');
            labels.iter().for_each(|label| line(out, format_args!("{label}")));
        } else {
            labels.iter().for_each(|label| out.extend_from_slice(&label.to_le_bytes()));
        }
        out.extend_from_slice(b")\n");
    }

    fn label_file(&self, object: &str, note: &str, labels: &[u32]) -> Vec<u8> {
        let mut out = self.header("labelList", object, note);
        self.labels(&mut out, labels);
        out
    }

    fn points(&self, points: &[Point]) -> Vec<u8> {
        let mut out = self.header("vectorField", "points", "");
        line(&mut out, format_args!("{}", points.len()));
        out.push(b'(');
        if self.is_text {
            out.push(b'\n');
            for point in points {
                out.push(b'(');
                push_floats(&mut out, point);
                out.extend_from_slice(b")\n");
            }
        } else {
            points.as_flattened().iter().for_each(|x| out.extend_from_slice(&x.to_le_bytes()));
        }
        out.extend_from_slice(b")\n");
        out
    }

    fn faces(&self, faces: &[&Face]) -> Vec<u8> {
        if !self.is_text {
            let mut rings = Csr::<u32>::default();
            faces.iter().for_each(|face| rings.push(face.ring.iter().copied()));
            let mut out = self.header("faceCompactList", "faces", "");
            self.labels(&mut out, rings.offsets());
            self.labels(&mut out, rings.items());
            return out;
        }
        let mut out = self.header("faceList", "faces", "");
        line(&mut out, format_args!("{}\n(", faces.len()));
        for face in faces {
            let ring: Vec<String> = face.ring.iter().map(u32::to_string).collect();
            line(&mut out, format_args!("{}({})", ring.len(), ring.join(" ")));
        }
        out.extend_from_slice(b")\n");
        out
    }

    fn boundary(&self, mesh: &Mesh, sorted: &Sorted) -> Vec<u8> {
        let labels = mesh.patches();
        let mut out = self.header("polyBoundaryMesh", "boundary", "");
        line(&mut out, format_args!("{}\n(", sorted.outer.len()));
        let (mut start, mut taken) = (sorted.inner.len(), Vec::new());
        for (&label, faces) in &sorted.outer {
            let name = match &labels {
                Some(labels) if label != UNLABELLED => word(&labels.name(label), "patch"),
                _ => DEFAULT.to_owned(),
            };
            let name = unused_name(&name, |name| taken.iter().any(|t| t == name));
            let kind = if name.to_lowercase().starts_with("wall") { "wall" } else { "patch" };
            line(
                &mut out,
                format_args!(
                    "    {name}\n    {{\n        type {kind};\n        nFaces {};\n        startFace {start};\n    }}",
                    faces.len()
                ),
            );
            start += faces.len();
            taken.push(name);
        }
        out.extend_from_slice(b")\n");
        out
    }

    /// A zone for each region; `None` if there are no regions.
    fn zones(&self, mesh: &Mesh, numbers: &[u32]) -> Option<Vec<u8>> {
        let regions = mesh.regions()?;
        let used: Vec<i32> = regions.used();
        if used.is_empty() {
            return None;
        }
        let mut out = self.header("regIOobject", "cellZones", "");
        line(&mut out, format_args!("{}\n(", used.len()));
        let mut taken = Vec::new();
        for label in used {
            let name =
                unused_name(&word(&regions.name(label), "region"), |name| taken.iter().any(|t| t == name));
            let of_region = regions.ids.iter().zip(numbers).filter(|&(&id, &n)| id == label && n != NONE);
            let cells: Vec<u32> = of_region.map(|(_, &n)| n).collect();
            line(&mut out, format_args!("{name}\n{{\n    type cellZone;\ncellLabels List<label>"));
            self.labels(&mut out, &cells);
            line(&mut out, format_args!(";\n}}"));
            taken.push(name);
        }
        out.extend_from_slice(b")\n");
        Some(out)
    }
}

fn line(out: &mut Vec<u8>, text: std::fmt::Arguments<'_>) {
    writeln!(out, "{text}").expect("writing into memory does not fail");
}
