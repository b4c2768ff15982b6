//! PLY surfaces, text or binary in either byte order: points, polygons and their properties; uses
//! `ply-rs-bw`.
//!
//! Properties of points and faces other than coordinates become arrays, each in its type. `nx ny nz` become
//! one array, `normal`; properties whose names end in `_0`, `_1` and so on also form one array. Labels are
//! the property `patch` of faces; their names are comments, `comment patch 3 wall`, which other programs
//! ignore.

use std::io::Cursor;

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    DefaultElement, ElementDef, Encoding as PlyEncoding, Header, Key, Ply, Property, PropertyAccess,
    PropertyAccessResult, PropertyDef, PropertyType, ScalarType,
};
use ply_rs_bw::writer::Writer;

use crate::base::{Error, Result, VertexId};
use crate::geometry::vector::is_finite;
use crate::io::format::{Encoding, Format, Input, Write, WriteOptions};
use crate::io::output::{Output, write_all};
use crate::io::polygonal::kind_of_face;
use crate::io::scalar::append;
use crate::io::select::{keep_cells, lost_arrays, surface_of};
use crate::mesh::{CellKind, Field, Mesh, Values};

pub(super) const FORMAT: Format =
    Format { name: "PLY", extensions: &[".ply"], read: Some(read), write: Some(Write::File(write)) };

/// Common names of the components of a normal.
const NORMAL: [&str; 3] = ["nx", "ny", "nz"];
const NORMAL_ARRAY: &str = "normal";
/// Names of the list of a face's points.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Maximum length of messages that quote the file, whose lines may have any length.
const MAX_MESSAGE_LENGTH: usize = 200;

/// The properties of a row of an element, in the order of the header.
#[derive(Debug, Default)]
struct Row(Vec<Property>);

impl PropertyAccess for Row {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, _: &str, property: Property) -> PropertyAccessResult {
        self.0.push(property);
        PropertyAccessResult::Set
    }
}

fn read(input: &Input<'_>) -> Result<Mesh> {
    let mut reader = Reader::new(Cursor::new(input.bytes));
    let parser = Parser::<Row>::new();
    let header = parser.read_header(&mut reader).map_err(parse_error)?;
    let mut mesh = Mesh::default();
    let mut faces = None;
    for element in header.elements.values() {
        check_count(element, input.bytes.len(), header.encoding == PlyEncoding::Ascii)?;
        let rows = parser.read_payload_for_element(&mut reader, element, &header).map_err(parse_error)?;
        match element.name.as_str() {
            "vertex" => points(&mut mesh, element, &rows)?,
            "face" => faces = Some((element, rows)),
            name => input.notes.add(format!("elements `{name}` are skipped ({})", element.count)),
        }
    }
    if mesh.points.is_empty() {
        return Err(Error::input("the surface has no points").remedy("export the surface again"));
    }
    if let Some((element, rows)) = faces {
        cells(&mut mesh, element, &rows, input)?;
    }
    let names = header.comments.iter().filter_map(|line| line.strip_prefix("patch ")?.split_once(' '));
    mesh.label_names.patches =
        names.filter_map(|(id, name)| Some((id.parse().ok()?, name.to_owned()))).collect();
    Ok(mesh)
}

/// Converts an error of the library, without its list of expected tokens.
fn parse_error(error: ParseError) -> Error {
    let reported = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
    let reported = reported.split(" Error: ParseError {").next().unwrap_or_default();
    let reported = reported
        .strip_prefix("Line ")
        .and_then(|rest| rest.split_once(": "))
        .map_or(reported, |(_, what)| what);
    let what: String = reported.chars().take(MAX_MESSAGE_LENGTH).collect();
    let found = Error::input(what).remedy("the file is truncated, damaged or not a PLY file: get a new copy");
    match error.line() {
        Some(line) => found.at(format!("line {line}")),
        None => found,
    }
}

/// Checks the declared number of rows against the size of the file, since empty rows would be read without
/// limit.
fn check_count(element: &ElementDef, n_bytes: usize, is_text: bool) -> Result<()> {
    let size = |kind: &ScalarType| match (is_text, kind) {
        (true, _) | (_, ScalarType::Short | ScalarType::UShort) => 2,
        (_, ScalarType::Char | ScalarType::UChar) => 1,
        (_, ScalarType::Int | ScalarType::UInt | ScalarType::Float) => 4,
        (_, ScalarType::Double) => 8,
    };
    let least = |property: &PropertyDef| match &property.data_type {
        PropertyType::Scalar(kind) | PropertyType::List(kind, _) => size(kind),
    };
    let of_row: usize = element.properties.values().map(least).sum();
    if element.count == 0 || (of_row > 0 && element.count <= n_bytes / of_row) {
        return Ok(());
    }
    Err(Error::input(format!(
        "{} elements `{}` declared, more than a file of {n_bytes} bytes can hold",
        element.count, element.name
    ))
    .remedy("the file is truncated or damaged: get a new copy"))
}

/// The index of a property in each row.
fn property_index(element: &ElementDef, name: &str) -> Option<usize> {
    element.properties.keys().position(|key| key == name)
}

fn points(mesh: &mut Mesh, element: &ElementDef, rows: &[Row]) -> Result<()> {
    let axis = |name: &str| {
        let column =
            property_index(element, name).and_then(|i| column(element, rows, i)).and_then(|v| v.to_f64());
        column.ok_or_else(|| {
            Error::input(format!("the points have no numeric property `{name}`"))
                .remedy("export the surface again")
        })
    };
    let [x, y, z] = [axis("x")?, axis("y")?, axis("z")?];
    mesh.points = x.into_iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect();
    mesh.point_data = fields(element, rows, &["x", "y", "z"]);
    Ok(())
}

fn cells(mesh: &mut Mesh, element: &ElementDef, rows: &[Row], input: &Input<'_>) -> Result<()> {
    let corners = CORNERS.iter().find_map(|name| property_index(element, name));
    let corners = corners.ok_or_else(|| {
        Error::input("the faces have no list property `vertex_indices`").remedy("export the surface again")
    })?;
    let n = mesh.points.len();
    for (i, row) in rows.iter().enumerate() {
        let wrong = |what: String| Error::input(what).at(format!("face {i}"));
        let ids = row.0.get(corners).and_then(Property::to_u32_list);
        let ids = ids.ok_or_else(|| wrong("expected non-negative whole numbers as point ids".into()))?;
        if let Some(id) = ids.iter().find(|&&id| id as usize >= n) {
            return Err(wrong(format!(
                "the face refers to point {id}, but there are {n} points, numbered from 0"
            ))
            .remedy("the file is damaged: get a new copy"));
        }
        mesh.cells.push(kind_of_face(ids.len()), ids.into_iter().map(VertexId));
    }
    let is_list = |property: &&PropertyDef| matches!(property.data_type, PropertyType::List(..));
    let names = element.properties.values().filter(is_list).map(|property| property.name.as_str());
    for name in names.filter(|name| !CORNERS.contains(name)) {
        input.notes.add(format!("face lists `{name}` are skipped"));
    }
    mesh.cell_data = fields(element, rows, &CORNERS);
    Ok(())
}

/// The numbers at one index of all rows; `None` for lists.
fn column(element: &ElementDef, rows: &[Row], i: usize) -> Option<Values> {
    let PropertyType::Scalar(kind) = &element.properties[i].data_type else { return None };
    macro_rules! all {
        ($variant:ident) => {{
            let number = |row: &Row| match row.0.get(i) {
                Some(Property::$variant(x)) => Some(*x),
                _ => None,
            };
            rows.iter().map(number).collect::<Option<Vec<_>>>()?.into()
        }};
    }
    Some(match kind {
        ScalarType::Char => all!(Char),
        ScalarType::UChar => all!(UChar),
        ScalarType::Short => all!(Short),
        ScalarType::UShort => all!(UShort),
        ScalarType::Int => all!(Int),
        ScalarType::UInt => all!(UInt),
        ScalarType::Float => all!(Float),
        ScalarType::Double => all!(Double),
    })
}

/// All numbers except those in `used` as arrays; neighbouring properties that belong together form one array.
fn fields(element: &ElementDef, rows: &[Row], used: &[&str]) -> Vec<Field> {
    let names: Vec<&str> = element.properties.keys().map(String::as_str).collect();
    let mut fields: Vec<Field> = Vec::new();
    let mut i = 0;
    while i < names.len() {
        let (name, k) = array_at(&names[i..]);
        let own: Option<Vec<Values>> = (i..i + k).map(|i| column(element, rows, i)).collect();
        let own = own
            .filter(|own| own.iter().all(|v| std::mem::discriminant(v) == std::mem::discriminant(&own[0])));
        match own {
            Some(columns) if !used.contains(&names[i]) => {
                fields.push(Field { name: name.to_owned(), components: k, values: interleaved(columns) });
                i += k;
            }
            _ => {
                let alone = column(element, rows, i).filter(|_| !used.contains(&names[i]));
                fields.extend(alone.map(|values| Field { name: names[i].to_owned(), components: 1, values }));
                i += 1;
            }
        }
    }
    fields
}

/// The name of the array formed by the first properties, and their number.
fn array_at<'a>(names: &[&'a str]) -> (&'a str, usize) {
    if names.starts_with(&NORMAL) {
        return (NORMAL_ARRAY, 3);
    }
    let Some(base) = names[0].strip_suffix("_0") else { return (names[0], 1) };
    let numbered = |&(k, name): &(usize, &&str)| name.strip_prefix(base) == Some(&format!("_{k}"));
    match names.iter().enumerate().take_while(numbered).count() {
        1 => (names[0], 1),
        k => (base, k),
    }
}

/// Interleaves columns of one type into rows.
fn interleaved(columns: Vec<Values>) -> Values {
    let (n, k) = (columns[0].len(), columns.len());
    let mut all = Field { name: String::new(), components: 1, values: columns[0].clone() };
    for column in &columns[1..] {
        append(&mut all.values, column.clone());
    }
    all.pick((0..n * k).map(|i| i % k * n + i / k)).values
}

fn write(mesh: &Mesh, options: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let (surface, boundary_only) = surface_of(mesh, "PLY");
    let holds = |kind| matches!(kind, CellKind::TRIANGLE | CellKind::QUAD | CellKind::POLYGON);
    let (mesh, mut lost) = keep_cells(&surface, "PLY", holds);
    lost.extend(boundary_only);
    let is_text = options.encoding == Encoding::Ascii;
    if is_text && !mesh.points.iter().all(|&p| is_finite(p)) {
        return Err(Error::options("a coordinate is not finite, which text PLY files cannot hold")
            .remedy("write it with --encoding binary"));
    }
    let is_written =
        |field: &&Field| type_of(&field.values).is_some() && !(is_text && has_non_finite(&field.values));
    for (what, fields) in [("point", &mesh.point_data), ("cell", &mesh.cell_data)] {
        let reported = lost_arrays("PLY", what, fields.iter().filter(|field| !is_written(field)));
        lost.extend(reported.map(|reported| {
            format!(
                "{reported}; text, 64-bit integers, and in text files non-finite values are not supported"
            )
        }));
        let renamed = fields.iter().filter(is_written).filter(|field| name_of(field) != field.name);
        lost.extend(
            renamed.map(|field| format!("{what} array {} is written as {}", field.name, name_of(field))),
        );
    }
    lost.extend(lost_arrays("PLY", "field", &mesh.field_data));
    let regions: Vec<&str> = mesh.label_names.regions.values().map(String::as_str).collect();
    if !regions.is_empty() {
        lost.push(format!("region names are not written (PLY has none): {}", regions.join(", ")));
    }
    let held = |fields: &'_ [Field]| fields.iter().filter(is_written).cloned().collect::<Vec<_>>();
    let (of_points, of_cells) = (held(&mesh.point_data), held(&mesh.cell_data));

    let mut ply = Ply::<DefaultElement>::new();
    ply.header.encoding = if is_text { PlyEncoding::Ascii } else { PlyEncoding::BinaryLittleEndian };
    let patches = mesh.label_names.patches.iter();
    ply.header.comments =
        patches.map(|(id, name)| format!("patch {id} {}", name.replace(['\n', '\r'], " "))).collect();
    let axes = ["x", "y", "z"];
    let coordinates =
        axes.map(|axis| PropertyDef::new(axis.into(), PropertyType::Scalar(ScalarType::Double)));
    declare(&mut ply.header, "vertex", mesh.points.len(), coordinates, &of_points);
    let corners = PropertyDef::new(CORNERS[0].into(), PropertyType::List(ScalarType::UInt, ScalarType::UInt));
    declare(&mut ply.header, "face", mesh.cells.len(), [corners], &of_cells);
    let points = mesh.points.iter().enumerate().map(|(i, point)| {
        let own = axes.iter().zip(point).map(|(axis, x)| ((*axis).to_owned(), Property::Double(*x)));
        own.chain(of_points.iter().flat_map(|field| row(field, i))).collect()
    });
    let faces = mesh.cells.iter().map(|(cell, _, vertices)| {
        let own = (CORNERS[0].to_owned(), Property::ListUInt(vertices.iter().map(|v| v.0).collect()));
        std::iter::once(own).chain(of_cells.iter().flat_map(|field| row(field, cell.index()))).collect()
    });
    ply.payload.insert("vertex".into(), points.collect());
    ply.payload.insert("face".into(), faces.collect());
    let mut out = Vec::new();
    let written = Writer::new().write_ply(&mut out, &mut ply);
    written.map_err(|e| Error::input(format!("cannot be written as PLY: {e}")))?;
    write_all(output, &out)?;
    Ok(lost)
}

/// Declares an element and its properties in the header.
fn declare(
    header: &mut Header,
    name: &str,
    count: usize,
    own: impl IntoIterator<Item = PropertyDef>,
    fields: &[Field],
) {
    let mut element = ElementDef::new(name.into());
    element.count = count;
    let of_fields = fields.iter().flat_map(|field| {
        let kind = type_of(&field.values).unwrap_or(ScalarType::Double);
        names_of(field)
            .into_iter()
            .map(move |name| PropertyDef::new(name, PropertyType::Scalar(kind.clone())))
    });
    own.into_iter()
        .chain(of_fields)
        .for_each(|property| drop(element.properties.insert(property.get_key(), property)));
    header.elements.insert(name.into(), element);
}

/// The PLY type of values; `None` if there is none.
fn type_of(values: &Values) -> Option<ScalarType> {
    Some(match values {
        Values::I8(_) => ScalarType::Char,
        Values::U8(_) => ScalarType::UChar,
        Values::I16(_) => ScalarType::Short,
        Values::U16(_) => ScalarType::UShort,
        Values::I32(_) => ScalarType::Int,
        Values::U32(_) => ScalarType::UInt,
        Values::F32(_) => ScalarType::Float,
        Values::F64(_) => ScalarType::Double,
        Values::I64(_) | Values::U64(_) | Values::Text(_) => return None,
    })
}

/// Whether there is a value that is not finite.
fn has_non_finite(values: &Values) -> bool {
    !values.is_integer() && (0..values.len()).any(|i| values.get_f64(i).is_some_and(|x| !x.is_finite()))
}

/// A name in PLY's alphabet of letters, digits, `_` and `-`.
fn name_of(field: &Field) -> String {
    let name = field.name.replace(|c: char| !c.is_ascii_alphanumeric() && c != '_' && c != '-', "_");
    if name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') { name } else { format!("_{name}") }
}

/// The names of the components of an array.
fn names_of(field: &Field) -> Vec<String> {
    let name = name_of(field);
    match (field.components, name.as_str()) {
        (1, _) => vec![name],
        (3, NORMAL_ARRAY) => NORMAL.map(str::to_owned).into(),
        (n, _) => (0..n).map(|k| format!("{name}_{k}")).collect(),
    }
}

/// Row `i` of an array, with the names of its components.
fn row(field: &Field, i: usize) -> Vec<(String, Property)> {
    let k = i * field.components;
    let property = |j: usize| match &field.values {
        Values::I8(v) => Property::Char(v[j]),
        Values::U8(v) => Property::UChar(v[j]),
        Values::I16(v) => Property::Short(v[j]),
        Values::U16(v) => Property::UShort(v[j]),
        Values::I32(v) => Property::Int(v[j]),
        Values::U32(v) => Property::UInt(v[j]),
        Values::F32(v) => Property::Float(v[j]),
        values => Property::Double(values.get_f64(j).unwrap_or_default()),
    };
    names_of(field).into_iter().zip((k..).map(property)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::Threads;
    use crate::io::in_memory::parsed;
    use crate::mesh::shapes;

    fn parse(bytes: &[u8]) -> (Result<Mesh>, Vec<String>) {
        parsed(&FORMAT, "in.ply", bytes)
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
        mesh.set_cell_field(Field::scalars(
            "quality",
            (0..m).map(|i| 1.0 / (i + 3) as f64).collect::<Vec<f64>>(),
        ));
        mesh.set_cell_field(Field { name: "rgb".into(), components: 3, values: vec![7u8; 3 * m].into() });
        mesh
    }

    #[test]
    fn text_and_binary_files_round_trip() {
        let mesh = full();
        for encoding in [Encoding::Ascii, Encoding::Binary] {
            let options = WriteOptions { encoding, ..WriteOptions::default() };
            let written = FORMAT.to_files(&mesh, &options, &Threads::single()).unwrap();
            assert_eq!(written.lost, [""; 0]);
            assert_eq!(parse(&written.files[0].1).0.unwrap(), mesh, "{encoding:?}");
        }
    }

    #[test]
    fn losses_in_text_files_are_reported_and_kept_in_binary_files() {
        let mut mesh = full();
        let n = mesh.cells.len();
        mesh.set_cell_field(Field::scalars("odd name", vec![f64::INFINITY; n]));
        let [text, bytes] = [Encoding::Ascii, Encoding::Binary].map(|encoding| {
            let options = WriteOptions { encoding, ..WriteOptions::default() };
            let mut written = FORMAT.to_files(&mesh, &options, &Threads::single()).unwrap();
            (parse(&written.files.remove(0).1).0.unwrap(), written.lost)
        });
        assert!(text.1.len() == 1 && text.1[0].contains("odd name"), "{:?}", text.1);
        assert_eq!(text.0, full());
        assert!(bytes.1 == ["cell array odd name is written as odd_name"]);
        assert_eq!(bytes.0.cell_field("odd_name").unwrap().values, vec![f64::INFINITY; n].into());
        mesh.points[0][1] = f64::NAN;
        let text = WriteOptions { encoding: Encoding::Ascii, ..WriteOptions::default() };
        assert!(FORMAT.to_files(&mesh, &text, &Threads::single()).is_err());
    }

    #[test]
    fn files_of_other_programs_are_read_and_skipped_content_is_reported() {
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
    fn big_endian_files_are_read() {
        let mut bytes = b"ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty double y\nproperty short z\nend_header\n".to_vec();
        bytes.extend(1.5f32.to_be_bytes());
        bytes.extend((-2.5f64).to_be_bytes());
        bytes.extend((-3i16).to_be_bytes());
        assert_eq!(parse(&bytes).0.unwrap().points, [[1.5, -2.5, -3.0]]);
    }

    #[test]
    fn errors_are_reported() {
        let head = |rest: &str| format!("ply\nformat ascii 1.0\n{rest}");
        let xyz = "property float x\nproperty float y\nproperty float z\n";
        let face = "property list uchar int vertex_indices\n";
        for (text, reported) in [
            ("plx\n".to_owned(), "line 1: Expected magic number 'ply'"),
            ("ply\nelement vertex 1\nend_header\n".into(), "No format line"),
            ("ply\nformat utf8 1.0\n".into(), "line 2: Couldn't parse line. String: 'format utf8 1.0"),
            (head("element vertex 99999999\nproperty float x\nend_header\n0 0 0\n"), "declared"),
            (head("element vertex 99999999\nend_header\n"), "declared"),
            (head("element vertex -1\n"), "line 3: Couldn't parse line. String: 'element vertex -1"),
            (head("property float x\n"), "without preceding element"),
            (head("element vertex 1\nproperty quad x\n"), "'property quad x"),
            (
                head("element vertex 1\nproperty list float int x\nend_header\n1 0\n"),
                "no numeric property `x`",
            ),
            (head(&format!("element vertex 1\n{xyz}end_header\n0 0\n")), "line 8: Couldn't read"),
            (head(&format!("element vertex 0\n{xyz}end_header\n")), "no points"),
            (
                head("element vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n"),
                "no numeric property `z`",
            ),
            (
                head(&format!("element vertex 1\n{xyz}element face 1\n{face}end_header\n0 0 0\n3 0 0 1\n")),
                "point 1",
            ),
            (
                head(&format!("element vertex 1\n{xyz}element face 1\n{face}end_header\n0 0 0\n300 0 0 1\n")),
                "Expected 300 list elements",
            ),
            (
                head(&format!("element vertex 1\n{xyz}element face 1\n{face}end_header\n0 0 0\n200 0 0 1\n")),
                "Expected 200 list elements",
            ),
            (
                head(&format!(
                    "element vertex 1\n{xyz}element face 1\nproperty uchar a\nend_header\n0 0 0\n3\n"
                )),
                "no list",
            ),
            (head("element vertex 1\nproperty float x\nnonsense"), "String: 'nonsense'"),
            (head("element vertex"), "line 3"),
        ] {
            let error = parse(text.as_bytes()).0.unwrap_err().to_string();
            assert!(error.contains(reported), "{text}: {error}");
        }
        // A file truncated at any point is rejected.
        let written =
            FORMAT.to_files(&full(), &WriteOptions::default(), &Threads::single()).unwrap().files.remove(0).1;
        for end in (0..written.len()).step_by(written.len() / 97) {
            assert!(parse(&written[..end]).0.is_err(), "{end}");
        }
    }
}
