//! Criteria for refinement of whole meshes: each compared with its definition; what may be coarsened, and
//! what is refused.

use crate::common::Numbers;
use crate::common::criteria::{
    case, corners, from_triangles, longest, pressure, speed, target, target_triangles, tets_where,
};
use motet::ErrorKind;
use motet::base::{Point, TetId, Threads, VertexId};
use motet::geometry::tet::{self, EDGES};
use motet::geometry::vector::{distance, dot, norm};
use motet::mesh::shapes::ball;
use motet::mesh::{Field, Mesh, Surface, TetMesh};
use motet::refine::{
    Aim, Amount, Condition, Criterion, Estimator, HessianSizes, Size, Target, estimate, mark, sizes,
};

#[test]
fn near_means_that_some_place_of_the_tet_is() {
    let threads = Threads::single();
    let (mesh, part) = case();
    let target = target(&threads);
    let triangles = target_triangles(&target);
    for within in [0.0, 0.05, 0.4, 1.7] {
        let criterion = Criterion::Near { target: target.clone(), within };
        let marks = criterion.marks(&mesh, &part, &threads).unwrap();
        let expected = tets_where(&part, |t| from_triangles(corners(&part.mesh, t), &triangles) <= within);
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
    let all = tets_where(&part, |_| true);
    assert_eq!(marks(Criterion::All), all);
    let (centre, radius) = ([1.0, 0.5, 0.0], 1.3);
    assert_eq!(
        marks(Criterion::Ball { centre, radius }),
        mark::in_ball(&part.mesh, centre, radius, &threads)
    );
    let corners_of_box = [[-1.0, -2.0, -5.0], [3.0, 2.0, 0.0]];
    assert_eq!(marks(Criterion::Box(corners_of_box)), mark::in_box(&part.mesh, corners_of_box, &threads));
    for (word, id) in [("right", 7), ("7", 7), ("3", 3)] {
        let expected = tets_where(&part, |t| part.mesh.regions[t] == id);
        assert!(!expected.is_empty() && expected.len() < all.len());
        assert_eq!(marks(Criterion::Region(word.into())), expected);
    }
    // The sphere has radius 1 and the box is far away.
    let is_on = |v: VertexId| norm(part.mesh.points[v.index()]) < 1.0 + 1e-9;
    let expected = tets_where(&part, |t| part.mesh.tets[t].into_iter().any(is_on));
    assert!(!expected.is_empty() && expected.len() < all.len());
    assert_eq!(marks(Criterion::Patch { patch: "sphere".into(), within: None }), expected);
    assert_eq!(marks(Criterion::Patch { patch: "1".into(), within: Some(0.0) }), expected);
    let surface = Surface::of(&mesh);
    let sphere: Vec<[Point; 3]> = (0..surface.triangles.len())
        .filter(|&t| surface.patches[t] == 1)
        .map(|t| surface.corners(t))
        .collect();
    let expected = tets_where(&part, |t| from_triangles(corners(&part.mesh, t), &sphere) <= 1.1);
    assert_eq!(marks(Criterion::Patch { patch: "sphere".into(), within: Some(1.1) }), expected);
}

#[test]
fn sizes_mark_edges_that_are_longer() {
    let threads = Threads::single();
    let (mesh, part) = case();
    let marks = |criterion: Criterion| criterion.marks(&mesh, &part, &threads).unwrap();
    let expected = tets_where(&part, |t| longest(corners(&part.mesh, t)) > 1.5);
    assert!(!expected.is_empty() && expected.len() < part.mesh.tets.len());
    assert_eq!(marks(Criterion::Size(Size::Uniform(1.5))), expected);
    let h = mesh.point_field("h").unwrap().values.to_f64().unwrap();
    let is_long = |t: usize| {
        EDGES.into_iter().any(|[i, j]| {
            let [a, b] = [i, j].map(|i| part.mesh.tets[t][i].index());
            distance(mesh.points[a], mesh.points[b]) > 0.5 * (h[a] + h[b])
        })
    };
    assert_eq!(marks(Criterion::Size(Size::Array("h".into()))), tets_where(&part, is_long));
    let mut positive = mesh.clone();
    let x = mesh.cell_field("x").unwrap().values.to_f64().unwrap();
    let on_cells: Vec<f64> = x.iter().map(|x| 1.0 + 0.1 * x.abs()).collect();
    positive.set_cell_field(Field::scalars("size", on_cells.clone()));
    let expected =
        tets_where(&part, |t| longest(corners(&part.mesh, t)) > on_cells[part.tet_to_cell[t].index()]);
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
        |holds: &dyn Fn(Point) -> bool| tets_where(&part, |t| corners(&part.mesh, t).into_iter().any(holds));
    assert_eq!(marks("p>1"), at_corner(&|p| pressure(&p) > 1.0));
    assert_eq!(marks("|p| <= 0.01"), at_corner(&|p| pressure(&p).abs() <= 0.01));
    assert_eq!(marks("v>=6"), at_corner(&|p| norm(speed(&p)) >= 6.0));
    assert_eq!(marks("|v|<1"), at_corner(&|p| norm(speed(&p)) < 1.0));
    for text in ["v:y<-0.5", "v[1]<-0.5"] {
        assert_eq!(marks(text), at_corner(&|p| speed(&p)[1] < -0.5));
    }
    let x = mesh.cell_field("x").unwrap().values.to_f64().unwrap();
    assert_eq!(marks("x>2.5"), tets_where(&part, |t| x[part.tet_to_cell[t].index()] > 2.5));
    assert_eq!(marks("region==7"), tets_where(&part, |t| part.mesh.regions[t] == 7));
    assert_eq!(marks("region!=7"), tets_where(&part, |t| part.mesh.regions[t] == 3));
    // If an array has exactly that name, no component is meant.
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
    let expected = tets_where(&part, |t| norm(gradients[t]) * longest(corners(&part.mesh, t)) > 2.0);
    assert!(!expected.is_empty() && expected.len() < part.mesh.tets.len());
    assert_eq!(marks(Criterion::Gradient { array: "p".into(), above: 2.0 }), expected);
    let tensors = estimate::velocity_gradients(&part.mesh, &v, &threads);
    let size = |t: usize| tensors[t].iter().map(|row| dot(*row, *row)).sum::<f64>().sqrt();
    let expected = tets_where(&part, |t| size(t) * longest(corners(&part.mesh, t)) > 8.0);
    assert_eq!(marks(Criterion::Gradient { array: "v".into(), above: 8.0 }), expected);
    let curl = estimate::vorticity(&part.mesh, &v, &threads);
    let expected = tets_where(&part, |t| norm(curl[t]) > 3.0);
    assert_eq!(marks(Criterion::Vorticity { array: "v".into(), above: 3.0 }), expected);
    let q = estimate::q_criterion(&part.mesh, &v, &threads);
    assert_eq!(marks(Criterion::Q { array: "v".into(), above: 0.5 }), tets_where(&part, |t| q[t] > 0.5));
    for (by, of) in [
        (Estimator::Jump, estimate::gradient_jump as fn(&TetMesh, &[f64], &Threads) -> Vec<f64>),
        (Estimator::Recovery, estimate::recovery),
    ] {
        let amount = |amount| Criterion::Estimate { array: "p".into(), by, amount };
        let estimates = of(&part.mesh, &p, &threads);
        assert_eq!(marks(amount(Amount::Share(0.4))), mark::largest_share(&estimates, 0.4));
        let n = part.mesh.tets.len() + 700;
        assert_eq!(marks(amount(Amount::Tets(n))), mark::to_count(&estimates, n));
        // For a vector, all components count.
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
fn what_is_not_there_is_reported_with_what_is() {
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
        (jump("x", share), ["`x` is a cell array", "point arrays: v, p, h"]),
        (jump("p", Amount::Share(1.5)), ["fraction of the error is 1.5", "at most 1"]),
        (jump("p", Amount::Share(f64::NAN)), ["NaN", "at most 1"]),
        (Criterion::Vorticity { array: "p".into(), above: 1.0 }, ["array p", "1 component(s), but a vector"]),
        (Criterion::Q { array: "v".into(), above: f64::INFINITY }, ["Q is inf", "a finite number"]),
        (Criterion::Q { array: "v:x".into(), above: 1.0 }, ["is not a velocity", "three components"]),
        (Criterion::Gradient { array: "p".into(), above: f64::NAN }, ["NaN", "a finite number"]),
        (Criterion::Size(Size::Uniform(0.0)), ["the size is 0", "above 0"]),
        (Criterion::Size(Size::Array("p".into())), ["array p, point", "is not a valid edge length"]),
        (Criterion::Size(Size::Array("x".into())), ["array x, cell", "is not a valid edge length"]),
        (Criterion::Ball { centre: [0.0; 3], radius: -1.0 }, ["radius of a ball is -1", "0 or more"]),
        (Criterion::Box([[0.0; 3], [1.0, -1.0, 1.0]]), ["from 0 to -1 along y is empty", "lowest corner"]),
        (Criterion::Near { target: target(&threads), within: f64::NAN }, ["NaN", "0 or more"]),
        (hessian(&["p"], Aim::Error(-1.0)), ["the error is -1", "above 0"]),
        (hessian(&["p", "nothing"], Aim::RangePart(0.1)), ["no array `nothing`", "point arrays"]),
        (hessian(&[], Aim::Error(1.0)), ["need an array", "second derivatives"]),
    ] {
        // Labels and patches are arguments of the call; contents of arrays are not.
        let is_place = matches!(criterion, Criterion::Region(_) | Criterion::Patch { .. });
        let is_word = is_place || criterion.check().is_err();
        let kind = if is_word { ErrorKind::Options } else { ErrorKind::Input };
        let error = refused(criterion);
        let reported = error.to_string();
        assert!(parts.iter().all(|part| reported.contains(part)), "{reported}");
        assert_eq!(error.kind(), kind, "{reported}");
    }
    let bare = Mesh::new(mesh.points.clone(), mesh.cells.clone());
    let reported = Criterion::Region("1".into()).wishes(&bare, &part, &threads).unwrap_err().to_string();
    assert!(reported.contains("it has no regions"), "{reported}");
    let reported = Target::new(vec![[0.0; 3]], Vec::new(), &threads).unwrap_err().to_string();
    assert!(reported.contains("no surface"), "{reported}");
    assert!(Target::new(vec![[f64::NAN; 3]; 3], vec![[0, 1, 2].map(VertexId)], &threads).is_err());
    let around = Target::of_mesh(&ball(2, 1), &threads).unwrap();
    assert!(around.is_within(0.1, [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 1.0]]));
    assert!(tet::volume([[0.0; 3]; 4]) == 0.0);
}

/// Values that are not finite mark nothing and stop nothing.
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
