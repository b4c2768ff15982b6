//! Requested edge lengths: given, checked, and evaluated anywhere.

use serde::Serialize;

use crate::base::{Error, Point, Result, TetId, VertexId};
use crate::geometry::tet::{EDGES, volume};
use crate::geometry::vector::{LARGEST, distance};
use crate::kernel::{Change, Complex, VertexChange};
use crate::mesh::TetMesh;
use crate::remesh::input_mesh::InputMesh;

/// An edge shorter than this fraction of its size is too short.
pub const SHORT: f64 = 0.5;
/// An edge longer than this multiple of its size is too long. Its halves, 0.75 and more, are not too short.
pub const LONG: f64 = 1.5;

/// A mesh of no more than this many tets may be made from any mesh: about 2 GB.
const ALWAYS: f64 = 1e7;
/// A larger mesh may be made if it has at most so many times the input's tets, ...
const MAX_GROWTH: f64 = 100.0;
/// ... and never more than this: half of what the kernel's ids can distinguish.
const MAX_TETS: f64 = (1u32 << 28) as f64;

/// Requested edge lengths. The size of an edge is the mean of the sizes at its two ends.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Sizes {
    /// One size everywhere.
    Uniform(f64),
    /// One size for each vertex of the mesh, interpolated linearly in its tets.
    Vertices(Vec<f64>),
}

impl Sizes {
    /// The largest number of tets that the mesh may have while it is brought to these sizes. Fails if a size
    /// is not a positive length, or if the resulting mesh would be too large.
    pub(super) fn check(&self, mesh: &TetMesh) -> Result<usize> {
        let is_size = |h: f64| h > 0.0 && h <= LARGEST;
        match self {
            Self::Uniform(h) if is_size(*h) => {}
            Self::Uniform(h) => {
                return Err(Error::options(format!("an edge length must be a positive number; got {h}"))
                    .remedy("give a number above 0"));
            }
            Self::Vertices(sizes) if sizes.len() != mesh.points.len() => {
                let what = format!("{} sizes for {} points", sizes.len(), mesh.points.len());
                return Err(Error::input(what).remedy("give a size for each point"));
            }
            Self::Vertices(sizes) => {
                let is_off = |v: &&VertexId| !is_size(sizes[v.index()]);
                if let Some(v) = mesh.tets.as_flattened().iter().filter(is_off).min() {
                    let what = format!("an edge length must be a positive number; got {}", sizes[v.index()]);
                    return Err(Error::input(what)
                        .at(format!("point {v}"))
                        .remedy("give a positive size for every point of a tet"));
                }
            }
        }
        let (root, limit) =
            (self.root_of_n_tets(mesh), (MAX_GROWTH * mesh.tets.len() as f64).clamp(ALWAYS, MAX_TETS));
        let factor = root / limit.cbrt();
        if factor <= 1.0 {
            // The estimate may be off by a factor.
            return Ok(2 * limit as usize);
        }
        let number = |x: f64| if x < 1e6 { format!("{x:.1}") } else { format!("{x:.1e}") };
        let estimate = match root.powi(3) {
            n if n < 1e15 => format!("about {n:.1e}"),
            _ => "more than 1e15".to_owned(),
        };
        Err(Error::input(format!(
            "a mesh of these sizes would have {estimate} tets; \
             from a mesh of {} tets, at most {limit:.1e} are made",
            mesh.tets.len()
        ))
        .remedy(format!(
            "request sizes {} times as large; that mesh can then be remeshed again",
            number(factor + 0.1)
        )))
    }

    /// The cube root of the estimated number of tets of a mesh of these sizes: the number of regular tets
    /// with that edge length that fill its volume.
    fn root_of_n_tets(&self, mesh: &TetMesh) -> f64 {
        let size = |v: &VertexId| match self {
            Self::Uniform(h) => *h,
            Self::Vertices(sizes) => sizes[v.index()],
        };
        // In units of the smallest size, so that no cube overflows.
        let least = mesh.tets.as_flattened().iter().map(size).fold(f64::INFINITY, f64::min);
        let in_tet = |tet: &[VertexId; 4]| {
            let dense: f64 = tet.iter().map(|v| (least / size(v)).powi(3)).sum();
            6.0 * std::f64::consts::SQRT_2 * volume(tet.map(|v| mesh.points[v.index()])).abs() * dense / 4.0
        };
        mesh.tets.iter().map(in_tet).sum::<f64>().cbrt() / least
    }
}

/// Sizes at places in the mesh as it was given, for a mesh that has changed since.
#[derive(Debug)]
pub(super) struct SizeField {
    source: Source,
    /// The position of each vertex when its size was last evaluated, and that size.
    known: Vec<(Point, f64)>,
    /// A collapse may not make an edge longer than this multiple of its size.
    collapse_limit: f64,
    /// Edges longer than this multiple of their size are too long now: [`LONG`] in the end, more while a
    /// coarse mesh is made finer.
    pub(super) long_limit: f64,
    /// Whether a change may leave an edge too short.
    pub(super) may_shorten: bool,
}

#[derive(Debug)]
enum Source {
    Uniform(f64),
    /// One size for each vertex of the mesh as it was given.
    Vertices(Vec<f64>),
}

/// Sizes in a mesh that has changed, with the mesh as it was given.
#[derive(Clone, Copy, Debug)]
pub(super) struct SizesIn<'a> {
    pub(super) field: &'a SizeField,
    pub(super) input: &'a InputMesh<'a>,
    pub(super) complex: &'a Complex,
}

impl SizeField {
    /// A field of sizes that have been checked. Where nothing is split, `collapse_limit` keeps collapses from
    /// making edges that a later remeshing would split at once.
    pub(super) fn new(sizes: &Sizes, input: &InputMesh, collapse_limit: f64) -> Self {
        let (source, known) = match sizes {
            Sizes::Uniform(h) => (Source::Uniform(*h), Vec::new()),
            Sizes::Vertices(sizes) => {
                let known = input.points().iter().copied().zip(sizes.iter().copied()).collect();
                (Source::Vertices(sizes.clone()), known)
            }
        };
        Self { source, known, collapse_limit, long_limit: LONG, may_shorten: false }
    }

    /// Whether sizes differ from place to place.
    pub(super) fn is_graded(&self) -> bool {
        matches!(self.source, Source::Vertices(_))
    }

    /// Evaluates the sizes at all vertices of some tets that were inserted or moved, so that later calls find
    /// them.
    pub(super) fn learn(
        &mut self,
        complex: &Complex,
        input: &InputMesh,
        tets: impl IntoIterator<Item = TetId>,
    ) {
        if !self.is_graded() {
            return;
        }
        for vertex in tets.into_iter().flat_map(|t| complex.vertices(t)) {
            if self.known.len() <= vertex.index() {
                self.known.resize(vertex.index() + 1, ([f64::NAN; 3], f64::NAN));
            }
            let point = complex.point(vertex);
            if self.known[vertex.index()].0 != point {
                self.known[vertex.index()] =
                    (point, SizesIn { field: self, input, complex }.at(vertex, point, &[]));
            }
        }
    }
}

impl SizesIn<'_> {
    /// The size at a vertex that is, or will be after a change of `cavity`, at `point`: linear in the tet
    /// that contained it.
    fn at(self, vertex: VertexId, point: Point, cavity: &[TetId]) -> f64 {
        let sizes = match &self.field.source {
            Source::Uniform(h) => return *h,
            Source::Vertices(sizes) => sizes,
        };
        match self.field.known.get(vertex.index()) {
            Some(&(place, size)) if place == point => size,
            _ => self.input.at(self.complex, point, cavity).map_or(f64::NAN, |(tet, weights)| {
                tet.iter().zip(weights).map(|(v, weight)| sizes[v.index()] * weight).sum()
            }),
        }
    }

    /// The lengths of the six edges of a tet divided by their sizes. Used to sweep whole meshes, so the size
    /// at each corner is looked up once.
    #[inline]
    pub(super) fn of_tet(self, tet: TetId) -> [f64; 6] {
        let (vertices, corners) = (self.complex.vertices(tet), self.complex.corners(tet));
        let (mut sizes, mut ratios) = ([0.0; 4], [0.0; 6]);
        for i in 0..4 {
            sizes[i] = self.at(vertices[i], corners[i], &[]);
        }
        for (ratio, [i, j]) in ratios.iter_mut().zip(EDGES) {
            *ratio = distance(corners[i], corners[j]) / (0.5 * (sizes[i] + sizes[j]));
        }
        ratios
    }

    /// The length of an edge divided by its size, the mean of those at its ends.
    pub(super) fn of_edge(self, ends: [VertexId; 2]) -> f64 {
        let [p, q] = ends.map(|v| self.complex.point(v));
        distance(p, q) / (0.5 * (self.at(ends[0], p, &[]) + self.at(ends[1], q, &[])))
    }

    /// Whether a change makes no new edge that is too long or too short, and none that already is more so.
    pub(super) fn accepts(self, change: &Change) -> bool {
        let low = if self.field.may_shorten { 0.0 } else { SHORT };
        self.keeps_within([low, self.field.long_limit], change)
    }

    /// Whether a collapse makes no edge too long.
    pub(super) fn lengthens_none(self, change: &Change) -> bool {
        self.keeps_within([0.0, self.field.collapse_limit], change)
    }

    fn keeps_within(self, [low, high]: [f64; 2], change: &Change) -> bool {
        let complex = self.complex;
        let placed = match change.vertex {
            VertexChange::Insert(point, _) => Some((complex.next_vertex(), point)),
            VertexChange::Move(vertex, point) => Some((vertex, point)),
            VertexChange::None | VertexChange::Remove(_) => None,
        };
        let placed = placed.map(|(vertex, point)| (vertex, point, self.at(vertex, point, &change.cavity)));
        let of = |v: VertexId| match placed {
            Some((vertex, point, size)) if vertex == v => (point, size),
            _ => (complex.point(v), self.at(v, complex.point(v), &[])),
        };
        for tet in &change.fill {
            for ends in EDGES.map(|e| e.map(|i| tet.vertices[i])) {
                let [(p, at_p), (q, at_q)] = ends.map(of);
                let after = distance(p, q) / (0.5 * (at_p + at_q));
                if (low..=high).contains(&after) {
                    continue;
                }
                let had = |t: &TetId| ends.iter().all(|v| complex.vertices(*t).contains(v));
                if !change.cavity.iter().any(had) {
                    return false;
                }
                let before = self.of_edge(ends);
                if after > high && after > before || after < low && after < before {
                    return false;
                }
            }
        }
        true
    }
}
