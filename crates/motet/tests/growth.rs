//! Work grows with the mesh and no faster: the bytes allocated for each tet, counted over a whole call, are
//! no more for a mesh of many tets than for one of few.
//!
//! A table as long as all vertices, made anew for each part of the work, is not seen on small meshes, and
//! never ends on large ones.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

use motet::base::{Point, TetId, Threads};
use motet::delaunay::Triangulation;
use motet::mesh::shapes::{ball, box_grid};
use motet::mesh::{CellKind, Cells, Mesh, Surface, TetPart};
use motet::meshing::{Options, Sizes, Surfaces, fill};
use motet::motion::{self, Mover};
use motet::preflight::Role;
use motet::refine::{self, Refinement};
use motet::remesh;

/// The bytes allocated so far, whether they were freed or not.
static ALLOCATED: AtomicUsize = AtomicUsize::new(0);

struct Counting;

#[allow(unsafe_code, reason = "the allocator counts, and leaves the rest to the system's")]
// SAFETY: all calls go to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATED.fetch_add(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        ALLOCATED.fetch_add(layout.size(), Ordering::Relaxed);
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The bytes allocated for each tet while `work` runs, which returns the number of tets.
fn bytes_per_tet(work: impl FnOnce() -> usize) -> f64 {
    let before = ALLOCATED.load(Ordering::Relaxed);
    let n_tets = work();
    (ALLOCATED.load(Ordering::Relaxed) - before) as f64 / n_tets as f64
}

fn skin(mesh: &Mesh) -> Mesh {
    let surface = Surface::boundary_of(mesh);
    let mut cells = Cells::new();
    surface.triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
    Mesh::new(surface.points, cells)
}

/// Fills a ball of `n` by `n` squares on each of six sides with tets of half the edges of its triangles: many
/// triangles are then missing from the Delaunay tets, and more of them the more triangles there are.
fn filled(n: usize, improves: bool) -> usize {
    let threads = Threads::single();
    let surfaces = Surfaces::new(&[(&skin(&ball(n, 4)), Role::Boundary, "ball")]).unwrap();
    let sizes = Some(Sizes::Uniform(0.8 / n as f64));
    let options = match improves {
        true => Options::with_sizes(sizes, None),
        false => Options { sizes, ..Options::default() },
    };
    let filled = fill(&surfaces, &surfaces.preflight(&threads), &options, &threads).unwrap();
    filled.mesh.cells.len()
}

/// Fills a cube of `n` by `n` squares on each of six sides without points inside: Delaunay tets lack half of
/// the diagonals of the squares, all of a side in one plane.
fn filled_cube(n: usize) -> usize {
    let threads = Threads::single();
    let cube = skin(&box_grid([n; 3], [[0.0; 3], [1.0; 3]]));
    let surfaces = Surfaces::new(&[(&cube, Role::Boundary, "cube")]).unwrap();
    let filled = fill(&surfaces, &surfaces.preflight(&threads), &Options::default(), &threads).unwrap();
    filled.mesh.cells.len()
}

/// A grid of `n` cubes along each axis, whose inner vertices are shaken so that some tets are bad.
fn shaken(n: usize) -> Mesh {
    let mut mesh = box_grid([n; 3], [[0.0; 3], [1.0; 3]]);
    let is_inside = |p: &Point| p.iter().all(|&x| x > 1e-9 && x < 1.0 - 1e-9);
    let noise = |i: usize| (((i + 1) as f64 * 12.9898).sin() * 43_758.545_3).fract();
    for (i, p) in mesh.points.iter_mut().enumerate().filter(|(_, p)| is_inside(p)) {
        (0..3).for_each(|k| p[k] += 0.3 / n as f64 * noise(3 * i + k));
    }
    mesh
}

fn triangulated(n: usize) -> usize {
    let coordinate =
        |i: usize, k: usize| ((i + 1) as f64 * [0.618_033_9, 0.754_877_6, 0.569_840_2][k]).fract();
    let points: Vec<Point> = (0..n).map(|i| [0, 1, 2].map(|k| coordinate(i, k))).collect();
    Triangulation::new(&points, &Threads::single()).unwrap().tets().len()
}

fn remeshed(n: usize) -> usize {
    let rules = motet::mesh::history::Rules::default();
    let mesh = shaken(n);
    remesh::remesh_mesh(&mesh, &remesh::Options::default(), &rules, &Threads::single()).unwrap();
    mesh.cells.len()
}

fn refined(n: usize) -> usize {
    let threads = Threads::single();
    let mesh = TetPart::of(&box_grid([n; 3], [[0.0; 3], [1.0; 3]])).unwrap().mesh;
    let mut refinement = Refinement::new(&mesh, refine::Options::default(), &threads).unwrap();
    let marked: Vec<TetId> = (0..mesh.tets.len()).step_by(3).map(TetId::new).collect();
    refinement.refine(&marked, &threads).unwrap();
    refinement.mesh().tets.len()
}

fn moved(n: usize) -> usize {
    let threads = Threads::single();
    let mesh = box_grid([n; 3], [[0.0; 3], [1.0; 3]]);
    let mover = Mover::new(&mesh, &motion::Options::default(), &threads).unwrap();
    drop(mover);
    mesh.cells.len()
}

#[test]
fn bytes_allocated_per_tet_do_not_grow() {
    type Work = fn(usize) -> usize;
    // Each case with the sizes of a small mesh and of one with some eight times as many tets.
    let cases: [(&str, Work, [usize; 2]); 7] = [
        ("delaunay", triangulated, [4000, 32_000]),
        ("mesh", |n| filled(n, false), [10, 20]),
        ("mesh of planes", filled_cube, [8, 24]),
        ("mesh, improved", |n| filled(n, true), [10, 20]),
        ("remesh", remeshed, [12, 24]),
        ("refine", refined, [10, 20]),
        ("move", moved, [12, 24]),
    ];
    for (name, work, sizes) in cases {
        let [few, many] = sizes.map(|n| bytes_per_tet(|| work(n)));
        println!("{name}: {few:.0} and {many:.0} bytes per tet");
        assert!(many < 1.25 * few, "{name}: {few:.0} bytes per tet, and {many:.0} of a larger mesh");
    }
}
