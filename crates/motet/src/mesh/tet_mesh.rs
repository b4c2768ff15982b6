//! The input of operations that change connectivity: tets, labelled triangles and lines, and what must stay
//! fixed.

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::in_range;

/// A tetrahedral mesh as plain arrays: what a solver passes and gets back.
///
/// Every tet has a region, every triangle a patch. Triangles are facets of tets, on the boundary or inside;
/// boundary facets and facets between two regions are kept even without a triangle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TetMesh {
    /// Coordinates of each vertex.
    pub points: Vec<Point>,
    /// The vertices of each tet. Either orientation is accepted.
    pub tets: Vec<[VertexId; 4]>,
    /// The region of each tet.
    pub regions: Vec<i32>,
    /// The vertices of each labelled facet.
    pub triangles: Vec<[VertexId; 3]>,
    /// The patch of each triangle.
    pub patches: Vec<i32>,
    /// The vertices of each labelled edge. A line that is an edge of a tet is divided and merged with that
    /// edge; any other stays as it is.
    pub lines: Vec<[VertexId; 2]>,
    /// The label of each line; lines of different labels are never merged.
    pub line_labels: Vec<i32>,
    /// Vertices that are neither moved nor removed, such as those of cells of other kinds.
    pub fixed_vertices: Vec<VertexId>,
    /// Edges that stay as they are, such as those of hexahedra beside the tets.
    pub fixed_edges: Vec<[VertexId; 2]>,
    /// Where the mesh was cut out of a larger one: the vertices that tets outside have, too, in rising order.
    /// They are fixed, and tets that share one need not be connected.
    pub cut_vertices: Vec<VertexId>,
}

impl TetMesh {
    /// A mesh of tets in one region, without triangles.
    pub fn new(points: Vec<Point>, tets: Vec<[VertexId; 4]>) -> Self {
        let regions = vec![0; tets.len()];
        Self { points, tets, regions, ..Self::default() }
    }

    /// Checks that array lengths match, that every vertex id exists, that no row names a vertex twice and
    /// that every coordinate of a tet is a finite number.
    ///
    /// # Errors
    /// If a check fails; the error names the first tet, triangle, line, edge or vertex at fault.
    pub fn validate(&self) -> Result<()> {
        if self.regions.len() != self.tets.len() {
            return Err(Error::input(format!("{} regions for {} tets", self.regions.len(), self.tets.len())));
        }
        if self.patches.len() != self.triangles.len() {
            let (patches, triangles) = (self.patches.len(), self.triangles.len());
            return Err(Error::input(format!("{patches} patches for {triangles} triangles")));
        }
        if self.line_labels.len() != self.lines.len() {
            let (labels, lines) = (self.line_labels.len(), self.lines.len());
            return Err(Error::input(format!("{labels} labels for {lines} lines")));
        }
        self.check_ids("tet", &self.tets)?;
        self.check_ids("triangle", &self.triangles)?;
        self.check_ids("line", &self.lines)?;
        self.check_ids("fixed edge", &self.fixed_edges)?;
        self.check_ids("fixed vertex", self.fixed_vertices.as_chunks::<1>().0)?;
        self.check_ids("vertex of the cut", self.cut_vertices.as_chunks::<1>().0)?;
        self.check_numbers()
    }

    fn check_ids<const N: usize>(&self, what: &str, rows: &[[VertexId; N]]) -> Result<()> {
        let n = self.points.len();
        let is_off = |row: &[VertexId; N]| {
            row.iter().any(|v| v.index() >= n) || (1..N).any(|i| row[..i].contains(&row[i]))
        };
        match rows.iter().position(is_off) {
            None => Ok(()),
            Some(i) => Err(Error::input(format!(
                "names the points {:?}, but there are {n} points and a {what} needs {N} distinct ones",
                rows[i].map(|v| v.0)
            ))
            .at(format!("{what} {i}"))
            .remedy("`motet info` lists what is wrong with a mesh")),
        }
    }

    fn check_numbers(&self) -> Result<()> {
        let is_off = |tet: &[VertexId; 4]| tet.iter().any(|v| !in_range(self.points[v.index()]));
        if self.points.iter().all(|p| in_range(*p)) {
            return Ok(());
        }
        match self.tets.iter().position(is_off) {
            None => Ok(()),
            Some(i) => Err(Error::input("has a vertex whose coordinates are not finite")
                .at(format!("tet {i}"))
                .remedy("`motet info` lists what is wrong with a mesh")),
        }
    }
}
