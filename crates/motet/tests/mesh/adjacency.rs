//! Facets, boundary and neighbours: tables are compared with reference cells, results with brute force.

use std::collections::{BTreeMap, BTreeSet};

use motet::base::{CellId, Csr, Point, VertexId};
use motet::geometry::vector::{add, scale};
use motet::mesh::adjacency::{Facets, vertex_to_cells};
use motet::mesh::facets::facet_shapes;
use motet::mesh::tet_facets::tet_neighbors;
use motet::mesh::{Boundary, CellKind, Cells, cell_volumes, cone_volume};
use proptest::prelude::*;

pub(crate) const HEX: [Point; 8] = [
    [0., 0., 0.],
    [1., 0., 0.],
    [1., 1., 0.],
    [0., 1., 0.],
    [0., 0., 1.],
    [1., 0., 1.],
    [1., 1., 1.],
    [0., 1., 1.],
];
const WEDGE: [Point; 6] =
    [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 0., 1.], [0., 1., 1.]];
const TET_EDGES: &[&[usize]] = &[&[0, 1], &[1, 2], &[2, 0], &[0, 3], &[1, 3], &[2, 3]];
const WEDGE_RIM_EDGES: &[&[usize]] = &[&[0, 1], &[1, 2], &[2, 0], &[3, 4], &[4, 5], &[5, 3]];
const PILLARS_3: &[&[usize]] = &[&[0, 3], &[1, 4], &[2, 5]];
const WEDGE_SIDES: &[&[usize]] = &[&[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]];
const PYRAMID_EDGES: &[&[usize]] = &[&[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 4], &[1, 4], &[2, 4], &[3, 4]];
const HEX_EDGES: &[&[usize]] = &[
    &[0, 1],
    &[1, 2],
    &[2, 3],
    &[3, 0],
    &[4, 5],
    &[5, 6],
    &[6, 7],
    &[7, 4],
    &[0, 4],
    &[1, 5],
    &[2, 6],
    &[3, 7],
];
const HEX_SIDES: &[&[usize]] = &[&[0, 4, 7, 3], &[1, 2, 6, 5], &[0, 1, 5, 4], &[3, 7, 6, 2]];
const HEX_ENDS: &[&[usize]] = &[&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 2, 3, 4, 5, 6, 7]];

/// The corners, and a node in the middle of each of `groups` of corners.
fn with_middles(corners: &[Point], groups: &[&[&[usize]]]) -> Vec<Point> {
    let middle = |group: &&[usize]| {
        scale(group.iter().fold([0.0; 3], |sum, &i| add(sum, corners[i])), 1.0 / group.len() as f64)
    };
    corners.iter().copied().chain(groups.iter().flat_map(|g| g.iter()).map(middle)).collect()
}

fn prism(n: usize) -> Vec<Point> {
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
    [0.0, 1.0].iter().flat_map(|&z| (0..n).map(move |i| [angle(i).cos(), angle(i).sin(), z])).collect()
}

/// A reference cell of every kind, as VTK's class documentation numbers it, and its volume.
fn reference_cells() -> Vec<(CellKind, Vec<Point>, f64)> {
    let tet = [HEX[0], HEX[1], HEX[3], HEX[4]];
    let pyramid = [HEX[0], HEX[1], HEX[2], HEX[3], [0.5, 0.5, 1.0]];
    let polygon_area = |n: f64| n / 2.0 * (std::f64::consts::TAU / n).sin();
    let voxel = [0, 1, 3, 2, 4, 5, 7, 6].map(|i| HEX[i]);
    let hex27 = with_middles(&HEX, &[HEX_EDGES, HEX_SIDES, HEX_ENDS]);
    vec![
        (CellKind::TETRA, tet.to_vec(), 1.0 / 6.0),
        (CellKind::VOXEL, voxel.to_vec(), 1.0),
        (CellKind::HEXAHEDRON, HEX.to_vec(), 1.0),
        (CellKind::WEDGE, WEDGE.to_vec(), 0.5),
        (CellKind::PYRAMID, pyramid.to_vec(), 1.0 / 3.0),
        (CellKind::PENTAGONAL_PRISM, prism(5), polygon_area(5.0)),
        (CellKind::HEXAGONAL_PRISM, prism(6), polygon_area(6.0)),
        (CellKind::QUADRATIC_TETRA, with_middles(&tet, &[TET_EDGES]), 1.0 / 6.0),
        (CellKind::QUADRATIC_HEXAHEDRON, hex27[..20].to_vec(), 1.0),
        (CellKind::BIQUADRATIC_QUADRATIC_HEXAHEDRON, hex27[..24].to_vec(), 1.0),
        (CellKind::TRIQUADRATIC_HEXAHEDRON, hex27, 1.0),
        (CellKind::QUADRATIC_LINEAR_WEDGE, with_middles(&WEDGE, &[WEDGE_RIM_EDGES]), 0.5),
        (CellKind::QUADRATIC_WEDGE, with_middles(&WEDGE, &[WEDGE_RIM_EDGES, PILLARS_3]), 0.5),
        (
            CellKind::BIQUADRATIC_QUADRATIC_WEDGE,
            with_middles(&WEDGE, &[WEDGE_RIM_EDGES, PILLARS_3, WEDGE_SIDES]),
            0.5,
        ),
        (CellKind::QUADRATIC_PYRAMID, with_middles(&pyramid, &[PYRAMID_EDGES]), 1.0 / 3.0),
    ]
}

fn ids(list: impl IntoIterator<Item = usize>) -> Vec<VertexId> {
    list.into_iter().map(VertexId::new).collect()
}

#[test]
fn every_kind_is_closed_by_facets_that_face_outward() {
    for (kind, points, volume) in reference_cells() {
        assert_eq!(kind.n_vertices(), Some(points.len()), "{}", kind.label());
        let centre = scale(points.iter().fold([0.0; 3], |s, p| add(s, *p)), 1.0 / points.len() as f64);
        let mut edges = BTreeSet::new();
        for facet in facet_shapes(kind).unwrap() {
            let ring = ids(facet.corners().iter().map(|&i| i as usize));
            assert!(cone_volume(ring.iter().copied(), &points, centre) > 0.0, "{} {ring:?}", kind.label());
            for i in 0..ring.len() {
                assert!(edges.insert((ring[i], ring[(i + 1) % ring.len()])), "{}", kind.label());
            }
        }
        assert!(edges.iter().all(|&(a, b)| edges.contains(&(b, a))), "{}", kind.label());
        let cells = Cells::uniform(kind, ids(0..points.len())).unwrap();
        assert!((cell_volumes(&cells, &points)[0] - volume).abs() < 1e-14, "{}", kind.label());
        assert_eq!(Boundary::of(&cells).len(), facet_shapes(kind).unwrap().len());
    }
}

#[test]
fn middle_nodes_of_a_facet_follow_its_edges() {
    for (kind, points, _) in reference_cells() {
        for facet in facet_shapes(kind).unwrap() {
            let corner = |i: usize| points[facet.corners()[i % facet.n_corners] as usize];
            let middles = &facet.nodes[facet.n_corners..];
            for (i, &node) in middles.iter().enumerate() {
                let expected = match (facet.kind, i) {
                    (CellKind::QUADRATIC_LINEAR_QUAD, i) => scale(add(corner(2 * i), corner(2 * i + 1)), 0.5),
                    (_, i) if i < facet.n_corners => scale(add(corner(i), corner(i + 1)), 0.5),
                    _ => scale((0..facet.n_corners).fold([0.0; 3], |s, i| add(s, corner(i))), 0.25),
                };
                assert_eq!(points[node as usize], expected, "{} {:?}", kind.label(), facet.nodes);
            }
            assert_eq!(facet.kind.n_vertices().unwrap_or(facet.nodes.len()), facet.nodes.len());
        }
    }
}

#[test]
fn turning_a_mirrored_cell_outward_mends_its_facets_middles_and_all() {
    for (kind, points, _) in reference_cells() {
        let mirrored: Vec<Point> = points.iter().map(|p| [-p[0], p[1], p[2]]).collect();
        let cells = Cells::uniform(kind, ids(0..points.len())).unwrap();
        let mut boundary = Boundary::of(&cells);
        boundary.turn_outward(&cells, &mirrored);
        let shapes = facet_shapes(kind).unwrap();
        for (facet, shape) in boundary.facets.iter().zip(shapes) {
            let n = shape.n_corners;
            assert!(cone_volume(facet[..n].iter().copied(), &mirrored, [-0.3, 0.3, 0.3]) > 0.0);
            let at = |i: usize| mirrored[facet[i].index()];
            for (i, _) in facet[n..].iter().enumerate().take(n) {
                let first = if shape.kind == CellKind::QUADRATIC_LINEAR_QUAD { 2 * i } else { i };
                assert_eq!(at(n + i), scale(add(at(first), at((first + 1) % n)), 0.5), "{}", kind.label());
            }
        }
    }
}

#[test]
fn a_polyhedron_and_a_hexahedron_share_their_quad() {
    let mut cells = Cells::new();
    cells.push(CellKind::HEXAHEDRON, ids(0..8));
    // A pyramid on top of the hexahedron, written as a polyhedron.
    let mut faces = Csr::default();
    for face in [&[7, 6, 5, 4][..], &[4, 5, 8], &[5, 6, 8], &[6, 7, 8], &[7, 4, 8]] {
        faces.push(ids(face.iter().copied()));
    }
    cells.push_polyhedron(ids(4..9), faces);
    let boundary = Boundary::of(&cells);
    assert_eq!(boundary.len(), 5 + 4);
    assert_eq!(boundary.vertices, ids(0..9));
    assert_eq!(boundary.cells.iter().filter(|c| c.0 == 1).count(), 4);
    let mut points = HEX.to_vec();
    points.push([0.5, 0.5, 2.0]);
    let volumes = cell_volumes(&cells, &points);
    assert!((volumes[0] - 1.0).abs() < 1e-14 && (volumes[1] - 1.0 / 3.0).abs() < 1e-14);
}

#[test]
fn a_polyhedron_may_name_vertices_in_its_faces_alone() {
    let mut faces = Csr::default();
    for face in [&[0, 1, 2][..], &[0, 1, 9], &[1, 2, 9], &[2, 0, 9], &[3, 4], &[]] {
        faces.push(ids(face.iter().copied()));
    }
    let mut cells = Cells::new();
    cells.push_polyhedron(ids(0..3), faces);
    assert_eq!(Boundary::of(&cells).vertices, ids([0, 1, 2, 9]));
}

#[test]
fn quads_that_agree_in_three_sorted_corners_are_distinguished() {
    let mut cells = Cells::new();
    cells.push(CellKind::PYRAMID, ids([0, 1, 2, 9, 10]));
    cells.push(CellKind::PYRAMID, ids([0, 1, 3, 9, 11]));
    assert_eq!(Boundary::of(&cells).len(), 10);
}

#[test]
fn a_collapsed_hexahedron_is_the_wedge_that_it_stands_for() {
    let mut cells = Cells::new();
    cells.push(CellKind::HEXAHEDRON, ids([0, 1, 2, 2, 4, 5, 6, 6]));
    cells.push(CellKind::WEDGE, ids([0, 2, 3, 4, 6, 7]));
    let boundary = Boundary::of(&cells);
    assert_eq!(boundary.len(), 4 + 4, "the wall between them is shared, the collapsed side is no facet");
}

#[test]
fn cells_of_other_dimensions_have_no_part_in_the_boundary() {
    let mut cells = Cells::new();
    cells.push(CellKind::TRIANGLE, ids([0, 1, 2]));
    cells.push(CellKind::TETRA, ids([0, 1, 2, 3]));
    cells.push(CellKind::LINE, ids([0, 1]));
    cells.push(CellKind::LAGRANGE_TETRAHEDRON, ids([0, 1, 2, 3]));
    let boundary = Boundary::of(&cells);
    assert_eq!((boundary.len(), boundary.n_unknown), (4, 1));
    assert!(boundary.cells.iter().all(|c| c.0 == 1));
    assert!(Boundary::of(&Cells::new()).is_empty());
}

/// Any list of tets over few vertices: degenerate, repeated, sharing a facet many times.
fn any_tets() -> impl Strategy<Value = Vec<[VertexId; 4]>> {
    prop::collection::vec(prop::array::uniform4((0u32..9).prop_map(VertexId)), 0..30)
}

fn sorted_facet(tet: [VertexId; 4], i: usize) -> Vec<VertexId> {
    let corners: BTreeSet<_> = (0..4).filter(|&j| j != i).map(|j| tet[j]).collect();
    corners.into_iter().collect()
}

proptest! {
    #[test]
    fn boundary_and_neighbours_are_those_of_a_map_of_facets(tets in any_tets()) {
        let mut uses: BTreeMap<Vec<VertexId>, Vec<(u32, usize)>> = BTreeMap::new();
        for (t, tet) in tets.iter().enumerate() {
            for i in 0..4 {
                uses.entry(sorted_facet(*tet, i)).or_default().push((t as u32, i));
            }
        }
        uses.retain(|facet, _| facet.len() == 3);
        let neighbors = tet_neighbors(&tets);
        for (t, tet) in tets.iter().enumerate() {
            for (i, &neighbor) in neighbors[t].iter().enumerate() {
                let of_facet = uses.get(&sorted_facet(*tet, i)).map_or(&[][..], |u| &u[..]);
                let expected = match of_facet {
                    [a, b] => Some(if *a == (t as u32, i) { b.0 } else { a.0 }),
                    _ => None,
                };
                prop_assert_eq!(neighbor.get().map(|tet| tet.0), expected);
            }
        }
        let cells = Cells::uniform(CellKind::TETRA, tets.as_flattened().to_vec()).unwrap();
        let boundary = Boundary::of(&cells);
        let found: BTreeSet<Vec<VertexId>> =
            boundary.facets.iter().map(|f| f.iter().copied().collect::<BTreeSet<_>>().into_iter().collect()).collect();
        let expected: BTreeSet<_> = uses.iter().filter(|(_, u)| u.len() == 1).map(|(f, _)| f.clone()).collect();
        prop_assert_eq!(boundary.len(), expected.len());
        prop_assert_eq!(found, expected);
        let mut n_uses = 0;
        Facets::of(&cells).for_each_shared(|u| n_uses += u.len());
        prop_assert_eq!(n_uses, uses.values().map(Vec::len).sum::<usize>());
    }

    #[test]
    fn cells_around_a_vertex_are_those_that_name_it(tets in any_tets()) {
        let cells = Cells::uniform(CellKind::TETRA, tets.as_flattened().to_vec()).unwrap();
        let around = vertex_to_cells(&cells, 9);
        for v in 0..9 {
            let expected: Vec<CellId> = cells
                .iter()
                .flat_map(|(cell, _, vs)| vs.iter().filter(move |w| w.index() == v).map(move |_| cell))
                .collect();
            prop_assert_eq!(around.list(v), &expected[..]);
        }
    }
}
