//! Zones: points, elements and boundary conditions.

use crate::base::{Error, Point, Result, VertexId};
use crate::io::cgns::conditions::{Condition, conditions};
use crate::io::cgns::elements::Section;
use crate::io::cgns::node::Node;
use crate::io::format::Notes;
use crate::mesh::Values;

/// The contents of a zone, without solutions.
pub(super) struct Zone {
    pub(super) node: Node,
    pub(super) points: Vec<Point>,
    /// Sections in ascending order of their element numbers.
    pub(super) sections: Vec<Section>,
    pub(super) conditions: Vec<Condition>,
    pub(super) family: Option<String>,
}

impl Zone {
    pub(super) fn read(node: Node, notes: &Notes) -> Result<Self> {
        let kind = node.child_of("ZoneType_t")?.map(|node| node.text()).transpose()?;
        if kind.as_deref() != Some("Unstructured") {
            let kind = kind.filter(|kind| !kind.is_empty()).unwrap_or_else(|| "Structured".to_owned());
            return Err(Error::input(format!(
                "zone {} is {kind}; only unstructured zones are read",
                node.name
            ))
            .at(node.path())
            .remedy("in ParaView, open it, apply `Merge Blocks` and save the data as .vtu"));
        }
        let n_points = node.ints()?.first().copied().unwrap_or(0);
        let n_points = usize::try_from(n_points).ok().filter(|&n| n <= VertexId::MAX_COUNT);
        let n_points = n_points.ok_or_else(|| node.error("invalid number of points"))?;
        let points = points(&node, n_points)?;
        let mut sections = Vec::new();
        for section in node.children_of("Elements_t")? {
            sections.push(Section::read(&section, n_points, notes)?);
        }
        sections.sort_by_key(|section| section.first);
        let overlap = sections.windows(2).find(|pair| pair[1].first - pair[0].first < pair[0].len() as i64);
        if let Some(pair) = overlap {
            let (a, b) = (&pair[0].name, &pair[1].name);
            return Err(node.error(format!("sections {a} and {b} overlap in element numbers")));
        }
        let conditions = conditions(&node, notes)?;
        let family = node.text_of("FamilyName_t")?.filter(|name| !name.is_empty());
        Ok(Self { node, points, sections, conditions, family })
    }
}

/// The points of a zone; missing coordinates, as in plane meshes, are zero.
fn points(zone: &Node, n: usize) -> Result<Vec<Point>> {
    // A moving mesh has several coordinate nodes; this is the first.
    let named = zone.child("GridCoordinates")?;
    let grid = match named {
        Some(grid) => Some(grid),
        None => zone.child_of("GridCoordinates_t")?,
    };
    let grid = grid.ok_or_else(|| zone.error("the zone has no coordinates"))?;
    columns(&grid, Some(n))
}

/// Points from a column for each axis, all with `n` values, or by default with as many as the first.
pub(super) fn columns(grid: &Node, n: Option<usize>) -> Result<Vec<Point>> {
    let mut columns: Vec<Option<Vec<f64>>> = Vec::new();
    let mut n = n;
    for name in ["CoordinateX", "CoordinateY", "CoordinateZ"] {
        let Some(node) = grid.child(name)? else {
            columns.push(None);
            continue;
        };
        let values = match node.values()? {
            Values::F64(values) => values,
            other => other.to_f64().ok_or_else(|| node.error("coordinates are not numbers"))?,
        };
        let n = *n.get_or_insert(values.len());
        if values.len() != n {
            return Err(node.error(format!("{} values for {n} points", values.len())));
        }
        columns.push(Some(values));
    }
    if columns.iter().all(Option::is_none) {
        return Err(grid.error("no coordinates X, Y, Z").remedy("convert the coordinates to Cartesian"));
    }
    let at = |axis: usize, i: usize| columns[axis].as_ref().map_or(0.0, |column| column[i]);
    Ok((0..n.unwrap_or(0)).map(|i| [0, 1, 2].map(|axis| at(axis, i))).collect())
}
