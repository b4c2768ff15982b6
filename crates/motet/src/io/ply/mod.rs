//! PLY surfaces, text and binary, either way round: points, polygons, and what else is told of them.
//!
//! Written here, because `ply-rs` (0.1) keeps a map from names to values for each row, and `ply-rs-bw` is its continuation.
//!
//! | file | what it holds |
//! |---|---|
//! | `header` | elements and their properties |
//! | `body` | their numbers, column by column |
//! | `write` | a mesh as such a file |
//!
//! Properties of points and of faces that are no coordinates are arrays, each in its type. `nx ny nz` are one array, `normal`; of others whose names end in `_0`, `_1` and
//! so on the same. Labels are the property `patch` of faces, their names comments, `comment patch 3 wall`, which other programs pass over.

mod body;
mod header;
mod write;

use crate::base::{Error, Result, VertexId};
use crate::io::format::{Format, Input};
use crate::io::ply::body::Table;
use crate::io::ply::header::{Element, Header};
use crate::io::polygonal::kind_of_face;
use crate::io::scalar::Scalar;
use crate::mesh::{Field, Mesh, Values};

pub(super) const FORMAT: Format =
    Format { name: "PLY", endings: &[".ply"], read: Some(read), write: Some(write::write) };

/// The coordinates of a normal, which most programs call so.
const NORMAL: [&str; 3] = ["nx", "ny", "nz"];
const NORMAL_ARRAY: &str = "normal";

fn read(input: &Input<'_>) -> Result<Mesh> {
    let header = Header::read(input.bytes)?;
    let mut mesh = Mesh::default();
    let mut faces: Option<Table> = None;
    let mut body = body::Body::new(&header, input.bytes);
    for element in &header.elements {
        let table = body.table(element)?;
        match element.name.as_str() {
            "vertex" => points(&mut mesh, table)?,
            "face" => faces = Some(table),
            name => input.notes.add(format!("{} elements `{name}` are passed over", element.n)),
        }
    }
    if mesh.points.is_empty() {
        return Err(Error::input("a surface without a point").remedy("export the surface again"));
    }
    if let Some(table) = faces {
        cells(&mut mesh, table, input)?;
    }
    mesh.label_names.patches = header.patch_names;
    Ok(mesh)
}

fn points(mesh: &mut Mesh, mut table: Table) -> Result<()> {
    let mut axis = |name: &str| {
        let column = table.take(name).ok_or_else(|| {
            Error::input(format!("its points have no property `{name}`")).remedy("export the surface again")
        })?;
        Ok(column.1)
    };
    let [x, y, z] = [axis("x")?, axis("y")?, axis("z")?];
    mesh.points = x.into_iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect();
    mesh.point_data = fields(table);
    Ok(())
}

fn cells(mesh: &mut Mesh, mut table: Table, input: &Input<'_>) -> Result<()> {
    let lists = table.take_list(&["vertex_indices", "vertex_index"]).ok_or_else(|| {
        Error::input("its faces have no list `vertex_indices`").remedy("export the surface again")
    })?;
    let n = mesh.points.len();
    for (i, list) in lists.iter().enumerate() {
        let vertex = |&id: &f64| {
            let fits = id >= 0.0 && id < n as f64 && id.fract() == 0.0;
            fits.then(|| VertexId::new(id as usize)).ok_or_else(|| {
                Error::input(format!("point {id} is named, but there are {n}, from 0"))
                    .at(format!("face {i}"))
                    .remedy("the file is damaged: get it again")
            })
        };
        let vertices = list.iter().map(vertex).collect::<Result<Vec<_>>>()?;
        mesh.cells.push(kind_of_face(vertices.len()), vertices);
    }
    for name in table.lists() {
        input.notes.add(format!("the lists `{name}` of faces are passed over"));
    }
    mesh.cell_data = fields(table);
    Ok(())
}

/// Columns as arrays: neighbours that belong together as one.
fn fields(table: Table) -> Vec<Field> {
    let columns = table.columns();
    let mut fields = Vec::new();
    let mut rest = &columns[..];
    while let Some((name, ..)) = rest.first() {
        let (array, k) = match run(rest) {
            Some(found) => found,
            None => (name.clone(), 1),
        };
        let (own, behind) = rest.split_at(k);
        let n = own[0].2.len();
        let rows = (0..n).flat_map(|i| own.iter().map(move |column| column.2[i]));
        fields.push(Field { name: array, components: k, values: typed(own[0].1, rows) });
        rest = behind;
    }
    fields
}

/// The array that the first columns make together, and how many they are.
fn run(columns: &[(String, Scalar, Vec<f64>)]) -> Option<(String, usize)> {
    let kind = columns.first()?.1;
    let alike = columns.iter().take_while(|column| column.1 == kind).map(|column| column.0.as_str());
    if alike.clone().take(3).eq(NORMAL) {
        return Some((NORMAL_ARRAY.into(), 3));
    }
    let base = columns[0].0.strip_suffix("_0")?;
    let k =
        alike.enumerate().take_while(|(i, name)| name.strip_prefix(base) == Some(&format!("_{i}"))).count();
    (k > 1).then(|| (base.to_owned(), k))
}

/// Numbers in the type that the file has them in, all of which doubles hold.
fn typed(kind: Scalar, numbers: impl Iterator<Item = f64>) -> Values {
    match kind {
        Scalar::I8 => numbers.map(|x| x as i8).collect::<Vec<_>>().into(),
        Scalar::U8 => numbers.map(|x| x as u8).collect::<Vec<_>>().into(),
        Scalar::I16 => numbers.map(|x| x as i16).collect::<Vec<_>>().into(),
        Scalar::U16 => numbers.map(|x| x as u16).collect::<Vec<_>>().into(),
        Scalar::I32 => numbers.map(|x| x as i32).collect::<Vec<_>>().into(),
        Scalar::U32 => numbers.map(|x| x as u32).collect::<Vec<_>>().into(),
        Scalar::F32 => numbers.map(|x| x as f32).collect::<Vec<_>>().into(),
        Scalar::I64 | Scalar::U64 | Scalar::F64 => numbers.collect::<Vec<_>>().into(),
    }
}

/// Whether an element has so few rows that the file can hold them.
fn fits(element: &Element, bytes_left: usize, is_text: bool) -> bool {
    let of_row = element.properties.iter().map(|property| property.smallest(is_text)).sum::<usize>();
    // The last number of a text may lack what divides it from the next.
    element.n == 0 || (of_row > 0 && element.n <= (bytes_left + usize::from(is_text)) / of_row)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::format::{Encoding, Notes, WriteOptions};
    use crate::mesh::{CellKind, shapes};

    fn parse(bytes: &[u8]) -> (Result<Mesh>, Vec<String>) {
        let notes = Notes::default();
        let mesh = read(&Input { path: std::path::Path::new("in.ply"), bytes, notes: &notes });
        (mesh, notes.into_vec())
    }

    fn full() -> Mesh {
        let mut mesh = shapes::Aneurysm { around: 8, ..Default::default() }.mesh().unwrap();
        let (n, m) = (mesh.points.len(), mesh.cells.len());
        mesh.set_point_field(Field::vectors("normal", &mesh.points.clone()));
        mesh.set_point_field(Field {
            name: "stress".into(),
            components: 6,
            values: vec![0.1f32; 6 * n].into(),
        });
        mesh.set_point_field(Field::scalars("id", (0..n as u32).collect::<Vec<_>>()));
        mesh.set_cell_field(Field::scalars("quality", (0..m).map(|i| 1.0 / i as f64).collect::<Vec<f64>>()));
        mesh.set_cell_field(Field { name: "rgb".into(), components: 3, values: vec![7u8; 3 * m].into() });
        mesh
    }

    #[test]
    fn all_comes_back_from_text_and_bytes() {
        let mesh = full();
        for encoding in [Encoding::Ascii, Encoding::Binary] {
            let options = WriteOptions { encoding, ..WriteOptions::default() };
            let written = write::write(&mesh, &options).unwrap();
            assert_eq!(written.lost, [""; 0]);
            assert_eq!(parse(&written.files[0].1).0.unwrap(), mesh, "{encoding:?}");
        }
    }

    #[test]
    fn what_others_write_is_read_and_what_is_passed_over_is_told() {
        let head = "ply\r\nformat ascii 1.0\r\nobj_info scanned\r\nelement vertex 3\r\nproperty float x\r\nproperty float y\r\n\
                    property float z\r\nproperty uchar red\r\nelement face 1\r\nproperty list uchar int vertex_index\r\n\
                    property list uchar float texcoord\r\nelement edge 1\r\nproperty int vertex1\r\nproperty int vertex2\r\nend_header\r\n";
        let (mesh, notes) =
            parse(format!("{head}0 0 0 1\r\n1 0 0 2\r\n0 1 0 3\r\n3 0 1 2 2 0.5 0.5\r\n0 1\r\n").as_bytes());
        let mesh = mesh.unwrap();
        assert_eq!(mesh.cells.kinds(), [CellKind::TRIANGLE]);
        assert_eq!(mesh.point_data, [Field::scalars("red", vec![1u8, 2, 3])]);
        assert_eq!(notes.len(), 2);
    }

    #[test]
    fn the_big_end_may_come_first() {
        let mut bytes = b"ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty double y\nproperty short z\nend_header\n".to_vec();
        bytes.extend(1.5f32.to_be_bytes());
        bytes.extend((-2.5f64).to_be_bytes());
        bytes.extend((-3i16).to_be_bytes());
        assert_eq!(parse(&bytes).0.unwrap().points, [[1.5, -2.5, -3.0]]);
    }

    #[test]
    fn what_is_wrong_is_told() {
        let head = |rest: &str| format!("ply\nformat ascii 1.0\n{rest}");
        let xyz = "property float x\nproperty float y\nproperty float z\n";
        let face = "property list uchar int vertex_indices\n";
        for (text, told) in [
            ("plx\n".to_owned(), "begins with a line `ply`"),
            ("ply\nelement vertex 1\nend_header\n".into(), "no line says the format"),
            ("ply\nformat utf8 1.0\n".into(), "expected ascii"),
            (head("element vertex 99999999\nproperty float x\nend_header\n0 0 0\n"), "announced"),
            (head("element vertex 99999999\nend_header\n"), "announced"),
            (head("element vertex -1\n"), "-1 is no number"),
            (head("property float x\n"), "before the first element"),
            (head("element vertex 1\nproperty quad x\n"), "`quad` is no type"),
            (head("element vertex 1\nproperty list float int x\n"), "whole number"),
            (head(&format!("element vertex 1\n{xyz}end_header\n0 0\n")), "announced"),
            (head(&format!("element vertex 0\n{xyz}end_header\n")), "without a point"),
            (
                head("element vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n"),
                "no property `z`",
            ),
            (
                head(&format!("element vertex 1\n{xyz}element face 1\n{face}end_header\n0 0 0\n3 0 0 1\n")),
                "point 1",
            ),
            (
                head(&format!("element vertex 1\n{xyz}element face 1\n{face}end_header\n0 0 0\n300 0 0 1\n")),
                "300 is no number",
            ),
            (
                head(&format!("element vertex 1\n{xyz}element face 1\n{face}end_header\n0 0 0\n200 0 0 1\n")),
                "a list of 200",
            ),
            (
                head(&format!(
                    "element vertex 1\n{xyz}element face 1\nproperty uchar a\nend_header\n0 0 0\n3\n"
                )),
                "no list",
            ),
            (head("element vertex 1\nproperty float x\nnonsense"), "expected format, comment"),
            (head("element vertex"), "ends"),
        ] {
            let error = parse(text.as_bytes()).0.unwrap_err().to_string();
            assert!(error.contains(told), "{text}: {error}");
        }
        // Cut off anywhere, a file is refused.
        let written = write::write(&full(), &WriteOptions::default()).unwrap().files.remove(0).1;
        for end in (0..written.len()).step_by(written.len() / 97) {
            assert!(parse(&written[..end]).0.is_err(), "{end}");
        }
    }
}
