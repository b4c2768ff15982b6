//! The elements or points of boundary conditions.

use crate::base::Result;
use crate::io::cgns::node::Node;
use crate::io::format::Notes;

/// A boundary condition of a zone.
pub(super) struct Condition {
    pub(super) name: String,
    pub(super) family: Option<String>,
    pub(super) members: Members,
}

/// What a condition or a solution is defined on.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Members {
    /// Elements, by their numbers.
    Elements(Numbers),
    /// Points, by their numbers.
    Points(Numbers),
}

/// Numbers of elements or points, from 1.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Numbers {
    /// Individual numbers.
    List(Vec<i64>),
    /// From the first number to the last, inclusive.
    Range(i64, i64),
}

impl Numbers {
    /// The numbers from `first` to `last`, inclusive.
    pub(super) fn within(&self, first: i64, last: i64) -> Box<dyn Iterator<Item = i64> + '_> {
        match self {
            Self::List(all) => Box::new(all.iter().copied().filter(move |n| (first..=last).contains(n))),
            Self::Range(from, to) => Box::new(first.max(*from)..=last.min(*to)),
        }
    }

    /// Reads the list or range of a node; `None` if it has neither.
    pub(super) fn of(node: &Node, list: &str, range: &str) -> Result<Option<Self>> {
        if let Some(list) = node.child(list)? {
            return Ok(Some(Self::List(list.ints()?)));
        }
        let Some(range) = node.child(range)? else { return Ok(None) };
        match range.ints()?.as_slice() {
            &[first, last] => Ok(Some(Self::Range(first.min(last), first.max(last)))),
            _ => Err(range.error("range: expected two numbers")),
        }
    }
}

/// Whether a condition or solution is on points, which is the default.
pub(super) fn is_on_points(node: &Node) -> Result<bool> {
    Ok(node.text_of("GridLocation_t")?.is_none_or(|place| place == "Vertex"))
}

/// The boundary conditions of a zone.
pub(super) fn conditions(zone: &Node, notes: &Notes) -> Result<Vec<Condition>> {
    let mut all = Vec::new();
    for conditions in zone.children_of("ZoneBC_t")? {
        for node in conditions.children_of("BC_t")? {
            match members(&node)? {
                Some(members) => all.push(Condition {
                    family: node.text_of("FamilyName_t")?.filter(|name| !name.is_empty()),
                    name: node.name,
                    members,
                }),
                None => notes.add(format!("{} has neither elements nor points: skipped", node.path())),
            }
        }
    }
    Ok(all)
}

fn members(node: &Node) -> Result<Option<Members>> {
    if let Some(numbers) = Numbers::of(node, "PointList", "PointRange")? {
        let is_on_points = is_on_points(node)?;
        return Ok(Some(if is_on_points { Members::Points(numbers) } else { Members::Elements(numbers) }));
    }
    // The form used before version 3.
    Ok(Numbers::of(node, "ElementList", "ElementRange")?.map(Members::Elements))
}
