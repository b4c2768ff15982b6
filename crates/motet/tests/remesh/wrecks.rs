//! Broken meshes end as valid meshes, or are refused with a place, or the report counts what is left.

use crate::common::wreck::{Ending, Wreck, sound_connectivity};
use crate::common::{Numbers, random_mesh};
use motet::base::{Threads, VertexId};
use motet::geometry::predicates::orient3d;
use motet::mesh::shapes::box_grid;
use motet::mesh::{TetMesh, TetPart};
use motet::remesh::{Options, SurfaceRule, remesh};

#[test]
fn wrecks_end_valid_told_or_refused() {
    let mut n_valid = 0;
    for seed in 0..100 {
        let wreck = Wreck::new(seed);
        let surface = if seed % 4 == 0 { SurfaceRule::Adapt { distance: None } } else { SurfaceRule::Keep };
        match wreck.end(surface) {
            Ok(end) => n_valid += usize::from(end == Ending::Valid),
            Err(why) => panic!("wreck {seed}, {:?}: {why}", wreck.damage),
        }
    }
    assert!(n_valid > 30, "{n_valid} of 100 are meshes again");
}

/// A positive tet with a wrong vertex overlaps others: a change can then insert edges and facets that exist
/// elsewhere already, though every tet has a positive volume.
#[test]
fn a_positive_tet_with_a_wrong_vertex_leaves_no_facet_with_three_tets() {
    for seed in [6206, 9573] {
        let end = Wreck::new(seed).end(SurfaceRule::Keep);
        assert!(end.is_ok(), "wreck {seed}: {}", end.unwrap_err());
    }
}

/// Most tets are inverted, and hardly any can be repaired: the repair ends, and counts them.
#[test]
fn a_box_shaken_beyond_repair_is_reported() {
    for part in [1.5, 3.0] {
        let end = Wreck::shaken_box(2, 6, part).end(SurfaceRule::Keep);
        assert_eq!(end, Ok(Ending::Reported));
    }
}

#[test]
fn two_tets_on_one_side_of_a_facet_become_one() {
    let points = vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0.2, 0.2, 1.], [0.3, 0.2, 2.]];
    let tets = [[0, 1, 2, 3], [0, 1, 2, 4]].map(|tet| tet.map(VertexId)).to_vec();
    let outcome = remesh(&TetMesh::new(points, tets), &Options::default(), &Threads::single()).unwrap();
    assert_eq!((outcome.extract.mesh.tets.len(), outcome.report.operations.peeling), (1, 1));
    assert_eq!((outcome.report.before.inverted, outcome.report.after.inverted), (1, 0));
}

#[test]
fn a_tet_folded_over_a_mesh_is_removed_and_the_rest_stays() {
    let mesh = TetPart::of(&box_grid([4; 3], [[0.0; 3], [1.0; 3]])).unwrap().mesh;
    let mut folded = mesh.clone();
    // The facet x = 0 of a tet, joined to a vertex far inside.
    let is_on = |v: &VertexId| mesh.points[v.index()][0] == 0.0;
    let facet = mesh.tets.iter().find_map(|tet| {
        let on: Vec<_> = tet.iter().copied().filter(is_on).collect();
        <[VertexId; 3]>::try_from(on).ok()
    });
    let [a, b, c] = facet.unwrap();
    folded.points.push([0.9, 0.4, 0.4]);
    folded.tets.push([a, b, c, VertexId::new(mesh.points.len())]);
    folded.regions.push(0);
    let outcome = remesh(&folded, &Options::default(), &Threads::single()).unwrap();
    assert_eq!(outcome.report.operations.peeling, 1);
    let new = &outcome.extract.mesh;
    assert!(new.points == mesh.points && new.tets == mesh.tets, "the rest is as it was, to the bit");
    let labelled = |mesh: &TetMesh| {
        let sorted = |t: &[VertexId; 3]| {
            let mut t = *t;
            t.sort_unstable();
            t
        };
        let mut all: Vec<_> = mesh.triangles.iter().map(sorted).zip(mesh.patches.clone()).collect();
        all.sort_unstable();
        all
    };
    assert!(labelled(new) == labelled(&mesh), "every triangle keeps its patch");
}

/// A tet with another one at each of its four facets, each of which has its other three facets on the
/// boundary.
fn star() -> TetMesh {
    let points = vec![
        [1., 1., 1.],
        [1., -1., -1.],
        [-1., 1., -1.],
        [-1., -1., 1.],
        [-1.2, -1.2, -1.2],
        [-1.2, 1.2, 1.2],
        [1.2, -1.2, 1.2],
        [1.2, 1.2, -1.2],
    ];
    let tets = [[0, 1, 3, 2], [1, 2, 3, 4], [0, 3, 2, 5], [0, 1, 3, 6], [0, 2, 1, 7]];
    let mut mesh = TetMesh::new(points, tets.map(|tet| tet.map(VertexId)).to_vec());
    for tet in &mut mesh.tets {
        let [a, b, c, d] = tet.map(|v| mesh.points[v.index()]);
        if orient3d(a, b, c, d) < 0 {
            tet.swap(2, 3);
        }
    }
    assert_eq!(sound_connectivity(&mesh), Ok(0));
    mesh
}

#[test]
fn a_tet_that_motion_has_inverted_at_the_boundary_is_repaired_and_not_removed() {
    let mut mesh = star();
    mesh.points[4] = [0.3; 3];
    let outcome = remesh(&mesh, &Options::default(), &Threads::single()).unwrap();
    assert_eq!((outcome.report.before.inverted, outcome.report.after.inverted), (1, 0));
    assert_eq!((outcome.report.operations.peeling, outcome.extract.mesh.tets.len()), (0, 6));
}

#[test]
fn a_folded_tet_with_a_labelled_triangle_stays_and_a_heap_of_others_is_removed() {
    let mut folded = star();
    let positive = |points: &[[f64; 3]], mut tet: [VertexId; 4]| {
        let [a, b, c, d] = tet.map(|v| points[v.index()]);
        if orient3d(a, b, c, d) < 0 {
            tet.swap(2, 3);
        }
        tet
    };
    // On the facet 1, 2, 4 of the second tet, on the side of that tet; and another one on it, on the far
    // side.
    folded.points.extend([[-0.5, -0.5, 0.4], [-1.0, -1.0, 2.0]]);
    folded.tets.push(positive(&folded.points, [1, 2, 4, 8].map(VertexId)));
    folded.tets.push(positive(&folded.points, [1, 2, 8, 9].map(VertexId)));
    folded.regions = vec![0; folded.tets.len()];
    let [first, second] = [5, 6].map(|t: usize| folded.tets[t]);
    let outcome = remesh(&folded, &Options::default(), &Threads::single()).unwrap();
    assert_eq!(outcome.report.operations.peeling, 2, "{first:?} {second:?}");
    assert_eq!(outcome.extract.mesh.tets, star().tets);
    folded.triangles = vec![[2, 8, 9].map(VertexId)];
    folded.patches = vec![1];
    let outcome = remesh(&folded, &Options::default(), &Threads::single()).unwrap();
    assert_eq!((outcome.report.operations.peeling, outcome.extract.mesh.triangles.len()), (0, 1));
    assert!(outcome.report.after.inverted > 0);
}

/// A former failure: a tet of this mesh referred to a removed vertex.
#[test]
fn a_shaken_mesh_that_lost_a_vertex_keeps_it() {
    for part in [0.07662673500271387, 0.5, 0.9] {
        let seed = 15308308045394861619;
        let mut mesh = random_mesh(39, seed);
        let mut numbers = Numbers(seed);
        for p in mesh.points.iter_mut().skip(8) {
            p.iter_mut().for_each(|x| *x += part * (numbers.unit() - 0.5));
        }
        let outcome = remesh(&mesh, &Options::default(), &Threads::single()).unwrap();
        let n_wrong = sound_connectivity(&outcome.extract.mesh).unwrap();
        assert_eq!(n_wrong > 0, outcome.report.after.inverted > 0);
    }
}
