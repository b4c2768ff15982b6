//! Bodies on lattices: sets of voxels, partitions into cells, plates with bumps.

use std::collections::BTreeMap;

use motet::base::Point;

use super::super::Numbers;
use super::body::{Body, halves};

type Place = [usize; 3];

/// The boundary of a random set of about this share of `n^3` voxels, with quads cut along random diagonals.
/// Where voxels meet only in an edge or a corner, the surface is not a manifold, unless `is_manifold` is set:
/// then voxels are filled in.
pub(crate) fn voxels(n: usize, share: f64, is_manifold: bool, numbers: &mut Numbers) -> Body {
    let mut grid = Grid::new(n, |_| numbers.unit() < share);
    grid.full[Grid::index(n, [n / 2; 3])] = true;
    while is_manifold && grid.fill_one_pinch() {}
    let lines = [(); 3].map(|()| random_lines(n, numbers));
    let mut skin = Skin::default();
    for place in places([n; 3]) {
        for (axis, up) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
            if grid.at(place) && !grid.beside(place, axis, up) {
                skin.push(facet(place, axis, up), numbers);
            }
        }
    }
    let size = |place: Place| (0..3).map(|k| lines[k][place[k] + 1] - lines[k][place[k]]).product::<f64>();
    let volume = places([n; 3]).filter(|p| grid.at(*p)).map(size).sum();
    skin.body(&lines, Some(volume))
}

/// A box divided into cells by membranes; three or four triangles share inner edges.
pub(crate) fn cells(n: Place, numbers: &mut Numbers) -> Body {
    let lines = n.map(|n| random_lines(n, numbers));
    let mut skin = Skin::default();
    for place in places(n) {
        for axis in 0..3 {
            skin.push(facet(place, axis, false), numbers);
            if place[axis] + 1 == n[axis] {
                skin.push(facet(place, axis, true), numbers);
            }
        }
    }
    let volume = lines.each_ref().map(|line| line[line.len() - 1] - line[0]).iter().product();
    Body { has_membranes: n != [1; 3], ..skin.body(&lines, Some(volume)) }
}

/// A plate of height 1 whose top varies at random by up to `height`: dihedral angles are nearly flat.
pub(crate) fn bumps(n: usize, height: f64, numbers: &mut Numbers) -> Body {
    let lines = [random_lines(n, numbers), random_lines(n, numbers), vec![0.0, 1.0]];
    let mut skin = Skin::default();
    for place in places([n, n, 1]) {
        for (axis, up) in (0..3).flat_map(|axis| [(axis, false), (axis, true)]) {
            let last = if axis == 2 { 1 } else { n };
            if axis == 2 || place[axis] == (if up { last - 1 } else { 0 }) {
                skin.push(facet(place, axis, up), numbers);
            }
        }
    }
    let mut body = skin.body(&lines, None);
    body.points.iter_mut().filter(|p| p[2] == 1.0).for_each(|p| p[2] += height * numbers.unit());
    let tops = body.triangles.iter().map(|t| t.map(|v| body.points[v.index()]));
    let column = |[a, b, c]: [Point; 3]| {
        let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
        area * (a[2] + b[2] + c[2]) / 3.0
    };
    let is_top = |t: &[Point; 3]| t.iter().all(|p| p[2] > 0.5);
    // Triangles on the sides have no area seen from above.
    body.volume = Some(tops.filter(is_top).map(column).sum());
    body
}

/// Increasing coordinates: integers, or random steps of 64ths.
fn random_lines(n: usize, numbers: &mut Numbers) -> Vec<f64> {
    let is_even = numbers.below(2) == 0;
    let mut line = vec![0.0];
    for i in 0..n {
        line.push(line[i] + if is_even { 1.0 } else { (1 + numbers.below(128)) as f64 / 64.0 });
    }
    line
}

fn places(n: Place) -> impl Iterator<Item = Place> {
    (0..n[0] * n[1] * n[2]).map(move |i| [i % n[0], i / n[0] % n[1], i / (n[0] * n[1])])
}

/// The corners of one side of a cell, facing outward.
fn facet(place: Place, axis: usize, up: bool) -> [Place; 4] {
    let corner = |s: usize, t: usize| {
        let mut corner = place;
        corner[axis] += usize::from(up);
        corner[(axis + 1) % 3] += s;
        corner[(axis + 2) % 3] += t;
        corner
    };
    match up {
        true => [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)],
        false => [corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)],
    }
}

/// Triangles over the places of a lattice.
#[derive(Default)]
struct Skin {
    ids: BTreeMap<Place, usize>,
    triangles: Vec<[usize; 3]>,
}

impl Skin {
    fn push(&mut self, quad: [Place; 4], numbers: &mut Numbers) {
        let ids = quad.map(|place| {
            let next = self.ids.len();
            *self.ids.entry(place).or_insert(next)
        });
        self.triangles.extend(halves(ids, numbers));
    }

    fn body(&self, lines: &[Vec<f64>; 3], volume: Option<f64>) -> Body {
        let mut points = vec![[0.0; 3]; self.ids.len()];
        for (place, &id) in &self.ids {
            points[id] = [0, 1, 2].map(|k| lines[k][place[k]]);
        }
        Body::new(points, &self.triangles, volume)
    }
}

/// A grid of voxels, each full or empty.
struct Grid {
    n: usize,
    full: Vec<bool>,
}

impl Grid {
    fn new(n: usize, mut is_full: impl FnMut(Place) -> bool) -> Self {
        Self { n, full: places([n; 3]).map(&mut is_full).collect() }
    }

    fn index(n: usize, [i, j, k]: Place) -> usize {
        i + n * (j + n * k)
    }

    fn at(&self, place: Place) -> bool {
        place.iter().all(|&i| i < self.n) && self.full[Self::index(self.n, place)]
    }

    fn beside(&self, mut place: Place, axis: usize, up: bool) -> bool {
        // Below 0 wraps to the largest number, which is outside too.
        place[axis] = if up { place[axis] + 1 } else { place[axis].wrapping_sub(1) };
        self.at(place)
    }

    /// Fills an empty voxel where full ones, or empty ones, meet only in an edge or a corner; returns whether
    /// there was one.
    fn fill_one_pinch(&mut self) -> bool {
        let n = self.n;
        // Corners on the outer rim count too: everything outside is empty.
        for corner in places([n + 1; 3]) {
            let around: Vec<Place> =
                (0..8).map(|d| [0, 1, 2].map(|k| (corner[k] + (d >> k & 1)).wrapping_sub(1))).collect();
            let full: Vec<bool> = around.iter().map(|p| self.at(*p)).collect();
            if is_joined(&full, true) && is_joined(&full, false) {
                continue;
            }
            let empty = around.iter().zip(&full).find(|(p, full)| !**full && p.iter().all(|&i| i < n));
            if let Some((place, _)) = empty {
                self.full[Self::index(n, *place)] = true;
                return true;
            }
        }
        false
    }
}

/// Whether, of the eight voxels around a corner, the full (or empty) ones are connected by their sides.
fn is_joined(full: &[bool], wanted: bool) -> bool {
    let Some(first) = (0..8).find(|&d| full[d] == wanted) else { return true };
    let (mut seen, mut next) = ([false; 8], vec![first]);
    while let Some(d) = next.pop() {
        if !seen[d] {
            seen[d] = true;
            next.extend([d ^ 1, d ^ 2, d ^ 4].into_iter().filter(|&e| full[e] == wanted));
        }
    }
    (0..8).all(|d| full[d] != wanted || seen[d])
}
