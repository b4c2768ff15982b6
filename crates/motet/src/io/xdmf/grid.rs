//! The points, cells and arrays of a grid.

use super::data::{Data, Source};
use super::kinds::Topology;
use crate::base::{Error, Point, Result, VertexId};
use crate::io::format::Notes;
use crate::io::scalar::{to_ids, to_points};
use crate::io::text::quoted;
use crate::io::vtkxml::Element;
use crate::mesh::{Cells, Field, Values};

/// An attribute that both versions of the format name differently: `Type` or, before, `TopologyType`.
pub(super) fn either<'e>(element: &'e Element<'_>, names: [&str; 2]) -> Option<&'e str> {
    names.iter().find_map(|name| element.attribute(name))
}

/// The points of a geometry of two or three coordinates.
pub(super) fn points(geometry: &Element<'_>, source: &mut Source<'_>) -> Result<Vec<Point>> {
    let kind = either(geometry, ["GeometryType", "Type"]).unwrap_or("XYZ").to_ascii_uppercase();
    let data = source.only_item(geometry)?;
    let bad = |what: String| Error::input(what).at(geometry.place());
    let n_columns = match kind.as_str() {
        "XYZ" => 3,
        "XY" => 2,
        other => {
            return Err(bad(format!("geometries of type {} are not supported", quoted(other.as_bytes())))
                .remedy("write coordinates as XYZ"));
        }
    };
    let n = data.values.len();
    if !n.is_multiple_of(n_columns) {
        return Err(bad(format!("{n} coordinates are not a whole number of points")));
    }
    if n_columns == 3 {
        return to_points(data.values).ok_or_else(|| bad("expected coordinates, found texts".into()));
    }
    let flat = data.values.to_f64().ok_or_else(|| bad("expected coordinates, found texts".into()))?;
    Ok(flat.as_chunks::<2>().0.iter().map(|&[x, y]| [x, y, 0.0]).collect())
}

/// The cells of a topology.
pub(super) fn cells(topology: &Element<'_>, source: &mut Source<'_>) -> Result<Cells> {
    let name = either(topology, ["TopologyType", "Type"]).unwrap_or_default();
    let bad = |what: String| Error::input(what).at(topology.place());
    let is_mixed = name.eq_ignore_ascii_case("Mixed");
    let uniform = Topology::named(name);
    if !is_mixed && uniform.is_none() {
        return Err(bad(format!("topologies of type {} are not supported", quoted(name.as_bytes())))
            .remedy("save it as an unstructured grid of linear or quadratic cells"));
    }
    let data = source.only_item(topology)?;
    let ids = to_ids(&data.values).map_err(|found| bad(format!("expected ids of points, found {found}")))?;
    let Some(uniform) = uniform else { return mixed(&ids).map_err(|e| e.at(topology.place())) };
    let n_nodes = match uniform.n_nodes() {
        Some(n) => n,
        None => match topology.count("NodesPerElement")? {
            Some(n) => n,
            None => data.n_columns().max(1),
        },
    };
    let Some(kind) = uniform.kind(n_nodes).filter(|_| ids.len().is_multiple_of(n_nodes)) else {
        return Err(bad(format!("{} ids are not a whole number of cells of {n_nodes} nodes", ids.len())));
    };
    let mut cells = Cells::new();
    ids.chunks_exact(n_nodes).for_each(|cell| cells.push(kind, cell.iter().copied().map(VertexId)));
    Ok(cells)
}

/// Cells of several kinds: for each the number of its topology, the number of its nodes if that varies, and
/// its nodes.
fn mixed(numbers: &[u32]) -> Result<Cells> {
    let mut cells = Cells::new();
    let mut rest = numbers;
    while let [number, tail @ ..] = rest {
        let n = cells.len();
        let Some(topology) = Topology::numbered(*number) else {
            return Err(Error::input(format!("cell {n}: topology {number} is not supported"))
                .remedy("save it as an unstructured grid of linear or quadratic cells"));
        };
        let (n_nodes, tail) = match (topology.n_nodes(), tail) {
            (Some(n_nodes), tail) => (n_nodes, tail),
            (None, [n_nodes, tail @ ..]) => (*n_nodes as usize, tail),
            (None, []) => (1, tail),
        };
        let Some((nodes, tail)) = tail.split_at_checked(n_nodes) else {
            return Err(Error::input(format!("cell {n} has fewer nodes than the {n_nodes} of its type"))
                .remedy("the file is truncated or damaged: get a new copy"));
        };
        let kind = topology.kind(n_nodes);
        let kind = kind.ok_or_else(|| Error::input(format!("cell {n} has {n_nodes} nodes")))?;
        cells.push(kind, nodes.iter().copied().map(VertexId));
        rest = tail;
    }
    Ok(cells)
}

/// Where the values of an array are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Center {
    Node,
    Cell,
    Grid,
}

/// The arrays of a grid with their centres; others are skipped with a note.
pub(super) fn attributes(
    grid: &Element<'_>,
    source: &mut Source<'_>,
    [n_points, n_cells]: [usize; 2],
    notes: &Notes,
) -> Result<Vec<(Center, Field)>> {
    let mut fields = Vec::new();
    for attribute in grid.children_named("Attribute") {
        let name = attribute.attribute("Name").unwrap_or("attribute");
        let center = match attribute.attribute("Center").unwrap_or("Node").to_ascii_lowercase().as_str() {
            "node" => Center::Node,
            "cell" => Center::Cell,
            "grid" => Center::Grid,
            other => {
                notes.add(format!("array {name} is skipped: its values are on {}", quoted(other.as_bytes())));
                continue;
            }
        };
        if let Some(kind) = attribute.attribute("ItemType") {
            notes.add(format!("array {name} is skipped: it is a {}", quoted(kind.as_bytes())));
            continue;
        }
        let data = source.only_item(attribute)?;
        let n_rows = match center {
            Center::Node => n_points,
            Center::Cell => n_cells,
            Center::Grid => data.n_rows(),
        };
        match field(name, data, n_rows) {
            Some(field) => fields.push((center, field)),
            None => notes.add(format!("array {name} is skipped: it does not have {n_rows} rows")),
        }
    }
    Ok(fields)
}

/// An array of `n_rows` rows; `None` if the data have others.
fn field(name: &str, data: Data, n_rows: usize) -> Option<Field> {
    let n = data.values.len();
    let components = match n_rows {
        0 => data.n_columns().max(1),
        _ => n / n_rows,
    };
    let is_whole = components > 0 && components.checked_mul(n_rows) == Some(n);
    let fits = data.n_rows() == n_rows || data.n_rows() == n;
    (is_whole && fits).then(|| Field { name: name.to_owned(), components, values: data.values })
}

/// Values as labels; `None` if they are no whole numbers of 32 bits.
pub(super) fn to_labels(values: &Values) -> Option<Vec<i32>> {
    values.to_i64()?.into_iter().map(|label| i32::try_from(label).ok()).collect()
}
