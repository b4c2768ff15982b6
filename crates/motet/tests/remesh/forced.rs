//! Tets that walls force count as good while others are repaired: exactly these tets, and no others of the
//! same quality.

use motet::base::{Point, TetId, Threads, VertexId};
use motet::geometry::quality::eas;
use motet::kernel::Complex;
use motet::mesh::shapes::box_grid;
use motet::mesh::{TetMesh, TetPart};
use motet::remesh::{Options, Outcome, SurfaceRule, remesh};

/// Far enough to separate a copy, and a power of two: coordinates with few digits stay exact.
const APART: f64 = 16.0;

/// A cube of `n^3` cubes whose top is shifted by `shear` along x; coordinates have few digits.
fn sheared(n: usize, shear: f64) -> TetMesh {
    let mut mesh = TetPart::of(&box_grid([n; 3], [[0.0; 3], [1.0; 3]])).unwrap().mesh;
    mesh.points.iter_mut().for_each(|p| p[0] += shear * p[2]);
    mesh.points.as_flattened_mut().iter_mut().for_each(|x| *x = (*x * 4096.0).round() / 4096.0);
    mesh.triangles.clear();
    mesh.patches.clear();
    mesh
}

fn corners(mesh: &TetMesh, tet: usize) -> [Point; 4] {
    mesh.tets[tet].map(|v| mesh.points[v.index()])
}

/// The mesh, with a separate copy of each of its bad tets: its own walls force it, with the same bits.
fn with_copies_of_the_bad(mesh: &TetMesh) -> (TetMesh, usize) {
    let mut all = mesh.clone();
    let bad: Vec<usize> = (0..mesh.tets.len()).filter(|&t| eas(corners(mesh, t)) < 0.2).collect();
    for (i, &t) in bad.iter().enumerate() {
        let first = all.points.len();
        let shift = [APART * (2 + i % 8) as f64, APART * (i / 8 % 8) as f64, APART * (i / 64) as f64];
        let copy = corners(mesh, t).map(|p| [0, 1, 2].map(|axis| p[axis] + shift[axis]));
        assert_eq!(eas(copy).to_bits(), eas(corners(mesh, t)).to_bits());
        all.points.extend(copy);
        all.tets.push([0, 1, 2, 3].map(|i| VertexId::new(first + i)));
        all.regions.push(0);
    }
    (all, bad.len())
}

/// The number of bad tets left in the mesh itself.
fn left_here(outcome: &Outcome) -> usize {
    outcome.report.left.iter().filter(|left| left.place[0] < APART).count()
}

/// The repair of a mesh does not depend on tets elsewhere that are forced by their own walls.
#[test]
fn a_tet_is_not_given_up_because_walls_force_another_of_its_quality() {
    for (n, shear) in [(2, 5.5), (4, 5.5)] {
        let mesh = sheared(n, shear);
        let (all, n_copies) = with_copies_of_the_bad(&mesh);
        let surface = SurfaceRule::Adapt { distance: Some(1e-3) };
        let options = Options { surface, ..Options::default() };
        let [alone, beside] =
            [&mesh, &all].map(|mesh| left_here(&remesh(mesh, &options, &Threads::single()).unwrap()));
        println!("{n} {shear}: {n_copies} bad, left alone {alone}, beside copies {beside}");
        assert!(n_copies > 20 && 4 * alone < n_copies, "{n} {shear}: most are repaired");
        assert!(4 * beside < n_copies, "{n} {shear}: {beside} of {n_copies} are given up beside copies");
    }
}

#[test]
fn a_tet_that_is_marked_counts_as_good_and_another_of_the_same_bits_does_not() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.5, 1.0, 0.0], [0.5, 1.0, 0.125]];
    let apart = corners.map(|[x, y, z]| [x + APART, y, z]);
    let tets = [0, 4].map(|first| [0, 1, 2, 3].map(|i| VertexId::new(first + i)));
    let mut complex = Complex::new(&TetMesh::new([corners, apart].concat(), tets.to_vec())).unwrap();
    let quality = eas(corners);
    assert!(quality > 0.0 && quality < 0.2);
    assert_eq!(complex.below(0.2, &Threads::single()), [TetId(0), TetId(1)]);
    complex.exempt(&[TetId(0)], 0.2);
    assert_eq!(complex.below(0.2, &Threads::single()), [TetId(1)]);
    assert_eq!(complex.quality(TetId(1)).to_bits(), quality.to_bits());
    complex.verify().unwrap();
    complex.end_exemptions();
    assert_eq!(complex.below(0.2, &Threads::single()), [TetId(0), TetId(1)]);
    assert_eq!(complex.quality(TetId(0)).to_bits(), quality.to_bits());
}
