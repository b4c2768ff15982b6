//! Which tets are bad, and how bad the worst is.

use std::sync::Arc;

use crate::base::{CellId, Point, Threads};
use crate::geometry::quality::{POSITIVE_EAS, eas, eas_of_each};
use crate::geometry::tet;
use crate::mesh::{Mesh, OrientedTets, Qualities, is_inverted};
use crate::motion::Mover;
use crate::ops::defect;

/// The tets of a mesh, oriented.
#[derive(Clone, Debug)]
pub(super) struct Tets(Arc<OrientedTets>);

/// The quality of the tets with the vertices at some positions.
#[derive(Clone, Debug, Default)]
pub(super) struct Shape {
    /// Tets below the limit and their EAS, sorted by cell.
    pub(super) bad: Vec<(CellId, f64)>,
    /// The worst tet, with its EAS and its centroid.
    pub(super) worst: Option<(CellId, f64, Point)>,
    /// How many tets are flat or inverted.
    pub(super) inverted: usize,
    /// The sum of the [defects](defect) of all tets.
    pub(super) defects: f64,
}

/// The number of tets that a thread evaluates at a time.
const CHUNK: usize = 1 << 13;

impl Tets {
    pub(super) fn of(mesh: &Mesh, threads: &Threads) -> Self {
        Self(Arc::new(OrientedTets::of_linear(mesh, threads)))
    }

    /// The tets of the mesh that a mover moves.
    pub(super) fn of_mover(mover: &Mover) -> Self {
        Self(mover.connectivity().tets.clone())
    }

    pub(super) fn len(&self) -> usize {
        self.0.tets.len()
    }

    /// The shape with the tets of boundary layers removed from the bad ones, with the vertices at `points`.
    pub(super) fn without_layers(&self, shape: &Shape, points: &[Point], limit: f64) -> Shape {
        let place = |(cell, _): &(CellId, f64)| self.0.cells.binary_search(cell).ok();
        let judged = self.0.judge(points, shape.bad.iter().filter_map(place).collect(), limit);
        let is_bad = |bad: &(CellId, f64)| place(bad).is_some_and(|i| judged.bad.binary_search(&i).is_ok());
        Shape { bad: shape.bad.iter().copied().filter(is_bad).collect(), ..*shape }
    }

    /// The shape with the vertices at `points`.
    pub(super) fn shape(&self, points: &[Point], limit: f64, threads: &Threads) -> Shape {
        let chunks: Vec<usize> = (0..self.len()).step_by(CHUNK).collect();
        let look = |start: usize| self.look(start..(start + CHUNK).min(self.len()), points, limit);
        let parts = threads.each(chunks, look);
        parts.into_iter().fold(Shape::default(), Shape::and)
    }

    /// The tets of boundary layers among those below a limit, with the vertices at `points`; `low` has all
    /// tets below it.
    pub(super) fn layers(&self, low: &[(CellId, f64)], points: &[Point], limit: f64) -> Vec<CellId> {
        let below = low.iter().filter(|(_, eas)| *eas < limit);
        let place = |(cell, _): &(CellId, f64)| self.0.cells.binary_search(cell).ok();
        let judged = self.0.judge(points, below.filter_map(place).collect(), limit);
        judged.layers.into_iter().map(|tet| self.0.cells[tet]).collect()
    }

    /// How many of `n_points` vertices are inside the volume.
    pub(super) fn n_inside(&self, n_points: usize) -> usize {
        let mut is_inside = vec![false; n_points];
        self.0.tets.as_flattened().iter().for_each(|v| is_inside[v.index()] = true);
        self.0.walls().flatten().for_each(|v| is_inside[v.index()] = false);
        is_inside.into_iter().filter(|is| *is).count()
    }

    /// The quality of all tets with the vertices at `points`.
    pub(super) fn qualities(&self, points: &[Point], threads: &Threads) -> Qualities {
        Qualities::of(points, &self.0.tets, threads)
    }

    /// The EAS of some cells with the vertices at `points`.
    pub(super) fn eas_of(&self, some: &[(CellId, f64)], points: &[Point]) -> Vec<f64> {
        let of = |(cell, _): &(CellId, f64)| {
            let tet = self.0.cells.binary_search(cell).ok().map(|i| self.0.tets[i]);
            tet.map_or(1.0, |tet| eas(tet.map(|v| points[v.index()])))
        };
        some.iter().map(of).collect()
    }

    /// Some cells and the tets within `rings` layers of neighbours around them, sharing a vertex from layer
    /// to layer.
    pub(super) fn around(&self, some: &[(CellId, f64)], rings: usize, n_points: usize) -> Vec<CellId> {
        let mut tets: Vec<usize> =
            some.iter().filter_map(|(cell, _)| self.0.cells.binary_search(cell).ok()).collect();
        let mut is_near = vec![false; n_points];
        for _ in 0..rings {
            tets.iter().flat_map(|&t| self.0.tets[t]).for_each(|v| is_near[v.index()] = true);
            tets = (0..self.0.tets.len())
                .filter(|&t| self.0.tets[t].iter().any(|v| is_near[v.index()]))
                .collect();
        }
        tets.into_iter().map(|t| self.0.cells[t]).collect()
    }

    fn look(&self, range: std::ops::Range<usize>, points: &[Point], limit: f64) -> Shape {
        let corners = &self.0.tets[range.clone()];
        let mut shape = Shape::default();
        for ((i, tet), quality) in range.zip(corners).zip(eas_of_each(points, corners)) {
            shape.defects += defect(quality.max(0.0));
            let is_worst = shape.worst.is_none_or(|(_, worst, _)| quality < worst);
            if !is_worst && quality >= limit.max(POSITIVE_EAS) {
                continue;
            }
            let (cell, place) = (self.0.cells[i], tet.map(|v| points[v.index()]));
            if quality < limit {
                shape.bad.push((cell, quality));
            }
            shape.inverted += usize::from(quality < POSITIVE_EAS && is_inverted(place));
            if is_worst {
                shape.worst = Some((cell, quality, tet::centroid(place)));
            }
        }
        shape
    }
}

impl Shape {
    fn and(mut self, other: Self) -> Self {
        self.bad.extend(other.bad);
        self.inverted += other.inverted;
        self.defects += other.defects;
        self.worst = match (self.worst, other.worst) {
            (Some(a), Some(b)) if b.1 < a.1 => Some(b),
            (a, b) => a.or(b),
        };
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes::sphere_in_box;

    #[test]
    fn the_shape_is_that_of_each_tet() {
        let mut mesh = sphere_in_box(4, 4);
        for (i, p) in mesh.points.iter_mut().enumerate() {
            (0..3).for_each(|k| p[k] += 0.35 * ((7 * i + 3 * k) as f64).sin());
        }
        let tets = Tets::of(&mesh, &Threads::single());
        for limit in [0.0, 0.2, 0.9] {
            let shape = tets.shape(&mesh.points, limit, &Threads::single());
            let all: Vec<(CellId, f64)> = (mesh.cells.tets())
                .map(|(cell, tet)| (cell, eas(tet.map(|v| mesh.points[v.index()]))))
                .collect();
            let bad: Vec<_> = all.iter().copied().filter(|(_, q)| *q < limit).collect();
            assert_eq!(shape.bad, bad);
            assert_eq!(shape.inverted, all.iter().filter(|(_, q)| *q <= 0.0).count());
            let worst = all.iter().copied().reduce(|a, b| if b.1 < a.1 { b } else { a });
            assert_eq!(shape.worst.map(|(cell, quality, _)| (cell, quality)), worst);
            assert!(limit == 0.0 || !bad.is_empty());
        }
    }

    #[test]
    fn tets_that_are_numbered_the_other_way_round_are_not_inverted() {
        let mesh = sphere_in_box(2, 2);
        let mut mirrored = mesh.clone();
        mirrored.points.iter_mut().for_each(|p| p[0] = -p[0]);
        let threads = Threads::single();
        let [a, b] =
            [&mesh, &mirrored].map(|m| Tets::of(m, &threads).shape(&m.points, 0.2, &threads).worst.unwrap());
        assert!(a.1 > 0.0 && (a.1 - b.1).abs() < 1e-12);
    }
}
