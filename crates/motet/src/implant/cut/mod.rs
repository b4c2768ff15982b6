//! Two surfaces divided where they meet, so that the line where they do is made of edges of both.
//!
//! | step | file | how |
//! |---|---|---|
//! | pairs | `common` | points that two triangles have in common, by what they are: a vertex, two edges, an edge and a triangle |
//! | points | `points` | each once, whatever pair has found it; put on edges and in triangles |
//! | pieces | `plane` | each triangle with its points and segments |
//!
//! Neither surface crosses itself, so no point is where three triangles cross that have no vertex or edge in common, and each is found on an edge of one of the surfaces.
//! What is nearer than a share of the extent counts as one place ([`NEAR`]): coordinates that were meant to be equal as a rule are not. What comes of
//! it is looked at again with exact signs.

mod common;
mod plane;
mod points;

use std::collections::BTreeSet;

use crate::base::{Error, Point, Result, Threads, VertexId, rising};
use crate::geometry::vector::distance;
use crate::mesh::bounds;
use crate::preflight::{crossings, renamed};
use crate::spatial::BoxTree;
use crate::spatial::runs::{around, corners, in_runs};
use common::{Common, On, Side};
use points::Points;

/// What is nearer than this part of the largest extent is one place.
const NEAR: f64 = 1e-11;

/// Two surfaces over one list of points, divided.
#[derive(Clone, Debug, Default)]
pub(super) struct Cut {
    /// The points as they were given, then those that came.
    pub(super) points: Vec<Point>,
    /// The pieces of each surface, turned as it is, and the triangle that each is or is a part of; in the order of those.
    pub(super) pieces: [Vec<([VertexId; 3], u32)>; 2],
    /// The vertex that each given point is now.
    pub(super) names: Vec<VertexId>,
}

impl Cut {
    /// Divides `surfaces`, neither of which crosses itself. A vertex of the first that lies on one of the second becomes that.
    ///
    /// # Errors
    /// When they come so close to each other that what comes of it would cross itself.
    pub(super) fn new(points: &[Point], surfaces: [&[[VertexId; 3]]; 2], threads: &Threads) -> Result<Self> {
        let used: Vec<Point> = surfaces[0].as_flattened().iter().map(|v| points[v.index()]).collect();
        let near = bounds(&used).map_or(0.0, |[low, high]| distance(low, high) * NEAR);
        let names = joined(points, surfaces, near);
        let first = renamed(surfaces[0], &names);
        let surfaces = [&first[..], surfaces[1]];
        let pairs = pairs(points, surfaces, near, threads);
        let mut found = Points::new(points, &pairs, surfaces);
        found.merge(near);
        let cut = found.divide(&pairs, surfaces, names);
        cut.filter(|cut| cut.is_sound(threads)).ok_or_else(|| {
            Error::input("surfaces come so close to each other, or cross at so small an angle, that they cannot be divided")
                .remedy("move the device a little")
        })
    }

    /// Whether the pieces meet in what they share alone.
    fn is_sound(&self, threads: &Threads) -> bool {
        let [a, b] = [0, 1].map(|s| self.pieces[s].iter().map(|(t, _)| *t).collect::<Vec<_>>());
        let is_same = |&[i, j]: &[u32; 2]| rising(a[i as usize]) == rising(b[j as usize]);
        crossings(&self.points, &a, &b, threads).iter().all(is_same)
    }
}

/// What vertices of the first surface are called: as those of the second that lie at their place.
fn joined(points: &[Point], surfaces: [&[[VertexId; 3]]; 2], near: f64) -> Vec<VertexId> {
    let mut names: Vec<VertexId> = (0..points.len()).map(VertexId::new).collect();
    let vertices = |s: usize| surfaces[s].as_flattened().iter().copied().collect::<BTreeSet<_>>();
    let second: Vec<VertexId> = vertices(1).into_iter().collect();
    let boxes: Vec<_> = second.iter().map(|v| [points[v.index()]; 2]).collect();
    let (tree, mut touching) = (BoxTree::new(&boxes), Vec::new());
    for v in vertices(0) {
        let at = points[v.index()];
        tree.touching(widened([at; 2], near), &mut touching);
        let off = |i: &&u32| distance(points[second[**i as usize].index()], at);
        let nearest = touching.iter().filter(|i| off(i) <= near).min_by(|i, j| off(i).total_cmp(&off(j)));
        if let Some(&i) = nearest {
            names[v.index()] = second[i as usize];
        }
    }
    names
}

fn widened([low, high]: [Point; 2], by: f64) -> [Point; 2] {
    [low.map(|x| x - by), high.map(|x| x + by)]
}

/// A triangle of each surface, and what they have in common beside vertices of both.
type Pair = ([u32; 2], Common);

fn pairs(points: &[Point], surfaces: [&[[VertexId; 3]]; 2], near: f64, threads: &Threads) -> Vec<Pair> {
    let [a, b] = surfaces;
    let boxes: Vec<_> = b.iter().map(|&t| widened(around(&corners(points, t)), near)).collect();
    let tree = BoxTree::new(&boxes);
    let side = |surface: u8, number: u32, t: [VertexId; 3]| Side {
        surface,
        number,
        vertices: t,
        corners: corners(points, t),
    };
    in_runs(a.len(), threads, |touching, run| {
        let mut found = Vec::new();
        for i in run {
            tree.touching(around(&corners(points, a[i])), touching);
            for &j in touching.iter() {
                let (x, y) = (side(0, i as u32, a[i]), side(1, j, b[j as usize]));
                let common = Common::of(&x, &y, near).filter(|common| {
                    common.is_flat
                        || common.points.iter().any(|p| !matches!(p.on, [On::Corner(_), On::Corner(_)]))
                });
                found.extend(common.map(|common| ([i as u32, j], common)));
            }
        }
        found
    })
}
