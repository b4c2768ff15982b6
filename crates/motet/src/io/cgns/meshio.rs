//! Files `.cgns` written by meshio: groups without labels, types and sizes, which hold tets.

use crate::base::{Error, Result, VertexId};
use crate::io::cgns::node::Node;
use crate::io::cgns::zone::columns;
use crate::mesh::{CellKind, Cells, Mesh};

/// Reads the mesh; `None` if the file was not written by meshio.
pub(super) fn read(root: &Node) -> Result<Option<Mesh>> {
    let is_bare = |node: &Node| node.label.is_empty();
    let Some(base) = root.child("Base")?.filter(is_bare) else { return Ok(None) };
    let Some(zone) = base.child("Zone1")?.filter(is_bare) else { return Ok(None) };
    let points = columns(&zone.required_child("GridCoordinates")?, None)?;
    let Some(node) = zone.required_child("GridElements")?.child("ElementConnectivity")? else {
        return Err(Error::input("the file was written by meshio and has no tets").at(zone.path()));
    };
    let place = |id: i64| {
        let place = usize::try_from(id).ok().and_then(|id| id.checked_sub(1)).filter(|&p| p < points.len());
        place.map(|p| VertexId(p as u32)).ok_or_else(|| {
            node.error(format!("an element refers to point {id}, but there are {} points", points.len()))
        })
    };
    let vertices = node.ints()?.into_iter().map(place).collect::<Result<Vec<_>>>()?;
    let cells = Cells::uniform(CellKind::TETRA, vertices).map_err(|e| e.at(node.path()))?;
    Ok(Some(Mesh::new(points, cells)))
}
