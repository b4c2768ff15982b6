//! Motet's own vessels as closed surfaces, for other programs to fill.
//!
//! `shapes FOLDER [--around N]` writes `aneurysm.vtp` and `bifurcation.vtp`, with N vertices around each vessel (48 without the word).

use std::error::Error;
use std::path::Path;

use motet::io::{self, WriteOptions};
use motet::mesh::shapes::{Aneurysm, Bifurcation};

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let folder = words.next().ok_or("shapes FOLDER [--around N]")?;
    let around = match words.next().as_deref() {
        None => 48,
        Some("--around") => words.next().ok_or("--around takes a number")?.parse()?,
        Some(word) => return Err(format!("{word} is no word of this example").into()),
    };
    let shapes = [
        ("aneurysm.vtp", Aneurysm { around, ..Aneurysm::default() }.mesh()?),
        ("bifurcation.vtp", Bifurcation { around, ..Bifurcation::default() }.mesh()?),
    ];
    for (file, mesh) in shapes {
        io::write(Path::new(&folder).join(file), &mesh, &WriteOptions::default())?;
    }
    Ok(())
}
