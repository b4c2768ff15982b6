//! Surfaces that the examples about contact share: a tube with bulges, and a stent lattice in it.

use std::f64::consts::TAU;

use motet::base::{Point, VertexId};

/// Points, and triangles over them.
pub(crate) type Shape = (Vec<Point>, Vec<[VertexId; 3]>);

/// A tube of radius 1 and length 8 with bulges: 99,200 triangles.
pub(crate) fn tube() -> Shape {
    let (around, along) = (400, 125);
    let mut points = Vec::new();
    for i in 0..around {
        let angle = i as f64 / around as f64 * TAU;
        for j in 0..along {
            let z = 8.0 * j as f64 / (along - 1) as f64;
            let radius = 1.0 + 0.02 * (3.0 * angle + 1.3 * z).sin() + 0.01 * (7.0 * z).sin();
            points.push([radius * angle.cos(), radius * angle.sin(), z]);
        }
    }
    let mut triangles = Vec::new();
    for i in 0..around {
        for j in 0..along - 1 {
            let (a, b) = (i * along + j, (i + 1) % around * along + j);
            triangles.push([a, b, b + 1].map(VertexId::new));
            triangles.push([a, b + 1, a + 1].map(VertexId::new));
        }
    }
    (points, triangles)
}

/// A lattice of two families of helices between radii 0.91 and 0.95, closed: 27,864 vertices.
pub(crate) fn lattice() -> Shape {
    let (around, along) = (168usize, 114usize);
    let is_strut = |x: f64| (x.rem_euclid(1.0) - 0.5).abs() < 0.14;
    let keep = |i: usize, j: usize| {
        let (u, w) = ((i as f64 + 0.5) / around as f64 * 12.0, (j as f64 + 0.5) / along as f64 * 12.0);
        is_strut(u + w) || is_strut(u - w) || j < 3 || j >= along - 3
    };
    let skin = around * (along + 1);
    let mut points = Vec::new();
    for radius in [0.95, 0.91] {
        for i in 0..around {
            let angle = i as f64 / around as f64 * TAU;
            for j in 0..=along {
                let z = 1.0 + 6.0 * j as f64 / along as f64;
                points.push([radius * angle.cos(), radius * angle.sin(), z]);
            }
        }
    }
    let node = |i: usize, j: usize| (i % around) * (along + 1) + j;
    let mut quads = Vec::new();
    for i in 0..around {
        for j in (0..along).filter(|&j| keep(i, j)) {
            let [a, b, c, d] = [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)];
            quads.extend([[a, b, c, d], [a, d, c, b].map(|v| v + skin)]);
            let sides = [
                (j > 0 && keep(i, j - 1), a, b),
                (j + 1 < along && keep(i, j + 1), c, d),
                (keep((i + around - 1) % around, j), d, a),
                (keep((i + 1) % around, j), b, c),
            ];
            let open = sides.into_iter().filter(|side| !side.0);
            quads.extend(open.map(|(_, x, y)| [x, x + skin, y + skin, y]));
        }
    }
    let mut used: Vec<usize> = quads.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    let id = |v: usize| VertexId::new(used.partition_point(|&u| u < v));
    let triangles =
        quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|t| t.map(id)).collect();
    (used.iter().map(|&v| points[v]).collect(), triangles)
}
