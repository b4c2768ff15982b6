//! What to refine in whole meshes: each criterion against its definition, what may be coarsened, and what is refused.

mod common;

use std::sync::Arc;

use common::Numbers;
use motet::ErrorKind;
use motet::base::{Point, TetId, Threads, VertexId};
use motet::geometry::distance::triangle_triangle;
use motet::geometry::tet::{self, EDGES, FACETS, centroid, holds};
use motet::geometry::vector::{distance, dot, norm};
use motet::mesh::shapes::{ball, box_grid, sphere_in_box};
use motet::mesh::{CellKind, Cells, Field, Mesh, Surface, TetMesh, TetPart};
use motet::refine::wish::{Wish, check_expected, coarser, expected_tets, marked};
use motet::refine::{
    Aim, Amount, Condition, Criterion, Estimator, HessianSizes, Limits, Options, Refinement, Size, Target,
    estimate, mark, marks_of_all, sizes, wishes_of_all,
};

fn corners(mesh: &TetMesh, t: usize) -> [Point; 4] {
    mesh.tets[t].map(|v| mesh.points[v.index()])
}

fn longest(corners: [Point; 4]) -> f64 {
    EDGES.map(|[i, j]| distance(corners[i], corners[j])).into_iter().fold(0.0, f64::max)
}

/// The tets for which the definition holds.
fn those(part: &TetPart, holds: impl Fn(usize) -> bool) -> Vec<TetId> {
    (0..part.mesh.tets.len()).filter(|&t| holds(t)).map(TetId::new).collect()
}

/// Tets and triangles as cells of a mesh, in mixed order: triangles first, so that tets have other numbers.
fn whole(tets: &TetMesh) -> Mesh {
    let mut cells = Cells::new();
    tets.triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
    tets.tets.iter().for_each(|t| cells.push(CellKind::TETRA, *t));
    let mut mesh = Mesh::new(tets.points.clone(), cells);
    let zeros = |n: usize| vec![0; n].into_iter();
    let [n, m] = [tets.tets.len(), tets.triangles.len()];
    let regions: Vec<i32> = zeros(m).chain(tets.regions.iter().copied()).collect();
    let patches: Vec<i32> = tets.patches.iter().copied().chain(zeros(n)).collect();
    mesh.set_cell_field(Field::scalars("region", regions));
    mesh.set_cell_field(Field::scalars("patch", patches));
    mesh
}

fn speed(p: &Point) -> Point {
    [p[1] * p[2], (2.0 * p[0]).sin(), p[0] - p[1] * p[1]]
}

fn pressure(p: &Point) -> f64 {
    (1.5 * p[0]).tanh() + 0.3 * p[1] * p[2]
}

/// Fields by formula, on points and on cells.
fn with_fields(mut mesh: Mesh) -> Mesh {
    let v: Vec<Point> = mesh.points.iter().map(speed).collect();
    mesh.set_point_field(Field::vectors("v", &v));
    mesh.set_point_field(Field::scalars("p", mesh.points.iter().map(pressure).collect::<Vec<_>>()));
    let size: Vec<f64> = mesh.points.iter().map(|p| 0.6 + 0.35 * norm(*p)).collect();
    mesh.set_point_field(Field::scalars("h", size));
    let middle = |vertices: &[VertexId]| {
        vertices.iter().map(|v| mesh.points[v.index()][0]).sum::<f64>() / vertices.len() as f64
    };
    let on_cells: Vec<f64> = mesh.cells.iter().map(|(_, _, vertices)| middle(vertices)).collect();
    mesh.set_cell_field(Field::scalars("x", on_cells));
    mesh
}

/// A ball in a box, in two regions, with fields; and its tets.
fn case() -> (Mesh, TetPart) {
    let mut tets = TetPart::of(&sphere_in_box(3, 4)).unwrap().mesh;
    let labels: Vec<i32> =
        (0..tets.tets.len()).map(|t| if centroid(corners(&tets, t))[0] < 0.5 { 3 } else { 7 }).collect();
    tets.regions = labels;
    let mut mesh = with_fields(whole(&tets));
    mesh.label_names.regions.insert(7, "right".into());
    mesh.label_names.patches.insert(1, "sphere".into());
    let part = TetPart::of(&mesh).unwrap();
    (mesh, part)
}

/// Two plates, and a closed surface that a tet holds whole.
fn target(threads: &Threads) -> Arc<Target> {
    let mut points = vec![[1.2, -1.0, -1.0], [3.0, 0.5, 1.0], [1.5, 2.0, 0.3], [-2.0, 0.0, 2.0]];
    let mut triangles = vec![[0, 1, 2].map(VertexId), [1, 2, 3].map(VertexId)];
    let first = points.len() as u32;
    let small = [[0.0; 3], [1e-3, 0.0, 0.0], [0.0, 1e-3, 0.0], [0.0, 0.0, 1e-3]];
    points.extend(small.map(|p: Point| [p[0] - 4.1, p[1] - 3.9, p[2] + 4.2]));
    triangles.extend(FACETS.map(|facet| facet.map(|i| VertexId(first + i as u32))));
    Arc::new(Target::new(points, triangles, threads).unwrap())
}

fn target_triangles(target: &Target) -> Vec<[Point; 3]> {
    target.triangles().iter().map(|t| t.map(|v| target.points()[v.index()])).collect()
}

/// The distance of a tet from triangles, by looking at all.
fn from_triangles(corners: [Point; 4], triangles: &[[Point; 3]]) -> f64 {
    let from = |triangle: &[Point; 3]| {
        let facets = FACETS.map(|facet| {
            triangle_triangle::closest(facet.map(|i| corners[i]), *triangle).distance_squared.sqrt()
        });
        if holds(corners, triangle[0]) { 0.0 } else { facets.into_iter().fold(f64::INFINITY, f64::min) }
    };
    triangles.iter().map(from).fold(f64::INFINITY, f64::min)
}

#[test]
fn near_means_that_some_place_of_the_tet_is() {
    let threads = Threads::single();
    let (mesh, part) = case();
    let target = target(&threads);
    let triangles = target_triangles(&target);
    for within in [0.0, 0.05, 0.4, 1.7] {
        let criterion = Criterion::Near { target: target.clone(), within };
        let marks = criterion.marks(&mesh, &part, &threads).unwrap();
        let expected = those(&part, |t| from_triangles(corners(&part.mesh, t), &triangles) <= within);
        assert_eq!(marks, expected, "{within}");
        println!("within {within}: {} of {} tets", marks.len(), part.mesh.tets.len());
        assert!(!marks.is_empty() && marks.len() < part.mesh.tets.len());
    }
}

#[test]
fn criteria_of_place_mark_what_they_say() {
    let threads = Threads::single();
    let (mesh, part) = case();
    let marks = |criterion: Criterion| criterion.marks(&mesh, &part, &threads).unwrap();
    let all = those(&part, |_| true);
    assert_eq!(marks(Criterion::All), all);
    let (centre, radius) = ([1.0, 0.5, 0.0], 1.3);
    assert_eq!(
        marks(Criterion::Ball { centre, radius }),
        mark::in_ball(&part.mesh, centre, radius, &threads)
    );
    let corners_of_box = [[-1.0, -2.0, -5.0], [3.0, 2.0, 0.0]];
    assert_eq!(marks(Criterion::Box(corners_of_box)), mark::in_box(&part.mesh, corners_of_box, &threads));
    for (word, id) in [("right", 7), ("7", 7), ("3", 3)] {
        let expected = those(&part, |t| part.mesh.regions[t] == id);
        assert!(!expected.is_empty() && expected.len() < all.len());
        assert_eq!(marks(Criterion::Region(word.into())), expected);
    }
    // The sphere has radius 1 and the box is far.
    let is_on = |v: VertexId| norm(part.mesh.points[v.index()]) < 1.0 + 1e-9;
    let expected = those(&part, |t| part.mesh.tets[t].into_iter().any(is_on));
    assert!(!expected.is_empty() && expected.len() < all.len());
    assert_eq!(marks(Criterion::Patch { patch: "sphere".into(), within: None }), expected);
    assert_eq!(marks(Criterion::Patch { patch: "1".into(), within: Some(0.0) }), expected);
    let surface = Surface::of(&mesh);
    let sphere: Vec<[Point; 3]> = (0..surface.triangles.len())
        .filter(|&t| surface.patches[t] == 1)
        .map(|t| surface.corners(t))
        .collect();
    let expected = those(&part, |t| from_triangles(corners(&part.mesh, t), &sphere) <= 1.1);
    assert_eq!(marks(Criterion::Patch { patch: "sphere".into(), within: Some(1.1) }), expected);
}

#[test]
fn sizes_mark_edges_that_are_longer() {
    let threads = Threads::single();
    let (mesh, part) = case();
    let marks = |criterion: Criterion| criterion.marks(&mesh, &part, &threads).unwrap();
    let expected = those(&part, |t| longest(corners(&part.mesh, t)) > 1.5);
    assert!(!expected.is_empty() && expected.len() < part.mesh.tets.len());
    assert_eq!(marks(Criterion::Size(Size::Uniform(1.5))), expected);
    let h = mesh.point_field("h").unwrap().values.to_f64().unwrap();
    let is_long = |t: usize| {
        EDGES.into_iter().any(|[i, j]| {
            let [a, b] = [i, j].map(|i| part.mesh.tets[t][i].index());
            distance(mesh.points[a], mesh.points[b]) > 0.5 * (h[a] + h[b])
        })
    };
    assert_eq!(marks(Criterion::Size(Size::Array("h".into()))), those(&part, is_long));
    let mut positive = mesh.clone();
    let x = mesh.cell_field("x").unwrap().values.to_f64().unwrap();
    let on_cells: Vec<f64> = x.iter().map(|x| 1.0 + 0.1 * x.abs()).collect();
    positive.set_cell_field(Field::scalars("size", on_cells.clone()));
    let expected = those(&part, |t| longest(corners(&part.mesh, t)) > on_cells[part.tet_to_cell[t].index()]);
    let by_cell = Criterion::Size(Size::Array("size".into()));
    assert_eq!(by_cell.marks(&positive, &part, &threads).unwrap(), expected);
    let target = target(&threads);
    let near = Criterion::NearSize { target: target.clone(), size: 0.2, growth: 0.7 };
    assert_eq!(marks(near), mark::near_surface(&part.mesh, target.tree(), 0.2, 0.7, &threads));
}

#[test]
fn conditions_hold_for_cells_by_value_and_for_points_at_any_corner() {
    let threads = Threads::single();
    let (mesh, part) = case();
    let marks = |text: &str| {
        let condition: Condition = text.parse().unwrap();
        Criterion::Where(condition).marks(&mesh, &part, &threads).unwrap()
    };
    let at_corner =
        |holds: &dyn Fn(Point) -> bool| those(&part, |t| corners(&part.mesh, t).into_iter().any(holds));
    assert_eq!(marks("p>1"), at_corner(&|p| pressure(&p) > 1.0));
    assert_eq!(marks("|p| <= 0.01"), at_corner(&|p| pressure(&p).abs() <= 0.01));
    assert_eq!(marks("v>=6"), at_corner(&|p| norm(speed(&p)) >= 6.0));
    assert_eq!(marks("|v|<1"), at_corner(&|p| norm(speed(&p)) < 1.0));
    for text in ["v:y<-0.5", "v[1]<-0.5"] {
        assert_eq!(marks(text), at_corner(&|p| speed(&p)[1] < -0.5));
    }
    let x = mesh.cell_field("x").unwrap().values.to_f64().unwrap();
    assert_eq!(marks("x>2.5"), those(&part, |t| x[part.tet_to_cell[t].index()] > 2.5));
    assert_eq!(marks("region==7"), those(&part, |t| part.mesh.regions[t] == 7));
    assert_eq!(marks("region!=7"), those(&part, |t| part.mesh.regions[t] == 3));
    // Of an array by that very name no component is meant.
    let mut odd = mesh.clone();
    odd.set_point_field(Field::scalars("v:y", vec![1.0; mesh.points.len()]));
    let condition = Criterion::Where("v:y>0".parse().unwrap());
    assert_eq!(condition.marks(&odd, &part, &threads).unwrap().len(), part.mesh.tets.len());
}

#[test]
fn criteria_of_fields_mark_by_their_estimates() {
    let threads = Threads::single();
    let (mesh, part) = case();
    let marks = |criterion: Criterion| criterion.marks(&mesh, &part, &threads).unwrap();
    let p: Vec<f64> = mesh.points.iter().map(pressure).collect();
    let v: Vec<Point> = mesh.points.iter().map(speed).collect();
    let gradients = estimate::gradients(&part.mesh, &p, &threads);
    let expected = those(&part, |t| norm(gradients[t]) * longest(corners(&part.mesh, t)) > 2.0);
    assert!(!expected.is_empty() && expected.len() < part.mesh.tets.len());
    assert_eq!(marks(Criterion::Gradient { array: "p".into(), above: 2.0 }), expected);
    let tensors = estimate::velocity_gradients(&part.mesh, &v, &threads);
    let size = |t: usize| tensors[t].iter().map(|row| dot(*row, *row)).sum::<f64>().sqrt();
    let expected = those(&part, |t| size(t) * longest(corners(&part.mesh, t)) > 8.0);
    assert_eq!(marks(Criterion::Gradient { array: "v".into(), above: 8.0 }), expected);
    let curl = estimate::vorticity(&part.mesh, &v, &threads);
    let expected = those(&part, |t| norm(curl[t]) > 3.0);
    assert_eq!(marks(Criterion::Vorticity { array: "v".into(), above: 3.0 }), expected);
    let q = estimate::q_criterion(&part.mesh, &v, &threads);
    assert_eq!(marks(Criterion::Q { array: "v".into(), above: 0.5 }), those(&part, |t| q[t] > 0.5));
    for (by, of) in [
        (Estimator::Jump, estimate::gradient_jump as fn(&TetMesh, &[f64], &Threads) -> Vec<f64>),
        (Estimator::Recovery, estimate::recovery),
    ] {
        let amount = |amount| Criterion::Estimate { array: "p".into(), by, amount };
        let estimates = of(&part.mesh, &p, &threads);
        assert_eq!(marks(amount(Amount::Share(0.4))), mark::largest_share(&estimates, 0.4));
        let n = part.mesh.tets.len() + 700;
        assert_eq!(marks(amount(Amount::Tets(n))), mark::to_count(&estimates, n));
        // Of a vector all components count.
        let of_axis = |k: usize| of(&part.mesh, &v.iter().map(|v| v[k]).collect::<Vec<_>>(), &threads);
        let of_axes = [0, 1, 2].map(of_axis);
        let all: Vec<f64> = (0..part.mesh.tets.len())
            .map(|t| of_axes.iter().map(|of_axis| of_axis[t] * of_axis[t]).sum::<f64>().sqrt())
            .collect();
        let of_vector = Criterion::Estimate { array: "v".into(), by, amount: Amount::Share(0.5) };
        assert_eq!(marks(of_vector), mark::largest_share(&all, 0.5));
        let of_component = Criterion::Estimate { array: "v:z".into(), by, amount: Amount::Share(0.5) };
        assert_eq!(marks(of_component), mark::largest_share(&of_axes[2], 0.5));
    }
}

#[test]
fn several_criteria_mark_what_any_of_them_does_on_any_number_of_threads() {
    let (one, three) = (Threads::single(), Threads::new(3).unwrap());
    let (mesh, part) = case();
    let criteria = all_criteria(&one);
    let mut expected: Vec<TetId> = Vec::new();
    for criterion in &criteria[..4] {
        expected.extend(criterion.marks(&mesh, &part, &one).unwrap());
    }
    expected.sort_unstable();
    expected.dedup();
    assert_eq!(marks_of_all(&criteria[..4], &mesh, &part, &one).unwrap(), expected);
    let wishes = wishes_of_all(&criteria, &mesh, &part, &one).unwrap();
    assert_eq!(wishes, wishes_of_all(&criteria, &mesh, &part, &three).unwrap());
    let none = wishes_of_all(&[], &mesh, &part, &one).unwrap();
    assert_eq!((marked(&none), coarser(&none).len()), (vec![], part.mesh.tets.len()));
}

/// One of each kind.
fn all_criteria(threads: &Threads) -> Vec<Criterion> {
    let hessian = |aim| {
        let arrays = vec!["p".into(), "v".into()];
        Criterion::Hessian(HessianSizes { arrays, aim, limits: sizes::SizeLimits::default() })
    };
    let amount = Amount::Share(0.3);
    vec![
        Criterion::Ball { centre: [1.0, 0.0, 0.0], radius: 0.5 },
        Criterion::Near { target: target(threads), within: 0.3 },
        Criterion::NearSize { target: target(threads), size: 0.4, growth: 0.8 },
        Criterion::Where("v:x>4".parse().unwrap()),
        Criterion::Region("right".into()),
        Criterion::Patch { patch: "sphere".into(), within: None },
        Criterion::Patch { patch: "sphere".into(), within: Some(0.6) },
        Criterion::Size(Size::Uniform(1.2)),
        Criterion::Size(Size::Array("h".into())),
        Criterion::Box([[-1.0; 3], [2.0; 3]]),
        Criterion::Gradient { array: "p".into(), above: 1.0 },
        Criterion::Estimate { array: "v".into(), by: Estimator::Jump, amount },
        Criterion::Estimate { array: "p".into(), by: Estimator::Recovery, amount },
        hessian(Aim::Error(0.1)),
        hessian(Aim::RangePart(0.02)),
        hessian(Aim::Tets(20_000)),
        Criterion::Vorticity { array: "v".into(), above: 3.0 },
        Criterion::Q { array: "v".into(), above: 0.5 },
        Criterion::All,
    ]
}

#[test]
fn what_may_be_taken_back_would_not_be_divided_again() {
    let threads = Threads::single();
    let (first, part) = case();
    let mut refinement = Refinement::new(&part.mesh, Options::default(), &threads).unwrap();
    let all: Vec<TetId> = (0..part.mesh.tets.len()).map(TetId::new).collect();
    refinement.refine(&all, &threads).unwrap();
    let mut fine = with_fields(whole(refinement.mesh()));
    fine.label_names = first.label_names.clone();
    let fine_part = TetPart::of(&fine).unwrap();
    let roots: Vec<TetId> = refinement.roots().collect();
    for criterion in &all_criteria(&threads)[..9] {
        let mut is_marked = vec![false; part.mesh.tets.len()];
        criterion.marks(&first, &part, &threads).unwrap().iter().for_each(|t| is_marked[t.index()] = true);
        let wishes = criterion.wishes(&fine, &fine_part, &threads).unwrap();
        let mut is_whole = vec![true; part.mesh.tets.len()];
        for (root, wish) in roots.iter().zip(&wishes) {
            is_whole[root.index()] &= *wish == Wish::Coarser;
        }
        let n = is_whole.iter().filter(|is_whole| **is_whole).count();
        let n_again = is_whole.iter().zip(&is_marked).filter(|(whole, marked)| **whole && **marked).count();
        let n_marked = is_marked.iter().filter(|is_marked| **is_marked).count();
        println!("{n} of {} may be taken back, {n_marked} were marked", is_whole.len());
        assert_eq!(n_again, 0, "{criterion:?}");
        assert!(n > 0, "{criterion:?}");
    }
}

#[test]
fn as_many_tets_come_as_were_expected() {
    let threads = Threads::single();
    let first = TetPart::of(&box_grid([3, 3, 3], [[0.0; 3], [1.0; 3]])).unwrap().mesh;
    for size in [0.3, 0.15] {
        let criterion = Criterion::Size(Size::Uniform(size));
        let mut refinement = Refinement::new(&first, Options::default(), &threads).unwrap();
        let mut expected = None;
        loop {
            let part = TetPart::of(&whole(refinement.mesh())).unwrap();
            let wishes = criterion.wishes(&whole(&part.mesh), &part, &threads).unwrap();
            let n = *expected.get_or_insert(expected_tets(&wishes));
            if marked(&wishes).is_empty() {
                assert_eq!(n, refinement.mesh().tets.len() as f64);
                break;
            }
            refinement.refine(&marked(&wishes), &threads).unwrap();
        }
    }
    let mesh = whole(&first);
    let part = TetPart::of(&mesh).unwrap();
    let wishes = |h: f64| Criterion::Size(Size::Uniform(h)).wishes(&mesh, &part, &threads).unwrap();
    assert!(check_expected(&wishes(1e-2)).is_ok());
    let told = check_expected(&wishes(1e-6)).unwrap_err().to_string();
    assert!(told.contains("e20 tets") && told.contains("times as large"), "{told}");
}

#[test]
fn limits_hold() {
    let threads = Threads::single();
    let (mesh, part) = case();
    let wishes = Criterion::Size(Size::Uniform(0.1)).wishes(&mesh, &part, &threads).unwrap();
    let limited = |limits: Limits, generations: &[u8]| {
        let mut limited = wishes.clone();
        limits.apply(&part.mesh, generations, &mut limited);
        limited
    };
    assert_eq!(limited(Limits::default(), &[]), wishes);
    let generations: Vec<u8> = (0..part.mesh.tets.len()).map(|t| (t % 4) as u8).collect();
    let by_generation = limited(Limits { generation: Some(2), ..Limits::default() }, &generations);
    assert_eq!(marked(&by_generation), those(&part, |t| t % 4 < 2 && wishes[t].is_divided()));
    assert!(by_generation.iter().all(|wish| *wish <= Wish::Divided(2)));
    let by_size = limited(Limits { smallest: Some(0.6), ..Limits::default() }, &[]);
    assert_eq!(marked(&by_size), those(&part, |t| longest(corners(&part.mesh, t)) >= 1.2));
    let n = part.mesh.tets.len();
    let by_count = limited(Limits { n_tets: Some(n + 77), ..Limits::default() }, &[]);
    assert_eq!(marked(&by_count).len(), 11);
    let least = marked(&by_count).iter().map(|t| longest(corners(&part.mesh, t.index()))).fold(9.0, f64::min);
    let longer = those(&part, |t| longest(corners(&part.mesh, t)) > least);
    assert!(longer.iter().all(|t| marked(&by_count).contains(t)));
    assert!(marked(&limited(Limits { n_tets: Some(3), ..Limits::default() }, &[])).is_empty());
}

#[test]
fn what_is_not_there_is_told_with_what_is() {
    let threads = Threads::single();
    let (mesh, part) = case();
    let refused = |criterion: Criterion| criterion.wishes(&mesh, &part, &threads).unwrap_err();
    let array = |text: &str| Criterion::Where(text.parse().unwrap());
    let jump = |array: &str, amount| Criterion::Estimate { array: array.into(), by: Estimator::Jump, amount };
    let hessian = |arrays: &[&str], aim| {
        let arrays = arrays.iter().map(|a| (*a).to_owned()).collect();
        Criterion::Hessian(HessianSizes { arrays, aim, limits: sizes::SizeLimits::default() })
    };
    let share = Amount::Share(0.5);
    for (criterion, parts) in [
        (array("q>1"), ["no array `q`", "point arrays: v, p, h; cell arrays: region, patch, x"]),
        (array("v[3]>1"), ["3 component(s)", "`v[3]`"]),
        (array("v:w>1"), ["no array `v:w`", "point arrays"]),
        (Criterion::Region("left".into()), ["no region `left`", "it has 3, right"]),
        (Criterion::Patch { patch: "wall".into(), within: None }, ["no patch `wall`", "it has sphere, 2"]),
        (jump("x", share), ["`x` has values on cells", "point arrays: v, p, h"]),
        (jump("p", Amount::Share(1.5)), ["share of the error is 1.5", "at most 1"]),
        (jump("p", Amount::Share(f64::NAN)), ["NaN", "at most 1"]),
        (Criterion::Vorticity { array: "p".into(), above: 1.0 }, ["array p", "1 component(s), but a vector"]),
        (Criterion::Q { array: "v".into(), above: f64::INFINITY }, ["Q is inf", "a finite number"]),
        (Criterion::Q { array: "v:x".into(), above: 1.0 }, ["no velocity", "three components"]),
        (Criterion::Gradient { array: "p".into(), above: f64::NAN }, ["NaN", "a finite number"]),
        (Criterion::Size(Size::Uniform(0.0)), ["the size is 0", "above 0"]),
        (Criterion::Size(Size::Array("p".into())), ["array p, point", "is no length of an edge"]),
        (Criterion::Size(Size::Array("x".into())), ["array x, cell", "is no length of an edge"]),
        (Criterion::Ball { centre: [0.0; 3], radius: -1.0 }, ["radius of a ball is -1", "0 or more"]),
        (Criterion::Box([[0.0; 3], [1.0, -1.0, 1.0]]), ["from 0 to -1 along y is empty", "lowest corner"]),
        (Criterion::Near { target: target(&threads), within: f64::NAN }, ["NaN", "0 or more"]),
        (hessian(&["p"], Aim::Error(-1.0)), ["the error is -1", "above 0"]),
        (hessian(&["p", "nothing"], Aim::RangePart(0.1)), ["no array `nothing`", "point arrays"]),
        (hessian(&[], Aim::Error(1.0)), ["need an array", "second derivatives"]),
    ] {
        // Numbers are words of the call; what is in the mesh is not.
        let kind = if criterion.check().is_err() { ErrorKind::Options } else { ErrorKind::Input };
        let error = refused(criterion);
        let told = error.to_string();
        assert!(parts.iter().all(|part| told.contains(part)), "{told}");
        assert_eq!(error.kind(), kind, "{told}");
    }
    let bare = Mesh::new(mesh.points.clone(), mesh.cells.clone());
    let told = Criterion::Region("1".into()).wishes(&bare, &part, &threads).unwrap_err().to_string();
    assert!(told.contains("it has no regions"), "{told}");
    let told = Target::new(vec![[0.0; 3]], Vec::new(), &threads).unwrap_err().to_string();
    assert!(told.contains("no surface"), "{told}");
    assert!(Target::new(vec![[f64::NAN; 3]; 3], vec![[0, 1, 2].map(VertexId)], &threads).is_err());
    let around = Target::of_mesh(&ball(2, 1), &threads).unwrap();
    assert!(around.is_within(0.1, [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 1.0]]));
    assert!(tet::volume([[0.0; 3]; 4]) == 0.0);
}

/// Values that are no numbers mark nothing and stop nothing.
#[test]
fn values_that_are_no_numbers_are_passed_over() {
    let threads = Threads::single();
    let (mut mesh, part) = case();
    let mut numbers = Numbers(1);
    let holes: Vec<f64> = (0..mesh.points.len())
        .map(|i| if numbers.unit() < 0.05 { f64::NAN } else { pressure(&mesh.points[i]) })
        .collect();
    mesh.set_point_field(Field::scalars("p", holes.clone()));
    let is_sound = |t: &TetId| part.mesh.tets[t.index()].iter().all(|v| !holes[v.index()].is_nan());
    for aim in [Aim::Error(0.05), Aim::Tets(20_000)] {
        let limits = sizes::SizeLimits { growth: f64::INFINITY, ..Default::default() };
        let criterion = Criterion::Hessian(HessianSizes { arrays: vec!["p".into()], aim, limits });
        assert!(!criterion.marks(&mesh, &part, &threads).unwrap().is_empty());
    }
    for by in [Estimator::Jump, Estimator::Recovery] {
        let criterion = Criterion::Estimate { array: "p".into(), by, amount: Amount::Share(0.5) };
        let marks = criterion.marks(&mesh, &part, &threads).unwrap();
        assert!(!marks.is_empty() && marks.iter().all(is_sound));
    }
}
