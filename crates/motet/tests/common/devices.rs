//! Hosts and devices for tests of implantation.

use super::random::Random;
use motet::base::{CellId, Point, VertexId};
use motet::implant::{Device, Inside};
use motet::mesh::Mesh;
use motet::mesh::shapes::{Coil, Stent, ball, box_grid};

/// A box of edge 3 around the origin, with cells of edge 3 / n.
pub(crate) fn room(n: usize) -> Mesh {
    box_grid([n; 3], [[-1.5; 3], [1.5; 3]])
}

pub(crate) fn moved(mut mesh: Mesh, by: impl Fn(Point) -> Point) -> Mesh {
    mesh.points.iter_mut().for_each(|p| *p = by(*p));
    mesh
}

pub(crate) fn small_ball(radius: f64, at: Point) -> Mesh {
    moved(ball(3, 2), |p| [0, 1, 2].map(|i| at[i] + radius * p[i]))
}

pub(crate) fn coil(at: Point) -> Mesh {
    let coil = Coil { centre: at, radius: 0.6, pitch: 0.5, turns: 2.0, wire_radius: 0.12 };
    coil.mesh(40, 8).unwrap()
}

/// The bits of the corners of a facet, in an order independent of numbering.
pub(crate) fn key<const N: usize>(mut corners: [Point; N]) -> [[u64; 3]; N] {
    // Maps -0.0 to 0.0.
    let bits = |p: Point| p.map(|x| (x + 0.0).to_bits());
    corners.sort_by_key(|p| bits(*p));
    corners.map(bits)
}

pub(crate) fn tets(mesh: &Mesh) -> impl Iterator<Item = (CellId, [Point; 4])> + '_ {
    mesh.cells.tets().map(|(cell, tet)| (cell, tet.map(|v| mesh.points[v.index()])))
}

pub(crate) fn stent() -> Mesh {
    let stent = Stent {
        length: 2.0,
        rings: 2,
        crowns: 4,
        strut_width: 0.12,
        thickness: 0.1,
        link_length: 0.4,
        link_every: 2,
        segments: 4,
    };
    stent.mesh(0.8).unwrap()
}

/// A device of one of five shapes at a random place; every fourth is on the lattice of the host.
pub(crate) fn random_device(random: &mut Random) -> (String, Device) {
    let kind = (random.next() * 5.0) as usize;
    let on_lattice = random.next() < 0.25;
    let at: Point = std::array::from_fn(|_| {
        let x = random.between(-1.3, 1.3);
        if on_lattice { (x / 0.375).round() * 0.375 } else { x }
    });
    let size = if on_lattice { 0.375 } else { random.between(0.1, 0.7) };
    let place = |p: Point| [0, 1, 2].map(|i| at[i] + size * p[i]);
    let (name, mesh) = match kind {
        0 => ("ball", moved(ball(3, 2), place)),
        1 => ("box", moved(box_grid([2; 3], [[-1.0; 3], [1.0; 3]]), place)),
        2 => ("coil", moved(coil([0.0; 3]), place)),
        3 => ("stent", moved(stent(), |p| place([p[0], p[1], p[2] - 1.0]))),
        _ => {
            let ring: Vec<Point> = (0..16)
                .map(|i| f64::from(i) * std::f64::consts::TAU / 16.0)
                .map(|a| place([a.cos(), a.sin(), 0.0]))
                .collect();
            let segments: Vec<[VertexId; 2]> =
                (0..16).map(|i| [VertexId(i), VertexId((i + 1) % 16)]).collect();
            ("torus", motet::mesh::shapes::wire(&ring, &segments, 0.3 * size, 8).unwrap())
        }
    };
    let mut device = Device::new(mesh, name);
    device.inside = match (device.inside, (random.next() * 3.0) as usize) {
        (_, 0) => Inside::Hollow,
        (_, 1) => Inside::Filled,
        (inside, _) => inside,
    };
    (format!("{name} at {at:?}, size {size}, {:?}", device.inside), device)
}
