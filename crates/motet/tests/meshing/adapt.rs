//! Surfaces of needles, which force bad tets: adapted first, they do not.

use motet::base::{CellId, Point, Threads, VertexId};
use motet::geometry::triangle::at;
use motet::mesh::shapes::{Aneurysm, box_grid};
use motet::mesh::{Mesh, Qualities, Surface};
use motet::meshing::{Adapting, Dividing, Filled, Options, Sizes, Surfaces, fill};
use motet::preflight::Role;

/// A surface with a vertex close to an edge in every third triangle.
fn with_needles(mesh: &Mesh) -> Mesh {
    let mut surface = Surface::own_or_boundary_of(mesh);
    for t in (0..surface.triangles.len()).step_by(3) {
        let [a, b, c] = surface.triangles[t];
        let new = VertexId::new(surface.points.len());
        surface.points.push(at(surface.corners(t), [0.02, 0.45, 0.53]));
        surface.triangles[t] = [a, b, new];
        for triangle in [[b, c, new], [c, a, new]] {
            surface.triangles.push(triangle);
            surface.patches.push(surface.patches[t]);
        }
    }
    let mut cells = motet::mesh::Cells::new();
    surface.triangles.iter().for_each(|t| cells.push(motet::mesh::CellKind::TRIANGLE, *t));
    let patch = motet::mesh::Field::scalars("patch", surface.patches);
    Mesh { cell_data: vec![patch], ..Mesh::new(surface.points, cells) }
}

fn filled(mesh: &Mesh, size: f64, dividing: Dividing, distance: f64) -> (Filled, Options) {
    let threads = Threads::single();
    let surfaces = Surfaces::new(&[(mesh, Role::Boundary, "")]).unwrap();
    let adapting = Adapting { distance: Some(distance), ..Adapting::default() };
    let options = Options { dividing, adapting, ..Options::with_sizes(Some(Sizes::Uniform(size)), None) };
    (fill(&surfaces, &surfaces.preflight(&threads), &options, &threads).unwrap(), options)
}

/// The boundary of a box, as triangles.
fn box_of(corners: [Point; 2]) -> Mesh {
    let surface = Surface::boundary_of(&box_grid([1; 3], corners));
    let mut cells = motet::mesh::Cells::new();
    surface.triangles.iter().for_each(|t| cells.push(motet::mesh::CellKind::TRIANGLE, *t));
    Mesh::new(surface.points, cells)
}

fn volume(mesh: &Mesh) -> f64 {
    motet::mesh::cell_volumes(&mesh.cells, &mesh.points).iter().sum()
}

#[test]
fn needles_of_an_adapted_surface_force_no_bad_tet() {
    let given = Aneurysm::default().mesh().unwrap();
    let needles = with_needles(&given);
    let (size, distance) = (0.3, 0.01);
    let (kept, _) = filled(&needles, size, Dividing::Never, distance);
    let (adapted, options) = filled(&needles, size, Dividing::Adapt, distance);
    assert_eq!(adapted.not_reached(&options), None);
    let [of_kept, of_adapted] =
        [&kept, &adapted].map(|filled| Qualities::of_mesh(&filled.mesh, &Threads::single()).unwrap());
    assert!(of_kept.worst < 0.05 && of_adapted.worst >= 0.2, "{of_kept:?} {of_adapted:?}");
    assert!(of_adapted.mean > of_kept.mean + 0.05, "{of_kept:?} {of_adapted:?}");
    let report = adapted.report.adapted.unwrap();
    assert!(report.to_given <= distance && report.from_given <= distance, "{report:?}");
    // The volume between the surfaces is at most the distance times the area.
    let surface = Surface::of(&adapted.mesh);
    let area: f64 =
        (0..surface.triangles.len()).map(|t| motet::geometry::triangle::area(surface.corners(t))).sum();
    assert!((volume(&adapted.mesh) - volume(&kept.mesh)).abs() < distance * area);
    let patches = |mesh: &Mesh| mesh.patches().unwrap().used();
    assert_eq!(patches(&adapted.mesh), patches(&kept.mesh));
}

#[test]
fn the_wall_between_two_bodies_stays_one_wall() {
    let (left, right) = (box_of([[0.0; 3], [1.0; 3]]), box_of([[1.0, 0.0, 0.0], [2.0, 1.0, 1.0]]));
    let threads = Threads::single();
    let surfaces =
        Surfaces::new(&[(&left, Role::Boundary, "left"), (&right, Role::Boundary, "right")]).unwrap();
    let options =
        Options { dividing: Dividing::Adapt, ..Options::with_sizes(Some(Sizes::Uniform(0.2)), None) };
    let filled = fill(&surfaces, &surfaces.preflight(&threads), &options, &threads).unwrap();
    assert_eq!(filled.not_reached(&options), None);
    let volumes: Vec<f64> = filled.report.bodies.iter().map(|body| body.volume).collect();
    assert_eq!(volumes.len(), 2);
    assert!(volumes.iter().all(|v| (v - 1.0).abs() < 1e-9), "{volumes:?}");
    assert!(filled.mesh.cells.vertices(CellId::new(0)).len() == 4);
}

#[test]
fn triangles_between_walls_that_are_near_each_other_are_smaller() {
    let (size, distance) = (0.4, 0.002);
    let plate = |thickness: f64| box_of([[0.0; 3], [4.0, 3.0, thickness]]);
    let of = |thickness: f64| filled(&plate(thickness), size, Dividing::Adapt, distance).0;
    let [thin, thick] = [0.1, 1.0].map(of);
    let quality = Qualities::of_mesh(&thin.mesh, &Threads::single()).unwrap();
    assert!(quality.worst >= 0.2 && quality.p1 > 0.25, "{quality:?}");
    let after = |filled: &Filled| filled.report.adapted.unwrap().after;
    assert!(after(&thin) > 2 * after(&thick), "{} {}", after(&thin), after(&thick));
}

#[test]
fn a_distance_out_of_range_is_refused() {
    let threads = Threads::single();
    let needles = with_needles(&Aneurysm::default().mesh().unwrap());
    let surfaces = Surfaces::new(&[(&needles, Role::Boundary, "")]).unwrap();
    for (size, distance) in [(0.3, 0.0), (0.3, -1.0), (0.3, f64::NAN), (1e-9, 0.01)] {
        let adapting = Adapting { distance: Some(distance), ..Adapting::default() };
        let sized = Options::with_sizes(Some(Sizes::Uniform(size)), None);
        let options = Options { dividing: Dividing::Adapt, adapting, ..sized };
        assert!(
            fill(&surfaces, &surfaces.preflight(&threads), &options, &threads).is_err(),
            "{size} {distance}"
        );
    }
}
