//! Gaps by the Delaunay tets that span them, as Moyle and Ventikos (2008) measure them: quick to keep, and an upper bound.
//!
//! The vertices of all bodies are triangulated; a tet whose vertices belong to more than one body spans a gap, and says how near
//! these bodies come in it: by two edges (two-two) or by a facet and a vertex (three-one).
//!
//! **What is exact.** The least distance between two *vertices* of different bodies ([`Between::nearest_vertices`]): no third vertex lies in
//! the ball whose diameter they are, since it would be nearer to the one of them that is of another body, so they are joined by an
//! edge of every Delaunay triangulation.
//!
//! **What is a bound.** Everything else is the distance between points that do lie on the surfaces, hence never too small, but
//! the nearest triangle need not be in a tet with the vertex, so it may be too large. The text of 2008 takes every edge and facet of a tet for a
//! part of the surfaces, also chords across dents, and may thus be too small as well; here those that are not edges or
//! triangles of the surface are left out. How much is lost is measured by `examples/contact_delaunay.rs`. The exact answer takes a
//! tree of boxes; this one gives what a tree does not: the tets of the gap, and a graph that moves along.

mod measure;
pub mod paper;
mod side;
mod simplices;
mod sites;

pub use side::Side;

use crate::base::{Csr, Error, Id, Point, Result, Threads, VertexId};
use crate::geometry::vector::{distance, sub};
use measure::{Pair, Part, nearest};
use side::starts_on;
use sites::{NO_SITE, Sites};

/// What a tet is by the bodies that its vertices belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GapKind {
    /// Two vertices of one body and two of another.
    TwoTwo,
    /// Three vertices of one body and one of another.
    ThreeOne,
    /// Two vertices of one body, and one each of two others.
    TwoOneOne,
    /// Vertices of four bodies.
    Ones,
    /// A vertex is in two bodies, or two bodies have a vertex in one place: their distance is 0 there.
    Touching,
    /// All vertices are in one plane or line, so there are triangles or segments in place of tets.
    Flat,
    /// All vertices of one body: no gap, and never in the list.
    Four,
}

/// A tet that spans a gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapTet {
    /// The body with most vertices first: the edges of a two-two, or the facet and the lone vertex of a three-one; not oriented. In a
    /// [`GapKind::Flat`] one the last is [`Id::NONE`], or the last two.
    pub vertices: [VertexId; 4],
    /// What it is.
    pub kind: GapKind,
    /// The two bodies that come nearest in it, the smaller first.
    pub bodies: [u32; 2],
    /// How near they come in it; infinite where the way from one to the other is on a side that does not count.
    pub distance: f64,
}

/// Where two bodies come nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Least {
    /// How near.
    pub distance: f64,
    /// Which, the smaller first.
    pub bodies: [u32; 2],
    /// The point on each.
    pub points: [Point; 2],
}

/// Two vertices of different bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VertexPair {
    /// How far apart.
    pub distance: f64,
    /// The bodies, the smaller first.
    pub bodies: [u32; 2],
    /// The vertex of each.
    pub vertices: [VertexId; 2],
}

/// What [`Between::new`] is told.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BetweenOptions {
    /// On which side of each body its gaps are; bodies past the end have [`Side::Both`]. Default: none given. With a side, a pair of
    /// points counts only if the way between them starts on that side at both ends, as told by the triangles there: so nothing
    /// is measured through the wall of a thin body.
    pub sides: Vec<Side>,
}

/// The gaps between bodies, by the Delaunay tets of their vertices.
#[derive(Clone, Debug)]
pub struct Between {
    /// The tets that span gaps.
    pub tets: Vec<GapTet>,
    /// For each point how far it is from the features of other bodies that share a tet with it: an upper bound of its distance; infinite
    /// where there are none, and for points that no body uses.
    pub gap: Vec<f64>,
    /// For each point the vertex of another body that is nearest to where its gap ends; [`Id::NONE`] where the gap is infinite.
    pub closest: Vec<VertexId>,
    /// Where two bodies come nearest, over all tets: an upper bound; `None` where no tet spans a gap.
    pub least: Option<Least>,
    /// The nearest two vertices of different bodies, whatever the sides: exact after [`Between::new`].
    pub nearest_vertices: Option<VertexPair>,
    /// How many tets have all vertices of one body.
    pub n_of_one_body: usize,
    sides: Vec<Side>,
    sites: Sites,
    /// The gap tets as sites, and the gap tets at each site.
    simplices: Vec<[u32; 4]>,
    at_site: Csr<u32>,
}

impl Between {
    /// Triangulates the vertices of all bodies and measures the tets that span gaps. Each body is triangles over the same points; bodies may
    /// touch and share vertices, be open or closed, in one plane or a single point. One body alone has no gaps. The
    /// result is the same for any number of threads.
    ///
    /// # Errors
    /// When there is no body, when one is empty, when a triangle names a point that is not there, or a point is not finite.
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
        let (kinds, simplices): (Vec<GapKind>, Vec<[u32; 4]>) =
            classified.into_iter().filter(|(kind, _)| spans(*kind)).unzip();
        let vertex = |site: u32| sites.owners(site).first().map_or(VertexId::NONE, |owner| owner.1);
        let unmeasured = |(kind, tet): (&GapKind, &[u32; 4])| GapTet {
            vertices: tet.map(vertex),
            kind: *kind,
            bodies: [0; 2],
            distance: f64::INFINITY,
        };
        let sides = (0..bodies.len()).map(|b| options.sides.get(b).copied().unwrap_or_default());
        let at_site = Csr::from_pairs(used.len(), || {
            (0..)
                .zip(&simplices)
                .flat_map(|(t, tet)| tet.iter().filter(|&&s| s != NO_SITE).map(move |&s| (s as usize, t)))
        });
        let mut between = Self {
            tets: kinds.iter().zip(&simplices).map(unmeasured).collect(),
            gap: Vec::new(),
            closest: Vec::new(),
            least: None,
            nearest_vertices: None,
            n_of_one_body: n_tets - kinds.len(),
            sides: sides.collect(),
            sites,
            simplices,
            at_site,
        };
        between.measure(points, threads);
        Ok(between)
    }

    /// Measures the same tets with points that moved: much less work than [`Between::new`], which makes it the handle to keep over
    /// the steps of a simulation. No tet is exchanged, so what is near must be in a tet with what it was near to before:
    /// all distances, that of the nearest vertices too, are then upper bounds, and looser the farther things move along each other.
    ///
    /// # Errors
    /// When there is another number of points, or one that a body uses is not finite.
    pub fn update(&mut self, points: &[Point], threads: &Threads) -> Result<()> {
        if points.len() != self.gap.len() {
            let (had, has) = (self.gap.len(), points.len());
            return Err(Error::input(format!("{has} points, where {had} were triangulated"))
                .remedy("measure a surface with other vertices anew"));
        }
        sites::check_finite(points, self.sites.vertices.iter().map(|(_, v, _)| *v))?;
        self.measure(points, threads);
        Ok(())
    }

    /// How many bodies there are.
    pub fn n_bodies(&self) -> usize {
        self.sites.n_bodies()
    }

    fn measure(&mut self, points: &[Point], threads: &Threads) {
        let measured = threads.map(self.simplices.len(), |t| self.tet(self.simplices[t], points));
        let vertices =
            threads.map(self.sites.vertices.len(), |i| self.vertex(self.sites.vertices[i], points));
        (self.least, self.nearest_vertices) = (None, None);
        for (tet, (least, pair)) in self.tets.iter_mut().zip(measured) {
            (tet.bodies, tet.distance) = least.map_or(([0; 2], f64::INFINITY), |l| (l.bodies, l.distance));
            keep_nearer(&mut self.least, least, |l| l.distance);
            keep_nearer(&mut self.nearest_vertices, pair, |p| p.distance);
        }
        self.gap = vec![f64::INFINITY; points.len()];
        self.closest = vec![VertexId::NONE; points.len()];
        for (&(body, v, _), (gap, other)) in self.sites.vertices.iter().zip(vertices) {
            if gap < self.gap[v.index()] {
                (self.gap[v.index()], self.closest[v.index()]) = (gap, other.1);
            }
            // Bodies that touch where no tet is have no other witness.
            if other.1 != VertexId::NONE && self.simplices.is_empty() {
                let own = (body, v);
                let [first, second] = if own.0 < other.0 { [own, other] } else { [other, own] };
                let bodies = [first.0, second.0];
                let pair = VertexPair { distance: gap, bodies, vertices: [first.1, second.1] };
                let least = Least { distance: gap, bodies, points: pair.vertices.map(|v| points[v.index()]) };
                keep_nearer(&mut self.least, Some(least), |l| l.distance);
                keep_nearer(&mut self.nearest_vertices, Some(pair), |p| p.distance);
            }
        }
    }

    /// Where two bodies come nearest in a tet, and the nearest two vertices of different bodies.
    fn tet(&self, tet: [u32; 4], points: &[Point]) -> (Option<Least>, Option<VertexPair>) {
        let parts = self.parts(tet, points);
        let (mut least, mut nearest_vertices) = (None, None);
        for (i, b) in parts.iter().enumerate() {
            for a in &parts[..i] {
                let pair = nearest(a, b, &self.sites);
                let bodies = [a.body, b.body];
                if self.counts(a, b, &pair, points) {
                    let found = Least {
                        distance: pair.distance_squared.sqrt(),
                        bodies,
                        points: [a.at(&pair.on_a), b.at(&pair.on_b)],
                    };
                    keep_nearer(&mut least, Some(found), |l| l.distance);
                }
                let real = |part: &Part| {
                    part.vertices.into_iter().filter(|&v| v != VertexId::NONE).collect::<Vec<_>>()
                };
                for &v in &real(a) {
                    for &w in &real(b) {
                        let distance = distance(points[v.index()], points[w.index()]);
                        let found = VertexPair { distance, bodies, vertices: [v, w] };
                        keep_nearer(&mut nearest_vertices, Some(found), |p| p.distance);
                    }
                }
            }
        }
        (least, nearest_vertices)
    }

    /// The gap of a vertex of a body, and the nearest vertex there with its body.
    fn vertex(&self, (body, v, site): (u32, VertexId, u32), points: &[Point]) -> (f64, (u32, VertexId)) {
        let first = self.sites.vertex(site, body);
        let mut best = (f64::INFINITY, (u32::MAX, VertexId::NONE));
        for &owner in self.sites.owners(site).iter().filter(|owner| owner.0 != body) {
            let between = distance(points[first.index()], points[owner.1.index()]);
            if between < best.0 {
                best = (between, owner);
            }
        }
        for &t in self.at_site.list(site as usize) {
            let tet = self.simplices[t as usize];
            let parts = self.parts(tet, points);
            let place = tet.iter().position(|&s| s == site).unwrap_or(0);
            let Some(own) = parts.iter().find(|part| part.body == body).map(|part| part.vertex(place)) else {
                continue;
            };
            for other in parts.iter().filter(|part| part.body != body) {
                let pair = nearest(&own, other, &self.sites);
                let gap = pair.distance_squared.sqrt();
                if gap < best.0 && self.counts(&own, other, &pair, points) {
                    let heaviest = (1..4).fold(0, |m, i| if pair.on_b[i] > pair.on_b[m] { i } else { m });
                    best = (gap, (other.body, other.vertices[heaviest]));
                }
            }
        }
        // Vertices of one body in one place are measured once; should they part, this stays a bound.
        (best.0 + distance(points[v.index()], points[first.index()]), best.1)
    }

    /// What each body has of a tet, by body.
    fn parts(&self, tet: [u32; 4], points: &[Point]) -> Vec<Part> {
        let mut bodies: Vec<u32> = Vec::with_capacity(4);
        for site in tet {
            bodies.extend(self.sites.owners(site).iter().map(|owner| owner.0));
        }
        bodies.sort_unstable();
        bodies.dedup();
        bodies.into_iter().map(|body| Part::new(tet, body, &self.sites, points)).collect()
    }

    /// Whether the way between two points is on the side that counts, at both ends.
    fn counts(&self, a: &Part, b: &Part, pair: &Pair, points: &[Point]) -> bool {
        let [on_a, on_b] = [a, b].map(|part| self.sides[part.body as usize]);
        if [on_a, on_b] == [Side::Both; 2] {
            return true;
        }
        let way = sub(b.at(&pair.on_b), a.at(&pair.on_a));
        starts_on(on_a, a, &pair.on_a, way, &self.sites, points)
            && starts_on(on_b, b, &pair.on_b, sub([0.0; 3], way), &self.sites, points)
    }
}

/// Takes the new one where it is nearer; of two as near the first stays.
fn keep_nearer<T>(best: &mut Option<T>, new: Option<T>, distance: impl Fn(&T) -> f64) {
    if let Some(new) = new
        && best.as_ref().is_none_or(|best| distance(&new) < distance(best))
    {
        *best = Some(new);
    }
}
