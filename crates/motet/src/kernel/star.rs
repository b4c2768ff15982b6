//! Traversal: the tets of a vertex (its star), and the tets around an edge (its shell).

use crate::base::{TetId, VertexId};
use crate::kernel::complex::Complex;
use crate::kernel::link::{Behind, WallId};
use crate::kernel::marks::Marks;
use crate::kernel::tets::{NO_TET, flood};

/// The tets around an edge `ab`, in order, with the vertices opposite the edge.
///
/// ```text
///          r2               tet i is (a, b, ring[i], ring[i + 1]) and positive: seen along
///        / | \              the edge from a to b, the ring runs clockwise.
///      r3--ab--r1           Closed: as many tets as ring vertices.
///        \ | /              Open (an edge of the boundary): one vertex more, the walls
///          r0               of the boundary at either end.
/// ```
#[derive(Clone, Debug, Default)]
pub struct Shell {
    /// The tets.
    pub tets: Vec<TetId>,
    /// The vertices opposite the edge.
    pub ring: Vec<VertexId>,
    /// Whether the tets form a closed ring around the edge.
    pub is_closed: bool,
    /// Which of the facets at the edge are walls, by the index in the ring of their third vertex; both ends
    /// of an open shell are walls.
    pub walls: Vec<usize>,
}

/// For vertices `i` and `j` of a positive tet, by local number, the other two, `k` and `l`, such that (i, j,
/// k, l) is positive.
const OTHERS: [[[u8; 2]; 4]; 4] = [
    [[0, 0], [2, 3], [3, 1], [1, 2]],
    [[3, 2], [0, 0], [0, 3], [2, 0]],
    [[1, 3], [3, 0], [0, 0], [0, 1]],
    [[2, 1], [0, 2], [1, 0], [0, 0]],
];

/// The local numbers of the vertices other than `i` and `j`; see [`OTHERS`].
#[inline(always)]
pub(super) fn other_places(i: usize, j: usize) -> [usize; 2] {
    OTHERS[i][j].map(usize::from)
}

impl Shell {
    /// Walks around the edge from `a` to `b`, beginning at `start`, a tet that has it.
    pub fn walk(&mut self, complex: &Complex, start: TetId, a: VertexId, b: VertexId) {
        self.clear();
        if self.walk_ring(complex, start, a, b) {
            return;
        }
        // The walk met the boundary: go back the other way to the first tet, and walk again from there.
        let first = Self::first(complex, start, a, b);
        self.clear();
        self.walls.push(0);
        self.walk_ring(complex, first, a, b);
    }

    fn clear(&mut self) {
        self.tets.clear();
        self.ring.clear();
        self.walls.clear();
        self.is_closed = false;
    }

    /// Walks around the edge until it is back at `start` (true) or at the boundary (false).
    fn walk_ring(&mut self, complex: &Complex, start: TetId, a: VertexId, b: VertexId) -> bool {
        let mut tet = start;
        loop {
            let (i, j) = (complex.place(tet, a), complex.place(tet, b));
            let [k, l] = other_places(i, j);
            let vertices = complex.vertices(tet);
            self.tets.push(tet);
            self.ring.push(vertices[k]);
            // The facet ahead belongs to the next ring vertex: after the last tet, to the first one.
            let is_wall = complex.is_wall(tet, k);
            if is_wall {
                self.walls.push(self.ring.len());
            }
            let next = complex.across(tet, k);
            if next.is_none() {
                self.ring.push(vertices[l]);
                return false;
            }
            tet = next.tet();

            if tet == start {
                self.is_closed = true;
                if self.walls.last() == Some(&self.ring.len()) {
                    self.walls.pop();
                    self.walls.insert(0, 0);
                }
                return true;
            }
        }
    }

    /// The tet of an open shell from which [`Self::walk_ring`] visits all of them.
    fn first(complex: &Complex, start: TetId, a: VertexId, b: VertexId) -> TetId {
        let mut tet = start;
        loop {
            let [_, l] = other_places(complex.place(tet, a), complex.place(tet, b));
            let next = complex.across(tet, l);
            if next.is_none() {
                return tet;
            }
            tet = next.tet();
        }
    }

    /// The wall at index `place` of the ring, which is one of [`Self::walls`].
    pub fn wall_at(&self, complex: &Complex, place: usize) -> WallId {
        // Tet i has the ring vertices i and i + 1; its facet at one of them lies opposite the other.
        let (tet, opposite) = match place {
            0 => (0, 1 % self.ring.len()),
            _ => (place - 1, place - 1),
        };
        let tet = self.tets[tet];
        match complex.behind(tet, complex.place(tet, self.ring[opposite])) {
            Behind::Wall(wall) => wall,
            Behind::Tet(_) => unreachable!("places of walls are noted as such"),
        }
    }

    /// Whether the edge lies inside one region, with no wall at it.
    #[inline]
    pub fn is_free(&self) -> bool {
        self.walls.is_empty()
    }
}

/// The tets of a vertex that are connected through facets at it.
#[derive(Clone, Debug, Default)]
pub struct Star {
    /// The tets.
    pub tets: Vec<TetId>,
    /// Whether one of the facets at the vertex is a wall.
    pub has_walls: bool,
    marks: Marks,
}

impl Complex {
    /// Whether all tets of a vertex are connected through facets at it; `star` gathers them.
    pub fn is_one_star(&self, vertex: VertexId, star: &mut Star) -> bool {
        star.gather(self, vertex);
        star.tets.len() == self.overlaps.n_tets(vertex)
    }
}

impl Star {
    /// Gathers the tets of `vertex`.
    pub fn gather(&mut self, complex: &Complex, vertex: VertexId) {
        self.tets.clear();
        self.has_walls = false;
        let start = complex.tet_of(vertex);
        if start == NO_TET {
            return;
        }
        let reached = (&mut self.tets, &mut self.marks);
        let has_vertex = |opposite: VertexId| opposite != vertex;
        flood(&complex.tets, start, reached, has_vertex, |half| {
            self.has_walls |= complex.is_wall(half.tet(), half.facet());
            complex.across(half.tet(), half.facet())
        });
    }

    /// Whether a tet is among those gathered last.
    #[inline]
    pub fn has(&self, tet: TetId) -> bool {
        self.marks.has(tet)
    }
}

#[cfg(test)]
mod tests {
    use super::other_places;

    #[test]
    fn the_other_places_make_an_even_permutation() {
        for i in 0..4 {
            for j in (0..4).filter(|&j| j != i) {
                let [k, l] = other_places(i, j);
                let order = [i, j, k, l];
                let swaps = (0..4).flat_map(|x| (0..x).map(move |y| (y, x)));
                let n_inversions = swaps.filter(|&(y, x)| order[y] > order[x]).count();
                let mut sorted = order;
                sorted.sort_unstable();
                assert!(sorted == [0, 1, 2, 3] && n_inversions % 2 == 0, "{order:?}");
            }
        }
    }
}
