//! The surfaces that the demo starts from.

use std::path::Path;

use motet::base::VertexId;
use motet::io::{self, WriteOptions};
use motet::mesh::shapes::{Aneurysm, CenterLine, Coil, Flap, Stent};
use motet::mesh::{CellKind, Cells, Field, LabelNames, Surface};
use motet::{Mesh, Result};

/// Writes `aneurysm.vtp`, `coil.vtp`, `stent.vtp`, `lumen.vtp` and `flap.vtp`.
pub(super) fn write(folder: &Path) -> Result<()> {
    let aneurysm = Aneurysm { around: 32, ..Aneurysm::default() };
    let flap = Flap { around: 32, slices: 40, reach: 0.72, ..Flap::default() }.mesh()?;
    let shapes = [
        ("aneurysm.vtp", aneurysm.mesh()?),
        ("coil.vtp", coil(&aneurysm)?),
        ("stent.vtp", stent(&aneurysm)?),
        ("lumen.vtp", patches(&flap, &["wall", "inlet", "outlet"])?),
        ("flap.vtp", patches(&flap, &["flap"])?),
    ];
    for (file, mesh) in shapes {
        io::write(folder.join(file), &mesh, &WriteOptions::default())?;
    }
    Ok(())
}

/// A coil in the sac, coaxial with it.
fn coil(aneurysm: &Aneurysm) -> Result<Mesh> {
    let coil = Coil { centre: [0.0; 3], radius: 0.75, pitch: 0.45, turns: 2.5, wire_radius: 0.1 };
    let mut loops = coil.mesh(48, 8)?;
    loops.points.iter_mut().for_each(|p| *p = [p[0], aneurysm.sac_height + 0.1 + p[2], -p[1]]);
    Ok(loops)
}

/// A stent in delivery: in the vessel at the neck, not yet expanded.
fn stent(aneurysm: &Aneurysm) -> Result<Mesh> {
    // The axis of the vessel is a circular arc with its midpoint at the origin.
    let bend = aneurysm.length / aneurysm.bend_deg.to_radians();
    let on_axis = |i: i32| {
        let angle = aneurysm.bend_deg.to_radians() * (f64::from(i) / 100.0 - 0.5) * 0.25;
        [bend * angle.sin(), bend * (angle.cos() - 1.0), 0.0]
    };
    let axis = CenterLine::new(&(0..=100).map(on_axis).collect::<Vec<_>>())?;
    let lattice = Stent {
        length: axis.length(),
        rings: 5,
        crowns: 4,
        strut_width: 0.12,
        // Thicker or wider struts have narrower triangles, which force bad tets.
        thickness: 0.1,
        ..Stent::default()
    };
    let mut stent = lattice.mesh(0.72 * aneurysm.radius)?;
    stent.points = axis.bent(&stent.points);
    Ok(stent)
}

/// Some patches of a surface, as a surface of their own.
fn patches(mesh: &Mesh, names: &[&str]) -> Result<Mesh> {
    let surface = Surface::of(mesh);
    let labels = names.iter().map(|name| mesh.find_patch(name)).collect::<Result<Vec<_>>>()?;
    let kept = surface.triangles.iter().zip(&surface.patches).filter(|(_, patch)| labels.contains(patch));
    let (mut cells, mut patch_ids, mut new) = (Cells::new(), Vec::new(), vec![u32::MAX; mesh.points.len()]);
    let mut points = Vec::new();
    for (triangle, &patch) in kept {
        let corners = triangle.map(|v| {
            if new[v.index()] == u32::MAX {
                new[v.index()] = points.len() as u32;
                points.push(mesh.points[v.index()]);
            }
            VertexId(new[v.index()])
        });
        cells.push(CellKind::TRIANGLE, corners);
        patch_ids.push(patch);
    }
    let of_patches = mesh.label_names.patches.iter().filter(|(label, _)| labels.contains(label));
    let names = of_patches.map(|(&label, name)| (label, name.clone())).collect();
    Ok(Mesh {
        cell_data: vec![Field::scalars("patch", patch_ids)],
        label_names: LabelNames { patches: names, ..LabelNames::default() },
        ..Mesh::new(points, cells)
    })
}
