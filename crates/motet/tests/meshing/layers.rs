//! Boundary layers, compared with what they promise: every tet positive, the mesh conforming, no volume lost,
//! walls kept, thickness as requested wherever there is space.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};

use motet::Mesh;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::predicates::orient3d;
use motet::geometry::tet::{FACETS, volume};
use motet::geometry::triangle::{area_vector, centroid};
use motet::geometry::vector::{add, cross, distance, dot, norm, scale, sub};
use motet::mesh::check::check;
use motet::mesh::shapes::{Aneurysm, Bifurcation, Flap, ThickTube, ball, box_grid};
use motet::mesh::{CellKind, Cells, Surface};
use motet::meshing::layers::{Layers, Stack};
use motet::meshing::{Filled, Options, Sizes, Surfaces, fill};
use motet::preflight::Role;

const STACK: Stack = Stack { count: 3, first: 0.02, growth: 1.5 };

fn everywhere(stack: Stack) -> Layers {
    Layers { everywhere: Some(stack), ..Layers::default() }
}

fn surfaces(mesh: &Mesh) -> Surfaces {
    Surfaces::new(&[(mesh, Role::Boundary, "surface")]).unwrap()
}

fn try_fill(mesh: &Mesh, layers: Layers, size: Option<f64>) -> motet::Result<Filled> {
    try_fill_all(&surfaces(mesh), layers, size)
}

fn try_fill_all(surfaces: &Surfaces, layers: Layers, size: Option<f64>) -> motet::Result<Filled> {
    let threads = Threads::single();
    let improve = size.map(|_| motet::remesh::Options::default());
    let options =
        Options { sizes: size.map(Sizes::Uniform), improve, layers: Some(layers), ..Options::default() };
    fill(surfaces, &surfaces.preflight(&threads), &options, &threads)
}

/// Fills and checks what must hold for any result.
fn filled(mesh: &Mesh, layers: Layers, size: Option<f64>) -> Filled {
    let made = try_fill(mesh, layers, size).unwrap();
    let faults = faults(mesh, &made);
    assert!(faults.is_empty(), "{} faults, {}", faults.len(), faults[0]);
    made
}

fn rising(mut t: [VertexId; 3]) -> [VertexId; 3] {
    t.sort_unstable();
    t
}

/// The triangles of a surface by their coordinates, independent of numbering.
fn places(points: &[Point], t: [VertexId; 3]) -> [[u64; 3]; 3] {
    let mut corners = t.map(|v| points[v.index()].map(|x| (x + 0.0).to_bits()));
    corners.sort_unstable();
    corners
}

fn triangles(mesh: &Mesh) -> impl Iterator<Item = (usize, [VertexId; 3])> + '_ {
    let triangles = mesh.cells.iter().filter(|(_, kind, _)| *kind == CellKind::TRIANGLE);
    triangles.map(|(cell, _, v)| (cell.index(), [v[0], v[1], v[2]]))
}

fn faults(surface: &Mesh, made: &Filled) -> Vec<String> {
    let (mesh, mut faults) = (&made.mesh, Vec::new());
    let at = |v: VertexId| mesh.points[v.index()];
    let regions = mesh.regions().unwrap();
    let mut sides: HashMap<[VertexId; 3], Vec<i32>> = HashMap::new();
    let mut volumes = vec![0.0; made.report.bodies.len()];
    for (cell, tet) in mesh.cells.tets() {
        let [a, b, c, d] = tet.map(at);
        if orient3d(a, b, c, d) <= 0 {
            faults.push(format!("tet {cell} is not positive"));
        }
        let region = regions.ids[cell.index()];
        volumes[region as usize - 1] += volume([a, b, c, d]);
        for facet in FACETS {
            sides.entry(rising(facet.map(|k| tet[k]))).or_default().push(region);
        }
    }
    let labelled: HashSet<_> = triangles(mesh).map(|(_, t)| rising(t)).collect();
    for (facet, of) in &sides {
        let is_wall = labelled.contains(facet);
        match of[..] {
            [_] if is_wall => {}
            [a, b] if is_wall || a == b => {}
            _ => faults.push(format!("facet {facet:?} of the regions {of:?}, labelled: {is_wall}")),
        }
    }
    faults.extend(
        labelled.iter().filter(|t| !sides.contains_key(*t)).map(|t| format!("triangle {t:?} is no facet")),
    );
    let enclosed = enclosed(surface);
    let total: f64 = volumes.iter().sum();
    if (total - enclosed).abs() > 1e-10 * enclosed {
        faults.push(format!("volume {total} of {enclosed}"));
    }
    for (reported, found) in made.report.bodies.iter().map(|body| body.volume).zip(&volumes) {
        if (reported - found).abs() > 1e-10 * enclosed {
            faults.push(format!("a volume of {reported} is reported, {found} found"));
        }
    }
    faults.extend(lost_walls(surface, made));
    faults
}

/// The volume that the outer boundary encloses: triangles of the surface with nothing on one side.
fn enclosed(surface: &Mesh) -> f64 {
    let labels = surface.patches().unwrap();
    let inner: Vec<i32> = ["interface", "flap"].iter().filter_map(|name| labels.find(name)).collect();
    let outer = triangles(surface).filter(|(cell, _)| !inner.contains(&labels.ids[*cell]));
    outer.map(|(_, t)| t.map(|v| surface.points[v.index()])).map(|[a, b, c]| dot(a, cross(b, c)) / 6.0).sum()
}

/// Triangles of walls that are lost or have another patch, except in the planes of flat patches, where edges
/// of layers may slide.
fn lost_walls(surface: &Mesh, made: &Filled) -> Vec<String> {
    let (before, after) = (surface.patches().unwrap(), made.mesh.patches().unwrap());
    let there: HashMap<_, i32> =
        triangles(&made.mesh).map(|(i, t)| (places(&made.mesh.points, t), after.ids[i])).collect();
    let planes: Vec<[Point; 2]> = before.used().iter().filter_map(|&patch| plane(surface, patch)).collect();
    let is_in_plane = |t: [VertexId; 3]| {
        planes.iter().any(|&[middle, normal]| {
            let offsets = t.map(|v| sub(surface.points[v.index()], middle));
            offsets.iter().all(|&o| dot(o, normal).abs() <= 2e-3 * norm(o))
        })
    };
    let (mut faults, mut n_kept) = (Vec::new(), 0);
    for (i, t) in triangles(surface) {
        let is_kept = there.get(&places(&surface.points, t)) == Some(&before.ids[i]);
        n_kept += usize::from(is_kept);
        if !is_kept && !is_in_plane(t) {
            faults.push(format!("triangle {i} of `{}` is lost", before.name(before.ids[i])));
        }
    }
    if n_kept != made.report.triangles_kept {
        faults.push(format!("{} triangles are reported as kept, {n_kept} are", made.report.triangles_kept));
    }
    faults
}

/// A point in the plane of a patch, and the plane's normal; `None` where the patch is not flat.
fn plane(surface: &Mesh, patch: i32) -> Option<[Point; 2]> {
    let labels = surface.patches().unwrap();
    let of_patch = triangles(surface).filter(|(cell, _)| labels.ids[*cell] == patch);
    let corners: Vec<[Point; 3]> = of_patch.map(|(_, t)| t.map(|v| surface.points[v.index()])).collect();
    let normals: Vec<Point> = corners.iter().map(|&t| area_vector(t)).collect();
    let sum = normals.iter().fold([0.0; 3], |sum, n| add(sum, *n));
    let is_flat = normals.iter().all(|&n| dot(n, sum) > 0.999 * norm(n) * norm(sum));
    is_flat.then(|| [centroid(corners[0]), scale(sum, 1.0 / norm(sum))])
}

/// A tube with this radius as a function of z, with flat ends; patches `wall`, `inlet`, `outlet`.
fn vessel(radius: impl Fn(f64) -> f64, around: usize, slices: usize) -> Mesh {
    let mut mesh = Flap { around, slices, ..Flap::default() }.mesh().unwrap();
    let labels = mesh.patches().unwrap();
    let flap = labels.find("flap").unwrap();
    let mut cells = Cells::new();
    let mut patches = Vec::new();
    for (cell, t) in triangles(&mesh).filter(|(cell, _)| labels.ids[*cell] != flap) {
        cells.push(CellKind::TRIANGLE, t);
        patches.push(labels.ids[cell]);
    }
    for p in &mut mesh.points {
        let r = radius(p[2]);
        *p = [p[0] * r, p[1] * r, p[2]];
    }
    Mesh {
        cell_data: vec![motet::mesh::Field::scalars("patch", patches)],
        label_names: mesh.label_names.clone(),
        ..Mesh::new(mesh.points, cells)
    }
}

/// The columns of layers, found in a mesh of prisms: from each vertex of the wall up, level by level.
fn columns(mesh: &Mesh) -> Vec<Vec<VertexId>> {
    let (mut above, mut is_above) = (BTreeMap::new(), HashSet::new());
    for (_, kind, v) in mesh.cells.iter() {
        let pairs: &[[usize; 2]] = match kind {
            CellKind::WEDGE => &[[0, 3], [1, 4], [2, 5]],
            CellKind::PYRAMID => &[[0, 1], [3, 2]],
            _ => &[],
        };
        for &[low, high] in pairs {
            above.insert(v[low], v[high]);
            is_above.insert(v[high]);
        }
    }
    let feet = above.keys().filter(|v| !is_above.contains(*v));
    feet.map(|&foot| std::iter::successors(Some(foot), |v| above.get(v).copied()).collect()).collect()
}

fn with_prisms(layers: Layers) -> Layers {
    Layers { keep_prisms: true, ..layers }
}

#[test]
fn on_a_straight_tube_every_layer_is_as_thick_as_requested() {
    let mesh = vessel(|_| 1.0, 24, 24);
    let made = filled(&mesh, everywhere(STACK), Some(0.3));
    let reported = made.layers.unwrap();
    assert_eq!((reported.reduced, reported.without, reported.vertices), (0, 0, 24 * 25));
    assert_eq!(reported.prisms, 3 * 2 * 24 * 24);
    let prisms = filled_prisms(&mesh, everywhere(STACK));
    let apothem = (std::f64::consts::PI / 24.0).cos();
    let columns = columns(&prisms);
    assert_eq!(columns.len(), 24 * 25);
    for column in columns {
        // Walls are flat between the lines of vertices: their distance from the axis is that of the middle of
        // a chord.
        let heights: Vec<f64> = column
            .iter()
            .map(|v| prisms.points[v.index()])
            .map(|p| apothem * (1.0 - p[0].hypot(p[1])))
            .collect();
        let expected = [0.0, 0.02, 0.05, 0.095];
        assert_eq!(heights.len(), 4);
        heights.iter().zip(expected).for_each(|(h, e)| assert!((h - e).abs() < 1e-13, "{heights:?}"));
    }
}

fn filled_prisms(mesh: &Mesh, layers: Layers) -> Mesh {
    let made = try_fill(mesh, with_prisms(layers), None).unwrap();
    let defects = check(&made.mesh);
    assert!(defects.is_empty(), "{defects:?}");
    made.mesh
}

/// The heights of the levels of a column over the planes of the wall around its foot: for each level the
/// least over the planes.
fn heights(mesh: &Mesh, walls: &HashMap<VertexId, Vec<[Point; 3]>>, column: &[VertexId]) -> Vec<f64> {
    let over = |p: Point, [a, b, c]: [Point; 3]| {
        let normal = cross(sub(b, a), sub(c, a));
        -dot(sub(p, a), normal) / norm(normal)
    };
    let places = column.iter().map(|v| mesh.points[v.index()]);
    places.map(|p| walls[&column[0]].iter().map(|&t| over(p, t)).fold(f64::INFINITY, f64::min)).collect()
}

/// The triangles of a patch around each vertex.
fn walls(mesh: &Mesh, patch: &str) -> HashMap<VertexId, Vec<[Point; 3]>> {
    let labels = mesh.patches().unwrap();
    let wall = labels.find(patch).unwrap();
    let mut walls: HashMap<VertexId, Vec<[Point; 3]>> = HashMap::new();
    for (_, t) in triangles(mesh).filter(|(cell, _)| labels.ids[*cell] == wall) {
        t.iter().for_each(|&v| walls.entry(v).or_default().push(t.map(|v| mesh.points[v.index()])));
    }
    walls
}

#[test]
fn on_a_bent_tube_every_layer_is_as_thick_as_requested() {
    let stack = Stack { count: 4, first: 0.01, growth: 1.3 };
    let mesh = bent();
    let reported = filled(&mesh, everywhere(stack), Some(0.4)).layers.unwrap();
    assert_eq!(reported.reduced, 0, "{reported:?}");
    let prisms = filled_prisms(&mesh, everywhere(stack));
    let walls = walls(&prisms, "wall");
    for column in columns(&prisms) {
        let heights = heights(&prisms, &walls, &column);
        let expected = [0.0, 0.01, 0.023, 0.0399, 0.06187];
        assert_eq!(heights.len(), 5);
        heights.iter().zip(expected).for_each(|(h, e)| assert!((h - e).abs() < 1e-12, "{heights:?}"));
    }
}

fn bent() -> Mesh {
    let whole = ThickTube { bend_deg: 90.0, ..ThickTube::default() }.mesh().unwrap();
    part(&whole, &[("lumen_inlet", "inlet"), ("lumen_outlet", "outlet"), ("interface", "wall")])
}

/// Some patches of a surface, renamed.
fn part(whole: &Mesh, names: &[(&str, &str)]) -> Mesh {
    let labels = whole.patches().unwrap();
    let (mut cells, mut patches) = (Cells::new(), Vec::new());
    for (new, (old, _)) in (1..).zip(names) {
        let id = labels.find(old).unwrap();
        for (_, t) in triangles(whole).filter(|(cell, _)| labels.ids[*cell] == id) {
            cells.push(CellKind::TRIANGLE, t);
            patches.push(new);
        }
    }
    let mut mesh = Mesh::new(whole.points.clone(), cells);
    mesh.label_names.patches = (1..).zip(names.iter().map(|(_, new)| (*new).to_string())).collect();
    mesh.cell_data = vec![motet::mesh::Field::scalars("patch", patches)];
    mesh
}

#[test]
fn layers_give_way_where_a_tube_narrows() {
    let radius = |z: f64| 1.0 - 0.9 * (-(z - 3.0f64).powi(2) / 0.5).exp();
    let thick = Stack { count: 4, first: 0.05, growth: 1.2 };
    let mesh = vessel(radius, 24, 60);
    let reported = filled(&mesh, everywhere(thick), None).layers.unwrap();
    assert!(reported.full > 0 && reported.reduced > 0, "{reported:?}");
    let [least, _, largest] = reported.thickness.unwrap();
    assert!(least < 0.1 && (largest - thick.thickness()).abs() < 1e-12, "{reported:?}");
    assert!((reported.least_at.unwrap()[2] - 3.0).abs() < 0.5, "{reported:?}");
    // Along the wall the thickness changes slowly.
    let prisms = filled_prisms(&mesh, everywhere(thick));
    let walls = walls(&prisms, "wall");
    let top: HashMap<VertexId, f64> =
        columns(&prisms).iter().map(|c| (c[0], heights(&prisms, &walls, c)[c.len() - 1])).collect();
    let labels = prisms.patches().unwrap();
    let wall = labels.find("wall").unwrap();
    for (_, [a, b, _]) in triangles(&prisms).filter(|(cell, _)| labels.ids[*cell] == wall) {
        let along = distance(prisms.points[a.index()], prisms.points[b.index()]);
        assert!((top[&a] - top[&b]).abs() <= 0.31 * along, "{} and {} over {along}", top[&a], top[&b]);
    }
}

#[test]
fn in_a_tube_thinner_than_its_layers_they_take_three_tenths_of_the_way_across() {
    let reported =
        filled(&vessel(|_| 0.1, 24, 60), everywhere(Stack { first: 1.0, ..STACK }), None).layers.unwrap();
    let [least, median, largest] = reported.thickness.unwrap();
    assert_eq!((reported.full, reported.without), (0, 0));
    assert!(largest <= 0.06 + 1e-12 && median > 0.05 && least > 0.01, "{reported:?}");
}

#[test]
fn at_a_crotch_and_at_the_neck_of_a_sac_layers_fit() {
    let thick = Stack { count: 3, first: 0.08, growth: 1.3 };
    for stack in [STACK, thick] {
        for mesh in [Bifurcation::default().mesh().unwrap(), Aneurysm::default().mesh().unwrap()] {
            let reported = filled(&mesh, everywhere(stack), Some(0.3)).layers.unwrap();
            assert!(reported.full * 2 > reported.vertices, "{reported:?}");
            assert!(reported.without * 50 < reported.vertices, "{reported:?}");
        }
    }
    let narrow = Bifurcation { branch_angles_deg: [15.0; 2], blend: 0.1, ..Bifurcation::default() };
    filled(&narrow.mesh().unwrap(), everywhere(thick), None);
}

#[test]
fn corners_of_a_box_carry_layers() {
    let mesh = Mesh { ..surface_of(&box_grid([4, 4, 4], [[0.0; 3], [1.0; 3]])) };
    let reported =
        filled(&mesh, everywhere(Stack { count: 2, first: 0.04, growth: 1.0 }), None).layers.unwrap();
    assert_eq!((reported.reduced, reported.vertices), (0, 98));
    // At edges and corners columns lean, and are longer: over every side of the box around their foot they
    // are at least as high as requested.
    let prisms = filled_prisms(&mesh, everywhere(Stack { count: 2, first: 0.04, growth: 1.0 }));
    let mut around: HashMap<VertexId, Vec<[Point; 3]>> = HashMap::new();
    for patch in ["xmin", "xmax", "ymin", "ymax", "zmin", "zmax"] {
        walls(&prisms, patch).into_iter().for_each(|(v, list)| around.entry(v).or_default().extend(list));
    }
    for column in columns(&prisms) {
        let heights = heights(&prisms, &around, &column);
        heights
            .iter()
            .zip([0.0, 0.04, 0.08])
            .for_each(|(h, e)| assert!((h - e).abs() < 1e-13, "{heights:?}"));
    }
    // With layers on one side only, the others carry edges of layers.
    let stack = Stack { count: 2, first: 0.1, growth: 1.0 };
    let patch = mesh.patches().unwrap().find("zmin").unwrap();
    let one = Layers { by_patch: [(patch, stack)].into(), ..Layers::default() };
    let reported = filled(&mesh, one, None).layers.unwrap();
    assert_eq!(reported.reduced, 0, "{reported:?}");
    assert!((reported.volume - 0.2).abs() < 1e-12, "{reported:?}");
}

/// The surface cells of a volume mesh, with their patches.
fn surface_of(mesh: &Mesh) -> Mesh {
    let labels = mesh.patches().unwrap();
    let (mut cells, mut patches) = (Cells::new(), Vec::new());
    let surface = Surface::of(mesh);
    for (t, patch) in surface.triangles.iter().zip(&surface.patches) {
        cells.push(CellKind::TRIANGLE, *t);
        patches.push(*patch);
    }
    let mut only = Mesh::new(mesh.points.clone(), cells);
    only.label_names.patches = labels.names;
    only.cell_data = vec![motet::mesh::Field::scalars("patch", patches)];
    only
}

#[test]
fn a_ball_has_layers_all_over() {
    let mesh = surface_of(&ball(5, 5));
    let reported = filled(&mesh, everywhere(STACK), Some(0.3)).layers.unwrap();
    assert_eq!(reported.reduced, 0, "{reported:?}");
}

#[test]
fn patches_with_different_layers_meet() {
    let mut mesh = vessel(|_| 1.0, 24, 24);
    let labels = mesh.patches().unwrap();
    let wall = labels.find("wall").unwrap();
    let is_far = |t: [VertexId; 3]| t.iter().all(|v| mesh.points[v.index()][2] >= 3.0);
    let split: Vec<i32> = triangles(&mesh)
        .map(|(cell, t)| if labels.ids[cell] == wall && is_far(t) { 9 } else { labels.ids[cell] })
        .collect();
    mesh.cell_data = vec![motet::mesh::Field::scalars("patch", split)];
    let more = Stack { count: 5, ..STACK };
    let by_patch = BTreeMap::from([(wall, STACK), (9, more)]);
    for layers in [
        Layers { by_patch, ..Layers::default() },
        Layers { by_patch: [(9, more)].into(), ..everywhere(STACK) },
        // No layers on the other half: they run out there.
        Layers { by_patch: [(9, more)].into(), ..Layers::default() },
    ] {
        let reported = filled(&mesh, layers.clone(), None).layers.unwrap();
        assert!(reported.full > 0, "{reported:?}");
        let half = layers.everywhere.is_none() && layers.by_patch.len() == 1;
        assert_eq!(reported.without > 0, half, "{reported:?}");
        filled_prisms(&mesh, layers);
    }
}

#[test]
fn in_a_thick_tube_layers_grow_in_the_lumen() {
    let mesh = ThickTube { bend_deg: 60.0, ..ThickTube::default() }.mesh().unwrap();
    let find = |name: &str| mesh.patches().unwrap().find(name).unwrap();
    let (interface, outer) = (find("interface"), find("outer"));
    let one = Layers { by_patch: [(interface, STACK)].into(), ..Layers::default() };
    let made = filled(&mesh, one, Some(0.4));
    assert_eq!(made.layers.as_ref().unwrap().reduced, 0);
    let plain = fill_plain(&mesh);
    let volumes = |of: &Filled| of.report.bodies.iter().map(|body| body.volume).collect::<Vec<_>>();
    let (with, without) = (volumes(&made), volumes(&plain));
    assert!(with.iter().zip(&without).all(|(a, b)| (a - b).abs() < 1e-10 * b), "{with:?} {without:?}");
    // Layers in both bodies: in the wall from outside.
    let thin = Stack { count: 2, first: 0.02, growth: 1.0 };
    let both = Layers { by_patch: [(interface, STACK), (outer, thin)].into(), ..Layers::default() };
    let reported = filled(&mesh, both.clone(), None).layers.unwrap();
    assert_eq!((reported.reduced, reported.vertices), (0, 2 * 24 * 25));
    filled_prisms(&mesh, both);
}

fn fill_plain(mesh: &Mesh) -> Filled {
    let (surfaces, threads) = (surfaces(mesh), Threads::single());
    fill(&surfaces, &surfaces.preflight(&threads), &Options::default(), &threads).unwrap()
}

#[test]
fn beside_a_flap_layers_end_and_on_it_they_are_refused() {
    let whole = Flap { reach: 0.6, bend_deg: 60.0, ..Flap::default() }.mesh().unwrap();
    let [wall, inlet, outlet, flap] = ["wall", "inlet", "outlet", "flap"].map(|name| (name, name));
    let (vessel, sheet) = (part(&whole, &[wall, inlet, outlet]), part(&whole, &[flap]));
    let all = [(&vessel, Role::Boundary, "vessel"), (&sheet, Role::Membrane, "flap")];
    let surfaces = Surfaces::new(&all).unwrap();
    for layers in [everywhere(STACK), Layers { by_patch: [(1, STACK)].into(), ..Layers::default() }] {
        let made = try_fill_all(&surfaces, layers, Some(0.4)).unwrap();
        let faults = faults(&part(&whole, &[wall, inlet, outlet, flap]), &made);
        assert!(faults.is_empty(), "{} faults, {}", faults.len(), faults[0]);
        let reported = made.layers.unwrap();
        assert!(reported.without > 0 && reported.full > reported.vertices / 3, "{reported:?}");
    }
    let on_flap = Layers { by_patch: [(4, STACK)].into(), ..Layers::default() };
    let error = try_fill_all(&surfaces, on_flap, None).unwrap_err().to_string();
    assert!(error.contains("`flap`, which is a membrane"), "{error}");
}

#[test]
fn layers_are_the_same_for_any_number_of_threads() {
    let mesh = Bifurcation::default().mesh().unwrap();
    let surfaces = surfaces(&mesh);
    let layers = everywhere(Stack { count: 3, first: 0.1, growth: 1.3 });
    let options = Options { sizes: Some(Sizes::Uniform(0.4)), layers: Some(layers), ..Options::default() };
    let [one, three] = [1, 3].map(|n| {
        let threads = Threads::new(n).unwrap();
        fill(&surfaces, &surfaces.preflight(&threads), &options, &threads).unwrap().mesh
    });
    assert_eq!(one, three);
}

#[test]
fn layers_that_mean_nothing_are_refused() {
    let mesh = vessel(|_| 1.0, 12, 8);
    let stack = |count, first, growth| Stack { count, first, growth };
    for stack in [
        stack(0, 0.1, 1.0),
        stack(100_000, 0.1, 1.0),
        stack(2, 0.0, 1.0),
        stack(2, -0.1, 1.0),
        stack(2, f64::NAN, 1.0),
        stack(2, f64::INFINITY, 1.0),
        stack(2, 0.1, 0.0),
        stack(2, 0.1, -1.0),
        stack(2, 0.1, f64::NAN),
        stack(200, 1e300, 10.0),
        stack(200, 1.0, 1e-9),
    ] {
        let error = try_fill(&mesh, everywhere(stack), None).unwrap_err();
        assert_eq!(error.kind(), motet::ErrorKind::Options, "{error}");
        assert!(error.remedy_text().is_some(), "{error}");
    }
    for layers in [Layers::default(), Layers { by_patch: [(77, STACK)].into(), ..Layers::default() }] {
        assert_eq!(try_fill(&mesh, layers, None).unwrap_err().kind(), motet::ErrorKind::Options);
    }
    // Too thin or thick for the digits of coordinates: nothing tangles, and layers give way where there is no
    // space.
    for first in [1e-300, 1e-17, 1e9, 1e50] {
        filled(&mesh, everywhere(stack(2, first, 1.0)), None);
    }
}

/// The folder of real surfaces, where it exists.
fn data() -> Option<PathBuf> {
    let default = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("MOTET_DATA").map_or_else(default, PathBuf::from);
    if !folder.is_dir() {
        eprintln!("skipped: no real surfaces; set MOTET_DATA");
        return None;
    }
    Some(folder)
}

#[test]
fn real_vessels_get_layers() {
    let Some(data) = data() else { return };
    for (name, stack, least_full) in [
        ("seqseg_demo.vtp", Stack { count: 4, first: 0.01, growth: 1.3 }, 0.5),
        ("heartdeformnets_lh_template.vtp", Stack { count: 3, first: 5e-4, growth: 1.2 }, 0.5),
    ] {
        let mesh = motet::io::read(data.join("vessels").join(name)).unwrap();
        let made = try_fill(&mesh, everywhere(stack), None).unwrap();
        let reported = made.layers.as_ref().unwrap();
        println!("{name}: {reported:?}");
        assert!(reported.full as f64 > least_full * reported.vertices as f64, "{reported:?}");
        assert!(reported.without * 100 < reported.vertices, "{reported:?}");
        // Caps are flat only in single precision.
        let faults: Vec<_> = faults(&mesh, &made).into_iter().filter(|f| !f.starts_with("volume")).collect();
        assert!(faults.is_empty(), "{} faults, {}", faults.len(), faults[0]);
    }
}
