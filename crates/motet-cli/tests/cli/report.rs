//! `motet report`: its exit statuses and what it prints.

use crate::common::{Folder, stderr, stdout};
use serde_json::Value;

#[test]
fn a_page_is_written_and_reported() {
    let folder = Folder::new();
    let mesh = folder.cube("cube.vtu");
    folder.write("run.jsonl", b"{\"step\": 0, \"bad\": 3}\n{\"step\": 1, \"bad\": 0}\n");
    let call = folder.motet(["report", &mesh, "run.jsonl", "-o", "page.html", "--json"]).assert().success();
    let reported: Value = serde_json::from_str(&stdout(&call)).expect("one object");
    assert_eq!(reported["inputs"][0]["whole"], 1);
    assert_eq!(reported["inputs"][1]["rows"], 2);
    assert_eq!(reported["bytes"], folder.read("page.html").len());
    assert_eq!(folder.names(), ["cube.vtu", "page.html", "run.jsonl"]);
}

#[test]
fn wrong_words_exit_with_2_and_wrong_files_with_3() {
    let folder = Folder::new();
    let mesh = folder.cube("cube.vtu");
    folder.write("list.json", b"[1, 2]");
    let refused = |words: &[&str], code: i32, what: &str| {
        let call = folder.motet(words).assert().code(code);
        assert!(stderr(&call).contains(what), "{words:?}: {}", stderr(&call));
    };
    refused(&["report", "-o", "page.html"], 2, "Usage");
    refused(&["report", &mesh, "-o", "page.pdf"], 2, "ends in .html");
    refused(&["report", &mesh, "-o", "page.html", "--budget", "0"], 2, "megabytes");
    refused(
        &["report", "list.json", "-o", "page.html"],
        3,
        "list.json: an object or a list of objects is expected",
    );
    refused(&["report", "missing.pvd", "-o", "page.html"], 3, "missing.pvd");
    assert_eq!(folder.names(), ["cube.vtu", "list.json"]);
}
