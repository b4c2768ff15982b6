//! Surfaces that are far coarser than the sizes inside: divided in their own planes, with their shape
//! preserved.

use std::collections::BTreeMap;

use crate::common::prism::{moved, prism, turned};
use motet::base::{Point, Threads, VertexId};
use motet::geometry::quality::eas;
use motet::geometry::triangle::{area, area_vector};
use motet::geometry::vector::{distance, dot, norm, sub};
use motet::mesh::shapes::box_grid;
use motet::mesh::{CellKind, Cells, Mesh, Surface, cone_volume};
use motet::meshing::{Dividing, Filled, Options, Sizes, Surfaces, fill};
use motet::preflight::Role;

fn joined(meshes: &[(&Mesh, Role)]) -> Surfaces {
    let meshes: Vec<_> = meshes.iter().map(|&(mesh, role)| (mesh, role, "")).collect();
    Surfaces::new(&meshes).unwrap()
}

fn filled(surfaces: &Surfaces, size: f64) -> Filled {
    let threads = Threads::single();
    let options = Options::with_sizes(Some(Sizes::Uniform(size)), None);
    let filled = fill(surfaces, &surfaces.preflight(&threads), &options, &threads).unwrap();
    assert_eq!(filled.not_reached(&options), None);
    filled
}

/// The twelve triangles of a box.
fn box_surface(low: Point, high: Point) -> Mesh {
    let surface = Surface::boundary_of(&box_grid([1; 3], [low, high]));
    let ids = surface.triangles.into_flattened();
    Mesh::new(surface.points, Cells::uniform(CellKind::TRIANGLE, ids).unwrap())
}

fn tets(mesh: &Mesh) -> impl Iterator<Item = [Point; 4]> {
    mesh.cells.tets().map(|(_, tet)| tet.map(|v| mesh.points[v.index()]))
}

fn triangles(mesh: &Mesh) -> Vec<[VertexId; 3]> {
    Surface::of(mesh).triangles
}

/// Edges of triangles, each once.
fn edges(triangles: &[[VertexId; 3]]) -> Vec<[VertexId; 2]> {
    let of = |&[a, b, c]: &[VertexId; 3]| [[a, b], [b, c], [c, a]].map(|[p, q]| [p.min(q), p.max(q)]);
    let mut edges: Vec<[VertexId; 2]> = triangles.iter().flat_map(of).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// The total length of edges at which triangles meet at more than a degree.
fn crease_length(mesh: &Mesh) -> f64 {
    let mut at: BTreeMap<[VertexId; 2], Vec<Point>> = BTreeMap::new();
    let point = |v: VertexId| mesh.points[v.index()];
    for [a, b, c] in triangles(mesh) {
        let normal = area_vector([a, b, c].map(point));
        for [p, q] in [[a, b], [b, c], [c, a]] {
            at.entry([p.min(q), p.max(q)]).or_default().push(normal.map(|x| x / norm(normal)));
        }
    }
    let is_sharp = |normals: &[Point]| matches!(normals, [m, n] if dot(*m, *n) < 0.999_8);
    at.iter().filter(|(_, n)| is_sharp(n)).map(|([a, b], _)| distance(point(*a), point(*b))).sum()
}

fn surface_area(mesh: &Mesh) -> f64 {
    triangles(mesh).iter().map(|t| area(t.map(|v| mesh.points[v.index()]))).sum()
}

fn enclosed(mesh: &Mesh) -> f64 {
    let centre = mesh.points[0];
    triangles(mesh).iter().map(|t| cone_volume(t.iter().copied(), &mesh.points, centre)).sum()
}

fn volume(mesh: &Mesh) -> f64 {
    tets(mesh).map(motet::geometry::tet::volume).sum()
}

fn close(x: f64, y: f64, part: f64) -> bool {
    (x - y).abs() <= part * y.abs()
}

/// Asserts that volume, area and creases are those of the given surface up to rounding, that no tet is bad,
/// and that edges of the surface have about the length `size`, or less.
fn assert_divided(what: &str, surface: &Mesh, size: f64, rounding: f64) {
    let filled = filled(&joined(&[(surface, Role::Boundary)]), size);
    let mesh = &filled.mesh;
    assert!(filled.report.divided.is_some(), "{what}");
    assert!(tets(mesh).all(|tet| eas(tet) >= 0.2), "{what}");
    let boundary = triangles(mesh);
    let lengths = edges(&boundary).into_iter().map(|e| e.map(|v| mesh.points[v.index()]));
    let longest = lengths.map(|[p, q]| distance(p, q)).fold(0.0, f64::max);
    assert!(longest <= 2.0 * size, "{what}: {longest}");
    assert!(
        close(volume(mesh), enclosed(surface), rounding),
        "{what}: {} {}",
        volume(mesh),
        enclosed(surface)
    );
    assert!(close(surface_area(mesh), surface_area(surface), rounding), "{what}");
    assert!(close(crease_length(mesh), crease_length(surface), rounding), "{what}");
}

#[test]
fn coarse_prisms_are_divided_in_their_planes_however_they_lie() {
    for (n, size) in [(3, 0.3), (7, 0.5), (12, 0.4), (40, 0.3), (56, 0.3), (64, 0.3)] {
        let given = prism(n, 1.0, 3.0);
        assert_divided(&format!("{n}"), &given, size, 1e-9);
        assert_divided(&format!("{n} turned"), &turned(&given), size, 1e-9);
    }
    let given = turned(&prism(21, 1.0, 3.0));
    assert_divided("far", &moved(&given, |p| p.map(|x| x + 1e3)), 0.4, 1e-9);
    assert_divided("small", &moved(&given, |p| p.map(|x| 1e-3 * x)), 0.4e-3, 1e-9);
    for shift in [0.0, 100.0, 1e3] {
        let single = moved(&given, |p| p.map(|x| f64::from((x + shift) as f32)));
        assert_divided(&format!("f32, shifted by {shift}"), &single, 0.4, 1e-3);
    }
}

#[test]
fn a_box_is_divided_finely_and_evenly() {
    let given = box_surface([0.0; 3], [1.0, 2.0, 0.5]);
    for size in [0.1, 0.17, 0.29] {
        assert_divided(&format!("{size}"), &given, size, 1e-9);
    }
    // Faces stay exactly in their planes.
    let filled = filled(&joined(&[(&given, Role::Boundary)]), 0.15);
    let on_face =
        |p: Point| [[0.0, 1.0], [0.0, 2.0], [0.0, 0.5]].iter().zip(p).any(|(at, x)| at.contains(&x));
    let boundary = triangles(&filled.mesh);
    assert!(boundary.as_flattened().iter().all(|v| on_face(filled.mesh.points[v.index()])));
    let mut lengths: Vec<f64> = edges(&boundary)
        .into_iter()
        .map(|e| e.map(|v| filled.mesh.points[v.index()]))
        .map(|[p, q]| norm(sub(p, q)))
        .collect();
    lengths.sort_unstable_by(f64::total_cmp);
    let median = lengths[lengths.len() / 2] / 0.15;
    assert!((0.75..1.33).contains(&median), "{median}");
}

#[test]
fn bodies_that_share_a_wall_and_sheets_inside_stay_what_they_are() {
    let [left, right] = [0.0, 1.0].map(|x| box_surface([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0]));
    let sheet = Mesh::new(
        vec![[0.2, 0.3, 0.5], [0.8, 0.3, 0.5], [0.8, 0.7, 0.5], [0.2, 0.7, 0.5]],
        Cells::uniform(CellKind::TRIANGLE, [0, 1, 2, 0, 2, 3].map(VertexId::new).to_vec()).unwrap(),
    );
    let surfaces = joined(&[(&left, Role::Boundary), (&right, Role::Boundary), (&sheet, Role::Membrane)]);
    let filled = filled(&surfaces, 0.15);
    let volumes: Vec<f64> = filled.report.bodies.iter().map(|body| body.volume).collect();
    assert_eq!(volumes.len(), 2);
    assert!(volumes.iter().all(|v| close(*v, 1.0, 1e-12)), "{volumes:?}");
    // Eleven faces, of which the two bodies share one, and the sheet.
    let mesh = &filled.mesh;
    assert!(close(surface_area(mesh), 11.0 + 0.6 * 0.4, 1e-12));
    let in_sheet = |t: &&[VertexId; 3]| {
        t.iter().all(|v| mesh.points[v.index()][2] == 0.5) && {
            let [x, y] = [0, 1].map(|k| t.iter().map(|v| mesh.points[v.index()][k]).sum::<f64>() / 3.0);
            (0.2..0.8).contains(&x) && (0.3..0.7).contains(&y)
        }
    };
    let of_sheet: f64 =
        triangles(mesh).iter().filter(in_sheet).map(|t| area(t.map(|v| mesh.points[v.index()]))).sum();
    assert!(close(of_sheet, 0.6 * 0.4, 1e-12), "{of_sheet}");
}

#[test]
fn the_rule_decides_and_what_means_nothing_is_refused() {
    let given = box_surface([0.0; 3], [1.0; 3]);
    let surfaces = joined(&[(&given, Role::Boundary)]);
    let threads = Threads::single();
    let with = |sizes, dividing| {
        let options = Options { dividing, ..Options::with_sizes(sizes, None) };
        fill(&surfaces, &surfaces.preflight(&threads), &options, &threads)
    };
    // A size of which the edges are no large multiple.
    let size = Some(Sizes::Uniform(0.5));
    let kept = with(size.clone(), Dividing::Coarse).unwrap();
    assert_eq!((kept.report.divided, kept.report.triangles_kept), (None, 12));
    let divided = with(size, Dividing::Always).unwrap();
    let reported = divided.report.divided.unwrap();
    assert_eq!((reported.before, reported.after), (12, divided.report.triangles));
    assert!(reported.after > 12);
    let kept = with(Some(Sizes::Uniform(0.1)), Dividing::Never).unwrap();
    assert_eq!((kept.report.divided, kept.report.triangles_kept), (None, 12));
    assert!(with(None, Dividing::Always).is_err());
    let error = with(Some(Sizes::Uniform(1e-5)), Dividing::Coarse).unwrap_err();
    assert!(error.what().contains("points inside"), "{error}");
}

#[test]
fn threads_change_nothing() {
    let given = turned(&prism(17, 1.0, 2.0));
    let surfaces = joined(&[(&given, Role::Boundary)]);
    let options = Options::with_sizes(Some(Sizes::Uniform(0.3)), None);
    let made = |n| {
        let threads = Threads::new(n).unwrap();
        fill(&surfaces, &surfaces.preflight(&threads), &options, &threads).unwrap().mesh
    };
    assert_eq!(made(1), made(3));
}
