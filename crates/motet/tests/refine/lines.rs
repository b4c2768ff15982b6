//! Line cells in refinement: divided with their edges, merged with them, remembered in files.

use motet::base::{TetId, Threads, VertexId};
use motet::geometry::vector::distance;
use motet::io::{self, WriteOptions};
use motet::mesh::history::{Changed, Rules};
use motet::mesh::shapes::box_grid;
use motet::mesh::{CellKind, Field, Mesh};
use motet::refine::{MeshRefinement, Options};

/// A box with lines along one of its edges, with a duplicate on one edge, one line across its interior, and a
/// vertex cell.
fn with_lines() -> Mesh {
    let mut mesh = box_grid([2; 3], [[0.0; 3], [1.0; 3]]);
    let at =
        |mesh: &Mesh, place: [f64; 3]| VertexId::new(mesh.points.iter().position(|p| *p == place).unwrap());
    let (o, m, x) = (at(&mesh, [0.0; 3]), at(&mesh, [0.5, 0.0, 0.0]), at(&mesh, [1.0, 0.0, 0.0]));
    let centre = at(&mesh, [0.5; 3]);
    let lines = [([m, o], 7), ([m, x], 8), ([o, centre], 9), ([o, m], 7)];
    let n = mesh.cells.len();
    lines.iter().for_each(|(line, _)| mesh.cells.push(CellKind::LINE, *line));
    mesh.cells.push(CellKind::VERTEX, [centre]);
    for field in &mut mesh.cell_data {
        *field = field.pick((0..n).chain([0; 5]));
    }
    let curves = std::iter::repeat_n(0, n).chain(lines.iter().map(|line| line.1)).chain([1]);
    mesh.set_cell_field(Field::scalars("curve", curves.collect::<Vec<i32>>()));
    mesh
}

fn lengths(mesh: &Mesh) -> Vec<(i64, f64)> {
    let curves = mesh.cell_field("curve").unwrap().values.to_i64().unwrap();
    let lines = mesh.cells.iter().filter(|(_, kind, _)| *kind == CellKind::LINE);
    lines
        .map(|(cell, _, v)| {
            (curves[cell.index()], distance(mesh.points[v[0].index()], mesh.points[v[1].index()]))
        })
        .collect()
}

fn all(refinement: &MeshRefinement) -> Vec<TetId> {
    (0..refinement.refinement().mesh().tets.len()).map(TetId::new).collect()
}

#[test]
fn lines_are_divided_and_taken_back_with_their_edges() {
    let (first, threads, rules) = (with_lines(), Threads::single(), Rules::default());
    let mut one = MeshRefinement::new(&first, Options::default(), &threads).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("fine.vtu");
    for generation in 1..3u32 {
        let Changed { report: summary, history, .. } = one.refine(&all(&one), &rules, &threads).unwrap();
        assert_eq!(summary.n_held, 0);
        assert_eq!(one.refinement().mesh().tets.len(), 48 << (3 * generation));
        // Each part has half the length and the number of its whole, in its place and direction.
        let parts = 1 << generation;
        let expected: Vec<(i64, f64)> = lengths(&first)
            .into_iter()
            .flat_map(|(curve, l)| vec![(curve, l / f64::from(parts)); parts as usize])
            .collect();
        let found = lengths(one.mesh());
        assert!(
            found.len() == expected.len()
                && found.iter().zip(&expected).all(|(x, y)| x.0 == y.0 && (x.1 - y.1).abs() < 1e-14)
        );
        assert!(
            history.cells.main().all(|old| old.index() < 48 + first.cells.len() * (1 << (3 * generation)))
        );
        // A file remembers the same as the handle.
        io::write(&file, &one.with_memory(&threads), &WriteOptions::default()).unwrap();
        one = MeshRefinement::new(&io::read(&file).unwrap(), Options::default(), &threads).unwrap();
    }
    for _ in 0..2 {
        one.coarsen(&all(&one), &rules, &threads).unwrap();
    }
    assert!(one.mesh().points == first.points && one.mesh().cells == first.cells);
    assert_eq!(one.mesh().cell_field("curve"), first.cell_field("curve"));
}

#[test]
fn of_a_divided_edge_all_parts_are_lines_or_none() {
    let (first, threads) = (with_lines(), Threads::single());
    let mut one = MeshRefinement::new(&first, Options::default(), &threads).unwrap();
    one.refine(&all(&one), &Rules::default(), &threads).unwrap();
    let mut mesh = one.with_memory(&threads);
    // One half of the inner line is removed.
    let last = mesh.cells.iter().filter(|(_, kind, _)| *kind == CellKind::LINE).nth(4).unwrap().0.index();
    let kept: Vec<usize> = (0..mesh.cells.len()).filter(|&cell| cell != last).collect();
    let mut cells = motet::mesh::Cells::new();
    mesh.cells
        .iter()
        .filter(|(cell, ..)| cell.index() != last)
        .for_each(|(_, kind, v)| cells.push(kind, v.to_vec()));
    mesh.cells = cells;
    mesh.cell_data.iter_mut().for_each(|field| *field = field.pick(kept.iter().copied()));
    let error = MeshRefinement::new(&mesh, Options::default(), &threads).expect_err("it is refused");
    assert!(error.to_string().contains("lines"), "{error}");
}
