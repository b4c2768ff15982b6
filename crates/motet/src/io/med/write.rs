//! Writes points, cells by type, families and fields.

use std::collections::{BTreeMap, BTreeSet};

use super::families::Divided;
use super::kinds::{named, written_as};
use super::{GROUP_NAME, WHOLE};
use crate::base::Result;
use crate::io::cell_labels::{cell_labels, labels_cover};
use crate::io::format::WriteOptions;
use crate::io::hdf::{Attribute, Node, Storage};
use crate::io::label_numbers::numbers;
use crate::io::named_sets::{
    ByLabel, ELSET, NSET, PATCH, REGION, Sets, by_label, element_sets, marks, sets_from_arrays,
};
use crate::io::output::{Output, write_all};
use crate::io::select::{keep_cells, lost_arrays};
use crate::mesh::{CellKind, Field, Mesh, Values};

const NAME: &str = "MED";

/// The name of the mesh.
const MESH: &str = "mesh";

/// The name of the step of a mesh, and of a field, that does not change.
const STEP: &str = "-0000000000000000001-0000000000000000001";

/// Maximum number of bytes in the name of a field.
const FIELD_NAME: usize = 64;

/// Width of the names of coordinates and components.
const SHORT_NAME: usize = 16;

pub(super) fn write(mesh: &Mesh, _: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let (mesh, mut lost) = keep_cells(mesh, NAME, |kind| written_as(kind).is_some());
    let (regions, patches) = (by_label(mesh.regions(), REGION), by_label(mesh.patches(), PATCH));
    let of_cells = named_sets(element_sets(&mesh, &regions, &patches, &mut lost), &mut lost);
    let of_points = named_sets(sets_from_arrays(&mesh.point_data, NSET), &mut lost);
    let cells = Divided::new(mesh.cells.len(), &of_cells);
    let points = Divided::new(mesh.points.len(), &of_points);
    let of_families = family_numbers(&cells, &of_cells, [&regions, &patches], &mut lost);
    let blocks = blocks(&mesh);
    let mut root = Node::new("");
    root.group(version());
    let mut meshes = Node::new("ENS_MAA");
    meshes.group(mesh_node(&mesh, &blocks, &cells, &of_families, &points));
    root.group(meshes);
    root.group(families([
        ("ELEME", &cells, &of_cells, of_families),
        ("NOEUD", &points, &of_points, point_numbers(&points)),
    ]));
    if let Some(fields) = fields(&mesh, &blocks, &mut lost) {
        root.group(fields);
    }
    lost.extend(lost_arrays(NAME, "field", &mesh.field_data));
    write_all(output, &root.into_file_v1_8()?)?;
    Ok(lost)
}

/// Version 3.0, which all readers since then know; from 3.2 on they want groups in the order in which they
/// were made.
fn version() -> Node {
    let mut node = Node::new("INFOS_GENERALES");
    for (name, number) in [("MAJ", 3), ("MIN", 0), ("REL", 0)] {
        node.attribute(name, Attribute::Int(number));
    }
    node
}

fn text(text: impl Into<String>) -> Attribute {
    Attribute::Text(text.into())
}

/// Sets that have members, under names that fit.
fn named_sets(sets: Sets, lost: &mut Vec<String>) -> Sets {
    let mut sets = sets;
    sets.retain(|(_, members)| !members.is_empty());
    for (name, _) in &sets {
        if name.len() > GROUP_NAME || name.trim() != name {
            lost.push(format!(
                "the name {name:?} is not kept: MED has at most {GROUP_NAME} bytes without blanks around"
            ));
        }
    }
    sets
}

/// The number of each family of cells: that of the label that it is, if that is positive and no other family
/// has it.
fn family_numbers(cells: &Divided, sets: &Sets, labels: [&ByLabel; 2], lost: &mut Vec<String>) -> Vec<i64> {
    let mut taken: BTreeSet<i32> = labels.iter().flat_map(|labels| labels.keys().copied()).collect();
    taken.insert(0);
    let used = cells.used();
    let mut given = BTreeSet::new();
    let mut all = vec![0; cells.families.len()];
    // For each set its number for a reader: that of the family that it is, or 0.
    let mut of_sets: BTreeMap<&str, i32> = BTreeMap::new();
    for (family, of) in cells.families.iter().enumerate().skip(1).filter(|&(family, _)| used[family]) {
        let own = |labels: &&ByLabel| match of[..] {
            [set] => labels.iter().find(|(_, label)| label.0 == sets[set].0).map(|(&id, _)| id),
            _ => None,
        };
        let label = labels.iter().find_map(own).filter(|&id| id > 0 && given.insert(id));
        let number = label.unwrap_or_else(|| {
            let free = (1..).find(|number| !taken.contains(number)).unwrap_or(1);
            taken.insert(free);
            free
        });
        all[family] = -i64::from(number);
        for &set in of {
            let is_new = !of_sets.contains_key(sets[set].0.as_str());
            of_sets.insert(&sets[set].0, if is_new && of.len() == 1 { number } else { 0 });
        }
    }
    for (labels, prefix, what) in [(labels[0], REGION, "regions"), (labels[1], PATCH, "patches")] {
        let mut named: Vec<(&str, i32)> = labels.iter().map(|(&id, set)| (set.0.as_str(), id)).collect();
        named.sort_unstable();
        let read: Vec<i32> = named.iter().map(|(name, _)| of_sets.get(name).copied().unwrap_or(0)).collect();
        let mut known = BTreeSet::from([0]);
        let read = match read.iter().all(|&number| known.insert(number)) {
            true => read,
            false => numbers(&named.iter().map(|(name, _)| *name).collect::<Vec<_>>(), prefix),
        };
        if !named.iter().map(|(_, id)| *id).eq(read) {
            lost.push(format!("numbers of {what} are not all kept: MED identifies groups by name"));
        }
    }
    all
}

fn point_numbers(points: &Divided) -> Vec<i64> {
    (0..points.families.len() as i64).collect()
}

/// The cells of each kind.
fn blocks(mesh: &Mesh) -> BTreeMap<CellKind, Vec<usize>> {
    let mut blocks: BTreeMap<CellKind, Vec<usize>> = BTreeMap::new();
    for (cell, &kind) in mesh.cells.kinds().iter().enumerate() {
        blocks.entry(kind).or_default().push(cell);
    }
    blocks
}

/// Adds an array of one number for each of several things.
fn column(node: &mut Node, name: &str, numbers: Values, n: usize) {
    let len = numbers.len();
    let array = node.array(name, numbers, &[len], Storage::Plain);
    array.attribute("CGT", Attribute::Int(1));
    array.attribute("NBR", Attribute::Int(n as i64));
}

fn mesh_node(
    mesh: &Mesh,
    blocks: &BTreeMap<CellKind, Vec<usize>>,
    cells: &Divided,
    numbers: &[i64],
    points: &Divided,
) -> Node {
    let mut node = Node::new(MESH);
    let dim = mesh.cells.kinds().iter().filter_map(|kind| kind.dim()).max().unwrap_or(3);
    for (name, number) in
        [("DIM", dim.max(1) as i64), ("ESP", 3), ("REP", 0), ("SRT", 1), ("TYP", 0), ("NXT", -1), ("NXI", -1)]
    {
        node.attribute(name, Attribute::Int(number));
    }
    let axes: String = ["X", "Y", "Z"].map(|axis| format!("{axis:<SHORT_NAME$}")).concat();
    let unit = " ".repeat(3 * SHORT_NAME);
    for (name, value) in
        [("NOM", axes.as_str()), ("UNI", &unit), ("UNT", " "), ("DES", "Mesh written by motet")]
    {
        node.attribute(name, text(value));
    }
    let mut step = Node::new(STEP);
    for (name, number) in
        [("CGT", 1), ("NDT", -1), ("NOR", -1), ("NXT", -1), ("NXI", -1), ("PVT", -1), ("PVI", -1)]
    {
        step.attribute(name, Attribute::Int(number));
    }
    step.attribute("PDT", Attribute::Real(-1.0));
    step.group(points_node(mesh, points));
    if !blocks.is_empty() {
        let mut all = Node::new("MAI");
        all.attribute("CGT", Attribute::Int(1));
        for (&kind, own) in blocks {
            all.group(block_node(mesh, kind, own, cells, numbers));
        }
        step.group(all);
    }
    node.group(step);
    node
}

fn support(name: &str) -> Node {
    let mut node = Node::new(name);
    node.attribute("CGT", Attribute::Int(1));
    node.attribute("CGS", Attribute::Int(1));
    node.attribute("PFL", text(WHOLE));
    node
}

fn points_node(mesh: &Mesh, families: &Divided) -> Node {
    let mut node = support("NOE");
    let n = mesh.points.len();
    let coordinates: Vec<f64> =
        (0..3).flat_map(|axis| mesh.points.iter().map(move |point| point[axis])).collect();
    column(&mut node, "COO", coordinates.into(), n);
    let of_points: Vec<i64> = families.of_places.iter().map(|&family| i64::from(family)).collect();
    column(&mut node, "FAM", of_points.into(), n);
    node
}

fn block_node(mesh: &Mesh, kind: CellKind, own: &[usize], families: &Divided, numbers: &[i64]) -> Node {
    let (name, code) = written_as(kind).unwrap_or_default();
    let mut node = support(name);
    node.attribute("GEO", Attribute::Int(code));
    let lists = mesh.cells.connectivity();
    let n = own.len();
    let id = |vertex: &crate::base::VertexId| i64::from(vertex.0) + 1;
    match kind {
        CellKind::POLYGON => {
            let mut starts = vec![1i64];
            let mut nodes: Vec<i64> = Vec::new();
            for &cell in own {
                nodes.extend(lists.list(cell).iter().map(id));
                starts.push(nodes.len() as i64 + 1);
            }
            column(&mut node, "NOD", nodes.into(), n);
            column(&mut node, "INN", starts.into(), n + 1);
        }
        CellKind::POLYHEDRON => {
            let (mut of_cells, mut of_faces, mut nodes) = (vec![1i64], vec![1i64], Vec::<i64>::new());
            // The faces of all polyhedra are stored in the order of the cells.
            for faces in mesh.cells.polyhedron_faces() {
                for face in faces.iter() {
                    nodes.extend(face.iter().map(id));
                    of_faces.push(nodes.len() as i64 + 1);
                }
                of_cells.push(of_faces.len() as i64);
            }
            let n_faces = of_faces.len();
            column(&mut node, "NOD", nodes.into(), n);
            column(&mut node, "INN", of_faces.into(), n_faces);
            column(&mut node, "IFN", of_cells.into(), n + 1);
        }
        kind => {
            let order = named(name).map_or(&[][..], |geometry| geometry.order);
            let n_nodes = kind.n_vertices().unwrap_or(0);
            let place = |node: usize| order.get(node).copied().unwrap_or(node);
            let nodes: Vec<i64> = (0..n_nodes)
                .flat_map(|node| own.iter().map(move |&cell| id(&lists.list(cell)[place(node)])))
                .collect();
            column(&mut node, "NOD", nodes.into(), n);
        }
    }
    let of_cells: Vec<i64> = own.iter().map(|&cell| numbers[families.of_places[cell] as usize]).collect();
    column(&mut node, "FAM", of_cells.into(), n);
    column(&mut node, "NUM", own.iter().map(|&cell| cell as i64 + 1).collect::<Vec<_>>().into(), n);
    node
}

/// Families of cells and points, each with its number and groups.
fn families(of: [(&str, &Divided, &Sets, Vec<i64>); 2]) -> Node {
    let mut mesh = Node::new(MESH);
    let mut zero = Node::new("FAMILLE_ZERO");
    zero.attribute("NUM", Attribute::Int(0));
    mesh.group(zero);
    for (name, divided, sets, numbers) in of {
        let used = divided.used();
        let mut node = Node::new(name);
        for (family, of) in divided.families.iter().enumerate().skip(1).filter(|&(family, _)| used[family]) {
            let mut own = Node::new(format!("FAM_{}", numbers[family]));
            own.attribute("NUM", Attribute::Int(numbers[family]));
            let mut groups = Node::new("GRO");
            groups.attribute("NBR", Attribute::Int(of.len() as i64));
            groups.records(
                "NOM",
                of.iter().map(|&set| format!("{:<GROUP_NAME$}", sets[set].0)).collect(),
                GROUP_NAME,
            );
            own.group(groups);
            node.group(own);
        }
        if !node.is_empty() {
            mesh.group(node);
        }
    }
    let mut all = Node::new("FAS");
    all.group(mesh);
    all
}

/// Fields of arrays that are neither labels nor sets.
fn fields(mesh: &Mesh, blocks: &BTreeMap<CellKind, Vec<usize>>, lost: &mut Vec<String>) -> Option<Node> {
    let mut labels = cell_labels(mesh, None);
    // Groups of curves would be read back as arrays of another name.
    let kinds = mesh.cells.kinds();
    labels.iter_mut().zip(kinds).filter(|(_, kind)| kind.dim() < Some(2)).for_each(|(label, _)| *label = 0);
    let of_cells =
        mesh.cell_data.iter().filter(|f| marks(f, ELSET).is_none() && !labels_cover(&labels, mesh, f));
    let of_points = mesh.point_data.iter().filter(|f| marks(f, NSET).is_none());
    let mut all = Node::new("CHA");
    let mut names: BTreeSet<String> = BTreeSet::new();
    let (mut texts, mut others, mut renamed) = (Vec::new(), Vec::new(), Vec::new());
    for (is_of_points, field) in of_points.map(|f| (true, f)).chain(of_cells.map(|f| (false, f))) {
        let values = match &field.values {
            Values::F64(_) | Values::I32(_) | Values::I64(_) => field.clone(),
            values => match values.to_f64() {
                Some(values) => {
                    others.push(field.name.as_str());
                    Field { name: field.name.clone(), components: field.components, values: values.into() }
                }
                None => {
                    texts.push(field);
                    continue;
                }
            },
        };
        let plain = field.name.replace('/', "_");
        let plain: String = plain.chars().take(FIELD_NAME).collect();
        let own = crate::mesh::unused_name(&plain, |name| name.is_empty() || names.contains(name));
        if own != field.name {
            renamed.push(format!("the array {} is written as {own}", field.name));
        }
        names.insert(own.clone());
        all.group(field_node(&own, &values, is_of_points, mesh.points.len(), blocks));
    }
    lost.extend(renamed);
    lost.extend(lost_arrays(NAME, "text", texts));
    if !others.is_empty() {
        lost.push(format!("arrays are written in double precision: {}", others.join(", ")));
    }
    (!names.is_empty()).then_some(all)
}

fn field_node(
    name: &str,
    field: &Field,
    is_of_points: bool,
    n_points: usize,
    blocks: &BTreeMap<CellKind, Vec<usize>>,
) -> Node {
    let mut node = Node::new(name);
    let kind = match field.values {
        Values::I32(_) => 24,
        Values::I64(_) => 26,
        _ => 6,
    };
    node.attribute("TYP", Attribute::Int(kind));
    node.attribute("NCO", Attribute::Int(field.components as i64));
    node.attribute("MAI", text(MESH));
    let width = field.components * SHORT_NAME;
    let components: String =
        (1..=field.components).map(|i| format!("{:<SHORT_NAME$}", format!("V{i}"))).collect();
    for (name, value) in [("NOM", components), ("UNI", " ".repeat(width)), ("UNT", " ".into())] {
        node.attribute(name, text(value));
    }
    let mut step = Node::new(STEP);
    for (name, number) in [("NDT", -1), ("NOR", -1), ("RDT", -1), ("ROR", -1)] {
        step.attribute(name, Attribute::Int(number));
    }
    step.attribute("PDT", Attribute::Real(0.0));
    if is_of_points {
        let rows: Vec<usize> = (0..n_points).collect();
        step.group(values_node("NOE", field, &rows));
    } else {
        for (&kind, own) in blocks {
            let (name, _) = written_as(kind).unwrap_or_default();
            step.group(values_node(&format!("MAI.{name}"), field, own));
        }
    }
    node.group(step);
    node
}

/// The values of some rows, column by column.
fn values_node(name: &str, field: &Field, rows: &[usize]) -> Node {
    let mut node = Node::new(name);
    node.attribute("GAU", text(""));
    node.attribute("PFL", text(WHOLE));
    let mut profile = Node::new(WHOLE);
    profile.attribute("NBR", Attribute::Int(rows.len() as i64));
    profile.attribute("NGA", Attribute::Int(1));
    profile.attribute("GAU", text(""));
    let single = Field { name: String::new(), components: 1, values: field.values.clone() };
    let places = (0..field.components).flat_map(|c| rows.iter().map(move |&row| row * field.components + c));
    let values = single.pick(places).values;
    let n = values.len();
    profile.array("CO", values, &[n], Storage::Plain);
    node.group(profile);
    node
}
