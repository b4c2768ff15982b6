//! The report of a preflight: the certificate.

use std::fmt;

use serde::Serialize;

use super::fault::{Fault, FaultKind};
use super::narrow::Narrow;
use super::rims::{OpenEdges, Rim};
use super::surfaces::Surfaces;
use crate::base::Error;

/// Number of rims that an error names.
const MAX_RIMS_IN_ERROR: usize = 4;

/// The number of faults of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct FaultCount {
    /// The kind.
    #[serde(rename = "name")]
    pub kind: FaultKind,
    /// Number of those that prevent meshing.
    pub fatal: usize,
    /// Number of those that do not.
    pub notes: usize,
}

/// The faults of surfaces that are to be meshed, sorted by kind, then by triangles and vertices.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Preflight {
    /// Number of surfaces.
    pub n_surfaces: usize,
    /// Number of triangles of all surfaces together.
    pub n_triangles: usize,
    /// Number of points that no triangle uses.
    pub n_orphans: usize,
    /// The rims of surfaces that have to be closed, the longest first.
    pub rims: Vec<Rim>,
    /// Number of open edges of such surfaces that are in no rim, since triangles there do not face the same
    /// side.
    pub n_torn_edges: usize,
    /// The kinds that occur, with their counts.
    pub counts: Vec<FaultCount>,
    /// The triangles that force bad tets, if there are any.
    pub narrow: Option<Narrow>,
    /// Every fault.
    pub faults: Vec<Fault>,
}

impl Preflight {
    pub(super) fn new(
        surfaces: &Surfaces,
        mut faults: Vec<Fault>,
        OpenEdges { rims, n_torn_edges }: OpenEdges,
        narrow: Option<Narrow>,
    ) -> Self {
        faults.sort_by(|x, y| key(x).cmp(&key(y)));
        let mut is_used = vec![false; surfaces.points.len()];
        surfaces.triangles.as_flattened().iter().for_each(|v| is_used[v.index()] = true);
        Self {
            n_surfaces: surfaces.roles.len(),
            n_triangles: surfaces.triangles.len(),
            n_orphans: is_used.iter().filter(|is_used| !**is_used).count(),
            rims,
            n_torn_edges,
            counts: faults.chunk_by(|x, y| x.kind == y.kind).map(count).collect(),
            narrow,
            faults,
        }
    }

    /// Whether nothing prevents the surfaces from being meshed.
    pub fn is_fit(&self) -> bool {
        self.counts.iter().all(|count| count.fatal == 0)
    }

    /// The number of rims, and the longest ones, in words.
    fn describe_rims(&self) -> String {
        let n = self.rims.len();
        let longest: Vec<String> = self.rims.iter().take(MAX_RIMS_IN_ERROR).map(Rim::to_string).collect();
        let more = if n > MAX_RIMS_IN_ERROR {
            format!("; and {} more", n - MAX_RIMS_IN_ERROR)
        } else {
            String::new()
        };
        format!("the open edges form {n} rim{}: {}{more}", if n == 1 { "" } else { "s" }, longest.join("; "))
    }

    /// Number of faults of this kind, notes included.
    pub fn count(&self, kind: FaultKind) -> usize {
        self.counts.iter().filter(|count| count.kind == kind).map(|count| count.fatal + count.notes).sum()
    }

    /// The first fault that prevents meshing, as an error; `None` if there is none.
    pub fn first_error(&self) -> Option<Error> {
        let fault = self.faults.iter().find(|fault| fault.is_fatal)?;
        let kind = fault.kind;
        let n = self.counts.iter().find(|count| count.kind == kind).map_or(1, |count| count.fatal);
        let mut what = format!("the surfaces cannot be meshed: {}", kind.meaning());
        if kind == FaultKind::OpenEdge && !self.rims.is_empty() {
            what = format!("{what}; {}", self.describe_rims());
        }
        let others = self.counts.iter().filter(|count| count.kind != kind && count.fatal > 0);
        let others: String = others.map(|count| format!(", {} {}", count.fatal, count.kind.name())).collect();
        Some(
            Error::input(format!("{what} (in total {n} {}{others})", kind.name()))
                .at(fault.to_string())
                .remedy(kind.remedy()),
        )
    }
}

/// The sort key of faults.
fn key(fault: &Fault) -> (FaultKind, &[u32], &[crate::base::VertexId], u32) {
    (fault.kind, &fault.triangles, &fault.vertices, fault.surface)
}

fn count(same: &[Fault]) -> FaultCount {
    let fatal = same.iter().filter(|fault| fault.is_fatal).count();
    FaultCount { kind: same[0].kind, fatal, notes: same.len() - fatal }
}

impl fmt::Display for Preflight {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.is_fit() { "fit" } else { "not fit" };
        let plural = if self.n_surfaces == 1 { "" } else { "s" };
        write!(f, "{} triangles, {} surface{plural}: {verdict}", self.n_triangles, self.n_surfaces)?;
        for FaultCount { kind, fatal, notes } in &self.counts {
            write!(f, "; {}", kind.name())?;
            if *fatal > 0 {
                write!(f, " {fatal}")?;
            }
            if *notes > 0 {
                write!(f, " ({notes} not fatal)")?;
            }
        }
        if self.n_orphans > 0 { write!(f, "; {} points unused", self.n_orphans) } else { Ok(()) }
    }
}
