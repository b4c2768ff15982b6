//! Writes points, blocks of cells, side sets of facets, node sets and variables.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::NAME;
use super::encode::encode;
use super::kinds::{name_of, order, sides};
use super::layout::Layout;
use super::sets::on_side;
use crate::base::{Error, Result, rising_list};
use crate::io::cell_labels::{cell_labels, labels_cover};
use crate::io::facet_key::{FacetKey, facet_key, have_same_orientation};
use crate::io::format::WriteOptions;
use crate::io::named_sets::{NSET, PATCH, REGION, marks, sets_from_arrays};
use crate::io::output::Output;
use crate::io::select::{keep_cells, lost_arrays};
use crate::mesh::{CellKind, Field, Mesh, Values, corners};

/// The least width of names, as older readers expect it.
const NAME_WIDTH: usize = 33;

/// Cells of one kind and label.
struct Block {
    kind: CellKind,
    label: i32,
    cells: Vec<usize>,
}

/// An element and one of its sides, both counted from 1.
type Side = (i32, i32);

pub(super) fn write(mesh: &Mesh, _: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let (mesh, mut lost) = keep_cells(mesh, NAME, |kind| name_of(kind).is_some());
    if mesh.points.len().max(mesh.cells.len()) > i32::MAX as usize {
        return Err(Error::input("Exodus II files hold at most 2^31 points and cells")
            .remedy("choose another format"));
    }
    let labels = cell_labels(&mesh, None);
    let plan = Plan::new(&mesh, &labels, &mut lost);
    let mut layout = Layout::default();
    let time = layout.dimension("time_step", 1);
    let width = NAME_WIDTH.max(longest_name(&mesh) + 1);
    let name_width = layout.dimension("len_name", width);
    layout.dimension("len_string", NAME_WIDTH);
    layout.dimension("len_line", 81);
    layout.dimension("four", 4);
    debug_assert_eq!(time, 0, "the first dimension is that over time");
    layout.numbers("time_whole", &[], Values::F64(vec![0.0])).is_over_time = true;
    let n_dim = layout.dimension("num_dim", 3);
    layout.texts("coor_names", [n_dim, name_width], ["x", "y", "z"].map(str::to_owned).to_vec());
    let n_points = layout.dimension("num_nodes", mesh.points.len());
    for (axis, name) in ["coordx", "coordy", "coordz"].into_iter().enumerate() {
        let column = mesh.points.iter().map(|point| point[axis]).collect();
        layout.numbers(name, &[n_points], Values::F64(column));
    }
    let block_dimensions = blocks(&mut layout, &mesh, &plan, name_width);
    side_sets(&mut layout, &plan, name_width);
    node_sets(&mut layout, &mesh, name_width);
    let is_set = |f: &&Field| marks(f, NSET).is_some();
    let point_fields = scalars(mesh.point_data.iter().filter(|f| !is_set(f)), "point", &mut lost);
    variables(&mut layout, "nod", &point_fields, name_width, &mut |layout, number, field| {
        layout.numbers(format!("vals_nod_var{number}"), &[n_points], field.clone().into()).is_over_time =
            true;
    });
    let uncovered = mesh.cell_data.iter().filter(|f| !labels_cover(&labels, &mesh, f));
    let cell_fields = scalars(uncovered, "cell", &mut lost);
    variables(&mut layout, "elem", &cell_fields, name_width, &mut |layout, number, field| {
        for (block, &dimension) in plan.blocks.iter().zip(&block_dimensions) {
            let own: Vec<f64> = block.0.cells.iter().map(|&cell| field[cell]).collect();
            let name = format!("vals_elem_var{number}eb{}", dimension.0);
            layout.numbers(name, &[dimension.1], own.into()).is_over_time = true;
        }
    });
    let on_facets =
        cell_fields.iter().filter(|(_, values)| plan.facets.iter().any(|&cell| values[cell] != 0.0));
    let on_facets: Vec<&str> = on_facets.map(|(name, _)| name.as_str()).collect();
    if !on_facets.is_empty() {
        lost.push(format!("values on the facets of side sets are not written: {}", on_facets.join(", ")));
    }
    lost.extend(lost_arrays(NAME, "field", &mesh.field_data));
    encode(&layout, output)?;
    Ok(lost)
}

/// Blocks and side sets, with their numbers and names.
struct Plan {
    blocks: Vec<(Block, i32, String)>,
    sides: Vec<(Vec<Side>, i32, String)>,
    /// The cells that are in side sets.
    facets: Vec<usize>,
}

impl Plan {
    fn new(mesh: &Mesh, labels: &[i32], lost: &mut Vec<String>) -> Self {
        let kinds = mesh.cells.kinds();
        let on_volume = facets_on_volume(mesh, labels);
        let is_facet: BTreeSet<usize> = on_volume.iter().map(|facet| facet.cell).collect();
        let mut all: BTreeMap<(Reverse<usize>, i32, u8), Vec<usize>> = BTreeMap::new();
        for (cell, kind) in kinds.iter().enumerate().filter(|(cell, _)| !is_facet.contains(cell)) {
            all.entry((Reverse(kind.dim().unwrap_or(0)), labels[cell], kind.0)).or_default().push(cell);
        }
        let order: Vec<usize> = all.values().flatten().copied().collect();
        let mut element_of = vec![0; kinds.len()];
        order.iter().zip(1..).for_each(|(&cell, element)| element_of[cell] = element);
        let mut numbers = Numbers::new(all.keys().map(|&(_, label, _)| label));
        let blocks = all.into_iter().map(|((Reverse(dim), label, kind), cells)| {
            let [number, first] = numbers.next(label, dim, lost);
            let block = Block { kind: CellKind(kind), label, cells };
            let name = name(mesh, dim, block.label, first);
            (block, number, name)
        });
        let blocks: Vec<_> = blocks.collect();
        let mut by_patch: BTreeMap<i32, Vec<(usize, Side)>> = BTreeMap::new();
        for facet in on_volume {
            if let Some((cell, side)) = facet.side {
                by_patch.entry(labels[facet.cell]).or_default().push((facet.cell, (element_of[cell], side)));
            }
        }
        let mut numbers = Numbers::new(by_patch.keys().copied());
        let mut facets = Vec::new();
        let sides = by_patch.into_iter().map(|(label, mut members)| {
            members.sort_unstable();
            facets.extend(members.iter().map(|(cell, _)| *cell));
            let [number, first] = numbers.next(label, 2, lost);
            (members.into_iter().map(|(_, side)| side).collect(), number, name(mesh, 2, label, first))
        });
        let sides: Vec<_> = sides.collect();
        if order.iter().chain(&facets).copied().ne(0..kinds.len()) {
            lost.push(format!("the order of the cells is not kept: {NAME} groups cells by region and patch"));
        }
        Self { blocks, sides, facets }
    }
}

/// A surface cell, and the volume cell and its side where it lies.
struct Facet {
    cell: usize,
    side: Option<(usize, i32)>,
    is_turned: bool,
    is_double: bool,
}

/// The surface cells with labels that lie on sides of volume cells; of two sides the one that is turned as
/// the cell is. Where two surface cells coincide there is none: readers make one cell of a side.
fn facets_on_volume(mesh: &Mesh, labels: &[i32]) -> Vec<Facet> {
    let mut facets: HashMap<FacetKey, Facet> = HashMap::new();
    for (cell, kind, vertices) in mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2)) {
        let key = facet_key(corners(kind, vertices).iter().copied());
        let cell = cell.index();
        let new = Facet { cell, side: None, is_turned: false, is_double: false };
        let facet = facets.entry(key).or_insert(new);
        facet.is_double |= facet.cell != cell;
    }
    if facets.is_empty() {
        return Vec::new();
    }
    for (cell, kind, vertices) in mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3)) {
        for (number, side) in (1..).zip(sides(kind)) {
            let key = facet_key(side.iter().map(|&i| vertices[usize::from(i)]));
            let Some(facet) = facets.get_mut(&key) else { continue };
            let own = mesh.cells.connectivity().list(facet.cell);
            let Some((shape, nodes)) = on_side(kind, vertices, side) else { continue };
            if shape.kind != mesh.cells.kinds()[facet.cell] || rising_list(own) != rising_list(&nodes) {
                continue;
            }
            let is_turned = !have_same_orientation(&nodes[..shape.n_corners], corners(shape.kind, own));
            if facet.side.is_none() || facet.is_turned && !is_turned {
                (facet.side, facet.is_turned) = (Some((cell.index(), number)), is_turned);
            }
        }
    }
    let is_on_volume = |facet: &Facet| facet.side.is_some() && !facet.is_double && labels[facet.cell] != 0;
    facets.into_values().filter(is_on_volume).collect()
}

/// Numbers of blocks or side sets.
struct Numbers {
    labels: BTreeSet<i32>,
    used: BTreeSet<i32>,
    of_label: HashMap<(usize, i32), i32>,
}

impl Numbers {
    fn new(labels: impl Iterator<Item = i32>) -> Self {
        Self { labels: labels.collect(), used: BTreeSet::new(), of_label: HashMap::new() }
    }

    /// A number: the label itself where that is positive and free, otherwise one that is no label. All sets
    /// of a label are read as the first one, whose number comes second, and of which the change is reported.
    fn next(&mut self, label: i32, dim: usize, lost: &mut Vec<String>) -> [i32; 2] {
        let is_own = label > 0 && self.used.insert(label);
        let number = if is_own {
            label
        } else {
            let is_free = |number: &i32| !self.used.contains(number) && !self.labels.contains(number);
            (1..).find(is_free).unwrap_or_default()
        };
        self.used.insert(number);
        let what = if dim == 3 { "region" } else { "patch" };
        let first = *self.of_label.entry((dim, label)).or_insert(number);
        if first == number && !is_own {
            lost.push(match label {
                0 => format!("cells without a {what} are written as block {number}"),
                label => format!("{what} {label} is written with number {number}"),
            });
        }
        [number, first]
    }
}

/// The name of a label; one without a name has the number of its first block, so that all have one name.
fn name(mesh: &Mesh, dim: usize, label: i32, first: i32) -> String {
    let (names, prefix) = match dim {
        3 => (&mesh.label_names.regions, REGION),
        _ => (&mesh.label_names.patches, PATCH),
    };
    let own = names.get(&label).filter(|name| !name.is_empty() && dim > 1).cloned();
    own.unwrap_or_else(|| format!("{prefix}{first}"))
}

/// Writes blocks of cells; returns for each its number in names of arrays, and the dimension of its cells.
fn blocks(layout: &mut Layout, mesh: &Mesh, plan: &Plan, name_width: usize) -> Vec<(usize, usize)> {
    if plan.blocks.is_empty() {
        return Vec::new();
    }
    let n_elements = plan.blocks.iter().map(|(block, ..)| block.cells.len()).sum();
    layout.dimension("num_elem", n_elements);
    let sets = plan.blocks.iter().map(|(_, number, name)| (*number, name.clone()));
    directory(layout, "el_blk", "eb", sets.collect(), name_width);
    let mut dimensions = Vec::new();
    for (i, (block, ..)) in (1..).zip(&plan.blocks) {
        let n_nodes = block.kind.n_vertices().unwrap_or(1);
        let own = layout.dimension(format!("num_el_in_blk{i}"), block.cells.len());
        let each = layout.dimension(format!("num_nod_per_el{i}"), n_nodes);
        let mut nodes = Vec::with_capacity(block.cells.len() * n_nodes);
        for &cell in &block.cells {
            let vertices = mesh.cells.connectivity().list(cell);
            nodes.extend(
                (0..n_nodes).map(|i| vertices[order(block.kind).map_or(i, |order| order[i])].0 as i32 + 1),
            );
        }
        let array = layout.numbers(format!("connect{i}"), &[own, each], nodes.into());
        array.attribute = name_of(block.kind).map(|name| ["elem_type", name]);
        dimensions.push((i, own));
    }
    dimensions
}

/// Writes numbers and names of sets.
fn directory(
    layout: &mut Layout,
    dimension: &str,
    prefix: &str,
    sets: Vec<(i32, String)>,
    name_width: usize,
) {
    let n = layout.dimension(format!("num_{dimension}"), sets.len());
    let (numbers, names): (Vec<i32>, Vec<String>) = sets.into_iter().unzip();
    layout.numbers(format!("{prefix}_status"), &[n], vec![1; numbers.len()].into());
    layout.numbers(format!("{prefix}_prop1"), &[n], numbers.into()).attribute = Some(["name", "ID"]);
    layout.texts(&format!("{prefix}_names"), [n, name_width], names);
}

fn side_sets(layout: &mut Layout, plan: &Plan, name_width: usize) {
    if plan.sides.is_empty() {
        return;
    }
    let sets = plan.sides.iter().map(|(_, number, name)| (*number, name.clone()));
    directory(layout, "side_sets", "ss", sets.collect(), name_width);
    for (i, (members, ..)) in (1..).zip(&plan.sides) {
        let n = layout.dimension(format!("num_side_ss{i}"), members.len());
        let (elements, sides): (Vec<i32>, Vec<i32>) = members.iter().copied().unzip();
        layout.numbers(format!("elem_ss{i}"), &[n], elements.into());
        layout.numbers(format!("side_ss{i}"), &[n], sides.into());
    }
}

fn node_sets(layout: &mut Layout, mesh: &Mesh, name_width: usize) {
    let sets: Vec<_> =
        sets_from_arrays(&mesh.point_data, NSET).into_iter().filter(|(_, nodes)| !nodes.is_empty()).collect();
    if sets.is_empty() {
        return;
    }
    directory(
        layout,
        "node_sets",
        "ns",
        (1..).zip(&sets).map(|(i, (name, _))| (i, name.clone())).collect(),
        name_width,
    );
    for (i, (_, nodes)) in (1..).zip(&sets) {
        let n = layout.dimension(format!("num_nod_ns{i}"), nodes.len());
        let nodes: Vec<i32> = nodes.iter().map(|&node| node as i32 + 1).collect();
        layout.numbers(format!("node_ns{i}"), &[n], nodes.into());
    }
}

/// Arrays as variables of double precision: a vector as three, other rows as one for each column.
fn scalars<'f>(
    fields: impl Iterator<Item = &'f Field>,
    what: &str,
    lost: &mut Vec<String>,
) -> Vec<(String, Vec<f64>)> {
    let mut variables = Vec::new();
    let (mut texts, mut others, mut divided) = (Vec::new(), Vec::new(), Vec::new());
    for field in fields {
        let Some(values) = field.values.to_f64() else {
            texts.push(field);
            continue;
        };
        if !matches!(field.values, Values::F64(_)) {
            others.push(field.name.as_str());
        }
        if !matches!(field.components, 1 | 3) {
            divided.push(field.name.as_str());
        }
        for i in 0..field.components {
            let column = values.iter().skip(i).step_by(field.components).copied().collect();
            let name = match field.components {
                1 => field.name.clone(),
                3 => format!("{}{}", field.name, ["X", "Y", "Z"][i]),
                _ => format!("{}_{}", field.name, i + 1),
            };
            variables.push((name, column));
        }
    }
    lost.extend(lost_arrays(NAME, "text", texts));
    for (names, how) in [(others, "in double precision"), (divided, "as an array for each column")] {
        if !names.is_empty() {
            lost.push(format!("{what} arrays are written {how}: {}", names.join(", ")));
        }
    }
    variables
}

/// Writes the names of variables, and each by `add`, which gets its number and its values.
fn variables(
    layout: &mut Layout,
    what: &str,
    fields: &[(String, Vec<f64>)],
    name_width: usize,
    add: &mut dyn FnMut(&mut Layout, usize, &Vec<f64>),
) {
    if fields.is_empty() {
        return;
    }
    let n = layout.dimension(format!("num_{what}_var"), fields.len());
    let names = fields.iter().map(|(name, _)| name.clone()).collect();
    layout.texts(&format!("name_{what}_var"), [n, name_width], names);
    (1..).zip(fields).for_each(|(number, (_, values))| add(layout, number, values));
}

/// The number of bytes of the longest name.
fn longest_name(mesh: &Mesh) -> usize {
    let labels = mesh.label_names.regions.values().chain(mesh.label_names.patches.values()).map(String::len);
    // An array may get a letter or a number more.
    let arrays = mesh.point_data.iter().chain(&mesh.cell_data).map(|f| f.name.len() + 8);
    labels.chain(arrays).max().unwrap_or(0)
}
