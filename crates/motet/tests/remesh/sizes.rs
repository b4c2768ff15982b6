//! Sizes: edges reach the requested lengths, and nothing is lost on the way.

use crate::common::prism::{prism, turned};
use crate::common::{data_meshes, random_mesh};
use crate::moving_cases::measure::{
    assert_valid, boundary, features, labelled, length, patches, quality, volumes,
};
use crate::moving_cases::membrane::membrane_mesh;
use motet::ErrorKind;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::tet::EDGES;
use motet::geometry::vector::distance;
use motet::kernel::Complex;
use motet::mesh::shapes::box_grid;
use motet::mesh::{TetMesh, TetPart};
use motet::meshing::{self, Surfaces, fill};
use motet::preflight::Role;
use motet::remesh::{LONG, Lengths, Options, Outcome, SHORT, Sizes, SurfaceRule, remesh};
use proptest::prelude::*;

fn options_for(sizes: Sizes, surface: SurfaceRule) -> Options {
    Options { sizes: Some(sizes), surface, ..Options::default() }
}

const ADAPT: SurfaceRule = SurfaceRule::Adapt { distance: None };

fn cube(n: usize) -> TetMesh {
    TetPart::of(&box_grid([n; 3], [[0.0; 3], [1.0; 3]])).unwrap().mesh
}

/// Lengths of all edges relative to their sizes.
fn ratios(mesh: &TetMesh, size: impl Fn(Point) -> f64) -> Vec<f64> {
    let mut edges: Vec<[VertexId; 2]> =
        mesh.tets.iter().flat_map(|t| EDGES.map(|[i, j]| [t[i].min(t[j]), t[i].max(t[j])])).collect();
    edges.sort_unstable();
    edges.dedup();
    let point = |v: VertexId| mesh.points[v.index()];
    edges
        .into_iter()
        .map(|[a, b]| distance(point(a), point(b)) / (0.5 * (size(point(a)) + size(point(b)))))
        .collect()
}

fn close(x: f64, y: f64) -> bool {
    (x - y).abs() <= 1e-12 * y.abs()
}

/// Asserts that volumes, areas, features and labels are preserved, and that the report is true.
fn assert_kept(old: &TetMesh, outcome: &Outcome, size: impl Fn(Point) -> f64) {
    let (new, report) = (&outcome.extract.mesh, &outcome.report);
    assert_valid(new);
    let [before, after] = [old, new].map(volumes);
    assert!(before.keys().eq(after.keys()));
    before.iter().for_each(|(region, v)| assert!(close(after[region], *v), "region {region}"));
    let [before, after] = [old, new].map(patches);
    assert!(before.keys().eq(after.keys()));
    before.iter().for_each(|(patch, (_, a))| assert!(close(after[patch].1, *a), "patch {patch}"));
    let [before, after] = [old, new].map(|mesh| length(&features(mesh), |v| mesh.points[v.index()]));
    assert!(close(before, after), "features {before} {after}");

    let sizes = report.sizes.unwrap();
    for (reported, mesh) in [(sizes.before, old), (sizes.after, new)] {
        let ratios = ratios(mesh, &size);
        let n = |is: &dyn Fn(f64) -> bool| ratios.iter().filter(|r| is(**r)).count();
        assert_eq!(reported.edges, ratios.len());
        assert_eq!((reported.too_long, reported.too_short), (n(&|r| r > LONG), n(&|r| r < SHORT)));
        let sum: f64 = ratios.iter().sum();
        assert!((reported.mean - sum / ratios.len() as f64).abs() < 1e-9);
        assert!(close(reported.max, ratios.iter().copied().fold(0.0, f64::max)));
        assert!(close(reported.min, ratios.iter().copied().fold(f64::INFINITY, f64::min)));
    }
}

fn tell(what: &str, outcome: &Outcome) -> Lengths {
    let (report, sizes) = (&outcome.report, outcome.report.sizes.unwrap());
    println!(
        "{what}: tets {} -> {}, bad {} -> {}, worst {:.4}, {:.2} s\n    before {:?}\n    after  {:?}",
        report.before.tets,
        report.after.tets,
        report.before.bad,
        report.after.bad,
        report.after.worst.unwrap().eas,
        report.seconds.repair,
        sizes.before,
        sizes.after,
    );
    sizes.after
}

#[test]
fn a_box_is_made_finer_and_coarser() {
    for (n, size) in [(3, 0.09), (4, 0.2), (16, 0.2), (12, 0.5)] {
        let mesh = cube(n);
        let outcome = remesh(&mesh, &options_for(Sizes::Uniform(size), ADAPT), &Threads::single()).unwrap();
        let after = tell(&format!("cube of {n} to {size}"), &outcome);
        assert_kept(&mesh, &outcome, |_| size);
        assert_eq!((outcome.report.after.bad, after.too_long), (0, 0));
        assert!(outcome.report.is_complete());
        assert!(after.too_short * 30 < after.edges, "{} of {}", after.too_short, after.edges);
    }
}

#[test]
fn what_has_its_sizes_stays() {
    for (n, size) in [(6, 0.12), (6, 0.3), (14, 0.25)] {
        let options = options_for(Sizes::Uniform(size), ADAPT);
        let first = remesh(&cube(n), &options, &Threads::single()).unwrap();
        let second = remesh(&first.extract.mesh, &options, &Threads::single()).unwrap();
        let after = tell("second time", &second);
        println!("    kept {:.4}", second.report.kept_share);
        // Where short edges are left, it tries once more to improve their surroundings.
        let n_short = first.report.sizes.unwrap().after.too_short;
        assert!(second.report.kept_share >= if n_short == 0 { 1.0 } else { 0.8 });
        assert!(after.too_long == 0 && after.too_short <= n_short);
    }
}

#[test]
fn an_interface_between_regions_stays_where_it_is() {
    let mesh = membrane_mesh(0.2, 1);
    for size in [0.1, 0.45] {
        let outcome = remesh(&mesh, &options_for(Sizes::Uniform(size), ADAPT), &Threads::single()).unwrap();
        let after = tell(&format!("membrane to {size}"), &outcome);
        assert_kept(&mesh, &outcome, |_| size);
        assert_eq!((outcome.report.after.bad, after.too_long), (0, 0));
        assert!(after.too_short * 30 < after.edges, "{} of {}", after.too_short, after.edges);
        let is_off =
            |p: Point| p[2].abs() > 1e-12 && (p[2] - 0.5).abs() > 1e-12 && (p[2] - 1.0).abs() > 1e-12;
        let new = &outcome.extract.mesh;
        let on = new.triangles.iter().zip(&new.patches).filter(|(_, patch)| **patch == 7);
        assert!(on.flat_map(|(t, _)| t).all(|v| !is_off(new.points[v.index()])));
    }
}

#[test]
fn sizes_may_differ_from_vertex_to_vertex() {
    let mesh = cube(5);
    // A linear size field, exactly interpolated between vertices.
    let size = |p: Point| 0.06 + 0.3 * p[0];
    let sizes = mesh.points.iter().map(|p| size(*p)).collect();
    let outcome = remesh(&mesh, &options_for(Sizes::Vertices(sizes), ADAPT), &Threads::single()).unwrap();
    let after = tell("graded", &outcome);
    assert_kept(&mesh, &outcome, size);
    assert_eq!((outcome.report.after.bad, after.too_long), (0, 0));
    assert!(after.too_short * 25 < after.edges, "{} of {}", after.too_short, after.edges);
}

#[test]
fn a_surface_that_is_kept_is_kept_to_the_bit() {
    for (n, size) in [(4, 0.12), (10, 0.4)] {
        let mesh = cube(n);
        let outcome =
            remesh(&mesh, &options_for(Sizes::Uniform(size), SurfaceRule::Keep), &Threads::single()).unwrap();
        let after = tell("kept", &outcome);
        assert_kept(&mesh, &outcome, |_| size);
        assert_eq!(boundary(&outcome.extract.mesh), boundary(&mesh));
        assert_eq!(labelled(&outcome.extract.mesh), labelled(&mesh));
        assert_eq!(after.too_long, after.too_long_held);
        assert!(outcome.report.is_complete(), "{} bad", outcome.report.after.bad);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, max_shrink_iters: 4, ..ProptestConfig::default() })]

    #[test]
    fn any_mesh_keeps_every_invariant(seed in any::<u64>(), n in 10usize..40, size in 0.2f64..1.0, adapt in any::<bool>()) {
        let mesh = random_mesh(n, seed);
        let surface = if adapt { ADAPT } else { SurfaceRule::Keep };
        let outcome = remesh(&mesh, &options_for(Sizes::Uniform(size), surface), &Threads::single()).unwrap();
        Complex::new(&outcome.extract.mesh).unwrap().verify().map_err(TestCaseError::fail)?;
        prop_assert!(quality(&outcome.extract.mesh).inverted == 0);
        let again = remesh(&mesh, &options_for(Sizes::Uniform(size), surface), &Threads::single()).unwrap();
        prop_assert_eq!(again.extract.mesh, outcome.extract.mesh);
    }
}

#[test]
fn what_is_no_size_is_reported_with_its_place() {
    let mesh = cube(2);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = remesh(&mesh, &options_for(Sizes::Uniform(bad), ADAPT), &Threads::single()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Options);
        assert!(error.remedy_text().is_some());
        let mut sizes = vec![0.5; mesh.points.len()];
        sizes[17] = bad;
        let error =
            remesh(&mesh, &options_for(Sizes::Vertices(sizes), ADAPT), &Threads::single()).unwrap_err();
        assert_eq!((error.kind(), error.place()), (ErrorKind::Input, Some("point 17")));
    }
    let error =
        remesh(&mesh, &options_for(Sizes::Vertices(vec![0.5; 3]), ADAPT), &Threads::single()).unwrap_err();
    assert!(error.to_string().starts_with("3 sizes for 27 points"), "{error}");
}

#[test]
fn sizes_that_no_memory_can_hold_are_refused_at_once() {
    let mesh = cube(2);
    for size in [1e-3, 1e-9, 1e-200, f64::MIN_POSITIVE] {
        let error = remesh(&mesh, &options_for(Sizes::Uniform(size), ADAPT), &Threads::single()).unwrap_err();
        println!("{error}");
        assert_eq!(error.kind(), ErrorKind::Input);
        assert!(error.what().contains("at most 1.0e7"));
    }
}

/// Real meshes are brought to three quarters of, and to twice, the mean length of their edges.
#[test]
fn real_meshes_come_to_their_sizes() {
    let few = |name: &str| name.contains("house");
    for (name, mesh) in data_meshes().into_iter().filter(|(name, _)| few(name)) {
        let mesh = TetPart::of(&mesh).unwrap().mesh;
        let lengths = ratios(&mesh, |_| 1.0);
        let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
        for part in [0.75, 2.0] {
            let outcome =
                remesh(&mesh, &options_for(Sizes::Uniform(part * mean), ADAPT), &Threads::single()).unwrap();
            let after = tell(&format!("{name} to {part}"), &outcome);
            assert_valid(&outcome.extract.mesh);
            assert_eq!(after.too_long, after.too_long_held);
        }
    }
}

/// Filled without sizes, such a body has no vertex inside and nearly all of its tets are flat.
#[test]
fn prisms_of_long_flat_tets_come_to_their_sizes() {
    let threads = Threads::single();
    for (sides, lies) in [(24, false), (40, false), (40, true), (56, false)] {
        let given = prism(sides, 1.0, 3.0);
        let given = if lies { turned(&given) } else { given };
        let surfaces = Surfaces::new(&[(&given, Role::Boundary, "")]).unwrap();
        let preflight = surfaces.preflight(&threads);
        let coarse = fill(&surfaces, &preflight, &meshing::Options::default(), &threads).unwrap().mesh;
        let part = TetPart::of(&coarse).unwrap();
        let rule = SurfaceRule::Adapt { distance: Some(0.01) };
        let outcome = remesh(&part.mesh, &options_for(Sizes::Uniform(0.3), rule), &threads).unwrap();
        let what = format!("prism of {sides} sides, turned: {lies}");
        let after = tell(&what, &outcome);
        assert_valid(&outcome.extract.mesh);
        assert!(outcome.report.before.bad > 9 * part.mesh.tets.len() / 10, "{what}");
        assert_eq!((outcome.report.after.bad, after.too_long), (0, 0), "{what}");
        let volume = |mesh: &TetMesh| volumes(mesh).values().sum::<f64>();
        let [before, after] = [&part.mesh, &outcome.extract.mesh].map(volume);
        assert!((after / before - 1.0).abs() < 0.01, "{what}: volume {before}, then {after}");
    }
}

/// The mean EAS of all tets.
fn mean_eas(mesh: &TetMesh) -> f64 {
    let eas = |tet: &[VertexId; 4]| motet::geometry::quality::eas(tet.map(|v| mesh.points[v.index()]));
    mesh.tets.iter().map(eas).sum::<f64>() / mesh.tets.len() as f64
}

#[test]
fn tets_of_new_sizes_are_good_on_the_whole_and_edges_about_as_long_as_requested() {
    // Finer sizes; coarsened meshes have a mean EAS of about 0.6 with so few tets.
    for (n, size) in [(4, 0.1), (4, 0.07)] {
        let outcome =
            remesh(&cube(n), &options_for(Sizes::Uniform(size), ADAPT), &Threads::single()).unwrap();
        let after = tell(&format!("cube of {n} to {size}"), &outcome);
        let mean = mean_eas(&outcome.extract.mesh);
        println!("    mean EAS {mean:.3}");
        assert!(mean > 0.6, "{mean}");
        assert!(after.spread < 0.25, "{}", after.spread);
        assert!((0.8..1.2).contains(&after.mean), "{}", after.mean);
        let logarithms: Vec<f64> = ratios(&outcome.extract.mesh, |_| size).iter().map(|r| r.ln()).collect();
        let mean = logarithms.iter().sum::<f64>() / logarithms.len() as f64;
        let square = logarithms.iter().map(|l| (l - mean) * (l - mean)).sum::<f64>();
        assert!((after.spread - (square / logarithms.len() as f64).sqrt()).abs() < 1e-9);
    }
}

#[test]
fn sizes_requested_again_and_again_change_nothing_more() {
    let options = options_for(Sizes::Uniform(0.17), ADAPT);
    let mut mesh = cube(9);
    let mut counts = Vec::new();
    for _ in 0..20 {
        let outcome = remesh(&mesh, &options, &Threads::single()).unwrap();
        mesh = outcome.extract.mesh;
        counts.push((mesh.points.len(), mesh.tets.len(), mean_eas(&mesh)));
    }
    println!("{counts:?}");
    let ([.., before, last], third) = (counts.as_slice(), counts[2]) else { unreachable!() };
    assert_eq!(before, last);
    assert!(
        (third.1 as f64 / last.1 as f64 - 1.0).abs() < 0.01 && (third.2 - last.2).abs() < 0.01,
        "{counts:?}"
    );
}
