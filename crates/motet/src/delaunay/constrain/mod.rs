//! Constrained Delaunay: tets that have every triangle of given surfaces among their facets.
//!
//! | step | file | how |
//! |---|---|---|
//! | start | here | the Delaunay triangulation of all vertices, within a large box |
//! | edges | `edges`, `path`, `swap`, `split` | a missing edge of the surface is recovered by swaps of tets; where no swap helps, a point is put on it |
//! | facets | `facets`, `pierce`, `cut`, `wrap` | a missing triangle is recovered by swaps; or the tets that it cuts are removed and both hollows are refilled; or points are put in it |
//! | sweeps | `present` | which edges and facets the tets have, found on all threads |
//! | bodies | `bodies` | the bodies that the surfaces separate |
//! | surface | `repair`, `restore`, `refill`, `grow` | points on edges and in triangles are moved inside |
//!
//! At first, triangles in one plane form one flat facet (`flats`). Where such a facet does not come out with
//! its given triangles, or comes out with tets that have no volume in the digits of their coordinates,
//! everything starts again (`attempts`): next with triangles joined there that are coplanar up to the
//! rounding of their coordinates (`geometry::rounding`), whose flat tets are assigned to the outside
//! (`shed`), and finally with each triangle on its own (`levels`). The best attempt is taken. Flat tets
//! inside are replaced (`flat_tets`).
//!
//! Where points stay on edges ([`EdgePoints::Stay`]), nothing is swapped: `segments` divides edges until all
//! their pieces are Delaunay. Once all edges are present the constrained Delaunay triangulation exists
//! (Shewchuk 1998, *A condition guaranteeing the existence of higher-dimensional constrained Delaunay
//! triangulations*), so no facet needs a point inside it.
//!
//! *Signs.* A point on an edge generally has no exact coordinates in `f64`. It is stored as a fraction of the
//! way between two vertices, and signs are exact for such points (`geometry::predicates::spot`): nothing here
//! has a tolerance, and surfaces may come as close to each other as coordinates allow. Diazzi, Panozzo,
//! Vaxman and Attene (2023, *Constrained Delaunay tetrahedrization: a robust and practical approach*) were
//! the first to do this.
//!
//! *Ties* are broken by the same infinitesimal lifts everywhere, those of the triangulation of the points: so
//! the result depends on the input only, and theorems on points in general position hold for grids too.

mod attempts;
mod bodies;
mod cut;
mod edges;
mod facets;
mod finish;
mod flat_tets;
mod flatness;
mod flats;
mod grow;
mod grown;
mod hollow;
mod insert;
mod levels;
mod path;
mod pierce;
mod plane;
mod present;
mod recovery;
mod refill;
mod repair;
mod restore;
mod segments;
mod share;
mod shed;
mod sides;
mod sites;
mod split;
mod swap;
mod wrap;

use hashbrown::HashSet;

use super::Triangulation;
use super::input::{self, Scaled};
use crate::base::{Csr, Error, Point, Result, Threads, VertexId, sorted_ids};
use crate::geometry::rounding;
use crate::geometry::tet::EDGES;
use crate::geometry::vector::{add, distance, scale};
use crate::kernel::Tets;
use crate::mesh::bounds;
use bodies::Bodies;
use edges::Edges;
use flats::FlatFacets;
use grown::GrownFacets;
use recovery::{Order, Unrecovered};
use repair::{Repaired, SurfaceRepair};
use segments::Segments;
use sites::Sites;

/// The box around all points is larger than their own by this factor: at this distance it hardly makes an
/// edge less Delaunay.
const BOX: f64 = 8.0;

/// Axes along which the points are shorter than this fraction of the longest axis are stretched.
const SHORT: f64 = 1.0 / 32.0;

/// The tet around everything, needed to fill hollows, is larger than the box by this factor.
const FAR: f64 = 4096.0;

/// A point that was put on an edge of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointOnEdge {
    /// The ends of the edge.
    pub ends: [VertexId; 2],
    /// The fraction of the way from the first end to the second, in (0, 1), rounded. The point is `first +
    /// share (second - first)`.
    pub share: f64,
}

/// A point that was put in a triangle of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointInTriangle {
    /// The triangle's number.
    pub triangle: u32,
    /// Fractions `s` and `t` of the ways from the triangle's first corner to the others; the exact point is
    /// `first + s (second - first) + t (third - first)`.
    pub shares: [f64; 2],
}

/// Tets that have every triangle of the surfaces among their facets. Where points stay on edges
/// ([`EdgePoints::Stay`]), no vertex visible from a tet lies inside its circumsphere.
#[derive(Clone, Debug)]
pub struct Constrained {
    /// The points as given, then points on edges and in triangles, rounded, then points inside.
    pub points: Vec<Point>,
    /// The definitions of the points on edges.
    pub on_edges: Vec<PointOnEdge>,
    /// The definitions of the points in triangles; empty where points stay on edges.
    pub in_triangles: Vec<PointInTriangle>,
    /// The tets within the surfaces, positively oriented before points were rounded.
    pub tets: Vec<[VertexId; 4]>,
    /// The body of each tet, from 0; a body is a set of tets connected without crossing a surface.
    pub bodies: Vec<u32>,
    /// The facets that each triangle became, oriented like it; just the triangle itself, except where points
    /// stay on its edges.
    pub triangle_to_facets: Csr<[VertexId; 3]>,
    /// The bodies in front of each triangle and behind it; `None` is the outside. A triangle is seen
    /// counter-clockwise from its front.
    pub triangle_to_bodies: Vec<[Option<u32>; 2]>,
}

/// What becomes of points that had to be put on edges of the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EdgePoints {
    /// They move inside, so that every triangle is a facet as given. A point stays where there is no space
    /// for it inside.
    #[default]
    MoveInside,
    /// They stay: the tets are constrained Delaunay.
    Stay,
}

/// Fills closed surfaces with tets. Points used by triangles must be distinct, and triangles may meet only in
/// vertices and edges that they share. Surfaces may be nested, share triangles (given once) or have open
/// edges inside others.
///
/// # Errors
/// When a coordinate is not finite, when points used by triangles coincide or do not exist, when triangles
/// meet in more than they share (where this is noticed: a check beforehand lists all such places), or when
/// edges would have to be divided beyond the precision of their coordinates, or too often.
pub fn constrain(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    edge_points: EdgePoints,
    threads: &Threads,
) -> Result<Constrained> {
    input::check(points)?;
    check_ids(points, triangles)?;
    let (mut given, back) = in_box(points, edge_points)?;
    let (triangulation, sorted) = Triangulation::ordered(&given, threads)?;
    check_distinct(&triangulation, triangles)?;
    given.extend(far_around(&given));
    let moves = edge_points == EdgePoints::MoveInside;
    let fill = |flats: &FlatFacets, order: &Order<'_>| {
        let n_vertices = triangulation.points().len();
        let tets = Tets::from_neighbors(triangulation.tets(), triangulation.neighbors(), n_vertices, threads);
        let sites = Sites::new(given.clone(), &sorted);
        Filled::new(tets, sites, points.len(), triangles, flats.clone(), edge_points, order)
    };
    let sites = Sites::new(given.clone(), &sorted);
    let filled = if moves {
        attempts::best(&sites, triangles, back.rounding(rounding::of(points)), threads, fill)?
    } else {
        let flats = FlatFacets::of_each(triangles);
        Order::with_retries(0, threads, |order| fill(&flats, order))
            .map_err(|unrecovered| unrecovered.error)?
    };
    Ok(filled.finish(points, triangles, back, threads))
}

/// Returns the number of the flat facet of each triangle: connected triangles that lie in one plane, exactly
/// or up to a `rounding` of each coordinate, have the same number. Points must be finite, and each triangle
/// must name three different ones.
pub(crate) fn flat_facets(points: &[Point], triangles: &[[VertexId; 3]], rounding: f64) -> Vec<u32> {
    GrownFacets::find(&Sites::new(points.to_vec(), &[]), triangles, [rounding; 3]).number
}

fn check_ids(points: &[Point], triangles: &[[VertexId; 3]]) -> Result<()> {
    let is_off = |t: &[VertexId; 3]| {
        t.iter().any(|v| v.index() >= points.len()) || t[0] == t[1] || t[1] == t[2] || t[2] == t[0]
    };
    let Some(i) = triangles.iter().position(is_off) else { return Ok(()) };
    let what = format!(
        "refers to points {:?}, expected three different ids below {}",
        triangles[i].map(|v| v.0),
        points.len()
    );
    Err(Error::input(what).at(format!("triangle {i}")))
}

fn check_distinct(triangulation: &Triangulation, triangles: &[[VertexId; 3]]) -> Result<()> {
    let duplicates = triangulation.duplicates();
    let find = |v: &VertexId| duplicates.binary_search_by_key(v, |d| d.0).ok();
    let mut used = triangles.iter().enumerate().flat_map(|(i, t)| t.iter().map(move |v| (i, v)));
    let Some((i, d)) = used.find_map(|(i, v)| find(v).map(|d| (i, d))) else { return Ok(()) };
    let (a, b) = duplicates[d];
    Err(Error::input(format!("the points {a} and {b} coincide"))
        .at(format!("triangle {i}"))
        .remedy("merge points that coincide"))
}

/// Scales points back to their original scale.
#[derive(Clone, Copy)]
struct Back {
    all: [f64; 2],
    by_axis: Point,
}

impl Back {
    /// Converts a length into the scaled coordinates, along each axis.
    fn rounding(&self, length: f64) -> Point {
        std::array::from_fn(|i| length / (self.by_axis[i] * self.all[0] * self.all[1]))
    }

    fn of(&self, p: Point) -> Point {
        std::array::from_fn(|i| p[i] * self.by_axis[i] * self.all[0] * self.all[1])
    }
}

/// Scales the points by powers of two and adds the corners of a box far around them; also returns how to
/// scale back.
///
/// Where points need not be Delaunay in the end, axes along which the whole is far shorter are stretched:
/// otherwise the first tets of something flat or long would cross its surface everywhere.
fn in_box(points: &[Point], edge_points: EdgePoints) -> Result<(Vec<Point>, Back)> {
    let Scaled { points: mut given, back, .. } = input::scaled(points.to_vec());
    let extent = |[low, high]: [Point; 2]| -> Point { std::array::from_fn(|i| high[i] - low[i]) };
    let size = extent(bounds(&given).unwrap_or_default());
    let largest = size.into_iter().fold(0.0, f64::max);
    let is_far_shorter =
        |size: f64| size > 0.0 && size < SHORT * largest && edge_points == EdgePoints::MoveInside;
    let stretch =
        size.map(
            |size| if is_far_shorter(size) { 2f64.powi((largest / size).log2().floor() as i32) } else { 1.0 },
        );
    given.iter_mut().for_each(|p| (0..3).for_each(|i| p[i] *= stretch[i]));
    let [low, high] = bounds(&given).unwrap_or_default();
    let away = BOX * extent([low, high]).into_iter().fold(0.0, f64::max);
    for k in 0..8 {
        given.push(std::array::from_fn(|i| if k >> i & 1 == 0 { low[i] - away } else { high[i] + away }));
    }
    if away > 0.0 && (away * FAR).is_finite() && given.as_flattened().iter().all(|x| x.is_finite()) {
        return Ok((given, Back { all: back, by_axis: stretch.map(f64::recip) }));
    }
    Err(Error::input("the points have no extent, or one beyond the range of floating-point numbers")
        .remedy("rescale the surfaces"))
}

/// The corners of a positive tet that contains the box of the last eight points, and is far larger.
fn far_around(given: &[Point]) -> [Point; 4] {
    let [low, high] = [given[given.len() - 8], given[given.len() - 1]];
    let (middle, size) = (scale(add(low, high), 0.5), FAR * distance(low, high));
    let corners = [[1.0, 1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [-1.0, -1.0, 1.0]];
    corners.map(|corner| add(middle, scale(corner, size)))
}

/// The state of one attempt once everything has been made.
struct Filled {
    tets: Tets,
    sites: Sites,
    segments: Segments,
    flats: FlatFacets,
    bodies: Bodies,
    /// The surface. Tets without volume are not looked for where points stay on edges.
    surface: Repaired,
}

impl Filled {
    fn new(
        mut tets: Tets,
        mut sites: Sites,
        n_points: usize,
        triangles: &[[VertexId; 3]],
        flats: FlatFacets,
        edge_points: EdgePoints,
        order: &Order<'_>,
    ) -> Result<Self, Unrecovered> {
        let is_kept = edge_points == EdgePoints::MoveInside;
        let mut segments = Segments::new(flats.creases.clone());
        if is_kept {
            Edges::new(&mut tets, &mut sites, &mut segments).recover(order)?;
        } else {
            segments.recover(&mut tets, &mut sites, order.threads)?;
        }
        let parts = facets::recover(&mut tets, &mut sites, &segments, triangles, &flats, is_kept, order)?;
        let mut bodies = Bodies::find(&tets, &flats, &parts, VertexId::new(n_points), order.threads)?;
        let surface = if is_kept {
            let keep = SurfaceRepair::new(&mut tets, &mut sites, &mut bodies, triangles, &flats, &parts);
            keep.run(&segments, order.threads)?
        } else {
            Repaired { parts, ..Repaired::default() }
        };
        Ok(Self { tets, sites, segments, flats, bodies, surface })
    }

    /// The number of facets in excess of the number of triangles.
    fn n_in_pieces(&self) -> usize {
        let n: usize = self.flats.triangles.iter().map(<[u32]>::len).sum();
        self.surface.parts.items().len().saturating_sub(n)
    }

    /// The triangles that are in pieces, in flat facets whose triangles differ from those given, or at tets
    /// without volume.
    fn failed(&self, triangles: &[[VertexId; 3]]) -> Vec<u32> {
        let in_pieces =
            |flat: usize| self.surface.parts.list(flat).len() != self.flats.triangles.list(flat).len();
        let all = (0..self.flats.triangles.len()).filter(|&flat| in_pieces(flat));
        let all = all.chain(self.surface.unrestored.iter().map(|&flat| flat as usize));
        let mut failed: Vec<u32> =
            all.flat_map(|flat| self.flats.triangles.list(flat).iter().copied()).collect();
        let edges: HashSet<[VertexId; 2]> = self
            .surface
            .flat_tets
            .iter()
            .flat_map(|v| EDGES.map(|[i, j]| sorted_ids([v[i], v[j]])))
            .collect();
        let is_at_flat_tet = |[a, b, c]: [VertexId; 3]| {
            [[a, b], [b, c], [c, a]].iter().any(|e| edges.contains(&sorted_ids(*e)))
        };
        failed.extend((0..triangles.len() as u32).filter(|&i| is_at_flat_tet(triangles[i as usize])));
        failed
    }
}
