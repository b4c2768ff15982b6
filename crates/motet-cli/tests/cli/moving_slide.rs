//! `motet move` with patches that slide, interfaces that are driven, motions that contradict each other;
//! `motet cap --flatten`.

use crate::common::{Folder, stderr, stdout};
use assert_cmd::assert::Assert;
use motet::Mesh;
use motet::base::{Point, VertexId};
use motet::geometry::vector::{add, cross, dot, norm, scale, sub};
use motet::io::read;
use motet::mesh::shapes::{Aneurysm, box_grid};
use motet::mesh::{CellKind, Cells, Field, Surface};
use serde_json::Value;

fn unit_box(n: usize) -> Mesh {
    box_grid([n; 3], [[0.0; 3], [1.0; 3]])
}

fn report(call: &Assert) -> Value {
    serde_json::from_str(&stdout(call)).expect("one object")
}

#[test]
fn a_piston_goes_down_between_sliding_sides_and_all_is_stretched_evenly() {
    let folder = Folder::new();
    let mesh = unit_box(4);
    folder.mesh("box.vtu", &mesh);
    let mut words = vec!["move", "box.vtu", "-o", "out.vtu", "--translate", "zmax=0,0,-0.4", "--json"];
    ["xmin", "xmax", "ymin", "ymax"].iter().for_each(|side| words.extend(["--slide", side]));
    let reported = report(&folder.motet(words).assert().code(0));
    assert_eq!(reported["complete"], true);
    let planes = reported["sliding"].as_array().unwrap();
    assert_eq!(planes.len(), 4);
    assert!(planes.iter().all(|plane| plane["deviation"] == 0.0 && plane["sliding"].as_u64() > Some(9)));
    let moved = read(folder.path("out.vtu")).unwrap();
    for (p, q) in mesh.points.iter().zip(&moved.points) {
        assert!(p[0] == q[0] && p[1] == q[1] && (q[2] - 0.6 * p[2]).abs() < 1e-15, "{p:?} {q:?}");
    }
}

#[test]
fn patches_that_share_an_edge_and_are_moved_apart_are_refused_with_the_place_and_what_to_do() {
    let folder = Folder::new();
    folder.mesh("box.vtu", &unit_box(3));
    let apart =
        ["move", "box.vtu", "-o", "out.vtu", "--translate", "zmax=0,0,0.1", "--translate", "xmax=0.1,0,0"];
    let call = folder.motet(apart).assert().code(2);
    for part in ["xmax", "vertex", "1.000000", "--slide", "--fixed"] {
        assert!(stderr(&call).contains(part), "{}", stderr(&call));
    }
    assert_eq!(folder.names(), ["box.vtu"]);
    // Patches with equal motions count as one; a patch kept in place takes precedence.
    let alike =
        ["move", "box.vtu", "-o", "out.vtu", "--translate", "zmax=0,0,0.1", "--translate", "xmax=0,0,0.1"];
    folder.motet(alike).assert().code(0);
    let fixed = ["move", "box.vtu", "-o", "out.vtu", "--translate", "zmax=0,0,0.1", "--fixed", "xmax"];
    folder.motet(fixed).assert().code(0);
}

/// A box in two regions that meet in the plane `x = 0.5`, with an array that shifts that plane inside.
fn with_interface() -> (Mesh, Vec<usize>) {
    let mut mesh = unit_box(4);
    let middle = |v: &[VertexId]| 0.25 * v.iter().map(|v| mesh.points[v.index()][0]).sum::<f64>();
    let region = |(_, kind, v): (_, CellKind, &[VertexId])| match kind.dim() {
        Some(3) => 1 + i32::from(middle(v) > 0.5),
        _ => 0,
    };
    let regions: Vec<i32> = mesh.cells.iter().map(region).collect();
    let is_outer = |p: &Point| p.iter().any(|&x| x == 0.0 || x == 1.0);
    let inside: Vec<usize> =
        (0..mesh.points.len()).filter(|&v| mesh.points[v][0] == 0.5 && !is_outer(&mesh.points[v])).collect();
    let mut u = vec![[0.0; 3]; mesh.points.len()];
    inside.iter().for_each(|&v| u[v] = [0.1, 0.0, 0.0]);
    mesh.set_cell_field(Field::scalars("region", regions));
    mesh.set_point_field(Field::vectors("u", &u));
    (mesh, inside)
}

#[test]
fn an_array_on_an_interface_alone_moves_it_and_the_report_says_so() {
    let folder = Folder::new();
    let (mesh, inside) = with_interface();
    folder.mesh("two.vtu", &mesh);
    let words = ["move", "two.vtu", "-o", "out.vtu", "--displacement", "u", "--json"];
    let reported = report(&folder.motet(words).assert().code(0));
    assert_eq!(reported["interfaces"].as_array().unwrap().len(), 1);
    assert_eq!(reported["interfaces"][0]["vertices"], 25);
    let moved = read(folder.path("out.vtu")).unwrap();
    for &v in &inside {
        assert_eq!(moved.points[v], add(mesh.points[v], [0.1, 0.0, 0.0]));
    }
}

#[test]
fn an_array_that_moves_nothing_is_reported() {
    let folder = Folder::new();
    let mut mesh = unit_box(4);
    let inner = mesh.points.iter().position(|p| *p == [0.25, 0.25, 0.5]).unwrap();
    let mut u = vec![[0.0; 3]; mesh.points.len()];
    u[inner] = [0.1; 3];
    mesh.set_point_field(Field::vectors("u", &u));
    folder.mesh("box.vtu", &mesh);
    let call = folder.motet(["move", "box.vtu", "-o", "out.vtu", "--displacement", "u"]).assert().code(0);
    assert!(stderr(&call).contains("nothing has moved"), "{}", stderr(&call));
}

#[test]
fn a_rim_that_leaves_its_plane_is_reported() {
    let folder = Folder::new();
    folder.mesh("box.vtu", &unit_box(3));
    let words = |by| ["move", "box.vtu", "-o", "out.vtu", "--translate", by, "--slide", "xmin"];
    let call = folder.motet(words("zmax=0,0.1,-0.2")).assert().code(0);
    assert!(!stderr(&call).contains("leaves its plane"), "{}", stderr(&call));
    let call = folder.motet(words("zmax=0.1,0,-0.2")).assert().code(0);
    assert!(stderr(&call).contains("sliding patch xmin leaves its plane, by 0.1"), "{}", stderr(&call));
    let reported =
        report(&folder.motet(words("zmax=0.1,0,-0.2").into_iter().chain(["--json"])).assert().code(0));
    let leaves = &reported["steps"][0]["leaves_plane"];
    assert_eq!((leaves["patch"].as_str(), leaves["distance"].as_f64()), (Some("xmin"), Some(0.1)));
}

/// Two boxes side by side, the second with half the edge length: its vertices hang on facets of the first.
fn hanging() -> Mesh {
    let [coarse, fine] =
        [(2, 0.0), (4, 1.0)].map(|(n, x)| box_grid([n; 3], [[x, 0.0, 0.0], [x + 1.0, 1.0, 1.0]]));
    let mut points = coarse.points.clone();
    let place = |p: &Point, points: &mut Vec<Point>| {
        VertexId::new(points.iter().position(|q| q == p).unwrap_or_else(|| {
            points.push(*p);
            points.len() - 1
        }))
    };
    let of_fine: Vec<VertexId> = fine.points.iter().map(|p| place(p, &mut points)).collect();
    let mut cells = Cells::new();
    coarse.cells.tets().for_each(|(_, tet)| cells.push(CellKind::TETRA, tet));
    fine.cells.tets().for_each(|(_, tet)| cells.push(CellKind::TETRA, tet.map(|v| of_fine[v.index()])));
    let bend = |p: &Point| [0.0, 0.0, if p[2] == 1.0 { 0.1 * p[1] * (1.0 - p[1]) } else { 0.0 }];
    let w: Vec<Point> = points.iter().map(bend).collect();
    let mut mesh = Mesh::new(points, cells);
    mesh.set_point_field(Field::vectors("w", &w));
    mesh
}

#[test]
fn hanging_vertices_and_how_far_the_mesh_opens_at_them_are_reported() {
    let folder = Folder::new();
    folder.mesh("hang.vtu", &hanging());
    let words = ["move", "hang.vtu", "-o", "out.vtu", "--displacement", "w"];
    let call = folder.motet(words).assert().code(0);
    assert!(stderr(&call).contains("hanging_vertex") && stderr(&call).contains("opens"), "{}", stderr(&call));
    let reported = report(&folder.motet(words.into_iter().chain(["--json"])).assert().code(0));
    // 25 vertices of the fine side minus the 9 that both have. The one below the middle of the upper edge
    // stays; the coarse edge that it lies on moves half as far as its upper end, 0.1 / 4. Along the upper
    // edge the parabola is 0.1 / 16 above its chords.
    assert_eq!(reported["hanging"]["vertices"], 16);
    let opening = reported["hanging"]["opening"].as_f64().unwrap();
    assert!((opening - 0.1 / 8.0).abs() < 1e-15, "{opening}");
}

#[test]
fn a_rim_that_was_cut_by_hand_is_capped_flat_and_slides() {
    let folder = Folder::new();
    let whole = Aneurysm::default().mesh().unwrap();
    let surface = Surface::of(&whole);
    let wall = whole.find_patch("wall").unwrap();
    let kept = surface.triangles.iter().zip(&surface.patches).filter(|(_, p)| **p == wall);
    let triangles: Vec<VertexId> = kept.flat_map(|(t, _)| *t).collect();
    let inlet = motet::motion::FacetSet::find(&whole, "inlet").unwrap();
    let rim: Vec<VertexId> = inlet.vertices.iter().copied().filter(|v| triangles.contains(v)).collect();
    let middle =
        scale(rim.iter().fold([0.0; 3], |sum, v| add(sum, whole.points[v.index()])), 1.0 / rim.len() as f64);
    let [a, b] = [0, rim.len() / 4].map(|i| sub(whole.points[rim[i].index()], middle));
    let (normal, radius) = (cross(a, b), norm(a));
    let normal = scale(normal, 1.0 / norm(normal));
    let mut open = Mesh::new(whole.points.clone(), Cells::uniform(CellKind::TRIANGLE, triangles).unwrap());
    for v in &rim {
        // A saddle over the rim.
        let along = dot(sub(whole.points[v.index()], middle), scale(a, 1.0 / norm(a))) / radius;
        let off = scale(normal, 0.1 * radius * (2.0 * along * along - 1.0));
        open.points[v.index()] = add(open.points[v.index()], off);
    }
    folder.mesh("open.vtp", &open);
    let call = folder.motet(["cap", "open.vtp", "-o", "flat.vtp", "--flatten", "--json"]).assert().code(0);
    let planes = report(&call)["planes"].clone();
    let worst =
        planes.as_array().unwrap().iter().map(|p| p["deviation"].as_f64().unwrap()).fold(0.0, f64::max);
    assert!(worst > 0.08 * radius && worst < 0.12 * radius, "{worst} {radius}");
    folder.motet(["cap", "open.vtp", "-o", "closed.vtp"]).assert().code(0);
    let closed = read(folder.path("closed.vtp")).unwrap();
    assert_eq!(closed.points[..open.points.len()], open.points, "the wall stays to the bit");
    for (surface, mesh) in [("flat.vtp", "flat.vtu"), ("closed.vtp", "closed.vtu")] {
        folder.motet(["mesh", surface, "-o", mesh]).assert().success();
    }
    let slide = |mesh, more: &[&'static str]| {
        let words = [
            "move",
            mesh,
            "-o",
            "out.vtu",
            "--translate",
            "wall=0,0,0",
            "--slide",
            "cap_1",
            "--slide",
            "cap_2",
        ];
        folder.motet(words.into_iter().chain(more.iter().copied()))
    };
    let reported = report(&slide("flat.vtu", &["--json"]).assert().code(0));
    for plane in reported["sliding"].as_array().unwrap() {
        assert!(plane["deviation"].as_f64().unwrap() < 1e-12 * plane["radius"].as_f64().unwrap(), "{plane}");
    }
    let call = slide("closed.vtu", &[]).assert().code(3);
    assert!(
        stderr(&call).contains("--slide-tolerance") && stderr(&call).contains("--flatten"),
        "{}",
        stderr(&call)
    );
    let call = slide("closed.vtu", &["--slide-tolerance", "0.15"]).assert().code(0);
    assert!(
        stdout(&call).contains("deviates from its plane") && stdout(&call).contains("keep their distances"),
        "{}",
        stdout(&call)
    );
    let (before, after) = (read(folder.path("closed.vtu")).unwrap(), read(folder.path("out.vtu")).unwrap());
    assert_eq!(before.points, after.points, "no motion is the identity");
    slide("closed.vtu", &["--slide-tolerance", "1.5"]).assert().code(2);
}
