//! Tests that `motet.h` declares what this library has: constants and structs, by their names, numbers, types
//! and defaults; and that `motet.hpp` passes all options on.

use std::collections::BTreeMap;

use motet::base::Names;
use motet::mesh::CellKind;
use motet::motion::MethodName;

use crate::changing::{MotetFillOptions, MotetImplantOptions, MotetRemeshOptions};
use crate::constants::{self, Constant};
use crate::contact::MotetContactOptions;
use crate::memory::Versioned;
use crate::motion::{MotetCertificate, MotetMoverOptions};
use crate::moving::{MotetMovingOptions, MotetStep};
use crate::refinement::MotetRefinementOptions;

const HEADER: &str = include_str!("../include/motet.h");
const HEADER_CPP: &str = include_str!("../include/motet.hpp");

/// The parts of the header between an opening text and a closing one.
fn between<'a>(open: &'a str, close: &'a str) -> impl Iterator<Item = &'a str> {
    HEADER.split(open).skip(1).map(move |rest| rest.split_once(close).expect("what opens also closes").0)
}

/// A declaration and the comment behind it, on one line each.
struct Line {
    code: String,
    comment: String,
}

/// The lines of a body: each ends with `end`, a comment may follow.
fn lines(body: &str, end: char) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    let mut rest = body.trim();
    while !rest.is_empty() {
        if let Some(comment) = rest.strip_prefix("/*") {
            let (comment, behind) = comment.split_once("*/").expect("a comment ends");
            let words = comment.split_whitespace().filter(|&word| word != "*");
            lines.last_mut().expect("comments follow what they are about").comment =
                words.collect::<Vec<_>>().join(" ");
            rest = behind.trim_start();
            continue;
        }
        let n = rest.find([end, '/']).unwrap_or(rest.len());
        lines.push(Line { code: rest[..n].trim().to_owned(), comment: String::new() });
        rest = rest[n..].trim_start_matches(end).trim_start();
    }
    lines
}

/// The constants of the header and their numbers.
fn declared_constants() -> BTreeMap<String, i32> {
    let all = between("enum {", "}").flat_map(|body| lines(body, ','));
    all.map(|line| {
        let (name, number) = line.code.split_once(" = ").expect("each constant has its number");
        (name.to_owned(), number.parse().expect("a number"))
    })
    .collect()
}

/// The constants of a table and their numbers.
fn numbers<T>(constants: &[Constant<T>]) -> Vec<(&'static str, i32)> {
    constants.iter().map(|constant| (constant.name, constant.number)).collect()
}

#[test]
fn each_constant_of_the_header_has_the_number_of_its_table() {
    let kinds = [
        ("MOTET_VERTEX", CellKind::VERTEX),
        ("MOTET_LINE", CellKind::LINE),
        ("MOTET_TRIANGLE", CellKind::TRIANGLE),
        ("MOTET_QUAD", CellKind::QUAD),
        ("MOTET_TETRA", CellKind::TETRA),
        ("MOTET_HEXAHEDRON", CellKind::HEXAHEDRON),
        ("MOTET_WEDGE", CellKind::WEDGE),
        ("MOTET_PYRAMID", CellKind::PYRAMID),
        ("MOTET_TETRA10", CellKind::QUADRATIC_TETRA),
    ];
    let kinds = kinds.map(|(name, kind)| (name, i32::from(kind.0)));
    let statuses = [
        ("MOTET_OK", constants::OK),
        ("MOTET_ERROR_INTERNAL", constants::INTERNAL),
        ("MOTET_ERROR_OPTIONS", constants::OPTIONS),
        ("MOTET_ERROR_INPUT", constants::INPUT),
        ("MOTET_ERROR_IO", constants::IO),
        ("MOTET_ERROR_STOPPED", constants::STOPPED),
    ];
    let tables = [
        statuses.to_vec(),
        kinds.to_vec(),
        numbers(constants::ON),
        numbers(constants::METHODS),
        numbers(constants::RULES),
        numbers(constants::SURFACE_RULES),
        numbers(constants::INSIDES),
        numbers(constants::ADAPTS),
        numbers(constants::ROOMS),
    ];
    let known: BTreeMap<String, i32> =
        tables.into_iter().flatten().map(|(name, number)| (name.to_owned(), number)).collect();
    assert_eq!(declared_constants(), known);
}

#[test]
fn each_method_of_the_library_has_a_constant_with_its_name() {
    for &method in MethodName::ALL {
        let constant = constants::METHODS.iter().find(|constant| constant.meaning == method);
        let name = format!("MOTET_{}", method.as_str().to_uppercase());
        assert_eq!(constant.map(|constant| constant.name), Some(name.as_str()));
    }
}

#[test]
fn a_number_without_a_constant_is_refused_with_a_list_of_those_there_are() {
    let message = constants::method(7).expect_err("there is no method 7").to_string();
    assert!(message.contains("unknown method 7"), "{message}");
    for constant in constants::METHODS {
        assert!(message.contains(&format!("{} ({})", constant.name, constant.number)), "{message}");
    }
    assert!(constants::room(2).is_err() && constants::surface_rule(-1, 0.0).is_err());
}

/// The type in C of a member's type in Rust; the length of an array stands behind the name.
fn type_in_c(kind: &str) -> (&str, &str) {
    match kind {
        "i32" => ("int32_t ", ""),
        "i64" => ("int64_t ", ""),
        "f64" => ("double ", ""),
        "[f64; 3]" => ("double ", "[3]"),
        "*const *const c_char" => ("const char *const *", ""),
        "*const i32" => ("const int32_t *", ""),
        "*const f64" => ("const double *", ""),
        "*mut MotetWatch" => ("motet_watch *", ""),
        other => panic!("a member has the type {other}"),
    }
}

/// The default that a comment states, as `Debug` writes a value of a type.
fn stated_default(comment: &str, kind: &str) -> String {
    let words = comment.split_once("default ").map_or("0", |(_, words)| words);
    let word = words.split([' ', ':', ';', ',']).next().unwrap_or_default();
    let number = declared_constants().get(word).map_or_else(|| word.to_owned(), ToString::to_string);
    match kind {
        "f64" => format!("{:?}", number.parse::<f64>().expect("a default is a number")),
        "i32" | "i64" => number,
        _ => "0x0".to_owned(),
    }
}

/// Compares a struct of this library with that of the header.
fn check_struct<T: Versioned>() {
    let name = T::INIT.trim_end_matches("_init");
    let (open, close) = (format!("typedef struct {name} {{"), format!("}} {name};"));
    let body = between(&open, &close).next().unwrap_or_else(|| panic!("the header has no {name}"));
    let declared = lines(body, ';');
    assert_eq!(declared[0].code, "size_t size", "{name}");
    let members = T::members();
    assert_eq!(declared.len(), members.len() + 1, "{name}");
    for (line, member) in declared[1..].iter().zip(&members) {
        let (before, behind) = type_in_c(member.kind);
        assert_eq!(line.code, format!("{before}{}{behind}", member.name), "{name}");
        if name.ends_with("_options") {
            assert_eq!(stated_default(&line.comment, member.kind), member.default, "{name}: {}", member.name);
        }
    }
    if name.ends_with("_options") {
        let given = HEADER_CPP.split_once(&format!("inline {name} given(")).expect("motet.hpp has them").1;
        let given = given.split_once("\n}").expect("a function ends").0;
        let is_of_name = |c: char| c.is_alphanumeric() || c == '_';
        let set: Vec<&str> = given
            .split(" c.")
            .skip(1)
            .map(|rest| rest.split(|c| !is_of_name(c)).next().unwrap_or(""))
            .collect();
        assert_eq!(set, members.iter().map(|member| member.name).collect::<Vec<_>>(), "{name} in motet.hpp");
    }
}

#[test]
fn each_struct_of_the_header_has_the_members_and_the_defaults_of_the_library() {
    check_struct::<MotetMoverOptions>();
    check_struct::<MotetCertificate>();
    check_struct::<MotetRemeshOptions>();
    check_struct::<MotetImplantOptions>();
    check_struct::<MotetFillOptions>();
    check_struct::<MotetRefinementOptions>();
    check_struct::<MotetContactOptions>();
    check_struct::<MotetMovingOptions>();
    check_struct::<MotetStep>();
    assert_eq!(HEADER.matches("    size_t size;").count(), 9);
}
