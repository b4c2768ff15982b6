//! `motet view`: the address that it prints, and what it refuses.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::process::{Command, Stdio};

use crate::common::{Folder, stderr};
use assert_cmd::cargo::cargo_bin;
use serde_json::Value;

#[test]
fn a_page_is_served_at_the_printed_address_alone() {
    let folder = Folder::new();
    let mesh = folder.cube("cube.vtu");
    let mut program = Command::new(cargo_bin("motet"))
        .args(["view", &mesh, "--no-browser", "--json"])
        .current_dir(folder.path("."))
        .stdout(Stdio::piped())
        .spawn()
        .expect("it starts");
    let mut lines = BufReader::new(program.stdout.take().expect("a pipe")).lines();
    let mut text = String::new();
    while !text.contains('}') {
        text += &lines.next().expect("a line").expect("text");
    }
    let reported: Value = serde_json::from_str(&text).expect("one object");
    let address = reported["address"].as_str().expect("text");
    let (host, path) = address.strip_prefix("http://").and_then(|rest| rest.split_once('/')).expect("a path");
    let get = |path: &str| {
        let mut stream = TcpStream::connect(host).expect("it listens");
        write!(stream, "GET /{path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n").expect("sent");
        let mut answer = String::new();
        stream.read_to_string(&mut answer).expect("an answer");
        answer
    };
    assert!(get(path).starts_with("HTTP/1.1 200"), "{address}");
    assert!(get(&format!("{path}facts")).contains("\"can_undo\":false"));
    assert!(get("").starts_with("HTTP/1.1 404"));
    let mut taken =
        folder.motet(["view", &mesh, "--no-browser", "--port", host.split(':').nth(1).expect("a port")]);
    let call = taken.assert().code(2);
    assert!(stderr(&call).contains("port"), "{}", stderr(&call));
    program.kill().and_then(|()| program.wait()).expect("it ends");
    assert_eq!(folder.names(), ["cube.vtu"]);
}

#[test]
fn a_file_that_cannot_be_read_is_refused() {
    let folder = Folder::new();
    folder.write("a.vtu", b"<VTKFile");
    folder.motet(["view", "a.vtu", "--no-browser"]).assert().code(3);
    folder.motet(["view", "missing.vtu", "--no-browser"]).assert().code(3);
    folder.motet(["view"]).assert().code(2);
}
