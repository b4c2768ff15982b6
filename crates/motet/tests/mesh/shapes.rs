//! Built-in shapes: positive, conforming, covered by their patches, and of the right volume.

use std::collections::BTreeSet;

use motet::Mesh;
use motet::base::{Point, VertexId};
use motet::geometry::quality;
use motet::mesh::adjacency::Facets;
use motet::mesh::shapes::{
    TubeOptions, WallCells, ball, box_grid, mixed, quadratic, sphere_in_box, to_tets, tube,
};
use motet::mesh::{Boundary, CellKind, Cells, cell_volumes, cone_volume};

fn all_shapes() -> Vec<(&'static str, Mesh)> {
    let wall = |wall_cells| {
        tube(&TubeOptions { wall_layers: 3, first_layer: 0.02, wall_cells, ..TubeOptions::default() })
    };
    let grid = box_grid([2, 3, 4], [[-1.0, 0.0, 0.5], [1.0, 1.0, 2.0]]);
    vec![
        ("quadratic", quadratic(&grid)),
        ("box_grid", grid),
        ("ball", ball(4, 3)),
        ("ball of one", ball(1, 1)),
        ("sphere_in_box", sphere_in_box(6, 4)),
        ("sphere_in_box, odd", sphere_in_box(5, 1)),
        ("tube", tube(&TubeOptions::default())),
        ("tube, coarsest", tube(&TubeOptions { n: 1, rings: 1, slices: 1, ..TubeOptions::default() })),
        ("tube, thin tets", wall(WallCells::Tets)),
        ("tube, wedges", wall(WallCells::Wedges)),
        ("mixed", mixed(2)),
    ]
}

fn is_volume(kind: CellKind) -> bool {
    kind.dim() == Some(3)
}

/// The vertices of a facet, independent of its orientation and first vertex.
fn as_set(facet: &[VertexId]) -> BTreeSet<VertexId> {
    facet.iter().copied().collect()
}

#[test]
fn every_volume_cell_is_positive() {
    for (name, mesh) in all_shapes() {
        let volumes = cell_volumes(&mesh.cells, &mesh.points);
        for ((cell, kind, _), volume) in mesh.cells.iter().zip(volumes) {
            assert!(volume > 0.0 || !is_volume(kind), "{name}: cell {cell} has volume {volume}");
        }
    }
}

#[test]
fn no_facet_has_more_than_two_cells_and_the_patches_are_the_boundary() {
    for (name, mesh) in all_shapes() {
        Facets::of(&mesh.cells).for_each_shared(|uses| assert!(uses.len() <= 2, "{name}: {uses:?}"));
        let boundary = Boundary::of(&mesh.cells);
        let expected: Vec<_> = boundary.facets.iter().map(as_set).collect();
        let surface = mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2));
        let found: Vec<_> = surface.map(|(_, _, vertices)| as_set(vertices)).collect();
        assert_eq!(found, expected, "{name}");
    }
}

#[test]
fn the_boundary_is_closed_and_turns_outward() {
    // By the divergence theorem, the cones over the boundary from any point have the total volume of the
    // cells.
    for (name, mesh) in all_shapes() {
        let cells: f64 = cell_volumes(&mesh.cells, &mesh.points).iter().sum();
        let surface = mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2));
        let enclosed: f64 = surface
            .map(|(_, kind, v)| {
                let n = if kind == CellKind::QUADRATIC_TRIANGLE { 3 } else { v.len() };
                cone_volume(v[..n].iter().copied(), &mesh.points, [0.3, -7.0, 2.0])
            })
            .sum();
        assert!((cells - enclosed).abs() < 1e-11 * cells, "{name}: {cells} {enclosed}");
    }
}

#[test]
fn every_vertex_is_used_and_no_two_lie_at_one_place() {
    for (name, mesh) in all_shapes() {
        let used: BTreeSet<_> = mesh.cells.connectivity().items().iter().collect();
        assert_eq!(used.len(), mesh.points.len(), "{name}");
        let places: BTreeSet<_> = mesh.points.iter().map(|p| p.map(f64::to_bits)).collect();
        assert_eq!(places.len(), mesh.points.len(), "{name}");
    }
}

#[test]
fn every_cell_has_a_label_with_a_name_and_every_patch_is_there() {
    for (name, mesh) in all_shapes() {
        mesh.validate().unwrap();
        let (regions, patches) = (mesh.regions().unwrap(), mesh.patches().unwrap());
        for ((_, kind, _), (region, patch)) in mesh.cells.iter().zip(regions.ids.iter().zip(&patches.ids)) {
            assert_eq!((*region != 0, *patch != 0), (is_volume(kind), !is_volume(kind)), "{name}");
        }
        assert_eq!(patches.used(), patches.names.keys().copied().collect::<Vec<_>>(), "{name}");
        assert_eq!(regions.used(), regions.names.keys().copied().collect::<Vec<_>>(), "{name}");
    }
}

#[test]
fn the_same_call_gives_the_same_mesh() {
    for ((name, a), (_, b)) in all_shapes().into_iter().zip(all_shapes()) {
        assert_eq!(a, b, "{name}");
    }
}

#[test]
fn volumes_are_those_of_the_geometry() {
    let volume = |mesh: &Mesh| cell_volumes(&mesh.cells, &mesh.points).iter().sum::<f64>();
    assert!((volume(&box_grid([2, 3, 4], [[-1.0, 0.0, 0.5], [1.0, 1.0, 2.0]])) - 3.0).abs() < 1e-12);
    assert!((volume(&mixed(3)) - 3.0).abs() < 1e-12);
    // A regular polygon of 4 n corners as cross-section.
    let around = 4.0 * 4.0;
    let section = around / 2.0 * (std::f64::consts::TAU / around).sin();
    for wall_layers in [0, 3] {
        let options = TubeOptions { wall_layers, radius: 2.0, ..TubeOptions::default() };
        assert!((volume(&tube(&options)) - 4.0 * section * 5.0).abs() < 1e-11);
    }
    // Inscribed in the ball: smaller, with an error of second order in the cell size.
    let exact = 4.0 / 3.0 * std::f64::consts::PI;
    let missing = [4, 8].map(|n| exact - volume(&ball(n, 2)));
    assert!(missing[0] > 0.0 && (3.5..4.5).contains(&(missing[0] / missing[1])), "{missing:?}");
    let outside = 1000.0 - volume(&sphere_in_box(8, 3));
    assert!((volume(&ball(8, 2)) - outside).abs() < 1e-10, "the sphere of both shapes is the same");
}

#[test]
fn a_shell_has_six_n_squared_and_two_vertices() {
    for (n, layers) in [(1, 1), (3, 2), (6, 4)] {
        let mesh = sphere_in_box(n, layers);
        let shell = 6 * n * n + 2;
        assert_eq!(mesh.points.len(), shell * (layers + 1));
        let radius = |p: &Point| p.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!(mesh.points[..shell].iter().all(|p| (radius(p) - 1.0).abs() < 1e-15));
        let on_box = |p: &Point| p.iter().any(|x| x.abs() == 5.0) && p.iter().all(|x| x.abs() <= 5.0);
        assert!(mesh.points[mesh.points.len() - shell..].iter().all(on_box));
    }
}

#[test]
fn sphere_in_box_has_few_bad_tets() {
    let mesh = sphere_in_box(22, 10);
    assert_eq!(mesh.points.len(), 31_966);
    let eas: Vec<f64> =
        mesh.cells.tets().map(|(_, tet)| quality::eas(tet.map(|v| mesh.points[v.index()]))).collect();
    let worst = eas.iter().copied().fold(1.0, f64::min);
    let mean = eas.iter().sum::<f64>() / eas.len() as f64;
    println!("{} tets, EAS worst {worst:.4}, mean {mean:.4}", eas.len());
    assert!(worst > 0.19 && mean > 0.31, "{worst} {mean}");
}

#[test]
fn splitting_any_kind_keeps_the_volume_and_conforms() {
    let mixed = mixed(2);
    let prism = |n: u32| (0..2 * n).map(VertexId);
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / 6.0;
    let points: Vec<Point> =
        [0.0, 1.0].iter().flat_map(|&z| (0..6).map(move |i| [angle(i).cos(), angle(i).sin(), z])).collect();
    let mut hexagonal = Cells::new();
    hexagonal.push(CellKind::HEXAGONAL_PRISM, prism(6));
    for (cells, points) in [(&mixed.cells, &mixed.points), (&hexagonal, &points)] {
        let tets = to_tets(cells);
        let volumes = cell_volumes(&tets, points);
        assert!(volumes.iter().all(|&v| v > 0.0));
        let (before, after): (f64, f64) = (cell_volumes(cells, points).iter().sum(), volumes.iter().sum());
        assert!((before - after).abs() < 1e-13 * before);
        Facets::of(&tets).for_each_shared(|uses| assert!(uses.len() <= 2));
        // If two cells disagreed on a diagonal, their common walls would be boundary.
        let facets = |cells: &Cells| Boundary::of(cells).facets.iter().map(|f| f.len() - 2).sum::<usize>();
        assert_eq!(facets(&tets), facets(cells));
    }
}
