use std::path::Path;

use super::*;
use crate::base::{Threads, VertexId};
use crate::io::WriteOptions;
use crate::io::in_memory::{parsed, printed_text};
use crate::mesh::{CellKind, Cells, Field, Mesh};

fn parse(text: &str) -> (Mesh, Vec<String>) {
    let (mesh, notes) = parsed(&FORMAT, "in.inp", text.as_bytes());
    (mesh.unwrap(), notes)
}

fn error_of(text: &str) -> String {
    parsed(&FORMAT, "in.inp", text.as_bytes()).0.unwrap_err().to_string()
}

fn print(mesh: &Mesh) -> (String, Vec<String>) {
    printed_text(&FORMAT, mesh)
}

fn ids(mesh: &Mesh, array: &str) -> Vec<i64> {
    mesh.cell_field(array).unwrap().values.to_i64().unwrap()
}

/// Two tets with a section each and a shell on one of them, with gaps in the numbering.
const FLAT: &str = "\
*Heading
 two tets, and a shell
** a comment
*Node, nset=All nodes
  100,  0., 0, 0.0
  7, 1.0, 0., 0.
  20,  0., 1.D0,
  3000000000, 0., 0., 1.
  9, 1., 1., 1.
*ELEMENT , type = c3d4 ,
 elset=Soft
  5,  100, 7, 20,
  3000000000
*element, TYPE=C3D4H, ELSET=Hard
  900, 7, 20, 3000000000, 9
*Element, type=S3R, elset=lid
  33, 7, 20, 9
*Elset, elset=every, generate
  1, 1000, 1
*Nset, nset=ends
  100, 9,
*Nset, nset=of_soft, elset=Soft
*Surface, name=floor, type=ELEMENT
  Soft, S1
*Surface, name=roof
  33, SPOS
  5, S9999
";

fn flat() -> String {
    FLAT.replace("  5, S9999\n", "")
}

#[test]
fn a_flat_file_is_read_in_any_spelling() {
    let (mesh, notes) = parse(&flat());
    assert_eq!(notes, ["set every refers to nonexistent elements: 997"]);
    assert_eq!(mesh.points[2..], [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]]);
    assert_eq!(
        mesh.cells.kinds(),
        [CellKind::TETRA, CellKind::TETRA, CellKind::TRIANGLE, CellKind::TRIANGLE]
    );
    assert_eq!(mesh.cells.connectivity().list(0), [0, 1, 2, 3].map(VertexId));
    assert_eq!(mesh.cells.connectivity().list(1), [1, 2, 3, 4].map(VertexId));
    // S1 of a tet is its first three nodes; seen from outside they run the other way around.
    assert_eq!(mesh.cells.connectivity().list(3), [0, 2, 1].map(VertexId));
    // `every`, a set of all cells, carries the least information and is not chosen.
    assert_eq!(ids(&mesh, "region"), [1, 2, 0, 0]);
    assert_eq!(mesh.label_names.regions.values().collect::<Vec<_>>(), ["Soft", "Hard"]);
    assert_eq!(ids(&mesh, "patch"), [0, 0, 1, 2]);
    // Of two sets of all surface cells, the one declared with its own keyword is taken.
    assert_eq!(mesh.label_names.patches.values().collect::<Vec<_>>(), ["every", "floor"]);
    assert_eq!(ids(&mesh, "elset:every"), [1, 1, 1, 0]);
    assert_eq!(ids(&mesh, "elset:lid"), [0, 0, 1, 0]);
    assert_eq!(ids(&mesh, "surface:roof"), [0, 0, 1, 0]);
    let nodes = |name: &str| mesh.point_field(name).unwrap().values.to_i64().unwrap();
    assert_eq!(nodes("nset:Allnodes"), [1; 5]);
    assert_eq!(nodes("nset:ends"), [1, 0, 0, 0, 1]);
    assert_eq!(nodes("nset:of_soft"), [1, 1, 1, 1, 0]);
}

#[test]
fn skipped_content_is_reported() {
    assert!(
        error_of(FLAT).contains("refers to face `S9999` of a solid with faces S1 to S4"),
        "{}",
        error_of(FLAT)
    );
    let text = flat()
        + "*Element, type=MASS, elset=m\n77, 9\n*Material, name=steel\n*Elastic\n1.,2.\n*Surface, name=s, type=NODE\nends\n\
           *Surface, name=e\n33, E1\n77, \n*Elset, elset=gone\n33, 78\n*Nset, nset=_x, internal\n9\n\
           *Element, type=B31\n40, 7, 20, 9\n";
    let (mesh, notes) = parse(&text);
    assert_eq!(mesh.cells.kinds()[3], CellKind::LINE);
    let expected = [
        "elements of type MASS are skipped: motet has no such cell kind",
        "surface s is skipped: it is not made of element faces",
        "orientation nodes of beams are skipped",
        "keywords that do not describe the mesh are skipped: *ELASTIC, *MATERIAL",
        "set every refers to nonexistent elements: 996",
        "set gone refers to nonexistent elements: 1",
        "surface e: edges and ends are skipped, faces are kept",
        "surface e refers to nonexistent elements",
        "sets for internal use by the preprocessor are skipped: 1",
    ];
    for note in expected {
        assert!(notes.iter().any(|n| n == note), "{note}: {notes:?}");
    }
    assert_eq!(notes.len(), expected.len(), "{notes:?}");
}

#[test]
fn labels_are_disjoint_sets_those_with_sections_first() {
    let head = "*NODE\n1\n2,1\n3,0,1\n4,0,0,1\n5,1,1,1\n*ELEMENT,TYPE=C3D4,ELSET=A\n1,1,2,3,4\n*ELEMENT,TYPE=C3D4,ELSET=B\n2,2,3,4,5\n3,1,3,4,5\n";
    let regions = |tail: &str| {
        let mesh = parse(&format!("{head}{tail}")).0;
        (ids(&mesh, "region"), mesh.label_names.regions.into_values().collect::<Vec<_>>())
    };
    let names = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>();
    assert_eq!(regions(""), (vec![1, 2, 2], names(&["A", "B"])));
    // A set for a load covers fewer cells.
    assert_eq!(regions("*ELSET,ELSET=load\n2\n"), (vec![1, 2, 2], names(&["A", "B"])));
    assert_eq!(regions("*ELSET,ELSET=c\n1,2\n*ELSET,ELSET=d\n3\n"), (vec![1, 1, 2], names(&["c", "d"])));
    assert_eq!(regions("*ELSET,ELSET=all\nA,B\n"), (vec![1, 2, 2], names(&["A", "B"])));
    let sections = "*ELSET,ELSET=_s,INTERNAL\nB,A\n*SOLID SECTION,ELSET=_s,MATERIAL=m\n";
    assert_eq!(regions(sections), (vec![1, 1, 1], names(&["_s"])));
    // One of two overlapping sets becomes an array.
    let mesh = parse(&format!("{head}*ELSET,ELSET=c\n1,2\n*ELSET,ELSET=d\n2,3\n*ELSET,ELSET=e\n3\n")).0;
    assert_eq!(ids(&mesh, "region"), [1, 1, 2]);
    assert_eq!(ids(&mesh, "elset:d"), [0, 1, 1]);
    assert!(mesh.cell_field("elset:e").is_none() && mesh.cell_field("elset:A").is_some());
}

const PARTS: &str = "\
*Part, name=bar
*Node
1, 0., 0., 0.
2, 1., 0., 0.
3, 0., 1., 0.
4, 0., 0., 1.
*Element, type=C3D4, elset=body
1, 1, 2, 3, 4
*Nset, nset=tip
4
*End Part
*Assembly, name=a
*Instance, name=One, part=BAR
*End Instance
*Instance, name=Two, part=bar
10., 0., 0.
10., 0., 0., 10., 0., 1., 90.
*End Instance
*Node
1, 5., 5., 5.
*Nset, nset=ref
1,
*Nset, nset=mixed
One.2, Two.tip
*Elset, elset=_f, internal, instance=Two
1
*Surface, type=ELEMENT, name=face
_f, S3
One.body, S1
*End Assembly
";

#[test]
fn instances_are_placed_by_translation_and_rotation() {
    let (mesh, notes) = parse(PARTS);
    assert_eq!(notes, ["sets for internal use by the preprocessor are skipped: 1"]);
    assert_eq!(mesh.points.len(), 9);
    for (point, expected) in
        mesh.points[4..].iter().zip([[10.0, 0.0, 0.0], [10.0, 1.0, 0.0], [9.0, 0.0, 0.0]])
    {
        assert!(point.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{point:?}");
    }
    assert_eq!(mesh.points[8], [5.0; 3]);
    assert_eq!(ids(&mesh, "region"), [1, 2, 0, 0]);
    assert_eq!(mesh.label_names.regions.values().collect::<Vec<_>>(), ["One.body", "Two.body"]);
    assert_eq!(ids(&mesh, "patch"), [0, 0, 1, 1]);
    assert_eq!(mesh.label_names.patches[&1], "face");
    // S3 of a tet has nodes 2, 4, 3.
    assert_eq!(mesh.cells.connectivity().list(2), [5, 6, 7].map(VertexId));
    let nodes = |name: &str| mesh.point_field(name).unwrap().values.to_i64().unwrap();
    assert_eq!(nodes("nset:ref"), [0, 0, 0, 0, 0, 0, 0, 0, 1]);
    assert_eq!(nodes("nset:mixed"), [0, 1, 0, 0, 0, 0, 0, 1, 0]);
    assert_eq!(nodes("nset:Two.tip"), [0, 0, 0, 0, 0, 0, 0, 1, 0]);
    // A part without an instance is used as it is, and a single instance needs no name prefix.
    let alone = &PARTS[..PARTS.find("*Assembly").unwrap()];
    assert_eq!(parse(alone).0.label_names.regions[&1], "body");
    assert!(
        error_of(&PARTS.replace("part=BAR", "part=none"))
            .contains("part `none`, which is not defined before it")
    );
    assert!(error_of(&PARTS.replace("name=Two", "name=one")).contains("duplicate instance name `one`"));
    assert!(error_of(&PARTS.replace("One.2", "Three.2")).contains("instance `THREE` is not defined"));
    assert!(error_of(&PARTS.replace("10., 0., 1., 90.", "10., 0., 0., 90.")).contains("coincide"));
}

#[test]
fn too_many_copies_are_refused() {
    let nodes: String = (1..1000).map(|i| format!("{i},{i}\n")).collect();
    let instances: String = (0..60_000).map(|i| format!("*INSTANCE,NAME=i{i},PART=p\n")).collect();
    let error = error_of(&format!("*PART,NAME=p\n*NODE\n{nodes}*END PART\n{instances}"));
    assert!(error.contains("take more than"), "{error}");
}

#[test]
fn faces_of_solids_match_the_manual() {
    // Corners of the unit cube in the order of C3D8; the wedge and the pyramid use some of them.
    let nodes = "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n";
    for (element, faces) in [
        ("C3D8\n1,1,2,3,4,5,6,7,8", &["1234", "5678", "1256", "2367", "3478", "1458"][..]),
        ("C3D6\n1,1,2,3,5,6,7", &["123", "567", "1256", "2367", "1357"]),
        ("C3D5\n1,1,2,3,4,5", &["1234", "125", "235", "345", "145"]),
        ("C3D4\n1,1,2,4,5", &["124", "125", "245", "145"]),
    ] {
        for (face, number) in faces.iter().zip(1..) {
            let text = format!("{nodes}*ELEMENT,TYPE={element}\n*SURFACE,NAME=f\n1,S{number}\n");
            let (mesh, _) = parse(&text);
            let mut found: Vec<u32> = mesh.cells.connectivity().list(1).iter().map(|v| v.0 + 1).collect();
            found.sort_unstable();
            let found: String = found.iter().map(u32::to_string).collect();
            assert_eq!(found, *face, "{element} S{number}");
        }
        let all =
            parse(&format!("{nodes}*ELEMENT,TYPE={element}\n*ELSET,ELSET=a\n1\n*SURFACE,NAME=f\na,\n")).0;
        assert_eq!(all.cells.len(), 1 + faces.len());
    }
}

#[test]
fn elements_with_many_nodes_continue_over_lines() {
    let nodes: String = (1..=20).map(|i| format!("{i}, {i}.\n")).collect();
    let text = format!(
        "*NODE\n{nodes}*ELEMENT, TYPE=C3D20R\n1, 1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,\n** between\n16,17,18,19,20\n2, 20,19,18,17,16,15,14,13,12,11,10,9,8\n7,6,5,4,3,2,1\n*ELEMENT,TYPE=B32\n3, 1,2,3\n"
    );
    let mesh = parse(&text).0;
    assert_eq!(mesh.cells.kinds()[..2], [CellKind::QUADRATIC_HEXAHEDRON; 2]);
    assert_eq!(mesh.cells.connectivity().list(0), std::array::from_fn::<_, 20, _>(|i| VertexId(i as u32)));
    // Abaqus numbers the nodes from end to end; VTK puts the middle node last.
    assert_eq!(mesh.cells.connectivity().list(2), [0, 2, 1].map(VertexId));
    let error = error_of(&text.replace(",19,20\n2", ",19,20,21\n2"));
    assert!(error.contains("element 1 of type C3D20R: expected 20 nodes, found 21"), "{error}");
    assert!(error.contains("line 25"), "{error}");
    let error = error_of(&text.replace("7,6,5,4,3,2,1\n", ""));
    assert!(error.contains("element 2 of type C3D20R: expected 20 nodes, found 13"), "{error}");
}

fn write_files(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::create_dir_all(folder.path().join(name).parent().unwrap()).unwrap();
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

#[test]
fn included_files_replace_their_include_lines() {
    let folder = write_files(&[
        (
            "a.inp",
            "*NODE\n*INCLUDE, INPUT=sub/nodes.txt\n4,0.,0.,1.\n*ELEMENT,TYPE=C3D4,INPUT=tets.txt\n2,1,2,4,3\n",
        ),
        ("sub/nodes.txt", "1,0.,0.,0.\n*INCLUDE,INPUT=\"more.txt\"\n"),
        ("sub/more.txt", "2,1.,0.,0.\n3,0.,1.,0.\n"),
        ("tets.txt", "1,1,2,3,4\n"),
        ("loop.inp", "*INCLUDE,INPUT=sub/back.txt\n"),
        ("sub/back.txt", "*INCLUDE,INPUT=../loop.inp\n"),
        ("none.inp", "*INCLUDE,INPUT=nothing.txt\n"),
        ("folder.inp", "*INCLUDE,INPUT=sub\n"),
        ("bad.inp", "*INCLUDE,INPUT=bad.txt\n"),
        ("bad.txt", "*NODE\n1,x\n"),
    ]);
    let read = |name: &str| crate::io::read(folder.path().join(name));
    let mesh = read("a.inp").unwrap();
    assert_eq!((mesh.points.len(), mesh.cells.len()), (4, 2));
    let error = |name: &str| read(name).unwrap_err().to_string();
    assert!(error("loop.inp").contains("back.txt: line 1: included file `../loop.inp` includes itself"));
    assert!(error("none.inp").contains("none.inp: line 1: included file `nothing.txt` cannot be read"));
    assert!(error("folder.inp").contains("is not a regular file"));
    assert!(error("bad.inp").contains("bad.txt: line 2: node coordinate: expected a number, found `x`"));
}

#[test]
fn too_many_nested_includes_are_refused() {
    let names: Vec<String> = (0..20).map(|i| format!("f{i}.inp")).collect();
    let texts: Vec<String> = (1..21).map(|i| format!("*INCLUDE,INPUT=f{i}.inp\n").repeat(10)).collect();
    let files: Vec<(&str, &str)> = names.iter().zip(&texts).map(|(n, t)| (n.as_str(), t.as_str())).collect();
    let folder = write_files(&files);
    let error = crate::io::read(folder.path().join("f0.inp")).unwrap_err().to_string();
    assert!(error.contains("too many"), "{error}");
    let shallow =
        write_files(&[("a.inp", &"*INCLUDE,INPUT=b.inp\n".repeat(10_001)), ("b.inp", "** nothing\n")]);
    let error = crate::io::read(shallow.path().join("a.inp")).unwrap_err().to_string();
    assert!(error.contains("too many"), "{error}");
}

#[test]
fn errors_report_their_line() {
    for (text, words) in [
        ("1 2 3\n", "line 1: data line before the first keyword"),
        ("*HEADING\n", "there are no nodes"),
        ("*NODE\n1,0\n1,1\n", "node 1 occurs twice"),
        ("*NODE\n0,0\n", "line 2: 0 is not a valid node or element number"),
        ("*NODE\n-1,0\n", "-1 is not a valid node or element number"),
        ("*NODE\n1.5,0\n", "expected a whole number, found `1.5`"),
        ("*NODE,SYSTEM=C\n1,0\n", "line 1: nodes in coordinate system `C`"),
        ("*NODE\n1,1e999\n", "line 2: node coordinate: expected a number, found `1e999`"),
        ("*NODE\n1\n*ELEMENT\n1,1\n", "line 3: *ELEMENT has no parameter TYPE"),
        ("*NODE\n1\n*ELEMENT,TYPE=T3D2\n1,1,2\n", "element 1 refers to node 2, which does not exist"),
        ("*NODE\n1\n2\n*ELEMENT,TYPE=T3D2\n1,1,2\n1,2,1\n", "element 1 occurs twice"),
        (
            "*NODE\n1\n*ELEMENT,TYPE=T3D2\n1,1\n*NSET,NSET=a\n1\n",
            "line 5: element 1 of type T3D2: expected 2 nodes, found 1",
        ),
        ("*NODE\n1\n*ELEMENT,TYPE=T3D2\n1,1,1,1\n", "expected 2 nodes, found 3"),
        ("*NODE\n1\n*ELEMENT,TYPE=T3D2\n1,,1\n", "found ``"),
        ("*NODE\n1\n*NSET,NSET=a,GENERATE\n1\n", "(first, last, step), found 1"),
        (
            "*NODE\n1\n*NSET,NSET=a,GENERATE\n3,1\n",
            "range of a set: the first number, 3, is greater than the last, 1",
        ),
        ("*NODE\n1\n*NSET,NSET=a,GENERATE\n1,3,0\n", "0 is not a valid node or element number"),
        ("*NODE\n1\n*NSET,NSET=a\nb\n*NSET,NSET=b\n1\n", "line 4: set `b` is used before its definition"),
        ("*NODE\n1\n*NSET,NSET=a,ELSET=b\n", "set `B` is not defined"),
        ("*NODE\n1\n*SURFACE,NAME=a\nb,S1\n", "set `B` is not defined"),
        ("*NODE\n1\n*NGEN\n1,9\n", "line 3: *NGEN generates or moves nodes"),
        ("*PART,NAME=a\n*PART,NAME=A\n", "duplicate part name `A`"),
    ] {
        let error = error_of(text);
        assert!(error.contains(words), "{text:?}: {error}");
    }
    // However large its stated end, a range holds only the nodes that exist.
    let mesh = parse("*NODE\n1\n5\n*NSET,NSET=a,GENERATE\n1,9223372036854775807,4\n").0;
    assert_eq!(mesh.point_field("nset:a").unwrap().values, vec![1u8, 1].into());
}

#[test]
fn truncated_and_damaged_files_never_panic() {
    for text in [flat(), PARTS.to_owned()] {
        let bytes = text.as_bytes();
        let check = |bytes: &[u8]| {
            if let Ok(mesh) = parsed(&FORMAT, Path::new("in.inp"), bytes).0 {
                mesh.validate().unwrap();
                let again = FORMAT.to_files(&mesh, &WriteOptions::default(), &Threads::single()).unwrap();
                parsed(&FORMAT, Path::new("in.inp"), &again.files[0].1).0.unwrap();
            }
        };
        (0..bytes.len()).for_each(|n| check(&bytes[..n]));
        for at in 0..bytes.len() {
            for value in [b'*', b',', b'\n', b'9', b'.', b'"', b'-', 0, 0xff] {
                let mut damaged = bytes.to_vec();
                damaged[at] = value;
                check(&damaged);
            }
        }
    }
}

/// Two tets with a triangle between them and one on the outside.
fn labelled() -> Mesh {
    let mut cells = Cells::new();
    cells.push(CellKind::TETRA, [0, 1, 2, 3].map(VertexId));
    cells.push(CellKind::TRIANGLE, [3, 2, 1].map(VertexId));
    cells.push(CellKind::TETRA, [1, 2, 3, 4].map(VertexId));
    cells.push(CellKind::TRIANGLE, [0, 2, 1].map(VertexId));
    cells.push(CellKind::LINE, [0, 4].map(VertexId));
    let points =
        [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 1.0 / 3.0, 0.0], [0.0, 0.0, 1e-300], [1.0, 1.0, -2.5e7]];
    let mut mesh = Mesh::new(points.to_vec(), cells);
    mesh.set_cell_field(Field::scalars("region", vec![2, 0, 1, 0, 0]));
    mesh.set_cell_field(Field::scalars("patch", vec![0, 4, 0, 1, 0]));
    mesh.label_names.regions.extend([(1, "blood".to_owned()), (2, "the wall".to_owned())]);
    mesh.label_names.patches.insert(1, "THE WALL".to_owned());
    mesh
}

#[test]
fn labels_and_sets_round_trip() {
    let mut mesh = labelled();
    mesh.set_cell_field(Field::scalars("elset:loaded", vec![1u8, 0, 0, 0, 1]));
    mesh.set_cell_field(Field::scalars("surface:both", vec![0u8, 1, 0, 1, 0]));
    mesh.set_point_field(Field::scalars("nset:fixed", vec![1u8, 0, 0, 0, 1]));
    mesh.set_point_field(Field::scalars("nset:none", vec![0u8; 5]));
    let (text, lost) = print(&mesh);
    assert_eq!(lost, [""; 0]);
    let (back, notes) = parse(&text);
    assert!(notes.is_empty(), "{notes:?}");
    assert_eq!(back, mesh, "{text}");
    // The triangle between the tets faces away from the second tet, of which it is S1.
    assert!(text.contains("*SURFACE, TYPE=ELEMENT, NAME=PATCH_4\n3, S1\n"), "{text}");
    assert!(text.contains("*SURFACE, TYPE=ELEMENT, NAME=\"THE WALL\"\n1, S1\n"), "{text}");
}

#[test]
fn losses_are_reported() {
    let mut mesh = labelled();
    mesh.set_point_field(Field::scalars("p", vec![0.5; 5]));
    mesh.set_point_field(Field::scalars("nset:two", vec![2u8; 5]));
    mesh.set_cell_field(Field::scalars("q", vec![1; 5]));
    mesh.set_cell_field(Field::scalars("elset:blood", vec![1u8, 1, 0, 0, 0]));
    mesh.set_cell_field(Field::scalars("surface:line", vec![0u8, 0, 0, 0, 1]));
    mesh.field_data.push(Field::scalars("t", vec![1.0]));
    mesh.label_names.patches.insert(4, "a \"b\"".to_owned());
    let lost = print(&mesh).1;
    assert_eq!(
        lost,
        [
            "numbers of patches are not kept: Abaqus identifies patches by name",
            "elset:blood is written as set blood_2: a label already has this name",
            "surface line is not written: not all its cells are faces of volume cells",
            "cell arrays are not written (Abaqus has none): q",
            "point arrays are not written (Abaqus has none): p, nset:two",
            "field arrays are not written (Abaqus has none): t",
            "the name \"a \\\"b\\\"\" is written as \"a 'b'\"",
        ]
    );
}

#[test]
fn labels_that_a_file_would_merge_are_reported() {
    let mut mesh = labelled();
    mesh.label_names.regions.insert(1, "the wall".into());
    mesh.label_names.patches.insert(4, "x".repeat(81));
    let lost = print(&mesh).1;
    assert!(lost.iter().any(|l| l == "regions with the same name are merged"), "{lost:?}");
    assert!(lost.iter().any(|l| l.ends_with("has more than 80 characters: Abaqus rejects it")), "{lost:?}");
}

#[test]
fn a_set_of_solids_and_curves_round_trips_as_a_label_and_an_array() {
    let mut mesh = labelled();
    mesh.set_cell_field(Field::scalars("elset:blood", vec![0u8, 0, 1, 0, 1]));
    let (text, lost) = print(&mesh);
    assert_eq!(lost, [""; 0]);
    assert!(text.contains("*ELSET, ELSET=blood\n3, 5\n"), "{text}");
    assert_eq!(parse(&text).0, mesh);
}
