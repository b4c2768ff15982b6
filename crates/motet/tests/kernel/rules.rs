//! Rules of the kernel, one by one: look-ups agree with all tets, held things stay, tets that walls force
//! count as good.

use crate::common::{Numbers, random_mesh};
use motet::base::{Point, TetId, Threads, VertexId};
use motet::geometry::quality::{dihedral, eas, highest_eas};
use motet::geometry::triangle::angle_at;
use motet::kernel::{Change, Complex, FLATTEST, Hold, Reject, Side, Star, VertexChange, is_reached};
use motet::mesh::TetMesh;
use motet::mesh::TetPart;
use motet::mesh::shapes::box_grid;
use motet::ops::{Anywhere, Smoothing, collapse};

fn cube(n: usize) -> TetMesh {
    TetPart::of(&box_grid([n; 3], [[0.0; 3], [1.0; 3]])).unwrap().mesh
}

/// Moves some vertices to better places.
fn smooth_some(complex: &mut Complex, n: usize) {
    let (mut star, mut smoothing, mut change) = (Star::default(), Smoothing::default(), Change::default());
    for v in (0..complex.n_vertex_slots())
        .map(VertexId::new)
        .filter(|&v| complex.hold(v) == Hold::Free)
        .take(n)
        .collect::<Vec<_>>()
    {
        star.gather(complex, v);
        let bar = complex.worst_of(&star.tets);
        if smoothing.propose(complex, &star.tets, v, [bar, 1.0], &Anywhere, &mut change) {
            let checked = complex.check(&change).unwrap();
            complex.commit(checked, &mut Vec::new());
        }
    }
}

#[test]
fn the_worst_tet_and_those_below_a_bar_are_those_that_all_tets_say() {
    for seed in 0..20 {
        let mut complex = Complex::new(&random_mesh(40, seed)).unwrap();
        for n_moved in [0, 5] {
            smooth_some(&mut complex, n_moved);
            let measured: Vec<(TetId, f64)> = complex.tets().map(|t| (t, eas(complex.corners(t)))).collect();
            let lowest = measured.iter().map(|(_, q)| *q).fold(f64::INFINITY, f64::min);
            let first = measured.iter().copied().find(|(_, q)| *q == lowest);
            assert_eq!(complex.worst(), first);
            for bar in [lowest, lowest.next_up(), 0.1, 0.3, 0.9] {
                let below: Vec<TetId> = measured.iter().filter(|(_, q)| *q < bar).map(|(t, _)| *t).collect();
                assert_eq!(complex.below(bar, &Threads::single()), below);
            }
        }
    }
    assert_eq!(Complex::new(&TetMesh::default()).unwrap().worst(), None);
}

#[test]
fn vertices_are_used_as_long_as_a_tet_has_them() {
    let mut mesh = cube(3);
    let n = mesh.points.len();
    mesh.points.push([5.0; 3]);
    let mut complex = Complex::new(&mesh).unwrap();
    assert_eq!((complex.n_used_vertices(), complex.n_vertex_slots()), (n, n + 1));
    assert!(!complex.is_used(VertexId::new(n)) && complex.hold(VertexId::new(n)) == Hold::Fixed);
    // An inner vertex is collapsed into a neighbour: its slot is the next to be reused.
    let removed = (0..n).map(VertexId::new).find(|&v| complex.hold(v) == Hold::Free).unwrap();
    let (mut star, mut change) = (Star::default(), Change::default());
    star.gather(&complex, removed);
    let mut ends: Vec<VertexId> =
        star.tets.iter().flat_map(|&t| complex.vertices(t)).filter(|&v| v != removed).collect();
    ends.sort_unstable();
    ends.dedup();
    let kept = ends
        .into_iter()
        .find(|&kept| collapse(&complex, &star.tets, removed, kept, 0.0, &mut change))
        .unwrap();
    assert!(collapse(&complex, &star.tets, removed, kept, 0.0, &mut change));
    assert_eq!(complex.next_vertex(), VertexId::new(n + 1));
    let checked = complex.check_against(&change, 0.0).unwrap();
    let mut inserted = Vec::new();
    complex.commit(checked, &mut inserted);
    assert_eq!((complex.n_used_vertices(), complex.next_vertex()), (n - 1, removed));
    assert!(!complex.is_used(removed) && inserted.iter().all(|&t| !complex.is_original(t)));

    let extract = complex.extract(&mesh);
    let old_to_vertex = extract.old_to_vertex(n + 1);
    assert!(old_to_vertex[removed.index()].is_none());
    for (old, new) in old_to_vertex.iter().enumerate().filter(|(old, _)| *old != removed.index()) {
        assert_eq!(extract.mesh.points[new.get().unwrap().index()], mesh.points[old]);
    }
    for tet in complex.tets() {
        let now = extract.mesh.tets[extract.tet(tet).index()].map(|v| extract.mesh.points[v.index()]);
        assert_eq!(now.map(|p| p.map(f64::to_bits)), complex.corners(tet).map(|p| p.map(f64::to_bits)));
    }
}

/// Collapses a vertex of a wall into one beside it, with its walls.
fn drawn(complex: &Complex, removed: VertexId, kept: VertexId) -> Result<(), Reject> {
    let (mut star, mut change) = (Star::default(), Change::default());
    star.gather(complex, removed);
    collapse(complex, &star.tets, removed, kept, -2.0, &mut change);
    complex.check_against(&change, 0.0).map(|_| ())
}

#[test]
fn what_is_held_neither_moves_nor_goes() {
    let mesh = cube(4);
    let at = |p: Point| VertexId::new(mesh.points.iter().position(|&q| q == p).unwrap());
    // Two vertices inside a side of the cube.
    let (removed, kept) = (at([0.0, 0.5, 0.5]), at([0.0, 0.5, 0.25]));
    let fresh = || Complex::new(&mesh).unwrap();
    assert_eq!(drawn(&fresh(), removed, kept), Err(Reject::Held(removed)), "the surface is kept");
    let adapting = || {
        let mut complex = fresh();
        complex.adapt_surface();
        complex
    };
    assert!(!adapting().keeps_surface() && fresh().keeps_surface());
    assert_eq!(drawn(&adapting(), removed, kept), Ok(()));

    let mut fixed = adapting();
    fixed.set_hold(removed, Hold::Fixed);
    assert_eq!(drawn(&fixed, removed, kept), Err(Reject::Held(removed)));

    let mut locked = adapting();
    let tet = locked.tet_of(removed);
    locked.lock(tet);
    assert!(locked.is_locked(tet) && locked.tets().filter(|&t| locked.is_locked(t)).count() == 1);
    assert_eq!(drawn(&locked, removed, kept), Err(Reject::Locked(tet)));

    // A fixed wall holds its vertices; one of the others may still be removed if that leaves the wall.
    let mut walled = adapting();
    let of_both = |complex: &Complex| {
        let has_both = |v: [VertexId; 3]| v.contains(&removed) && v.contains(&kept);
        complex.walls().find(|(_, wall)| has_both(complex.facet(wall.sides[0]))).unwrap().0
    };
    let wall = of_both(&walled);
    walled.fix_wall(wall);
    assert!(
        walled.is_fixed_wall(wall) && walled.walls().filter(|(id, _)| walled.is_fixed_wall(*id)).count() == 1
    );
    assert_eq!(walled.hold(removed), Hold::Fixed);
    walled.set_hold(removed, Hold::Surface);
    assert!(matches!(drawn(&walled, removed, kept), Err(Reject::Wall(_))));

    // A fixed edge stays although its ends may move.
    let inner = (0..mesh.points.len()).map(VertexId::new).find(|&v| fresh().hold(v) == Hold::Free).unwrap();
    let mut star = Star::default();
    star.gather(&fresh(), inner);
    let end = fresh().vertices(star.tets[0]).into_iter().find(|&v| v != inner).unwrap();
    let mut edged = fresh();
    assert!(edged.may_divide(inner, end) && !edged.is_kept_edge(inner, end));
    edged.fix_edges([[inner, end]]);
    assert!(
        edged.is_fixed_edge(end, inner) && edged.is_kept_edge(inner, end) && !edged.may_divide(inner, end)
    );
    assert_eq!([inner, end].map(|v| edged.hold(v)), [Hold::Fixed; 2]);
    edged.set_hold(inner, Hold::Free);
    let refusal = drawn(&edged, inner, end);
    assert!(
        matches!(refusal, Err(Reject::Edge(edge)) if edge.contains(&inner) && edge.contains(&end)),
        "{refusal:?}"
    );
}

#[test]
fn a_star_has_walls_where_its_vertex_is_on_one() {
    let mesh = cube(3);
    let complex = Complex::new(&mesh).unwrap();
    for v in (0..mesh.points.len()).map(VertexId::new) {
        let mut star = Star::default();
        star.gather(&complex, v);
        let is_outside = complex.point(v).iter().any(|&x| x == 0.0 || x == 1.0);
        assert_eq!((star.has_walls, complex.hold(v) == Hold::Free), (is_outside, !is_outside));
        let mut tets: Vec<TetId> = complex.tets().filter(|&t| complex.vertices(t).contains(&v)).collect();
        assert!(complex.tets().all(|t| star.has(t) == tets.contains(&t)));
        star.tets.sort_unstable();
        tets.sort_unstable();
        assert_eq!(star.tets, tets);
    }
}

/// A tet between two walls that meet at an angle, with its edge along x; the two other facets are well
/// shaped.
fn wedge(degrees: f64) -> [Point; 4] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0], [-0.08, 0.8, 0.0], [0.08, 0.8 * cos, 0.8 * sin]]
}

#[test]
fn tets_that_walls_force_count_as_good_until_all_are_judged_again() {
    let corners = wedge(8.0);
    let quality = eas(corners);
    assert!((quality - 8f64.to_radians() / dihedral::REGULAR).abs() < 1e-12, "{quality}");
    let tets = vec![[0, 1, 2, 3].map(VertexId)];
    let mut complex = Complex::new(&TetMesh::new(corners.to_vec(), tets)).unwrap();
    let only = TetId(0);
    let sides =
        |walls: &'static [usize]| move |i: usize| if walls.contains(&i) { Side::Wall } else { Side::Inside };
    assert_eq!((complex.quality(only), complex.n_exempt()), (quality, 0));
    assert_eq!(complex.judge(corners, sides(&[2, 3])), quality, "nothing is spared yet");

    complex.exempt(&[only], 0.2);
    assert_eq!(
        (complex.quality(only), complex.n_exempt(), complex.below(0.2, &Threads::single())),
        (f64::INFINITY, 1, Vec::new())
    );
    complex.verify().unwrap();
    // The facets at the edge of the wedge are those opposite its two other corners.
    assert_eq!(complex.judge(corners, sides(&[2, 3])), f64::INFINITY);
    for walls in [&[][..], &[2], &[3], &[0, 1], &[0, 2], &[1, 3]] {
        assert_eq!(complex.judge(corners, |i| sides_of(walls, i)), quality, "{walls:?}");
    }
    // Tets flatter than the exempt ones are not exempt.
    let flatter = wedge(7.0);
    assert_eq!(complex.judge(flatter, sides(&[2, 3])), eas(flatter));
    let better = wedge(10.0);
    assert_eq!(complex.judge(better, sides(&[2, 3])), f64::INFINITY);
    let good = wedge(20.0);
    assert_eq!(complex.judge(good, sides(&[2, 3])), eas(good), "not below the limit");

    complex.end_exemptions();
    assert_eq!((complex.quality(only), complex.n_exempt()), (quality, 0));
    assert_eq!(complex.judge(corners, sides(&[2, 3])), quality);
    complex.verify().unwrap();
}

fn sides_of(walls: &[usize], i: usize) -> Side {
    if walls.contains(&i) { Side::Wall } else { Side::Inside }
}

#[test]
fn an_exemption_ends_with_its_tet_and_undo_restores_it() {
    let ring = [0.0, 120.0, 240.0].map(|turn: f64| [turn.to_radians().cos(), turn.to_radians().sin(), 0.0]);
    let points = [&[[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]][..], &ring].concat();
    let around_the_edge = [[0, 1, 2, 3], [0, 1, 3, 4], [0, 1, 4, 2]].map(|tet| tet.map(VertexId));
    let without_it = [[2, 3, 4, 1], [2, 4, 3, 0]].map(|tet| tet.map(VertexId));
    let mut complex = Complex::new(&TetMesh::new(points, around_the_edge.to_vec())).unwrap();
    let (mut change, mut inserted) = (Change::default(), Vec::new());
    let all: Vec<TetId> = complex.tets().collect();
    complex.exempt(&all, 0.2);
    assert_eq!((complex.n_exempt(), complex.quality(all[2])), (3, f64::INFINITY));

    let start = complex.mark();
    for fill in [&without_it[..], &around_the_edge] {
        change.clear();
        change.cavity.extend(complex.tets());
        fill.iter().for_each(|&tet| change.push(&complex, tet, 0));
        let checked = complex.check_against(&change, 0.0).unwrap();
        complex.commit(checked, &mut inserted);
        assert_eq!(complex.n_exempt(), 0, "neither new tets nor slots used again are exempt");
        assert!(inserted.iter().all(|&t| complex.quality(t) == eas(complex.corners(t))));
        complex.verify().unwrap();
    }
    complex.undo(start);
    assert_eq!((complex.n_exempt(), complex.quality(all[2])), (3, f64::INFINITY));
    complex.verify().unwrap();
}

#[test]
fn a_narrow_wall_forces_its_tet_only_where_it_is_firm() {
    // A needle-shaped facet with an angle of 5 degrees, and an apex high above it.
    let angle = 5f64.to_radians();
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [angle.cos(), angle.sin(), 0.0], [0.75, 0.03, 0.9]];
    let quality = eas(corners);
    let narrow = angle_at([corners[0], corners[1], corners[2]], 0).to_degrees();
    assert!((narrow - 5.0).abs() < 1e-9);
    assert_eq!(is_reached(quality, highest_eas(narrow)), (quality - 5.0 / 60.0).abs() < 1e-6);
    let tets = vec![[0, 1, 2, 3].map(VertexId)];
    let mut complex = Complex::new(&TetMesh::new(corners.to_vec(), tets)).unwrap();
    complex.exempt(&[TetId(0)], 0.2);
    let judged =
        |side: Side, at: usize| complex.judge(corners, |i| if i == at { side } else { Side::Inside });
    assert!(is_reached(quality, highest_eas(narrow)), "{quality}");
    assert_eq!(judged(Side::Firm, 3), f64::INFINITY);
    assert_eq!([judged(Side::Wall, 3), judged(Side::Inside, 3)], [quality; 2]);
    assert_eq!(judged(Side::Firm, 0), quality);
    // All walls of a surface that is kept are firm; of one that adapts, only those of marked tets.
    assert_eq!((0..4).map(|i| complex.side(TetId(0), i)).collect::<Vec<_>>(), [Side::Firm; 4]);
    complex.adapt_surface();
    assert_eq!((0..4).map(|i| complex.side(TetId(0), i)).collect::<Vec<_>>(), [Side::Firm; 4]);
    complex.end_exemptions();
    assert_eq!((0..4).map(|i| complex.side(TetId(0), i)).collect::<Vec<_>>(), [Side::Wall; 4]);
}

#[test]
fn the_best_that_an_angle_allows_is_reached_within_a_millionth() {
    assert_eq!([0.0, 30.0, 60.0, 120.0, 180.0].map(highest_eas), [0.0, 0.5, 1.0, 0.5, 0.0]);
    assert!(is_reached(0.1, 0.1) && is_reached(0.1, 0.1 + 0.9e-6) && !is_reached(0.1, 0.1 + 1.1e-6));
    assert!(!is_reached(0.0, 0.0) && !is_reached(-1e-9, 0.0));
    // Nearly flat tets are never exempt.
    let flat = wedge(1e-5);
    assert!(eas(flat) < FLATTEST);
    let tets = vec![[0, 1, 2, 3].map(VertexId)];
    let mut complex = Complex::new(&TetMesh::new(flat.to_vec(), tets)).unwrap();
    complex.exempt(&[TetId(0)], 0.2);
    assert_eq!(complex.judge(flat, |_| Side::Wall), eas(flat));
}

#[test]
fn a_vertex_is_where_it_will_be() {
    let mesh = random_mesh(20, 3);
    let complex = Complex::new(&mesh).unwrap();
    let mut numbers = Numbers(3);
    let place = [(); 3].map(|()| numbers.unit());
    let mut change = Change::default();
    let points = |change: &Change| {
        let all = (0..mesh.points.len()).map(|v| change.point(&complex, VertexId::new(v)));
        all.enumerate().filter(|(v, p)| *p != mesh.points[*v]).collect::<Vec<_>>()
    };
    assert!(points(&change).is_empty());
    change.vertex = VertexChange::Move(VertexId(9), place);
    assert_eq!(points(&change), [(9, place)]);
    change.vertex = VertexChange::Insert(place, Hold::Free);
    assert!(points(&change).is_empty());
    assert_eq!(change.point(&complex, complex.next_vertex()), place);
}
