//! The hard surfaces are as promised: closed, free of crossings and of flat triangles, and of the stated
//! volume.

use std::collections::{BTreeMap, BTreeSet};

use crate::common::hard::{Case, random_case};
use motet::base::Threads;
use motet::contact::is_closed;
use motet::geometry::predicates::collinear;
use motet::mesh::cone_volume;
use motet::preflight::own_crossings;

fn cases() -> impl Iterator<Item = Case> {
    (0..200).map(random_case)
}

#[test]
fn every_edge_is_between_triangles() {
    for case in cases() {
        let mut uses: BTreeMap<_, usize> = BTreeMap::new();
        for &[a, b, c] in &case.triangles {
            for (u, v) in [(a, b), (b, c), (c, a)] {
                *uses.entry((u.min(v), u.max(v))).or_default() += 1;
            }
        }
        for (edge, n) in uses {
            let is_even = n % 2 == 0 || case.has_membranes && n > 1;
            assert!(is_even, "{}: edge {edge:?} has {n} triangles", case.name);
            assert!(n == 2 || !case.name.contains("polycube"), "{} is no manifold at {edge:?}", case.name);
        }
        assert!(case.has_membranes || is_closed(&case.triangles), "{} has no inside", case.name);
    }
}

#[test]
fn nothing_crosses_and_no_triangle_is_flat() {
    for case in cases() {
        let found = own_crossings(&case.points, &case.triangles, &Threads::single());
        assert!(found.is_empty(), "{}: {} crossings, such as {:?}", case.name, found.len(), found[0]);
        for t in &case.triangles {
            let [a, b, c] = t.map(|v| case.points[v.index()]);
            assert!(!collinear(a, b, c), "{}: {t:?} is flat", case.name);
        }
    }
}

#[test]
fn volumes_are_as_told() {
    let mut n_reported = 0;
    for case in cases().filter(|case| !case.has_membranes) {
        let origin = case.points[0];
        let cones = case.triangles.iter().map(|t| cone_volume(t.iter().copied(), &case.points, origin));
        let (sum, all) = cones.fold((0.0, 0.0), |(sum, all), v| (sum + v, all + v.abs()));
        assert!(sum > 0.0, "{} is turned inside out", case.name);
        if let Some(volume) = case.volume {
            n_reported += 1;
            assert!((sum - volume).abs() <= 1e-12 * all, "{}: {sum}, reported {volume}", case.name);
        }
    }
    assert!(n_reported > 100, "{n_reported}");
}

#[test]
fn every_point_is_used_and_no_two_cases_are_alike() {
    let (mut seen, mut sizes) = (BTreeSet::new(), Vec::new());
    for case in (0..1000).map(random_case) {
        let used: BTreeSet<_> = case.triangles.iter().flatten().collect();
        assert_eq!(used.len(), case.points.len(), "{}", case.name);
        let bits: Vec<u64> = case.points.iter().flatten().map(|x| x.to_bits()).collect();
        seen.insert((bits, case.triangles.clone()));
        sizes.push(case.triangles.len());
    }
    sizes.sort_unstable();
    println!("{} different; triangles {} to {}, median {}", seen.len(), sizes[0], sizes[999], sizes[500]);
    assert!(seen.len() > 950, "{}", seen.len());
}
