//! Columns on a skin, which give way until nothing is in their way.

use super::columns::{Columns, Prism, Site};
use super::neighbors::NONE;
use super::report::Report;
use super::skin::Skin;
use super::split::n_tets;
use super::thickness::{Heights, Limits};
use crate::base::{Csr, Error, Result, Threads, VertexId};
use crate::geometry::tet::volume;

/// The factor by which columns at fault are made thinner.
const THINNING: f64 = 0.7;

/// How often a column may be at fault before it is removed; a twentieth of its thickness is left by then.
const MAX_BLAMES: u8 = 8;

/// The number of rounds after which all columns at fault are removed at once, with their neighbours.
const PATIENT_ROUNDS: usize = 40;

/// The number of rounds after which all columns are removed.
const ROUNDS: usize = 80;

/// The largest number of prisms.
const MAX_PRISMS: usize = 200_000_000;

/// Columns on a skin.
pub(super) struct Growth {
    pub(super) skin: Skin,
    pub(super) heights: Heights,
    /// How often columns had to give way.
    pub(super) rounds: usize,
    /// The neighbors of each vertex along walls.
    around: Csr<VertexId>,
    blames: Vec<u8>,
}

impl Growth {
    /// Columns as thick as requested, or as the space around each allows; `requested` returns the thickness
    /// at a vertex of the skin on a wall, given that of the stack there.
    ///
    /// # Errors
    /// When layers are requested on no wall, or there would be too many prisms.
    pub(super) fn new(
        skin: Skin,
        limits: &Limits,
        requested: impl Fn(VertexId, f64) -> f64 + Sync,
        threads: &Threads,
    ) -> Result<Self> {
        check_count(&skin)?;
        let around = around(&skin);
        let heights = Heights::find(&skin, &around, limits, requested, threads);
        let blames = vec![0; skin.points.len()];
        Ok(Self { skin, heights, rounds: 0, around, blames })
    }

    pub(super) fn columns(&self) -> Columns<'_> {
        Columns::new(&self.skin, &self.heights)
    }

    /// Makes columns thinner until none is at fault. `build` makes what is checked, `tangles` returns the
    /// columns at fault. Returns what was built last.
    ///
    /// # Errors
    /// When the call is stopped.
    pub(super) fn settle<T>(
        &mut self,
        build: impl Fn(&Skin, &Heights) -> T,
        tangles: impl Fn(&Skin, &Columns, &T) -> Vec<VertexId>,
        threads: &Threads,
    ) -> Result<T> {
        loop {
            threads.watch().report_and_check("fitting layers", self.rounds, 0)?;
            let built = build(&self.skin, &self.heights);
            let blamed = tangles(&self.skin, &self.columns(), &built);
            if blamed.is_empty() {
                return Ok(built);
            }
            self.give_way(&blamed);
        }
    }

    /// Makes columns thinner, and neighbouring ones as far as the slope requires.
    pub(super) fn give_way(&mut self, blamed: &[VertexId]) {
        self.rounds += 1;
        for v in blamed {
            let w = v.index();
            self.blames[w] = self.blames[w].saturating_add(1);
            let is_removed = self.blames[w] > MAX_BLAMES || self.rounds > PATIENT_ROUNDS;
            self.heights.heights[w] *= if is_removed { 0.0 } else { THINNING };
        }
        if self.rounds > PATIENT_ROUNDS {
            let beside = blamed.iter().flat_map(|v| self.around.list(v.index()));
            beside.for_each(|v| self.heights.heights[v.index()] = 0.0);
        }
        if self.rounds > ROUNDS {
            self.heights.heights.fill(0.0);
        }
        self.heights.limit_slope(&self.skin, &self.around);
    }

    /// Statistics on the layers.
    pub(super) fn report(&self) -> Report {
        let columns = self.columns();
        let mut report = Report::new(&self.skin, &columns, &self.heights, self.rounds);
        for t in 0..self.skin.triangles.len() as u32 {
            for prism in columns.prisms(t) {
                let Some((kind, _)) = prism.cell() else { continue };
                report.prisms += 1;
                report.tets += n_tets(kind);
                report.volume += prism_volume(&columns, &prism);
            }
        }
        report
    }
}

/// The neighbors of each vertex along walls.
pub(super) fn around(skin: &Skin) -> Csr<VertexId> {
    let walls = skin.triangles.iter().zip(&skin.stack_of).filter(|(_, stack)| **stack != NONE);
    let ends = walls.flat_map(|(&[a, b, c], _)| [(a, b), (b, a), (b, c), (c, b), (c, a), (a, c)]);
    let mut ends: Vec<(VertexId, VertexId)> = ends.collect();
    ends.sort_unstable();
    ends.dedup();
    Csr::from_pairs(skin.points.len(), || ends.iter().map(|&(from, to)| (from.index(), to)))
}

fn check_count(skin: &Skin) -> Result<()> {
    let count = |&stack: &u32| if stack == NONE { 0 } else { skin.stacks[stack as usize].count as usize };
    let n: usize = skin.stack_of.iter().map(count).sum();
    match n {
        0 => Err(Error::options("there is no triangle to grow layers on")
            .remedy("name a patch that bounds a body")),
        n if n > MAX_PRISMS => {
            Err(Error::options(format!("the layers would have {n} prisms; at most {MAX_PRISMS} are allowed"))
                .remedy("request fewer layers"))
        }
        _ => Ok(()),
    }
}

/// The volume of a prism: the mean over both choices of diagonals in its sides, so that neighbours agree
/// about the side between them.
fn prism_volume(columns: &Columns, prism: &Prism) -> f64 {
    let ([a, b, c], [d, e, f]) = (prism.bottom, prism.top);
    let of = |tet: [Site; 4]| volume(tet.map(|site| columns.at(site)));
    let one = of([a, c, b, d]) + of([b, c, e, d]) + of([d, e, f, c]);
    let other = of([d, e, f, a]) + of([a, c, b, f]) + of([a, b, e, f]);
    0.5 * (one + other)
}
