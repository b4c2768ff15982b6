//! A stent that opens in a vessel: the series used to show contact warnings.
//!
//! `contact_stent OUT.pvd [--steps 20] [--radius 0.45,1.3] [--length 15] X,Y,Z X,Y,Z ..` writes a stent along
//! a line through the given places, crimped at first and opened radially step by step. Without places it runs
//! along the middle of the artery of `vessels/vmtk_id1_aneurysm.vtp` (see the README), past the mouth of the
//! aneurysm. Then
//!
//! ```text
//! motet contact OUT.pvd VESSEL -o gaps.pvd --warn 0.15
//! ```
//!
//! reports at each step how far the struts are from the wall, which reproduces figure 13 of Moyle and
//! Ventikos (2008).

use std::error::Error;

use motet::base::Point;
use motet::io::{SeriesWriter, WriteOptions};
use motet::mesh::shapes::{CenterLine, Stent};

/// Places along the artery, in millimetres: on the path of largest clearance from its inlet to where it
/// branches, found by shortest paths over a grid of distances from the wall, where clearances above 1.3 count
/// as 1.3.
const ARTERY: [Point; 10] = [
    [43.3, 42.2, 38.0],
    [43.0, 43.4, 36.9],
    [43.8, 45.0, 35.8],
    [45.4, 46.7, 35.8],
    [46.2, 48.0, 37.1],
    [46.4, 50.0, 38.8],
    [46.1, 51.8, 39.7],
    [45.1, 53.3, 40.7],
    [43.7, 54.8, 41.8],
    [42.0, 56.3, 42.2],
];

/// Samples a smooth curve through the places finely (Catmull and Rom 1974).
fn smooth(places: &[Point]) -> Vec<Point> {
    const STEPS: usize = 12;
    let at = |i: isize| places[i.clamp(0, places.len() as isize - 1) as usize];
    let mut curve = Vec::new();
    for i in 0..places.len() as isize - 1 {
        let [a, b, c, d] = [at(i - 1), at(i), at(i + 1), at(i + 2)];
        for k in 0..STEPS {
            let t = k as f64 / STEPS as f64;
            curve.push([0, 1, 2].map(|x| {
                let slope = |p: Point, q: Point| 0.5 * (q[x] - p[x]);
                let (from, to) = (slope(a, c), slope(b, d));
                let (u, w) = (t * t * (3.0 - 2.0 * t), t * (1.0 - t));
                b[x] * (1.0 - u) + c[x] * u + w * ((1.0 - t) * from - t * to)
            }));
        }
    }
    curve.push(at(places.len() as isize - 1));
    curve
}

fn numbers(text: &str) -> Result<Vec<f64>, Box<dyn Error>> {
    Ok(text.split(',').map(str::parse).collect::<Result<_, _>>()?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut steps, mut radii, mut length, mut out, mut places) = (20, [0.45, 1.3], 15.0, None, Vec::new());
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--steps" => steps = value()?.parse::<u32>()?.max(1),
            "--radius" => radii = numbers(&value()?)?[..].try_into()?,
            "--length" => length = value()?.parse()?,
            _ if out.is_none() => out = Some(word),
            _ => places.push(numbers(&word)?[..].try_into()?),
        }
    }
    let out = out.ok_or("usage: contact_stent OUT.pvd")?;
    let places = if places.is_empty() { ARTERY.to_vec() } else { places };
    let stent =
        Stent { length, rings: 12, crowns: 8, strut_width: 0.08, thickness: 0.06, ..Stent::default() };
    let line = CenterLine::new(&smooth(&places))?;
    let mut series = SeriesWriter::new(&out, WriteOptions::default());
    for step in 0..=steps {
        let radius = radii[0] + (radii[1] - radii[0]) * f64::from(step) / f64::from(steps);
        let mut mesh = stent.mesh(radius)?;
        mesh.points = line.bent(&mesh.points);
        series.add(f64::from(step), &mesh)?;
    }
    println!(
        "{out}: {} steps, radius {} to {}, {} triangles",
        steps,
        radii[0],
        radii[1],
        stent.triangles()?.len()
    );
    Ok(())
}
