//! Edge removal: the tets around an edge are replaced by the best ones that do without it.
//!
//! The tets around an edge `ab` are removed. They are replaced by a triangulation of the ring around the
//! edge, with each triangle joined to `a` and to `b`. The triangulation with the best worst tet, or the
//! lowest total cost, is found by dynamic programming (Klincsek 1980, *Minimal triangulations of polygonal
//! domains*; Shewchuk 2002, *Two discrete optimization algorithms for the topological improvement of
//! tetrahedral meshes*): the flips 3-2 and 4-4 are its cases for rings of three and four.

use crate::base::{Point, TetId, VertexId};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, dot};
use crate::kernel::{Change, Complex, NewWall, Shell};
use crate::ops::{Objective, WorstAbove};

/// Edges with more ring vertices than this are not removed: triangulations become many, and good ones rare.
const MAX_RING: usize = 10;

/// Work arrays, reused from call to call.
#[derive(Clone, Debug, Default)]
pub struct EdgeRemoval {
    /// Buffer of [`Self::propose`].
    shell: Shell,
    /// For ring vertices i < j: the lowest cost of filling the ring between them, and the third vertex of the
    /// triangle at `ij`.
    best: Vec<(f64, u8)>,
}

impl EdgeRemoval {
    /// Proposes to remove the edge from `a` to `b`, which `start` has. Where the surface may change, an edge
    /// at which two walls of one patch meet can be removed, too: it is replaced by the edge between the other
    /// two vertices of the walls. Returns `false` if no triangulation is better than `bar`.
    pub fn propose(
        &mut self,
        complex: &Complex,
        start: TetId,
        [a, b]: [VertexId; 2],
        bar: f64,
        change: &mut Change,
    ) -> bool {
        let mut shell = std::mem::take(&mut self.shell);
        shell.walk(complex, start, a, b);
        let is_better = self.propose_for(complex, &shell, [a, b], &mut WorstAbove(bar), change);
        self.shell = shell;
        is_better
    }

    /// Proposes to remove the edge from `a` to `b`, with the tets `shell` around it, in the way of
    /// [`Self::propose`] that has the lowest cost. Returns `false` if none is below the limit of the
    /// objective.
    pub fn propose_for(
        &mut self,
        complex: &Complex,
        shell: &Shell,
        [a, b]: [VertexId; 2],
        objective: &mut impl Objective,
        change: &mut Change,
    ) -> bool {
        if complex.is_kept_edge(a, b) {
            return false;
        }
        change.clear();
        change.cavity.extend_from_slice(&shell.tets);
        let m = shell.ring.len();
        match shell.walls[..] {
            [] if m >= 3 => self.fill(complex, (shell, [a, b]), (0, m), objective, change),
            [i, j] if !complex.keeps_surface() => {
                swap_walls(complex, (shell, [a, b]), [i, j], change)
                    && self.fill(complex, (shell, [a, b]), (i, j - i + 1), objective, change)
                    && (!shell.is_closed
                        || self.fill(complex, (shell, [a, b]), (j, m - j + i + 1), objective, change))
            }
            _ => false,
        }
    }

    /// Fills the part of the ring that begins at index `start` and has `n` vertices. With fewer than three
    /// vertices there is nothing to fill.
    fn fill(
        &mut self,
        complex: &Complex,
        (shell, edge): (&Shell, [VertexId; 2]),
        (start, n): (usize, usize),
        objective: &mut impl Objective,
        change: &mut Change,
    ) -> bool {
        if n > MAX_RING {
            return false;
        }
        let m = shell.ring.len();
        let mut ring = [VertexId(0); MAX_RING];
        for (i, vertex) in ring[..n].iter_mut().enumerate() {
            *vertex = shell.ring[(start + i) % m];
        }
        if n < 3 {
            return true;
        }
        let region = complex.region(shell.tets[start % shell.tets.len()]);
        let limit = objective.limit(complex, &shell.tets, 2 * (n - 2));
        self.tabulate(complex, edge, &ring[..n], limit, objective, change) && {
            self.build(complex, edge, &ring[..n], region, (0, n - 1), change);
            true
        }
    }

    /// Fills the table; returns whether the whole ring can be filled at a cost below `limit`.
    fn tabulate<O: Objective>(
        &mut self,
        complex: &Complex,
        [a, b]: [VertexId; 2],
        ring: &[VertexId],
        limit: f64,
        objective: &O,
        change: &Change,
    ) -> bool {
        let best = &mut self.best;
        let m = ring.len();
        let [pa, pb] = [complex.point(a), complex.point(b)];
        let mut points = [[0.0; 3]; MAX_RING];
        for i in 0..m {
            points[i] = complex.point(ring[i]);
        }
        best.clear();
        best.resize(m * m, (O::NOTHING, 0));
        for length in 2..m {
            for i in 0..m - length {
                let j = i + length;
                let mut found = (limit, u8::MAX);
                for k in i + 1..j {
                    let mut cost = objective.both(best[i * m + k].0, best[k * m + j].0);
                    if cost >= found.0 {
                        continue;
                    }
                    let [p, q, r] = [ring[i], ring[k], ring[j]];
                    let above = change.judge(complex, [p, q, r, b], [points[i], points[k], points[j], pb]);
                    cost = objective.both(cost, objective.cost([p, q, r, b], above));
                    if cost >= found.0 {
                        continue;
                    }
                    let below = change.judge(complex, [p, r, q, a], [points[i], points[j], points[k], pa]);
                    cost = objective.both(cost, objective.cost([p, r, q, a], below));
                    if cost < found.0 {
                        found = (cost, k as u8);
                    }
                }
                best[i * m + j] = if found.1 == u8::MAX { (f64::INFINITY, u8::MAX) } else { found };
            }
        }
        best[m - 1].0 < limit
    }

    fn build(
        &self,
        complex: &Complex,
        [a, b]: [VertexId; 2],
        ring: &[VertexId],
        region: i32,
        (i, j): (usize, usize),
        change: &mut Change,
    ) {
        if j < i + 2 {
            return;
        }
        let k = usize::from(self.best[i * ring.len() + j].1);
        let [p, q, r] = [i, k, j].map(|place| ring[place]);
        change.push(complex, [p, q, r, b], region);
        change.push(complex, [p, r, q, a], region);
        self.build(complex, [a, b], ring, region, (i, k), change);
        self.build(complex, [a, b], ring, region, (k, j), change);
    }
}

/// Replaces the walls at indices `i` and `j` of the ring around an edge by two between the same four
/// vertices. Returns `false` if they belong to different patches, or if one of the new walls would lie on the
/// other.
fn swap_walls(
    complex: &Complex,
    (shell, [a, b]): (&Shell, [VertexId; 2]),
    places: [usize; 2],
    change: &mut Change,
) -> bool {
    let [first, second] = places.map(|place| complex.wall(shell.wall_at(complex, place)));
    let [p, q] = places.map(|place| shell.ring[place]);
    for (end, wall) in [(a, first), (b, second)] {
        change.walls.push(NewWall { vertices: [end, p, q], patch: wall.patch, triangle: wall.triangle });
    }
    first.patch == second.patch && !would_fold([a, b, p, q].map(|v| complex.point(v)))
}

/// Whether one of the walls `apq` and `bqp`, which would replace `abp` and `baq`, faces the other way. If all
/// four vertices lie in a plane and the midpoint of `pq` is outside both old walls, that would leave a tet
/// without volume between walls.
fn would_fold([a, b, p, q]: [Point; 4]) -> bool {
    let before = add(area_vector([a, b, p]), area_vector([b, a, q]));
    [[p, a, q], [q, b, p]].into_iter().any(|wall| dot(area_vector(wall), before) <= 0.0)
}
