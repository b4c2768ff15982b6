//! Motion by a graph whose nodes turn: rigid motions, a flap that bends, the same bits on every path.

use crate::stepped::{mover, n_inverted, step};
use motet::Mesh;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::vector::{add, distance, norm};
use motet::mesh::shapes::{box_grid, mixed, sphere_in_box};
use motet::mesh::{CellKind, Cells};
use motet::motion::{Extent, Method, Options, Prescribed, RigidLayer};

fn guided() -> Options {
    Options { method: Method::Guided, ..Options::default() }
}

/// A channel with a flap on its floor, `y = -1`: a slot one cell wide.
fn channel(n: usize) -> (Mesh, impl Fn(Point) -> bool) {
    let grid = box_grid([4 * n, 2 * n, 2 * n], [[-2.0, -1.0, -1.0], [2.0, 1.0, 1.0]]);
    let h = 1.0 / n as f64;
    let in_slot = move |p: Point, more: f64| {
        p[0] > -more && p[0] < h + more && p[1] < more && p[2] > -0.5 - more && p[2] < 0.5 + more
    };
    let mut mesh = Mesh { cells: Cells::new(), ..Mesh::default() };
    let mut new = vec![None; grid.points.len()];
    for (_, tet) in grid.cells.tets() {
        let centre = tet.iter().fold([0.0; 3], |s, v| add(s, grid.points[v.index()])).map(|x| x / 4.0);
        if !in_slot(centre, 0.0) {
            let tet = tet.map(|v| {
                *new[v.index()].get_or_insert_with(|| {
                    mesh.points.push(grid.points[v.index()]);
                    VertexId::new(mesh.points.len() - 1)
                })
            });
            mesh.cells.push(CellKind::TETRA, tet);
        }
    }
    (mesh, move |p| in_slot(p, 1e-9))
}

/// A map that bends the flap to an arc of this many radians.
fn bent(angle: f64, is_flap: impl Fn(Point) -> bool) -> impl Fn(Point) -> Point {
    move |p| {
        if !is_flap(p) || angle == 0.0 {
            return p;
        }
        let (sine, cosine) = (angle * (p[1] + 1.0)).sin_cos();
        [(1.0 - cosine) / angle + p[0] * cosine, sine / angle - 1.0 - p[0] * sine, p[2]]
    }
}

#[test]
fn a_rigid_motion_moves_every_vertex_rigidly() {
    let turn = Prescribed::Turn { axis: [1.0, 0.5, -0.3], angle: 2.0, centre: [0.3, 0.0, 7.0] };
    let map = |p: Point| add(turn.apply(p, 1.0), [1.0, -2.0, 0.3]);
    for mesh in [sphere_in_box(8, 5), mixed(5)] {
        let moved = step(&mover(&mesh, &guided()), map, &Threads::single());
        let off = mesh.points.iter().zip(&moved).map(|(&p, &q)| distance(map(p), q)).fold(0.0, f64::max);
        assert!(off < 1e-8, "{off:.1e}");
    }
}

#[test]
fn nothing_moves_to_the_bit_and_threads_and_ways_do_not_matter() {
    let (mesh, is_flap) = channel(6);
    let guided = mover(&mesh, &guided());
    let first = step(&guided, |p| p, &Threads::single());
    assert!(first == mesh.points);
    let there = step(&guided, bent(0.5, &is_flap), &Threads::single());
    assert!(there != first);
    assert!(there == step(&guided, bent(0.5, &is_flap), &Threads::new(3).unwrap()));
    step(&guided, bent(-0.4, &is_flap), &Threads::single());
    assert!(there == step(&guided, bent(0.5, &is_flap), &Threads::single()));
    assert!(first == step(&guided, |p| p, &Threads::single()));
}

#[test]
fn a_flap_bends_by_sixty_degrees_and_no_cell_inverts() {
    let (mesh, is_flap) = channel(8);
    let [graph, guided] = [Options::default(), guided()].map(|options| mover(&mesh, &options));
    for degrees in [30.0, 60.0] {
        let map = bent(f64::to_radians(degrees), &is_flap);
        let inverted =
            [&graph, &guided].map(|mover| n_inverted(&mesh, &step(mover, &map, &Threads::single())));
        println!(
            "{degrees} degrees: {} inverted by the graph, {} by one whose nodes turn",
            inverted[0], inverted[1]
        );
        assert_eq!(inverted[1], 0, "{degrees}");
        assert!(degrees < 60.0 || inverted[0] > 0);
    }
}

#[test]
fn a_sphere_turns_with_a_rigid_layer_round_it() {
    let mesh = sphere_in_box(11, 6);
    let turn = Prescribed::Turn { axis: [0.0, 0.0, 1.0], angle: f64::to_radians(60.0), centre: [0.0; 3] };
    let map = |p: Point| if norm(p) < 1.01 { turn.apply(p, 1.0) } else { p };
    let layer = Some(RigidLayer { extent: Extent::Distance(0.2), wall: None });
    for options in [guided(), Options { rigid_layer: layer, ..guided() }] {
        assert_eq!(n_inverted(&mesh, &step(&mover(&mesh, &options), map, &Threads::single())), 0);
    }
}
