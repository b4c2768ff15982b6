//! The origins of everything new in a step, from the forest: a part of a tet lies in it, and a whole is made
//! of its parts. Geometry is consulted only where pieces that fit a tet to its neighbours are replaced by
//! other pieces, and then only for few tets.
//!
//! A new vertex is the mean of the ends of its edge, which may be new themselves.

use std::collections::BTreeMap;

use super::super::forest::{Extracted, Forest};
use super::ancestry::{Ancestry, corners};
use super::joined::Joined;
use crate::base::{
    CellId, ForestVertexId, Id, LineId, MaybeId, Result, TetId, Threads, TriangleId, VertexId, absent,
};
use crate::geometry::segment;
use crate::geometry::tet;
use crate::geometry::vector::{add, distance, scale, sub};
use crate::mesh::LabelPlaces;
use crate::mesh::history::{Ledger, RegionLedger, Rows};
use crate::spatial::trace::{Labelled, LocalChange, trace};

/// How many rows a thread makes at a time.
const RUN: usize = 4096;

/// The origins of all new vertices and cells.
pub(super) struct Found {
    pub(super) vertices: Rows<VertexId>,
    pub(super) cells: Rows<CellId>,
    pub(super) ledger: Ledger,
}

/// Finds the origins of everything new, given the forest after the step, the meshes before and after, and the
/// old cells of the tets, triangles and lines.
pub(super) fn origins(
    forest: &Forest,
    [was, is]: [&Extracted; 2],
    ancestry: &Ancestry<'_>,
    joined: &Joined,
    cells: [&[CellId]; 3],
    threads: &Threads,
) -> Result<Found> {
    let (of_tets, ledger) = tets(ancestry, [was, is], joined, cells[0], threads);
    let of_triangles = triangles([was, is], joined, cells[1], threads)?;
    let of_lines = lines([was, is], joined, cells[2]);
    let means = Means { forest, numbers: was.numbers(forest.reference.len()) };
    let inserted = absent(&joined.vertex_to_old);
    let of_vertices = threads.in_runs(inserted.len(), RUN, |parts: &mut Vec<(VertexId, f64)>, run| {
        let mut rows = Rows::new();
        for &v in &inserted[run] {
            means.of(is.vertices[v.index()], parts);
            rows.push(v, parts, parts[0].0);
        }
        vec![rows]
    });
    Ok(Found { vertices: all(of_vertices), cells: of_tets.merged(of_triangles).merged(of_lines), ledger })
}

/// Joins rows whose ids rise from list to list.
fn all<I: Id>(lists: Vec<Rows<I>>) -> Rows<I> {
    let mut rows = Rows::new();
    lists.into_iter().for_each(|list| rows.append(list));
    rows
}

/// Some new tets: their rows, their volumes, and what they take of the volumes of old tets.
#[derive(Default)]
struct Taken {
    rows: Rows<CellId>,
    volumes: Vec<f64>,
    taken: Vec<(TetId, f64)>,
}

fn tets(
    ancestry: &Ancestry<'_>,
    [was, is]: [&Extracted; 2],
    joined: &Joined,
    old_cells: &[CellId],
    threads: &Threads,
) -> (Rows<CellId>, Ledger) {
    let volume = |out: &Extracted, t: TetId| tet::volume(corners(out, t)).abs();
    let inserted = &joined.tets.inserted;
    type Parts = (Vec<(TetId, f64)>, Vec<(CellId, f64)>);
    let mut found = threads.in_runs(inserted.len(), RUN, |(parts, of_cells): &mut Parts, run| {
        let mut out = Taken::default();
        for &t in &inserted[run] {
            ancestry.parts(t, parts);
            let (all, sum) = (volume(is, t), parts.iter().map(|part| part.1).sum::<f64>());
            out.volumes.push(all);
            out.taken.extend(parts.iter().map(|&(old, part)| (old, all * (part / sum))));
            let main = parts.iter().fold(parts[0], |best, &part| if part.1 > best.1 { part } else { best }).0;
            of_cells.clear();
            of_cells.extend(parts.iter().map(|&(old, part)| (old_cells[old.index()], part)));
            out.rows.push(joined.tet_to_cell[t.index()], of_cells, old_cells[main.index()]);
        }
        vec![out]
    });
    let rows = all(found.iter_mut().map(|found| std::mem::take(&mut found.rows)).collect());

    // Sums are in the order of tets, so that they do not depend on the number of threads.
    let mut regions = Regions::default();
    let mut taken = vec![0.0; was.mesh.tets.len()];
    let mut tets = inserted.iter();
    for found in found {
        for (all, t) in found.volumes.iter().zip(tets.by_ref()) {
            regions.of(is.mesh.regions[t.index()]).volume_after += all;
        }
        found.taken.iter().for_each(|&(old, part)| taken[old.index()] += part);
    }
    let removed = &joined.tets.removed;
    let volumes = threads.map(removed.len(), |i| volume(was, removed[i]));
    for (&t, all) in removed.iter().zip(volumes) {
        let entry = regions.of(was.mesh.regions[t.index()]);
        entry.volume_before += all;
        entry.deviation += (taken[t.index()] - all).abs();
    }
    (rows, Ledger { regions: regions.sorted(), ..Ledger::default() })
}

/// The entries of regions.
#[derive(Default)]
struct Regions {
    all: Vec<RegionLedger>,
    places: LabelPlaces,
}

impl Regions {
    /// The entry of a region.
    #[inline]
    fn of(&mut self, region: i32) -> &mut RegionLedger {
        let place = self.places.of(region);
        if place == self.all.len() {
            self.all.push(RegionLedger { region, ..RegionLedger::default() });
        }
        &mut self.all[place]
    }

    /// All entries, by rising labels.
    fn sorted(mut self) -> Vec<RegionLedger> {
        self.all.sort_by_key(|entry| entry.region);
        self.all
    }
}

/// Triangles inherit from the nearest part of the same triangle of the first mesh.
fn triangles(
    [was, is]: [&Extracted; 2],
    joined: &Joined,
    old_cells: &[CellId],
    threads: &Threads,
) -> Result<Rows<CellId>> {
    let labelled = |out: &Extracted, which: &[TriangleId], cells: &[CellId]| -> Vec<Labelled<3>> {
        let of = |t: &TriangleId| Labelled {
            cell: cells[t.index()],
            vertices: out.mesh.triangles[t.index()],
            label: out.triangles[t.index()].0 as i32,
        };
        which.iter().map(of).collect()
    };
    let traced = trace(
        &LocalChange {
            old_points: &was.mesh.points,
            new_points: &is.mesh.points,
            removed_triangles: &labelled(was, &joined.triangles.removed, old_cells),
            new_triangles: &labelled(is, &joined.triangles.inserted, &joined.triangle_to_cell),
            ..LocalChange::default()
        },
        threads,
    )?;
    let mut rows = Rows::new();
    let inherited = traced.cells.ids().iter().zip(traced.cells.iter());
    inherited.for_each(|(&cell, row)| rows.push(cell, &[(row.main, 1.0)], row.main));
    Ok(rows)
}

/// Lines inherit from the nearest part of the same line of the first mesh.
fn lines([was, is]: [&Extracted; 2], joined: &Joined, old_cells: &[CellId]) -> Rows<CellId> {
    let mut rows = Rows::new();
    let mut removed: BTreeMap<LineId, Vec<LineId>> = BTreeMap::new();
    joined.lines.removed.iter().for_each(|&l| removed.entry(was.lines[l.index()]).or_default().push(l));
    let ends = |out: &Extracted, l: LineId| out.mesh.lines[l.index()].map(|v| out.mesh.points[v.index()]);
    for &l in &joined.lines.inserted {
        let [a, b] = ends(is, l);
        let middle = scale(add(a, b), 0.5);
        let far = |old: &LineId| {
            let [p, q] = ends(was, *old);
            distance(add(p, scale(sub(q, p), segment::closest([p, q], middle))), middle)
        };
        let parts = removed.get(&is.lines[l.index()]).into_iter().flatten().copied();
        let nearest = parts.min_by(|x, y| far(x).total_cmp(&far(y)));
        let old = old_cells[nearest.unwrap_or_default().index()];
        rows.push(joined.line_to_cell[l.index()], &[(old, 1.0)], old);
    }
    rows
}

/// Expresses new vertices as means of old ones.
struct Means<'a> {
    forest: &'a Forest,
    /// For each vertex of the forest, its id in the mesh before; none if it was not in it.
    numbers: Vec<MaybeId<VertexId>>,
}

impl Means<'_> {
    /// Replaces `parts` by the old vertices that a vertex is a mean of, by rising ids, with their shares.
    fn of(&self, vertex: ForestVertexId, parts: &mut Vec<(VertexId, f64)>) {
        parts.clear();
        self.add(vertex, 1.0, parts);
        parts.sort_unstable_by_key(|part| part.0);
    }

    /// Adds a share of a vertex. Shares are powers of two, so their sums are exact in any order.
    fn add(&self, v: ForestVertexId, share: f64, parts: &mut Vec<(VertexId, f64)>) {
        if let Some(known) = self.numbers[v.index()].get() {
            match parts.iter_mut().find(|part| part.0 == known) {
                Some(part) => part.1 += share,
                None => parts.push((known, share)),
            }
            return;
        }
        let origin = self.forest.origin[v.index() - self.forest.n_first_vertices];
        for end in self.forest.edges[origin.index()].ends {
            self.add(end, 0.5 * share, parts);
        }
    }
}
