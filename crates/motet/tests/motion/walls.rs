//! The graph within its walls: branches and flaps, the same maps as without walls, refusals.

use crate::stepped::{mover, step};
use motet::Mesh;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::distance::segment_triangle::meet;
use motet::geometry::vector::{add, distance};
use motet::mesh::shapes::{box_grid, mixed, quadratic, sphere_in_box};
use motet::mesh::{Boundary, CellKind, Cells};
use motet::motion::{FacetSet, Method, Mover, Options};

fn within(method: Method) -> Options {
    Options { method, within_walls: true, ..Options::default() }
}

/// Where the channels are joined, in grid steps.
const JOINED: f64 = 6.0;

/// Two channels one above the other, joined at one end, with a gap smaller than the edges of their walls:
/// empty, or with cells and two flaps, whose vertices are returned.
fn channels(with_flaps: bool) -> (Mesh, Vec<VertexId>) {
    const HEIGHTS: [f64; 10] = [0.0, 0.5, 0.9, 0.97, 1.0, 1.1, 1.13, 1.2, 1.6, 2.1];
    let grid = box_grid([14, 9, 6], [[0.0; 3], [7.0, 9.0, 3.0]]);
    let place = |[x, y, z]: Point| {
        // The upper channel's vertices are above the middle of the lower one's edges.
        let off = if y > 4.5 { 0.25 * (0.5 * (JOINED - x)).clamp(0.0, 1.0) } else { 0.0 };
        // Vertices inside are not below the vertices of the wall.
        let inner = if [0.0, 4.0, 5.0, 9.0].contains(&y) { 0.0 } else { 0.25 };
        let (along, across) = (inner * x.min(1.0).min(7.0 - x), inner * z.min(1.0).min(3.0 - z));
        [2.0 * (x + off + along), HEIGHTS[y as usize], 2.0 * (z + across)]
    };
    let mut mesh = Mesh::new(grid.points.iter().map(|p| place(*p)).collect(), Cells::new());
    let mut between = Cells::new();
    for (_, tet) in grid.cells.tets() {
        let centre = tet.iter().fold([0.0; 3], |s, v| add(s, grid.points[v.index()])).map(|x| x / 4.0);
        let is_between = centre[0] < JOINED && centre[1] > 4.0 && centre[1] < 5.0;
        if is_between { &mut between } else { &mut mesh.cells }.push(CellKind::TETRA, tet);
    }
    let boundary = Boundary::of(&between);
    let is_flap = |ring: &&[VertexId]| {
        let height = |v: &VertexId| grid.points[v.index()][1];
        ring.iter().all(|v| height(v) == 4.0) || ring.iter().all(|v| height(v) == 5.0)
    };
    let flaps: Vec<Vec<VertexId>> =
        boundary.facets.iter().filter(is_flap).map(<[VertexId]>::to_vec).collect();
    if with_flaps {
        between.tets().for_each(|(_, tet)| mesh.cells.push(CellKind::TETRA, tet));
        flaps.iter().for_each(|ring| mesh.cells.push(CellKind::TRIANGLE, ring.iter().copied()));
    }
    let mut of_flaps = flaps.concat();
    of_flaps.sort_unstable();
    of_flaps.dedup();
    (mesh, of_flaps)
}

fn branches() -> Mesh {
    channels(false).0
}

/// Triangles of the boundary and of patches inside.
fn walls(mesh: &Mesh) -> Vec<[VertexId; 3]> {
    let outer = FacetSet::of_boundary(&Boundary::of(&mesh.cells), "", |_| true);
    let inner = FacetSet::of_cells(mesh, "", |_| true);
    let triangle = |ring: &[VertexId]| [ring[0], ring[1], ring[2]];
    outer.rings.iter().chain(inner.rings.iter()).map(triangle).collect()
}

/// Counts the dependences of vertices on nodes behind a wall.
fn n_through_walls(mesh: &Mesh, mover: &Mover) -> usize {
    let walls = walls(mesh);
    let place = |v: VertexId| mesh.points[v.index()];
    let is_node = |v: VertexId| mover.boundary().binary_search(&v).is_ok();
    let apart = |p: Point, q: Point, t: [Point; 3]| {
        (0..3).any(|k| t.iter().all(|x| x[k] > p[k].max(q[k])) || t.iter().all(|x| x[k] < p[k].min(q[k])))
    };
    let mut n = 0;
    for v in (0..mesh.points.len()).map(VertexId::new).filter(|v| !is_node(*v)) {
        let Some((nodes, weights)) = mover.weights(v) else { continue };
        for (node, _) in nodes.iter().zip(weights).filter(|(_, w)| *w > 1e-9) {
            let crossed = walls.iter().filter(|t| !t.contains(node));
            let (p, q) = (place(v), place(*node));
            n += usize::from(
                crossed.clone().any(|t| !apart(p, q, t.map(place)) && meet([p, q], t.map(place))),
            );
        }
    }
    n
}

#[test]
fn a_branch_that_moves_alone_takes_nothing_of_the_other_along() {
    let mesh = branches();
    // The upper channel bends away, more and more.
    let is_upper = |p: Point| p[0] < 10.0 && p[1] > 1.05;
    let map = |p: Point| if is_upper(p) { [p[0], p[1] + 0.1 * (10.0 - p[0]), p[2]] } else { p };
    let is_lower = |v: &usize| mesh.points[*v][0] < 10.0 && mesh.points[*v][1] < 1.05;
    let n_dragged = |mover: &Mover| {
        let moved = step(mover, map, &Threads::single());
        (0..moved.len()).filter(is_lower).filter(|&v| moved[v] != mesh.points[v]).count()
    };
    let plain = mover(&mesh, &Options::default());
    let dragged = n_dragged(&plain);
    println!(
        "the graph takes {dragged} vertices of the other branch along, {} hang on nodes beyond a wall",
        n_through_walls(&mesh, &plain)
    );
    assert!(dragged > 0, "the branches are near enough to tell");
    let kept = mover(&mesh, &within(Method::Delaunay));
    assert_eq!((n_dragged(&kept), n_through_walls(&mesh, &kept)), (0, 0));
}

#[test]
fn no_vertex_beside_a_flap_follows_its_far_side() {
    let (mesh, of_flaps) = channels(true);
    let options = |within_walls| Options { also_moved: of_flaps.clone(), within_walls, ..Options::default() };
    let [plain, kept] = [false, true].map(|within_walls| mover(&mesh, &options(within_walls)));
    println!(
        "beside the flap {} hang through it, {} where the graph keeps within",
        n_through_walls(&mesh, &plain),
        n_through_walls(&mesh, &kept)
    );
    assert!(n_through_walls(&mesh, &plain) > 0);
    assert_eq!(n_through_walls(&mesh, &kept), 0);
}

#[test]
fn affine_maps_are_affine_within_walls_too() {
    let map =
        |p: Point| [1.1 * p[0] + 0.2 * p[1] + 1.0, 0.9 * p[1] - 0.3 * p[2], 1.2 * p[2] + 0.1 * p[0] - 2.0];
    let curved = quadratic(&sphere_in_box(5, 3));
    for (mesh, name) in [(branches(), "branches"), (mixed(5), "mixed"), (curved, "quadratic")] {
        let moved = step(&mover(&mesh, &within(Method::Delaunay)), map, &Threads::single());
        let off = mesh.points.iter().zip(&moved).map(|(&p, &q)| distance(map(p), q)).fold(0.0, f64::max);
        assert!(off < 1e-10, "{name}: {off:.1e}");
    }
}

#[test]
fn threads_change_nothing_and_other_methods_keep_within_too() {
    let mesh = branches();
    let is_upper = |p: Point| p[0] < 10.0 && p[1] > 1.05;
    let map = |p: Point| if is_upper(p) { [p[0], p[1] + 0.1 * (10.0 - p[0]), p[2]] } else { p };
    let kept = mover(&mesh, &within(Method::Delaunay));
    assert!(step(&kept, map, &Threads::single()) == step(&kept, map, &Threads::new(3).unwrap()));
    let guided = step(&mover(&mesh, &within(Method::Guided)), map, &Threads::single());
    let far = (0..guided.len()).filter(|&v| mesh.points[v][0] < 8.0 && mesh.points[v][1] < 1.05);
    let dragged = far.map(|v| distance(guided[v], mesh.points[v])).fold(0.0, f64::max);
    assert!(dragged < 1e-3, "{dragged}");
}

#[test]
fn walls_that_cross_each_other_are_refused() {
    // Two tets that intersect: the boundary crosses itself.
    let points = vec![
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.2, 0.2, -0.5],
        [0.3, 0.2, 0.5],
        [0.2, 0.3, 0.5],
        [0.9, 0.9, 0.4],
    ];
    let mut cells = Cells::new();
    for tet in [[0, 1, 2, 3], [4, 5, 6, 7]] {
        cells.push(CellKind::TETRA, tet.map(VertexId));
    }
    let mesh = Mesh::new(points, cells);
    let error = Mover::new(&mesh, &within(Method::Delaunay), &Threads::single()).unwrap_err();
    assert!(error.what().contains("within the walls") && error.remedy_text().is_some(), "{}", error.what());
}
