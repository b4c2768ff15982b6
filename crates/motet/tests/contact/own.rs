//! Contact of a surface with itself: which places face each other, compared with brute force by an
//! independent implementation of the rule.

use crate::surfaces::{Shape, bodies, sheet, torus};
use motet::base::{BodyId, Threads};
use motet::contact::{BodyGaps, Contact, Gaps, Options};
use motet::geometry::triangle;
use motet::geometry::vector::{add, cross, distance, dot, norm, scale, sub};

fn joined(shapes: &[Shape]) -> Shape {
    let mut all = Shape::default();
    for shape in shapes {
        let first = all.points.len() as u32;
        all.points.extend(&shape.points);
        all.triangles.extend(shape.triangles.iter().map(|t| t.map(|v| v + first)));
    }
    all
}

fn own(shape: &Shape, within: f64) -> Gaps {
    let (points, one) = bodies(std::slice::from_ref(shape));
    let options = Options { own: true, within, ..Options::default() };
    let mut contact = Contact::new(points, one, options, &Threads::single()).expect("the shape is sound");
    let gaps = contact.measure(&Threads::single());
    assert_eq!(contact.measure(&Threads::single()), gaps, "a guess changed an answer");
    let two = Threads::new(2).expect("two threads start");
    assert_eq!(contact.measure(&two), gaps, "threads changed an answer");
    gaps
}

#[test]
fn two_sheets_of_one_plane_see_each_other_rim_to_rim() {
    let flat = sheet(8, |_, _| 0.0);
    let gaps = own(&joined(&[flat.clone(), flat.clone().shifted([1.05, 0.0, 0.0])]), 0.5);
    assert!((gaps.least() - 0.05).abs() < 1e-12, "{}", gaps.least());
    let points = joined(&[flat.clone(), flat.shifted([1.05, 0.0, 0.0])]).points;
    for (p, gap) in points.iter().zip(&gaps.bodies[0].gap) {
        if p[0] == 1.0 || p[0] == 1.05 {
            assert!((gap - 0.05).abs() < 1e-12, "{gap} at {p:?}");
        }
    }
}

/// A closed wedge of eight degrees whose knife edge is the line x = 0, z = 0, from y = 0 to 1; it lies where
/// x is negative.
fn wedge() -> Shape {
    let points = vec![
        [0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [-1.0, 0.0, 0.07],
        [-1.0, 1.0, 0.07],
        [-1.0, 0.0, -0.07],
        [-1.0, 1.0, -0.07],
    ];
    let triangles =
        vec![[0, 1, 3], [0, 3, 2], [0, 4, 5], [0, 5, 1], [2, 3, 5], [2, 5, 4], [0, 2, 4], [1, 5, 3]];
    Shape { points, triangles }
}

#[test]
fn knife_edges_that_point_at_each_other_are_seen() {
    let other = wedge().map(|p| [0.05 - p[0], p[1], -p[2]]);
    let both = joined(&[wedge(), other]);
    let gaps = own(&both, 0.5);
    let body = &gaps.bodies[0];
    assert!((gaps.least() - 0.05).abs() < 1e-12, "{}", gaps.least());
    for v in [0, 1, 6, 7] {
        assert!((body.gap[v] - 0.05).abs() < 1e-12, "{} at {v}", body.gap[v]);
    }
}

#[test]
fn nothing_is_seen_through_the_thickness_of_a_plate() {
    // A grid on both sides, 0.01 apart; the gap between them is closed by the rim.
    let n = 10;
    let top = sheet(n, |_, _| 0.01);
    let bottom = sheet(n, |_, _| 0.0).turned_inside_out();
    let mut plate = joined(&[top, bottom]);
    let (side, half) = (n + 1, (n + 1) * (n + 1));
    let mut rim: Vec<u32> = (0..n).map(|i| i * side).collect();
    rim.extend((0..n).map(|j| n * side + j));
    rim.extend((0..n).map(|i| (n - i) * side + n));
    rim.extend((0..n).map(|j| n - j));
    for k in 0..rim.len() {
        let (u, v) = (rim[k], rim[(k + 1) % rim.len()]);
        plate.triangles.extend([[v, u, u + half], [v, u + half, v + half]]);
    }
    let (points, one) = bodies(std::slice::from_ref(&plate));
    let contact = Contact::new(points, one, Options { own: true, ..Options::default() }, &Threads::single())
        .expect("it is sound");
    assert!(contact.is_closed(BodyId(0)));
    let gaps = own(&plate, 0.5);
    assert!(gaps.bodies[0].closest_body.iter().all(|b| b.is_none()), "{:?}", gaps.bodies[0].gap);
    assert!(gaps.pairs[0].nearest.is_none());
}

/// The literal rule. Lengths of paths along edges come from a table of all of them.
struct Oracle<'a> {
    shape: &'a Shape,
    normals: Vec<[f64; 3]>,
    ways: Vec<Vec<f64>>,
}

impl<'a> Oracle<'a> {
    fn new(shape: &'a Shape) -> Self {
        let normal = |t: usize| {
            let [a, b, c] = shape.corners(t);
            let area = cross(sub(b, a), sub(c, a));
            scale(area, 1.0 / norm(area))
        };
        let (n, p) = (shape.points.len(), &shape.points);
        let mut ways = vec![vec![f64::INFINITY; n]; n];
        for t in &shape.triangles {
            for [u, v] in [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].map(|e| e.map(|v| v as usize)) {
                let length = distance(p[u], p[v]);
                (ways[u][v], ways[v][u]) = (length, length);
            }
        }
        (0..n).for_each(|v| ways[v][v] = 0.0);
        // The algorithm of Floyd and Warshall.
        for k in 0..n {
            let through = ways[k].clone();
            for row in &mut ways {
                let first = row[k];
                row.iter_mut().zip(&through).for_each(|(way, rest)| *way = way.min(first + rest));
            }
        }
        Self { shape, normals: (0..shape.triangles.len()).map(normal).collect(), ways }
    }

    /// Whether a direction leaves a surface through the triangle by more than this cosine, or by the sum of
    /// the triangles that contain all of some vertices.
    fn leaves(&self, holds: &[u32], out: [f64; 3]) -> bool {
        let is_around = |t: &usize| holds.iter().all(|v| self.shape.triangles[*t].contains(v));
        let around = (0..self.normals.len()).filter(is_around);
        let sum = around.fold([0.0; 3], |sum, t| add(sum, self.normals[t]));
        norm(sum) > 0.0 && dot(scale(sum, 1.0 / norm(sum)), out) > 0.25
    }

    /// Whether a direction leaves through any of the triangles that contain all of some vertices, however
    /// obliquely.
    fn grazes(&self, holds: &[u32], out: [f64; 3]) -> bool {
        let around =
            (0..self.normals.len()).filter(|t| holds.iter().all(|v| self.shape.triangles[*t].contains(v)));
        around.map(|t| dot(self.normals[t], out)).any(|cosine| cosine > 0.02)
    }

    /// The gap of a vertex, within reach; and how close any decision was to the opposite one.
    fn gap(&self, v: usize, within: f64, fold: f64) -> f64 {
        let p = self.shape.points[v];
        let mut least = f64::INFINITY;
        for (t, corners) in self.shape.triangles.iter().enumerate() {
            if corners.contains(&(v as u32)) {
                continue;
            }
            let weights = triangle::closest(self.shape.corners(t), p);
            let place = triangle::at(self.shape.corners(t), weights);
            let far = distance(p, place);
            if far > within.min(least) {
                continue;
            }
            let way = scale(sub(place, p), 1.0 / far);
            let star = (0..self.normals.len()).filter(|&s| self.shape.triangles[s].contains(&(v as u32)));
            let starts = star.map(|s| dot(self.normals[s], way)).any(|cosine| cosine > 1e-9)
                || self.leaves(&[v as u32], way);
            let back = scale(way, -1.0);
            let held: Vec<u32> = (0..3).filter(|&k| weights[k] != 0.0).map(|k| corners[k]).collect();
            let ends = dot(self.normals[t], back) > 0.25
                || held.len() < 3 && (self.grazes(&held, back) || self.leaves(&held, back));
            let is_within = |u: &[u32; 3]| u.contains(&(v as u32)) && held.iter().all(|h| u.contains(h));
            if self.shape.triangles.iter().any(is_within) {
                continue;
            }
            let to = |c: &u32| self.ways[v][*c as usize] + distance(self.shape.points[*c as usize], place);
            let along = corners.iter().map(to).fold(f64::INFINITY, f64::min);
            if starts && ends && along > fold * far {
                least = far;
            }
        }
        least
    }
}

#[test]
fn folded_surfaces_have_the_gaps_of_a_look_at_everything() {
    let mut n_found = 0;
    for seed in 0..12 {
        let wave = |x: f64, y: f64| (f64::from(seed) + 5.0 * x + 3.0 * y).sin();
        // A ring bent up and down, so that parts of it approach each other; in every second case two of them.
        let bent = torus(7, 40, [1.0, 0.3]).map(|p| {
            let lift = 0.5 * wave(p[0], p[1]) + 0.2 * wave(3.0 * p[1], p[0]);
            [p[0] * (0.55 + 0.4 * p[1] * p[1]), p[1] + 0.1 * wave(p[2], p[0]), p[2] + lift]
        });
        let shape = match seed % 2 {
            0 => bent,
            _ => joined(&[bent.clone(), bent.shifted([0.1, 0.3, 0.75])]),
        };
        // The oracle takes normals as given: outward.
        let volume = |shape: &Shape| -> f64 {
            let corners = (0..shape.triangles.len()).map(|t| shape.corners(t));
            corners.map(|[a, b, c]| dot(a, cross(b, c))).sum()
        };
        let shape = if volume(&shape) < 0.0 { shape.turned_inside_out() } else { shape };
        let oracle = Oracle::new(&shape);
        let within = 0.9;
        let gaps = own(&shape, within);
        let BodyGaps { vertices, gap, .. } = &gaps.bodies[0];
        for (v, &gap) in vertices.iter().zip(gap) {
            let expected = oracle.gap(v.index(), within, Options::default().fold);
            assert!(
                gap == expected || (gap - expected).abs() < 1e-12,
                "seed {seed}: {gap} for {expected} at {v}"
            );
            n_found += usize::from(gap.is_finite());
        }
    }
    println!("{n_found} gaps");
    assert!(n_found > 500);
}
