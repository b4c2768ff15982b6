//! Surfaces repaired on request: closed, facing outward, with the original volume; what cannot be repaired is
//! reported.

use crate::common::{Numbers, data_folder};
use motet::base::{Point, Threads, VertexId};
use motet::geometry::vector::{add, scale};
use motet::mesh::firsts_at_place;
use motet::mesh::shapes::{ball, box_grid};
use motet::mesh::{Surface, cone_volume};
use motet::preflight::{
    FaultKind, Preflight, RepairKind, Repaired, Repairs, Role, preflight, renamed, repair,
};

type Triangles = Vec<[VertexId; 3]>;

const ALL: Repairs = Repairs {
    merge: Some(0.0),
    imprint: true,
    cut: false,
    keep_inward: false,
    drop_degenerate: true,
    drop_duplicates: true,
    orient: true,
    close_holes: Some(12),
    unite: false,
    wrap: None,
};

fn ids<const N: usize>(triangles: [[u32; 3]; N]) -> Triangles {
    triangles.map(|t| t.map(VertexId)).to_vec()
}

fn volume(points: &[Point], triangles: &Triangles) -> f64 {
    triangles.iter().map(|t| cone_volume(t.iter().copied(), points, [0.1, 0.2, 0.3])).sum()
}

fn mend(points: &[Point], triangles: &Triangles, repairs: &Repairs) -> Repaired {
    let surface_of = vec![0; triangles.len()];
    repair(points, triangles, &surface_of, &[Role::Boundary], repairs, &Threads::single()).unwrap()
}

fn look(points: &[Point], triangles: &Triangles) -> Preflight {
    preflight(points, triangles, &vec![0; triangles.len()], &[Role::Boundary], &Threads::single())
}

/// The surface with separate corners for each triangle.
fn apart(points: &[Point], triangles: &Triangles) -> (Vec<Point>, Triangles) {
    let corners = triangles.as_flattened().iter().map(|v| points[v.index()]).collect();
    (corners, (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2].map(VertexId)).collect())
}

/// A ball without some triangles that share no vertex, the others oriented at random, all with separate
/// corners.
fn damaged_ball(seed: u64) -> (Vec<Point>, Triangles, f64, usize) {
    let surface = Surface::boundary_of(&ball(5, 1));
    let whole = volume(&surface.points, &surface.triangles);
    let mut numbers = Numbers(seed);
    let mut is_near_hole = vec![false; surface.points.len()];
    let (mut left, mut n_holes) = (Triangles::new(), 0);
    for &t in &surface.triangles {
        if numbers.below(12) == 0 && !t.iter().any(|v| is_near_hole[v.index()]) {
            t.iter().for_each(|v| is_near_hole[v.index()] = true);
            n_holes += 1;
        } else {
            left.push(if numbers.below(3) == 0 { [t[0], t[2], t[1]] } else { t });
        }
    }
    let (points, triangles) = apart(&surface.points, &left);
    (points, triangles, whole, n_holes)
}

#[test]
fn a_ball_of_loose_turned_triangles_with_holes_is_whole_again() {
    for seed in 0..5 {
        let (points, triangles, whole, n_holes) = damaged_ball(seed);
        assert!(n_holes > 5);
        let mended = mend(&points, &triangles, &ALL);
        let report = look(&points, &mended.triangles);
        assert!(report.is_fit() && report.faults.is_empty(), "{report}");
        assert!((volume(&points, &mended.triangles) - whole).abs() < 1e-12);
        assert_eq!(mended.count(RepairKind::ClosedHole), n_holes);
        assert_eq!(mended.triangles.len(), triangles.len() + n_holes);
        let turned = mended.done.iter().filter(|r| r.kind == RepairKind::Turned).map(|r| r.triangles[0]);
        for t in turned {
            let new = mended.new_to_old.iter().position(|old| *old == Some(t)).unwrap();
            let [a, b, c] = triangles[t as usize].map(|v| mended.vertex_to_kept[v.index()]);
            assert_eq!(mended.triangles[new], [a, c, b]);
        }
        // Labels: a triangle that fills a hole gets the label of one that shares an edge with it.
        let labels = mended.labels(&(0..triangles.len()).collect::<Vec<_>>());
        for (new, old) in mended.new_to_old.iter().enumerate() {
            let beside = triangles[labels[new]].map(|v| mended.vertex_to_kept[v.index()]);
            let n_shared = beside.iter().filter(|v| mended.triangles[new].contains(v)).count();
            assert_eq!(n_shared, if old.is_some() { 3 } else { 2 });
        }
    }
}

#[test]
fn near_vertices_are_merged_and_no_farther_than_asked() {
    let (mut points, triangles, whole, n_holes) = damaged_ball(7);
    let mut numbers = Numbers(9);
    points.iter_mut().for_each(|p| *p = p.map(|x| x + 1e-9 * numbers.unit()));
    assert_eq!(look(&points, &triangles).count(FaultKind::OpenEdge), 3 * triangles.len());
    let mended = mend(&points, &triangles, &Repairs { merge: Some(1e-8), ..ALL });
    assert!(look(&points, &mended.triangles).is_fit());
    assert!((volume(&points, &mended.triangles) - whole).abs() < 1e-7);
    assert_eq!(mended.count(RepairKind::ClosedHole), n_holes);
    // A chain of vertices does not collapse: each is merged into a remaining one within the distance.
    let chain: Vec<Point> = (0..10).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    let all: Triangles = (0..8).map(|i| [i, i + 1, i + 2].map(VertexId)).collect();
    let mended = mend(&chain, &all, &Repairs { merge: Some(1.5), ..Repairs::default() });
    assert_eq!(mended.vertex_to_kept, [0, 0, 2, 2, 4, 4, 6, 6, 8, 8].map(VertexId));
}

#[test]
fn a_plane_hole_is_filled_within_its_plane() {
    let surface = Surface::boundary_of(&box_grid([4, 4, 4], [[0.0; 3], [1.0, 1.0, 1.0]]));
    // All triangles of one side around an inner vertex, and one more: a rim with a dent.
    let middle = surface.points.iter().position(|p| *p == [0.5, 0.5, 1.0]).unwrap();
    let corner = surface.points.iter().position(|p| *p == [0.25, 0.25, 1.0]).unwrap();
    let is_hole = |t: &[VertexId; 3]| {
        let has = |v: usize| t.contains(&VertexId::new(v));
        t.iter().all(|v| surface.points[v.index()][2] == 1.0) && (has(middle) || has(corner))
    };
    let mut left: Triangles = surface.triangles.iter().copied().filter(|t| !is_hole(t)).collect();
    let n_removed = surface.triangles.len() - left.len();
    assert!(n_removed > 8);
    let mended = mend(&surface.points, &left, &ALL);
    let report = look(&surface.points, &mended.triangles);
    assert!(report.is_fit() && report.faults.is_empty(), "{report}");
    assert!((volume(&surface.points, &mended.triangles) - 1.0).abs() < 1e-12);
    assert_eq!(mended.count(RepairKind::ClosedHole), 1);
    // A rim that is too long stays, and so does one of a membrane only.
    let few = Repairs { close_holes: Some(4), ..ALL };
    assert_eq!(mend(&surface.points, &left, &few).count(RepairKind::LeftLong), 1);
    let surface_of = vec![0; left.len()];
    let membrane =
        repair(&surface.points, &left, &surface_of, &[Role::Membrane], &ALL, &Threads::single()).unwrap();
    assert_eq!(membrane.triangles, left);
    // Something that sticks through the hole keeps it open.
    let mut points = surface.points.clone();
    let first = points.len() as u32;
    points.extend([[0.5, 0.5, 0.5], [0.52, 0.5, 0.5], [0.5, 0.52, 0.5], [0.5, 0.5, 2.0]]);
    left.extend(
        ids([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).iter().map(|t| t.map(|v| VertexId(v.0 + first))),
    );
    let mended = mend(&points, &left, &ALL);
    assert_eq!((mended.count(RepairKind::ClosedHole), mended.count(RepairKind::LeftOpen)), (0, 1));
    assert!(mended.triangles == left);
}

/// A tetrahedron with vertices on one side of one of its edges only; flat triangles fill the gap of zero
/// width.
#[test]
fn flat_triangles_go_and_what_was_closed_stays_closed() {
    let mut points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    points.extend([[0.25, 0.0, 0.0], [0.5, 0.0, 0.0]]);
    let cases = [
        ids([[0, 2, 4], [4, 2, 5], [5, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3], [0, 4, 1], [4, 5, 1]]),
        ids([[0, 2, 4], [4, 2, 5], [5, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3], [0, 4, 5], [0, 5, 1]]),
        ids([[0, 2, 4], [4, 2, 1], [0, 5, 3], [5, 1, 3], [0, 3, 2], [1, 2, 3], [0, 4, 1], [0, 1, 5]]),
    ];
    for triangles in cases {
        let before = look(&points, &triangles);
        assert_eq!(
            (before.count(FaultKind::ZeroArea), before.count(FaultKind::OpenEdge)),
            (2, 0),
            "{before}"
        );
        let mended = mend(&points, &triangles, &Repairs { drop_degenerate: true, ..Repairs::default() });
        let report = look(&points, &mended.triangles);
        assert!(report.is_fit() && report.faults.is_empty(), "{report}");
        assert!((volume(&points, &mended.triangles) - volume(&points, &triangles)).abs() < 1e-15);
        assert!((volume(&points, &mended.triangles) - 1.0 / 6.0).abs() < 1e-15);
        assert!(mended.new_to_old.iter().all(Option::is_some));
    }
}

#[test]
fn duplicates_go_singly_or_in_pairs() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    let tet = ids([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
    let twice = [tet.clone(), ids([[1, 0, 2]])].concat();
    let only = Repairs { drop_duplicates: true, ..Repairs::default() };
    assert_eq!(look(&points, &twice).count(FaultKind::Duplicate), 1);
    assert_eq!(mend(&points, &twice, &only).triangles, tet);
    // Two tets glued at a facet that both have: a closed surface around both is left.
    let glued = [tet, ids([[0, 1, 2], [0, 4, 1], [0, 2, 4], [1, 4, 2]])].concat();
    let mended = mend(&points, &glued, &only);
    assert_eq!((mended.triangles.len(), mended.count(RepairKind::DroppedDuplicate)), (6, 2));
    assert!(look(&points, &mended.triangles).is_fit());
    assert!((volume(&points, &mended.triangles) - 1.0 / 3.0).abs() < 1e-15);
}

#[test]
fn closed_parts_face_outward_and_one_sided_ones_stay() {
    let surface = Surface::boundary_of(&ball(2, 1));
    let (n, m) = (surface.points.len(), surface.triangles.len());
    let inner = surface.points.iter().map(|p| add(scale(*p, 0.5), [0.1, 0.0, 0.0]));
    let points: Vec<Point> = surface.points.iter().copied().chain(inner).collect();
    let shifted = |t: &[VertexId; 3]| [t[0], t[2], t[1]].map(|v| VertexId::new(v.index() + n));
    let both: Triangles =
        surface.triangles.iter().copied().chain(surface.triangles.iter().map(shifted)).collect();
    let report = look(&points, &both);
    assert!(report.is_fit());
    assert_eq!(
        report.faults.iter().map(|f| (f.kind, f.triangles.clone())).collect::<Vec<_>>(),
        [(FaultKind::InwardPart, vec![m as u32])]
    );
    let mended = mend(&points, &both, &Repairs { orient: true, ..Repairs::default() });
    assert!(look(&points, &mended.triangles).faults.is_empty());
    assert_eq!(mended.count(RepairKind::Turned), m);
    // A strip of five triangles with a twist.
    let points: Vec<Point> =
        (0..5).map(|i| [f64::from(i * i % 5), f64::from(i), f64::from(i * i * i % 7)]).collect();
    let strip = ids([[0, 1, 2], [1, 2, 3], [2, 3, 4], [3, 4, 0], [4, 0, 1]]);
    let mended = mend(&points, &strip, &Repairs { orient: true, ..Repairs::default() });
    assert_eq!((mended.count(RepairKind::LeftOneSided), &mended.triangles), (1, &strip));
}

#[test]
fn a_distance_that_is_none_is_refused() {
    for merge in [-1.0, f64::NAN, f64::INFINITY] {
        let requested = Repairs { merge: Some(merge), ..Repairs::default() };
        assert!(repair(&[], &[], &[], &[], &requested, &Threads::single()).is_err());
    }
}

#[test]
fn real_surfaces_after_all_repairs() {
    let Some(folder) = data_folder() else { return };
    let mut surprises = Vec::new();
    for (name, is_fit) in [
        // A triangle attached by one edge only.
        ("vessels/pescio_AbdominalAorticAneurysm.stl", false),
        ("vessels/endobeams_ica_model.stl", true),
        ("hostile_surfaces/pescio_AbdominalAorta.stl", false),
        ("hostile_surfaces/seqseg_shawn_260.vtp", true),
        ("hostile_surfaces/heartdeformnets_mmwhs_template.vtp", false),
        ("hostile_surfaces/manifold_Offset1.obj", false),
        ("hostile_surfaces/manifold_openscad-nonmanifold-crash.obj", false),
        ("hostile_surfaces/trimesh_joined_tetrahedra.obj", true),
        ("hostile_surfaces/trimesh_soup.stl", false),
    ] {
        let surface = Surface::of(&motet::io::read(folder.join(name)).unwrap());
        let (points, triangles) =
            (&surface.points, renamed(&surface.triangles, &firsts_at_place(&surface.points)));
        let mended = mend(points, &triangles, &Repairs { close_holes: Some(64), ..ALL });
        let mut done: Vec<(RepairKind, usize)> = Vec::new();
        for repair in &mended.done {
            match done.iter_mut().find(|d| d.0 == repair.kind) {
                Some(d) => d.1 += 1,
                None => done.push((repair.kind, 1)),
            }
        }
        let report = look(points, &mended.triangles);
        println!("{name}: {}\n    {done:?}\n    {report}", look(points, &triangles));
        surprises.extend((report.is_fit() != is_fit).then_some(name));
    }
    assert!(surprises.is_empty(), "{surprises:?}");
}
