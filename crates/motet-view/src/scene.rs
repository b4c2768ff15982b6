//! The mesh, what was done to it, and what the page shows of it.

use std::time::Instant;

use motet::base::{Point, Threads};
use motet::geometry::vector::{add, in_range, scale, sub};
use motet::io::{self, WriteOptions};
use motet::mesh::{Field, OrientedTets};
use motet::moving::{MovingMesh, Options, Step};
use motet::{Error, Mesh, Result};
use motet_report::Live;
use serde::{Deserialize, Serialize};

use crate::parts::{Patch, SeparateParts, patches};
use crate::preview::{GAP, Lists, Measured, Preview, PreviewRequest};

/// How many steps can be undone.
const MAX_UNDONE: usize = 20;

/// A mesh that a user moves.
pub struct Scene {
    name: String,
    threads: Threads,
    now: State,
    /// The states before each step, the latest last.
    past: Vec<State>,
    patches: Vec<Patch>,
    shown: Shown,
    /// The mesh as it was given.
    at_first: Measured,
}

/// The mesh between two steps.
enum State {
    /// A mesh that cannot be moved, and why.
    Still(Box<Mesh>, String),
    /// One that can, with the displacement of its driven vertices from their first positions.
    Moving(Box<MovingMesh>, Vec<Point>),
}

/// What is prepared for the page while connectivity stays.
struct Shown {
    live: Live,
    tets: OrientedTets,
    parts: Option<SeparateParts>,
    measured: Measured,
}

/// What the page requests when a patch is released.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MoveRequest {
    patch: String,
    /// The displacement since the last step.
    by: Point,
}

/// What the page tells of the mesh.
#[derive(Serialize)]
struct Facts<'a> {
    #[serde(flatten)]
    measured: &'a Measured,
    at_first: &'a Measured,
    #[serde(skip_serializing_if = "Option::is_none")]
    patches: Option<&'a [Patch]>,
    /// Whether parts stand apart, which are dragged where they are seen.
    has_separate_parts: bool,
    /// Why the mesh cannot be moved.
    #[serde(skip_serializing_if = "Option::is_none")]
    not_movable: Option<&'a str>,
    /// The outcome of the last step.
    #[serde(skip_serializing_if = "Option::is_none")]
    outcome: Option<String>,
    can_undo: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    milliseconds: Option<f64>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    lists: &'a [(&'static str, usize)],
}

impl Scene {
    /// A mesh, shown under a name. One without volume cells can be looked at, but not moved.
    ///
    /// # Errors
    /// When the page cannot be made.
    pub fn new(mesh: Mesh, name: &str, threads: Threads) -> Result<Self> {
        let options = Options::default();
        let mut movable = Vec::new();
        let now = match MovingMesh::new(&mesh, options.clone(), &threads) {
            Ok(moving) => {
                movable = patches(&mesh, &options.motion.driven(&mesh)?);
                let n = moving.driven_places().len();
                State::Moving(Box::new(moving), vec![[0.0; 3]; n])
            }
            Err(e) => State::Still(Box::new(mesh), format!("This mesh cannot be moved: {e}")),
        };
        let shown = Shown::of(&now, name, &threads)?;
        let at_first = shown.measured.clone();
        Ok(Self { name: name.to_owned(), threads, now, past: Vec::new(), patches: movable, shown, at_first })
    }

    /// The mesh as it is.
    pub fn mesh(&self) -> &Mesh {
        self.now.mesh()
    }

    /// The page.
    ///
    /// # Errors
    /// When it cannot be rendered.
    pub fn page(&self) -> Result<String> {
        self.shown.live.page()
    }

    /// The page with the mesh as it is, which works without this program.
    ///
    /// # Errors
    /// When it cannot be rendered.
    pub fn offline_page(&self) -> Result<String> {
        self.shown.live.offline_page()
    }

    /// The mesh as it is, as a VTU file.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn file(&self) -> Result<Vec<u8>> {
        let vtu = io::formats().iter().find(|format| format.extensions.contains(&".vtu"));
        let vtu = vtu.ok_or_else(|| Error::options("this build of motet does not write VTU"))?;
        let written = vtu.to_files(self.mesh(), &WriteOptions::default(), &self.threads)?;
        Ok(written.files.into_iter().next().map(|(_, bytes)| bytes).unwrap_or_default())
    }

    /// What replaces the data of the open page after a step, as JSON.
    pub fn update(&self) -> String {
        self.shown.live.update().to_string()
    }

    /// The state of the mesh, and what can be moved, as JSON.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn facts(&self) -> Result<String> {
        let not_movable = match &self.now {
            State::Still(_, why) => Some(why.as_str()),
            State::Moving(..) => None,
        };
        json(&Facts { patches: Some(&self.patches), not_movable, ..self.current_facts(None, None) })
    }

    /// Where everything would be, in the order of the page: the length of the facts, in four bytes, the facts
    /// as JSON, filled up to a multiple of four, and lists of numbers.
    ///
    /// # Errors
    /// When there is no such patch, or the displacement is not finite.
    pub fn preview(&mut self, request: &PreviewRequest) -> Result<Vec<u8>> {
        let begin = Instant::now();
        let displacement = self.displacement_with(&request.patch, request.by)?;
        let points = self.moving()?.0.preview(&displacement, &self.threads)?;
        let shown = &mut self.shown;
        let is_of_gaps = request.array.as_deref() == Some(GAP);
        let parts = shown.parts.as_mut().filter(|_| is_of_gaps);
        let preview = Preview::of(&shown.tets, parts, &points, &self.threads)?;
        let lists = Lists::of(&preview, shown.live.order(), &shown.tets, &points, request);
        let current = self.current_facts(Some(begin), None);
        let facts = Facts { measured: &preview.measured, lists: &lists.lengths, ..current };
        let mut facts = json(&facts)?.into_bytes();
        let mut answer = (facts.len() as u32).to_le_bytes().to_vec();
        facts.resize(facts.len().next_multiple_of(4), b' ');
        answer.extend(facts);
        answer.extend(lists.bytes);
        Ok(answer)
    }

    /// Moves a patch, and repairs what becomes bad; as far as it can be moved. The facts, as JSON.
    ///
    /// # Errors
    /// When there is no such patch, or the displacement is not finite. Then nothing has changed.
    pub fn shift(&mut self, request: &MoveRequest) -> Result<String> {
        let begin = Instant::now();
        let displacement = self.displacement_with(&request.patch, request.by)?;
        let (moving, old) = self.moving()?;
        let mut moving = moving.clone();
        let step = moving.advance(moving.time() + 1.0, &displacement, &self.threads)?;
        let reached = |(&a, &b): (&Point, &Point)| add(a, scale(sub(b, a), step.fraction));
        let displacement = match step.complete {
            true => displacement,
            false => old.iter().zip(&displacement).map(reached).collect(),
        };
        let now = State::Moving(Box::new(moving), displacement);
        self.shown = Shown::of(&now, &self.name, &self.threads)?;
        let before = std::mem::replace(&mut self.now, now);
        if self.past.len() == MAX_UNDONE {
            self.past.remove(0);
        }
        self.past.push(before);
        json(&self.current_facts(Some(begin), Some(outcome(&step))))
    }

    /// Undoes the last step that is not undone yet. The facts, as JSON.
    ///
    /// # Errors
    /// When there is none.
    pub fn undo(&mut self) -> Result<String> {
        let begin = Instant::now();
        let before = self.past.last().ok_or_else(|| Error::options("there is nothing to undo"))?;
        self.shown = Shown::of(before, &self.name, &self.threads)?;
        self.now = self.past.remove(self.past.len() - 1);
        json(&self.current_facts(Some(begin), Some("Undone.".to_owned())))
    }

    fn current_facts(&self, begin: Option<Instant>, outcome: Option<String>) -> Facts<'_> {
        Facts {
            measured: &self.shown.measured,
            at_first: &self.at_first,
            patches: None,
            has_separate_parts: self.shown.parts.is_some(),
            not_movable: None,
            outcome,
            can_undo: !self.past.is_empty(),
            milliseconds: begin.map(|begin| begin.elapsed().as_secs_f64() * 1e3),
            lists: &[],
        }
    }

    fn moving(&self) -> Result<(&MovingMesh, &[Point])> {
        match &self.now {
            State::Still(_, why) => Err(Error::options(why).remedy("give a mesh with volume cells")),
            State::Moving(moving, displacement) => Ok((moving, displacement)),
        }
    }

    /// The displacement of all driven vertices with one patch moved, as far as others leave it room.
    fn displacement_with(&mut self, patch: &str, by: Point) -> Result<Vec<Point>> {
        if !in_range(by) {
            return Err(Error::options("the displacement is not finite"));
        }
        let mut displacement = self.moving()?.1.to_vec();
        let found = self.patches.iter().find(|other| other.name == patch);
        let patch = found.ok_or_else(|| Error::options(format!("there is no patch {patch} to move")))?;
        let by = match &mut self.shown.parts {
            Some(parts) => parts.reached(patch.id, &self.now.mesh().points, by, &self.threads)?,
            None => by,
        };
        patch.nodes.iter().for_each(|&node| displacement[node] = add(displacement[node], by));
        Ok(displacement)
    }
}

impl State {
    fn mesh(&self) -> &Mesh {
        match self {
            Self::Still(mesh, _) => mesh,
            Self::Moving(moving, _) => moving.mesh(),
        }
    }
}

impl Shown {
    fn of(state: &State, name: &str, threads: &Threads) -> Result<Self> {
        let mesh = state.mesh();
        let tets = OrientedTets::of(mesh, threads);
        // Distances of what cannot be moved are not needed, and its points need not be finite.
        let mut parts = match state {
            State::Still(..) => None,
            State::Moving(..) => SeparateParts::of(mesh, threads)?,
        };
        let preview = Preview::of(&tets, parts.as_mut(), &mesh.points, threads)?;
        let mut pictured = mesh.clone();
        if let Some(gaps) = preview.gaps {
            pictured.set_point_field(Field::scalars(GAP, gaps));
        }
        Ok(Self { live: Live::of(pictured, name)?, tets, parts, measured: preview.measured })
    }
}

fn outcome(step: &Step) -> String {
    let done = match step.not_reached() {
        Some(why) => format!("Not moved all the way: {why}."),
        None => "Moved.".to_owned(),
    };
    match step.changes.len() {
        0 => done,
        1 => format!("{done} Bad tets were repaired."),
        n => format!("{done} Bad tets were repaired {n} times on the way."),
    }
}

fn json(facts: &Facts<'_>) -> Result<String> {
    serde_json::to_string(facts).map_err(|e| Error::options(format!("the answer cannot be written: {e}")))
}
