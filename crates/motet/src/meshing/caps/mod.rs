//! Closes open rims by caps of triangles, with the same connectivity for every frame of a moving surface.
//!
//! A cap consists of rings of vertices that shrink towards the middle of its rim, each vertex a fixed mean of
//! vertices of the rim: so caps follow a rim that moves or bends. A cap is as flat as its rim. Rims that were
//! cut by hand are not flat; they can be moved onto their planes. Ends can be named by their size, and
//! continued by straight tubes: `extension`.

mod extension;

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::ops::Range;

use serde::Serialize;

use crate::base::{Error, Point, Result, Threads, VertexId, sorted_ids};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, distance, dot, norm, scale, sub, unit};
use crate::mesh::disc::{disc_of_rings, n_rings};
use crate::mesh::{CellKind, Cells, Field, LabelNames, Mesh, Surface, unused_name};
use crate::preflight::{crossings, open_rims};
use extension::{Extension, RimFrame};

/// The caps of a surface, made from one frame and applied to any.
#[derive(Clone, Debug)]
pub struct Caps {
    n_points: usize,
    /// The triangles of the surface, with patches.
    triangles: Vec<[VertexId; 3]>,
    patches: Vec<i32>,
    names: BTreeMap<i32, String>,
    rims: Vec<Rim>,
}

/// How flat a rim, and therefore its cap, is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RimPlane {
    /// The patch of the cap.
    pub patch: String,
    /// The largest distance of a vertex of the rim from the middle of the rim, in the unit of the points.
    pub radius: f64,
    /// The largest distance of a vertex of the rim from the rim's plane: the one through the middle, normal
    /// to the rim's area vector.
    pub deviation: f64,
}

/// One rim and its cap.
#[derive(Clone, Debug)]
struct Rim {
    /// In the direction in which the cap's triangles run around it.
    vertices: Vec<VertexId>,
    /// The number of rings inside it.
    n_rings: usize,
    label: i32,
    extension: Option<Extension>,
}

impl Caps {
    /// Finds the rims of a surface: chains of edges that only one triangle uses. Caps become patches `cap_1`,
    /// `cap_2`, ..., the longest rim first; triangles without a patch become `wall`.
    ///
    /// # Errors
    /// When there is no rim, or open edges do not form closed chains.
    pub fn of(surface: &Mesh) -> Result<Self> {
        let Surface { triangles, patches, patch_names: mut names, .. } = Surface::of(surface);
        let points = &surface.points;
        let mut rims = rims(points, &triangles)?;
        rims.sort_by(|a, b| length(b, points).total_cmp(&length(a, points)).then_with(|| a.cmp(b)));
        let mut patches = patches;
        if patches.contains(&0) {
            let label = 1 + patches.iter().copied().max().unwrap_or(0);
            patches.iter_mut().filter(|p| **p == 0).for_each(|p| *p = label);
            names.insert(label, "wall".to_owned());
        }
        let first = 1 + patches.iter().copied().max().unwrap_or(0);
        let mut made = Vec::new();
        for (label, vertices) in (first..).zip(rims) {
            let name =
                unused_name(&format!("cap_{}", label - first + 1), |name| names.values().any(|n| n == name));
            names.insert(label, name);
            let n_rings = n_rings(points, &vertices);
            made.push(Rim { vertices, n_rings, label, extension: None });
        }
        Ok(Self { n_points: surface.points.len(), triangles, patches, names, rims: made })
    }

    /// The number of rims.
    pub fn len(&self) -> usize {
        self.rims.len()
    }

    /// Whether there are no rims; always false.
    pub fn is_empty(&self) -> bool {
        self.rims.is_empty()
    }

    /// Names the caps by size: `inlet` the one whose middle is nearest to a place or, without one, that with
    /// the largest area; the others `outlet_1`, `outlet_2`, ..., by falling area, or `outlet` if there is
    /// only one. A name that a patch of the surface has gets a number.
    ///
    /// # Errors
    /// When the frame has a different number of points, or a rim encloses no area.
    pub fn name_ends(&mut self, frame: &Mesh, inlet: Option<Point>) -> Result<()> {
        self.check(frame)?;
        let mut ends = Vec::new();
        for (k, rim) in self.rims.iter().enumerate() {
            let (middle, area) = self.area_of(rim, &frame.points)?;
            ends.push((inlet.map_or(0.0, |place| distance(place, middle)), -norm(area), k));
        }
        // Without a place all distances are equal, and the largest end comes first.
        let first = ends.iter().copied().min_by(|a, b| a.partial_cmp(b).unwrap_or(Ordering::Equal));
        let Some((_, _, first)) = first else { return Ok(()) };
        let mut others: Vec<_> = ends.iter().filter(|end| end.2 != first).map(|end| (end.1, end.2)).collect();
        others.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let labels: Vec<i32> = self.rims.iter().map(|rim| rim.label).collect();
        labels.iter().for_each(|label| drop(self.names.remove(label)));
        let mut name = |k: usize, name: &str| {
            let free = unused_name(name, |name| self.names.values().any(|known| known == name));
            self.names.insert(labels[k], free);
        };
        name(first, "inlet");
        for (i, (_, k)) in others.iter().enumerate() {
            name(*k, &if others.len() == 1 { "outlet".to_owned() } else { format!("outlet_{}", i + 1) });
        }
        Ok(())
    }

    /// Continues the vessel beyond an end, or beyond each without an extension of its own, by a straight tube
    /// of a length in the unit of the surface. Its cross-section becomes a circle of the same area, and it
    /// ends flat. Its triangles belong to the patches at the rim.
    ///
    /// # Errors
    /// When no end has this name, the length is not above 0, or too many rows of triangles are needed.
    pub fn extend(&mut self, frame: &Mesh, end: Option<&str>, length: f64) -> Result<()> {
        self.check(frame)?;
        let beside = self.patches_at_rims();
        let is_named =
            |rim: &Rim| end.is_none_or(|end| self.names.get(&rim.label).is_some_and(|name| name == end));
        let chosen: Vec<usize> = (0..self.rims.len()).filter(|&k| is_named(&self.rims[k])).collect();
        if chosen.is_empty() {
            let known = self.rims.iter().filter_map(|rim| self.names.get(&rim.label).cloned());
            return Err(Error::options(format!("the surface has no open end `{}`", end.unwrap_or_default()))
                .remedy(format!("it has {}", known.collect::<Vec<_>>().join(", "))));
        }
        for k in chosen {
            let rim = &mut self.rims[k];
            if end.is_none() && rim.extension.is_some() {
                continue;
            }
            let corners: Vec<Point> = rim.vertices.iter().map(|v| frame.points[v.index()]).collect();
            let n = rim.vertices.len();
            let edge = |i: usize| sorted_ids([rim.vertices[i], rim.vertices[(i + 1) % n]]);
            let patches = (0..n).map(|i| beside.get(&edge(i)).copied().unwrap_or(0)).collect();
            rim.extension = Some(Extension::new(&corners, patches, length)?);
        }
        Ok(())
    }

    /// The patch of the triangle at each edge of a rim.
    fn patches_at_rims(&self) -> BTreeMap<[VertexId; 2], i32> {
        let mut at: BTreeMap<[VertexId; 2], i32> = BTreeMap::new();
        for rim in &self.rims {
            let n = rim.vertices.len();
            at.extend((0..n).map(|i| (sorted_ids([rim.vertices[i], rim.vertices[(i + 1) % n]]), 0)));
        }
        for (&[a, b, c], &patch) in self.triangles.iter().zip(&self.patches) {
            for edge in [[a, b], [b, c], [c, a]] {
                at.entry(sorted_ids(edge)).and_modify(|known| *known = patch);
            }
        }
        at
    }

    /// Returns how flat the rims of a frame are, in the order of the caps.
    ///
    /// # Errors
    /// When the frame has a different number of points, or a rim encloses no area.
    pub fn planes(&self, frame: &Mesh) -> Result<Vec<RimPlane>> {
        self.check(frame)?;
        let plane = |rim: &Rim| Ok(self.plane_of(rim, &frame.points)?.0);
        self.rims.iter().map(plane).collect()
    }

    /// Returns a frame of the surface with the vertices of each rim moved onto the rim's plane, along its
    /// normal, so that its caps will be flat; all else stays to the bit. Also returns how far each rim was
    /// off.
    ///
    /// # Errors
    /// The errors of [`Self::planes`]; also when a triangle at a rim would turn over or lose its area.
    pub fn flatten(&self, frame: &Mesh) -> Result<(Mesh, Vec<RimPlane>)> {
        self.check(frame)?;
        let mut flat = frame.clone();
        let mut planes = Vec::new();
        for rim in &self.rims {
            let (found, middle, normal) = self.plane_of(rim, &frame.points)?;
            for v in &rim.vertices {
                let p = frame.points[v.index()];
                flat.points[v.index()] = sub(p, scale(normal, dot(normal, sub(p, middle))));
            }
            planes.push(found);
        }
        let area = |points: &[Point], t: &[VertexId; 3]| area_vector(t.map(|v| points[v.index()]));
        let is_turned = |t: &&[VertexId; 3]| {
            let [before, after] = [&frame.points, &flat.points].map(|points| area(points, t));
            before != after && dot(before, after) <= 0.0
        };
        match self.triangles.iter().find(is_turned) {
            None => Ok((flat, planes)),
            Some(t) => Err(Error::input("a triangle at the rim would turn over if the rim were flattened")
                .at(format!("point {} at {:?}", t[0], frame.points[t[0].index()]))
                .remedy("cut the vessel across, so that its rim is nearer to a plane; or cap it as it is")),
        }
    }

    fn check(&self, frame: &Mesh) -> Result<()> {
        match frame.points.len() == self.n_points {
            true => Ok(()),
            false => Err(Error::input(format!(
                "has {} points, but the first frame has {}",
                frame.points.len(),
                self.n_points
            ))
            .remedy("frames of one surface have the same points in the same order")),
        }
    }

    /// Returns the plane of a rim: how flat the rim is, its middle, and the unit normal.
    fn plane_of(&self, rim: &Rim, points: &[Point]) -> Result<(RimPlane, Point, Point)> {
        let patch = self.names.get(&rim.label).cloned().unwrap_or_default();
        let corners: Vec<Point> = rim.vertices.iter().map(|v| points[v.index()]).collect();
        let (middle, area) = self.area_of(rim, points)?;
        let normal = unit(area).unwrap_or_default();
        let off = |p: &Point| dot(normal, sub(*p, middle)).abs();
        let plane = RimPlane {
            patch,
            radius: corners.iter().map(|&p| distance(p, middle)).fold(0.0, f64::max),
            deviation: corners.iter().map(off).fold(0.0, f64::max),
        };
        Ok((plane, middle, normal))
    }

    /// Returns the middle of a rim and its area vector, which is not zero.
    fn area_of(&self, rim: &Rim, points: &[Point]) -> Result<(Point, Point)> {
        let corners: Vec<Point> = rim.vertices.iter().map(|v| points[v.index()]).collect();
        let middle = scale(corners.iter().copied().fold([0.0; 3], add), 1.0 / corners.len() as f64);
        let next = corners.iter().cycle().skip(1);
        let area =
            corners.iter().zip(next).fold([0.0; 3], |sum, (&p, &q)| add(sum, area_vector([middle, p, q])));
        match unit(area) {
            Some(_) => Ok((middle, area)),
            None => Err(Error::input("the rim encloses no area, so it has no plane").at(format!(
                "{}, point {}",
                self.names.get(&rim.label).cloned().unwrap_or_default(),
                rim.vertices[0]
            ))),
        }
    }

    /// Returns a frame of the surface, closed. Its own points come first; the numbers of points and triangles
    /// are the same for every frame.
    ///
    /// # Errors
    /// When the frame has a different number of points, or an extension meets the surface.
    pub fn close(&self, frame: &Mesh) -> Result<Mesh> {
        self.check(frame)?;
        let (mut points, mut triangles, mut patches) =
            (frame.points.clone(), self.triangles.clone(), self.patches.clone());
        let mut extended = Vec::new();
        for rim in &self.rims {
            let mut end = rim.vertices.clone();
            if let Some(extension) = &rim.extension {
                let (middle, area) = self.area_of(rim, &frame.points)?;
                let at = RimFrame { middle, normal: unit(area).unwrap_or_default() };
                let rows = extension.build(&mut points, &rim.vertices, at)?;
                let first = triangles.len();
                triangles.extend(rows.triangles);
                patches.extend(rows.patches);
                extended.push((first..triangles.len(), rim));
                end = rows.last;
            }
            triangles.extend(disc_of_rings(&mut points, &end, rim.n_rings));
            patches.resize(triangles.len(), rim.label);
        }
        for (range, rim) in extended {
            self.check_extension(&points, &triangles, range, rim)?;
        }
        let cells = Cells::uniform(CellKind::TRIANGLE, triangles.into_flattened())?;
        Ok(Mesh {
            cell_data: vec![Field::scalars("patch", patches)],
            label_names: LabelNames { patches: self.names.clone(), ..LabelNames::default() },
            ..Mesh::new(points, cells)
        })
    }

    /// # Errors
    /// When a triangle of an extension meets another one of the closed surface.
    fn check_extension(
        &self,
        points: &[Point],
        triangles: &[[VertexId; 3]],
        range: Range<usize>,
        rim: &Rim,
    ) -> Result<()> {
        let met = crossings(points, &triangles[range.clone()], triangles, &Threads::single());
        let is_other = |&[i, j]: &[u32; 2]| range.start + i as usize != j as usize;
        match met.into_iter().find(is_other) {
            None => Ok(()),
            Some([i, _]) => {
                let [a, ..] = triangles[range.start + i as usize];
                let name = self.names.get(&rim.label).cloned().unwrap_or_default();
                Err(Error::input(format!("the extension of `{name}` meets the surface"))
                    .at(format!("{:?}", points[a.index()]))
                    .remedy("give a shorter one, or cut the vessel where there is space beyond"))
            }
        }
    }
}

/// Finds closed chains of open edges, each in the direction in which a cap runs around it.
fn rims(points: &[Point], triangles: &[[VertexId; 3]]) -> Result<Vec<Vec<VertexId>>> {
    let [closed, torn] = open_rims(points, triangles);
    if let Some(v) = torn.first().and_then(|rim| rim.first()) {
        return Err(Error::input(
            "open edges lead nowhere from here: triangles are not consistently oriented",
        )
        .at(format!("point {v}"))
        .remedy("repair the surface first: `motet mesh --repair` reports what is wrong"));
    }
    match closed.is_empty() {
        true => Err(Error::input("has no open rim to cap")),
        false => Ok(closed),
    }
}

fn length(rim: &[VertexId], points: &[Point]) -> f64 {
    let next = rim.iter().cycle().skip(1);
    rim.iter().zip(next).map(|(a, b)| distance(points[a.index()], points[b.index()])).sum()
}

#[cfg(test)]
mod tests;
