//! Repairs new tets and a ring of the host around them.

use std::collections::{BTreeSet, HashSet};

use super::carve::{Carved, Fate};
use super::fill::Gap;
use super::owner::{Owner, Patch};
use crate::base::{CellId, MaybeId, Point, Result, TetId, Threads, VertexId, sorted_ids};
use crate::geometry::tet::FACETS;
use crate::mesh::TetMesh;
use crate::mesh::tet_facets::for_each_tet_facet;
use crate::remesh::{self, Improve, Options, SurfaceRule, remesh};

/// The removed tets of the host, and the new ones in their place. Vertices are those of the host, then new
/// ones.
#[derive(Debug)]
pub(super) struct Draft {
    /// All points; some of them are no longer used.
    pub(super) points: Vec<Point>,
    /// Which vertices of the host were moved.
    pub(super) is_moved: Vec<bool>,
    pub(super) is_removed: Vec<bool>,
    pub(super) tets: Vec<[VertexId; 4]>,
    pub(super) owners: Vec<Owner>,
    /// New triangles.
    pub(super) triangles: Vec<([VertexId; 3], Patch)>,
    /// For each tet of the repaired zone, where it is now.
    pub(super) zone_to_site: Vec<Site>,
}

/// A tet of the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Site {
    /// A tet of the host.
    Host(usize),
    /// A new tet, by its index in [`Draft::tets`].
    New(usize),
}

impl Draft {
    pub(super) fn new(host: &TetMesh, carved: &Carved, gap: &Gap) -> Self {
        Self {
            points: host.points.iter().chain(&gap.points).copied().collect(),
            is_moved: vec![false; host.points.len()],
            is_removed: carved.fates.iter().map(|&fate| fate == Fate::Removed).collect(),
            tets: gap.tets.clone(),
            owners: gap.owners.clone(),
            triangles: Vec::new(),
            zone_to_site: Vec::new(),
        }
    }

    /// Repairs bad tets among the new ones and among those of the host near them. Walls stay as they are,
    /// except where devices meet them: there they may stray by up to `stray`.
    ///
    /// # Errors
    /// When the tets are no mesh.
    pub(super) fn improve(
        &mut self,
        host: &TetMesh,
        carved: &Carved,
        gap: &Gap,
        options: &Options,
        stray: f64,
        threads: &Threads,
    ) -> Result<remesh::Report<TetId>> {
        let near: Vec<usize> = (0..host.tets.len()).filter(|&t| carved.fates[t] == Fate::Near).collect();
        let regions: Vec<Owner> = regions(&self.owners, host, &near);
        let number = |owner: &Owner| regions.iter().position(|r| r == owner).unwrap_or_default() as i32;
        let mut zone = Zone::new(self.points.len());
        for (tet, owner) in self.tets.iter().zip(&self.owners) {
            zone.push(*tet, number(owner), &self.points);
        }
        let of_region: Vec<i32> = near.iter().map(|&t| number(&Owner::Host(host.regions[t]))).collect();
        near.iter().zip(of_region).for_each(|(&t, region)| zone.push(host.tets[t], region, &self.points));
        let patches = zone.add_triangles(host, gap, &mut self.triangles);
        let surface = match gap.loose.is_empty() {
            true => SurfaceRule::Keep,
            false => {
                zone.fix_walls(&gap.loose);
                SurfaceRule::Adapt { distance: Some(stray) }
            }
        };
        let cells = (0..self.tets.len()).map(CellId::new).collect();
        let improve =
            Improve { cells: Some(cells), keeps_others: true, raises_worst: true, ..Improve::filled() };
        let improve = options.improve.clone().or(Some(improve));
        let options = Options { surface, sizes: None, improve, ..options.clone() };
        let outcome = remesh(&zone.mesh, &options, threads)?;
        let (extract, n_new) = (outcome.extract, self.tets.len());
        let mut to_result = Vec::with_capacity(extract.mesh.points.len());
        for (point, old) in extract.mesh.points.iter().zip(&extract.vertex_to_old) {
            to_result.push(old.get().map(|old| zone.to_result[old.index()]).unwrap_or_else(|| {
                self.points.push(*point);
                VertexId::new(self.points.len() - 1)
            }));
        }
        for &v in &extract.changed_vertices {
            let of = to_result[v.index()];
            self.points[of.index()] = extract.mesh.points[v.index()];
            if let Some(is_moved) = self.is_moved.get_mut(of.index()) {
                *is_moved = true;
            }
        }
        for (triangle, &patch) in extract.mesh.triangles.iter().zip(&extract.mesh.patches) {
            let new = patches.get(patch as usize).filter(|patch| **patch != Patch::Unlabelled);
            self.triangles.extend(new.map(|patch| (triangle.map(|v| to_result[v.index()]), *patch)));
        }
        near.iter().for_each(|&t| self.is_removed[t] = true);
        (self.tets, self.owners) = (Vec::new(), Vec::new());
        for ((tet, &region), old) in
            extract.mesh.tets.iter().zip(&extract.mesh.regions).zip(&extract.tet_to_old)
        {
            match old.get().and_then(|old| near.get(old.index().checked_sub(n_new)?)) {
                Some(&t) => {
                    self.is_removed[t] = false;
                    self.zone_to_site.push(Site::Host(t));
                }
                None => {
                    self.zone_to_site.push(Site::New(self.tets.len()));
                    self.tets.push(tet.map(|v| to_result[v.index()]));
                    self.owners.push(regions[region as usize]);
                }
            }
        }
        Ok(outcome.report)
    }
}

/// All owners, each once.
fn regions(owners: &[Owner], host: &TetMesh, near: &[usize]) -> Vec<Owner> {
    let mut found: Vec<Owner> = Vec::new();
    let all = owners.iter().copied().chain(near.iter().map(|&t| Owner::Host(host.regions[t])));
    for owner in all {
        if !found.contains(&owner) {
            found.push(owner);
        }
    }
    found
}

/// The zone as a mesh of its own, and the maps between its vertices and those of the result.
struct Zone {
    mesh: TetMesh,
    result_to_zone: Vec<MaybeId<VertexId>>,
    to_result: Vec<VertexId>,
}

impl Zone {
    fn new(n: usize) -> Self {
        Self { mesh: TetMesh::default(), result_to_zone: vec![MaybeId::NONE; n], to_result: Vec::new() }
    }

    fn push(&mut self, tet: [VertexId; 4], region: i32, points: &[Point]) {
        let in_zone = tet.map(|v| {
            self.result_to_zone[v.index()].get_or_insert_with(|| {
                self.to_result.push(v);
                self.mesh.points.push(points[v.index()]);
                VertexId::new(self.to_result.len() - 1)
            })
        });
        self.mesh.tets.push(in_zone);
        self.mesh.regions.push(region);
    }

    /// Adds triangles of the host and new ones, and holds what other cells of the host hold. Returns the
    /// patch of each patch number; the numbers from there on are triangles of the host. New triangles that
    /// lie outside of the zone are added to `elsewhere`.
    fn add_triangles(
        &mut self,
        host: &TetMesh,
        gap: &Gap,
        elsewhere: &mut Vec<([VertexId; 3], Patch)>,
    ) -> Vec<Patch> {
        let patches: BTreeSet<Patch> = gap.triangles.iter().map(|(_, patch)| *patch).collect();
        let patches: Vec<Patch> = patches.into_iter().collect();
        let of_host = i32::try_from(patches.len()).unwrap_or(i32::MAX);
        let number = |patch: &Patch| patches.binary_search(patch).map_or(of_host, |i| i as i32);
        let dropped: HashSet<[VertexId; 3]> =
            gap.dropped.iter().map(|face| sorted_ids(face.vertices)).collect();
        let of = |v: VertexId| self.result_to_zone[v.index()].get();
        let staying = host.triangles.iter().filter(|t| !dropped.contains(&sorted_ids(**t)));
        let all = staying.map(|t| (*t, of_host, None));
        let all = all.chain(gap.triangles.iter().map(|new| (new.0, number(&new.1), Some(*new))));
        let mut known = Vec::new();
        for ([a, b, c], patch, new) in all {
            match (of(a), of(b), of(c)) {
                (Some(a), Some(b), Some(c)) => known.push(([a, b, c], patch, new)),
                _ => elsewhere.extend(new),
            }
        }
        let triangles: Vec<[VertexId; 3]> = known.iter().map(|x| x.0).collect();
        let (mut facets, mut numbers) = (Vec::new(), Vec::new());
        for_each_tet_facet(&self.mesh.tets, &triangles, |sharing| {
            let Some(&t) = sharing.triangles.first() else { return };
            let (triangle, patch, new) = known[t as usize];
            if sharing.tets.is_empty() {
                elsewhere.extend(new);
            } else {
                facets.push(triangle);
                numbers.push(patch);
            }
        });
        let edges = host.fixed_edges.iter().filter_map(|&[a, b]| Some([of(a)?, of(b)?])).collect();
        let vertices = host.fixed_vertices.iter().filter_map(|&v| of(v)).collect();
        (self.mesh.triangles, self.mesh.patches) = (facets, numbers);
        (self.mesh.fixed_edges, self.mesh.fixed_vertices) = (edges, vertices);
        patches
    }

    /// Fixes the edges of walls that have no loose corner, and the vertices of walls that are not loose.
    fn fix_walls(&mut self, loose: &BTreeSet<VertexId>) {
        let (mut edges, mut vertices) = (Vec::new(), Vec::new());
        let is_loose = |v: VertexId| loose.contains(&self.to_result[v.index()]);
        let Self { mesh: TetMesh { tets, triangles, regions, .. }, .. } = self;
        for_each_tet_facet(tets, triangles, |sharing| {
            if !sharing.is_wall(regions) {
                return;
            }
            let (t, i) = sharing.tets[0];
            let [a, b, c] = FACETS[i].map(|k| tets[t.index()][k]);
            vertices.extend([a, b, c].into_iter().filter(|v| !is_loose(*v)));
            if ![a, b, c].into_iter().any(is_loose) {
                edges.extend([[a, b], [b, c], [c, a]].map(sorted_ids));
            }
        });
        self.mesh.fixed_edges.extend(edges);
        self.mesh.fixed_vertices.extend(vertices);
        self.mesh.fixed_edges.sort_unstable();
        self.mesh.fixed_edges.dedup();
        self.mesh.fixed_vertices.sort_unstable();
        self.mesh.fixed_vertices.dedup();
    }
}
