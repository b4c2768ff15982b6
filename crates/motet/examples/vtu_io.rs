//! Timing of VTU files: `vtu_io read FILE RUNS`, `vtu_io write FILE OUT none|zlib|lz4|lzma RUNS`; prints the
//! seconds of each run as JSON.

use std::time::Instant;

use motet::io::{self, Compression, WriteOptions};
use motet::{Mesh, Result};

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let result = match words[..] {
        ["read", file, runs] => read(file, count(runs)),
        ["write", file, out, compression, runs] => write(file, out, compression, count(runs)),
        _ => usage(),
    };
    match result {
        Ok((mesh, seconds)) => {
            let (points, cells) = (mesh.points.len(), mesh.cells.len());
            println!("{}", serde_json::json!({"seconds": seconds, "points": points, "cells": cells}));
        }
        Err(error) => {
            eprintln!("{error}");
            std::process::exit(3);
        }
    }
}

fn usage() -> ! {
    eprintln!("usage: vtu_io read FILE RUNS | vtu_io write FILE OUT none|zlib|lz4|lzma RUNS");
    std::process::exit(2);
}

fn count(text: &str) -> usize {
    text.parse().unwrap_or_else(|_| usage())
}

fn read(file: &str, runs: usize) -> Result<(Mesh, Vec<f64>)> {
    let mut mesh = io::read(file)?;
    let mut seconds = Vec::new();
    for _ in 0..runs {
        drop(std::mem::take(&mut mesh));
        let start = Instant::now();
        mesh = io::read(file)?;
        seconds.push(start.elapsed().as_secs_f64());
    }
    Ok((mesh, seconds))
}

fn write(file: &str, out: &str, compression: &str, runs: usize) -> Result<(Mesh, Vec<f64>)> {
    let compression = match compression {
        "none" => Compression::None,
        "zlib" => Compression::Zlib,
        "lz4" => Compression::Lz4,
        "lzma" => Compression::Lzma,
        _ => usage(),
    };
    let options = WriteOptions { compression, ..WriteOptions::default() };
    let mesh = io::read(file)?;
    let mut seconds = Vec::new();
    for _ in 0..runs {
        let start = Instant::now();
        io::write(out, &mesh, &options)?;
        seconds.push(start.elapsed().as_secs_f64());
    }
    Ok((mesh, seconds))
}
