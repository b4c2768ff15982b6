//! Rigid bodies: a body that rotates and translates as a whole carries the volume around it along, by two
//! numbers per vertex.
//!
//! ```text
//!   x' = x + sum over bodies of ( (R(e_r angle) - 1)(x - c) + e_t d ) + what the graph says of the rest
//! ```
//!
//! A body's motion is the rigid one that best fits that of its vertices: a translation `d` of its centre `c`
//! and a rotation. Each of the two reaches a vertex by its share, 1 on the body and 0 at all other prescribed
//! vertices (see `fields`, and `band` for bodies that keep moving): a vertex near a rotating body moves along
//! an arc, where a weighted sum of displacements would cut across it and flatten cells. Any other motion of
//! the boundary is left to the graph, so that the boundary arrives where it should. The shares belong to the
//! reference mesh: a step depends on the displacement alone.

mod band;
mod fields;
mod rigid;

use std::time::Instant;

use pulp::NullaryFnOnce;

#[cfg(target_arch = "x86_64")]
use crate::base::four::Wide;
use crate::base::four::{FourLanes, Plain};
use crate::base::{DisjointSets, Error, Point, Result, Threads, VertexId};
use crate::geometry::vector::{add, distance, norm, sub};
use crate::mesh::{Boundary, Mesh, bounds};
use crate::motion::interface::for_each_wall_facet;
use crate::motion::methods::bodies::fields::Fields;
use crate::motion::methods::bodies::rigid::Rigid;
use crate::motion::methods::delaunay::{Delaunay, GraphFollower};
use crate::motion::methods::{Follower, Prepare, Prepared, Reference, Scene};
use crate::motion::options::{FacetSet, Strain};
use crate::motion::update::{Displacements, Padded, WeightTable};

/// Shares of all bodies at every vertex, and the graph for the rest of the motion.
#[derive(Debug)]
struct RigidBodies {
    /// The nodes of each body.
    nodes: Vec<Vec<u32>>,
    /// The vertex of each node.
    vertices: Vec<VertexId>,
    fields: Fields,
    graph: GraphFollower,
}

/// A body moves rigidly when its vertices end within this fraction of the largest displacement of where the
/// rigid motion takes them: then the graph has nothing to do.
const ROUNDING: f64 = 1e-13;

/// Vertices per chunk.
const CHUNK: usize = 1 << 12;

/// Bodies, and the graph for the motion that none of them carries.
#[derive(Debug)]
pub(crate) struct Bodies {
    /// The vertices of each body.
    bodies: Vec<Vec<VertexId>>,
    strain: Strain,
    graph: Delaunay,
}

impl Bodies {
    /// The bodies of a mesh: those of `sets`, or where there are none, the connected parts of its walls.
    ///
    /// # Errors
    /// When a set has fewer than three vertices, has one that is not driven, or shares one with another set;
    /// when the walls are all in one piece.
    pub(crate) fn new(sets: &[FacetSet], reference: &mut Reference<'_>) -> Result<Self> {
        let bodies = body_vertices(sets, reference.mesh, reference.boundary, &reference.options.also_moved)?;
        Ok(Self { bodies, strain: reference.options.strain, graph: Delaunay::new(reference) })
    }
}

impl Prepare for Bodies {
    fn prepare(&self, scene: &Scene<'_>, points: &[Point], threads: &Threads) -> Result<Prepared> {
        let Prepared { follower, staying, graph_tets, mut setup } =
            self.graph.on_graph(scene, points, threads)?;
        let begin = Instant::now();
        let follower = RigidBodies::new(self, scene, &scene.following(&staying), points, follower, threads)?;
        setup.seconds.system += begin.elapsed().as_secs_f64();
        Ok(Prepared { follower, staying, graph_tets, setup }.boxed())
    }
}

impl RigidBodies {
    /// Computes the shares of all vertices at `points`; `free` are those that follow.
    ///
    /// # Errors
    /// When a free vertex is a corner of no cell, or when all cells at one are flat.
    fn new(
        method: &Bodies,
        scene: &Scene<'_>,
        free: &[VertexId],
        points: &[Point],
        graph: GraphFollower,
        threads: &Threads,
    ) -> Result<Self> {
        let (nodes, tets) = (scene.nodes, scene.corners);
        let driven = &nodes.vertices[..nodes.n_driven];
        let node = |v: &VertexId| driven.binary_search(v).ok().map(|i| i as u32);
        let nodes_of_body = |body: &Vec<VertexId>| body.iter().filter_map(node).collect();
        let nodes_of: Vec<Vec<u32>> = method.bodies.iter().map(nodes_of_body).collect();
        let fields = match method.strain {
            Strain::Even => Fields::new(&nodes_of, tets, points, (free, nodes), threads)?,
            Strain::Band => Fields::of_band(&nodes_of, tets, points, nodes),
        };
        Ok(Self { nodes: nodes_of, vertices: nodes.vertices.clone(), fields, graph })
    }

    /// Moves the vertices of `out`, which begin with vertex `first`, along with the bodies.
    fn move_along(&self, motions: &[Rigid], from: &[Point], first: usize, out: &mut [Point]) {
        let fields = &self.fields;
        #[cfg(target_arch = "x86_64")]
        if let Some(machine) = pulp::x86::V3::try_new() {
            return machine.vectorize(MoveAlong::<Wide> { machine, motions, fields, from, first, out });
        }
        MoveAlong::<Plain> { machine: (), motions, fields, from, first, out }.call();
    }
}

impl Follower for RigidBodies {
    fn follow(
        &self,
        from: &[Point],
        displacements: &Displacements<'_>,
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<usize> {
        let table = displacements.table();
        let motions: Vec<Rigid> = (self.nodes.iter())
            .map(|nodes| {
                let pairs = nodes.iter().map(|&n| {
                    let x = from[self.vertices[n as usize].index()];
                    (x, add(x, table[n as usize].point()))
                });
                Rigid::fit(&pairs.collect::<Vec<_>>())
            })
            .collect();
        let chunks = out.chunks_mut(CHUNK).enumerate().collect();
        threads
            .each(chunks, |(i, out): (usize, &mut [Point])| self.move_along(&motions, from, i * CHUNK, out));
        let places = self.vertices.iter().zip(&*table);
        let rest = places.map(|(v, d)| sub(add(from[v.index()], d.point()), out[v.index()]));
        let rest: Vec<Padded> = rest.map(Padded::new).collect();
        let largest = |of: &[Padded]| of.iter().map(|d| norm(d.point())).fold(0.0, f64::max);
        let mut iterations = 0;
        if largest(&rest) > ROUNDING * largest(&table) {
            let carried = out.to_vec();
            let rest = Displacements::All(rest.into_iter().chain([Padded::default()]).collect());
            iterations = self.graph.follow(&carried, &rest, out, threads)?;
        }
        for (v, d) in self.vertices.iter().zip(&*table) {
            out[v.index()] = add(from[v.index()], d.point());
        }
        Ok(iterations)
    }

    fn weights(&self) -> Option<&WeightTable> {
        self.graph.weights()
    }
}

/// Moves consecutive vertices, beginning with `first`, along with the bodies.
struct MoveAlong<'a, F: FourLanes> {
    machine: F::Machine,
    motions: &'a [Rigid],
    fields: &'a Fields,
    from: &'a [Point],
    first: usize,
    out: &'a mut [Point],
}

impl<F: FourLanes> NullaryFnOnce for MoveAlong<'_, F> {
    type Output = ();

    /// Four vertices at a time, the last group filled up by repeating a vertex: this takes 0.35 of the time
    /// of one by one.
    #[inline(always)]
    fn call(self) {
        let Self { machine, motions, fields, from, first, out } = self;
        for (i, out) in (0..).step_by(4).zip(out.chunks_mut(4)) {
            let mut places = [[0.0; 4]; 3];
            let last = out.len() - 1;
            let vertex = |k: usize| first + i + k.min(last);
            for k in 0..4 {
                let p = from[vertex(k)];
                (places[0][k], places[1][k], places[2][k]) = (p[0], p[1], p[2]);
            }
            let p =
                [F::load(machine, &places[0]), F::load(machine, &places[1]), F::load(machine, &places[2])];
            let mut moved = p;
            for (b, motion) in motions.iter().enumerate() {
                let of = |k: usize| fields.of(vertex(k))[b];
                let [p0, p1, p2, p3] = [of(0), of(1), of(2), of(3)];
                let shares = [[p0[0], p1[0], p2[0], p3[0]], [p0[1], p1[1], p2[1], p3[1]]];
                let change = motion.displacement::<F>(machine, p, shares);
                moved = [moved[0] + change[0], moved[1] + change[1], moved[2] + change[2]];
            }
            let [x, y, z] = [moved[0].stored(), moved[1].stored(), moved[2].stored()];
            for (k, out) in out.iter_mut().enumerate() {
                *out = [x[k], y[k], z[k]];
            }
        }
    }
}

/// The vertices of each body: those of `sets`, or without any, those of each connected part of the walls
/// except the part with the largest extent.
///
/// Walls are the boundary, and interior facets whose vertices the caller moves (`also_moved`), such as those
/// between fluid and solid.
///
/// # Errors
/// When a set has fewer than three vertices, has one that is not driven, or shares one with another set; when
/// the walls are all in one piece.
fn body_vertices(
    sets: &[FacetSet],
    mesh: &Mesh,
    boundary: &Boundary,
    also_moved: &[VertexId],
) -> Result<Vec<Vec<VertexId>>> {
    let mut is_moved = vec![false; mesh.points.len()];
    boundary.vertices.iter().chain(also_moved).for_each(|v| is_moved[v.index()] = true);
    if sets.is_empty() {
        return inner_parts(mesh, boundary, &is_moved);
    }
    let mut owner = vec![None; mesh.points.len()];
    for (i, set) in sets.iter().enumerate() {
        if set.vertices.len() < 3 {
            return Err(Error::options(format!(
                "the body {} has {} vertices; at least 3 are needed",
                set.name,
                set.vertices.len()
            ))
            .remedy("name patches with facets"));
        }
        for &v in &set.vertices {
            if let Some(other) = owner[v.index()].replace(i).filter(|other| *other != i) {
                return Err(Error::options(format!(
                    "the bodies {} and {} share vertex {v}",
                    sets[other].name, set.name
                ))
                .remedy("connected patches move together: name both as one body, or only one of them"));
            }
            if !is_moved[v.index()] {
                return Err(Error::options(format!(
                    "the body {} has an interior vertex that is not moved",
                    set.name
                ))
                .at(format!("vertex {v}"))
                .remedy("name patches of the boundary, or interior patches whose vertices are also moved"));
            }
        }
    }
    Ok(sets.iter().map(|set| set.vertices.clone()).collect())
}

fn inner_parts(mesh: &Mesh, boundary: &Boundary, is_moved: &[bool]) -> Result<Vec<Vec<VertexId>>> {
    let mut sets = DisjointSets::new(is_moved.len());
    sets.join_all(boundary.facets.iter());
    // Where only the boundary is moved, no interior facet is a wall.
    let n_moved = is_moved.iter().filter(|moved| **moved).count();
    if n_moved > boundary.vertices.len() {
        for_each_wall_facet(mesh, |facet| {
            if facet.iter().all(|v| is_moved[v.index()]) {
                sets.join_all([facet]);
            }
        });
    }
    let mut parts: Vec<Vec<VertexId>> = Vec::new();
    let mut place = std::collections::HashMap::new();
    for v in (0..is_moved.len()).filter(|&v| is_moved[v]).map(VertexId::new) {
        let at = *place.entry(sets.root(v.0)).or_insert_with(|| {
            parts.push(Vec::new());
            parts.len() - 1
        });
        parts[at].push(v);
    }
    // Vertices that the caller moves one by one are not bodies.
    parts.retain(|part| part.len() >= 3);
    let extent = |part: &Vec<VertexId>| {
        let places: Vec<Point> = part.iter().map(|v| mesh.points[v.index()]).collect();
        bounds(&places).map_or(0.0, |[low, high]| distance(low, high))
    };
    let extents: Vec<f64> = parts.iter().map(extent).collect();
    let outer = (1..parts.len()).fold(0, |i, j| if extents[j] > extents[i] { j } else { i });
    if parts.len() < 2 {
        return Err(Error::options("all walls are connected: no part of them is a separate body")
            .remedy("name the patches that move as bodies, move an interior patch, or use another method"));
    }
    parts.remove(outer);
    Ok(parts)
}
