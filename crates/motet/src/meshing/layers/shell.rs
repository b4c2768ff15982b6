//! What layers on the outer side of a surface are bounded by, and what is in their way.
//!
//! If every tet that a prism can be divided into is positive, and the surfaces around the layers cross
//! neither each other nor the rest of the given surface, then the layers fill the space between exactly once.

use super::columns::{Columns, Site, distinct};
use super::neighbors::NONE;
use super::skin::Skin;
use super::split::fan;
use super::tangles::prisms_are_positive;
use crate::base::{Point, Threads, VertexId};
use crate::meshing::surfaces::Surfaces;
use crate::preflight::own_crossings;

/// Maps sites in columns to points: feet are those of the surfaces, the others follow column by column.
pub(super) struct Sites {
    /// For each vertex of the skin, its vertex of the surfaces.
    feet: Vec<VertexId>,
    /// For each vertex of the skin, the number of points above feet in the columns before it.
    before: Vec<u32>,
    /// The number of points before those above feet.
    first: usize,
}

impl Sites {
    /// Numbers the sites, those above feet from `first` on.
    pub(super) fn new(skin: &Skin, columns: &Columns, first: usize) -> Self {
        let mut n = 0;
        let before = (0..skin.points.len()).map(|w| {
            let before = n;
            n += columns.count(VertexId::new(w));
            before
        });
        Self { before: before.collect(), feet: skin.to_vertex.clone(), first }
    }

    pub(super) fn of(&self, Site { foot, level }: Site) -> VertexId {
        match level {
            0 => self.feet[foot.index()],
            level => VertexId::new(self.first + self.before[foot.index()] as usize + level as usize - 1),
        }
    }

    /// All sites above feet, in the order of their points.
    pub(super) fn above<'a>(&self, columns: &'a Columns) -> impl Iterator<Item = Site> + 'a {
        let of = |w: usize| {
            let foot = VertexId::new(w);
            (1..=columns.count(foot)).map(move |level| Site { foot, level })
        };
        (0..self.feet.len()).flat_map(of)
    }
}

/// The surface around the layers, and the rest of the given surface.
pub(super) struct Shell {
    points: Vec<Point>,
    triangles: Vec<[VertexId; 3]>,
    /// For each triangle, the triangle of the skin on which the layers behind it stand; [`NONE`] for given
    /// triangles.
    stands_on: Vec<u32>,
}

impl Shell {
    /// Builds the shell; the first `n_real` triangles of the surfaces are there, those after them only show
    /// where the surface ends.
    pub(super) fn new(surfaces: &Surfaces, n_real: usize, skin: &Skin, columns: &Columns) -> Self {
        let sites = Sites::new(skin, columns, surfaces.points.len());
        let mut points = surfaces.points.clone();
        points.extend(sites.above(columns).map(|site| columns.at(site)));
        let mut triangles = surfaces.triangles[..n_real].to_vec();
        let mut stands_on = vec![NONE; n_real];
        for t in 0..n_real as u32 {
            if columns.prisms(t).next().is_none() {
                continue;
            }
            triangles.push(outer(skin, columns, &sites, t));
            for k in 0..3 {
                for ring in end_facets(skin, columns, &sites, t, k) {
                    triangles.extend(fan(&ring));
                }
            }
            stands_on.resize(triangles.len(), t);
        }
        Self { points, triangles, stands_on }
    }

    /// The columns at fault for any problem, in rising order; none if there is no problem.
    pub(super) fn tangles(&self, skin: &Skin, columns: &Columns, threads: &Threads) -> Vec<VertexId> {
        let off: Vec<bool> = threads.map(skin.triangles.len(), |t| !prisms_are_positive(columns, t as u32));
        let mut blamed: Vec<u32> = (0u32..).zip(off).filter(|(_, off)| *off).map(|(t, _)| t).collect();
        for pair in own_crossings(&self.points, &self.triangles, threads) {
            blamed.extend(pair.map(|i| self.stands_on[i as usize]).into_iter().filter(|&t| t != NONE));
        }
        let corners = blamed.into_iter().flat_map(|t| skin.triangles[t as usize]);
        let mut columns: Vec<VertexId> = corners.filter(|&v| columns.count(v) > 0).collect();
        columns.sort_unstable();
        columns.dedup();
        columns
    }
}

/// The triangle on top of the layers on a triangle, facing as the surface does.
pub(super) fn outer(skin: &Skin, columns: &Columns, sites: &Sites, triangle: u32) -> [VertexId; 3] {
    let [a, b, c] = skin.triangles[triangle as usize].map(|v| sites.of(columns.top(v)));
    [a, c, b]
}

/// The sides of layers at an edge of a triangle where the wall ends, facing away from the layers: quads and
/// triangles.
pub(super) fn end_facets(
    skin: &Skin,
    columns: &Columns,
    sites: &Sites,
    triangle: u32,
    k: usize,
) -> Vec<Vec<VertexId>> {
    let beyond = skin.behind[triangle as usize][k];
    if beyond != NONE && skin.has_stack(beyond) {
        return Vec::new();
    }
    let rings = columns.sides(triangle, k).map(distinct).filter(|ring| ring.len() > 2);
    rings.map(|ring| ring.into_iter().map(|site| sites.of(site)).collect()).collect()
}
