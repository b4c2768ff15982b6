//! Constrained Delaunay tets, compared with what they promise: every triangle is there, tets are conforming,
//! volumes, empty spheres.

use crate::common::filling::{Triangle, faults, volumes};
use crate::common::hard::{Case, random_case};
use motet::Mesh;
use motet::base::{Point, Threads, VertexId};
use motet::delaunay::{Constrained, EdgePoints, constrain};
use motet::mesh::shapes::{Aneurysm, Bifurcation, Coil, Flap, ThickTube};
use motet::mesh::{Surface, firsts_at_place};
use motet::preflight::renamed;

fn check(name: &str, points: &[Point], triangles: &[Triangle], rule: EdgePoints) -> Constrained {
    let filled = match constrain(points, triangles, rule, &Threads::single()) {
        Ok(filled) => filled,
        Err(error) => panic!("{name}: {error}"),
    };
    let faults = faults(points, triangles, &filled, rule);
    assert!(faults.is_empty(), "{name}: {} faults, {}", faults.len(), faults[0]);
    filled
}

/// A kind of hard surfaces of which some still take too long: many sharp notches side by side, with long thin
/// triangles across them.
const OPEN_KIND: &str = "wedges";

/// The first `n` hard surfaces that are not of the open kind.
fn cases(n: usize) -> impl Iterator<Item = Case> {
    (0..).map(random_case).filter(|case| !case.name.contains(OPEN_KIND)).take(n)
}

/// The number of cases; `MOTET_CASES=1000` checks more of them.
fn n_cases() -> usize {
    std::env::var("MOTET_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(60)
}

#[test]
fn hard_surfaces_are_filled_and_kept() {
    let (mut n, mut kept) = (0, 0);
    for case in cases(n_cases()) {
        let filled =
            constrain(&case.points, &case.triangles, EdgePoints::MoveInside, &Threads::single()).unwrap();
        n += 1;
        kept += usize::from(filled.on_edges.is_empty() && filled.in_triangles.is_empty());
        let faults = faults(&case.points, &case.triangles, &filled, EdgePoints::MoveInside);
        assert!(faults.is_empty(), "{}: {}", case.name, faults[0]);
    }
    println!("{kept} of {n} kept as given");
    assert!(20 * kept >= 17 * n, "{kept} of {n}");
}

#[test]
fn where_points_stay_on_edges_spheres_hold_nothing_that_sees_them() {
    // If stretched along one axis, edges would need too many points.
    let is_small = |case: &Case| case.triangles.len() < 120 && !case.name.contains("axis");
    for case in cases(n_cases()).filter(is_small) {
        check(&case.name, &case.points, &case.triangles, EdgePoints::Stay);
    }
}

#[test]
fn bodies_that_were_hard_once_are_filled() {
    // In the first three, an edge or a triangle could not be recovered in its turn; a hollow in 413 had
    // corners that none of its old tets had; facets around one edge of 658 intersect another within the last
    // digit of an `f64` share of it; 1082 lies far from the origin for its size.
    for case in [129, 244, 297, 413, 658, 1082].map(random_case) {
        check(&case.name, &case.points, &case.triangles, EdgePoints::MoveInside);
    }
}

fn surface(mesh: &Mesh) -> (Vec<Point>, Vec<Triangle>) {
    let surface = Surface::of(mesh);
    let kept = firsts_at_place(&surface.points);
    (surface.points.clone(), renamed(&surface.triangles, &kept))
}

#[test]
fn own_shapes_are_filled_and_kept() {
    let coil = Coil { centre: [0.0; 3], radius: 2.0, pitch: 1.0, turns: 3.0, wire_radius: 0.2 };
    let shapes = [
        ("flap", Flap::default().mesh().unwrap()),
        (
            "wavy flap",
            Flap { wave_height: 0.1, waves: 2.0, bend_deg: 60.0, ..Flap::default() }.mesh().unwrap(),
        ),
        ("thick tube", ThickTube::default().mesh().unwrap()),
        ("bifurcation", Bifurcation::default().mesh().unwrap()),
        ("aneurysm", Aneurysm::default().mesh().unwrap()),
        ("coil", coil.mesh(24, 8).unwrap()),
    ];
    for (name, mesh) in shapes {
        let (points, triangles) = surface(&mesh);
        let filled = check(name, &points, &triangles, EdgePoints::MoveInside);
        assert!(filled.on_edges.is_empty(), "{name}");
        let n_bodies = filled.bodies.iter().max().map_or(0, |b| b + 1);
        assert_eq!(n_bodies, if name == "thick tube" { 2 } else { 1 }, "{name}");
    }
}

#[test]
fn a_flap_has_tets_on_both_sides() {
    let mesh = Flap { reach: 0.6, ..Flap::default() }.mesh().unwrap();
    let labels = mesh.patches().unwrap();
    let flap = labels.find("flap").unwrap();
    let (points, triangles) = surface(&mesh);
    let filled = check("flap", &points, &triangles, EdgePoints::MoveInside);
    for (bodies, &patch) in filled.triangle_to_bodies.iter().zip(&labels.ids) {
        let n = bodies.iter().filter(|b| b.is_some()).count();
        assert_eq!(n, if patch == flap { 2 } else { 1 });
    }
}

#[test]
fn real_surfaces_are_filled() {
    let folder = std::env::var("MOTET_DATA")
        .unwrap_or_else(|_| concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data").into());
    if !std::path::Path::new(&folder).exists() {
        println!("skipped: no data in {folder}");
        return;
    }
    let files = [
        "vessels/seqseg_demo.vtp",
        "vessels/heartdeformnets_lh_template.vtp",
        "devices/sphinxsys_coil.stl",
        "devices/confluent_nitinol_strut_deployed.stl",
        "devices/endobeams_braided_stent/arcStretchObj.obj",
        "hostile_surfaces/manifold_Cray_right.obj",
        "hostile_surfaces/trimesh_7_8ths_cube.stl",
        "hostile_surfaces/trimesh_shared.STL",
    ];
    for file in files {
        let (points, triangles) = surface(&motet::io::read(format!("{folder}/{file}")).unwrap());
        let filled = constrain(&points, &triangles, EdgePoints::MoveInside, &Threads::single()).unwrap();
        assert!(volumes(points.len(), &triangles, &filled).is_empty(), "{file}");
        let n_kept = filled.triangle_to_facets.iter().filter(|list| list.len() == 1).count();
        println!(
            "{file}: {} triangles, {n_kept} as given, {} points on edges, {} tets",
            triangles.len(),
            filled.on_edges.len(),
            filled.tets.len()
        );
        assert_eq!(n_kept, triangles.len(), "{file}");
        let faults = faults(&points, &triangles, &filled, EdgePoints::MoveInside);
        assert!(faults.is_empty(), "{file}: {}", faults[0]);
    }
}

#[test]
fn the_result_does_not_depend_on_threads() {
    let (points, triangles) = surface(&Aneurysm::default().mesh().unwrap());
    let [one, two] = [1, 2]
        .map(|n| constrain(&points, &triangles, EdgePoints::MoveInside, &Threads::new(n).unwrap()).unwrap());
    assert!(one.points == two.points && one.tets == two.tets);
}

#[test]
fn bad_input_is_refused_with_its_place() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]];
    let refused = |points: &[Point], t: [u32; 3]| {
        let triangle = t.map(VertexId);
        constrain(points, &[triangle], EdgePoints::MoveInside, &Threads::single()).unwrap_err().to_string()
    };
    assert!(refused(&points, [0, 1, 9]).contains("triangle 0"));
    assert!(refused(&points, [0, 1, 1]).contains("three different"));
    assert!(refused(&points, [4, 1, 2]).contains("coincide"));
    assert!(refused(&[[0.0; 3], [1.0, f64::NAN, 0.0], [0.0, 1.0, 0.0]], [0, 1, 2]).contains("point 1"));
    assert!(refused(&[[0.0; 3]; 3], [0, 1, 2]).contains("no extent"));
}
