//! Line charts as SVG, drawn here so that they need no script.

use std::fmt::Write as _;

use serde::Serialize;

use crate::numbers::short;

const WIDTH: f64 = 360.0;
const HEIGHT: f64 = 190.0;
/// Margins left, right, above and below the lines.
const MARGINS: [f64; 4] = [50.0, 12.0, 10.0, 34.0];
/// Above this number of points, they are not marked by dots.
const MAX_DOTS: usize = 40;

/// Values over time (or steps), as one or several lines.
#[derive(Clone, Debug, Default)]
pub(crate) struct Chart {
    pub(crate) title: String,
    pub(crate) x_name: String,
    pub(crate) x: Vec<f64>,
    pub(crate) lines: Vec<Line>,
    /// A value that is marked by a horizontal line, with its name.
    pub(crate) threshold: Option<(f64, &'static str)>,
    pub(crate) from_zero: bool,
}

/// One line; `None` where a value is missing.
#[derive(Clone, Debug, Default)]
pub(crate) struct Line {
    pub(crate) name: String,
    pub(crate) y: Vec<Option<f64>>,
}

/// A chart in the form that the page uses.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Drawn {
    pub(crate) title: String,
    pub(crate) svg: String,
    /// Names of the lines, where there are several.
    pub(crate) legend: Vec<String>,
}

/// Maps values to positions in the picture.
struct Scale {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Scale {
    fn at(&self, x: f64) -> f64 {
        // Halves first: the difference of huge numbers may overflow.
        let part = (x / 2.0 - self.low / 2.0) / (self.high / 2.0 - self.low / 2.0);
        self.from + part * (self.to - self.from)
    }
}

impl Chart {
    /// Whether there is something to draw: a line with at least two values.
    pub(crate) fn is_drawable(&self) -> bool {
        self.x.len() > 1 && self.lines.iter().any(|line| line.y.iter().flatten().count() > 1)
    }

    pub(crate) fn drawn(&self) -> Drawn {
        let several = self.lines.len() > 1;
        let legend =
            if several { self.lines.iter().map(|line| line.name.clone()).collect() } else { Vec::new() };
        Drawn { title: self.title.clone(), svg: self.svg(), legend }
    }

    fn svg(&self) -> String {
        let [left, right, above, below] = MARGINS;
        let (low, high) = range(self.x.iter().copied());
        let x = Scale { low, high, from: left, to: WIDTH - right };
        let values = self.lines.iter().flat_map(|line| line.y.iter().flatten().copied());
        let values = values.chain(self.threshold.map(|t| t.0)).chain(self.from_zero.then_some(0.0));
        let (low, high) = range(values);
        let ticks = ticks(low, high, 4);
        let y_low = ticks.first().map_or(low, |t| t.min(low));
        let y_high = ticks.last().map_or(high, |t| t.max(high));
        let y = Scale { low: y_low, high: y_high, from: HEIGHT - below, to: above };
        let mut svg = format!(
            "<svg class=\"chart\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{}\" \
             data-x=\"{left} {} {} {}\">",
            escaped(&self.title),
            WIDTH - right,
            x.low,
            x.high
        );
        self.put_grid(&mut svg, &x, &y, &ticks);
        if let Some((value, _)) = self.threshold {
            let (at, end) = (y.at(value), WIDTH - right);
            let _ = write!(
                svg,
                "<line class=\"threshold\" x1=\"{left}\" x2=\"{end}\" y1=\"{at:.1}\" y2=\"{at:.1}\"/>"
            );
        }
        for (i, line) in self.lines.iter().enumerate() {
            self.put_line(&mut svg, line, i, &x, &y);
        }
        if let Some((value, name)) = self.threshold {
            // Lines should stay above the threshold, so its name goes below it, where there is space.
            let at = y.at(value);
            let at = if at + 14.0 < HEIGHT - below { at + 11.0 } else { at - 3.0 };
            let _ = write!(
                svg,
                "<text class=\"threshold\" x=\"{}\" y=\"{at:.1}\" text-anchor=\"end\">{name}</text>",
                WIDTH - right
            );
        }
        let _ = write!(
            svg,
            "<line class=\"cursor\" y1=\"{above}\" y2=\"{}\" x1=\"-9\" x2=\"-9\"/></svg>",
            HEIGHT - below
        );
        svg
    }

    fn put_grid(&self, svg: &mut String, x: &Scale, y: &Scale, y_ticks: &[f64]) {
        for &tick in y_ticks {
            let at = y.at(tick);
            let _ = write!(
                svg,
                "<line class=\"grid\" x1=\"{}\" x2=\"{}\" y1=\"{at:.1}\" y2=\"{at:.1}\"/>\
                 <text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                x.from,
                x.to,
                x.from - 6.0,
                at + 3.5,
                label(tick)
            );
        }
        let bottom = y.from;
        for tick in ticks(x.low, x.high, 5).into_iter().filter(|&t| t >= x.low && t <= x.high) {
            let at = x.at(tick);
            let _ = write!(
                svg,
                "<line class=\"tick\" x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"{bottom}\" y2=\"{}\"/>\
                 <text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                bottom + 4.0,
                bottom + 15.0,
                label(tick)
            );
        }
        let _ = write!(
            svg,
            "<line class=\"axis\" x1=\"{}\" x2=\"{}\" y1=\"{bottom}\" y2=\"{bottom}\"/>\
             <text class=\"name\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            x.from,
            x.to,
            (x.from + x.to) / 2.0,
            HEIGHT - 4.0,
            escaped(&self.x_name)
        );
    }

    fn put_line(&self, svg: &mut String, line: &Line, i: usize, x: &Scale, y: &Scale) {
        let mut path = String::new();
        let mut dots = String::new();
        let mut is_open = false;
        for (&at, value) in self.x.iter().zip(&line.y) {
            let Some(value) = value.filter(|v| v.is_finite() && at.is_finite()) else {
                is_open = false;
                continue;
            };
            let (px, py) = (x.at(at), y.at(value));
            let _ = write!(path, "{}{px:.1} {py:.1}", if is_open { "L" } else { "M" });
            let _ = write!(
                dots,
                "<circle cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"2.2\"><title>{} {}: {}</title></circle>",
                escaped(&self.x_name),
                short(at),
                short(value)
            );
            is_open = true;
        }
        let _ = write!(svg, "<g class=\"line l{}\"><path d=\"{path}\"/>", i % 8);
        if self.x.len() <= MAX_DOTS {
            svg.push_str(&dots);
        }
        svg.push_str("</g>");
    }
}

/// The range of the finite values, widened where it is empty or a single value.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let finite = values.filter(|x| x.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    match (low, high) {
        _ if low > high => (0.0, 1.0),
        _ if low < high => (low, high),
        _ if low == 0.0 => (0.0, 1.0),
        _ => (low - low.abs() / 2.0, low + low.abs() / 2.0),
    }
}

/// Round values within a range: multiples of 1, 2 or 5 times a power of ten.
fn ticks(low: f64, high: f64, about: usize) -> Vec<f64> {
    let rough = (high / about as f64) - (low / about as f64);
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|f| f * power).into_iter().find(|&s| s >= rough).unwrap_or(rough);
    if !step.is_finite() || step <= 0.0 || (low / step).abs() > 1e9 {
        return vec![low, high];
    }
    let (first, last) = ((low / step).floor() as i64, (high / step).ceil() as i64);
    (first..=last).map(|i| i as f64 * step).collect()
}

fn label(tick: f64) -> String {
    let rounded: f64 = format!("{tick:.6e}").parse().unwrap_or(tick);
    let size = rounded.abs();
    if size == 0.0 {
        return "0".to_owned();
    }
    if (1e-4..1e5).contains(&size) {
        rounded.to_string().replace('-', "\u{2212}")
    } else {
        format!("{rounded:e}")
    }
}

/// Escapes text for HTML.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_cover_the_range() {
        assert_eq!(ticks(0.0, 1.0, 4), [0.0, 0.5, 1.0]);
        assert_eq!(ticks(-3.0, 7.0, 5), [-4.0, -2.0, 0.0, 2.0, 4.0, 6.0, 8.0]);
        assert_eq!(label(0.30000000000000004), "0.3");
    }

    #[test]
    fn a_gap_breaks_the_line_and_no_value_breaks_the_picture() {
        let line = |y: &[Option<f64>]| Line { name: "a<b".into(), y: y.to_vec() };
        let chart = Chart {
            title: "a < b".into(),
            x_name: "step".into(),
            x: (0..4).map(f64::from).collect(),
            lines: vec![
                line(&[Some(1.0), None, Some(f64::NAN), Some(2.0)]),
                line(&[Some(1e308), Some(-1e308)]),
            ],
            ..Chart::default()
        };
        let svg = chart.drawn().svg;
        assert!(!svg.contains("NaN") && !svg.contains("inf") && svg.contains("a &lt; b"), "{svg}");
        assert_eq!(svg.matches('M').count(), 3);
        assert!(chart.is_drawable() && !Chart::default().is_drawable());
    }
}
