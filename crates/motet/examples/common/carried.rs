//! Fields that follow exact functions of position while vertices move, and are carried where the mesh
//! changes.

use std::f64::consts::FRAC_PI_2;

use motet::base::{Point, VertexId};
use motet::geometry::tet;
use motet::mesh::history::{History, Rule};
use motet::mesh::{Field, Mesh};
use serde_json::{Value, json};

/// Values at vertices, and the positions of these.
pub(crate) struct Carried {
    places: Vec<Point>,
    linear: Vec<f64>,
    smooth: Vec<f64>,
    /// The initial maximum of the linear function's absolute value.
    range: f64,
}

fn linear(p: Point) -> f64 {
    0.7 * p[0] - 1.3 * p[1] + 2.1 * p[2] + 0.4
}

fn smooth(p: Point) -> f64 {
    (FRAC_PI_2 * p[0]).sin() * (FRAC_PI_2 * p[1]).cos() + p[2] * p[2]
}

/// The integral of cell values over the tets.
pub(crate) fn integral(mesh: &Mesh, places: &[Point], values: &[f64]) -> f64 {
    mesh.cells.tets().map(|(cell, corners)| values[cell.index()] * volume(places, corners)).sum()
}

fn volume(places: &[Point], corners: [VertexId; 4]) -> f64 {
    tet::volume(corners.map(|v| places[v.index()]))
}

impl Carried {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        let of = |f: fn(Point) -> f64| mesh.points.iter().map(|p| f(*p)).collect::<Vec<_>>();
        let range = of(linear).into_iter().fold(0.0, |most, x| x.abs().max(most));
        Self { places: mesh.points.clone(), linear: of(linear), smooth: of(smooth), range }
    }

    pub(crate) fn places(&self) -> &[Point] {
        &self.places
    }

    /// Moves the vertices: each value changes by the change of the exact function on the way.
    pub(crate) fn move_to(&mut self, places: &[Point]) {
        for (i, (&to, from)) in places.iter().zip(&mut self.places).enumerate() {
            self.linear[i] += linear(to) - linear(*from);
            self.smooth[i] += smooth(to) - smooth(*from);
            *from = to;
        }
    }

    /// Moves the vertices to `before`, and carries the fields through the change of the mesh there by a rule
    /// for points.
    ///
    /// # Errors
    /// When the history is that of another mesh.
    pub(crate) fn change(&mut self, before: &[Point], history: &History, rule: Rule) -> motet::Result<()> {
        self.move_to(before);
        let carry = |values: &[f64]| -> motet::Result<Vec<f64>> {
            let field = history.transfer_points_by(&Field::scalars("", values.to_vec()), rule)?;
            Ok(field.and_then(|field| field.values.to_f64()).unwrap_or_default())
        };
        (self.linear, self.smooth) = (carry(&self.linear)?, carry(&self.smooth)?);
        self.places = history.transfer_points(&Field::vectors("", &self.places))?.to_vectors()?;
        Ok(())
    }

    /// Errors of the fields, on a mesh with the vertex positions of `self`.
    pub(crate) fn measured(&self, mesh: &Mesh) -> Value {
        let off = self.linear.iter().zip(&self.places).map(|(u, p)| (u - linear(*p)).abs() / self.range);
        let error: Vec<f64> = self.smooth.iter().zip(&self.places).map(|(u, p)| u - smooth(*p)).collect();
        let (mut squares, mut own, mut all) = (0.0, 0.0, 0.0);
        for (_, corners) in mesh.cells.tets() {
            let volume = volume(&self.places, corners);
            // The integral of the square of a linear function over a tet: a twentieth of the volume times the
            // sum of the squared values plus the square of their sum, exactly.
            let e = corners.map(|v| error[v.index()]);
            let sum: f64 = e.iter().sum();
            squares += volume / 20.0 * (e.iter().map(|x| x * x).sum::<f64>() + sum * sum);
            let [o, a] = self.by_points(corners);
            (own, all) = (own + volume * o, all + volume * a);
        }
        json!({
            "linear": off.fold(0.0, f64::max),
            "smooth": (squares / all).sqrt(),
            "most": error.iter().fold(0.0, |most: f64, e| e.abs().max(most)),
            "own": (own / all).sqrt(),
            "points": self.places.len(),
            "tets": mesh.cells.tets().count(),
        })
    }

    /// Means over a tet, by a four-point rule: of the squared difference between the exact function and its
    /// interpolant, and of the squared function.
    fn by_points(&self, corners: [VertexId; 4]) -> [f64; 2] {
        const NEAR: f64 = 0.585_410_196_624_968_5;
        const FAR: f64 = 0.138_196_601_125_010_5;
        let places = corners.map(|v| self.places[v.index()]);
        let mean = |i: usize, of: &dyn Fn(usize) -> f64| {
            (0..4).map(|j| if i == j { NEAR } else { FAR } * of(j)).sum::<f64>()
        };
        let (mut own, mut all) = (0.0, 0.0);
        for i in 0..4 {
            let exact = smooth([0, 1, 2].map(|k| mean(i, &|j| places[j][k])));
            let interpolated = mean(i, &|j| smooth(places[j]));
            own += (interpolated - exact).powi(2) / 4.0;
            all += exact.powi(2) / 4.0;
        }
        [own, all]
    }
}
