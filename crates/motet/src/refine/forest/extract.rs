//! The mesh of a closed forest: tets, triangles, lines, fixed edges, and vertices in an order that depends
//! only on what is divided.

use super::close::Cut;
use super::patterns::{self, patterns};
use super::{Forest, NONE};
use crate::base::{Error, Point, Result, TetId, VertexId};
use crate::geometry::vector::{add, scale};
use crate::mesh::TetMesh;

/// A mesh, and the counterparts of its vertices and cells in the forest or the first mesh.
#[derive(Clone, Debug, Default)]
pub(in crate::refine) struct Extracted {
    pub(in crate::refine) mesh: TetMesh,
    /// For each vertex, its id in the forest.
    pub(in crate::refine) vertices: Vec<u32>,
    /// For each tet, the tet of the forest that it is, or is a piece of.
    pub(in crate::refine) nodes: Vec<u32>,
    /// For each triangle, the triangle of the first mesh that it is a part of.
    pub(in crate::refine) triangles: Vec<u32>,
    /// For each line, the line of the first mesh that it is a part of.
    pub(in crate::refine) lines: Vec<u32>,
}

impl Extracted {
    /// For each of the `n` vertices of the forest, its number in the mesh; [`NONE`] if it is not in the mesh.
    pub(in crate::refine) fn numbers(&self, n: usize) -> Vec<u32> {
        let mut numbers = vec![NONE; n];
        self.vertices.iter().zip(0..).for_each(|(&v, number)| numbers[v as usize] = number);
        numbers
    }
}

/// Extracts the mesh. `points` holds the positions of forest vertices that were in the mesh before; `before`
/// lists these.
///
/// # Errors
/// When the mesh would have more tets or vertices than there are ids.
pub(in crate::refine) fn extract(
    forest: &Forest,
    first: &TetMesh,
    cuts: &[Cut],
    points: &[Point],
    before: &[u32],
) -> Result<Extracted> {
    let mut numbers = Numbers::new(forest, points, before);
    let mut out = Extracted::default();
    let n = n_tets(forest, cuts);
    out.mesh.tets.reserve_exact(n);
    out.mesh.regions.reserve_exact(n);
    out.nodes.reserve_exact(n);
    let mut open = Vec::new();
    for root in 0..forest.n_roots as u32 {
        open.push(root);
        while let Some(node) = open.pop() {
            let state = forest.states[node as usize];
            let tet = &forest.nodes[node as usize];
            let is_turned = tet.shape.is_mirrored();
            if state.is_divided {
                open.extend((tet.first_child..tet.first_child + 8).rev());
            } else if state.is_cut {
                let cut = cuts.binary_search_by_key(&node, |cut| cut.node).ok();
                let local = forest.local(node);
                for piece in cut.into_iter().flat_map(|i| pieces(&cuts[i])) {
                    let mut vertices = [NONE; 4];
                    for i in 0..4 {
                        vertices[i] = local[usize::from(piece[i])];
                    }
                    out.mesh.tets.push(numbers.tet(vertices, is_turned));
                    out.nodes.push(node);
                }
            } else {
                out.mesh.tets.push(numbers.tet(tet.vertices, is_turned));
                out.nodes.push(node);
            }
        }
        out.mesh.regions.resize(out.mesh.tets.len(), first.regions[root as usize]);
    }
    if out.mesh.tets.len() > TetId::MAX_COUNT || numbers.vertices.len() > VertexId::MAX_COUNT {
        return Err(Error::options(format!(
            "a mesh of {} tets needs more ids than there are",
            out.mesh.tets.len()
        ))
        .remedy("mark fewer tets, or limit the generation"));
    }
    for ((triangle, &patch), i) in first.triangles.iter().zip(&first.patches).zip(0..) {
        numbers.triangle(triangle.map(|v| v.0), &mut out.mesh.triangles);
        out.mesh.patches.resize(out.mesh.triangles.len(), patch);
        out.triangles.resize(out.mesh.triangles.len(), i);
    }
    for ((line, &label), i) in first.lines.iter().zip(&first.line_labels).zip(0..) {
        numbers.edge(line.map(|v| v.0), &mut out.mesh.lines);
        out.mesh.line_labels.resize(out.mesh.lines.len(), label);
        out.lines.resize(out.mesh.lines.len(), i);
    }
    for edge in &first.fixed_edges {
        numbers.edge(edge.map(|v| v.0), &mut out.mesh.fixed_edges);
    }
    out.mesh.fixed_vertices.clone_from(&first.fixed_vertices);
    (out.mesh.points, out.vertices) = (numbers.points, numbers.vertices);
    Ok(out)
}

/// The pieces of a cut tet.
fn pieces(cut: &Cut) -> &'static [[u8; 4]] {
    &patterns(cut.goal.mask, cut.goal.cuts)[usize::from(cut.goal.way)]
}

fn n_tets(forest: &Forest, cuts: &[Cut]) -> usize {
    let n_divided = forest.states.iter().filter(|state| state.is_divided).count();
    forest.n_roots + 7 * n_divided + cuts.iter().map(|cut| pieces(cut).len() - 1).sum::<usize>()
}

/// A number that means: none yet, but the vertex was in the mesh before.
const OLD: u32 = NONE - 1;

/// The numbers of vertices: those of the first mesh unchanged, then the others in the order in which tets use
/// them.
struct Numbers<'a> {
    forest: &'a Forest,
    known: &'a [Point],
    number: Vec<u32>,
    vertices: Vec<u32>,
    points: Vec<Point>,
}

impl<'a> Numbers<'a> {
    fn new(forest: &'a Forest, known: &'a [Point], before: &[u32]) -> Self {
        let (n, n_first) = (forest.reference.len(), forest.n_first_vertices);
        let mut number = vec![NONE; n];
        before.iter().for_each(|&v| number[v as usize] = OLD);
        number.iter_mut().zip(0..n_first as u32).for_each(|(number, v)| *number = v);
        let (mut vertices, mut points) = (Vec::with_capacity(n), Vec::with_capacity(n));
        vertices.extend(0..n_first as u32);
        points.extend_from_slice(&known[..n_first]);
        Self { forest, known, number, vertices, points }
    }

    #[inline]
    fn of(&mut self, v: u32) -> VertexId {
        let number = self.number[v as usize];
        if number < OLD { VertexId(number) } else { self.add(v) }
    }

    fn add(&mut self, v: u32) -> VertexId {
        let point = self.place(v);
        let number = self.vertices.len() as u32;
        self.number[v as usize] = number;
        self.vertices.push(v);
        self.points.push(point);
        VertexId(number)
    }

    /// Returns a tet; if it is turned, its first two vertices are exchanged after numbering.
    #[inline]
    fn tet(&mut self, vertices: [u32; 4], is_turned: bool) -> [VertexId; 4] {
        let mut tet = [VertexId(NONE); 4];
        for i in 0..4 {
            tet[i] = self.of(vertices[i]);
        }
        if is_turned {
            tet.swap(0, 1);
        }
        tet
    }

    /// The position of a vertex; a new one lies in the middle of its edge at current positions.
    fn place(&self, v: u32) -> Point {
        let i = v as usize;
        match self.number[i] {
            NONE => {
                let origin = self.forest.origin[i - self.forest.n_first_vertices];
                let [p, q] = self.forest.edges[origin as usize].ends;
                scale(add(self.place(p), self.place(q)), 0.5)
            }
            OLD => self.known[i],
            number => self.points[number as usize],
        }
    }

    /// Adds the parts of a triangle of the first mesh.
    fn triangle(&mut self, corners: [u32; 3], out: &mut Vec<[VertexId; 3]>) {
        let edges = [[1, 2], [2, 0], [0, 1]].map(|[i, j]| self.forest.root_edge([corners[i], corners[j]]));
        self.part(corners, edges.map(|edge| edge.unwrap_or(NONE)), out);
    }

    /// Adds the parts of a triangle; edge `k` is opposite corner `k`.
    fn part(&mut self, corners: [u32; 3], edges: [u32; 3], out: &mut Vec<[VertexId; 3]>) {
        let forest = self.forest;
        let middles = edges.map(|edge| forest.split_middle(edge));
        let half = |edge: u32, end: u32| forest.half(edge, end);
        if let [Some(x), Some(y), Some(z)] = middles {
            let [a, b, c] = corners;
            let [yz, zx, xy] = forest.inner_edges([x, y, z]).unwrap_or([NONE; 3]);
            self.part([a, z, y], [yz, half(edges[1], a), half(edges[2], a)], out);
            self.part([z, b, x], [half(edges[0], b), zx, half(edges[2], b)], out);
            self.part([y, x, c], [half(edges[0], c), half(edges[1], c), xy], out);
            self.part([x, y, z], [yz, zx, xy], out);
            return;
        }
        let is_second = forest.is_cut_from_second(edges, middles);
        let parts = patterns::cut(corners, middles, is_second);
        out.extend(parts.into_iter().map(|part| part.map(|v| self.of(v))));
    }

    /// Adds the parts of an edge of the first mesh.
    fn edge(&mut self, ends: [u32; 2], out: &mut Vec<[VertexId; 2]>) {
        let edge = self.forest.root_edge(ends).unwrap_or(NONE);
        self.edge_part(ends, edge, out);
    }

    fn edge_part(&mut self, [u, v]: [u32; 2], edge: u32, out: &mut Vec<[VertexId; 2]>) {
        match self.forest.split_middle(edge) {
            None => out.push([self.of(u), self.of(v)]),
            Some(middle) => {
                self.edge_part([u, middle], self.forest.half(edge, u), out);
                self.edge_part([middle, v], self.forest.half(edge, v), out);
            }
        }
    }
}

impl Forest {
    /// The corners of a tet, then the middles of its edges.
    pub(in crate::refine) fn local(&self, node: u32) -> [u32; 10] {
        let mut local = [NONE; 10];
        local[..4].copy_from_slice(&self.nodes[node as usize].vertices);
        for (e, edge) in self.edges_of[node as usize].iter().enumerate() {
            local[4 + e] = self.edges[*edge as usize].middle;
        }
        local
    }

    /// The vertex in the middle of an edge, if that is split.
    fn split_middle(&self, edge: u32) -> Option<u32> {
        (edge != NONE && self.is_split[edge as usize]).then(|| self.edges[edge as usize].middle)
    }

    /// The half of an edge at one of its ends.
    fn half(&self, edge: u32, end: u32) -> u32 {
        let edge = &self.edges[edge as usize];
        edge.halves[usize::from(edge.ends[0] != end)]
    }

    /// The tet of the first mesh that a tet lies in.
    pub(in crate::refine) fn root(&self, mut node: u32) -> u32 {
        while self.nodes[node as usize].parent != NONE {
            node = self.nodes[node as usize].parent;
        }
        node
    }
}
