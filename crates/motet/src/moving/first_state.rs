//! The first mesh of walls that come back, as arrays of a saved state, and back.

use crate::base::{Id, Result, Threads, VertexId};
use crate::mesh::{CellKind, Cells, Field, Mesh};
use crate::moving::first::{Count, FirstMesh, Returns};
use crate::moving::now::{InFirst, Known, LeftBad};
use crate::moving::options::Options;
use crate::moving::state::{Taken, no_state};
use crate::moving::wall::NO_NODE;

/// Arrays on the vertices and cells of the mesh: the id of each in the first one.
const VERTEX: &str = "moving:first_vertex";
const CELL: &str = "moving:first_cell";
const COUNT: &str = "moving:returns";
const POINTS: &str = "moving:first_mesh_points";
const KINDS: &str = "moving:first_mesh_kinds";
const OFFSETS: &str = "moving:first_mesh_offsets";
const VERTICES: &str = "moving:first_mesh_vertices";
const FIRST: &str = "moving:first_mesh_first";
const NODE: &str = "moving:first_mesh_node";
const FIRST_EAS: &str = "moving:first_mesh_first_eas";
/// Prefix of the arrays of its bad tets that repair left.
const LEFT: &str = "moving:first_mesh_left";
/// Prefixes of its own point and cell arrays.
const OF_POINTS: &str = "moving:first_mesh_point:";
const OF_CELLS: &str = "moving:first_mesh_cell:";

impl Returns {
    /// Stores everything in the mesh of a saved state; nothing if the first mesh may not be put back and no
    /// mesh ever was.
    pub(super) fn put_on(&self, file: &mut Mesh, in_first: &InFirst) {
        let Count { n_changed, has_changed, is_away, is_unsettled } = self.count;
        let count = [n_changed, u32::from(has_changed), u32::from(is_away), u32::from(is_unsettled)];
        let Some(first) = &self.first else {
            if is_unsettled {
                file.field_data.push(Field::scalars(COUNT, count.to_vec()));
            }
            return;
        };
        file.field_data.push(Field::scalars(COUNT, count.to_vec()));
        file.set_point_field(Field::scalars(VERTEX, numbers(&in_first.vertices)));
        file.set_cell_field(Field::scalars(CELL, numbers(&in_first.cells)));
        let FirstMesh { mesh, known, left, .. } = first.as_ref();
        let kinds: Vec<u8> = mesh.cells.kinds().iter().map(|kind| kind.0).collect();
        file.field_data.extend([
            Field::vectors(POINTS, &mesh.points),
            Field::scalars(KINDS, kinds),
            Field::scalars(OFFSETS, mesh.cells.connectivity().offsets().to_vec()),
            Field::scalars(VERTICES, numbers(mesh.cells.connectivity().items())),
            Field::vectors(FIRST, &known.first),
            Field::scalars(NODE, known.node.clone()),
            Field::scalars(FIRST_EAS, known.first_eas.clone()),
        ]);
        file.field_data.extend(LeftBad::to_fields(left, LEFT));
        for (prefix, fields) in [(OF_POINTS, &mesh.point_data), (OF_CELLS, &mesh.cell_data)] {
            let named = |field: &Field| Field { name: format!("{prefix}{}", field.name), ..field.clone() };
            file.field_data.extend(fields.iter().map(named));
        }
    }

    /// Restores everything from the arrays of a saved state with this `mesh`; the second result is
    /// [`Known::in_first`].
    pub(super) fn taken(
        taken: &Taken,
        mesh: &Mesh,
        n_nodes: usize,
        options: &Options,
        threads: &Threads,
    ) -> Result<(Self, InFirst)> {
        if !taken.has(COUNT) {
            return Ok((Self::default(), InFirst::default()));
        }
        let &[n_changed, has_changed, is_away, is_unsettled] = taken.ids(COUNT)?.as_slice() else {
            return Err(no_state(COUNT));
        };
        let [has_changed, is_away, is_unsettled] = [has_changed, is_away, is_unsettled].map(|flag| flag != 0);
        let count = Count { n_changed, has_changed, is_away, is_unsettled };
        if !taken.has(POINTS) {
            return Ok((Self { first: None, count }, InFirst::default()));
        }
        let (first, known) = first_mesh(taken, mesh)?;
        check_known(&known, &first, n_nodes)?;
        let in_first = InFirst {
            vertices: ids_of(taken, VERTEX, mesh.points.len(), first.points.len())?,
            cells: ids_of(taken, CELL, mesh.cells.len(), first.cells.len())?,
        };
        let left = taken.left(LEFT, first.cells.len())?;
        let first = FirstMesh::from_parts(first, known, left, options, threads);
        Ok((Self { first: Some(Box::new(first)), count }, in_first))
    }
}

fn first_mesh(taken: &Taken, mesh: &Mesh) -> Result<(Mesh, Known)> {
    let kinds = taken.bytes(KINDS)?.into_iter().map(CellKind).collect();
    let vertices = taken.ids(VERTICES)?.into_iter().map(VertexId).collect();
    let cells = Cells::from_parts(kinds, taken.ids(OFFSETS)?, vertices)?;
    let mut first = Mesh::new(taken.vectors(POINTS)?, cells);
    first.label_names = mesh.label_names.clone();
    (first.point_data, first.cell_data) = (taken.named(OF_POINTS), taken.named(OF_CELLS));
    first.validate()?;
    let known = Known {
        first: taken.vectors(FIRST)?,
        node: taken.ids(NODE)?,
        first_eas: taken.floats(FIRST_EAS)?,
        in_first: InFirst::same(&first),
        ..Known::default()
    };
    Ok((first, known))
}

fn check_known(known: &Known, first: &Mesh, n_nodes: usize) -> Result<()> {
    let n_points = first.points.len();
    let is_node = |node: &u32| *node == NO_NODE || (*node as usize) < n_nodes;
    let all = [
        (FIRST, known.first.len() == n_points),
        (NODE, known.node.len() == n_points && known.node.iter().all(is_node)),
        (FIRST_EAS, known.first_eas.len() == first.cells.len()),
    ];
    all.iter().find(|(_, is_right)| !is_right).map_or(Ok(()), |(name, _)| Err(no_state(name)))
}

fn numbers<I: Id>(ids: &[I]) -> Vec<u32> {
    ids.iter().map(|id| if *id == I::NONE { u32::MAX } else { id.place() as u32 }).collect()
}

/// An id in the first mesh, or none, for each of `n` entities; fails if an id occurs twice.
fn ids_of<I: Id>(taken: &Taken, name: &str, n: usize, n_first: usize) -> Result<Vec<I>> {
    let numbers = taken.ids(name)?;
    let mut is_taken = vec![false; n_first];
    let mut is_free = |number: u32| {
        number == u32::MAX
            || is_taken.get_mut(number as usize).is_some_and(|taken| !std::mem::replace(taken, true))
    };
    match numbers.len() == n && numbers.iter().all(|number| is_free(*number)) {
        true => {
            Ok(numbers.into_iter().map(|i| if i == u32::MAX { I::NONE } else { I::of(i as usize) }).collect())
        }
        false => Err(no_state(name)),
    }
}
