//! Refinement in the form that bench-compare requires of all programs: the same mesh, the same marks,
//! generation by generation.
//!
//! `refine_rivals CASE.json OUT` reads the mesh and the rule for marks that bench-compare wrote beside
//! `CASE.json`, and prints one JSON object with a row for each generation; meshes go to `OUT_1.points` and
//! `OUT_1.tets`, and so on, unless these exist. The time runs from the marks to the mesh. `refine_rivals
//! --coil FILE` writes the points of a coil's surface as f64.
//!
//! A tet is marked when its longest edge is longer than `longest`, and its centroid is nearer to one of the
//! points `near` than this generation's radius; with `whole` the radius is increased by the distance of the
//! tet's farthest corner from its centroid. Without `near` all tets are marked.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use motet::base::{Point, TetId, Threads, VertexId};
use motet::geometry::tet::{EDGES, centroid};
use motet::geometry::vector::distance;
use motet::mesh::TetMesh;
use motet::mesh::shapes::Coil;
use motet::refine::{Options, Refinement};
use serde_json::{Map, Value, json};

/// Five turns of wire of radius 0.05 beside the sphere of the benchmark's mesh.
fn coil() -> motet::Result<Vec<Point>> {
    let coil = Coil { centre: [2.5, 0.0, 0.0], radius: 0.6, pitch: 0.4, turns: 5.0, wire_radius: 0.05 };
    Ok(coil.mesh(72, 12)?.points)
}

fn raw<const N: usize>(path: &Path) -> std::io::Result<Vec<[u8; N]>> {
    Ok(fs::read(path)?.as_chunks::<N>().0.to_vec())
}

fn read_points(path: &Path) -> std::io::Result<Vec<Point>> {
    let numbers: Vec<f64> = raw(path)?.into_iter().map(f64::from_le_bytes).collect();
    Ok(numbers.as_chunks::<3>().0.to_vec())
}

fn read_tets(path: &Path) -> std::io::Result<Vec<[VertexId; 4]>> {
    let ids: Vec<VertexId> = raw(path)?.into_iter().map(|b| VertexId(u32::from_le_bytes(b))).collect();
    Ok(ids.as_chunks::<4>().0.to_vec())
}

fn write(mesh: &TetMesh, out: &str, generation: usize) -> std::io::Result<()> {
    let path = |end: &str| PathBuf::from(format!("{out}_{generation}.{end}"));
    if path("tets").exists() {
        return Ok(());
    }
    fs::write(
        path("points"),
        mesh.points.iter().flatten().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>(),
    )?;
    fs::write(path("tets"), mesh.tets.iter().flatten().flat_map(|v| v.0.to_le_bytes()).collect::<Vec<_>>())
}

/// The rule by which tets are marked for division.
struct Marks {
    near: Option<Vec<Point>>,
    radii: Vec<f64>,
    longest: f64,
    whole: bool,
}

impl Marks {
    fn read(case: &Value, folder: &Path) -> Result<Self, Box<dyn Error>> {
        let near = case["near"].as_str().map(|name| read_points(&folder.join(name))).transpose()?;
        let radii = serde_json::from_value(case["radii"].clone())?;
        let longest = case["longest"].as_f64().ok_or("longest?")?;
        Ok(Self { near, radii, longest, whole: case["whole"] == true })
    }

    fn of(&self, mesh: &TetMesh, generation: usize, threads: &Threads) -> Vec<TetId> {
        let Some(near) = &self.near else { return (0..mesh.tets.len()).map(TetId::new).collect() };
        let side = |k: usize, least: f64, of: fn(f64, f64) -> f64| near.iter().map(|p| p[k]).fold(least, of);
        let low: [f64; 3] = std::array::from_fn(|k| side(k, f64::INFINITY, f64::min));
        let high: [f64; 3] = std::array::from_fn(|k| side(k, f64::NEG_INFINITY, f64::max));
        let radius = self.radii[(generation - 1).min(self.radii.len() - 1)];
        let flags = threads.map(mesh.tets.len(), |i| {
            let corners = mesh.tets[i].map(|v| mesh.points[v.index()]);
            if EDGES.iter().all(|&[a, b]| distance(corners[a], corners[b]) <= self.longest) {
                return false;
            }
            let centre = centroid(corners);
            let own = corners.iter().map(|&corner| distance(corner, centre)).fold(0.0, f64::max);
            let reach = if self.whole { radius + own } else { radius };
            let is_beside = (0..3).all(|k| low[k] - reach <= centre[k] && centre[k] <= high[k] + reach);
            is_beside && near.iter().any(|&point| distance(point, centre) < reach)
        });
        (0..).zip(flags).filter(|(_, is_marked)| *is_marked).map(|(i, _)| TetId(i)).collect()
    }
}

fn run(case: &Path, out: &str) -> Result<Value, Box<dyn Error>> {
    let folder = case.parent().ok_or("no folder")?;
    let case: Value = serde_json::from_slice(&fs::read(case)?)?;
    let threads = Threads::single();
    let marks = Marks::read(&case, folder)?;
    let first =
        TetMesh::new(read_points(&folder.join("first.points"))?, read_tets(&folder.join("first.tets"))?);
    let begin = Instant::now();
    let mut refinement = Refinement::new(&first, Options::default(), &threads)?;
    let mut result = Map::new();
    result.insert("setup_seconds".into(), begin.elapsed().as_secs_f64().into());
    let (mut rows, mut total) = (Vec::new(), 0.0);
    for generation in 1..=case["generations"].as_u64().ok_or("generations?")? as usize {
        let marked = marks.of(refinement.mesh(), generation, &threads);
        if marked.is_empty() {
            break;
        }
        let begin = Instant::now();
        let summary = refinement.refine(&marked, &threads)?;
        let seconds = begin.elapsed().as_secs_f64();
        total += seconds;
        result.insert(format!("generation_{generation}_seconds"), seconds.into());
        let memory = refinement.memory() as f64 / summary.n_tets as f64;
        rows.push(json!({"marked": marked.len(), "tets": summary.n_tets, "memory_per_tet": memory}));
        write(refinement.mesh(), out, generation)?;
    }
    result.extend([
        ("generations".into(), rows.into()),
        ("seconds".into(), total.into()),
        ("version".into(), env!("CARGO_PKG_VERSION").into()),
    ]);
    Ok(result.into())
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match &words[..] {
        [flag, file] if flag == "--coil" => {
            fs::write(file, coil()?.iter().flatten().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>())?;
        }
        [case, out] => println!("{}", run(Path::new(case), out)?),
        _ => return Err("refine_rivals CASE.json OUT, or refine_rivals --coil FILE".into()),
    }
    Ok(())
}
