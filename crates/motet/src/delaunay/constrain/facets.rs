//! Makes every triangle of the surface a union of facets of tets.
//!
//! All edges are present, so what is missing of a triangle consists of whole parts between existing edges.
//! The tets cut by a part are removed; the hollows on its two sides are refilled, each with tets that see
//! nothing beyond the part.

use hashbrown::{HashMap, HashSet};

use super::cut::{Cut, Face, Stuck};
use super::flats::FlatFacets;
use super::pierce::PiercedFacet;
use super::plane::Plane;
use super::present::find_facets;
use super::recovery::{Order, Part, Unrecovered};
use super::segments::Segments;
use super::sites::Sites;
use super::split::Protected;
use super::wrap::GiftWrap;
use crate::base::{Csr, Error, TetId, VertexId, sorted_ids};
use crate::kernel::{HalfFacet, Tets};

/// Makes every flat facet a set of facets of tets; returns them, oriented like the first triangle of each
/// flat facet. Where `may_swap`, swaps are tried first, and triangles get points inside where all else fails.
pub(super) fn recover(
    tets: &mut Tets,
    sites: &mut Sites,
    segments: &Segments,
    triangles: &[[VertexId; 3]],
    flats: &FlatFacets,
    may_swap: bool,
    order: &Order<'_>,
) -> Result<Csr<[VertexId; 3]>, Unrecovered> {
    let on_segments = segments.points(sites);
    let of_flat = |i: usize| {
        let all = flats.triangles.list(i).iter().map(|&i| triangles[i as usize]);
        parts_of_flat(sites, all, |t| polygon_of(segments, &on_segments, t))
    };
    let mut parts = Csr::default();
    order.threads.map(flats.triangles.len(), of_flat).into_iter().for_each(|own| parts.push(own));
    let sides = find_facets(tets, parts.items(), order.threads);
    let mut work = Work::default();
    let mut changed = HashMap::new();
    let mut in_line: Vec<usize> = (0..flats.triangles.len()).collect();
    in_line.sort_by_key(|&i| order.rank(|part| flats.has(i, part)));
    for (n_made, i) in in_line.into_iter().enumerate() {
        order.watch().report_and_check("recovering facets of the surface", n_made, parts.len())?;
        let own = parts.list(i);
        let sides = &sides[parts.offsets()[i] as usize..][..own.len()];
        let is_missing = |(part, side): &(&[VertexId; 3], &HalfFacet)| !work.has(tets, **part, **side);
        let missing: Vec<_> = own.iter().zip(sides).filter(is_missing).map(|(&part, _)| part).collect();
        if missing.is_empty() {
            work.walls.extend(own.iter().copied().map(sorted_ids));
            continue;
        }
        let (flat, mut made) = (flats.triangles.list(i), own.to_vec());
        let first = triangles[flat[0] as usize];
        let done = if may_swap {
            let all = flat.iter().map(|&i| (i, triangles[i as usize])).collect();
            work.make(tets, sites, segments, all, &mut made)
        } else {
            work.recover(tets, sites, (first, &made), missing)
        };
        done.map_err(|_: Stuck| stuck(sites, flat[0], first))?;
        work.walls.extend(made.iter().copied().map(sorted_ids));
        changed.insert(i, made);
    }
    Ok(with_changed(parts, &changed))
}

/// The facets of each flat facet, those of some flat facets replaced.
fn with_changed(
    parts: Csr<[VertexId; 3]>,
    changed: &HashMap<usize, Vec<[VertexId; 3]>>,
) -> Csr<[VertexId; 3]> {
    if changed.is_empty() {
        return parts;
    }
    let mut all = Csr::default();
    let own = |(i, list)| changed.get(&i).map_or(list, Vec::as_slice);
    parts.iter().enumerate().for_each(|each| all.push(own(each).iter().copied()));
    all
}

fn stuck(sites: &Sites, i: u32, triangle: [VertexId; 3]) -> Unrecovered {
    let corners = triangle.map(|v| sites.near(v));
    let [a, b, c] = triangle;
    let error = Error::input(format!(
        "the triangle of points {a}, {b} and {c} could not be recovered as facets of tets"
    ))
    .at(format!("triangle {i}, at {:?}", corners[0]))
    .remedy("check for triangles that cross or touch it");
    Unrecovered { what: Some(Part::Triangle(i)), error }
}

/// The edges and facets of the surface that exist so far.
struct Walls<'a> {
    segments: &'a Segments,
    walls: &'a HashSet<[VertexId; 3]>,
}

impl Protected for Walls<'_> {
    fn has_edge(&self, edge: [VertexId; 2]) -> bool {
        self.segments.has_piece(edge)
    }

    fn has_facet(&self, face: [VertexId; 3]) -> bool {
        self.walls.contains(&sorted_ids(face))
    }
}

/// The corners of a triangle and the points on its edges, in the order of its orientation.
fn polygon_of(segments: &Segments, on_segments: &Csr<VertexId>, triangle: [VertexId; 3]) -> Vec<VertexId> {
    let mut polygon = Vec::with_capacity(3);
    for i in 0..3 {
        let [a, b] = [triangle[i], triangle[(i + 1) % 3]];
        polygon.push(a);
        let on = segments.find([a, b]).map_or(&[][..], |s| on_segments.list(s.0 as usize));
        if a < b {
            polygon.extend(on);
        } else {
            polygon.extend(on.iter().rev());
        }
    }
    polygon
}

/// The constrained Delaunay triangulation of a flat facet, given by its triangles, with the points on its
/// outline; `polygon` gives the corners of a triangle and the points on its edges.
fn parts_of_flat(
    sites: &Sites,
    triangles: impl ExactSizeIterator<Item = [VertexId; 3]> + Clone,
    polygon: impl Fn([VertexId; 3]) -> Vec<VertexId>,
) -> Vec<[VertexId; 3]> {
    let Some(first) = triangles.clone().next() else { return Vec::new() };
    if triangles.len() == 1 {
        return parts_of(sites, &polygon(first), first);
    }
    let plane = Plane::new(sites, first);
    let turned = triangles.map(|t| plane.turned(t));
    let mut parts: Vec<_> = turned.flat_map(|t| parts_of(sites, &polygon(t), t)).collect();
    plane.make_delaunay(&mut parts);
    parts
}

/// The Delaunay triangulation of a triangle's corners and the points on its edges.
fn parts_of(sites: &Sites, polygon: &[VertexId], triangle: [VertexId; 3]) -> Vec<[VertexId; 3]> {
    if polygon.len() == 3 { vec![triangle] } else { Plane::new(sites, triangle).triangulate(polygon) }
}

/// Buffers reused from one flat facet to the next, and the parts made so far.
#[derive(Default)]
struct Work {
    cut: Cut,
    wrap: GiftWrap,
    pierced: PiercedFacet,
    /// All parts so far, vertices in ascending order.
    walls: HashSet<[VertexId; 3]>,
    star: Vec<TetId>,
}

impl Work {
    /// Whether tets have a facet; `side` is a side that it has had, or [`HalfFacet::NONE`].
    fn has(&mut self, tets: &mut Tets, facet: [VertexId; 3], side: HalfFacet) -> bool {
        let still_has = |side: HalfFacet| {
            let v = tets.vertices(side.tet());
            facet.iter().all(|corner| v.contains(corner))
        };
        !side.is_none() && still_has(side) || tets.find_facet(facet, &mut self.star).is_some()
    }

    fn missing(&mut self, tets: &mut Tets, parts: &[[VertexId; 3]]) -> Vec<[VertexId; 3]> {
        parts.iter().copied().filter(|&part| !self.has(tets, part, HalfFacet::NONE)).collect()
    }

    /// Makes a flat facet a set of facets of tets: by swaps, by refilling the hollows on both sides, or with
    /// points inside.
    fn make(
        &mut self,
        tets: &mut Tets,
        sites: &mut Sites,
        segments: &Segments,
        triangles: Vec<(u32, [VertexId; 3])>,
        own: &mut Vec<[VertexId; 3]>,
    ) -> Result<(), Stuck> {
        let first = triangles[0].1;
        self.pierced.begin(triangles, own);
        let kept = Walls { segments, walls: &self.walls };
        if self.pierced.swap_all(tets, sites, &kept)
            && let Some(facets) = self.pierced.facets(tets, sites)
        {
            *own = facets;
            return Ok(());
        }
        // Swaps may have destroyed parts that existed.
        let missing = self.missing(tets, own);
        if self.recover(tets, sites, (first, own), missing).is_err() {
            let kept = Walls { segments, walls: &self.walls };
            *own = self.pierced.run(tets, sites, &kept).ok_or(Stuck)?;
        }
        Ok(())
    }

    /// Makes the missing parts of a flat facet facets of tets. Parts with no existing edge between them are
    /// inserted together. `plane` holds a triangle that defines the plane, and the facets in it.
    fn recover(
        &mut self,
        tets: &mut Tets,
        sites: &Sites,
        plane: ([VertexId; 3], &[[VertexId; 3]]),
        mut missing: Vec<[VertexId; 3]>,
    ) -> Result<(), Stuck> {
        while let Some(part) = missing.pop() {
            let mut group = vec![part];
            let mut rim = None;
            let mut next = 0;
            while let Some(&[a, b, c]) = group.get(next) {
                next += 1;
                for (edge, beyond) in [([a, b], c), ([b, c], a), ([c, a], b)] {
                    if tets.find_edge(edge, &mut self.star).is_some() {
                        rim.get_or_insert((edge, beyond));
                    } else {
                        let shares = |p: &[VertexId; 3]| edge.iter().all(|v| p.contains(v));
                        let place = missing.iter().position(shares);
                        group.extend(place.map(|k| missing.swap_remove(k)));
                    }
                }
            }
            self.insert(tets, sites, plane, &group, rim.ok_or(Stuck)?)?;
        }
        Ok(())
    }

    /// Inserts a group of parts as facets; restores the tets where this fails.
    fn insert(
        &mut self,
        tets: &mut Tets,
        sites: &Sites,
        plane: ([VertexId; 3], &[[VertexId; 3]]),
        group: &[[VertexId; 3]],
        rim: ([VertexId; 2], VertexId),
    ) -> Result<(), Stuck> {
        self.cut.find(tets, sites, plane, rim, |face| self.walls.contains(&sorted_ids(face)))?;
        let old: Vec<_> = self.cut.tets.iter().map(|&tet| tets.vertices(tet)).collect();
        let at: Vec<_> = group.as_flattened().iter().map(|&v| (v, tets.tet_of(v))).collect();
        self.cut.tets.iter().for_each(|&tet| tets.remove(tet));
        let shells = std::mem::take(&mut self.cut.shells);
        self.wrap.begin();
        let filled = self.fill(tets, sites, group, &shells);
        if filled.is_err() {
            self.wrap.made().iter().for_each(|&tet| tets.remove(tet));
            // Not every vertex of the group need belong to an old tet.
            at.into_iter().for_each(|(vertex, tet)| tets.set_tet_of(vertex, tet));
            let outer = shells.iter().flatten().filter(|face| !face.outer.is_none());
            tets.put(&old, outer.map(|face| (sorted_ids(face.vertices), face.outer)).collect());
        }
        self.cut.shells = shells;
        filled
    }

    /// Fills both hollows of a group of parts.
    fn fill(
        &mut self,
        tets: &mut Tets,
        sites: &Sites,
        group: &[[VertexId; 3]],
        shells: &[Vec<Face>; 2],
    ) -> Result<(), Stuck> {
        let mut faces = shells[0].clone();
        faces.extend(group.iter().map(|&vertices| Face { vertices, outer: HalfFacet::NONE }));
        self.wrap.fill(tets, sites, &faces, &self.cut.vertices[0])?;
        self.join_walls(tets);
        faces.clone_from(&shells[1]);
        for &[a, b, c] in group {
            let outer = self.wrap.inner([a, b, c]).ok_or(Stuck)?;
            faces.push(Face { vertices: [a, c, b], outer });
        }
        self.wrap.fill(tets, sites, &faces, &self.cut.vertices[1])?;
        self.join_walls(tets);
        Ok(())
    }

    /// Links the tets on the two sides of walls within a hollow.
    fn join_walls(&self, tets: &mut Tets) {
        for &[a, b, c] in &self.cut.walls {
            if let (Some(front), Some(behind)) = (self.wrap.inner([a, b, c]), self.wrap.inner([a, c, b])) {
                tets.join(front, behind);
            }
        }
    }
}
