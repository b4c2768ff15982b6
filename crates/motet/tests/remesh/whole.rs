//! Remeshing of whole meshes: unaffected parts stay to the bit, labels and arrays are carried along.

use std::collections::BTreeMap;

use crate::common::random::Random;
use motet::Mesh;
use motet::base::{CellId, Csr, Point, Threads, VertexId};
use motet::geometry::quality::eas;
use motet::geometry::tet;
use motet::geometry::triangle::{area, area_vector};
use motet::geometry::vector::dot;
use motet::mesh::check::{check, is_conforming};
use motet::mesh::history::{Changed, On, Origin, Rule, Rules, field_ledger};
use motet::mesh::shapes::box_grid;
use motet::mesh::{Boundary, CellKind, Cells, Field, Qualities, Values};
use motet::remesh::{
    Goal, Improve, Options, Report, SurfaceRule, has_only_labels, remesh_labelled, remesh_mesh,
};

const N: usize = 6;
const VELOCITY: [[f64; 4]; 3] = [[1.0, 2.0, -3.0, 0.5], [0.1, -0.7, 4.0, -2.0], [3.0, 0.0, 0.2, 1.0]];

fn linear(p: Point) -> Point {
    VELOCITY.map(|[a, b, c, d]| a * p[0] + b * p[1] + c * p[2] + d)
}

fn cell_corners<'a>(mesh: &'a Mesh, vertices: &'a [VertexId]) -> impl Iterator<Item = Point> + 'a {
    vertices.iter().map(|v| mesh.points[v.index()])
}

fn corners(mesh: &Mesh, tet: [VertexId; 4]) -> [Point; 4] {
    tet.map(|v| mesh.points[v.index()])
}

/// The unit cube, regions 5 below x = 1/2 and 9 above; vertices within a region are displaced by up to
/// `shake` cells, and if `on_sides`, those within a side as well, in the side. It has arrays of all sorts.
fn shaken_box(shake: f64, on_sides: bool) -> Mesh {
    let mut mesh = box_grid([N; 3], [[0.0; 3], [1.0; 3]]);
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    for point in &mut mesh.points {
        let is_free = point.map(|x| x > 0.0 && x < 1.0);
        let in_side = is_free.iter().filter(|free| **free).count() == 2;
        let moves = (is_free == [true; 3] || in_side && on_sides) && point[0] != 0.5;
        for (x, free) in point.iter_mut().zip(is_free) {
            let by = shake / N as f64 * random.between(-1.0, 1.0);
            *x += if moves && free { by } else { 0.0 };
        }
    }
    let of_tet = |p: [Point; 4]| if tet::centroid(p)[0] < 0.5 { 5 } else { 9 };
    let mut regions = vec![0i32; mesh.cells.len()];
    mesh.cells.tets().for_each(|(cell, t)| regions[cell.index()] = of_tet(corners(&mesh, t)));
    let n_cells = mesh.cells.len();
    mesh.set_cell_field(Field::scalars("region", regions));
    mesh.label_names.regions = [(5, "fluid".to_owned()), (9, "wall".to_owned())].into();
    let velocity: Vec<Point> = mesh.points.iter().map(|p| linear(*p)).collect();
    mesh.set_point_field(Field::vectors("velocity", &velocity));
    mesh.set_point_field(Field::scalars("constant", vec![0.1f32; mesh.points.len()]));
    mesh.set_point_field(Field::scalars("GlobalNodeID", (1..=mesh.points.len() as i64).collect::<Vec<_>>()));
    mesh.set_cell_field(Field::scalars("constant", vec![0.1; n_cells]));
    mesh.set_cell_field(Field::scalars(
        "pressure",
        (0..n_cells).map(|_| random.between(-1.0, 1.0)).collect::<Vec<_>>(),
    ));
    mesh.set_cell_field(Field::scalars("number", (0..n_cells as u16).collect::<Vec<_>>()));
    mesh.set_cell_field(Field::scalars("GlobalElementID", (1..=n_cells as i32).collect::<Vec<_>>()));
    mesh
}

fn adapt() -> Options {
    Options { surface: SurfaceRule::Adapt { distance: None }, ..Options::default() }
}

fn remeshed(mesh: &Mesh, options: &Options) -> Changed<Report> {
    let outcome = remesh_mesh(mesh, options, &Rules::default(), &Threads::single()).unwrap();
    outcome.mesh.validate().unwrap();
    outcome
}

/// Volume, and integrals of the cell array `name`, by region.
fn integrals(mesh: &Mesh, name: &str) -> BTreeMap<i32, [f64; 2]> {
    let (regions, field) = (mesh.regions().unwrap(), mesh.cell_field(name).unwrap());
    let mut sums: BTreeMap<i32, [f64; 2]> = BTreeMap::new();
    for (cell, vertices) in mesh.cells.tets() {
        let volume = tet::volume(corners(mesh, vertices)).abs();
        let sum = sums.entry(regions.ids[cell.index()]).or_default();
        *sum = [sum[0] + volume, sum[1] + volume * field.values.get_f64(cell.index()).unwrap()];
    }
    sums
}

/// Asserts that every point, cell and row of an array that the history calls kept is unchanged, to the bit,
/// and in order.
fn assert_kept(old: &Mesh, outcome: &Changed<Report>) {
    let Changed { mesh: new, history, .. } = outcome;
    let kept = history.cells.kept().iter().filter_map(|cell| cell.get());
    assert!(kept.is_sorted(), "cells that stayed keep their order");
    let mut kept_points = Vec::new();
    for (new_id, origin) in history.vertices.iter().enumerate() {
        if let Origin::Kept(was) = origin {
            assert_eq!(new.points[new_id].map(f64::to_bits), old.points[was.index()].map(f64::to_bits));
            kept_points.push((new_id, was.index()));
        }
    }
    let mut kept_cells = Vec::new();
    for (new_id, origin) in history.cells.iter().enumerate() {
        let Origin::Kept(was) = origin else { continue };
        let cell = CellId::new(new_id);
        assert_eq!(new.cells.kind(cell), old.cells.kind(was));
        let is_tet = new.cells.kind(cell) == CellKind::TETRA;
        let [is, had] = [(new, cell), (old, was)].map(|(m, c)| cell_corners(m, m.cells.vertices(c)));
        assert!(!is_tet || is.map(|p| p.map(f64::to_bits)).eq(had.map(|p| p.map(f64::to_bits))));
        kept_cells.push((new_id, was.index()));
    }
    let pairs =
        [(&old.point_data, &new.point_data, &kept_points), (&old.cell_data, &new.cell_data, &kept_cells)];
    for (before, after, kept) in pairs {
        assert_eq!(
            before.iter().map(|f| &f.name).collect::<Vec<_>>(),
            after.iter().map(|f| &f.name).collect::<Vec<_>>()
        );
        for (before, after) in before.iter().zip(after) {
            assert_eq!(after.pick(kept.iter().map(|k| k.0)), before.pick(kept.iter().map(|k| k.1)));
        }
    }
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-12
}

#[test]
fn what_stays_stays_and_arrays_keep_what_they_mean() {
    let old = shaken_box(0.35, true);
    let best = Options { goal: Goal::Best, ..adapt() };
    let mut n_changed = 0;
    for options in [Options::default(), adapt(), best] {
        let outcome = remeshed(&old, &options);
        assert_carried(&old, &outcome);
        n_changed += outcome.history.vertices.changed().len();
    }
    assert!(n_changed > 0);
}

fn assert_carried(old: &Mesh, outcome: &Changed<Report>) {
    let Changed { mesh: new, history, report, .. } = outcome;
    assert!(report.before.inverted == 0 && report.after.bad < report.before.bad / 4, "{report:?}");
    assert!(!history.cells.changed().is_empty());
    assert_kept(old, outcome);
    // Linear fields stay linear; constant ones stay constant, to the bit.
    let velocity = new.point_field("velocity").unwrap().to_vectors().unwrap();
    for (value, point) in velocity.iter().zip(&new.points) {
        let expected = linear(*point);
        assert!((0..3).all(|k| close(value[k], expected[k])), "{value:?} {expected:?}");
    }
    assert_eq!(new.point_field("constant").unwrap().values, vec![0.1f32; new.points.len()].into());
    assert_eq!(new.cell_field("constant").unwrap().values, vec![0.1; new.cells.len()].into());
    // Volumes and integrals, region by region.
    let [before, after] = [old, new].map(|m| integrals(m, "pressure"));
    assert!(before.keys().eq([5, 9].iter()) && after.keys().eq(before.keys()));
    for (region, [volume, integral]) in &before {
        assert!(close(*volume, after[region][0]), "region {region}: {volume} {:?}", after[region]);
        assert!(close(*integral, after[region][1]), "region {region}: {integral} {:?}", after[region]);
    }
    assert_eq!(new.label_names, old.label_names);
    // Integers come from some old cell; types are preserved.
    assert!(matches!(new.cell_field("number").unwrap().values, Values::U16(_)));
}

#[test]
fn the_ledger_of_fields_tells_integrals_by_region() {
    let old = shaken_box(0.35, false);
    let rules = Rules { points: [("velocity".to_owned(), Rule::Drop)].into(), ..Rules::default() };
    let outcome = remesh_mesh(&old, &Options::default(), &rules, &Threads::single()).unwrap();
    let fields = field_ledger(&old, &outcome.mesh, &rules, &Threads::single());
    let heads: Vec<_> = fields.iter().map(|f| (f.name.as_str(), f.on, f.rule)).collect();
    assert_eq!(
        heads,
        [
            ("constant", On::Points, Rule::Interpolate),
            ("constant", On::Cells, Rule::Conserve),
            ("pressure", On::Cells, Rule::Conserve)
        ]
    );
    for field in &fields {
        let regions: Vec<i32> = field.regions.iter().map(|r| r.region).collect();
        assert_eq!(regions, [5, 9]);
        assert!(field.deviation() < 1e-13, "{field:?}");
        assert!(field.range_after.unwrap()[1] <= field.range_before.unwrap()[1]);
    }
    let [before, after] = [&old, &outcome.mesh].map(|mesh| integrals(mesh, "pressure"));
    for reported in &fields[2].regions {
        assert!(close(before[&reported.region][1], reported.before[0]), "{reported:?}");
        assert!(close(after[&reported.region][1], reported.after[0]), "{reported:?}");
    }
    // Values that do not come from the old mesh.
    let mut other = outcome.mesh.clone();
    other.set_cell_field(Field::scalars("pressure", vec![0.5; other.cells.len()]));
    assert!(field_ledger(&old, &other, &rules, &Threads::single())[2].deviation() > 0.1);
}

#[test]
fn ids_tell_points_and_tets_apart_also_where_they_are_new() {
    let old = shaken_box(0.45, false);
    let Changed { mesh, .. } = remeshed(&old, &Options { goal: Goal::Best, ..adapt() });
    let all_differ = |mut ids: Vec<i64>| {
        let n = ids.len();
        ids.sort_unstable();
        ids.dedup();
        ids.len() == n
    };
    assert!(all_differ(mesh.point_field("GlobalNodeID").unwrap().values.to_i64().unwrap()));
    let elements = mesh.cell_field("GlobalElementID").unwrap().values.to_i64().unwrap();
    assert!(all_differ(mesh.cells.tets().map(|(cell, _)| elements[cell.index()]).collect()));
}

#[test]
fn the_report_tells_cells_of_the_mesh() {
    let old = shaken_box(0.45, false);
    let Changed { mesh, report, .. } = remeshed(&old, &Options::default());
    for (mesh, worst) in [(&old, report.before.worst.unwrap()), (&mesh, report.after.worst.unwrap())] {
        let vertices = mesh.cells.vertices(worst.tet).try_into().unwrap();
        assert_eq!(eas(corners(mesh, vertices)), worst.eas);
    }
    for left in &report.left {
        let vertices = mesh.cells.vertices(left.tet).try_into().unwrap();
        assert_eq!(eas(corners(&mesh, vertices)), left.eas);
    }
}

#[test]
fn a_surface_that_adapts_keeps_its_patches() {
    let old = shaken_box(0.35, true);
    let outcome = remeshed(&old, &adapt());
    let Changed { mesh: new, history, .. } = &outcome;
    assert_kept(&old, &outcome);
    let is_new = |(cell, kind): (usize, &CellKind)| {
        *kind == CellKind::TRIANGLE && matches!(history.cells.of(CellId::new(cell)), Origin::Changed(_))
    };
    assert!(new.cells.kinds().iter().enumerate().any(is_new), "some triangle is new");
    let by_patch = |mesh: &Mesh| {
        let patches = mesh.patches().unwrap();
        let mut areas: BTreeMap<i32, f64> = BTreeMap::new();
        for (cell, kind, v) in mesh.cells.iter().filter(|c| c.1 == CellKind::TRIANGLE) {
            let triangle = [0, 1, 2].map(|i| mesh.points[v[i].index()]);
            *areas.entry(patches.ids[cell.index()]).or_default() += area(triangle);
            // As for the sides of the box, triangles face away from its centre.
            let outward = triangle[0].map(|x| x - 0.5);
            assert!(dot(area_vector(triangle), outward) > 0.0, "{kind:?} {cell}");
        }
        areas
    };
    let (before, after) = (by_patch(&old), by_patch(new));
    assert!(before.len() == 6 && after.keys().eq(before.keys()));
    for (patch, area) in &before {
        assert!(close(*area, after[patch]), "{patch}: {area} {}", after[patch]);
    }
    // Triangles are still the boundary, each facet once.
    let sorted = |v: &[VertexId]| {
        let mut v = v.to_vec();
        v.sort_unstable();
        v
    };
    let mut triangles: Vec<_> =
        new.cells.iter().filter(|c| c.1 == CellKind::TRIANGLE).map(|c| sorted(c.2)).collect();
    let mut facets: Vec<_> = Boundary::of(&new.cells).facets.iter().map(sorted).collect();
    triangles.sort_unstable();
    facets.sort_unstable();
    assert_eq!(triangles, facets);
}

/// A shaken box with cells of other kinds before, between and after its tets.
fn box_and_others() -> Mesh {
    let plain = shaken_box(0.45, false);
    let mut points = plain.points.clone();
    let beside: Vec<VertexId> = (0..8).map(|i| VertexId::new(points.len() + i)).collect();
    points.extend((0..8).map(|i| [3.0 + f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)]));
    let inside: Vec<VertexId> = plain.cells.tets().step_by(97).flat_map(|(_, t)| t).collect();
    let mut cells = Cells::new();
    cells.push(CellKind::LINE, [inside[0], inside[1]]);
    for (i, (_, kind, vertices)) in plain.cells.iter().enumerate() {
        cells.push(kind, vertices.iter().copied());
        if i % 200 == 100 {
            cells.push(CellKind::VERTEX, [inside[i % inside.len()]]);
            let mut faces = Csr::default();
            faces.push([beside[0], beside[1], beside[2]]);
            faces.push([beside[0], beside[1], beside[4]]);
            faces.push([beside[0], beside[2], beside[4]]);
            faces.push([beside[1], beside[2], beside[4]]);
            cells.push_polyhedron([0, 1, 2, 4].map(|k| beside[k]), faces);
        }
    }
    cells.push(CellKind::HEXAHEDRON, [0, 1, 3, 2, 4, 5, 7, 6].map(|k| beside[k]));
    // A triangle that is not a facet of a tet, and a duplicate.
    cells.push(CellKind::TRIANGLE, [inside[0], inside[9], inside[22]]);
    let again = plain.cells.iter().find(|c| c.1 == CellKind::TRIANGLE).unwrap().2;
    cells.push(CellKind::TRIANGLE, again.iter().copied());
    let n_cells = cells.len();
    let mut mesh = Mesh::new(points, cells);
    mesh.set_cell_field(Field::scalars("number", (0..n_cells as i32).collect::<Vec<_>>()));
    mesh
}

#[test]
fn cells_of_other_kinds_stay_with_their_points() {
    let old = box_and_others();
    for options in [Options::default(), adapt()] {
        let outcome = remeshed(&old, &options);
        let Changed { mesh: new, history, report, .. } = &outcome;
        assert!(report.before.bad > report.after.bad);
        assert_kept(&old, &outcome);
        // Of the triangles, only the last two: one that is no facet, and the duplicate.
        let first_extra = old.cells.len() as i64 - 2;
        let others = |mesh: &Mesh| -> Vec<(i64, CellKind, Vec<[u64; 3]>)> {
            let numbers = mesh.cell_field("number").unwrap().values.to_i64().unwrap();
            let bits = |v: &[VertexId]| cell_corners(mesh, v).map(|p| p.map(f64::to_bits)).collect();
            let cells = mesh.cells.iter().filter(|(cell, kind, _)| match *kind {
                CellKind::TETRA => false,
                CellKind::TRIANGLE => numbers[cell.index()] >= first_extra,
                _ => true,
            });
            cells.map(|(cell, kind, v)| (numbers[cell.index()], kind, bits(v))).collect()
        };
        assert_eq!(others(&old), others(new));
        assert!(others(new).len() > 10);
        let faces = |mesh: &Mesh| -> Vec<Vec<[u64; 3]>> {
            let bits = |v: &[VertexId]| cell_corners(mesh, v).map(|p| p.map(f64::to_bits)).collect();
            mesh.cells
                .polyhedron_faces()
                .iter()
                .flat_map(|f| f.iter().map(bits).collect::<Vec<_>>())
                .collect()
        };
        assert_eq!(faces(&old), faces(new));
        assert_eq!(history.cells.len(), new.cells.len());
    }
}

#[test]
fn a_good_mesh_comes_back_as_it_is() {
    let old = shaken_box(0.05, false);
    let Changed { mesh, history, report, .. } = remeshed(&old, &Options::default());
    assert_eq!(mesh, old);
    assert_eq!((report.before.bad, report.kept_share), (0, 1.0));
    assert!(history.cells.changed().is_empty() && history.vertices.changed().is_empty());
}

#[test]
fn the_same_for_any_number_of_threads() {
    let old = shaken_box(0.35, true);
    let of = |n: usize| {
        let threads = Threads::new(n).unwrap();
        remesh_mesh(&old, &adapt(), &Rules::default(), &threads).unwrap()
    };
    let (one, two) = (of(1), of(2));
    assert_eq!(one.mesh, two.mesh);
    assert_eq!(one.history, two.history);
}

#[test]
fn a_rule_of_the_callers_is_obeyed_and_one_for_no_array_is_refused() {
    let old = shaken_box(0.45, false);
    let with = |name: &str, rule| {
        let rules = Rules { cells: [(name.to_owned(), rule)].into(), ..Rules::default() };
        remesh_mesh(&old, &Options::default(), &rules, &Threads::single())
    };
    let dropped = with("pressure", Rule::Drop).unwrap().mesh;
    assert!(dropped.cell_field("pressure").is_none() && dropped.cell_field("constant").is_some());
    let error = with("presure", Rule::Drop).unwrap_err();
    assert_eq!(error.kind(), motet::ErrorKind::Options);
}

#[test]
fn what_makes_no_mesh_is_reported_with_its_cell() {
    // Three tets at one facet, after two line cells.
    let points =
        vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3], [0.0, 0.0, -1.0]];
    let mut cells = Cells::new();
    (0..2).for_each(|_| cells.push(CellKind::LINE, [0, 1].map(VertexId)));
    for apex in [3, 4, 5] {
        cells.push(CellKind::TETRA, [0, 1, 2, apex].map(VertexId));
    }
    let of = |mesh: &Mesh| {
        remesh_mesh(mesh, &Options::default(), &Rules::default(), &Threads::single()).unwrap_err()
    };
    let error = of(&Mesh::new(points.clone(), cells));
    assert_eq!(error.place(), Some("cell 2"), "{error}");
    assert!(error.remedy_text().is_some());
    let mut cells = Cells::new();
    cells.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
    let error = of(&Mesh::new(points, cells));
    assert!(error.to_string().contains("1 triangle") && error.remedy_text().is_some(), "{error}");
}

#[test]
fn a_conforming_mesh_stays_conforming() {
    let old = shaken_box(0.35, true);
    let new = remeshed(&old, &adapt()).mesh;
    assert!(is_conforming(&check(&old)));
    let defects = check(&new);
    assert!(is_conforming(&defects), "{defects:?}");
}

/// A shaken box whose only arrays are labels.
fn labelled_box() -> Mesh {
    let mut mesh = shaken_box(0.35, true);
    mesh.point_data.clear();
    mesh.cell_data.retain(|field| ["region", "patch"].contains(&field.name.as_str()));
    mesh
}

#[test]
fn without_a_history_the_mesh_and_its_labels_are_the_same() {
    let old = labelled_box();
    assert!(has_only_labels(&old) && !has_only_labels(&shaken_box(0.35, true)));
    let best = Options { goal: Goal::Best, ..Options::default() };
    let improved = Options { improve: Some(Improve::filled()), ..Options::default() };
    for options in [Options::default(), adapt(), best, improved] {
        let whole = remesh_mesh(&old, &options, &Rules::default(), &Threads::single()).unwrap();
        let (labelled, report) = remesh_labelled(&old, &options, &Threads::single()).unwrap();
        assert!(report.kept < old.cells.tets().count() && report.kept == whole.report.kept);
        assert_eq!(labelled, whole.mesh);
    }
}

#[test]
fn a_volume_that_was_filled_is_improved_and_keeps_its_vertices() {
    let old = labelled_box();
    let of = |improve| Options { improve, ..Options::default() };
    let [repaired, improved] = [None, Some(Improve::filled())]
        .map(|improve| remesh_labelled(&old, &of(improve), &Threads::single()).unwrap());
    let means =
        [&repaired, &improved].map(|(mesh, _)| Qualities::of_mesh(mesh, &Threads::single()).unwrap().mean);
    assert!(means[1] > means[0] + 0.05, "{means:?}");
    assert_eq!(repaired.0.points.len(), improved.0.points.len());
}

#[test]
fn tets_numbered_the_other_way_round_stay_so() {
    let mut old = shaken_box(0.35, false);
    let mut cells = Cells::new();
    for (_, kind, vertices) in old.cells.iter() {
        let mut vertices = vertices.to_vec();
        vertices.swap(0, 1);
        cells.push(kind, vertices);
    }
    let straight = remeshed(&old, &Options::default());
    old.cells = cells;
    let outcome = remeshed(&old, &Options::default());
    assert!(outcome.mesh.is_turned() && !straight.mesh.is_turned());
    assert_kept(&old, &outcome);
    assert_eq!(outcome.report.before.types, straight.report.before.types);
    assert_eq!((outcome.report.after.bad, outcome.report.after.inverted), (0, 0));
    assert!(outcome.mesh.cells.tets().all(|(_, t)| tet::volume(corners(&outcome.mesh, t)) < 0.0));
}
