//! Triangles divided where they meet, cluster by cluster: what happens at one crossing does not depend on any
//! other.

use std::collections::BTreeMap;

use crate::base::{Csr, DisjointSets, Point, Threads, VertexId, splitmix64};
use crate::geometry::vector::add;
use crate::preflight::crossing::own_crossings;
use crate::preflight::cut::{Cut, Rule};

/// How often the points of a cluster are shifted by chance where dividing it fails.
const ATTEMPTS: u64 = 4;

/// By how much they are shifted, over the distance of points that are one place.
const SHIFT: f64 = 300.0;

/// Triangles that share what they have in common.
#[derive(Clone, Debug, Default)]
pub(crate) struct Divided {
    /// The given points, some of them shifted, then new ones.
    pub(crate) points: Vec<Point>,
    /// The pieces, each with the given triangle that it is or is part of.
    pub(crate) pieces: Vec<([VertexId; 3], u32)>,
    /// The vertex that each given point has become.
    pub(crate) vertex_to_kept: Vec<VertexId>,
    /// Whether each given triangle belongs to a cluster of triangles that met.
    pub(crate) is_cut: Vec<bool>,
    /// The number of these clusters.
    pub(crate) clusters: usize,
    /// How many of them were divided only after their points had been shifted.
    pub(crate) shifted: usize,
}

/// A cluster: triangles connected by crossings, or by the corners of triangles that cross others, with all
/// triangles at these corners.
struct Cluster {
    triangles: Vec<u32>,
    /// Their vertices, in rising order, and whether each is a corner of a triangle that crosses.
    vertices: Vec<VertexId>,
    is_inner: Vec<bool>,
}

/// Divides triangles where they meet. Points nearer than `near` are one place.
///
/// # Errors
/// A place where dividing failed.
pub(super) fn divide(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    near: f64,
    threads: &Threads,
) -> Result<Divided, Point> {
    let clusters = clusters(points, triangles, threads);
    let cuts = threads.map(clusters.len(), |k| clusters[k].cut(points, triangles, near));
    let mut divided = Divided { points: points.to_vec(), clusters: clusters.len(), ..Divided::default() };
    let mut kept: Vec<VertexId> = (0..points.len()).map(VertexId::new).collect();
    let mut is_cut = vec![false; triangles.len()];
    for (cluster, cut) in clusters.iter().zip(cuts) {
        let Some((cut, attempt)) = cut else {
            return Err(points[cluster.vertices[0].index()]);
        };
        divided.shifted += usize::from(attempt > 0);
        let (n_given, first) = (cluster.vertices.len(), divided.points.len());
        let global = |v: VertexId| match v.index().checked_sub(n_given) {
            None => cluster.vertices[v.index()],
            Some(new) => VertexId::new(first + new),
        };
        for (v, p) in cluster.vertices.iter().zip(&cut.points) {
            divided.points[v.index()] = *p;
        }
        divided.points.extend(&cut.points[n_given..]);
        for (v, to) in cluster.vertices.iter().zip(&cut.vertex_to_kept) {
            if global(*to) != *v {
                kept[v.index()] = global(*to);
            }
        }
        cluster.triangles.iter().for_each(|&t| is_cut[t as usize] = true);
        let pieces =
            cut.pieces.iter().map(|(t, origin)| (t.map(global), cluster.triangles[*origin as usize]));
        divided.pieces.extend(pieces);
    }
    for (t, triangle) in (0u32..).zip(triangles).filter(|(t, _)| !is_cut[*t as usize]) {
        let [a, b, c] = triangle.map(|v| kept[v.index()]);
        if a != b && b != c && c != a {
            divided.pieces.push(([a, b, c], t));
        }
    }
    Ok(Divided { is_cut, vertex_to_kept: kept, ..divided })
}

fn clusters(points: &[Point], triangles: &[[VertexId; 3]], threads: &Threads) -> Vec<Cluster> {
    let pairs = own_crossings(points, triangles, threads);
    let mut is_inner = vec![false; points.len()];
    for t in pairs.as_flattened() {
        triangles[*t as usize].iter().for_each(|v| is_inner[v.index()] = true);
    }
    let at = Csr::from_pairs(points.len(), || {
        let is_inner = &is_inner;
        (0u32..).zip(triangles).flat_map(move |(t, corners)| {
            corners.iter().filter(|v| is_inner[v.index()]).map(move |v| (v.index(), t))
        })
    });
    let mut sets = DisjointSets::new(triangles.len());
    pairs.iter().for_each(|[s, t]| sets.join(*s, *t));
    for star in at.iter() {
        star.windows(2).for_each(|pair| sets.join(pair[0], pair[1]));
    }
    let roots = sets.roots();
    let mut by_root: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (t, corners) in (0u32..).zip(triangles) {
        if corners.iter().any(|v| is_inner[v.index()]) {
            by_root.entry(roots[t as usize]).or_default().push(t);
        }
    }
    let cluster = |own: Vec<u32>| {
        let mut vertices: Vec<VertexId> = own.iter().flat_map(|&t| triangles[t as usize]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let is_inner = vertices.iter().map(|v| is_inner[v.index()]).collect();
        Cluster { triangles: own, vertices, is_inner }
    };
    by_root.into_values().map(cluster).collect()
}

impl Cluster {
    /// The pieces of the cluster, in its own numbers, and the number of the attempt. `None` if all fail.
    fn cut(&self, points: &[Point], triangles: &[[VertexId; 3]], near: f64) -> Option<(Cut, u64)> {
        let id = |v: VertexId| VertexId::new(self.vertices.partition_point(|w| *w < v));
        let triangles: Vec<[VertexId; 3]> =
            self.triangles.iter().map(|&t| triangles[t as usize].map(id)).collect();
        let given: Vec<Point> = self.vertices.iter().map(|v| points[v.index()]).collect();
        let group_of = vec![0; triangles.len()];
        let rule = Rule { group_of: &group_of, admits: &|_, _| true, near, crossings: true };
        (0..ATTEMPTS).find_map(|attempt| {
            let shift = |(i, p): (usize, &Point)| match attempt > 0 && self.is_inner[i] {
                true => add(*p, chance(attempt, self.vertices[i], attempt as f64 * SHIFT * near)),
                false => *p,
            };
            let points: Vec<Point> = given.iter().enumerate().map(shift).collect();
            let cut = Cut::new(&points, &triangles, &rule, &Threads::single())?;
            Some((cut, attempt))
        })
    }
}

/// A vector of components up to `most`, by chance but always the same.
fn chance(attempt: u64, v: VertexId, most: f64) -> Point {
    [0, 1, 2].map(|axis| {
        let number = splitmix64(splitmix64(u64::from(v.0) << 8 | attempt) ^ axis);
        most * (2.0 * number as f64 / u64::MAX as f64 - 1.0)
    })
}
