//! Reads TetGen's files with a common stem.

use super::EDGE_NODES;
use crate::base::{Error, Result, VertexId};
use crate::io::Input;
use crate::io::node_order::vtk_to_other;
use crate::io::reading::read_if_exists;
use crate::io::text::{Text, parse_float, parse_int};
use crate::mesh::{CellKind, Cells, Field, Mesh, Values};

/// Maximum number of columns, more than any program writes.
const MAX_COLUMNS: usize = 1 << 16;

/// One of the files: a header of a few counts, then a line for each item.
struct Table<'a> {
    text: Text<'a>,
    head: Vec<usize>,
}

impl<'a> Table<'a> {
    /// Reads the header, which starts with the number of lines and is padded with zeros to `min_columns`
    /// numbers.
    fn new(bytes: &'a [u8], what: &str, min_columns: usize) -> Result<Self> {
        let mut text = Text::with_comments(bytes, b'#');
        text.peek().ok_or_else(|| text.unexpected_end(&format!("the header of the {what}")))?;
        let mut head = Vec::new();
        let n = text.count(what, 1)?;
        head.push(n);
        while let Some(word) = text.word_in_line() {
            let count = parse_int(word).and_then(|n| usize::try_from(n).ok()).filter(|n| *n <= MAX_COLUMNS);
            head.push(count.ok_or_else(|| text.unexpected("header", "a count", word))?);
        }
        if head.len() < min_columns {
            head.resize(min_columns, 0);
        }
        Ok(Self { text, head })
    }

    /// Reads the numbers of the next non-empty line.
    fn row(&mut self, what: &str, row: &mut Vec<&'a [u8]>) -> Result<()> {
        row.clear();
        row.push(self.text.expect(what)?);
        while let Some(word) = self.text.word_in_line() {
            row.push(word);
        }
        Ok(())
    }

    fn int(&self, row: &[&[u8]], column: usize, what: &str) -> Result<i64> {
        let word = row.get(column).ok_or_else(|| self.too_few_columns(column + 1, what))?;
        parse_int(word).ok_or_else(|| self.text.unexpected(what, "a whole number", word))
    }

    fn float(&self, row: &[&[u8]], column: usize, what: &str) -> Result<f64> {
        let word = row.get(column).ok_or_else(|| self.too_few_columns(column + 1, what))?;
        parse_float(word).ok_or_else(|| self.text.unexpected(what, "a number", word))
    }

    fn too_few_columns(&self, n: usize, what: &str) -> Error {
        self.text
            .error(format!("{what} is missing: expected {n} numbers on the line"))
            .remedy("the header does not match the lines, or the file is damaged")
    }
}

/// Nodes, as needed by the other files.
struct NodesFile {
    points: Vec<[f64; 3]>,
    fields: Vec<Field>,
    /// The number of the first node.
    base: i64,
    dim: usize,
}

/// Reads the files that share the stem of the given one.
pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let path = input.path;
    let is_ele = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("ele"));
    let node_path = if is_ele { path.with_extension("node") } else { path.to_owned() };
    let ele_path = if is_ele { path.to_owned() } else { path.with_extension("ele") };
    let (node_bytes, ele_bytes) = if is_ele {
        let bytes = read_if_exists(&node_path)?.ok_or_else(|| {
            Error::input("the file with the points of the .ele file does not exist")
                .in_file(&node_path)
                .remedy("put the .node file of the same name in the same folder")
        })?;
        (Some(bytes), None)
    } else {
        (None, read_if_exists(&ele_path)?)
    };
    let nodes =
        read_nodes(node_bytes.as_deref().unwrap_or(input.bytes)).map_err(|e| e.in_file(&node_path))?;
    let mut elements = Elements::default();
    match if is_ele { Some(input.bytes) } else { ele_bytes.as_deref() } {
        Some(bytes) => elements.read_ele(bytes, &nodes).map_err(|e| e.in_file(&ele_path))?,
        None => input.notes.add("there is no .ele file of the same name: only points are read"),
    }
    for (extension, kind, n) in [("face", CellKind::TRIANGLE, 3), ("edge", CellKind::LINE, 2)] {
        let side_path = path.with_extension(extension);
        if let Some(bytes) = read_if_exists(&side_path)? {
            elements.read_sides(&bytes, &nodes, kind, n).map_err(|e| e.in_file(&side_path))?;
        }
    }
    Ok(elements.into_mesh(nodes))
}

/// Reads the node file, whose header is `number of points, dimension, number of attributes, number of
/// markers`.
fn read_nodes(bytes: &[u8]) -> Result<NodesFile> {
    let mut table = Table::new(bytes, "nodes", 4)?;
    let [n, dim, n_attributes, n_markers] = [table.head[0], table.head[1], table.head[2], table.head[3]];
    if !(2..=3).contains(&dim) {
        return Err(table.text.error(format!("expected dimension 2 or 3, found {dim}")));
    }
    let mut attributes = vec![Vec::new(); n_attributes];
    let mut markers = vec![Vec::new(); n_markers.min(1)];
    let mut points = Vec::with_capacity(n);
    let mut row = Vec::new();
    let mut base = 0;
    for i in 0..n {
        table.row("a node", &mut row)?;
        let number = table.int(&row, 0, "node number")?;
        base = if i == 0 { number } else { base };
        if number.checked_sub(base) != Some(i as i64) {
            return Err(table
                .text
                .error(format!("expected node {}, found node {number}", base.saturating_add(i as i64)))
                .remedy("number the nodes consecutively"));
        }
        let mut point = [0.0; 3];
        for (k, x) in point[..dim].iter_mut().enumerate() {
            *x = table.float(&row, 1 + k, "node coordinate")?;
        }
        points.push(point);
        for (k, column) in attributes.iter_mut().enumerate() {
            column.push(table.float(&row, 1 + dim + k, "node attribute")?);
        }
        for column in &mut markers {
            column.push(table.int(&row, 1 + dim + n_attributes, "node marker")?);
        }
    }
    let attribute = |(k, values)| Field::scalars(format!("tetgen:attr{}", k + 1), Values::F64(values));
    let mut fields: Vec<Field> = attributes.into_iter().enumerate().map(attribute).collect();
    fields.extend(markers.into_iter().map(|values| Field::scalars("tetgen:ref", narrow(values))));
    Ok(NodesFile { points, fields, base, dim })
}

/// Converts to 32 bits if all values fit.
fn narrow(values: Vec<i64>) -> Values {
    match values.iter().map(|&v| i32::try_from(v).ok()).collect::<Option<Vec<i32>>>() {
        Some(narrow) => narrow.into(),
        None => values.into(),
    }
}

#[derive(Default)]
struct Elements {
    cells: Cells,
    /// Columns of attributes; the first also holds the markers of triangles and edges.
    columns: Vec<Vec<f64>>,
}

impl Elements {
    /// Reads the element file, whose header is `number of tetrahedra, nodes in each, number of attributes`.
    fn read_ele(&mut self, bytes: &[u8], nodes: &NodesFile) -> Result<()> {
        let mut table = Table::new(bytes, "elements", 3)?;
        let [n, n_nodes, n_attributes] = [table.head[0], table.head[1], table.head[2]];
        let kind = match (n_nodes, nodes.dim) {
            (4, 3) => CellKind::TETRA,
            (10, 3) => CellKind::QUADRATIC_TETRA,
            (3, _) => CellKind::TRIANGLE,
            _ => {
                return Err(table.text.error(format!(
                    "expected tetrahedra with 4 or 10 nodes, found elements with {n_nodes} in {} dimensions",
                    nodes.dim
                )));
            }
        };
        let order = vtk_to_other(kind, n_nodes, EDGE_NODES);
        self.columns = vec![Vec::new(); n_attributes];
        self.rows(&mut table, n, kind, &order, nodes)
    }

    /// Reads a face or edge file, whose header is `number of triangles or edges, number of markers`.
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
                column.push(table.float(&row, 1 + order.len() + k, "element attribute")?);
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
                .error(format!(
                    "an element refers to node {number}, but nodes are numbered from {} to {last}",
                    self.base
                ))
                .remedy("the files do not belong together, or are damaged")
        })
    }
}
