//! The places of the vertices of all bodies: which bodies have a vertex at each, and which triangles meet
//! there.

use super::super::input::vertices_of;
use crate::base::{BodyId, Csr, Error, MaybeId, Point, Result, VertexId, id};

id!(
    /// A place at which bodies have vertices.
    pub(super) SiteId
);

/// A body that has a vertex at a site.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Owner {
    pub(super) body: BodyId,
    /// The first vertex of the body there.
    pub(super) vertex: VertexId,
}

/// A vertex of a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyVertex {
    pub(super) body: BodyId,
    pub(super) vertex: VertexId,
    pub(super) site: SiteId,
}

/// Vertices at the same place are one site, with an owner for each body that has a vertex there.
///
/// What two bodies have in common, be it a vertex of both or two vertices at one place, is thus a site with
/// two owners.
#[derive(Clone, Debug)]
pub(super) struct Sites {
    /// The owners of each site in the order of bodies.
    pub(super) owners: Csr<Owner>,
    /// Every vertex that a triangle uses, in the order of bodies, then of ids.
    pub(super) vertices: Vec<BodyVertex>,
    /// The triangles of all bodies, one body after the other, as sites.
    pub(super) triangles: Vec<[SiteId; 3]>,
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

/// A point that coincides with another one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Duplicate {
    pub(super) duplicate: SiteId,
    /// The point that stands for both.
    pub(super) kept: SiteId,
}

impl Sites {
    /// A site is the index of a vertex in `used` that is kept.
    pub(super) fn new(
        n_points: usize,
        used: &[VertexId],
        duplicates: &[Duplicate],
        bodies: &[Vec<[VertexId; 3]>],
    ) -> Self {
        let mut of_vertex = vec![SiteId::default(); n_points];
        used.iter().zip(0..).for_each(|(v, site)| of_vertex[v.index()] = SiteId(site));
        for &Duplicate { duplicate, kept } in duplicates {
            of_vertex[used[duplicate.index()].index()] = kept;
        }
        let corners: Vec<[VertexId; 3]> = bodies.concat();
        let triangles: Vec<[SiteId; 3]> = corners.iter().map(|t| t.map(|v| of_vertex[v.index()])).collect();
        let mut vertices = Vec::with_capacity(used.len());
        let mut ends = Vec::with_capacity(bodies.len());
        for (body, triangles) in (0..).map(BodyId).zip(bodies) {
            let mut own: Vec<VertexId> = triangles.as_flattened().to_vec();
            own.sort_unstable();
            own.dedup();
            let of = |vertex: VertexId| BodyVertex { body, vertex, site: of_vertex[vertex.index()] };
            vertices.extend(own.into_iter().map(of));
            ends.push(ends.last().copied().unwrap_or(0) + triangles.len() as u32);
        }
        // Of the vertices that a body has at one site, only the first is its owner.
        let mut last: Vec<MaybeId<BodyId>> = vec![MaybeId::NONE; used.len()];
        let is_first = |of: &BodyVertex| {
            let body = MaybeId::from(of.body);
            std::mem::replace(&mut last[of.site.index()], body) != body
        };
        let first: Vec<BodyVertex> = vertices.iter().copied().filter(is_first).collect();
        let owner = |of: &BodyVertex| (of.site.index(), Owner { body: of.body, vertex: of.vertex });
        let owners = Csr::from_pairs(used.len(), || first.iter().map(owner));
        let star = Csr::from_pairs(used.len(), || {
            (0..).zip(&triangles).flat_map(|(t, &[a, b, c])| {
                let once = [Some(a), (b != a).then_some(b), (c != a && c != b).then_some(c)];
                once.into_iter().flatten().map(move |site| (site.index(), t))
            })
        });
        Self { owners, vertices, triangles, corners, ends, star }
    }

    /// How many bodies there are.
    pub(super) fn n_bodies(&self) -> usize {
        self.ends.len()
    }

    /// The owners of a site.
    pub(super) fn owners(&self, site: MaybeId<SiteId>) -> &[Owner] {
        site.get().map_or(&[][..], |site| self.owners.list(site.index()))
    }

    /// The vertex of a body at a site, if it has one there.
    pub(super) fn vertex(&self, site: MaybeId<SiteId>, body: BodyId) -> Option<VertexId> {
        self.owners(site).iter().find(|owner| owner.body == body).map(|owner| owner.vertex)
    }

    /// The triangles of a body that contain all these sites, at least one.
    pub(super) fn star_of<'a>(
        &'a self,
        body: BodyId,
        sites: &'a [SiteId],
    ) -> impl Iterator<Item = usize> + 'a {
        let lists = sites.iter().map(|s| self.star.list(s.index()));
        let shortest = lists.min_by_key(|list| list.len()).unwrap_or(&[]);
        let range = self.of_body(body);
        let holds =
            move |t: &u32| range.contains(t) && sites.iter().all(|s| self.triangles[*t as usize].contains(s));
        shortest.iter().copied().filter(holds).map(|t| t as usize)
    }

    /// The triangles of a body at a site.
    pub(super) fn star(&self, body: BodyId, site: SiteId) -> impl Iterator<Item = usize> + '_ {
        let range = self.of_body(body);
        let list = self.star.list(site.index()).iter().filter(move |t| range.contains(t));
        list.map(|&t| t as usize)
    }

    fn of_body(&self, body: BodyId) -> std::ops::Range<u32> {
        let start = if body.0 == 0 { 0 } else { self.ends[body.index() - 1] };
        start..self.ends[body.index()]
    }

    /// Whether these sites are a vertex, an edge or a triangle of the surface of a body.
    pub(super) fn is_real(&self, body: BodyId, sites: &[SiteId]) -> bool {
        self.star_of(body, sites).next().is_some()
    }
}
