//! Putting the first mesh back in place of one that does not settle.

use std::sync::Arc;
use std::time::Instant;

use crate::base::{ErrorKind, Id, MaybeId, Point, Result, Threads};
use crate::mesh::history::History;
use crate::mesh::{Field, Mesh};
use crate::motion::Mover;
use crate::moving::contents::pass_contents;
use crate::moving::current::{Current, InFirst, positions_after, present_rules};
use crate::moving::first_mesh::FirstMesh;
use crate::moving::shapes::Shape;
use crate::moving::step::{Change, Why};
use crate::moving::step_run::StepRun;
use crate::spatial::trace::between;

/// The largest number of attempts to leave vertices in place because tets would turn over if they moved to
/// their positions in the first mesh.
const MAX_ATTEMPTS: usize = 8;

impl FirstMesh {
    /// This mesh with its walls displaced, and the shape of its tets; `None` if that makes tets bad.
    fn displaced(&self, run: &StepRun<'_>) -> Result<Option<(Current, Shape)>> {
        let (mesh, threads) = (self.mesh.clone(), run.threads);
        let mover = Mover::new(&mesh, &run.options.motion.options(&mesh)?, threads)?;
        let mut now = Current::of(mesh, mover, self.records.clone(), self.left.clone(), run.wall, threads)?;
        now.mover.step(&now.target(run.displacement), &mut now.mesh.points, threads)?;
        let is_upright = now.mover.check.newly_inverted(&now.mesh.points, threads).is_empty();
        let shape = now.tets.shape(&now.mesh.points, run.options.limit(), threads);
        Ok((is_upright && shape.bad.len() <= self.n_bad).then_some((now, shape)))
    }
}

impl StepRun<'_> {
    /// The first mesh as a replacement for `now`, whose vertices are at [`Self::points`], and the shape of
    /// its tets. `None` if a replacement is not due, or would not be good there.
    pub(super) fn put_back(
        &mut self,
        now: &Current,
        before: &[Point],
        has_changed: bool,
    ) -> Result<Option<(Current, Shape)>> {
        let returns = self.returns;
        let Some(first) = returns.first.as_deref().filter(|_| returns.is_return(self.displacement)) else {
            return Ok(None);
        };
        let shape = self.shape_at(now);
        let lost = first.lost(now, &self.points, &shape, self.threads);
        if !returns.is_enough(lost, has_changed) || now.records.in_first == first.records.in_first {
            return Ok(None);
        }
        let begin = Instant::now();
        let put_back = match first.displaced(self)? {
            None => None,
            Some((next, shape_there)) => {
                let next = self.with_data_of(now, before, next, &shape)?;
                next.map(|next| (next, shape_there))
            }
        };
        self.seconds.setup += begin.elapsed().as_secs_f64();
        Ok(put_back)
    }

    /// Passes the data of `now` to `next`, the first mesh with its walls displaced. `None` if its cells
    /// cannot be traced, or if its tets would be inverted at the start and may not be.
    fn with_data_of(
        &mut self,
        now: &Current,
        before: &[Point],
        mut next: Current,
        shape: &Shape,
    ) -> Result<Option<Current>> {
        let points = self.nearest_to(now, &next.mesh.points);
        let given = now.moved(&points, &self.options.contents);
        let rules = present_rules(&self.options.rules, &given);
        let Some(history) = history(&given, now, &next.mesh, self.threads)? else { return Ok(None) };
        history.transfer(&given, &mut next.mesh, &rules)?;
        pass_contents(&given, &mut next.mesh, &history, &self.options.contents);
        next.records.before = positions_after(before, &history)?;
        next.records.rest = Some(next.mesh.points.clone());
        arrange(&mut next.mesh.point_data, &now.mesh.point_data);
        arrange(&mut next.mesh.cell_data, &now.mesh.cell_data);
        if self.options.valid_at_start && next.inverted_at_start(self.threads).is_some() {
            return Ok(None);
        }
        let counts = [now, &next].map(|now| now.tets.len());
        let (time, history) = (self.times[1], Arc::new(history));
        self.changes.push(Change::new(time, Why::Return, counts, shape, history, points));
        Ok(Some(next))
    }

    /// The vertices of a mesh, moved to their positions in the first one where that has them and no tet turns
    /// over: this is part of the step's motion, so that tets still shared with the first mesh stay.
    fn nearest_to(&self, now: &Current, places: &[Point]) -> Vec<Point> {
        let mut is_first: Vec<Option<Point>> =
            now.records.in_first.vertices.iter().map(|v| v.get().map(|v| places[v.index()])).collect();
        for _ in 0..MAX_ATTEMPTS {
            let points: Vec<Point> =
                is_first.iter().zip(&self.points).map(|(place, here)| place.unwrap_or(*here)).collect();
            let turned = now.mover.check.newly_inverted(&points, self.threads);
            if turned.is_empty() {
                return points;
            }
            let vertices = turned.iter().flat_map(|cell| now.mesh.cells.vertices(*cell));
            vertices.for_each(|v| is_first[v.index()] = None);
        }
        self.points.clone()
    }
}

/// The history from `given`, which is `now` with all its arrays, to the first mesh; `None` if its cells
/// cannot be traced: lines that were divided, labels in other arrays.
fn history(given: &Mesh, now: &Current, first: &Mesh, threads: &Threads) -> Result<Option<History>> {
    let array =
        |mesh: &Mesh| [mesh.regions(), mesh.patches()].map(|labels| labels.map(|labels| labels.array));
    if array(given) != array(first) {
        return Ok(None);
    }
    let InFirst { vertices, cells } = &now.records.in_first;
    let vertices = inverse_ids(vertices, first.points.len());
    let cells = inverse_ids(cells, first.cells.len());
    match between(given, first, &vertices, &cells, threads) {
        Ok(history) => Ok(Some(history)),
        Err(e) if e.kind() == ErrorKind::Input => Ok(None),
        Err(e) => Err(e),
    }
}

/// For each entity of the first mesh its current id, or none: the inverse of `in_first`.
fn inverse_ids<I: Id>(in_first: &[MaybeId<I>], n_first: usize) -> Vec<MaybeId<I>> {
    let mut now = vec![MaybeId::NONE; n_first];
    for (i, first) in in_first.iter().enumerate() {
        if let Some(first) = first.get() {
            now[first.place()] = I::of(i).into();
        }
    }
    now
}

/// Sorts arrays into the order of others.
fn arrange(fields: &mut [Field], as_in: &[Field]) {
    fields.sort_by_key(|field| as_in.iter().position(|other| other.name == field.name));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::VertexId;

    #[test]
    fn ids_are_inverted() {
        let none = MaybeId::NONE;
        let [a, b, c] = [0, 1, 2].map(|v| MaybeId::from(VertexId(v)));
        assert_eq!(inverse_ids(&[c, none, a], 4), [c, none, a, none]);
        assert_eq!(inverse_ids(&[none, b], 2), [none, b]);
    }
}
