//! Shared by the targets of algorithms: bodies from bytes, and what must hold for a mesh of tets by
//! definition.
#![allow(dead_code, reason = "each target uses its part")]

use std::collections::HashMap;

use motet::Mesh;
use motet::base::{Point, VertexId};
use motet::geometry::predicates::orient3d;
use motet::geometry::tet::{FACETS, volume};
use motet::geometry::triangle::area;
use motet::mesh::shapes::box_grid;
use motet::mesh::{CellKind, Cells, Field, Surface};

/// Numbers from bytes in order; zeros after the last.
pub struct Numbers<'a>(pub &'a [u8]);

impl Numbers<'_> {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        first
    }

    /// A number in 0..n, for n up to 256.
    pub fn below(&mut self, n: usize) -> usize {
        usize::from(self.byte()) % n
    }

    /// A multiple of 1/16 in [-1, 1]: coordinates often coincide.
    pub fn coarse(&mut self) -> f64 {
        (f64::from(self.byte() % 33) - 16.0) / 16.0
    }

    /// A vector of [`Self::coarse`] numbers.
    pub fn vector(&mut self) -> Point {
        [self.coarse(), self.coarse(), self.coarse()]
    }
}

/// Cubes of a lattice of 2 or 3 per side, each of 6 tets, with corners moved by up to `most` of an edge.
/// Cubes are in regions 1 to 3; all coordinates lie within [-1, 1].
pub fn cubes(numbers: &mut Numbers, most: f64) -> Mesh {
    let n = 2 + numbers.below(2);
    let whole = box_grid([n; 3], [[-1.0; 3], [1.0; 3]]);
    let regions: Vec<i32> = (0..n * n * n).map(|_| numbers.below(5) as i32 - 1).collect();
    let edge = 2.0 / n as f64;
    let cube = |tet: &[VertexId]| -> usize {
        let lowest = |axis: usize| tet.iter().map(|v| whole.points[v.index()][axis]).fold(1.0, f64::min);
        let at = |axis: usize| ((lowest(axis) + 1.0) / edge).round() as usize;
        at(0) + n * (at(1) + n * at(2))
    };
    let (mut cells, mut labels) = (Cells::new(), Vec::new());
    for (_, tet) in whole.cells.tets() {
        let region = regions[cube(&tet)];
        if region > 0 || cube(&tet) == 0 {
            cells.push(CellKind::TETRA, tet);
            labels.push(region.max(1));
        }
    }
    let points = whole.points.iter().map(|p| {
        let by = numbers.vector();
        [0, 1, 2].map(|i| p[i] + most * edge * by[i])
    });
    let mut mesh = Mesh::new(points.collect(), cells);
    mesh.set_cell_field(Field::scalars("region", labels));
    placed(&mut mesh, numbers);
    mesh
}

/// Leaves a mesh where it is, or rotates, shifts or scales it, or rounds it to `f32`.
fn placed(mesh: &mut Mesh, numbers: &mut Numbers) {
    let how = numbers.below(8);
    let turn = |p: Point| {
        // A rotation with rational entries, most of which are not exact in floating point.
        let rows = [[2.0, -2.0, 1.0], [1.0, 2.0, 2.0], [-2.0, -1.0, 2.0]];
        rows.map(|r: [f64; 3]| (r[0] * p[0] + r[1] * p[1] + r[2] * p[2]) / 3.0)
    };
    for p in &mut mesh.points {
        *p = match how {
            1 => turn(*p),
            2 => p.map(|x| x + 1e3),
            3 => p.map(|x| 1e-3 * x),
            4 => p.map(|x| f64::from(x as f32)),
            5 => turn(*p).map(|x| f64::from((x + 1e3) as f32)),
            _ => *p,
        };
    }
}

/// The boundary of a mesh, as a mesh of triangles.
pub fn skin(mesh: &Mesh) -> Mesh {
    let surface = Surface::boundary_of(mesh);
    let mut cells = Cells::new();
    surface.triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
    Mesh::new(surface.points, cells)
}

pub fn tets(mesh: &Mesh) -> Vec<[Point; 4]> {
    mesh.cells.tets().map(|(_, tet)| tet.map(|v| mesh.points[v.index()])).collect()
}

pub fn is_positive([a, b, c, d]: [Point; 4]) -> bool {
    orient3d(a, b, c, d) > 0
}

pub fn n_not_positive(mesh: &Mesh) -> usize {
    tets(mesh).into_iter().filter(|tet| !is_positive(*tet)).count()
}

/// The volume of the tets of each region; `tolerance` covers rounding.
pub fn volumes(mesh: &Mesh) -> HashMap<i64, f64> {
    let labels = mesh.cell_field("region").and_then(|f| f.values.to_f64());
    let mut volumes = HashMap::new();
    for (cell, tet) in mesh.cells.tets() {
        let region = labels.as_ref().map_or(0, |l| l[cell.index()] as i64);
        *volumes.entry(region).or_insert(0.0) += volume(tet.map(|v| mesh.points[v.index()]));
    }
    volumes
}

/// The permitted deviation of the volumes of a mesh made from `given`: the area of all facets times the
/// rounding of the given coordinates. Facets that are flat up to the rounding of `f32`, or of a few decimals,
/// may be divided in another way; a hundredth of the last decimal is allowed.
pub fn tolerance(mesh: &Mesh, given: &Mesh) -> f64 {
    let coordinates = || given.points.iter().flatten().copied();
    let largest = coordinates().fold(0.0f64, |m, x| m.max(x.abs()));
    let is_single = coordinates().all(|x| f64::from(x as f32) == x);
    let of_single = if is_single { 2.0 * f64::from(f32::EPSILON) * largest } else { 0.0 };
    let has_decimals =
        |ten: &f64| coordinates().all(|x| (x * ten - (x * ten).round()).abs() <= 1e-15 * (x * ten).abs());
    let ten = (0..=9).map(|n| 10f64.powi(n)).find(has_decimals);
    let facets: f64 = tets(mesh).iter().flat_map(|t| FACETS.map(|f| area(f.map(|k| t[k])))).sum();
    facets * ten.map_or(0.0, |ten| 0.01 / ten).max(of_single).max(1e-12 * largest)
}

/// Checks what holds for every mesh: ids within range, distinct corners, at most two tets at each facet and,
/// where all tets are positive, no two on the same side of a facet.
pub fn check(mesh: &Mesh) {
    mesh.validate().expect("the mesh holds together");
    let are_positive = n_not_positive(mesh) == 0;
    let mut uses: HashMap<[VertexId; 3], Vec<bool>> = HashMap::new();
    for (cell, tet) in mesh.cells.tets() {
        let mut corners = tet;
        corners.sort_unstable();
        assert!(corners.windows(2).all(|w| w[0] != w[1]), "tet {cell} has a corner twice");
        for facet in FACETS {
            let facet = facet.map(|k| tet[k]);
            uses.entry(rising(facet)).or_default().push(is_even(facet));
        }
    }
    for (facet, sides) in uses {
        let is_sound = sides.len() == 1 || sides.len() == 2 && (sides[0] != sides[1] || !are_positive);
        assert!(is_sound, "facet {facet:?} of {} tets, seen from {sides:?}", sides.len());
    }
}

fn rising(mut facet: [VertexId; 3]) -> [VertexId; 3] {
    facet.sort_unstable();
    facet
}

/// Whether the permutation that sorts the corners is even.
fn is_even([a, b, c]: [VertexId; 3]) -> bool {
    (usize::from(a > b) + usize::from(a > c) + usize::from(b > c)) % 2 == 0
}
