//! Why a tet is still bad: what of the surface keeps it so, or that nothing was found to help.

use std::fmt;

use serde::Serialize;

use crate::base::{Point, TetId};
use crate::geometry::quality::{dihedral, eas};
use crate::geometry::tet::{EDGES, FACETS, centroid};
use crate::geometry::vector::{cross, dot, norm, sub};
use crate::kernel::{Complex, Hold, Shell};
use crate::remesh::classify::{DEFECT_NAMES, classify};

/// A bad tet that is left.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Left {
    /// Which tet of the new mesh.
    pub tet: u32,
    /// Its EAS.
    pub eas: f64,
    /// Its centre.
    pub place: Point,
    /// Its type: "I" to "IV", or "other".
    pub defect: &'static str,
    /// Why it is left.
    pub reason: Reason,
}

/// Why a bad tet is left.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// One of its facets is a wall whose smallest or largest angle allows no better tet on it.
    WallAngle {
        /// The angle, in degrees.
        degrees: f64,
        /// The highest EAS that a tet on such a wall can have.
        best_eas: f64,
    },
    /// Walls meet at one of its edges at an angle that allows no better tet between them.
    WallsMeet {
        /// The angle, in degrees.
        degrees: f64,
        /// The highest EAS that a tet in such an angle can have.
        best_eas: f64,
    },
    /// All its vertices are held, and no change of its edges and facets raises the worst quality.
    AllHeld,
    /// No operation raises the worst quality round it.
    NothingHelps,
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WallAngle { degrees, best_eas } => {
                write!(
                    f,
                    "a wall of it has an angle of {degrees:.2} degrees: no tet on it can have an EAS above {best_eas:.3}"
                )
            }
            Self::WallsMeet { degrees, best_eas } => {
                write!(
                    f,
                    "walls meet at it at {degrees:.2} degrees: no tet between can have an EAS above {best_eas:.3}"
                )
            }
            Self::AllHeld => write!(f, "all four vertices are held by the surface, and no swap helps"),
            Self::NothingHelps => write!(f, "no operation raises the worst quality round it"),
        }
    }
}

/// What is left, and why; `new_id` tells which tet of the new mesh each is.
pub(super) fn explain(
    complex: &Complex,
    left: &[TetId],
    min_eas: f64,
    new_id: impl Fn(TetId) -> u32,
) -> Vec<Left> {
    let mut shell = Shell::default();
    let of = |&tet: &TetId| {
        let corners = complex.corners(tet);
        Left {
            tet: new_id(tet),
            eas: eas(corners),
            place: centroid(corners),
            defect: DEFECT_NAMES[classify(corners).number()],
            reason: reason(complex, tet, min_eas, &mut shell),
        }
    };
    left.iter().map(of).collect()
}

fn reason(complex: &Complex, tet: TetId, min_eas: f64, shell: &mut Shell) -> Reason {
    let corners = complex.corners(tet);
    for facet in (0..4).filter(|&i| complex.is_wall(tet, i)) {
        let (degrees, best_eas) = best_on_wall(FACETS[facet].map(|i| corners[i]));
        if best_eas < min_eas {
            return Reason::WallAngle { degrees, best_eas };
        }
    }
    for [i, j] in EDGES {
        let vertices = complex.vertices(tet);
        shell.walk(complex, tet, vertices[i], vertices[j]);
        if let Some((degrees, best_eas)) =
            best_between_walls(complex, tet, shell, [i, j]).filter(|b| b.1 < min_eas)
        {
            return Reason::WallsMeet { degrees, best_eas };
        }
    }
    match complex.vertices(tet).into_iter().all(|v| complex.hold(v) != Hold::Free) {
        true => Reason::AllHeld,
        false => Reason::NothingHelps,
    }
}

/// The angle of a triangle that is farthest from 60 degrees, and what it leaves of the EAS.
fn best_on_wall([a, b, c]: [Point; 3]) -> (f64, f64) {
    let angle = |p: Point, q: Point, r: Point| {
        let (u, v) = (sub(q, p), sub(r, p));
        norm(cross(u, v)).atan2(dot(u, v)).to_degrees()
    };
    let quality = |degrees: f64| if degrees < 60.0 { degrees / 60.0 } else { (180.0 - degrees) / 120.0 };
    let angles = [angle(a, b, c), angle(b, c, a), angle(c, a, b)].map(|degrees| (degrees, quality(degrees)));
    angles.into_iter().min_by(|x, y| x.1.total_cmp(&y.1)).unwrap_or_default()
}

/// The angle between the walls on both sides of a tet at one of its edges, and what it leaves of the EAS: a tet there has no
/// larger one.
fn best_between_walls(complex: &Complex, tet: TetId, shell: &Shell, edge: [usize; 2]) -> Option<(f64, f64)> {
    let (m, at) = (shell.tets.len(), shell.tets.iter().position(|&t| t == tet)?);
    let [first, .., last] = shell.walls[..] else { return None };
    // The walls on both sides: tet i lies between the ring places i and i + 1.
    let before = shell.walls.iter().copied().rfind(|&w| w <= at).unwrap_or(last);
    let after = shell.walls.iter().copied().find(|&w| w > at).unwrap_or(first + m);
    let n = (after + m - before) % m;
    let tets = (0..if n == 0 { m } else { n }).map(|i| shell.tets[(before + i) % m]);
    let vertices = edge.map(|i| complex.vertices(tet)[i]);
    let degrees: f64 = tets
        .map(|t| {
            let places = vertices.map(|v| complex.place(t, v));
            let e = EDGES.iter().position(|e| places.iter().all(|p| e.contains(p))).unwrap_or(0);
            dihedral::angles(complex.corners(t))[e].to_degrees()
        })
        .sum();
    let regular = (1.0f64 / 3.0).acos().to_degrees();
    Some((degrees, degrees / regular))
}
