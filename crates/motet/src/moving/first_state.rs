//! The first mesh of walls that come back, as arrays of a saved state, and back.

use crate::base::{Id, MaybeId, Result, Threads, VertexId};
use crate::mesh::{CellKind, Cells, Field, Mesh};
use crate::moving::current::{InFirst, LeftBad, Records};
use crate::moving::first_mesh::{Count, FirstMesh, Returns};
use crate::moving::options::Options;
use crate::moving::shapes::Tets;
use crate::moving::state::{StateArrays, damaged_state};
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
    pub(super) fn store_in(&self, file: &mut Mesh, in_first: &InFirst) {
        let Count { n_changed, has_changed, is_away, is_unsettled } = self.count;
        let count = [n_changed, u32::from(has_changed), u32::from(is_away), u32::from(is_unsettled)];
        let Some(first) = &self.first else {
            if is_unsettled {
                file.field_data.push(Field::scalars(COUNT, count.to_vec()));
            }
            return;
        };
        file.field_data.push(Field::scalars(COUNT, count.to_vec()));
        file.set_point_field(Field::scalars(VERTEX, known_numbers(&in_first.vertices)));
        file.set_cell_field(Field::scalars(CELL, known_numbers(&in_first.cells)));
        let FirstMesh { mesh, records, left, .. } = first.as_ref();
        let kinds: Vec<u8> = mesh.cells.kinds().iter().map(|kind| kind.0).collect();
        file.field_data.extend([
            Field::vectors(POINTS, &mesh.points),
            Field::scalars(KINDS, kinds),
            Field::scalars(OFFSETS, mesh.cells.connectivity().offsets().to_vec()),
            Field::scalars(VERTICES, numbers(mesh.cells.connectivity().items())),
            Field::vectors(FIRST, &records.first),
            Field::scalars(NODE, records.node.clone()),
            Field::scalars(FIRST_EAS, records.first_eas.clone()),
        ]);
        file.field_data.extend(LeftBad::to_fields(left, LEFT));
        for (prefix, fields) in [(OF_POINTS, &mesh.point_data), (OF_CELLS, &mesh.cell_data)] {
            let named = |field: &Field| Field { name: format!("{prefix}{}", field.name), ..field.clone() };
            file.field_data.extend(fields.iter().map(named));
        }
    }

    /// Restores everything from the arrays of a saved state with this `mesh`; the second result is
    /// [`Records::in_first`].
    pub(super) fn from_state(
        arrays: &StateArrays,
        mesh: &Mesh,
        n_nodes: usize,
        options: &Options,
        threads: &Threads,
    ) -> Result<(Self, InFirst)> {
        if !arrays.has(COUNT) {
            return Ok((Self::default(), InFirst::default()));
        }
        let &[n_changed, has_changed, is_away, is_unsettled] = arrays.ids(COUNT)?.as_slice() else {
            return Err(damaged_state(COUNT));
        };
        let [has_changed, is_away, is_unsettled] = [has_changed, is_away, is_unsettled].map(|flag| flag != 0);
        let count = Count { n_changed, has_changed, is_away, is_unsettled };
        if !arrays.has(POINTS) {
            return Ok((Self { first: None, count }, InFirst::default()));
        }
        let (first, records) = first_mesh(arrays, mesh)?;
        check_records(&records, &first, n_nodes)?;
        let in_first = InFirst {
            vertices: ids_of(arrays, VERTEX, mesh.points.len(), first.points.len())?,
            cells: ids_of(arrays, CELL, mesh.cells.len(), first.cells.len())?,
        };
        let left = arrays.left(LEFT, first.cells.len())?;
        let tets = Tets::of(&first, threads);
        let first = FirstMesh::from_parts(first, &tets, records, left, options, threads);
        Ok((Self { first: Some(Box::new(first)), count }, in_first))
    }
}

fn first_mesh(arrays: &StateArrays, mesh: &Mesh) -> Result<(Mesh, Records)> {
    let kinds = arrays.bytes(KINDS)?.into_iter().map(CellKind).collect();
    let vertices = arrays.ids(VERTICES)?.into_iter().map(VertexId).collect();
    let cells = Cells::from_parts(kinds, arrays.ids(OFFSETS)?, vertices)?;
    let mut first = Mesh::new(arrays.vectors(POINTS)?, cells);
    first.label_names = mesh.label_names.clone();
    (first.point_data, first.cell_data) = (arrays.named(OF_POINTS), arrays.named(OF_CELLS));
    first.validate()?;
    let records = Records {
        first: arrays.vectors(FIRST)?,
        node: arrays.ids(NODE)?,
        first_eas: arrays.floats(FIRST_EAS)?,
        in_first: InFirst::same(&first),
        ..Records::default()
    };
    Ok((first, records))
}

fn check_records(records: &Records, first: &Mesh, n_nodes: usize) -> Result<()> {
    let n_points = first.points.len();
    let is_node = |node: &u32| *node == NO_NODE || (*node as usize) < n_nodes;
    let all = [
        (FIRST, records.first.len() == n_points),
        (NODE, records.node.len() == n_points && records.node.iter().all(is_node)),
        (FIRST_EAS, records.first_eas.len() == first.cells.len()),
    ];
    all.iter().find(|(_, is_right)| !is_right).map_or(Ok(()), |(name, _)| Err(damaged_state(name)))
}

fn numbers<I: Id>(ids: &[I]) -> Vec<u32> {
    ids.iter().map(|id| id.place() as u32).collect()
}

/// The numbers of ids, the largest one for none.
fn known_numbers<I: Id>(ids: &[MaybeId<I>]) -> Vec<u32> {
    ids.iter().map(|id| id.get().map_or(u32::MAX, |id| id.place() as u32)).collect()
}

/// An id in the first mesh, or none, for each of `n` entities; fails if an id occurs twice.
fn ids_of<I: Id>(arrays: &StateArrays, name: &str, n: usize, n_first: usize) -> Result<Vec<MaybeId<I>>> {
    let numbers = arrays.ids(name)?;
    let mut is_used = vec![false; n_first];
    let mut is_free = |number: u32| {
        number == u32::MAX
            || is_used.get_mut(number as usize).is_some_and(|used| !std::mem::replace(used, true))
    };
    match numbers.len() == n && numbers.iter().all(|number| is_free(*number)) {
        true => {
            let known = |i: u32| if i == u32::MAX { MaybeId::NONE } else { I::of(i as usize).into() };
            Ok(numbers.into_iter().map(known).collect())
        }
        false => Err(damaged_state(name)),
    }
}
