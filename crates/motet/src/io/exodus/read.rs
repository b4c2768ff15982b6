//! Reads points, blocks, sets and variables into a mesh.

use super::kinds::{kind, order};
use super::sets::{Directory, add_block, node_sets, numbered, prefix_of, side_sets};
use super::source::Source;
use super::variables;
use crate::base::{Error, Point, Result, VertexId};
use crate::io::format::Input;
use crate::io::named_sets::{NamedSets, Rank, set_labels};
use crate::io::scalar::to_ids;
use crate::io::text::quoted;
use crate::mesh::{Cells, Field, Mesh};

/// Arrays that are skipped, with what they are.
const SKIPPED: &[(&str, &str)] = &[
    ("vals_glo_var", "global variables are skipped"),
    ("vals_sset_var", "variables of side sets are skipped"),
    ("vals_nset_var", "variables of node sets are skipped"),
    ("facconn", "blocks of polyhedra are skipped"),
];

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let source = Source::open(input.bytes)?;
    let mut mesh = Mesh::new(points(&source)?, Cells::new());
    let directory = Directory::read(&source, "eb")?;
    let mut sets = NamedSets::default();
    let mut blocks = Vec::new();
    let mut cell_of = Vec::new();
    for number in numbered(&source, "connect") {
        let start = mesh.cells.len();
        let n_elements = block(&source, number, &mut mesh, &mut cell_of, input)?;
        let end = mesh.cells.len();
        if start < end {
            let prefix = prefix_of(mesh.cells.kinds()[start]);
            let cells = start as u32..end as u32;
            add_block(&mut sets.all, directory.set(number, prefix, vec![cells], Rank::Declared));
        }
        if n_elements == end - start {
            blocks.push((number, start..end));
        }
    }
    let n_own = mesh.cells.len();
    side_sets(&source, &mut mesh, &cell_of, &mut sets, input.notes)?;
    set_labels(&mut mesh, n_own, &sets.all, input.notes);
    node_sets(&source, &mut mesh, input.notes)?;
    let (n_points, n_cells) = (mesh.points.len(), mesh.cells.len());
    let of_points = variables::of_points(&source, n_points, input.notes)?;
    let of_cells = variables::of_cells(&source, &blocks, n_cells, input.bytes.len() as u64, input.notes)?;
    of_points.into_iter().for_each(|field: Field| mesh.set_point_field(field));
    for field in of_cells {
        match mesh.cell_field(&field.name).is_some() {
            true => input.notes.add(format!("variable {} is skipped: labels have this name", field.name)),
            false => mesh.set_cell_field(field),
        }
    }
    if let Some(n) = source.n_steps("time_whole")?.filter(|&n| n > 1) {
        input.notes.add(format!("of {n} steps over time the last is read"));
    }
    for (prefix, what) in SKIPPED {
        if source.names().iter().any(|name| name.starts_with(prefix)) {
            input.notes.add(*what);
        }
    }
    Ok(mesh)
}

/// The points, from an array for each coordinate or one for all.
fn points(source: &Source<'_>) -> Result<Vec<Point>> {
    let missing = || {
        Error::input("there are no coordinates (coordx or coord)")
            .remedy("the file contains no mesh, or is no Exodus II file")
    };
    let numbers = |name: &str, values: crate::mesh::Values| {
        values.to_f64().ok_or_else(|| Error::input("expected numbers").at(format!("array {name}")))
    };
    let mut columns: Vec<Vec<f64>> = Vec::new();
    if let Some(table) = source.table("coord")? {
        let all = numbers("coord", table.values)?;
        columns.extend(all.chunks(table.n_columns.max(1)).take(3).map(<[f64]>::to_vec));
    } else {
        for name in ["coordx", "coordy", "coordz"] {
            let Some(table) = source.table(name)? else { break };
            columns.push(numbers(name, table.values)?);
        }
    }
    let n = columns.first().ok_or_else(missing)?.len();
    if columns.iter().any(|column| column.len() != n) {
        return Err(Error::input("the coordinates of points differ in number").remedy("the file is damaged"));
    }
    if n > VertexId::MAX_COUNT {
        return Err(Error::input("more nodes than a mesh can hold"));
    }
    let mut points = vec![[0.0; 3]; n];
    for (axis, column) in columns.iter().enumerate() {
        points.iter_mut().zip(column).for_each(|(point, &x)| point[axis] = x);
    }
    Ok(points)
}

/// Appends the elements of a block; returns their number. Blocks of types that are no cells here are skipped.
fn block(
    source: &Source<'_>,
    number: usize,
    mesh: &mut Mesh,
    cell_of: &mut Vec<Option<u32>>,
    input: &Input<'_>,
) -> Result<usize> {
    let name = format!("connect{number}");
    let bad = |what: String| {
        Error::input(what).at(format!("array {name}")).remedy("the file is damaged: write it again")
    };
    let Some(table) = source.table(&name)? else { return Ok(0) };
    let type_name = source.attribute(&name, "elem_type")?.unwrap_or_default();
    let n_nodes = table.n_columns;
    let n_elements = table.values.len().checked_div(n_nodes).unwrap_or(0);
    let Some(kind) = kind(&type_name, n_nodes) else {
        let what = format!("elements of type {} with {n_nodes} nodes", quoted(type_name.as_bytes()));
        if ["NSIDED", "NFACED"].contains(&type_name.to_ascii_uppercase().as_str()) {
            return Err(
                bad(format!("{what} are not supported")).remedy("mesh with tets, bricks, wedges or pyramids")
            );
        }
        input.notes.add(format!("{what} are skipped"));
        cell_of.extend(std::iter::repeat_n(None, n_elements));
        return Ok(n_elements);
    };
    let nodes =
        to_ids(&table.values).map_err(|found| bad(format!("expected numbers of nodes, found {found}")))?;
    let n_points = mesh.points.len();
    let mut vertices = vec![VertexId(0); n_nodes];
    for element in nodes.chunks_exact(n_nodes) {
        for (i, &node) in element.iter().enumerate() {
            let vertex = node.checked_sub(1).filter(|&vertex| (vertex as usize) < n_points);
            let vertex = vertex.ok_or_else(|| bad(format!("refers to node {node} of {n_points}")))?;
            vertices[order(kind).map_or(i, |order| order[i])] = VertexId(vertex);
        }
        cell_of.push(Some(mesh.cells.len() as u32));
        mesh.cells.push(kind, vertices.iter().copied());
    }
    Ok(n_elements)
}
