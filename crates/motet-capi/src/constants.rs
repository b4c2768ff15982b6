//! The constants of `motet.h` and what each stands for. Numbers are part of the C interface: a number keeps
//! its meaning, and a new constant gets a new number.

use motet::contact::Room;
use motet::implant::{Adapt, Inside};
use motet::mesh::history::Rule;
use motet::motion::MethodName;
use motet::remesh::SurfaceName;
use motet::{Error, Result};

use crate::memory::optional;

/// A constant of the header.
pub(crate) struct Constant<T> {
    /// The name in the header.
    pub(crate) name: &'static str,
    /// The number in the header.
    pub(crate) number: i32,
    /// What the constant stands for in the library.
    pub(crate) meaning: T,
}

/// A constant by its name, its number and its meaning.
const fn constant<T>(name: &'static str, number: i32, meaning: T) -> Constant<T> {
    Constant { name, number, meaning }
}

pub(crate) const OK: i32 = 0;
pub(crate) const INTERNAL: i32 = 1;
pub(crate) const OPTIONS: i32 = 2;
pub(crate) const INPUT: i32 = 3;
pub(crate) const IO: i32 = 4;
pub(crate) const STOPPED: i32 = 5;

/// What the rows of an array belong to.
#[derive(Clone, Copy)]
pub(crate) enum On {
    /// A row for each point.
    Points,
    /// A row for each cell.
    Cells,
}

pub(crate) const ON: &[Constant<On>] =
    &[constant("MOTET_ON_POINTS", 0, On::Points), constant("MOTET_ON_CELLS", 1, On::Cells)];

/// Methods of motion.
pub(crate) const METHODS: &[Constant<MethodName>] = &[
    constant("MOTET_DELAUNAY", 0, MethodName::Delaunay),
    constant("MOTET_BODIES", 1, MethodName::Bodies),
    constant("MOTET_GUIDED", 2, MethodName::Guided),
    constant("MOTET_ELASTIC", 3, MethodName::Elastic),
    constant("MOTET_LAPLACE", 4, MethodName::Laplace),
    constant("MOTET_IDW", 5, MethodName::Idw),
    constant("MOTET_RBF", 6, MethodName::Rbf),
];

/// The rule by which an array is transferred, which depends on what its rows belong to.
pub(crate) struct TransferRule {
    on_points: Rule,
    on_cells: Rule,
}

pub(crate) const RULES: &[Constant<TransferRule>] = &[
    constant("MOTET_RULE_MEAN", 0, TransferRule { on_points: Rule::Interpolate, on_cells: Rule::Conserve }),
    constant("MOTET_RULE_INHERIT", 1, TransferRule { on_points: Rule::Inherit, on_cells: Rule::Inherit }),
    constant("MOTET_RULE_LINEAR", 2, TransferRule { on_points: Rule::Linear, on_cells: Rule::Conserve }),
];

pub(crate) const SURFACE_RULES: &[Constant<SurfaceName>] = &[
    constant("MOTET_SURFACE_KEEP", 0, SurfaceName::Keep),
    constant("MOTET_SURFACE_ADAPT", 1, SurfaceName::Adapt),
    constant("MOTET_SURFACE_LOOSE", 2, SurfaceName::Loose),
];

pub(crate) const INSIDES: &[Constant<Inside>] = &[
    constant("MOTET_INSIDE_OWN", 0, Inside::Own),
    constant("MOTET_INSIDE_FILLED", 1, Inside::Filled),
    constant("MOTET_INSIDE_HOLLOW", 2, Inside::Hollow),
];

pub(crate) const ADAPTS: &[Constant<Adapt>] = &[
    constant("MOTET_ADAPT_NO", 0, Adapt::No),
    constant("MOTET_ADAPT_WALLS", 1, Adapt::Walls),
    constant("MOTET_ADAPT_ALL", 2, Adapt::All),
];

pub(crate) const ROOMS: &[Constant<Room>] = &[
    constant("MOTET_ROOM_FOUND", -1, Room::Found),
    constant("MOTET_ROOM_NO", 0, Room::No),
    constant("MOTET_ROOM_YES", 1, Room::Yes),
];

/// The meaning of a number passed from C; an error that lists the constants where none has this number.
fn meaning<T>(constants: &'static [Constant<T>], number: i32, what: &str) -> Result<&'static T> {
    let found = constants.iter().find(|constant| constant.number == number);
    found.map(|constant| &constant.meaning).ok_or_else(|| {
        let known: Vec<String> =
            constants.iter().map(|constant| format!("{} ({})", constant.name, constant.number)).collect();
        Error::options(format!("unknown {what} {number}")).remedy(format!("give one of {}", known.join(", ")))
    })
}

/// What rows belong to.
pub(crate) fn on(number: i32) -> Result<On> {
    meaning(ON, number, "value of `on`").copied()
}

/// A method of motion.
pub(crate) fn method(number: i32) -> Result<MethodName> {
    meaning(METHODS, number, "method").copied()
}

/// How an array is transferred.
pub(crate) fn transfer_rule(number: i32, on: On) -> Result<Rule> {
    let rule = meaning(RULES, number, "rule")?;
    Ok(match on {
        On::Points => rule.on_points,
        On::Cells => rule.on_cells,
    })
}

/// What a repair may do to walls, and how far they may stray; where walls are kept, the distance has no
/// effect.
pub(crate) fn surface_rule(number: i32, distance: f64) -> Result<(SurfaceName, Option<f64>)> {
    let rule = *meaning(SURFACE_RULES, number, "surface rule")?;
    Ok((rule, optional(distance).filter(|_| rule != SurfaceName::Keep)))
}

/// What becomes of the space in a device.
pub(crate) fn inside(number: i32) -> Result<Inside> {
    meaning(INSIDES, number, "value of `inside`").copied()
}

/// What of the host is refined first.
pub(crate) fn adapt(number: i32) -> Result<Adapt> {
    meaning(ADAPTS, number, "value of `adapt`").copied()
}

/// Whether a body is a room.
pub(crate) fn room(number: i32) -> Result<Room> {
    meaning(ROOMS, number, "value of `is_room`").cloned()
}
