//! A straight tube, the simplest vessel, optionally with thin layers at the wall.
//!
//! ```text
//!    .-""""-.        cross-section: a core of n x n quads, bent outward, then rings
//!   /\ ____ /\       of 4 n quads; the outermost rings are thin. Numbered from the
//!  |  |_|_|_| |      wall inward, ring by ring, so that all rings of the wall are cut
//!  |  |_|_|_| |      along the same diagonals.
//!   \/      \/
//!    `-....-'
//! ```

use std::f64::consts::FRAC_PI_4;

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::{LARGEST, add, scale};
use crate::mesh::shapes::check_count;
use crate::mesh::shapes::labelled::labelled;
use crate::mesh::shapes::split::{fan_triangles, to_tets};
use crate::mesh::{CellKind, Cells, Mesh};

/// The kind of cells in the thin layers at the wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WallCells {
    /// Tets, three for each half of a quad of the wall.
    Tets,
    /// Wedges, one for each half of a quad of the wall.
    Wedges,
}

/// The parameters of a tube.
#[derive(Clone, Debug, PartialEq)]
pub struct TubeOptions {
    /// Radius; default 1.
    pub radius: f64,
    /// Length along z, from 0; default 5.
    pub length: f64,
    /// Number of cells along each side of the core, a quarter of the number around; default 4.
    pub n: usize,
    /// Number of rings of cells between the core and the thin layers; default 2.
    pub rings: usize,
    /// Number of cells along the axis; default 15.
    pub slices: usize,
    /// Number of thin layers at the wall; default 0.
    pub wall_layers: usize,
    /// Thickness of the outermost thin layer, as a fraction of the radius; default 0.01.
    pub first_layer: f64,
    /// Ratio of the thickness of each thin layer to that of its outer neighbour; default 1.3.
    pub growth: f64,
    /// The kind of cells in the thin layers; default tets.
    pub wall_cells: WallCells,
}

impl Default for TubeOptions {
    fn default() -> Self {
        Self {
            radius: 1.0,
            length: 5.0,
            n: 4,
            rings: 2,
            slices: 15,
            wall_layers: 0,
            first_layer: 0.01,
            growth: 1.3,
            wall_cells: WallCells::Tets,
        }
    }
}

impl TubeOptions {
    /// Checks that [`tube`] can build these options.
    ///
    /// # Errors
    /// If a count is 0 (other than `wall_layers`), there would be more points than a shape may have, a length
    /// is not positive, or the thin layers leave no space for the core.
    pub fn check(&self) -> Result<()> {
        let Self { n, rings, slices, wall_layers, .. } = *self;
        if n == 0 || rings == 0 || slices == 0 {
            return Err(Error::options(format!("got {n} cells, {rings} rings and {slices} slices"))
                .remedy("give 1 or more of each"));
        }
        let section = (n as f64 + 1.0) * (n as f64 + 4.0 * (rings as f64 + wall_layers as f64 + 1.0));
        check_count(section * (slices as f64 + 1.0))?;
        let lengths = [self.radius, self.length, self.first_layer, self.growth];
        if !lengths.iter().all(|x| *x > 0.0 && *x <= LARGEST) {
            return Err(Error::options(format!(
                "got {lengths:?} for radius, length, the first layer and its growth"
            ))
            .remedy("give numbers above 0"));
        }
        if self.outer_radius() <= CORE {
            return Err(Error::options(format!("{wall_layers} wall layers leave no space for the core"))
                .remedy("ask for fewer, or for thinner ones"));
        }
        Ok(())
    }

    /// The radius inside the thin layers, as a fraction of the tube's radius.
    fn outer_radius(&self) -> f64 {
        let layers = std::iter::successors(Some(self.first_layer), |thickness| Some(thickness * self.growth));
        layers.take(self.wall_layers).fold(1.0, |radius, thickness| radius - thickness)
    }

    /// The radius of each ring of vertices, from the wall inward, as a fraction of the tube's radius.
    fn ring_radii(&self) -> Vec<f64> {
        let mut radii = vec![1.0];
        let mut thickness = self.first_layer;
        for _ in 0..self.wall_layers {
            radii.push(radii[radii.len() - 1] - thickness);
            thickness *= self.growth;
        }
        let outer = radii[radii.len() - 1];
        assert!(outer > CORE, "the wall layers leave no room for the core");
        let step = (outer - CORE) / self.rings as f64;
        radii.extend((1..=self.rings).map(|r| outer - step * r as f64));
        radii
    }
}

/// Distance of the corners of the core from the axis, as a fraction of the radius.
const CORE: f64 = 0.6;

/// Roundness of the core: 0 is a square, 1 a disc (on which the corners would be flat).
const ROUNDNESS: f64 = 0.6;

/// The tube described by `options`, along z from 0. Region `lumen`; patches `wall`, `inlet` (at z = 0) and
/// `outlet`.
///
/// Panics if a count is 0 (other than `wall_layers`), or if the thin layers fill the tube: see
/// [`TubeOptions::check`].
pub fn tube(options: &TubeOptions) -> Mesh {
    assert!(options.n > 0 && options.rings > 0 && options.slices > 0, "a mesh has cells");
    let section = Section::new(options);
    let points: Vec<Point> = section.points(options);
    let (mut cells, to_split) = section.cells(options);
    for (_, kind, vertices) in to_tets(&to_split).iter() {
        cells.push(kind, vertices.iter().copied());
    }
    let heights: Vec<f64> = points.iter().map(|p| p[2]).collect();
    let length = options.length;
    labelled(points, cells, "lumen", &["wall", "inlet", "outlet"], move |facet| {
        let all_at = |z: f64| facet.iter().all(|v| heights[v.index()] == z);
        if all_at(0.0) {
            1
        } else if all_at(length) {
            2
        } else {
            0
        }
    })
}

/// The cross-section, and the numbering of its copies along the axis: rings from the wall inward, all slices
/// of one before the next, then the inside of the core.
struct Section {
    n: usize,
    n_slices: usize,
    rings: Vec<f64>,
}

impl Section {
    fn new(options: &TubeOptions) -> Self {
        Self { n: options.n, n_slices: options.slices + 1, rings: options.ring_radii() }
    }

    fn n_around(&self) -> usize {
        4 * self.n
    }

    /// Points in the order of the ids.
    fn points(&self, options: &TubeOptions) -> Vec<Point> {
        let height = |slice: usize| {
            if slice == options.slices {
                options.length
            } else {
                options.length * slice as f64 / options.slices as f64
            }
        };
        let in_slices = |plane: Vec<[f64; 2]>| {
            (0..self.n_slices).flat_map(move |slice| {
                plane
                    .clone()
                    .into_iter()
                    .map(move |[x, y]| [options.radius * x, options.radius * y, height(slice)])
            })
        };
        let core_rim = self.rings.len() - 1;
        let mut points = Vec::new();
        for (r, &radius) in self.rings.iter().enumerate() {
            // Circles at the wall, blended inward into the outline of the core.
            let share = r.saturating_sub(options.wall_layers) as f64 / options.rings as f64;
            let plane = (0..self.n_around()).map(|around| {
                let square = self.rim_place(around).map(|i| self.even_angle(i));
                if r == core_rim {
                    core_point(square)
                } else {
                    ring_point(square, radius, share, self.rings[options.wall_layers])
                }
            });
            points.extend(in_slices(plane.collect()));
        }
        let inside =
            (0..self.n_inside()).map(|i| core_point(self.inside_place(i).map(|i| self.even_angle(i))));
        points.extend(in_slices(inside.collect()));
        points
    }

    fn even_angle(&self, i: usize) -> f64 {
        super::cubed_sphere::even_angle(i, self.n)
    }

    fn n_inside(&self) -> usize {
        (self.n - 1) * (self.n - 1)
    }

    /// The indices in the grid of the core of its inner vertex `i`.
    fn inside_place(&self, i: usize) -> [usize; 2] {
        [i % (self.n - 1) + 1, i / (self.n - 1) + 1]
    }

    /// The indices in the grid of the core of a vertex on its rim, counter-clockwise from its lower left
    /// corner.
    fn rim_place(&self, around: usize) -> [usize; 2] {
        let (side, i) = (around / self.n % 4, around % self.n);
        match side {
            0 => [i, 0],
            1 => [self.n, i],
            2 => [self.n - i, self.n],
            _ => [0, self.n - i],
        }
    }

    fn on_ring(&self, ring: usize, around: usize, slice: usize) -> VertexId {
        VertexId::new((ring * self.n_slices + slice) * self.n_around() + around % self.n_around())
    }

    /// The vertex of the core at indices in its grid of `(n + 1)^2`.
    fn in_core(&self, [i, j]: [usize; 2], slice: usize) -> VertexId {
        let n = self.n;
        let rim = |around: usize| self.on_ring(self.rings.len() - 1, around, slice);
        match (i, j) {
            (i, 0) => rim(i),
            (i, j) if i == n => rim(n + j),
            (i, j) if j == n => rim(3 * n - i),
            (0, j) => rim(4 * n - j),
            (i, j) => {
                let rings = self.rings.len() * self.n_slices * self.n_around();
                VertexId::new(rings + slice * self.n_inside() + (j - 1) * (n - 1) + i - 1)
            }
        }
    }

    /// The finished cells of the wall, and the hexahedra that are to be split.
    fn cells(&self, options: &TubeOptions) -> (Cells, Cells) {
        let (mut done, mut hexahedra) = (Cells::new(), Cells::new());
        for slice in 0..options.slices {
            for ring in 0..self.rings.len() - 1 {
                let wedges = ring < options.wall_layers && options.wall_cells == WallCells::Wedges;
                for around in 0..self.n_around() {
                    let quad = |ring: usize| {
                        [(0, 0), (1, 0), (1, 1), (0, 1)]
                            .map(|(a, s)| self.on_ring(ring, around + a, slice + s))
                    };
                    // Quads of a ring face outward, so a cell between two rings takes them reversed.
                    if wedges {
                        push_wedges(quad(ring), quad(ring + 1), &mut done);
                    } else {
                        hexahedra.push(
                            CellKind::HEXAHEDRON,
                            reversed(quad(ring)).into_iter().chain(reversed(quad(ring + 1))),
                        );
                    }
                }
            }
            for place in 0..self.n * self.n {
                let (i, j) = (place % self.n, place / self.n);
                let quad = |slice: usize| {
                    [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|place| self.in_core(place, slice))
                };
                hexahedra.push(CellKind::HEXAHEDRON, quad(slice).into_iter().chain(quad(slice + 1)));
            }
        }
        (done, hexahedra)
    }
}

fn reversed([a, b, c, d]: [VertexId; 4]) -> [VertexId; 4] {
    [a, d, c, b]
}

/// Two wedges between an outer quad, facing outward, and an inner one.
fn push_wedges(outer: [VertexId; 4], inner: [VertexId; 4], cells: &mut Cells) {
    for (base, top) in fan_triangles(&outer).zip(fan_triangles(&inner)) {
        let [[a, b, c], [d, e, f]] = [base, top];
        cells.push(CellKind::WEDGE, [a, c, b, d, f, e]);
    }
}

/// The point of the core for a point of the square `[-1, 1]^2`: bent towards a disc.
fn core_point([x, y]: [f64; 2]) -> [f64; 2] {
    let length = x.hypot(y);
    let round = if length > 0.0 { x.abs().max(y.abs()) / length } else { 0.0 };
    let s = CORE * ((1.0 - ROUNDNESS) * FRAC_PI_4.cos() + ROUNDNESS * round);
    [s * x, s * y]
}

/// A point on a ring: on the circle of this radius if `share` is 0, otherwise blended by `share` from the
/// circle of radius `outer` into the core's rim.
fn ring_point(square: [f64; 2], radius: f64, share: f64, outer: f64) -> [f64; 2] {
    let [x, y] = square;
    let circle = |r: f64| [x, y].map(|c| r * c / x.hypot(y));
    if share == 0.0 {
        return circle(radius);
    }
    let ([a, b], [c, d]) = (circle(outer), core_point(square));
    let [x, y, _] = add(scale([a, b, 0.0], 1.0 - share), scale([c, d, 0.0], share));
    [x, y]
}
