//! The motion of walls in time: prescribed motions, given displacements, and measured frames, each with a
//! course in time.

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, norm, scale, sub};
use crate::motion::{FacetSet, Prescribed};

/// The fraction of a motion that is done at a phase: 0 at the beginning of a period, 1 at its end. Periods
/// repeat.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum InTime {
    /// There and back, smoothly: `(1 - cos(2 pi phase)) / 2`, complete at half the period.
    #[default]
    Beat,
    /// To one side, to the other, and back: `sin(2 pi phase)`.
    Swing,
    /// Linear, from zero at the beginning of the first period to complete at its end, where it stays.
    Ramp,
    /// Linear between these pairs of phase and fraction, in rising order of phase; the last pair is followed
    /// by the first of the next period.
    Table(Vec<[f64; 2]>),
}

impl InTime {
    /// # Errors
    /// If a table has fewer than two entries, phases outside 0 to 1 or not rising, or a number that is not
    /// finite.
    pub fn check(&self) -> Result<()> {
        let Self::Table(table) = self else { return Ok(()) };
        let is_finite = table.as_flattened().iter().all(|x| x.is_finite());
        let is_rising = table.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        let is_within = table.iter().all(|[phase, _]| (0.0..=1.0).contains(phase));
        match table.len() > 1 && is_finite && is_rising && is_within {
            true => Ok(()),
            false => Err(Error::options(
                "a course in time must be a table of two or more entries, with phases rising within 0 to 1",
            )
            .remedy("give pairs of phase and fraction, such as [[0, 0], [0.3, 1], [1, 0]]")),
        }
    }

    /// The fraction of the motion that is done at this phase.
    pub fn at(&self, phase: f64) -> f64 {
        let turn = std::f64::consts::TAU * (phase - phase.floor());
        match self {
            Self::Beat => {
                let half = (0.5 * turn).sin();
                half * half
            }
            Self::Swing => turn.sin(),
            Self::Ramp => phase.clamp(0.0, 1.0),
            Self::Table(table) => in_table(table, phase - phase.floor()),
        }
    }
}

fn in_table(table: &[[f64; 2]], phase: f64) -> f64 {
    let (first, last) = (table[0], table[table.len() - 1]);
    let after = table.partition_point(|[at, _]| *at <= phase);
    let [a, b] = match after {
        0 => [[last[0] - 1.0, last[1]], first],
        n if n == table.len() => [last, [first[0] + 1.0, first[1]]],
        n => [table[n - 1], table[n]],
    };
    let width = b[0] - a[0];
    if width > 0.0 { a[1] + (b[1] - a[1]) * (phase - a[0]) / width } else { b[1] }
}

/// The number of phases per period at which parts of a script are compared.
const PHASES: usize = 16;

/// Two displacements are equal if they differ by less than this fraction of their size and that of the
/// coordinates.
const ROUNDING: f64 = 1e-12;

/// The displacement of each driven vertex at any time. A vertex follows the first part that names it;
/// vertices that no part names stay.
#[derive(Clone, Debug)]
pub struct Script {
    /// The driven vertices of the first mesh, in rising order.
    driven: Vec<VertexId>,
    places: Vec<Point>,
    /// The part that each vertex follows, and its index in it.
    part_of: Vec<Option<(usize, usize)>>,
    parts: Vec<Part>,
    /// The driven vertices that the last part names, and the index of each in it.
    last_rows: Vec<(usize, usize)>,
}

#[derive(Clone, Debug)]
enum Part {
    Stay,
    /// A motion of space.
    Follow(Prescribed, InTime),
    /// A displacement for each vertex.
    Displace(Vec<Point>, InTime),
    /// Displacements for each frame, evenly spaced over a period, and whether the first follows the last.
    Frames(Vec<Vec<Point>>, bool),
}

impl Script {
    /// A script in which nothing moves. `driven` lists the vertices that
    /// [`Motion::driven`](crate::motion::Motion::driven) returns; `points` are the points of the first mesh.
    pub fn still(driven: &[VertexId], points: &[Point]) -> Self {
        Self {
            driven: driven.to_vec(),
            places: driven.iter().map(|v| points[v.index()]).collect(),
            part_of: vec![None; driven.len()],
            parts: Vec::new(),
            last_rows: Vec::new(),
        }
    }

    /// The first positions of the driven vertices.
    pub fn places(&self) -> &[Point] {
        &self.places
    }

    /// Lets these vertices stay; returns how many of them were not named before, and so obey.
    pub fn hold(&mut self, vertices: &[VertexId]) -> usize {
        self.assign(vertices, Part::Stay)
    }

    /// Lets these vertices follow a motion of space; returns how many of them were not named before.
    ///
    /// # Errors
    /// The errors of [`Prescribed::check`] and [`InTime::check`].
    pub fn follow(&mut self, vertices: &[VertexId], motion: Prescribed, in_time: InTime) -> Result<usize> {
        motion.check()?;
        in_time.check()?;
        Ok(self.assign(vertices, Part::Follow(motion, in_time)))
    }

    /// Lets each of these vertices move by its own displacement in `by`, scaled by `in_time`; returns how
    /// many of them were not named before.
    ///
    /// # Errors
    /// The errors of [`InTime::check`], and if `by` does not have one displacement per vertex.
    pub fn go(&mut self, vertices: &[VertexId], by: Vec<Point>, in_time: InTime) -> Result<usize> {
        in_time.check()?;
        check_rows(&by, vertices)?;
        Ok(self.assign(vertices, Part::Displace(by, in_time)))
    }

    /// Lets these vertices follow frames, which are evenly spaced over a period, with linear interpolation in
    /// between; returns how many of them were not named before.
    ///
    /// # Errors
    /// If there are no frames, or if a frame does not have one displacement per vertex.
    pub fn frames(
        &mut self,
        vertices: &[VertexId],
        frames: Vec<Vec<Point>>,
        is_periodic: bool,
    ) -> Result<usize> {
        if frames.is_empty() {
            return Err(Error::input("a motion by frames needs at least one frame"));
        }
        frames.iter().try_for_each(|frame| check_rows(frame, vertices))?;
        Ok(self.assign(vertices, Part::Frames(frames, is_periodic)))
    }

    fn assign(&mut self, vertices: &[VertexId], part: Part) -> usize {
        let mut n = 0;
        self.last_rows.clear();
        for (row, v) in vertices.iter().enumerate() {
            let Ok(i) = self.driven.binary_search(v) else { continue };
            self.last_rows.push((i, row));
            if self.part_of[i].is_none() {
                self.part_of[i] = Some((self.parts.len(), row));
                n += 1;
            }
        }
        self.parts.push(part);
        n
    }

    /// Vertices that the last part names but that follow an earlier one which moves them differently during a
    /// period, by more than rounding. Vertices that stay by request are not included.
    pub fn contradicted(&self) -> Vec<VertexId> {
        let Some((last, part)) = self.parts.len().checked_sub(1).map(|last| (last, &self.parts[last])) else {
            return Vec::new();
        };
        let differs = |i: usize, row: usize, earlier: (usize, usize)| {
            let place = self.places[i];
            (1..=PHASES).map(|k| k as f64 / PHASES as f64).any(|phase| {
                let a = self.parts[earlier.0].displacement(place, earlier.1, phase);
                let b = part.displacement(place, row, phase);
                norm(sub(a, b)) > ROUNDING * (norm(a) + norm(b) + norm(place))
            })
        };
        let contradicted = |(&i, &row): (&usize, &usize)| match self.part_of[i] {
            Some((earlier, _)) if earlier == last || matches!(self.parts[earlier], Part::Stay) => None,
            Some(earlier) => differs(i, row, earlier).then_some(self.driven[i]),
            None => None,
        };
        self.last_rows.iter().map(|(i, row)| (i, row)).filter_map(contradicted).collect()
    }

    /// The displacement of each driven vertex at a phase, which is time over period.
    pub fn at(&self, phase: f64) -> Vec<Point> {
        let of = |(&place, part_of): (&Point, &Option<(usize, usize)>)| match part_of {
            None => [0.0; 3],
            Some((part, row)) => self.parts[*part].displacement(place, *row, phase),
        };
        self.places.iter().zip(&self.part_of).map(of).collect()
    }
}

impl Part {
    fn displacement(&self, place: Point, row: usize, phase: f64) -> Point {
        match self {
            Self::Stay => [0.0; 3],
            Self::Follow(motion, in_time) => motion.displacement(place, in_time.at(phase)),
            Self::Displace(by, in_time) => scale(by[row], in_time.at(phase)),
            Self::Frames(frames, is_periodic) => {
                let n = frames.len();
                // A phase of k / n is frame k, whatever its rounding error.
                let at = match is_periodic {
                    true => whole((phase - phase.floor()) * n as f64),
                    false => whole(phase.clamp(0.0, 1.0) * (n - 1) as f64),
                };
                let (k, part) = (at.floor() as usize, at - at.floor());
                let [a, b] = [k % n, (k + 1) % n].map(|k| frames[k][row]);
                if part == 0.0 { a } else { add(a, scale(sub(b, a), part)) }
            }
        }
    }
}

/// A number of frames, rounded if it is whole but for rounding error.
fn whole(x: f64) -> f64 {
    if (x - x.round()).abs() < 1e-9 { x.round() } else { x }
}

fn check_rows(rows: &[Point], vertices: &[VertexId]) -> Result<()> {
    match rows.len() == vertices.len() {
        true => Ok(()),
        false => Err(Error::input(format!("{} displacements for {} vertices", rows.len(), vertices.len()))),
    }
}

/// The unit normals at the vertices of some facets, outward from the volume if the facets are: area-weighted
/// means over the facets. The direction of a wall that swells.
pub fn normals(facets: &FacetSet, points: &[Point]) -> Vec<Point> {
    let mut sums = vec![[0.0; 3]; facets.vertices.len()];
    for triangle in facets.triangles() {
        let area = area_vector(triangle.map(|v| points[v.index()]));
        for v in triangle {
            if let Ok(i) = facets.vertices.binary_search(&v) {
                sums[i] = add(sums[i], area);
            }
        }
    }
    let unit = |v: Point| {
        let length = norm(v);
        if length > 0.0 { scale(v, 1.0 / length) } else { v }
    };
    sums.into_iter().map(unit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn courses_in_time_are_what_their_names_say() {
        assert_eq!([0.0, 0.5, 1.0, 2.5].map(|t| InTime::Beat.at(t)), [0.0, 1.0, 0.0, 1.0]);
        assert!((InTime::Swing.at(0.25) - 1.0).abs() < 1e-15 && (InTime::Swing.at(1.75) + 1.0).abs() < 1e-15);
        assert_eq!([0.0, 0.3, 1.0, 7.0].map(|t| InTime::Ramp.at(t)), [0.0, 0.3, 1.0, 1.0]);
        let table = InTime::Table(vec![[0.25, 1.0], [0.75, 3.0]]);
        assert_eq!([0.25, 0.5, 0.75, 0.0, 1.0, 0.875].map(|t| table.at(t)), [1.0, 2.0, 3.0, 2.0, 2.0, 2.5]);
        assert!(table.check().is_ok());
        for off in [
            vec![],
            vec![[0.0, 1.0]],
            vec![[0.5, 0.0], [0.5, 1.0]],
            vec![[0.0, 0.0], [1.5, 0.0]],
            vec![[0.0, 0.0], [1.0, f64::NAN]],
        ] {
            assert!(InTime::Table(off).check().is_err());
        }
    }

    #[test]
    fn frames_are_met_to_the_bit_and_the_first_part_named_is_followed() {
        let driven = [2, 4, 5].map(VertexId);
        let points = vec![[1.0; 3]; 6];
        let mut script = Script::still(&driven, &points);
        let frames: Vec<Vec<Point>> =
            (0..7).map(|k| vec![[0.1 * f64::from(k), 0.0, 0.0], [0.0, 1.0, 0.0]]).collect();
        assert_eq!(script.frames(&[4, 1].map(VertexId), frames.clone(), true).unwrap(), 1);
        assert_eq!(script.hold(&[4, 5].map(VertexId)), 1);
        assert_eq!(
            script.follow(&[2, 5].map(VertexId), Prescribed::Shift([0.0, 0.0, 2.0]), InTime::Ramp).unwrap(),
            1
        );
        for k in 0..21 {
            let at = script.at(f64::from(k) / 7.0);
            assert_eq!(at[1], frames[k as usize % 7][0]);
            assert_eq!(at[2], [0.0; 3]);
        }
        assert_eq!(script.at(0.5)[0], [0.0, 0.0, 1.0]);
        assert!((script.at(6.5 / 7.0)[1][0] - 0.3).abs() < 1e-15);
        // Vertex 4 follows frames, 5 stays; 2 and 4 obey earlier parts that move them differently from this
        // one.
        assert_eq!(script.follow(&driven, Prescribed::Shift([0.0, 0.0, 1.0]), InTime::Ramp).unwrap(), 0);
        assert_eq!(script.contradicted(), [2, 4].map(VertexId));
        assert_eq!(script.follow(&driven, Prescribed::Shift([0.0, 0.0, 2.0]), InTime::Ramp).unwrap(), 0);
        assert_eq!(script.contradicted(), [VertexId(4)]);
        assert!(script.frames(&driven, frames, false).is_err());
        assert!(script.go(&driven, vec![[0.0; 3]; 2], InTime::Beat).is_err());
    }
}
