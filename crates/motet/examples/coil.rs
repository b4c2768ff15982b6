//! Writes a coil as a surface file, as a target for refinement.
//!
//! `coil OUT.vtp [--at X,Y,Z] [--radius R] [--pitch P] [--turns N] [--wire W]` writes a helix about a line
//! along z through the middle of its axis. The defaults suit the aneurysm of the DOLFIN project
//! (`aneurysm.xml.gz`, LGPL-3), in millimetres: four turns of a wire 0.3 thick.
//!
//! ```text
//! motet refine aneurysm.xml.gz -o fine.vtu --near-size coil.vtp=0.075
//! ```
//!
//! then makes four tets across the wire.

use std::error::Error;

use motet::io::{self, WriteOptions};
use motet::mesh::shapes::Coil;

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let out =
        words.next().ok_or("coil OUT.vtp [--at X,Y,Z] [--radius R] [--pitch P] [--turns N] [--wire W]")?;
    let mut coil =
        Coil { centre: [53.6, 43.3, 35.3], radius: 1.6, pitch: 0.8, turns: 4.0, wire_radius: 0.15 };
    while let (Some(word), Some(value)) = (words.next(), words.next()) {
        match word.as_str() {
            "--at" => {
                let numbers: Vec<f64> = value.split(',').map(str::parse).collect::<Result<_, _>>()?;
                coil.centre = numbers.try_into().map_err(|_| "--at takes three numbers")?;
            }
            "--radius" => coil.radius = value.parse()?,
            "--pitch" => coil.pitch = value.parse()?,
            "--turns" => coil.turns = value.parse()?,
            "--wire" => coil.wire_radius = value.parse()?,
            _ => return Err(format!("unknown argument {word}").into()),
        }
    }
    io::write(&out, &coil.mesh(72, 16)?, &WriteOptions::default())?;
    Ok(())
}
