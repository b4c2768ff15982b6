//! The operations propose what they promise: the best of all options where these can be enumerated, the right
//! tets, and nothing at or below the bar.

mod common;

use common::Numbers;
use motet::base::{Point, TetId, VertexId};
use motet::geometry::quality::eas;
use motet::geometry::tet::volume;
use motet::geometry::vector::{distance, norm};
use motet::kernel::{Change, Complex, Fill, HalfFacet, Hold, NewLine, NewWall, Shell, Star, VertexChange};
use motet::mesh::TetMesh;
use motet::ops::{
    Anywhere, EdgeRemoval, FaceRemoval, Insertion, Objective, Reach, Relaxation, Smoothing, Track, collapse,
    defect, split_crossed, split_edge, split_onto,
};

/// The ends of the edge that rings surround.
const A: VertexId = VertexId(0);
const B: VertexId = VertexId(1);

/// The ends of an edge along z, and points in a ring around it, over a part of a turn.
fn ring(n: usize, turn: f64, numbers: &mut Numbers) -> Vec<Point> {
    let mut points = vec![[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]];
    for i in 0..n {
        let angle = turn * (i as f64 + 0.6 * numbers.unit()) / n as f64;
        let (radius, height) = (0.7 + 0.6 * numbers.unit(), 0.6 * numbers.unit() - 0.3);
        points.push([radius * angle.cos(), radius * angle.sin(), height]);
    }
    points
}

/// A mesh of tets, reordered to be positive.
fn mesh(points: Vec<Point>, tets: impl IntoIterator<Item = [usize; 4]>) -> TetMesh {
    let turned = |mut tet: [usize; 4]| {
        if volume(tet.map(|v| points[v])) < 0.0 {
            tet.swap(2, 3);
        }
        tet.map(VertexId::new)
    };
    let tets = tets.into_iter().map(turned).collect();
    TetMesh::new(points, tets)
}

/// The tets between an edge and each two neighbours in its ring; closed, or from the first to the last.
fn round_edge(points: Vec<Point>, is_closed: bool) -> TetMesh {
    let n = points.len() - 2;
    let last = if is_closed { n } else { n - 1 };
    mesh(points, (0..last).map(|i| [0, 1, 2 + i, 2 + (i + 1) % n]))
}

/// All triangulations of the polygon of places `i` to `j`.
fn triangulations(i: usize, j: usize) -> Vec<Vec<[usize; 3]>> {
    if j < i + 2 {
        return vec![Vec::new()];
    }
    let mut all = Vec::new();
    for k in i + 1..j {
        for left in triangulations(i, k) {
            all.extend(
                triangulations(k, j).into_iter().map(|right| [&left[..], &right, &[[i, k, j]]].concat()),
            );
        }
    }
    all
}

/// The worst quality of the tets from triangles of a ring to both ends of the edge. The ring runs
/// counter-clockwise around it.
fn worst_on(points: &[Point], triangles: &[[usize; 3]]) -> f64 {
    let of = |t: &[usize; 3]| {
        let [p, q, r] = t.map(|place| points[place + 2]);
        eas([p, q, r, points[1]]).min(eas([p, r, q, points[0]]))
    };
    triangles.iter().map(of).fold(f64::INFINITY, f64::min)
}

/// The sum of the defects of these tets.
fn defects_on(points: &[Point], triangles: &[[usize; 3]]) -> f64 {
    let of = |t: &[usize; 3]| {
        let [p, q, r] = t.map(|place| points[place + 2]);
        defect(eas([p, q, r, points[1]])) + defect(eas([p, r, q, points[0]]))
    };
    triangles.iter().map(of).sum()
}

fn corners(complex: &Complex, change: &Change, tet: [VertexId; 4]) -> [Point; 4] {
    tet.map(|v| change.point(complex, v))
}

/// A proposal with leftovers of an earlier one.
fn dirty() -> Change {
    let fill = Fill { vertices: [7; 4].map(VertexId), region: 3, quality: 0.5 };
    let wall = NewWall { vertices: [7; 3].map(VertexId), patch: 1, triangle: 0 };
    let line = NewLine { vertices: [7; 2].map(VertexId), source: 0 };
    let vertex = VertexChange::Remove(VertexId(1));
    Change { cavity: vec![TetId(0)], fill: vec![fill], vertex, walls: vec![wall], lines: vec![line] }
}

/// Asserts that every tet of the fill has the quality that it will have in place, that the fill covers the
/// cavity, and that the kernel accepts it.
fn assert_sound(complex: &Complex, change: &Change) {
    for tet in &change.fill {
        assert_eq!(tet.quality, eas(corners(complex, change, tet.vertices)));
    }
    assert!(change.lines.is_empty() && (change.walls.is_empty() || !complex.keeps_surface()));
    let before: f64 = change.cavity.iter().map(|&t| volume(complex.corners(t))).sum();
    let after: f64 = change.fill.iter().map(|t| volume(corners(complex, change, t.vertices))).sum();
    assert!((after - before).abs() < 1e-12 * before, "{after} in place of {before}");
    let checked = complex.check_against(change, 0.0);
    assert!(checked.is_ok(), "{:?}", checked.err());
}

#[test]
fn edge_removal_finds_the_best_of_all_triangulations() {
    // Buffers are reused: their previous contents must not matter.
    let (mut removal, mut change) = (EdgeRemoval::default(), dirty());
    let mut numbers = Numbers(1);
    let mut n_removed = 0;
    for n in (3..=7).cycle().take(200) {
        let points = ring(n, std::f64::consts::TAU, &mut numbers);
        let complex = Complex::new(&round_edge(points.clone(), true)).unwrap();
        let best =
            triangulations(0, n - 1).iter().map(|t| worst_on(&points, t)).fold(f64::NEG_INFINITY, f64::max);
        for start in (0..n).map(TetId::new) {
            let is_proposed = removal.propose(&complex, start, [A, B], 0.0, &mut change);
            assert_eq!(is_proposed, best > 0.0, "{best}");
            if is_proposed {
                n_removed += 1;
                assert_eq!((change.cavity.len(), change.fill.len()), (n, 2 * (n - 2)));
                assert!((change.worst() - best).abs() < 1e-14, "{} and not {best}", change.worst());
                assert_sound(&complex, &change);
            }
        }
        // Nothing at or below the bar replaces the worst removed tet.
        let first = TetId(0);
        assert!(!removal.propose(&complex, first, [A, B], best.max(0.0) + 1e-12, &mut change));
        assert_eq!(removal.propose(&complex, first, [A, B], best - 1e-12, &mut change), best - 1e-12 > -1.0);
    }
    assert!(n_removed > 200, "{n_removed}");
}

/// An objective: a low sum of the defects of the fill, and no tet as bad as `bar`.
struct Sum {
    limit: f64,
    bar: f64,
}

impl Objective for Sum {
    const NOTHING: f64 = 0.0;

    fn limit(&mut self, _: &Complex, cavity: &[TetId], n_fill: usize) -> f64 {
        assert_eq!(n_fill, 2 * (cavity.len() - 2));
        self.limit
    }

    fn cost(&self, _: [VertexId; 4], quality: f64) -> f64 {
        if quality <= self.bar { f64::INFINITY } else { defect(quality) }
    }

    fn both(&self, a: f64, b: f64) -> f64 {
        a + b
    }
}

#[test]
fn edge_removal_finds_the_triangulation_of_the_least_sum() {
    let (mut removal, mut change, mut shell) = (EdgeRemoval::default(), dirty(), Shell::default());
    let mut numbers = Numbers(7);
    let mut n_removed = 0;
    for n in (3..=7).cycle().take(200) {
        let points = ring(n, std::f64::consts::TAU, &mut numbers);
        let complex = Complex::new(&round_edge(points.clone(), true)).unwrap();
        let sum = |triangles: &Vec<[usize; 3]>| -> f64 {
            if worst_on(&points, triangles) <= 0.1 { f64::INFINITY } else { defects_on(&points, triangles) }
        };
        let least = triangulations(0, n - 1).iter().map(sum).fold(f64::INFINITY, f64::min);
        for start in (0..n).map(TetId::new) {
            let mut objective = Sum { limit: 1e9, bar: 0.1 };
            shell.walk(&complex, start, A, B);
            let is_proposed = removal.propose_for(&complex, &shell, [A, B], &mut objective, &mut change);
            assert_eq!(is_proposed, least.is_finite(), "{least}");
            if is_proposed {
                n_removed += 1;
                let found: f64 = change.fill.iter().map(|tet| defect(tet.quality)).sum();
                assert!((found - least).abs() < 1e-12, "{found} and not {least}");
                assert_sound(&complex, &change);
            }
        }
        // No fill that costs as much as the limit is accepted.
        for (limit, is_below) in [(least - 1e-12, false), (least + 1e-12, least.is_finite())] {
            let mut objective = Sum { limit, bar: 0.1 };
            assert_eq!(removal.propose_for(&complex, &shell, [A, B], &mut objective, &mut change), is_below);
        }
    }
    assert!(n_removed > 100, "{n_removed}");
}

#[test]
fn rings_of_more_than_ten_are_left_alone() {
    for (n, is_tried) in [(10, true), (11, false)] {
        // Flat, so that all triangulations are positive.
        let on_circle = |i: usize| {
            let angle = std::f64::consts::TAU * i as f64 / n as f64;
            [angle.cos(), angle.sin(), 0.0]
        };
        let points = [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]].into_iter().chain((0..n).map(on_circle)).collect();
        let complex = Complex::new(&round_edge(points, true)).unwrap();
        let mut change = Change::default();
        assert_eq!(EdgeRemoval::default().propose(&complex, TetId(0), [A, B], 0.0, &mut change), is_tried);
    }
}

#[test]
fn an_edge_of_the_boundary_is_swapped_between_its_walls() {
    let mut numbers = Numbers(2);
    let mut n_swapped = 0;
    for n in (3..=6).cycle().take(200) {
        // The first and the last of the ring lie in one plane with the edge.
        let mut points = ring(n, std::f64::consts::PI, &mut numbers);
        let (radius, height) = (0.7 + 0.6 * numbers.unit(), 0.6 * numbers.unit() - 0.3);
        points[2] = [radius, 0.0, height];
        points[n + 1] = [-radius, 0.0, -height];
        let mut complex = Complex::new(&round_edge(points.clone(), false)).unwrap();
        let (mut removal, mut change) = (EdgeRemoval::default(), Change::default());
        assert!(!removal.propose(&complex, TetId(0), [A, B], 0.0, &mut change), "the surface is kept");
        complex.adapt_surface();
        let best =
            triangulations(0, n - 1).iter().map(|t| worst_on(&points, t)).fold(f64::NEG_INFINITY, f64::max);
        let is_proposed = removal.propose(&complex, TetId(0), [A, B], 0.0, &mut change);
        assert_eq!(is_proposed, best > 0.0, "{best}");
        if !is_proposed {
            continue;
        }
        n_swapped += 1;
        assert!((change.worst() - best).abs() < 1e-14, "{} and not {best}", change.worst());
        assert_sound(&complex, &change);
        let ends = [VertexId(2), VertexId::new(n + 1)];
        let walls: Vec<_> = change.walls.iter().map(|wall| wall.vertices).collect();
        assert_eq!(walls, [[A, ends[0], ends[1]], [B, ends[0], ends[1]]]);
    }
    assert!(n_swapped > 50, "{n_swapped}");
}

#[test]
fn walls_within_a_ring_are_swapped_if_they_are_of_one_patch() {
    let mut numbers = Numbers(3);
    let mut n_swapped = 0;
    for k in 0..100 {
        // Four quarters of a turn with more of the ring between; the walls are at the first and the third.
        let n = 6;
        let mut points = ring(n, std::f64::consts::TAU, &mut numbers);
        let half = 2 + n / 2;
        points[half] = points[2].map(|x| -x);
        let mut mesh = round_edge(points.clone(), true);
        mesh.triangles = vec![[A, B, VertexId(2)], [B, A, VertexId::new(half)]];
        mesh.patches = vec![4, if k % 2 == 0 { 4 } else { 5 }];
        let mut complex = Complex::new(&mesh).unwrap();
        complex.adapt_surface();
        let sides = [triangulations(0, n / 2), {
            let other = triangulations(n / 2, n);
            other.into_iter().map(|all| all.into_iter().map(|t| t.map(|i| i % n)).collect()).collect()
        }];
        let best = |all: &[Vec<[usize; 3]>]| {
            all.iter().map(|t| worst_on(&points, t)).fold(f64::NEG_INFINITY, f64::max)
        };
        let best = best(&sides[0]).min(best(&sides[1]));
        let mut change = Change::default();
        for start in (0..n).map(TetId::new) {
            let is_proposed = EdgeRemoval::default().propose(&complex, start, [A, B], 0.0, &mut change);
            assert_eq!(is_proposed, best > 0.0 && k % 2 == 0, "{best}");
            if is_proposed {
                n_swapped += 1;
                assert!((change.worst() - best).abs() < 1e-14, "{} and not {best}", change.worst());
                assert!(change.walls.iter().all(|wall| wall.patch == 4));
                assert_sound(&complex, &change);
            }
        }
    }
    assert!(n_swapped > 100, "{n_swapped}");
}

#[test]
fn face_removal_finds_the_best_of_all_connected_facets() {
    let (mut removal, mut change) = (FaceRemoval::default(), dirty());
    let mut numbers = Numbers(4);
    let mut sizes = [0; 5];
    for n in (3..=6).cycle().take(300) {
        let points = ring(n, std::f64::consts::TAU, &mut numbers);
        let all = triangulations(0, n - 1);
        let triangles = &all[numbers.below(all.len())];
        if worst_on(&points, triangles) <= 0.0 {
            continue;
        }
        let at = |t: [usize; 3], end: usize| [end, t[0] + 2, t[1] + 2, t[2] + 2];
        let tets = triangles.iter().flat_map(|&t| [at(t, 0), at(t, 1)]);
        let complex = Complex::new(&mesh(points.clone(), tets)).unwrap();
        let first = 2 * numbers.below(triangles.len());
        // Each connected set of facets, by bits: its outer edges get a tet each.
        let mut best = 0.0;
        for set in (0u32..1 << triangles.len()).filter(|set| set >> (first / 2) & 1 == 1) {
            let taken: Vec<[usize; 3]> =
                (0..triangles.len()).filter(|i| set >> i & 1 == 1).map(|i| triangles[i]).collect();
            let edges: Vec<[usize; 2]> =
                taken.iter().flat_map(|&[p, q, r]| [[p, q], [q, r], [r, p]]).collect();
            let outer: Vec<_> = edges.iter().filter(|[p, q]| !edges.contains(&[*q, *p])).collect();
            // A polygon of this many triangles has two edges more; with fewer, facets are connected only by
            // vertices.
            if outer.len() != taken.len() + 2 {
                continue;
            }
            let of = |&&[p, q]: &&[usize; 2]| eas([points[0], points[1], points[p + 2], points[q + 2]]);
            let worst = outer.iter().map(of).fold(f64::INFINITY, f64::min);
            best = worst.max(best);
        }
        let opposite = complex.place(TetId::new(first), A);
        let is_proposed = removal.propose(&complex, TetId::new(first), opposite, 0.0, &mut change);
        assert_eq!(is_proposed, best > 0.0, "{best}");
        if is_proposed {
            let n = change.cavity.len() / 2;
            sizes[n] += 1;
            assert!((change.worst() - best).abs() < 1e-14, "{} and not {best}", change.worst());
            assert_eq!((change.cavity.len(), change.fill.len()), (2 * n, n + 2));
            assert_sound(&complex, &change);
            let above = best + 1e-12;
            assert!(!removal.propose(&complex, TetId::new(first), opposite, above, &mut change));
        }
    }
    assert!(sizes[1..].iter().all(|&n| n > 5), "{sizes:?}");
}

/// A ball of tets around a vertex, which is the last one: triangles of an octahedron, divided once, joined to
/// it.
fn ball_round(centre: Point) -> TetMesh {
    let axes: Vec<Point> = (0..6)
        .map(|i| [0, 1, 2].map(|k| if k == i / 2 { 1.0 - 2.0 * (i % 2) as f64 } else { 0.0 }))
        .collect();
    let mut points = axes;
    let mut tets = Vec::new();
    for (x, y, z) in (0..8).map(|i| (i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2))) {
        let mut middle = |a: usize, b: usize| {
            let sum = [0, 1, 2].map(|k| points[a][k] + points[b][k]);
            let place = sum.map(|s| s / norm(sum));
            let known = points.iter().position(|&p| distance(p, place) < 1e-12);
            known.unwrap_or_else(|| {
                points.push(place);
                points.len() - 1
            })
        };
        let [xy, yz, zx] = [middle(x, y), middle(y, z), middle(z, x)];
        tets.extend([[x, xy, zx], [y, yz, xy], [z, zx, yz], [xy, yz, zx]]);
    }
    points.push(centre);
    let apex = points.len() - 1;
    mesh(points, tets.into_iter().map(|[a, b, c]| [a, b, c, apex]))
}

/// Restricts moves to a plane of constant z.
struct InPlane(f64);

impl Track for InPlane {
    fn draw(&self, [x, y, _]: Point) -> Option<Point> {
        Some([x, y, self.0])
    }

    fn along(&self, [x, y, _]: Point) -> Point {
        [x, y, 0.0]
    }
}

#[test]
fn smoothing_goes_to_where_the_worst_is_best_and_no_farther_than_is_enough() {
    let vertex = VertexId(18);
    let worst = |centre: Point| {
        let complex = Complex::new(&ball_round(centre)).unwrap();
        complex.tets().map(|t| complex.quality(t)).fold(f64::INFINITY, f64::min)
    };
    let (best, mut numbers, mut n_on_the_way) = (worst([0.0; 3]), Numbers(5), 0);
    for _ in 0..50 {
        let start = [(); 3].map(|()| 0.8 * numbers.unit() - 0.4);
        let complex = Complex::new(&ball_round(start)).unwrap();
        let (mut star, mut smoothing, mut change) = (Star::default(), Smoothing::default(), dirty());
        star.gather(&complex, vertex);
        let before = complex.worst_of(&star.tets);
        assert!(smoothing.propose(&complex, &star.tets, vertex, [before, 1.0], &Anywhere, &mut change));
        assert_sound(&complex, &change);
        let VertexChange::Move(_, place) = change.vertex else { panic!("{:?}", change.vertex) };
        assert!(change.worst() > before && change.worst() > 0.9 * best, "{} of {best}", change.worst());
        assert!((change.worst() - worst(place)).abs() < 1e-14);
        // An optimal position is not proposed again.
        let at_best = change.worst();
        assert!(!smoothing.propose(
            &complex,
            &star.tets,
            vertex,
            [at_best + 0.05, 1.0],
            &Anywhere,
            &mut change
        ));

        // Where a smaller improvement is enough, it stops on the way.
        let enough = before + 0.1 * (at_best - before);
        assert!(smoothing.propose(&complex, &star.tets, vertex, [before, enough], &Anywhere, &mut change));
        let VertexChange::Move(_, near) = change.vertex else { panic!("{:?}", change.vertex) };
        assert!(change.worst() >= enough && near != start);
        n_on_the_way += usize::from(change.worst() < at_best - 0.05);
        assert!(!smoothing.propose(&complex, &star.tets, vertex, [before, before], &Anywhere, &mut change));

        let track = InPlane(start[2]);
        if smoothing.propose(&complex, &star.tets, vertex, [before, 1.0], &track, &mut change) {
            let VertexChange::Move(_, place) = change.vertex else { panic!("{:?}", change.vertex) };
            assert_eq!(place[2], start[2]);
            let of_centre = worst([0.0, 0.0, start[2]]);
            assert!(change.worst() > 0.9 * of_centre, "{} of {of_centre}", change.worst());
        }
    }
    assert!(n_on_the_way > 25, "{n_on_the_way}");
}

#[test]
fn relaxation_lowers_the_sum_of_the_defects_where_the_vertex_is_and_in_another_pose() {
    let vertex = VertexId(18);
    let mut numbers = Numbers(11);
    let (mut star, mut relaxation, mut change) = (Star::default(), Relaxation::default(), dirty());
    for _ in 0..50 {
        let start = [(); 3].map(|()| 0.8 * numbers.unit() - 0.4);
        let complex = Complex::new(&ball_round(start)).unwrap();
        star.gather(&complex, vertex);
        // In the other pose everything is stretched and sheared.
        let stretched = |[x, y, z]: Point| [0.6 * x + 0.3 * y, y, 1.5 * z];
        let sum = |place: Point, moved: &dyn Fn(Point) -> Point| -> f64 {
            let at = |v: VertexId| if v == vertex { place } else { complex.point(v) };
            let corners = |t: &TetId| complex.vertices(*t).map(|v| moved(at(v)));
            star.tets.iter().map(|t| defect(eas(corners(t)).max(0.0))).sum()
        };
        let here = |p: Point| p;
        let none = None::<fn(VertexId) -> Point>;
        assert!(relaxation.propose(
            (&complex, none),
            &star.tets,
            vertex,
            Reach::default(),
            &Anywhere,
            &mut change
        ));
        assert_sound(&complex, &change);
        assert!(relaxation.place_in_pose().is_none());
        let VertexChange::Move(_, alone) = change.vertex else { panic!("{:?}", change.vertex) };
        assert!(sum(alone, &here) < sum(start, &here));

        let both = |place: Point| sum(place, &here) + sum(place, &stretched);
        let pose = Some(|v: VertexId| stretched(complex.point(v)));
        assert!(relaxation.propose(
            (&complex, pose),
            &star.tets,
            vertex,
            Reach::default(),
            &Anywhere,
            &mut change
        ));
        let VertexChange::Move(_, place) = change.vertex else { panic!("{:?}", change.vertex) };
        // The linear map between the poses is found exactly.
        assert!(relaxation.place_in_pose().is_some_and(|in_pose| distance(in_pose, stretched(place)) < 1e-9));
        assert!(both(place) < both(start) && both(place) < both(alone) + 0.02 * both(start));
    }
}

#[test]
fn a_collapse_draws_every_other_tet_to_the_vertex_that_stays() {
    let (removed, kept) = (VertexId(18), VertexId(7));
    let complex = Complex::new(&ball_round([0.0; 3])).unwrap();
    let (mut star, mut change) = (Star::default(), dirty());
    star.gather(&complex, removed);
    assert!(collapse(&complex, &star.tets, removed, kept, 0.0, &mut change));
    assert_sound(&complex, &change);
    assert_eq!(change.vertex, VertexChange::Remove(removed));
    let others: Vec<_> =
        star.tets.iter().copied().filter(|&t| !complex.vertices(t).contains(&kept)).collect();
    assert_eq!(change.fill.len(), others.len());
    for (tet, fill) in others.iter().zip(&change.fill) {
        assert_eq!(fill.vertices, complex.vertices(*tet).map(|v| if v == removed { kept } else { v }));
    }
    let worst = change.worst();
    assert!(!collapse(&complex, &star.tets, removed, kept, worst, &mut change));
    assert!(collapse(&complex, &star.tets, removed, kept, worst.next_down(), &mut change));
}

#[test]
fn splits_of_an_edge_make_two_tets_of_each() {
    let (mut numbers, mut n_onto) = (Numbers(6), 0);
    for n in (3..8).cycle().take(50) {
        let points = ring(n, std::f64::consts::TAU, &mut numbers);
        let complex = Complex::new(&round_edge(points, true)).unwrap();
        let (mut shell, mut change) = (Shell::default(), dirty());
        shell.walk(&complex, TetId(0), A, B);
        let middle = ([0.0, 0.0, 0.1], Hold::Free);
        assert!(split_edge(&complex, &shell, [A, B], middle, 0.0, &mut change));
        assert_sound(&complex, &change);
        assert_eq!(change.fill.len(), 2 * n);
        assert!(change.fill.iter().all(|tet| tet.vertices.contains(&complex.next_vertex())));
        assert!(change.fill.iter().all(|tet| tet.vertices.contains(&A) != tet.vertices.contains(&B)));
        let worst = change.worst();
        assert!(!split_edge(&complex, &shell, [A, B], middle, worst, &mut change));
        assert!(split_edge(&complex, &shell, [A, B], middle, worst.next_down(), &mut change));

        // A vertex of the ring in place of the midpoint: the triangulation that fans out from it.
        let onto = VertexId(2);
        if split_onto(&complex, &shell, onto, 0.0, &mut change) {
            n_onto += 1;
            assert_sound(&complex, &change);
            assert_eq!(change.fill.len(), 2 * (n - 2));
            assert!(change.fill.iter().all(|tet| tet.vertices.contains(&onto)));
        }
    }
    assert!(n_onto > 10, "{n_onto}");
}

/// Two edges that cross at right angles, 01 over 23, with the tet between them; around the first, and with
/// `both` around the second, the tets that close the ring.
fn crossing(both: bool) -> TetMesh {
    let points = [
        [-1.0, 0.0, -0.1],
        [1.0, 0.0, -0.1],
        [0.0, -1.0, 0.1],
        [0.0, 1.0, 0.1],
        [0.0, 0.0, -1.0],
        [0.0, 0.0, 1.0],
    ];
    let tets = [[0, 1, 2, 3], [0, 1, 3, 4], [0, 1, 4, 2], [2, 3, 0, 5], [2, 3, 5, 1]];
    mesh(points[..if both { 6 } else { 5 }].to_vec(), tets.into_iter().take(if both { 5 } else { 3 }))
}

#[test]
fn crossed_edges_are_split_where_they_pass_each_other() {
    let split = |mesh: &TetMesh, adapts: bool, change: &mut Change| {
        let mut complex = Complex::new(mesh).unwrap();
        if adapts {
            complex.adapt_surface();
        }
        let (mut first, mut second) = (Shell::default(), Shell::default());
        first.walk(&complex, TetId(0), VertexId(0), VertexId(1));
        second.walk(&complex, TetId(0), VertexId(2), VertexId(3));
        let is_split = split_crossed(&complex, [&first, &second], [0.0; 3], 0.0, change);
        assert_eq!(
            is_split,
            split_crossed(&complex, [&second, &first], [0.0; 3], 0.0, &mut Change::default())
        );
        (complex, is_split)
    };
    let mut change = dirty();
    let (complex, is_split) = split(&crossing(true), false, &mut change);
    assert!(is_split);
    assert_sound(&complex, &change);
    assert_eq!((change.cavity.len(), change.fill.len()), (5, 8));
    // An edge at a wall or on the boundary may not be split.
    let mut walled = crossing(true);
    walled.triangles = vec![[2, 3, 5].map(VertexId)];
    walled.patches = vec![1];
    for mesh in [walled, crossing(false)] {
        for adapts in [false, true] {
            assert!(!split(&mesh, adapts, &mut change).1);
        }
    }
}

#[test]
fn an_insertion_joins_a_vertex_to_all_that_it_sees_well() {
    let mut numbers = Numbers(7);
    let mut sizes = Vec::new();
    for seed in 0..60 {
        let mesh = common::random_mesh(30, seed);
        let complex = Complex::new(&mesh).unwrap();
        let tet = TetId::new(numbers.below(complex.n_tets()));
        let middle = motet::geometry::tet::centroid(complex.corners(tet));
        let (mut insertion, mut change) = (Insertion::default(), dirty());
        for bar in [0.0, 0.05, 0.1, 0.2] {
            if !insertion.propose(&complex, &[tet], middle, [bar, 0.6], &mut change) {
                continue;
            }
            assert_sound(&complex, &change);
            assert!(change.worst() > bar && change.cavity.contains(&tet) && change.cavity.len() <= 40);
            assert!(change.fill.iter().all(|t| t.vertices[3] == complex.next_vertex()));
            let is_wall = |half: HalfFacet| complex.is_wall(half.tet(), half.facet());
            for (t, i) in change.cavity.iter().flat_map(|&t| (0..4).map(move |i| (t, i))) {
                let behind = complex.across(t, i);
                let is_within = !behind.is_none() && change.cavity.contains(&behind.tet());
                assert!(!(is_within && is_wall(HalfFacet::new(t, i))), "a wall would go");
            }
            sizes.push(change.cavity.len());
        }
    }
    assert!(sizes.len() > 60 && sizes.contains(&1) && sizes.iter().any(|&n| n > 5), "{sizes:?}");
}
