//! Constrained Delaunay tets, held against what they promise: every triangle is there, all fits, volumes, empty spheres.

mod common;

use std::collections::{HashMap, HashSet};

use common::hard::{Case, random_case};
use motet::Mesh;
use motet::base::{Point, Threads, VertexId};
use motet::delaunay::{Constrained, EdgePoints, constrain};
use motet::geometry::predicates::insphere;
use motet::geometry::tet::{FACETS, volume};
use motet::geometry::triangle::area;
use motet::geometry::vector::distance;
use motet::mesh::shapes::{Aneurysm, Bifurcation, Coil, Flap, ThickTube};
use motet::mesh::{Surface, firsts_at_place};
use motet::preflight::renamed;

type Triangle = [VertexId; 3];

fn rising(mut t: Triangle) -> Triangle {
    t.sort_unstable();
    t
}

/// What is wrong with a result, if anything.
fn faults(points: &[Point], triangles: &[Triangle], filled: &Constrained, rule: EdgePoints) -> Vec<String> {
    let mut faults = Vec::new();
    let at = |v: VertexId| filled.points[v.index()];
    if filled.points[..points.len()] != *points {
        faults.push("the points given are not the first ones".into());
    }
    let mut sides: HashMap<Triangle, Vec<(usize, VertexId)>> = HashMap::new();
    for (t, tet) in filled.tets.iter().enumerate() {
        for (i, facet) in FACETS.iter().enumerate() {
            sides.entry(rising(facet.map(|k| tet[k]))).or_default().push((t, tet[i]));
        }
    }
    let mut walls = HashSet::new();
    for (i, &triangle) in triangles.iter().enumerate() {
        let parts = filled.triangle_to_facets.list(i);
        let whole = area(triangle.map(at));
        let total: f64 = parts.iter().map(|p| area(p.map(at))).sum();
        let edge = (0..3).map(|k| distance(at(triangle[k]), at(triangle[(k + 1) % 3]))).fold(0.0, f64::max);
        let rounding = at(triangle[0]).iter().fold(0.0, |m: f64, x| m.max(x.abs())) * f64::EPSILON;
        if (total - whole).abs() > 1e-10 * edge * edge + 4.0 * rounding * edge * parts.len() as f64 {
            faults.push(format!("triangle {i}: {total} of {whole}"));
        }
        for &part in parts {
            walls.insert(rising(part));
            let n = filled.triangle_to_bodies[i].iter().filter(|b| b.is_some()).count();
            if sides.get(&rising(part)).map_or(0, Vec::len) != n {
                faults.push(format!("triangle {i}: a part with {n} bodies is not a facet of as many tets"));
            }
        }
    }
    for (facet, of) in &sides {
        match of[..] {
            [_] if walls.contains(facet) => {}
            [(s, _), (t, _)] if walls.contains(facet) || filled.bodies[s] == filled.bodies[t] => {}
            _ => faults.push(format!("facet {facet:?} of {} tets", of.len())),
        }
    }
    faults.extend(volumes(triangles, filled));
    if rule == EdgePoints::Stay {
        faults.extend(spheres(points.len(), filled, &sides, &walls));
    }
    faults
}

/// Bodies whose tets do not sum to what their surface encloses.
fn volumes(triangles: &[Triangle], filled: &Constrained) -> Vec<String> {
    let n = filled.bodies.iter().max().map_or(0, |&b| b as usize + 1);
    let (mut of_tets, mut of_surface, mut size) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let origin = filled.tets.first().map_or([0.0; 3], |t| filled.points[t[0].index()]);
    let from = |v: &VertexId| {
        let p = filled.points[v.index()];
        [0, 1, 2].map(|i| p[i] - origin[i])
    };
    for (tet, &body) in filled.tets.iter().zip(&filled.bodies) {
        of_tets[body as usize] += volume([0, 1, 2, 3].map(|k| from(&tet[k])));
    }
    for (triangle, bodies) in triangles.iter().zip(&filled.triangle_to_bodies) {
        let [a, b, c] = [0, 1, 2].map(|k| from(&triangle[k]));
        let part = volume([[0.0; 3], a, b, c]);
        for (body, sign) in bodies.iter().zip([-1.0, 1.0]) {
            if let Some(body) = body {
                of_surface[*body as usize] += sign * part;
                size[*body as usize] += part.abs();
            }
        }
    }
    let off =
        (0..n).filter(|&b| (of_tets[b] - of_surface[b]).abs() > 1e-10 * (of_tets[b].abs() + 1e-3 * size[b]));
    off.map(|b| format!("body {b}: {} of {}", of_tets[b], of_surface[b])).collect()
}

/// Facets between tets, not of the surface, with the one tet's vertex inside the sphere of the other (exact, so only without points on edges).
fn spheres(
    n: usize,
    filled: &Constrained,
    sides: &HashMap<Triangle, Vec<(usize, VertexId)>>,
    walls: &HashSet<Triangle>,
) -> Vec<String> {
    let is_given = |v: &VertexId| v.index() < n;
    let inner = sides.iter().filter(|(facet, of)| of.len() == 2 && !walls.contains(*facet));
    let bad = inner.filter(|(_, of)| {
        let (tet, other) = (filled.tets[of[0].0], of[1].1);
        let [a, b, c, d] = tet.map(|v| filled.points[v.index()]);
        tet.iter().all(is_given) && is_given(&other) && insphere(a, b, c, d, filled.points[other.index()]) > 0
    });
    bad.map(|(facet, _)| format!("facet {facet:?} is not Delaunay")).collect()
}

fn check(name: &str, points: &[Point], triangles: &[Triangle], rule: EdgePoints) -> Constrained {
    let filled = match constrain(points, triangles, rule, &Threads::single()) {
        Ok(filled) => filled,
        Err(error) => panic!("{name}: {error}"),
    };
    let faults = faults(points, triangles, &filled, rule);
    assert!(faults.is_empty(), "{name}: {} faults, {}", faults.len(), faults[0]);
    filled
}

/// Kinds of hard surfaces of which not every one is filled and kept yet: flat faces cut into needles, many sharp notches side by side, surfaces
/// that touch in many vertices.
const OPEN_KINDS: [&str; 5] = ["cut_box", "wedges", "chazelle", "star_in_star", "axis"];

/// The first so many hard surfaces that are no open kind; of those with "axis" in their name, one axis is stretched up to a million times.
fn cases(n: usize) -> impl Iterator<Item = Case> {
    let is_open = |case: &Case| OPEN_KINDS.iter().any(|kind| case.name.contains(kind));
    (0..).map(random_case).filter(move |case| !is_open(case)).take(n)
}

/// `MOTET_CASES=1000` checks more of them.
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
        if filled.on_edges.is_empty() {
            kept += 1;
            let faults = faults(&case.points, &case.triangles, &filled, EdgePoints::MoveInside);
            assert!(faults.is_empty(), "{}: {}", case.name, faults[0]);
        } else {
            println!("{}: {} points stayed on edges", case.name, filled.on_edges.len());
            assert!(volumes(&case.triangles, &filled).is_empty(), "{}", case.name);
        }
    }
    println!("{kept} of {n} kept as they came");
    assert!(10 * kept >= 9 * n, "{kept} of {n}");
}

#[test]
fn where_points_stay_on_edges_spheres_hold_nothing_that_sees_them() {
    for case in cases(n_cases()).filter(|case| case.triangles.len() < 120) {
        check(&case.name, &case.points, &case.triangles, EdgePoints::Stay);
    }
}

#[test]
fn what_cannot_be_kept_is_told_and_nothing_hangs() {
    for case in (0..40).map(random_case).filter(|case| case.triangles.len() < 200) {
        match constrain(&case.points, &case.triangles, EdgePoints::MoveInside, &Threads::single()) {
            Err(error) => assert!(error.place().is_some(), "{}: {error}", case.name),
            Ok(filled) => {
                assert!(volumes(&case.triangles, &filled).is_empty() || !filled.on_edges.is_empty())
            }
        }
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
        "hostile_surfaces/trimesh_7_8ths_cube.stl",
        "hostile_surfaces/trimesh_shared.STL",
    ];
    for file in files {
        let (points, triangles) = surface(&motet::io::read(format!("{folder}/{file}")).unwrap());
        let filled = constrain(&points, &triangles, EdgePoints::MoveInside, &Threads::single()).unwrap();
        assert!(volumes(&triangles, &filled).is_empty(), "{file}");
        let n_kept = filled.triangle_to_facets.iter().filter(|list| list.len() == 1).count();
        println!(
            "{file}: {} triangles, {n_kept} as they came, {} points on edges, {} tets",
            triangles.len(),
            filled.on_edges.len(),
            filled.tets.len()
        );
        // The stretched triangles of the devices leave a few points on edges.
        assert!(filled.on_edges.is_empty() || file.starts_with("devices"), "{file}");
        if filled.on_edges.is_empty() {
            let faults = faults(&points, &triangles, &filled, EdgePoints::MoveInside);
            assert!(faults.is_empty(), "{file}: {}", faults[0]);
        }
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
