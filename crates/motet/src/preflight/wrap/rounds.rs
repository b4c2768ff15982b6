//! Adds sites, round by round, until no facet strays and no given triangle is far from all facets.

use hashbrown::HashMap;

use super::facets::{Facet, Known, N_AROUND, facets};
use super::field::Field;
use super::seeds::{Creases, apart};
use super::spaced::Spaced;
use super::{Fate, Wrapped};
use crate::base::{DisjointSets, MaybeId, Point, Result, Threads, VertexId, sorted_ids};
use crate::geometry::triangle::{self, centroid, middles};
use crate::geometry::vector::{add, cross, distance, is_finite, scale, sub, unit};
use crate::mesh::{cone_volume, largest_extent};
use crate::spatial::{NearestTriangle, bounding_box};

/// Sites are not nearer than this to each other, over the allowed distance.
const LEAST_OVER_DISTANCE: f64 = 0.25;

/// Facets may stray this far, over the allowed distance: between the places where that is measured it is
/// more.
const STRAY_OVER_DISTANCE: f64 = 0.5;

/// Facets across holes may stray this far from where the inside ends, over their longest side: that is known
/// to the accuracy of winding numbers alone, and finer facets would follow the error.
const AT_HOLE: f64 = 0.1;

/// Given triangles farther than this from all facets need sites, over the allowed distance.
const FAR_OVER_DISTANCE: f64 = 0.8;

/// A facet is narrow if the radius around its sites is larger than this multiple of its shortest edge.
const NARROW: f64 = 1.5;

/// Narrow facets are divided if the radius is larger than this multiple of the allowed distance.
const NARROW_OVER_DISTANCE: f64 = 2.0;

/// A new site moves onto a crease nearer than this, over its distance from other sites.
const ONTO_CREASE: f64 = 0.5;

/// New sites of one round are at least this far apart, over their distance from other sites.
const APART: f64 = 0.7;

/// The distance of places on given triangles where it is first measured how far these are, over the allowed
/// distance; halved wherever they are far.
const SAMPLES_OVER_DISTANCE: f64 = 16.0;
const LEAST_SAMPLES_OVER_DISTANCE: f64 = 1.0;

/// How far beside a given triangle its sides are looked at, over the allowed distance.
const BESIDE: f64 = 1.0;

/// The most rounds.
const MAX_ROUNDS: usize = 400;

/// A place for a new site.
#[derive(Clone, Copy, Debug)]
struct Proposal {
    place: Point,
    /// The distance from other sites.
    radius: f64,
}

/// The surface around what triangles enclose, within the distance of their field; `None` if that is nothing.
///
/// # Errors
/// When a stop was requested, or there are too many sites.
pub(crate) fn wrap(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    field: &Field,
    threads: &Threads,
) -> Result<Option<Wrapped>> {
    let mut growth = Growth::new(points, triangles, field, threads);
    let mut rounds = MAX_ROUNDS;
    let mut found = growth.grow(&mut rounds, threads)?;
    let all: Vec<[Point; 3]> = triangles.iter().map(|t| t.map(|v| points[v.index()])).collect();
    let mut length = SAMPLES_OVER_DISTANCE * field.distance;
    let mut suspects = samples(&all, length);
    loop {
        let proposals = growth.far(&suspects, length, &found, threads);
        let mut is_far = proposals.iter().map(Option::is_some);
        suspects.retain(|_| is_far.next() == Some(true));
        if suspects.is_empty() || length < LEAST_SAMPLES_OVER_DISTANCE * field.distance {
            break;
        }
        growth.add(proposals.into_iter().flatten().collect());
        found = growth.grow(&mut rounds, threads)?;
        length *= 0.5;
        suspects = suspects.iter().flat_map(|sample| sample.divided(&all, length)).collect();
    }
    growth.drop_crumbs(&mut found);
    if found.is_empty() {
        return Ok(None);
    }
    let mut fates = growth.fates(&all, &found, threads);
    suspects.iter().for_each(|sample| fates[sample.triangle] = Fate::Thin);
    Ok(Some(Wrapped { fates, ..growth.finish(&found) }))
}

/// The sites of a facet, in rising order, and whether more than two facets meet at one of its edges.
type FacetKey = ([VertexId; 3], bool);

/// The sites so far.
struct Growth<'a> {
    sites: Vec<Point>,
    given: Vec<MaybeId<VertexId>>,
    /// The places of the sites, but for those around everything.
    spaced: Spaced,
    creases: Creases,
    field: &'a Field,
    known: Known,
    /// What facets between these centres needed in the last round.
    proposed: HashMap<FacetKey, ([Point; 2], Option<Proposal>)>,
}

impl<'a> Growth<'a> {
    fn new(points: &[Point], triangles: &[[VertexId; 3]], field: &'a Field, threads: &Threads) -> Self {
        let mut used = triangles.as_flattened().to_vec();
        used.sort_unstable();
        used.dedup();
        let [low, high] = bounding_box(used.iter().map(|v| points[v.index()]));
        let extent = largest_extent([low, high]);
        let corner = |i: usize| {
            [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { low[axis] - extent } else { high[axis] + extent })
        };
        let creases = Creases::new(points, triangles, threads);
        let mut first = apart(points, creases.corners.iter().copied(), field.distance);
        // A facet with edges of length h is h^2 / 8 R from a sphere of radius R.
        let far_apart = apart(points, first.iter().chain(&used).copied(), (field.distance * extent).sqrt());
        first.extend(far_apart);
        first.sort_unstable();
        first.dedup();
        let is_at_end =
            threads.map_parts(first.len(), 16, |i| field.is_at_end(points[first[i].index()], field.distance));
        let first = first.iter().zip(is_at_end).filter(|of| of.1).map(|of| *of.0);
        let mut growth = Self {
            sites: (0..N_AROUND).map(corner).collect(),
            given: vec![MaybeId::NONE; N_AROUND],
            spaced: Spaced::new(LEAST_OVER_DISTANCE * field.distance),
            creases,
            field,
            known: Known::default(),
            proposed: HashMap::new(),
        };
        for v in first {
            growth.add_site(points[v.index()], v.into());
        }
        growth
    }

    /// Adds sites until no facet needs one.
    fn grow(&mut self, rounds: &mut usize, threads: &Threads) -> Result<Vec<Facet>> {
        loop {
            threads.watch().report_and_check("wrapping surfaces", self.sites.len(), 0)?;
            let found = facets(&self.sites, self.field, &mut self.known, threads)?;
            let proposals = self.proposals(&found, threads);
            if *rounds == 0 || self.add(proposals) == 0 {
                return Ok(found);
            }
            *rounds -= 1;
        }
    }

    /// The places that facets need.
    fn proposals(&mut self, found: &[Facet], threads: &Threads) -> Vec<Proposal> {
        let is_branching = branching(found);
        let key = |i: usize| (sorted_ids(found[i].sites), is_branching[i]);
        let before = &self.proposed;
        let all: Vec<Option<Proposal>> = threads.map_parts(found.len(), 16, |i| match before.get(&key(i)) {
            Some((centres, proposal)) if *centres == found[i].centres => *proposal,
            _ => self.proposal(&found[i], is_branching[i]),
        });
        self.proposed = (0..found.len()).map(|i| (key(i), (found[i].centres, all[i]))).collect();
        all.into_iter().flatten().collect()
    }

    fn proposal(&self, facet: &Facet, is_branching: bool) -> Option<Proposal> {
        let allowed = self.field.distance;
        let corners = facet.sites.map(|v| self.sites[v.index()]);
        let stray = STRAY_OVER_DISTANCE * allowed;
        let strays = middles(corners).into_iter().any(|p| self.field.nearest_within(p, stray).is_none());
        if !strays && !is_branching && !is_narrow(corners, NARROW_OVER_DISTANCE * allowed) {
            return None;
        }
        let [inner, outer] = facet.centres;
        // The outer centre is inside where its tet reaches to the sites around everything.
        let is_crossed = is_finite(outer) && !self.field.is_inside(outer);
        let place = match is_crossed {
            true => self.field.end(inner, outer),
            false => self.field.nearest(centroid(corners))?.point,
        };
        let off = distance(place, triangle::at(corners, triangle::closest(corners, place)));
        // Where the inside ends at a hole, no given triangle is near.
        let is_at_hole = || self.field.nearest_within(place, stray).is_none();
        let flat = stray.max(AT_HOLE * triangle::longest_side(corners));
        if strays && !is_branching && off <= flat && is_at_hole() {
            return None;
        }
        let radius = corners.map(|q| distance(place, q)).into_iter().fold(f64::INFINITY, f64::min);
        let proposal = Proposal { place, radius };
        (radius >= self.least()).then(|| self.at_crease(proposal))
    }

    fn at_crease(&self, proposal: Proposal) -> Proposal {
        let place =
            self.creases.nearest(proposal.place, ONTO_CREASE * proposal.radius).unwrap_or(proposal.place);
        Proposal { place, ..proposal }
    }

    /// The samples that are far from all facets, though the inside ends there.
    fn far(
        &self,
        samples: &[Sample],
        length: f64,
        found: &[Facet],
        threads: &Threads,
    ) -> Vec<Option<Proposal>> {
        let tree = self.nearest_facet(found, threads);
        threads.map_parts(samples.len(), 64, |i| {
            let Sample { place, normal, .. } = samples[i];
            let radius = tree.closest(place).map_or(f64::INFINITY, |closest| closest.distance_squared.sqrt());
            let is_far = radius > FAR_OVER_DISTANCE * self.field.distance;
            let [behind, before] = if is_far { self.beside(place, normal) } else { [false; 2] };
            (behind != before).then_some(Proposal { place, radius: radius.min(length) })
        })
    }

    /// Drops parts of the surface around rooms thinner than the distance.
    fn drop_crumbs(&self, found: &mut Vec<Facet>) {
        let mut sets = DisjointSets::new(found.len());
        for pair in sides(found).windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            sets.join(pair[0].1, pair[1].1);
        }
        let roots = sets.roots();
        let mut measured: HashMap<u32, (Point, f64, f64)> = HashMap::new();
        for (facet, root) in found.iter().zip(&roots) {
            let corners = facet.sites.map(|v| self.sites[v.index()]);
            let (origin, volume, area) = measured.entry(*root).or_insert((corners[0], 0.0, 0.0));
            *volume += cone_volume(facet.sites.into_iter(), &self.sites, *origin);
            *area += triangle::area(corners);
        }
        let least = self.field.distance;
        let mut is_thick = roots.iter().map(|root| {
            let (_, volume, area) = measured[root];
            // A plate of this thickness has as much volume and area.
            2.0 * volume.abs() >= least * area
        });
        found.retain(|_| is_thick.next() == Some(true));
    }

    /// What became of given triangles.
    fn fates(&self, triangles: &[[Point; 3]], found: &[Facet], threads: &Threads) -> Vec<Fate> {
        let tree = self.nearest_facet(found, threads);
        threads.map_parts(triangles.len(), 64, |t| {
            let place = centroid(triangles[t]);
            let normal = unit(triangle::area_vector(triangles[t])).unwrap_or_default();
            match tree.closest_within(place, self.field.distance) {
                Some(_) => Fate::Kept,
                None => match self.beside(place, normal) {
                    [true, true] => Fate::Inside,
                    [false, false] => Fate::Outside,
                    _ => Fate::Thin,
                },
            }
        })
    }

    fn nearest_facet(&self, found: &[Facet], threads: &Threads) -> NearestTriangle {
        let triangles: Vec<[VertexId; 3]> = found.iter().map(|facet| facet.sites).collect();
        NearestTriangle::new(&self.sites, &triangles, threads)
    }

    /// Whether the places behind and before a place on a triangle are inside.
    fn beside(&self, place: Point, normal: Point) -> [bool; 2] {
        [-BESIDE, BESIDE].map(|by| self.field.is_inside(add(place, scale(normal, by * self.field.distance))))
    }

    /// Adds the sites that are proposed, those far from others first, those near new ones not at all. Returns
    /// their number.
    fn add(&mut self, mut proposals: Vec<Proposal>) -> usize {
        proposals.sort_by(|x, y| y.radius.total_cmp(&x.radius));
        let before = self.sites.len();
        let mut rest = &proposals[..];
        // Those of similar radii together, by cells of a grid as large as the largest of them.
        while let Some(Proposal { radius: largest, .. }) = rest.first() {
            let n = rest.partition_point(|proposal| proposal.radius > 0.5 * largest).max(1);
            let mut new = Spaced::new(APART * largest);
            self.sites[before..].iter().for_each(|&p| new.insert(p));
            for Proposal { place, radius } in &rest[..n] {
                if new.is_free(*place, APART * radius) && self.spaced.is_free(*place, self.least()) {
                    new.insert(*place);
                    self.add_site(*place, MaybeId::NONE);
                }
            }
            rest = &rest[n..];
        }
        self.sites.len() - before
    }

    fn add_site(&mut self, place: Point, given: MaybeId<VertexId>) {
        self.sites.push(place);
        self.given.push(given);
        self.spaced.insert(place);
    }

    /// The least distance of sites from each other.
    fn least(&self) -> f64 {
        LEAST_OVER_DISTANCE * self.field.distance
    }

    fn finish(self, found: &[Facet]) -> Wrapped {
        let mut new = vec![u32::MAX; self.sites.len()];
        let mut wrapped =
            Wrapped { points: Vec::new(), given: Vec::new(), triangles: Vec::new(), fates: Vec::new() };
        for facet in found {
            wrapped.triangles.push(facet.sites.map(|v| {
                let place = &mut new[v.index()];
                if *place == u32::MAX {
                    *place = wrapped.points.len() as u32;
                    wrapped.points.push(self.sites[v.index()]);
                    wrapped.given.push(self.given[v.index()]);
                }
                *place
            }));
        }
        wrapped
    }
}

/// Whether the circumradius of a triangle is much longer than its shortest side, and longer than `least`.
fn is_narrow([a, b, c]: [Point; 3], least: f64) -> bool {
    let sides = [distance(a, b), distance(b, c), distance(c, a)];
    let shortest = sides.into_iter().fold(f64::INFINITY, f64::min);
    let radius = sides.into_iter().product::<f64>() / (4.0 * triangle::area([a, b, c]));
    radius > least && radius > NARROW * shortest
}

/// The sides of facets, each with its facet, in rising order.
fn sides(found: &[Facet]) -> Vec<([VertexId; 2], u32)> {
    let mut sides: Vec<([VertexId; 2], u32)> = (0u32..)
        .zip(found)
        .flat_map(|(i, Facet { sites: [a, b, c], .. })| {
            [[*a, *b], [*b, *c], [*c, *a]].map(|side| (sorted_ids(side), i))
        })
        .collect();
    sides.sort_unstable();
    sides
}

/// Whether more than two facets meet at an edge of each facet.
fn branching(found: &[Facet]) -> Vec<bool> {
    let sides = sides(found);
    let mut is_branching = vec![false; found.len()];
    for same in sides.chunk_by(|x, y| x.0 == y.0).filter(|same| same.len() > 2) {
        same.iter().for_each(|side| is_branching[side.1 as usize] = true);
    }
    is_branching
}

/// A place on a given triangle.
struct Sample {
    place: Point,
    /// The unit normal of the triangle.
    normal: Point,
    triangle: usize,
}

impl Sample {
    /// Four places around this one, half of `length` aside.
    fn divided(&self, triangles: &[[Point; 3]], length: f64) -> [Self; 4] {
        let corners = triangles[self.triangle];
        let along = unit(sub(corners[1], corners[0])).unwrap_or_default();
        let across = cross(self.normal, along);
        [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]].map(|[x, y]| {
            let aside = scale(add(scale(along, x), scale(across, y)), 0.5 * length);
            let place = triangle::at(corners, triangle::closest(corners, add(self.place, aside)));
            Self { place, ..*self }
        })
    }
}

/// Places on triangles: corners, and places between that leave no disc of twice this length without one.
fn samples(triangles: &[[Point; 3]], length: f64) -> Vec<Sample> {
    let mut samples = Vec::new();
    for (triangle, &corners) in triangles.iter().enumerate() {
        let Some(normal) = unit(triangle::area_vector(corners)) else { continue };
        let sides = [0, 1, 2].map(|k| distance(corners[(k + 1) % 3], corners[(k + 2) % 3]));
        let top = (1..3).fold(0, |best, k| if sides[k] > sides[best] { k } else { best });
        let [apex, from, to] = [0, 1, 2].map(|k| corners[(top + k) % 3]);
        let height = 2.0 * triangle::area(corners) / sides[top];
        let [n, m] = [sides[top], height].map(|of| (of / length).ceil().max(1.0) as usize);
        let mut add_sample = |place: Point| samples.push(Sample { place, normal, triangle });
        for i in 0..=n {
            let foot = add(from, scale(sub(to, from), i as f64 / n as f64));
            (0..m).for_each(|j| add_sample(add(foot, scale(sub(apex, foot), j as f64 / m as f64))));
        }
        add_sample(apex);
        add_sample(centroid(corners));
    }
    samples
}
