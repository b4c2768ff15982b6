//! What prevents surfaces from being meshed: compared with brute force in rational numbers, and on real
//! surfaces.

use std::collections::BTreeMap;

use crate::common::data_folder;
use crate::common::random::Random;
use crate::oracle::{FaultKey, crosses, faults};
use motet::base::{Point, Threads, VertexId};
use motet::geometry::quality::eas;
use motet::geometry::vector::distance;
use motet::io::{self, WriteOptions};
use motet::mesh::firsts_at_place;
use motet::mesh::{CellKind, Surface};
use motet::preflight::{
    Fault, FaultKind, Preflight, RepairKind, Repairs, Role, culprits, preflight, renamed, repair,
};
use proptest::prelude::*;

type Triangles = Vec<[VertexId; 3]>;

fn fault_keys(report: &Preflight) -> Vec<FaultKey> {
    let of = |f: &Fault| (f.kind, f.is_fatal, f.surface, f.triangles.clone(), f.vertices.clone());
    report.faults.iter().map(of).collect()
}

fn alone(points: &[Point], triangles: &Triangles, role: Role) -> Preflight {
    preflight(points, triangles, &vec![0; triangles.len()], &[role], &Threads::single())
}

fn small_grid(n: usize) -> impl Strategy<Value = Vec<Point>> {
    prop::collection::vec(prop::array::uniform3((-2i8..=2).prop_map(f64::from)), n)
}

fn soup(n_points: u32, n: usize) -> impl Strategy<Value = Triangles> {
    prop::collection::vec(prop::array::uniform3((0..n_points).prop_map(VertexId)), 1..n)
}

/// The sides of tets: closed parts, with either orientation, glued at vertices, edges and facets.
fn tets(n_points: u32, n: usize) -> impl Strategy<Value = Triangles> {
    let tets = prop::collection::vec(prop::array::uniform4((0..n_points).prop_map(VertexId)), 1..n);
    tets.prop_map(|tets| {
        let sides = |&[a, b, c, d]: &[VertexId; 4]| [[b, c, d], [a, d, c], [a, b, d], [a, c, b]];
        tets.iter().flat_map(sides).collect()
    })
}

fn roles() -> impl Strategy<Value = Vec<Role>> {
    prop::collection::vec(prop_oneof![Just(Role::Boundary), Just(Role::Membrane)], 3)
}

/// Compares the whole list of faults with that of the oracle.
fn holds_against_everything(points: &[Point], triangles: &Triangles, of: &[u32], roles: &[Role]) {
    let surface_of: Vec<u32> = (0..triangles.len()).map(|t| of[t % of.len()]).collect();
    let report = preflight(points, triangles, &surface_of, roles, &Threads::single());
    assert_eq!(fault_keys(&report), faults(points, triangles, &surface_of, roles));
    assert_eq!(report.is_fit(), !report.faults.iter().any(|f| f.is_fatal));
    assert_eq!(report.first_error().is_none(), report.is_fit());
    let n: usize = report.counts.iter().map(|count| count.fatal + count.notes).sum();
    assert_eq!(n, report.faults.len());
    for fault in report.faults.iter().filter(|f| f.kind == FaultKind::Crossing) {
        let at = fault.at.expect("corners are finite");
        for &t in &fault.triangles {
            let corners = triangles[t as usize].map(|v| points[v.index()]);
            let weights = motet::geometry::triangle::closest(corners, at);
            assert!(distance(motet::geometry::triangle::at(corners, weights), at) < 1e-14, "{fault:?}");
        }
    }
}

/// Difficult coordinates: not finite, of extreme sizes, and ordinary ones.
fn any_coordinate() -> impl Strategy<Value = f64> {
    let hard = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, 5e-324, -0.0, 1e300, 1e-300];
    prop_oneof![1 => prop::sample::select(hard.to_vec()), 6 => (-2i8..=2).prop_map(f64::from), 2 => -1.0..1.0]
}

fn any_repairs() -> impl Strategy<Value = Repairs> {
    let distances = [None, Some(0.0), Some(1e-9), Some(1.0), Some(1e50)];
    let merge = prop::sample::select(distances.to_vec());
    let wraps = prop::sample::select(vec![None, None, None, None, Some(0.5), Some(1e9)]);
    let repairs = (merge, any::<[bool; 7]>(), prop::option::of(0usize..8), wraps);
    repairs.prop_map(|(merge, flags, close_holes, wrap)| Repairs {
        merge,
        drop_degenerate: flags[0],
        drop_duplicates: flags[1],
        orient: flags[2],
        imprint: flags[3],
        cut: flags[4],
        keep_inward: flags[5],
        close_holes,
        unite: flags[6],
        wrap,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn soups_have_the_faults_of_a_look_at_everything(
        points in small_grid(9), triangles in soup(9, 14), of in prop::collection::vec(0u32..3, 1..6), roles in roles(),
    ) {
        holds_against_everything(&points, &triangles, &of, &roles);
        let map = firsts_at_place(&points);
        holds_against_everything(&points, &renamed(&triangles, &map), &of, &roles);
    }

    #[test]
    fn sides_of_tets_have_the_faults_of_a_look_at_everything(
        points in small_grid(8), triangles in tets(8, 5), roles in roles(), is_one in any::<bool>(),
    ) {
        let of: Vec<u32> = if is_one { vec![0] } else { vec![0, 0, 0, 0, 1, 1, 1, 1] };
        holds_against_everything(&points, &triangles, &of, &roles);
    }

    /// Whatever the input, nothing panics or hangs; the number of threads makes no difference; only what was
    /// requested is done.
    #[test]
    fn anything_is_looked_at_and_repaired(
        points in prop::collection::vec(prop::array::uniform3(any_coordinate()), 10),
        triangles in soup(10, 40), of in prop::collection::vec(0u32..3, 1..6), roles in roles(), repairs in any_repairs(),
    ) {
        let surface_of: Vec<u32> = (0..triangles.len()).map(|t| of[t % of.len()]).collect();
        let (one, two) = (Threads::single(), Threads::new(2).unwrap());
        let report = preflight(&points, &triangles, &surface_of, &roles, &one);
        prop_assert_eq!(&report, &preflight(&points, &triangles, &surface_of, &roles, &two));
        serde_json::to_string(&report).unwrap();
        culprits(&points, &triangles, &report).validate().unwrap();
        let mended = repair(&points, &triangles, &surface_of, &roles, &repairs, &one);
        let again = repair(&points, &triangles, &surface_of, &roles, &repairs, &two);
        // Points are compared as text, since NaN is not equal to NaN.
        prop_assert_eq!(format!("{mended:?}"), format!("{again:?}"));
        // A wrap is refused where nothing is enclosed.
        let Ok(mended) = mended else {
            prop_assert!(repairs.wrap.is_some());
            return Ok(());
        };
        if repairs == Repairs::default() {
            prop_assert_eq!(&mended.triangles, &triangles);
            prop_assert!(mended.done.is_empty());
        }
        prop_assert!(points.len() <= mended.points.len() && mended.new_points.len() == mended.points.len() - points.len());
        let after = preflight(&mended.points, &mended.triangles, &mended.surface_of, &roles, &one);
        prop_assert!(!repairs.drop_duplicates || after.count(FaultKind::Duplicate) == 0);
        prop_assert!(!repairs.drop_degenerate || after.count(FaultKind::RepeatedVertex) == 0);
    }
}

#[test]
fn no_triangle_is_double_after_a_wrap_either() {
    // A membrane beside a boundary, its triangle given twice.
    let points = [
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [9.0, 0.0, 0.0],
        [9.0, 1.0, 0.0],
        [9.0, 0.0, 1.0],
    ];
    let triangles: Triangles =
        [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3], [4, 5, 6], [4, 5, 6]].map(|t| t.map(VertexId)).to_vec();
    let (of, roles) = ([0, 0, 0, 0, 1, 1], [Role::Boundary, Role::Membrane]);
    let repairs = Repairs { unite: true, wrap: Some(0.05), ..Repairs::all(0.0, 0) };
    let mended = repair(&points, &triangles, &of, &roles, &repairs, &Threads::single()).unwrap();
    let after = preflight(&mended.points, &mended.triangles, &mended.surface_of, &roles, &Threads::single());
    assert_eq!(after.count(FaultKind::Duplicate), 0);
    assert_eq!((mended.triangles.len() > 1, mended.count(RepairKind::Wrapped)), (true, 1));
}

#[test]
fn welding_takes_the_smallest_id_and_leaves_what_is_no_number() {
    let points =
        [[1.0, 0.0, 0.0], [0.0; 3], [-0.0, 0.0, 0.0], [f64::NAN; 3], [f64::NAN; 3], [0.0, -0.0, 0.0]];
    assert_eq!(firsts_at_place(&points), [0, 1, 1, 3, 4, 1].map(VertexId));
    assert_eq!(renamed(&[[0, 2, 5].map(VertexId)], &firsts_at_place(&points)), [[0, 1, 1].map(VertexId)]);
}

#[test]
fn roles_say_what_is_fatal() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let triangles: Triangles = [[0, 1, 2], [0, 2, 3]].map(|t| t.map(VertexId)).to_vec();
    assert!(alone(&points, &triangles, Role::Membrane).is_fit());
    let report = alone(&points, &triangles, Role::Boundary);
    let error = report.first_error().expect("it is open").to_string();
    assert!(
        error.contains("4 open_edge") && error.contains("surface 0, triangle 0, vertices 0, 1 at"),
        "{error}"
    );
    let none = preflight(&points, &triangles, &[0, 2], &[Role::Membrane; 3], &Threads::single());
    assert_eq!(fault_keys(&none)[0], (FaultKind::EmptySurface, true, 1, vec![], vec![]));
}

#[test]
fn culprits_are_the_faulty_cells_and_survive_a_file() {
    let points =
        vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.2, 0.2, -1.0], [0.3, 0.2, 1.0], [0.2, 0.4, 1.0]];
    let triangles: Triangles = [[0, 1, 2], [3, 4, 5]].map(|t| t.map(VertexId)).to_vec();
    let report = alone(&points, &triangles, Role::Boundary);
    assert_eq!((report.count(FaultKind::Crossing), report.count(FaultKind::OpenEdge)), (1, 6));
    let mesh = culprits(&points, &triangles, &report);
    assert_eq!(mesh.cells.counts(), [(CellKind::LINE, 6), (CellKind::TRIANGLE, 2)]);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("culprits.vtp");
    assert_eq!(io::write(&file, &mesh, &WriteOptions::default()).unwrap(), [""; 0], "nothing is lost");
    let back = io::read(&file).unwrap();
    for name in ["fault", "kind", "fatal", "surface", "triangle"] {
        assert_eq!(back.cell_field(name), mesh.cell_field(name), "{name}");
    }
    let triangle = back.cell_field("triangle").unwrap().values.to_i64().unwrap();
    assert_eq!(triangle, [-1, -1, -1, -1, -1, -1, 0, 1]);
    let named = back.field_data.iter().find(|field| field.name == "kind:crossing").unwrap();
    assert_eq!(named.values.to_i64().unwrap(), [i64::from(FaultKind::Crossing.code())]);
}

/// What the README of the data folder reports about a surface; the last is pymeshlab's count of
/// self-intersecting faces.
struct Known {
    name: &'static str,
    open_edges: usize,
    branching_edges: usize,
    duplicates: Option<usize>,
    zero_area: Option<usize>,
    crossing_faces: Option<usize>,
    is_fit: bool,
}

const fn known(name: &'static str, edges: [usize; 2], rest: [Option<usize>; 3], is_fit: bool) -> Known {
    let [duplicates, zero_area, crossing_faces] = rest;
    Known {
        name,
        open_edges: edges[0],
        branching_edges: edges[1],
        duplicates,
        zero_area,
        crossing_faces,
        is_fit,
    }
}

const SURFACES: &[Known] = &[
    known("hostile_surfaces/pescio_AbdominalAorta.stl", [18, 8], [None, None, Some(14)], false),
    known("hostile_surfaces/seqseg_shawn_260.vtp", [14, 180], [Some(126), None, Some(252)], false),
    known("hostile_surfaces/heartdeformnets_mmwhs_template.vtp", [2, 1], [None, None, Some(5237)], false),
    known("hostile_surfaces/manifold_Offset1.obj", [0, 4], [Some(2), Some(10), Some(125)], false),
    known(
        "hostile_surfaces/manifold_openscad-nonmanifold-crash.obj",
        [0, 18],
        [Some(3), Some(1), Some(672)],
        false,
    ),
    known("hostile_surfaces/manifold_Cray_right.obj", [0, 3], [Some(8), Some(12), None], true),
    known("hostile_surfaces/manifold_self_intersectA.obj", [0, 0], [None, None, Some(334)], false),
    known("hostile_surfaces/manifold_self_intersectB.obj", [0, 0], [None, None, Some(334)], false),
    known("hostile_surfaces/trimesh_soup.stl", [300, 0], [None, None, Some(99)], false),
    known("hostile_surfaces/trimesh_joined_tetrahedra.obj", [0, 3], [Some(1), None, None], false),
    known("hostile_surfaces/trimesh_not_convex.obj", [0, 12], [None, None, None], false),
    known("hostile_surfaces/trimesh_shared.STL", [0, 1], [None, None, None], true),
    known("hostile_surfaces/trimesh_7_8ths_cube.stl", [0, 0], [None, None, None], true),
    known("vessels/pescio_AbdominalAorticAneurysm.stl", [2, 2], [None, None, None], false),
    known("vessels/seqseg_demo.vtp", [0, 0], [None, None, None], true),
    known("vessels/heartdeformnets_lh_template.vtp", [0, 0], [None, None, None], true),
    known("vessels/endobeams_ica_model.stl", [100, 0], [None, None, None], false),
    known("vessels/vmtk_id1_aneurysm.vtp", [297, 0], [None, None, None], false),
    known("devices/sphinxsys_coil.stl", [0, 0], [None, None, None], true),
    known("devices/confluent_nitinol_strut_deployed.stl", [0, 0], [None, None, None], true),
    known("devices/endobeams_braided_stent/arcStretchObj.obj", [0, 0], [None, None, None], true),
];

/// Numbers of edges of one triangle and of more than two, with duplicate triangles counted.
fn plain_edges(triangles: &Triangles) -> [usize; 2] {
    let mut uses: BTreeMap<[VertexId; 2], usize> = BTreeMap::new();
    for [a, b, c] in triangles.iter().filter(|[a, b, c]| a != b && b != c && c != a) {
        for [u, v] in [[a, b], [b, c], [c, a]] {
            *uses.entry([*u.min(v), *u.max(v)]).or_default() += 1;
        }
    }
    [uses.values().filter(|&&n| n == 1).count(), uses.values().filter(|&&n| n > 2).count()]
}

/// A sample of pairs of triangles whose boxes touch.
fn some_near_pairs(points: &[Point], triangles: &Triangles, n: usize) -> Vec<[u32; 2]> {
    let boxes: Vec<[Point; 2]> = triangles
        .iter()
        .map(|t| {
            let of = |f: fn(f64, f64) -> f64| {
                let [a, b, c] = t.map(|v| points[v.index()]);
                [0, 1, 2].map(|k| f(f(a[k], b[k]), c[k]))
            };
            [of(f64::min), of(f64::max)]
        })
        .collect();
    let touch = |a: &[Point; 2], b: &[Point; 2]| (0..3).all(|k| a[0][k] <= b[1][k] && b[0][k] <= a[1][k]);
    // For large surfaces, a sample of the triangles.
    let step = triangles.len() / 3000 + 1;
    let mut pairs = Vec::new();
    for i in (0..triangles.len()).step_by(step) {
        let near = (i + 1..triangles.len()).filter(|&j| touch(&boxes[i], &boxes[j]));
        pairs.extend(near.map(|j| [i as u32, j as u32]));
    }
    let step = pairs.len() / n + 1;
    pairs.into_iter().step_by(step).collect()
}

/// Asserts in rational numbers that reported pairs cross, and others do not.
fn check_crossings(points: &[Point], triangles: &Triangles, report: &Preflight) -> usize {
    let is_crossing = |f: &&Fault| f.kind == FaultKind::Crossing;
    let found: Vec<[u32; 2]> =
        report.faults.iter().filter(is_crossing).map(|f| [f.triangles[0], f.triangles[1]]).collect();
    let cross = |[i, j]: [u32; 2]| crosses(points, &triangles[i as usize], &triangles[j as usize]);
    for &pair in found.iter().step_by(found.len() / 1000 + 1) {
        assert!(cross(pair), "{pair:?} do not cross");
    }
    let of = |kind| report.faults.iter().filter(move |f| f.kind == kind);
    let mut left_out: Vec<u32> = of(FaultKind::Duplicate).map(|f| f.triangles[1]).collect();
    left_out.extend(of(FaultKind::ZeroArea).map(|f| f.triangles[0]));
    for pair in some_near_pairs(points, triangles, 1500) {
        if !pair.iter().any(|t| left_out.contains(t)) {
            assert_eq!(found.binary_search(&pair).is_ok(), cross(pair), "{pair:?}");
        }
    }
    let mut faces = found.concat();
    faces.sort_unstable();
    faces.dedup();
    faces.len()
}

/// Differences between our counts and those of the README:
/// - pairs are counted here and faces there: the number of different triangles in pairs is compared with it;
/// - duplicates count as self-intersecting there (seqseg_shawn_260: 252 are 2 x 126), not here;
/// - areas below some bound are zero there, here only those that are exactly zero;
/// - manifold_Cray_right overflows in single precision, in which it was measured there; in double precision
///   it is a valid prism;
/// - edges of duplicates count there as often as they occur; that count is made here too, and has to be the
///   same.
#[test]
fn real_surfaces_are_refused_or_fit() {
    let Some(folder) = data_folder() else { return };
    for name in ["trimesh_empty.stl", "nvidia_aneurysm_closed_lfs_pointer.stl", "trimesh_stl_empty_bin.stl"] {
        let Err(error) = io::read(folder.join("hostile_surfaces").join(name)) else {
            panic!("{name} was read")
        };
        println!("{name}: {error}");
    }
    for known in SURFACES {
        let surface = Surface::of(&io::read(folder.join(known.name)).unwrap());
        let (points, triangles) =
            (&surface.points, renamed(&surface.triangles, &firsts_at_place(&surface.points)));
        let report = alone(points, &triangles, Role::Boundary);
        let two = Threads::new(2).unwrap();
        let again = preflight(points, &triangles, &vec![0; triangles.len()], &[Role::Boundary], &two);
        assert_eq!(report, again, "threads changed an answer");
        let n_faces = check_crossings(points, &triangles, &report);
        println!("{}: {report}", known.name);
        println!("    {n_faces} triangles cross (README {:?})", known.crossing_faces);
        if let Some(error) = report.first_error() {
            println!("    {error}");
        }
        assert_eq!(report.is_fit(), known.is_fit, "{}", known.name);
        if known.name.contains("Cray") {
            holds_against_everything(points, &triangles, &[0], &[Role::Boundary]);
            continue;
        }
        assert_eq!(plain_edges(&triangles), [known.open_edges, known.branching_edges], "{}", known.name);
        assert_eq!(report.count(FaultKind::Duplicate), known.duplicates.unwrap_or(0), "{}", known.name);
        assert!(report.count(FaultKind::ZeroArea) <= known.zero_area.unwrap_or(0), "{}", known.name);
        if triangles.len() <= 200 {
            holds_against_everything(points, &triangles, &[0], &[Role::Boundary]);
        }
    }
}

/// A tet on a triangle of a surface is never better than the report says, and can be nearly as good.
#[test]
fn narrow_triangles_are_counted_with_the_quality_that_they_allow() {
    let needle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.1, 0.0]];
    let points = [needle[0], needle[1], needle[2], [0.6, 0.05, 1.0]];
    let triangles: Triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|t| t.map(VertexId)).to_vec();
    let narrow = alone(&points, &triangles, Role::Boundary).narrow.unwrap();
    // The second one has an angle of 5.2 degrees at vertex 3.
    assert_eq!((narrow.n_triangles, narrow.triangle), (2, 2));
    let narrow = alone(&points, &triangles[..2].to_vec(), Role::Membrane).narrow.unwrap();
    assert_eq!((narrow.n_triangles, narrow.triangle), (1, 0));
    assert!((narrow.highest_eas - 0.1f64.atan().to_degrees() / 60.0).abs() < 1e-12, "{narrow:?}");
    let mut random = Random(3);
    let mut best = 0.0;
    for _ in 0..20_000 {
        let apex = [random.next(), 2.0 * random.next() - 1.0, random.next()];
        best = f64::max(best, eas([needle[0], needle[1], needle[2], apex]));
    }
    assert!(best <= narrow.highest_eas + 1e-12 && best > 0.95 * narrow.highest_eas, "{best} {narrow:?}");
    let even = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    assert_eq!(alone(&even, &triangles, Role::Boundary).narrow, None);
}
