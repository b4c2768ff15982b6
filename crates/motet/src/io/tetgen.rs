//! TetGen's files: `.node` and `.ele`, with `.face` and `.edge` where they lie beside.
//!
//! Either name reads all that have the same stem. Counting starts at the first
//! number in `.node`, 0 or 1 or any other. Attributes and markers become the arrays
//! `tetgen:attr1`, ... and `tetgen:ref` on points, `tetgen:ref`, `tetgen:ref2`, ...
//! on cells (meshio's names); on triangles and edges `tetgen:ref` is their marker.
//! The sense of tetrahedra stays as it is: TetGen writes positive ones, others do
//! not. `.neigh` is not read, since it follows from `.ele`.

use std::io::Write as _;
use std::path::Path;

use super::node_order::{Nodes, vtk_to_other};
use super::text::{Text, parse_float, parse_int, push_float};
use crate::base::{Error, Result, VertexId};
use crate::io::cell_labels::{cell_labels, lost_names, say_all};
use crate::io::select::{keep_cells, lost_arrays};
use crate::io::{Format, Input, WriteOptions, Written};
use crate::mesh::{CellKind, Cells, Field, Mesh, Values};

pub(super) const FORMAT: Format =
    Format { name: "TetGen", endings: &[".node", ".ele"], read: Some(read), write: Some(write) };

/// Nodes on edges of a tetrahedron, found by comparing with midpoints of edges
/// what TetGen 1.6 writes with `-o2`.
const EDGE_NODES: Nodes = &[&[2, 3], &[0, 3], &[0, 1], &[1, 2], &[1, 3], &[0, 2]];
/// More numbers on a line than any program writes.
const MAX_COLUMNS: usize = 1 << 16;

/// One of the files: a head of a few counts, then a line for each thing.
struct Table<'a> {
    text: Text<'a>,
    head: Vec<usize>,
}

impl<'a> Table<'a> {
    /// Reads the head: `n_least` numbers at least, the first being how many lines follow.
    fn new(bytes: &'a [u8], what: &str, n_least: usize) -> Result<Self> {
        let mut text = Text::with_comments(bytes, b'#');
        text.peek().ok_or_else(|| text.ends(&format!("the head of the {what}")))?;
        let mut head = Vec::new();
        let n = text.count(what, 1)?;
        head.push(n);
        while let Some(word) = text.word_in_line() {
            let count = parse_int(word).and_then(|n| usize::try_from(n).ok()).filter(|n| *n <= MAX_COLUMNS);
            head.push(count.ok_or_else(|| text.unexpected("head of the file", "a count", word))?);
        }
        if head.len() < n_least {
            head.resize(n_least, 0);
        }
        Ok(Self { text, head })
    }

    /// The numbers of the next line that is not empty.
    fn row(&mut self, what: &str, row: &mut Vec<&'a [u8]>) -> Result<()> {
        row.clear();
        row.push(self.text.expect(what)?);
        while let Some(word) = self.text.word_in_line() {
            row.push(word);
        }
        Ok(())
    }

    fn int(&self, row: &[&[u8]], column: usize, what: &str) -> Result<i64> {
        let word = row.get(column).ok_or_else(|| self.short(column + 1, what))?;
        parse_int(word).ok_or_else(|| self.text.unexpected(what, "a whole number", word))
    }

    fn float(&self, row: &[&[u8]], column: usize, what: &str) -> Result<f64> {
        let word = row.get(column).ok_or_else(|| self.short(column + 1, what))?;
        parse_float(word).ok_or_else(|| self.text.unexpected(what, "a number", word))
    }

    fn short(&self, n: usize, what: &str) -> Error {
        self.text
            .error(format!("{what} is missing: the line needs {n} numbers"))
            .remedy("the head of the file does not fit its lines, or the file is damaged")
    }
}

/// Nodes, as the other files need them.
struct NodesFile {
    points: Vec<[f64; 3]>,
    fields: Vec<Field>,
    /// The number of the first one.
    base: i64,
    dim: usize,
}

fn read(input: &Input<'_>) -> Result<Mesh> {
    let path = input.path;
    let is_ele = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("ele"));
    let node_path = if is_ele { path.with_extension("node") } else { path.to_owned() };
    let ele_path = if is_ele { path.to_owned() } else { path.with_extension("ele") };
    let (node_bytes, ele_bytes) = if is_ele {
        let bytes = beside(&node_path)?.ok_or_else(|| {
            Error::input("there is no such file, which holds the points of the .ele file")
                .in_file(&node_path)
                .remedy("put the .node file of the same name beside it")
        })?;
        (Some(bytes), None)
    } else {
        (None, beside(&ele_path)?)
    };
    let nodes =
        read_nodes(node_bytes.as_deref().unwrap_or(input.bytes)).map_err(|e| e.in_file(&node_path))?;
    let mut elements = Elements::default();
    match if is_ele { Some(input.bytes) } else { ele_bytes.as_deref() } {
        Some(bytes) => elements.read_ele(bytes, &nodes).map_err(|e| e.in_file(&ele_path))?,
        None => input.notes.add("there is no .ele file of the same name: points without cells"),
    }
    for (ending, kind, n) in [("face", CellKind::TRIANGLE, 3), ("edge", CellKind::LINE, 2)] {
        let side_path = path.with_extension(ending);
        if let Some(bytes) = beside(&side_path)? {
            elements.read_sides(&bytes, &nodes, kind, n).map_err(|e| e.in_file(&side_path))?;
        }
    }
    Ok(elements.into_mesh(nodes))
}

/// The content of a file that may be missing.
fn beside(path: &Path) -> Result<Option<Vec<u8>>> {
    match std::fs::read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(e) => Err(Error::io(path, &e)),
    }
}

/// `number of points, dimension, number of attributes, number of markers`.
fn read_nodes(bytes: &[u8]) -> Result<NodesFile> {
    let mut table = Table::new(bytes, "nodes", 4)?;
    let [n, dim, n_attributes, n_markers] = [table.head[0], table.head[1], table.head[2], table.head[3]];
    if !(2..=3).contains(&dim) {
        return Err(table.text.error(format!("points of {dim} dimensions; 2 and 3 are read")));
    }
    let mut attributes = vec![Vec::new(); n_attributes];
    let mut markers = vec![Vec::new(); n_markers.min(1)];
    let mut points = Vec::with_capacity(n);
    let mut row = Vec::new();
    let mut base = 0;
    for i in 0..n {
        table.row("a node", &mut row)?;
        let number = table.int(&row, 0, "number of a node")?;
        base = if i == 0 { number } else { base };
        if number.checked_sub(base) != Some(i as i64) {
            return Err(table
                .text
                .error(format!("node {number} stands where number {} should", base.saturating_add(i as i64)))
                .remedy("number the nodes without gaps"));
        }
        let mut point = [0.0; 3];
        for (k, x) in point[..dim].iter_mut().enumerate() {
            *x = table.float(&row, 1 + k, "coordinate of a node")?;
        }
        points.push(point);
        for (k, column) in attributes.iter_mut().enumerate() {
            column.push(table.float(&row, 1 + dim + k, "attribute of a node")?);
        }
        for column in &mut markers {
            column.push(table.int(&row, 1 + dim + n_attributes, "marker of a node")?);
        }
    }
    let attribute = |(k, values)| Field::scalars(format!("tetgen:attr{}", k + 1), Values::F64(values));
    let mut fields: Vec<Field> = attributes.into_iter().enumerate().map(attribute).collect();
    fields.extend(markers.into_iter().map(|values| Field::scalars("tetgen:ref", narrow(values))));
    Ok(NodesFile { points, fields, base, dim })
}

/// 32 bits where they suffice.
fn narrow(values: Vec<i64>) -> Values {
    match values.iter().map(|&v| i32::try_from(v).ok()).collect::<Option<Vec<i32>>>() {
        Some(narrow) => narrow.into(),
        None => values.into(),
    }
}

#[derive(Default)]
struct Elements {
    cells: Cells,
    /// Columns of attributes; the first holds the markers of triangles and edges as well.
    columns: Vec<Vec<f64>>,
}

impl Elements {
    /// `number of tetrahedra, nodes in each, number of attributes`.
    fn read_ele(&mut self, bytes: &[u8], nodes: &NodesFile) -> Result<()> {
        let mut table = Table::new(bytes, "elements", 3)?;
        let [n, n_nodes, n_attributes] = [table.head[0], table.head[1], table.head[2]];
        let kind = match (n_nodes, nodes.dim) {
            (4, 3) => CellKind::TETRA,
            (10, 3) => CellKind::QUADRATIC_TETRA,
            (3, _) => CellKind::TRIANGLE,
            _ => {
                return Err(table.text.error(format!(
                    "elements of {n_nodes} nodes in {} dimensions; tetrahedra of 4 or 10 nodes are read",
                    nodes.dim
                )));
            }
        };
        let order = vtk_to_other(kind, n_nodes, EDGE_NODES);
        self.columns = vec![Vec::new(); n_attributes];
        self.rows(&mut table, n, kind, &order, nodes)
    }

    /// `number of triangles or edges, number of markers`.
    fn read_sides(&mut self, bytes: &[u8], nodes: &NodesFile, kind: CellKind, n_nodes: usize) -> Result<()> {
        let mut table = Table::new(bytes, "sides", 2)?;
        let [n, n_markers] = [table.head[0], table.head[1]];
        let before = self.cells.len();
        let mut sides = Self { columns: vec![Vec::new(); n_markers.min(1)], ..Self::default() };
        sides.rows(&mut table, n, kind, &(0..n_nodes).collect::<Vec<_>>(), nodes)?;
        if self.columns.is_empty() && n_markers > 0 {
            self.columns.push(vec![0.0; before]);
        }
        for (k, column) in self.columns.iter_mut().enumerate() {
            match sides.columns.get(k) {
                Some(markers) => column.extend(markers),
                None => column.resize(before + n, 0.0),
            }
        }
        for (_, kind, vertices) in sides.cells.iter() {
            self.cells.push(kind, vertices.iter().copied());
        }
        Ok(())
    }

    fn rows(
        &mut self,
        table: &mut Table<'_>,
        n: usize,
        kind: CellKind,
        order: &[usize],
        nodes: &NodesFile,
    ) -> Result<()> {
        let mut row = Vec::new();
        let mut theirs = vec![VertexId::default(); order.len()];
        for _ in 0..n {
            table.row("an element", &mut row)?;
            for (k, vertex) in theirs.iter_mut().enumerate() {
                *vertex = nodes.vertex(table.int(&row, 1 + k, "node of an element")?, table)?;
            }
            self.cells.push(kind, order.iter().map(|&k| theirs[k]));
            for (k, column) in self.columns.iter_mut().enumerate() {
                column.push(table.float(&row, 1 + order.len() + k, "attribute of an element")?);
            }
        }
        Ok(())
    }

    fn into_mesh(self, nodes: NodesFile) -> Mesh {
        let mut mesh = Mesh::new(nodes.points, self.cells);
        mesh.point_data = nodes.fields;
        for (k, values) in self.columns.into_iter().enumerate() {
            let name = if k == 0 { "tetgen:ref".to_owned() } else { format!("tetgen:ref{}", k + 1) };
            let field = Field::scalars(name, Values::F64(values));
            let values = field.values.to_i64().map_or(field.values, narrow);
            mesh.cell_data.push(Field { values, ..field });
        }
        mesh
    }
}

impl NodesFile {
    fn vertex(&self, number: i64, table: &Table<'_>) -> Result<VertexId> {
        let place = number.checked_sub(self.base).and_then(|place| usize::try_from(place).ok());
        place.filter(|&place| place < self.points.len()).map(VertexId::new).ok_or_else(|| {
            let last = self.base + self.points.len() as i64 - 1;
            table
                .text
                .error(format!("an element names node {number}, but there are {} to {last}", self.base))
                .remedy("the files do not belong together, or are damaged")
        })
    }
}

fn write(mesh: &Mesh, _: &WriteOptions) -> Result<Written> {
    let n_tets = |kind| mesh.cells.kinds().iter().filter(|k| **k == kind).count();
    let quadratic = n_tets(CellKind::TETRA) == 0 && n_tets(CellKind::QUADRATIC_TETRA) > 0;
    let tetra = if quadratic { CellKind::QUADRATIC_TETRA } else { CellKind::TETRA };
    let (mesh, mut lost) = keep_cells(mesh, "TetGen", |kind| {
        kind == tetra || kind == CellKind::TRIANGLE || kind == CellKind::LINE
    });
    let labels = cell_labels(&mesh, None);
    lost.extend(lost_names("TetGen", &mesh));
    lost.extend(lost_arrays("TetGen", "field", &mesh.field_data));
    let rank = |kind: &CellKind| [tetra, CellKind::TRIANGLE, CellKind::LINE].iter().position(|k| k == kind);
    if !mesh.cells.kinds().is_sorted_by_key(rank) {
        lost.push("TetGen keeps cells by their kinds: their order differs from that in the mesh".into());
    }
    let mut files = vec![(".node".to_owned(), node_file(&mesh, &mut lost))];
    files.push((".ele".to_owned(), ele_file(&mesh, tetra, &labels, &mut lost)));
    files.push((".face".to_owned(), side_file(&mesh, CellKind::TRIANGLE, &labels)));
    if mesh.cells.kinds().contains(&CellKind::LINE) {
        files.push((".edge".to_owned(), side_file(&mesh, CellKind::LINE, &labels)));
    }
    Ok(Written { files, lost })
}

fn node_file(mesh: &Mesh, lost: &mut Vec<String>) -> Vec<u8> {
    let markers = ["tetgen:ref", "medit:ref"].iter().find_map(|name| mesh.point_field(name));
    let markers = markers.filter(|f| f.components == 1 && f.values.to_i64().is_some());
    let (kept, other): (Vec<&Field>, Vec<&Field>) = mesh
        .point_data
        .iter()
        .filter(|f| markers.is_none_or(|m| m.name != f.name))
        .partition(|f| !matches!(f.values, Values::Text(_)));
    lost.extend(lost_arrays("TetGen", "text", other));
    lost.extend(nameless("point", &kept, |f| f.name.starts_with("tetgen:")));
    let n_attributes: usize = kept.iter().map(|f| f.components).sum();
    let mut out = Vec::new();
    line(&mut out, format_args!("{} 3 {n_attributes} {}", mesh.points.len(), usize::from(markers.is_some())));
    for (i, point) in mesh.points.iter().enumerate() {
        put(&mut out, i);
        point.iter().for_each(|&x| put_float(&mut out, x));
        for field in &kept {
            (0..field.components).for_each(|k| put_value(&mut out, field, i * field.components + k));
        }
        if let Some(markers) = markers {
            put_value(&mut out, markers, i);
        }
        out.push(b'\n');
    }
    out
}

/// The first attribute is the region; whole-number arrays follow.
fn ele_file(mesh: &Mesh, tetra: CellKind, labels: &[i32], lost: &mut Vec<String>) -> Vec<u8> {
    let (kept, other): (Vec<&Field>, Vec<&Field>) = mesh
        .cell_data
        .iter()
        .filter(|f| !say_all(labels, mesh, f))
        .partition(|f| f.values.is_integer() && mesh.cells.kinds().contains(&tetra));
    lost.extend(lost_arrays("TetGen", "cell", other));
    lost.extend(nameless("cell", &kept, |f| f.name.starts_with("tetgen:")));
    let places = places_of(mesh, tetra);
    let labelled = !kept.is_empty() || places.iter().any(|&i| labels[i] != 0);
    let n_attributes = usize::from(labelled) + kept.iter().map(|f| f.components).sum::<usize>();
    let n_nodes = tetra.n_vertices().unwrap_or(4);
    let order = vtk_to_other(tetra, n_nodes, EDGE_NODES);
    let mut out = Vec::new();
    line(&mut out, format_args!("{} {n_nodes} {n_attributes}", places.len()));
    let mut theirs = vec![VertexId::default(); n_nodes];
    for (number, &i) in places.iter().enumerate() {
        put(&mut out, number);
        order.iter().zip(mesh.cells.connectivity().list(i)).for_each(|(&place, &v)| theirs[place] = v);
        theirs.iter().for_each(|v| put(&mut out, v));
        if labelled {
            put(&mut out, labels[i]);
        }
        for field in &kept {
            (0..field.components).for_each(|k| put_value(&mut out, field, i * field.components + k));
        }
        out.push(b'\n');
    }
    out
}

fn side_file(mesh: &Mesh, kind: CellKind, labels: &[i32]) -> Vec<u8> {
    let places = places_of(mesh, kind);
    let marked = places.iter().any(|&i| labels[i] != 0);
    let mut out = Vec::new();
    line(&mut out, format_args!("{} {}", places.len(), usize::from(marked)));
    for (number, &i) in places.iter().enumerate() {
        put(&mut out, number);
        mesh.cells.connectivity().list(i).iter().for_each(|v| put(&mut out, v));
        if marked {
            put(&mut out, labels[i]);
        }
        out.push(b'\n');
    }
    out
}

fn places_of(mesh: &Mesh, kind: CellKind) -> Vec<usize> {
    (0..mesh.cells.len()).filter(|&i| mesh.cells.kinds()[i] == kind).collect()
}

/// A sentence on arrays that keep their values but not their names.
fn nameless(what: &str, fields: &[&Field], keeps_name: impl Fn(&Field) -> bool) -> Option<String> {
    let names: Vec<&str> = fields.iter().filter(|f| !keeps_name(f)).map(|f| f.name.as_str()).collect();
    (!names.is_empty()).then(|| {
        format!("{what} arrays are written as numbered attributes, TetGen has no names: {}", names.join(", "))
    })
}

fn line(out: &mut Vec<u8>, content: impl std::fmt::Display) {
    writeln!(out, "{content}").expect("writing into memory does not fail");
}

fn put(out: &mut Vec<u8>, content: impl std::fmt::Display) {
    if out.last().is_some_and(|b| *b != b'\n') {
        out.push(b' ');
    }
    write!(out, "{content}").expect("writing into memory does not fail");
}

fn put_float(out: &mut Vec<u8>, x: f64) {
    out.push(b' ');
    push_float(out, x);
}

fn put_value(out: &mut Vec<u8>, field: &Field, i: usize) {
    match &field.values {
        Values::I64(v) => put(out, v[i]),
        Values::U64(v) => put(out, v[i]),
        values if values.is_integer() => put(out, values.get_f64(i).unwrap_or_default()),
        values => put_float(out, values.get_f64(i).unwrap_or(f64::NAN)),
    }
}
