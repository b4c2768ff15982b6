//! Guided motion: walls that bend and rotate carry the volume around them along, rotation included.
//!
//! A weighted sum of displacements cannot rotate cells: where a flap bends by 60 degrees, it shears them
//! until they invert. So each node of the graph gets a rotation in addition to its displacement, and the
//! graph gets some interior nodes:
//!
//! 1. The rotation of a boundary vertex is that of its facets. Inside, rotation vectors are harmonic
//!    (harmonic guidance: Zayer, Roessl, Karni, Seidel 2005).
//! 2. Interior nodes move to where the gradient of the motion is nearest to those rotations,
//!    `min sum k_T |grad x' - R_T|^2` over the tets of the graph (Poisson editing: Yu, Zhou, Xu, Shi, Bao,
//!    Guo, Shum 2004). These are sparse systems of some hundred unknowns. They are solved once more, for the
//!    rotations nearest to the gradients of the first solution (as rigid as possible: Sorkine, Alexa 2007),
//!    with compressed tets stiffer.
//! 3. Each node carries an affine map: its displacement and half its gradient. A vertex gets the weighted
//!    mean of those of its four nodes: exact for motions of second order, and without the kinks that linear
//!    weights have where tets of the graph meet.
//!
//! All of it starts from the reference: a step depends on where the boundary is, not on how it got there.

mod affine_blend;
mod helpers;

use std::time::Instant;

use crate::algebra::{Tolerance, conjugate_gradients};
use crate::base::{Point, Result, Threads, VertexId};
use crate::geometry::tet::EDGES;
use crate::geometry::vector::{add, cross, distance, dot, norm, scale, sub};
use crate::motion::elements::{Numbering, System, gradients, laplacian};
use crate::motion::graph::{BuiltGraph, Graph, Walls};
use crate::motion::methods::guided::affine_blend::{Affine, AffineBlend};
use crate::motion::methods::guided::helpers::{Helpers, choose_helpers};
use crate::motion::methods::{Follower, Prepare, Prepared, Reference, Scene};
use crate::motion::nodes::Nodes;
use crate::motion::options::FacetSet;
use crate::motion::polar::Quaternion;
use crate::motion::rotation::Wall;
use crate::motion::update::{Displacements, Padded, WeightTable};

/// The tolerance of a step, far below what affects cells.
const STEP_TOLERANCE: Tolerance = Tolerance { residual: 1e-9, iterations: 10_000 };
/// Small tets are stiff: the power of the edge length in the stiffness for displacements. Powers of -2 to
/// -3.5 were tried on a sphere that shifts and turns and on a flap that bends: weaker than -2.25, the flap's
/// tip inverts cells; stronger than -2.5, the shifted sphere does.
const STIFFNESS_EXPONENT: f64 = -2.25;
/// The power of the edge length in the stiffness for rotations. With -2 the rotated sphere leaves a tenth
/// more bad tets.
const ROTATION_STIFFNESS_EXPONENT: f64 = -1.0;
/// Tets of the graph count from this volume on, relative to the cube of their longest edge: gradients of
/// flatter ones are meaningless.
const MIN_RELATIVE_VOLUME: f64 = 1e-9;

/// Helpers are more than this many edges apart. With 2 a step takes a third of the time on a mesh of 32,000
/// vertices, but a flap that bends by 90 degrees keeps an inverted tet through 16 sweeps of smoothing, and at
/// 60 degrees half as many bad ones again.
const HELPER_RINGS: usize = 1;

const NO_ROW: u32 = u32::MAX;
const NO_NODE: u32 = u32::MAX;

/// The boundary, whose facets guide, and interior vertices that are nodes of the graph.
#[derive(Debug)]
pub(crate) struct Guided {
    facets: FacetSet,
    helpers: Helpers,
    walls: Option<Walls>,
}

impl Guided {
    /// Chooses the helpers of a mesh.
    pub(crate) fn new(reference: &mut Reference<'_>) -> Self {
        let (corners, points) = (reference.corners, &reference.mesh.points);
        Self {
            facets: FacetSet::of_boundary(reference.boundary, "boundary", |_| true),
            helpers: choose_helpers(corners, points, reference.free, HELPER_RINGS),
            walls: reference.walls(),
        }
    }
}

impl Prepare for Guided {
    fn prepare(&self, scene: &Scene<'_>, points: &[Point], threads: &Threads) -> Result<Prepared> {
        let mut nodes = scene.nodes.graph_vertices();
        nodes.extend(&self.helpers.vertices);
        let mut built = BuiltGraph::new(self.walls.as_ref(), &nodes, scene.free, points, threads)?;
        let staying = built.leave_unused(scene.free, scene.is_used);
        let begin = Instant::now();
        let graph_tets = built.holding_tets(&nodes);
        let mut setup = built.setup(nodes.len());
        let BuiltGraph { graph, embedding: found, .. } = built;
        let mut table = WeightTable::fixed(graph.places.len() as u32, points.len());
        for (vertex, (&tet, w)) in scene.following(&staying).iter().zip(found.tet.iter().zip(&found.weights))
        {
            table.set(*vertex, found.tets[tet as usize], *w);
        }
        let lengths = nodes.iter().map(|v| self.helpers.lengths[v.index()]).collect();
        let wall = RotatingWall::new(&self.facets, scene.nodes, points);
        let follower = GuidedFollower::new(graph, table, scene.nodes, lengths, wall)?;
        setup.seconds.system = begin.elapsed().as_secs_f64();
        Ok(Prepared { follower, staying, graph_tets, setup }.boxed())
    }
}

/// A graph whose nodes rotate.
#[derive(Debug)]
struct GuidedFollower {
    /// The vertex of each given node.
    vertices: Vec<VertexId>,
    /// For each given node of the graph, its index among all nodes; helpers come after them.
    of_graph: Vec<u32>,
    /// For each node that is not given, its row in the system; [`NO_ROW`] where all its tets are flat.
    row_of: Vec<u32>,
    /// Nodes without a row, each with the nodes of its flat tets, whose mean displacement it takes.
    flat: Vec<(u32, Vec<u32>)>,
    places: Vec<Point>,
    wall: RotatingWall,
    /// Nodes of the graph that are on no facet: their rotation is harmonic.
    off_wall: Vec<u32>,
    on_wall: Vec<u32>,
    tets: Vec<GraphTet>,
    /// The tets that have a helper, and the numbers of their nodes in the system.
    inner: Vec<u32>,
    inner_numbers: Vec<[u32; 4]>,
    rotation_system: System<f64>,
    position_system: System<f64>,
    blend: AffineBlend,
}

/// The facets whose rotation counts.
#[derive(Debug)]
struct RotatingWall {
    wall: Wall,
    /// The graph node of each of the wall's vertices; [`NO_NODE`] where it has none.
    nodes: Vec<u32>,
}

impl RotatingWall {
    fn new(facets: &FacetSet, nodes: &Nodes, points: &[Point]) -> Self {
        let mut node_of = vec![NO_NODE; points.len()];
        (0u32..).zip(nodes.graph_vertices()).for_each(|(i, v)| node_of[v.index()] = i);
        // Corners only: middle nodes have no facet of their own.
        let mut corners: Vec<VertexId> = facets.rings.items().to_vec();
        corners.sort_unstable();
        corners.dedup();
        let local = |v: VertexId| corners.binary_search(&v).ok().map(|i| i as u32);
        let triangles: Vec<[u32; 3]> =
            (facets.triangles()).filter_map(|t| Some([local(t[0])?, local(t[1])?, local(t[2])?])).collect();
        let places: Vec<Point> = corners.iter().map(|v| points[v.index()]).collect();
        Self {
            wall: Wall::new(&places, &triangles, |_| true),
            nodes: corners.iter().map(|v| node_of[v.index()]).collect(),
        }
    }

    /// The graph nodes of the wall's vertices.
    fn graph_nodes(&self) -> impl Iterator<Item = u32> + '_ {
        self.nodes.iter().copied().filter(|n| *n != NO_NODE)
    }
}

/// A tet of the graph that is not flat.
#[derive(Clone, Copy, Debug)]
struct GraphTet {
    nodes: [u32; 4],
    gradients: [Point; 4],
    volume: f64,
    /// Volume times conductivity.
    stiffness: f64,
    /// The weight of the tet in the gradient at its nodes: volume over the cube of the longest edge.
    weight: f64,
}

impl GraphTet {
    /// The tet with these nodes, `stiffness` times as stiff as its volume is large; `None` where it is flat.
    fn new(nodes: [u32; 4], places: &[Point], stiffness: f64) -> Option<Self> {
        let corners = nodes.map(|n| places[n as usize]);
        let longest = EDGES.iter().map(|&[i, j]| distance(corners[i], corners[j])).fold(0.0, f64::max);
        let (gradients, volume) = gradients(corners)?;
        let weight = volume / (longest * longest * longest);
        let tet = Self { nodes, gradients, volume, stiffness: volume * stiffness, weight };
        (weight > MIN_RELATIVE_VOLUME).then_some(tet)
    }
}

/// What the motion of each node is determined by.
struct Roles {
    /// Nodes whose displacement is solved for, in rising order.
    solved: Vec<u32>,
    /// Nodes that are not given and in no tet, in rising order.
    tetless: Vec<u32>,
    /// Nodes whose rotation is that of the wall, or has no influence.
    on_wall: Vec<u32>,
    off_wall: Vec<u32>,
}

impl Roles {
    fn new(tets: &[GraphTet], wall: &RotatingWall, n_given: usize, n_nodes: usize) -> Self {
        // Nodes in no tet have no influence: those in the place of another, and those that the graph needed
        // in a flat wall.
        let mut is_on_wall = vec![true; n_nodes];
        tets.iter().flat_map(|t| t.nodes).for_each(|n| is_on_wall[n as usize] = false);
        let (tetless, solved) = (n_given as u32..n_nodes as u32).partition(|n| is_on_wall[*n as usize]);
        wall.graph_nodes().for_each(|n| is_on_wall[n as usize] = true);
        let (on_wall, off_wall) = (0..n_nodes as u32).partition(|n| is_on_wall[*n as usize]);
        Self { solved, tetless, on_wall, off_wall }
    }
}

/// The Laplacian of tets of the graph for the nodes `free`, where those of `given` have values; and the
/// numbers of the tets' nodes in it.
fn system<'a>(
    tets: impl Iterator<Item = &'a GraphTet>,
    n_nodes: usize,
    free: &[u32],
    given: &[u32],
    stiffness: impl Fn(&GraphTet) -> f64,
) -> Result<(System<f64>, Vec<[u32; 4]>)> {
    let index = |n: &u32| *n as usize;
    let numbering = Numbering::new(n_nodes, free.iter().map(index), given.iter().map(index));
    let numbered = |tet: &'a GraphTet| Some((tet, numbering.of_tet(tet.nodes.map(|n| n as usize))?));
    let (tets, numbers): (Vec<&GraphTet>, Vec<[u32; 4]>) = tets.filter_map(numbered).unzip();
    let of_tet = |i: usize| laplacian(&tets[i].gradients, stiffness(tets[i]));
    Ok((System::assemble(&numbering, &numbers, of_tet)?, numbers))
}

impl GuidedFollower {
    /// Sets up a graph whose nodes are the given ones, the helpers, and others that it needed; `table` holds
    /// the nodes and weights of each vertex, `lengths` the edge length at the given nodes and the helpers.
    ///
    /// # Errors
    /// When a system cannot be set up.
    fn new(
        Graph { places, tets }: Graph,
        table: WeightTable,
        nodes: &Nodes,
        lengths: Vec<f64>,
        wall: RotatingWall,
    ) -> Result<Self> {
        let (all, n_given) = (places.len(), nodes.of_graph.len());
        let lengths = fill_unknown_lengths(lengths, &tets, all);
        let kept: Vec<GraphTet> = (tets.iter())
            .filter_map(|tet| GraphTet::new(*tet, &places, mean_power(tet, &lengths, STIFFNESS_EXPONENT)))
            .collect();
        let roles = Roles::new(&kept, &wall, n_given, all);
        let mut row_of = vec![NO_ROW; all - n_given];
        (0..).zip(&roles.solved).for_each(|(row, &n)| row_of[n as usize - n_given] = row);
        let fixed: Vec<u32> = (0..n_given as u32).chain(roles.tetless.iter().copied()).collect();
        let (rotation_system, _) = system(kept.iter(), all, &roles.off_wall, &roles.on_wall, |tet| {
            tet.volume * mean_power(&tet.nodes, &lengths, ROTATION_STIFFNESS_EXPONENT)
        })?;
        let has_helper = |t: &u32| kept[*t as usize].nodes.iter().any(|n| *n as usize >= n_given);
        let inner: Vec<u32> = (0..kept.len() as u32).filter(has_helper).collect();
        let inner_tets = inner.iter().map(|&t| &kept[t as usize]);
        let (position_system, inner_numbers) =
            system(inner_tets, all, &roles.solved, &fixed, |tet| tet.stiffness)?;
        Ok(Self {
            vertices: nodes.vertices.clone(),
            of_graph: nodes.of_graph.clone(),
            row_of,
            flat: neighbours_in_tets(&roles.tetless, &tets),
            wall,
            off_wall: roles.off_wall,
            on_wall: roles.on_wall,
            blend: AffineBlend::new(table, &kept, all),
            tets: kept,
            inner,
            inner_numbers,
            rotation_system,
            position_system,
            places,
        })
    }

    /// Appends the displacements of the other nodes to those of the given ones.
    fn extend(&self, moved: &mut Vec<Point>, inner: &[Point]) {
        moved.extend(self.row_of.iter().map(|&row| inner.get(row as usize).copied().unwrap_or([0.0; 3])));
        for (node, near) in &self.flat {
            let sum = near.iter().fold([0.0; 3], |sum, &n| add(sum, moved[n as usize]));
            moved[*node as usize] = scale(sum, 1.0 / near.len().max(1) as f64);
        }
    }

    /// Moves helpers so that gradients are nearest to the guides; `inner` holds a guess on entry. Returns the
    /// number of iterations.
    fn solve(
        &self,
        system: &System<f64>,
        guides: &[Guide],
        given: &[Point],
        inner: &mut [Point],
        threads: &Threads,
    ) -> Result<usize> {
        let mut right = system.coupling.times(given, threads);
        right.iter_mut().for_each(|f| *f = f.map(|x| -x));
        for (&t, guide) in self.inner.iter().zip(guides) {
            let tet = &self.tets[t as usize];
            for (&node, &gradient) in tet.nodes.iter().zip(&tet.gradients) {
                if let Some(row) = (node as usize).checked_sub(self.of_graph.len()) {
                    let row = self.row_of[row] as usize;
                    let change = sub(times(guide.rotation, gradient), gradient);
                    right[row] = add(right[row], scale(change, guide.stiffness));
                }
            }
        }
        let solved =
            conjugate_gradients(&system.inner, &system.sweeps, &right, inner, STEP_TOLERANCE, threads)?;
        Ok(solved.iterations)
    }

    /// The rotation vector of every node, and the number of iterations.
    fn rotation_vectors(&self, moved: &[Point], threads: &Threads) -> Result<(Vec<Point>, usize)> {
        let of_wall = |&node: &u32| Padded::new(moved.get(node as usize).copied().unwrap_or_default());
        let of_wall: Vec<Padded> = self.wall.nodes.iter().map(of_wall).collect();
        let rotations = self.wall.wall.rotations(&of_wall, threads);
        let mut rotation_vectors = vec![[0.0; 3]; self.places.len()];
        for (i, &node) in self.wall.nodes.iter().enumerate().filter(|(_, node)| **node != NO_NODE) {
            rotation_vectors[node as usize] = rotations.of(i).map_or([0.0; 3], |q| rotation_vector(*q));
        }
        let given: Vec<Point> = self.on_wall.iter().map(|&n| rotation_vectors[n as usize]).collect();
        let mut right = self.rotation_system.coupling.times(&given, threads);
        right.iter_mut().for_each(|f| *f = f.map(|x| -x));
        let mut inner = vec![[0.0; 3]; self.off_wall.len()];
        let solved = conjugate_gradients(
            &self.rotation_system.inner,
            &self.rotation_system.sweeps,
            &right,
            &mut inner,
            STEP_TOLERANCE,
            threads,
        )?;
        self.off_wall.iter().zip(inner).for_each(|(&n, vector)| rotation_vectors[n as usize] = vector);
        Ok((rotation_vectors, solved.iterations))
    }

    /// The affine map of every node: its displacement there, and half the mean gradient of the displacement
    /// in its tets.
    fn affine(&self, moved: &[Point]) -> Vec<Affine> {
        let mut sums = vec![[[0.0; 3]; 3]; moved.len()];
        for tet in &self.tets {
            let mut gradient = [[0.0; 3]; 3];
            for (&n, g) in tet.nodes.iter().zip(tet.gradients) {
                let u = moved[n as usize];
                (0..3).for_each(|j| gradient[j] = add(gradient[j], scale(u, g[j])));
            }
            let gradient = gradient.map(|column| scale(column, tet.weight));
            for &n in &tet.nodes {
                let sum = &mut sums[n as usize];
                (0..3).for_each(|j| sum[j] = add(sum[j], gradient[j]));
            }
        }
        self.blend.affine(&self.places, moved, &sums)
    }
}

impl Follower for GuidedFollower {
    fn follow(
        &self,
        from: &[Point],
        displacements: &Displacements<'_>,
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<usize> {
        let table = displacements.table();
        let mut moved: Vec<Point> = self.of_graph.iter().map(|&n| table[n as usize].point()).collect();
        let (rotation_vectors, iterations) = self.rotation_vectors(&moved, threads)?;
        let guides: Vec<Guide> = (self.inner.iter())
            .map(|&t| {
                let tet = &self.tets[t as usize];
                let mean = tet.nodes.iter().fold([0.0; 3], |sum, &n| add(sum, rotation_vectors[n as usize]));
                Guide { rotation: rotation(scale(mean, 0.25)), stiffness: tet.stiffness }
            })
            .collect();
        let mut inner = vec![[0.0; 3]; self.row_of.len() - self.flat.len()];
        let n_given = moved.len();
        // Nodes without a row are numbered as given ones, but no tet couples them.
        let mut given = moved.clone();
        given.resize(n_given + self.flat.len(), [0.0; 3]);
        let first = self.solve(&self.position_system, &guides, &given, &mut inner, threads)?;
        self.extend(&mut moved, &inner);
        // Once more: towards the resulting rotations, and with compressed tets stiffer.
        let guides = threads.map(guides.len(), |i| {
            let tet = &self.tets[self.inner[i] as usize];
            let gradient = deformation(tet, &moved);
            Guide {
                rotation: nearest_rotation(gradient, guides[i].rotation),
                stiffness: tet.stiffness * stiffening(gradient),
            }
        });
        let mut stiffer = self.position_system.clone();
        stiffer.fill(&self.inner_numbers, |i| {
            laplacian(&self.tets[self.inner[i] as usize].gradients, guides[i].stiffness)
        })?;
        let second = self.solve(&stiffer, &guides, &given, &mut inner, threads)?;
        moved.truncate(n_given);
        self.extend(&mut moved, &inner);
        let maps = self.affine(&moved);
        self.blend.apply(&self.places, from, &maps, out, threads);
        for (v, d) in self.vertices.iter().zip(&*table) {
            out[v.index()] = add(from[v.index()], d.point());
        }
        Ok(iterations + first + second)
    }
}

/// Each of `nodes` with the other nodes that it shares tets with.
fn neighbours_in_tets(nodes: &[u32], tets: &[[u32; 4]]) -> Vec<(u32, Vec<u32>)> {
    let of = |&node: &u32| {
        let tets = tets.iter().filter(|tet| tet.contains(&node));
        let mut near: Vec<u32> =
            tets.flatten().copied().filter(|n| nodes.binary_search(n).is_err()).collect();
        near.sort_unstable();
        near.dedup();
        (node, near)
    };
    nodes.iter().map(of).collect()
}

/// The length at every node: a node of unknown length gets the mean of those that it shares tets with.
fn fill_unknown_lengths(mut lengths: Vec<f64>, tets: &[[u32; 4]], n: usize) -> Vec<f64> {
    lengths.resize(n, 0.0);
    let is_known: Vec<bool> = lengths.iter().map(|&length| length > 0.0).collect();
    let mut sums = vec![(0.0, 0.0); n];
    for tet in tets {
        for &other in tet.iter().filter(|i| !is_known[**i as usize]) {
            for &near in tet.iter().filter(|i| is_known[**i as usize]) {
                sums[other as usize].0 += lengths[near as usize];
                sums[other as usize].1 += 1.0;
            }
        }
    }
    let n_known = is_known.iter().filter(|known| **known).count();
    let mean = lengths.iter().sum::<f64>() / n_known.max(1) as f64;
    for ((length, known), (sum, count)) in lengths.iter_mut().zip(is_known).zip(sums) {
        if !known {
            *length = if count > 0.0 { sum / count } else { mean };
        }
    }
    lengths
}

/// The mean over the nodes of a tet of the length there to a power.
fn mean_power(tet: &[u32; 4], lengths: &[f64], power: f64) -> f64 {
    0.25 * tet.iter().map(|&n| lengths[n as usize].powf(power)).sum::<f64>()
}

/// The rotation vector of a quaternion: its axis times its angle, from 0 to pi.
fn rotation_vector([w, x, y, z]: Quaternion) -> Point {
    let side = if w < 0.0 { -1.0 } else { 1.0 };
    let sine = norm([x, y, z]);
    if sine == 0.0 {
        return [0.0; 3];
    }
    scale([x, y, z], side * 2.0 * sine.atan2(w * side) / sine)
}

/// The rotation that a tet of the graph is to take, and its stiffness.
struct Guide {
    rotation: Matrix,
    stiffness: f64,
}

/// A matrix as three columns.
type Matrix = [Point; 3];

fn times(matrix: Matrix, v: Point) -> Point {
    let [a, b, c] = matrix;
    add(add(scale(a, v[0]), scale(b, v[1])), scale(c, v[2]))
}

/// The rotation matrix of a rotation vector (Rodrigues 1840).
fn rotation(vector: Point) -> Matrix {
    let angle = norm(vector);
    let half = 0.5 * angle;
    let (first, of_half) = match angle > 1e-6 {
        true => (angle.sin() / angle, half.sin() / half),
        false => (1.0, 1.0),
    };
    AXES.map(|v| {
        let across = cross(vector, v);
        add(v, add(scale(across, first), scale(cross(vector, across), 0.5 * of_half * of_half)))
    })
}

const AXES: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The gradient of the motion in a tet of the graph: the images of the axes.
fn deformation(tet: &GraphTet, moved: &[Point]) -> Matrix {
    let mut columns = AXES;
    for (&n, g) in tet.nodes.iter().zip(tet.gradients) {
        (0..3).for_each(|j| columns[j] = add(columns[j], scale(moved[n as usize], g[j])));
    }
    columns
}

/// The rotation nearest to a matrix, from one that is near (Mueller, Bender, Chentanez, Macklin 2016); it is
/// proper even for an inverted matrix.
fn nearest_rotation(matrix: Matrix, mut from: Matrix) -> Matrix {
    const ROUNDS: usize = 5;
    for _ in 0..ROUNDS {
        let across = (0..3).fold([0.0; 3], |s, j| add(s, cross(from[j], matrix[j])));
        let along: f64 = (0..3).map(|j| dot(from[j], matrix[j])).sum();
        let step = rotation(scale(across, 1.0 / (along.abs() + 1e-9)));
        from = from.map(|column| times(step, column));
    }
    from
}

/// The factor by which a tet becomes stiffer: the mean stretch of the inverse, 1 for a tet that keeps its
/// shape; at least 1, at most 20.
fn stiffening([a, b, c]: Matrix) -> f64 {
    let cofactors = [cross(b, c), cross(c, a), cross(a, b)];
    let size = (cofactors.iter().map(|v| dot(*v, *v)).sum::<f64>() / 3.0).sqrt();
    let volume = dot(a, cofactors[0]);
    if volume > 0.05 * size { (size / volume).max(1.0) } else { 20.0 }
}
