//! The repair of bad tets one by one, worst first.

mod ahead;
mod by_length;
mod density;
mod divide;
mod improve;
mod score;
mod search;
mod sizing;
mod stages;
mod thin;
mod trial;
mod tried;

pub(super) use density::Density;
pub(super) use improve::Aim;
pub(super) use sizing::Sizing;

use crate::base::{Changes, Result, TetId, Threads, VertexId};
use crate::kernel::{Change, Complex, Shell, Star};
use crate::remesh::input_mesh::{InputMesh, Pose};
use crate::remesh::left::{forced, is_forced};
use crate::remesh::options::{SurfaceRule, Whole};
use crate::remesh::repair::ahead::Pass;
use crate::remesh::repair::score::{Score, worth_more_bad};
use crate::remesh::repair::search::{Search, Toolbox, Tools};
use crate::remesh::repair::stages::{FIRST_STAGES, STAGES};
use crate::remesh::repair::trial::Found;
use crate::remesh::repair::tried::Tried;
use crate::remesh::report::{Counts, Operation, State};
use crate::remesh::sizes::SizesIn;
use crate::remesh::surface::{Crease, Surface};

/// How much higher the target is for tets around those that no operation repairs, one attempt after another.
const RAISES: [f64; 3] = [0.1, 0.15, 0.2];

/// The targets for the worst tets of [`Repair::best`].
const BEST: [f64; 4] = [0.25, 0.3, 0.35, 0.4];
/// A tet with at least this EAS is good enough for [`Repair::best`].
const GOOD: f64 = 0.7;

/// If more than this fraction of the tets is left below a target, the target rises no further.
const MANY: f64 = 0.01;

/// A mesh counts as hopelessly tangled if a round of all stages leaves more inverted tets than this number,
/// than this fraction of all tets, and than this fraction of those that it found. In a cube of 8,000 tets
/// whose vertices were moved at random by up to an edge, the first eight rounds reduced 3,736 bad tets to
/// 789; eighteen more left 500, 200 of them inverted. With moves of up to two edges, 4,711 bad tets were
/// 4,833 after eight rounds, and 4,844 in the end.
const HOPELESS: (usize, f64, f64) = (100, 0.01, 0.95);

/// What is done with the bad tets that the first rounds leave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Treatment {
    /// Repeats the rounds.
    Again,
    /// Divides the tets that nothing else repairs.
    Divide,
    /// Does both, where walls that meet at less than this angle no longer form a feature.
    Soften(Crease),
}

/// The treatments that a surface rule allows: made one after the other as long as bad tets are left.
pub(super) fn treatments(surface: SurfaceRule) -> &'static [Treatment] {
    use Treatment::{Again, Divide, Soften};
    const ALL: [Treatment; 5] = [Again, Divide, Soften(Crease::BLUNT), Divide, Soften(Crease::NONE)];
    match surface {
        SurfaceRule::Keep | SurfaceRule::Flat { .. } => &ALL[..1],
        SurfaceRule::Adapt { .. } => &ALL[..4],
        SurfaceRule::Loose { .. } => &ALL,
    }
}

/// Whether a tet is marked; an empty list marks none.
pub(super) fn is_among(marks: &[bool], tet: TetId) -> bool {
    marks.get(tet.index()).is_some_and(|is_marked| *is_marked)
}

/// The union of two lists of marks; an empty list marks none.
fn union(a: &[bool], b: &[bool]) -> Vec<bool> {
    (0..a.len().max(b.len())).map(TetId::new).map(|tet| is_among(a, tet) || is_among(b, tet)).collect()
}

/// The rest of a mesh of which a part is repaired.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outside {
    tets: usize,
    free_vertices: usize,
    /// The mean over the whole mesh.
    mean_defect: f64,
}

impl Outside {
    /// What a whole mesh has besides a part in a state.
    pub(super) fn of(whole: Whole, part: &State<TetId>) -> Self {
        Self {
            tets: whole.tets.saturating_sub(part.tets),
            free_vertices: whole.free_vertices.saturating_sub(part.free_vertices),
            mean_defect: whole.mean_defect,
        }
    }
}

/// The state of a repair.
pub(super) struct Repair<'a> {
    pub(super) complex: Complex,
    /// The mesh that the complex was made of.
    pub(super) input: InputMesh<'a>,
    pub(super) operations: Counts,
    surface: Option<Surface>,
    /// The sizes, if any are requested.
    pub(super) sizing: Option<Sizing>,
    /// The other pose in which tets are to be good, if there is one.
    pub(super) pose: Option<Pose>,
    /// The rest of the mesh that the complex is a part of, if it is one.
    pub(super) outside: Option<Outside>,
    /// Marks tets of the first mesh that never count as bad, by id; empty if there are none.
    never_bad: Vec<bool>,
    /// Marks tets of the first mesh that stay as they are, by id; empty if there are none.
    pub(super) kept: Vec<bool>,
    target: f64,
    n_stages: usize,
    toolbox: Toolbox,
    /// Bad tets among those inserted.
    inserted_bad: Vec<TetId>,
    changes: Changes,
    /// The repairs that failed in this run.
    tried: Tried,
    /// Whether rounds ended because the mesh is hopelessly tangled.
    is_hopeless: bool,
    threads: &'a Threads,
}

impl<'a> Repair<'a> {
    pub(super) fn new(
        complex: Complex,
        input: InputMesh<'a>,
        surface: Option<Surface>,
        never_bad: Vec<bool>,
        target: f64,
        threads: &'a Threads,
    ) -> Self {
        Self {
            complex,
            input,
            operations: Counts::default(),
            surface,
            sizing: None,
            pose: None,
            outside: None,
            never_bad,
            kept: Vec::new(),
            target,
            n_stages: FIRST_STAGES,
            toolbox: Toolbox::default(),
            inserted_bad: Vec::new(),
            changes: Changes::new(),
            tried: Tried::nothing(),
            is_hopeless: false,
            threads,
        }
    }

    /// Repairs the bad tets in rounds as long as there is progress; returns those that are left.
    ///
    /// Without progress, the tets around those that are left are improved first: the change that would repair
    /// a tet is often blocked by a neighbour that is hardly better.
    pub(super) fn run(&mut self, mut bad: Vec<TetId>, rounds: usize) -> Result<Vec<TetId>> {
        self.tried = Tried::of(self.target);
        self.is_hopeless = false;
        let (mut raises, mut before) = (RAISES.iter(), None);
        let mut n_inverted = self.n_inverted(&bad);
        for _ in 0..rounds {
            let progressed = self.round(&mut bad)?;
            if bad.is_empty() {
                break;
            }
            let n_inverted_before = std::mem::replace(&mut n_inverted, self.n_inverted(&bad));
            if self.n_stages < STAGES.len() {
                self.n_stages += 1;
                continue;
            }
            self.is_hopeless = self.is_hopeless_with([n_inverted_before, n_inverted]);
            if self.is_hopeless {
                break;
            }
            if progressed {
                continue;
            }
            // If thousands are left, the surface causes them, and improving their surroundings does not help.
            let pays_off =
                before.is_none_or(|before: usize| before.saturating_sub(bad.len()) >= bad.len() / 100);
            let Some(more) = raises.next().filter(|_| pays_off) else { break };
            // Tets forced by walls that stay cannot get better, whatever lies around them.
            let (complex, stays, mut shell) = (&self.complex, self.surface.is_none(), Shell::default());
            let is_unforced = |tet: &TetId| !(stays && is_forced(complex, None, *tet, &mut shell));
            let unforced: Vec<TetId> = bad.iter().copied().filter(is_unforced).collect();
            if unforced.is_empty() {
                break;
            }
            before = Some(bad.len());
            self.improve_around(&unforced, self.target + more)?;
        }
        self.tried = Tried::nothing();
        bad.append(&mut self.inserted_bad);
        bad.retain(|&t| self.is_bad(t));
        self.sort(&mut bad);
        Ok(bad)
    }

    /// Whether rounds ended because the mesh is hopelessly tangled: no other treatment of bad tets makes it
    /// valid.
    pub(super) fn is_hopeless(&self) -> bool {
        self.is_hopeless
    }

    fn n_inverted(&self, bad: &[TetId]) -> usize {
        bad.iter().filter(|&&tet| self.complex.quality(tet) <= 0.0).count()
    }

    /// Whether a mesh is hopelessly tangled if a round of all stages found `before` inverted tets and left
    /// `after`.
    fn is_hopeless_with(&self, [before, after]: [usize; 2]) -> bool {
        let (many, of_all, of_before) = HOPELESS;
        let (n_tets, n_left) = (self.n_tets() as f64, after as f64);
        after > many && n_left > of_all * n_tets && n_left > of_before * before as f64
    }

    /// Treats the bad tets that are left; returns those that remain.
    pub(super) fn treat(
        &mut self,
        treatment: Treatment,
        left: Vec<TetId>,
        rounds: usize,
    ) -> Result<Vec<TetId>> {
        if let (Some(surface), Treatment::Soften(crease)) = (&mut self.surface, treatment) {
            surface.constrain_features(&mut self.complex, crease);
        }
        let left = if treatment == Treatment::Divide { left } else { self.run(left, rounds)? };
        if treatment == Treatment::Again { Ok(left) } else { self.divide(left, rounds) }
    }

    /// Treats the bad tets that are left, with an exemption: tets as good as the walls at them allow count as
    /// good, since they cannot get better and would block their neighbours. Returns what is left below the
    /// target, forced tets included. The treatment is undone if it leaves more bad tets than before: walls
    /// can force two tets in place of one.
    pub(super) fn beside_forced(
        &mut self,
        left: &[TetId],
        treat: impl Fn(&mut Self, Vec<TetId>) -> Result<Vec<TetId>>,
    ) -> Result<Vec<TetId>> {
        let forced = forced(&self.complex, self.surface.as_ref(), left);
        self.complex.exempt(&forced, self.target);
        let (start, operations) = (self.complex.mark(), self.operations);
        let unforced = treat(self, left.to_vec())?;
        if unforced.len() + self.complex.n_exempt() > left.len() {
            self.complex.undo(start);
            self.operations = operations;
        }
        self.complex.end_exemptions();
        Ok(self.below(self.target))
    }

    /// Makes all tets as good as possible.
    pub(super) fn best(&mut self, rounds: usize) -> Result<()> {
        let aim = Aim { below: GOOD, floor: self.target, limit: self.target, cost: 0.0 };
        self.improve_and_raise(aim, self.below(GOOD), 1.0, rounds)
    }

    /// Improves the tets of a zone as far as is possible without a long search. Walls stay, and kept tets do
    /// not count as bad.
    pub(super) fn best_within(&mut self, aim: Aim, zone: Vec<TetId>, rounds: usize) -> Result<()> {
        let never_bad = union(&self.never_bad, &self.kept);
        let (never_bad, surface) = (std::mem::replace(&mut self.never_bad, never_bad), self.surface.take());
        if surface.is_some() {
            self.complex.keep_surface();
        }
        let done = self.improve_and_raise(aim, zone, MANY, rounds);
        if surface.is_some() {
            self.complex.adapt_surface();
        }
        (self.never_bad, self.surface) = (never_bad, surface);
        done
    }

    /// Improves the tets of a zone as a whole, then raises the worst of all, then improves what that has
    /// changed without lowering the worst. Raising the worst first would leave a lower mean.
    fn improve_and_raise(&mut self, aim: Aim, zone: Vec<TetId>, max_left: f64, rounds: usize) -> Result<()> {
        self.improve(aim, zone)?;
        let begin = self.changes.now();
        self.raise_worst(max_left, rounds)?;
        let mut changed = self.below(aim.below);
        changed.retain(|&t| self.complex.vertices(t).iter().any(|&v| !self.changes.none_since(v, begin)));
        self.improve(Aim { floor: self.target, ..aim }, changed)
    }

    /// Whether so many tets are left that surfaces must force them: trying all operations for each would take
    /// long and help little.
    pub(super) fn are_too_many(&self, n_left: usize) -> bool {
        self.is_more(n_left, MANY)
    }

    /// Whether `n` is more than this fraction of all tets.
    fn is_more(&self, n: usize, part: f64) -> bool {
        n as f64 > part * self.n_tets() as f64
    }

    /// The number of tets, with those outside.
    fn n_tets(&self) -> usize {
        self.complex.n_tets() + self.outside.map_or(0, |outside| outside.tets)
    }

    /// Repairs up to a target that rises as long as no more than a fraction `max_left` of the tets is left
    /// below it. The last rise is undone if it leaves more tets below the first target than before.
    fn raise_worst(&mut self, max_left: f64, rounds: usize) -> Result<()> {
        let usual = self.target;
        for target in BEST {
            let n_bad = self.below(usual).len();
            let (start, operations, before) = (self.complex.mark(), self.operations, self.target);
            self.n_stages = FIRST_STAGES;
            let left = self.try_again(target.max(before), rounds)?;
            if self.below(usual).len() > n_bad {
                self.complex.undo(start);
                (self.operations, self.target) = (operations, before);
                break;
            }
            self.complex.forget();
            if self.is_more(left.len(), max_left) {
                break;
            }
        }
        Ok(())
    }

    /// Repairs the tets below a target once more, after improving: what blocked them may be better now.
    /// Returns those that are left.
    pub(super) fn try_again(&mut self, target: f64, rounds: usize) -> Result<Vec<TetId>> {
        self.target = target;
        self.run(self.below(target), rounds)
    }

    /// The vertices of some tets, sorted, for [`Self::try_again_at`]; the tets may change in between.
    pub(super) fn vertices_of(&self, tets: &[TetId]) -> Vec<VertexId> {
        let mut vertices: Vec<_> = tets.iter().flat_map(|&tet| self.complex.vertices(tet)).collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }

    /// Repairs, after improving, the tets below a target that have at least two of the vertices: what blocked
    /// them may be better now. Returns the tets left below the target anywhere.
    pub(super) fn try_again_at(
        &mut self,
        vertices: &[VertexId],
        target: f64,
        rounds: usize,
    ) -> Result<Vec<TetId>> {
        self.target = target;
        let is_near = |v: &VertexId| vertices.binary_search(v).is_ok();
        let mut again = self.below(target);
        again.retain(|&tet| self.complex.vertices(tet).iter().filter(|v| is_near(v)).count() >= 2);
        self.run(again, rounds)?;
        Ok(self.below(target))
    }

    /// Tries to repair each bad tet once, and leaves the list of those that are bad then. Returns whether
    /// anything was changed.
    fn round(&mut self, bad: &mut Vec<TetId>) -> Result<bool> {
        bad.retain(|&t| self.is_bad(t));
        self.sort(bad);
        let mut repairs = Repairs { progressed: false };
        self.make(&mut repairs, "repairing tets", bad)?;
        bad.append(&mut self.inserted_bad);
        bad.retain(|&t| self.is_bad(t));
        Ok(repairs.progressed)
    }

    /// Improves the tets that share a vertex with a bad one, up to a higher target.
    fn improve_around(&mut self, bad: &[TetId], target: f64) -> Result<()> {
        let (mut around, mut star) = (Vec::new(), Star::default());
        for &tet in bad {
            for vertex in self.complex.vertices(tet) {
                star.gather(&self.complex, vertex);
                around.extend_from_slice(&star.tets);
            }
        }
        let usual = std::mem::replace(&mut self.target, target);
        // Here all tets nearby are to reach the target.
        let never_bad = std::mem::take(&mut self.never_bad);
        around.retain(|&t| self.is_bad(t));
        self.round(&mut around)?;
        (self.target, self.never_bad) = (usual, never_bad);
        around.retain(|&t| self.is_bad(t));
        self.inserted_bad.append(&mut around);
        Ok(())
    }

    /// Sorts tets, worst first, and removes duplicates.
    fn sort(&self, tets: &mut Vec<TetId>) {
        // Ties are ordered by id.
        let mut keys: Vec<_> = tets.iter().map(|&t| (rising(self.complex.quality(t)), t)).collect();
        keys.sort_unstable();
        keys.dedup();
        tets.clear();
        tets.extend(keys.into_iter().map(|(_, tet)| tet));
    }

    /// The tets below a quality that may be changed, worst first.
    pub(super) fn below(&self, quality: f64) -> Vec<TetId> {
        let mut below = self.complex.below(quality, self.threads);
        below.retain(|&t| !self.complex.is_locked(t) && !self.is_never_bad(t));
        self.sort(&mut below);
        below
    }

    fn is_bad(&self, tet: TetId) -> bool {
        let may_be = self.complex.is_alive(tet) && !self.complex.is_locked(tet) && !self.is_never_bad(tet);
        may_be && self.complex.quality(tet) < self.target
    }

    fn is_kept(&self, tet: TetId) -> bool {
        self.complex.is_original(tet) && is_among(&self.kept, tet)
    }

    fn is_never_bad(&self, tet: TetId) -> bool {
        self.complex.is_original(tet) && is_among(&self.never_bad, tet)
    }

    /// Whether all stages are tried.
    fn is_last_stage(&self) -> bool {
        self.n_stages == STAGES.len()
    }

    /// The sizes that edges are to have, if any are requested.
    fn sizes(&self) -> Option<SizesIn<'_>> {
        let Self { complex, input, sizing, .. } = self;
        sizing.as_ref().map(|sizing| SizesIn { field: &sizing.field, input, complex })
    }

    /// Makes a change if the kernel accepts it; its tets have to be better than `bar`. `inserted` gets the
    /// new tets. Returns whether it was made.
    fn commit(&mut self, change: &Change, of: Operation, bar: f64, inserted: &mut Vec<TetId>) -> bool {
        let Self { complex, input, sizing, changes, operations, .. } = self;
        let Ok(checked) = complex.check_against(change, bar) else { return false };
        input.note_removed(complex, &change.cavity);
        complex.commit(checked, inserted);
        operations.add(of);
        changes.record(inserted.iter().flat_map(|&t| complex.vertices(t)));
        if let Some(sizing) = sizing {
            sizing.field.learn(complex, input, inserted.iter().copied());
        }
        true
    }
}

/// A pass that makes the best change for each bad tet.
struct Repairs {
    /// Whether a change was made.
    progressed: bool,
}

/// The result of a search for the change that repairs a tet.
#[derive(Debug, PartialEq)]
enum RepairFound {
    /// The tet is not bad, or its repair failed and would fail again.
    Nothing,
    /// Walls force the tet.
    Forced,
    /// No change helps.
    Failed,
    Change(Found<Score>),
}

impl Pass for Repairs {
    type Candidate = TetId;
    type Found = RepairFound;

    fn search(&self, search: &mut Search, tet: TetId) -> RepairFound {
        let repair = search.repair;
        let complex = &repair.complex;
        if !repair.is_bad(tet) || repair.tried.knows(&repair.changes, complex, tet, repair.target) {
            return RepairFound::Nothing;
        }
        // Where the surface may change, walls do not force a tet.
        if repair.surface.is_none() && search.with_shell(|_, shell| is_forced(complex, None, tet, shell)) {
            return RepairFound::Forced;
        }
        search.worth_more_bad = worth_more_bad(repair.is_last_stage().then(|| complex.quality(tet)));
        for stage in &STAGES[..repair.n_stages] {
            stage(search, tet);
            if search.tools.repairs.reaches(repair.target) {
                break;
            }
        }
        search.tools.repairs.take(complex).map_or(RepairFound::Failed, RepairFound::Change)
    }

    fn is_current(&self, repair: &Repair, tet: TetId, _: &RepairFound, since: u32) -> bool {
        repair.is_unchanged(tet, since)
    }

    fn update(&self, repair: &Repair, _: TetId, found: &mut RepairFound) {
        if let RepairFound::Change(found) = found {
            found.renumber(&repair.complex);
        }
    }

    fn act(&mut self, repair: &mut Repair, tools: &mut Tools, tet: TetId, found: RepairFound) {
        let is_made = match found {
            RepairFound::Nothing => return,
            RepairFound::Forced => return repair.tried.note_failure(&repair.changes, tet, repair.target),
            RepairFound::Failed => false,
            RepairFound::Change(found) => {
                tools.repairs.set(found);
                tools.repairs.commit(repair)
            }
        };
        if is_made {
            self.progressed = true;
            let (complex, target) = (&repair.complex, repair.target);
            let inserted = tools.repairs.inserted().iter().copied();
            repair.inserted_bad.extend(inserted.filter(|&t| complex.quality(t) < target));
        } else if repair.is_last_stage() {
            repair.tried.note_failure(&repair.changes, tet, repair.target);
        }
    }
}

/// An integer that orders as `f64::total_cmp` does.
fn rising(x: f64) -> i64 {
    let bits = x.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}
