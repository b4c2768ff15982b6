//! Layers on surfaces: as thick as possible, the core between them filled, and all joined.

use super::columns::{Columns, Prism, Site};
use super::core::Core;
use super::glue::glue;
use super::neighbors::NONE;
use super::options::Layers;
use super::report::Report;
use super::skin::{Sides, Skin};
use super::slide::Sliders;
use super::split::n_tets;
use super::tangles::{CapRims, tangles};
use super::thickness::Heights;
use crate::base::{Csr, Error, Point, Result, Threads, VertexId};
use crate::delaunay::Constrained;
use crate::geometry::tet::volume;
use crate::mesh::Mesh;
use crate::meshing::surfaces::Surfaces;

/// The factor by which columns at fault are made thinner.
const THINNING: f64 = 0.7;

/// How often a column may be at fault before it is removed; a twentieth of its thickness is left by then.
const MAX_BLAMES: u8 = 8;

/// The number of rounds after which all columns at fault are removed at once, with their neighbours.
const PATIENT_ROUNDS: usize = 40;

/// The number of rounds after which all columns are removed.
const ROUNDS: usize = 80;

/// The largest number of prisms.
const MAX_PRISMS: usize = 200_000_000;

/// Layers fitted to surfaces.
pub(crate) struct GrownLayers<'a> {
    surfaces: &'a Surfaces,
    sides: Vec<Sides>,
    skin: Skin,
    /// The neighbors of each vertex along walls.
    around: Csr<VertexId>,
    slide: Sliders,
    rims: CapRims,
    heights: Heights,
    blames: Vec<u8>,
    rounds: usize,
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
        check_count(&skin)?;
        let around = around(&skin);
        let heights = Heights::find(&skin, &around, threads);
        let (slide, rims) = (Sliders::new(&skin), CapRims::new(&skin));
        let core = build(surfaces, &sides, &skin, &heights, &slide);
        let blames = vec![0; skin.points.len()];
        let mut grown = Self { surfaces, sides, skin, around, slide, rims, heights, blames, rounds: 0, core };
        grown.settle(threads)?;
        Ok(grown)
    }

    fn columns(&self) -> Columns<'_> {
        Columns::new(&self.skin, &self.heights)
    }

    /// Makes layers thinner until there are no tangles.
    fn settle(&mut self, threads: &Threads) -> Result<()> {
        loop {
            threads.watch().report_and_check("fitting layers", self.rounds, 0)?;
            let blamed = tangles(&self.skin, &self.columns(), &self.core, &self.rims, threads);
            if blamed.is_empty() {
                return Ok(());
            }
            self.give_way(&blamed);
        }
    }

    /// Makes columns thinner, and neighbouring ones as far as the slope requires.
    fn give_way(&mut self, blamed: &[VertexId]) {
        self.rounds += 1;
        for v in blamed {
            let w = v.index();
            self.blames[w] = self.blames[w].saturating_add(1);
            let is_removed = self.blames[w] > MAX_BLAMES || self.rounds > PATIENT_ROUNDS;
            self.heights.heights[w] *= if is_removed { 0.0 } else { THINNING };
        }
        if self.rounds > PATIENT_ROUNDS {
            let beside = blamed.iter().flat_map(|v| self.around.list(v.index()));
            beside.for_each(|v| self.heights.heights[v.index()] = 0.0);
        }
        if self.rounds > ROUNDS {
            self.heights.heights.fill(0.0);
        }
        self.heights.limit_slope(&self.skin, &self.around);
        self.core = build(self.surfaces, &self.sides, &self.skin, &self.heights, &self.slide);
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
            self.give_way(&blamed);
            self.settle(threads)?;
        }
    }

    /// The columns under tops that are in pieces.
    fn in_pieces(&self, filled: &Constrained) -> Vec<VertexId> {
        let is_off = |i: &usize| self.core.is_raised[*i] && filled.triangle_to_facets.list(*i).len() != 1;
        let columns = self.columns();
        let off = (0..self.core.is_raised.len()).filter(is_off);
        let on_skin = off.flat_map(|i| self.core.skin_triangles(&self.skin, i as u32));
        let corners = on_skin.flat_map(|s| self.skin.triangles[s as usize]);
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
        glue(mesh, to_mesh, self.surfaces, &self.skin, &self.columns(), &self.core)
    }

    /// The number of triangles of the surfaces.
    pub(crate) fn n_triangles(&self) -> usize {
        self.surfaces.triangles.len()
    }

    /// Statistics on the layers.
    pub(crate) fn report(&self) -> Report {
        let columns = self.columns();
        let mut report = Report::new(&self.skin, &columns, &self.heights, self.rounds);
        for t in 0..self.skin.triangles.len() as u32 {
            for prism in columns.prisms(t) {
                let Some((kind, _)) = prism.cell() else { continue };
                report.prisms += 1;
                report.tets += n_tets(kind);
                report.volume += prism_volume(&columns, &prism);
            }
        }
        report
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

fn build(surfaces: &Surfaces, sides: &[Sides], skin: &Skin, heights: &Heights, slide: &Sliders) -> Core {
    let motions: Vec<Point> = slide.motions(skin, heights);
    Core::new(surfaces, sides, skin, &Columns::new(skin, heights), &motions)
}

fn around(skin: &Skin) -> Csr<VertexId> {
    let walls = skin.triangles.iter().zip(&skin.stack_of).filter(|(_, stack)| **stack != NONE);
    let ends = walls.flat_map(|(&[a, b, c], _)| [(a, b), (b, a), (b, c), (c, b), (c, a), (a, c)]);
    let mut ends: Vec<(VertexId, VertexId)> = ends.collect();
    ends.sort_unstable();
    ends.dedup();
    Csr::from_pairs(skin.points.len(), || ends.iter().map(|&(from, to)| (from.index(), to)))
}

fn check_count(skin: &Skin) -> Result<()> {
    let count = |&stack: &u32| if stack == NONE { 0 } else { skin.stacks[stack as usize].count as usize };
    let n: usize = skin.stack_of.iter().map(count).sum();
    match n {
        0 => Err(Error::options("there is no triangle to grow layers on")
            .remedy("name a patch that bounds a body")),
        n if n > MAX_PRISMS => {
            Err(Error::options(format!("the layers would have {n} prisms; at most {MAX_PRISMS} are allowed"))
                .remedy("request fewer layers"))
        }
        _ => Ok(()),
    }
}

/// The volume of a prism: the mean over both choices of diagonals in its sides, so that neighbours agree
/// about the side between them.
fn prism_volume(columns: &Columns, prism: &Prism) -> f64 {
    let ([a, b, c], [d, e, f]) = (prism.bottom, prism.top);
    let of = |tet: [Site; 4]| volume(tet.map(|site| columns.at(site)));
    let one = of([a, c, b, d]) + of([b, c, e, d]) + of([d, e, f, c]);
    let other = of([d, e, f, a]) + of([a, c, b, f]) + of([a, b, e, f]);
    0.5 * (one + other)
}
