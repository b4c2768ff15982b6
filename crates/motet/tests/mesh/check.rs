//! Defects: none in the built-in shapes; each inserted one is found by name and place.

use crate::adjacency::HEX as CUBE;
use motet::Mesh;
use motet::base::{CellId, Point, VertexId};
use motet::mesh::check::{DefectKind, check, is_conforming};
use motet::mesh::shapes::{TubeOptions, WallCells, ball, box_grid, mixed, quadratic, sphere_in_box, tube};
use motet::mesh::{CellKind, Cells, Summary};

fn mesh(points: &[Point], cells: &[(CellKind, &[u32])]) -> Mesh {
    let mut list = Cells::new();
    for (kind, ids) in cells {
        list.push(*kind, ids.iter().map(|&i| VertexId(i)));
    }
    Mesh::new(points.to_vec(), list)
}

/// Kinds and counts of all defects.
fn found(mesh: &Mesh) -> Vec<(DefectKind, usize)> {
    check(mesh).iter().map(|defect| (defect.kind, defect.count)).collect()
}

#[test]
fn built_in_shapes_have_no_defect() {
    let wedges = TubeOptions { wall_layers: 3, wall_cells: WallCells::Wedges, ..TubeOptions::default() };
    let shapes = [
        box_grid([3, 2, 4], [[0.0; 3], [1.0, 1.0, 3.0]]),
        ball(4, 2),
        sphere_in_box(8, 4),
        tube(&TubeOptions::default()),
        tube(&wedges),
        mixed(2),
        quadratic(&ball(3, 1)),
    ];
    for shape in shapes {
        assert_eq!(found(&shape), []);
        let summary = Summary::of(&shape);
        assert!(summary.conforming && summary.inverted == 0);
        assert!(summary.surface.is_some_and(|s| s.closed));
    }
}

#[test]
fn points_that_are_no_place_that_none_uses_or_that_coincide() {
    let points = [
        [0., 0., 0.],
        [1., 0., 0.],
        [0., 1., 0.],
        [0., 0., 1.],
        [f64::NAN, 0., 0.],
        [5., 6., 7.],
        [0.0, -0.0, 1.0],
    ];
    let mesh = mesh(&points, &[(CellKind::TETRA, &[0, 1, 2, 3]), (CellKind::TETRA, &[0, 1, 2, 4])]);
    let defects = check(&mesh);
    let of = |kind| defects.iter().find(|d| d.kind == kind).unwrap();
    assert_eq!(of(DefectKind::NonFinitePoint).examples[0].vertices, [VertexId(4)]);
    assert_eq!(of(DefectKind::NonFinitePoint).examples[0].at, None);
    assert_eq!(of(DefectKind::OrphanPoint).count, 2);
    assert_eq!(of(DefectKind::OrphanPoint).examples[0].at, Some([5., 6., 7.]));
    assert_eq!(of(DefectKind::DuplicatePoint).examples[0].vertices, [VertexId(3), VertexId(6)]);
    let summary = Summary::of(&mesh);
    assert!((summary.volume - 1.0 / 6.0).abs() < 1e-15);
    assert_eq!(summary.bounds, Some([[0.0; 3], [5., 6., 7.]]));
    assert!((summary.quality.unwrap().eas.min - 0.75).abs() < 1e-15);
}

#[test]
fn inverted_flat_and_repeating_cells() {
    let tet: (CellKind, &[u32]) = (CellKind::TETRA, &[0, 1, 3, 4]);
    assert_eq!(found(&mesh(&CUBE[..5], &[tet]))[..], [(DefectKind::OrphanPoint, 1)]);
    let turned =
        mesh(&CUBE, &[(CellKind::TETRA, &[1, 0, 3, 4]), (CellKind::HEXAHEDRON, &[4, 5, 6, 7, 0, 1, 2, 3])]);
    let defects = check(&turned);
    let inverted = defects.iter().find(|d| d.kind == DefectKind::InvertedCell).unwrap();
    // A tet that shares no facet with others is numbered the other way round.
    assert_eq!(inverted.count, 1);
    assert_eq!(inverted.examples[0].cells, [CellId(1)]);
    assert_eq!((Summary::of(&turned).inverted, Summary::of(&turned).turned), (1, 1));

    let flat = found(&mesh(&CUBE, &[(CellKind::TETRA, &[0, 1, 2, 3]), (CellKind::TETRA, &[0, 1, 3, 3])]));
    assert!(flat.contains(&(DefectKind::FlatCell, 2)) && flat.contains(&(DefectKind::RepeatedVertex, 1)));
    let line = [[0., 0., 0.], [1., 1., 1.], [3., 3., 3.]];
    assert!(
        found(&mesh(&line, &[(CellKind::TRIANGLE, &[0, 1, 2])])).contains(&(DefectKind::ZeroAreaCell, 1))
    );
}

#[test]
fn flatness_is_decided_exactly() {
    // Near the plane x + y + z = 1: as binary fractions 0.1, 0.2 and 0.7 do not sum to 1
    // (they miss by 2^-55, which the sum in double precision does not show).
    let is_flat = |last: Point| {
        let points = [[1., 0., 0.], [0., 1., 0.], [0., 0., 1.], last];
        let kinds = found(&mesh(&points, &[(CellKind::TETRA, &[0, 1, 2, 3])]));
        kinds.contains(&(DefectKind::FlatCell, 1))
    };
    assert!(!is_flat([0.1, 0.2, 0.7]));
    assert!(is_flat([0.125, 0.25, 0.625]));
}

#[test]
fn a_tet_folded_onto_its_neighbour() {
    let points = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0.2, 0.2, 1.], [0.3, 0.2, 2.], [0.2, 0.3, -1.]];
    let of = |x: &[u32], y: &[u32]| check(&mesh(&points, &[(CellKind::TETRA, x), (CellKind::TETRA, y)]));
    let folded = of(&[0, 1, 2, 3], &[0, 1, 2, 4]);
    let defect = folded.iter().find(|d| d.kind == DefectKind::FoldedFacet).expect("it is found");
    assert_eq!((defect.count, &defect.examples[0].cells[..]), (1, &[CellId(0), CellId(1)][..]));
    assert!(!is_conforming(&folded));
    // Side by side, numbered either way, nothing is folded; nor is an inverted tet.
    for other in [[0, 2, 1, 5], [0, 1, 2, 5], [0, 2, 1, 4]] {
        assert!(of(&[0, 1, 2, 3], &other).iter().all(|d| d.kind != DefectKind::FoldedFacet), "{other:?}");
    }
}

#[test]
fn cells_that_do_not_fit_together() {
    let above: Vec<Point> =
        CUBE.iter().copied().chain([[0.5, 0.5, 2.0], [0.5, 0.5, 3.0], [0.5, 0.5, 4.0]]).collect();
    let tet = |apex| vec![4, 5, 6, apex];
    let (a, b, c) = (tet(8), tet(9), tet(10));
    let three = mesh(&above, &[(CellKind::TETRA, &a), (CellKind::TETRA, &b), (CellKind::TETRA, &c)]);
    let defects = check(&three);
    let overshared = defects.iter().find(|d| d.kind == DefectKind::OversharedFacet).unwrap();
    assert_eq!(overshared.examples[0].cells, [0, 1, 2].map(CellId));
    assert!(!is_conforming(&defects));

    let twice = found(&mesh(
        &CUBE,
        &[
            (CellKind::TETRA, &[0, 1, 3, 4]),
            (CellKind::TETRA, &[4, 3, 1, 0]),
            (CellKind::QUAD, &[0, 1, 2, 3]),
            (CellKind::QUAD, &[3, 0, 1, 2]),
        ],
    ));
    assert!(twice.contains(&(DefectKind::DuplicateCell, 2)), "{twice:?}");

    let doubled: Vec<Point> =
        CUBE.iter().chain(&[CUBE[4], CUBE[5], CUBE[6], CUBE[7]]).copied().chain([[0.5, 0.5, 2.0]]).collect();
    let cracked = mesh(
        &doubled,
        &[(CellKind::HEXAHEDRON, &[0, 1, 2, 3, 4, 5, 6, 7]), (CellKind::PYRAMID, &[8, 9, 10, 11, 12])],
    );
    let expected =
        [(DefectKind::DuplicatePoint, 4), (DefectKind::UnmergedFacet, 1), (DefectKind::SeparatePart, 2)];
    assert_eq!(found(&cracked), expected);
    assert!(!Summary::of(&cracked).conforming);
}

#[test]
fn a_crack_whose_rim_is_shared_is_still_a_crack() {
    // Two tets whose facets share two corners, and have a third corner each at the same place.
    let points = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 1., 0.], [0.2, 0.2, 1.], [0.2, 0.2, -1.]];
    let tets = mesh(&points, &[(CellKind::TETRA, &[0, 1, 2, 4]), (CellKind::TETRA, &[1, 0, 3, 5])]);
    assert!(found(&tets).contains(&(DefectKind::UnmergedFacet, 1)));
}

#[test]
fn a_wall_divided_on_one_side_only() {
    // A cube with a quarter cube on its top: three of its upper corners hang.
    let mut points = CUBE.to_vec();
    points.extend([[0.5, 0., 1.], [0.5, 0.5, 1.], [0., 0.5, 1.]]);
    points.extend([[0., 0., 1.5], [0.5, 0., 1.5], [0.5, 0.5, 1.5], [0., 0.5, 1.5]]);
    let small: &[u32] = &[4, 8, 9, 10, 11, 12, 13, 14];
    let cubes =
        mesh(&points, &[(CellKind::HEXAHEDRON, &[0, 1, 2, 3, 4, 5, 6, 7]), (CellKind::HEXAHEDRON, small)]);
    let defects = check(&cubes);
    assert_eq!(
        defects.iter().map(|d| (d.kind, d.count)).collect::<Vec<_>>()[0],
        (DefectKind::HangingVertex, 3)
    );
    assert_eq!(defects[0].examples[1].at, Some([0.5, 0.5, 1.0]));
    assert!(!is_conforming(&defects));
    // The same mesh far from the origin, and in another unit.
    for (scale, shift) in [(1e-3, 0.0), (1e3, 0.0), (1.0, 1000.0)] {
        let mut moved = cubes.clone();
        moved.points.iter_mut().for_each(|p| *p = p.map(|x| x * scale + shift));
        assert!(found(&moved).contains(&(DefectKind::HangingVertex, 3)), "{scale} {shift}");
    }
}

#[test]
fn boundaries_that_touch_themselves() {
    let edge = [[0., 0., 0.], [0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]];
    let on_an_edge = mesh(&edge, &[(CellKind::TETRA, &[0, 2, 3, 1]), (CellKind::TETRA, &[0, 4, 5, 1])]);
    assert_eq!(found(&on_an_edge), [(DefectKind::NonManifoldEdge, 1)]);
    let corner =
        [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [-1., 0., 0.], [0., -1., 0.], [0., 0., -1.]];
    let at_a_corner = mesh(&corner, &[(CellKind::TETRA, &[0, 1, 2, 3]), (CellKind::TETRA, &[0, 5, 4, 6])]);
    let defects = check(&at_a_corner);
    assert_eq!(found(&at_a_corner), [(DefectKind::NonManifoldVertex, 1)]);
    assert_eq!(defects[0].examples[0].vertices, [VertexId(0)]);
    assert!(is_conforming(&defects), "pinched, but every facet fits");
}

#[test]
fn surfaces_that_are_open_turned_over_or_non_manifold() {
    let triangle = |a: &'static [u32]| (CellKind::TRIANGLE, a);
    let open = mesh(&CUBE[..4], &[triangle(&[0, 1, 2]), triangle(&[0, 2, 3])]);
    assert_eq!(found(&open), [(DefectKind::OpenEdge, 4)]);
    assert!(!Summary::of(&open).surface.unwrap().closed);
    let turned = mesh(&CUBE[..4], &[triangle(&[0, 1, 2]), triangle(&[0, 3, 2])]);
    assert_eq!(found(&turned), [(DefectKind::OpenEdge, 4), (DefectKind::MisorientedEdge, 1)]);
    let book = mesh(&CUBE[..5], &[triangle(&[0, 1, 2]), triangle(&[0, 1, 3]), triangle(&[0, 1, 4])]);
    assert_eq!(found(&book), [(DefectKind::OpenEdge, 6), (DefectKind::NonManifoldEdge, 1)]);
}

#[test]
fn the_middle_nodes_of_lagrange_cells_are_no_corners() {
    let sides: [&[u32]; 4] =
        [&[0, 2, 1, 6, 5, 4], &[0, 1, 3, 4, 8, 7], &[1, 2, 3, 5, 9, 8], &[2, 0, 3, 6, 7, 9]];
    let mut points = vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];
    points.extend([[1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0., 0., 1.], [1., 0., 1.], [0., 1., 1.]]);
    assert_eq!(found(&mesh(&points, &sides.map(|side| (CellKind::LAGRANGE_TRIANGLE, side)))), []);
}

#[test]
fn parts_are_counted_and_the_display_names_places() {
    let mut points = CUBE.to_vec();
    points.extend(CUBE.map(|p| p.map(|x| x + 10.0)));
    let hexahedron: Vec<u32> = (0..8).collect();
    let far: Vec<u32> = (8..16).collect();
    let two = mesh(&points, &[(CellKind::HEXAHEDRON, &hexahedron), (CellKind::HEXAHEDRON, &far)]);
    let defects = check(&two);
    assert_eq!(found(&two), [(DefectKind::SeparatePart, 2)]);
    assert_eq!(
        defects[0].to_string(),
        "2 separate_part (a part of the mesh that is not connected to the rest): cell 0 at (0.500000, 0.500000, 0.500000); \
         cell 1 at (10.500000, 10.500000, 10.500000)"
    );
}

#[test]
fn the_summary_has_the_keys_that_scripts_rely_on() {
    let json = serde_json::to_value(Summary::of(&sphere_in_box(4, 2))).unwrap();
    assert_eq!(json["points"], 98 * 3);
    assert_eq!(json["cells"]["tetra"], 6 * 96 * 2);
    assert_eq!(json["cells"]["triangle"], 2 * 2 * 96);
    assert_eq!(json["bounds"], serde_json::json!([[-5.0, -5.0, -5.0], [5.0, 5.0, 5.0]]));
    assert_eq!(json["regions"]["fluid"]["tets"], 6 * 96 * 2);
    assert_eq!(json["regions"]["fluid"]["volume"], json["volume"]);
    assert_eq!(json["patches"]["box"]["triangles"], 2 * 96);
    assert!((json["patches"]["box"]["area"].as_f64().unwrap() - 600.0).abs() < 1e-11);
    assert_eq!(json["patches"]["sphere"]["closed"], true);
    for key in ["min", "mean", "bad"] {
        assert!(json["quality"]["eas"][key].is_number());
    }
    assert!(json["quality"]["dihedral_deg"]["min"].as_f64().unwrap() > 1.0);
    assert!(json["quality"]["dihedral_deg"]["max"].as_f64().unwrap() < 180.0);
    assert!(
        json["quality"]["mean_ratio"]["min"].is_number() && json["quality"]["mean_ratio"]["mean"].is_number()
    );
    assert_eq!((&json["inverted"], &json["conforming"]), (&0.into(), &true.into()));
    assert_eq!(json["defects"], serde_json::json!([]));
    let counted: u64 =
        json["quality"]["eas"]["histogram"].as_array().unwrap().iter().filter_map(|n| n.as_u64()).sum();
    assert_eq!(counted, 6 * 96 * 2);
}

#[test]
fn hopeless_meshes_are_reported_about_in_bounded_time() {
    // Every tet spans the whole mesh, and one facet has thousands of cells.
    let n = 3000u32;
    let points: Vec<Point> = (0..n)
        .map(|i| {
            [17, 31, 47]
                .map(|k| f64::from(i.wrapping_mul(2_654_435_761).rotate_left(k)) / f64::from(u32::MAX))
        })
        .collect();
    let mut cells = Cells::new();
    for i in 0..20_000 {
        cells.push(CellKind::TETRA, [i, i * 7 + 1, i * 13 + 2, i * 29 + 3].map(|v| VertexId(v % n)));
        cells.push(CellKind::TETRA, [0, 1, 2, 3].map(VertexId));
    }
    let defects = check(&Mesh::new(points, cells));
    let duplicates = defects.iter().find(|d| d.kind == DefectKind::DuplicateCell).unwrap();
    assert!(duplicates.count >= 19_999 && duplicates.examples.len() == 5);
}

/// Real meshes with the values that other programs measured (angles in degrees): file, tets, inverted,
/// smallest and largest dihedral angle, smallest and mean mean-ratio.
type Measured = (&'static str, usize, usize, [f64; 2], [f64; 2]);
const MEASURED: &[Measured] = &[
    ("tetmeshes/pescio_AbdominalAorticAneurysm.msh", 8404, 0, [0.155, 179.6], [0.0108, 0.501]),
    ("tetmeshes/sv_ale_pipe/lumen.vtu", 204_705, 0, [13.8, 156.2], [0.413, 0.86]),
    ("tetmeshes/sv_ale_pipe/wall.vtu", 85_220, 0, [16.4, 154.6], [0.425, 0.875]),
    ("tetmeshes/sv_boundary_layer_pipe/lumen.vtu", 170_694, 0, [7.67, 165.0], [0.285, 0.634]),
    ("tetmeshes/ambit_pipe_fsi/pipe_fsi_domain.vtu", 4953, 0, [4.95, 172.0], [0.201, 0.808]),
    ("moving_wall/ambit_la_lv/lalv_domain_with_aledisp.vtu", 8225, 0, [11.6, 154.4], [0.311, 0.806]),
    ("bad_tets/polyfem_microstructure_P1.msh", 6414, 8, [0.0362, 179.4], [-0.147, 0.387]),
    ("bad_tets/polyfem_screw.msh", 6059, 0, [0.0127, 180.0], [0.00143, 0.5]),
];

/// Whether `x` is `expected` to half of its third digit.
fn to_three_digits(x: f64, expected: f64) -> bool {
    (x - expected).abs() <= expected.abs() * 5.1e-3
}

#[test]
fn real_meshes_are_as_others_measured_them() {
    let folder = std::env::var("MOTET_DATA")
        .unwrap_or_else(|_| concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data").into());
    let folder = std::path::Path::new(&folder);
    if !folder.is_dir() {
        println!("skipped: no real meshes in {}; set MOTET_DATA", folder.display());
        return;
    }
    for (file, tets, inverted, dihedral, ratio) in MEASURED {
        let summary = Summary::of(&motet::io::read(folder.join(file)).unwrap());
        assert_eq!((summary.cells["tetra"], summary.inverted), (*tets, *inverted), "{file}");
        let quality = summary.quality.unwrap();
        let found = [
            quality.dihedral_deg.min,
            quality.dihedral_deg.max,
            quality.mean_ratio.min,
            quality.mean_ratio.mean,
        ];
        for (found, expected) in found.into_iter().zip(dihedral.iter().chain(ratio)) {
            assert!(to_three_digits(found, *expected), "{file}: {found} {expected}");
        }
        assert!(summary.conforming, "{file}: {:?}", summary.defects);
    }
}
