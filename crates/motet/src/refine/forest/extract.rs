//! The mesh of a closed forest: tets, triangles, lines, fixed edges, and vertices in an order that depends
//! only on what is divided.

use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

use bytemuck::allocation::{cast_vec, zeroed_vec};

use super::close::Cut;
use super::{Forest, in_forest, patterns};
use crate::base::{
    EdgeId, Error, ForestVertexId, LineId, MaybeId, NodeId, Point, Result, TetId, Threads, TriangleId,
    VertexId,
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
    /// For each root, the number of tets that lie in it; empty for a mesh that is not in the order of roots.
    pub(in crate::refine) n_tets: Vec<u32>,
    /// For each triangle, the triangle of the first mesh that it is a part of.
    pub(in crate::refine) triangles: Vec<TriangleId>,
    /// For each line, the line of the first mesh that it is a part of.
    pub(in crate::refine) lines: Vec<LineId>,
}

impl Extracted {
    /// The vertices of a first mesh.
    pub(in crate::refine) fn of_first(first: &TetMesh) -> Self {
        let points = first.points.clone();
        let vertices = (0..points.len()).map(ForestVertexId::new).collect();
        Self { mesh: TetMesh { points, ..TetMesh::default() }, vertices, ..Self::default() }
    }

    /// For each of the `n` vertices of the forest, its id in the mesh; none if it is not in the mesh.
    pub(in crate::refine) fn numbers(&self, n: usize) -> Vec<MaybeId<VertexId>> {
        let mut numbers = vec![MaybeId::NONE; n];
        self.vertices.iter().zip(0..).for_each(|(v, number)| numbers[v.index()] = VertexId(number).into());
        numbers
    }
}

/// How many tets are extracted at a time.
const RUN: usize = 1 << 13;

/// How many roots, or triangles of the first mesh, are examined at a time.
const ROOTS: usize = 512;

/// Extracts the mesh. `before` is the mesh before, whose vertices stay where they are.
///
/// # Errors
/// When the mesh would have more tets or vertices than there are ids.
pub(in crate::refine) fn extract(
    forest: &Forest,
    first: &TetMesh,
    cuts: &[Cut],
    before: &Extracted,
    threads: &Threads,
) -> Result<Extracted> {
    let rows = rows(forest, threads);
    let mut out = Extracted::default();
    let mut numbers = extract_tets(forest, first, cuts, &rows, &mut out, threads);
    let triangles = threads.in_runs(first.triangles.len(), ROOTS, |(): &mut (), run| {
        let mut parts = Vec::new();
        for i in run {
            forest.parts_of_triangle(first.triangles[i].map(in_forest), &mut |part| {
                parts.push((part, TriangleId::new(i)));
            });
        }
        parts
    });
    for &(part, whole) in &triangles {
        out.mesh.triangles.push(part.map(|v| numbers.of(v)));
        out.mesh.patches.push(first.patches[whole.index()]);
        out.triangles.push(whole);
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
    if out.mesh.tets.len() > TetId::MAX_COUNT || numbers.vertices.len() > VertexId::MAX_COUNT {
        return Err(Error::options(format!(
            "a mesh of {} tets needs more ids than there are",
            out.mesh.tets.len()
        ))
        .remedy("mark fewer tets, or limit the generation"));
    }
    out.vertices = numbers.vertices;
    let places = Places { forest, before, known: before.numbers(forest.reference.len()) };
    out.mesh.points = threads.map(out.vertices.len(), |i| places.of(out.vertices[i]));
    Ok(out)
}

/// Consecutive tets of the forest that are not divided: roots, or parts of one tet.
#[derive(Clone, Copy, Debug)]
struct Row {
    first: NodeId,
    n: u32,
    /// The root that these are parts of; for roots, any.
    root: u32,
}

/// All tets that are not divided, in the order of the mesh.
fn rows(forest: &Forest, threads: &Threads) -> Vec<Row> {
    threads.in_runs(forest.n_roots, ROOTS, |open: &mut Vec<(u32, u32)>, roots| {
        let mut rows = Vec::new();
        let mut root = 0;
        open.push((roots.start as u32, roots.end as u32));
        while let Some((begin, end)) = open.pop() {
            let states = &forest.states[begin as usize..end as usize];
            let n = states.iter().position(|state| state.is_divided).unwrap_or(states.len()) as u32;
            if n > 0 {
                rows.push(Row { first: NodeId(begin), n, root });
            }
            let divided = begin + n;
            if divided < end {
                root = if open.is_empty() { divided } else { root };
                open.push((divided + 1, end));
                if let Some(NodeId(first)) = forest.nodes[divided as usize].first_child.get() {
                    open.push((first, first + 8));
                }
            }
        }
        rows
    })
}

/// A part of the mesh that is being extracted.
struct Part<'a> {
    rows: &'a [Row],
    tets: &'a mut [[VertexId; 4]],
    nodes: &'a mut [NodeId],
    regions: &'a mut [i32],
}

impl Part<'_> {
    /// Takes the rows from the front that together have at least this many tets, or all.
    fn split(self, least: usize, n_tets: &[u32]) -> (Self, Self) {
        let (mut n_rows, mut n) = (0, 0);
        while n_rows < self.rows.len() && n < least {
            n += n_tets[n_rows] as usize;
            n_rows += 1;
        }
        let (rows, tets, nodes, regions) = (
            self.rows.split_at(n_rows),
            self.tets.split_at_mut(n),
            self.nodes.split_at_mut(n),
            self.regions.split_at_mut(n),
        );
        (
            Part { rows: rows.0, tets: tets.0, nodes: nodes.0, regions: regions.0 },
            Part { rows: rows.1, tets: tets.1, nodes: nodes.1, regions: regions.1 },
        )
    }

    /// Writes the tets, with the names that `name` gives to vertices, in the order in which it is asked.
    fn fill(
        self,
        forest: &Forest,
        first: &TetMesh,
        cuts: &[Cut],
        mut name: impl FnMut(ForestVertexId) -> VertexId,
    ) {
        let (mut at, mut next_cut) = (0, 0);
        let mut put = |vertices: [ForestVertexId; 4], is_turned: bool, node: NodeId, region: i32| {
            let mut tet = [VertexId::default(); 4];
            for i in 0..4 {
                tet[i] = name(vertices[i]);
            }
            if is_turned {
                tet.swap(0, 1);
            }
            (self.tets[at], self.nodes[at], self.regions[at]) = (tet, node, region);
            at += 1;
        };
        for row in self.rows {
            for node in (row.first.0..row.first.0 + row.n).map(NodeId) {
                let root = if node.index() < forest.n_roots { node.0 } else { row.root };
                let region = first.regions[root as usize];
                let tet = &forest.nodes[node.index()];
                let is_turned = tet.shape.is_mirrored();
                if forest.states[node.index()].n_pieces == 0 {
                    put(tet.vertices, is_turned, node, region);
                    continue;
                }
                // Cuts are in the order of tets, and so mostly follow each other.
                if cuts.get(next_cut).is_none_or(|cut| cut.node != node) {
                    next_cut = cuts.partition_point(|cut| cut.node < node);
                }
                let local = forest.local(node);
                for piece in cuts[next_cut].pieces() {
                    let vertex = |place: u8| local[usize::from(place)].get().expect("pieces use split edges");
                    put(piece.map(vertex), is_turned, node, region);
                }
                next_cut += 1;
            }
        }
    }
}

/// Extracts the tets. Vertices of the first mesh keep their numbers; the others are numbered in the order in
/// which tets use them.
fn extract_tets<'a>(
    forest: &'a Forest,
    first: &TetMesh,
    cuts: &[Cut],
    rows: &[Row],
    out: &mut Extracted,
    threads: &Threads,
) -> Numbers<'a> {
    let n_tets = threads.map(rows.len(), |i| {
        let begin = rows[i].first.index();
        let states = &forest.states[begin..begin + rows[i].n as usize];
        states.iter().map(|state| u32::from(state.n_pieces.max(1))).sum::<u32>()
    });
    let n: usize = n_tets.iter().map(|&n| n as usize).sum();
    out.n_tets = of_roots(forest, rows, &n_tets);
    // A page of zeroed memory is made where it is first written, by the thread that does so.
    out.mesh.tets = cast_vec(zeroed_vec::<[u32; 4]>(n));
    (out.nodes, out.mesh.regions) = (cast_vec(zeroed_vec::<u32>(n)), zeroed_vec(n));
    let all = Part { rows, tets: &mut out.mesh.tets, nodes: &mut out.nodes, regions: &mut out.mesh.regions };
    if threads.count() == 1 {
        let mut numbers = Numbers::new(forest);
        all.fill(forest, first, cuts, |v| numbers.of(v));
        return numbers;
    }
    let (mut parts, mut rest, mut n_tets) = (Vec::new(), all, &n_tets[..]);
    while !rest.rows.is_empty() {
        let (part, others) = rest.split(RUN, n_tets);
        n_tets = &n_tets[part.rows.len()..];
        parts.push((parts.len() as u32, part));
        rest = others;
    }
    // The first part that uses each vertex: 0 for those of the first mesh, which none needs to number.
    let numbered = 0..forest.n_first_vertices;
    let user: Vec<AtomicU32> = threads
        .map(forest.reference.len(), |v| AtomicU32::new(if numbered.contains(&v) { 0 } else { u32::MAX }));
    let used = threads.each(parts, |(k, part)| {
        let mut used = Vec::new();
        part.fill(forest, first, cuts, |v| {
            let user = &user[v.index()];
            if user.load(Relaxed) > k && user.fetch_min(k, Relaxed) > k {
                used.push(v);
            }
            VertexId(v.0)
        });
        used
    });
    let used: Vec<_> = used.into_iter().zip(0..).collect();
    let used = threads.each(used, |(mut used, k)| {
        used.retain(|v: &ForestVertexId| user[v.index()].load(Relaxed) == k);
        used
    });
    let mut numbers =
        Numbers { forest, number: user, vertices: numbered.clone().map(ForestVertexId::new).collect() };
    numbers.number[numbered].iter_mut().zip(0..).for_each(|(number, v)| *number.get_mut() = v);
    for v in used.into_iter().flatten() {
        *numbers.number[v.index()].get_mut() = numbers.vertices.len() as u32;
        numbers.vertices.push(v);
    }
    threads.update(&mut out.mesh.tets, RUN, |_, tet| {
        for v in tet {
            v.0 = numbers.number[v.index()].load(Relaxed);
        }
    });
    numbers
}

/// For each root, the number of tets that lie in it, given the number of tets of each row.
fn of_roots(forest: &Forest, rows: &[Row], n_tets: &[u32]) -> Vec<u32> {
    let mut of_roots = vec![0; forest.n_roots];
    for (row, n) in rows.iter().zip(n_tets) {
        if row.first.index() >= forest.n_roots {
            of_roots[row.root as usize] += n;
            continue;
        }
        let roots = row.first.index()..row.first.index() + row.n as usize;
        for (n, state) in of_roots[roots.clone()].iter_mut().zip(&forest.states[roots]) {
            *n = u32::from(state.n_pieces.max(1));
        }
    }
    of_roots
}

/// Where vertices are.
struct Places<'a> {
    forest: &'a Forest,
    before: &'a Extracted,
    /// For each vertex of the forest, its number in the mesh before.
    known: Vec<MaybeId<VertexId>>,
}

impl Places<'_> {
    /// The position of a vertex; a new one lies in the middle of its edge at current positions.
    fn of(&self, v: ForestVertexId) -> Point {
        if let Some(known) = self.known[v.index()].get() {
            return self.before.mesh.points[known.index()];
        }
        let origin = self.forest.origin[v.index() - self.forest.n_first_vertices];
        let [p, q] = self.forest.edges[origin.index()].ends;
        scale(add(self.of(p), self.of(q)), 0.5)
    }
}

/// The numbers of vertices: those of the first mesh unchanged, then the others in the order in which they are
/// asked for.
struct Numbers<'a> {
    forest: &'a Forest,
    /// The number of each vertex of the forest; `u32::MAX` until it has one.
    number: Vec<AtomicU32>,
    vertices: Vec<ForestVertexId>,
}

impl<'a> Numbers<'a> {
    fn new(forest: &'a Forest) -> Self {
        let (n, n_first) = (forest.reference.len(), forest.n_first_vertices as u32);
        let number = (0..n as u32).map(|v| AtomicU32::new(if v < n_first { v } else { u32::MAX }));
        let mut vertices = Vec::with_capacity(n);
        vertices.extend((0..n_first).map(ForestVertexId));
        Self { forest, number: number.collect(), vertices }
    }

    #[inline]
    fn of(&mut self, v: ForestVertexId) -> VertexId {
        let number = self.number[v.index()].get_mut();
        if *number == u32::MAX {
            *number = self.vertices.len() as u32;
            self.vertices.push(v);
        }
        VertexId(*number)
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
    /// Gives `put` the parts of a triangle of the first mesh.
    fn parts_of_triangle(&self, corners: [ForestVertexId; 3], put: &mut impl FnMut([ForestVertexId; 3])) {
        let edges = [[1, 2], [2, 0], [0, 1]].map(|[i, j]| self.root_edge([corners[i], corners[j]]));
        self.parts_of(corners, edges.map(MaybeId::from), put);
    }

    /// Gives `put` the parts of a triangle; edge `k` is opposite corner `k`, none if it is no edge of the
    /// forest.
    fn parts_of(
        &self,
        corners: [ForestVertexId; 3],
        edges: [MaybeId<EdgeId>; 3],
        put: &mut impl FnMut([ForestVertexId; 3]),
    ) {
        let split = edges.map(|edge| self.split_edge(edge));
        let half = |edge: EdgeId, end: ForestVertexId| self.half(edge, end);
        if let [Some((of_a, x)), Some((of_b, y)), Some((of_c, z))] = split {
            let [a, b, c] = corners;
            let [yz, zx, xy] = self.inner_edges([x, y, z]).unwrap_or([MaybeId::NONE; 3]);
            self.parts_of([a, z, y], [yz, half(of_b, a), half(of_c, a)], put);
            self.parts_of([z, b, x], [half(of_a, b), zx, half(of_c, b)], put);
            self.parts_of([y, x, c], [half(of_a, c), half(of_b, c), xy], put);
            self.parts_of([x, y, z], [yz, zx, xy], put);
            return;
        }
        let is_second = self.is_cut_from_second(split.map(|split| split.map(|(edge, _)| edge)));
        let middles = split.map(|split| split.map(|(_, middle)| middle));
        patterns::cut(corners, middles, is_second).into_iter().for_each(put);
    }

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
        let at_second = usize::from(self.edges[edge.index()].ends[0] != end);
        self.halves(edge).map(|halves| halves[at_second]).into()
    }

    /// The tet of the first mesh that a tet lies in.
    pub(in crate::refine) fn root(&self, node: NodeId) -> TetId {
        TetId(self.ancestors(node).last().unwrap_or(node).0)
    }
}
