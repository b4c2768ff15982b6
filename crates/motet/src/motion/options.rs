//! Options of a mover: which facets are walls, what stays rigid, what slides.

use serde::Serialize;

use crate::algebra::Tolerance;
use crate::base::{Csr, Error, Result, VertexId};
use crate::geometry::vector::LARGEST;
use crate::mesh::{Boundary, CellKind, Mesh, corners};
use crate::names;

/// How the interior vertices follow.
#[derive(Clone, Debug, Default, Serialize)]
#[non_exhaustive]
pub enum Method {
    /// By weights in the Delaunay graph of the nodes (Liu, Qin, Xia 2006).
    #[default]
    Delaunay,
    /// As rigid bodies carry them along: each of the patches is a body; where there are none, each connected
    /// part of the walls is one, except the outer part.
    ///
    /// Walls are the boundary and interior facets whose vertices are [moved](Options::also_moved), such as
    /// those between fluid and solid: what they enclose moves along rigidly. A body's motion is the rigid one
    /// that best fits its vertices, a rotation of at most half a circle; the rest is done by the graph.
    Bodies(Vec<FacetSet>),
    /// By the graph with some interior vertices as nodes, each with a rotation in addition to its
    /// displacement, that of the walls near it: for walls that bend. Two small linear systems per step.
    Guided,
    /// As an elastic body that is stiff where cells are small. A linear system per step.
    Elastic(Elastic),
    /// Each coordinate of the displacement by a Laplace equation that is stiff at the wall. A linear system
    /// per step.
    Laplace(Laplace),
    /// By the mean of the rigid motions of all boundary vertices, weighted by distance (Luke, Collins, Blades
    /// 2012).
    InverseDistance,
    /// By radial basis functions of compact support on chosen centres (de Boer, van der Schoot, Bijl 2007;
    /// Rendall, Allen 2009).
    Radial,
}

names! {
    /// Where the strain goes that bodies put on the volume around them: see [`Method::Bodies`].
    pub enum Strain: "strain" {
        /// Evenly over all that lies between a body and the walls that stay: no tet gets much of it. For
        /// walls that return.
        Even = "even",
        /// Into a band of about one edge beside the body: what is farther away stays unchanged, to the bit.
        /// For bodies that keep moving: a few tets become bad, again and again, and all others stay good.
        Band = "band",
    }
}

/// Linear elasticity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Elastic {
    /// Poisson's ratio, at least 0 and below 0.5. Default: 0.3.
    pub poisson: f64,
    /// The stiffness of a cell is one over its volume to this power (Stein, Tezduyar, Benney 2003). Default:
    /// 1.
    pub stiffening: f64,
    /// Tolerance of steps that are iterated. Default: a residual of 1e-6.
    pub tolerance: Tolerance,
    /// Bytes that a factor of the matrix may take. It is kept, so that a step is exact and needs no
    /// iterations; where it would take more than this, steps are iterated. Default: 0.
    pub factor_bytes: u64,
}

impl Default for Elastic {
    fn default() -> Self {
        Self { poisson: 0.3, stiffening: 1.0, tolerance: DEFAULT_TOLERANCE, factor_bytes: 0 }
    }
}

/// A Laplace equation.
#[derive(Clone, Debug, Serialize)]
pub struct Laplace {
    /// The diffusivity is one over the distance from the wall to this power. Default: 1.
    pub exponent: f64,
    /// The wall; `None` means all of the boundary that does not slide.
    pub wall: Option<FacetSet>,
    /// Tolerance of steps that are iterated. Default: a residual of 1e-6.
    pub tolerance: Tolerance,
    /// Bytes that a factor of the matrix may take. It is kept, so that a step is exact and needs no
    /// iterations; where it would take more than this, steps are iterated. Default: 0.
    pub factor_bytes: u64,
}

impl Default for Laplace {
    fn default() -> Self {
        Self { exponent: 1.0, wall: None, tolerance: DEFAULT_TOLERANCE, factor_bytes: 0 }
    }
}

impl Method {
    /// Whether the method places only corners of cells, since it is based on the tets at them.
    pub(crate) fn places_corners_only(&self) -> bool {
        matches!(self, Self::Bodies(_) | Self::Elastic(_) | Self::Laplace(_))
    }

    /// Checks the numbers of the method.
    ///
    /// # Errors
    /// When a number is out of range.
    pub(crate) fn check(&self) -> Result<()> {
        let (power, tolerance) = match self {
            Self::Delaunay | Self::Bodies(_) | Self::Guided | Self::InverseDistance | Self::Radial => {
                return Ok(());
            }
            Self::Elastic(law) => {
                if !(0.0..0.5).contains(&law.poisson) {
                    return Err(Error::options(format!(
                        "Poisson's ratio must be in [0, 0.5); got {}",
                        law.poisson
                    ))
                    .remedy("give a number such as 0.3"));
                }
                (law.stiffening, law.tolerance)
            }
            Self::Laplace(law) => (law.exponent, law.tolerance),
        };
        if !power.is_finite() {
            return Err(Error::options(format!("the exponent of the stiffness must be finite; got {power}"))
                .remedy("give 1, or 0 for uniform stiffness"));
        }
        if !(tolerance.residual > 0.0 && tolerance.residual < 1.0) {
            return Err(Error::options(format!(
                "the relative residual must be between 0 and 1; got {}",
                tolerance.residual
            ))
            .remedy("give a number such as 1e-6"));
        }
        Ok(())
    }
}

/// Displacements are accurate to about this fraction of the largest: far finer than cells.
const DEFAULT_TOLERANCE: Tolerance = Tolerance { residual: 1e-6, iterations: 10_000 };

/// How a mesh is to be moved. The default moves every interior vertex by the graph of the boundary alone.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// How the interior vertices follow.
    pub method: Method,
    /// Where the strain goes with [`Method::Bodies`]. Default: [`Strain::Even`].
    pub strain: Strain,
    /// Whether the graph stays within the walls, so that no vertex follows the wall of another lumen or the
    /// far side of a flap. It is slower to set up, and needs a boundary whose facets meet only in what they
    /// share. Default: no.
    pub within_walls: bool,
    /// Number of sweeps over the vertices of bad tets after each step, which move them to where their tets
    /// are better. Default: 0.
    pub smoothing: usize,
    /// Interior vertices that the caller moves as well, such as those of an interface between fluid and wall.
    /// Any of them on the boundary do not slide. Default: none.
    pub also_moved: Vec<VertexId>,
    /// Vertices near a wall that keep their position relative to it. Default: none.
    pub rigid_layer: Option<RigidLayer>,
    /// Flat parts of the boundary whose vertices slide in their plane, following the vertices around them;
    /// where two planes meet, along their line. Displacements given for these vertices are ignored. Default:
    /// none.
    pub sliding: Vec<FacetSet>,
    /// How far the vertices of such a part may be off its plane, relative to its radius; they stay as far
    /// off.
    pub slide_tolerance: SlideTolerance,
    /// Limits of [`Mover::advance`](crate::motion::Mover::advance).
    pub limits: Limits,
}

impl Options {
    /// Checks the numbers.
    ///
    /// # Errors
    /// When a number is out of range.
    pub(crate) fn check(&self) -> Result<()> {
        self.method.check()?;
        let SlideTolerance(tolerance) = self.slide_tolerance;
        if !(0.0..1.0).contains(&tolerance) {
            return Err(Error::options(format!(
                "the tolerance of sliding patches must be a fraction of their radius in [0, 1); got {tolerance}"
            ))
            .remedy("give a number such as 0.05"));
        }
        match self.rigid_layer.as_ref().map(|layer| layer.extent) {
            Some(Extent::Distance(distance)) if !(0.0..=LARGEST).contains(&distance) => Err(Error::options(
                format!("the thickness of the rigid layer must be 0 or more; got {distance}"),
            )
            .remedy("give a length in the unit of the mesh, or leave it out")),
            _ => Ok(()),
        }
    }
}

/// The vertices that move rigidly with their nearest wall facet.
#[derive(Clone, Debug)]
pub struct RigidLayer {
    /// How far from the wall the layer reaches.
    pub extent: Extent,
    /// The wall; `None` means all of the boundary that does not slide.
    pub wall: Option<FacetSet>,
}

/// How flat a sliding patch has to be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SlideTolerance(
    /// The largest distance of a vertex from the plane of the patch, relative to the radius of the patch.
    /// Default: 0.05. Inlets cut by programs are off by 0.003, caps of rims cut by hand by 0.01 (both
    /// observed); the wall of a vessel by 0.3 and more.
    pub f64,
);

impl SlideTolerance {
    /// The default tolerance.
    pub const DEFAULT: Self = Self(0.05);
}

impl Default for SlideTolerance {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// How far a rigid layer reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// Vertices at most this far from the wall, in the unit of the mesh.
    Distance(f64),
    /// Vertices at most this many cells from the wall.
    Cells(usize),
}

/// When sub-stepping gives up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Limits {
    /// Maximum number of sub-steps. Default: 50.
    pub substeps: usize,
    /// A sub-step that advances by less than this fraction of the whole motion is no progress. Default:
    /// 0.002.
    pub smallest: f64,
    /// A sub-step that cannot go all the way goes no farther than to where the worst cell keeps this share of
    /// the volume that it had when the sub-step began: going to the very end of the admissible would leave
    /// flat cells behind. Default: 0.5 (values from 0 to 0.9 were tried on a sphere in a box, 32 k vertices,
    /// moved by three radii: the worst EAS is 0.001 up to 0.2, and 0.005 to 0.018 from 0.4 on, in 2 to 5
    /// sub-steps).
    pub keep_volume: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { substeps: 50, smallest: 0.002, keep_volume: 0.5 }
    }
}

/// Facets of a mesh, as rings of corners, and all vertices on them.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FacetSet {
    /// The name for messages, such as that of a patch.
    pub name: String,
    /// The corners of each facet, in order around it.
    pub rings: Csr<VertexId>,
    /// Corners and middle nodes, each once, in rising order.
    pub vertices: Vec<VertexId>,
}

impl FacetSet {
    /// The surface cells of `mesh` for which `is_wanted`, called with the index of the cell, holds.
    pub fn of_cells(mesh: &Mesh, name: impl Into<String>, is_wanted: impl Fn(usize) -> bool) -> Self {
        let cells = mesh.cells.iter().filter(|(id, kind, _)| kind.dim() == Some(2) && is_wanted(id.index()));
        Self::collect(name.into(), cells.map(|(_, kind, vertices)| (kind, vertices)), |v| v)
    }

    /// The facets of one patch, by the label of its surface cells; none when there is no such patch.
    pub fn of_patch(mesh: &Mesh, label: i32) -> Self {
        match mesh.patches() {
            Some(patches) => Self::of_cells(mesh, patches.name(label), |i| patches.ids[i] == label),
            None => Self { name: label.to_string(), ..Self::default() },
        }
    }

    /// The facets of the patch with this name or number.
    ///
    /// # Errors
    /// When the mesh has no such patch.
    pub fn find(mesh: &Mesh, word: &str) -> Result<Self> {
        Ok(Self::of_patch(mesh, mesh.find_patch(word)?))
    }

    /// Facets given by their corners, in order around each.
    pub fn of_rings<'a>(name: impl Into<String>, rings: impl Iterator<Item = &'a [VertexId]>) -> Self {
        let polygon = rings.map(|ring| (CellKind::POLYGON, ring));
        Self::collect(name.into(), polygon, |v| v)
    }

    /// The union of the sets, with all their names; `None` where there are no sets.
    pub fn joined(sets: impl IntoIterator<Item = Self>) -> Option<Self> {
        sets.into_iter().reduce(|mut all, set| {
            all.name = format!("{}, {}", all.name, set.name);
            set.rings.iter().for_each(|ring| all.rings.push(ring.iter().copied()));
            all.vertices.extend(set.vertices);
            all.vertices.sort_unstable();
            all.vertices.dedup();
            all
        })
    }

    /// The cells of another mesh, a surface, whose points are the vertices `point_to_vertex`.
    ///
    /// Panics when a cell names a point that has no entry in `point_to_vertex`.
    pub fn of_surface(surface: &Mesh, name: impl Into<String>, point_to_vertex: &[VertexId]) -> Self {
        let cells = surface.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2));
        let cells = cells.map(|(_, kind, points)| (kind, points));
        Self::collect(name.into(), cells, |p| point_to_vertex[p.index()])
    }

    /// The facets of a boundary for which `is_wanted`, called with the index of the facet, holds.
    pub fn of_boundary(
        boundary: &Boundary,
        name: impl Into<String>,
        is_wanted: impl Fn(usize) -> bool,
    ) -> Self {
        let facets = (0..boundary.len()).filter(|&i| is_wanted(i));
        let facets = facets.map(|i| (boundary.kinds[i], boundary.facets.list(i)));
        Self::collect(name.into(), facets, |v| v)
    }

    fn collect<'a>(
        name: String,
        facets: impl Iterator<Item = (CellKind, &'a [VertexId])>,
        vertex: impl Fn(VertexId) -> VertexId,
    ) -> Self {
        let mut set = Self { name, ..Self::default() };
        for (kind, vertices) in facets {
            set.vertices.extend(vertices.iter().map(|&v| vertex(v)));
            match kind {
                // Corners of a pixel are in rows, not in a ring.
                CellKind::PIXEL => set.rings.push([0, 1, 3, 2].map(|i| vertex(vertices[i]))),
                CellKind::TRIANGLE_STRIP => {
                    vertices.windows(3).for_each(|t| set.rings.push(t.iter().map(|&v| vertex(v))));
                }
                _ => set.rings.push(corners(kind, vertices).iter().map(|&v| vertex(v))),
            }
        }
        set.vertices.sort_unstable();
        set.vertices.dedup();
        set
    }

    /// The facets divided into triangles, as fans from their first corners.
    pub fn triangles(&self) -> impl Iterator<Item = [VertexId; 3]> + '_ {
        self.rings.iter().flat_map(|ring| {
            let last = ring.len().saturating_sub(1);
            (1..last.max(1)).filter(move |_| ring.len() > 2).map(|i| [ring[0], ring[i], ring[i + 1]])
        })
    }

    /// Whether there are no facets.
    pub fn is_empty(&self) -> bool {
        self.rings.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;

    #[test]
    fn a_patch_is_found_by_its_name_and_by_its_number() {
        let mesh = shapes::sphere_in_box(2, 1);
        let sphere = FacetSet::find(&mesh, "sphere").unwrap();
        assert_eq!(sphere, FacetSet::of_patch(&mesh, 1));
        assert_eq!(sphere, FacetSet::find(&mesh, "1").unwrap());
        let rings = FacetSet::of_rings("sphere", sphere.rings.iter());
        assert_eq!(rings, sphere);
        assert!(FacetSet::find(&mesh, "door").unwrap_err().to_string().contains("sphere, box"));
    }
}
