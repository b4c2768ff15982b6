//! Reads the form in HDF5: points, faces and the cells on their sides, each in sections, and tables of zones.

use super::content::{Content, HANGING_NODES, Numbered, hanging_nodes, span, two_dimensions};
use crate::base::{Csr, Error, Point, Result};
use crate::io::format::Input;
use crate::io::hdf;
use crate::io::latin::decode_utf8_or_latin1;
use crate::mesh::{Mesh, Values};

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let root = hdf::open(input.bytes)?;
    let mesh = only_mesh(&root)?;
    match attribute(&mesh, "dimension") {
        None | Some(3) => {}
        Some(2) => return Err(two_dimensions_at(mesh.path())),
        Some(other) => return Err(damaged(mesh.path(), format!("expected dimension 3, found {other}"))),
    }
    let mut content = Content::default();
    for (of, name) in
        [(Numbered::Points, "nodeCount"), (Numbered::Cells, "cellCount"), (Numbered::Faces, "faceCount")]
    {
        content.declare(of, attribute(&mesh, name).unwrap_or(0));
    }
    if let Some(nodes) = mesh.group("nodes")? {
        points(&nodes, &mut content)?;
    }
    if let Some(cells) = mesh.group("cells")? {
        refuse_hanging_nodes(&cells)?;
        for zone in zones(&cells, Numbered::Cells, &mut content)? {
            content.add_zone(zone.id, zone.first, zone.n);
        }
    }
    if let Some(of_mesh) = mesh.group("faces")? {
        faces(&of_mesh, &mut content)?;
    }
    content.into_mesh()
}

/// The group of the only mesh.
fn only_mesh(root: &hdf::Group) -> Result<hdf::Group> {
    let Some(meshes) = root.group("meshes")? else {
        return Err(match root.groups().iter().any(|name| name == "results") {
            true => Error::input("the file has a solution, but no mesh")
                .remedy("give the case that belongs to it (.cas.h5)"),
            false => Error::input("is an HDF5 file without the group meshes of Fluent")
                .remedy("give the file the extension of its format"),
        });
    };
    match meshes.groups() {
        [] => Err(damaged(meshes.path(), "there is no mesh")),
        [only] => required(&meshes, only),
        [first, second, ..] => {
            let n = meshes.groups().len();
            Err(Error::input(format!(
                "there are {n} meshes ({first}, {second}{}), of which one can be read",
                if n > 2 { ", ..." } else { "" }
            ))
            .at(meshes.path())
            .remedy("write each mesh to a file of its own in Fluent"))
        }
    }
}

fn damaged(place: &str, what: impl Into<String>) -> Error {
    Error::input(what).at(place).remedy("the file is truncated or damaged: get a new copy")
}

fn two_dimensions_at(place: &str) -> Error {
    two_dimensions(Error::input("the mesh has two dimensions, which are not supported").at(place))
}

fn required(group: &hdf::Group, name: &str) -> Result<hdf::Group> {
    group.group(name)?.ok_or_else(|| damaged(group.path(), format!("the group {name} is missing")))
}

/// The number that an attribute of a group holds.
fn attribute(group: &hdf::Group, name: &str) -> Option<i64> {
    group.ints(name)?.first().copied()
}

/// Refuses cells or faces that others divide.
fn refuse_hanging_nodes(group: &hdf::Group) -> Result<()> {
    match group.group("tree")? {
        Some(tree) if !tree.groups().is_empty() => {
            Err(hanging_nodes(Error::input(HANGING_NODES).at(tree.path())))
        }
        _ => Ok(()),
    }
}

/// Refuses faces that were cut out of faces of two zones that do not match.
fn refuse_interfaces(faces: &hdf::Group) -> Result<()> {
    match faces.group("interface")? {
        Some(interface) if !interface.groups().is_empty() => Err(Error::input(
            "faces of zones overlap without common points (mesh interfaces), which is not supported",
        )
        .at(interface.path())
        .remedy("delete the mesh interfaces in Fluent and write the file again")),
        _ => Ok(()),
    }
}

/// The number of the first of `n` rows of a section, of which attributes give the first and last number;
/// `None` without rows. The error continues a sentence.
fn first_of(min: Option<Vec<i64>>, max: Option<Vec<i64>>, n: usize) -> Result<Option<usize>, String> {
    if n == 0 {
        return Ok(None);
    }
    let (Some([min]), Some([max])) = (min.as_deref(), max.as_deref()) else {
        return Err("has no numbers minId and maxId".into());
    };
    match span(*min, *max)? {
        Some((first, rows)) if first > 0 && rows == n => Ok(Some(first)),
        _ => Err(format!("has numbers {min} to {max}, but {n} rows")),
    }
}

/// Reads the points of all sections.
fn points(nodes: &hdf::Group, content: &mut Content) -> Result<()> {
    let sections = required(nodes, "coords")?;
    for name in sections.arrays() {
        let array = sections.required_array(name)?;
        if array.components() == 2 {
            return Err(two_dimensions_at(array.path()));
        }
        let numbers = match array.all()? {
            Values::F64(numbers) => numbers,
            other => other.to_f64().ok_or_else(|| array.error("expected numbers"))?,
        };
        let (rows, rest) = numbers.as_chunks::<3>();
        if !rest.is_empty() {
            return Err(
                array.error(format!("expected 3 coordinates for each point, found {}", numbers.len()))
            );
        }
        let first = first_of(array.attribute("minId")?, array.attribute("maxId")?, rows.len())
            .map_err(|what| array.error(what))?;
        if let Some(first) = first {
            content.count(Numbered::Points, rows.len());
            let points: Vec<Point> = rows.to_vec();
            content.add_points(first, points).map_err(|what| array.error(what))?;
        }
    }
    Ok(())
}

/// A row of a table of zones, of which none is empty.
struct Zone {
    id: i32,
    first: usize,
    n: usize,
    kind: i64,
}

/// Reads the table of zones of cells or faces, and their names. Zones come in the order of their first rows
/// and do not overlap.
fn zones(group: &hdf::Group, of: Numbered, content: &mut Content) -> Result<Vec<Zone>> {
    let table = required(group, "zoneTopology")?;
    let wrong = |what: String| damaged(table.path(), what);
    let ids = table.required_array("id")?;
    let ids = ids.ints(0..ids.rows())?;
    let column = |name: &str| {
        let array = table.required_array(name)?;
        let numbers = array.ints(0..array.rows())?;
        match numbers.len() == ids.len() {
            true => Ok(numbers),
            false => Err(array.error(format!("{} zones have {} numbers here", ids.len(), numbers.len()))),
        }
    };
    let (first, last) = (column("minId")?, column("maxId")?);
    let kinds = match of {
        Numbered::Faces => column("zoneType")?,
        _ => vec![0; ids.len()],
    };
    let narrow =
        |&id: &i64| i32::try_from(id).map_err(|_| wrong(format!("zone {id} needs more than 32 bits")));
    let ids = ids.iter().map(narrow).collect::<Result<Vec<_>>>()?;
    let mut zones = Vec::new();
    for (i, &id) in ids.iter().enumerate() {
        // Empty zones end before they begin, or have the number 0.
        if last[i] == 0 {
            continue;
        }
        let Some((first, n)) = span(first[i], last[i]).map_err(|what| wrong(format!("zone {id} {what}")))?
        else {
            continue;
        };
        content.count(of, n);
        zones.push(Zone { id, first, n, kind: kinds[i] });
    }
    zones.sort_by_key(|zone| zone.first);
    if let Some([one, other]) = zones.array_windows().find(|[one, other]| one.first + one.n > other.first) {
        return Err(wrong(format!("zones {} and {} both have number {}", one.id, other.id, other.first)));
    }
    if let Some(names) = table.array("name")? {
        let names = names.bytes()?;
        let names = names.split(|&byte| byte == 0).next().unwrap_or_default();
        for (&id, name) in ids.iter().zip(names.split(|&byte| byte == b';')) {
            let name = name.trim_ascii();
            if !name.is_empty() {
                content.add_name(id, decode_utf8_or_latin1(name));
            }
        }
    }
    Ok(zones)
}

/// Rows with consecutive numbers.
struct Section<T> {
    first: usize,
    n: usize,
    rows: T,
}

/// Sections in the order of their numbers, of which none has two rows.
struct Sections<T>(Vec<Section<T>>);

impl<T> Sections<T> {
    fn new(mut sections: Vec<Section<T>>, place: &str) -> Result<Self> {
        sections.sort_by_key(|section| section.first);
        match sections.array_windows().find(|[one, other]| one.first + one.n > other.first) {
            None => Ok(Self(sections)),
            Some([_, other]) => Err(damaged(place, format!("two sections have number {}", other.first))),
        }
    }

    /// The section with this number, and the row in it.
    fn find(&self, number: usize) -> Option<(&T, usize)> {
        let after = self.0.partition_point(|section| section.first <= number);
        let section = self.0.get(after.checked_sub(1)?)?;
        let row = number - section.first;
        (row < section.n).then_some((&section.rows, row))
    }

    fn n_rows(&self) -> usize {
        self.0.iter().map(|section| section.n).sum()
    }
}

/// Whole numbers of 32 bits.
fn numbers(array: &hdf::Array) -> Result<Vec<u32>> {
    match array.all()? {
        Values::U32(numbers) => Ok(numbers),
        other => {
            let numbers = other.to_i64().unwrap_or_default();
            let narrow = numbers.iter().map(|&n| u32::try_from(n).ok()).collect::<Option<Vec<_>>>();
            narrow
                .filter(|narrow| narrow.len() == other.len())
                .ok_or_else(|| array.error("expected whole numbers from 0 to 4294967295"))
        }
    }
}

/// The points of all faces.
fn rings(faces: &hdf::Group) -> Result<Sections<Csr<u32>>> {
    let group = required(faces, "nodes")?;
    let mut sections = Vec::new();
    for name in group.groups() {
        let section = required(&group, name)?;
        let counts = section.required_array("nnodes")?;
        let nodes = section.required_array("nodes")?;
        let mut offsets = vec![0];
        let mut end = 0u32;
        for n in numbers(&counts)? {
            end = end.checked_add(n).ok_or_else(|| counts.error("faces have more than 4294967295 points"))?;
            offsets.push(end);
        }
        let n = offsets.len() - 1;
        let items = numbers(&nodes)?;
        let n_items = items.len();
        let rows = Csr::new(offsets, items)
            .ok_or_else(|| nodes.error(format!("faces have {end} points (nnodes), found {n_items}")))?;
        let first = first_of(section.ints("minId"), section.ints("maxId"), n)
            .map_err(|what| damaged(section.path(), what))?;
        sections.extend(first.map(|first| Section { first, n, rows }));
    }
    Sections::new(sections, group.path())
}

/// The cells on one side of faces; faces without a cell there may be missing.
fn side(faces: &hdf::Group, name: &str) -> Result<Sections<Vec<u32>>> {
    let Some(group) = faces.group(name)? else { return Ok(Sections(Vec::new())) };
    let mut sections = Vec::new();
    for name in group.arrays() {
        let array = group.required_array(name)?;
        let rows = numbers(&array)?;
        let n = rows.len();
        let first = first_of(array.attribute("minId")?, array.attribute("maxId")?, n)
            .map_err(|what| array.error(what))?;
        sections.extend(first.map(|first| Section { first, n, rows }));
    }
    Sections::new(sections, group.path())
}

fn faces(group: &hdf::Group, content: &mut Content) -> Result<()> {
    refuse_hanging_nodes(group)?;
    refuse_interfaces(group)?;
    let zones = zones(group, Numbered::Faces, content)?;
    let rings = rings(group)?;
    let sides = [side(group, "c0")?, side(group, "c1")?];
    for zone in &zones {
        let wrong = |what: String| damaged(group.path(), format!("zone {}: {what}", zone.id));
        for number in zone.first..zone.first + zone.n {
            let (of_section, row) =
                rings.find(number).ok_or_else(|| wrong(format!("face {number} has no points (nodes)")))?;
            let cells = sides.each_ref().map(|side| side.find(number).map_or(0, |(cells, row)| cells[row]));
            content
                .add_face(of_section.list(row), cells, zone.id, zone.kind)
                .map_err(|what| wrong(format!("face {number}: {what}")))?;
        }
    }
    // Each face of a zone was found, and zones do not overlap.
    match rings.n_rows() - zones.iter().map(|zone| zone.n).sum::<usize>() {
        0 => Ok(()),
        n => Err(damaged(group.path(), format!("{n} faces are in no zone"))),
    }
}
