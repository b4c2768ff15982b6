//! Refinement of everything a file holds: cells of other kinds stay, arrays are transferred, and the memory
//! is stored as arrays.

mod ancestry;
mod joined;
mod memory_arrays;
mod origins;

use super::forest::Extracted;
use super::refinement::{Before, Options, Refinement, Summary};
use super::true_surface::OnSurface;
use crate::base::{CellId, Result, TetId, Threads, VertexId};
use crate::mesh::history::{Changed, History, Origins, Rules, number_anew};
use crate::mesh::{CellKind, Mesh, TetPart};
use crate::spatial::NearestTriangle;
use ancestry::Ancestry;
use joined::Joined;
use origins::origins;

/// A mesh of any cells whose tets are refined and coarsened again and again. The parts of a divided cell take
/// its place in the order of cells; new points follow all others.
#[derive(Clone, Debug)]
pub struct MeshRefinement {
    mesh: Mesh,
    refinement: Refinement,
    /// The cells of the first mesh, in order.
    slots: Vec<Slot>,
    tet_to_cell: Vec<CellId>,
    triangle_to_cell: Vec<CellId>,
    line_to_cell: Vec<CellId>,
}

/// The kind of a cell of the first mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Slot {
    Tet,
    Triangle,
    Line,
    Other,
}

impl Slot {
    /// Classifies a cell as [`TetPart`] does.
    fn of(kind: CellKind, vertices: &[VertexId]) -> Self {
        match (kind, vertices) {
            (CellKind::TETRA, _) => Self::Tet,
            (CellKind::TRIANGLE, _) => Self::Triangle,
            (CellKind::LINE, [a, b]) if a != b => Self::Line,
            _ => Self::Other,
        }
    }
}

impl MeshRefinement {
    /// Starts with a mesh. If it has the arrays that [`with_memory`](Self::with_memory) adds, continues from
    /// what they record.
    ///
    /// # Errors
    /// When there is no tet, when the tets do not form a mesh (the error gives the first such cell), and when
    /// the arrays belong to another mesh.
    pub fn new(mesh: &Mesh, options: Options, threads: &Threads) -> Result<Self> {
        let part = TetPart::of(mesh)?;
        let memory = memory_arrays::memory(mesh, &part)?;
        let refinement = match &memory {
            Some(memory) => Refinement::recall(&part.mesh, memory, options, threads),
            None => Refinement::new(&part.mesh, options, threads),
        };
        let refinement = refinement.map_err(|error| part.at_cell(error))?;
        let slots = slots(mesh, &refinement);
        let TetPart { tet_to_cell, triangle_to_cell, line_to_cell, .. } = part;
        let mesh = memory_arrays::without(mesh);
        Ok(Self { mesh, refinement, slots, tet_to_cell, triangle_to_cell, line_to_cell })
    }

    /// Returns the mesh without its memory: it then counts as the first mesh, as it is.
    pub fn forget(mesh: &Mesh) -> Mesh {
        memory_arrays::without(mesh)
    }

    /// Puts new points of the boundary on the true surface, see [`Refinement::put_on_surface`].
    pub fn put_on_surface(&mut self, surface: &NearestTriangle) -> OnSurface {
        let done = self.refinement.put_on_surface(surface);
        self.mesh.points.clone_from(&self.refinement.mesh().points);
        done
    }

    /// The current mesh, with the arrays transferred so far and without those of the memory.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The refinement of its tets, triangles and lines, in the order of [`mesh`](Self::mesh), with their
    /// memory.
    pub fn refinement(&self) -> &Refinement {
        &self.refinement
    }

    /// The tets, triangles and lines, and the ids of their cells.
    pub fn part(&self) -> TetPart {
        TetPart {
            mesh: self.refinement.mesh().clone(),
            tet_to_cell: self.tet_to_cell.clone(),
            triangle_to_cell: self.triangle_to_cell.clone(),
            line_to_cell: self.line_to_cell.clone(),
        }
    }

    /// The mesh with its memory as arrays, unless nothing is divided: `refine_root`, `refine_path`,
    /// `refine_piece` and `refine_asked` on cells and `refine_reference` on points (see
    /// [`Memory`](crate::refine::Memory)).
    pub fn with_memory(&self, threads: &Threads) -> Mesh {
        let mut mesh = self.mesh.clone();
        if self.refinement.is_divided() {
            let memory = self.refinement.memory_to_keep(threads);
            memory_arrays::store(&mut mesh, &memory, &self.tet_to_cell, &self.triangle_to_cell);
        }
        mesh
    }

    /// Divides the marked tets as [`Refinement::refine`] does, and transfers the arrays by `rules`.
    ///
    /// # Errors
    /// The errors of [`Refinement::refine`], and when a rule fits no array; then nothing has changed.
    pub fn refine(
        &mut self,
        marked: &[TetId],
        rules: &Rules,
        threads: &Threads,
    ) -> Result<Changed<Summary, &Mesh>> {
        self.change(rules, threads, |refinement| refinement.refine_from(marked, threads))
    }

    /// Takes divisions back as [`Refinement::coarsen`] does, and transfers the arrays by `rules`.
    ///
    /// # Errors
    /// The errors of [`Refinement::coarsen`], and when a rule fits no array; then nothing has changed.
    pub fn coarsen(
        &mut self,
        marked: &[TetId],
        rules: &Rules,
        threads: &Threads,
    ) -> Result<Changed<Summary, &Mesh>> {
        self.change(rules, threads, |refinement| refinement.coarsen_from(marked, threads))
    }

    fn change(
        &mut self,
        rules: &Rules,
        threads: &Threads,
        change: impl FnOnce(&mut Refinement) -> Result<Before>,
    ) -> Result<Changed<Summary, &Mesh>> {
        let before = change(&mut self.refinement)?;
        let history = match self.follow(&before.was, rules, threads) {
            Ok(history) => history,
            Err(error) => {
                self.refinement.undo(before, threads)?;
                return Err(error);
            }
        };
        Ok(Changed { mesh: &self.mesh, history, report: self.refinement.summary() })
    }

    /// Follows a change of the tets with everything else; `was` are the tets before.
    ///
    /// # Errors
    /// When a rule fits no array; then nothing here has changed.
    fn follow(&mut self, was: &Extracted, rules: &Rules, threads: &Threads) -> Result<History> {
        let Refinement { forest, now: is, .. } = &self.refinement;
        let cells = [&self.tet_to_cell[..], &self.triangle_to_cell, &self.line_to_cell];
        let ancestry = Ancestry::new(forest, [was, is], threads);
        let joined = Joined::of(&self.mesh, &self.slots, cells, forest, [was, is], &ancestry, threads);
        let found = origins(forest, [was, is], &ancestry, &joined, cells, threads)?;
        let history = History {
            vertices: Origins::trusted(self.mesh.points.len(), joined.vertex_to_old, found.vertices),
            cells: Origins::trusted(self.mesh.cells.len(), joined.cell_to_old, found.cells),
            ledger: found.ledger,
        };
        let mut mesh = Mesh::new(is.mesh.points.clone(), joined.cells);
        history.transfer_on(&self.mesh, &mut mesh, rules, threads)?;
        let new_points = history.vertices.changed().ids();
        number_anew(&mut mesh, new_points, history.cells.changed().ids());
        mesh.unmark(new_points);
        self.mesh = mesh;
        (self.tet_to_cell, self.triangle_to_cell) = (joined.tet_to_cell, joined.triangle_to_cell);
        self.line_to_cell = joined.line_to_cell;
        Ok(history)
    }
}

/// One slot for each cell of the first mesh: all parts of a root share the slot of its first part.
fn slots(mesh: &Mesh, refinement: &Refinement) -> Vec<Slot> {
    let mut roots = refinement.roots().map(|root| root.0);
    let mut triangles = refinement.now.triangles.iter().map(|triangle| triangle.0);
    let mut lines = refinement.now.lines.iter().map(|line| line.0);
    let (mut next_root, mut next_triangle, mut next_line) = (0, 0, 0);
    let mut slots = Vec::new();
    for (_, kind, vertices) in mesh.cells.iter() {
        let slot = Slot::of(kind, vertices);
        // Roots, triangles and lines are numbered in the order of their first appearance in the mesh.
        let is_first = match slot {
            Slot::Tet => is_next(roots.next(), &mut next_root),
            Slot::Triangle => is_next(triangles.next(), &mut next_triangle),
            Slot::Line => is_next(lines.next(), &mut next_line),
            Slot::Other => true,
        };
        if is_first {
            slots.push(slot);
        }
    }
    slots
}

fn is_next(found: Option<u32>, next: &mut u32) -> bool {
    let is_next = found == Some(*next);
    *next += u32::from(is_next);
    is_next
}
