//! Patches that slide: in planes, along the lines of two planes, at corners; nearly flat patches; driven
//! vertices beside them.

use std::collections::BTreeMap;

use motet::Mesh;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::vector::{add, cross, distance, dot, norm, scale, sub};
use motet::mesh::{Boundary, Cells, Field, shapes};
use motet::motion::{
    Elastic, Extent, FacetSet, Interface, Laplace, Method, Mover, Options, RigidLayer, SlideTolerance,
};

const SIDES: [&str; 6] = ["xmin", "xmax", "ymin", "ymax", "zmin", "zmax"];
const LOW: Point = [0.0, 0.0, 0.0];
const HIGH: Point = [2.0, 1.5, 1.0];

/// `x' = A x + b`, by rows.
type Affine = [[f64; 4]; 3];

fn apply(rows: &Affine, p: Point) -> Point {
    rows.map(|[a, b, c, d]| a * p[0] + b * p[1] + c * p[2] + d)
}

/// The composition: first `first`, then `then`.
fn after(then: &Affine, first: &Affine) -> Affine {
    let entry = |row: &[f64; 4], k: usize| (0..3).map(|i| row[i] * first[i][k]).sum::<f64>();
    then.map(|row| [entry(&row, 0), entry(&row, 1), entry(&row, 2), entry(&row, 3) + row[3]])
}

/// A rotation about an axis that is not a coordinate axis, and its inverse, each with this shift.
fn turned(shift: f64) -> [Affine; 2] {
    let x = scale([2.0, -1.0, 3.0], 1.0 / 14f64.sqrt());
    let y = cross(x, [0.0, 1.0, 0.0]);
    let y = scale(y, 1.0 / norm(y));
    let z = cross(x, y);
    let by = [shift, -shift, 0.7 * shift];
    let to = [0, 1, 2].map(|i| [x[i], y[i], z[i], by[i]]);
    let from = [x, y, z].map(|axis| [axis[0], axis[1], axis[2], -dot(axis, by)]);
    [to, from]
}

/// A map from a box to a leaning parallelepiped, and its inverse.
fn leaning() -> [Affine; 2] {
    let to = [[1.0, 0.4, 0.3, 0.0], [0.0, 1.0, -0.5, 0.0], [0.0, 0.0, 1.0, 0.0]];
    let from = [[1.0, -0.4, -0.5, 0.0], [0.0, 1.0, 0.5, 0.0], [0.0, 0.0, 1.0, 0.0]];
    [to, from]
}

const SAME: Affine = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// An affine motion of the box that keeps the planes of the sides in `slides`: bit `2 k + s` is the lower or
/// upper side along axis `k`.
fn keeping(slides: usize) -> Affine {
    let free = [[0.9, 0.15, -0.1, 0.05], [0.1, 1.1, 0.2, -0.1], [-0.2, 0.1, 0.7, 0.3]];
    [0, 1, 2].map(|k| match slides >> (2 * k) & 3 {
        0 => free[k],
        3 => SAME[k],
        side => {
            let (stretch, fixed) = ([1.3, 0.8, 0.6][k], if side == 1 { LOW[k] } else { HIGH[k] });
            let mut row = [0.0, 0.0, 0.0, (1.0 - stretch) * fixed];
            row[k] = stretch;
            row
        }
    })
}

fn sides(mesh: &Mesh, slides: usize) -> Vec<FacetSet> {
    let named = SIDES.iter().enumerate().filter(|(side, _)| slides >> side & 1 == 1);
    named.map(|(_, name)| FacetSet::find(mesh, name).unwrap()).collect()
}

/// The input for each driven vertex: the motion on sides that do not slide, zero on others.
fn places_to_go(mesh: &Mesh, mover: &Mover, sliding: &[FacetSet], motion: &Affine) -> Vec<Point> {
    let boundary = Boundary::of(&mesh.cells);
    let keys: Vec<Vec<VertexId>> = sliding.iter().flat_map(|s| s.rings.iter().map(sorted)).collect();
    let rings = FacetSet::of_boundary(&boundary, "", |_| true).rings;
    let others = FacetSet::of_boundary(&boundary, "", |i| !keys.contains(&sorted(rings.list(i))));
    let of = |v: &VertexId| match others.vertices.binary_search(v) {
        Ok(_) => sub(apply(motion, mesh.points[v.index()]), mesh.points[v.index()]),
        Err(_) => [0.0; 3],
    };
    mover.boundary().iter().map(of).collect()
}

fn sorted(ring: &[VertexId]) -> Vec<VertexId> {
    let mut ring = ring.to_vec();
    ring.sort_unstable();
    ring
}

/// Moves `mesh` by its driven vertices, and asserts the same affine motion of every vertex, within
/// `tolerance`.
fn is_affine(mesh: &Mesh, options: &Options, motion: &Affine, tolerance: f64) {
    let threads = Threads::single();
    let mut mover = Mover::new(mesh, options, &threads).unwrap();
    let driven = places_to_go(mesh, &mover, &options.sliding, motion);
    let mut out = mesh.points.clone();
    let certificate = mover.advance(&driven, &mut out, &threads).unwrap();
    assert!(certificate.complete, "{} of the way", certificate.fraction);
    for (v, (&p, &q)) in mesh.points.iter().zip(&out).enumerate() {
        let expected = apply(motion, p);
        assert!(distance(q, expected) <= tolerance, "{v}: {p:?} is at {q:?}, not {expected:?}");
    }
}

fn small_box() -> Mesh {
    shapes::box_grid([4, 3, 3], [LOW, HIGH])
}

fn placed(mut mesh: Mesh, to: &Affine) -> Mesh {
    mesh.points.iter_mut().for_each(|p| *p = apply(to, *p));
    mesh
}

fn sliding(sets: Vec<FacetSet>) -> Options {
    Options { sliding: sets, ..Options::default() }
}

#[test]
fn a_box_of_which_any_sides_slide_takes_every_affine_motion_that_keeps_their_planes() {
    for slides in 1..63 {
        let mesh = small_box();
        is_affine(&mesh, &sliding(sides(&mesh, slides)), &keeping(slides), 1e-14);
    }
}

#[test]
fn so_it_does_turned_leaning_and_far_from_the_origin() {
    for ([to, from], tolerance) in [(turned(0.0), 1e-14), (turned(1e3), 1e-11), (leaning(), 1e-14)] {
        for slides in 1..63 {
            let motion = after(&to, &after(&keeping(slides), &from));
            let mesh = placed(small_box(), &to);
            is_affine(&mesh, &sliding(sides(&mesh, slides)), &motion, tolerance);
        }
    }
}

#[test]
fn and_with_coordinates_of_single_precision() {
    for (shift, size) in [(0.0, 2.0), (1e3, 1e3)] {
        let [to, from] = turned(shift);
        for slides in [5, 20, 21, 31, 47, 54, 61] {
            let mut mesh = placed(small_box(), &to);
            mesh.points.iter_mut().for_each(|p| *p = p.map(|x| f64::from(x as f32)));
            let motion = after(&to, &after(&keeping(slides), &from));
            is_affine(&mesh, &sliding(sides(&mesh, slides)), &motion, 8.0 * size * f64::from(f32::EPSILON));
        }
    }
}

#[test]
fn scale_does_not_matter() {
    for size in [1e-3, 1e3] {
        let by = [[size, 0.0, 0.0, 0.0], [0.0, size, 0.0, 0.0], [0.0, 0.0, size, 0.0]];
        let back = by.map(|row| row.map(|x| if x == 0.0 { 0.0 } else { 1.0 / x }));
        for slides in [5, 21, 31, 62] {
            let mesh = placed(small_box(), &by);
            let motion = after(&by, &after(&keeping(slides), &back));
            is_affine(&mesh, &sliding(sides(&mesh, slides)), &motion, 1e-13 * size);
        }
    }
}

#[test]
fn middle_nodes_of_sliding_edges_slide_too() {
    for slides in [5, 21, 31, 47] {
        let mesh = shapes::quadratic(&small_box());
        is_affine(&mesh, &sliding(sides(&mesh, slides)), &keeping(slides), 1e-14);
    }
}

#[test]
fn other_methods_that_keep_affine_motions_keep_them_with_sides_that_slide() {
    let exact = Elastic { factor_bytes: 1 << 30, ..Elastic::default() };
    let harmonic = Laplace { factor_bytes: 1 << 30, exponent: 0.0, ..Laplace::default() };
    let methods = [Method::Elastic(exact), Method::Laplace(harmonic), Method::Guided];
    for method in methods {
        for slides in [5, 21, 31] {
            let mesh = small_box();
            let options = Options { method: method.clone(), ..sliding(sides(&mesh, slides)) };
            is_affine(&mesh, &options, &keeping(slides), 1e-7);
        }
    }
}

/// The boundary facets in each coordinate plane, as one set per plane.
fn planes_of(mesh: &Mesh) -> BTreeMap<String, FacetSet> {
    let boundary = Boundary::of(&mesh.cells);
    let plane = |i: usize| {
        let at = |v: &VertexId, k: usize| mesh.points[v.index()][k];
        let ring = boundary.facets.list(i);
        let flat = (0..3).find(|&k| ring.iter().all(|v| at(v, k) == at(&ring[0], k))).unwrap();
        format!("{} = {}", ["x", "y", "z"][flat], at(&ring[0], flat))
    };
    let names: Vec<String> = (0..boundary.len()).map(plane).collect();
    let set = |name: &String| (name.clone(), FacetSet::of_boundary(&boundary, name, |i| names[i] == *name));
    names.iter().map(set).collect()
}

/// A box without the cells whose centre satisfies `is_out`.
fn notched(n: [usize; 3], high: Point, is_out: impl Fn(Point) -> bool) -> Mesh {
    let whole = shapes::box_grid(n, [LOW, high]);
    let middle = |tet: &[VertexId; 4]| {
        scale(tet.iter().fold([0.0; 3], |sum, v| add(sum, whole.points[v.index()])), 0.25)
    };
    let tets: Vec<[VertexId; 4]> =
        whole.cells.tets().map(|(_, tet)| tet).filter(|tet| !is_out(middle(tet))).collect();
    let mut used: Vec<VertexId> = tets.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    let new = |v: &VertexId| VertexId::new(used.binary_search(v).unwrap());
    let cells =
        Cells::uniform(motet::mesh::CellKind::TETRA, tets.as_flattened().iter().map(new).collect()).unwrap();
    Mesh::new(used.iter().map(|v| whole.points[v.index()]).collect(), cells)
}

#[test]
fn edges_that_turn_inward_and_lines_in_several_parts_slide() {
    // An L, and a block with a groove through its top, whose walls slide, too. All faces but the ends along x
    // slide.
    let l = notched([3, 4, 4], [3.0, 2.0, 2.0], |p| p[1] > 1.0 && p[2] > 1.0);
    let groove = notched([3, 4, 4], [3.0, 2.0, 2.0], |p| (0.5..1.5).contains(&p[1]) && p[2] > 1.0);
    let motion = [[0.5, 0.0, 0.0, 0.0], SAME[1], SAME[2]];
    for mesh in [l, groove] {
        let sets: Vec<FacetSet> = planes_of(&mesh)
            .into_iter()
            .filter(|(name, _)| !name.starts_with('x'))
            .map(|(_, set)| set)
            .collect();
        assert!(sets.len() > 4);
        is_affine(&mesh, &sliding(sets), &motion, 1e-14);
    }
}

#[test]
fn patches_side_by_side_in_one_plane_slide_as_one() {
    // Each sliding side is cut in two along a zigzag.
    let mesh = small_box();
    let boundary = Boundary::of(&mesh.cells);
    let mut sets = Vec::new();
    for side in sides(&mesh, 0b1111) {
        for part in 0..2 {
            let of_side =
                |i: usize| side.rings.iter().position(|ring| sorted(ring) == sorted(boundary.facets.list(i)));
            let set = FacetSet::of_boundary(&boundary, format!("{} {part}", side.name), |i| {
                of_side(i).is_some_and(|at| at % 2 == part)
            });
            sets.push(set);
        }
    }
    assert_eq!(sets.len(), 8);
    let squeeze = [SAME[0], SAME[1], [0.0, 0.0, 0.5, 0.0]];
    is_affine(&mesh, &sliding(sets.clone()), &squeeze, 1e-14);
    let mover = Mover::new(&mesh, &sliding(sets), &Threads::single()).unwrap();
    assert_eq!(mover.sliding().len(), 4);
}

// ---------------------------------------------------------------- nearly flat patches

/// A box whose upper side along z is a shallow dish of this depth, and that side.
fn dish(depth: f64) -> (Mesh, FacetSet) {
    let mut mesh = shapes::box_grid([6, 6, 4], [[-1.0, -1.0, 0.0], [1.0, 1.0, 1.0]]);
    for p in &mut mesh.points {
        p[2] -= p[2] * depth * (1.0 - p[0] * p[0]) * (1.0 - p[1] * p[1]);
    }
    let top = FacetSet::find(&mesh, "zmax").unwrap();
    (mesh, top)
}

#[test]
fn a_patch_that_is_nearly_flat_slides_and_is_reported_and_stays_as_far_off() {
    let (mesh, top) = dish(0.03);
    let threads = Threads::single();
    let mut mover = Mover::new(&mesh, &sliding(vec![top.clone()]), &threads).unwrap();
    let [plane] = mover.sliding() else { panic!("one plane") };
    // The mean height is between those of the rim and the bottom of the dish.
    assert!(plane.deviation > 0.015 && plane.deviation < 0.03, "{plane:?}");
    assert!(plane.radius > 1.3 && plane.radius < 1.5 && plane.sliding == 25, "{plane:?}");
    let mut out = vec![[9.0; 3]; mesh.points.len()];
    mover.advance(&vec![[0.0; 3]; mover.boundary().len()], &mut out, &threads).unwrap();
    assert_eq!(out, mesh.points, "no motion is the identity, to the bit");
    // When widened in the plane, every vertex keeps its height.
    let widen = |v: &VertexId| {
        let [x, y, _] = mesh.points[v.index()];
        [0.2 * x, 0.1 * y, 0.0]
    };
    let driven: Vec<Point> = mover.boundary().iter().map(widen).collect();
    mover.advance(&driven, &mut out, &threads).unwrap();
    for v in &top.vertices {
        let ([x, y, z], moved) = (mesh.points[v.index()], out[v.index()]);
        assert_eq!(moved[2], z);
        assert!((moved[0] - 1.2 * x).abs() < 1e-14 && (moved[1] - 1.1 * y).abs() < 1e-14);
    }
}

#[test]
fn how_far_off_is_allowed_can_be_said_and_the_error_tells_how_far_it_is() {
    let (mesh, top) = dish(0.2);
    let options = sliding(vec![top.clone()]);
    let places_to_go = Mover::new(&mesh, &options, &Threads::single()).unwrap_err().to_string();
    for part in ["sliding patch zmax", "is not flat", "--slide-tolerance", "--flatten"] {
        assert!(places_to_go.contains(part), "{places_to_go}");
    }
    let wide = Options { slide_tolerance: SlideTolerance(0.2), ..options.clone() };
    assert!(Mover::new(&mesh, &wide, &Threads::single()).is_ok());
    for off in [-0.1, 1.0, f64::NAN] {
        let options = Options { slide_tolerance: SlideTolerance(off), ..options.clone() };
        assert!(Mover::new(&mesh, &options, &Threads::single()).is_err());
    }
}

#[test]
fn a_shallow_dish_in_two_halves_is_one_plane() {
    let (mesh, top) = dish(0.02);
    let boundary = Boundary::of(&mesh.cells);
    let is_left = |i: usize| boundary.facets.list(i).iter().all(|v| mesh.points[v.index()][0] <= 0.0);
    let is_top = |i: usize| boundary.facets.list(i).iter().all(|v| top.vertices.binary_search(v).is_ok());
    let halves = [true, false]
        .map(|left| FacetSet::of_boundary(&boundary, "half", |i| is_top(i) && is_left(i) == left));
    let mover = Mover::new(&mesh, &sliding(halves.to_vec()), &Threads::single()).unwrap();
    let whole = Mover::new(&mesh, &sliding(vec![top]), &Threads::single()).unwrap();
    assert_eq!(mover.sliding().len(), 1);
    assert_eq!(mover.setup().sliding, whole.setup().sliding);
}

// ---------------------------------------------------------------- what drives beside planes that slide

#[test]
fn a_vertex_that_is_asked_to_be_driven_does_not_slide() {
    let mesh = small_box();
    let side = sides(&mesh, 1);
    let plug: Vec<VertexId> = side[0]
        .vertices
        .iter()
        .copied()
        .filter(|v| mesh.points[v.index()] == [0.0, 0.5, 1.0 / 3.0])
        .collect();
    assert_eq!(plug.len(), 1);
    let options = Options { also_moved: plug.clone(), ..sliding(side) };
    let threads = Threads::single();
    let mut mover = Mover::new(&mesh, &options, &threads).unwrap();
    let by = [0.0, 0.1, 0.05];
    let driven: Vec<Point> =
        mover.boundary().iter().map(|v| if *v == plug[0] { by } else { [0.0; 3] }).collect();
    let mut out = mesh.points.clone();
    assert!(mover.advance(&driven, &mut out, &threads).unwrap().complete);
    assert_eq!(out[plug[0].index()], add(mesh.points[plug[0].index()], by));
}

#[test]
fn a_rim_that_leaves_its_plane_is_reported_with_its_farthest_vertex() {
    let mesh = small_box();
    let threads = Threads::single();
    let mut mover = Mover::new(&mesh, &sliding(sides(&mesh, 1)), &threads).unwrap();
    let mut out = mesh.points.clone();
    let mut leaving = |by: &dyn Fn(Point) -> Point| {
        let driven: Vec<Point> = mover.boundary().iter().map(|v| by(mesh.points[v.index()])).collect();
        mover.advance(&driven, &mut out, &threads).unwrap().leaves_plane
    };
    assert_eq!(leaving(&|_| [0.0; 3]), None);
    assert_eq!(leaving(&|p| [0.0, 0.1 * p[1], 0.2 * p[2]]), None, "within the plane");
    // The upper side along z is sheared: its edge with the sliding side leaves the plane most at its upper
    // end.
    let places_to_go = leaving(&|p| [0.1 * p[2] * (1.0 + p[1]), 0.0, 0.0]).unwrap();
    assert_eq!((places_to_go.patch.as_str(), places_to_go.place), ("xmin", [0.0, 1.5, 1.0]));
    assert!((places_to_go.distance - 0.25).abs() < 1e-15 && places_to_go.is_significant, "{places_to_go:?}");
    let places_to_go = leaving(&|p| [1e-9 * p[2], 0.0, 0.0]).unwrap();
    assert!(!places_to_go.is_significant, "{places_to_go:?}");
}

#[test]
fn what_a_rigid_layer_holds_stays_on_its_line() {
    let mesh = small_box();
    let wall = FacetSet::find(&mesh, "zmax").unwrap();
    let rigid = RigidLayer { extent: Extent::Cells(1), wall: Some(wall.clone()) };
    let options = Options { rigid_layer: Some(rigid), ..sliding(sides(&mesh, 0b1111)) };
    let threads = Threads::single();
    let mut mover = Mover::new(&mesh, &options, &threads).unwrap();
    // The wall bends, so that offsets rotate; at the ends this would lead out of the planes.
    let bend = |v: &VertexId| match wall.vertices.binary_search(v) {
        Ok(_) => [0.0, 0.0, 0.1 * mesh.points[v.index()][0] * mesh.points[v.index()][0]],
        Err(_) => [0.0; 3],
    };
    let driven: Vec<Point> = mover.boundary().iter().map(bend).collect();
    let mut out = mesh.points.clone();
    assert!(mover.advance(&driven, &mut out, &threads).unwrap().complete);
    let mut on_lines = 0;
    for (p, q) in mesh.points.iter().zip(&out) {
        let held = [0, 1].map(|k| p[k] == LOW[k] || p[k] == HIGH[k]);
        assert!((0..2).all(|k| !held[k] || p[k] == q[k]), "{p:?} {q:?}");
        on_lines += usize::from(held == [true; 2] && p[2] > 0.0 && p[2] < 1.0 && p[0] > 0.0 && q[2] > p[2]);
    }
    assert_eq!(on_lines, 4, "inner vertices of the two edges at the far end went along");
}

// ---------------------------------------------------------------- interfaces

/// The box in two regions that meet in the plane `x = 1`.
fn halves() -> Mesh {
    let mut mesh = small_box();
    let middle = |tet: &[VertexId]| 0.25 * tet.iter().map(|v| mesh.points[v.index()][0]).sum::<f64>();
    let region = |(_, kind, vertices): (_, motet::mesh::CellKind, &[VertexId])| match kind.dim() {
        Some(3) => i32::from(middle(vertices) > 1.0),
        _ => 0,
    };
    let regions: Vec<i32> = mesh.cells.iter().map(region).collect();
    mesh.set_cell_field(Field::scalars("region", regions));
    mesh
}

#[test]
fn an_array_moves_the_interface_of_regions_where_it_is_not_zero_there() {
    let mesh = halves();
    let boundary = Boundary::of(&mesh.cells);
    let on_plane: Vec<VertexId> =
        (0..mesh.points.len()).map(VertexId::new).filter(|v| mesh.points[v.index()][0] == 1.0).collect();
    let mut rows = vec![[0.0; 3]; mesh.points.len()];
    assert_eq!(Interface::moved(&mesh, &boundary, &rows).unwrap(), []);
    // On the boundary alone, or off the interface: nothing is prescribed on the interface.
    rows[on_plane[0].index()] = [0.1; 3];
    let beside = (0..mesh.points.len()).find(|&v| mesh.points[v] == [0.5, 0.5, 1.0 / 3.0]).unwrap();
    rows[beside] = [0.1; 3];
    assert_eq!(Interface::moved(&mesh, &boundary, &rows).unwrap(), []);
    let inside = on_plane.iter().find(|v| boundary.vertices.binary_search(v).is_err()).unwrap();
    rows[inside.index()] = [0.0, 0.0, 0.1];
    let moved = Interface::moved(&mesh, &boundary, &rows).unwrap();
    assert_eq!(moved.len(), 1);
    assert_eq!(moved[0].vertices, on_plane);
    rows[on_plane[1].index()] = [f64::NAN; 3];
    assert!(Interface::moved(&mesh, &boundary, &rows).unwrap_err().to_string().contains("interface"));
    assert!(Interface::moved(&mesh, &boundary, &rows[1..]).is_err());
}

#[test]
fn a_sheet_of_labelled_facets_inside_is_an_interface() {
    let mesh = small_box();
    let boundary = Boundary::of(&mesh.cells);
    assert_eq!(Interface::all(&mesh, &boundary), []);
    let facets = motet::mesh::adjacency::Facets::of(&mesh.cells);
    let mut sheet: Vec<VertexId> = Vec::new();
    facets.for_each_shared(|uses| {
        let corners: Vec<VertexId> = facets.corners(uses[0]).collect();
        if corners.iter().all(|v| mesh.points[v.index()][0] == 1.0) {
            sheet.extend(corners);
        }
    });
    let with_sheet = {
        let mut mesh = mesh.clone();
        let patches = mesh.patches().unwrap();
        let mut labels = patches.ids.clone();
        for corners in sheet.chunks(3) {
            mesh.cells.push(motet::mesh::CellKind::TRIANGLE, corners.iter().copied());
            labels.push(77);
        }
        let mut cells = Mesh::new(mesh.points.clone(), mesh.cells.clone());
        cells.set_cell_field(Field::scalars("patch", labels));
        cells
    };
    let [interface] = &Interface::all(&with_sheet, &boundary)[..] else { panic!("one interface") };
    sheet.sort_unstable();
    sheet.dedup();
    assert_eq!((interface.name.as_str(), &interface.vertices), ("77", &sheet));
}
