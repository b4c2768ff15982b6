//! Finds exactly what prevents layers of given heights, and the columns at fault.
//!
//! If every tet that a prism can be divided into is positive, the parts of every flat part still face the
//! same way, and the surfaces of the core do not cross, then all cells together fill the bodies exactly once:
//! nothing else need be checked.

use super::columns::{Columns, Site, distinct};
use super::core::Core;
use super::neighbors::NONE;
use super::skin::Skin;
use crate::base::{Csr, Point, Threads, VertexId};
use crate::geometry::predicates::orient3d;
use crate::geometry::vector::{add, norm, scale, sub};
use crate::preflight::own_crossings;

/// Which columns are at fault for problems on a flat part.
pub(super) struct CapRims {
    /// For each flat part, its vertices with layers.
    of_flat: Csr<VertexId>,
}

impl CapRims {
    pub(super) fn new(skin: &Skin) -> Self {
        let mut all: Vec<(usize, VertexId)> = Vec::new();
        for (t, triangle) in skin.triangles.iter().enumerate().filter(|(t, _)| skin.flats.of[*t] != NONE) {
            let on_wall = triangle.iter().filter(|v| skin.walls(**v).next().is_some());
            all.extend(on_wall.map(|&v| (skin.flats.of[t] as usize, v)));
        }
        all.sort_unstable();
        all.dedup();
        Self { of_flat: Csr::from_pairs(skin.flats.normals.len(), || all.iter().copied()) }
    }

    /// The columns at the corners of a triangle of the skin; if it has none, those at the rim of its flat
    /// part.
    fn blame(&self, skin: &Skin, columns: &Columns, triangle: u32) -> Vec<VertexId> {
        let stands = |v: &VertexId| columns.count(*v) > 0;
        let own: Vec<_> = skin.triangles[triangle as usize].into_iter().filter(stands).collect();
        match skin.flats.of[triangle as usize] {
            part if own.is_empty() && part != NONE => {
                self.of_flat.list(part as usize).iter().copied().filter(stands).collect()
            }
            _ => own,
        }
    }
}

/// Returns the columns at fault for any problem, in ascending order; empty if there is none.
pub(super) fn tangles(
    skin: &Skin,
    columns: &Columns,
    core: &Core,
    rims: &CapRims,
    threads: &Threads,
) -> Vec<VertexId> {
    let off: Vec<bool> = threads.map(skin.triangles.len(), |t| {
        !prisms_are_positive(columns, t as u32) || !sides_lie_flat(skin, columns, t as u32)
    });
    let mut blamed: Vec<u32> = (0u32..).zip(off).filter(|(_, off)| *off).map(|(t, _)| t).collect();
    blamed.extend(turned_over(skin, core));
    for pair in own_crossings(&core.surfaces.points, &core.surfaces.triangles, threads) {
        pair.into_iter().for_each(|i| blamed.extend(core.skin_triangles(skin, i)));
    }
    let mut columns: Vec<VertexId> = blamed.into_iter().flat_map(|t| rims.blame(skin, columns, t)).collect();
    columns.sort_unstable();
    columns.dedup();
    columns
}

pub(super) fn prisms_are_positive(columns: &Columns, triangle: u32) -> bool {
    let is_positive = |tet: [Site; 4]| {
        let [a, b, c, d] = tet.map(|site| columns.at(site));
        orient3d(a, b, c, d) > 0
    };
    columns.prisms(triangle).all(|prism| prism.tets().all(is_positive))
}

/// Whether the sides of prisms that lie in flat parts face the same way as these, however they are divided.
fn sides_lie_flat(skin: &Skin, columns: &Columns, triangle: u32) -> bool {
    let is_rim = |k: &usize| {
        let beyond = skin.behind[triangle as usize][*k];
        let part = if beyond == NONE { NONE } else { skin.flats.of[beyond as usize] };
        skin.has_stack(triangle) && part != NONE && skin.flats.normals[part as usize] != [0.0; 3]
    };
    (0..3).filter(is_rim).all(|k| {
        let normal = skin.flats.normals[skin.flats.of[skin.behind[triangle as usize][k] as usize] as usize];
        columns.sides(triangle, k).all(|side| {
            let ring: Vec<Point> = distinct(side).into_iter().map(|site| columns.at(site)).collect();
            let n = ring.len();
            n < 3 || (0..n).all(|i| faces([ring[i], ring[(i + 1) % n], ring[(i + 2) % n]], normal))
        })
    })
}

/// Moved triangles of the skin in flat parts that have turned over.
fn turned_over<'a>(skin: &'a Skin, core: &'a Core) -> impl Iterator<Item = u32> + 'a {
    let triangles = (0u32..).zip(&core.surfaces.triangles);
    let moved = triangles.filter(|(i, _)| !core.is_unmoved[*i as usize] && !core.is_raised[*i as usize]);
    moved.flat_map(move |(i, triangle)| {
        let [a, b, c] = triangle.map(|v| core.surfaces.points[v.index()]);
        core.skin_triangles(skin, i).filter(move |&s| {
            let part = skin.flats.of[s as usize];
            let corners = if skin.is_turned[s as usize] { [a, c, b] } else { [a, b, c] };
            part != NONE && !faces(corners, skin.flats.normals[part as usize])
        })
    })
}

/// Whether a triangle faces in the direction of a normal.
fn faces([a, b, c]: [Point; 3], normal: Point) -> bool {
    let above = add(a, scale(normal, norm(sub(b, a)) + norm(sub(c, a))));
    orient3d(a, b, c, above) > 0
}
