//! Patches that slide in motions of several sub-steps: their vertices get new weights in each.

use motet::Mesh;
use motet::base::{Point, Threads};
use motet::geometry::vector::{add, cross, distance, dot, norm, scale, sub};
use motet::mesh::shapes;
use motet::motion::{Certificate, FacetSet, Mover, Options};

/// A rotated, scaled and shifted system of coordinates.
#[derive(Clone, Copy)]
struct Frame {
    axes: [Point; 3],
    unit: f64,
    origin: Point,
}

impl Frame {
    const PLAIN: Self =
        Self { axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], unit: 1.0, origin: [0.0; 3] };

    /// Rotated about an axis that is not a coordinate axis.
    fn turned(unit: f64, origin: Point) -> Self {
        let x = scale([2.0, -1.0, 3.0], 1.0 / 14f64.sqrt());
        let y = cross(x, [0.0, 1.0, 0.0]);
        let y = scale(y, 1.0 / norm(y));
        Self { axes: [x, y, cross(x, y)], unit, origin }
    }

    fn place(&self, p: Point) -> Point {
        let along = |sum: Point, i: usize| add(sum, scale(self.axes[i], self.unit * p[i]));
        (0..3).fold(self.origin, along)
    }

    fn coordinates(&self, p: Point) -> Point {
        self.axes.map(|axis| dot(axis, sub(p, self.origin)) / self.unit)
    }
}

/// A block between the waves `z = w(x, y)` and `z = 1 - w(x, y)` over a square, with vertical planes as
/// sides; and the position of each vertex once the waves have become planes.
fn wavy(n: [usize; 3], height: f64, frame: &Frame) -> (Mesh, Vec<Point>) {
    use std::f64::consts::PI;
    let wave = |x: f64, y: f64| height * (1.5 * PI * x).cos() * (PI * y).cos();
    let mut mesh = shapes::box_grid(n, [[0.0; 3], [2.0, 2.0, 1.0]]);
    let flat: Vec<Point> = mesh.points.iter().map(|&p| frame.place(p)).collect();
    for p in &mut mesh.points {
        p[2] += wave(p[0], p[1]) * (2.0 * p[2] - 1.0);
        *p = frame.place(*p);
    }
    (mesh, flat)
}

fn sliding(mesh: &Mesh, names: &[&str]) -> Options {
    let sliding = names.iter().map(|name| FacetSet::find(mesh, name).unwrap()).collect();
    Options { sliding, ..Options::default() }
}

/// Moves top and bottom to their flat positions.
fn flatten(mesh: &Mesh, mover: &mut Mover, flat: &[Point], out: &mut [Point]) -> Certificate {
    let move_of = |v: &motet::base::VertexId| sub(flat[v.index()], mesh.points[v.index()]);
    let driven: Vec<Point> = mover.boundary().iter().map(move_of).collect();
    mover.advance(&driven, out, &Threads::single()).unwrap()
}

/// The triangles between vertices of a rim that becomes straight lose their area; vertices that depend on
/// them must not.
#[test]
fn rims_that_become_straight_leave_no_flat_cells() {
    let frames = [
        (Frame::PLAIN, 1e-14),
        (Frame::turned(1e-3, [0.0; 3]), 1e-14),
        (Frame::turned(1e3, [0.0; 3]), 1e-14),
        (Frame::turned(1.0, [1e3; 3]), 1e-11),
    ];
    for (frame, rounding) in frames {
        let (mesh, flat) = wavy([12, 12, 10], 0.22, &frame);
        let options = sliding(&mesh, &["xmin", "xmax", "ymin", "ymax"]);
        let mut mover = Mover::new(&mesh, &options, &Threads::single()).unwrap();
        let mut out = mesh.points.clone();
        let certificate = flatten(&mesh, &mut mover, &flat, &mut out);
        assert!(certificate.complete && certificate.fraction == 1.0, "{}", certificate.fraction);
        assert!(certificate.substeps > 1, "one step is enough: this shows nothing");
        assert_eq!((certificate.inverted, certificate.not_reached()), (0, None));
        let worst = certificate.quality.worst_eas.unwrap().value;
        assert!(worst > 0.05, "{worst}");
        for v in mover.boundary() {
            let [reported, reached] = [&flat, &out].map(|points| frame.coordinates(points[v.index()]));
            // Sides keep their planes, and vertices that are neither on top nor at the bottom only move up or
            // down.
            assert!(
                (0..2).all(|k| (reported[k] - reached[k]).abs() <= 10.0 * rounding),
                "{v}: {reported:?} {reached:?}"
            );
            let is_driven = reported[2] < rounding || reported[2] > 1.0 - rounding;
            assert!(
                !is_driven || distance(reported, reached) <= 10.0 * rounding,
                "{v}: {reported:?} {reached:?}"
            );
        }
    }
}

#[test]
fn waves_that_come_and_go_leave_the_same_mesh_every_time() {
    let (mesh, flat) = wavy([8, 8, 8], 0.25, &Frame::turned(1e-3, [1.0; 3]));
    let options = sliding(&mesh, &["xmin", "xmax", "ymin", "ymax"]);
    let threads = Threads::single();
    let mut mover = Mover::new(&mesh, &options, &threads).unwrap();
    let back = vec![[0.0; 3]; mover.boundary().len()];
    let mut first: Option<Vec<Point>> = None;
    for _ in 0..5 {
        let mut out = mesh.points.clone();
        let certificate = flatten(&mesh, &mut mover, &flat, &mut out);
        assert!(certificate.complete && certificate.substeps > 1);
        assert_eq!(first.get_or_insert_with(|| out.clone()), &out);
        assert!(mover.advance(&back, &mut out, &threads).unwrap().complete);
        assert_eq!(out, mesh.points);
    }
}
