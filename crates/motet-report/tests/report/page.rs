//! Written pages: their content, their size, and what is refused.

use std::fs;
use std::path::PathBuf;

use motet::base::VertexId;
use motet::io::{self, SeriesWriter, WriteOptions};
use motet::mesh::shapes::{ball, box_grid, mixed, quadratic, sphere_in_box};
use motet::mesh::{CellKind, Cells, Field};
use motet::{ErrorKind, Mesh};
use motet_report::{Options, Report, write};
use serde_json::Value;

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn text(&self, name: &str, text: &str) -> PathBuf {
        fs::write(self.path(name), text).expect("it is written");
        self.path(name)
    }

    fn mesh(&self, name: &str, mesh: &Mesh) -> PathBuf {
        io::write(self.path(name), mesh, &WriteOptions::default()).expect("it is written");
        self.path(name)
    }

    fn series(&self, meshes: &[Mesh]) -> PathBuf {
        let mut writer = SeriesWriter::new(self.path("series.pvd"), WriteOptions::default());
        for (k, mesh) in meshes.iter().enumerate() {
            writer.add(0.5 * k as f64, mesh).expect("it is written");
        }
        self.path("series.pvd")
    }

    /// Returns the report, the page, and the data for the page's script.
    fn page(&self, inputs: &[PathBuf], budget: usize) -> (Report, String, Value) {
        let output = self.path("page.html");
        let report = write(inputs, &Options { budget, ..Options::new(&output) }).expect("a page");
        let page = fs::read_to_string(output).expect("it is there");
        assert_eq!(page.len(), report.bytes);
        let start = page.find("id=\"manifest\">").expect("a manifest") + "id=\"manifest\">".len();
        let end = start + page[start..].find("</script>").expect("its end");
        let manifest = serde_json::from_str(&page[start..end]).expect("JSON");
        (report, page, manifest)
    }

    fn refused(&self, input: PathBuf) -> motet::Error {
        write(&[input], &Options::new(self.path("no.html"))).expect_err("refused")
    }
}

/// A ball deformed along x, a little more in each of `n` frames.
fn pushed(n: usize) -> Vec<Mesh> {
    let frame = |k: usize| {
        let mut mesh = ball(6, 4);
        let shift = k as f64;
        mesh.points.iter_mut().for_each(|p| p[0] += 0.05 * shift * p[1] * p[1]);
        mesh.set_point_field(Field::scalars("h", vec![shift; mesh.points.len()]));
        mesh
    };
    (0..n).map(frame).collect()
}

#[test]
fn a_page_stands_alone_and_has_the_same_bytes_each_time() {
    let folder = Folder::new();
    let input = folder.series(&pushed(3));
    let log =
        folder.text("run.jsonl", "{\"step\": 0, \"worst_eas\": 0.5}\n{\"step\": 1, \"worst_eas\": 0.25}\n");
    let inputs = [input, log];
    let (report, page, _) = folder.page(&inputs, Options::BUDGET);
    assert_eq!(page, folder.page(&inputs, Options::BUDGET).1);
    for word in ["http://", "https://", "src=", "@import", "url("] {
        let found: Vec<_> = page.match_indices(word).collect();
        assert!(found.iter().all(|(at, _)| page[*at..].starts_with("http://www.w3.org/2000/svg")), "{word}");
    }
    assert!(!page.contains(&*folder.0.path().to_string_lossy()), "no folder of this machine");
    assert_eq!((report.inputs[0].frames, report.inputs[0].shown, report.inputs[0].whole), (3, 3, 3));
    assert_eq!(report.inputs[1].rows, 2);
    assert!(page.contains("worst_eas") && page.contains("Certificate of each frame"));
}

#[test]
fn tables_of_ids_are_there_once_for_all_frames_of_the_same_cells() {
    let folder = Folder::new();
    let (.., manifest) = folder.page(&[folder.series(&pushed(3))], Options::BUDGET);
    let frames = manifest["inputs"][0]["frames"].as_array().expect("frames");
    assert_eq!(frames[0]["inside"]["tets"], frames[2]["inside"]["tets"]);
    assert_eq!(frames[0]["skin"]["triangles"], frames[2]["skin"]["triangles"]);
    assert_ne!(frames[0]["skin"]["points"], frames[2]["skin"]["points"]);
}

#[test]
fn a_series_may_change_its_cells_and_its_arrays() {
    let folder = Folder::new();
    let mut meshes =
        vec![ball(3, 2), mixed(2), quadratic(&ball(2, 1)), box_grid([2; 3], [[0.0; 3], [1.0; 3]])];
    let n = meshes[1].points.len();
    meshes[1].set_point_field(Field::vectors("u", &vec![[3.0, 4.0, 0.0]; n]));
    let (report, _, manifest) = folder.page(&[folder.series(&meshes)], Options::BUDGET);
    assert_eq!((report.inputs[0].shown, report.inputs[0].whole), (4, 4));
    let input = &manifest["inputs"][0];
    let u = input["arrays"].as_array().expect("arrays").iter().position(|a| a["name"] == "u").expect("u");
    assert_eq!(input["frames"][1]["skin"]["values"][u.to_string()]["low"], 5.0);
    assert!(input["frames"][0]["skin"]["values"].get(u.to_string()).is_none());
    assert_eq!(
        (&input["arrays"][u]["is_vector"], &input["arrays"][u]["title"]),
        (&true.into(), &"length of u".into())
    );
    assert!(
        input["frames"][1]["skin"]["vectors"][u.to_string()]["step"].as_f64().is_some_and(|step| step > 0.0)
    );
    assert!(input["frames"][0]["skin"]["vectors"].get(u.to_string()).is_none());
    assert!(
        input["frames"][1]["inside"]["facets"].is_array() && input["frames"][0]["inside"]["tets"].is_u64()
    );
}

#[test]
fn patches_are_parts_and_what_is_around_another_is_transparent() {
    let folder = Folder::new();
    let inputs = [folder.mesh("box.vtu", &sphere_in_box(3, 2)), folder.mesh("ball.vtu", &ball(3, 2))];
    let (_, page, manifest) = folder.page(&inputs, Options::BUDGET);
    let input = &manifest["inputs"][0];
    let opacity = |name: &str| {
        let parts = input["parts"].as_array().expect("parts");
        let is_it = |part: &&Value| {
            let names = &input["arrays"][part["array"].as_u64().expect("an array") as usize]["names"];
            names[part["id"].to_string()] == name
        };
        parts.iter().find(is_it).expect("the part")["opacity"].as_f64().expect("a number")
    };
    assert!(opacity("box") < 0.5 && opacity("sphere") == 1.0);
    assert_eq!(manifest["inputs"][1]["parts"].as_array().map(Vec::len), Some(0), "one patch needs no list");
    assert!(page.contains("EAS (quality of a tet)"));
    // Without arrays there are no labels to tell parts apart by.
    let (report, _, manifest) = folder.page(&inputs, 1);
    assert!(report.inputs[0].left_out.iter().any(|what| what.contains("Arrays are left out")));
    assert_eq!(manifest["inputs"][0]["parts"].as_array().map(Vec::len), Some(0));
}

#[test]
fn what_does_not_fit_is_left_out_in_order_and_told() {
    let folder = Folder::new();
    let input = [folder.series(&pushed(8))];
    let all = folder.page(&input, Options::BUDGET).0;
    assert!(all.inputs[0].left_out.is_empty() && all.payload_bytes <= all.budget_bytes);
    let mut before = all.payload_bytes;
    for part in [2, 4, 8, 16] {
        let budget = all.payload_bytes / part;
        let (report, page, manifest) = folder.page(&input, budget);
        let input = &report.inputs[0];
        assert!(report.payload_bytes <= before, "{report:?}");
        before = report.payload_bytes;
        assert!(input.shown >= 2 && !input.left_out.is_empty(), "{report:?}");
        assert!(report.payload_bytes <= budget || input.shown == 2, "{report:?}");
        assert!(input.left_out.iter().all(|sentence| page.contains(sentence)));
        let frames = manifest["inputs"][0]["frames"].as_array().expect("frames");
        assert_eq!(
            (&frames[0]["frame"], &frames[input.shown - 1]["frame"]),
            (&Value::from(0), &Value::from(7))
        );
    }
    let (report, ..) = folder.page(&input, 1);
    assert_eq!((report.inputs[0].shown, report.inputs[0].whole + report.inputs[0].cut), (2, 0));
}

#[test]
fn surfaces_points_without_cells_and_arrays_without_numbers_have_a_page() {
    let folder = Folder::new();
    let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let triangle = Cells::uniform(CellKind::TRIANGLE, (0..3).map(VertexId).collect()).expect("a triangle");
    let mut surface = Mesh::new(points.clone(), triangle);
    surface.set_point_field(Field::scalars("none", vec![f64::NAN; 3]));
    surface.set_point_field(Field::scalars("gap", vec![0.5, f64::NAN, 0.25]));
    let (_, page, manifest) = folder.page(&[folder.mesh("surface.vtu", &surface)], Options::BUDGET);
    assert!(page.contains("The least gap is 0.25"));
    let values = &manifest["inputs"][0]["frames"][0]["skin"]["values"];
    assert_eq!(values.as_object().map(serde_json::Map::len), Some(1));
    let bare = folder.mesh("bare.vtu", &Mesh::new(points, Cells::new()));
    let (report, page, _) = folder.page(&[bare], Options::BUDGET);
    assert!(report.inputs[0].frames == 1 && page.contains("no cells"));
}

#[test]
fn points_that_are_no_numbers_are_reported_and_not_drawn() {
    let folder = Folder::new();
    let mut mesh = ball(3, 2);
    mesh.points[0] = [f64::NAN; 3];
    let (_, page, _) = folder.page(&[folder.mesh("nan.vtu", &mesh)], Options::BUDGET);
    assert!(page.contains("have points that are not finite"));
}

#[test]
fn texts_from_files_are_no_markup() {
    let folder = Folder::new();
    let log = folder.text(
        "run.json",
        "{\"<b>\": \"</script><script>alert(1)</script>\", \"steps\": [{\"a&<\": 1}, {\"a&<\": 2}]}",
    );
    let options = Options { title: Some("<i>".into()), ..Options::new(folder.path("page.html")) };
    write(&[log], &options).expect("a page");
    let page = fs::read_to_string(folder.path("page.html")).expect("it is there");
    assert!(!page.contains("alert(1)</script>") && !page.contains("<b>") && !page.contains("<i>"));
    assert!(page.contains("a&amp;&lt;"));
}

#[test]
fn what_cannot_be_read_is_reported_with_file_place_and_remedy() {
    let folder = Folder::new();
    let empty = "<VTKFile type=\"Collection\"><Collection></Collection></VTKFile>";
    let error = folder.refused(folder.text("empty.pvd", empty));
    assert!(error.kind() == ErrorKind::Input && error.to_string().contains("lists no files"), "{error}");
    let error = folder.refused(folder.text("number.json", "3"));
    assert!(error.to_string().contains("found a number") && error.remedy_text().is_some(), "{error}");
    let error = folder.refused(folder.text("broken.jsonl", "{\"a\": 1}\n{\"a\": NaN}\n"));
    assert_eq!(error.place(), Some("line 2"));
    assert_eq!(folder.refused(folder.path("missing.vtu")).kind(), ErrorKind::Io);
    assert!(!folder.path("no.html").exists());
}

#[test]
fn outputs_that_are_no_page_or_an_input_are_refused() {
    let folder = Folder::new();
    let input = folder.text("log.json", "{}");
    let refused = |inputs: &[PathBuf], output: &str| {
        write(inputs, &Options::new(folder.path(output))).expect_err("refused").kind()
    };
    assert_eq!(refused(std::slice::from_ref(&input), "page.pdf"), ErrorKind::Options);
    assert_eq!(refused(&[], "page.html"), ErrorKind::Options);
    fs::write(folder.path("page.html"), "{}").expect("written");
    assert_eq!(refused(&[input, folder.path("page.html")], "page.html"), ErrorKind::Options);
}
