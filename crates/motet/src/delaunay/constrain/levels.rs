//! Ways of joining triangles to flat facets: where one way has failed, another is tried, at that place only.

use super::grown::GrownFacets;
use super::recovery::Part;
use crate::base::{Csr, VertexId};

/// The neighbours with which a triangle may be joined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Merge {
    /// None.
    None,
    /// Neighbours exactly in the plane of the triangle.
    Exact,
    /// Neighbours that may have been in the plane of the triangle before coordinates were rounded.
    Rounded,
}

/// The way in which each triangle may be joined with its neighbours. Triangles coplanar up to rounding change
/// together from one way to the next.
pub(super) struct Levels<'a> {
    triangles: &'a [[VertexId; 3]],
    pub(super) grown: &'a GrownFacets,
    /// The triangles of each facet of `grown`.
    members: Csr<u32>,
    of_facet: Vec<Merge>,
}

impl<'a> Levels<'a> {
    /// Starts with triangles joined that are exactly coplanar.
    pub(super) fn new(triangles: &'a [[VertexId; 3]], grown: &'a GrownFacets) -> Self {
        let n = grown.firsts.len();
        let facets = || grown.number.iter().enumerate().map(|(i, &of)| (of as usize, i as u32));
        Self { triangles, grown, members: Csr::from_pairs(n, facets), of_facet: vec![Merge::Exact; n] }
    }

    /// The way in which a triangle may be joined.
    pub(super) fn of(&self, triangle: u32) -> Merge {
        self.of_facet[self.grown.number[triangle as usize] as usize]
    }

    /// Whether any triangles are joined that are coplanar only up to rounding.
    pub(super) fn has_rounded(&self) -> bool {
        self.of_facet.contains(&Merge::Rounded)
    }

    /// Advances the triangles `failed` and those coplanar with them to their next way of joining: exactly,
    /// then up to rounding, then not at all. Returns whether any of them had a way left.
    pub(super) fn advance(&mut self, failed: &[u32]) -> bool {
        let mut facets: Vec<u32> = failed.iter().map(|&i| self.grown.number[i as usize]).collect();
        facets.sort_unstable();
        facets.dedup();
        facets.retain(|&facet| self.of_facet[facet as usize] != Merge::None);
        for &facet in &facets {
            let is_one = self.members.list(facet as usize).len() == 1;
            let of = &mut self.of_facet[facet as usize];
            *of = if *of == Merge::Exact && !is_one { Merge::Rounded } else { Merge::None };
        }
        !facets.is_empty()
    }

    /// Stops joining triangles altogether; returns whether any were joined.
    pub(super) fn separate_all(&mut self) -> bool {
        let has_joined = self.of_facet.iter().any(|of| *of != Merge::None);
        self.of_facet.fill(Merge::None);
        has_joined
    }

    /// The joined triangles that share the most vertices with a part of the surface; all joined triangles
    /// where none shares one.
    pub(super) fn near(&self, part: Part) -> Vec<u32> {
        let ends = match part {
            Part::Edge(ends) => ends.to_vec(),
            Part::Triangle(i) => self.triangles[i as usize].to_vec(),
        };
        let joined = || (0..self.triangles.len() as u32).filter(|&i| self.of(i) != Merge::None);
        let n_shared = |i: &u32| self.triangles[*i as usize].iter().filter(|v| ends.contains(v)).count();
        let with = |least: usize| joined().filter(|i| n_shared(i) >= least).collect::<Vec<u32>>();
        (0..=ends.len()).rev().map(with).find(|found| !found.is_empty()).unwrap_or_default()
    }
}
