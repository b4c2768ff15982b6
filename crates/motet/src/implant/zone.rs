//! What came and a ring of the host around it, repaired.

use super::carve::{Carved, Fate};
use super::gap::{Gap, Owner};
use crate::base::{Id, Point, Result, VertexId};
use crate::mesh::TetMesh;
use crate::mesh::tet_facets::for_each_tet_facet;
use crate::remesh::{self, Options, SurfaceRule, remesh};

/// The host's tets that are no more, and what came in their place. Vertices are those of the host, and behind them new ones.
#[derive(Debug)]
pub(super) struct Draft {
    /// All points; some of them are used no more.
    pub(super) points: Vec<Point>,
    /// Which vertices of the host were moved.
    pub(super) is_moved: Vec<bool>,
    pub(super) is_gone: Vec<bool>,
    pub(super) tets: Vec<[VertexId; 4]>,
    pub(super) owners: Vec<Owner>,
    /// For each tet of the zone that was repaired where it is now.
    pub(super) of_zone: Vec<Site>,
}

/// One of the tets of the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Site {
    /// One of the host.
    Host(usize),
    /// One that came, by its place in [`Draft::tets`].
    New(usize),
}

impl Draft {
    pub(super) fn new(host: &TetMesh, carved: &Carved, gap: &Gap) -> Self {
        Self {
            points: host.points.iter().chain(&gap.points).copied().collect(),
            is_moved: vec![false; host.points.len()],
            is_gone: carved.fates.iter().map(|&fate| fate == Fate::Gone).collect(),
            tets: gap.tets.clone(),
            owners: gap.owners.clone(),
            of_zone: Vec::new(),
        }
    }

    /// Repairs bad tets among those that came and those of the host near them.
    ///
    /// # Errors
    /// When the tets are no mesh.
    pub(super) fn improve(
        &mut self,
        host: &TetMesh,
        carved: &Carved,
        gap: &Gap,
        options: &Options,
    ) -> Result<remesh::Report> {
        let near: Vec<usize> = (0..host.tets.len()).filter(|&t| carved.fates[t] == Fate::Near).collect();
        let regions: Vec<Owner> = regions(&self.owners, host, &near);
        let number = |owner: &Owner| regions.iter().position(|r| r == owner).unwrap_or_default() as i32;
        let mut zone = Zone::new(self.points.len());
        for (tet, owner) in self.tets.iter().zip(&self.owners) {
            zone.push(*tet, number(owner), &self.points);
        }
        let of_region: Vec<i32> = near.iter().map(|&t| number(&Owner::Host(host.regions[t]))).collect();
        near.iter().zip(of_region).for_each(|(&t, region)| zone.push(host.tets[t], region, &self.points));
        zone.hold(host, gap);
        let options = Options { surface: SurfaceRule::Keep, sizes: None, ..options.clone() };
        let outcome = remesh(&zone.mesh, &options)?;
        let (extract, n_came) = (outcome.extract, self.tets.len());
        let mut to_result = Vec::with_capacity(extract.mesh.points.len());
        for (point, &old) in extract.mesh.points.iter().zip(&extract.vertex_to_old) {
            to_result.push(zone.to_result.get(old as usize).copied().unwrap_or_else(|| {
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
        near.iter().for_each(|&t| self.is_gone[t] = true);
        (self.tets, self.owners) = (Vec::new(), Vec::new());
        for ((tet, &region), &old) in
            extract.mesh.tets.iter().zip(&extract.mesh.regions).zip(&extract.tet_to_old)
        {
            match near.get((old as usize).wrapping_sub(n_came)) {
                Some(&t) => {
                    self.is_gone[t] = false;
                    self.of_zone.push(Site::Host(t));
                }
                None => {
                    self.of_zone.push(Site::New(self.tets.len()));
                    self.tets.push(tet.map(|v| to_result[v.index()]));
                    self.owners.push(regions[region as usize]);
                }
            }
        }
        Ok(outcome.report)
    }
}

/// Each owner once.
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

/// A mesh of its own, and what its vertices are.
struct Zone {
    mesh: TetMesh,
    of_result: Vec<VertexId>,
    to_result: Vec<VertexId>,
}

impl Zone {
    fn new(n: usize) -> Self {
        Self { mesh: TetMesh::default(), of_result: vec![Id::NONE; n], to_result: Vec::new() }
    }

    fn push(&mut self, tet: [VertexId; 4], region: i32, points: &[Point]) {
        for v in tet {
            if self.of_result[v.index()] == VertexId::NONE {
                self.of_result[v.index()] = VertexId::new(self.to_result.len());
                self.to_result.push(v);
                self.mesh.points.push(points[v.index()]);
            }
        }
        self.mesh.tets.push(tet.map(|v| self.of_result[v.index()]));
        self.mesh.regions.push(region);
    }

    /// Holds triangles of the host and of devices, and what other cells of the host hold.
    fn hold(&mut self, host: &TetMesh, gap: &Gap) {
        let of = |v: VertexId| Some(self.of_result[v.index()]).filter(|v| *v != VertexId::NONE);
        let triangles = host.triangles.iter().copied().chain(gap.triangles.iter().map(|(t, _)| *t));
        let known = triangles.filter_map(|[a, b, c]| Some([of(a)?, of(b)?, of(c)?]));
        let known: Vec<[VertexId; 3]> = known.collect();
        let mut facets = Vec::new();
        for_each_tet_facet(&self.mesh.tets, &known, |sharing| {
            if !sharing.tets.is_empty() {
                facets.extend(sharing.triangles.first().map(|&t| known[t as usize]));
            }
        });
        let edges = host.fixed_edges.iter().filter_map(|&[a, b]| Some([of(a)?, of(b)?])).collect();
        let vertices = host.fixed_vertices.iter().filter_map(|&v| of(v)).collect();
        self.mesh.patches = vec![0; facets.len()];
        (self.mesh.triangles, self.mesh.fixed_edges, self.mesh.fixed_vertices) = (facets, edges, vertices);
    }
}
