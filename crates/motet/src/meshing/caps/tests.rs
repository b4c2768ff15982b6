//! Caps on shapes whose ends are known.

use super::*;
use crate::base::Threads;
use crate::mesh::shapes::Aneurysm;
use crate::preflight::{Role, preflight};

/// An aneurysm without its inlet and outlet.
fn open() -> Mesh {
    let whole = Aneurysm::default().mesh().unwrap();
    let surface = Surface::of(&whole);
    let wall = whole.find_patch("wall").unwrap();
    let kept = surface.triangles.iter().zip(&surface.patches).filter(|(_, p)| **p == wall);
    let triangles: Vec<VertexId> = kept.flat_map(|(t, _)| *t).collect();
    Mesh::new(whole.points, Cells::uniform(CellKind::TRIANGLE, triangles).unwrap())
}

#[test]
fn a_vessel_gets_two_caps_and_encloses_what_it_did() {
    let open = open();
    let caps = Caps::of(&open).unwrap();
    assert_eq!(caps.len(), 2);
    let closed = caps.close(&open).unwrap();
    assert_eq!(closed.points[..open.points.len()], open.points);
    let surface = Surface::of(&closed);
    assert!(crate::mesh::check::is_closed(surface.triangles.iter().map(|t| t.as_slice())));
    let whole = Surface::of(&Aneurysm::default().mesh().unwrap()).enclosed_volume();
    // Rims are flat, so caps are.
    assert!((surface.enclosed_volume() - whole).abs() < 1e-12 * whole);
    assert_eq!(closed.label_names.patches.values().collect::<Vec<_>>(), ["wall", "cap_1", "cap_2"]);
    assert!(
        preflight(
            &surface.points,
            &surface.triangles,
            &vec![0; surface.triangles.len()],
            &[Role::Boundary],
            &Threads::single()
        )
        .is_fit()
    );
}

#[test]
fn caps_follow_a_rim_that_moves() {
    let open = open();
    let caps = Caps::of(&open).unwrap();
    let mut moved = open.clone();
    let map = |p: Point| [1.1 * p[0] + 0.2 * p[1] + 3.0, 0.9 * p[1], p[2] - 0.3 * p[0]];
    moved.points.iter_mut().for_each(|p| *p = map(*p));
    let [a, b] = [&open, &moved].map(|frame| caps.close(frame).unwrap());
    assert_eq!(a.cells, b.cells);
    for (p, q) in a.points.iter().zip(&b.points) {
        assert!(distance(map(*p), *q) < 1e-13);
    }
    moved.points.pop();
    assert!(caps.close(&moved).is_err());
}

#[test]
fn rims_are_flattened_and_nothing_else_is_touched() {
    let mut open = open();
    let caps = Caps::of(&open).unwrap();
    let before = open.clone();
    let flat_rims: Vec<RimPlane> = caps.planes(&open).unwrap();
    assert!(flat_rims.iter().all(|rim| rim.deviation < 1e-12 * rim.radius));
    // Every other vertex of a rim is off by 0.02 of the radius along the normal of its plane, the others
    // by -0.02.
    for (rim, plane) in caps.rims.iter().zip(&flat_rims) {
        let (_, _, normal) = caps.plane_of(rim, &before.points).unwrap();
        for (i, v) in rim.vertices.iter().enumerate() {
            let by = if i % 2 == 0 { 0.02 } else { -0.02 } * plane.radius;
            open.points[v.index()] = add(open.points[v.index()], scale(normal, by));
        }
    }
    let (flat, planes) = caps.flatten(&open).unwrap();
    assert_eq!(planes, caps.planes(&open).unwrap());
    let is_on_rim = |v: usize| caps.rims.iter().any(|rim| rim.vertices.contains(&VertexId::new(v)));
    for (v, (p, q)) in open.points.iter().zip(&flat.points).enumerate() {
        assert!(is_on_rim(v) || p == q);
    }
    for (plane, was) in caps.planes(&flat).unwrap().iter().zip(&planes) {
        assert!(plane.deviation < 1e-14 * plane.radius, "{plane:?}");
        assert!((was.deviation / was.radius - 0.02).abs() < 2e-3, "{was:?}");
    }
}

#[test]
fn a_rim_that_cannot_be_flattened_is_refused_with_its_place() {
    // A tent without its floor: two of its four corners are so high that the walls would turn over.
    let points =
        vec![[1.0, 0.0, 3.0], [0.0, 1.0, -3.0], [-1.0, 0.0, 3.0], [0.0, -1.0, -3.0], [0.0, 0.0, 1.0]];
    let walls = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]].map(|t| t.map(VertexId));
    let cells =
        |walls: &[[VertexId; 3]]| Cells::uniform(CellKind::TRIANGLE, walls.as_flattened().to_vec()).unwrap();
    let tent = Mesh::new(points, cells(&walls));
    let caps = Caps::of(&tent).unwrap();
    assert!((caps.planes(&tent).unwrap()[0].deviation - 3.0).abs() < 1e-15);
    assert!(caps.flatten(&tent).is_ok());
    let mut folded = tent.clone();
    folded.points[4] = [0.9, 0.0, 2.0];
    folded.points[0] = [0.5, 0.0, 3.0];
    let error = caps.flatten(&folded).unwrap_err().to_string();
    assert!(error.contains("point") && error.contains("turn over"), "{error}");
}

#[test]
fn what_has_no_rim_is_reported() {
    let whole = Aneurysm::default().mesh().unwrap();
    assert!(Caps::of(&whole).unwrap_err().to_string().contains("no open rim"));
    // Two that share an edge and face opposite sides.
    let two = [[0, 1, 2], [0, 1, 3]].map(|t| t.map(VertexId)).as_flattened().to_vec();
    let torn = Mesh::new(vec![[0.0; 3]; 4], Cells::uniform(CellKind::TRIANGLE, two).unwrap());
    assert!(Caps::of(&torn).unwrap_err().to_string().starts_with("point "));
}

fn is_fit(closed: &Mesh) -> bool {
    let surface = Surface::of(closed);
    let n = surface.triangles.len();
    preflight(&surface.points, &surface.triangles, &vec![0; n], &[Role::Boundary], &Threads::single())
        .is_fit()
}

#[test]
fn extensions_add_the_volume_of_their_tubes() {
    let open = open();
    let mut caps = Caps::of(&open).unwrap();
    let plain = caps.close(&open).unwrap();
    caps.name_ends(&open, None).unwrap();
    caps.extend(&open, Some("outlet"), 2.0).unwrap();
    caps.extend(&open, None, 3.0).unwrap();
    let long = caps.close(&open).unwrap();
    assert!(is_fit(&long));
    assert_eq!(long.points[..open.points.len()], open.points);
    let [short, whole] = [&plain, &long].map(|mesh| Surface::of(mesh).enclosed_volume());
    let area = |name: &str| {
        let (surface, patch) = (Surface::of(&long), long.find_patch(name).unwrap());
        let of = (0..surface.triangles.len()).filter(|&t| surface.patches[t] == patch);
        of.map(|t| norm(area_vector(surface.corners(t)))).sum::<f64>()
    };
    let tubes = 3.0 * area("inlet") + 2.0 * area("outlet");
    assert!((whole - short - tubes).abs() < 0.01 * tubes, "{} {tubes}", whole - short);
    // Only caps and the wall: extensions continue it.
    let names: Vec<&String> = long.label_names.patches.values().collect();
    assert_eq!(names, ["wall", "inlet", "outlet"]);
}

#[test]
fn an_uneven_rim_becomes_a_flat_circle() {
    let mut open = open();
    let caps = Caps::of(&open).unwrap();
    for rim in &caps.rims {
        let (_, middle, normal) = caps.plane_of(rim, &open.points).unwrap();
        for (i, v) in rim.vertices.iter().enumerate() {
            let p = &mut open.points[v.index()];
            let offset = sub(*p, middle);
            // Squeezed to an ellipse, and wavy.
            let squeezed = [offset[0], offset[1], 0.6 * offset[2]];
            *p = add(add(middle, squeezed), scale(normal, 0.05 * (0.9 * i as f64).sin()));
        }
    }
    let mut caps = Caps::of(&open).unwrap();
    caps.extend(&open, None, 2.5).unwrap();
    let long = caps.close(&open).unwrap();
    assert!(is_fit(&long));
    let planes = Caps::of(&open_of(&long)).unwrap();
    for plane in planes.planes(&open_of(&long)).unwrap() {
        assert!(plane.deviation < 1e-12, "{plane:?}");
    }
    for rim in &planes.rims {
        let (plane, middle, _) = planes.plane_of(rim, &long.points).unwrap();
        for v in &rim.vertices {
            let radius = distance(long.points[v.index()], middle);
            assert!((radius / plane.radius - 1.0).abs() < 0.02, "{radius} {}", plane.radius);
        }
    }
}

/// A closed surface without its caps.
fn open_of(closed: &Mesh) -> Mesh {
    let (surface, wall) = (Surface::of(closed), closed.find_patch("wall").unwrap());
    let kept = surface.triangles.iter().zip(&surface.patches).filter(|(_, p)| **p == wall);
    let triangles: Vec<VertexId> = kept.flat_map(|(t, _)| *t).collect();
    Mesh::new(closed.points.clone(), Cells::uniform(CellKind::TRIANGLE, triangles).unwrap())
}

#[test]
fn ends_are_named_by_size_or_place() {
    let vessel = crate::mesh::shapes::Bifurcation::default().mesh().unwrap();
    let is_wall = vessel.find_patch("wall").unwrap();
    let surface = Surface::of(&vessel);
    let kept = surface.triangles.iter().zip(&surface.patches).filter(|(_, p)| **p == is_wall);
    let triangles: Vec<VertexId> = kept.flat_map(|(t, _)| *t).collect();
    let open = Mesh::new(vessel.points.clone(), Cells::uniform(CellKind::TRIANGLE, triangles).unwrap());
    let middle = |closed: &Mesh, name: &str| {
        let (surface, patch) = (Surface::of(closed), closed.find_patch(name).unwrap());
        let of: Vec<usize> = (0..surface.triangles.len()).filter(|&t| surface.patches[t] == patch).collect();
        let sum = of
            .iter()
            .fold([0.0; 3], |sum, &t| add(sum, crate::geometry::triangle::centroid(surface.corners(t))));
        scale(sum, 1.0 / of.len() as f64)
    };
    let mut caps = Caps::of(&open).unwrap();
    caps.name_ends(&open, None).unwrap();
    let closed = caps.close(&open).unwrap();
    // The trunk is the widest.
    assert!(distance(middle(&closed, "inlet"), middle(&vessel, "inlet")) < 1e-2);
    let branch = middle(&vessel, "outlet_2");
    caps.name_ends(&open, Some(branch)).unwrap();
    let closed = caps.close(&open).unwrap();
    assert!(distance(middle(&closed, "inlet"), branch) < 1e-2);
    assert!(distance(middle(&closed, "outlet_1"), middle(&vessel, "inlet")) < 1e-2);
    let refused = caps.extend(&open, Some("x"), 1.0).unwrap_err().to_string();
    assert!(refused.contains("no open end `x`") && refused.contains("outlet_2"), "{refused}");
    for length in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
        assert!(caps.extend(&open, None, length).is_err(), "{length}");
    }
}

#[test]
fn an_extension_that_meets_the_surface_is_refused() {
    // Half a ring: one end looks at the other.
    let (n, m) = (12, 40);
    let points: Vec<Point> = (0..m)
        .flat_map(|j| (0..n).map(move |i| (i, j)))
        .map(|(i, j)| {
            let (s, t) = (std::f64::consts::TAU * i as f64 / n as f64, 4.2 * j as f64 / (m - 1) as f64);
            let r = 2.0 + 0.5 * s.cos();
            [r * t.cos(), r * t.sin(), 0.5 * s.sin()]
        })
        .collect();
    let mut cells = Vec::new();
    for (i, j) in (0..m - 1).flat_map(|j| (0..n).map(move |i| (i, j))) {
        let id = |i: usize, j: usize| VertexId::new(j * n + i % n);
        cells.extend([id(i, j), id(i, j + 1), id(i + 1, j), id(i + 1, j), id(i, j + 1), id(i + 1, j + 1)]);
    }
    let open = Mesh::new(points, Cells::uniform(CellKind::TRIANGLE, cells).unwrap());
    let mut caps = Caps::of(&open).unwrap();
    caps.extend(&open, None, 0.5).unwrap();
    assert!(is_fit(&caps.close(&open).unwrap()));
    let mut caps = Caps::of(&open).unwrap();
    caps.extend(&open, None, 6.0).unwrap();
    let refused = caps.close(&open).unwrap_err().to_string();
    assert!(refused.contains("meets the surface"), "{refused}");
}
