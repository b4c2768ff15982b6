//! Parts of a surface cut off, by a plane or a sphere: the ends of vessels.
//!
//! A plane cuts along one line only, the one nearest to a given place, so that the rest of a vessel that
//! bends back through the plane stays. Triangles on the line are divided; arrays are interpolated along
//! their edges.

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;

use super::super::surfaces::Surfaces;
use crate::base::{CellId, Error, MaybeId, Point, Result, Threads, VertexId, sorted_ids};
use crate::geometry::segment;
use crate::geometry::vector::{add, distance, dot, in_range, scale, sub, unit};
use crate::mesh::history::{Changed, History, Ledger, Origins, Rows, Rules};
use crate::mesh::{CellKind, Cells, Mesh, Surface};
use crate::preflight::Role;

/// What is cut off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum Cut {
    /// The part in front of a plane through a place, along the cut nearest to that place; the normal points
    /// into it.
    Plane {
        /// A place on the plane, near the vessel to be cut.
        at: Point,
        /// The direction of the part that is cut off.
        normal: Point,
    },
    /// All that lies inside a sphere.
    Sphere {
        /// The centre of the sphere, in the unit of the mesh.
        centre: Point,
        /// The radius of the sphere, above 0.
        radius: f64,
    },
}

/// What a cut did.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Clipped {
    /// The cut.
    pub cut: Cut,
    /// The triangles of the surface that were removed as a whole.
    pub removed: usize,
    /// The triangles that were divided.
    pub divided: usize,
}

impl Cut {
    /// The cut that numbers denote: `x, y, z, nx, ny, nz` for a plane, `x, y, z, r` for a sphere.
    ///
    /// # Errors
    /// When there are neither 4 nor 6 numbers, or they are no plane and no sphere.
    pub fn of_numbers(numbers: &[f64]) -> Result<Self> {
        let cut = match *numbers {
            [x, y, z, radius] => Self::Sphere { centre: [x, y, z], radius },
            [x, y, z, nx, ny, nz] => Self::Plane { at: [x, y, z], normal: [nx, ny, nz] },
            _ => {
                return Err(Error::options(format!(
                    "a cut has 6 numbers for a plane (place, normal) or 4 for a sphere (centre, radius); got {}",
                    numbers.len()
                )));
            }
        };
        cut.check().map(|()| cut)
    }

    /// # Errors
    /// When a coordinate is not finite, the normal is zero, or the radius is not above 0.
    fn check(&self) -> Result<()> {
        let is_valid = match *self {
            Self::Plane { at, normal } => in_range(at) && in_range(normal) && unit(normal).is_some(),
            Self::Sphere { centre, radius } => in_range(centre) && radius > 0.0 && radius.is_finite(),
        };
        match is_valid {
            true => Ok(()),
            false => Err(Error::options(format!("{self} cannot cut anything"))
                .remedy("give finite numbers, a normal that is not zero, a radius above 0")),
        }
    }

    /// How far a point lies in the part that is cut off; negative outside.
    fn depth(&self, p: Point) -> f64 {
        match *self {
            Self::Plane { at, normal } => dot(sub(p, at), unit(normal).unwrap_or_default()),
            Self::Sphere { centre, radius } => radius - distance(p, centre),
        }
    }

    /// The share of the way from `p`, outside, to `q`, inside, at which an edge meets the cut.
    fn share(&self, p: Point, q: Point) -> f64 {
        let share = match *self {
            Self::Plane { .. } => self.depth(p) / (self.depth(p) - self.depth(q)),
            Self::Sphere { centre, radius } => {
                let (way, from) = (sub(q, p), sub(p, centre));
                let (a, b, c) = (dot(way, way), dot(way, from), dot(from, from) - radius * radius);
                // The first of the two places, of the form that does not cancel: b is negative.
                c / (-b + (b * b - a * c).max(0.0).sqrt())
            }
        };
        if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 }
    }
}

impl fmt::Display for Cut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = |p: Point| p.map(|x| x.to_string()).join(", ");
        match *self {
            Self::Plane { at, normal } => {
                write!(f, "the plane through {} with normal {}", place(at), place(normal))
            }
            Self::Sphere { centre, radius } => {
                write!(f, "the sphere of radius {radius} around {}", place(centre))
            }
        }
    }
}

/// Cuts parts off the surface of a mesh, one cut after the other. The result has triangles only; arrays of
/// points are linear along divided edges, triangles have the values of those that they were a part of.
///
/// # Errors
/// When a cut is invalid, meets nothing, does not separate a part, or would leave nothing.
pub fn clip(mesh: &Mesh, cuts: &[Cut], threads: &Threads) -> Result<Changed<Vec<Clipped>>> {
    let given = Surface::own_or_boundary_of(mesh);
    let surfaces = Surfaces::of(&[(&given, Role::Boundary, "surface")])?;
    let mut sheet = Sheet {
        points: surfaces.points,
        made: Vec::new(),
        n_given: mesh.points.len(),
        triangles: surfaces.triangles,
        cells: given.triangle_to_cell.clone(),
    };
    let mut done = Vec::new();
    for cut in cuts {
        cut.check()?;
        done.push(sheet.cut(cut)?);
    }
    let history = sheet.history(mesh)?;
    let mut new = Mesh {
        label_names: mesh.label_names.clone(),
        ..Mesh::new(sheet.points, Cells::uniform(CellKind::TRIANGLE, sheet.triangles.into_flattened())?)
    };
    history.transfer_on(mesh, &mut new, &Rules::default(), threads)?;
    Ok(Changed { mesh: new, history, report: done })
}

/// A surface that is being cut.
struct Sheet {
    points: Vec<Point>,
    /// The points after the given ones: the ends of the edge of each, and the share of the way to the second.
    made: Vec<([VertexId; 2], f64)>,
    n_given: usize,
    triangles: Vec<[VertexId; 3]>,
    /// The cell of each triangle.
    cells: Vec<CellId>,
}

impl Sheet {
    fn cut(&mut self, cut: &Cut) -> Result<Clipped> {
        let depths: Vec<f64> = self.points.iter().map(|&p| cut.depth(p)).collect();
        let is_in = |v: VertexId| depths[v.index()] > 0.0;
        let is_met = |t: usize| {
            let n = self.triangles[t].iter().filter(|v| is_in(**v)).count();
            n == 1 || n == 2
        };
        let beyond = neighbors_by_edge(&self.triangles);
        let mut is_divided: Vec<bool> = (0..self.triangles.len()).map(is_met).collect();
        if let Cut::Plane { at, .. } = *cut {
            is_divided = self.nearest_line(&is_divided, &beyond, at, is_in);
        }
        if !is_divided.contains(&true) {
            return Err(Error::input("the cut does not meet the surface").at(cut.to_string()));
        }
        let is_removed = self.cut_off(cut, &is_divided, &beyond, is_in)?;
        let divided = is_divided.iter().filter(|divided| **divided).count();
        let removed = is_removed.iter().filter(|removed| **removed).count();
        self.divide(cut, &is_divided, &is_removed, is_in);
        Ok(Clipped { cut: *cut, removed, divided })
    }

    /// Of the triangles that a plane meets, those on the line nearest to a place.
    fn nearest_line(
        &self,
        is_met: &[bool],
        beyond: &BTreeMap<[VertexId; 2], Vec<u32>>,
        at: Point,
        is_in: impl Fn(VertexId) -> bool,
    ) -> Vec<bool> {
        let mut line_of = vec![u32::MAX; is_met.len()];
        let mut nearest = (f64::INFINITY, u32::MAX);
        for seed in (0..is_met.len()).filter(|&t| is_met[t]) {
            if line_of[seed] != u32::MAX {
                continue;
            }
            line_of[seed] = seed as u32;
            let mut todo = vec![seed];
            while let Some(t) = todo.pop() {
                for edge in edges(self.triangles[t]) {
                    let ends = edge.map(|v| self.points[v.index()]);
                    let away = distance_to(ends, at);
                    if is_in(edge[0]) != is_in(edge[1]) && away < nearest.0 {
                        nearest = (away, seed as u32);
                    }
                    let next = beyond[&sorted_ids(edge)].iter().map(|&s| s as usize);
                    for s in next.filter(|&s| is_in(edge[0]) != is_in(edge[1]) && is_met[s]) {
                        if line_of[s] == u32::MAX {
                            line_of[s] = seed as u32;
                            todo.push(s);
                        }
                    }
                }
            }
        }
        line_of.iter().map(|&line| line == nearest.1 && line != u32::MAX).collect()
    }

    /// The whole triangles that are cut off: all that can be reached from the inner parts of divided ones.
    fn cut_off(
        &self,
        cut: &Cut,
        is_divided: &[bool],
        beyond: &BTreeMap<[VertexId; 2], Vec<u32>>,
        is_in: impl Fn(VertexId) -> bool,
    ) -> Result<Vec<bool>> {
        let mut is_removed = vec![false; is_divided.len()];
        let mut todo: Vec<usize> = Vec::new();
        let reach = |edge: [VertexId; 2], is_removed: &mut [bool], todo: &mut Vec<usize>| {
            for &s in &beyond[&sorted_ids(edge)] {
                let s = s as usize;
                if is_divided[s] {
                    // From inside, a divided triangle may be reached at its inner edges only.
                    if !edge.iter().any(|v| is_in(*v)) {
                        return false;
                    }
                } else if !is_removed[s] {
                    is_removed[s] = true;
                    todo.push(s);
                }
            }
            true
        };
        let mut separates = true;
        for t in (0..is_divided.len()).filter(|&t| is_divided[t]) {
            for edge in edges(self.triangles[t]) {
                if edge.iter().all(|v| is_in(*v)) {
                    separates &= reach(edge, &mut is_removed, &mut todo);
                }
            }
        }
        // A part that a sphere contains need not touch its cut.
        if matches!(cut, Cut::Sphere { .. }) {
            let inside = |t: &usize| self.triangles[*t].iter().all(|v| is_in(*v));
            (0..is_divided.len()).filter(inside).for_each(|t| is_removed[t] = true);
            todo.clear();
        }
        while let Some(t) = todo.pop() {
            for edge in edges(self.triangles[t]) {
                separates &= reach(edge, &mut is_removed, &mut todo);
            }
        }
        let kept = (0..is_divided.len()).any(|t| !is_removed[t]);
        match separates && kept {
            true => Ok(is_removed),
            false => Err(Error::input("the cut does not separate a part of the surface from the rest")
                .at(cut.to_string())
                .remedy("cut where the vessel is one tube, with the normal towards the end to be removed")),
        }
    }

    /// Replaces divided triangles by their outer parts, and leaves out those that are removed.
    fn divide(
        &mut self,
        cut: &Cut,
        is_divided: &[bool],
        is_removed: &[bool],
        is_in: impl Fn(VertexId) -> bool,
    ) {
        let (triangles, cells) = (std::mem::take(&mut self.triangles), std::mem::take(&mut self.cells));
        let mut on_edges: BTreeMap<[VertexId; 2], VertexId> = BTreeMap::new();
        for (t, (&triangle, &cell)) in triangles.iter().zip(&cells).enumerate() {
            if is_removed[t] {
                continue;
            }
            if !is_divided[t] {
                self.triangles.push(triangle);
                self.cells.push(cell);
                continue;
            }
            // The outer part as a ring: outer corners, and points on the edges that lead inside.
            let mut ring = Vec::with_capacity(4);
            for [a, b] in edges(triangle) {
                if !is_in(a) {
                    ring.push(a);
                }
                if is_in(a) != is_in(b) {
                    let [out, inside] = if is_in(a) { [b, a] } else { [a, b] };
                    let on = on_edges.entry([out, inside]).or_insert_with(|| {
                        let [p, q] = [out, inside].map(|v| self.points[v.index()]);
                        let share = cut.share(p, q);
                        self.points.push(add(scale(p, 1.0 - share), scale(q, share)));
                        self.made.push(([out, inside], share));
                        VertexId::new(self.points.len() - 1)
                    });
                    ring.push(*on);
                }
            }
            let of = |k: usize| self.points[ring[k].index()];
            // The shorter diagonal of a quad.
            let first = usize::from(ring.len() == 4 && distance(of(1), of(3)) < distance(of(0), of(2)));
            for k in 1..ring.len() - 1 {
                let at = |i: usize| ring[(first + i) % ring.len()];
                self.triangles.push([at(0), at(k), at(k + 1)]);
                self.cells.push(cell);
            }
        }
    }

    /// Where points and triangles come from. Points that are no longer used stay.
    fn history(&self, mesh: &Mesh) -> Result<History> {
        let mut kept: Vec<MaybeId<VertexId>> = (0..self.n_given).map(|v| VertexId::new(v).into()).collect();
        let mut rows = Rows::new();
        // A point on an edge of an earlier cut has the parts of its ends.
        let mut parts_of: Vec<Vec<(VertexId, f64)>> = Vec::new();
        for &(ends, share) in &self.made {
            let mut parts: Vec<(VertexId, f64)> = Vec::new();
            for (end, weight) in [(ends[0], 1.0 - share), (ends[1], share)] {
                match end.index().checked_sub(self.n_given) {
                    None => parts.push((end, weight)),
                    Some(i) => parts.extend(parts_of[i].iter().map(|(v, part)| (*v, part * weight))),
                }
            }
            crate::mesh::history::merge_parts(&mut parts);
            let main =
                parts.iter().copied().fold(parts[0], |best, part| if part.1 > best.1 { part } else { best });
            rows.push(VertexId::new(kept.len()), &parts, main.0);
            kept.push(MaybeId::NONE);
            parts_of.push(parts);
        }
        let mut cells: (Vec<MaybeId<CellId>>, Rows<CellId>) = (Vec::new(), Rows::new());
        for (t, (triangle, &cell)) in self.triangles.iter().zip(&self.cells).enumerate() {
            let is_same = mesh.cells.kind(cell) == CellKind::TRIANGLE
                && triangle.iter().all(|v| v.index() < self.n_given);
            if is_same {
                cells.0.push(cell.into());
            } else {
                cells.1.push(CellId::new(t), &[(cell, 1.0)], cell);
                cells.0.push(MaybeId::NONE);
            }
        }
        Ok(History {
            vertices: Origins::new(self.n_given, kept, rows)?,
            cells: Origins::new(mesh.cells.len(), cells.0, cells.1)?,
            ledger: Ledger::default(),
        })
    }
}

fn distance_to(ends: [Point; 2], p: Point) -> f64 {
    let share = segment::closest(ends, p);
    distance(p, add(scale(ends[0], 1.0 - share), scale(ends[1], share)))
}

fn edges([a, b, c]: [VertexId; 3]) -> [[VertexId; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// The triangles at each edge.
fn neighbors_by_edge(triangles: &[[VertexId; 3]]) -> BTreeMap<[VertexId; 2], Vec<u32>> {
    let mut at: BTreeMap<[VertexId; 2], Vec<u32>> = BTreeMap::new();
    for (t, triangle) in (0u32..).zip(triangles) {
        edges(*triangle).into_iter().for_each(|edge| at.entry(sorted_ids(edge)).or_default().push(t));
    }
    at
}
