//! Motion of quadratic meshes: straight edges stay straight, curved cells are judged inside, by every method.

use motet::Mesh;
use motet::base::{Names, Point, Threads, VertexId};
use motet::geometry::vector::{add, cross, distance, dot, norm, scale, sub};
use motet::mesh::shapes::{box_grid, quadratic, sphere_in_box};
use motet::mesh::{Boundary, CellKind, Cells};
use motet::motion::{
    Certificate, Elastic, Extent, FacetSet, Laplace, Method, Mover, Options, Prescribed, RigidLayer,
    mesh_velocity,
};

const TET_EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// The space between a box and a sphere of radius 1, of quadratic tets whose middle nodes on the sphere are
/// on it.
fn curved_sphere() -> Mesh {
    let linear = sphere_in_box(4, 3);
    let mut mesh = quadratic(&linear);
    for &v in &Boundary::of(&mesh.cells).vertices {
        let p = &mut mesh.points[v.index()];
        if norm(*p) < 1.01 {
            *p = scale(*p, 1.0 / norm(*p));
        }
    }
    mesh
}

fn methods() -> Vec<Method> {
    vec![
        Method::Delaunay,
        Method::Bodies(Vec::new()),
        Method::Guided,
        Method::Elastic(Elastic::default()),
        Method::Laplace(Laplace::default()),
        Method::InverseDistance,
        Method::Radial,
    ]
}

/// The least `det J` of a quadratic tet over a grid of places, by definition.
fn sampled(nodes: &[Point]) -> f64 {
    let n = 8;
    let mut least = f64::INFINITY;
    for i in 0..=n {
        for j in 0..=n - i {
            for k in 0..=n - i - j {
                let l = [n - i - j - k, i, j, k].map(|x| x as f64 / n as f64);
                let by = |c: usize| {
                    let middle = TET_EDGES.iter().enumerate().map(|(m, &[a, b])| {
                        let other = if a == c {
                            l[b]
                        } else if b == c {
                            l[a]
                        } else {
                            0.0
                        };
                        scale(nodes[4 + m], 4.0 * other)
                    });
                    middle.fold(scale(nodes[c], 4.0 * l[c] - 1.0), add)
                };
                let [a, b, c] = [1, 2, 3].map(|c| sub(by(c), by(0)));
                least = least.min(dot(cross(a, b), c));
            }
        }
    }
    least
}

fn nodes(mesh: &Mesh, points: &[Point]) -> Vec<Vec<Point>> {
    let cells = mesh.cells.iter().filter(|(_, kind, _)| *kind == CellKind::QUADRATIC_TETRA);
    cells.map(|(_, _, nodes)| nodes.iter().map(|v| points[v.index()]).collect()).collect()
}

fn is_sphere(p: Point) -> bool {
    norm(p) < 1.01
}

fn driven(mover: &Mover, map: impl Fn(Point) -> Point) -> Vec<Point> {
    let places = mover.boundary().iter().map(|v| mover.reference()[v.index()]);
    places.map(|p| if is_sphere(p) { sub(map(p), p) } else { [0.0; 3] }).collect()
}

fn advance(mover: &mut Mover, displacement: &[Point]) -> (Vec<Point>, Certificate) {
    let mut out = mover.reference().to_vec();
    let certificate = mover.advance(displacement, &mut out, &Threads::single()).unwrap();
    (out, certificate)
}

/// The largest distance of a middle node of an inner edge from the midpoint of its ends.
fn off_the_middle(mesh: &Mesh, points: &[Point]) -> f64 {
    let on_boundary = Boundary::of(&mesh.cells).vertices;
    let mut most: f64 = 0.0;
    for (_, kind, nodes) in mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3)) {
        let edges = TET_EDGES.iter().enumerate().filter(|_| kind == CellKind::QUADRATIC_TETRA);
        for (m, [a, b]) in edges.filter(|(m, _)| on_boundary.binary_search(&nodes[4 + m]).is_err()) {
            let [p, q, r] = [nodes[*a], nodes[*b], nodes[4 + m]].map(|v| points[v.index()]);
            most = most.max(distance(r, scale(add(p, q), 0.5)));
        }
    }
    most
}

#[test]
fn straight_edges_inside_stay_straight_by_every_method() {
    let mesh = curved_sphere();
    assert!(off_the_middle(&mesh, &mesh.points) < 1e-14);
    let turn = Prescribed::Turn { axis: [1.0, 1.0, 0.0], angle: 0.35, centre: [0.0; 3] };
    let map = |p: Point| add(turn.apply(p, 1.0), [0.5, 0.2, 0.0]);
    for method in methods() {
        let name = method.name();
        let options = Options { method, ..Options::default() };
        let mut mover =
            Mover::new(&mesh, &options, &Threads::single()).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(mover.setup().middles > 0 && mover.setup().left == 0, "{name}");
        let displacement = driven(&mover, map);
        let (out, certificate) = advance(&mut mover, &displacement);
        assert!(certificate.complete && certificate.inverted == 0, "{name}");
        assert!(off_the_middle(&mesh, &out) < 1e-13, "{name}");
        for (v, d) in mover.boundary().iter().zip(&displacement) {
            assert_eq!(
                out[v.index()],
                add(mesh.points[v.index()], *d),
                "{name}: where its displacement puts it"
            );
        }
        let least = nodes(&mesh, &out).iter().map(|nodes| sampled(nodes)).fold(f64::INFINITY, f64::min);
        assert!(least > 0.0, "{name}: {least}");
        assert!(certificate.quality.worst_curved_jacobian.unwrap().value > 0.0);
        // Velocities of middle nodes are consistent, too: each is the mean of those of the ends.
        let velocity = mesh_velocity(&mesh.points, &out, 0.25).unwrap();
        let moved: Vec<Point> =
            mesh.points.iter().zip(&velocity).map(|(&p, &v)| add(p, scale(v, 0.25))).collect();
        assert!(off_the_middle(&mesh, &moved) < 1e-12, "{name}");
        // And the way back restores the initial bits, except where iterations start from the last solution.
        let back = driven(&mover, |p| p);
        let (out, _) = advance(&mut mover, &back);
        assert!(matches!(name.as_str(), "elastic" | "laplace") || out == mesh.points, "{name}");
    }
}

/// Even if shifted far, rotated and written in `f32`, edges are recognised as straight within the larger
/// rounding.
#[test]
fn straight_edges_are_found_within_the_rounding_of_their_coordinates() {
    let sizes =
        [(1.0, 0.0, false), (1.0, 1e3, true), (1e-3, 0.0, true), (1e3, 0.0, false), (1e-3, 1.0, false)];
    for (size, shift, is_single) in sizes {
        let mut mesh = curved_sphere();
        let (sin, cos) = 0.4f64.sin_cos();
        let n = Mover::new(&mesh, &Options::default(), &Threads::single()).unwrap().setup().middles;
        for p in &mut mesh.points {
            *p = [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1], p[2]].map(|x| size * x + shift);
            if is_single {
                *p = p.map(|x| f64::from(x as f32));
            }
        }
        let mover = Mover::new(&mesh, &Options::default(), &Threads::single()).unwrap();
        assert_eq!(mover.setup().middles, n, "{size} {shift}");
    }
}

/// Including sub-steps, the motion stops before a quadratic cell folds, though no corner moves.
#[test]
fn a_motion_stops_before_a_cell_folds_between_its_corners() {
    let mesh = quadratic(&box_grid([2; 3], [[0.0; 3], [2.0; 3]]));
    let mut mover = Mover::new(&mesh, &Options::default(), &Threads::single()).unwrap();
    // The middle node of an edge on the face z = 2 is pushed through its cells.
    let n_corners = 27;
    let top = |v: &VertexId| mesh.points[v.index()][2] == 2.0 && v.index() >= n_corners;
    let inside = |p: Point| p[0] > 0.2 && p[0] < 1.8 && p[1] > 0.2 && p[1] < 1.8;
    let pushed = *mover.boundary().iter().find(|v| top(v) && inside(mesh.points[v.index()])).unwrap();
    let displacement: Vec<Point> =
        mover.boundary().iter().map(|&v| if v == pushed { [0.0, 0.0, -0.9] } else { [0.0; 3] }).collect();
    let (out, certificate) = advance(&mut mover, &displacement);
    assert!(!certificate.complete && certificate.inverted == 0, "{certificate:?}");
    assert!(certificate.fraction > 0.05 && certificate.fraction < 1.0, "{}", certificate.fraction);
    assert!(!certificate.blocked_by.is_empty());
    assert!(nodes(&mesh, &out).iter().all(|nodes| sampled(nodes) > 0.0));
    // The whole motion would fold just those cells.
    let mut all = mesh.points.clone();
    mover.step(&displacement, &mut all, &Threads::single()).unwrap();
    let folded: Vec<usize> = (nodes(&mesh, &all).iter().enumerate())
        .filter(|(_, nodes)| sampled(nodes) <= 0.0)
        .map(|(i, _)| i)
        .collect();
    assert!(!folded.is_empty());
    let there = mover.quality(&all, &Threads::single());
    assert!(there.inverted >= folded.len());
    let worst = there.quality.worst_curved_jacobian.unwrap();
    assert!(worst.value < 0.0 && certificate.blocked_by.contains(&worst.cell));
    assert!(distance(worst.place, all[pushed.index()]) < 1.5);
}

#[test]
fn what_is_folded_from_the_start_is_counted_and_stops_nothing() {
    let mut mesh = quadratic(&box_grid([3; 3], [[0.0; 3], [3.0; 3]]));
    let on_boundary = Boundary::of(&mesh.cells).vertices;
    let inner = |v: &usize| on_boundary.binary_search(&VertexId::new(*v)).is_err();
    let pushed = (64..mesh.points.len()).find(inner).unwrap();
    mesh.points[pushed][1] += 0.6;
    let mut mover = Mover::new(&mesh, &Options::default(), &Threads::single()).unwrap();
    let shift = vec![[0.25, 0.5, 0.0]; mover.boundary().len()];
    let (out, certificate) = advance(&mut mover, &shift);
    assert!(certificate.complete && certificate.inverted > 0);
    assert_eq!(certificate.inverted, certificate.inverted_before);
    // The node of the curved edge follows the method, which is exact for a shift.
    assert!(distance(out[pushed], add(mesh.points[pushed], [0.25, 0.5, 0.0])) < 1e-12);
}

/// Connected linear and quadratic cells of all kinds: middle nodes of wedges and hexahedra, of faces and of
/// the volume.
#[test]
fn middles_of_edges_faces_and_volumes_stay_where_they_are_between_their_corners() {
    let n = 4;
    let m = 2 * n + 1;
    let id = |[i, j, k]: [usize; 3]| VertexId::new(i + m * (j + m * k));
    let points: Vec<Point> =
        (0..m * m * m).map(|v| [v % m, v / m % m, v / m / m].map(|x| 0.5 * x as f64)).collect();
    let mut cells = Cells::new();
    let corners = [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2]];
    for c in 0..n * n * n {
        let first = [c % n, c / n % n, c / n / n].map(|x| 2 * x);
        let mut places: Vec<[usize; 3]> = corners.to_vec();
        for middle in motet::mesh::curved::middles(CellKind::TRIQUADRATIC_HEXAHEDRON) {
            let sum = |axis: usize| middle.corners.iter().map(|&c| corners[c][axis]).sum::<usize>();
            places.push([0, 1, 2].map(|axis| sum(axis) / middle.corners.len()));
        }
        let vertices = places.iter().map(|p| id([0, 1, 2].map(|axis| first[axis] + p[axis])));
        cells.push(CellKind::TRIQUADRATIC_HEXAHEDRON, vertices);
    }
    let mesh = Mesh::new(points, cells);
    for method in methods() {
        let name = method.name();
        let mover = Mover::new(&mesh, &Options { method, ..Options::default() }, &Threads::single());
        let Ok(mut mover) = mover else { continue };
        // The top is pressed in, most in its centre.
        let map = |[x, y, z]: Point| [0.0, 0.0, -0.02 * z * x * (4.0 - x) * y * (4.0 - y) / 4.0];
        let displacement: Vec<Point> = mover.boundary().iter().map(|v| map(mesh.points[v.index()])).collect();
        let (out, certificate) = advance(&mut mover, &displacement);
        assert!(certificate.complete && certificate.inverted == 0, "{name} {certificate:?}");
        let at = |place: [usize; 3]| out[id(place).index()];
        let inner = (0..m * m * m).map(|v| [v % m, v / m % m, v / m / m]);
        for place in inner.filter(|p| p.iter().all(|&x| x > 0 && x < m - 1)) {
            let odd: Vec<usize> = (0..3).filter(|&axis| place[axis] % 2 == 1).collect();
            let around = 1usize << odd.len();
            let mean = (0..around).fold([0.0; 3], |sum, c| {
                let mut corner = place;
                (odd.iter().enumerate())
                    .for_each(|(bit, &axis)| corner[axis] = place[axis] - 1 + 2 * (c >> bit & 1));
                add(sum, scale(at(corner), 1.0 / around as f64))
            });
            assert!(distance(at(place), mean) < 1e-13, "{name} {place:?}");
        }
    }
}

#[test]
fn sliding_patches_and_rigid_layers_keep_straight_edges_straight() {
    let mesh = quadratic(&box_grid([3; 3], [[0.0; 3], [3.0; 3]]));
    let set = |axis: usize, side: f64| {
        let boundary = Boundary::of(&mesh.cells);
        let is_there =
            |i: usize| boundary.facets.list(i).iter().all(|v| mesh.points[v.index()][axis] == side);
        FacetSet::of_boundary(&boundary, "side", is_there)
    };
    let options = Options {
        sliding: vec![set(0, 0.0)],
        rigid_layer: Some(RigidLayer { wall: Some(set(2, 3.0)), extent: Extent::Cells(1) }),
        ..Options::default()
    };
    let mover = Mover::new(&mesh, &options, &Threads::single()).unwrap();
    let displacement: Vec<Point> = (mover.boundary().iter())
        .map(|v| mesh.points[v.index()])
        .map(|[x, y, z]| if z == 3.0 { [0.0, 0.1 * x * y, -0.05 * x * y] } else { [0.0; 3] })
        .collect();
    let mut out = mesh.points.clone();
    mover.step(&displacement, &mut out, &Threads::single()).unwrap();
    assert!(off_the_middle(&mesh, &out) < 1e-13);
    let sliding: Vec<VertexId> = (0..mesh.points.len())
        .filter(|&v| mesh.points[v][0] == 0.0 && mesh.points[v][1..].iter().all(|x| *x > 0.0 && *x < 3.0))
        .map(VertexId::new)
        .collect();
    assert!(sliding.iter().all(|v| out[v.index()][0] == 0.0));
}
