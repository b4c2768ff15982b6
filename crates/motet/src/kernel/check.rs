//! The check of a change against everything that must never happen.

use std::fmt;

use crate::base::{TetId, VertexId};
use crate::geometry::predicates::orient3d;
use crate::geometry::tet::FACETS;
use crate::kernel::change::{Change, NewWall, VertexChange};
use crate::kernel::complex::Complex;
use crate::kernel::hold::Hold;
use crate::kernel::link::{Behind, HalfFacet, WallId};

/// Why a change is refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Reject {
    /// The worst quality of the fill is not above the bar.
    Quality {
        /// The bar.
        before: f64,
        /// The worst quality of the fill.
        after: f64,
    },
    /// A tet of the fill is flat or inverted.
    NotPositive([VertexId; 4]),
    /// A facet of the cavity's boundary has no tet of the fill behind it, or a facet of the fill has nothing
    /// behind it.
    Open([VertexId; 3]),
    /// More than two tets would share this facet, or two would lie on one side of it.
    Crowded([VertexId; 3]),
    /// An edge or a facet to be inserted exists already outside the cavity: possible only where tets overlap.
    Exists([VertexId; 2]),
    /// A wall that has to stay would be removed.
    Wall([VertexId; 3]),
    /// A tet would change its region.
    Region([VertexId; 3]),
    /// A vertex would be left without a tet, and is not declared removed.
    Vertex(VertexId),
    /// A constrained vertex would be moved or removed.
    Held(VertexId),
    /// A locked tet would be removed.
    Locked(TetId),
    /// An edge that must stay would be removed.
    Edge([VertexId; 2]),
}

impl fmt::Display for Reject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Quality { before, after } => {
                write!(f, "the worst quality would go from {before} to {after}")
            }
            Self::NotPositive(tet) => write!(f, "the tet {tet:?} would not be positive"),
            Self::Open(facet) => write!(f, "the facet {facet:?} would have nothing behind it"),
            Self::Crowded(facet) => write!(f, "too many tets would share the facet {facet:?}"),
            Self::Exists(edge) => write!(f, "the edge {edge:?}, or a facet with it, exists already"),
            Self::Wall(facet) => write!(f, "the wall {facet:?} would be lost"),
            Self::Region(facet) => write!(f, "tets would change their region at {facet:?}"),
            Self::Vertex(v) => write!(f, "vertex {v} would be lost"),
            Self::Held(v) => write!(f, "vertex {v} is held"),
            Self::Locked(tet) => write!(f, "tet {tet} is locked"),
            Self::Edge(edge) => write!(f, "the edge {edge:?} would be lost"),
        }
    }
}

/// A change that passed the check, and how its tets are joined: the input of [`Complex::commit`].
#[derive(Debug)]
pub struct Checked<'a> {
    pub(super) change: &'a Change,
    pub(super) joints: Vec<Joint>,
    pub(super) lost_walls: Vec<WallId>,
    /// The edges of lost lines, lower vertex first.
    pub(super) lost_lines: Vec<[VertexId; 2]>,
}

/// How one facet of the fill is joined to what lies behind it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Joint {
    /// Two tets of the fill.
    Inner([FillFacet; 2]),
    /// A tet of the fill and one outside.
    Outer(FillFacet, HalfFacet),
    /// A tet of the fill at a wall, in place of this facet of a cavity tet.
    AtWall(FillFacet, WallId, HalfFacet),
    /// A wall within the cavity, with a tet of the fill in place of each of its sides.
    InnerWall([FillFacet; 2], WallId),
    /// A new wall, with one or two tets of the fill.
    NewWall(FillFacet, Option<FillFacet>, NewWall),
    /// A new wall on a tet outside, with a tet of the fill on its other side or nothing.
    Exposed(HalfFacet, Option<FillFacet>, NewWall),
}

/// A tet of the fill, by index, and one of its facets.
#[derive(Clone, Copy, Debug)]
pub(super) struct FillFacet {
    pub(super) tet: u32,
    pub(super) facet: u8,
}

/// One use of a facet, in the sorted list where all uses of a facet are adjacent.
#[derive(Clone, Copy, Debug)]
struct Use {
    /// The vertices of the facet, sorted.
    key: [VertexId; 3],
    /// Whether `key` is an even permutation of the facet as seen from outside its tet.
    is_even: bool,
    role: Role,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Role {
    /// A facet between the cavity and a tet outside.
    Outer(HalfFacet, HalfFacet),
    /// A wall of the cavity whose other side is not in the cavity.
    AtWall(HalfFacet, WallId),
    /// A wall with the cavity on both sides.
    InnerWall(HalfFacet, WallId),
    /// A new wall, by index.
    NewWall(u32),
    /// A facet of the fill.
    Fill(u32, u8),
}

impl Complex {
    /// Checks a change that has to raise the worst quality.
    ///
    /// # Errors
    /// The first reason to refuse it.
    pub fn check<'a>(&self, change: &'a Change) -> Result<Checked<'a>, Reject> {
        self.check_against(change, self.worst_of(&change.cavity))
    }

    /// Checks a change whose worst quality has to be above `bar`.
    ///
    /// # Errors
    /// The first reason to refuse it.
    pub fn check_against<'a>(&self, change: &'a Change, bar: f64) -> Result<Checked<'a>, Reject> {
        let after = change.worst();
        if after <= bar {
            return Err(Reject::Quality { before: bar, after });
        }
        if let Some(&tet) = change.cavity.iter().find(|&&t| self.is_locked(t)) {
            return Err(Reject::Locked(tet));
        }
        self.check_held(change)?;
        for tet in &change.fill {
            let [a, b, c, d] = change.corners(self, tet.vertices);
            if orient3d(a, b, c, d) <= 0 {
                return Err(Reject::NotPositive(tet.vertices));
            }
        }
        if !self.overlaps.is_tangled && self.is_move(change) {
            return Ok(self.join_as_before(change));
        }
        self.check_vertices(change)?;
        let lost_lines = self.check_edges(change)?;
        if self.overlaps.is_tangled {
            self.check_existing(change)?;
        }
        Ok(Checked { lost_lines, ..self.join(change)? })
    }

    /// The lowest quality of some tets.
    pub fn worst_of(&self, tets: &[TetId]) -> f64 {
        tets.iter().map(|&t| self.quality(t)).fold(f64::INFINITY, f64::min)
    }

    fn check_held(&self, change: &Change) -> Result<(), Reject> {
        let moved = match change.vertex {
            VertexChange::Move(v, _) | VertexChange::Remove(v) => Some(v),
            _ => None,
        };
        let is_held = |v: VertexId| match self.keeps_surface() {
            true => self.hold(v) != Hold::Free,
            false => self.hold(v) == Hold::Fixed,
        };
        if let Some(v) = moved.filter(|&v| is_held(v)) {
            return Err(Reject::Held(v));
        }
        // Where tets overlap, the tets of a vertex may be connected by the vertex only: no walk through
        // facets finds all of them.
        if let Some(v) = moved.filter(|_| self.overlaps.is_tangled) {
            let n = change.cavity.iter().filter(|&&t| self.vertices(t).contains(&v)).count();
            if n != self.overlaps.n_tets(v) {
                return Err(Reject::Vertex(v));
            }
        }
        Ok(())
    }

    fn check_vertices(&self, change: &Change) -> Result<(), Reject> {
        let removed = match change.vertex {
            VertexChange::Remove(v) => Some(v),
            _ => None,
        };
        for v in change.cavity.iter().flat_map(|&t| self.vertices(t)) {
            let is_in_fill = change.fill.iter().any(|tet| tet.vertices.contains(&v));
            if is_in_fill == (removed == Some(v)) {
                return Err(Reject::Vertex(v));
            }
        }
        Ok(())
    }

    /// Joins every facet of the fill to what lies behind it.
    pub(super) fn join<'a>(&self, change: &'a Change) -> Result<Checked<'a>, Reject> {
        let mut uses = self.uses(change);
        uses.sort_unstable_by_key(|u| (u.key, u.role));
        let joints = Vec::with_capacity(uses.len());
        let mut checked = Checked { change, joints, lost_walls: Vec::new(), lost_lines: Vec::new() };
        for same in uses.chunk_by(|x, y| x.key == y.key) {
            self.join_facet(same, &mut checked)?;
        }
        Ok(checked)
    }

    fn join_facet(&self, uses: &[Use], checked: &mut Checked) -> Result<(), Reject> {
        let change = checked.change;
        let key = uses[0].key;
        let part = |u: &Use| match u.role {
            Role::Fill(tet, facet) => FillFacet { tet, facet },
            _ => unreachable!("roles are matched below"),
        };
        let region = |u: &Use| match u.role {
            Role::Fill(tet, _) => change.fill[tet as usize].region,
            Role::Outer(half, _) | Role::AtWall(half, _) | Role::InnerWall(half, _) => {
                self.region(half.tet())
            }
            Role::NewWall(_) => unreachable!("a wall to come has no region"),
        };
        let agree = |x: &Use, y: &Use| if region(x) == region(y) { Ok(()) } else { Err(Reject::Region(key)) };
        let (same_side, two_sides) = (
            |x: &Use, y: &Use| if x.is_even == y.is_even { Ok(()) } else { Err(Reject::Crowded(key)) },
            |x: &Use, y: &Use| if x.is_even != y.is_even { Ok(()) } else { Err(Reject::Crowded(key)) },
        );
        use Role::{AtWall, Fill, InnerWall, NewWall, Outer};
        let joint = match uses {
            [x @ Use { role: Outer(_, outside), .. }, y @ Use { role: Fill(..), .. }] => {
                same_side(x, y).and(agree(x, y))?;
                Joint::Outer(part(y), *outside)
            }
            [x @ Use { role: AtWall(half, wall), .. }, y @ Use { role: Fill(..), .. }] => {
                same_side(x, y).and(agree(x, y))?;
                Joint::AtWall(part(y), *wall, *half)
            }
            [x @ Use { role: Fill(..), .. }, y @ Use { role: Fill(..), .. }] => {
                two_sides(x, y).and(agree(x, y))?;
                Joint::Inner([part(x), part(y)])
            }
            [
                v @ Use { role: InnerWall(half, wall), .. },
                w @ Use { role: InnerWall(..), .. },
                x @ Use { role: Fill(..), .. },
                y @ Use { role: Fill(..), .. },
            ] => {
                two_sides(x, y)?;
                let (x, y) = if x.is_even == v.is_even { (x, y) } else { (y, x) };
                agree(v, x).and(agree(w, y))?;
                let is_first = self.wall(*wall).sides[0] == *half;
                let sides = if is_first { [part(x), part(y)] } else { [part(y), part(x)] };
                Joint::InnerWall(sides, *wall)
            }
            // Walls change only where the surface may.
            _ if self.keeps_surface() => return Err(self.refusal(uses)),
            [Use { role: AtWall(_, wall), .. }]
            | [Use { role: InnerWall(_, wall), .. }, Use { role: InnerWall(..), .. }] => {
                if self.is_fixed_wall(*wall) {
                    return Err(Reject::Wall(key));
                }
                checked.lost_walls.push(*wall);
                return Ok(());
            }
            [Use { role: NewWall(wall), .. }, x @ Use { role: Fill(..), .. }] => {
                Joint::NewWall(part(x), None, change.walls[*wall as usize])
            }
            [
                Use { role: NewWall(wall), .. },
                x @ Use { role: Fill(..), .. },
                y @ Use { role: Fill(..), .. },
            ] => {
                two_sides(x, y)?;
                Joint::NewWall(part(x), Some(part(y)), change.walls[*wall as usize])
            }
            [Use { role: Outer(_, outside), .. }, Use { role: NewWall(wall), .. }] => {
                Joint::Exposed(*outside, None, change.walls[*wall as usize])
            }
            [
                x @ Use { role: Outer(_, outside), .. },
                Use { role: NewWall(wall), .. },
                y @ Use { role: Fill(..), .. },
            ] => {
                same_side(x, y)?;
                Joint::Exposed(*outside, Some(part(y)), change.walls[*wall as usize])
            }
            _ => return Err(self.refusal(uses)),
        };
        checked.joints.push(joint);
        Ok(())
    }

    fn refusal(&self, uses: &[Use]) -> Reject {
        let key = uses[0].key;
        let is_wall = |u: &Use| matches!(u.role, Role::AtWall(..) | Role::InnerWall(..) | Role::NewWall(_));
        match uses.len() {
            _ if uses.iter().any(is_wall) => Reject::Wall(key),
            1 => Reject::Open(key),
            _ => Reject::Crowded(key),
        }
    }

    fn uses(&self, change: &Change) -> Vec<Use> {
        let mut uses = Vec::with_capacity(4 * (change.cavity.len() + change.fill.len()));
        let mut cavity = change.cavity.clone();
        cavity.sort_unstable();
        let is_inside = |half: HalfFacet| !half.is_none() && cavity.binary_search(&half.tet()).is_ok();
        for half in change.cavity.iter().flat_map(|&t| (0..4).map(move |i| HalfFacet::new(t, i))) {
            let role = match self.behind(half.tet(), half.facet()) {
                Behind::Tet(other) if is_inside(other) => continue,
                Behind::Tet(other) => Role::Outer(half, other),
                Behind::Wall(wall) if is_inside(self.wall(wall).other(half)) => Role::InnerWall(half, wall),
                Behind::Wall(wall) => Role::AtWall(half, wall),
            };
            uses.push(Use::new(self.facet(half), role));
        }
        for (place, wall) in (0..).zip(&change.walls) {
            uses.push(Use::new(wall.vertices, Role::NewWall(place)));
        }
        for (place, tet) in (0..).zip(&change.fill) {
            for (i, facet) in (0..).zip(FACETS) {
                uses.push(Use::new(facet.map(|corner| tet.vertices[corner]), Role::Fill(place, i)));
            }
        }
        uses
    }
}

impl Use {
    #[inline]
    fn new([a, b, c]: [VertexId; 3], role: Role) -> Self {
        let (x, y, first) = if a < b { (a, b, true) } else { (b, a, false) };
        let (key, is_even) = if c > y {
            ([x, y, c], first)
        } else if c > x {
            ([x, c, y], !first)
        } else {
            ([c, x, y], first)
        };
        Self { key, is_even, role }
    }
}
