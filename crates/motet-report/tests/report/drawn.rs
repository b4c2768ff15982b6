//! What a page draws, unpacked again, is the mesh: for series whose cells change, in any order, however much
//! of them fits.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Read as _;
use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use motet::Mesh;
use motet::base::{Point, VertexId};
use motet::geometry::vector::{distance, dot, sub};
use motet::io::{SeriesWriter, WriteOptions};
use motet::mesh::shapes::{ball, box_grid, mixed, quadratic};
use motet::mesh::{CellKind, Cells, Field, Surface};
use motet_report::{InputReport, Options, write};
use proptest::prelude::*;
use serde_json::Value;

/// A page, and what its script reads from it.
struct Page {
    text: String,
    manifest: Value,
    report: InputReport,
}

/// One frame as the page draws it: points, triangles of the skin, volume cells by the ids of their points,
/// and their values.
struct Drawn {
    frame: usize,
    points: Vec<Point>,
    tolerance: f64,
    skin: Vec<Vec<u32>>,
    solids: Vec<Vec<u32>>,
    /// Triangles that bound the cells, facing outward or inward.
    facets: Vec<[u32; 3]>,
    planes: [Vec<f64>; 3],
    holds: Value,
    skin_values: BTreeMap<String, Vec<f64>>,
    solid_values: BTreeMap<String, Vec<f64>>,
}

impl Page {
    fn of(meshes: &[Mesh], budget: usize) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let input = series(folder.path(), meshes);
        let output = folder.path().join("page.html");
        let report = write(&[input], &Options { budget, ..Options::new(&output) }).expect("a page");
        let text = fs::read_to_string(output).expect("it is there");
        let manifest = serde_json::from_str(between(&text, "id=\"manifest\">")).expect("JSON");
        Self { text, manifest, report: report.inputs[0].clone() }
    }

    fn frames(&self) -> impl Iterator<Item = Drawn> + '_ {
        let frames = self.manifest["inputs"][0]["frames"].as_array().expect("frames");
        frames.iter().map(|frame| self.drawn(frame))
    }

    /// Does what `script/unpack.js` and `script/geometry.js` do.
    fn drawn(&self, frame: &Value) -> Drawn {
        let (skin, inside) = (&frame["skin"], &frame["inside"]);
        let triple = |value: &Value| [0, 1, 2].map(|i| value[i].as_f64().expect("a number"));
        let (low, step) = (triple(&skin["low"]), triple(&skin["step"]));
        let place = |row: &[u32]| [0, 1, 2].map(|i| low[i] + step[i] * f64::from(row[i]));
        let mut points: Vec<Point> = self.rows(&skin["points"]).iter().map(|row| place(row)).collect();
        let has_inside = !inside.is_null();
        if has_inside {
            points.extend(self.rows(&inside["points"]).iter().map(|row| place(row)));
        }
        let (mut solids, mut facets) = (Vec::new(), Vec::new());
        if has_inside && inside["tets"].is_u64() {
            solids = self.rows(&inside["tets"]);
        } else if has_inside {
            let counts = self.rows(&inside["facets"][0]);
            let mut triangles = self.rows(&inside["facets"][1]).into_iter();
            for count in counts {
                let own: Vec<Vec<u32>> = triangles.by_ref().take(count[0] as usize).collect();
                facets.extend(own.iter().map(|t| [t[0], t[1], t[2]]));
                solids.push(own.into_iter().flatten().collect());
            }
        }
        let planes = [0, 1, 2].map(|axis| {
            let planes = inside["planes"][axis].as_array().cloned().unwrap_or_default();
            planes.iter().map(|x| x.as_f64().expect("a number")).collect()
        });
        Drawn {
            frame: frame["frame"].as_u64().expect("a number") as usize,
            points,
            tolerance: step.into_iter().fold(0.0, f64::max),
            skin: self.rows(&skin["triangles"]),
            solids,
            facets,
            planes,
            holds: inside["holds"].clone(),
            skin_values: self.values(&skin["values"]),
            solid_values: self.values(&inside["values"]),
        }
    }

    fn values(&self, values: &Value) -> BTreeMap<String, Vec<f64>> {
        let keys = &self.manifest["inputs"][0]["arrays"];
        let number = |value: &Value, name: &str| value[name].as_f64().expect("a number");
        let of_array = |(id, value): (&String, &Value)| {
            let key = &keys[id.parse::<usize>().expect("a place")];
            let numbers = self.rows(&value["block"]);
            let number = |row: &Vec<u32>| match row[0] {
                65_535 => f64::NAN,
                code => number(value, "low") + number(value, "step") * f64::from(code),
            };
            (key["name"].as_str().expect("a name").to_owned(), numbers.iter().map(number).collect())
        };
        values.as_object().into_iter().flatten().map(of_array).collect()
    }

    fn rows(&self, block: &Value) -> Vec<Vec<u32>> {
        let id = self.manifest["ids"][block.to_string()].as_u64().expect("a block");
        let facts = &self.manifest["blocks"][id as usize];
        let [rows, columns, planes] = [0, 1, 2].map(|i| facts[i].as_u64().expect("a count") as usize);
        let packed = STANDARD.decode(between(&self.text, &format!("id=\"b{id}\">"))).expect("base64");
        let mut bytes = Vec::new();
        flate2::read::ZlibDecoder::new(&packed[..]).read_to_end(&mut bytes).expect("zlib");
        let mut out = vec![vec![0u32; columns]; rows];
        for column in 0..columns {
            let mut above = 0u32;
            for row in 0..rows {
                let byte = |plane| u32::from(bytes[(column * planes + plane) * rows + row]) << (8 * plane);
                let coded = (0..planes).fold(0, |x, plane| x | byte(plane));
                let difference = (coded >> 1) ^ (coded & 1).wrapping_neg();
                let is_beside = facts[3] == "ids" && column > 0;
                let base = if is_beside { out[row][column - 1] } else { above };
                out[row][column] = if facts[3] == "plain" { coded } else { base.wrapping_add(difference) };
                above = out[row][column];
            }
        }
        out
    }
}

fn between<'a>(text: &'a str, start: &str) -> &'a str {
    let from = text.find(start).expect("it is there") + start.len();
    &text[from..from + text[from..].find("</script>").expect("its end")]
}

fn series(folder: &Path, meshes: &[Mesh]) -> std::path::PathBuf {
    let mut writer = SeriesWriter::new(folder.join("series.pvd"), WriteOptions::default());
    for (k, mesh) in meshes.iter().enumerate() {
        writer.add(k as f64, mesh).expect("it is written");
    }
    folder.join("series.pvd")
}

impl Drawn {
    /// The vertex of the mesh for each point: the nearest one, within the rounding of coordinates.
    fn vertices(&self, mesh: &Mesh) -> Vec<u32> {
        let nearest = |p: &Point| {
            let far = |v: &usize| distance(mesh.points[*v], *p);
            let v = (0..mesh.points.len()).min_by(|a, b| far(a).total_cmp(&far(b))).expect("a vertex");
            assert!(far(&v) <= self.tolerance, "frame {}: no vertex at {p:?}", self.frame);
            v as u32
        };
        self.points.iter().map(nearest).collect()
    }

    fn assert_is(&self, mesh: &Mesh) {
        let vertex = self.vertices(mesh);
        let named = |ids: &[u32]| sorted(ids.iter().map(|&i| vertex[i as usize]));
        self.assert_skin(mesh, &named);
        self.assert_solids(mesh, &named);
        if let Some(values) = self.skin_values.get("x") {
            let own = values.iter().zip(&vertex).map(|(x, &v)| (x - mesh.points[v as usize][0]).abs());
            assert!(own.fold(0.0, f64::max) <= 1e-3, "frame {}: values of points", self.frame);
        }
    }

    /// Asserts that the triangles are those of the boundary; of facets with more corners, the vertices are
    /// compared.
    fn assert_skin(&self, mesh: &Mesh, named: &impl Fn(&[u32]) -> Vec<u32>) {
        let expected = Surface::boundary_of(mesh);
        let ours: BTreeSet<Vec<u32>> = self.skin.iter().map(|t| named(t)).collect();
        let theirs: BTreeSet<Vec<u32>> =
            expected.triangles.iter().map(|t| sorted(t.iter().map(|v| v.0))).collect();
        assert_eq!(self.skin.len(), expected.triangles.len(), "frame {}", self.frame);
        assert!(ours == theirs, "frame {}: the skin is not the boundary", self.frame);
    }

    /// Asserts that each cell is the one its number says, and that none is missing where all cells, or those
    /// at planes, should be there.
    fn assert_solids(&self, mesh: &Mesh, named: &impl Fn(&[u32]) -> Vec<u32>) {
        let of_mesh =
            |cell: usize| sorted(mesh.cells.vertices(motet::base::CellId::new(cell)).iter().map(|v| v.0));
        let ours: BTreeSet<Vec<u32>> = self.solids.iter().map(|ids| named(ids)).collect();
        assert_eq!(ours.len(), self.solids.len(), "frame {}: a cell is there twice", self.frame);
        let volume = |cell: &usize| mesh.cells.kinds()[*cell].dim() == Some(3);
        let all: Vec<usize> = (0..mesh.cells.len()).filter(volume).collect();
        let theirs: BTreeSet<Vec<u32>> = all.iter().map(|&cell| of_mesh(cell)).collect();
        assert!(ours.is_subset(&theirs), "frame {}: cells that the mesh does not have", self.frame);
        if self.holds == "all" {
            assert!(ours == theirs, "frame {}: cells are missing", self.frame);
        }
        for &cell in all.iter().filter(|&&cell| self.is_crossed(mesh, cell)) {
            assert!(ours.contains(&of_mesh(cell)), "frame {}: cell {cell} at a plane is missing", self.frame);
        }
        if let Some(numbers) = self.solid_values.get("number") {
            for (ids, &number) in self.solids.iter().zip(numbers) {
                assert_eq!(named(ids), of_mesh(number as usize), "frame {}: values of cells", self.frame);
            }
        }
    }

    fn is_crossed(&self, mesh: &Mesh, cell: usize) -> bool {
        let vertices = mesh.cells.vertices(motet::base::CellId::new(cell));
        (0..3).any(|axis| {
            let at = || vertices.iter().map(|v| mesh.points[v.index()][axis]);
            let (low, high) = (at().fold(f64::INFINITY, f64::min), at().fold(f64::NEG_INFINITY, f64::max));
            self.planes[axis].iter().any(|&c| low < c && c < high)
        })
    }

    /// The sum of the volumes that the facets of each cell enclose.
    fn volume(&self) -> f64 {
        let mut facet = self.facets.iter();
        let mut sum = 0.0;
        for solid in &self.solids {
            let middle = self.points[solid[0] as usize];
            for t in facet.by_ref().take(solid.len() / 3) {
                let [a, b, c] = t.map(|v| sub(self.points[v as usize], middle));
                sum += (dot(a, motet::geometry::vector::cross(b, c)) / 6.0).abs();
            }
        }
        sum
    }
}

fn sorted(ids: impl Iterator<Item = u32>) -> Vec<u32> {
    ids.collect::<BTreeSet<u32>>().into_iter().collect()
}

/// The mesh with its vertices renumbered by a stride coprime to their count: other connectivity, the same
/// shape and counts.
fn renumbered(mesh: &Mesh, stride: usize) -> Mesh {
    let n = mesh.points.len();
    let gcd = |mut a: usize, mut b: usize| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let stride = (stride % n.max(2) + 1..).find(|&s| gcd(s, n) == 1).expect("1 is");
    let new = |v: usize| (v * stride + 1) % n;
    let mut points = mesh.points.clone();
    (0..n).for_each(|v| points[new(v)] = mesh.points[v]);
    let mut cells = Cells::new();
    for (_, kind, vertices) in mesh.cells.iter() {
        let vertices: Vec<VertexId> = vertices.iter().map(|v| VertexId::new(new(v.index()))).collect();
        cells.push(kind, vertices);
    }
    Mesh::new(points, cells)
}

/// A mesh of one of six topologies, deformed, with its ids as values.
fn frame((which, push): (usize, i32)) -> Mesh {
    let mut mesh = match which {
        0 => ball(3, 2),
        1 => renumbered(&ball(3, 2), 5),
        2 => box_grid([4, 3, 2], [[-1.0; 3], [1.0; 3]]),
        3 => renumbered(&box_grid([4, 3, 2], [[-1.0; 3], [1.0; 3]]), 7),
        4 => mixed(2),
        _ => renumbered(&ball(3, 2), 11),
    };
    let push = 0.04 * f64::from(push);
    // Sheared and bent, so that the order along any curve through the points changes; the cells stay the
    // same.
    for p in &mut mesh.points {
        *p = [p[0] + push * p[1] + push * p[2] * p[2], p[1] - 2.0 * push * p[0], (1.0 + push) * p[2]];
    }
    let x: Vec<f64> = mesh.points.iter().map(|p| p[0]).collect();
    mesh.set_point_field(Field::scalars("x", x));
    let numbers = (0..mesh.cells.len() as i32).collect::<Vec<_>>();
    mesh.set_cell_field(Field::scalars("number", numbers));
    mesh
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_the_page_draws_is_the_mesh_of_each_frame(
        frames in prop::collection::vec((0usize..6, -5i32..6), 1..9), part in 1usize..40
    ) {
        let meshes: Vec<Mesh> = frames.into_iter().map(frame).collect();
        let whole = Page::of(&meshes, Options::BUDGET);
        prop_assert_eq!(whole.report.whole, meshes.len());
        for page in [&whole, &Page::of(&meshes, whole.text.len() / part)] {
            page.frames().for_each(|drawn| drawn.assert_is(&meshes[drawn.frame]));
        }
    }
}

#[test]
fn cells_change_in_the_middle_and_only_planes_fit() {
    let meshes: Vec<Mesh> =
        [(0, 0), (0, 2), (1, 3), (0, 4), (3, 0), (1, 1), (3, -3), (0, 1)].into_iter().map(frame).collect();
    let whole = Page::of(&meshes, Options::BUDGET);
    let mut cut = 0;
    for part in 1..12 {
        let page = Page::of(&meshes, whole.text.len() / part);
        cut += page.report.cut;
        page.frames().for_each(|drawn| drawn.assert_is(&meshes[drawn.frame]));
    }
    assert!(cut > 0, "no budget forced planes");
}

#[test]
fn facets_of_other_cells_enclose_them() {
    let meshes = [mixed(2), quadratic(&ball(2, 2)), mixed(3), mixed(2)];
    let page = Page::of(&meshes, Options::BUDGET);
    assert!(page.frames().count() == 4 && meshes[0].cells.kinds().contains(&CellKind::HEXAHEDRON));
    for drawn in page.frames().filter(|drawn| drawn.frame != 1) {
        assert!((drawn.volume() - 3.0).abs() < 1e-5, "{}", drawn.volume());
        drawn.assert_is(&meshes[drawn.frame]);
    }
}
