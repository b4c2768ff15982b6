//! Repairs the bad tets of a mesh.
use motet::base::VertexId;
use motet::mesh::{CellKind, TetMesh};
use motet::remesh::{Options, remesh};
fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let mesh = motet::io::read(&args[0]).unwrap();
    let tets: Vec<[VertexId; 4]> = mesh.cells.tets().map(|t| t.1).collect();
    let mut tm = TetMesh::new(mesh.points.clone(), tets);
    for (_, kind, v) in mesh.cells.iter() {
        if kind == CellKind::TRIANGLE {
            tm.triangles.push([v[0], v[1], v[2]]);
            tm.patches.push(1);
        }
    }
    let options = Options { min_eas: args.get(1).map_or(0.2, |x| x.parse().unwrap()), surface: if args.iter().any(|a| a == "adapt") { motet::remesh::SurfaceRule::Adapt { distance: None } } else { motet::remesh::SurfaceRule::Keep }, ..Options::default() };
    for _ in 0..args.get(3).map_or(3, |x| x.parse().unwrap_or(1)) {
        let t = std::time::Instant::now();
        let out = remesh(&tm, &options).unwrap();
        println!("{:.1} ms {:?}", t.elapsed().as_secs_f64() * 1e3, out.report);
        if args.len() > 2 {
            out.complex.verify().unwrap();
        }
    }
}
