//! Fields across changes of a mesh: linear fields, integrals and constants are preserved, and what was kept
//! stays to the bit.

use std::collections::BTreeMap;

use crate::common::random::Random;
use motet::base::{CellId, MaybeId, Point, Threads, VertexId};
use motet::delaunay::Triangulation;
use motet::geometry::tet;
use motet::mesh::history::{History, Ledger, Origin, Origins, Rows, Rule, Rules};
use motet::mesh::{CellKind, Cells, Field, Mesh, Values};
use motet::spatial::trace::between;
use proptest::prelude::*;

fn single() -> Threads {
    Threads::single()
}

/// The unit box in two regions, 1 below x = 1/2 and 2 above, each with its own Delaunay triangulation; `n`
/// points in each and on each side; the wall between them has points of both. Triangles on the outside, one
/// patch per side.
fn two_regions(seed: u64, n: usize) -> Mesh {
    let mut random = Random(seed);
    let corners = |x: f64| (0..4).map(move |i| [x, f64::from(i & 1), f64::from(i >> 1)]);
    let mut points: Vec<Point> = corners(0.5).collect();
    points.extend((0..n).map(|_| {
        let [_, y, z] = random.point();
        [0.5, y, z]
    }));
    let n_shared = points.len();
    let mut cells = Cells::new();
    let (mut regions, mut patches, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for (region, end) in [(1, 0.0), (2, 1.0)] {
        let mut ids: Vec<usize> = (0..n_shared).collect();
        ids.extend(points.len()..points.len() + 4 + 6 * n);
        points.extend(corners(end));
        for side in 0..6 * n {
            let [x, y, z] = random.point();
            let x = 0.5 + (end - 0.5) * x;
            points.push(match side % 6 {
                0 => [x, 0.0, z],
                1 => [x, 1.0, z],
                2 => [x, y, 0.0],
                3 => [x, y, 1.0],
                4 => [end, y, z],
                _ => [x, y, z],
            });
        }
        let half: Vec<Point> = ids.iter().map(|&i| points[i]).collect();
        let triangulation = Triangulation::new(&half, &single()).unwrap();
        for tet in triangulation.tets() {
            cells.push(CellKind::TETRA, tet.map(|v| VertexId::new(ids[v.index()])));
            regions.push(region);
        }
        for facet in triangulation.hull() {
            let corners = facet.vertices.map(|v| half[v.index()]);
            let on = |k: usize, x: f64| corners.iter().all(|p| p[k] == x);
            let side = (0..6).find(|&s| on(s / 2, (s % 2) as f64));
            if let Some(side) = side {
                triangles.push(facet.vertices.map(|v| VertexId::new(ids[v.index()])));
                patches.push(side as i32 + 1);
            }
        }
    }
    let n_tets = regions.len();
    triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
    regions.resize(cells.len(), 0);
    let patches: Vec<i32> = vec![0; n_tets].into_iter().chain(patches).collect();
    let mut mesh = Mesh::new(points, cells);
    mesh.set_cell_field(Field::scalars("region", regions));
    mesh.set_cell_field(Field::scalars("patch", patches));
    mesh
}

/// The history between two meshes that have no vertex or cell in common.
fn all_new(old: &Mesh, new: &Mesh) -> History {
    let (vertices, cells) = (vec![MaybeId::NONE; new.points.len()], vec![MaybeId::NONE; new.cells.len()]);
    between(old, new, &vertices, &cells, &single()).unwrap()
}

/// The integral over each region, and that of the absolute values.
fn integrals(mesh: &Mesh, field: &Field) -> BTreeMap<i32, [f64; 2]> {
    let regions = mesh.regions().unwrap();
    let mut integrals = BTreeMap::new();
    for (cell, tet) in mesh.cells.tets() {
        let volume = tet::volume(tet.map(|v| mesh.points[v.index()])).abs();
        let value = field.values.get_f64(cell.index()).unwrap();
        let entry: &mut [f64; 2] = integrals.entry(regions.ids[cell.index()]).or_default();
        entry[0] += volume * value;
        entry[1] += volume * value.abs();
    }
    integrals
}

fn floats(field: &Field) -> &[f64] {
    match &field.values {
        Values::F64(values) => values,
        _ => panic!("double precision"),
    }
}

fn linear(p: Point) -> f64 {
    3.0 - 2.0 * p[0] + 0.5 * p[1] + 7.0 * p[2]
}

fn linear_field(points: &[Point]) -> Field {
    Field::scalars("linear", points.iter().map(|&p| linear(p)).collect::<Vec<f64>>())
}

#[test]
fn linear_point_fields_stay_linear() {
    let (old, new) = (two_regions(1, 12), two_regions(2, 15));
    let history = all_new(&old, &new);
    let carried = history.transfer_points(&linear_field(&old.points)).unwrap();
    for (value, p) in floats(&carried).iter().zip(&new.points) {
        assert!((value - linear(*p)).abs() < 1e-12, "{value} at {p:?}");
    }
    let place = history.transfer_points(&Field::vectors("place", &old.points)).unwrap();
    for (found, p) in place.to_vectors().unwrap().iter().zip(&new.points) {
        assert!((0..3).all(|k| (found[k] - p[k]).abs() < 1e-13));
    }
    assert_eq!(history.ledger.n_outside, 0);
}

#[test]
fn quadratic_point_fields_stay_quadratic_off_walls_with_another_field_in_each_region() {
    let (old, new) = (two_regions(1, 40), two_regions(2, 50));
    let history = all_new(&old, &new);
    let value = |[x, y, z]: Point| {
        let left = 1.0 + x - y + x * x - 2.0 * y * z + 0.5 * z * x;
        if x < 0.5 { left } else { left + 3.0 * (x - 0.5) * (y + x) }
    };
    let of = |points: &[Point]| Field::scalars("u", points.iter().map(|&p| value(p)).collect::<Vec<f64>>());
    let carried = history.transfer_points(&of(&old.points)).unwrap();
    let linear = history.transfer_points_by(&of(&old.points), Rule::Linear).unwrap().unwrap();
    let (mut n, mut most) = (0, 0.0f64);
    let rows = history.vertices.quadratic();
    for (id, row) in rows.ids().iter().zip(rows.iter()) {
        let exact = value(new.points[id.index()]);
        let negative: f64 = row.shares.iter().filter(|share| **share < 0.0).sum();
        // Rows with larger negative shares are brought closer to linear ones.
        if negative > -0.499 {
            assert!((floats(&carried)[id.index()] - exact).abs() < 1e-10);
            most = most.max((floats(&linear)[id.index()] - exact).abs());
            n += 1;
        }
    }
    assert!(n > 30 && most > 0.01, "{n} rows, linear off by {most}");
}

#[test]
fn integrals_over_regions_survive_a_hundred_transfers() {
    let (old, new) = (two_regions(3, 10), two_regions(4, 14));
    let (there, back) = (all_new(&old, &new), all_new(&new, &old));
    for history in [&there, &back] {
        assert_eq!(history.ledger.regions.len(), 2);
        for region in &history.ledger.regions {
            assert!((region.volume_before - 0.5).abs() < 1e-14);
            assert!((region.volume_after - 0.5).abs() < 1e-14);
            assert!(region.deviation < 1e-14, "{region:?}");
        }
    }
    let mut random = Random(99);
    let regions = old.regions().unwrap();
    // Values of either sign, very different in the two regions.
    let values: Vec<f64> =
        regions.ids.iter().map(|&r| (random.next() - 0.3) * if r == 1 { 1.0 } else { 1e6 }).collect();
    let first = Field::scalars("heat", values);
    let before = integrals(&old, &first);
    let mut field = first.clone();
    for _ in 0..50 {
        field = there.transfer_cells(&field).unwrap();
        field = back.transfer_cells(&field).unwrap();
    }
    assert!(floats(&field).iter().all(|v| v.is_finite()));
    for (region, after) in integrals(&old, &field) {
        let [integral, absolute] = before[&region];
        assert!((after[0] - integral).abs() < 1e-12 * absolute, "{region}: {integral} {}", after[0]);
    }
    // The field spread out, but did not cross the wall.
    assert!(field.values != first.values);
    for (i, &region) in regions.ids.iter().enumerate().filter(|(_, r)| **r != 0) {
        assert!(floats(&field)[i].abs() <= if region == 1 { 1.0 } else { 1e6 });
    }
}

#[test]
fn constants_stay_to_the_bit_and_values_between_the_old_ones() {
    let (old, new) = (two_regions(5, 8), two_regions(6, 8));
    let history = all_new(&old, &new);
    let of = |n: usize, value: f64| Field::scalars("u", vec![value; n]);
    for value in [0.1, -1e300, 1.0 / 3.0] {
        let points = history.transfer_points(&of(old.points.len(), value)).unwrap();
        let cells = history.transfer_cells(&of(old.cells.len(), value)).unwrap();
        assert!(floats(&points).iter().chain(floats(&cells)).all(|v| v.to_bits() == value.to_bits()));
    }
    let single = Field::scalars("u", vec![0.1f32; old.cells.len()]);
    assert_eq!(history.transfer_cells(&single).unwrap().values, vec![0.1f32; new.cells.len()].into());
    let mut random = Random(7);
    let mixed = Field::scalars("u", (0..old.points.len()).map(|_| random.next()).collect::<Vec<f64>>());
    let (least, largest) = floats(&mixed).iter().fold((1.0f64, 0.0f64), |(l, h), &v| (l.min(v), h.max(v)));
    let carried = history.transfer_points(&mixed).unwrap();
    assert!(floats(&carried).iter().all(|v| (least..=largest).contains(v)));
}

#[test]
fn ids_names_and_directions_are_taken_over_whole() {
    let (old, new) = (two_regions(8, 8), two_regions(9, 8));
    let history = all_new(&old, &new);
    let ids = Field::scalars("id", (0..old.points.len() as u64).map(|i| (1 << 60) + i).collect::<Vec<u64>>());
    let Values::U64(carried) = history.transfer_points(&ids).unwrap().values else { panic!("its type") };
    assert!(carried.iter().all(|i| *i >= 1 << 60 && *i < (1 << 60) + old.points.len() as u64));
    let names = Field::scalars("name", (0..old.cells.len()).map(|i| format!("cell {i}")).collect::<Vec<_>>());
    let Values::Text(carried) = history.transfer_cells(&names).unwrap().values else { panic!("its type") };
    assert!(carried.iter().all(|name| name.starts_with("cell ")));
    let mut random = Random(1);
    let fibres: Vec<Point> = (0..old.cells.len())
        .map(|_| {
            let angle = 7.0 * random.next();
            [angle.cos(), angle.sin(), 0.0]
        })
        .collect();
    let carried = history.transfer_cells(&Field::vectors("fibres", &fibres)).unwrap();
    assert!(carried.to_vectors().unwrap().iter().all(|f| fibres.contains(f)));
    // Labels are consistent: the region of a tet, and the patch of a triangle, are those of the new mesh.
    for label in ["region", "patch"] {
        let carried = history.transfer_cells(old.cell_field(label).unwrap()).unwrap();
        assert_eq!(&carried, new.cell_field(label).unwrap());
    }
}

/// A triangulation as a mesh with one region, and the cell of each tet by its vertices.
fn triangulated(points: &[Point]) -> (Mesh, BTreeMap<[VertexId; 4], CellId>) {
    let triangulation = Triangulation::new(points, &single()).unwrap();
    let cells = Cells::uniform(CellKind::TETRA, triangulation.tets().as_flattened().to_vec()).unwrap();
    let places = triangulation.tets().iter().enumerate().map(|(i, t)| (sorted(*t), CellId::new(i)));
    (Mesh::new(points.to_vec(), cells), places.collect())
}

fn sorted(mut tet: [VertexId; 4]) -> [VertexId; 4] {
    tet.sort_unstable();
    tet
}

/// The history when points are added to a triangulation, or some of its points are moved; tets with the same
/// vertices are the same.
fn local(old_points: &[Point], new_points: &[Point], threads: &Threads) -> (Mesh, Mesh, History) {
    let (old, places) = triangulated(old_points);
    let (new, _) = triangulated(new_points);
    let vertices: Vec<MaybeId<VertexId>> =
        (0..new.points.len()).map(|i| (i < old.points.len()).then(|| VertexId::new(i)).into()).collect();
    let cells: Vec<MaybeId<CellId>> =
        new.cells.tets().map(|(_, tet)| places.get(&sorted(tet)).copied().into()).collect();
    let history = between(&old, &new, &vertices, &cells, threads).unwrap();
    (old, new, history)
}

fn box_corners() -> Vec<Point> {
    (0..8).map(|i| [f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)]).collect()
}

fn cloud(seed: u64, n: usize) -> Vec<Point> {
    let mut random = Random(seed);
    box_corners().into_iter().chain((0..n).map(|_| random.point())).collect()
}

#[test]
fn what_was_kept_keeps_its_values_to_the_bit() {
    let points = cloud(11, 300);
    let mut more = points.clone();
    more.extend([[0.3, 0.4, 0.5], [0.31, 0.4, 0.5]]);
    let (old, new, history) = local(&points, &more, &single());
    let mut random = Random(3);
    let odd: Vec<f64> = (0..old.cells.len())
        .map(|i| match i % 50 {
            0 => f64::NAN,
            1 => -0.0,
            2 => f64::INFINITY,
            _ => random.next(),
        })
        .collect();
    let carried = history.transfer_cells(&Field::scalars("odd", odd.clone())).unwrap();
    let mut n_kept = 0;
    for (value, origin) in floats(&carried).iter().zip(history.cells.iter()) {
        if let Origin::Kept(cell) = origin {
            assert_eq!(value.to_bits(), odd[cell.index()].to_bits());
            n_kept += 1;
        }
    }
    assert!(n_kept > 9 * new.cells.len() / 10);
    assert_eq!(n_kept + history.cells.changed().len(), new.cells.len());
    assert_eq!(history.vertices.changed().ids(), [VertexId(308), VertexId(309)]);
}

#[test]
fn a_moved_vertex_is_interpolated_at_its_new_place_and_keeps_its_names() {
    let points = cloud(21, 100);
    let mut moved = points.clone();
    moved[50] = [0.5, 0.5, 0.5];
    let (old, new, history) = local(&points, &moved, &single());
    assert_eq!(history.vertices.changed().ids(), [VertexId(50)]);
    let carried = history.transfer_points(&linear_field(&old.points)).unwrap();
    assert!((floats(&carried)[50] - linear(new.points[50])).abs() < 1e-13);
    let ids = Field::scalars("id", (0..old.points.len() as i32).collect::<Vec<i32>>());
    assert_eq!(history.transfer_points(&ids).unwrap(), ids);
    // Tets with the same vertices have changed shape nevertheless.
    for (cell, tet) in new.cells.tets().filter(|(_, tet)| tet.contains(&VertexId(50))) {
        assert!(matches!(history.cells.of(cell), Origin::Changed(_)), "{tet:?}");
    }
    assert!(history.ledger.region(0).unwrap().deviation < 1e-14);
}

#[test]
fn any_number_of_threads_gives_the_same_history() {
    let (points, more) = (cloud(31, 400), cloud(32, 500));
    let one = local(&points, &more, &single()).2;
    let three = local(&points, &more, &Threads::new(3).unwrap()).2;
    assert_eq!(one, three);
}

#[test]
fn old_tets_may_be_inverted_or_flat_and_the_ledger_says_so() {
    let points = cloud(41, 60);
    let (mut old, _) = triangulated(&points);
    // One vertex pulled through its star, and another moved onto its neighbour.
    old.points[20] = [1.5, 1.4, 0.3];
    old.points[21] = old.points[22];
    let (new, _) = triangulated(&points);
    let history = all_new(&old, &new);
    let region = history.ledger.regions[0];
    assert!(region.volume_before > 1.01 * region.volume_after && region.deviation > 0.01, "{region:?}");
    let cells = history.transfer_cells(&Field::scalars("u", vec![2.5; old.cells.len()])).unwrap();
    assert!(floats(&cells).iter().all(|&u| u == 2.5));
    let points = history.transfer_points(&linear_field(&old.points)).unwrap();
    assert!(floats(&points).iter().all(|u| u.is_finite()));
}

#[test]
fn what_lies_outside_takes_the_nearest_values() {
    let (old, _) = triangulated(&cloud(51, 40));
    // A box with a bump on one side: the surface has moved.
    let mut points = cloud(52, 40);
    points.push([0.5, 0.5, 1.125]);
    let (new, _) = triangulated(&points);
    let history = all_new(&old, &new);
    assert_eq!(history.ledger.n_outside, 1);
    assert!((history.ledger.farthest_outside - 0.125).abs() < 1e-15);
    let region = history.ledger.regions[0];
    assert!((region.volume_before - 1.0).abs() < 1e-14);
    assert!(
        region.volume_after > 1.0 && region.deviation >= region.volume_after - region.volume_before - 1e-14
    );
    let carried = history.transfer_points(&linear_field(&old.points)).unwrap();
    assert!((floats(&carried).last().unwrap() - linear([0.5, 0.5, 1.0])).abs() < 1e-13);
}

#[test]
fn two_histories_in_one_do_what_both_do() {
    let meshes = [two_regions(61, 6), two_regions(62, 7), two_regions(63, 5)];
    let (first, second) = (all_new(&meshes[0], &meshes[1]), all_new(&meshes[1], &meshes[2]));
    let both = first.then(&second);
    let mut random = Random(5);
    let mut random = |n: usize| Field::scalars("u", (0..n).map(|_| random.next()).collect::<Vec<f64>>());
    let on_points = random(meshes[0].points.len());
    let stepwise = second.transfer_points(&first.transfer_points(&on_points).unwrap()).unwrap();
    let at_once = both.transfer_points(&on_points).unwrap();
    assert!(floats(&stepwise).iter().zip(floats(&at_once)).all(|(a, b)| (a - b).abs() < 1e-13));
    let on_cells = random(meshes[0].cells.len());
    let stepwise = second.transfer_cells(&first.transfer_cells(&on_cells).unwrap()).unwrap();
    let at_once = both.transfer_cells(&on_cells).unwrap();
    assert!(floats(&stepwise).iter().zip(floats(&at_once)).all(|(a, b)| (a - b).abs() < 1e-13));
    let ids = Field::scalars("id", (0..meshes[0].cells.len() as i64).collect::<Vec<i64>>());
    let stepwise = second.transfer_cells(&first.transfer_cells(&ids).unwrap()).unwrap();
    assert_eq!(stepwise, both.transfer_cells(&ids).unwrap());
    // Composition with an identity before or after changes nothing.
    let nothing = History::identity(first.vertices.n_old(), first.cells.n_old());
    assert_eq!(nothing.then(&first).vertices.kept(), first.vertices.kept());
    assert_eq!(nothing.then(&first).cells.changed().ids(), first.cells.changed().ids());
    assert_eq!(nothing.then(&nothing), nothing);
}

#[test]
fn all_arrays_of_a_mesh_are_carried_by_their_rules() {
    let (mut old, mut new) = (two_regions(71, 6), two_regions(72, 6));
    let history = all_new(&old, &new);
    old.label_names.regions.insert(1, "fluid".into());
    old.set_point_field(Field::vectors("velocity", &old.points.clone()));
    old.set_point_field(Field::vectors("velocity_old", &old.points.clone()));
    old.set_point_field(Field::scalars("scratch", vec![0u8; old.points.len()]));
    old.set_cell_field(Field::scalars("density", vec![1.5; old.cells.len()]));
    old.field_data.push(Field::scalars("time", vec![0.25]));
    let rules = Rules {
        points: BTreeMap::from([("scratch".into(), Rule::Drop), ("velocity_old".into(), Rule::Inherit)]),
        cells: BTreeMap::new(),
    };
    let theirs = new.cell_data.clone();
    history.transfer(&old, &mut new, &rules).unwrap();
    new.validate().unwrap();
    assert_eq!(new.cell_data[..2], theirs);
    assert_eq!(new.label_names, old.label_names);
    assert_eq!(new.field_data, old.field_data);
    assert!(new.point_field("scratch").is_none());
    assert_eq!(new.cell_field("density").unwrap().values, vec![1.5; new.cells.len()].into());
    let inherited = new.point_field("velocity_old").unwrap().to_vectors().unwrap();
    assert!(inherited.iter().all(|p| old.points.contains(p)));
    assert!(new.point_field("velocity").is_some());

    let unknown = Rules { cells: BTreeMap::from([("presure".into(), Rule::Drop)]), ..Rules::default() };
    let error = history.transfer(&old, &mut new, &unknown).unwrap_err().to_string();
    assert!(
        error.starts_with("cell array presure: a rule names this array, but the mesh has only region, patch"),
        "{error}"
    );
}

#[test]
fn rows_for_quadratic_fields_have_to_fit() {
    let mut half = Rows::new();
    half.push(VertexId(1), &[(VertexId(0), 0.5), (VertexId(1), 0.5)], VertexId(0));
    let origins = Origins::new(3, vec![VertexId(2).into(), MaybeId::NONE], half).unwrap();
    let with = |id: u32, parts: &[(u32, f64)]| {
        let mut rows = Rows::new();
        let parts: Vec<_> = parts.iter().map(|&(old, share)| (VertexId(old), share)).collect();
        rows.push_signed(VertexId(id), &parts, VertexId(0));
        origins.clone().with_quadratic(rows)
    };
    let fits = with(1, &[(0, 0.75), (1, 0.5), (2, -0.25)]).unwrap();
    let history = History { vertices: fits, cells: Origins::identity(0), ledger: Ledger::default() };
    let field = |values: [f64; 3]| Field::scalars("u", values.to_vec());
    assert_eq!(history.transfer_points(&field([4.0, 8.0, 4.0])).unwrap().values, vec![4.0, 6.0].into());
    assert_eq!(history.transfer_points(&field([4.0, 8.0, 0.0])).unwrap().values, vec![0.0, 7.0].into());
    // The result stays within the values around, and is the value of the first row where those are equal, or
    // another one is not finite.
    assert_eq!(history.transfer_points(&field([4.0, 8.0, -1e6])).unwrap().values, vec![-1e6, 8.0].into());
    assert_eq!(history.transfer_points(&field([0.0, 0.0, 4.0])).unwrap().values, vec![4.0, 0.0].into());
    let carried = history.transfer_points(&field([4.0, 8.0, f64::NAN])).unwrap();
    assert_eq!(floats(&carried)[1], 6.0);
    let stored = serde_json::to_string(&history).unwrap();
    assert_eq!(serde_json::from_str::<History>(&stored).unwrap(), history);
    let beyond = stored.replace("[0,1,2]", "[0,1,9]");
    assert!(beyond != stored && serde_json::from_str::<History>(&beyond).is_err());
    assert!(with(0, &[(0, 1.0)]).unwrap_err().to_string().contains("has not changed"));
    assert!(with(1, &[(3, 1.0)]).unwrap_err().to_string().contains("old id 3"));
    assert!(with(1, &[(0, 0.5), (1, f64::NAN)]).is_err());
    let twice = history.then(&History {
        vertices: Origins::new(2, vec![VertexId(1).into()], Rows::new()).unwrap(),
        cells: Origins::identity(0),
        ledger: Ledger::default(),
    });
    assert_eq!(twice.transfer_points(&field([4.0, 8.0, 4.0])).unwrap().values, vec![6.0].into());
}

#[test]
fn what_does_not_fit_is_refused_with_its_name_and_counts() {
    let history = History::identity(3, 2);
    let error = history.transfer_points(&Field::scalars("p", vec![1.0; 4])).unwrap_err().to_string();
    assert!(
        error.starts_with("point array p: has 4 values, but 3 points of 1 component(s) need 3"),
        "{error}"
    );
    let error = history.transfer_cells(&Field::vectors("v", &[[0.0; 3]; 3])).unwrap_err().to_string();
    assert!(error.starts_with("cell array v: has 9 values, but 2 cells of 3 component(s) need 6"), "{error}");
    let ids = Field::scalars("id", vec![1, 2, 3]);
    for (rule, text) in [
        (Rule::Conserve, "point array id: cannot be transferred by the rule Conserve"),
        (
            Rule::Interpolate,
            "point array id: cannot be transferred by the rule Interpolate, since whole numbers and texts have no mean",
        ),
    ] {
        let error = history.transfer_points_by(&ids, rule).unwrap_err().to_string();
        assert!(error.starts_with(text), "{error}");
    }
    assert_eq!(history.transfer_points_by(&ids, Rule::Drop).unwrap(), None);
    let error = history.transfer(&Mesh::default(), &mut Mesh::default(), &Rules::default()).unwrap_err();
    assert!(error.to_string().starts_with("old mesh: has 0 points, but the history is of a mesh with 3"));

    // Regions do not mix, so a new region has no source.
    let (old, mut new) = (two_regions(81, 4), two_regions(82, 4));
    let ids = new.regions().unwrap().ids.iter().map(|&r| if r == 2 { 3 } else { r }).collect::<Vec<i32>>();
    new.set_cell_field(Field::scalars("region", ids));
    let none = (vec![MaybeId::NONE; new.points.len()], vec![MaybeId::NONE; new.cells.len()]);
    let error = between(&old, &new, &none.0, &none.1, &single()).unwrap_err().to_string();
    assert!(error.contains("is new in region 3, but no tet of that region was removed"), "{error}");
    let error = between(&old, &new, &none.0[1..], &none.1, &single()).unwrap_err().to_string();
    assert!(error.contains("old ids were given, but the new mesh has"), "{error}");
}

#[test]
fn origins_that_do_not_fit_are_refused() {
    let row = |from: &[(VertexId, f64)]| {
        let mut rows = Rows::new();
        rows.push(VertexId(1), from, VertexId(0));
        rows
    };
    let kept = vec![VertexId(0).into(), MaybeId::NONE];
    let fine = row(&[(VertexId(0), 1.0), (VertexId(1), 3.0)]);
    let origins = Origins::new(2, kept.clone(), fine.clone()).unwrap();
    let Origin::Changed(found) = origins.of(VertexId(1)) else { panic!("it changed") };
    assert_eq!((found.from, found.shares), ([VertexId(0), VertexId(1)].as_slice(), [0.25, 0.75].as_slice()));
    assert_eq!(origins.of(VertexId(0)), Origin::Kept(VertexId(0)));
    let beyond = Origins::new(1, kept.clone(), fine.clone()).unwrap_err().to_string();
    assert_eq!(beyond, "row of 1: refers to the old id 1, but there were only 1");
    assert!(Origins::new(2, vec![VertexId(2).into(), MaybeId::NONE], fine.clone()).is_err());
    assert!(Origins::new(2, vec![VertexId(0).into(), VertexId(1).into()], fine).is_err());
    assert!(Origins::new(2, vec![MaybeId::NONE, VertexId(1).into()], row(&[])).is_err());
    // Without a positive share, the main vertex gives everything.
    for empty in [vec![], vec![(VertexId(1), 0.0)], vec![(VertexId(1), f64::NAN)]] {
        let origins = Origins::new(2, kept.clone(), row(&empty)).unwrap();
        assert_eq!(origins.of(VertexId(1)).parts(), ([VertexId(0)].as_slice(), [1.0].as_slice()));
    }
}

#[test]
fn a_history_can_be_stored() {
    let mut rows = Rows::new();
    rows.push(VertexId(1), &[(VertexId(0), 0.25), (VertexId(2), 0.75)], VertexId(2));
    let history = History {
        vertices: Origins::new(3, vec![VertexId(2).into(), MaybeId::NONE], rows).unwrap(),
        cells: Origins::identity(2),
        ledger: Ledger::default(),
    };
    let text = serde_json::to_string(&history).unwrap();
    assert_eq!(serde_json::from_str::<History>(&text).unwrap(), history);
    for (good, bad) in
        [("[0.25,0.75]", "[0.25,0.5]"), ("[0.25,0.75]", "[0.25]"), ("\"n_old\":3", "\"n_old\":2")]
    {
        assert!(text.contains(good));
        assert!(serde_json::from_str::<History>(&text.replace(good, bad)).is_err(), "{bad}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn any_local_change_conserves_and_keeps_what_is_linear(
        seed in 1u64..1000,
        n in 20usize..120,
        new in prop::collection::vec(prop::array::uniform3(0.0..=1.0f64), 0..8),
        moved in prop::collection::vec((any::<prop::sample::Index>(), prop::array::uniform3(0.01..0.99f64)), 0..4),
        on_grid in any::<bool>(),
    ) {
        let round = |p: Point| if on_grid { p.map(|x| (x * 4.0).round() / 4.0) } else { p };
        // Many slivers where points lie on a grid.
        let mut old: Vec<Point> = cloud(seed, n).into_iter().map(round).collect();
        old.sort_by(|a, b| a.partial_cmp(b).unwrap());
        old.dedup();
        let mut points = old.clone();
        for (which, place) in moved {
            let i = which.index(points.len());
            if old[i].iter().all(|x| (0.01..0.99).contains(x)) {
                points[i] = place;
            }
        }
        points.extend(new.into_iter().map(round).filter(|p| !old.contains(p)));
        let (old, new, history) = local(&old, &points, &single());
        prop_assert_eq!(history.ledger.n_outside, 0);
        let deviation = history.ledger.regions.iter().map(|r| r.deviation).sum::<f64>();
        prop_assert!(deviation < 1e-13, "{}", deviation);
        let carried = history.transfer_points(&linear_field(&old.points)).unwrap();
        for (value, p) in floats(&carried).iter().zip(&new.points) {
            prop_assert!((value - linear(*p)).abs() < 1e-12);
        }
        let mut random = Random(seed);
        let heat = Field::scalars("heat", (0..old.cells.len()).map(|_| random.next()).collect::<Vec<f64>>());
        let volume = |mesh: &Mesh, field: &Field| -> f64 {
            let volumes = mesh.tet_field("v", |t| tet::volume(t).abs());
            floats(&volumes).iter().zip(floats(field)).map(|(v, u)| v * u).sum()
        };
        let carried = history.transfer_cells(&heat).unwrap();
        let (before, after) = (volume(&old, &heat), volume(&new, &carried));
        prop_assert!((before - after).abs() < 1e-13, "{} {}", before, after);
    }
}
