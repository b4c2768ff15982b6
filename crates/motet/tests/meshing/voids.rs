//! Cavities enclosed by closed surfaces turned inward, and surfaces that are far coarser than the sizes
//! inside.

use motet::base::{Point, Threads, VertexId};
use motet::mesh::shapes::box_grid;
use motet::mesh::{CellKind, Cells, Mesh, Surface};
use motet::meshing::{Filled, Options, Seed, Sizes, Surfaces, fill};
use motet::preflight::{Repairs, Role};

/// The surface of a cube around the origin with this side, of `n` cubes along each; turned inward on request.
fn cube(n: usize, side: f64, is_inward: bool) -> Mesh {
    let surface = Surface::boundary_of(&box_grid([n; 3], [[-0.5 * side; 3], [0.5 * side; 3]]));
    let turned = |t: &[VertexId; 3]| if is_inward { [t[0], t[2], t[1]] } else { *t };
    let triangles: Vec<[VertexId; 3]> = surface.triangles.iter().map(turned).collect();
    Mesh::new(surface.points, Cells::uniform(CellKind::TRIANGLE, triangles.into_flattened()).unwrap())
}

/// All surfaces in one mesh.
fn one_of(meshes: &[Mesh]) -> Mesh {
    let (mut points, mut ids): (Vec<Point>, Vec<VertexId>) = Default::default();
    for mesh in meshes {
        let first = points.len();
        points.extend(&mesh.points);
        ids.extend(mesh.cells.connectivity().items().iter().map(|v| VertexId::new(first + v.index())));
    }
    Mesh::new(points, Cells::uniform(CellKind::TRIANGLE, ids).unwrap())
}

fn filled(surfaces: &Surfaces, options: &Options) -> Filled {
    let threads = Threads::single();
    fill(surfaces, &surfaces.preflight(&threads), options, &threads).unwrap()
}

fn joined(meshes: &[Mesh]) -> Surfaces {
    let named: Vec<_> = meshes.iter().map(|mesh| (mesh, Role::Boundary, "")).collect();
    Surfaces::new(&named).unwrap()
}

/// The volume of each region, and whether it is a void.
fn volumes_and_voids(filled: &Filled) -> Vec<(f64, bool)> {
    filled.report.bodies.iter().map(|body| ((body.volume * 1e9).round() / 1e9, body.is_void)).collect()
}

const VOIDS: Options = Options {
    edge_points: motet::delaunay::EdgePoints::MoveInside,
    sizes: None,
    dividing: motet::meshing::Dividing::Coarse,
    adapting: motet::meshing::Adapting { distance: None, feature_angle: 40.0 },
    seeds: Vec::new(),
    holes: Vec::new(),
    voids: true,
    improve: None,
    layers: None,
};

#[test]
fn what_surfaces_turned_inward_enclose_is_left_out_on_request() {
    let hollow = [cube(2, 2.0, false), cube(1, 1.0, true)];
    for surfaces in [joined(&hollow), joined(&[one_of(&hollow)])] {
        let whole = filled(&surfaces, &Options::default());
        assert_eq!(volumes_and_voids(&whole), [(7.0, false), (1.0, true)]);
        let without = filled(&surfaces, &VOIDS);
        assert_eq!((volumes_and_voids(&without), without.report.voids), (vec![(7.0, false)], 1));
    }
}

#[test]
fn surfaces_that_face_outward_or_all_inward_enclose_no_void() {
    for is_inward in [false, true] {
        let surfaces = joined(&[cube(2, 2.0, is_inward), cube(1, 1.0, is_inward)]);
        assert_eq!(volumes_and_voids(&filled(&surfaces, &VOIDS)), [(7.0, false), (1.0, false)]);
    }
}

#[test]
fn shells_alternate_and_a_seed_keeps_a_void() {
    // A cavity with a body inside, and one beside another in the same space.
    let shells = [cube(2, 4.0, false), cube(2, 3.0, true), cube(1, 1.0, false)];
    let surfaces = joined(&shells);
    let without = filled(&surfaces, &VOIDS);
    assert_eq!((volumes_and_voids(&without), without.report.voids), (vec![(37.0, false), (1.0, false)], 1));
    let seeds = vec![Seed { place: [1.2, 0.1, 0.2], name: "air".to_owned() }];
    let kept = filled(&surfaces, &Options { seeds, ..VOIDS });
    assert_eq!(
        (volumes_and_voids(&kept), kept.report.voids),
        (vec![(37.0, false), (26.0, true), (1.0, false)], 0)
    );
}

#[test]
fn a_repair_can_leave_surfaces_turned_inward() {
    for (keep_inward, expected) in [(true, vec![(7.0, false)]), (false, vec![(7.0, false), (1.0, false)])] {
        let mut surfaces = joined(&[one_of(&[cube(2, 2.0, false), cube(1, 1.0, true)])]);
        let repairs = Repairs { keep_inward, ..Repairs::all(0.0, 8) };
        surfaces.repair(&repairs, &Threads::single()).unwrap();
        assert_eq!(volumes_and_voids(&filled(&surfaces, &VOIDS)), expected);
    }
}

#[test]
fn a_surface_far_coarser_than_the_size_is_named_with_its_edges() {
    let surfaces = joined(&[cube(1, 1.0, false)]);
    let coarse = Sizes::Uniform(0.2).coarse(&surfaces).expect("edges of length 1 are far longer");
    assert_eq!(coarse.edges, [1.0, 1.0, 2f64.sqrt()]);
    assert!(coarse.to_string().contains("coarser than the size 0.2"), "{coarse}");
    assert_eq!(
        filled(&surfaces, &Options::with_sizes(Some(Sizes::Uniform(0.2)), None)).report.coarse,
        Some(coarse)
    );
    // One coarse face of many does not make a surface coarse, nor is a surface as fine as the size.
    assert_eq!(Sizes::Uniform(0.5).coarse(&surfaces), None);
    assert_eq!(Sizes::Uniform(0.2).coarse(&joined(&[cube(4, 1.0, false)])), None);
}
