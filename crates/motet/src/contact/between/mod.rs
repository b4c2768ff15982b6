//! Gaps measured by the Delaunay tets that span them, as in Moyle and Ventikos (2008): cheap to update, and
//! an upper bound.
//!
//! The vertices of all bodies are triangulated. A tet whose vertices belong to more than one body spans a
//! gap, and gives the distance of these bodies within it: of two edges (two-two), or of a facet and a vertex
//! (three-one).
//!
//! **What is exact.** The least distance between two *vertices* of different bodies
//! ([`Between::nearest_vertices`]): no third vertex lies in the ball that has them as a diameter, since it
//! would be nearer to the one of them that is of another body, so every Delaunay triangulation joins them by
//! an edge.
//!
//! **What is a bound.** Everything else is the distance between points that do lie on the surfaces, hence
//! never too small. But the nearest triangle need not be in a tet with the vertex, so it may be too large.
//! The paper of 2008 takes every edge and facet of a tet for a part of the surfaces, even chords across
//! dents, so its distances may be too small as well; here, those that are not edges or triangles of the
//! surface are left out. The exact answer comes from a tree of boxes; this module gives what a tree does not:
//! the tets of the gap, and a graph that moves along.
//!
//! **How good the bound is**, for a stent lattice in a tube (78,000 vertices), by
//! `examples/contact_delaunay.rs`, which has more pairs. 24 % of the vertices have no gap tet, and 33 % their
//! exact distance. Of those that have a gap tet, the median is 0.04 % too large, one in twenty more than
//! 16 %, and the worst 134 %. Of the tenth that is nearest to the other surface all have one, and the worst
//! is 33 % too large; with `stars` all of these are exact. The least distance of all was off by 0 to 0.8 %
//! over nine pairs. The paper's rule for two edges is too large in 43 % of the lattice's two-two tets, by up
//! to 88 %. Building takes 0.6 s and an update 0.27 s, on one thread of a busy machine, on which the tree
//! computes the exact distances of all vertices from scratch in 0.1 s.

mod gaps;
mod measure;
pub mod paper;
mod side;
mod simplices;
mod sites;

use super::input::check_finite;
use super::side::Side;
use crate::base::{BodyId, Csr, Error, MaybeId, Point, Result, Threads, VertexId};
use simplices::Simplex;
use sites::{SiteId, Sites};

/// The kind of a tet, by the bodies that its vertices belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GapKind {
    /// Two vertices of one body and two of another.
    TwoTwo,
    /// Three vertices of one body and one of another.
    ThreeOne,
    /// Two vertices of one body, and one each of two others.
    TwoOneOne,
    /// Vertices of four bodies, one each.
    Ones,
    /// A vertex belongs to two bodies, or two bodies have a vertex at one place: their distance is 0 there.
    Touching,
    /// All vertices of all bodies are in one plane or on one line, so there are triangles or segments instead
    /// of tets.
    Flat,
    /// All vertices belong to one body: no gap, and never in the list.
    Four,
}

/// A tet that spans a gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapTet {
    /// The vertices, those of the body with most of them first: the two edges of a two-two, or the facet and
    /// the lone vertex of a three-one; not oriented. In a [`GapKind::Flat`] one the last is none, or the last
    /// two are.
    pub vertices: [MaybeId<VertexId>; 4],
    /// Which vertices of the tet belong to which bodies.
    pub kind: GapKind,
    /// The two bodies that come nearest in it, the smaller first.
    pub bodies: [BodyId; 2],
    /// How near they come in it; infinite if the line from one to the other is on a side that does not count.
    pub distance: f64,
}

impl GapTet {
    /// All four vertices; `None` for a [flat](GapKind::Flat) one.
    pub fn corners(&self) -> Option<[VertexId; 4]> {
        let [a, b, c, d] = self.vertices.map(MaybeId::get);
        Some([a?, b?, c?, d?])
    }
}

/// Where two bodies come nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Least {
    /// Their distance.
    pub distance: f64,
    /// The bodies, the smaller first.
    pub bodies: [BodyId; 2],
    /// The point on each.
    pub points: [Point; 2],
}

/// Two vertices of different bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexPair {
    /// Their distance.
    pub distance: f64,
    /// The bodies, the smaller first.
    pub bodies: [BodyId; 2],
    /// The vertex of each.
    pub vertices: [VertexId; 2],
}

/// Options of [`Between::new`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BetweenOptions {
    /// On which side of each body its gaps are; bodies past the end have [`Side::Both`]. Empty by default.
    /// With a side, a pair of points counts only if the line between them starts on that side at both ends,
    /// according to the triangles there: so nothing is measured through the wall of a thin body.
    pub sides: Vec<Side>,
    /// Whether a vertex is also measured against all triangles around the vertices that share a tet with it:
    /// nearer to the truth, and slower; see the table that `examples/contact_delaunay.rs` prints. Off by
    /// default, as in the paper of 2008.
    pub stars: bool,
}

/// The gaps between bodies, by the Delaunay tets of their vertices.
#[derive(Clone, Debug)]
pub struct Between {
    /// The tets that span gaps.
    pub tets: Vec<GapTet>,
    /// For each point, its distance from the features of other bodies that share a tet with it: an upper
    /// bound of its distance to these bodies; infinite if there are none, and for points that no body uses.
    pub gap: Vec<f64>,
    /// For each point, the vertex of another body that is nearest to where its gap ends; none if the gap
    /// is infinite.
    pub closest: Vec<MaybeId<VertexId>>,
    /// Where two bodies come nearest, over all tets: an upper bound; `None` if no tet spans a gap.
    pub least: Option<Least>,
    /// The nearest two vertices of different bodies, regardless of the sides: exact after [`Between::new`].
    pub nearest_vertices: Option<VertexPair>,
    /// How many tets have all vertices in one body.
    pub n_of_one_body: usize,
    sides: Vec<Side>,
    stars: bool,
    sites: Sites,
    /// The gap tets as sites, and the gap tets at each site.
    simplices: Vec<Simplex>,
    at_site: Csr<u32>,
}

impl Between {
    /// Triangulates the vertices of all bodies and measures the tets that span gaps. Each body is a list of
    /// triangles over the same points. Bodies may touch and share vertices, be open or closed, or lie in one
    /// plane or at a single point. One body alone has no gaps. The result does not depend on the number of
    /// threads.
    ///
    /// # Errors
    /// When there is no body, when one is empty, when a triangle names a point that does not exist, or a
    /// point is not finite.
    pub fn new(
        points: &[Point],
        bodies: &[Vec<[VertexId; 3]>],
        options: &BetweenOptions,
        threads: &Threads,
    ) -> Result<Self> {
        let used = sites::used_vertices(points, bodies)?;
        let own: Vec<Point> = used.iter().map(|v| points[v.index()]).collect();
        let found = simplices::simplices(&own, threads)?;
        let sites = Sites::new(points.len(), &used, &found.duplicates, bodies);
        let classified = threads.map(found.tets.len(), |t| simplices::classified(found.tets[t], &sites));
        let spans = |kind: GapKind| kind != GapKind::Four;
        let n_tets = classified.len();
        let (kinds, simplices): (Vec<GapKind>, Vec<Simplex>) =
            classified.into_iter().filter(|(kind, _)| spans(*kind)).unzip();
        let vertex = |site: MaybeId<SiteId>| -> MaybeId<VertexId> {
            sites.owners(site).first().map(|owner| owner.vertex).into()
        };
        let unmeasured = |(kind, tet): (&GapKind, &Simplex)| GapTet {
            vertices: tet.map(vertex),
            kind: *kind,
            bodies: [BodyId(0); 2],
            distance: f64::INFINITY,
        };
        let sides = (0..bodies.len()).map(|b| options.sides.get(b).copied().unwrap_or_default());
        let at_site = Csr::from_pairs(used.len(), || {
            (0..)
                .zip(&simplices)
                .flat_map(|(t, tet)| tet.iter().filter_map(|s| s.get()).map(move |s| (s.index(), t)))
        });
        let mut between = Self {
            tets: kinds.iter().zip(&simplices).map(unmeasured).collect(),
            gap: Vec::new(),
            closest: Vec::new(),
            least: None,
            nearest_vertices: None,
            n_of_one_body: n_tets - kinds.len(),
            sides: sides.collect(),
            stars: options.stars,
            sites,
            simplices,
            at_site,
        };
        between.measure(points, threads);
        Ok(between)
    }

    /// Measures the same tets with points that moved: much less work than [`Between::new`], so this is the
    /// handle to keep over the steps of a simulation. The tets stay the same, so a vertex is measured only
    /// against what it shared a tet with before: all distances, including that of the nearest vertices, are
    /// then upper bounds, and looser the farther bodies move along each other.
    ///
    /// # Errors
    /// When the number of points is different, or a point that a body uses is not finite.
    pub fn update(&mut self, points: &[Point], threads: &Threads) -> Result<()> {
        if points.len() != self.gap.len() {
            let (had, has) = (self.gap.len(), points.len());
            return Err(Error::input(format!("got {has} points, but {had} were triangulated"))
                .remedy("build a new measurement for surfaces with other vertices"));
        }
        check_finite("the bodies", self.sites.vertices.iter().map(|of| of.vertex), points)?;
        self.measure(points, threads);
        Ok(())
    }

    /// How many bodies there are.
    pub fn n_bodies(&self) -> usize {
        self.sites.n_bodies()
    }
}
