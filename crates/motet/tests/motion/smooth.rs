//! Smoothing after a motion: only the vertices of bad tets move, the way back is the same, and there are no
//! jumps.

use motet::base::{Point, Threads};
use motet::geometry::quality::eas;
use motet::geometry::vector::{add, distance, norm};
use motet::mesh::shapes::sphere_in_box;
use motet::mesh::{BAD_EAS, Mesh};
use motet::motion::{Mover, Options};

fn movers(mesh: &Mesh) -> [Mover; 2] {
    [0, 2].map(|smoothing| {
        let options = Options { smoothing, ..Options::default() };
        Mover::new(mesh, &options, &Threads::single()).unwrap()
    })
}

/// The sphere shifted along x.
fn shifted(mover: &Mover, by: f64) -> Vec<Point> {
    let reported = |p: Point| [if norm(p) < 1.01 { by } else { 0.0 }, 0.0, 0.0];
    mover.boundary().iter().map(|v| reported(mover.reference()[v.index()])).collect()
}

fn stepped(mover: &Mover, by: f64, threads: &Threads) -> Vec<Point> {
    let mut out = mover.reference().to_vec();
    mover.step(&shifted(mover, by), &mut out, threads).unwrap();
    out
}

fn bad(mesh: &Mesh, points: &[Point], below: f64) -> Vec<usize> {
    let corners = mesh.cells.tets().map(|(_, tet)| tet.map(|v| points[v.index()]));
    corners.enumerate().filter(|(_, tet)| eas(*tet) < below).map(|(t, _)| t).collect()
}

#[test]
fn bad_tets_get_fewer_and_only_their_vertices_move() {
    let mesh = sphere_in_box(15, 7);
    let [plain, smooth] = movers(&mesh);
    for by in [1.0, 2.0] {
        let [before, after] = [&plain, &smooth].map(|mover| stepped(mover, by, &Threads::single()));
        let [n_before, n_after] = [&before, &after].map(|points| bad(&mesh, points, BAD_EAS).len());
        assert!(n_before > 20 && 2 * n_after < n_before, "{by}: {n_before} {n_after}");
        assert!(bad(&mesh, &after, 0.0).is_empty());
        let near = bad(&mesh, &before, 0.25);
        let tets: Vec<_> = mesh.cells.tets().map(|(_, tet)| tet).collect();
        let mut may_move = vec![false; mesh.points.len()];
        near.iter().for_each(|&t| tets[t].iter().for_each(|v| may_move[v.index()] = true));
        let moved = (0..before.len()).filter(|&v| before[v] != after[v]);
        assert!(moved.clone().count() > 0 && moved.clone().all(|v| may_move[v]));
        for (v, d) in smooth.boundary().iter().zip(shifted(&smooth, by)) {
            assert_eq!(after[v.index()], add(mesh.points[v.index()], d));
        }
        assert!(after == stepped(&smooth, by, &Threads::new(3).unwrap()));
    }
}

#[test]
fn a_way_back_leads_through_the_same_meshes() {
    let mesh = sphere_in_box(11, 6);
    let [_, mut smooth] = movers(&mesh);
    let mut seen: Vec<Vec<Point>> = Vec::new();
    let ways = [0.0, 0.7, 1.4, 0.7, 0.0];
    for by in ways {
        let mut out = mesh.points.clone();
        let certificate = smooth.advance(&shifted(&smooth, by), &mut out, &Threads::single()).unwrap();
        assert!(certificate.complete && (by == 1.4) <= (certificate.smoothed > 0));
        seen.push(out);
    }
    assert!(seen[0] == seen[4] && seen[1] == seen[3]);
}

#[test]
fn no_vertex_jumps_when_its_tets_turn_bad() {
    let mesh = sphere_in_box(11, 6);
    let [plain, smooth] = movers(&mesh);
    let (n, far) = (400, 2.0);
    let mut fastest = [0.0f64; 2];
    let mut before = [&plain, &smooth].map(|mover| stepped(mover, 0.0, &Threads::single()));
    for k in 1..=n {
        let now = [&plain, &smooth]
            .map(|mover| stepped(mover, far * f64::from(k) / f64::from(n), &Threads::single()));
        for i in 0..2 {
            let ways = before[i].iter().zip(&now[i]).map(|(p, q)| distance(*p, *q));
            fastest[i] = ways.fold(fastest[i], f64::max);
        }
        before = now;
    }
    let of_wall = far / f64::from(n);
    println!(
        "fastest vertex, in velocities of the wall: {:.2}, smoothed {:.2}",
        fastest[0] / of_wall,
        fastest[1] / of_wall
    );
    assert!(fastest[0] < 1.001 * of_wall, "{fastest:?}");
    // Without the fading, a vertex that enters the list jumps by a part of its edges, however small the step.
    assert!(fastest[1] < 2.0 * of_wall, "{fastest:?}");
}
