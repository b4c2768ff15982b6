//! Vessels as surfaces: closed, free of crossings, with triangles of fair quality, flat caps, and the right
//! volume.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::OnceLock;

use motet::Mesh;
use motet::base::{Point, Threads, VertexId};
use motet::contact::is_closed;
use motet::geometry::triangle;
use motet::geometry::vector::{cross, dot, norm, sub};
use motet::mesh::shapes::{Aneurysm, Bifurcation, Flap, ThickTube};
use motet::mesh::{Surface, cone_volume};
use motet::preflight::own_crossings;

/// All vessels, made once.
fn vessels() -> &'static [(&'static str, Surface)] {
    static VESSELS: OnceLock<Vec<(&'static str, Surface)>> = OnceLock::new();
    VESSELS.get_or_init(make_vessels)
}

fn make_vessels() -> Vec<(&'static str, Surface)> {
    let held_once = Flap { reach: 0.6, bend_deg: 60.0, ..Flap::default() };
    let wavy = Flap { wave_height: 0.4, bend_deg: 90.0, around: 32, slices: 40, ..Flap::default() };
    let uneven = Bifurcation {
        branch_radii: [0.9, 0.5],
        branch_angles_deg: [25.0, 70.0],
        around: 31,
        ..Bifurcation::default()
    };
    let small_sac = Aneurysm { bend_deg: 0.0, sac_radius: 0.8, sac_height: 1.4, ..Aneurysm::default() };
    let layered = ThickTube { bend_deg: 120.0, layers: 3, thickness: 0.6, ..ThickTube::default() };
    let all = [
        ("flap", Flap::default().mesh()),
        ("flap_once", held_once.mesh()),
        ("flap_wavy", wavy.mesh()),
        ("thick_tube", ThickTube::default().mesh()),
        ("thick_tube_bent", layered.mesh()),
        ("bifurcation", Bifurcation::default().mesh()),
        ("bifurcation_uneven", uneven.mesh()),
        ("bifurcation_fine", Bifurcation { around: 64, ..Bifurcation::default() }.mesh()),
        ("aneurysm", Aneurysm::default().mesh()),
        ("aneurysm_small", small_sac.mesh()),
        ("aneurysm_fine", Aneurysm { around: 48, ..Aneurysm::default() }.mesh()),
    ];
    all.into_iter().map(|(name, mesh)| (name, Surface::of(&mesh.expect("the options are sound")))).collect()
}

/// The triangles of the patches whose names satisfy `wanted`.
fn of_patches(surface: &Surface, wanted: impl Fn(&str) -> bool) -> Vec<[VertexId; 3]> {
    let all = surface.triangles.iter().zip(&surface.patches);
    all.filter(|(_, patch)| wanted(&surface.patch_names[patch])).map(|(t, _)| *t).collect()
}

fn volume(surface: &Surface, triangles: &[[VertexId; 3]]) -> f64 {
    triangles.iter().map(|t| cone_volume(t.iter().copied(), &surface.points, [0.2, 3.0, -1.0])).sum()
}

fn smallest_angle_deg([a, b, c]: [Point; 3]) -> f64 {
    let at = |p, q, r| {
        let (u, v) = (sub(q, p), sub(r, p));
        norm(cross(u, v)).atan2(dot(u, v)).to_degrees()
    };
    at(a, b, c).min(at(b, c, a)).min(at(c, a, b))
}

#[test]
fn nothing_crosses_and_triangles_are_fair() {
    for (name, surface) in vessels() {
        let found = own_crossings(&surface.points, &surface.triangles, &Threads::single());
        assert!(found.is_empty(), "{name}: {found:?}");
        let angles: Vec<f64> =
            (0..surface.triangles.len()).map(|t| smallest_angle_deg(surface.corners(t))).collect();
        let least = angles.iter().copied().fold(90.0, f64::min);
        let mean = angles.iter().sum::<f64>() / angles.len() as f64;
        println!("{name}: {} triangles, smallest angle {least:.1}, in the mean {mean:.1}", angles.len());
        // Half squares have at most 45 degrees, and a bend stretches them.
        assert!(mean > 35.0 && least > 12.0, "{name}: {mean} {least}");
        assert_eq!(surface.vertices().len(), surface.points.len(), "{name} has points without triangles");
    }
}

#[test]
fn what_is_closed_is_closed_and_turned_outward() {
    for (name, surface) in vessels() {
        let closed = of_patches(surface, |patch| patch != "flap" && patch != "interface");
        let wall = of_patches(surface, |patch| patch == "interface" || patch.starts_with("lumen"));
        for (part, triangles) in [("all", &closed), ("lumen", &wall)] {
            assert!(is_closed(triangles), "{name}, {part}");
            assert!(volume(surface, triangles) > 0.0 || triangles.is_empty(), "{name}, {part}");
        }
    }
}

#[test]
fn caps_are_flat() {
    for (name, surface) in vessels() {
        for (patch, patch_name) in &surface.patch_names {
            if !patch_name.contains("let") {
                continue;
            }
            let of_cap: Vec<usize> =
                (0..surface.triangles.len()).filter(|&t| surface.patches[t] == *patch).collect();
            let origin = surface.corners(of_cap[0])[0];
            let area = triangle::area_vector(surface.corners(of_cap[0]));
            for corner in of_cap.iter().flat_map(|&t| surface.corners(t)) {
                let off = dot(sub(corner, origin), area) / norm(area);
                assert!(off.abs() < 1e-12, "{name}, {patch_name}: {off}");
            }
        }
    }
}

#[test]
fn volumes_are_those_of_prisms() {
    let section = |r: f64| 12.0 * r * r * (TAU / 24.0).sin();
    let tube = Surface::of(&ThickTube::default().mesh().expect("the defaults are sound"));
    let lumen = of_patches(&tube, |patch| patch == "interface" || patch.starts_with("lumen"));
    assert!((volume(&tube, &lumen) - 6.0 * section(1.0)).abs() < 1e-11);
    let outside = of_patches(&tube, |patch| patch != "interface");
    assert!((volume(&tube, &outside) - 6.0 * section(1.3)).abs() < 1e-11);
}

/// The number of uses of each edge of some triangles.
fn edges(triangles: &[[VertexId; 3]]) -> BTreeMap<[VertexId; 2], usize> {
    let mut edges = BTreeMap::new();
    for &[a, b, c] in triangles {
        for [u, v] in [[a, b], [b, c], [c, a]] {
            *edges.entry([u.min(v), u.max(v)]).or_default() += 1;
        }
    }
    edges
}

#[test]
fn a_flap_hangs_on_edges_of_the_wall_and_is_free_elsewhere() {
    for (name, reach, lines) in [("both", 1.0, 2), ("one", 0.5, 1)] {
        let mesh: Mesh = Flap { reach, ..Flap::default() }.mesh().expect("the options are sound");
        let surface = Surface::of(&mesh);
        let wall = edges(&of_patches(&surface, |patch| patch == "wall"));
        let flap = edges(&of_patches(&surface, |patch| patch == "flap"));
        let rim: Vec<_> = flap.iter().filter(|(_, n)| **n == 1).map(|(edge, _)| edge).collect();
        let held = rim.iter().filter(|edge| wall.contains_key(**edge)).count();
        // From slice 5 to slice 19 of 24.
        assert_eq!(held, 14 * lines, "{name}");
        assert!(rim.len() > held, "{name}");
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let flaps = [
        Flap { extent: [0.0, 0.5], ..Flap::default() },
        Flap { lines_deg: [10.0, 12.0], ..Flap::default() },
        Flap { wave_height: 2.0, ..Flap::default() },
        Flap { reach: f64::NAN, ..Flap::default() },
    ];
    flaps.iter().for_each(|flap| assert!(flap.mesh().is_err(), "{flap:?}"));
    assert!(ThickTube { bend_deg: 300.0, ..ThickTube::default() }.mesh().is_err());
    assert!(ThickTube { layers: 0, ..ThickTube::default() }.mesh().is_err());
    assert!(Bifurcation { branch_angles_deg: [5.0, 5.0], ..Bifurcation::default() }.mesh().is_err());
    assert!(Bifurcation { length: 0.1, ..Bifurcation::default() }.mesh().is_err());
    assert!(Aneurysm { sac_height: 9.0, ..Aneurysm::default() }.mesh().is_err());
    assert!(Aneurysm { length: 2.0, bend_deg: 0.0, ..Aneurysm::default() }.mesh().is_err());
}
