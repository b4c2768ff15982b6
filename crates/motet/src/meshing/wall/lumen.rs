//! The surface that a wall stands on, closed.

use std::collections::BTreeMap;

use super::super::caps::Caps;
use super::super::compact::{compact, used_vertices};
use super::super::layers::{EndFacet, is_on_cap};
use super::super::surfaces::Surfaces;
use crate::base::{CellId, Error, Result, Threads, VertexId, sorted_ids};
use crate::mesh::{Boundary, CellKind, Cells, Mesh, Surface, cone_volume};
use crate::preflight::{Role, open_rims, preflight, renamed};

/// The name of a surface without patches.
pub(super) const INTERFACE: &str = "interface";

/// The lumen: what it is a part of, and its surface.
pub(super) struct Lumen {
    /// The points and cells that stay, without arrays.
    pub(super) base: Mesh,
    /// For each point of the base, the point of the given mesh.
    pub(super) points: Vec<VertexId>,
    /// For each cell of the base, the cell of the given mesh.
    pub(super) cells: Vec<CellId>,
    /// The surface, facing outward, over the points of the base; more points follow those where it is closed.
    pub(super) surfaces: Surfaces,
    /// The number of triangles that are there; those after them close the surface.
    pub(super) n_real: usize,
    /// For each of these, the cell of the given mesh from which the wall takes its values.
    pub(super) beside: Vec<CellId>,
    /// For each of these, whether the base has it as a surface cell.
    pub(super) is_cell: Vec<bool>,
    /// For each triangle, whether the wall stands on it.
    pub(super) on: Vec<bool>,
}

impl Lumen {
    /// The lumen of a mesh: inside the boundary of its volume cells or, where it has none, its surface cells.
    ///
    /// # Errors
    /// When there is no surface, a wall facet is not a triangle, the surface has faults other than open ends,
    /// or a patch does not exist.
    pub(super) fn of(mesh: &Mesh, on: &[String], threads: &Threads) -> Result<Self> {
        let boundary = Boundary::of(&mesh.cells);
        let mut lumen = match boundary.is_empty() {
            true => Self::of_surface(mesh)?,
            false => Self::of_volume(mesh, boundary),
        };
        lumen.close()?;
        lumen.check(threads)?;
        lumen.choose(on)?;
        match lumen.is_volume() {
            true => lumen.check_facets(mesh)?,
            false => lumen.drop_caps()?,
        }
        Ok(lumen)
    }

    /// Whether there are volume cells.
    pub(super) fn is_volume(&self) -> bool {
        self.base.cells.kinds().iter().any(|kind| kind.dim() == Some(3))
    }

    /// The patch of the cap beside an end; 0 where there is none.
    pub(super) fn cap_at(&self, end: &EndFacet) -> i32 {
        end.beyond.map_or(0, |t| self.surfaces.patches[t as usize])
    }

    fn of_volume(mesh: &Mesh, boundary: Boundary) -> Self {
        let surface = Surface::of_boundary(mesh, boundary);
        let own = Surface::of(mesh);
        let key = |t: &[VertexId; 3]| sorted_ids(*t);
        let labelled: BTreeMap<[VertexId; 3], usize> =
            own.triangles.iter().zip(0..).map(|(t, i)| (key(t), i)).collect();
        let found: Vec<Option<&usize>> = surface.triangles.iter().map(|t| labelled.get(&key(t))).collect();
        let patches = found.iter().map(|i| i.map_or(0, |i| own.patches[*i])).collect();
        let n = surface.triangles.len();
        Self {
            base: Mesh::new(mesh.points.clone(), mesh.cells.clone()),
            points: (0..mesh.points.len()).map(VertexId::new).collect(),
            cells: (0..mesh.cells.len()).map(CellId::new).collect(),
            n_real: n,
            beside: surface.triangle_to_cell,
            is_cell: found.iter().map(Option::is_some).collect(),
            on: Vec::new(),
            surfaces: Surfaces {
                points: surface.points,
                triangles: surface.triangles,
                surface_of: vec![0; n],
                roles: vec![Role::Boundary],
                names: vec![INTERFACE.into()],
                meshes: vec![vec![0]],
                patches,
                patch_names: own.patch_names,
                n_lost: 0,
            },
        }
    }

    fn of_surface(mesh: &Mesh) -> Result<Self> {
        let given = Surface::of(mesh);
        if given.triangles.is_empty() {
            return Err(Error::input("the mesh has no surface: neither surface cells nor volume cells")
                .remedy("give a surface of triangles, quads or polygons, or a volume mesh"));
        }
        let mut surfaces = Surfaces::of(&[(&given, Role::Boundary, INTERFACE)])?;
        let is_used = used_vertices(surfaces.points.len(), surfaces.triangles.as_flattened().iter());
        let (points, old_to_new) = compact(&surfaces.points, &is_used);
        let triangles = renamed(&surfaces.triangles, &old_to_new);
        surfaces = Surfaces { points, triangles, ..surfaces };
        let n = surfaces.triangles.len();
        Ok(Self {
            base: Mesh::new(
                surfaces.points.clone(),
                Cells::uniform(CellKind::TRIANGLE, surfaces.triangles.as_flattened().to_vec())?,
            ),
            points: (0..is_used.len()).filter(|&v| is_used[v]).map(VertexId::new).collect(),
            cells: given.triangle_to_cell.clone(),
            n_real: n,
            beside: given.triangle_to_cell,
            is_cell: vec![true; n],
            on: Vec::new(),
            surfaces,
        })
    }

    /// Closes open ends by triangles that are not part of the surface, and turns the surface outward.
    fn close(&mut self) -> Result<()> {
        let Surfaces { points, triangles, .. } = &self.surfaces;
        let [closed, torn] = open_rims(points, triangles);
        if !(closed.is_empty() && torn.is_empty()) {
            let cells = Cells::uniform(CellKind::TRIANGLE, triangles.as_flattened().to_vec())?;
            let open = Mesh::new(points.clone(), cells);
            let closed = Surface::of(&Caps::of(&open)?.close(&open)?);
            self.surfaces.points = closed.points;
            self.surfaces.triangles = closed.triangles;
            self.surfaces.surface_of.resize(self.surfaces.triangles.len(), 0);
            self.surfaces.patches.resize(self.surfaces.triangles.len(), 0);
        }
        let Surfaces { points, triangles, .. } = &mut self.surfaces;
        let origin = triangles.first().map_or([0.0; 3], |t| points[t[0].index()]);
        let volume: f64 = triangles.iter().map(|t| cone_volume(t.iter().copied(), points, origin)).sum();
        if volume < 0.0 {
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        Ok(())
    }

    /// # Errors
    /// When the surface has faults other than open ends.
    fn check(&self, threads: &Threads) -> Result<()> {
        let Surfaces { points, triangles, surface_of, .. } = &self.surfaces;
        let n = self.n_real;
        let role = if n < triangles.len() { Role::Membrane } else { Role::Boundary };
        preflight(points, &triangles[..n], &surface_of[..n], &[role], threads)
            .first_error()
            .map_or(Ok(()), Err)
    }

    /// Finds the triangles on which the wall stands: those of some patches, or all that are not on caps.
    fn choose(&mut self, on: &[String]) -> Result<()> {
        let Surfaces { points, triangles, patches, .. } = &self.surfaces;
        let ids = on.iter().map(|patch| self.surfaces.find_patch(patch)).collect::<Result<Vec<i32>>>()?;
        let mut chosen: Vec<bool> = match on {
            [] => is_on_cap(points, triangles).into_iter().map(|is_cap| !is_cap).collect(),
            _ => patches.iter().map(|patch| ids.contains(patch)).collect(),
        };
        chosen[self.n_real..].fill(false);
        self.on = chosen;
        match self.on.contains(&true) {
            true => Ok(()),
            false => Err(Error::options("there is no triangle for a wall to stand on")
                .remedy("name patches that have triangles")),
        }
    }

    /// # Errors
    /// When the wall would stand on a facet that is not a triangle.
    fn check_facets(&self, mesh: &Mesh) -> Result<()> {
        let mut boundary = Boundary::of(&mesh.cells);
        boundary.turn_outward(&mesh.cells, &mesh.points);
        let is_triangle: BTreeMap<CellId, bool> = boundary
            .cells
            .iter()
            .zip(&boundary.kinds)
            .map(|(cell, kind)| (*cell, *kind == CellKind::TRIANGLE))
            .collect();
        let off = (0..self.n_real).find(|&t| self.on[t] && !is_triangle[&self.beside[t]]);
        match off {
            None => Ok(()),
            Some(t) => Err(Error::input("the wall would stand on a facet that is not a triangle")
                .at(format!("cell {}", self.beside[t]))
                .remedy("give linear tets, or prisms whose triangles lie on the wall")),
        }
    }

    /// Leaves out the triangles of a surface on which no wall stands: they bound nothing.
    fn drop_caps(&mut self) -> Result<()> {
        let kept: Vec<usize> = (0..self.n_real).filter(|&t| self.on[t]).collect();
        let triangles = kept.iter().flat_map(|&t| self.surfaces.triangles[t]).collect();
        self.base.cells = Cells::uniform(CellKind::TRIANGLE, triangles)?;
        self.cells = kept.iter().map(|&t| self.beside[t]).collect();
        Ok(())
    }
}
