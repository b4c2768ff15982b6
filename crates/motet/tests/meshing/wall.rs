//! Walls of vessels, compared with what they promise: every tet positive, the lumen kept to the bit, nothing
//! crosses, ends lie in the planes of caps, and the volume is that of a shell.

use std::f64::consts::{PI, TAU};

use motet::Mesh;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::predicates::orient3d;
use motet::geometry::tet::volume;
use motet::geometry::triangle::area_vector;
use motet::geometry::vector::{norm, scale};
use motet::mesh::check::{Defect, DefectKind, check};
use motet::mesh::history::Changed;
use motet::mesh::shapes::{Aneurysm, Bifurcation, TubeOptions, ball, tube};
use motet::mesh::{CellKind, Cells, Field, Surface};
use motet::meshing::wall::{Options, Report, Thickness, WallWords, wall};
use motet::preflight::own_crossings;

fn uniform(thickness: f64) -> Options {
    Options::new(Thickness::Uniform(thickness))
}

/// Makes a wall and checks what must hold for any.
fn made(mesh: &Mesh, options: &Options) -> Changed<Report> {
    let made = wall(mesh, options, &Threads::single()).unwrap();
    let new = &made.mesh;
    new.validate().unwrap();
    // Two vessels are two parts.
    let is_fault = |defect: &&Defect| defect.kind != DefectKind::SeparatePart;
    assert_eq!(check(new).iter().find(is_fault), None);
    for (cell, tet) in solid(&made) {
        let [a, b, c, d] = tet.map(|v| new.points[v.index()]);
        assert!(orient3d(a, b, c, d) > 0, "cell {cell}");
    }
    let boundary = Surface::boundary_of(new);
    assert_eq!(
        own_crossings(&boundary.points, &boundary.triangles, &Threads::single()),
        Vec::<[u32; 2]>::new()
    );
    let total: f64 = new.cells.tets().map(|(_, t)| volume(t.map(|v| new.points[v.index()]))).sum();
    if new.cells.kinds().iter().all(|kind| *kind == CellKind::TETRA || kind.dim() != Some(3)) {
        assert!((total - boundary.enclosed_volume()).abs() < 1e-12 * total);
    }
    made
}

/// The wall's tets.
fn solid(made: &Changed<Report>) -> Vec<(usize, [VertexId; 4])> {
    let regions = made.mesh.regions().unwrap().ids;
    let all = made.mesh.cells.tets().filter(|(cell, _)| regions[cell.index()] == made.report.region);
    all.map(|(cell, tet)| (cell.index(), tet)).collect()
}

fn solid_volume(made: &Changed<Report>) -> f64 {
    solid(made).into_iter().map(|(_, t)| volume(t.map(|v| made.mesh.points[v.index()]))).sum()
}

/// The surface cells of a mesh, alone.
fn surface_of(mesh: &Mesh, kept: impl Fn(i32) -> bool) -> Mesh {
    let surface = Surface::of(mesh);
    let kept = surface.triangles.iter().zip(&surface.patches).filter(|(_, p)| kept(**p));
    let (triangles, patches): (Vec<_>, Vec<i32>) = kept.map(|(t, p)| (*t, *p)).unzip();
    let cells = Cells::uniform(CellKind::TRIANGLE, triangles.into_flattened()).unwrap();
    Mesh {
        cell_data: vec![Field::scalars("patch", patches)],
        label_names: mesh.label_names.clone(),
        ..Mesh::new(mesh.points.clone(), cells)
    }
}

#[test]
fn around_a_ball_it_is_a_shell() {
    let inside = ball(8, 4);
    let made = made(&inside, &Options { layers: 3, growth: 1.2, ..uniform(0.2) });
    let report = &made.report;
    assert_eq!((report.layers.full, report.layers.without), (report.layers.vertices, 0));
    assert!(report.ends.is_empty());
    let shell = 4.0 / 3.0 * PI * (1.2f64.powi(3) - 1.0);
    assert!((solid_volume(&made) / shell - 1.0).abs() < 0.02, "{} {shell}", solid_volume(&made));
    assert!((solid_volume(&made) - report.layers.volume).abs() < 1e-3 * shell);
    assert_eq!(made.mesh.label_names.regions[&report.region], "wall");
    assert_eq!(solid(&made).len(), 3 * 3 * report.interface);
    // Levels: 1, 1.2, 1.44 parts of the thickness.
    let mut radii: Vec<f64> = made.mesh.points[inside.points.len()..].iter().map(|p| norm(*p)).collect();
    radii.sort_by(f64::total_cmp);
    let n = radii.len() / 3;
    for (k, height) in [(0, 1.0), (1, 2.2), (2, 3.64)] {
        let expected = 1.0 + 0.2 * height / 3.64;
        assert!((radii[k * n + n / 2] - expected).abs() < 3e-3, "{} {expected}", radii[k * n + n / 2]);
    }
}

#[test]
fn the_lumen_stays_to_the_bit_and_has_a_region_of_its_own() {
    let mut lumen = tube(&TubeOptions::default());
    let heights: Vec<f64> = lumen.points.iter().map(|p| p[2]).collect();
    lumen.set_point_field(Field::scalars("height", heights));
    let made = made(&lumen, &Options { layers: 2, ..uniform(0.2) });
    let new = &made.mesh;
    assert_eq!(new.points[..lumen.points.len()], lumen.points);
    for ((_, kind, vertices), (_, new_kind, new_vertices)) in lumen.cells.iter().zip(new.cells.iter()) {
        assert_eq!((kind, vertices), (new_kind, new_vertices));
    }
    let (old, all) = (lumen.regions().unwrap(), new.regions().unwrap());
    assert_eq!(old.ids[..], all.ids[..old.ids.len()]);
    assert!(!old.used().contains(&made.report.region));
    let names: Vec<&str> = new.label_names.patches.values().map(String::as_str).collect();
    for name in ["wall", "inlet", "outlet", "outer", "wall_inlet", "wall_outlet"] {
        assert!(names.contains(&name), "{names:?}");
    }
    assert_eq!(made.report.ends, ["wall_inlet", "wall_outlet"]);
    // Arrays go on along the columns.
    let height = new.point_field("height").unwrap().values.to_f64().unwrap();
    assert!(height.iter().zip(&new.points).all(|(h, p)| (h - p[2]).abs() < 1e-9));
    assert_eq!(made.history.vertices.len(), new.points.len());
}

#[test]
fn ends_lie_in_the_planes_of_caps() {
    let lumen = tube(&TubeOptions::default());
    let made = made(&lumen, &uniform(0.3));
    let patches = made.mesh.patches().unwrap();
    let z: Vec<f64> = lumen.points.iter().map(|p| p[2]).collect();
    let (low, high) =
        (z.iter().copied().fold(f64::MAX, f64::min), z.iter().copied().fold(f64::MIN, f64::max));
    let mut area = 0.0;
    for (cell, kind, vertices) in made.mesh.cells.iter() {
        let name = patches.names.get(&patches.ids[cell.index()]).map_or("", String::as_str);
        if kind == CellKind::TRIANGLE && ["wall_inlet", "wall_outlet"].contains(&name) {
            let corners = [0, 1, 2].map(|k| made.mesh.points[vertices[k].index()]);
            let plane = if name == "wall_inlet" { low } else { high };
            assert!(corners.iter().all(|p| (p[2] - plane).abs() < 1e-12), "{corners:?}");
            area += norm(area_vector(corners));
        }
    }
    let radius = lumen.points.iter().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
    let rings = 2.0 * PI * ((radius + 0.3).powi(2) - radius.powi(2));
    assert!((area / rings - 1.0).abs() < 0.03, "{area} {rings}");
}

#[test]
fn an_open_surface_has_the_wall_of_the_closed_one() {
    let whole = Aneurysm::default().mesh().unwrap();
    let is_wall = whole.find_patch("wall").unwrap();
    let open = surface_of(&whole, |patch| patch == is_wall);
    let options = Options { layers: 2, ..Options::new(Thickness::OfRadius(0.15)) };
    let [closed, open] = [&whole, &open].map(|mesh| made(mesh, &options));
    assert_eq!(closed.report.ends, ["wall_inlet", "wall_outlet"]);
    assert_eq!(open.report.ends, ["wall_end"]);
    assert_eq!(closed.report.layers.without, 0);
    let [a, b] = [&closed, &open].map(solid_volume);
    assert!((a - b).abs() < 1e-2 * a, "{a} {b}");
    assert_eq!(closed.report.interface, open.report.interface);
    // The wall alone: caps bound nothing.
    let patches = closed.mesh.patches().unwrap();
    let names: Vec<String> = patches.used().into_iter().map(|id| patches.name(id)).collect();
    assert!(!names.contains(&"inlet".to_owned()), "{names:?}");
}

#[test]
fn where_vessels_branch_nothing_crosses() {
    let lumen = Bifurcation::default().mesh().unwrap();
    for part in [0.1, 0.3, 0.6] {
        let made = made(&lumen, &Options { layers: 2, ..Options::new(Thickness::OfRadius(part)) });
        assert_eq!(made.report.layers.without, 0, "{part}");
        assert!(
            made.report.layers.full as f64 > 0.8 * made.report.layers.vertices as f64,
            "{:?}",
            made.report
        );
    }
}

#[test]
fn a_part_of_the_radius_is_that_of_the_vessel() {
    let lumen = tube(&TubeOptions::default());
    let radius = lumen.points.iter().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
    let made = made(&lumen, &Options::new(Thickness::OfRadius(0.25)));
    let [least, median, largest] = made.report.layers.thickness.unwrap();
    // The ball lies inside a polygon.
    assert!((median / (0.25 * radius) - 0.98).abs() < 0.02, "{median}");
    assert!(least > 0.9 * median && largest < 1.05 * median, "{least} {largest}");
}

#[test]
fn an_array_says_how_thick_it_is() {
    let mut lumen = tube(&TubeOptions::default());
    let length = lumen.points.iter().map(|p| p[2]).fold(0.0, f64::max);
    let thickness: Vec<f64> = lumen.points.iter().map(|p| 0.1 + 0.1 * p[2] / length).collect();
    lumen.set_point_field(Field::scalars("t", thickness));
    let words: WallWords = serde_json::from_str(r#"{"thickness": "t"}"#).unwrap();
    let made = made(&lumen, &words.options(&lumen).unwrap());
    let radius = lumen.points.iter().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
    for p in &made.mesh.points[lumen.points.len()..] {
        let expected = radius + 0.1 + 0.1 * p[2] / length;
        assert!((p[0].hypot(p[1]) / expected - 1.0).abs() < 0.02, "{p:?}");
    }
}

#[test]
fn a_wall_stands_on_named_patches_only() {
    let lumen = Bifurcation::default().mesh().unwrap();
    let options = Options { on: vec!["outlet_1".into()], ..uniform(0.2) };
    let made = made(&lumen, &options);
    let id = lumen.find_patch("outlet_1").unwrap();
    let n = lumen.patches().unwrap().ids.iter().filter(|&&p| p == id).count();
    assert_eq!(made.report.interface, n);
    let refused = wall(&lumen, &Options { on: vec!["x".into()], ..uniform(0.2) }, &Threads::single());
    assert!(refused.unwrap_err().to_string().contains("no patch `x`"));
}

#[test]
fn prisms_stay_where_requested() {
    let lumen = tube(&TubeOptions::default());
    let options = Options { layers: 2, keep_prisms: true, ..uniform(0.2) };
    let made = wall(&lumen, &options, &Threads::single()).unwrap();
    let wedges = made.mesh.cells.kinds().iter().filter(|kind| **kind == CellKind::WEDGE).count();
    assert_eq!(wedges, 2 * made.report.interface);
    assert_eq!(check(&made.mesh), Vec::new());
}

#[test]
fn places_scales_and_threads_change_nothing() {
    let lumen = Bifurcation::default().mesh().unwrap();
    let options = Options { layers: 2, ..uniform(0.3) };
    let first = made(&lumen, &options);
    let again = wall(&lumen, &options, &Threads::new(3).unwrap()).unwrap();
    assert_eq!((&first.mesh, &first.report), (&again.mesh, &again.report));
    let (sin, cos) = (TAU / 7.0).sin_cos();
    let turn = |p: Point| [cos * p[0] - sin * p[2] + 1e3, p[1] - 2e3, sin * p[0] + cos * p[2]];
    let mut turned = lumen.clone();
    turned.points.iter_mut().for_each(|p| *p = turn(*p));
    let mut large = lumen.clone();
    large.points.iter_mut().for_each(|p| *p = scale(*p, 1e4));
    let turned = made(&turned, &options);
    let large = made(&large, &Options { layers: 2, ..uniform(3e3) });
    let of = |made: &Changed<Report>| (made.report.layers.full, made.report.layers.prisms);
    assert_eq!((of(&first), of(&first)), (of(&turned), of(&large)));
    let [a, b, c] = [&first, &turned, &large].map(solid_volume);
    assert!((a - b).abs() < 1e-6 * a && (a - c / 1e12).abs() < 1e-6 * a, "{a} {b} {c}");
}

#[test]
fn walls_of_vessels_side_by_side_share_the_space_between_them() {
    // Two tubes 0.2 apart, each with a wall of 0.3 requested.
    let one = tube(&TubeOptions::default());
    let radius = one.points.iter().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
    let (surface, n) = (Surface::of(&one), one.points.len());
    let mut points = one.points.clone();
    points.extend(one.points.iter().map(|p| [p[0] + 2.0 * radius + 0.2, p[1], p[2]]));
    let mut triangles = surface.triangles.clone();
    triangles.extend(surface.triangles.iter().map(|t| t.map(|v| VertexId::new(v.index() + n))));
    let cells = Cells::uniform(CellKind::TRIANGLE, triangles.into_flattened()).unwrap();
    let made = made(&Mesh::new(points, cells), &uniform(0.3));
    assert!(made.report.layers.reduced > 0);
    assert_eq!(made.report.layers.without, 0);
    let least = made.report.layers.thickness.unwrap()[0];
    assert!(least > 0.03 && least < 0.1, "{least}");
}

#[test]
fn what_cannot_be_walled_is_refused() {
    let lumen = tube(&TubeOptions::default());
    let refused =
        |mesh: &Mesh, options: &Options| wall(mesh, options, &Threads::single()).unwrap_err().to_string();
    for thickness in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(refused(&lumen, &uniform(thickness)).contains("must be a number above 0"));
    }
    assert!(refused(&lumen, &Options { layers: 0, ..uniform(0.1) }).contains("number of layers"));
    assert!(refused(&Mesh::default(), &uniform(0.1)).contains("no surface"));
    let mut wrong = vec![0.1; lumen.points.len()];
    wrong.fill(-0.5);
    assert!(refused(&lumen, &Options::new(Thickness::AtPoints(wrong))).contains("got -0.5"));
    // Two balls that cross.
    let ball = ball(3, 1);
    let (surface, n) = (Surface::boundary_of(&ball), ball.points.len());
    let mut points = ball.points.clone();
    points.extend(ball.points.iter().map(|p| [p[0] + 0.7, p[1] + 0.1, p[2]]));
    let mut triangles = surface.triangles.clone();
    triangles.extend(surface.triangles.iter().map(|t| t.map(|v| VertexId::new(v.index() + n))));
    let cells = Cells::uniform(CellKind::TRIANGLE, triangles.into_flattened()).unwrap();
    assert!(refused(&Mesh::new(points, cells), &uniform(0.1)).contains("crossing"));
    let box_of_hexahedra = motet::mesh::shapes::mixed(2);
    assert!(refused(&box_of_hexahedra, &uniform(0.1)).contains("not a triangle"));
    let twice = WallWords { of_radius: Some(0.1), ..serde_json::from_str(r#"{"thickness": 1}"#).unwrap() };
    assert!(twice.options(&lumen).unwrap_err().to_string().contains("given twice"));
    assert!(WallWords::default().options(&lumen).unwrap_err().to_string().contains("no thickness"));
}
