//! How the vertices of caps follow when the rims of caps move with the layers.
//!
//! The motion is harmonic between what moves and what stays: every vertex moves by the mean of its
//! neighbours' motions, weighted by inverse distance, found by Gauss-Seidel iteration. Vertices within a cap
//! stay in its plane, those on an edge between two flat parts on that line.

use super::directions::Freedom;
use super::neighbors::NONE;
use super::skin::Skin;
use super::thickness::Heights;
use crate::base::{Point, VertexId};
use crate::geometry::vector::{add, distance, norm, scale, sub};

/// Iteration ends when nothing changes by more than this fraction of the largest motion.
const TOLERANCE: f64 = 1e-7;

/// The largest number of iterations.
const ROUNDS: usize = 2000;

/// A vertex without layers that may slide, and its neighbours with their weights, which sum to 1.
struct Slider {
    vertex: VertexId,
    freedom: Freedom,
    around: Vec<(VertexId, f64)>,
}

/// All sliding vertices.
pub(super) struct Sliders(Vec<Slider>);

impl Sliders {
    pub(super) fn new(skin: &Skin) -> Self {
        let may_slide = |&w: &usize| {
            let vertex = VertexId::new(w);
            let is_bare = |&t: &u32| skin.flats.of[t as usize] != NONE;
            skin.walls(vertex).next().is_none() && skin.stars.list(w).iter().all(is_bare)
        };
        let slider = |w: usize| {
            let vertex = VertexId::new(w);
            Slider { vertex, freedom: Freedom::of(skin, vertex), around: weights(skin, vertex) }
        };
        let all = (0..skin.points.len()).filter(may_slide).map(slider);
        Self(all.filter(|slider| slider.freedom != Freedom::Nowhere).collect())
    }

    /// The motion of each vertex: given by the layers, interpolated for sliding vertices, zero for all
    /// others.
    pub(super) fn motions(&self, skin: &Skin, heights: &Heights) -> Vec<Point> {
        let top = |w: usize| scale(heights.lifts[w], heights.heights[w]);
        let mut motions: Vec<Point> = (0..skin.points.len()).map(top).collect();
        let largest = motions.iter().map(|&m| norm(m)).fold(0.0, f64::max);
        for _ in 0..ROUNDS {
            let mut change = 0.0f64;
            for slider in &self.0 {
                let mean = |sum, &(v, weight): &(VertexId, f64)| add(sum, scale(motions[v.index()], weight));
                let new = slider.freedom.project(slider.around.iter().fold([0.0; 3], mean));
                change = change.max(norm(sub(new, motions[slider.vertex.index()])));
                motions[slider.vertex.index()] = new;
            }
            if change <= TOLERANCE * largest {
                break;
            }
        }
        motions
    }
}

fn weights(skin: &Skin, vertex: VertexId) -> Vec<(VertexId, f64)> {
    let star = skin.stars.list(vertex.index());
    let mut around: Vec<VertexId> =
        star.iter().flat_map(|&t| skin.triangles[t as usize]).filter(|&v| v != vertex).collect();
    around.sort_unstable();
    around.dedup();
    let weight = |v: &VertexId| 1.0 / distance(skin.points[v.index()], skin.points[vertex.index()]);
    let sum: f64 = around.iter().map(weight).sum();
    around.iter().map(|v| (*v, weight(v) / sum)).collect()
}
