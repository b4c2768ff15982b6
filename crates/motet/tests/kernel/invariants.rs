//! The kernel: whatever is done, every invariant holds, and undoing it restores every bit.

use crate::common::editor::Editor;
use crate::common::{Numbers, random_mesh};
use motet::base::{TetId, Threads, VertexId};
use motet::kernel::{Change, Complex, HalfFacet, Hold, Reject, VertexChange};
use motet::mesh::TetMesh;
use proptest::prelude::*;

/// Facets of walls with their labels and the regions on their sides, by vertices.
fn walls(complex: &Complex) -> Vec<([VertexId; 3], i32, Vec<i32>)> {
    let mut walls: Vec<_> = complex
        .walls()
        .map(|(_, wall)| {
            let mut key = complex.facet(wall.sides[0]);
            key.sort_unstable();
            let is_there = |side: &&HalfFacet| !side.is_none();
            let mut regions: Vec<_> =
                wall.sides.iter().filter(is_there).map(|s| complex.region(s.tet())).collect();
            regions.sort_unstable();
            (key, wall.patch, regions)
        })
        .collect();
    walls.sort_unstable();
    walls
}

fn volumes(complex: &Complex) -> [f64; 2] {
    [3, 7].map(|region| {
        let tets = complex.tets().filter(|&t| complex.region(t) == region);
        tets.map(|t| motet::geometry::tet::volume(complex.corners(t))).sum()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn random_edits_keep_every_invariant_and_are_undone_to_the_bit(seed in any::<u64>(), n in 8usize..120) {
        let mesh = random_mesh(n, seed);
        let mut complex = Complex::new(&mesh).unwrap();
        complex.verify().map_err(TestCaseError::fail)?;
        let mut numbers = Numbers(seed ^ 0x5eed);
        let mut editor = Editor::default();
        let (walls_before, volumes_before) = (walls(&complex), volumes(&complex));
        let mark = complex.mark();
        let first = format!("{complex:?}");
        let (mut n_made, mut halfway) = (0, None);
        for i in 0..1500 {
            if editor.propose(&complex, &mut numbers) && editor.make(&mut complex) {
                n_made += 1;
                if n_made % 50 == 0 {
                    complex.verify().map_err(TestCaseError::fail)?;
                }
            }
            if i == 700 {
                halfway = Some((complex.mark(), format!("{complex:?}")));
            }
        }
        prop_assert!(n_made > 100, "only {n_made} edits");
        complex.verify().map_err(TestCaseError::fail)?;
        prop_assert_eq!(&walls(&complex), &walls_before);
        for (now, before) in volumes(&complex).into_iter().zip(volumes_before) {
            prop_assert!((now - before).abs() < 1e-12, "{now} {before}");
        }
        let (mark_halfway, at_halfway) = halfway.unwrap();
        complex.undo(mark_halfway);
        prop_assert!(format!("{complex:?}") == at_halfway, "not what it was halfway");
        complex.undo(mark);
        prop_assert!(format!("{complex:?}") == first, "not what it was at first");
    }

    #[test]
    fn what_is_extracted_is_the_same_mesh_and_says_what_stayed(seed in any::<u64>()) {
        let mesh = random_mesh(60, seed);
        let mut complex = Complex::new(&mesh).unwrap();
        let (mut numbers, mut editor) = (Numbers(seed), Editor::default());
        for _ in 0..100 {
            let _ = editor.propose(&complex, &mut numbers) && editor.make(&mut complex);
        }
        let extract = complex.extract(&mesh);
        let again = Complex::new(&extract.mesh).unwrap();
        again.verify().map_err(TestCaseError::fail)?;
        prop_assert_eq!(again.n_tets(), complex.n_tets());
        prop_assert_eq!(extract.mesh.triangles.len(), mesh.triangles.len());
        let known = || extract.tet_to_old.iter().enumerate().filter_map(|(new, old)| Some((new, old.get()?)));
        for (new, old) in known() {
            let corners = |mesh: &TetMesh, t: usize| mesh.tets[t].map(|v| mesh.points[v.index()].map(f64::to_bits));
            prop_assert_eq!(corners(&extract.mesh, new), corners(&mesh, old.index()));
            prop_assert_eq!(extract.mesh.regions[new], mesh.regions[old.index()]);
        }
        prop_assert_eq!(extract.removed_tets.len() + known().count(), mesh.tets.len());
    }
}

fn two_tets() -> TetMesh {
    let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    TetMesh::new(points, vec![[0, 1, 2, 3].map(VertexId), [0, 2, 1, 4].map(VertexId)])
}

#[test]
fn what_must_never_happen_is_refused_by_name() {
    let complex = Complex::new(&two_tets()).unwrap();
    let refusal = |edit: &dyn Fn(&mut Change)| {
        let mut change = Change::default();
        change.cavity.extend([TetId(0), TetId(1)]);
        for tet in [[0, 1, 2, 3], [0, 2, 1, 4]] {
            change.push(&complex, tet.map(VertexId), 0);
        }
        edit(&mut change);
        complex.check_against(&change, -2.0).map(|_| ()).unwrap_err()
    };
    assert!(matches!(refusal(&|c| c.fill.truncate(1)), Reject::Vertex(VertexId(4))));
    assert!(matches!(refusal(&|c| c.fill[0].vertices.swap(0, 1)), Reject::NotPositive(_)));
    assert!(matches!(
        refusal(&|c| c.vertex = VertexChange::Move(VertexId(3), [0.0, 0.0, 2.0])),
        Reject::Held(_)
    ));
    assert!(matches!(refusal(&|c| c.fill[0].region = 1), Reject::Region(_)));
    assert!(matches!(refusal(&|c| c.fill.push(c.fill[0])), Reject::Crowded(_)));
    let nothing = Change { cavity: vec![TetId(0)], ..Change::default() };
    let worse = complex.check(&nothing);
    assert!(matches!(worse, Err(Reject::Vertex(_))), "{worse:?}");
    let mut same = Change::default();
    same.cavity.push(TetId(0));
    same.push(&complex, complex.vertices(TetId(0)), 0);
    assert!(matches!(complex.check(&same), Err(Reject::Quality { .. })));
    assert!(complex.check_against(&same, 0.0).is_ok());
}

#[test]
fn tets_numbered_the_other_way_are_reported_from_inverted_ones() {
    let mut mesh = random_mesh(40, 5);
    let sound = Complex::new(&mesh).unwrap();
    mesh.tets.iter_mut().step_by(3).for_each(|tet| tet.swap(0, 1));
    let turned = Complex::new(&mesh).unwrap();
    turned.verify().unwrap();
    assert!(turned.tets().all(|t| (turned.quality(t) - sound.quality(t)).abs() < 1e-12));
    // A vertex moved through the facet opposite: its tets are inverted, whatever their numbering.
    let inner = (8..48).map(VertexId).find(|&v| sound.hold(v) == Hold::Free).unwrap();
    mesh.points[inner.index()] = [3.0, 3.0, 3.0];
    let inverted = Complex::new(&mesh).unwrap();
    inverted.verify().unwrap();
    assert!(!inverted.below(0.0, &Threads::single()).is_empty());
    let volume = |c: &Complex| c.tets().map(|t| motet::geometry::tet::volume(c.corners(t))).sum::<f64>();
    assert!((volume(&inverted) - 1.0).abs() < 1e-12);
}

#[test]
fn a_facet_of_three_tets_is_named() {
    let mut mesh = two_tets();
    mesh.points.push([0.3, 0.3, 2.0]);
    mesh.tets.push([0, 1, 2, 5].map(VertexId));
    mesh.regions.push(0);
    let error = Complex::new(&mesh).unwrap_err().to_string();
    assert!(error.starts_with("tet 0: 3 tets share the facet of the points"), "{error}");
}
