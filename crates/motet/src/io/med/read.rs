//! Reads points and cells.

use std::collections::BTreeSet;

use super::families::Families;
use super::fields::{self, Block};
use super::kinds::{POLYGONS, POLYHEDRA, named};
use crate::base::{Csr, Error, Point, Result, VertexId};
use crate::io::format::{Input, Notes};
use crate::io::hdf;
use crate::io::named_sets::{NSET, set_arrays, set_labels};
use crate::mesh::{CellKind, Cells, Mesh};

/// What meshio describes its meshes as.
const MESHIO: &str = "Mesh created with meshio";

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let root = hdf::open(input.bytes)?;
    let no_mesh =
        |what: &str| Error::input(what.to_owned()).remedy("give the file the extension of its format");
    let meshes =
        root.group("ENS_MAA")?.ok_or_else(|| no_mesh("is an HDF5 file without the group ENS_MAA of MED"))?;
    let names = meshes.groups();
    let name = names.first().ok_or_else(|| no_mesh("the file has no mesh (ENS_MAA is empty)"))?;
    if names.len() > 1 {
        input.notes.add(format!("the file has {} meshes: only {name} is read", names.len()));
    }
    let group = required(&meshes, name)?;
    if group.ints("TYP").is_some_and(|kind| kind == [1]) {
        return Err(at(&group, "the mesh is structured, which is not supported")
            .remedy("convert it to an unstructured mesh in Salome"));
    }
    let (points, elements) = content(&group, input.notes)?;
    let (point_families, points) = read_points(&points, &group)?;
    let n_points = points.len();
    let is_turned = group.text("DES").is_none_or(|text| text != MESHIO);
    let mut lists = Vec::new();
    for name in elements.iter().flat_map(|elements| elements.groups()) {
        let list = elements.as_ref().map(|elements| required(elements, name)).transpose()?;
        match list.map(|list| List::read(name, &list, n_points, is_turned)).transpose()?.flatten() {
            Some(list) => lists.push(list),
            None => input.notes.add(format!("cells of type {name} are skipped")),
        }
    }
    let (cells, blocks, cell_families) = joined(lists)?;
    let mut mesh = Mesh::new(points, cells);
    let families = Families::read(&root, &group)?;
    let n_cells = mesh.cells.len();
    match families.have_groups_of_cells() {
        true => set_labels(&mut mesh, n_cells, &families.sets(&cell_families)?.all, input.notes),
        false => {
            let sets = Families::sets_of_families(&cell_families, mesh.cells.kinds());
            set_labels(&mut mesh, n_cells, &sets, input.notes);
        }
    }
    let of_points = families.sets(&point_families)?;
    set_arrays(&mut mesh.point_data, NSET, of_points.all.iter(), n_points, input.notes);
    let file_bytes = input.bytes.len() as u64;
    let arrays = fields::read(&root, name, n_points, &blocks, file_bytes, input.notes)?;
    for (fields, to) in [(arrays.points, &mut mesh.point_data), (arrays.cells, &mut mesh.cell_data)] {
        for field in fields {
            match to.iter().any(|known| known.name == field.name) {
                true => input.notes.add(format!("field {} is skipped: labels have this name", field.name)),
                false => to.push(field),
            }
        }
    }
    Ok(mesh)
}

fn required(group: &hdf::Group, name: &str) -> Result<hdf::Group> {
    group.group(name)?.ok_or_else(|| at(group, &format!("the group {name} is missing")))
}

fn at(group: &hdf::Group, what: &str) -> Error {
    Error::input(what.to_owned()).at(group.path().to_owned())
}

/// The groups of points and of cells, at the first step of the mesh.
fn content(mesh: &hdf::Group, notes: &Notes) -> Result<(hdf::Group, Option<hdf::Group>)> {
    if let Some(points) = mesh.group("NOE")? {
        return Ok((points, mesh.group("MAI")?));
    }
    let steps = mesh.groups();
    let first = steps.first().ok_or_else(|| at(mesh, "the mesh has no points (NOE)"))?;
    if steps.len() > 1 {
        notes.add(format!("of {} steps of the mesh the first is read", steps.len()));
    }
    let step = required(mesh, first)?;
    Ok((required(&step, "NOE")?, step.group("MAI")?))
}

/// The families and places of points.
fn read_points(group: &hdf::Group, mesh: &hdf::Group) -> Result<(Vec<i64>, Vec<Point>)> {
    let array = group.required_array("COO")?;
    let dim = mesh.ints("ESP").and_then(|dim| usize::try_from(*dim.first()?).ok()).unwrap_or(3);
    let columns = array.all()?.to_f64().ok_or_else(|| array.error("expected numbers"))?;
    if !(1..=3).contains(&dim) || columns.len() % dim != 0 {
        return Err(array.error(format!("{} coordinates of points in {dim} dimensions", columns.len())));
    }
    let n = columns.len() / dim;
    if n > VertexId::MAX_COUNT {
        return Err(array.error("more points than a mesh can hold"));
    }
    let mut points = vec![[0.0; 3]; n];
    for (axis, column) in columns.chunks_exact(n.max(1)).enumerate() {
        points.iter_mut().zip(column).for_each(|(point, &x)| point[axis] = x);
    }
    Ok((column(group, "FAM", n)?.unwrap_or_else(|| vec![0; n]), points))
}

/// Whole numbers, one for each of `n` points or cells.
fn column(group: &hdf::Group, name: &str, n: usize) -> Result<Option<Vec<i64>>> {
    let Some(array) = group.array(name)? else { return Ok(None) };
    let numbers = ints(&array)?;
    match numbers.len() == n {
        true => Ok(Some(numbers)),
        false => Err(array.error(format!("expected {n} numbers, found {}", numbers.len()))),
    }
}

fn ints(array: &hdf::Array) -> Result<Vec<i64>> {
    array.ints(0..array.rows())
}

/// The cells of a type.
struct List {
    name: String,
    kind: CellKind,
    cells: Csr<VertexId>,
    /// The faces of polyhedra.
    faces: Vec<Csr<VertexId>>,
    families: Vec<i64>,
    numbers: Option<Vec<i64>>,
}

impl List {
    /// Reads cells; `None` for types that are no cells here.
    fn read(name: &str, group: &hdf::Group, n_points: usize, is_turned: bool) -> Result<Option<Self>> {
        let Some(array) = group.array("NOD")? else { return Ok(None) };
        let vertices = ints(&array)?.into_iter().map(|node| {
            let vertex = usize::try_from(node).ok().and_then(|node| node.checked_sub(1));
            vertex.filter(|&vertex| vertex < n_points).map(VertexId::new).ok_or_else(|| {
                array.error(format!(
                    "refers to point {node}, but there are {n_points} points, numbered from 1"
                ))
            })
        });
        let vertices = vertices.collect::<Result<Vec<VertexId>>>()?;
        let (mut cells, mut faces) = (Csr::default(), Vec::new());
        let kind = if name == POLYGONS.0 {
            slices(group, "INN", vertices.len())?
                .windows(2)
                .for_each(|w| cells.push(vertices[w[0]..w[1]].iter().copied()));
            CellKind::POLYGON
        } else if name == POLYHEDRA.0 {
            let of_faces = slices(group, "INN", vertices.len())?;
            let of_cells = slices(group, "IFN", of_faces.len().saturating_sub(1))?;
            for w in of_cells.windows(2) {
                let mut rings = Csr::default();
                of_faces[w[0]..=w[1]]
                    .windows(2)
                    .for_each(|w| rings.push(vertices[w[0]..w[1]].iter().copied()));
                let used: BTreeSet<VertexId> = rings.items().iter().copied().collect();
                cells.push(used);
                faces.push(rings);
            }
            CellKind::POLYHEDRON
        } else {
            let Some(geometry) = named(name) else { return Ok(None) };
            let n_nodes = geometry.kind.n_vertices().unwrap_or(1);
            if vertices.len() % n_nodes != 0 {
                return Err(array.error(format!("{} nodes of cells of {n_nodes} nodes", vertices.len())));
            }
            let n = vertices.len() / n_nodes;
            let order = Some(geometry.order).filter(|order| is_turned && !order.is_empty());
            let mut cell = vec![VertexId(0); n_nodes];
            for i in 0..n {
                for node in 0..n_nodes {
                    cell[order.map_or(node, |order| order[node])] = vertices[node * n + i];
                }
                cells.push(cell.iter().copied());
            }
            geometry.kind
        };
        let n = cells.len();
        let families = column(group, "FAM", n)?.unwrap_or_else(|| vec![0; n]);
        Ok(Some(Self {
            name: name.to_owned(),
            kind,
            cells,
            faces,
            families,
            numbers: column(group, "NUM", n)?,
        }))
    }
}

/// Starts of slices of `n` items and the end of the last, counted from 0.
fn slices(group: &hdf::Group, name: &str, n: usize) -> Result<Vec<usize>> {
    let array = group.required_array(name)?;
    let starts = ints(&array)?;
    let starts =
        starts.iter().map(|&start| usize::try_from(start).ok()?.checked_sub(1).filter(|&start| start <= n));
    let starts = starts.collect::<Option<Vec<usize>>>().filter(|starts| starts.is_sorted());
    starts
        .filter(|starts| !starts.is_empty())
        .ok_or_else(|| array.error(format!("expected rising numbers from 1 to {}", n + 1)))
}

/// All cells, in the order of their numbers if each has its own; the places of each list, and the families.
fn joined(lists: Vec<List>) -> Result<(Cells, Vec<Block>, Vec<i64>)> {
    let n: usize = lists.iter().map(|list| list.cells.len()).sum();
    if u32::try_from(n).is_err() {
        return Err(Error::input("more cells than a mesh can hold"));
    }
    let mut order: Vec<(i64, usize, usize)> = Vec::with_capacity(n);
    let mut are_numbered = true;
    for (of, list) in lists.iter().enumerate() {
        are_numbered &= list.numbers.is_some();
        let number = |i: usize| list.numbers.as_ref().map_or(0, |numbers| numbers[i]);
        order.extend((0..list.cells.len()).map(|i| (number(i), of, i)));
    }
    if are_numbered {
        let numbers: BTreeSet<i64> = order.iter().map(|row| row.0).collect();
        if numbers.len() == n {
            order.sort_unstable();
        }
    }
    let mut cells = Cells::new();
    let mut families = Vec::with_capacity(n);
    let mut blocks: Vec<Block> = lists
        .iter()
        .map(|list| Block { name: list.name.clone(), cells: vec![0; list.cells.len()] })
        .collect();
    for (place, (_, of, i)) in (0u32..).zip(order) {
        let list = &lists[of];
        let vertices = list.cells.list(i).iter().copied();
        match list.kind {
            CellKind::POLYHEDRON => cells.push_polyhedron(vertices, list.faces[i].clone()),
            kind => cells.push(kind, vertices),
        }
        families.push(list.families[i]);
        blocks[of].cells[i] = place;
    }
    Ok((cells, blocks, families))
}
