//! Writes a mesh.

use std::collections::{BTreeMap, HashMap};
use std::io::Write as _;

use crate::base::{CellId, Csr, Error, Point, Result, Threads, VertexId, rising_list};
use crate::geometry::vector::is_finite;
use crate::io::format::{Encoding, WriteOptions, Written};
use crate::io::select::lost_arrays;
use crate::io::text::push_floats;
use crate::mesh::adjacency::{FacetUse, Facets};
use crate::mesh::{CellKind, Mesh, cell_volume, unused_name};

/// The patch of faces without a label.
const DEFAULT: &str = "defaultFaces";

pub(super) fn write(mesh: &Mesh, options: &WriteOptions, _: &Threads) -> Result<Written> {
    let mut lost = Vec::new();
    let numbers = cell_numbers(mesh)?;
    let mut sorted = Sorted::of(mesh, &numbers)?;
    let points = sorted.renumber(mesh)?;
    report_losses(mesh, &sorted, points.len(), &mut lost);
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

/// Marks the absence of a cell.
const NONE: u32 = u32::MAX;

/// The number of each volume cell; [`NONE`] for other cells.
fn cell_numbers(mesh: &Mesh) -> Result<Vec<u32>> {
    let facets = Facets::of(&mesh.cells);
    let mut next = 0;
    let mut number = |(cell, kind, _): (CellId, CellKind, &[VertexId])| {
        if kind.dim() != Some(3) {
            return Ok(NONE);
        }
        if facets.count(cell) == 0 {
            return Err(Error::input(format!("the faces of cells of kind {} are unknown", kind.label()))
                .at(format!("cell {cell}")));
        }
        next += 1;
        Ok(next - 1)
    };
    let numbers = mesh.cells.iter().map(&mut number).collect::<Result<Vec<_>>>()?;
    match next {
        0 => Err(Error::input("a polyMesh needs volume cells, but the mesh has none")
            .remedy("write a surface as .vtp")),
        _ => Ok(numbers),
    }
}

struct Face {
    ring: Vec<u32>,
    owner: u32,
    neighbour: u32,
}

/// The faces in file order: inner ones, then those of each patch.
struct Sorted {
    inner: Vec<Face>,
    outer: BTreeMap<i32, Vec<Face>>,
    /// Number of surface cells that are not on the boundary.
    n_not_boundary: usize,
}

/// Label of unlabelled faces, which sorts after all others.
const UNLABELLED: i32 = i32::MAX;

impl Sorted {
    fn of(mesh: &Mesh, numbers: &[u32]) -> Result<Self> {
        let facets = Facets::of(&mesh.cells);
        let mut labels = surface_labels(mesh);
        let is_inverted = |cell: CellId| cell_volume(&facets, cell, &mesh.points) < 0.0;
        let ring_of = |facet: FacetUse, turned: bool| {
            let ring = facets.corners(facet).map(|v| v.0);
            let mut ring: Vec<u32> = ring.collect();
            if turned {
                ring.reverse();
            }
            // Start at the lowest vertex, independent of the cell kind, so that a mesh read from a file is
            // written identically.
            let first = (0..ring.len()).min_by_key(|&i| ring[i]).unwrap_or(0);
            ring.rotate_left(first);
            ring
        };
        let (mut inner, mut outer) = (Vec::new(), BTreeMap::<i32, Vec<Face>>::new());
        let mut too_many = None;
        facets.for_each_shared(|uses| match *uses {
            [only] => {
                let ring = ring_of(only, is_inverted(only.cell));
                let label =
                    labels.remove(&rising_list(&ring)).filter(|&label| label != 0).unwrap_or(UNLABELLED);
                let owner = numbers[only.cell.index()];
                outer.entry(label).or_default().push(Face { ring, owner, neighbour: NONE });
            }
            [a, b] => {
                let (a, b) = if numbers[a.cell.index()] < numbers[b.cell.index()] { (a, b) } else { (b, a) };
                let ring = ring_of(a, is_inverted(a.cell));
                inner.push(Face { ring, owner: numbers[a.cell.index()], neighbour: numbers[b.cell.index()] });
            }
            _ => too_many = too_many.or(uses.first().copied()),
        });
        if let Some(facet) = too_many {
            return Err(Error::input("more than two cells share a face").at(format!("cell {}", facet.cell)));
        }
        inner.sort_by(|a, b| (a.owner, a.neighbour, &a.ring).cmp(&(b.owner, b.neighbour, &b.ring)));
        outer
            .values_mut()
            .for_each(|faces| faces.sort_by(|a, b| (a.owner, &a.ring).cmp(&(b.owner, &b.ring))));
        Ok(Self { inner, outer, n_not_boundary: labels.len() })
    }

    /// Drops points that no face uses, renumbers the faces, and returns the remaining points.
    fn renumber(&mut self, mesh: &Mesh) -> Result<Vec<Point>> {
        let faces = || self.inner.iter().chain(self.outer.values().flatten());
        let mut new = vec![NONE; mesh.points.len()];
        faces().flat_map(|face| &face.ring).for_each(|&v| new[v as usize] = 0);
        let mut points = Vec::new();
        for (v, new) in new.iter_mut().enumerate().filter(|(_, new)| **new == 0) {
            if !is_finite(mesh.points[v]) {
                return Err(Error::input("a coordinate is not finite").at(format!("point {v}")));
            }
            *new = points.len() as u32;
            points.push(mesh.points[v]);
        }
        let all = self.inner.iter_mut().chain(self.outer.values_mut().flatten());
        all.flat_map(|face| &mut face.ring).for_each(|v| *v = new[*v as usize]);
        Ok(points)
    }
}

/// The patch of each surface cell, keyed by its corners.
fn surface_labels(mesh: &Mesh) -> HashMap<Vec<u32>, i32> {
    let patches = mesh.patches();
    let cells = mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2));
    let of = |(cell, kind, vertices): (CellId, CellKind, &[VertexId])| {
        let corners: Vec<u32> = crate::mesh::corners(kind, vertices).iter().map(|v| v.0).collect();
        (rising_list(&corners), patches.as_ref().map_or(0, |labels| labels.ids[cell.index()]))
    };
    cells.map(of).collect()
}

fn report_losses(mesh: &Mesh, sorted: &Sorted, n_points: usize, lost: &mut Vec<String>) {
    let n_others = mesh.cells.kinds().iter().filter(|kind| kind.dim().is_none_or(|dim| dim < 2)).count();
    let unused = mesh.points.len() - n_points;
    for (n, what) in [
        (sorted.n_not_boundary, "surface cells are not written: they are not on the boundary"),
        (n_others, "cells are not written: they are neither volume nor surface cells"),
        (unused, "points are not written: they are not corners of volume cells (such as middle nodes)"),
    ] {
        if n > 0 {
            lost.push(format!("{n} {what}"));
        }
    }
    let own = |name: &str| matches!(name, "region" | "patch");
    lost.extend(lost_arrays("a polyMesh", "point", mesh.point_data.iter()));
    lost.extend(lost_arrays("a polyMesh", "cell", mesh.cell_data.iter().filter(|field| !own(&field.name))));
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

/// Converts a name to an OpenFOAM word: no blanks, quotes, slashes or punctuation, and no leading digit.
fn word(name: &str, what: &str) -> String {
    let is_bad = |c: char| {
        c.is_whitespace()
            || matches!(c, '"' | '\'' | '/' | ';' | '{' | '}' | '(' | ')' | '[' | ']' | '\\' | '$' | '#')
    };
    let clean: String = name.chars().map(|c| if is_bad(c) { '_' } else { c }).collect();
    match clean.chars().next() {
        None => what.to_owned(),
        Some(first) if first.is_ascii_digit() || first == '-' => format!("{what}_{clean}"),
        Some(_) => clean,
    }
}
