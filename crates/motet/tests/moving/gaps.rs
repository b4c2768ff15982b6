//! Gaps between watched walls as sizes: a moving mesh is divided where they are narrow, and coarsened where
//! they are wide again.

use motet::base::{Point, Threads, VertexId};
use motet::contact;
use motet::geometry::vector::{distance, norm};
use motet::mesh::Mesh;
use motet::mesh::shapes::sphere_in_box;
use motet::moving::{GAP, MovingMesh, Options, Watching, Why};
use motet::refine::{Criterion, Limits, Size, Wanted};

fn threads() -> Threads {
    Threads::single()
}

fn watched() -> Options {
    let watch = Watching {
        patches: vec!["sphere".into(), "box".into()],
        options: contact::Options::default(),
        horizon: None,
        hold: None,
    };
    Options { watch: Some(watch), ..Options::default() }
}

/// Edges no longer than gaps; divisions taken back where gaps are wider.
fn by_gaps() -> Wanted {
    let criteria = vec![Criterion::Size(Size::Array(GAP.into()))];
    let limits = Limits { smallest: Some(0.2), ..Limits::default() };
    Wanted { criteria, coarsen: true, limits, ..Wanted::default() }
}

fn sphere_goes(moving: &MovingMesh, by: f64) -> Vec<Point> {
    let goes = |p: &Point| if norm(*p) < 1.01 { [by, 0.0, 0.0] } else { [0.0; 3] };
    moving.driven_places().iter().map(goes).collect()
}

/// The longest edge of tets all of whose vertices have a gap below a limit.
fn longest_in_gap(moving: &MovingMesh, below: f64) -> f64 {
    let mesh = moving.mesh();
    let gaps = moving.gaps().unwrap().at_points(mesh.points.len());
    let is_near = |v: VertexId| gaps[v.index()] < below;
    let edges =
        mesh.cells.tets().flat_map(|(_, t)| (0..4).flat_map(move |i| (0..i).map(move |j| [t[i], t[j]])));
    let lengths = edges
        .filter(|e| e.iter().all(|v| is_near(*v)))
        .map(|[a, b]| distance(mesh.points[a.index()], mesh.points[b.index()]));
    lengths.fold(0.0, f64::max)
}

#[test]
fn edges_of_walls_are_as_short_as_gaps_are_wide() {
    let first: Mesh = sphere_in_box(4, 4);
    let mut moving = MovingMesh::new(&first, watched(), &threads()).unwrap();
    let n_first = first.cells.tets().count();
    assert!(
        moving.refine(&by_gaps(), &threads()).unwrap().is_empty(),
        "gaps of four are wider than edges are long"
    );
    moving.advance(1.0, &sphere_goes(&moving, 2.0), &threads()).unwrap();
    moving.advance(2.0, &sphere_goes(&moving, 3.4), &threads()).unwrap();
    let (before, n_before) = (longest_in_gap(&moving, 0.75), moving.mesh().cells.tets().count());
    let changes = moving.refine(&by_gaps(), &threads()).unwrap();
    assert!(!changes.is_empty() && changes.iter().all(|c| c.why == Why::Refinement && c.time == 2.0));
    assert_eq!(changes[0].tets_before, n_before);
    let n_fine = moving.mesh().cells.tets().count();
    moving.certify(&threads()).unwrap();
    let after = longest_in_gap(&moving, 0.75);
    assert!(n_fine > n_before && before > 0.75 && after <= 0.75, "{before} {after}");
    assert!(moving.mesh().point_field(GAP).is_none(), "the array is there for criteria alone");
    moving.advance(3.0, &sphere_goes(&moving, 1.0), &threads()).unwrap();
    while !moving.refine(&by_gaps(), &threads()).unwrap().is_empty() {}
    let n_back = moving.mesh().cells.tets().count();
    assert!(n_back < n_fine && (n_back as f64) < 1.5 * n_first as f64, "{n_first} {n_fine} {n_back}");
}

/// The number of tets and the longest edge in the gap, before and after a mesh that was divided by its gaps
/// is coarsened down to a length.
fn coarsened(smallest: f64) -> [(usize, f64); 2] {
    let mut moving = MovingMesh::new(&sphere_in_box(4, 4), watched(), &threads()).unwrap();
    moving.advance(1.0, &sphere_goes(&moving, 2.0), &threads()).unwrap();
    moving.advance(2.0, &sphere_goes(&moving, 3.4), &threads()).unwrap();
    moving.refine(&by_gaps(), &threads()).unwrap();
    assert!(moving.gaps().is_none(), "what was measured is of triangles that are no more");
    let state = |moving: &mut MovingMesh| {
        moving.certify(&threads()).unwrap();
        (moving.mesh().cells.tets().count(), longest_in_gap(moving, 0.75))
    };
    let before = state(&mut moving);
    moving.coarsen(smallest, &threads()).unwrap();
    [before, state(&mut moving)]
}

#[test]
fn what_a_narrow_gap_asks_for_is_not_taken_back_by_lengths() {
    let [before, by_gap] = coarsened(0.2);
    let [_, by_first] = coarsened(10.0);
    assert!(by_first.0 < by_gap.0 && by_gap.0 <= before.0, "{before:?} {by_gap:?} {by_first:?}");
    assert!(by_gap.1 <= 0.75, "{by_gap:?}");
}
