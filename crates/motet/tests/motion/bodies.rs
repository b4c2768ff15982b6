//! Motion carried by rigid bodies: rotations, shifts, several bodies, non-rigid motion, bad input.

use crate::stepped::{mover, n_inverted, step};
use motet::Mesh;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::vector::{add, distance, norm, sub};
use motet::mesh::shapes::{box_grid, sphere_in_box};
use motet::mesh::{Boundary, CellKind, Cells, Field};
use motet::motion::{Elastic, Extent, FacetSet, Method, Mover, Options, Prescribed, RigidLayer, Strain};

fn bodies(sets: Vec<FacetSet>) -> Options {
    Options { method: Method::Bodies(sets), ..Options::default() }
}

fn is_sphere(p: Point) -> bool {
    norm(p) < 1.01
}

fn turned(degrees: f64, shift: Point) -> impl Fn(Point) -> Point {
    let turn = Prescribed::Turn { axis: [1.0, 2.0, -0.5], angle: degrees.to_radians(), centre: [0.0; 3] };
    move |p| if is_sphere(p) { add(turn.apply(p, 1.0), shift) } else { p }
}

/// A box with two holes, each made by removing a box of cells.
fn two_holes() -> (Mesh, [Vec<VertexId>; 2]) {
    let grid = box_grid([15, 8, 8], [[0.0; 3], [15.0, 8.0, 8.0]]);
    let hole = |p: Point| {
        let inside = |low: f64| p[0] > low && p[0] < low + 2.0 && (1..3).all(|i| p[i] > 3.0 && p[i] < 5.0);
        if inside(4.0) {
            Some(0)
        } else if inside(9.0) {
            Some(1)
        } else {
            None
        }
    };
    let mut mesh = Mesh { points: grid.points.clone(), ..Mesh::default() };
    let mut new = vec![None; grid.points.len()];
    mesh.points.clear();
    mesh.cells = Cells::new();
    for (_, tet) in grid.cells.tets() {
        let centre = tet.iter().fold([0.0; 3], |s, v| add(s, grid.points[v.index()])).map(|x| x / 4.0);
        if hole(centre).is_none() {
            let tet = tet.map(|v| {
                *new[v.index()].get_or_insert_with(|| {
                    mesh.points.push(grid.points[v.index()]);
                    VertexId::new(mesh.points.len() - 1)
                })
            });
            mesh.cells.push(CellKind::TETRA, tet);
        }
    }
    let near = |low: f64| {
        let is = |p: Point| p[0] >= low && p[0] <= low + 2.0 && (1..3).all(|i| p[i] >= 3.0 && p[i] <= 5.0);
        let boundary = Boundary::of(&mesh.cells);
        boundary.vertices.into_iter().filter(|v| is(mesh.points[v.index()])).collect()
    };
    let holes = [near(4.0), near(9.0)];
    (mesh, holes)
}

#[test]
fn a_sphere_turns_by_a_right_angle_and_shifts_and_no_cell_inverts() {
    let mesh = sphere_in_box(11, 6);
    let (graph, carried) = (mover(&mesh, &Options::default()), mover(&mesh, &bodies(Vec::new())));
    for (degrees, shift) in [(90.0, [0.0; 3]), (0.0, [2.0, 0.0, 0.0]), (60.0, [1.0, -1.0, 0.5])] {
        let map = turned(degrees, shift);
        let by_bodies = step(&carried, &map, &Threads::single());
        assert_eq!(n_inverted(&mesh, &by_bodies), 0, "{degrees} {shift:?}");
        assert!(by_bodies == step(&carried, &map, &Threads::new(3).unwrap()));
    }
    // The purpose of the method: the graph alone fails here.
    assert!(n_inverted(&mesh, &step(&graph, turned(90.0, [0.0; 3]), &Threads::single())) > 100);
}

#[test]
fn the_way_does_not_matter_and_what_comes_back_is_the_first_mesh_to_the_bit() {
    let mesh = sphere_in_box(8, 5);
    let mut carried = mover(&mesh, &Options { smoothing: 2, ..bodies(Vec::new()) });
    let first = step(&carried, |p| p, &Threads::single());
    let mut last = Vec::new();
    for degrees in [0.0, 20.0, 50.0, 20.0, 0.0] {
        let map = turned(degrees, [0.4, 0.0, 0.0].map(|x| x * degrees));
        let displacement: Vec<Point> =
            carried.boundary().iter().map(|v| mesh.points[v.index()]).map(|p| sub(map(p), p)).collect();
        last = mesh.points.clone();
        carried.advance(&displacement, &mut last, &Threads::single()).unwrap();
    }
    assert!(last == first);
}

#[test]
fn what_is_not_rigid_is_left_to_the_graph() {
    let mesh = sphere_in_box(8, 5);
    let (graph, carried) = (mover(&mesh, &Options::default()), mover(&mesh, &bodies(Vec::new())));
    // The sphere swells, and the box is compressed: neither is a rigid motion of the sphere.
    let map = |p: Point| if is_sphere(p) { p.map(|x| 1.3 * x) } else { [p[0], p[1], 0.8 * p[2]] };
    let [a, b] = [&graph, &carried].map(|mover| step(mover, map, &Threads::single()));
    let apart = a.iter().zip(&b).map(|(p, q)| distance(*p, *q)).fold(0.0, f64::max);
    assert!(apart < 1e-12, "{apart}");
}

#[test]
fn bodies_that_move_alike_take_along_what_is_between_them() {
    let (mesh, holes) = two_holes();
    assert!(holes.iter().all(|hole| hole.len() == 26));
    let carried = mover(&mesh, &bodies(Vec::new()));
    let is_hole = |p: Point| holes.iter().flatten().any(|v| mesh.points[v.index()] == p);
    let shifted =
        step(&carried, |p| if is_hole(p) { [p[0], p[1] + 0.5, p[2]] } else { p }, &Threads::single());
    let between: Vec<usize> = (0..mesh.points.len())
        .filter(|&v| mesh.points[v] == [7.0, 4.0, 4.0] || mesh.points[v] == [8.0, 4.0, 4.0])
        .collect();
    assert_eq!(between.len(), 2);
    for v in between {
        let moved = shifted[v][1] - mesh.points[v][1];
        assert!(moved > 0.4 && moved < 0.5 + 1e-9, "{moved}");
    }
    // Each by itself: one rotates, one shifts.
    let turn = Prescribed::Turn { axis: [1.0, 0.0, 0.0], angle: 0.8, centre: [5.0, 4.0, 4.0] };
    let map = |p: Point| match () {
        () if is_hole(p) && p[0] < 7.5 => turn.apply(p, 1.0),
        () if is_hole(p) => [p[0] + 1.0, p[1], p[2]],
        () => p,
    };
    let moved = step(&carried, map, &Threads::single());
    assert_eq!(n_inverted(&mesh, &moved), 0);
}

#[test]
fn a_rigid_layer_turns_with_its_body() {
    let mesh = sphere_in_box(11, 6);
    let sphere = FacetSet::of_boundary(&Boundary::of(&mesh.cells), "sphere", |i| {
        let boundary = Boundary::of(&mesh.cells);
        boundary.facets.list(i).iter().all(|v| is_sphere(mesh.points[v.index()]))
    });
    let layer = RigidLayer { extent: Extent::Cells(1), wall: Some(sphere.clone()) };
    let options = Options { rigid_layer: Some(layer), ..bodies(vec![sphere]) };
    let moved = step(&mover(&mesh, &options), turned(90.0, [0.5, 0.0, 0.0]), &Threads::single());
    assert_eq!(n_inverted(&mesh, &moved), 0);
}

/// A box with a smaller box inside whose tets are a region of their own, the vertices between the two, and
/// whether a place belongs to the smaller one.
fn solid_in_fluid() -> (Mesh, Vec<VertexId>, impl Fn(Point) -> bool) {
    let is_solid = |p: Point| (0..3).all(|k| p[k].abs() < 1.01 - 0.25 * k as f64);
    let mut mesh = box_grid([16; 3], [[-2.0; 3], [2.0; 3]]);
    let middle = |vertices: &[VertexId]| {
        let sum = vertices.iter().fold([0.0; 3], |sum, v| add(sum, mesh.points[v.index()]));
        sum.map(|x| x / vertices.len() as f64)
    };
    let regions: Vec<i32> =
        mesh.cells.iter().map(|(_, _, vertices)| 1 + i32::from(is_solid(middle(vertices)))).collect();
    let mut is_of = vec![[false; 2]; mesh.points.len()];
    for (cell, tet) in mesh.cells.tets() {
        tet.iter().for_each(|v| is_of[v.index()][regions[cell.index()] as usize - 1] = true);
    }
    let between = (0..is_of.len()).filter(|&v| is_of[v] == [true; 2]).map(VertexId::new).collect();
    mesh.set_cell_field(Field::scalars("region", regions));
    (mesh, between, is_solid)
}

#[test]
fn an_interface_that_is_moved_is_a_body_and_what_it_encloses_goes_along_rigidly() {
    let (mesh, between, is_solid) = solid_in_fluid();
    let turn = Prescribed::Turn { axis: [1.0, 2.0, -0.5], angle: 0.3, centre: [0.1, 0.0, 0.0] };
    let named = FacetSet { name: "solid".into(), vertices: between.clone(), ..FacetSet::default() };
    for (sets, strain) in
        [(Vec::new(), Strain::Even), (Vec::new(), Strain::Band), (vec![named], Strain::Band)]
    {
        let options = Options { also_moved: between.clone(), strain, ..bodies(sets) };
        let moved = step(
            &mover(&mesh, &options),
            |p| if is_solid(p) { turn.apply(p, 1.0) } else { p },
            &Threads::single(),
        );
        assert_eq!(n_inverted(&mesh, &moved), 0);
        let solid = mesh.points.iter().zip(&moved).filter(|(p, _)| is_solid(**p));
        assert!(solid.clone().count() > 2 * between.len() / 3);
        // With even strain, shares come from an iterative solution.
        let nearly = if strain == Strain::Even { 1e-6 } else { 1e-12 };
        solid.for_each(|(&p, &q)| assert!(distance(q, turn.apply(p, 1.0)) < nearly, "{strain:?}"));
    }
}

#[test]
fn what_is_no_body_is_refused() {
    let mesh = sphere_in_box(5, 3);
    let boundary = Boundary::of(&mesh.cells);
    let refused = |sets: Vec<FacetSet>, mesh: &Mesh| {
        let error = Mover::new(mesh, &bodies(sets), &Threads::single()).unwrap_err();
        assert!(error.remedy_text().is_some());
        error.what().to_string()
    };
    let all = FacetSet::of_boundary(&boundary, "all", |_| true);
    assert!(refused(vec![all.clone(), all], &mesh).contains("share vertex"));
    assert!(
        refused(vec![FacetSet { name: "none".into(), ..FacetSet::default() }], &mesh)
            .contains("has 0 vertices")
    );
    let whole = box_grid([2, 2, 2], [[0.0; 3], [1.0; 3]]);
    assert!(refused(Vec::new(), &whole).contains("all walls are connected"));
    let inside: Vec<VertexId> = (0..mesh.points.len())
        .map(VertexId::new)
        .filter(|v| boundary.vertices.binary_search(v).is_err())
        .take(3)
        .collect();
    let inner = FacetSet { name: "inner".into(), vertices: inside, ..FacetSet::default() };
    assert!(refused(vec![inner], &mesh).contains("an interior vertex"));
}

#[test]
fn after_a_thousand_cycles_the_mesh_is_the_first_one_to_the_bit() {
    let mesh = sphere_in_box(5, 3);
    let methods = [Method::Delaunay, Method::Bodies(Vec::new()), Method::Guided];
    let graphs = methods.into_iter().flat_map(|m| [(m.clone(), false), (m, true)]);
    // With a factor that is kept, a system does not depend on the step before, either.
    let elastic = Method::Elastic(Elastic { factor_bytes: 1 << 26, ..Elastic::default() });
    for (method, within_walls) in graphs.chain([(elastic, false)]) {
        let options = Options { smoothing: 2, within_walls, method, ..Options::default() };
        let mut mover = mover(&mesh, &options);
        let at = |mover: &mut Mover, phase: f64| {
            let map = turned(20.0 * phase.sin(), [0.8 * phase.sin(), 0.4 * (1.0 - phase.cos()), 0.0]);
            let place = |v: &VertexId| mesh.points[v.index()];
            let displacement: Vec<Point> =
                mover.boundary().iter().map(place).map(|p| sub(map(p), p)).collect();
            let mut out = mesh.points.clone();
            assert!(mover.advance(&displacement, &mut out, &Threads::single()).unwrap().substeps == 0);
            out
        };
        let phases = [0.0, 1.0, 2.5, 4.5].map(|k: f64| k * std::f64::consts::PI / 3.0);
        let first = phases.map(|phase| at(&mut mover, phase));
        assert!(first[1] != first[0]);
        for cycle in 1..=1000 {
            // All of the last cycle; of the others, only the farthest place and the first.
            let looked_at = if cycle == 1000 { 0..4 } else { 2..4 };
            for k in looked_at {
                assert!(at(&mut mover, phases[k]) == first[k], "cycle {cycle}, {options:?}");
            }
        }
    }
}
