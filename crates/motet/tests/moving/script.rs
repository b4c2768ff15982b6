//! The motion of walls over time, and contradictions in it.

use motet::base::{Point, VertexId};
use motet::geometry::vector::norm;
use motet::mesh::shapes::box_grid;
use motet::mesh::{CellKind, Cells, Field, Mesh};
use motet::motion::{FacetSet, Prescribed};
use motet::moving::{Gaps, InTime, Script, Seconds, Step, normals};

const DRIVEN: [VertexId; 2] = [VertexId(0), VertexId(3)];

fn still(place: Point) -> Script {
    Script::still(&DRIVEN, &[place; 4])
}

#[test]
fn frames_are_spread_over_a_period_or_from_begin_to_end() {
    let frames: Vec<Vec<Point>> = [0.0, 1.0, 4.0, 9.0].map(|x| vec![[x, 0.0, 0.0], [0.0, x, 0.0]]).to_vec();
    let at = |script: &Script, phase: f64| {
        let [a, b] = script.at(phase).try_into().unwrap();
        let (x, y): (Point, Point) = (a, b);
        assert_eq!((x[0], x[1], x[2], y[0], y[2]), (y[1], 0.0, 0.0, 0.0, 0.0));
        x[0]
    };
    let mut once = still([0.0; 3]);
    assert_eq!(once.frames(&DRIVEN, frames.clone(), false).unwrap(), 2);
    for (phase, x) in
        [(-2.0, 0.0), (0.0, 0.0), (1.0 / 6.0, 0.5), (1.0 / 3.0, 1.0), (0.5, 2.5), (1.0, 9.0), (7.5, 9.0)]
    {
        assert!((at(&once, phase) - x).abs() < 1e-12, "{phase}: {}", at(&once, phase));
    }
    let mut again = still([0.0; 3]);
    again.frames(&DRIVEN, frames, true).unwrap();
    for (phase, x) in [(0.0, 0.0), (0.25, 1.0), (0.375, 2.5), (0.75, 9.0), (0.875, 4.5), (1.0, 0.0)] {
        for periods in [-3.0, -1.0, 0.0, 1.0, 5.0] {
            assert!((at(&again, phase + periods) - x).abs() < 1e-12, "{phase} in period {periods}");
        }
    }
    let shift = Prescribed::Shift([1.0; 3]);
    assert!(again.follow(&DRIVEN, Prescribed::Shift([f64::NAN; 3]), InTime::Ramp).is_err());
    assert!(again.follow(&DRIVEN, shift, InTime::Table(Vec::new())).is_err(), "a course of nothing");
    assert!(
        again.go(&DRIVEN, vec![[0.0; 3]; 2], InTime::Table(Vec::new())).is_err(),
        "a course that is none"
    );
    // With one frame the walls are there all the time.
    for is_periodic in [true, false] {
        let mut one = still([0.0; 3]);
        one.frames(&DRIVEN, vec![vec![[2.0, 0.0, 0.0], [0.0, 2.0, 0.0]]], is_periodic).unwrap();
        assert!([0.0, 0.3, 1.0, 1.7].iter().all(|phase| at(&one, *phase) == 2.0));
    }
    assert!(still([0.0; 3]).frames(&DRIVEN, Vec::new(), true).is_err());
}

#[test]
fn parts_contradict_each_other_where_they_differ_by_more_than_rounding() {
    // The same shift twice, the second time off by a part of the largest coordinate.
    for size in [1e-6, 1.0, 1e6] {
        for (off, is_other) in [(0.0, false), (1e-13, false), (1e-11, true), (1e-3, true)] {
            let mut script = still([size, 0.0, 0.0]);
            let by = [0.5 * size, 0.0, 0.0];
            script.follow(&DRIVEN, Prescribed::Shift(by), InTime::Ramp).unwrap();
            script.go(&DRIVEN, vec![[by[0], off * size, 0.0], by], InTime::Ramp).unwrap();
            let expected: &[VertexId] = if is_other { &DRIVEN[..1] } else { &[] };
            assert_eq!(script.contradicted(), expected, "{off} of {size}");
        }
    }
    // For a course at rest at the beginning and the end of a period, in between.
    for in_time in [InTime::Beat, InTime::Swing] {
        let mut script = still([1.0; 3]);
        script.follow(&DRIVEN, Prescribed::Shift([1.0, 0.0, 0.0]), in_time.clone()).unwrap();
        script.follow(&DRIVEN, Prescribed::Shift([2.0, 0.0, 0.0]), in_time).unwrap();
        assert_eq!(script.contradicted(), DRIVEN);
    }
    // At the origin, the displacements determine what counts as rounding.
    let mut script = still([0.0; 3]);
    script.follow(&DRIVEN, Prescribed::Shift([1.0, 0.0, 0.0]), InTime::Ramp).unwrap();
    script.go(&DRIVEN, vec![[1.0, 1e-13, 0.0], [1.0, 1e-11, 0.0]], InTime::Ramp).unwrap();
    assert_eq!(script.contradicted(), DRIVEN[1..]);
    // What stays is not contradicted; nor is what has one part.
    let mut script = still([1.0; 3]);
    assert!(script.contradicted().is_empty());
    script.hold(&DRIVEN);
    script.follow(&DRIVEN, Prescribed::Shift([1.0; 3]), InTime::Ramp).unwrap();
    assert!(script.contradicted().is_empty());
}

#[test]
fn normals_lead_out_of_a_box_and_are_none_where_there_is_no_area() {
    let mesh = box_grid([2; 3], [[0.0; 3], [1.0; 3]]);
    let patches = mesh.patches().unwrap();
    for label in patches.used() {
        let facets = FacetSet::of_patch(&mesh, label);
        let all = normals(&facets, &mesh.points);
        assert_eq!(all.len(), facets.vertices.len());
        // A side of the box: all normals point along one axis, away from the centre.
        let place = mesh.points[facets.vertices[0].index()];
        for normal in &all {
            assert!(
                (norm(*normal) - 1.0).abs() < 1e-15 && normal.iter().filter(|x| x.abs() > 1e-15).count() == 1
            );
            assert!((0..3).map(|k| normal[k] * (place[k] - 0.5)).sum::<f64>() == 0.5);
        }
    }
    let mut cells = Cells::new();
    cells.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
    let mut flat =
        Mesh { points: (0..3).map(|i| [f64::from(i), 0.0, 0.0]).collect(), cells, ..Mesh::default() };
    flat.set_cell_field(Field::scalars("patch", vec![7]));
    assert_eq!(normals(&FacetSet::of_patch(&flat, 7), &flat.points), [[0.0; 3]; 3]);
}

#[test]
fn a_step_says_why_it_ended_early() {
    let done = Step { complete: true, fraction: 1.0, ..Step::default() };
    assert_eq!(done.not_reached(), None);
    let part = Step { complete: false, fraction: 0.25, ..Step::default() };
    assert!(part.not_reached().unwrap().contains("25"), "{:?}", part.not_reached());
    let free = Step { gaps: Some(Gaps::default()), ..done.clone() };
    assert_eq!(free.not_reached(), None);
    let gaps = Gaps { cramped: Some("leaflet".into()), ..Gaps::default() };
    let cramped = Step { gaps: Some(gaps), ..done };
    assert!(cramped.not_reached().unwrap().contains("leaflet"));
}

#[test]
fn seconds_add_up_by_stage() {
    let one = Seconds { motion: 1.0, quality: 2.0, repair: 3.0, setup: 4.0, contact: 5.0, total: 16.0 };
    let mut sum = one;
    sum += one;
    assert_eq!(
        sum,
        Seconds { motion: 2.0, quality: 4.0, repair: 6.0, setup: 8.0, contact: 10.0, total: 32.0 }
    );
}
