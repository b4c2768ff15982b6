//! How far elements move without coming too near what they give way to, and how they are pushed back to the
//! distance.

use super::elements::{Element, Elements};
use super::lerp;
use super::obstacle::Obstacle;
use crate::base::{Point, Threads, VertexId};
use crate::contact::{SLACK, sweep_apart};
use crate::geometry::distance::triangle_triangle::closest_below;
use crate::geometry::vector::{add, distance, dot, largest_coordinate, norm, scale, sub};
use crate::spatial::{BoxTree, bounding_box, expanded, touch};

/// Elements that fall short of their distance by this fraction of it are pushed back, ...
const TOO_NEAR: f64 = 1e-13;

/// ... or by this fraction of the largest coordinate.
const ROUNDING: f64 = 1e-15;

/// An element stands on the obstacle if it exceeds its distance by no more than this fraction.
const STANDS: f64 = 1e-6;

/// An element that was stopped exceeds its distance from what stopped it by at most this fraction.
const HITS: f64 = 0.02;

/// Number of sweeps that remove from a motion the components into the obstacle: needed where several things
/// stop a node.
const CORNER_SWEEPS: usize = 8;

/// The largest number of searches for elements that are too near, and of sweeps over them after each search.
const PUSHES: [usize; 2] = [8, 8];

/// One part of a step: from a start where nothing is too near, with the obstacle at rest.
pub(super) struct Round<'a> {
    /// The positions of all nodes at the start.
    start: &'a [Point],
    /// The elements that may come near.
    elements: Vec<Element>,
    /// The triangles of the obstacle that they may come near.
    others: Vec<[VertexId; 3]>,
    tree: BoxTree,
    nodes: &'a [VertexId],
    /// An upper bound on the distance of any node from its start.
    farthest: f64,
    rounding: f64,
    threads: &'a Threads,
}

/// The result of pushing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pushed {
    /// Nothing was too near.
    Nothing,
    /// Everything is far enough away now.
    Away,
    /// Something is still too near: there is little space, or it is pushed from more than one side.
    NotFarEnough,
}

/// Which nodes of an element slide.
#[derive(Clone, Copy, Debug)]
enum SlidingNodes {
    /// The nodes that span its nearest point.
    Nearest,
    /// All nodes: a triangle that was stopped slides as a whole.
    All,
}

impl<'a> Round<'a> {
    /// Sets up the elements and obstacles for nodes that move from `start` to `wanted`.
    pub(super) fn new(
        elements: &Elements,
        nodes: &'a [VertexId],
        start: &'a [Point],
        wanted: &[Point],
        obstacle: &mut Obstacle,
        threads: &'a Threads,
    ) -> Self {
        let from_obstacle = obstacle.distances(nodes, start, threads);
        let longest = nodes.iter().map(|v| distance(start[v.index()], wanted[v.index()])).fold(0.0, f64::max);
        let least = elements.all.iter().map(|e| e.least).fold(0.0, f64::max);
        // When held back, a node may move in the opposite direction by as much as another one was to go.
        let farthest = 2.0 * (longest + least);
        let may_come_near = |element: &&Element| {
            let place = |v: &VertexId| nodes.binary_search(v).map_or(f64::INFINITY, |k| from_obstacle[k]);
            let nearest = element.corners.iter().map(place).fold(f64::INFINITY, f64::min);
            let corners = element.corners.map(|v| start[v.index()]);
            let size = [1, 2].map(|k| distance(corners[0], corners[k]));
            nearest <= element.least + farthest + size[0].max(size[1]) * 2.0
        };
        let elements: Vec<Element> = elements.all.iter().filter(may_come_near).copied().collect();
        let way = elements.iter().flat_map(|e| e.corners).map(|v| start[v.index()]);
        let near = expanded(bounding_box(way), farthest + least);
        let corners = |t: &[VertexId; 3]| bounding_box(t.map(|v| start[v.index()]));
        let others: Vec<_> = obstacle.triangles.iter().filter(|t| touch(corners(t), near)).copied().collect();
        let tree = BoxTree::new(&others.iter().map(corners).collect::<Vec<_>>());
        let rounding = ROUNDING * largest_coordinate(start).max(largest_coordinate(wanted));
        Self { start, elements, others, tree, nodes, farthest, rounding, threads }
    }

    /// Whether no node has moved beyond the region that was searched.
    pub(super) fn covers(&self, at: &[Point]) -> bool {
        self.nodes.iter().all(|v| distance(self.start[v.index()], at[v.index()]) <= self.farthest)
    }

    /// Where nodes should go: to their wanted places, except that nodes which stand on the obstacle at the
    /// start slide along it.
    pub(super) fn targets(&self, wanted: &[Point]) -> Vec<Point> {
        let all: Vec<(usize, f64)> = (0..self.elements.len()).map(|i| (i, 0.0)).collect();
        let mut at = wanted.to_vec();
        self.slide(&mut at, &all, wanted, |element| (element.least * (1.0 + STANDS), SlidingNodes::Nearest));
        at
    }

    /// Stops elements where they come too near on a straight way from the start; from there they slide.
    /// Returns whether there are any.
    pub(super) fn stop(&self, at: &mut [Point]) -> bool {
        let hits = self.hits(at, |element| SLACK * element.least);
        if hits.is_empty() {
            return false;
        }
        let to = at.to_vec();
        for &(v, time) in &self.first_of_nodes(&hits) {
            at[v.index()] = lerp(self.start[v.index()], to[v.index()], time);
        }
        self.slide(at, &hits, &to, |element| (SLACK * element.least * (1.0 + HITS), SlidingNodes::All));
        true
    }

    /// The elements that come as near as `apart` on straight ways from the start, each with the fraction of
    /// the way that it may go.
    fn hits(&self, at: &[Point], apart: impl Fn(&Element) -> f64) -> Vec<(usize, f64)> {
        if self.elements.is_empty() || self.others.is_empty() {
            return Vec::new();
        }
        let velocity: Vec<Point> = self.start.iter().zip(at).map(|(&p, &q)| sub(q, p)).collect();
        let own: Vec<_> = self.elements.iter().map(|e| e.corners).collect();
        let apart: Vec<f64> = self.elements.iter().map(apart).collect();
        let times = sweep_apart(self.start, &velocity, [&own, &self.others], &apart, 1.0, self.threads);
        times.into_iter().enumerate().filter(|(_, time)| *time < 1.0).collect()
    }

    /// The earliest time at which each node is stopped, in rising order of nodes.
    fn first_of_nodes(&self, hits: &[(usize, f64)]) -> Vec<(VertexId, f64)> {
        let nodes = |&(i, time): &(usize, f64)| self.elements[i].corners.map(|v| (v, time));
        let mut first: Vec<(VertexId, f64)> = hits.iter().flat_map(nodes).collect();
        first.sort_unstable_by(|x, y| x.0.cmp(&y.0).then(x.1.total_cmp(&y.1)));
        first.dedup_by_key(|(v, _)| *v);
        first
    }

    /// From where elements are stopped, at a fraction of their way, their nodes slide along the obstacles
    /// within `reach` of them there: by as much as their remaining way is longer along the obstacle than into
    /// it.
    fn slide(
        &self,
        at: &mut [Point],
        hits: &[(usize, f64)],
        to: &[Point],
        reach: impl Fn(&Element) -> (f64, SlidingNodes) + Sync,
    ) {
        let found = self.threads.map(hits.len(), |k| {
            let (i, time) = hits[k];
            let element = &self.elements[i];
            let here = element.corners.map(|v| lerp(self.start[v.index()], to[v.index()], time));
            let (within, who) = reach(element);
            self.normals(element, here, within, who)
                .into_iter()
                .map(|(v, n)| (v, time, n))
                .collect::<Vec<_>>()
        });
        let mut normals: Vec<(VertexId, f64, Point)> = found.concat();
        normals.sort_by(|x, y| x.0.cmp(&y.0).then(x.1.total_cmp(&y.1)));
        for normals in normals.chunk_by(|x, y| x.0 == y.0) {
            // Obstacles that would stop a node later do not stop it once it slides.
            let (v, time, _) = normals[0];
            let first: Vec<Point> =
                normals.iter().take_while(|(_, t, _)| *t == time).map(|(_, _, n)| *n).collect();
            let here = lerp(self.start[v.index()], to[v.index()], time);
            if let Some(by) = along(sub(to[v.index()], here), &first) {
                at[v.index()] = add(here, by);
            }
        }
    }

    /// The nodes of an element that is within reach of the obstacle, each with the direction away from it.
    fn normals(
        &self,
        element: &Element,
        here: [Point; 3],
        reach: f64,
        who: SlidingNodes,
    ) -> Vec<(VertexId, Point)> {
        let mut all = Vec::new();
        for t in self.around(here, reach) {
            let closest = closest_below(here, self.other(t), reach * reach);
            let Some((closest, way)) = closest.and_then(|c| Some((c, c.direction()?))) else { continue };
            let away = scale(way, -1.0);
            match who {
                SlidingNodes::Nearest => {
                    all.extend(shares(element.corners, closest.on_a).map(|(v, _)| (v, away)))
                }
                SlidingNodes::All => all.extend(element.corners.map(|v| (v, away))),
            }
        }
        all
    }

    /// Moves all nodes towards their wanted places, by the same fraction of the remaining way, until
    /// something is at its distance: for when pushing left them too far away.
    pub(super) fn close_up(&self, wanted: &[Point]) -> Vec<Point> {
        // Nothing is too near, so nothing needs slack.
        let hits =
            self.hits(wanted, |element| element.least - 2.0 * (element.least - self.too_near(element)));
        let time = hits.iter().fold(1.0, |least: f64, (_, time)| least.min(*time));
        let mut at = self.start.to_vec();
        self.nodes.iter().map(|v| v.index()).for_each(|v| at[v] = lerp(at[v], wanted[v], time));
        at
    }

    /// Pushes elements that are too near away from what they are nearest to.
    pub(super) fn push(&self, at: &mut [Point]) -> Pushed {
        let [n_looks, n_sweeps] = PUSHES;
        for k in 0..n_looks {
            let near: Vec<&Element> = {
                let is_near = self.threads.map(self.elements.len(), |i| self.is_near(&self.elements[i], at));
                self.elements.iter().zip(is_near).filter(|(_, is)| *is).map(|(e, _)| e).collect()
            };
            if near.is_empty() {
                return if k > 0 { Pushed::Away } else { Pushed::Nothing };
            }
            for _ in 0..n_sweeps {
                let mut is_pushed = false;
                near.iter().for_each(|element| is_pushed |= self.push_one(element, at));
                if !is_pushed {
                    break;
                }
            }
        }
        Pushed::NotFarEnough
    }

    fn too_near(&self, element: &Element) -> f64 {
        element.least - (TOO_NEAR * element.least).max(self.rounding)
    }

    /// The triangles of the obstacle that may be within reach.
    fn around(&self, here: [Point; 3], reach: f64) -> Vec<u32> {
        let mut found = Vec::new();
        self.tree.touching(expanded(bounding_box(here), reach), &mut found);
        found
    }

    fn other(&self, t: u32) -> [Point; 3] {
        self.others[t as usize].map(|v| self.start[v.index()])
    }

    fn is_near(&self, element: &Element, at: &[Point]) -> bool {
        let (corners, least) = (element.corners.map(|v| at[v.index()]), self.too_near(element));
        let is_near = |&t: &u32| closest_below(corners, self.other(t), least * least).is_some();
        self.around(corners, least).iter().any(is_near)
    }

    /// Pushes an element away from each triangle that it is too near: moves its corners, by the weights of
    /// the nearest point (position based dynamics; Mueller et al. 2007).
    fn push_one(&self, element: &Element, at: &mut [Point]) -> bool {
        let least = self.too_near(element);
        let mut is_pushed = false;
        for t in self.around(element.corners.map(|v| at[v.index()]), element.least) {
            let corners = element.corners.map(|v| at[v.index()]);
            let Some(closest) = closest_below(corners, self.other(t), least * least) else { continue };
            let Some(way) = closest.direction() else { continue };
            let by = scale(way, closest.distance() - element.least);
            for (v, share) in shares(element.corners, closest.on_a) {
                at[v.index()] = add(at[v.index()], scale(by, share));
            }
            is_pushed = true;
        }
        is_pushed
    }
}

/// How far a node slides along the obstacles with these normals: by as much as its way is longer along them
/// than into them. `None` if it moves away from them.
fn along(way: Point, normals: &[Point]) -> Option<Point> {
    let mut along = way;
    for _ in 0..CORNER_SWEEPS {
        for normal in normals {
            along = sub(along, scale(*normal, dot(along, *normal).min(0.0)));
        }
    }
    let (into, free) = (distance(way, along), norm(along));
    (into > 0.0).then(|| scale(along, if free > into { 1.0 - into / free } else { 0.0 }))
}

/// The share of a push that each node takes, so that the point with these weights moves by all of it. An
/// element that is a node counts once.
fn shares(corners: [VertexId; 3], weights: [f64; 3]) -> impl Iterator<Item = (VertexId, f64)> {
    let is_node = corners[0] == corners[1];
    let weights = if is_node { [1.0, 0.0, 0.0] } else { weights };
    let sum: f64 = weights.iter().map(|w| w * w).sum();
    corners.into_iter().zip(weights.map(|w| w / sum)).filter(|(_, share)| *share != 0.0)
}
