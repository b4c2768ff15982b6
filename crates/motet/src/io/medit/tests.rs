use std::path::Path;

use super::*;
use crate::base::{Result, Threads, VertexId};
use crate::io::format::{Notes, WriteOptions, Written};
use crate::io::in_memory::{parsed, survives_changed_bytes};
use crate::mesh::{Cells, Field, Mesh, Values};

/// A binary file of any version and byte order, assembled number by number.
struct Bytes {
    out: Vec<u8>,
    version: i32,
    big: bool,
}

impl Bytes {
    fn new(version: i32, big: bool) -> Self {
        let mut bytes = Self { out: Vec::new(), version, big };
        bytes.fixed_i32(1).fixed_i32(version);
        let next = bytes.out.len() + if version < 3 { 12 } else { 16 };
        bytes.fixed_i32(3).position(next).fixed_i32(3);
        bytes
    }

    fn put<const N: usize>(&mut self, mut bytes: [u8; N]) -> &mut Self {
        if self.big {
            bytes.reverse();
        }
        self.out.extend(bytes);
        self
    }

    fn fixed_i32(&mut self, x: i32) -> &mut Self {
        self.put(x.to_le_bytes())
    }

    fn position(&mut self, x: usize) -> &mut Self {
        if self.version < 3 { self.fixed_i32(x as i32) } else { self.put((x as i64).to_le_bytes()) }
    }

    fn int(&mut self, x: i32) -> &mut Self {
        if self.version < 4 { self.fixed_i32(x) } else { self.put(i64::from(x).to_le_bytes()) }
    }

    fn float(&mut self, x: f64) -> &mut Self {
        if self.version == 1 { self.put((x as f32).to_le_bytes()) } else { self.put(x.to_le_bytes()) }
    }

    /// Adds a section whose content `fill` writes, with the position after it.
    fn section(&mut self, number: i32, n: i32, fill: impl FnOnce(&mut Self)) -> &mut Self {
        let mut inner = Self { out: Vec::new(), version: self.version, big: self.big };
        inner.int(n);
        fill(&mut inner);
        let head = if self.version < 3 { 8 } else { 12 };
        let next = self.out.len() + head + inner.out.len();
        self.fixed_i32(number).position(next);
        self.out.extend(inner.out);
        self
    }

    /// Completes the file with a tetrahedron with references, an unknown section, and the end.
    fn tet(mut self) -> Vec<u8> {
        self.section(4, 4, |s| {
            for (i, p) in CORNERS.iter().enumerate() {
                for &x in p {
                    s.float(x);
                }
                s.int(i as i32);
            }
        });
        self.section(999, 2, |s| _ = s.int(7).int(7));
        self.section(8, 1, |s| (1..=5).for_each(|i| _ = s.int(i)));
        self.section(15, 1, |s| _ = s.int(2));
        self.fixed_i32(54).position(0);
        self.out
    }
}

const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn parse_meshb(bytes: &[u8]) -> (Result<Mesh>, Vec<String>) {
    parsed(&MESHB, "in.meshb", bytes)
}

fn error_of(bytes: &[u8]) -> String {
    parse_meshb(bytes).0.unwrap_err().to_string()
}

#[test]
fn every_version_is_read_in_either_byte_order() {
    for version in 1..=4 {
        for big in [false, true] {
            let (mesh, notes) = parse_meshb(&Bytes::new(version, big).tet());
            let mesh = mesh.unwrap();
            assert_eq!(mesh.points, CORNERS);
            assert_eq!(mesh.cells.kinds(), [CellKind::TETRA]);
            assert_eq!(mesh.cells.connectivity().items(), [0, 1, 2, 3].map(VertexId));
            assert_eq!(mesh.cell_field(REF).unwrap().values, Values::I32(vec![5]));
            assert_eq!(mesh.point_field(REF).unwrap().values, Values::I32(vec![0, 1, 2, 3]));
            assert_eq!(mesh.point_field(REQUIRED).unwrap().values, Values::U8(vec![0, 1, 0, 0]));
            assert_eq!(notes, ["section `number 999` is skipped: a mesh cannot hold it"]);
        }
    }
}

#[test]
fn truncated_files_are_reported() {
    for version in 1..=4 {
        let bytes = Bytes::new(version, false).tet();
        // Between two sections only the missing end reveals the cut; a file cut after the number of `End` is
        // complete.
        for n in 0..bytes.len() - if version < 3 { 4 } else { 8 } {
            let (mesh, notes) = parse_meshb(&bytes[..n]);
            assert!(
                mesh.is_err() || notes.iter().any(|n| n.contains("`End` is missing")),
                "{version} at {n}"
            );
        }
    }
}

#[test]
fn wrong_positions_and_counts_are_reported() {
    let good = Bytes::new(2, false).tet();
    // The position after the dimension, and those in the head of the vertices (whose section begins at byte
    // 20).
    for (at, value, words) in [
        (12, 4, "the next section, byte 4,"),
        (12, 1_000_000, "the next section, byte 1000000,"),
        (12, -1, "the next section, byte -1,"),
        (24, 20, "the next section, byte 20,"),
        (24, 40, "4 vertices declared, but the rest of the section can hold at most 0"),
        (28, 5, "5 vertices declared"),
        (28, 3, "the section ends here, but the file places the next one at byte 144"),
        (28, -1, "-1 vertices declared"),
        (4, 5, "expected format version 1 to 4, found 5"),
        (16, 4, "expected dimension 2 or 3, found 4"),
    ] {
        let mut bytes = good.clone();
        bytes[at..at + 4].copy_from_slice(&i32::to_le_bytes(value));
        let error = error_of(&bytes);
        assert!(error.contains(words) && error.contains("byte "), "{at} {value}: {error}");
    }
    for count in [i64::MAX, i64::MIN, 1 << 60] {
        let mut bytes = Bytes::new(4, false).tet();
        bytes[36..44].copy_from_slice(&count.to_le_bytes());
        assert!(error_of(&bytes).contains("vertices declared"));
    }
    assert!(error_of(b"\x02\0\0\0\x02\0\0\0").contains("check the format of the file"));
}

#[test]
fn damaged_bytes_never_panic() {
    for version in [1, 3] {
        let good = Bytes::new(version, false).tet();
        survives_changed_bytes(&MESHB, "in.meshb", &good, b"\0\x01\x7f\x80\xff");
    }
}

fn two_kinds() -> Mesh {
    let mut cells = Cells::new();
    cells.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
    cells.push(CellKind::TETRA, [0, 1, 2, 3].map(VertexId));
    Mesh::new(CORNERS.to_vec(), cells)
}

fn field(name: &str, components: usize, n: usize) -> Field {
    let values: Vec<f64> = (0..n * components).map(|i| i as f64 / 3.0 - 1.0).collect();
    Field { name: name.into(), components, values: values.into() }
}

fn write_to(folder: &Path, name: &str, mesh: &Mesh) -> Vec<String> {
    crate::io::write(folder.join(name), mesh, &WriteOptions::default()).unwrap()
}

fn read_from(folder: &Path, name: &str) -> (Mesh, Vec<String>) {
    crate::io::read_noted(folder.join(name)).unwrap()
}

#[test]
fn solutions_of_every_type_round_trip_in_both_forms() {
    let mut mesh = two_kinds();
    for (name, components) in [("medit:sol", 1), ("medit:sol_2", 3), ("medit:sol_3", 6), ("medit:sol_4", 9)] {
        mesh.set_point_field(field(name, components, 4));
        mesh.set_cell_field(field(name, components, 2));
    }
    let folder = tempfile::tempdir().unwrap();
    for names in [["a.mesh", "a.sol"], ["b.meshb", "b.solb"]] {
        for name in names {
            assert_eq!(write_to(folder.path(), name, &mesh), [""; 0]);
            for name in names {
                let (back, notes) = read_from(folder.path(), name);
                assert_eq!(back, mesh);
                assert!(notes.is_empty(), "{notes:?}");
            }
            names.iter().for_each(|name| std::fs::remove_file(folder.path().join(name)).unwrap());
        }
    }
}

#[test]
fn a_tensor_is_stored_by_rows_of_its_lower_triangle() {
    let mut mesh = Mesh::new(vec![[0.0; 3]], Cells::new());
    // xx yy zz xy yz xz
    mesh.set_point_field(Field {
        name: "t".into(),
        components: 6,
        values: vec![11.0, 22.0, 33.0, 12.0, 23.0, 13.0].into(),
    });
    let Written { files, lost } = write::solution(&mesh, false, &Threads::single()).unwrap();
    let text = String::from_utf8(files[0].1.clone()).unwrap();
    assert!(text.contains("SolAtVertices\n1\n1 3\n11.0 12.0 22.0 13.0 23.0 33.0\n"), "{text}");
    assert_eq!(lost, ["array names are not written (Medit solutions have none): t"]);
}

#[test]
fn two_dimensional_values_are_padded_with_zeros() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    put("a.mesh", "MeshVersionFormatted 2 Dimension 2 Vertices 1 5 6 0 End");
    put(
        "a.sol",
        "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n1\n4 1 2 3 4\n9 1 2 11 12 22 1 2 3 4\nEnd\n",
    );
    let (mesh, notes) = read_from(folder.path(), "a.mesh");
    assert!(notes.is_empty(), "{notes:?}");
    let values: Vec<_> = mesh.point_data.iter().map(|f| f.values.to_f64().unwrap()).collect();
    assert_eq!(values[0], [9.0]);
    assert_eq!(values[1], [1.0, 2.0, 0.0]);
    assert_eq!(values[2], [11.0, 22.0, 0.0, 12.0, 0.0, 0.0]);
    assert_eq!(values[3], [1.0, 2.0, 0.0, 3.0, 4.0, 0.0, 0.0, 0.0, 0.0]);
}

#[test]
fn only_solution_arrays_are_written_beside_a_mesh() {
    let mut mesh = two_kinds();
    mesh.set_point_field(field("pressure", 1, 4));
    mesh.set_cell_field(field("pair", 2, 2));
    mesh.set_point_field(Field::scalars("n", vec![1i32; 4]));
    let Written { files, lost } = write::mesh(&mesh, false, &Threads::single()).unwrap();
    assert_eq!(files.len(), 1);
    assert!(lost.iter().any(|l| l.contains("pressure, n")) && lost.iter().any(|l| l.contains(".solb")));
    let Written { files, lost } = write::solution(&mesh, true, &Threads::single()).unwrap();
    assert_eq!(files.iter().map(|f| f.0.as_str()).collect::<Vec<_>>(), ["", ".meshb"]);
    assert!(lost.iter().any(|l| l == "cell arrays are not written (Medit has none): pair"), "{lost:?}");
    assert!(lost.iter().any(|l| l == "point arrays are not written (Medit has none): n"), "{lost:?}");
    mesh.point_data.clear();
    assert!(
        write::solution(&mesh, true, &Threads::single())
            .unwrap_err()
            .to_string()
            .contains("no real-valued array")
    );
}

#[test]
fn kinds_without_values_have_no_solution_section() {
    let mut mesh = two_kinds();
    mesh.set_cell_field(Field::scalars("medit:sol", vec![f64::NAN, 2.5]));
    let folder = tempfile::tempdir().unwrap();
    assert!(write_to(folder.path(), "a.mesh", &mesh).is_empty());
    let text = std::fs::read_to_string(folder.path().join("a.sol")).unwrap();
    assert!(!text.contains("SolAtTriangles") && text.contains("SolAtTetrahedra\n1\n1 1\n2.5\n"), "{text}");
    let values =
        read_from(folder.path(), "a.mesh").0.cell_field("medit:sol").unwrap().values.to_f64().unwrap();
    assert!(values[0].is_nan() && values[1] == 2.5);
}

#[test]
fn a_solution_that_does_not_fit_is_skipped_with_the_mesh_and_refused_on_its_own() {
    let folder = tempfile::tempdir().unwrap();
    write_to(folder.path(), "a.mesh", &two_kinds());
    let put = |text: &str| std::fs::write(folder.path().join("a.sol"), text).unwrap();
    let head = "MeshVersionFormatted 2\nDimension 3\n";
    put(&format!("{head}SolAtVertices\n3\n1 1\n1 2 3\nEnd\n"));
    let (mesh, notes) = read_from(folder.path(), "a.mesh");
    assert!(mesh.point_data.is_empty());
    assert_eq!(notes, ["a.sol is skipped: it has 3 values on Vertices, but the mesh has 4"]);
    let error = crate::io::read(folder.path().join("a.sol")).unwrap_err().to_string();
    assert!(
        error.contains("has 3 values on Vertices") && error.contains("do not belong together"),
        "{error}"
    );
    put("TITLE = \"some other program's\"\n");
    let (_, notes) = read_from(folder.path(), "a.mesh");
    assert_eq!(notes, ["a.sol is skipped: it is not a Medit solution"]);
    // A damaged solution is reported even if only the mesh was named.
    for (text, words) in [
        ("SolAtVertices\n4\n1 5\n1 2 3 4\nEnd\n", "expected an array type from 1 to 4, found 5"),
        ("SolAtVertices\n4\n1 1\n1 2 3\nEnd\n", "found `End`"),
        ("SolAtVertices\n4\n1 1\n1 2 3", "4 rows of 1 values declared"),
        ("SolAtVertices\n4\n99999999999 1\n", "expected 0 to 1000 arrays in a section, found 99999999999"),
        ("SolAtVertices\n4\n1001 1 1\n", "arrays in a section, found 1001"),
        ("SolAtVertices\n9999999999999\n1 1\n", "rows of a solution declared"),
        ("SolAtVertices\n40000\n1 4\n1 2", "rows of a solution declared"),
    ] {
        put(&format!("{head}{text}"));
        for name in ["a.mesh", "a.sol"] {
            let error = crate::io::read(folder.path().join(name)).unwrap_err().to_string();
            assert!(error.contains(words) && error.contains("a.sol"), "{error}");
        }
    }
    put(&format!("{head}End\n"));
    assert!(crate::io::read(folder.path().join("a.sol")).unwrap_err().to_string().contains("no solution"));
    std::fs::remove_file(folder.path().join("a.mesh")).unwrap();
    put(&format!("{head}SolAtVertices\n1\n1 1\n1\nEnd\n"));
    assert!(
        crate::io::read(folder.path().join("a.sol")).unwrap_err().to_string().contains("no mesh of the same")
    );
}

#[test]
fn truncated_binary_solutions_are_reported() {
    let mut mesh = two_kinds();
    mesh.set_point_field(field("medit:sol", 6, 4));
    let Written { files, .. } = write::solution(&mesh, true, &Threads::single()).unwrap();
    for n in 0..files[0].1.len() - 4 {
        let notes = Notes::default();
        let content = content::Content::read(&files[0].1[..n], &notes);
        assert!(content.is_err() || notes.into_vec().iter().any(|n| n.contains("`End` is missing")), "{n}");
    }
}

#[test]
fn marks_without_a_section_are_reported() {
    let mut mesh = two_kinds();
    mesh.set_cell_field(Field::scalars(RIDGE, vec![1u8, 0]));
    mesh.set_cell_field(Field::scalars(REQUIRED, vec![1u8, 1]));
    let ridge = "medit:ridge of 1 Triangles is not written: there is no section for it";
    assert_eq!(write::mesh(&mesh, false, &Threads::single()).unwrap().lost, [ridge]);
    let required = "medit:required of 1 Tetrahedra is not written: there is no section for it";
    assert_eq!(write::mesh(&mesh, true, &Threads::single()).unwrap().lost, [ridge, required]);
}
