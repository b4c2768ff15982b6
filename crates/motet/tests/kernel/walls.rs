//! The kernel where walls and lines may change: whatever is done, every invariant holds, every line keeps its
//! ends, and undoing it restores every bit.

use std::collections::BTreeMap;

use crate::common::editor::Editor;
use crate::common::{Numbers, random_mesh};
use motet::base::VertexId;
use motet::kernel::Complex;
use motet::mesh::TetMesh;
use proptest::prelude::*;

/// Makes some edges lines of three labels.
fn with_lines(mut mesh: TetMesh) -> TetMesh {
    mesh.lines = mesh.tets.iter().step_by(7).flat_map(|&[a, b, c, _]| [[a, b], [c, b]]).collect();
    mesh.line_labels = (0..mesh.lines.len() as i32).map(|i| i % 3).collect();
    mesh
}

/// The vertices that lines of a label meet an odd number of times: where the label begins and ends.
fn ends(complex: &Complex, mesh: &TetMesh) -> Vec<(i32, VertexId)> {
    let mut times: BTreeMap<(i32, VertexId), u32> = BTreeMap::new();
    for (edge, line) in complex.lines() {
        for &old in complex.lines_of_first(line) {
            let label = mesh.line_labels[old as usize];
            edge.iter().for_each(|&v| *times.entry((label, v)).or_default() += 1);
        }
    }
    times.into_iter().filter(|(_, n)| n % 2 == 1).map(|(end, _)| end).collect()
}

/// The whole state as text; lines by their edges, since a map has no order.
fn state(complex: &Complex, mesh: &TetMesh) -> String {
    match complex.has_lines() {
        true => format!("{:?} {:?}", complex.extract(mesh), complex.lines()),
        false => format!("{complex:?}"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn changes_of_walls_and_lines_keep_every_invariant_and_are_undone_to_the_bit(
        seed in any::<u64>(),
        n in 8usize..40,
        has_lines in any::<bool>(),
    ) {
        let plain = random_mesh(n, seed);
        let mesh = if has_lines { with_lines(plain) } else { plain };
        let mut complex = Complex::new(&mesh).unwrap();
        complex.adapt_surface();
        // Measures every tet: cached qualities are part of the state.
        complex.verify().map_err(TestCaseError::fail)?;
        let ends_at_first = ends(&complex, &mesh);
        let (mut numbers, mut editor) = (Numbers(seed ^ 0x5eed), Editor::default());
        let (mark, first) = (complex.mark(), state(&complex, &mesh));
        let (mut n_made, mut halfway) = (0, None);
        for i in 0..600 {
            n_made += usize::from(editor.propose(&complex, &mut numbers) && editor.make(&mut complex));
            if i % 100 == 0 {
                complex.verify().map_err(TestCaseError::fail)?;
                prop_assert_eq!(&ends(&complex, &mesh), &ends_at_first);
            }
            if i == 300 {
                halfway = Some((complex.mark(), state(&complex, &mesh)));
            }
        }
        prop_assert!(n_made > 50, "only {} edits", n_made);
        complex.verify().map_err(TestCaseError::fail)?;

        let extract = complex.extract(&mesh);
        let again = Complex::new(&extract.mesh).unwrap();
        again.verify().map_err(TestCaseError::fail)?;
        prop_assert_eq!(again.n_tets(), complex.n_tets());
        prop_assert_eq!(again.walls().count(), complex.walls().count());
        prop_assert_eq!(again.lines().len(), complex.lines().len());
        for (new, old) in extract.vertex_to_old.iter().map(|old| old.get()).enumerate() {
            let is_changed = extract.changed_vertices.binary_search(&VertexId::new(new)).is_ok();
            prop_assert!(old.is_none_or(|old| old.index() < mesh.points.len()));
            prop_assert!(is_changed || old.is_some_and(|old| extract.mesh.points[new] == mesh.points[old.index()]));
        }
        let label_of = |old: u32| mesh.line_labels[old as usize];
        let labels: Vec<i32> = extract.line_to_old.iter().map(|&old| label_of(old)).collect();
        prop_assert_eq!(&extract.mesh.line_labels, &labels);

        let (mark_halfway, at_halfway) = halfway.unwrap();
        complex.undo(mark_halfway);
        complex.verify().map_err(TestCaseError::fail)?;
        prop_assert!(state(&complex, &mesh) == at_halfway, "not what it was halfway");
        complex.undo(mark);
        complex.verify().map_err(TestCaseError::fail)?;
        prop_assert!(state(&complex, &mesh) == first, "not what it was at first");
    }
}
