//! Requested edge lengths inside, checked against what is possible.

use std::fmt;

use serde::Serialize;

use super::surfaces::Surfaces;
use crate::base::{Error, Result};
use crate::geometry::triangle::area;
use crate::geometry::vector::{LARGEST, distance};
use crate::mesh::{Field, Mesh, Surface, edge_lengths, firsts_at_place, mean_edge_lengths};

/// The largest growth of sizes per unit of distance: in the lattice, neighbours differ by a factor of 2 at
/// most, so more would have no effect. Below it no cube of the lattice is so large that small sizes within it
/// go unnoticed at its middle.
pub const MOST_GROWTH: f64 = 0.7;

/// A surface triangle with an edge this many times as long as the size inside gives bad tets.
const COARSE: f64 = 3.0;
/// So does a triangle with an edge longer than the size whose longest edge is this many times its height: a
/// needle then has an angle below 10 degrees.
const NARROW: f64 = 6.0;

/// A surface most of which is far coarser than the size inside, or consists of narrow triangles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Coarse {
    /// The size of edges inside.
    pub size: f64,
    /// The shortest, the median and the longest edge of the surface.
    pub edges: [f64; 3],
}

impl fmt::Display for Coarse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { size, edges: [least, median, largest] } = self;
        write!(
            f,
            "most triangles of the surface are narrow or far coarser than the size {size}: edges are {least:.4} to {largest:.4} long, the median is {median:.4}"
        )
    }
}

/// Edge lengths inside, in units of the surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Sizes {
    /// One size everywhere.
    Uniform(f64),
    /// Given at the surface, growing from there.
    Graded(Grading),
}

/// Sizes that grow from the surface: at each place the minimum of `size there + growth * distance` over the
/// whole surface, so sizes at two places never differ by more than `growth` times their distance.
#[derive(Clone, Debug, PartialEq)]
pub struct Grading {
    /// The size at each of [`Surfaces::points`], linear on triangles; `None`: the mean length of the edges of
    /// the surface there. Default: `None`.
    pub at_points: Option<Vec<f64>>,
    /// By how much sizes grow per unit of distance, above 0 and at most [`MOST_GROWTH`]. Default: 0.3.
    pub growth: f64,
    /// The largest size anywhere. Default: `None`.
    pub largest: Option<f64>,
}

impl Default for Grading {
    fn default() -> Self {
        Self { at_points: None, growth: 0.3, largest: None }
    }
}

impl Sizes {
    /// Chooses between uniform and graded sizes. If `growth` or sizes at points are given, or if `is_graded`,
    /// sizes grow from the surface, up to `largest`; otherwise they are `largest` everywhere. `None` if
    /// nothing is given.
    pub fn of(
        largest: Option<f64>,
        is_graded: bool,
        growth: Option<f64>,
        at_points: Option<Vec<f64>>,
    ) -> Option<Self> {
        if !is_graded && growth.is_none() && at_points.is_none() {
            return largest.map(Self::Uniform);
        }
        let growth = growth.unwrap_or(Grading::default().growth);
        Some(Self::Graded(Grading { at_points, growth, largest }))
    }

    /// These sizes with those at points replaced by a function of them.
    pub(super) fn map_points(self, of: impl FnOnce(&[f64]) -> Vec<f64>) -> Self {
        match self {
            Self::Graded(Grading { at_points: Some(values), growth, largest }) => {
                Self::Graded(Grading { at_points: Some(of(&values)), growth, largest })
            }
            other => other,
        }
    }

    /// Checks the sizes.
    ///
    /// # Errors
    /// When a size is not a valid length, or the growth is out of range.
    pub(super) fn check(&self, surfaces: &Surfaces) -> Result<()> {
        match self {
            Self::Uniform(size) => check_length(*size),
            Self::Graded(grading) => grading.check(surfaces),
        }
    }

    /// Whether most of the surface, by area, has edges far longer than a uniform size, or is made of narrow
    /// triangles, on which no good tets can stand. `None` if not, or if sizes are graded.
    pub fn coarse(&self, surfaces: &Surfaces) -> Option<Coarse> {
        let Self::Uniform(size) = *self else { return None };
        let (mut all, mut coarse) = (0.0, 0.0);
        for triangle in &surfaces.triangles {
            let corners @ [a, b, c] = triangle.map(|v| surfaces.points[v.index()]);
            let longest = distance(a, b).max(distance(b, c)).max(distance(c, a));
            all += area(corners);
            let is_narrow = longest > size && longest * longest > NARROW * 2.0 * area(corners);
            coarse += if longest > COARSE * size || is_narrow { area(corners) } else { 0.0 };
        }
        let edges = edge_lengths(&surfaces.points, surfaces.triangles.iter().copied())?;
        (2.0 * coarse > all).then_some(Coarse { size, edges })
    }

    /// The sizes at the corners of each triangle; empty for a uniform size.
    pub(super) fn at_corners(&self, surfaces: &Surfaces) -> Vec<[f64; 3]> {
        let Self::Graded(grading) = self else { return Vec::new() };
        let of_edges = || mean_edge_lengths(&surfaces.points, surfaces.triangles.iter().copied());
        let sizes = grading.at_points.as_ref().map_or_else(of_edges, Vec::clone);
        surfaces.triangles.iter().map(|t| t.map(|v| sizes[v.index()])).collect()
    }
}

impl Grading {
    fn check(&self, surfaces: &Surfaces) -> Result<()> {
        self.largest.map_or(Ok(()), check_length)?;
        if !(self.growth > 0.0 && self.growth <= MOST_GROWTH) {
            let what = format!(
                "the growth of sizes is {}; it must be above 0 and at most {MOST_GROWTH}",
                self.growth
            );
            return Err(Error::options(what).remedy("0.3 is a good start"));
        }
        let Some(sizes) = &self.at_points else { return Ok(()) };
        if sizes.len() != surfaces.points.len() {
            let what = format!("{} sizes for {} points of the surfaces", sizes.len(), surfaces.points.len());
            return Err(Error::input(what).remedy("give a size for each point"));
        }
        let used = surfaces.triangles.as_flattened().iter();
        match used.filter(|v| !is_length(sizes[v.index()])).min() {
            None => Ok(()),
            Some(v) => Err(no_length(sizes[v.index()]).at(format!("point {v} of the surfaces"))),
        }
    }
}

fn is_length(size: f64) -> bool {
    size > 0.0 && size <= LARGEST
}

fn check_length(size: f64) -> Result<()> {
    if is_length(size) {
        return Ok(());
    }
    Err(Error::options(format!("the size is {size}; it must be a length above 0 and at most {LARGEST:e}")))
}

fn no_length(size: f64) -> Error {
    Error::input(format!("the size {size} is not a valid edge length"))
        .remedy("give every point of the surface a number above 0")
}

/// Returns the sizes at the points of a mesh, from an array on its points or its surface cells (volume cells
/// if it has no surface cells). Among cells that share a point the smallest size counts. Points that no cell
/// uses get infinity.
///
/// # Errors
/// When there is no such array, when it has more than one component, or when a value is not a valid length;
/// the error gives the point or cell.
pub fn sizes_by(mesh: &Mesh, array: &str) -> Result<Vec<f64>> {
    let surface = Surface::own_or_boundary_of(mesh);
    let mut sizes = vec![f64::INFINITY; mesh.points.len()];
    if let Some(field) = mesh.point_field(array) {
        let values = scalars(field)?;
        for v in surface.vertices() {
            sizes[v.index()] = values[v.index()];
            if !is_length(values[v.index()]) {
                return Err(no_length(values[v.index()]).at(format!("array `{array}`: point {v}")));
            }
        }
        return Ok(sizes);
    }
    let Some(field) = mesh.cell_field(array) else { return Err(unknown(mesh, array)) };
    let values = scalars(field)?;
    for (triangle, cell) in surface.triangles.iter().zip(&surface.triangle_to_cell) {
        let size = values[cell.index()];
        if !is_length(size) {
            return Err(no_length(size).at(format!("array `{array}`: cell {cell}")));
        }
        triangle.iter().for_each(|v| sizes[v.index()] = sizes[v.index()].min(size));
    }
    Ok(sizes)
}

fn scalars(field: &Field) -> Result<Vec<f64>> {
    let values = field.values.to_f64().filter(|_| field.components == 1);
    values.ok_or_else(|| {
        Error::input("does not have one number a row, as sizes must")
            .at(format!("array `{}`", field.name))
            .remedy("give an array with one component")
    })
}

fn unknown(mesh: &Mesh, array: &str) -> Error {
    let names = |fields: &[Field]| match fields {
        [] => "none".to_owned(),
        _ => fields.iter().map(|field| field.name.as_str()).collect::<Vec<_>>().join(", "),
    };
    Error::input(format!("the surface has no array `{array}`")).remedy(format!(
        "point arrays: {}; cell arrays: {}",
        names(&mesh.point_data),
        names(&mesh.cell_data)
    ))
}

impl Surfaces {
    /// Returns sizes at all points, given those at the points of each mesh; among coincident points the
    /// smallest counts.
    pub fn sizes(&self, of_meshes: &[Vec<f64>]) -> Vec<f64> {
        let mut sizes = of_meshes.concat();
        if sizes.len() == self.points.len() {
            let kept = firsts_at_place(&self.points);
            for (v, first) in kept.iter().enumerate() {
                sizes[first.index()] = sizes[first.index()].min(sizes[v]);
            }
        }
        sizes
    }
}
