//! Why a tet is still bad: which part of the surface forces it, or that no operation was found to help.

use std::fmt;

use serde::Serialize;

use crate::base::{CellId, Point, TetId};
use crate::geometry::quality::{dihedral, eas, highest_eas};
use crate::geometry::tent::Tent;
use crate::geometry::tet::{EDGES, FACETS, centroid};
use crate::geometry::triangle;
use crate::kernel::{Complex, Hold, Shell, Star, is_reached};
use crate::remesh::classify::{DEFECT_NAMES, classify};
use crate::remesh::surface::Surface;

/// A bad tet that is left.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Left<Tet = CellId> {
    /// The tet: as a cell of a whole mesh, or as a tet of a mesh of tets.
    pub tet: Tet,
    /// EAS of the tet.
    pub eas: f64,
    /// Centroid of the tet.
    pub place: Point,
    /// Type of the tet: "I" to "IV", or "other".
    pub defect: &'static str,
    /// Why it is left.
    pub reason: Reason,
}

impl<Tet> Left<Tet> {
    /// The bad tet as a cell of a whole mesh: `cell` gives that of a tet.
    pub(super) fn in_cells(self, cell: impl Fn(Tet) -> CellId) -> Left {
        let Self { tet, eas, place, defect, reason } = self;
        Left { tet: cell(tet), eas, place, defect, reason }
    }
}

/// Why a bad tet is left.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
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
    /// A wall stands so close above one of its facets, itself a wall, that no better tet fits between them.
    WallNear {
        /// The angle of the tent over the facet that the near wall leaves, in degrees: no tet on the facet
        /// has all three dihedral angles there larger than this.
        degrees: f64,
        /// The highest EAS that a tet on that facet can have.
        best_eas: f64,
    },
    /// All its vertices are held, and no change of its edges and facets raises the worst quality.
    AllHeld,
    /// No operation raises the worst quality around it.
    NothingHelps,
}

impl Reason {
    /// Whether walls rule out a good tet there.
    pub fn is_forced(&self) -> bool {
        matches!(self, Self::WallAngle { .. } | Self::WallsMeet { .. } | Self::WallNear { .. })
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WallAngle { degrees, best_eas } => {
                write!(
                    f,
                    "one of its walls has an angle of {degrees:.2} degrees: \
                     no tet on that wall can have an EAS above {best_eas:.3}"
                )
            }
            Self::WallsMeet { degrees, best_eas } => {
                write!(
                    f,
                    "walls meet at {degrees:.2} degrees at one of its edges: \
                     no tet between them can have an EAS above {best_eas:.3}"
                )
            }
            Self::WallNear { degrees, best_eas } => {
                write!(
                    f,
                    "a wall is so close to one of its walls \
                     that dihedral angles are limited to {degrees:.2} degrees: \
                     no tet between them can have an EAS above {best_eas:.3}"
                )
            }
            Self::AllHeld => write!(f, "all four vertices are held by the surface, and no swap helps"),
            Self::NothingHelps => write!(f, "no operation raises the worst quality around it"),
        }
    }
}

/// Explains each bad tet in `left`; `new_id` gives the id of a tet in the new mesh.
pub(super) fn explain(
    complex: &Complex,
    left: &[TetId],
    min_eas: f64,
    new_id: impl Fn(TetId) -> TetId,
) -> Vec<Left<TetId>> {
    let (mut shell, mut star) = (Shell::default(), Star::default());
    let of = |&tet: &TetId| {
        let corners = complex.corners(tet);
        Left {
            tet: new_id(tet),
            eas: eas(corners),
            place: centroid(corners),
            defect: DEFECT_NAMES[classify(corners).number()],
            reason: reason(complex, tet, min_eas, &mut shell, &mut star),
        }
    };
    left.iter().map(of).collect()
}

fn reason(complex: &Complex, tet: TetId, min_eas: f64, shell: &mut Shell, star: &mut Star) -> Reason {
    let least = |bounds: &mut dyn Iterator<Item = (f64, f64)>| {
        bounds.filter(|b| b.1 < min_eas).min_by(|x, y| x.1.total_cmp(&y.1))
    };
    if let Some((degrees, best_eas)) = least(&mut wall_bounds(complex, tet).map(|wall| wall.bound)) {
        return Reason::WallAngle { degrees, best_eas };
    }
    if let Some((degrees, best_eas)) = least(&mut edge_bounds(complex, tet, shell).into_iter()) {
        return Reason::WallsMeet { degrees, best_eas };
    }
    if let Some((degrees, best_eas)) = least(&mut tent_bounds(complex, tet, star).into_iter()) {
        return Reason::WallNear { degrees, best_eas };
    }
    match complex.vertices(tet).into_iter().all(|v| complex.hold(v) != Hold::Free) {
        true => Reason::AllHeld,
        false => Reason::NothingHelps,
    }
}

/// The tets of a list that are as good as the walls at them allow. Where the `surface` may change, the angle
/// of a wall forces a tet only if it lies between two features.
pub(super) fn forced(complex: &Complex, surface: Option<&Surface>, tets: &[TetId]) -> Vec<TetId> {
    let mut shell = Shell::default();
    tets.iter().copied().filter(|&tet| is_forced(complex, surface, tet, &mut shell)).collect()
}

/// Whether a tet is as good as the walls at it allow: see [`forced`].
pub(super) fn is_forced(complex: &Complex, surface: Option<&Surface>, tet: TetId, shell: &mut Shell) -> bool {
    let quality = complex.quality(tet);
    let vertices = complex.vertices(tet);
    let mut is_firm = |[at, p, q]: [usize; 3]| {
        surface.is_none_or(|surface| {
            [p, q].into_iter().all(|end| {
                let edge = [vertices[at], vertices[end]];
                shell.walk(complex, tet, edge[0], edge[1]);
                !surface.is_smooth(complex, edge, shell)
            })
        })
    };
    wall_bounds(complex, tet).any(|wall| is_reached(quality, wall.bound.1) && is_firm(wall.corner))
        || edge_bounds(complex, tet, shell).into_iter().any(|bound| is_reached(quality, bound.1))
}

/// How the angle of a wall limits a tet on it.
struct WallBound {
    /// The angle in degrees, and the highest EAS that it allows.
    bound: (f64, f64),
    /// Local numbers in the tet of the vertex at the angle and of the other two vertices of the wall.
    corner: [usize; 3],
}

/// For each wall of a tet, the angle that limits its EAS most: the one farthest from 60 degrees.
fn wall_bounds(complex: &Complex, tet: TetId) -> impl Iterator<Item = WallBound> {
    let corners = complex.corners(tet);
    let of_wall = move |i: usize| {
        let [a, b, c] = FACETS[i];
        let bounds = [[a, b, c], [b, c, a], [c, a, b]].map(|corner| {
            let [p, q, r] = corner.map(|place| corners[place]);
            let degrees = triangle::angle_at([p, q, r], 0).to_degrees();
            WallBound { bound: (degrees, highest_eas(degrees)), corner }
        });
        bounds.into_iter().min_by(|x, y| x.bound.1.total_cmp(&y.bound.1))
    };
    let walls: Vec<usize> = (0..4).filter(|&i| complex.is_wall(tet, i)).collect();
    walls.into_iter().filter_map(of_wall)
}

/// For each edge of a tet at which walls meet on both sides of it: their angle in degrees, and the highest
/// EAS of a tet between them.
fn edge_bounds(complex: &Complex, tet: TetId, shell: &mut Shell) -> Vec<(f64, f64)> {
    let vertices = complex.vertices(tet);
    let mut bounds = Vec::new();
    for [i, j] in EDGES {
        shell.walk(complex, tet, vertices[i], vertices[j]);
        bounds.extend(best_between_walls(complex, tet, shell, [i, j]));
    }
    bounds
}

/// The angle in degrees between the walls on both sides of a tet at one of its edges, and the highest EAS
/// that a tet there can have.
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
    Some((degrees, degrees / dihedral::REGULAR.to_degrees()))
}

/// For each wall of a tet: the angle, in degrees, of the tent over it that other walls of the neighbouring
/// tets leave, and the highest EAS of a tet on it. A tet whose dihedral angles there are all larger would
/// contain part of a wall. Only walls that have to stay count: all of them if the surface is kept, otherwise
/// those between fixed vertices.
fn tent_bounds(complex: &Complex, tet: TetId, star: &mut Star) -> Vec<(f64, f64)> {
    let stays = |tet: TetId, i: usize| {
        let vertices = complex.vertices(tet);
        let is_fixed = |&k: &usize| complex.hold(vertices[k]) == Hold::Fixed;
        complex.is_wall(tet, i) && (complex.keeps_surface() || FACETS[i].iter().all(is_fixed))
    };
    let facet = |tet: TetId, i: usize| FACETS[i].map(|k| complex.corners(tet)[k]);
    let bases: Vec<usize> = (0..4).filter(|&i| stays(tet, i)).collect();
    if bases.is_empty() {
        return Vec::new();
    }
    let mut walls = Vec::new();
    for vertex in complex.vertices(tet) {
        star.gather(complex, vertex);
        for &near in &star.tets {
            walls.extend((0..4).filter(|&i| stays(near, i)).map(|i| facet(near, i)));
        }
    }
    let bound = |i: usize| {
        // Facets are counter-clockwise seen from outside the tet.
        let [a, b, c] = facet(tet, i);
        let tent = Tent::over([a, c, b])?;
        let angle = walls.iter().filter_map(|wall| tent.angle_below(*wall)).reduce(f64::min)?;
        Some((angle.to_degrees(), angle / dihedral::REGULAR))
    };
    bases.into_iter().filter_map(bound).collect()
}
