//! Layers on surfaces: as thick as possible, the core between them filled, and all joined.

use super::columns::Columns;
use super::core::Core;
use super::glue::glue;
use super::growth::Growth;
use super::options::Layers;
use super::report::Report;
use super::skin::{Sides, Skin};
use super::slide::Sliders;
use super::tangles::{CapRims, tangles};
use super::thickness::{Heights, Limits};
use crate::base::{Error, Result, Threads, VertexId};
use crate::delaunay::Constrained;
use crate::mesh::Mesh;
use crate::meshing::surfaces::Surfaces;

/// Layers fitted to surfaces.
pub(crate) struct GrownLayers<'a> {
    surfaces: &'a Surfaces,
    sides: Vec<Sides>,
    growth: Growth,
    slide: Sliders,
    rims: CapRims,
    core: Core,
}

impl<'a> GrownLayers<'a> {
    /// Grows layers as far as there is space; `sides` are the bodies on the two sides of each triangle.
    ///
    /// # Errors
    /// When a stack is invalid, or when layers are requested on a membrane or on no wall.
    pub(crate) fn new(
        surfaces: &'a Surfaces,
        layers: &Layers,
        sides: Vec<Sides>,
        threads: &Threads,
    ) -> Result<Self> {
        layers.check()?;
        let skin = Skin::new(surfaces, layers, &sides)?;
        let (slide, rims) = (Sliders::new(&skin), CapRims::new(&skin));
        let mut growth = Growth::new(skin, &Limits::INSIDE, |_, full| full, threads)?;
        let core = settle(&mut growth, surfaces, &sides, &slide, &rims, threads)?;
        Ok(Self { surfaces, sides, growth, slide, rims, core })
    }

    /// Fills the core. `fill` gets its surfaces, and for each of their triangles the original triangle; what
    /// it returns beside the tets is passed on. If the top of a layer comes out in pieces, the columns below
    /// it give way and the core is filled again.
    ///
    /// # Errors
    /// When the core cannot be filled.
    pub(crate) fn fill<T>(
        &mut self,
        threads: &Threads,
        fill: impl Fn(&Surfaces, &[u32]) -> Result<(Constrained, T)>,
    ) -> Result<(Constrained, T)> {
        loop {
            let (mut filled, extra) = fill(&self.core.surfaces, &self.core.to_triangle)?;
            let blamed = self.in_pieces(&filled);
            if blamed.is_empty() {
                self.rename(&mut filled)?;
                return Ok((filled, extra));
            }
            self.growth.give_way(&blamed);
            self.core =
                settle(&mut self.growth, self.surfaces, &self.sides, &self.slide, &self.rims, threads)?;
        }
    }

    /// The columns under tops that are in pieces.
    fn in_pieces(&self, filled: &Constrained) -> Vec<VertexId> {
        let is_off = |i: &usize| self.core.is_raised[*i] && filled.triangle_to_facets.list(*i).len() != 1;
        let columns = self.growth.columns();
        let off = (0..self.core.is_raised.len()).filter(is_off);
        let on_skin = off.flat_map(|i| self.core.skin_triangles(&self.growth.skin, i as u32));
        let corners = on_skin.flat_map(|s| self.growth.skin.triangles[s as usize]);
        let mut blamed: Vec<VertexId> = corners.filter(|&v| columns.count(v) > 0).collect();
        blamed.sort_unstable();
        blamed.dedup();
        blamed
    }

    /// Gives the bodies the numbers they have without layers, and removes what lies between walls and tops.
    ///
    /// # Errors
    /// When a side of the core has no body behind it, or one that also lies behind a side of another body.
    fn rename(&self, filled: &mut Constrained) -> Result<()> {
        let n_bodies = filled.bodies.iter().max().map_or(0, |&b| b as usize + 1);
        let mut body_to_old = vec![None; n_bodies];
        for (i, (new, old)) in filled.triangle_to_bodies.iter().zip(&self.core.sides).enumerate() {
            for (new, old) in new.iter().zip(old).filter_map(|(new, old)| old.map(|old| (new, old))) {
                let known = new.map(|new| body_to_old[new as usize].get_or_insert(old));
                if known.is_none_or(|known| *known != old) {
                    return Err(Error::input("the layers leave no space inside")
                        .at(format!("triangle {}", self.core.to_triangle[i]))
                        .remedy("request thinner layers"));
                }
            }
        }
        let kept: Vec<_> = filled.bodies.iter().map(|&b| body_to_old[b as usize]).collect();
        let mut stays = kept.iter().map(Option::is_some);
        filled.tets.retain(|_| stays.next().unwrap_or(false));
        filled.bodies = kept.into_iter().flatten().collect();
        filled.triangle_to_bodies.clone_from(&self.core.sides);
        let raised = filled.triangle_to_bodies.iter_mut().zip(&self.core.is_raised);
        // Tops are not part of the surface.
        raised.filter(|(_, is_raised)| **is_raised).for_each(|(sides, _)| *sides = [None; 2]);
        Ok(())
    }

    /// The surfaces of the core.
    pub(crate) fn core(&self) -> &Surfaces {
        &self.core.surfaces
    }

    /// Joins the mesh of the core and the layers, as prisms; `to_mesh` maps vertices of the core to those of
    /// its mesh.
    pub(crate) fn glue(&self, mesh: &Mesh, to_mesh: &[VertexId]) -> Mesh {
        glue(mesh, to_mesh, self.surfaces, &self.growth.skin, &self.growth.columns(), &self.core)
    }

    /// The number of triangles of the surfaces.
    pub(crate) fn n_triangles(&self) -> usize {
        self.surfaces.triangles.len()
    }

    /// Statistics on the layers.
    pub(crate) fn report(&self) -> Report {
        self.growth.report()
    }

    /// Counts the triangles of the surfaces that are facets unchanged, where `is_whole` tells which triangles
    /// of the core are in one piece, and those that enclose nothing.
    pub(crate) fn count(&self, is_whole: impl Fn(usize) -> bool) -> [usize; 2] {
        let mut is_kept = vec![false; self.surfaces.triangles.len()];
        for (i, &t) in self.core.to_triangle.iter().enumerate() {
            is_kept[t as usize] |= self.core.is_raised[i] || self.core.is_unmoved[i] && is_whole(i);
        }
        let n_kept = is_kept.iter().filter(|kept| **kept).count();
        [n_kept, self.sides.iter().filter(|sides| **sides == [None; 2]).count()]
    }
}

/// Makes layers thinner until there are no tangles. Returns the core that they leave.
fn settle(
    growth: &mut Growth,
    surfaces: &Surfaces,
    sides: &[Sides],
    slide: &Sliders,
    rims: &CapRims,
    threads: &Threads,
) -> Result<Core> {
    let build = |skin: &Skin, heights: &Heights| {
        let motions = slide.motions(skin, heights);
        Core::new(surfaces, sides, skin, &Columns::new(skin, heights), &motions)
    };
    growth.settle(build, |skin, columns, core| tangles(skin, columns, core, rims, threads), threads)
}
