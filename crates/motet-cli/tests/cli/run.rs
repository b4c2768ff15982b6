//! `motet run` and `motet cap`: what they write, how a killed run resumes, what they refuse.

use std::collections::BTreeMap;
use std::fs;
use std::process::{Command, Stdio};
use std::time::Duration;

use crate::common::random::Random;
use crate::common::{Folder, stderr, stdout};
use motet::base::VertexId;
use motet::io::{read, read_series};
use motet::mesh::shapes::{Aneurysm, sphere_in_box};
use motet::mesh::{CellKind, Cells, Field, Surface};
use motet::{Mesh, mesh};
use serde_json::Value;

/// A sphere that moves far and turns, twice there and back.
const JOB: &str = r#"
mesh = "box.vtu"
output = "out/moved.pvd"
contents = ["dye"]

[time]
period = 0.8
steps = 6
periods = 2

[motion]
smooth = 2
fixed = ["box"]

[[motion.move]]
patch = "sphere"
turn = { axis = [0, 0, 1], degrees = 60 }
shift = [3, 0, 0]
in_time = "swing"

[contact]
patches = ["sphere", "box"]
warn = 1.5
"#;

fn box_mesh() -> Mesh {
    let mut mesh = sphere_in_box(5, 4);
    let dye = (0..mesh.cells.len()).map(|i| (i as f64).sin()).collect::<Vec<_>>();
    mesh.set_cell_field(Field::scalars("dye", dye));
    mesh
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.mesh("box.vtu", &box_mesh());
    folder.write("job.toml", JOB.as_bytes());
    folder
}

/// The content of a folder, except for timings.
fn bytes(folder: &Folder, name: &str) -> BTreeMap<String, Vec<u8>> {
    let files =
        fs::read_dir(folder.path(name)).expect("the folder is there").map(|e| e.expect("an entry").path());
    // A run that is killed while writing leaves the draft beside its destination.
    let is_meant = |path: &std::path::PathBuf| {
        let name = path.to_string_lossy();
        !name.ends_with(".times.jsonl") && !name.contains(".motet-")
    };
    let files = files.filter(is_meant);
    let name = |path: &std::path::Path| path.file_name().expect("a name").to_string_lossy().into_owned();
    files.map(|path| (name(&path), fs::read(&path).expect("a file"))).collect()
}

fn lines(folder: &Folder, name: &str) -> Vec<Value> {
    let text = String::from_utf8(folder.read(name)).expect("text");
    text.lines().map(|line| serde_json::from_str(line).expect("an object a line")).collect()
}

#[test]
fn a_cycle_is_run_and_every_step_is_written_and_told() {
    let folder = folder();
    let call = folder.motet(["run", "job.toml", "--json"]).assert().code(0);
    let report: Value = serde_json::from_str(&stdout(&call)).expect("one object");
    assert_eq!(
        (&report["steps"], &report["complete"], &report["most_bad"]),
        (&12.into(), &true.into(), &0.into())
    );
    assert!(report["changes"].as_u64() > Some(0) && report["first_warned_at"].as_f64() > Some(0.0));
    let frames = read_series(folder.path("out/moved.pvd")).unwrap();
    assert_eq!(frames.len(), 13);
    let lines = lines(&folder, "out/moved.jsonl");
    let first = box_mesh();
    let content = |mesh: &Mesh| -> f64 {
        let dye = mesh.cell_field("dye").unwrap().values.to_f64().unwrap();
        let volumes = mesh::cell_volumes(&mesh.cells, &mesh.points);
        dye.iter().zip(volumes).filter(|(_, v)| v.is_finite()).map(|(c, v)| c * v).sum()
    };
    let before = content(&first);
    for (k, ((time, file), line)) in frames.iter().zip(&lines).enumerate() {
        assert_eq!(line["step"].as_u64(), Some(k as u64));
        assert!((line["time"].as_f64().unwrap() - time).abs() < 1e-15);
        assert!((time - 0.8 * k as f64 / 6.0).abs() < 1e-12);
        let mesh = read(file).unwrap();
        assert_eq!(line["tets"].as_u64(), Some(mesh.cells.tets().count() as u64));
        assert_eq!((line["bad"].as_u64(), line["inverted"].as_u64()), (Some(0), Some(0)));
        assert!(mesh.point_field("velocity").is_some() && mesh.point_field("gap").is_some());
        assert!((content(&mesh) - before).abs() < 1e-11 * first.cells.len() as f64);
        let gap = line["gaps"]["least"].as_f64().unwrap();
        // The sphere turns about its centre, so only its shift counts; where its facets are nearest may
        // differ a little.
        let shift = 3.0 * (std::f64::consts::TAU * k as f64 / 6.0).sin();
        assert!((gap - (4.0 - shift.abs())).abs() < 0.2, "{gap} {shift}");
    }
    // ParaView wants all frames to have the same arrays.
    let arrays = |mesh: &Mesh| -> Vec<String> {
        mesh.point_data.iter().chain(&mesh.cell_data).map(|field| field.name.clone()).collect()
    };
    let all: Vec<_> = frames.iter().map(|(_, file)| arrays(&read(file).unwrap())).collect();
    assert!(all.iter().all(|names| *names == all[0]), "{all:?}");
}

#[test]
fn a_run_that_is_killed_goes_on_and_ends_with_the_same_bytes() {
    let whole = folder();
    whole.motet(["run", "job.toml", "-q"]).assert().code(0);
    let expected = bytes(&whole, "out");
    let broken = folder();
    let mut random = Random(7);
    let program = broken.motet(["run"]).get_program().to_owned();
    let mut killed = 0;
    for _ in 0..40 {
        let mut run = Command::new(&program)
            .current_dir(broken.path(""))
            .args(["run", "job.toml", "--resume", "-q", "--threads", if killed % 2 == 0 { "1" } else { "2" }])
            .stdout(Stdio::null())
            .spawn()
            .expect("it starts");
        std::thread::sleep(Duration::from_millis(random.between(30.0, 430.0) as u64));
        if run.try_wait().expect("it can be asked").is_some_and(|status| status.success()) {
            break;
        }
        run.kill().expect("it can be killed");
        run.wait().expect("it ends");
        killed += 1;
    }
    println!("killed {killed} times");
    broken.motet(["run", "job.toml", "--resume", "-q"]).assert().code(0);
    let got = bytes(&broken, "out");
    assert_eq!(got.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>());
    expected.iter().for_each(|(name, bytes)| assert!(got[name] == *bytes, "{name} differs"));
}

#[test]
fn a_run_ends_where_it_is_reported_to_and_goes_on_from_there() {
    let whole = folder();
    whole.motet(["run", "job.toml", "-q"]).assert().code(0);
    let parted = folder();
    parted.motet(["run", "job.toml", "-q", "--until", "5"]).assert().code(0);
    assert_eq!(read_series(parted.path("out/moved.pvd")).unwrap().len(), 6);
    let call = parted.motet(["run", "job.toml", "--resume"]).assert().code(0);
    assert!(stdout(&call).contains("resumes after step 5"));
    assert!(bytes(&whole, "out") == bytes(&parted, "out"));
    // A longer run is the same job, and so is one that is written in another way.
    let longer = JOB.replace("periods = 2", "periods = 3").replace("[time]", "# all of it\n[time]");
    parted.write("job.toml", longer.as_bytes());
    parted.motet(["run", "job.toml", "--resume", "-q", "--until", "13"]).assert().code(0);
    assert_eq!(read_series(parted.path("out/moved.pvd")).unwrap().len(), 14);
    // Another job does not resume from it.
    let before = bytes(&parted, "out");
    for (from, to, key) in [
        ("fixed = [\"box\"]", "inside = []", "motion.fixed was [\"box\"] and is []"),
        ("smooth = 2", "smooth = 3", "motion.smooth was 2 and is 3"),
        ("shift = [3, 0, 0]", "shift = [2, 0, 0]", "motion.move.0.shift"),
        ("warn = 1.5", "warn = 1.5\nhold = 0.1", "contact.hold was nothing and is 0.1"),
        ("steps = 6", "steps = 7", "time.steps was 6 and is 7"),
    ] {
        parted.write("job.toml", JOB.replace(from, to).as_bytes());
        let call = parted.motet(["run", "job.toml", "--resume"]).assert().code(3);
        assert!(
            stderr(&call).contains("the job to resume") && stderr(&call).contains(key),
            "{}",
            stderr(&call)
        );
    }
    parted.write("job.toml", JOB.as_bytes());
    assert!(bytes(&parted, "out") == before, "what was refused changed nothing");
    let mut fewer = box_mesh();
    fewer.points.iter_mut().for_each(|p| p[0] *= 1.5);
    parted.mesh("box.vtu", &fewer);
    let call = parted.motet(["run", "job.toml", "--resume"]).assert().code(3);
    assert!(
        stderr(&call).contains("the job to resume") && stderr(&call).contains("mesh was"),
        "{}",
        stderr(&call)
    );
}

#[test]
fn what_is_missing_of_a_run_to_go_on_with_is_reported() {
    let folder = folder();
    folder.motet(["run", "job.toml", "-q", "--until", "3"]).assert().code(0);
    let whole = bytes(&folder, "out");
    let refused = |name: &str, content: Option<&[u8]>| {
        let path = folder.path("out").join(name);
        match content {
            Some(content) => fs::write(&path, content).unwrap(),
            None => fs::remove_file(&path).unwrap(),
        }
        let call = folder.motet(["run", "job.toml", "--resume"]).assert().code(3);
        let reported = stderr(&call);
        assert!(reported.contains(name) && reported.contains("--resume"), "{reported}");
        fs::write(&path, &whole[name]).unwrap();
    };
    refused("moved_0002.vtu", None);
    refused("moved_0002.vtu", Some(b""));
    let log = &whole["moved.jsonl"];
    let cut = log.iter().rposition(|c| *c == b'{').unwrap() / 2;
    refused("moved.jsonl", Some(&log[..cut]));
    refused("moved.jsonl", None);
    refused("moved.job.json", None);
    refused("moved.job.json", Some(b"{"));
    folder.motet(["run", "job.toml", "--resume", "-q", "--until", "3"]).assert().code(0);
    assert!(bytes(&folder, "out") == whole);
}

#[test]
fn one_run_at_a_time_writes_to_an_output_and_leftovers_of_killed_ones_go() {
    let folder = folder();
    fs::create_dir(folder.path("out")).unwrap();
    // Left by a killed run, by a run with another output, and by someone else.
    let left = [".motet-moved_0002.vtu-abc123", ".motet-moved.jsonl-abc123", ".motet-moved.pvd.lock"];
    let others = [".motet-moved_b.pvd-abc123", ".motet-other_0002.vtu-abc123", ".motet-notes"];
    left.iter().chain(&others).for_each(|name| folder.write(&format!("out/{name}"), b"1"));
    let held = motet::io::OutputLock::take(&folder.path("out/moved.pvd")).unwrap();
    assert!(held.is_held());
    let call = folder.motet(["run", "job.toml"]).assert().code(1);
    let reported = stderr(&call);
    assert!(
        reported.contains("another run") && reported.contains(&std::process::id().to_string()),
        "{reported}"
    );
    assert!(!folder.path("out/moved_0000.vtu").exists());
    drop(held);
    folder.motet(["run", "job.toml", "-q", "--until", "1"]).assert().code(0);
    let is_there = |name: &&str| folder.path("out").join(name).exists();
    assert!(!left.iter().any(is_there) && others.iter().all(is_there));
}

#[test]
fn what_is_refined_at_first_and_on_the_way_is_in_the_frames() {
    let folder = folder();
    let refine = "\n[[refine]]\nball = [\"0,0,0,1.4\"]\n\n[[refine]]\npatch = [\"sphere\"]\nevery = 4\ncoarsen = true\nlimit_generation = 1\n";
    let job = JOB.replace("shift = [3, 0, 0]", "shift = [0.5, 0, 0]").replace("degrees = 60", "degrees = 5");
    folder.write("job.toml", (job + refine).as_bytes());
    folder.motet(["run", "job.toml", "-q"]).assert().code(0);
    let lines = lines(&folder, "out/moved.jsonl");
    assert!(lines[0]["tets"].as_u64().unwrap() > box_mesh().cells.tets().count() as u64);
    let why: Vec<&str> = (lines.iter())
        .flat_map(|line| line["changes"].as_array().unwrap())
        .filter_map(|change| change["why"].as_str())
        .collect();
    assert!(why.contains(&"refinement"), "{why:?}");
}

#[test]
fn a_motion_that_cannot_be_gone_to_its_end_is_reported() {
    let folder = folder();
    folder.write("job.toml", JOB.replace("shift = [3, 0, 0]", "shift = [5, 0, 0]").as_bytes());
    let call = folder.motet(["run", "job.toml"]).assert().code(4);
    assert!(stdout(&call).contains("% of the step") && stdout(&call).contains("the last one incomplete"));
    let frames = read_series(folder.path("out/moved.pvd")).unwrap();
    let last = read(&frames.last().unwrap().1).unwrap();
    assert!(mesh::check::check(&last).is_empty());
}

#[test]
fn walls_that_would_meet_stop_where_they_are_reported_to() {
    let folder = folder();
    let job = JOB
        .replace("shift = [3, 0, 0]", "shift = [3.8, 0, 0]")
        .replace("warn = 1.5", "warn = 1.5\nhold = 1.0");
    folder.write("job.toml", job.as_bytes());
    let call = folder.motet(["run", "job.toml"]).assert().code(0);
    assert!(
        stdout(&call).contains(" held") && stdout(&call).contains("walls stopped in"),
        "{}",
        stdout(&call)
    );
    let gaps: Vec<Value> =
        lines(&folder, "out/moved.jsonl").into_iter().map(|line| line["gaps"].clone()).collect();
    let least = gaps.iter().filter_map(|gaps| gaps["least"].as_f64()).fold(f64::INFINITY, f64::min);
    assert!((least - 1.0).abs() < 1e-9, "{least}");
    assert!(gaps.iter().any(|gaps| gaps["held"].as_u64() > Some(0)));
    assert!(gaps.iter().any(|gaps| gaps["held"].as_u64() == Some(0)));
}

#[test]
fn what_is_wrong_with_a_job_is_reported_with_its_line() {
    let folder = folder();
    let refused = |from: &str, to: &str, reported: &[&str]| {
        assert!(JOB.contains(from));
        folder.write("job.toml", JOB.replacen(from, to, 1).as_bytes());
        let call = folder.motet(["run", "job.toml"]).assert().code(3);
        for part in reported {
            assert!(stderr(&call).contains(part), "{to}: {}", stderr(&call));
        }
    };
    refused(
        "period = 0.8",
        "perod = 0.8",
        &["job.toml", "line 7", "unknown key `perod`; did you mean `period`?"],
    );
    refused("period = 0.8", "period = \"a\"", &["line 7", "string"]);
    refused("period = 0.8", "period = -1", &["time.period"]);
    refused("steps = 6", "steps = 0", &["time.steps"]);
    refused("mesh = \"box.vtu\"", "mesh = \"bx.vtu\"", &["bx.vtu"]);
    refused("moved.pvd", "moved.vtu", &["not a series"]);
    refused("[time]", "[time", &["line 6"]);
    refused("patch = \"sphere\"", "patch = \"spher\"", &["job.toml", "spher", "sphere, box"]);
    refused("in_time = \"swing\"", "in_time = \"wobble\"", &["wobble", "beat"]);
    refused("in_time = \"swing\"", "in_time = [[0, 1], [0, 2]]", &["rising"]);
    refused("fixed = [\"box\"]", "fixed = [\"box\", \"sphere\"]", &["no vertex of patch sphere"]);
    refused("contents = [\"dye\"]", "contents = [\"ink\"]", &["ink", "dye"]);
    refused("warn = 1.5", "warn = -1.5", &["[contact]", "warning distance"]);
    refused("warn = 1.5", "hold = -1", &["[contact]", "kept apart must be 0 or more"]);
    refused("smooth = 2", "method = \"magic\"", &["magic", "guided"]);
    refused("smooth = 2", "smoot = 2", &["line 12", "did you mean `smooth`?"]);
    refused("smooth = 2", "method = \"guded\"", &["line 12", "did you mean `guided`?"]);
    refused("smooth = 2", "rigid_layer = \"thick\"", &["line 12", "3layers", "thick"]);
    refused("mesh = \"box.vtu\"", "", &["`mesh` is missing"]);
    refused("shift = [3, 0, 0]", "swell = 3", &["both swell and another motion"]);
    refused("[contact]", "[[refine]]\nevery = 2\n[contact]", &["no criterion"]);
    refused("[contact]", "[repair]\nmin_eas = 2\n[contact]", &["[repair]"]);
    refused("[contact]", "[[device]]\nfile = \"no.stl\"\n[contact]", &["no.stl"]);
    let call = folder.motet(["run", "none.toml"]).assert().code(3);
    assert!(stderr(&call).contains("none.toml"));
    folder.motet(["run"]).assert().code(2);
}

#[test]
fn the_documentation_lists_all_keys_as_they_are_printed() {
    let call = Folder::new().motet(["run", "--keys"]).assert().code(0);
    let page = include_str!("../../../../docs/run.md");
    assert!(page.contains(stdout(&call).trim_end()), "print them again: motet run --keys");
}

/// The wall of an aneurysm without its ends, in phase `k` of its pulse.
fn pulsing(k: usize) -> Mesh {
    let whole = Aneurysm::default().mesh().unwrap();
    let surface = Surface::of(&whole);
    let wall = whole.find_patch("wall").unwrap();
    let kept = surface.triangles.iter().zip(&surface.patches).filter(|(_, patch)| **patch == wall);
    let mut triangles: Vec<VertexId> = kept.flat_map(|(t, _)| *t).collect();
    let mut used = triangles.clone();
    used.sort_unstable();
    used.dedup();
    let part = 1.0 + 0.05 * (std::f64::consts::TAU * k as f64 / 6.0).sin();
    let points = used.iter().map(|v| whole.points[v.index()]).map(|p| [p[0] * part, p[1] * part, p[2]]);
    triangles.iter_mut().for_each(|v| *v = VertexId::new(used.binary_search(v).unwrap()));
    Mesh::new(points.collect(), Cells::uniform(CellKind::TRIANGLE, triangles).unwrap())
}

#[test]
fn measured_walls_are_capped_meshed_and_followed_by_a_mesh_of_its_own_triangles() {
    let folder = Folder::new();
    let frames: Vec<String> = (0..6).map(|k| folder.mesh(&format!("wall_{k}.vtp"), &pulsing(k))).collect();
    let words = ["cap"]
        .into_iter()
        .chain(frames.iter().map(String::as_str))
        .chain(["-o", "wall.pvd", "--period", "0.6"]);
    let call = folder.motet(words).assert().code(0);
    assert!(stdout(&call).contains("6 frames, 2 rims capped"), "{}", stdout(&call));
    let series = read_series(folder.path("wall.pvd")).unwrap();
    assert_eq!(series.len(), 6);
    assert!((series[1].0 - 0.1).abs() < 1e-12);
    let made = |call: assert_cmd::assert::Assert| {
        let code = call.get_output().status.code();
        assert!(matches!(code, Some(0 | 4)), "{}", stderr(&call));
    };
    made(folder.motet(["mesh", "wall_0000.vtu", "-o", "lumen.vtu", "--size", "0.4", "-q"]).assert());
    let repaired =
        ["remesh", "lumen.vtu", "-o", "lumen2.vtu", "--surface", "adapt", "--distance", "0.02", "-q"];
    made(folder.motet(repaired).assert());
    // Without a number of steps, there is one for each measured wall.
    for (mesh, matching, steps) in [("lumen.vtu", "position", "steps = 12\n"), ("lumen2.vtu", "nearest", "")]
    {
        let job = format!(
            "mesh = \"{mesh}\"\noutput = \"{matching}.pvd\"\n[time]\nperiod = 0.6\n{steps}[motion]\nsurfaces = \"wall.pvd\"\nmatch = \"{matching}\"\n"
        );
        folder.write("job.toml", job.as_bytes());
        let call = folder.motet(["run", "job.toml"]).assert();
        assert!([Some(0), Some(4)].contains(&call.get_output().status.code()), "{}", stderr(&call));
        let frames = read_series(folder.path(&format!("{matching}.pvd"))).unwrap();
        let every = if steps.is_empty() { 1 } else { 2 };
        assert_eq!(frames.len(), 1 + 6 * every);
        let volume = |file: &std::path::Path| Surface::boundary_of(&read(file).unwrap()).enclosed_volume();
        for k in 0..6 {
            let [ours, theirs] = [&frames[every * k].1, &series[k].1].map(|file| volume_of(file, &volume));
            assert!((ours - theirs).abs() < 2e-3 * theirs, "{matching} {k}: {ours} {theirs}");
        }
        let lines = lines(&folder, &format!("{matching}.jsonl"));
        assert!(
            lines
                .iter()
                .all(|line| line["inverted"].as_u64() == Some(0) && line["complete"].as_bool() == Some(true))
        );
    }
}

fn volume_of(file: &std::path::Path, of_boundary: &impl Fn(&std::path::Path) -> f64) -> f64 {
    let mesh = read(file).unwrap();
    if mesh.cells.tets().next().is_some() { of_boundary(file) } else { Surface::of(&mesh).enclosed_volume() }
}

#[test]
fn what_cannot_be_capped_is_reported() {
    let folder = Folder::new();
    folder.mesh("closed.vtp", &Aneurysm::default().mesh().unwrap());
    folder.mesh("a.vtp", &pulsing(0));
    let mut more = pulsing(1);
    more.points.push([0.0; 3]);
    folder.mesh("b.vtp", &more);
    let call = folder.motet(["cap", "closed.vtp", "-o", "out.vtp"]).assert().code(3);
    assert!(stderr(&call).contains("no open rim"));
    let call = folder.motet(["cap", "a.vtp", "b.vtp", "-o", "out.pvd"]).assert().code(3);
    assert!(stderr(&call).contains("b.vtp") && stderr(&call).contains("points"));
    folder.motet(["cap", "a.vtp", "a.vtp", "-o", "out.vtp"]).assert().code(2);
    assert_eq!(folder.names(), ["a.vtp", "b.vtp", "closed.vtp"].map(String::from));
}
