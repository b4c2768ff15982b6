//! Hostile files: each gets exit status 3 and one message that names file, place and
//! remedy; never a panic. `cargo test -p motet-cli --test cli bad_input -- --nocapture`
//! prints the table.

use crate::common::{Folder, cube, data, stderr, stdout};
use motet::Mesh;
use motet::base::{CellId, VertexId};
use motet::mesh::{CellKind, Cells};

/// A file, the call that reads it (`FILE` stands for it), and the expected outcome.
struct Case {
    file: &'static str,
    bytes: Vec<u8>,
    call: &'static [&'static str],
    code: i32,
    /// Expected parts of the message, or of the result.
    says: &'static [&'static str],
}

const INFO: &[&str] = &["info", "FILE"];
const MOVE: &[&str] = &["move", "FILE", "-o", "out.vtu", "--affine", "1,0,0,0.1,0,1,0,0,0,0,1,0"];

fn bad(file: &'static str, bytes: impl AsRef<[u8]>, says: &'static [&'static str]) -> Case {
    Case { file, bytes: bytes.as_ref().to_vec(), call: INFO, code: 3, says }
}

/// A complete VTU file in text form, from its points and the connectivity, offsets and types of its cells.
fn vtu(
    n_points: &str,
    n_cells: &str,
    points: &str,
    connectivity: &str,
    offsets: &str,
    types: &str,
) -> String {
    format!(
        r#"<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="{n_points}" NumberOfCells="{n_cells}">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">{points}</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">{connectivity}</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">{offsets}</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">{types}</DataArray></Cells>
</Piece></UnstructuredGrid></VTKFile>"#
    )
}

const REMESH: &[&str] = &["remesh", "FILE", "-o", "out.vtu"];

const POINTS: &str = "0 0 0 1 0 0 0 1 0 0 0 1";
const HUGE: &str = "1152921504606846976";

fn written(name: &str, mesh: &Mesh) -> Vec<u8> {
    let folder = Folder::new();
    folder.mesh(name, mesh);
    folder.read(name)
}

fn truncated(name: &str) -> Vec<u8> {
    let bytes = written(name, &cube(4));
    bytes[..bytes.len() * 2 / 3].to_vec()
}

fn broken_vtu() -> Vec<Case> {
    vec![
        bad("empty.vtu", "", &["empty.vtu: "]),
        bad("zeros.vtu", [0u8; 4096], &["zeros.vtu: "]),
        bad("truncated.vtu", truncated("a.vtu"), &["truncated.vtu: "]),
        bad("html.vtu", "<!DOCTYPE html><html><body>404</body></html>", &["html.vtu: "]),
        bad("lfs_pointer.vtu", LFS_POINTER, &["lfs_pointer.vtu: ", "LFS"]),
        bad("surface_inside.vtu", "<VTKFile type=\"PolyData\"/>", &["surface_inside.vtu: "]),
        bad("huge_points.vtu", vtu(HUGE, "1", POINTS, "0 1 2 3", "4", "10"), &["huge_points.vtu: "]),
        bad("huge_cells.vtu", vtu("4", HUGE, POINTS, "0 1 2 3", "4", "10"), &["huge_cells.vtu: "]),
        bad("huge_offsets.vtu", vtu("4", "1", POINTS, "0 1 2 3", HUGE, "10"), &["huge_offsets.vtu: "]),
        bad("negative_count.vtu", vtu("-4", "1", POINTS, "0 1 2 3", "4", "10"), &["negative_count.vtu: "]),
        bad("beyond.vtu", vtu("4", "1", POINTS, "0 1 2 9", "4", "10"), &["beyond.vtu: cell 0: ", "point 9"]),
        bad("negative_id.vtu", vtu("4", "1", POINTS, "0 1 2 -3", "4", "10"), &["negative_id.vtu: "]),
        bad(
            "three_of_four.vtu",
            vtu("4", "1", POINTS, "0 1 2", "3", "10"),
            &["three_of_four.vtu: ", "4 vertices"],
        ),
        bad("falling.vtu", vtu("4", "2", POINTS, "0 1 2 3 0 1 2 3", "8 4", "10 10"), &["falling.vtu: "]),
        bad(
            "letters.vtu",
            vtu("4", "1", "0 0 zero 1 0 0 0 1 0 0 0 1", "0 1 2 3", "4", "10"),
            &["letters.vtu: "],
        ),
        bad("few_points.vtu", vtu("5", "1", POINTS, "0 1 2 3", "4", "10"), &["few_points.vtu: "]),
    ]
}

const LFS_POINTER: &str = "version https://git-lfs.github.com/spec/v1\n\
    oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n";

fn broken_others() -> Vec<Case> {
    vec![
        bad("empty.msh", "", &["empty.msh: "]),
        bad("truncated.msh", truncated("a.msh"), &["truncated.msh: "]),
        bad(
            "huge.msh",
            format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {HUGE} 1 {HUGE}\n"),
            &["huge.msh: "],
        ),
        bad(
            "huge2.msh",
            format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{HUGE}\n1 0 0 0\n$EndNodes\n"),
            &["huge2.msh: "],
        ),
        bad("empty.stl", "", &["empty.stl: "]),
        bad("lfs_pointer.stl", LFS_POINTER, &["lfs_pointer.stl: ", "LFS"]),
        bad("lying.stl", [&[0u8; 80][..], &u32::MAX.to_le_bytes()].concat(), &["lying.stl: "]),
        bad("truncated.vtp", b"<VTKFile type=\"PolyData\"><PolyData><Piece Num", &["truncated.vtp: "]),
        bad(
            "huge.vtk",
            format!(
                "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS {HUGE} double\n"
            ),
            &["huge.vtk: "],
        ),
        bad("empty.obj", "", &["empty.obj: "]),
        bad("beyond.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", &["beyond.obj: ", "9"]),
        bad(
            "huge.mesh",
            format!("MeshVersionFormatted 2\nDimension 3\nVertices\n{HUGE}\n0 0 0 1\n"),
            &["huge.mesh: "],
        ),
        bad("huge.node", format!("{HUGE} 3 0 0\n1 0 0 0\n"), &["huge.node: "]),
        bad(
            "half.xml",
            "<dolfin><mesh celltype=\"tetrahedron\" dim=\"3\"><vertices size=\"4\">",
            &["half.xml: "],
        ),
        bad("no_frame.pvd", "<VTKFile type=\"Collection\"/>", &["no_frame.pvd: "]),
    ]
}

/// Readable files that are not what `move` needs, or that have defects.
fn odd_meshes() -> Vec<Case> {
    let file =
        |file, mesh: &Mesh, call, code, says| Case { file, bytes: written(file, mesh), call, code, says };
    let mut triangle = Cells::new();
    triangle.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
    let surface = Mesh::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], triangle);
    let mut not_a_number = cube(2);
    not_a_number.points[13][1] = f64::NAN;
    let mut inverted = cube(2);
    inverted.points[13] = [1.9, 0.5, 0.5];
    let mut flat = cube(2);
    flat.points[13] = flat.points[12];
    let mut three_at_a_facet = cube(2);
    let tet = three_at_a_facet.cells.vertices(CellId(0)).to_vec();
    for x in [2.0, 3.0] {
        let apex = VertexId::new(three_at_a_facet.points.len());
        three_at_a_facet.points.push([x; 3]);
        three_at_a_facet.cells.push(CellKind::TETRA, [tet[0], tet[1], tet[2], apex]);
    }
    let mut twice_in_a_tet = cube(2);
    twice_in_a_tet.cells.push(CellKind::TETRA, [0, 1, 2, 2].map(VertexId));
    let mut orphan = cube(2);
    orphan.points.push([0.25, 0.3, 0.35]);
    let mut twice = cube(2);
    twice.points.push(twice.points[0]);
    vec![
        file("surface.vtu", &surface, MOVE, 3, &["surface.vtu: ", "volume"]),
        file("surface.stl", &surface, MOVE, 3, &["surface.stl: ", "volume"]),
        file("surface.vtp", &surface, INFO, 0, &["triangle"]),
        file("nothing.vtu", &Mesh::default(), MOVE, 3, &["nothing.vtu: "]),
        file("nothing2.vtu", &Mesh::default(), INFO, 0, &["0 points"]),
        file("nan.vtu", &not_a_number, MOVE, 3, &["nan.vtu: ", "13"]),
        file("nan2.vtu", &not_a_number, INFO, 0, &["finite"]),
        file("inverted.vtu", &inverted, INFO, 0, &["inverted"]),
        file("inverted_moved.vtu", &inverted, MOVE, 0, &["at first", "of the input are inverted or flat"]),
        file("flat.vtu", &flat, INFO, 0, &["flat"]),
        file("flat_moved.vtu", &flat, MOVE, 0, &["at first"]),
        file("orphan.vtu", &orphan, INFO, 0, &["orphan"]),
        file("orphan_moved.vtu", &orphan, MOVE, 0, &[]),
        file("twice.vtu", &twice, INFO, 0, &["duplicate"]),
        file("twice_moved.vtu", &twice, MOVE, 0, &[]),
        file("surface.vtp", &surface, REMESH, 3, &["surface.vtp: ", "no linear tetrahedra", "volume mesh"]),
        file("nothing_remeshed.vtu", &Mesh::default(), REMESH, 3, &["nothing_remeshed.vtu: "]),
        file("nan_remeshed.vtu", &not_a_number, REMESH, 3, &["nan_remeshed.vtu: cell ", "are not finite"]),
        file("inverted_remeshed.vtu", &inverted, REMESH, 0, &["inverted"]),
        file("flat_remeshed.vtu", &flat, REMESH, 0, &["inverted"]),
        file("orphan_remeshed.vtu", &orphan, REMESH, 0, &[]),
        file("three.vtu", &three_at_a_facet, REMESH, 3, &["three.vtu: cell 0: ", "share the facet"]),
        file("same.vtu", &twice_in_a_tet, REMESH, 3, &["same.vtu: cell 48: ", "distinct"]),
    ]
}

#[test]
fn hostile_files_are_refused_with_a_reason() {
    let cases = [broken_vtu(), broken_others(), odd_meshes()].concat_all();
    let mut faults = Vec::new();
    let mut table = String::from("| file | exit | message |\n|---|---|---|\n");
    for case in &cases {
        let folder = Folder::new();
        folder.write(case.file, &case.bytes);
        let words = case.call.iter().map(|w| if *w == "FILE" { case.file } else { w });
        let call = folder.motet(words).timeout(std::time::Duration::from_secs(60)).assert();
        let (code, err, out) = (call.get_output().status.code(), stderr(&call), stdout(&call));
        let defects: Vec<&str> = out.lines().filter_map(|line| line.trim().strip_prefix("- ")).collect();
        let defects = defects.join("<br>");
        let message = err.lines().next().unwrap_or(&defects);
        table += &format!("| {} ({}) | {} | {message} |\n", case.file, case.call[0], code.unwrap_or(-1));
        let mut fault =
            |what: String| faults.push(format!("{} ({}): {what}\n  {err}", case.file, case.call[0]));
        if code != Some(case.code) {
            fault(format!("exit {code:?}, expected {}", case.code));
        }
        for part in case.says.iter().filter(|part| !err.contains(**part) && !out.contains(**part)) {
            fault(format!("does not say `{part}`"));
        }
        if err.contains("panicked") {
            fault("a panic".into());
        }
        if case.code == 3 && (err.lines().count() != 1 || !err.starts_with("error: ")) {
            fault("not one message".into());
        }
        if case.code == 3 && !message.contains("; ") {
            fault("no remedy".into());
        }
        if case.code == 3 && folder.names() != [case.file] {
            fault(format!("left {:?}", folder.names()));
        }
    }
    println!("{table}");
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

trait ConcatAll<T> {
    fn concat_all(self) -> Vec<T>;
}

impl<T, const N: usize> ConcatAll<T> for [Vec<T>; N] {
    fn concat_all(self) -> Vec<T> {
        self.into_iter().flatten().collect()
    }
}

#[test]
fn hostile_surfaces_of_others_never_panic() {
    let Some(data) = data() else { return };
    let mut faults = Vec::new();
    let mut table = String::from("| file | exit | message |\n|---|---|---|\n");
    let entries = std::fs::read_dir(data.join("hostile_surfaces")).expect("the folder is readable");
    let mut files: Vec<_> = entries.map(|e| e.expect("an entry").path()).collect();
    files.sort();
    for file in files {
        let name = file.file_name().expect("a name").to_string_lossy().into_owned();
        let folder = Folder::new();
        let call = folder.motet([std::ffi::OsStr::new("info"), file.as_os_str()]).assert();
        let code = call.get_output().status.code();
        let err = stderr(&call).replace(&*file.to_string_lossy(), &name);
        table += &format!(
            "| {name} (info) | {} | {} |\n",
            code.unwrap_or(-1),
            err.lines().next().unwrap_or_default()
        );
        let no_mesh = name.contains("lfs_pointer") || name.contains("empty");
        if code != Some(if no_mesh { 3 } else { 0 }) || err.contains("panicked") {
            faults.push(format!("{name}: exit {code:?}: {err}"));
        }
        let moved = folder
            .motet(["move", &file.to_string_lossy(), "-o", "out.vtu", "--affine", "1,0,0,1,0,1,0,0,0,0,1,0"])
            .assert();
        if moved.get_output().status.code() != Some(3)
            || stderr(&moved).contains("panicked")
            || !folder.names().is_empty()
        {
            faults.push(format!("{name} (move): {:?}: {}", moved.get_output().status.code(), stderr(&moved)));
        }
        let remeshed = folder.motet(["remesh", &file.to_string_lossy(), "-o", "out.vtu"]).assert();
        if remeshed.get_output().status.code() != Some(3)
            || stderr(&remeshed).contains("panicked")
            || !folder.names().is_empty()
        {
            faults.push(format!("{name} (remesh): {}", stderr(&remeshed)));
        }
    }
    println!("{table}");
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}
