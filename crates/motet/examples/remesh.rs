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
    let options = Options {
        min_eas: args.get(1).map_or(0.2, |x| x.parse().unwrap()),
        surface: if args.iter().any(|a| a == "adapt") {
            motet::remesh::SurfaceRule::Adapt { distance: None }
        } else {
            motet::remesh::SurfaceRule::Keep
        },
        goal: if args.iter().any(|a| a == "best") {
            motet::remesh::Goal::Best
        } else {
            motet::remesh::Goal::Repair
        },
        ..Options::default()
    };
    for _ in 0..args.get(3).map_or(3, |x| x.parse().unwrap_or(1)) {
        let t = std::time::Instant::now();
        let out = remesh(&tm, &options).unwrap();
        println!("{:.1} ms {:?}", t.elapsed().as_secs_f64() * 1e3, out.report);
        let c = &out.complex;
        let mm = c
            .tets()
            .map(|t| motet::geometry::quality::dihedral::min_max(c.corners(t)))
            .fold([9.0f64, 0.0f64], |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        println!("dihedral {:?}", mm.map(f64::to_degrees));
        if std::env::var("DIAG").is_ok() {
            let c = &out.complex;
            for t in c.below(options.min_eas).into_iter().step_by(7) {
                let v = c.vertices(t);
                let p = c.corners(t);
                let l: Vec<String> = motet::geometry::tet::EDGES
                    .iter()
                    .map(|e| format!("{:.4}", motet::geometry::vector::distance(p[e[0]], p[e[1]])))
                    .collect();
                println!(
                    "{:.4} {:?} {} walls {:?}",
                    c.quality(t),
                    v.map(|v| c.hold(v)),
                    l.join(" "),
                    [0, 1, 2, 3].map(|i| c.is_wall(t, i) as u8)
                );
            }
        }
        if args.len() > 2 {
            out.complex.verify().unwrap();
        }
    }
}
