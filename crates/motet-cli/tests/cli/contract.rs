//! What scripts rely on: exit statuses, clean standard output, JSON, files that appear whole or not at all.

use crate::common::{Folder, stderr, stdout};
use motet::mesh::shapes::sphere_in_box;

#[test]
fn a_call_without_a_verb_shows_the_usage_and_exits_2() {
    let folder = Folder::new();
    for words in [&[][..], &["fly"], &["convert", "only-one.vtu"], &["info", "a.vtu", "--threads", "many"]] {
        let call = folder.motet(words).assert().code(2);
        assert_eq!(stdout(&call), "", "{words:?}");
        let reported = stderr(&call);
        assert!(reported.contains("Usage: motet") || reported.contains("--help"), "{words:?}: {reported}");
    }
}

#[test]
fn a_wrong_call_with_json_is_reported_as_an_object() {
    let call = Folder::new().motet(["fly", "--json"]).assert().code(2);
    let reported: serde_json::Value = serde_json::from_str(&stdout(&call)).expect("one object");
    assert_eq!(reported["error"]["exit"], 2);
    assert!(reported["error"]["what"].as_str().is_some_and(|t| t.contains("fly")), "{reported}");
}

#[test]
fn help_is_no_failure() {
    let folder = Folder::new();
    for words in [&["help"][..], &["--help"], &["--version"], &["help", "convert"], &["move", "--help"]] {
        let call = folder.motet(words).assert().code(0);
        assert_eq!(stderr(&call), "", "{words:?}");
    }
}

#[test]
fn an_ending_that_no_format_has_is_a_wrong_word() {
    let folder = Folder::new();
    let mesh = folder.cube("cube.vtu");
    let call = folder.motet(["convert", &mesh, "cube.docx"]).assert().code(2);
    assert!(stderr(&call).starts_with("error: cube.docx: "), "{}", stderr(&call));
    assert!(stderr(&call).contains(".vtu"), "{}", stderr(&call));
}

#[test]
fn a_file_that_is_not_there_is_an_unreadable_input() {
    let folder = Folder::new();
    let call = folder.motet(["info", "nowhere.vtu", "--json"]).assert().code(3);
    assert!(stderr(&call).starts_with("error: nowhere.vtu: "), "{}", stderr(&call));
    let reported: serde_json::Value = serde_json::from_str(&stdout(&call)).expect("one object");
    assert_eq!(reported["error"]["file"], "nowhere.vtu");
    assert_eq!(reported["error"]["exit"], 3);
}

#[test]
fn folders_of_outputs_are_made() {
    let folder = Folder::new();
    let mesh = folder.cube("cube.vtu");
    for output in ["new/deep/out.vtu", "new/other/out.msh"] {
        folder.motet(["convert", &mesh, output]).assert().code(0);
        assert!(folder.path(output).exists(), "{output}");
    }
    let shear = ["--affine", "1,0.1,0,0,0,1,0,0,0,0,1,0", "--steps", "2", "--dt", "0.5"];
    folder.motet(["move", &mesh, "-o", "series/out.pvd"].iter().chain(&shear)).assert().code(0);
    assert!(folder.path("series/out.pvd").is_file());
    folder.motet(["remesh", &mesh, "-o", "a/out.vtu", "--history", "b/map.json"]).assert().code(0);
    assert!(folder.path("a/out.vtu").is_file() && folder.path("b/map.json").is_file());
}

#[test]
fn a_file_in_the_place_of_a_folder_is_reported_before_work_begins() {
    let folder = Folder::new();
    let mesh = folder.cube("cube.vtu");
    let call = folder.motet(["convert", &mesh, "cube.vtu/deep/out.vtu"]).assert().code(3);
    assert!(stderr(&call).contains("cube.vtu is a file"), "{}", stderr(&call));
    assert_eq!(folder.names(), ["cube.vtu"]);
}

#[test]
fn a_failed_conversion_leaves_nothing_and_keeps_what_was_there() {
    let folder = Folder::new();
    folder.write("broken.vtu", b"<VTKFile type=\"UnstructuredGrid\">");
    folder.write("out.vtu", b"precious");
    folder.motet(["convert", "broken.vtu", "out.vtu"]).assert().code(3);
    assert_eq!(folder.read("out.vtu"), b"precious");
    assert_eq!(folder.names(), ["broken.vtu", "out.vtu"]);
}

#[test]
fn json_is_one_object_on_standard_output_and_nothing_else() {
    let folder = Folder::new();
    let mesh = folder.cube("cube.vtu");
    let call = folder.motet(["convert", &mesh, "out.vtu", "--json"]).assert().code(0);
    let reported: serde_json::Value = serde_json::from_str(&stdout(&call)).expect("one object");
    for key in ["input", "output", "points", "cells", "lost", "seconds"] {
        assert!(!reported[key].is_null(), "{key}");
    }
    assert_eq!(folder.names(), ["cube.vtu", "out.vtu"]);
}

#[test]
fn quiet_says_nothing() {
    let folder = Folder::new();
    let mesh = folder.cube("cube.vtu");
    let call = folder.motet(["convert", &mesh, "out.vtu", "-q"]).assert().code(0);
    assert_eq!((stdout(&call), stderr(&call)), (String::new(), String::new()));
}

#[test]
fn the_bytes_do_not_depend_on_the_threads() {
    let folder = Folder::new();
    let mesh = folder.cube("cube.vtu");
    for (threads, out) in [("1", "one.vtu"), ("2", "two.vtu")] {
        folder.motet(["convert", &mesh, out, "--threads", threads]).assert().code(0);
    }
    assert_eq!(folder.read("one.vtu"), folder.read("two.vtu"));
}

#[test]
fn every_verb_takes_more_threads_than_the_machine_has_and_gives_the_same_files() {
    let folder = Folder::new();
    folder.mesh("box.vtu", &sphere_in_box(3, 2));
    folder.cube("cube.vtu");
    let corners = ["0.7 0.5 0.5", "0.3 0.5 0.5", "0.5 0.7 0.5", "0.5 0.3 0.5", "0.5 0.5 0.7", "0.5 0.5 0.3"];
    let triangles = ["0 2 4", "2 1 4", "1 3 4", "3 0 4", "2 0 5", "1 2 5", "3 1 5", "0 3 5"];
    let triangles = triangles.map(|t| format!("3 {t}")).join("\n");
    folder.write("ball.off", format!("OFF\n6 8 0\n{}\n{triangles}\n", corners.join("\n")).as_bytes());
    folder
        .write("open.off", format!("OFF\n6 7 0\n{}\n{}\n", corners.join("\n"), &triangles[..55]).as_bytes());
    let calls: [&[&str]; 11] = [
        &["convert", "box.vtu", "-o"],
        &["info", "box.vtu", "-o"],
        &["mesh", "ball.off", "--size", "0.1", "-o"],
        &["remesh", "box.vtu", "-o"],
        &["refine", "box.vtu", "--all", "-o"],
        &["implant", "cube.vtu", "ball.off", "-o"],
        &["move", "box.vtu", "--translate", "sphere=0.1,0,0", "-o"],
        &["contact", "box.vtu", "--patches", "sphere,box", "-o"],
        &["cap", "open.off", "-o"],
        &["surface", "open.off", "--size", "0.1", "-o"],
        &["wall", "box.vtu", "--thickness", "0.1", "--on", "box", "-o"],
    ];
    for words in calls {
        let made = |name: &str, threads: &str| {
            let words = words.iter().filter(|word| **word != "-o" || words[0] != "convert").copied();
            folder.motet(words.chain([name, "--threads", threads, "-q"])).assert().success();
            folder.read(name)
        };
        let ending = if matches!(words[0], "contact" | "cap") { "vtp" } else { "vtu" };
        let names = ["one", "many"].map(|name| format!("{}-{name}.{ending}", words[0]));
        assert!(made(&names[0], "1") == made(&names[1], "100000"), "{words:?}");
    }
    for verb in [
        "info", "quality", "convert", "mesh", "move", "remesh", "refine", "implant", "contact", "run", "cap",
        "report", "surface", "wall",
    ] {
        let call = folder.motet([verb, "--threads", "-1"]).assert().code(2);
        assert!(stderr(&call).contains("invalid value '-1' for '--threads <N>'"), "{}", stderr(&call));
    }
}

#[test]
fn completions_and_manual_pages_know_every_verb() {
    let folder = Folder::new();
    let help = stdout(&folder.motet(["--help"]).assert().code(0));
    let verbs = help.lines().skip_while(|line| !line.starts_with("Commands:")).skip(1);
    // Further lines of a description are indented more.
    let verbs = verbs.take_while(|line| !line.is_empty()).filter(|line| !line.starts_with("   "));
    let verbs: Vec<&str> = verbs.filter_map(|line| line.split_whitespace().next()).collect();
    assert!(verbs.contains(&"mesh") && verbs.contains(&"man"), "{verbs:?}");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = stdout(&folder.motet(["completions", shell]).assert().code(0));
        assert!(verbs.iter().all(|verb| script.contains(verb)), "{shell}");
        // fish writes `-l layers`.
        assert!(script.contains("layers"), "{shell}");
    }
    folder.motet(["man", "share/man1"]).assert().code(0);
    for verb in verbs.into_iter().filter(|verb| *verb != "help") {
        let page = folder.read(&format!("share/man1/motet-{verb}.1"));
        let page = String::from_utf8(page).unwrap();
        assert!(page.contains(".SH SYNOPSIS") && page.contains(&format!("motet {verb}")), "{verb}: {page}");
    }
    assert!(!folder.read("share/man1/motet.1").is_empty());
}
