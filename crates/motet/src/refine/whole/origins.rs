//! The origins of everything new in a step, from the forest: a part of a tet lies in it, and a whole is made
//! of its parts. Geometry is consulted only where pieces that fit a tet to its neighbours are replaced by
//! other pieces, and then only for few tets.
//!
//! A new vertex is the mean of the ends of its edge, which may be new themselves.

use std::collections::BTreeMap;

use super::super::choose::estimate;
use super::super::forest::{Extracted, Forest};
use super::super::refinement::Refinement;
use super::joined::Joined;
use crate::base::{
    CellId, ForestVertexId, LineId, MaybeId, NodeId, Point, Result, TetId, Threads, TriangleId, VertexId,
};
use crate::geometry::overlap::Solid;
use crate::geometry::segment;
use crate::geometry::tet::{self, centroid};
use crate::geometry::vector::{add, distance, scale, sub};
use crate::mesh::history::{Ledger, RegionLedger, Rows};
use crate::spatial::trace::{Labelled, LocalChange, trace};

/// A new cell, the old cells it comes from with their shares, and the main one.
type CellRow = (CellId, Vec<(CellId, f64)>, CellId);

/// The origins of all new vertices and cells.
pub(super) struct Found {
    pub(super) vertices: Rows<VertexId>,
    pub(super) cells: Rows<CellId>,
    pub(super) ledger: Ledger,
}

/// Finds the origins of everything new. The two refinements are those before and after; `cells` gives the old
/// cells of the tets, triangles and lines.
pub(super) fn origins(
    [before, after]: [&Refinement; 2],
    joined: &Joined,
    cells: [&[CellId]; 3],
    threads: &Threads,
) -> Result<Found> {
    let ancestry = Ancestry::new(&after.forest, &before.now, &after.now);
    let parts = threads.map(joined.tets.inserted.len(), |i| ancestry.parts(joined.tets.inserted[i]));
    let ledger = ledger(&ancestry, joined, &parts);
    let mut rows: Vec<CellRow> = Vec::with_capacity(parts.len());
    for (t, parts) in joined.tets.inserted.iter().zip(&parts) {
        let of_old = parts.iter().map(|&(old, volume)| (cells[0][old.index()], volume));
        let main = parts.iter().fold(parts[0], |best, &part| if part.1 > best.1 { part } else { best }).0;
        rows.push((joined.tet_to_cell[t.index()], of_old.collect(), cells[0][main.index()]));
    }
    triangles(before, after, joined, cells[1], threads, &mut rows)?;
    lines(&before.now, &after.now, joined, cells[2], &mut rows);
    rows.sort_by_key(|row| row.0);
    let mut of_cells = Rows::new();
    rows.iter().for_each(|(cell, parts, main)| of_cells.push(*cell, parts, *main));
    let mut of_vertices = Rows::new();
    let means = Means::new(&after.forest, &before.now);
    let inserted = joined.vertex_to_old.iter().enumerate().filter(|(_, old)| old.is_none());
    for (v, _) in inserted {
        let parts = means.of(after.now.vertices[v]);
        of_vertices.push(VertexId::new(v), &parts, parts[0].0);
    }
    Ok(Found { vertices: of_vertices, cells: of_cells, ledger })
}

/// Which tets before and after the step lie in which.
struct Ancestry<'a> {
    forest: &'a Forest,
    was: &'a Extracted,
    is: &'a Extracted,
    /// For each tet of the forest, the range of its pieces in the mesh before: the first, and one past the
    /// last.
    old: Vec<[u32; 2]>,
    /// For each tet of the forest that is coarser than before, the old tets that lie in it.
    within: BTreeMap<NodeId, Vec<TetId>>,
}

impl<'a> Ancestry<'a> {
    fn new(forest: &'a Forest, was: &'a Extracted, is: &'a Extracted) -> Self {
        let pieces = |out: &Extracted| {
            let mut pieces = vec![[0, 0]; forest.nodes.len()];
            for (node, t) in out.nodes.iter().zip(0..) {
                let [first, end] = &mut pieces[node.index()];
                *first = if *end == 0 { t } else { *first };
                *end = t + 1;
            }
            pieces
        };
        let (old, new) = (pieces(was), pieces(is));
        let mut within: BTreeMap<NodeId, Vec<TetId>> = BTreeMap::new();
        for (&node, t) in was.nodes.iter().zip(0..) {
            let coarser = forest.ancestors(node).skip(1).find(|node| new[node.index()][1] > 0);
            if let Some(coarser) = coarser {
                within.entry(coarser).or_default().push(TetId(t));
            }
        }
        Self { forest, was, is, old, within }
    }

    /// Returns the old tets that make up a new tet, with their volumes, which need not sum to that of the
    /// tet.
    fn parts(&self, t: TetId) -> Vec<(TetId, f64)> {
        let node = self.is.nodes[t.index()];
        let holder = self.forest.ancestors(node).map(|node| self.old[node.index()]).find(|old| old[1] > 0);
        let candidates: Vec<TetId> = match (holder, self.within.get(&node)) {
            (Some([first, end]), _) if end == first + 1 => return vec![(TetId(first), 1.0)],
            (Some([first, end]), _) => (first..end).map(TetId).collect(),
            (None, Some(within)) => within.clone(),
            (None, None) => Vec::new(),
        };
        let solid = Solid::new(corners(self.is, t));
        let overlaps = candidates.iter().filter_map(|&old| {
            let other = Solid::new(corners(self.was, old));
            solid.real_overlap(&other).map(|volume| (old, volume))
        });
        let overlaps: Vec<_> = overlaps.collect();
        if !overlaps.is_empty() {
            return overlaps;
        }
        // Points that moved may leave no overlap: then take the nearest candidate.
        let centre = centroid(corners(self.is, t));
        let far = |old: &TetId| distance(centroid(corners(self.was, *old)), centre);
        let nearest = candidates.iter().copied().min_by(|x, y| far(x).total_cmp(&far(y)));
        vec![(nearest.unwrap_or_default(), 1.0)]
    }
}

fn corners(out: &Extracted, t: TetId) -> [Point; 4] {
    estimate::corners(&out.mesh, out.mesh.tets[t.index()])
}

fn ledger(ancestry: &Ancestry, joined: &Joined, parts: &[Vec<(TetId, f64)>]) -> Ledger {
    let volume = |out: &Extracted, t: TetId| tet::volume(corners(out, t)).abs();
    let mut regions: BTreeMap<i32, RegionLedger> = BTreeMap::new();
    let mut taken: BTreeMap<TetId, f64> = BTreeMap::new();
    for (&t, parts) in joined.tets.inserted.iter().zip(parts) {
        let (all, sum) = (volume(ancestry.is, t), parts.iter().map(|part| part.1).sum::<f64>());
        regions.entry(ancestry.is.mesh.regions[t.index()]).or_default().volume_after += all;
        parts.iter().for_each(|&(old, part)| *taken.entry(old).or_default() += all * (part / sum));
    }
    for &t in &joined.tets.removed {
        let all = volume(ancestry.was, t);
        let entry = regions.entry(ancestry.was.mesh.regions[t.index()]).or_default();
        entry.volume_before += all;
        entry.deviation += (taken.get(&t).copied().unwrap_or(0.0) - all).abs();
    }
    let regions = regions.into_iter().map(|(region, entry)| RegionLedger { region, ..entry }).collect();
    Ledger { regions, ..Ledger::default() }
}

/// Triangles inherit from the nearest part of the same triangle of the first mesh.
fn triangles(
    before: &Refinement,
    after: &Refinement,
    joined: &Joined,
    old_cells: &[CellId],
    threads: &Threads,
    rows: &mut Vec<CellRow>,
) -> Result<()> {
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
            old_points: &before.now.mesh.points,
            new_points: &after.now.mesh.points,
            removed_triangles: &labelled(&before.now, &joined.triangles.removed, old_cells),
            new_triangles: &labelled(&after.now, &joined.triangles.inserted, &joined.triangle_to_cell),
            ..LocalChange::default()
        },
        threads,
    )?;
    let inherited = traced.cells.ids().iter().zip(traced.cells.iter());
    rows.extend(inherited.map(|(&cell, row)| (cell, vec![(row.main, 1.0)], row.main)));
    Ok(())
}

/// Lines inherit from the nearest part of the same line of the first mesh.
fn lines(was: &Extracted, is: &Extracted, joined: &Joined, old_cells: &[CellId], rows: &mut Vec<CellRow>) {
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
        rows.push((joined.line_to_cell[l.index()], vec![(old, 1.0)], old));
    }
}

/// Expresses new vertices as means of old ones.
struct Means<'a> {
    forest: &'a Forest,
    /// For each vertex of the forest, its id in the mesh before; none if it was not in it.
    numbers: Vec<MaybeId<VertexId>>,
}

impl<'a> Means<'a> {
    fn new(forest: &'a Forest, was: &Extracted) -> Self {
        Self { forest, numbers: was.numbers(forest.reference.len()) }
    }

    /// Returns the old vertices that a vertex is a mean of, in ascending order, with their shares.
    fn of(&self, vertex: ForestVertexId) -> Vec<(VertexId, f64)> {
        let mut parts: BTreeMap<VertexId, f64> = BTreeMap::new();
        let mut open = vec![(vertex, 1.0)];
        while let Some((v, share)) = open.pop() {
            match self.numbers[v.index()].get() {
                Some(known) => *parts.entry(known).or_default() += share,
                None => {
                    let origin = self.forest.origin[v.index() - self.forest.n_first_vertices];
                    open.extend(self.forest.edges[origin.index()].ends.map(|end| (end, 0.5 * share)));
                }
            }
        }
        parts.into_iter().collect()
    }
}
