//! The faces of volume cells, each with the cells on its sides, as formats of finite volumes list them.

use std::collections::{BTreeMap, HashMap};

use crate::base::{CellId, Error, Point, Result, VertexId, rising_list};
use crate::geometry::vector::is_finite;
use crate::io::select::lost_arrays;
use crate::mesh::adjacency::{FacetUse, Facets};
use crate::mesh::{CellKind, Mesh, cell_volume};

/// Marks the absence of a cell.
pub(super) const NONE: u32 = u32::MAX;

/// The number of each volume cell; [`NONE`] for other cells.
pub(super) fn cell_numbers(mesh: &Mesh, format: &str) -> Result<Vec<u32>> {
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
        0 => Err(Error::input(format!("{format} needs volume cells, but the mesh has none"))
            .remedy("write a surface as .vtp")),
        _ => Ok(numbers),
    }
}

/// A face as a ring that runs counter-clockwise seen from outside its owner.
pub(super) struct Face {
    pub(super) ring: Vec<u32>,
    pub(super) owner: u32,
    /// The cell on the other side, or [`NONE`].
    pub(super) neighbour: u32,
}

/// The faces in file order: inner ones, the owner being the lower cell, then those of each patch.
pub(super) struct Sorted {
    pub(super) inner: Vec<Face>,
    pub(super) outer: BTreeMap<i32, Vec<Face>>,
    /// Number of surface cells that are not on the boundary.
    n_not_boundary: usize,
}

/// Label of unlabelled faces, which sorts after all others.
pub(super) const UNLABELLED: i32 = i32::MAX;

impl Sorted {
    pub(super) fn of(mesh: &Mesh, numbers: &[u32]) -> Result<Self> {
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
    pub(super) fn renumber(&mut self, mesh: &Mesh) -> Result<Vec<Point>> {
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

    /// Adds what is not written of a mesh of which `n_points` points are.
    pub(super) fn report_losses(&self, format: &str, mesh: &Mesh, n_points: usize, lost: &mut Vec<String>) {
        let n_others = mesh.cells.kinds().iter().filter(|kind| kind.dim().is_none_or(|dim| dim < 2)).count();
        let unused = mesh.points.len() - n_points;
        for (n, what) in [
            (self.n_not_boundary, "surface cells are not written: they are not on the boundary"),
            (n_others, "cells are not written: they are neither volume nor surface cells"),
            (unused, "points are not written: they are not corners of volume cells (such as middle nodes)"),
        ] {
            if n > 0 {
                lost.push(format!("{n} {what}"));
            }
        }
        let own = |name: &str| matches!(name, "region" | "patch");
        lost.extend(lost_arrays(format, "point", mesh.point_data.iter()));
        lost.extend(lost_arrays(format, "cell", mesh.cell_data.iter().filter(|field| !own(&field.name))));
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

/// Converts a name to a word of OpenFOAM and of Fluent: no blanks, quotes, slashes or punctuation, and no
/// leading digit.
pub(super) fn word(name: &str, what: &str) -> String {
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
