//! The input surface, and how far the mesh's surface may stray from it.
//!
//! Every patch has a search tree over its input triangles. A change of walls is accepted if each new or moved
//! wall lies within the allowed distance of its own patch, sampled at its corners, the midpoints of its edges
//! and its centroid, and faces the same way as the triangle below it; and if the place that a vertex leaves
//! lies as near to the new walls.

use std::collections::BTreeMap;

use crate::base::{Point, TetId, Threads, VertexId};
use crate::geometry::segment;
use crate::geometry::tet::FACETS;
use crate::geometry::triangle::{area_vector, closest};
use crate::geometry::vector::{add, distance, dot, norm, scale, sub};
use crate::kernel::{
    Behind, Change, Complex, FLATTEST, HalfFacet, Hold, NewWall, Shell, Star, VertexChange, Wall,
};
use crate::ops::Track;
use crate::remesh::lines::FirstLines;
use crate::spatial::NearestTriangle;

/// Walls that meet at a sharper angle than this form a feature: the cosine of the angle between their
/// normals.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) struct Crease(f64);

impl Crease {
    /// 30 degrees.
    pub(super) const SHARP: Self = Self(0.866);
    /// 60 degrees, for where [`Self::SHARP`] leaves bad tets: creases that are only a coarse image of
    /// something curved may change within the allowed distance.
    pub(super) const BLUNT: Self = Self(0.5);
    /// No angle is a feature; borders of patches still are.
    pub(super) const NONE: Self = Self(-2.0);
}

/// A feature runs straight through a vertex if it bends by less than this: cosine of 45 degrees.
const STRAIGHT: f64 = 0.707;
/// How far a new wall may be rotated from the triangle it lies on: cosine of 45 degrees.
const TURNED: f64 = 0.707;

/// The walls of the first mesh, patch by patch.
pub(super) struct Surface {
    patches: BTreeMap<i32, Patch>,
    lines: FirstLines,
    distance: f64,
    crease: Crease,
    /// Which vertices of the first mesh were fixed before features were searched for.
    is_fixed: Vec<bool>,
}

struct Patch {
    tree: NearestTriangle,
    /// Normals of the triangles; in a patch with tets on one side only, they point away from the tets.
    normals: Vec<Point>,
    /// Whether every wall of the patch has tets on one side only.
    is_boundary: bool,
}

impl Surface {
    /// The surface of a complex that nothing has changed yet; its walls may stray by up to `distance`.
    pub(super) fn of(complex: &Complex, distance: f64) -> Self {
        let mut triangles: BTreeMap<i32, (Vec<[VertexId; 3]>, bool)> = BTreeMap::new();
        for (_, wall) in complex.walls() {
            let (triangles, is_boundary) = triangles.entry(wall.patch).or_insert_with(|| (Vec::new(), true));
            triangles.push(complex.facet(wall.sides[0]));
            *is_boundary &= wall.sides[1].is_none();
        }
        let points: Vec<Point> =
            (0..complex.n_vertex_slots()).map(|v| complex.point(VertexId::new(v))).collect();
        let patch = |(triangles, is_boundary): (Vec<[VertexId; 3]>, bool)| Patch {
            is_boundary,
            normals: triangles.iter().map(|t| area_vector(t.map(|v| points[v.index()]))).collect(),
            tree: NearestTriangle::new(&points, &triangles, &Threads::single()),
        };
        let is_fixed = (0..points.len()).map(|v| complex.hold(VertexId::new(v)) == Hold::Fixed).collect();
        let patches = triangles.into_iter().map(|(id, t)| (id, patch(t))).collect();
        Self { patches, lines: FirstLines::of(complex), distance, crease: Crease::SHARP, is_fixed }
    }

    /// Whether the walls and lines that a change inserts or moves stay near the surface and the lines of the
    /// first mesh.
    pub(super) fn accepts(&self, complex: &Complex, change: &Change) -> bool {
        let moved = match change.vertex {
            VertexChange::Move(v, _) if complex.hold(v) != Hold::Free => Some(v),
            _ => None,
        };
        if change.walls.is_empty() && change.lines.is_empty() && moved.is_none() {
            return true;
        }
        // Refused even if the tets were as flat before.
        if change.worst() < FLATTEST {
            return false;
        }
        let corners = |wall: &NewWall| change.corners(complex, facing_out(complex, change, wall.vertices));
        let mut walls: Vec<(i32, [Point; 3])> =
            change.walls.iter().map(|wall| (wall.patch, corners(wall))).collect();
        if let Some(moved) = moved {
            let of_moved = walls_of(complex, &change.cavity).into_iter();
            let of_moved = of_moved.map(|(wall, vertices)| (wall.patch, vertices));
            let of_moved = of_moved.filter(|(_, vertices)| vertices.contains(&moved));
            walls.extend(of_moved.map(|(patch, vertices)| (patch, change.corners(complex, vertices))));
        }
        walls.iter().all(|&(patch, triangle)| self.lies_on(patch, triangle))
            && (walls.is_empty() || self.covers(complex, change, &walls))
            && self.lines.accepts(complex, change, self.distance)
    }

    /// Whether an edge may be split at its midpoint: walls stay where they are, and only flat tets are
    /// refused. Halves of a wall that is already at the allowed distance would fail [`Self::accepts`], which
    /// samples them at other points; the edge would then stay as long as it is.
    pub(super) fn accepts_in_place(&self, change: &Change) -> bool {
        change.walls.is_empty() || change.worst() >= FLATTEST
    }

    /// The point of a patch, as it was at first, that is closest to `point`; `None` if there is no such
    /// patch.
    pub(super) fn on_patch(&self, patch: i32, point: Point) -> Option<Point> {
        self.patches.get(&patch)?.tree.closest(point).map(|found| found.point)
    }

    fn lies_on(&self, patch: i32, triangle: [Point; 3]) -> bool {
        let Some(patch) = self.patches.get(&patch) else { return false };
        let normal = area_vector(triangle);
        let [a, b, c] = triangle;
        let middle = |p: Point, q: Point| scale(add(p, q), 0.5);
        let centre = scale(add(add(a, b), c), 1.0 / 3.0);
        let near = |p: Point| patch.tree.closest_within(p, self.distance);
        let Some(below) = near(centre) else { return false };
        let facing = patch.normals[below.triangle];
        let cosine = dot(normal, facing) / (norm(normal) * norm(facing));
        // Walls between tets have no side of their own: either orientation is fine. A wall of the boundary
        // that faces the other way is folded over others.
        let cosine = if patch.is_boundary { cosine } else { cosine.abs() };
        (cosine > TURNED || self.crease == Crease::NONE)
            && [a, b, c, middle(a, b), middle(b, c), middle(c, a)].into_iter().all(|p| near(p).is_some())
    }

    /// Whether the place that a vertex leaves lies near the new walls.
    fn covers(&self, complex: &Complex, change: &Change, walls: &[(i32, [Point; 3])]) -> bool {
        let left = match change.vertex {
            VertexChange::Move(v, _) | VertexChange::Remove(v) => complex.point(v),
            _ => return true,
        };
        walls.iter().any(|&(_, triangle)| {
            let foot = crate::geometry::triangle::at(triangle, closest(triangle, left));
            norm(sub(foot, left)) <= self.distance
        })
    }
}

/// The vertices of a new wall, ordered so that it faces away from the tet that will be on it: a tet of the
/// fill, or the tet behind the cavity that the change exposes. A wall with two tets faces away from one of
/// them.
fn facing_out(complex: &Complex, change: &Change, wall: [VertexId; 3]) -> [VertexId; 3] {
    let facet_of = |tet: [VertexId; 4]| {
        let apex = (0..4).find(|&i| !wall.contains(&tet[i]))?;
        wall.iter().all(|v| tet.contains(v)).then(|| FACETS[apex].map(|i| tet[i]))
    };
    let in_fill = change.fill.iter().find_map(|tet| facet_of(tet.vertices));
    let exposed = || change.cavity.iter().find_map(|&tet| facet_of(complex.vertices(tet)));
    in_fill.or_else(|| exposed().map(|[a, b, c]| [a, c, b])).unwrap_or(wall)
}

/// The walls of some tets, each once, with their vertices.
fn walls_of<'a>(complex: &'a Complex, tets: &[TetId]) -> Vec<(&'a Wall, [VertexId; 3])> {
    let mut walls = Vec::new();
    for half in tets.iter().flat_map(|&t| (0..4).map(move |i| HalfFacet::new(t, i))) {
        if let Behind::Wall(id) = complex.behind(half.tet(), half.facet()) {
            walls.push((id, half));
        }
    }
    walls.sort_unstable();
    walls.dedup_by_key(|wall| wall.0);
    walls.into_iter().map(|(id, half)| (complex.wall(id), complex.facet(half))).collect()
}

/// Where a vertex that the surface may constrain can move.
pub(super) enum SurfaceTrack<'a> {
    /// Anywhere.
    Anywhere,
    /// Along a patch; its normal at the vertex is given.
    Patch(&'a NearestTriangle, Point),
    /// Along a feature, as far as its next vertices; the points are the previous vertex, the vertex itself
    /// and the next one.
    Feature([Point; 3]),
}

impl Track for SurfaceTrack<'_> {
    fn draw(&self, point: Point) -> Option<Point> {
        match self {
            Self::Anywhere => Some(point),
            Self::Patch(tree, _) => tree.closest(point).map(|found| found.point),
            &Self::Feature([before, at, behind]) => {
                let feet = [before, behind].map(|end| {
                    let foot = add(at, scale(sub(end, at), segment::closest([at, end], point)));
                    (distance(point, foot), foot)
                });
                feet.into_iter().min_by(|x, y| x.0.total_cmp(&y.0)).map(|foot| foot.1)
            }
        }
    }

    fn along(&self, direction: Point) -> Point {
        match *self {
            Self::Anywhere => direction,
            Self::Patch(_, normal) => sub(direction, onto(direction, normal)),
            Self::Feature([before, _, behind]) => onto(direction, sub(behind, before)),
        }
    }
}

/// The component of a direction along another.
fn onto(direction: Point, way: Point) -> Point {
    let length = dot(way, way);
    if length > 0.0 { scale(way, dot(direction, way) / length) } else { [0.0; 3] }
}

impl Surface {
    /// Where a vertex on the surface or on a feature may move; `star` holds its tets. `None` if it has to
    /// stay.
    pub(super) fn track(
        &self,
        complex: &Complex,
        star: &[TetId],
        vertex: VertexId,
        shell: &mut Shell,
    ) -> Option<SurfaceTrack<'_>> {
        let mut walls = walls_of(complex, star);
        walls.retain(|(_, vertices)| vertices.contains(&vertex));
        if complex.hold(vertex) == Hold::Surface {
            let patch = walls.first()?.0.patch;
            let is_one = walls.iter().all(|wall| wall.0.patch == patch);
            let tree = &self.patches.get(&patch).filter(|_| is_one)?.tree;
            return Some(SurfaceTrack::Patch(tree, mean_normal(complex, &walls)));
        }
        let mut others: Vec<(VertexId, TetId)> = Vec::new();
        for (wall, vertices) in walls {
            others.extend(vertices.into_iter().filter(|&v| v != vertex).map(|v| (v, wall.sides[0].tet())));
        }
        others.extend(complex.line_neighbors(star, vertex).into_iter().filter_map(|v| {
            let tet = star.iter().find(|&&t| complex.vertices(t).contains(&v))?;
            Some((v, *tet))
        }));
        others.sort_unstable();
        others.dedup_by_key(|other| other.0);
        others.retain(|&(other, tet)| {
            shell.walk(complex, tet, vertex, other);
            !self.is_smooth(complex, [vertex, other], shell)
        });
        match others[..] {
            [(a, _), (b, _)] => Some(SurfaceTrack::Feature([a, vertex, b].map(|v| complex.point(v)))),
            _ => None,
        }
    }
}

/// The mean normal of some walls, weighted by area; its sign is arbitrary.
fn mean_normal(complex: &Complex, walls: &[(&Wall, [VertexId; 3])]) -> Point {
    let mut sum = [0.0; 3];
    for (_, vertices) in walls {
        let normal = area_vector(vertices.map(|v| complex.point(v)));
        // Walls have no side of their own: each is flipped to agree with those before.
        sum = if dot(sum, normal) < 0.0 { sub(sum, normal) } else { add(sum, normal) };
    }
    sum
}

impl Surface {
    /// Whether the walls at an edge are a smooth part of one patch, and the edge is not a line.
    pub(super) fn is_smooth(&self, complex: &Complex, [a, b]: [VertexId; 2], shell: &Shell) -> bool {
        let [i, j] = shell.walls[..] else { return false };
        if complex.line(a, b).is_some() {
            return false;
        }
        let [first, second] = [i, j].map(|place| complex.wall(shell.wall_at(complex, place)));
        let [p, q] = [i, j].map(|place| complex.point(shell.ring[place]));
        let [a, b] = [a, b].map(|v| complex.point(v));
        // Oriented so that they agree where the surface is flat.
        let (m, n) = (area_vector([a, b, p]), area_vector([b, a, q]));
        first.patch == second.patch && dot(m, n) > self.crease.0 * norm(m) * norm(n)
    }

    /// Finds features and corners, where walls meet at a sharper angle than `crease` or where lines run, and
    /// constrains the vertices on them.
    pub(super) fn constrain_features(&mut self, complex: &mut Complex, crease: Crease) {
        self.crease = crease;
        for v in (0..complex.n_vertex_slots()).map(VertexId::new) {
            let is_fixed = self.is_fixed.get(v.index()).copied().unwrap_or(false);
            if complex.hold(v) > Hold::Surface && !is_fixed {
                complex.set_hold(v, Hold::Surface);
            }
        }
        let mut edges: Vec<([VertexId; 2], Point, i32, VertexId)> = Vec::new();
        for (_, wall) in complex.walls() {
            let [a, b, c] = complex.facet(wall.sides[0]);
            let normal = area_vector([a, b, c].map(|v| complex.point(v)));
            for (edge, third) in [([a, b], c), ([b, c], a), ([c, a], b)] {
                edges.push(([edge[0].min(edge[1]), edge[0].max(edge[1])], normal, wall.patch, third));
            }
        }
        edges.sort_unstable_by_key(|edge| (edge.0, edge.3));
        let mut features: Vec<([VertexId; 2], Option<u32>)> = Vec::new();
        for walls in edges.chunk_by(|x, y| x.0 == y.0) {
            let [a, b] = walls[0].0;
            let is_smooth = match walls {
                [x, y] => {
                    let [m, n] = [x.3, y.3].map(|third| area_vector([a, b, third].map(|v| complex.point(v))));
                    x.2 == y.2 && -dot(m, n) > self.crease.0 * norm(m) * norm(n)
                }
                _ => false,
            };
            if !is_smooth && complex.line(a, b).is_none() {
                features.push(([a, b], None));
            }
        }
        let lines = complex.lines().into_iter();
        features.extend(lines.map(|(edge, line)| (edge, Some(complex.line_label(line.source)))));
        // The directions in which features leave each vertex.
        let mut ways: Vec<(VertexId, Point, Option<u32>)> = Vec::new();
        for ([a, b], label) in features {
            let way = sub(complex.point(b), complex.point(a));
            let way = scale(way, 1.0 / norm(way));
            ways.push((a, way, label));
            ways.push((b, scale(way, -1.0), label));
        }
        ways.sort_by_key(|way| way.0);
        for of_vertex in ways.chunk_by(|x, y| x.0 == y.0) {
            let hold = match of_vertex {
                [(_, x, of), (_, y, other)] if of == other && -dot(*x, *y) > STRAIGHT => Hold::Edge,
                _ => Hold::Fixed,
            };
            let vertex = of_vertex[0].0;
            complex.set_hold(vertex, complex.hold(vertex).max(hold));
        }
        fix_touching(complex);
    }
}

/// Fixes vertices at which parts of the mesh touch without sharing a facet.
fn fix_touching(complex: &mut Complex) {
    let mut star = Star::default();
    for v in (0..complex.n_vertex_slots()).map(VertexId::new) {
        if matches!(complex.hold(v), Hold::Surface | Hold::Edge) && !complex.is_one_star(v, &mut star) {
            complex.set_hold(v, Hold::Fixed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes::box_grid;
    use crate::mesh::{TetMesh, TetPart};

    /// The cube from (0, 0, 0) to (1, 1, 1) and, if `both`, the one from there to (2, 2, 2), which shares one
    /// vertex with it. All walls are of one patch.
    fn cubes(both: bool) -> TetMesh {
        let mut mesh = TetPart::of(&box_grid([2; 3], [[0.0; 3], [1.0; 3]])).unwrap().mesh;
        mesh.patches.fill(1);
        let n = mesh.points.len();
        let place =
            |mesh: &TetMesh, at: Point| VertexId::new(mesh.points.iter().position(|p| *p == at).unwrap());
        let [low, high] = [place(&mesh, [0.0; 3]), place(&mesh, [1.0; 3])];
        if both {
            let second = |v: VertexId| if v == low { high } else { VertexId::new(n + v.index()) };
            mesh.points.extend(mesh.points.clone().into_iter().map(|p| p.map(|x| x + 1.0)));
            mesh.tets.extend(mesh.tets.clone().into_iter().map(|t| t.map(second)));
            mesh.triangles.extend(mesh.triangles.clone().into_iter().map(|t| t.map(second)));
            mesh.patches.extend(mesh.patches.clone());
            mesh.regions.extend(mesh.regions.clone());
        }
        mesh
    }

    #[test]
    fn a_vertex_where_parts_touch_stays_even_where_nothing_is_a_feature() {
        for both in [false, true] {
            let mesh = cubes(both);
            let mut complex = Complex::new(&mesh).unwrap();
            complex.adapt_surface();
            Surface::of(&complex, 0.1).constrain_features(&mut complex, Crease::NONE);
            // The vertex that the second cube has in place of the shared one has no tets.
            let used =
                complex.tets().flat_map(|t| complex.vertices(t)).collect::<std::collections::BTreeSet<_>>();
            let held: Vec<Point> = used
                .into_iter()
                .filter(|v| complex.hold(*v) == Hold::Fixed)
                .map(|v| complex.point(v))
                .collect();
            assert_eq!(held, if both { vec![[1.0; 3]] } else { Vec::new() });
        }
    }
}
