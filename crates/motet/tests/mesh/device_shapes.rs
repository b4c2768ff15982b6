//! Stents and wires: closed, facing outward, of the right genus, free of crossings, also when bent along a
//! centre line.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use motet::Mesh;
use motet::base::{Point, VertexId};
use motet::geometry::distance::{point_segment, triangle_triangle};
use motet::geometry::vector::{distance, norm, sub};
use motet::mesh::shapes::{CenterLine, Coil, Stent, chains, wire};
use motet::mesh::{Surface, cone_volume};

type Triangles = [[VertexId; 3]];

/// Panics unless each edge is used once in each direction; returns the Euler characteristic.
fn euler_if_closed(triangles: &Triangles) -> i64 {
    let mut edges = BTreeMap::new();
    let mut vertices: Vec<VertexId> = triangles.as_flattened().to_vec();
    for &[a, b, c] in triangles {
        for edge in [(a, b), (b, c), (c, a)] {
            *edges.entry(edge).or_insert(0) += 1;
        }
    }
    for (&(a, b), &n) in &edges {
        assert_eq!((n, edges.get(&(b, a))), (1, Some(&1)), "edge {a} {b}");
    }
    vertices.sort_unstable();
    vertices.dedup();
    vertices.len() as i64 - edges.len() as i64 / 2 + triangles.len() as i64
}

fn volume(points: &[Point], triangles: &Triangles) -> f64 {
    triangles.iter().map(|t| cone_volume(t.iter().copied(), points, [0.1, 0.2, 0.3])).sum()
}

/// Pairs of triangles without a common vertex that have a point in common.
fn crossings(points: &[Point], triangles: &Triangles) -> usize {
    let corners = |t: &[VertexId; 3]| t.map(|v| points[v.index()]);
    let mut n = 0;
    for (i, t) in triangles.iter().enumerate() {
        for other in &triangles[..i] {
            let apart = !t.iter().any(|v| other.contains(v));
            n += usize::from(apart && triangle_triangle::meet(corners(t), corners(other)));
        }
    }
    n
}

fn small() -> Stent {
    Stent { length: 4.0, rings: 3, crowns: 4, segments: 3, ..Stent::default() }
}

#[test]
fn a_stent_is_a_closed_surface_with_a_handle_for_each_link() {
    for (rings, crowns, segments, link_every) in
        [(1, 3, 2, 1), (2, 1, 2, 1), (3, 4, 3, 1), (4, 6, 5, 2), (5, 6, 4, 3), (3, 7, 2, 20)]
    {
        let stent = Stent { rings, crowns, segments, link_every, ..Stent::default() };
        let triangles = stent.triangles().unwrap();
        // Each ring is a torus, of characteristic 0, and each link subtracts 2.
        assert_eq!(euler_if_closed(&triangles), -2 * stent.n_links() as i64);
        assert!(rings == 1 || link_every == 20 || stent.n_links() >= rings - 1);
        if link_every == 1 {
            assert_eq!(stent.n_links(), (rings - 1) * crowns);
        }
        let points = stent.points(1.5).unwrap();
        assert_eq!(points.len(), triangles.as_flattened().iter().map(|v| v.index() + 1).max().unwrap());
        assert!(volume(&points, &triangles) > 0.0);
        let (low, high) = points.iter().fold((f64::MAX, f64::MIN), |m, p| (m.0.min(p[2]), m.1.max(p[2])));
        assert!(low >= -1e-12 && high <= stent.length + 1e-12, "{low} {high}");
    }
}

#[test]
fn a_stent_has_the_same_triangles_and_no_crossings_at_every_radius() {
    let stent = small();
    let triangles = stent.triangles().unwrap();
    let mut last = 0.0;
    for step in 0..20 {
        let radius = 0.3 + 0.1 * f64::from(step);
        let points = stent.points(radius).unwrap();
        assert_eq!(crossings(&points, &triangles), 0, "radius {radius}");
        for p in &points {
            let r = p[0].hypot(p[1]);
            assert!(r < radius * (1.0 + 1e-12) && r > (radius - stent.thickness) * (1.0 - 1e-12));
        }
        assert!(volume(&points, &triangles) > last * 0.5);
        last = volume(&points, &triangles);
    }
    // Strongly crimped, with wide struts: legs close up but do not cross.
    let tight = Stent { strut_width: 0.5, ..small() };
    assert_eq!(crossings(&tight.points(0.12).unwrap(), &triangles), 0);
    // The same stent in metres.
    let metres = Stent { length: 4e-3, strut_width: 1.5e-4, thickness: 1e-4, link_length: 1.5e-4, ..small() };
    let (a, b) = (metres.points(1e-3).unwrap(), small().points(1.0).unwrap());
    assert!(a.iter().zip(&b).all(|(a, b)| norm(sub(a.map(|x| 1e3 * x), *b)) < 1e-14));
}

#[test]
fn a_stent_bends_along_a_centre_line_without_crossing_or_twist() {
    let stent = small();
    let triangles = stent.triangles().unwrap();
    // A quarter of a circle that then rises out of its plane.
    let line: Vec<Point> = (0..60)
        .map(|i| f64::from(i) / 59.0 * PI / 2.0)
        .map(|a| [3.0 * a.cos(), 3.0 * a.sin(), if a > 1.0 { (a - 1.0).powi(2) } else { 0.0 }])
        .collect();
    let line = CenterLine::new(&line).unwrap();
    assert!(line.length() > stent.length);
    let points = line.bent(&stent.points(1.0).unwrap());
    assert_eq!(crossings(&points, &triangles), 0);
    let (bent, straight) = (volume(&points, &triangles), volume(&stent.points(1.0).unwrap(), &triangles));
    assert!((bent / straight - 1.0).abs() < 0.02, "{bent} {straight}");
    // A circle in its plane: what points across the plane still does at the end. The ends continue straight.
    let circle: Vec<Point> =
        (0..=40).map(|i| TAU * f64::from(i) / 80.0).map(|a| [a.cos(), a.sin(), 0.0]).collect();
    let circle = CenterLine::new(&circle).unwrap();
    let heights = |z: f64| (circle.place([0.1, 0.0, z])[2], circle.place([0.0, 0.1, z])[2]);
    let (first, last) = (heights(0.0), heights(circle.length()));
    assert!((first.0 - last.0).abs() < 1e-12 && (first.1 - last.1).abs() < 1e-12);
    assert!(norm([first.0, first.1, 0.0]) > 0.0999);
    let beyond = circle.place([0.0, 0.0, circle.length() + 1.0]);
    assert!(distance(beyond, circle.place([0.0, 0.0, circle.length()])) > 0.999);
}

#[test]
fn what_makes_no_stent_or_line_is_refused() {
    let refused = |stent: Stent| {
        assert!(stent.triangles().is_err());
        stent.points(1.0).unwrap_err().remedy_text().unwrap().to_owned()
    };
    refused(Stent { rings: 0, ..Stent::default() });
    refused(Stent { segments: 1, ..Stent::default() });
    refused(Stent { strut_width: f64::NAN, ..Stent::default() });
    refused(Stent { rings: usize::MAX, ..Stent::default() });
    assert!(refused(Stent { rings: 40, ..Stent::default() }).contains("fewer rings"));
    assert!(Stent::default().points(0.1).is_err());
    assert!(CenterLine::new(&[[0.0; 3]]).is_err());
    assert!(CenterLine::new(&[[0.0; 3], [1.0; 3], [1.0; 3]]).unwrap_err().to_string().contains("point 2"));
    assert!(CenterLine::new(&[[0.0; 3], [f64::NAN; 3]]).is_err());
}

fn segments(pairs: &[[u32; 2]]) -> Vec<[VertexId; 2]> {
    pairs.iter().map(|s| s.map(VertexId)).collect()
}

fn surface(mesh: &Mesh) -> Surface {
    let surface = Surface::of(mesh);
    assert_eq!(surface.patch_names[&1], "wire");
    surface
}

#[test]
fn segments_become_chains_between_ends_and_loops() {
    // A Y, a loop, and a segment of zero length.
    let found =
        chains(9, &segments(&[[0, 1], [2, 1], [2, 3], [2, 4], [5, 6], [6, 7], [7, 5], [8, 8], [1, 0]]));
    let as_numbers: Vec<(Vec<u32>, bool)> =
        found.iter().map(|c| (c.vertices.iter().map(|v| v.0).collect(), c.closed)).collect();
    let expected = [(vec![0, 1, 2], false), (vec![2, 3], false), (vec![2, 4], false), (vec![5, 6, 7], true)];
    assert_eq!(as_numbers, expected);
}

#[test]
fn a_wire_is_as_thick_as_requested_and_closed() {
    // A helix: length and section give the volume.
    let helix: Vec<Point> =
        (0..200).map(|i| 0.1 * f64::from(i)).map(|a| [2.0 * a.cos(), 2.0 * a.sin(), 0.2 * a]).collect();
    let open = segments(&(0..199).map(|i| [i, i + 1]).collect::<Vec<_>>());
    let (radius, around) = (0.2, 16);
    let wire_of = surface(&wire(&helix, &open, radius, around).unwrap());
    assert_eq!(euler_if_closed(&wire_of.triangles), 2);
    let length: f64 = helix.windows(2).map(|p| distance(p[0], p[1])).sum();
    let section = 0.5 * around as f64 * radius * radius * (TAU / around as f64).sin();
    let found = volume(&wire_of.points, &wire_of.triangles);
    assert!((found / (length * section) - 1.0).abs() < 1e-3, "{found} {}", length * section);
    assert_eq!(crossings(&wire_of.points[..40 * around], &within(&wire_of.triangles, 40 * around)), 0);
    for p in &wire_of.points[..200 * around] {
        let near = open.iter().map(|s| point_segment::closest(*p, s.map(|v| helix[v.index()])).distance());
        let near = near.fold(f64::INFINITY, f64::min);
        assert!((near / radius - 1.0).abs() < 1e-2, "{near}");
    }
}

fn within(triangles: &Triangles, n: usize) -> Vec<[VertexId; 3]> {
    triangles.iter().copied().filter(|t| t.iter().all(|v| v.index() < n)).collect()
}

#[test]
fn a_closed_wire_meets_itself_without_a_seam() {
    // Not in a plane, so that the frame comes back rotated.
    let n = 60;
    let knot: Vec<Point> = (0..n)
        .map(|i| TAU * f64::from(i) / f64::from(n))
        .map(|a| [3.0 * a.cos(), 3.0 * a.sin(), (2.0 * a).sin() + 0.5 * (3.0 * a).cos()])
        .collect();
    let ring = segments(&(0..n as u32).map(|i| [i, (i + 1) % n as u32]).collect::<Vec<_>>());
    let wire_of = surface(&wire(&knot, &ring, 0.3, 8).unwrap());
    assert_eq!(euler_if_closed(&wire_of.triangles), 0);
    assert!(volume(&wire_of.points, &wire_of.triangles) > 0.0);
    assert_eq!(crossings(&wire_of.points, &wire_of.triangles), 0);
    // No side is sheared: edges along the wire are hardly longer than the longest step of the line plus the
    // effect of the bend.
    let longest = (0..n as usize)
        .flat_map(|i| (0..8).map(move |k| (8 * i + k, 8 * ((i + 1) % n as usize) + k)))
        .map(|(a, b)| distance(wire_of.points[a], wire_of.points[b]))
        .fold(0.0, f64::max);
    let step = (0..n as usize).map(|i| distance(knot[i], knot[(i + 1) % n as usize])).fold(0.0, f64::max);
    assert!(longest < 1.2 * step, "{longest} {step}");
}

#[test]
fn a_wire_that_cannot_be_is_refused_with_the_segment() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [f64::NAN; 3]];
    let refused =
        |pairs: &[[u32; 2]], radius| wire(&points, &segments(pairs), radius, 6).unwrap_err().to_string();
    assert!(refused(&[], 0.1).contains("no segments"));
    assert!(refused(&[[0, 1], [1, 2]], 0.1).contains("segment 1: has no length"));
    assert!(refused(&[[0, 3]], 0.1).contains("segment 0"));
    assert!(refused(&[[0, 9]], 0.1).contains("point 9"));
    assert!(refused(&[[0, 1]], 0.0).contains("radius"));
    assert!(wire(&points, &segments(&[[0, 1]]), 0.1, 2).is_err());
    // A sharp turn back has no middle, but still gives a wire.
    let back = [[0.0; 3], [1.0, 0.0, 0.0], [0.5, 0.0, 0.0]];
    assert!(wire(&back, &segments(&[[0, 1], [1, 2]]), 0.1, 6).is_ok());
}

#[test]
fn a_coil_is_a_closed_wire_of_its_length() {
    let coil = Coil { centre: [1.0, 2.0, 3.0], radius: 2.0, pitch: 0.5, turns: 3.5, wire_radius: 0.1 };
    let mesh = coil.mesh(90, 24).unwrap();
    let surface = Surface::of(&mesh);
    assert_eq!(euler_if_closed(&surface.triangles), 2);
    let length = 3.5 * (TAU * 2.0).hypot(0.5);
    let volume = volume(&surface.points, &surface.triangles);
    assert!((volume / (PI * 0.01 * length) - 1.0).abs() < 0.02, "{volume}");
    let middle = |k: usize| {
        coil.line(90).iter().map(|p| p[k]).fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(x), b.max(x)])
    };
    assert!((middle(2)[0] + middle(2)[1] - 6.0).abs() < 1e-12);
    assert!(coil.line(90).iter().all(|p| ((p[0] - 1.0).hypot(p[1] - 2.0) - 2.0).abs() < 1e-12));
}
