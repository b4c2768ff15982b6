//! Writes motet's own vessels and devices as closed surfaces, for other programs to fill.
//!
//! `shapes FOLDER [--around N]` writes `aneurysm.vtp` and `bifurcation.vtp`, with N vertices around each
//! vessel (48 by default); `loops.vtp`, a coil that lies in the sac of the aneurysm; `stent.vtp`, a stent in
//! its vessel, across the neck, pressed into the wall by a twentieth of the radius; `box.vtu` and `ball.vtu`,
//! both of tets, one in the middle of the other; `block.vtu` and `turns.vtp`, a box of tets, and a coil of
//! 11,520 triangles that lies in it.

use std::error::Error;
use std::path::Path;

use motet::io::{self, WriteOptions};
use motet::mesh::shapes::{Aneurysm, Bifurcation, CenterLine, Coil, Stent, ball, box_grid};

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let folder = words.next().ok_or("shapes FOLDER [--around N]")?;
    let around = match words.next().as_deref() {
        None => 48,
        Some("--around") => words.next().ok_or("--around takes a number")?.parse()?,
        Some(word) => return Err(format!("unknown argument {word}").into()),
    };
    let aneurysm = Aneurysm { around, ..Aneurysm::default() };
    let coil = Coil { centre: [0.0; 3], radius: 0.8, pitch: 0.35, turns: 4.0, wire_radius: 0.075 };
    let mut loops = coil.mesh(120, 12)?;
    // Align the coil's axis with that of the sac.
    loops.points.iter_mut().for_each(|p| *p = [p[0], aneurysm.sac_height + p[2], -p[1]]);
    // The axis of the vessel is a circular arc with its midpoint at the origin.
    let bend = aneurysm.length / aneurysm.bend_deg.to_radians();
    let on_axis = |i: i32| {
        let angle = aneurysm.bend_deg.to_radians() * (f64::from(i) / 200.0 - 0.5) * 0.6;
        [bend * angle.sin(), bend * (angle.cos() - 1.0), 0.0]
    };
    let axis = CenterLine::new(&(0..=200).map(on_axis).collect::<Vec<_>>())?;
    let lattice =
        Stent { length: axis.length(), crowns: 6, strut_width: 0.12, link_length: 0.2, ..Stent::default() };
    let mut stent = lattice.mesh(1.05 * aneurysm.radius)?;
    stent.points = axis.bent(&stent.points);
    // 359 pieces.
    let turns = Coil { centre: [0.0; 3], radius: 0.6, pitch: 0.5, turns: 359.0 / 120.0, wire_radius: 0.12 };
    let shapes = [
        ("aneurysm.vtp", aneurysm.mesh()?),
        ("bifurcation.vtp", Bifurcation { around, ..Bifurcation::default() }.mesh()?),
        ("loops.vtp", loops),
        ("stent.vtp", stent),
        ("box.vtu", box_grid([12; 3], [[-2.5; 3], [2.5; 3]])),
        ("ball.vtu", ball(6, 4)),
        ("block.vtu", box_grid([12; 3], [[-1.5; 3], [1.5; 3]])),
        ("turns.vtp", turns.mesh(120, 16)?),
    ];
    for (file, mesh) in shapes {
        io::write(Path::new(&folder).join(file), &mesh, &WriteOptions::default())?;
    }
    Ok(())
}
