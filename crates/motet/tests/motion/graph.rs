//! Mesh motion: affine maps, periodic walls, rigid layers, sliding patches, sub-steps, bad input.

use crate::common::data_meshes;
use crate::stepped::mover;
use motet::Mesh;
use motet::base::{Csr, Point, Threads, VertexId};
use motet::geometry::vector::{add, distance, norm, scale, sub};
use motet::mesh::{BAD_EAS, Boundary, CellKind, Cells, shapes};
use motet::motion::{Extent, FacetSet, Mover, Options, PointMover, Prescribed, RigidLayer, mesh_velocity};
use proptest::prelude::*;

// ---------------------------------------------------------------- meshes

/// A grid of `n^3` cubes of side 1, without those for which `is_hole` holds, each cut into cells of one kind;
/// inner points are displaced a little, those of holes are not.
fn grid(n: usize, kind: CellKind, is_hole: impl Fn([usize; 3]) -> bool) -> Mesh {
    let m = n + 1;
    let id = |i: usize, j: usize, k: usize| VertexId::new(i + m * (j + m * k));
    let mut points: Vec<Point> = (0..m * m * m)
        .map(|v| {
            let at = [v % m, v / m % m, v / m / m];
            let wobble = |axis: usize| 0.08 * ((v * (axis + 2) * 37 % 101) as f64 / 50.0 - 1.0);
            let is_inner = at.iter().all(|&i| i > 0 && i < n);
            let cubes = (0..8).map(|c| [0, 1, 2].map(|axis| at[axis].wrapping_sub(c >> axis & 1)));
            let is_free = is_inner && !cubes.into_iter().any(&is_hole);
            [0, 1, 2].map(|axis| at[axis] as f64 + if is_free { wobble(axis) } else { 0.0 })
        })
        .collect();
    let mut cells = Cells::new();
    for c in 0..n * n * n {
        let [i, j, k] = [c % n, c / n % n, c / n / n];
        if is_hole([i, j, k]) {
            continue;
        }
        let cube = [
            id(i, j, k),
            id(i + 1, j, k),
            id(i + 1, j + 1, k),
            id(i, j + 1, k),
            id(i, j, k + 1),
            id(i + 1, j, k + 1),
            id(i + 1, j + 1, k + 1),
            id(i, j + 1, k + 1),
        ];
        cut(&mut points, &mut cells, cube, kind);
    }
    let used: std::collections::BTreeSet<VertexId> = cells.connectivity().items().iter().copied().collect();
    let old: Vec<VertexId> = used.into_iter().collect();
    let new = |v: VertexId| VertexId::new(old.binary_search(&v).unwrap());
    let mut compact = Cells::new();
    let mut polyhedron = 0;
    for (_, kind, vertices) in cells.iter() {
        let vertices = vertices.iter().map(|&v| new(v));
        if kind == CellKind::POLYHEDRON {
            let mut faces = Csr::default();
            cells.polyhedron_faces()[polyhedron].iter().for_each(|f| faces.push(f.iter().map(|&v| new(v))));
            compact.push_polyhedron(vertices, faces);
            polyhedron += 1;
        } else {
            compact.push(kind, vertices);
        }
    }
    let mesh = Mesh::new(old.iter().map(|v| points[v.index()]).collect(), compact);
    mesh.validate().unwrap();
    mesh
}

fn solid(n: usize, kind: CellKind) -> Mesh {
    grid(n, kind, |_| false)
}

/// A box with a cubic hole: `n` cells along each side, `hole` of them hollow in the middle.
fn hollow(n: usize, hole: usize, kind: CellKind) -> Mesh {
    let inner = (n - hole) / 2..(n + hole) / 2;
    grid(n, kind, |at| at.iter().all(|i| inner.contains(i)))
}

const KUHN: [[usize; 4]; 6] =
    [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]];
const QUADS: [[usize; 4]; 6] =
    [[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]];

fn cut(points: &mut Vec<Point>, cells: &mut Cells, cube: [VertexId; 8], kind: CellKind) {
    let pick = |places: &[usize]| places.iter().map(|&i| cube[i]).collect::<Vec<_>>();
    match kind {
        CellKind::TETRA => KUHN.iter().for_each(|t| cells.push(kind, pick(t))),
        CellKind::HEXAHEDRON => cells.push(kind, cube),
        CellKind::VOXEL => cells.push(kind, pick(&[0, 1, 3, 2, 4, 5, 7, 6])),
        CellKind::WEDGE => {
            cells.push(kind, pick(&[0, 1, 2, 4, 5, 6]));
            cells.push(kind, pick(&[0, 2, 3, 4, 6, 7]));
        }
        CellKind::PYRAMID => {
            let centre = cube.iter().fold([0.0; 3], |s, v| add(s, scale(points[v.index()], 0.125)));
            points.push(centre);
            let tip = VertexId::new(points.len() - 1);
            for [a, b, c, d] in QUADS {
                cells.push(kind, [cube[a], cube[d], cube[c], cube[b], tip].map(|v| v));
            }
        }
        CellKind::POLYHEDRON => {
            let mut faces = Csr::default();
            QUADS.iter().for_each(|q| faces.push(pick(q)));
            cells.push_polyhedron(cube, faces);
        }
        CellKind::QUADRATIC_TETRA => {
            for t in KUHN {
                let mut vertices = pick(&t);
                for [i, j] in [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]] {
                    let middle = scale(add(points[vertices[i].index()], points[vertices[j].index()]), 0.5);
                    let known = points.iter().rposition(|p| *p == middle);
                    vertices.push(VertexId::new(known.unwrap_or_else(|| {
                        points.push(middle);
                        points.len() - 1
                    })));
                }
                cells.push(kind, vertices);
            }
        }
        other => panic!("no cut into {other:?}"),
    }
}

const KINDS: [CellKind; 7] = [
    CellKind::TETRA,
    CellKind::HEXAHEDRON,
    CellKind::VOXEL,
    CellKind::WEDGE,
    CellKind::PYRAMID,
    CellKind::POLYHEDRON,
    CellKind::QUADRATIC_TETRA,
];

fn diagonal(mesh: &Mesh) -> f64 {
    let [low, high] = mesh.bounds().unwrap();
    distance(low, high)
}

/// Moves the mesh in one step, with `displacement` of every driven vertex.
fn step(mover: &Mover, displacement: impl Fn(Point) -> Point) -> Vec<Point> {
    let driven: Vec<Point> =
        mover.boundary().iter().map(|v| displacement(mover.reference()[v.index()])).collect();
    let mut out = vec![[f64::NAN; 3]; mover.reference().len()];
    mover.step(&driven, &mut out, &Threads::single()).unwrap();
    out
}

fn bits(points: &[Point]) -> Vec<[u64; 3]> {
    points.iter().map(|p| p.map(f64::to_bits)).collect()
}

// ---------------------------------------------------------------- the step

fn affine(rows: [[f64; 4]; 3]) -> impl Fn(Point) -> Point {
    let map = Prescribed::Affine(rows);
    move |p| map.displacement(p, 1.0)
}

/// The largest distance of any vertex from its image under the affine map.
fn affine_error(mesh: &Mesh, rows: [[f64; 4]; 3]) -> f64 {
    let mover = mover(mesh, &Options::default());
    let moved = step(&mover, affine(rows));
    let expected = mesh.points.iter().map(|&p| Prescribed::Affine(rows).apply(p, 1.0));
    moved.iter().zip(expected).map(|(&p, q)| distance(p, q)).fold(0.0, f64::max)
}

const NEAR_IDENTITY: [[f64; 4]; 3] =
    [[1.13, 0.21, -0.08, 0.7], [-0.11, 0.92, 0.17, -1.3], [0.05, -0.24, 1.07, 0.2]];

#[test]
fn affine_maps_are_exact_in_cells_of_every_kind() {
    for kind in KINDS {
        let mesh = solid(4, kind);
        let error = affine_error(&mesh, NEAR_IDENTITY);
        assert!(error < 1e-13 * diagonal(&mesh), "{kind:?}: {error:e}");
    }
}

#[test]
fn affine_maps_are_exact_around_a_hole() {
    let mesh = hollow(8, 2, CellKind::TETRA);
    assert!(affine_error(&mesh, NEAR_IDENTITY) < 1e-13 * diagonal(&mesh));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(20) })]
    #[test]
    fn any_affine_map_is_exact(rows in prop::array::uniform3(prop::array::uniform4(-0.5..0.5f64))) {
        let mesh = hollow(5, 1, CellKind::TETRA);
        let mut rows = rows;
        (0..3).for_each(|i| rows[i][i] += 1.0);
        prop_assert!(affine_error(&mesh, rows) < 1e-13 * diagonal(&mesh));
    }
}

fn wave(phase: f64) -> impl Fn(Point) -> Point {
    move |p| {
        let s = 0.1 * phase.sin();
        [s * (p[1] * 0.7).sin(), s * (p[2] + p[0]).cos(), s * (p[0] * p[1] * 0.2).sin()]
    }
}

#[test]
fn boundary_vertices_go_exactly_where_they_are_reported() {
    let mesh = hollow(6, 2, CellKind::TETRA);
    let mover = mover(&mesh, &Options::default());
    let moved = step(&mover, wave(1.0));
    for v in mover.boundary() {
        let p = mesh.points[v.index()];
        assert_eq!(moved[v.index()], add(p, wave(1.0)(p)));
    }
    assert_eq!(mover.boundary(), Boundary::of(&mesh.cells).vertices);
}

#[test]
fn a_periodic_wall_gives_a_periodic_mesh_to_the_bit() {
    let mesh = hollow(6, 2, CellKind::TETRA);
    for options in [Options::default(), layer(Extent::Cells(1), None)] {
        let mover = mover(&mesh, &options);
        let first = bits(&step(&mover, wave(0.3)));
        step(&mover, wave(1.7));
        assert_eq!(bits(&step(&mover, wave(0.3))), first);
    }
    let mover = mover(&mesh, &Options::default());
    assert_eq!(bits(&step(&mover, |_| [0.0; 3])), bits(&mesh.points), "what does not move stays to the bit");
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let mesh = grid(22, CellKind::TETRA, |at| at.iter().all(|i| (9..13).contains(i)));
    let options = layer(Extent::Distance(1.2), None);
    for options in [Options::default(), options] {
        let all: Vec<_> = [1, 2, 3]
            .map(|n| {
                let threads = Threads::new(n).unwrap();
                let mut mover = Mover::new(&mesh, &options, &threads).unwrap();
                let driven: Vec<Point> =
                    mover.boundary().iter().map(|v| wave(1.2)(mesh.points[v.index()])).collect();
                let mut out = vec![[0.0; 3]; mesh.points.len()];
                mover.step(&driven, &mut out, &threads).unwrap();
                let stepped = bits(&out);
                let certificate = mover.advance(&driven, &mut out, &threads).unwrap();
                (stepped, bits(&out), certificate.quality)
            })
            .into();
        assert_eq!(all[0], all[1]);
        assert_eq!(all[0], all[2]);
    }
}

#[test]
fn every_vertex_hangs_on_four_nodes_whose_mean_it_is() {
    for kind in KINDS {
        let mesh = hollow(5, 1, kind);
        let mover = mover(&mesh, &Options::default());
        let (mut n, mut n_driven) = (0, 0);
        for v in (0..mesh.points.len()).map(VertexId::new) {
            let Some((nodes, weights)) = mover.weights(v) else {
                n_driven += usize::from(mover.boundary().binary_search(&v).is_ok());
                continue;
            };
            n += 1;
            assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)), "{weights:?}");
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            let mean = (0..4).fold([0.0; 3], |s, i| add(s, scale(mesh.points[nodes[i].index()], weights[i])));
            assert!(distance(mean, mesh.points[v.index()]) < 1e-12 * diagonal(&mesh), "vertex {v}");
        }
        // Middle nodes of straight edges follow their corners.
        assert_eq!(n_driven, mover.boundary().len());
        assert_eq!(n + n_driven + mover.setup().middles, mesh.points.len());
        assert_eq!(n, mover.setup().hanging);
    }
}

#[test]
fn affine_maps_are_exact_on_every_mesh_of_the_data() {
    for (name, mesh) in data_meshes() {
        let size = diagonal(&mesh);
        let shift = [0.3, -0.2, 0.1].map(|x| x * size);
        let rows =
            [0, 1, 2].map(|i| [0, 1, 2, 3].map(|j| if j < 3 { NEAR_IDENTITY[i][j] } else { shift[i] }));
        let error = affine_error(&mesh, rows) / size;
        println!("{name}: {error:.1e} of the box");
        assert!(error < 1e-12, "{name}: {error:e}");
    }
}

#[test]
fn weights_reproduce_every_vertex_of_the_data() {
    for (name, mesh) in data_meshes() {
        let mover = mover(&mesh, &Options::default());
        let size = diagonal(&mesh);
        for v in (0..mesh.points.len()).map(VertexId::new) {
            let Some((nodes, weights)) = mover.weights(v) else { continue };
            assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)), "{name} {weights:?}");
            let mean = (0..4).fold([0.0; 3], |s, i| add(s, scale(mesh.points[nodes[i].index()], weights[i])));
            assert!(distance(mean, mesh.points[v.index()]) < 1e-12 * size, "{name} vertex {v}");
        }
        assert_eq!(mover.setup().outside, 0, "{name}");
    }
}

// ---------------------------------------------------------------- the sphere in the box

fn is_sphere(p: &Point) -> bool {
    norm(*p) < 1.01
}

#[test]
fn a_sphere_in_a_box_goes_two_radii_in_one_step_and_three_in_several() {
    let mesh = motet::mesh::shapes::sphere_in_box(15, 7);
    for travel in [0.5, 1.0, 2.0, 3.0] {
        let mut mover = mover(&mesh, &Options::default());
        let reported =
            |v: &VertexId| [if is_sphere(&mesh.points[v.index()]) { travel } else { 0.0 }, 0.0, 0.0];
        let driven: Vec<Point> = mover.boundary().iter().map(reported).collect();
        let mut out = mesh.points.clone();
        let certificate = mover.advance(&driven, &mut out, &Threads::single()).unwrap();
        assert_eq!(certificate.inverted, 0, "{travel}");
        assert!(certificate.quality.worst_eas.unwrap().value > 0.0);
        if travel <= 2.0 {
            assert!(certificate.complete && certificate.substeps == 0, "{travel}: {certificate:?}");
        } else {
            assert!(certificate.fraction >= certificate.admissible_fraction);
        }
    }
}

#[test]
fn a_rigid_layer_around_the_sphere_keeps_its_cells() {
    let mesh = motet::mesh::shapes::sphere_in_box(8, 6);
    let patch = mesh.patches().unwrap().find("sphere").unwrap();
    let sphere = FacetSet::of_patch(&mesh, patch);
    assert!(sphere.vertices.iter().all(|v| is_sphere(&mesh.points[v.index()])));
    let mover = mover(&mesh, &layer(Extent::Cells(1), Some(sphere)));
    let turn = Prescribed::Turn { axis: [1.0, 1.0, 0.0], angle: 0.4, centre: [0.0; 3] };
    let moved = step(&mover, |p| if is_sphere(&p) { turn.displacement(p, 1.0) } else { [0.0; 3] });
    let n = mover.setup().layer;
    assert_eq!(n, 6 * 8 * 8 + 2, "one shell");
    let rigid = moved.iter().zip(&mesh.points).filter(|(m, p)| distance(**m, turn.apply(**p, 1.0)) < 1e-14);
    assert!(rigid.count() >= 2 * n);
}

#[test]
fn mixed_cells_and_quadratic_tets_move_affinely_too() {
    let ball = motet::mesh::shapes::ball(3, 3);
    for mesh in [motet::mesh::shapes::mixed(4), motet::mesh::shapes::quadratic(&ball)] {
        assert!(affine_error(&mesh, NEAR_IDENTITY) < 1e-13 * diagonal(&mesh));
    }
}

#[test]
fn prisms_at_a_pulsating_wall_keep_their_thickness() {
    use motet::mesh::shapes::{TubeOptions, WallCells, tube};
    for wall_cells in [WallCells::Tets, WallCells::Wedges] {
        let mesh = tube(&TubeOptions { wall_layers: 3, wall_cells, ..TubeOptions::default() });
        let [low, high] = mesh.bounds().unwrap();
        let radius = high[0];
        let set = |name: &str| FacetSet::of_patch(&mesh, mesh.patches().unwrap().find(name).unwrap());
        let options = Options {
            sliding: vec![set("inlet"), set("outlet")],
            ..layer(Extent::Cells(3), Some(set("wall")))
        };
        let mover = mover(&mesh, &options);
        let wall = set("wall").vertices;
        let is_wall = |v: &VertexId| wall.binary_search(v).is_ok();
        let driven: Vec<Point> = (mover.boundary().iter())
            .map(|v| (mesh.points[v.index()], is_wall(v)))
            .map(|(p, moves)| if moves { [0.2 * p[0], 0.2 * p[1], 0.0] } else { [0.0; 3] })
            .collect();
        let mut out = mesh.points.clone();
        mover.step(&driven, &mut out, &Threads::single()).unwrap();
        let r = |p: Point| p[0].hypot(p[1]);
        let mut n = 0;
        for (p, q) in mesh.points.iter().zip(&out) {
            if [low[2], high[2]].contains(&p[2]) {
                assert_eq!(p[2], q[2], "it leaves the plane of its end");
            }
            // The first ring of vertices inside the wall.
            let depth = radius - r(*p);
            if depth > 1e-9 && depth < 0.015 * radius {
                n += 1;
                let after = 1.2 * radius - r(*q);
                // The facets are chords: the depth beneath them is less than that of the cylinder.
                assert!((after - depth).abs() < 0.01 * depth, "{p:?} {q:?}: {depth} {after}");
            }
        }
        assert!(n > 0);
    }
}

// ---------------------------------------------------------------- what is no plain boundary

#[test]
fn vertices_of_an_interface_inside_are_moved_on_request() {
    let mesh = solid(6, CellKind::TETRA);
    let is_middle = |p: &Point| (p[2] - 3.0).abs() < 0.2;
    let middle: Vec<VertexId> =
        (0..mesh.points.len()).filter(|&v| is_middle(&mesh.points[v])).map(VertexId::new).collect();
    let mover = mover(&mesh, &Options { also_moved: middle.clone(), ..Options::default() });
    let lift = |p: Point| if is_middle(&p) && p[0] > 0.0 && p[0] < 6.0 { [0.0, 0.0, 0.2] } else { [0.0; 3] };
    let moved = step(&mover, lift);
    for v in middle {
        assert!(mover.boundary().binary_search(&v).is_ok());
        assert_eq!(moved[v.index()], add(mesh.points[v.index()], lift(mesh.points[v.index()])));
    }
}

#[test]
fn two_sides_of_a_slit_go_their_own_ways() {
    let mut mesh = solid(4, CellKind::TETRA);
    // The plane z = 2 away from the rim is doubled: cells above it use the copies.
    let mut copies = std::collections::HashMap::new();
    for v in 0..mesh.points.len() {
        let p = mesh.points[v];
        if (p[2] - 2.0).abs() < 0.2 && p[..2].iter().all(|&x| x > 0.5 && x < 3.5) {
            copies.insert(VertexId::new(v), VertexId::new(mesh.points.len()));
            mesh.points.push(p);
        }
    }
    let centre_z = |t: &[VertexId]| t.iter().map(|v| mesh.points[v.index()][2]).sum::<f64>() / 4.0;
    let mut cells = Cells::new();
    for (_, kind, t) in mesh.cells.iter() {
        let above = centre_z(t) > 2.1;
        cells.push(kind, t.iter().map(|v| if above { *copies.get(v).unwrap_or(v) } else { *v }));
    }
    mesh.cells = cells;
    let mover = mover(&mesh, &Options::default());
    let driven: Vec<Point> = (mover.boundary().iter())
        .map(|v| match (copies.contains_key(v), copies.values().any(|c| c == v)) {
            (true, _) => [0.0, 0.0, -0.1],
            (_, true) => [0.0, 0.0, 0.1],
            _ => [0.0; 3],
        })
        .collect();
    let mut out = mesh.points.clone();
    mover.step(&driven, &mut out, &Threads::single()).unwrap();
    for (lower, upper) in copies {
        let gap = out[upper.index()][2] - out[lower.index()][2];
        assert!((gap - 0.2).abs() < 1e-15);
    }
}

#[test]
fn vertices_of_no_cell_follow_inside_and_stay_outside() {
    let mut mesh = solid(3, CellKind::TETRA);
    let n = mesh.points.len();
    mesh.points.extend([[1.3, 1.4, 1.6], [10.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0]]);
    let mover = mover(&mesh, &Options::default());
    let moved = step(&mover, |_| [0.0, 0.5, 0.0]);
    assert!(distance(moved[n], [1.3, 1.9, 1.6]) < 1e-15);
    assert_eq!(moved[n + 1], [10.0, 0.0, 0.0]);
    assert!(moved[n + 2][0].is_nan());
    assert_eq!(mover.setup().left, 2);
}

// ---------------------------------------------------------------- rigid layer, sliding

fn layer(extent: Extent, wall: Option<FacetSet>) -> Options {
    Options { rigid_layer: Some(RigidLayer { extent, wall }), ..Options::default() }
}

/// The part of the boundary of a hollow box that belongs to the hole.
fn hole_of(mesh: &Mesh) -> FacetSet {
    let [low, high] = mesh.bounds().unwrap();
    let boundary = Boundary::of(&mesh.cells);
    let on_hull = |v: &VertexId| (0..3).any(|i| [low[i], high[i]].contains(&mesh.points[v.index()][i]));
    FacetSet::of_boundary(&boundary, "hole", |i| !boundary.facets.list(i).iter().all(on_hull))
}

#[test]
fn a_rigid_layer_moves_rigidly_with_a_wall_that_does() {
    for kind in [CellKind::TETRA, CellKind::HEXAHEDRON, CellKind::WEDGE, CellKind::POLYHEDRON] {
        let mesh = hollow(9, 3, kind);
        let hole = hole_of(&mesh);
        let mover = mover(&mesh, &layer(Extent::Cells(1), Some(hole.clone())));
        let turn = Prescribed::Turn { axis: [0.2, 0.3, 1.0], angle: 0.3, centre: [4.5, 4.5, 4.5] };
        let is_hole = |p: Point| hole.vertices.iter().any(|v| mesh.points[v.index()] == p);
        let moved = step(&mover, |p| if is_hole(p) { turn.displacement(p, 1.0) } else { [0.0; 3] });
        // The layer has every vertex of a cell that touches the hole, and no other.
        let mut in_layer = vec![false; mesh.points.len()];
        for (_, _, vertices) in mesh.cells.iter() {
            if vertices.iter().any(|v| hole.vertices.binary_search(v).is_ok()) {
                vertices.iter().for_each(|v| in_layer[v.index()] = true);
            }
        }
        for v in (0..mesh.points.len()).filter(|&v| in_layer[v]) {
            let expected = turn.apply(mesh.points[v], 1.0);
            assert!(distance(moved[v], expected) < 1e-13, "{kind:?} vertex {v}");
        }
        assert_eq!(mover.setup().layer, in_layer.iter().filter(|&&b| b).count() - hole.vertices.len());
        assert!(mover.setup().graph_nodes > mover.boundary().len());
    }
}

#[test]
fn a_layer_by_distance_holds_the_vertices_within_it_and_keeps_their_distance() {
    let mesh = hollow(10, 2, CellKind::TETRA);
    let mover = mover(&mesh, &layer(Extent::Distance(1.25), Some(hole_of(&mesh))));
    let bulge = |p: Point| {
        let r = sub(p, [5.0, 5.0, 5.0]);
        if norm(r) < 2.0 { scale(r, 0.2) } else { [0.0; 3] }
    };
    let moved = step(&mover, bulge);
    let wall_distance = |p: Point, half: f64| {
        let q = sub(p, [5.0, 5.0, 5.0]).map(|x| (x.abs() - half).max(0.0));
        norm(q)
    };
    let mut n = 0;
    for (p, q) in mesh.points.iter().zip(&moved) {
        let before = wall_distance(*p, 1.0);
        if before > 0.0 && before <= 1.25 {
            n += 1;
            assert!((wall_distance(*q, 1.2) - before).abs() < 1e-13, "{p:?} {q:?}");
        }
    }
    assert_eq!(n, mover.setup().layer);
}

/// A square tube along z as a grid of `n x n x m`; its sides are the wall, its ends are open.
fn tube_ends(mesh: &Mesh) -> [FacetSet; 2] {
    let [low, high] = mesh.bounds().unwrap();
    let boundary = Boundary::of(&mesh.cells);
    [(low, "inlet"), (high, "outlet")].map(|(corner, name)| {
        let in_plane = |v: &VertexId| mesh.points[v.index()][2] == corner[2];
        FacetSet::of_boundary(&boundary, name, |i| boundary.facets.list(i).iter().all(in_plane))
    })
}

#[test]
fn ends_slide_in_their_planes_with_a_wall_that_widens() {
    let mesh = solid(6, CellKind::TETRA);
    let ends = tube_ends(&mesh);
    let on_wall = |p: Point| p[..2].iter().any(|&x| x == 0.0 || x == 6.0);
    let widen = |p: Point| if on_wall(p) { [0.2 * (p[0] - 3.0), 0.2 * (p[1] - 3.0), 0.0] } else { [1e59; 3] };
    let mut options = Options { sliding: ends.to_vec(), ..Options::default() };
    let moved = step(&mover(&mesh, &options), widen);
    for end in &ends {
        for v in end.vertices.iter().map(|v| v.index()) {
            let p = mesh.points[v];
            let expected = [p[0] + 0.2 * (p[0] - 3.0), p[1] + 0.2 * (p[1] - 3.0), p[2]];
            assert!(distance(moved[v], expected) < 1e-14, "{:?} {expected:?}", moved[v]);
            assert_eq!(moved[v][2], p[2], "it leaves its plane");
        }
    }
    // With a layer one cell thick, the first vertices inside move with the wall, in the plane.
    options.rigid_layer = Some(RigidLayer { extent: Extent::Distance(1.0), wall: None });
    let mover = mover(&mesh, &options);
    let moved = step(&mover, widen);
    for v in ends[0].vertices.iter().map(|v| v.index()) {
        let [x, y, z] = mesh.points[v];
        assert_eq!(moved[v][2], z);
        if x == 1.0 && y > 1.0 && y < 5.0 {
            assert!((moved[v][0] - (0.4)).abs() < 1e-14, "{:?}", moved[v]);
        }
    }
    assert_eq!(mover.setup().sliding, 2 * 25);
}

#[test]
fn what_is_not_flat_does_not_slide() {
    let mut mesh = solid(4, CellKind::TETRA);
    let ends = tube_ends(&mesh);
    let middle = ends[0].vertices.iter().find(|v| mesh.points[v.index()][..2] == [2.0, 2.0]).unwrap();
    mesh.points[middle.index()][2] = -0.5;
    let options = Options { sliding: ends.to_vec(), ..Options::default() };
    let error = Mover::new(&mesh, &options, &Threads::single()).unwrap_err().to_string();
    assert!(error.starts_with("sliding patch inlet: is not flat"), "{error}");
}

// ---------------------------------------------------------------- sub-steps

fn push_hole(mover: &mut Mover, hole: &FacetSet, by: f64, out: &mut [Point]) -> motet::motion::Certificate {
    let reported =
        |v: &VertexId| if hole.vertices.binary_search(v).is_ok() { [by, 0.0, 0.0] } else { [0.0; 3] };
    let driven: Vec<Point> = mover.boundary().iter().map(reported).collect();
    mover.advance(&driven, out, &Threads::single()).unwrap()
}

#[test]
fn a_motion_that_fits_is_done_in_one_step_and_certified() {
    let mesh = hollow(8, 2, CellKind::TETRA);
    let (hole, mut mover) = (hole_of(&mesh), mover(&mesh, &Options::default()));
    let mut out = mesh.points.clone();
    let certificate = push_hole(&mut mover, &hole, 0.5, &mut out);
    assert!(certificate.complete && certificate.substeps == 0 && certificate.fraction == 1.0);
    assert_eq!(certificate.inverted, 0);
    let driven: Vec<Point> = (mover.boundary().iter())
        .map(|v| [if hole.vertices.binary_search(v).is_ok() { 0.5 } else { 0.0 }, 0.0, 0.0])
        .collect();
    let mut stepped = mesh.points.clone();
    mover.step(&driven, &mut stepped, &Threads::single()).unwrap();
    assert_eq!(bits(&out), bits(&stepped));
    // The worst tet, by brute force.
    let quality = |t: [VertexId; 4]| motet::geometry::quality::eas(t.map(|v| out[v.index()]));
    let worst = mesh.cells.tets().map(|(id, t)| (quality(t), id)).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    let reported = certificate.quality.worst_eas.unwrap();
    assert_eq!((reported.value, reported.cell), worst);
    let bad = mesh.cells.tets().filter(|(_, t)| quality(*t) < BAD_EAS).count();
    assert_eq!(certificate.quality.bad, bad);
}

#[test]
fn pushed_through_a_wall_it_stops_before_it_and_says_how_far_it_got() {
    let mesh = hollow(8, 2, CellKind::TETRA);
    let (hole, mut mover) = (hole_of(&mesh), mover(&mesh, &Options::default()));
    let mut out = mesh.points.clone();
    // The hole is 3 from the wall.
    let certificate = push_hole(&mut mover, &hole, 4.0, &mut out);
    assert!(!certificate.complete);
    assert!(certificate.substeps > 1);
    assert!(certificate.fraction >= certificate.admissible_fraction);
    assert!(certificate.fraction > 0.3 && certificate.fraction < 0.75, "{}", certificate.fraction);
    assert_eq!(certificate.inverted, 0);
    assert!(!certificate.blocked_by.is_empty());
    // The mesh is where the certificate says.
    for v in &hole.vertices {
        let removed = sub(out[v.index()], mesh.points[v.index()]);
        assert!(distance(removed, [4.0 * certificate.fraction, 0.0, 0.0]) < 1e-12);
    }
    // And the way back is free: all of it, in one step, to the initial bits.
    let back = push_hole(&mut mover, &hole, 0.0, &mut out);
    assert!(back.complete && back.substeps == 0);
    assert_eq!(bits(&out), bits(&mesh.points));
}

#[test]
fn cells_inverted_from_the_start_are_reported_but_stop_nothing() {
    let mut mesh = hollow(8, 2, CellKind::TETRA);
    // One inner vertex far off: the tets around it are partly inverted.
    let inner = (0..mesh.points.len()).find(|&v| distance(mesh.points[v], [1.0, 1.0, 1.0]) < 0.2).unwrap();
    mesh.points[inner] = [2.3, 1.4, 1.2];
    let (hole, mut mover) = (hole_of(&mesh), mover(&mesh, &Options::default()));
    let mut out = mesh.points.clone();
    let certificate = push_hole(&mut mover, &hole, 0.25, &mut out);
    assert!(certificate.inverted_before > 0);
    assert!(certificate.complete);
    let back = push_hole(&mut mover, &hole, 0.0, &mut out);
    assert_eq!(back.inverted, back.inverted_before);
}

#[test]
fn cells_of_other_kinds_are_checked_at_their_corners() {
    for kind in KINDS {
        let mesh = hollow(6, 2, kind);
        let (hole, mut mover) = (hole_of(&mesh), mover(&mesh, &Options::default()));
        let mut out = mesh.points.clone();
        let near = push_hole(&mut mover, &hole, 0.3, &mut out);
        assert!(near.complete && near.inverted == 0 && near.inverted_before == 0, "{kind:?} {near:?}");
        let is_tet = kind == CellKind::TETRA;
        assert_eq!(near.quality.worst_eas.is_some(), is_tet);
        assert_eq!(near.quality.worst_scaled_jacobian.is_some(), !is_tet);
        let far = push_hole(&mut mover, &hole, 9.0, &mut out);
        assert!(!far.complete && far.inverted == 0, "{kind:?}");
    }
}

#[test]
fn the_certificate_is_plain_json() {
    let mesh = hollow(6, 2, CellKind::TETRA);
    let (hole, mut mover) = (hole_of(&mesh), mover(&mesh, &Options::default()));
    let mut out = mesh.points.clone();
    let certificate = push_hole(&mut mover, &hole, 0.3, &mut out);
    let json = serde_json::to_value(&certificate).unwrap();
    assert_eq!(json["complete"], true);
    assert_eq!(json["inverted"], 0);
    assert!(json["worst_eas"]["cell"].is_u64() && json["worst_eas"]["place"].is_array());
    assert!(json["seconds"]["total"].as_f64().unwrap() > 0.0);
}

// ---------------------------------------------------------------- velocity, bad input

#[test]
fn the_velocity_is_the_way_over_the_time() {
    let v = mesh_velocity(&[[0.0; 3], [1.0, 2.0, 3.0]], &[[0.5, 0.0, 0.0], [1.0, 2.0, 2.0]], 0.25).unwrap();
    assert_eq!(v, [[2.0, 0.0, 0.0], [0.0, 0.0, -4.0]]);
    assert!(mesh_velocity(&[[0.0; 3]], &[[0.0; 3]], 0.0).is_err());
    assert!(mesh_velocity(&[[0.0; 3]], &[[0.0; 3]], f64::NAN).is_err());
    assert!(mesh_velocity(&[[0.0; 3]], &[], 1.0).is_err());
}

fn refused(mesh: &Mesh, options: &Options) -> String {
    Mover::new(mesh, options, &Threads::single()).unwrap_err().to_string()
}

#[test]
fn what_cannot_be_moved_is_refused_with_a_reason() {
    let surface = Mesh::new(
        vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        Cells::uniform(CellKind::TRIANGLE, [0, 1, 2].map(VertexId).to_vec()).unwrap(),
    );
    assert!(refused(&surface, &Options::default()).starts_with("volume cells are needed"));
    assert!(refused(&Mesh::default(), &Options::default()).starts_with("volume cells are needed"));

    let mut mesh = solid(2, CellKind::TETRA);
    mesh.points[5][1] = f64::INFINITY;
    assert!(refused(&mesh, &Options::default()).starts_with("vertex 5: has coordinates that are not finite"));

    let mut flat = solid(2, CellKind::TETRA);
    flat.points.iter_mut().for_each(|p| p[2] = 0.0);
    assert!(refused(&flat, &Options::default()).contains("in one plane"));

    let mesh = solid(2, CellKind::TETRA);
    let beyond = Options { also_moved: vec![VertexId(99)], ..Options::default() };
    assert!(refused(&mesh, &beyond).contains("vertex 99"));
    let no_wall = layer(Extent::Cells(1), Some(FacetSet { name: "wal".into(), ..FacetSet::default() }));
    assert!(refused(&mesh, &no_wall).contains("the wall wal"));

    let mover = mover(&mesh, &Options::default());
    let mut out = mesh.points.clone();
    assert!(mover.step(&[[0.0; 3]], &mut out, &Threads::single()).is_err());
    let mut driven = vec![[0.0; 3]; mover.boundary().len()];
    assert!(mover.step(&driven, &mut out[1..], &Threads::single()).is_err());
    driven[3][2] = f64::NAN;
    let error = mover.step(&driven, &mut out, &Threads::single()).unwrap_err().to_string();
    assert!(error.contains("not finite"), "{error}");
}

#[test]
fn a_patch_may_hold_a_lagrange_cell_of_any_length() {
    let mut mesh = solid(2, CellKind::TETRA);
    let first = mesh.cells.len();
    mesh.cells.push(CellKind::LAGRANGE_TRIANGLE, [0].map(VertexId));
    mesh.cells.push(CellKind::LAGRANGE_TRIANGLE, [0, 1, 3, 9, 10, 12].map(VertexId));
    let set = FacetSet::of_cells(&mesh, "patch", |cell| cell >= first);
    assert_eq!(set.rings.iter().map(<[_]>::len).collect::<Vec<_>>(), [1, 3]);
    assert_eq!(set.vertices, [0, 1, 3, 9, 10, 12].map(VertexId));
}

#[test]
fn cells_whose_facets_are_not_known_are_refused() {
    let mut mesh = motet::mesh::shapes::box_grid([2, 2, 2], [[0.0; 3], [1.0; 3]]);
    mesh.cells.push(motet::mesh::CellKind::LAGRANGE_TETRAHEDRON, (0..10).map(motet::base::VertexId));
    mesh.cell_data.clear();
    let error =
        motet::motion::Mover::new(&mesh, &Default::default(), &motet::base::Threads::single()).unwrap_err();
    assert!(error.to_string().starts_with("1 volume cells are of an unsupported kind"), "{error}");
}

#[test]
fn points_follow_nodes_as_vertices_follow_the_boundary() {
    let mesh = shapes::sphere_in_box(8, 4);
    let threads = Threads::single();
    let mover = Mover::new(&mesh, &Options::default(), &threads).unwrap();
    let nodes: Vec<Point> = mover.boundary().iter().map(|v| mesh.points[v.index()]).collect();
    let displacement: Vec<Point> = nodes.iter().map(|p| [0.1 * p[1], p[0] * p[2] / 50.0, -0.2]).collect();
    let mut expected = mesh.points.clone();
    mover.step(&displacement, &mut expected, &threads).unwrap();
    let step = |nodes: &[Point], displacement: &[Point]| {
        let points = PointMover::new(nodes, &mesh.points, &threads).unwrap();
        let mut out = mesh.points.clone();
        points.step(displacement, &mut out, &threads).unwrap();
        out
    };
    // Given in reverse order, and half of them twice, nodes make the same graph: a process that has them in
    // another order gets the same bits.
    let first = step(&nodes, &displacement);
    let turned =
        |list: &[Point]| list.iter().rev().chain(&list[..list.len() / 2]).copied().collect::<Vec<_>>();
    assert_eq!(step(&turned(&nodes), &turned(&displacement)), first);
    // The boundary goes where it is driven, and an affine motion moves everything by the same map, whatever
    // the graph.
    for (v, d) in mover.boundary().iter().zip(&displacement) {
        let expected = add(mesh.points[v.index()], *d);
        assert!(distance(first[v.index()], expected) < 1e-14);
    }
    let affine: Vec<Point> = nodes.iter().map(|p| [0.1 * p[1], 0.3 - p[0], 2.0 * p[2]]).collect();
    for (p, q) in mesh.points.iter().zip(step(&nodes, &affine)) {
        assert!(distance(q, [p[0] + 0.1 * p[1], p[1] + 0.3 - p[0], 3.0 * p[2]]) < 1e-12);
    }
}

#[test]
fn points_and_nodes_that_do_not_fit_are_reported() {
    let threads = Threads::single();
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mover = PointMover::new(&corners, &[[0.1; 3]], &threads).unwrap();
    let refused = |n: usize, d: f64, m: usize| {
        mover.step(&vec![[d; 3]; n], &mut vec![[0.0; 3]; m], &threads).unwrap_err().to_string()
    };
    assert!(refused(3, 0.0, 1).contains("3 displacements"));
    assert!(refused(4, 0.0, 2).contains("2 places"));
    assert!(refused(4, f64::NAN, 1).contains("displacement 0"));
    assert!(PointMover::new(&corners[..3], &[[0.1; 3]], &threads).is_err());
    assert!(PointMover::new(&corners, &[[f64::INFINITY; 3]], &threads).is_err());
    assert_eq!(PointMover::new(&corners, &[[9.0; 3]], &threads).unwrap().n_outside(), 1);
}
