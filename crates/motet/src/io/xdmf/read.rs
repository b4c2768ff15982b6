//! Reads the grids of a domain into one mesh.

use super::data::Source;
use super::grid::{Center, attributes, cells, either, points};
use super::tags::{add_cells, extend, put_in_order};
use crate::base::{Error, Result};
use crate::io::format::{Input, Notes};
use crate::io::text::quoted;
use crate::io::vtkxml::{Document, Element};
use crate::mesh::Mesh;

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let document = Document::parse(input.bytes)?;
    let root = &document.root;
    if root.name != "Xdmf" {
        return Err(Error::input(format!(
            "expected root element `Xdmf`, found {}",
            quoted(root.name.as_bytes())
        ))
        .at(root.place())
        .remedy("check the format of the file"));
    }
    let mut source = Source::new(input.path);
    let mut mesh: Option<Mesh> = None;
    // Those of the first grid; tags of facets come after them.
    let mut n_cells = 0;
    let domain = root.child("Domain");
    for grid in domain.into_iter().flat_map(|domain| domain.children_named("Grid")) {
        let Some(grid) = uniform(grid, input.notes)? else { continue };
        match (&mut mesh, grid.child("Topology"), grid.child("Geometry")) {
            (None, Some(topology), Some(geometry)) => {
                let points = points(geometry, &mut source)?;
                let mut first = Mesh::new(points, cells(topology, &mut source)?);
                n_cells = first.cells.len();
                names(&mut first, grid);
                add_arrays(&mut first, n_cells, grid, &mut source, input.notes)?;
                mesh = Some(first);
            }
            (Some(mesh), Some(topology), None) => {
                let cells = cells(topology, &mut source)?;
                let n = [mesh.points.len(), cells.len()];
                let fields = attributes(grid, &mut source, n, input.notes)?;
                let name = grid.attribute("Name").unwrap_or_default();
                add_cells(mesh, name, &cells, fields, input.notes);
            }
            (Some(mesh), None, None) => add_arrays(mesh, n_cells, grid, &mut source, input.notes)?,
            (Some(_), ..) => {
                let name = grid.attribute("Name").unwrap_or_default();
                input.notes.add(format!("grid {} is skipped: it is another mesh", quoted(name.as_bytes())));
            }
            (None, ..) => {
                return Err(Error::input("the first grid has no Topology and Geometry of its own")
                    .at(grid.place())
                    .remedy("the file contains no mesh or is damaged: get a new copy"));
            }
        }
    }
    let mut mesh = mesh.ok_or_else(|| {
        Error::input("there is no grid").remedy("the file contains no mesh or is truncated: get a new copy")
    })?;
    put_in_order(&mut mesh);
    Ok(mesh)
}

/// The grid itself, or the first of a collection over time.
fn uniform<'e, 'a>(grid: &'e Element<'a>, notes: &Notes) -> Result<Option<&'e Element<'a>>> {
    let kind = either(grid, ["GridType", "Type"]).unwrap_or("Uniform");
    if kind.eq_ignore_ascii_case("Uniform") {
        return Ok(Some(grid));
    }
    let name = grid.attribute("Name").unwrap_or_default();
    let is_over_time = grid.attribute("CollectionType").is_some_and(|t| t.eq_ignore_ascii_case("Temporal"));
    if !kind.eq_ignore_ascii_case("Collection") || !is_over_time {
        return Err(Error::input(format!("grids of type {} are not supported", quoted(kind.as_bytes())))
            .at(grid.place())
            .remedy("merge its grids into one: in ParaView, apply `Append Datasets` and save as .vtu"));
    }
    let n = grid.children_named("Grid").count();
    if n > 1 {
        notes.add(format!("{} has {n} steps over time: the first is read", quoted(name.as_bytes())));
    }
    Ok(grid.child("Grid"))
}

/// Reads names of labels as meshio writes them: a text of XML with `<map key="NAME" dim="2">LABEL</map>`.
fn names(mesh: &mut Mesh, grid: &Element<'_>) {
    for information in grid.children_named("Information") {
        let Ok(document) = Document::parse(information.text) else { continue };
        for map in document.root.children_named("map") {
            let label = std::str::from_utf8(map.text).ok().and_then(|text| text.parse().ok());
            let (Some(label), Some(name)) = (label, map.raw_attribute("key")) else { continue };
            let names = match map.attribute("dim") {
                Some("3") => &mut mesh.label_names.regions,
                Some("2") => &mut mesh.label_names.patches,
                _ => continue,
            };
            names.insert(label, name.to_owned());
        }
    }
}

/// Adds the arrays of a grid whose cells are the first `n_cells` of the mesh.
fn add_arrays(
    mesh: &mut Mesh,
    n_cells: usize,
    grid: &Element<'_>,
    source: &mut Source<'_>,
    notes: &Notes,
) -> Result<()> {
    for (center, mut field) in attributes(grid, source, [mesh.points.len(), n_cells], notes)? {
        match center {
            Center::Node => mesh.set_point_field(field),
            Center::Cell => {
                extend(&mut field, mesh.cells.len());
                mesh.set_cell_field(field);
            }
            Center::Grid => mesh.field_data.push(field),
        }
    }
    Ok(())
}
