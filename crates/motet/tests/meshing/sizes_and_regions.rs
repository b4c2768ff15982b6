//! Volume meshes of surfaces: sizes inside; regions by their places, numbers and names.

use motet::base::{Point, Threads, VertexId};
use motet::geometry::quality::eas;
use motet::geometry::tet::EDGES;
use motet::geometry::vector::distance;
use motet::mesh::check::{DefectKind, check};
use motet::mesh::shapes::{Aneurysm, Bifurcation, Flap, ThickTube, ball, box_grid};
use motet::mesh::{CellKind, Cells, Field, Mesh, Surface, cone_volume};
use motet::meshing::{Filled, Grading, Options, Seed, Sizes, Surfaces, fill, sizes_by};
use motet::preflight::Role;
use motet::{Result, remesh};

fn joined(meshes: &[(&Mesh, &str)]) -> Surfaces {
    let meshes: Vec<_> = meshes.iter().map(|(mesh, name)| (*mesh, Role::Boundary, *name)).collect();
    Surfaces::new(&meshes).unwrap()
}

fn filled(surfaces: &Surfaces, options: &Options) -> Result<Filled> {
    let threads = Threads::new(2).unwrap();
    fill(surfaces, &surfaces.preflight(&threads), options, &threads)
}

/// The boundary of a mesh, scaled by a factor and shifted along x.
fn skin(mesh: &Mesh, factor: f64, along: f64) -> Mesh {
    let surface = Surface::boundary_of(mesh);
    let mut cells = Cells::new();
    surface.triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
    let moved = surface.points.iter().map(|p| [factor * p[0] + along, factor * p[1], factor * p[2]]);
    Mesh::new(moved.collect(), cells)
}

/// The volume that triangles enclose.
fn enclosed(mesh: &Mesh) -> f64 {
    let surface = Surface::of(mesh);
    surface.triangles.iter().map(|t| cone_volume(t.iter().copied(), &surface.points, [0.0; 3])).sum()
}

fn tets(mesh: &Mesh) -> Vec<[VertexId; 4]> {
    let tet = |v: &[VertexId]| <[VertexId; 4]>::try_from(v).unwrap();
    mesh.cells.iter().filter(|(_, kind, _)| *kind == CellKind::TETRA).map(|(_, _, v)| tet(v)).collect()
}

fn is_on_surface(mesh: &Mesh) -> Vec<bool> {
    let mut on = vec![false; mesh.points.len()];
    let triangles = mesh.cells.iter().filter(|(_, kind, _)| *kind == CellKind::TRIANGLE);
    triangles.for_each(|(_, _, v)| v.iter().for_each(|v| on[v.index()] = true));
    on
}

/// The surface of a box, with sizes that vary along x.
fn graded_box() -> (Mesh, Vec<f64>) {
    let mesh = skin(&box_grid([6, 6, 6], [[0.0; 3], [1.0, 1.1, 0.9]]), 1.0, 0.0);
    let sizes = mesh.points.iter().map(|p| 0.04 + 0.2 * p[0]).collect();
    (mesh, sizes)
}

fn graded(at_points: Option<Vec<f64>>, growth: f64, largest: Option<f64>) -> Options {
    let sizes = Some(Sizes::Graded(Grading { at_points, growth, largest }));
    Options { sizes, improve: Some(remesh::Options::default()), ..Options::default() }
}

#[test]
fn edges_inside_follow_the_sizes() {
    let (mesh, sizes) = graded_box();
    let surfaces = joined(&[(&mesh, "box")]);
    let growth = 0.3;
    let result = filled(&surfaces, &graded(Some(sizes.clone()), growth, None)).unwrap();
    let mesh = &result.mesh;
    assert!(check(mesh).is_empty() && result.report.not_positive == 0);
    // A sample of many places of the surface; sizes that are linear along the faces of a box give the same
    // minimum over all places.
    let places: Vec<Point> = (0..6000)
        .map(|i| {
            let (u, v) = (f64::from(i / 6 % 32) / 31.0, f64::from(i / 192) / 31.0);
            let p = match i % 6 {
                0 => [0.0, u, v],
                1 => [1.0, u, v],
                2 => [u, 0.0, v],
                3 => [u, 1.0, v],
                4 => [u, v, 0.0],
                _ => [u, v, 1.0],
            };
            [p[0], 1.1 * p[1], 0.9 * p[2]]
        })
        .collect();
    let size = |p: Point| {
        let at = |q: &Point| 0.04 + 0.2 * q[0] + growth * distance(p, *q);
        places.iter().map(at).fold(f64::INFINITY, f64::min)
    };
    let on = is_on_surface(mesh);
    let mut ratios = Vec::new();
    for tet in tets(mesh).iter().step_by(5).filter(|tet| tet.iter().all(|v| !on[v.index()])) {
        for ends in EDGES.map(|e| e.map(|i| mesh.points[tet[i].index()])) {
            ratios
                .push(distance(ends[0], ends[1]) / size([0, 1, 2].map(|i| (ends[0][i] + ends[1][i]) / 2.0)));
        }
    }
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    assert!(ratios.len() > 1000 && (0.7..1.2).contains(&mean), "{mean} of {}", ratios.len());
    let beyond = ratios.iter().filter(|r| !(0.5..2.0).contains(*r)).count();
    assert!(beyond * 50 < ratios.len(), "{beyond} of {}", ratios.len());
}

#[test]
fn no_tet_of_the_lattice_is_bad_where_levels_meet() {
    let (mesh, sizes) = graded_box();
    let options = Options { improve: None, ..graded(Some(sizes), 0.5, None) };
    let result = filled(&joined(&[(&mesh, "box")]), &options).unwrap();
    let on = is_on_surface(&result.mesh);
    let inner = tets(&result.mesh).into_iter().filter(|tet| tet.iter().all(|v| !on[v.index()]));
    let qualities: Vec<f64> = inner.map(|tet| eas(tet.map(|v| result.mesh.points[v.index()]))).collect();
    let worst = qualities.iter().copied().fold(1.0, f64::min);
    assert!(qualities.len() > 1000 && worst >= 0.2, "{worst} of {}", qualities.len());
}

/// A vessel and the flap in it.
fn lumen_and_flap() -> [Mesh; 2] {
    let whole = Flap { reach: 0.6, ..Flap::default() }.mesh().unwrap();
    let labels = whole.patches().unwrap();
    let flap = labels.find("flap").unwrap();
    [false, true].map(|is_flap| {
        let mut cells = Cells::new();
        let of_part = whole.cells.iter().filter(|(cell, _, _)| (labels.ids[cell.index()] == flap) == is_flap);
        of_part.for_each(|(_, kind, vertices)| cells.push(kind, vertices.iter().copied()));
        Mesh::new(whole.points.clone(), cells)
    })
}

#[test]
fn vessels_are_filled_by_the_sizes_of_their_surface() {
    let [tube, aneurysm, bifurcation] = [
        ThickTube::default().mesh().unwrap(),
        Aneurysm::default().mesh().unwrap(),
        Bifurcation::default().mesh().unwrap(),
    ];
    let [lumen, flap] = lumen_and_flap();
    let with_flap = [(&lumen, Role::Boundary, "lumen"), (&flap, Role::Membrane, "flap")];
    for (surfaces, name) in [
        (joined(&[(&tube, "tube")]), "tube"),
        (joined(&[(&aneurysm, "aneurysm")]), "aneurysm"),
        (joined(&[(&bifurcation, "bifurcation")]), "bifurcation"),
        (Surfaces::new(&with_flap).unwrap(), "flap"),
    ] {
        let result = filled(&surfaces, &graded(None, 0.3, None)).unwrap();
        assert!(check(&result.mesh).is_empty(), "{name}");
        assert_eq!(result.report.triangles_kept, surfaces.triangles.len(), "{name}");
        assert_eq!(result.report.not_positive, 0, "{name}");
        let bad = result.improved.unwrap().after.bad;
        assert!(bad * 1000 <= result.report.tets, "{name}: {bad} of {}", result.report.tets);
    }
}

#[test]
fn threads_change_nothing() {
    let mesh = Bifurcation::default().mesh().unwrap();
    let surfaces = joined(&[(&mesh, "a")]);
    let by = |n: usize| {
        let threads = Threads::new(n).unwrap();
        fill(&surfaces, &surfaces.preflight(&threads), &graded(None, 0.4, None), &threads).unwrap().mesh
    };
    assert_eq!(by(1), by(3));
}

#[test]
fn bodies_are_numbered_from_the_outside_in_whatever_the_order_of_files() {
    let unit = ball(3, 3);
    let [small, middle, large] = [0.3, 0.6, 1.0].map(|factor| skin(&unit, factor, 0.0));
    let volumes = [&large, &middle, &small].map(enclosed);
    let shells = [volumes[0] - volumes[1], volumes[1] - volumes[2], volumes[2]];
    for files in [
        [(&small, "small"), (&middle, "middle"), (&large, "large")],
        [(&middle, "middle"), (&large, "large"), (&small, "small")],
    ] {
        let surfaces = joined(&files);
        let bodies = filled(&surfaces, &Options::default()).unwrap().report.bodies;
        assert_eq!(bodies.iter().map(|b| b.region).collect::<Vec<_>>(), [1, 2, 3]);
        let names: Vec<_> = bodies.iter().map(|b| b.name.as_deref().unwrap()).collect();
        assert_eq!(names, ["large", "middle", "small"]);
        for (body, shell) in bodies.iter().zip(shells) {
            assert!((body.volume - shell).abs() < 1e-12, "{body:?} {shell}");
        }
        // The same shells with the middle one left out, and the innermost named.
        let seeds = vec![Seed { place: [0.01, 0.0, 0.0], name: "core".into() }];
        let options = Options { seeds, holes: vec![[0.45, 0.0, 0.0]], ..Options::default() };
        let result = filled(&surfaces, &options).unwrap();
        let reported: Vec<_> = result.report.bodies.iter().map(|b| b.name.as_deref().unwrap()).collect();
        assert_eq!(reported, ["large", "core"]);
        assert!((result.report.bodies[1].volume - shells[2]).abs() < 1e-12);
        // The remaining parts are separate, and there are no other defects.
        let defects = check(&result.mesh);
        assert!(defects.iter().all(|d| d.kind == DefectKind::SeparatePart), "{defects:?}");
        assert_eq!(result.mesh.regions().unwrap().find("core"), Some(2));
        assert_eq!(result.report.triangles_outside, 0);
    }
}

#[test]
fn bodies_that_share_a_wall_are_named_by_their_surfaces() {
    let left = skin(&box_grid([2, 2, 2], [[0.0; 3], [1.0; 3]]), 1.0, 0.0);
    let right = skin(&box_grid([4, 2, 2], [[1.0, 0.0, 0.0], [3.0, 1.0, 1.0]]), 1.0, 0.0);
    let bodies =
        filled(&joined(&[(&left, "left"), (&right, "right")]), &Options::default()).unwrap().report.bodies;
    let reported: Vec<_> =
        bodies.iter().map(|b| (b.region, b.name.as_deref().unwrap(), b.volume.round())).collect();
    assert_eq!(reported, [(1, "left", 1.0), (2, "right", 2.0)]);
}

#[test]
fn names_survive_improving_and_one_surface_gives_none() {
    let mesh = ThickTube::default().mesh().unwrap();
    let seeds = vec![Seed { place: [0.0, 0.0, 0.1], name: "blood".into() }];
    let surfaces = joined(&[(&mesh, "tube")]);
    let bodies = filled(&surfaces, &Options { seeds, ..graded(None, 0.3, None) }).unwrap().report.bodies;
    assert_eq!(bodies.len(), 2);
    assert_eq!(bodies.iter().filter(|b| b.name.as_deref() == Some("blood")).count(), 1);
    assert_eq!(bodies.iter().filter(|b| b.name.is_none()).count(), 1);
    let whole = enclosed_by_outside(&mesh);
    assert!((bodies.iter().map(|b| b.volume).sum::<f64>() - whole).abs() < 1e-9 * whole);
}

/// The volume that a tube and its wall enclose: all patches except the one between them.
fn enclosed_by_outside(mesh: &Mesh) -> f64 {
    let surface = Surface::of(mesh);
    let interface = mesh.patches().unwrap().find("interface").unwrap();
    let outer = surface.triangles.iter().zip(&surface.patches).filter(|(_, patch)| **patch != interface);
    outer.map(|(t, _)| cone_volume(t.iter().copied(), &surface.points, [0.0; 3])).sum::<f64>().abs()
}

#[test]
fn places_that_mean_nothing_are_refused() {
    let unit = ball(3, 3);
    let [inner, outer] = [0.5, 1.0].map(|factor| skin(&unit, factor, 0.0));
    let surfaces = joined(&[(&inner, "inner"), (&outer, "outer")]);
    let reported = |seeds: &[(Point, &str)], holes: &[Point]| {
        let seeds = seeds.iter().map(|(place, name)| Seed { place: *place, name: (*name).into() }).collect();
        let options = Options { seeds, holes: holes.to_vec(), ..Options::default() };
        filled(&surfaces, &options).map(|_| ()).unwrap_err().to_string()
    };
    let (core, shell) = ([0.01, 0.0, 0.0], [0.0, 0.7, 0.01]);
    assert!(reported(&[([2.0, 0.0, 0.0], "a")], &[]).contains("outside of all"));
    assert!(reported(&[], &[[0.0, f64::NAN, 0.0]]).contains("finite"));
    let vertex = outer.points[Surface::of(&outer).triangles[0][0].index()];
    assert!(reported(&[(vertex, "a")], &[]).contains("lies on the surface"));
    let vertex = inner.points[Surface::of(&inner).triangles[0][0].index()];
    assert!(reported(&[(vertex, "a")], &[]).contains("lies on the surface"));
    assert!(reported(&[(core, "a"), ([0.0, 0.01, 0.0], "b")], &[]).contains("another seed names `a`"));
    assert!(reported(&[(core, "a"), (shell, "a")], &[]).contains("another body"));
    assert!(reported(&[(core, "a")], &[core]).contains("names `a`"));
    assert!(reported(&[], &[core, shell]).contains("every body is a hole"));
}

#[test]
fn sizes_that_mean_nothing_are_refused() {
    let (mesh, sizes) = graded_box();
    let surfaces = joined(&[(&mesh, "box")]);
    let reported = |at_points: Option<Vec<f64>>, growth: f64, largest: Option<f64>| {
        filled(&surfaces, &graded(at_points, growth, largest)).map(|_| ()).unwrap_err().to_string()
    };
    for growth in [0.0, -0.1, 0.8, f64::NAN] {
        assert!(reported(None, growth, None).contains("at most 0.7"));
    }
    assert!(reported(None, 0.3, Some(0.0)).contains("above 0"));
    assert!(reported(Some(vec![1.0]), 0.3, None).contains("1 sizes for"));
    let with = |size: f64| {
        let mut sizes = sizes.clone();
        sizes[5] = size;
        Some(sizes)
    };
    for size in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(reported(with(size), 0.3, None).contains("point 5"));
    }
    assert!(reported(Some(vec![1e-9; sizes.len()]), 0.3, None).contains("larger sizes"));
    assert!(reported(None, 0.3, Some(1e-9)).contains("larger sizes"));
    assert!(reported(with(1e-30), 0.3, None).contains("larger"));
}

#[test]
fn arrays_give_sizes_by_points_and_by_cells() {
    let mut mesh = skin(&box_grid([1, 1, 1], [[0.0; 3], [1.0; 3]]), 1.0, 0.0);
    let n = mesh.cells.len();
    mesh.point_data.push(Field::scalars("h", vec![0.5; mesh.points.len()]));
    mesh.cell_data.push(Field::scalars("k", (0..n).map(|i| 1.0 + i as f64).collect::<Vec<_>>()));
    mesh.cell_data.push(Field::scalars("off", (0..n).map(|i| i as f64 - 3.0).collect::<Vec<_>>()));
    mesh.point_data.push(Field::vectors("v", &vec![[1.0; 3]; mesh.points.len()]));
    assert!(sizes_by(&mesh, "h").unwrap().iter().all(|h| *h == 0.5));
    let by_cells = sizes_by(&mesh, "k").unwrap();
    for (v, size) in by_cells.iter().enumerate() {
        let of = mesh.cells.iter().filter(|(_, _, t)| t.contains(&VertexId::new(v)));
        assert_eq!(of.map(|(cell, _, _)| 1.0 + cell.index() as f64).fold(f64::INFINITY, f64::min), *size);
    }
    let reported = |array: &str| sizes_by(&mesh, array).unwrap_err().to_string();
    assert!(reported("off").contains("array `off`: cell 0"), "{}", reported("off"));
    assert!(reported("v").contains("one number a row"));
    assert!(reported("none").contains("point arrays: h, v; cell arrays: k, off"), "{}", reported("none"));
}
