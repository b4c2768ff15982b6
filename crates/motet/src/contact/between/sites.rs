//! The places of the vertices of all bodies: which bodies have a vertex at each, and which triangles meet
//! there.

use super::super::input::vertices_of;
use crate::base::{Csr, Error, Id, Point, Result, VertexId};

/// Stands for no site.
pub(super) const NO_SITE: u32 = u32::MAX;

/// Vertices at the same place are one site, with an owner for each body that has a vertex there.
///
/// What two bodies have in common, be it a vertex of both or two vertices at one place, is thus a site with
/// two owners.
#[derive(Clone, Debug)]
pub(super) struct Sites {
    /// The owners of each site in the order of bodies, each with its first vertex there.
    pub(super) owners: Csr<(u32, VertexId)>,
    /// Every vertex that a triangle uses, with its body and site; in the order of bodies, then of ids.
    pub(super) vertices: Vec<(u32, VertexId, u32)>,
    /// The triangles of all bodies, one body after the other, as sites.
    pub(super) triangles: Vec<[u32; 3]>,
    /// The triangles of all bodies as vertices, in the same order.
    pub(super) corners: Vec<[VertexId; 3]>,
    /// Where the triangles of each body end.
    ends: Vec<u32>,
    /// The triangles at each site.
    star: Csr<u32>,
}

/// The vertices that the bodies use, each once, in ascending order.
pub(super) fn used_vertices(points: &[Point], bodies: &[Vec<[VertexId; 3]>]) -> Result<Vec<VertexId>> {
    if bodies.is_empty() {
        return Err(Error::input("there is no body to measure gaps of")
            .remedy("give the triangles of each body as a separate list"));
    }
    let mut used = vec![false; points.len()];
    for (b, triangles) in bodies.iter().enumerate() {
        vertices_of(&format!("body {b}"), triangles, points)?.iter().for_each(|v| used[v.index()] = true);
    }
    Ok((0..used.len()).filter(|&v| used[v]).map(VertexId::new).collect())
}

impl Sites {
    /// `duplicates` are pairs `(duplicate, kept)` of indices into `used`; a site is the index of a kept one.
    pub(super) fn new(
        n_points: usize,
        used: &[VertexId],
        duplicates: &[(u32, u32)],
        bodies: &[Vec<[VertexId; 3]>],
    ) -> Self {
        let mut of_vertex = vec![NO_SITE; n_points];
        used.iter().zip(0..).for_each(|(v, site)| of_vertex[v.index()] = site);
        for &(duplicate, kept) in duplicates {
            of_vertex[used[duplicate as usize].index()] = kept;
        }
        let corners: Vec<[VertexId; 3]> = bodies.concat();
        let triangles: Vec<[u32; 3]> = corners.iter().map(|t| t.map(|v| of_vertex[v.index()])).collect();
        let mut vertices = Vec::with_capacity(used.len());
        let mut ends = Vec::with_capacity(bodies.len());
        for (body, triangles) in (0..).zip(bodies) {
            let mut own: Vec<VertexId> = triangles.as_flattened().to_vec();
            own.sort_unstable();
            own.dedup();
            vertices.extend(own.into_iter().map(|v| (body, v, of_vertex[v.index()])));
            ends.push(ends.last().copied().unwrap_or(0) + triangles.len() as u32);
        }
        // Of the vertices that a body has at one site, only the first is its owner.
        let mut last = vec![NO_SITE; used.len()];
        let is_first = |&(body, _, site): &(u32, VertexId, u32)| {
            std::mem::replace(&mut last[site as usize], body) != body
        };
        let first: Vec<(u32, VertexId, u32)> = vertices.iter().copied().filter(is_first).collect();
        let owners = Csr::from_pairs(used.len(), || first.iter().map(|&(b, v, s)| (s as usize, (b, v))));
        let star = Csr::from_pairs(used.len(), || {
            (0..).zip(&triangles).flat_map(|(t, &[a, b, c])| {
                let once = [Some(a), (b != a).then_some(b), (c != a && c != b).then_some(c)];
                once.into_iter().flatten().map(move |site| (site as usize, t))
            })
        });
        Self { owners, vertices, triangles, corners, ends, star }
    }

    /// How many bodies there are.
    pub(super) fn n_bodies(&self) -> usize {
        self.ends.len()
    }

    /// The owners of a site; none for [`NO_SITE`].
    pub(super) fn owners(&self, site: u32) -> &[(u32, VertexId)] {
        if site == NO_SITE { &[] } else { self.owners.list(site as usize) }
    }

    /// The vertex of a body at a site; [`Id::NONE`] if it has none.
    pub(super) fn vertex(&self, site: u32, body: u32) -> VertexId {
        let found = self.owners(site).iter().find(|owner| owner.0 == body);
        found.map_or(VertexId::NONE, |owner| owner.1)
    }

    /// The triangles of a body that contain all these sites, at least one.
    pub(super) fn star_of<'a>(&'a self, body: u32, sites: &'a [u32]) -> impl Iterator<Item = usize> + 'a {
        let lists = sites.iter().map(|&s| self.star.list(s as usize));
        let shortest = lists.min_by_key(|list| list.len()).unwrap_or(&[]);
        let range = self.of_body(body);
        let holds =
            move |t: &u32| range.contains(t) && sites.iter().all(|s| self.triangles[*t as usize].contains(s));
        shortest.iter().copied().filter(holds).map(|t| t as usize)
    }

    /// The triangles of a body at a site.
    pub(super) fn star(&self, body: u32, site: u32) -> impl Iterator<Item = usize> + '_ {
        let range = self.of_body(body);
        let list = self.star.list(site as usize).iter().filter(move |t| range.contains(t));
        list.map(|&t| t as usize)
    }

    fn of_body(&self, body: u32) -> std::ops::Range<u32> {
        let start = if body == 0 { 0 } else { self.ends[body as usize - 1] };
        start..self.ends[body as usize]
    }

    /// Whether these sites are a vertex, an edge or a triangle of the surface of a body.
    pub(super) fn is_real(&self, body: u32, sites: &[u32]) -> bool {
        self.star_of(body, sites).next().is_some()
    }
}
