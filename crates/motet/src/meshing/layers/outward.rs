//! Layers on the outer side of surfaces: the walls of vessels.
//!
//! Columns stand on the surface as they do inside, but where the wall ends at a cap they stay in its plane,
//! and the cap stays as it is. What bounds the layers must not cross anything: `shell`.

use super::columns::Columns;
use super::directions::Directions;
use super::growth::{Growth, around};
use super::neighbors::NONE;
use super::options::Stack;
use super::report::Report;
use super::shell::{Shell, Sites, end_facets, outer};
use super::skin::Skin;
use super::thickness::{Limits, largest_ball};
use crate::base::{Csr, Point, Result, Threads, VertexId};
use crate::mesh::CellKind;
use crate::meshing::surfaces::Surfaces;
use crate::spatial::NearestTriangle;

/// How often radii are averaged with those of neighbours.
const SWEEPS: usize = 10;

/// Layers on the outer side of surfaces that are closed.
pub(in crate::meshing) struct OutwardLayers {
    growth: Growth,
    /// The number of points of the surfaces; those above them follow.
    n_points: usize,
}

/// The side of a layer where the wall ends.
pub(in crate::meshing) struct EndFacet {
    /// A triangle or quad, facing away from the layer.
    pub(in crate::meshing) ring: Vec<VertexId>,
    /// The triangle of the wall.
    pub(in crate::meshing) triangle: u32,
    /// The triangle of the surfaces beyond the end of the wall, if there is exactly one.
    pub(in crate::meshing) beyond: Option<u32>,
}

impl OutwardLayers {
    /// Grows layers on the triangles where `on` holds, as thick at each vertex as `thickness` says, or as
    /// there is space. `stack` gives their number and proportions. The first `n_real` triangles are there;
    /// those after them close the surface, and only show where it ends.
    ///
    /// # Errors
    /// When there is no such triangle, there are too many layers, or the call is stopped.
    pub(in crate::meshing) fn new(
        surfaces: &Surfaces,
        n_real: usize,
        on: &[bool],
        stack: Stack,
        thickness: &[f64],
        threads: &Threads,
    ) -> Result<Self> {
        let skin = Skin::outside(surfaces, stack, on);
        let of_vertices = skin.to_vertex.clone();
        let requested = |w: VertexId, _| thickness[of_vertices[w.index()].index()];
        let mut growth = Growth::new(skin, &Limits::OUTSIDE, requested, threads)?;
        growth.settle(
            |skin, heights| Shell::new(surfaces, n_real, skin, &Columns::new(skin, heights)),
            |skin, columns, shell| shell.tangles(skin, columns, threads),
            threads,
        )?;
        Ok(Self { growth, n_points: surfaces.points.len() })
    }

    /// The points above the surface, with the vertex of the surfaces below each. Their ids follow those of
    /// the surfaces' points.
    pub(in crate::meshing) fn points(&self) -> Vec<(Point, VertexId)> {
        let columns = self.growth.columns();
        let all = self.sites(&columns).above(&columns);
        all.map(|site| (columns.at(site), self.growth.skin.to_vertex[site.foot.index()])).collect()
    }

    /// The cells of the layers: wedges, and pyramids and tets where columns end; with the triangle of the
    /// surfaces on which each stands.
    pub(in crate::meshing) fn cells(&self) -> Vec<(CellKind, Vec<VertexId>, u32)> {
        let columns = self.growth.columns();
        let sites = self.sites(&columns);
        let of = |t: u32| columns.prisms(t).filter_map(move |prism| prism.cell().map(|cell| (cell, t)));
        let all = (0..self.growth.skin.triangles.len() as u32).flat_map(of);
        all.map(|((kind, corners), t)| (kind, corners.into_iter().map(|site| sites.of(site)).collect(), t))
            .collect()
    }

    /// The outer side of the layers on each triangle that has any, facing away from them.
    pub(in crate::meshing) fn outer(&self) -> Vec<([VertexId; 3], u32)> {
        let columns = self.growth.columns();
        let sites = self.sites(&columns);
        let all = 0..self.growth.skin.triangles.len() as u32;
        all.filter(|&t| columns.prisms(t).next().is_some())
            .map(|t| (outer(&self.growth.skin, &columns, &sites, t), t))
            .collect()
    }

    /// The sides of the layers where the wall ends.
    pub(in crate::meshing) fn ends(&self) -> Vec<EndFacet> {
        let columns = self.growth.columns();
        let (skin, sites) = (&self.growth.skin, self.sites(&columns));
        let mut all = Vec::new();
        for triangle in 0..skin.triangles.len() as u32 {
            for k in 0..3 {
                let beyond = skin.behind[triangle as usize][k];
                let beyond = (beyond != NONE).then_some(beyond);
                let rings = end_facets(skin, &columns, &sites, triangle, k);
                all.extend(rings.into_iter().map(|ring| EndFacet { ring, triangle, beyond }));
            }
        }
        all
    }

    /// Statistics on the layers.
    pub(in crate::meshing) fn report(&self) -> Report {
        self.growth.report()
    }

    fn sites(&self, columns: &Columns) -> Sites {
        Sites::new(&self.growth.skin, columns, self.n_points)
    }
}

/// The local radius at each vertex where `on` holds around it: that of the largest ball that touches the
/// surface there from inside, averaged with neighbours; 0 at other vertices.
pub(in crate::meshing) fn radii(surfaces: &Surfaces, on: &[bool], threads: &Threads) -> Vec<f64> {
    let stack = Stack { count: 1, first: 1.0, growth: 1.0 };
    let skin = Skin::inside(surfaces, stack, on);
    let around = around(&skin);
    let directions = Directions::find(&skin, &around, threads);
    let tree = NearestTriangle::new(&skin.points, &skin.triangles, threads);
    let largest = crate::mesh::bounds(&skin.points).map_or(0.0, crate::mesh::largest_extent);
    let ball = |w: usize| match directions.ways[w] {
        [0.0, 0.0, 0.0] => 0.0,
        way => largest_ball(&skin, &tree, VertexId::new(w), way, largest),
    };
    let mut found: Vec<f64> = threads.map(skin.points.len(), ball);
    for _ in 0..SWEEPS {
        found = threads.map(found.len(), |w| averaged(&around, &found, w));
    }
    let mut radii = vec![0.0; surfaces.points.len()];
    skin.to_vertex.iter().zip(&found).for_each(|(v, &radius)| radii[v.index()] = radius);
    radii
}

/// The mean of the values at a vertex and its neighbours, those without a value left out.
fn averaged(around: &Csr<VertexId>, values: &[f64], w: usize) -> f64 {
    let beside = around.list(w).iter().map(|v| values[v.index()]);
    let known = beside.chain([values[w]]).filter(|value| *value > 0.0);
    let (sum, n) = known.fold((0.0, 0.0), |(sum, n), value| (sum + value, n + 1.0));
    if around.list(w).is_empty() || n == 0.0 { values[w] } else { sum / n }
}
