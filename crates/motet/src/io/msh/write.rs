//! Writes MSH files of both versions, as text or binary.

use std::collections::{BTreeMap, BTreeSet};

use super::kinds::{ElementType, element_types};
use super::sink::Sink;
use crate::base::{Error, Result};
use crate::io::cell_labels::{cell_labels, int_column, labels_cover};
use crate::io::format::{Encoding, WriteOptions};
use crate::io::output::{Output, drain};
use crate::io::select::{keep_cells, lost_arrays};
use crate::mesh::{CellKind, Field, Mesh, Values};

/// Array with the entity of each node, under meshio's name.
const NODE_ENTITIES: &str = "gmsh:dim_tags";

#[derive(Clone, Copy, PartialEq)]
enum Version {
    V2,
    V4,
}

/// The labels of all cells in Gmsh's terms.
struct CellTags {
    /// Dimension of each cell.
    dims: Vec<i32>,
    physical: Vec<i32>,
    /// Entity of each cell, at least 1; each entity has a single physical group.
    entities: Vec<i32>,
    partitions: Option<Vec<i32>>,
}

/// Writes an MSH file in the requested version. The default is 4.1, or 2.2 if only some cells have a label,
/// which meshio (5.3) cannot read in 4.1, and there are no cell arrays, which meshio cannot read on several
/// kinds of cells in 2.2.
pub(super) fn write(mesh: &Mesh, options: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let types = element_types();
    let requested = match options.version.as_deref() {
        None => None,
        Some("4.1" | "4") => Some(Version::V4),
        Some("2.2" | "2") => Some(Version::V2),
        Some(other) => {
            return Err(
                Error::options(format!("MSH version {other} cannot be written")).remedy("choose 4.1 or 2.2")
            );
        }
    };
    let (mesh, mut lost) = keep_cells(mesh, "MSH", |kind| types.iter().any(|t| t.kind == kind));
    let tagged = CellTags::of(&mesh, &mut lost)?;
    let labelled = tagged.physical.iter().filter(|&&label| label != 0).count();
    let partly = labelled > 0 && labelled < tagged.physical.len();
    let has_data = mesh.cell_data.iter().any(|f| !tagged.is_in_tags(&mesh, f, true));
    let default = if partly && !has_data { Version::V2 } else { Version::V4 };
    let version2 = requested.unwrap_or(default) == Version::V2;
    let mut text = Sink { out: Vec::new(), binary: options.encoding != Encoding::Ascii };
    header(&mut text, if version2 { "2.2" } else { "4.1" });
    physical_names(&mut text, &mesh);
    if version2 {
        nodes2(&mut text, output, &mesh)?;
        elements2(&mut text, output, &mesh, &types, &tagged)?;
    } else {
        let node_entities = node_entities(&mesh, &tagged);
        entities4(&mut text, &mesh, &tagged, &node_entities);
        nodes4(&mut text, output, &mesh, &node_entities)?;
        elements4(&mut text, output, &mesh, &types, &tagged)?;
    }
    data(&mut text, output, &mesh, &tagged, version2, &mut lost)?;
    drain(&mut text.out, output)?;
    Ok(lost)
}

impl CellTags {
    fn of(mesh: &Mesh, lost: &mut Vec<String>) -> Result<Self> {
        let dims: Vec<i32> = mesh.cells.kinds().iter().map(|k| k.dim().unwrap_or(0) as i32).collect();
        let physical = cell_labels(mesh, Some("gmsh:geometrical"));
        let wanted = int_column(mesh, "gmsh:geometrical").unwrap_or_else(|| physical.clone());
        let entities = entities_of(&dims, &wanted, &physical)?;
        let given = mesh.cell_field("gmsh:geometrical").is_some();
        if given && entities != wanted {
            lost.push(
                "gmsh:geometrical: entities without a number, or with cells of several labels, get new numbers".into(),
            );
        }
        Ok(Self { dims, physical, entities, partitions: int_column(mesh, "gmsh:partition") })
    }

    /// Whether the tags already express an array.
    fn is_in_tags(&self, mesh: &Mesh, field: &Field, version2: bool) -> bool {
        match (field.name.as_str(), int_column(mesh, &field.name)) {
            ("gmsh:geometrical", Some(_)) => true,
            ("gmsh:partition", Some(_)) => version2,
            // These are also kept as data, since their names state their origin.
            ("medit:ref" | "tetgen:ref", _) => false,
            _ => labels_cover(&self.physical, mesh, field),
        }
    }
}

/// An entity for each cell: the wanted one if it is positive and has no other label yet, else a new one,
/// since an entity has a single physical group in version 4.
fn entities_of(dims: &[i32], wanted: &[i32], physical: &[i32]) -> Result<Vec<i32>> {
    let mut label_of = BTreeMap::new();
    let mut entity_of = BTreeMap::new();
    let mut numbers = EntityNumbers::default();
    dims.iter().zip(wanted).for_each(|(&dim, &entity)| numbers.take(dim, entity));
    let mut entities = Vec::with_capacity(dims.len());
    for ((&dim, &entity), &label) in dims.iter().zip(wanted).zip(physical) {
        let fits = entity > 0 && *label_of.entry((dim, entity)).or_insert(label) == label;
        if fits {
            entities.push(entity);
            continue;
        }
        let new = match entity_of.get(&(dim, entity, label)) {
            Some(&new) => new,
            None => {
                let new = numbers.new_one(dim).ok_or_else(|| {
                    Error::input("no entity number is left").remedy("remove the array gmsh:geometrical")
                })?;
                entity_of.insert((dim, entity, label), new);
                new
            }
        };
        entities.push(new);
    }
    Ok(entities)
}

/// Used entity numbers in each dimension.
#[derive(Default)]
struct EntityNumbers {
    taken: [BTreeSet<i32>; 4],
    /// No number up to this one is free.
    lowest: [i32; 4],
}

impl EntityNumbers {
    fn take(&mut self, dim: i32, number: i32) {
        self.taken[dim as usize].insert(number.max(0));
    }

    /// The number after the largest; if that is the last possible one, the lowest free number.
    fn new_one(&mut self, dim: i32) -> Option<i32> {
        let (taken, lowest) = (&mut self.taken[dim as usize], &mut self.lowest[dim as usize]);
        let new = match taken.last().map_or(Some(1), |last| last.checked_add(1)) {
            Some(new) => new,
            None => {
                let new = (*lowest + 1..i32::MAX).find(|number| !taken.contains(number))?;
                *lowest = new;
                new
            }
        };
        taken.insert(new);
        Some(new)
    }
}

fn header(sink: &mut Sink, version: &str) {
    sink.line("$MeshFormat");
    sink.line(format_args!("{version} {} 8", i32::from(sink.binary)));
    if sink.binary {
        sink.int(1);
    }
    sink.end_section("MeshFormat");
}

fn physical_names(sink: &mut Sink, mesh: &Mesh) {
    let mut names: Vec<(i32, i32, &str)> = Vec::new();
    for (prefix, dim) in [("point:", 0), ("curve:", 1)] {
        for field in &mesh.field_data {
            let label = field.values.to_i64().and_then(|v| i32::try_from(*v.first()?).ok());
            if let (Some(name), Some(label)) = (field.name.strip_prefix(prefix), label) {
                names.push((dim, label, name));
            }
        }
    }
    names.extend(mesh.label_names.patches.iter().map(|(&label, name)| (2, label, name.as_str())));
    names.extend(mesh.label_names.regions.iter().map(|(&label, name)| (3, label, name.as_str())));
    if names.is_empty() {
        return;
    }
    sink.line("$PhysicalNames");
    sink.line(names.len());
    for (dim, label, name) in names {
        sink.line(format_args!("{dim} {label} \"{}\"", one_line(name)));
    }
    sink.line("$EndPhysicalNames");
}

/// A name with line breaks and double quotes replaced.
fn one_line(name: &str) -> String {
    name.replace('"', "'").replace(['\n', '\r'], " ")
}

/// The entity of each node: from the mesh if given, otherwise the lowest entity of the highest dimension of
/// the cells.
fn node_entities(mesh: &Mesh, tagged: &CellTags) -> Vec<[i32; 2]> {
    let given = mesh.point_field(NODE_ENTITIES).filter(|f| f.components == 2).and_then(|f| f.values.to_i64());
    let given = given.and_then(|tags| {
        tags.as_chunks::<2>()
            .0
            .iter()
            .map(|&[dim, tag]| {
                Some([i32::try_from(dim).ok()?, i32::try_from(tag).ok()?])
                    .filter(|[dim, tag]| (0..4).contains(dim) && *tag > 0)
            })
            .collect::<Option<Vec<_>>>()
    });
    given.unwrap_or_else(|| {
        let highest = tagged.dims.iter().zip(&tagged.entities).max_by_key(|(dim, tag)| (**dim, -**tag));
        let entity = highest.map_or([3, 1], |(&dim, &tag)| [dim, tag]);
        vec![entity; mesh.points.len()]
    })
}

/// Writes every entity of cells or nodes, with its bounding box and its physical group.
fn entities4(sink: &mut Sink, mesh: &Mesh, tagged: &CellTags, node_entities: &[[i32; 2]]) {
    let mut groups: BTreeMap<(i32, i32), i32> = BTreeMap::new();
    let mut boxes: BTreeMap<(i32, i32), [[f64; 3]; 2]> = BTreeMap::new();
    let mut grow = |key: (i32, i32), p: [f64; 3]| {
        let [low, high] = boxes.entry(key).or_insert([p, p]);
        for i in 0..3 {
            low[i] = low[i].min(p[i]);
            high[i] = high[i].max(p[i]);
        }
    };
    for (cell, _, vertices) in mesh.cells.iter() {
        let i = cell.index();
        groups.insert((tagged.dims[i], tagged.entities[i]), tagged.physical[i]);
        vertices.iter().for_each(|v| grow((tagged.dims[i], tagged.entities[i]), mesh.points[v.index()]));
    }
    for (&[dim, tag], &p) in node_entities.iter().zip(&mesh.points) {
        groups.entry((dim, tag)).or_insert(0);
        grow((dim, tag), p);
    }
    sink.line("$Entities");
    for dim in 0..4 {
        sink.size(groups.keys().filter(|key| key.0 == dim).count());
    }
    sink.end_line();
    for (key, &label) in &groups {
        let [low, high] = boxes.get(key).copied().unwrap_or_default();
        sink.int(key.1);
        sink.doubles(&low);
        if key.0 > 0 {
            sink.doubles(&high);
        }
        sink.size(usize::from(label != 0));
        if label != 0 {
            sink.int(label);
        }
        if key.0 > 0 {
            sink.size(0);
        }
        sink.end_line();
    }
    sink.end_section("Entities");
}

fn nodes4(sink: &mut Sink, output: &mut Output<'_>, mesh: &Mesh, node_entities: &[[i32; 2]]) -> Result<()> {
    let runs: Vec<&[[i32; 2]]> = node_entities.chunk_by(|a, b| a == b).collect();
    sink.line("$Nodes");
    for n in [runs.len(), mesh.points.len(), usize::from(!mesh.points.is_empty()), mesh.points.len()] {
        sink.size(n);
    }
    sink.end_line();
    let mut first = 0;
    for run in runs {
        let [dim, tag] = run[0];
        [dim, tag, 0].into_iter().for_each(|n| sink.int(n));
        sink.size(run.len());
        sink.end_line();
        sink.rows(output, run.len(), |sink, i| {
            sink.size(first + i + 1);
            sink.end_line();
        })?;
        sink.rows(output, run.len(), |sink, i| {
            sink.doubles(&mesh.points[first + i]);
            sink.end_line();
        })?;
        first += run.len();
    }
    sink.end_section("Nodes");
    Ok(())
}

fn elements4(
    sink: &mut Sink,
    output: &mut Output<'_>,
    mesh: &Mesh,
    types: &[ElementType],
    tagged: &CellTags,
) -> Result<()> {
    let n = mesh.cells.len();
    let kinds = mesh.cells.kinds();
    let key = |i: usize| (tagged.entities[i], kinds[i]);
    let places: Vec<usize> = (0..n).collect();
    let runs: Vec<&[usize]> = places.chunk_by(|&a, &b| key(a) == key(b)).collect();
    sink.line("$Elements");
    [runs.len(), n, usize::from(n > 0), n].into_iter().for_each(|n| sink.size(n));
    sink.end_line();
    for run in runs {
        let t = type_of(types, kinds[run[0]]);
        sink.int(tagged.dims[run[0]]);
        sink.int(tagged.entities[run[0]]);
        sink.int(t.number);
        sink.size(run.len());
        sink.end_line();
        sink.rows(output, run.len(), |sink, i| {
            sink.size(run[i] + 1);
            gmsh_nodes(mesh, run[i], t, |node| sink.size(node));
            sink.end_line();
        })?;
    }
    sink.end_section("Elements");
    Ok(())
}

fn nodes2(sink: &mut Sink, output: &mut Output<'_>, mesh: &Mesh) -> Result<()> {
    sink.line("$Nodes");
    sink.line(mesh.points.len());
    sink.rows(output, mesh.points.len(), |sink, i| {
        sink.int(i as i32 + 1);
        sink.doubles(&mesh.points[i]);
        sink.end_line();
    })?;
    sink.end_section("Nodes");
    Ok(())
}

fn elements2(
    sink: &mut Sink,
    output: &mut Output<'_>,
    mesh: &Mesh,
    types: &[ElementType],
    tagged: &CellTags,
) -> Result<()> {
    sink.line("$Elements");
    sink.line(mesh.cells.len());
    let n_tags = if tagged.partitions.is_some() { 4 } else { 2 };
    let places: Vec<usize> = (0..mesh.cells.len()).collect();
    let kinds = mesh.cells.kinds();
    for run in places.chunk_by(|&a, &b| kinds[a] == kinds[b]) {
        let t = type_of(types, kinds[run[0]]);
        if sink.binary {
            [t.number, run.len() as i32, n_tags].into_iter().for_each(|n| sink.int(n));
        }
        sink.rows(output, run.len(), |sink, i| {
            let i = run[i];
            sink.int(i as i32 + 1);
            if !sink.binary {
                sink.int(t.number);
                sink.int(n_tags);
            }
            sink.int(tagged.physical[i]);
            sink.int(tagged.entities[i]);
            if let Some(partitions) = &tagged.partitions {
                sink.int(1);
                sink.int(partitions[i]);
            }
            gmsh_nodes(mesh, i, t, |node| sink.int(node as i32));
            sink.end_line();
        })?;
    }
    sink.end_section("Elements");
    Ok(())
}

fn type_of(types: &[ElementType], kind: CellKind) -> &ElementType {
    types.iter().find(|t| t.kind == kind).expect("only kinds with a type are kept")
}

/// Calls `put` with the number of each node of cell `i`, in Gmsh's order.
fn gmsh_nodes(mesh: &Mesh, i: usize, t: &ElementType, mut put: impl FnMut(usize)) {
    let vertices = mesh.cells.connectivity().list(i);
    let mut nodes = [0; 32];
    for (vtk, &gmsh) in t.vtk_to_gmsh.iter().enumerate() {
        nodes[gmsh] = vertices[vtk].index() + 1;
    }
    nodes[..vertices.len()].iter().for_each(|&node| put(node));
}

fn data(
    sink: &mut Sink,
    output: &mut Output<'_>,
    mesh: &Mesh,
    tagged: &CellTags,
    version2: bool,
    lost: &mut Vec<String>,
) -> Result<()> {
    let is_entity = |f: &&Field| !version2 && f.name == NODE_ENTITIES;
    let point_data: Vec<_> = mesh.point_data.iter().filter(|f| !is_entity(f)).collect();
    let cell_data: Vec<_> = mesh.cell_data.iter().filter(|f| !tagged.is_in_tags(mesh, f, version2)).collect();
    for (section, fields) in [("NodeData", &point_data), ("ElementData", &cell_data)] {
        for field in fields {
            if let Some(values) = field.values.to_f64().filter(|values| !values.is_empty()) {
                data_section(sink, output, section, field, &values)?;
            }
        }
    }
    let all = || point_data.iter().chain(&cell_data).copied();
    lost.extend(lost_arrays("MSH", "text", all().filter(|f| matches!(f.values, Values::Text(_)))));
    let other: Vec<&str> = all()
        .filter(|f| !matches!(f.values, Values::Text(_) | Values::F64(_)))
        .map(|f| f.name.as_str())
        .collect();
    if !other.is_empty() {
        lost.push(format!("arrays are converted to double precision: {}", other.join(", ")));
    }
    let names = |f: &&Field| !f.name.starts_with("point:") && !f.name.starts_with("curve:");
    lost.extend(lost_arrays("MSH", "field", mesh.field_data.iter().filter(names)));
    Ok(())
}

fn data_section(
    sink: &mut Sink,
    output: &mut Output<'_>,
    section: &str,
    field: &Field,
    values: &[f64],
) -> Result<()> {
    sink.line(format_args!("${section}"));
    sink.line(format_args!("1\n\"{}\"\n1\n0.0\n3\n0", one_line(&field.name)));
    sink.line(format_args!("{}\n{}", field.components, field.n_rows()));
    let n = field.components;
    sink.rows(output, values.len() / n, |sink, i| {
        sink.int(i as i32 + 1);
        sink.doubles(&values[i * n..(i + 1) * n]);
        sink.end_line();
    })?;
    sink.end_section(section);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entity_has_one_label_and_a_positive_number() {
        let dims = [3, 3, 3, 2, 2];
        let wanted = [7, 7, 0, 7, -1];
        let physical = [1, 2, 0, 3, 3];
        let entities = entities_of(&dims, &wanted, &physical).unwrap();
        assert_eq!(entities, [7, 8, 9, 7, 8]);
    }
}
