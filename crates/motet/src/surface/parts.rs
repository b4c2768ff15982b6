//! A surface of which most stays, made even part by part: what stays costs nothing, and parts that are away
//! from each other do not depend on each other.

use std::collections::{BTreeMap, BTreeSet};

use super::{Adapted, Options, adapt_whole};
use crate::base::{DisjointSets, Point, Result, Threads, VertexId, sorted_ids};
use crate::spatial::{BoxTree, bounding_box, expanded};

/// Parts nearer than this times the allowed distance are made even together, so that they do not cross.
const APART: f64 = 2.0;

/// Triangles that change together, and those that stay beside them.
struct Part {
    changing: Vec<u32>,
    beside: Vec<u32>,
}

/// Makes those parts of a surface even that have a point that may change. The order of points is that of
/// [`super::adapt`]; triangles that stay come first.
///
/// # Errors
/// The errors of [`super::adapt`].
pub(super) fn adapt(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    labels: &[u32],
    options: &Options,
    threads: &Threads,
) -> Result<Adapted> {
    let parts = parts(points, triangles, options);
    let watch = threads.watch();
    watch.report_and_check("making the surface even", 0, parts.len())?;
    let made = threads.map(parts.len(), |k| parts[k].adapt(points, triangles, labels, options));
    let sizes = (0..points.len()).map(|v| options.sizes[if options.sizes.len() == 1 { 0 } else { v }]);
    let mut all = Adapted {
        points: points.to_vec(),
        triangles: Vec::new(),
        labels: Vec::new(),
        sizes: sizes.collect(),
    };
    let stays = |t: &[VertexId; 3]| t.iter().all(|v| options.held[v.index()]);
    for (t, label) in triangles.iter().zip(labels).filter(|(t, _)| stays(t)) {
        all.triangles.push(*t);
        all.labels.push(*label);
    }
    for (part, made) in parts.iter().zip(made) {
        part.put(&made?, triangles, &mut all);
    }
    Ok(all)
}

fn parts(points: &[Point], triangles: &[[VertexId; 3]], options: &Options) -> Vec<Part> {
    let held = |t: &[VertexId; 3]| t.iter().all(|v| options.held[v.index()]);
    let (staying, changing): (Vec<u32>, Vec<u32>) =
        (0..triangles.len() as u32).partition(|&t| held(&triangles[t as usize]));
    let reach = APART * options.distance;
    let bounds = |t: &u32| bounding_box(triangles[*t as usize].map(|v| points[v.index()]));
    let trees = [&changing, &staying].map(|list| BoxTree::new(&list.iter().map(bounds).collect::<Vec<_>>()));
    let mut sets = DisjointSets::new(changing.len());
    let mut touching = Vec::new();
    for (i, t) in (0u32..).zip(&changing) {
        trees[0].touching(expanded(bounds(t), reach), &mut touching);
        touching.iter().for_each(|&j| sets.join(i, j));
    }
    let mut by_root: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (t, root) in changing.iter().zip(sets.roots()) {
        by_root.entry(root).or_default().push(*t);
    }
    let part = |changing: Vec<u32>| {
        let mut beside = BTreeSet::new();
        for t in &changing {
            trees[1].touching(expanded(bounds(t), reach), &mut touching);
            beside.extend(touching.iter().map(|&i| staying[i as usize]));
        }
        Part { changing, beside: beside.into_iter().collect() }
    };
    by_root.into_values().map(part).collect()
}

impl Part {
    /// The triangles of the part, those that stay last.
    fn triangles<'a>(&'a self, all: &'a [[VertexId; 3]]) -> impl Iterator<Item = [VertexId; 3]> + 'a {
        self.changing.iter().chain(&self.beside).map(|&t| all[t as usize])
    }

    /// The vertices of the part, in rising order.
    fn vertices(&self, all: &[[VertexId; 3]]) -> Vec<VertexId> {
        let mut vertices: Vec<VertexId> = self.triangles(all).flatten().collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }

    /// The part made even, in numbers of its own.
    fn adapt(
        &self,
        points: &[Point],
        triangles: &[[VertexId; 3]],
        labels: &[u32],
        options: &Options,
    ) -> Result<Adapted> {
        let vertices = self.vertices(triangles);
        let id = |v: VertexId| VertexId::new(vertices.partition_point(|w| *w < v));
        let own: Vec<[VertexId; 3]> = self.triangles(triangles).map(|t| t.map(id)).collect();
        let labels: Vec<u32> =
            self.changing.iter().chain(&self.beside).map(|&t| labels[t as usize]).collect();
        let places: Vec<Point> = vertices.iter().map(|v| points[v.index()]).collect();
        let options = Options {
            sizes: match options.sizes.len() {
                1 => options.sizes.clone(),
                _ => vertices.iter().map(|v| options.sizes[v.index()]).collect(),
            },
            held: vertices.iter().map(|v| options.held[v.index()]).collect(),
            ..*options
        };
        adapt_whole(&places, &own, &labels, &options, &Threads::single())
    }

    /// Puts the part as made even into the whole surface.
    fn put(&self, made: &Adapted, triangles: &[[VertexId; 3]], all: &mut Adapted) {
        let (vertices, first) = (self.vertices(triangles), all.points.len());
        let global = |v: VertexId| match v.index().checked_sub(vertices.len()) {
            None => vertices[v.index()],
            Some(new) => VertexId::new(first + new),
        };
        for (k, v) in vertices.iter().enumerate() {
            (all.points[v.index()], all.sizes[v.index()]) = (made.points[k], made.sizes[k]);
        }
        all.points.extend(&made.points[vertices.len()..]);
        all.sizes.extend(&made.sizes[vertices.len()..]);
        let mut beside: BTreeSet<[VertexId; 3]> =
            self.beside.iter().map(|&t| sorted_ids(triangles[t as usize])).collect();
        for (t, label) in made.triangles.iter().zip(&made.labels) {
            let t = t.map(global);
            if !beside.remove(&sorted_ids(t)) {
                all.triangles.push(t);
                all.labels.push(*label);
            }
        }
    }
}
