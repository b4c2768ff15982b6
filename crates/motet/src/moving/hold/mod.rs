//! Walls that are kept apart: what would come too near another wall, or pass through it, stops in front of
//! it.
//!
//! ```text
//!      requested                       held
//!      o                   o           o                   o
//!         o             o                 o             o
//!    --------o-------o--------             o--o--o--o--o     at the distance
//!    ============o============         =========================  the other wall
//! ```
//!
//! | file | what it does |
//! |---|---|
//! | `obstacle` | the walls that another one gives way to, and where it is when it is carried along with them |
//! | `elements` | triangles and nodes of a wall, and how near each may come |
//! | `round` | how far elements get without coming too near, and how they are pushed back to the distance |
//! | `spread` | nodes next to one that was stopped are held back with it, so that no edge between them is lost |
//!
//! In a step, every node of a wall is requested to move in a straight line from where the last step left it
//! to a new place. Of two walls, the first gives way: it is carried along by the second, then moves straight
//! on to its requested place. Each of its triangles moves only while its distance from the other wall exceeds
//! a fraction ([`SLACK`](crate::contact::SLACK)) of the one to keep, which
//! [`sweep_apart`](crate::contact::sweep_apart) finds by conservative advancement. So nothing passes through,
//! however far it is requested to go. From there it is pushed back to the distance, away from what is
//! nearest. A node that stands at the distance slides along as far as its requested way is longer along the
//! obstacle than into it (friction, Coulomb 1785, with a coefficient of 1): pressed on hard it stops,
//! whatever the slope. A round that neither stops nor pushes anything proves that its result is sound.

mod elements;
mod obstacle;
mod round;
mod spread;
#[cfg(test)]
mod tests;

use self::elements::Elements;
use self::obstacle::Obstacle;
use self::round::{Pushed, Round};
use self::spread::Slopes;
use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, distance, dot, largest_coordinate, scale, sub};
use crate::moving::options::Watching;
use crate::moving::wall::Wall;

/// The number of parts of a step, and the fraction of an edge's length by which the corrections at its ends
/// may differ: tried one after the other, until the wall is sound.
const ATTEMPTS: [(usize, f64); 3] = [(1, 0.5), (4, 0.25), (8, 0.0)];

/// The largest number of rounds of stopping, pushing back and holding back. Two or three are typical.
const ROUNDS: usize = 8;

/// A distance has to exceed this fraction of the largest coordinate: coordinates are rounded to 1e-16.
const RESOLUTION: f64 = 1e-12;

/// A held triangle keeps at least this fraction of its area, projected along the normal at its requested
/// place.
const UPRIGHT: f64 = 0.01;

/// Walls, each of which is kept away from all that follow it.
#[derive(Clone, Debug)]
pub(super) struct Hold {
    /// In reverse order: the last of the walls that give way comes first.
    walls: Vec<YieldingWall>,
    /// Displacement of each node from its first position, as the last step left it.
    pub(super) last: Vec<Point>,
}

/// A wall that gives way to others.
#[derive(Clone, Debug)]
struct YieldingWall {
    /// Index of this wall among the watched patches.
    wall: usize,
    triangles: Vec<[VertexId; 3]>,
    /// The nodes of the triangles that the other walls do not share.
    nodes: Vec<VertexId>,
    obstacle: Obstacle,
    elements: Elements,
    slopes: Slopes,
}

/// The result of keeping walls apart in a step.
#[derive(Clone, Debug, Default)]
pub(super) struct Held {
    /// Displacement of each node from its first position.
    pub(super) displacement: Vec<Point>,
    /// How many nodes are not at their requested place.
    pub(super) n_nodes: usize,
    /// The node that is farthest from its requested place.
    pub(super) farthest: Option<Stopped>,
    /// A wall that has no space to keep its distance.
    pub(super) cramped: Option<usize>,
}

/// A node that is not at its requested place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stopped {
    /// Index of its wall among the watched patches.
    pub(super) wall: usize,
    /// Distance of the node from its requested place.
    pub(super) short: f64,
    /// Position of the node.
    pub(super) place: Point,
}

impl Hold {
    /// The watched patches as walls to keep apart; `None` if they are not to be. A node that two of them
    /// share is not kept away from either.
    ///
    /// # Errors
    /// If the distance is not above 0, or is less than coordinates resolve.
    pub(super) fn of(watch: &Watching, wall: &Wall, threads: &Threads) -> Result<Option<Self>> {
        let Some(distance) = watch.hold else { return Ok(None) };
        let bodies: Vec<_> = (0..watch.patches.len() as u32).map(|k| wall.body(k)).collect();
        Self::between(distance, &wall.places, &bodies, threads).map(Some)
    }

    /// Keeps walls apart, given as triangles between nodes at these first places.
    fn between(
        distance: f64,
        places: &[Point],
        bodies: &[Vec<[VertexId; 3]>],
        threads: &Threads,
    ) -> Result<Self> {
        let least = RESOLUTION * largest_coordinate(places);
        if !(distance > least && distance.is_finite()) {
            return Err(Error::options(format!(
                "the distance between walls is too small, or not finite: {distance}"
            ))
            .remedy(format!("give a distance above {least:e}, the resolution of the coordinates")));
        }
        let walls =
            (1..bodies.len()).rev().map(|k| YieldingWall::new(distance, places, k - 1, bodies, threads));
        Ok(Self { walls: walls.collect(), last: vec![[0.0; 3]; places.len()] })
    }

    /// Stops whatever goes too far on its way from where the last step left it. [`Self::advance`] then
    /// records how much of that was done.
    pub(super) fn stop(&mut self, places: &[Point], requested: &[Point], threads: &Threads) -> Held {
        let displaced =
            |by: &[Point]| -> Vec<Point> { places.iter().zip(by).map(|(&p, &d)| add(p, d)).collect() };
        let (from, wanted) = (displaced(&self.last), displaced(requested));
        let mut held = Held { displacement: requested.to_vec(), ..Held::default() };
        let mut at = wanted.clone();
        for wall in &mut self.walls {
            if !wall.give_way(&from, &mut at, threads) {
                held.cramped = Some(wall.wall);
            }
            for v in wall.nodes.iter().map(|v| v.index()).filter(|&v| at[v] != wanted[v]) {
                held.displacement[v] = sub(at[v], places[v]);
                let stopped = Stopped { wall: wall.wall, short: distance(at[v], wanted[v]), place: at[v] };
                held.n_nodes += 1;
                held.farthest = held.farthest.filter(|known| known.short >= stopped.short).or(Some(stopped));
            }
        }
        held
    }

    /// Records that walls have gone this fraction of the way to these displacements.
    pub(super) fn advance(&mut self, displacement: &[Point], part: f64) {
        for (last, &to) in self.last.iter_mut().zip(displacement) {
            *last = if part == 1.0 { to } else { lerp(*last, to, part) };
        }
    }
}

impl YieldingWall {
    /// Sets up the wall with this index, which gives way to all after it.
    fn new(
        distance: f64,
        places: &[Point],
        wall: usize,
        bodies: &[Vec<[VertexId; 3]>],
        threads: &Threads,
    ) -> Self {
        let mut obstacle = Obstacle::new(places, &bodies[wall + 1..], threads);
        let triangles = bodies[wall].clone();
        let mut nodes = nodes_of(&triangles);
        nodes.retain(|v| !obstacle.has_node(*v));
        let elements = Elements::new(&triangles, &nodes, distance, places, &mut obstacle, threads);
        let slopes = Slopes::new(&triangles, &nodes, places, threads);
        Self { wall, triangles, nodes, obstacle, elements, slopes }
    }

    /// Moves the nodes as far as allowed on their way to their places in `at`. Returns whether they keep
    /// their distance: there may be no space to do so.
    fn give_way(&mut self, from: &[Point], at: &mut [Point], threads: &Threads) -> bool {
        let is_still = self.obstacle.is_still(from, at);
        if is_still && self.nodes.iter().all(|v| from[v.index()] == at[v.index()]) {
            return true;
        }
        let found = ATTEMPTS.iter().find_map(|&(n, slope)| self.advance(from, at, n, slope, threads));
        let is_found = found.is_some();
        let end = found.unwrap_or_else(|| self.carried(from, at, threads));
        self.nodes.iter().for_each(|v| at[v.index()] = end[v.index()]);
        // If nothing pushes, a wall that stays where it was is as far away as it was.
        is_found || is_still
    }

    /// Moves to `to` in `n` parts.
    fn advance(
        &mut self,
        from: &[Point],
        to: &[Point],
        n: usize,
        slope: f64,
        threads: &Threads,
    ) -> Option<Vec<Point>> {
        (1..=n).try_fold(from.to_vec(), |here, k| {
            let part = k as f64 / n as f64;
            let wanted: Vec<Point> = match k == n {
                true => to.to_vec(),
                false => from.iter().zip(to).map(|(&a, &b)| lerp(a, b, part)).collect(),
            };
            self.part(&here, &wanted, slope, threads)
        })
    }

    /// Moves one part: straight on, then along what stopped it. `None` if the wall would not be sound.
    fn part(
        &mut self,
        here: &[Point],
        wanted: &[Point],
        slope: f64,
        threads: &Threads,
    ) -> Option<Vec<Point>> {
        let start = self.carried(here, wanted, threads);
        let at = self.pass(&start, wanted, slope, threads)?;
        if self.nodes.iter().all(|v| at[v.index()] == wanted[v.index()]) {
            return Some(at);
        }
        Some(self.closed_up(at, wanted, threads))
    }

    /// Moves nodes that were pushed farther away than necessary closer again, if the wall stays sound.
    fn closed_up(&mut self, at: Vec<Point>, wanted: &[Point], threads: &Threads) -> Vec<Point> {
        let closer = Round::new(&self.elements, &self.nodes, &at, wanted, &mut self.obstacle, threads)
            .close_up(wanted);
        if self.is_upright(&closer, wanted) { closer } else { at }
    }

    /// Moves straight on from a place where nothing is too near.
    fn pass(
        &mut self,
        start: &[Point],
        wanted: &[Point],
        slope: f64,
        threads: &Threads,
    ) -> Option<Vec<Point>> {
        let round = Round::new(&self.elements, &self.nodes, start, wanted, &mut self.obstacle, threads);
        let mut at = round.targets(wanted);
        let mut n_near = 0;
        for _ in 0..ROUNDS {
            self.slopes.limit(&mut at, wanted, slope);
            let is_stopped = round.stop(&mut at);
            let pushed = round.push(&mut at);
            n_near += usize::from(pushed == Pushed::NotFarEnough);
            // Holding back may help once.
            if n_near > 1 {
                return None;
            }
            if !is_stopped && pushed == Pushed::Nothing {
                return (round.covers(&at) && self.is_upright(&at, wanted)).then_some(at);
            }
        }
        None
    }

    /// The positions of all nodes if these are carried along by the walls that they give way to.
    fn carried(&mut self, here: &[Point], wanted: &[Point], threads: &Threads) -> Vec<Point> {
        let mut start = wanted.to_vec();
        self.nodes.iter().for_each(|v| start[v.index()] = here[v.index()]);
        if !self.obstacle.is_still(here, wanted) {
            let carried = self.obstacle.carry(&self.nodes, here, wanted, threads);
            self.nodes.iter().zip(carried).for_each(|(v, p)| start[v.index()] = p);
        }
        start
    }

    /// Whether no triangle that is off its requested place is turned over or lost.
    fn is_upright(&self, at: &[Point], wanted: &[Point]) -> bool {
        self.triangles.iter().filter(|t| t.iter().any(|v| at[v.index()] != wanted[v.index()])).all(|t| {
            let [is, requested] = [at, wanted].map(|at| area_vector(t.map(|v| at[v.index()])));
            dot(is, requested) >= UPRIGHT * dot(requested, requested)
        })
    }
}

/// The nodes of triangles, in rising order.
fn nodes_of(triangles: &[[VertexId; 3]]) -> Vec<VertexId> {
    let mut nodes = triangles.as_flattened().to_vec();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// The point at fraction `part` of the way from one place to another.
fn lerp(from: Point, to: Point, part: f64) -> Point {
    add(from, scale(sub(to, from), part))
}
