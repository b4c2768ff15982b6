//! Wires that touch, cross or nearly do are put in with a new surface: the boundaries of the flow and of the
//! wires are 2-manifolds.

use std::collections::HashMap;
use std::f64::consts::TAU;

use crate::common::devices::room;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::vector::{add, cross, scale, sub, unit};
use motet::implant::{Adapt, Device, Interface, Options, implant};
use motet::mesh::check::{check, is_conforming};
use motet::mesh::history::Rules;
use motet::mesh::{CellKind, Cells, Mesh, Surface};

const RADIUS: f64 = 0.1;
const SIDES: u32 = 8;

/// A closed wire along these places, added to a mesh of triangles.
fn add_wire(points: &mut Vec<Point>, cells: &mut Cells, way: &[Point]) {
    let first = points.len() as u32;
    let n = way.len();
    for (i, &p) in way.iter().enumerate() {
        let along = sub(way[(i + 1).min(n - 1)], way[i.saturating_sub(1)]);
        let side = unit(cross(along, [0.0, 0.0, 1.0])).expect("no wire goes along z");
        let up = unit(cross(side, along)).expect("at right angles");
        for k in 0..SIDES {
            let (sin, cos) = (TAU * f64::from(k) / f64::from(SIDES)).sin_cos();
            points.push(add(p, scale(add(scale(side, cos), scale(up, sin)), RADIUS)));
        }
    }
    let at = |i: usize, k: u32| VertexId(first + i as u32 * SIDES + k % SIDES);
    let ends = [VertexId(first + n as u32 * SIDES), VertexId(first + n as u32 * SIDES + 1)];
    points.extend([way[0], way[n - 1]]);
    for k in 0..SIDES {
        for i in 0..n - 1 {
            cells.push(CellKind::TRIANGLE, [at(i, k), at(i + 1, k), at(i + 1, k + 1)]);
            cells.push(CellKind::TRIANGLE, [at(i, k), at(i + 1, k + 1), at(i, k + 1)]);
        }
        cells.push(CellKind::TRIANGLE, [ends[0], at(0, k), at(0, k + 1)]);
        cells.push(CellKind::TRIANGLE, [ends[1], at(n - 1, k + 1), at(n - 1, k)]);
    }
}

fn wires(ways: &[Vec<Point>]) -> Mesh {
    let (mut points, mut cells) = (Vec::new(), Cells::new());
    ways.iter().for_each(|way| add_wire(&mut points, &mut cells, way));
    Mesh::new(points, cells)
}

fn straight(from: Point, to: Point) -> Vec<Point> {
    (0..=4).map(|i| add(from, scale(sub(to, from), f64::from(i) / 4.0))).collect()
}

/// Counts edges of the boundary of some tets that do not have exactly two of its facets, and vertices with
/// more than one fan of them.
fn pinches(tets: &[[VertexId; 4]]) -> (usize, usize) {
    let mut facets: HashMap<[VertexId; 3], ([VertexId; 3], usize)> = HashMap::new();
    for &[a, b, c, d] in tets {
        for facet in [[b, c, d], [a, d, c], [a, b, d], [a, c, b]] {
            let mut key = facet;
            key.sort_unstable();
            facets.entry(key).or_insert((facet, 0)).1 += 1;
        }
    }
    let boundary: Vec<[VertexId; 3]> = facets.into_values().filter(|f| f.1 == 1).map(|f| f.0).collect();
    let mut edges: HashMap<[VertexId; 2], usize> = HashMap::new();
    let mut at: HashMap<VertexId, Vec<[VertexId; 2]>> = HashMap::new();
    for &[a, b, c] in &boundary {
        for [u, v, w] in [[a, b, c], [b, c, a], [c, a, b]] {
            *edges.entry([u.min(v), u.max(v)]).or_default() += 1;
            at.entry(w).or_default().push([u, v]);
        }
    }
    // Around a vertex, the opposite sides follow each other in one ring.
    let is_one_fan = |sides: &Vec<[VertexId; 2]>| {
        let next: HashMap<VertexId, VertexId> = sides.iter().map(|&[u, v]| (u, v)).collect();
        let (start, mut v, mut n) = (sides[0][0], sides[0][0], 0);
        while let Some(&to) = next.get(&v) {
            (v, n) = (to, n + 1);
            if v == start || n > sides.len() {
                break;
            }
        }
        n == sides.len() && next.len() == n
    };
    (edges.values().filter(|&&n| n != 2).count(), at.values().filter(|sides| !is_one_fan(sides)).count())
}

#[test]
fn wires_that_touch_cross_or_overlap_a_little_leave_a_manifold() {
    let x = |y: f64, z: f64| straight([-0.5, y, z], [0.5, y, z]);
    let skew = |z: f64| straight([-0.4, -0.35, z], [0.4, 0.35, z]);
    let cases = [
        ("along a line", vec![x(-RADIUS, 0.0), x(RADIUS, 0.0)]),
        ("along a line, nearly", vec![x(-RADIUS, 0.0), x(1.02 * RADIUS, 0.0)]),
        ("at a point", vec![x(0.0, -RADIUS), skew(RADIUS)]),
        ("overlapping at an angle", vec![x(0.0, -0.97 * RADIUS), skew(RADIUS)]),
        ("three", vec![x(-RADIUS, -RADIUS), x(RADIUS, -RADIUS), skew(RADIUS)]),
    ];
    let options = Options {
        interface: Interface::Conform { tolerance: Some(0.2 * RADIUS) },
        adapt: Adapt::No,
        ..Options::default()
    };
    let host = room(8);
    for (name, ways) in cases {
        let device = Device::new(wires(&ways), "wires");
        let made = implant(&host, &[device], &options, &Rules::default(), &Threads::single());
        let made = made.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(is_conforming(&check(&made.mesh)), "{name}");
        let fit = made.report.devices[0].fit.expect("the surface is new");
        assert!(fit.is_reached(), "{name}: {fit:?}");
        let regions = made.mesh.regions().expect("the device is a region");
        let mut by_region: HashMap<i32, Vec<[VertexId; 4]>> = HashMap::new();
        for (cell, tet) in made.mesh.cells.tets() {
            by_region.entry(regions.ids[cell.index()]).or_default().push(tet);
        }
        assert_eq!(by_region.len(), 2);
        for (region, tets) in &by_region {
            assert_eq!(pinches(tets), (0, 0), "{name}, region {region}");
        }
        let volume = Surface::of(&wires(&ways)).enclosed_volume().abs();
        let filled = made.report.devices[0].volume;
        assert!((filled - volume).abs() < 0.1 * volume, "{name}: {filled} for {volume}");
    }
}
