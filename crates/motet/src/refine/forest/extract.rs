//! The mesh of a closed forest: tets, triangles, lines, fixed edges, and vertices in an order that depends
//! only on what is divided.

use super::close::Cut;
use super::patterns::{self, patterns};
use super::{Forest, in_forest};
use crate::base::{
    EdgeId, Error, ForestVertexId, LineId, MaybeId, NodeId, Point, Result, TetId, TriangleId, VertexId,
};
use crate::geometry::vector::{add, scale};
use crate::mesh::TetMesh;

/// A mesh, and the counterparts of its vertices and cells in the forest or the first mesh.
#[derive(Clone, Debug, Default)]
pub(in crate::refine) struct Extracted {
    pub(in crate::refine) mesh: TetMesh,
    /// For each vertex, its id in the forest.
    pub(in crate::refine) vertices: Vec<ForestVertexId>,
    /// For each tet, the tet of the forest that it is, or is a piece of.
    pub(in crate::refine) nodes: Vec<NodeId>,
    /// For each triangle, the triangle of the first mesh that it is a part of.
    pub(in crate::refine) triangles: Vec<TriangleId>,
    /// For each line, the line of the first mesh that it is a part of.
    pub(in crate::refine) lines: Vec<LineId>,
}

impl Extracted {
    /// For each of the `n` vertices of the forest, its id in the mesh; none if it is not in the mesh.
    pub(in crate::refine) fn numbers(&self, n: usize) -> Vec<MaybeId<VertexId>> {
        let mut numbers = vec![MaybeId::NONE; n];
        self.vertices.iter().zip(0..).for_each(|(v, number)| numbers[v.index()] = VertexId(number).into());
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
    before: &[ForestVertexId],
) -> Result<Extracted> {
    let mut numbers = Numbers::new(forest, points, before);
    let mut out = Extracted::default();
    let n = n_tets(forest, cuts);
    out.mesh.tets.reserve_exact(n);
    out.mesh.regions.reserve_exact(n);
    out.nodes.reserve_exact(n);
    let mut open = Vec::new();
    for root in 0..forest.n_roots {
        open.push(NodeId::new(root));
        while let Some(node) = open.pop() {
            let state = forest.states[node.index()];
            let tet = &forest.nodes[node.index()];
            let is_turned = tet.shape.is_mirrored();
            if state.is_divided {
                open.extend(tet.first_child.get().into_iter().flat_map(Forest::parts_from).rev());
            } else if state.is_cut {
                let cut = cuts.binary_search_by_key(&node, |cut| cut.node).ok();
                let local = forest.local(node);
                for piece in cut.into_iter().flat_map(|i| pieces(&cuts[i])) {
                    let vertex = |place: u8| local[usize::from(place)].get().expect("pieces use split edges");
                    out.mesh.tets.push(numbers.tet(piece.map(vertex), is_turned));
                    out.nodes.push(node);
                }
            } else {
                out.mesh.tets.push(numbers.tet(tet.vertices, is_turned));
                out.nodes.push(node);
            }
        }
        out.mesh.regions.resize(out.mesh.tets.len(), first.regions[root]);
    }
    if out.mesh.tets.len() > TetId::MAX_COUNT || numbers.vertices.len() > VertexId::MAX_COUNT {
        return Err(Error::options(format!(
            "a mesh of {} tets needs more ids than there are",
            out.mesh.tets.len()
        ))
        .remedy("mark fewer tets, or limit the generation"));
    }
    for ((triangle, &patch), i) in first.triangles.iter().zip(&first.patches).zip(0..) {
        numbers.triangle(triangle.map(in_forest), &mut out.mesh.triangles);
        out.mesh.patches.resize(out.mesh.triangles.len(), patch);
        out.triangles.resize(out.mesh.triangles.len(), TriangleId(i));
    }
    for ((line, &label), i) in first.lines.iter().zip(&first.line_labels).zip(0..) {
        numbers.edge(line.map(in_forest), &mut out.mesh.lines);
        out.mesh.line_labels.resize(out.mesh.lines.len(), label);
        out.lines.resize(out.mesh.lines.len(), LineId(i));
    }
    for edge in &first.fixed_edges {
        numbers.edge(edge.map(in_forest), &mut out.mesh.fixed_edges);
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

/// The numbers of vertices: those of the first mesh unchanged, then the others in the order in which tets use
/// them.
struct Numbers<'a> {
    forest: &'a Forest,
    known: &'a [Point],
    /// Whether each vertex of the forest was in the mesh before.
    is_old: Vec<bool>,
    /// The number of each vertex of the forest, once it has one.
    number: Vec<MaybeId<VertexId>>,
    vertices: Vec<ForestVertexId>,
    points: Vec<Point>,
}

impl<'a> Numbers<'a> {
    fn new(forest: &'a Forest, known: &'a [Point], before: &[ForestVertexId]) -> Self {
        let (n, n_first) = (forest.reference.len(), forest.n_first_vertices);
        let (mut is_old, mut number) = (vec![false; n], vec![MaybeId::NONE; n]);
        before.iter().for_each(|v| is_old[v.index()] = true);
        number.iter_mut().zip(0..n_first as u32).for_each(|(number, v)| *number = VertexId(v).into());
        let (mut vertices, mut points) = (Vec::with_capacity(n), Vec::with_capacity(n));
        vertices.extend((0..n_first as u32).map(ForestVertexId));
        points.extend_from_slice(&known[..n_first]);
        Self { forest, known, is_old, number, vertices, points }
    }

    #[inline]
    fn of(&mut self, v: ForestVertexId) -> VertexId {
        match self.number[v.index()].get() {
            Some(number) => number,
            None => self.add(v),
        }
    }

    fn add(&mut self, v: ForestVertexId) -> VertexId {
        let point = self.place(v);
        let number = VertexId(self.vertices.len() as u32);
        self.number[v.index()] = number.into();
        self.vertices.push(v);
        self.points.push(point);
        number
    }

    /// Returns a tet; if it is turned, its first two vertices are exchanged after numbering.
    #[inline]
    fn tet(&mut self, vertices: [ForestVertexId; 4], is_turned: bool) -> [VertexId; 4] {
        let mut tet = [VertexId::default(); 4];
        for i in 0..4 {
            tet[i] = self.of(vertices[i]);
        }
        if is_turned {
            tet.swap(0, 1);
        }
        tet
    }

    /// The position of a vertex; a new one lies in the middle of its edge at current positions.
    fn place(&self, v: ForestVertexId) -> Point {
        let i = v.index();
        match self.number[i].get() {
            Some(number) => self.points[number.index()],
            None if self.is_old[i] => self.known[i],
            None => {
                let origin = self.forest.origin[i - self.forest.n_first_vertices];
                let [p, q] = self.forest.edges[origin.index()].ends;
                scale(add(self.place(p), self.place(q)), 0.5)
            }
        }
    }

    /// Adds the parts of a triangle of the first mesh.
    fn triangle(&mut self, corners: [ForestVertexId; 3], out: &mut Vec<[VertexId; 3]>) {
        let edges = [[1, 2], [2, 0], [0, 1]].map(|[i, j]| self.forest.root_edge([corners[i], corners[j]]));
        self.part(corners, edges.map(MaybeId::from), out);
    }

    /// Adds the parts of a triangle; edge `k` is opposite corner `k`, none if it is no edge of the forest.
    fn part(
        &mut self,
        corners: [ForestVertexId; 3],
        edges: [MaybeId<EdgeId>; 3],
        out: &mut Vec<[VertexId; 3]>,
    ) {
        let forest = self.forest;
        let split = edges.map(|edge| forest.split_edge(edge));
        let half = |edge: EdgeId, end: ForestVertexId| forest.half(edge, end);
        if let [Some((of_a, x)), Some((of_b, y)), Some((of_c, z))] = split {
            let [a, b, c] = corners;
            let [yz, zx, xy] = forest.inner_edges([x, y, z]).unwrap_or([MaybeId::NONE; 3]);
            self.part([a, z, y], [yz, half(of_b, a), half(of_c, a)], out);
            self.part([z, b, x], [half(of_a, b), zx, half(of_c, b)], out);
            self.part([y, x, c], [half(of_a, c), half(of_b, c), xy], out);
            self.part([x, y, z], [yz, zx, xy], out);
            return;
        }
        let is_second = forest.is_cut_from_second(split.map(|split| split.map(|(edge, _)| edge)));
        let parts = patterns::cut(corners, split.map(|split| split.map(|(_, middle)| middle)), is_second);
        out.extend(parts.into_iter().map(|part| part.map(|v| self.of(v))));
    }

    /// Adds the parts of an edge of the first mesh.
    fn edge(&mut self, ends: [ForestVertexId; 2], out: &mut Vec<[VertexId; 2]>) {
        let edge = self.forest.root_edge(ends).into();
        self.edge_part(ends, edge, out);
    }

    fn edge_part(
        &mut self,
        [u, v]: [ForestVertexId; 2],
        edge: MaybeId<EdgeId>,
        out: &mut Vec<[VertexId; 2]>,
    ) {
        match self.forest.split_edge(edge) {
            None => out.push([self.of(u), self.of(v)]),
            Some((edge, middle)) => {
                self.edge_part([u, middle], self.forest.half(edge, u), out);
                self.edge_part([middle, v], self.forest.half(edge, v), out);
            }
        }
    }
}

impl Forest {
    /// The corners of a tet, then the middles of its edges; none for edges that were never split.
    pub(in crate::refine) fn local(&self, node: NodeId) -> [MaybeId<ForestVertexId>; 10] {
        let mut local = [MaybeId::NONE; 10];
        for (place, corner) in local.iter_mut().zip(self.nodes[node.index()].vertices) {
            *place = corner.into();
        }
        for (place, edge) in local[4..].iter_mut().zip(&self.edges_of[node.index()]) {
            *place = self.edges[edge.index()].middle;
        }
        local
    }

    /// An edge that is split, and the vertex in its middle.
    fn split_edge(&self, edge: MaybeId<EdgeId>) -> Option<(EdgeId, ForestVertexId)> {
        let edge = edge.get().filter(|edge| self.is_split[edge.index()])?;
        Some((edge, self.edges[edge.index()].middle.get()?))
    }

    /// The half of an edge at one of its ends.
    fn half(&self, edge: EdgeId, end: ForestVertexId) -> MaybeId<EdgeId> {
        let edge = &self.edges[edge.index()];
        edge.halves[usize::from(edge.ends[0] != end)]
    }

    /// The tet of the first mesh that a tet lies in.
    pub(in crate::refine) fn root(&self, node: NodeId) -> TetId {
        TetId(self.ancestors(node).last().unwrap_or(node).0)
    }
}
