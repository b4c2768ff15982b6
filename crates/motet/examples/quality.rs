//! Reads tets as raw little-endian f64 (12 per tet), and writes all quality measures of each (11 per tet).
//!
//! `quality IN OUT`; the order is eas, equi-angle skew, smallest and largest
//! dihedral angle (radians), mean ratio, Cubit mean ratio, edge ratio, volume, scaled
//! Jacobian, radius ratio, aspect ratio.

use std::process::ExitCode;

use motet::geometry::quality::{
    aspect_ratio, cubit_mean_ratio, dihedral, eas, edge_ratio, equiangle_skew, mean_ratio, radius_ratio,
    scaled_jacobian, volume,
};

fn measures(tet: [[f64; 3]; 4]) -> [f64; 11] {
    let [low, high] = dihedral::min_max(tet);
    [
        eas(tet),
        equiangle_skew(tet),
        low,
        high,
        mean_ratio(tet),
        cubit_mean_ratio(tet),
        edge_ratio(tet),
        volume(tet),
        scaled_jacobian(tet),
        radius_ratio(tet),
        aspect_ratio(tet),
    ]
}

fn run(input: &str, output: &str) -> std::io::Result<()> {
    let bytes = std::fs::read(input)?;
    let numbers: Vec<f64> = bytes.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
    let tets = numbers.as_chunks::<3>().0.as_chunks::<4>().0;
    let written: Vec<u8> = tets.iter().flat_map(|tet| measures(*tet)).flat_map(f64::to_le_bytes).collect();
    std::fs::write(output, written)
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, output] = &arguments[..] else {
        eprintln!("quality IN OUT");
        return ExitCode::from(2);
    };
    match run(input, output) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
