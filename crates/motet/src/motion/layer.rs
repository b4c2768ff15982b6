//! The rigid layer: vertices near a wall that keep their position relative to it.
//!
//! ```text
//!     x            A vertex x of the layer has its foot f on the nearest facet of
//!     |  o         the wall, with weights b, and its offset o = x - f. The wall
//!  ---f------      moves: the foot goes along with the facet, f' = f + sum b d,
//!                  and the offset turns with the wall at the foot, x' = f' + R o.
//! ```
//!
//! R is blended from the rotations of the facet's vertices (see `rotation`). The facet's own rotation would
//! jump where the foot passes from one facet to the next, and shear thin cells that stand across the edge.
//! Rotations keep lengths, so every vertex keeps its distance from its foot. The distance between two
//! vertices of the layer is not kept where the wall stretches or bends: there the cells of the layer stretch
//! along with the wall.
//!
//! Where the wall has a crease, neighbours may have their feet on different sides of it. Each would move with
//! its own side, so both are left to the graph.

use pulp::NullaryFnOnce;

use crate::base::four::{FourLanes, FourVectors, Plain, cross, dot};
#[cfg(target_arch = "x86_64")]
use crate::base::four::{Wide, wide_machine};
use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::triangle;
use crate::geometry::vector::{add, distance, sub};
use crate::mesh::Cells;
use crate::motion::options::{Extent, FacetSet};
use crate::motion::polar::IDENTITY;
use crate::motion::rotation::{Rotations, Wall};
use crate::motion::update::Padded;
use crate::spatial::NearestTriangle;

/// Largest distance between the feet of neighbours, relative to the distance between the neighbours. In a
/// vessel with branches, bent, twisted and widened, prisms of the layer keep at least 0.46 of their thickness
/// and cells invert where this is infinite; at 1.5, 2 and 3 none do, and 0.65, 0.69 and 0.66 are kept.
const MAX_FOOT_RATIO: f64 = 2.0;

/// One vertex of the layer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Member {
    pub(crate) vertex: VertexId,
    /// The driven nodes at the corners of the nearest triangle of the wall.
    corners: [u32; 3],
    /// The weights that the foot has for the last two of them; the first is 1 less these.
    weights: [f64; 2],
    offset: Point,
}

/// A wall and the vertices that move with it.
#[derive(Debug)]
pub(crate) struct Layer {
    /// Over the driven nodes, of which some may be on no facet.
    wall: Wall,
    /// Those that do not slide, and then those that do; each in rising order.
    pub(crate) members: Vec<Member>,
}

impl Layer {
    /// Collects those of `candidates` that are within `extent` of the wall. `driven` are the vertices of the
    /// driven nodes, in rising order, and `slides` says which candidates slide.
    pub(crate) fn new(
        points: &[Point],
        cells: &Cells,
        wall: &FacetSet,
        extent: Extent,
        candidates: &[VertexId],
        driven: &[VertexId],
        slides: impl Fn(VertexId) -> bool,
    ) -> Result<Self> {
        let mut vertices: Vec<VertexId> = wall.rings.items().to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        if wall.triangles().next().is_none() {
            return Err(Error::options(format!("the wall {} of the rigid layer has no facets", wall.name)));
        }
        if let Some(v) = vertices.iter().find(|v| driven.binary_search(v).is_err()) {
            return Err(Error::input("is on the wall of the rigid layer, but its motion is not given")
                .at(format!("vertex {v}")));
        }
        let triangles: Vec<[VertexId; 3]> = wall.triangles().collect();
        let search = NearestTriangle::new(points, &triangles, &Threads::single());
        let node = |v: VertexId| driven.binary_search(&v).expect("every vertex was found") as u32;
        let triangles: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(node)).collect();
        let reach = match extent {
            Extent::Distance(distance) => distance,
            Extent::Cells(_) => f64::INFINITY,
        };
        let near = match extent {
            Extent::Distance(_) => None,
            Extent::Cells(n) => Some(within_cells(cells, points.len(), &vertices, n)),
        };
        let is_near = |v: VertexId| near.as_ref().is_none_or(|near| near[v.index()]);
        let mut members = Vec::new();
        for &vertex in candidates.iter().filter(|v| is_near(**v)) {
            let p = points[vertex.index()];
            if let Some(foot) = search.closest_within(p, reach) {
                let (corners, weights) = from_vertex(triangles[foot.triangle], foot.weights);
                members.push(Member { vertex, corners, weights, offset: sub(p, foot.point) });
            }
        }
        let between = spans_crease(points, cells, &vertices, &members);
        members.retain(|m| !between[m.vertex.index()]);
        members.sort_by_key(|m| slides(m.vertex));
        members.shrink_to_fit();
        let mut is_needed = vec![false; driven.len()];
        members.iter().flat_map(|m| m.corners).for_each(|node| is_needed[node as usize] = true);
        let places: Vec<Point> = driven.iter().map(|v| points[v.index()]).collect();
        Ok(Self { wall: Wall::new(&places, &triangles, |node| is_needed[node]), members })
    }

    /// The rotations of the wall at the driven nodes, given their displacements.
    pub(crate) fn rotations(&self, driven: &[Padded], threads: &Threads) -> Rotations {
        self.wall.rotations(driven, threads)
    }

    /// Displacements of the feet of consecutive members, beginning with `first`.
    pub(crate) fn feet(&self, driven: &[Padded], first: usize, out: &mut [Padded]) {
        let members = &self.members[first..first + out.len()];
        #[cfg(target_arch = "x86_64")]
        if let Some(machine) = wide_machine() {
            return machine.vectorize(Feet::<Wide> { machine, members, driven, out });
        }
        Feet::<Plain> { machine: (), members, driven, out }.call();
    }

    /// Adds to `out` how the offsets of consecutive members, beginning with `first`, change as the wall
    /// rotates at their feet.
    pub(crate) fn rotate_offsets(&self, rotations: &Rotations, first: usize, out: &mut [Padded]) {
        if rotations.is_empty() {
            return;
        }
        let members = &self.members[first..first + out.len()];
        #[cfg(target_arch = "x86_64")]
        if let Some(machine) = wide_machine() {
            return machine.vectorize(Offsets::<Wide> { machine, members, rotations, out });
        }
        Offsets::<Plain> { machine: (), members, rotations, out }.call();
    }

    /// The value at the foot of each member, given the values at the driven nodes.
    pub(crate) fn at_feet(&self, driven: &[Point]) -> Vec<Point> {
        let weights = |[b, c]: [f64; 2]| [1.0 - b - c, b, c];
        let foot = |m: &Member| triangle::at(m.corners.map(|node| driven[node as usize]), weights(m.weights));
        self.members.iter().map(foot).collect()
    }

    /// Whether each member is an outer one, which shares a cell with a vertex that is neither a member nor
    /// driven.
    pub(crate) fn outer(
        &self,
        cells: &Cells,
        is_driven: impl Fn(VertexId) -> bool,
        n_points: usize,
    ) -> Vec<bool> {
        let mut is_member = vec![false; n_points];
        self.members.iter().for_each(|m| is_member[m.vertex.index()] = true);
        let mut is_outer = vec![false; n_points];
        for (_, _, vertices) in cells.iter() {
            if vertices.iter().any(|&v| !is_member[v.index()] && !is_driven(v)) {
                vertices.iter().for_each(|v| is_outer[v.index()] = true);
            }
        }
        self.members.iter().map(|m| is_outer[m.vertex.index()]).collect()
    }
}

/// The corners of a triangle and the last two of their weights; where the foot is a corner, but for rounding,
/// that corner comes first and has all the weight.
fn from_vertex([a, b, c]: [u32; 3], weights: [f64; 3]) -> ([u32; 3], [f64; 2]) {
    let is_all = |w: f64| w > 1.0 - 1e-12;
    match weights {
        [first, _, _] if is_all(first) => ([a, b, c], [0.0; 2]),
        [_, second, _] if is_all(second) => ([b, c, a], [0.0; 2]),
        [_, _, third] if is_all(third) => ([c, a, b], [0.0; 2]),
        [_, second, third] => ([a, b, c], [second, third]),
    }
}

/// The loop over feet, each a weighted sum of three displacements.
struct Feet<'a, F: FourLanes> {
    machine: F::Machine,
    members: &'a [Member],
    driven: &'a [Padded],
    out: &'a mut [Padded],
}

impl<F: FourLanes> NullaryFnOnce for Feet<'_, F> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let machine = self.machine;
        for (out, member) in self.out.iter_mut().zip(self.members) {
            let [a, b, c] = member.corners;
            let at = |node: u32| self.driven[node as usize].load::<F>(machine);
            let [second, third] =
                [F::splat(machine, member.weights[0]), F::splat(machine, member.weights[1])];
            let first = F::splat(machine, 1.0) - second - third;
            *out = Padded::of_lanes(first * at(a) + second * at(b) + third * at(c));
        }
    }
}

/// The loop over offsets, four members at a time.
struct Offsets<'a, F: FourLanes> {
    machine: F::Machine,
    members: &'a [Member],
    rotations: &'a Rotations,
    out: &'a mut [Padded],
}

impl<F: FourLanes> NullaryFnOnce for Offsets<'_, F> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { machine, members, rotations, out } = self;
        for (members, out) in members.chunks(4).zip(out.chunks_mut(4)) {
            let rotates = |m: &Member| rotations.of(m.corners[0] as usize).is_some();
            if !members.iter().any(rotates) {
                continue;
            }
            let last = members.len() - 1;
            let four = [&members[0], &members[last.min(1)], &members[last.min(2)], &members[last]];
            let [x, y, z] = changes::<F>(machine, four, rotations);
            let [x, y, z] = [x.stored(), y.stored(), z.stored()];
            for (lane, out) in out.iter_mut().enumerate() {
                *out = Padded::new(add(out.point(), [x[lane], y[lane], z[lane]]));
            }
        }
    }
}

/// How the offsets of four members change by the means of the rotations at the corners, by their weights. `q`
/// and `-q` are the same rotation, so each is taken on the side of the sum so far.
#[inline(always)]
fn changes<F: FourLanes>(
    machine: F::Machine,
    [a, b, c, d]: [&Member; 4],
    rotations: &Rotations,
) -> FourVectors<F> {
    let zero = F::splat(machine, 0.0);
    let weight = |k: usize| F::load(machine, &[a.weights[k], b.weights[k], c.weights[k], d.weights[k]]);
    let weights = [F::splat(machine, 1.0) - weight(0) - weight(1), weight(0), weight(1)];
    // Over flat and convex walls most feet are vertices.
    let at_vertices = [a, b, c, d].iter().all(|m| m.weights == [0.0; 2]);
    let mut sum = [zero; 4];
    for (k, &weight) in weights.iter().enumerate().take(if at_vertices { 1 } else { 3 }) {
        let rotation = |m: &Member| rotations.of(m.corners[k] as usize).unwrap_or(&IDENTITY);
        let [p, q, r, s] = [rotation(a), rotation(b), rotation(c), rotation(d)];
        let mut side = zero;
        let mut of_corner = sum;
        for i in 0..4 {
            of_corner[i] = F::load(machine, &[p[i], q[i], r[i], s[i]]);
            side = side + sum[i] * of_corner[i];
        }
        let weight = (zero - side).select_positive(zero - weight, weight);
        for i in 0..4 {
            sum[i] = sum[i] + weight * of_corner[i];
        }
    }
    let part = |k: usize| F::load(machine, &[a.offset[k], b.offset[k], c.offset[k], d.offset[k]]);
    let (offset, [w, x, y, z]) = ([part(0), part(1), part(2)], sum);
    // As a single rotation changes a vector, relative to the squared length of the mean.
    let axis = [x, y, z];
    let across = cross(axis, offset);
    let scale = F::splat(machine, 2.0) / (w * w + dot(axis, axis));
    let [x, y, z] =
        cross(axis, [across[0] + w * offset[0], across[1] + w * offset[1], across[2] + w * offset[2]]);
    [(x * scale).or_if_nan(zero), (y * scale).or_if_nan(zero), (z * scale).or_if_nan(zero)]
}

/// Which vertices share a cell with another one whose foot is more than [`MAX_FOOT_RATIO`] times as far from
/// theirs as they are from each other. Where the wall has a crease, each would follow another side, and the
/// cells between would be crushed: they are left to the graph.
fn spans_crease(points: &[Point], cells: &Cells, wall: &[VertexId], members: &[Member]) -> Vec<bool> {
    let mut foot = vec![None; points.len()];
    wall.iter().for_each(|v| foot[v.index()] = Some(points[v.index()]));
    members.iter().for_each(|m| foot[m.vertex.index()] = Some(sub(points[m.vertex.index()], m.offset)));
    let mut between = vec![false; points.len()];
    for (_, _, vertices) in cells.iter() {
        for (i, &a) in vertices.iter().enumerate() {
            for &b in &vertices[..i] {
                let (Some(foot_a), Some(foot_b)) = (foot[a.index()], foot[b.index()]) else { continue };
                if distance(foot_a, foot_b) > MAX_FOOT_RATIO * distance(points[a.index()], points[b.index()])
                {
                    between[a.index()] = true;
                    between[b.index()] = true;
                }
            }
        }
    }
    between
}

/// Which vertices are at most `n` cells away from any of `from`. Every ring is a pass over all cells: for the
/// few rings of a layer, this is cheaper than listing the cells of each vertex.
fn within_cells(cells: &Cells, n_points: usize, from: &[VertexId], n: usize) -> Vec<bool> {
    let mut near = vec![false; n_points];
    from.iter().for_each(|v| near[v.index()] = true);
    for _ in 0..n {
        let before = near.clone();
        for (_, kind, vertices) in cells.iter() {
            if vertices.iter().any(|v| before[v.index()]) && kind.dim() == Some(3) {
                vertices.iter().for_each(|v| near[v.index()] = true);
            }
        }
        if near == before {
            break;
        }
    }
    near
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vector::norm;
    use crate::mesh::{Boundary, shapes};

    /// A layer around a sphere in a box, and displacements that bend its walls.
    fn bent_layer() -> (Layer, Vec<Padded>) {
        let mesh = shapes::sphere_in_box(5, 4);
        let boundary = Boundary::of(&mesh.cells);
        let wall = FacetSet::of_boundary(&boundary, "boundary", |_| true);
        let driven = &boundary.vertices;
        let inside = |v: &VertexId| driven.binary_search(v).is_err();
        let candidates: Vec<VertexId> = (0..mesh.points.len()).map(VertexId::new).filter(inside).collect();
        let extent = Extent::Distance(0.6);
        let layer = Layer::new(&mesh.points, &mesh.cells, &wall, extent, &candidates, driven, |_| false);
        let bend =
            |[x, y, z]: Point| Padded::new([0.4 * (y * z).sin(), 0.3 * x * y - z, 0.5 * (2.0 * x).cos()]);
        (layer.unwrap(), driven.iter().map(|v| bend(mesh.points[v.index()])).collect())
    }

    #[test]
    fn offsets_keep_their_lengths() {
        let (layer, driven) = bent_layer();
        let rotations = layer.rotations(&driven, &Threads::single());
        let mut changes = vec![Padded::default(); layer.members.len()];
        layer.rotate_offsets(&rotations, 0, &mut changes);
        for (member, change) in layer.members.iter().zip(&changes) {
            let turned = norm(add(member.offset, change.point()));
            assert!((turned - norm(member.offset)).abs() < 1e-15, "{member:?} {turned}");
            assert!(norm(change.point()) > 0.0);
        }
    }

    #[test]
    fn wide_and_plain_instructions_give_the_same_bits() {
        let (layer, driven) = bent_layer();
        let rotations = &layer.rotations(&driven, &Threads::single());
        let mut wide = vec![Padded::default(); layer.members.len()];
        let mut plain = wide.clone();
        layer.feet(&driven, 0, &mut wide);
        layer.rotate_offsets(rotations, 0, &mut wide);
        let (members, machine) = (&layer.members[..], ());
        Feet::<Plain> { machine, members, driven: &driven, out: &mut plain }.call();
        Offsets::<Plain> { machine, members, rotations, out: &mut plain }.call();
        assert!(wide.iter().zip(&plain).all(|(a, b)| a.is_same(b)));
    }

    #[test]
    fn a_foot_at_a_corner_has_its_weight_first() {
        assert_eq!(from_vertex([7, 8, 9], [1e-16, 1.0, -1e-16]), ([8, 9, 7], [0.0; 2]));
        assert_eq!(from_vertex([7, 8, 9], [0.0, 0.0, 1.0]), ([9, 7, 8], [0.0; 2]));
        assert_eq!(from_vertex([7, 8, 9], [0.5, 0.25, 0.25]), ([7, 8, 9], [0.25; 2]));
    }
}
