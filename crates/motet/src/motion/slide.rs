//! Flat parts of the boundary whose vertices slide in their plane.
//!
//! An inlet is cut across a vessel; when the wall moves, its rim goes along and the
//! vertices between must follow. They hang in the Delaunay triangulation of the
//! vertices around them in the plane, just as inner vertices hang in the one in space.
//! In fact it is the same code: with one more node above the plane, the tets over the
//! plane stand on the triangles of the plane's own Delaunay triangulation (the sphere
//! through a triangle and that node cuts the plane in the triangle's circle).

use std::collections::HashSet;

use crate::base::{Error, Point, Result, Threads, VertexId, rising_list};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, cross, dot, in_range, norm, scale, sub};
use crate::mesh::Boundary;
use crate::motion::graph::{hang, triangulate};
use crate::motion::options::FacetSet;
use crate::motion::update::Padded;

/// Vertices of a flat patch may be off their plane by this part of its radius. Real inlets
/// are cut by meshers, not by rulers: 0.003 was met. The displacement is interpolated
/// by where they lie in the plane; what they are off it stays.
const FLAT: f64 = 1e-2;

/// The vertices of one flat patch.
#[derive(Debug)]
pub(crate) struct Slide {
    pub(crate) normal: Point,
    /// Nodes of the sliding vertices.
    pub(crate) sliding: Vec<u32>,
    /// For each the nodes that it follows, and their weights.
    follows: Vec<([u32; 4], [f64; 4])>,
}

/// A facet by its corners, in whatever order.
type Key = Vec<VertexId>;

pub(crate) fn key(ring: &[VertexId]) -> Key {
    rising_list(ring)
}

/// For each set its vertices that slide: those on no boundary facet outside the set.
pub(crate) fn free_vertices(sets: &[FacetSet], boundary: &Boundary, n_points: usize) -> Vec<Vec<VertexId>> {
    if sets.is_empty() {
        return Vec::new();
    }
    let keys: Vec<HashSet<Key>> = sets.iter().map(|s| s.rings.iter().map(key).collect()).collect();
    // Bit i: on a facet of set i; the last bit: on a facet of none.
    const OTHER: u32 = u32::MAX;
    let mut on = vec![None::<u32>; n_points];
    let rings = FacetSet::of_boundary(boundary, "", |_| true).rings;
    for (corners, vertices) in rings.iter().zip(boundary.facets.iter()) {
        let corners = key(corners);
        let set = keys.iter().position(|keys| keys.contains(&corners)).map_or(OTHER, |i| i as u32);
        for v in vertices {
            let on = &mut on[v.index()];
            *on = if on.is_none_or(|before| before == set) { Some(set) } else { Some(OTHER) };
        }
    }
    let free = |(i, set): (usize, &FacetSet)| {
        set.vertices.iter().copied().filter(|v| on[v.index()] == Some(i as u32)).collect()
    };
    sets.iter().enumerate().map(free).collect()
}

impl Slide {
    /// `sliding` follow the other vertices of `set`; `node` gives the node of a vertex.
    pub(crate) fn new(
        points: &[Point],
        set: &FacetSet,
        sliding: &[VertexId],
        node: impl Fn(VertexId) -> u32,
        threads: &Threads,
    ) -> Result<Self> {
        let place = |v: &VertexId| points[v.index()];
        let about = |e: Error| e.at(format!("sliding patch {}", set.name));
        let plane = Plane::new(points, set).map_err(about)?;
        let sources: Vec<VertexId> =
            set.vertices.iter().copied().filter(|v| sliding.binary_search(v).is_err()).collect();
        let mut nodes: Vec<Point> = sources.iter().map(|v| plane.flatten(place(v))).collect();
        nodes.push([0.0, 0.0, plane.size]);
        let flat: Vec<Point> = sliding.iter().map(|v| plane.flatten(place(v))).collect();
        let graph = triangulate(&nodes, threads).map_err(|_| {
            about(Error::input(format!(
                "{} vertices on its rim, not all in a line, are needed for others to follow; it has {}",
                3,
                sources.len()
            )))
        })?;
        let hanging = hang(&graph, &flat, threads);
        // The node above the plane has no weight for a point in it; any node does in its place.
        let node_of = |i: u32| node(sources.get(i as usize).copied().unwrap_or(sources[0]));
        let above = sources.len() as u32;
        let follows = hanging.tet.iter().zip(&hanging.weights).map(|(&tet, weights)| {
            let tet = hanging.tets[tet as usize];
            let mut weights = *weights;
            (0..4).filter(|&i| tet[i] == above).for_each(|i| weights[i] = 0.0);
            (tet.map(node_of), weights)
        });
        Ok(Self {
            normal: plane.normal,
            sliding: sliding.iter().map(|&v| node(v)).collect(),
            follows: follows.collect(),
        })
    }

    pub(crate) fn n_sliding(&self) -> usize {
        self.sliding.len()
    }

    /// Gives the sliding nodes their displacement.
    pub(crate) fn apply(&self, displacement: &mut [Padded]) {
        for (&sliding, (nodes, weights)) in self.sliding.iter().zip(&self.follows) {
            let sum = nodes.iter().zip(weights).fold([0.0; 3], |sum, (&node, &weight)| {
                add(sum, scale(displacement[node as usize].point(), weight))
            });
            displacement[sliding as usize] = Padded::new(sum);
        }
    }
}

/// The plane of a flat patch.
pub(crate) struct Plane {
    centre: Point,
    axes: [Point; 2],
    pub(crate) normal: Point,
    size: f64,
}

impl Plane {
    pub(crate) fn new(points: &[Point], set: &FacetSet) -> Result<Self> {
        let corners = set.vertices.iter().map(|v| points[v.index()]);
        let centre = scale(corners.clone().fold([0.0; 3], add), 1.0 / set.vertices.len().max(1) as f64);
        let size = corners.clone().map(|p| norm(sub(p, centre))).fold(0.0, f64::max);
        // Facets of a patch need not all run the same way round: none may cancel another.
        let area = set.triangles().map(|t| area_vector(t.map(|v| points[v.index()])));
        let area = area.fold([0.0; 3], |sum, a| if dot(sum, a) < 0.0 { sub(sum, a) } else { add(sum, a) });
        let normal = scale(area, 1.0 / norm(area));
        if !in_range(normal) {
            return Err(Error::input(format!("its {} facets have no area", set.rings.len()))
                .remedy("name a patch that the mesh has"));
        }
        let off = corners.map(|p| dot(normal, sub(p, centre)).abs()).fold(0.0, f64::max);
        if off > FLAT * size {
            return Err(Error::input(format!(
                "is not flat: {off:.3e} off its plane, at a radius of {size:.3e}"
            ))
            .remedy("let only flat patches slide, such as inlets and outlets"));
        }
        // Along the coordinate axis that is furthest from the normal.
        let least = (0..3).fold(0, |i, j| if normal[j].abs() < normal[i].abs() { j } else { i });
        let across = cross(normal, [0, 1, 2].map(|i| f64::from(u8::from(i == least))));
        let across = scale(across, 1.0 / norm(across));
        Ok(Self { centre, axes: [cross(across, normal), across], normal, size })
    }

    /// Coordinates in the plane; the third is 0.
    fn flatten(&self, p: Point) -> Point {
        let p = sub(p, self.centre);
        [dot(p, self.axes[0]), dot(p, self.axes[1]), 0.0]
    }
}
