//! Changes of a surface, made only where it stays near the given one, faces the same way and crosses nothing.

use hashbrown::HashMap;

use super::cover::{Cover, Moves};
use super::features::{Features, Kind, length};
use super::lines::Line;
use super::near::Near;
use super::original::Original;
use super::sheet::{Change, Sheet, edges_of};
use crate::base::{Changes, Point, Threads, VertexId, sorted_ids};
use crate::geometry::segment;
use crate::geometry::triangle::{area_vector, centroid, largest_cosine, longest_side};
use crate::geometry::vector::{add, distance, dot, scale, unit};

/// A vertex that would move by less than this times the allowed distance stays in place.
const NEGLIGIBLE: f64 = 1e-6;

/// Edges longer than this times the allowed distance are checked at three places instead of one, and their
/// triangles at four.
const DENSE: f64 = 8.0;

/// Neighbours whose normals have a smaller cosine than this are folded onto each other: 165 degrees.
const MIN_FOLD: f64 = -0.966;

/// Why a change is not made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refusal {
    /// New triangles would stray too far from the given surface or face another way than it does, or parts of
    /// the given surface would be too far from them.
    Far,
    /// New triangles would be folded, cross others, or be narrower than those that they replace.
    Bad,
    /// Both ends of the edge must stay, or are on different lines.
    Held,
}

/// The surface as it is, and all that its changes are held against.
pub(super) struct Work<'a> {
    pub(super) sheet: Sheet,
    pub(super) features: Features,
    pub(super) original: Original,
    pub(super) cover: Cover,
    near: Near,
    /// The requested length of edges at each vertex.
    pub(super) sizes: Vec<f64>,
    pub(super) threads: &'a Threads,
    pub(super) max_triangles: usize,
    /// Whether sizes are smaller between walls that are near each other.
    pub(super) is_for_tets: bool,
    pub(super) changes: Changes,
    /// When it was last tried to collapse edges.
    pub(super) collapses: Tried,
    /// When it was last tried to move each vertex; 0: never.
    pub(super) moved: Vec<u32>,
}

impl<'a> Work<'a> {
    pub(super) fn new(
        sheet: Sheet,
        features: Features,
        original: Original,
        sizes: Vec<f64>,
        max_triangles: usize,
        threads: &'a Threads,
    ) -> Self {
        let cover = Cover::new(&sheet, &sizes, original.distance);
        let near = Near::new(&sheet);
        let changes = Changes::new();
        let (collapses, moved) = (Tried::new(), Vec::new());
        Self {
            cover,
            near,
            sheet,
            features,
            original,
            sizes,
            threads,
            max_triangles,
            is_for_tets: false,
            changes,
            collapses,
            moved,
        }
    }

    /// Keeps vertices where they are, and edges between them.
    pub(super) fn hold(&mut self, held: &[bool]) {
        self.features.held = held.to_vec();
        for v in (0..held.len()).filter(|&v| held[v]) {
            self.features.kinds[v] = Kind::Corner;
        }
    }

    /// Whether a vertex stays.
    pub(super) fn is_held(&self, v: VertexId) -> bool {
        self.features.is_held(v)
    }

    /// Whether an edge stays, since both of its ends do.
    pub(super) fn is_held_edge(&self, edge: [VertexId; 2]) -> bool {
        edge.iter().all(|v| self.is_held(*v))
    }

    /// The length requested of an edge.
    pub(super) fn size(&self, [u, v]: [VertexId; 2]) -> f64 {
        0.5 * (self.sizes[u.index()] + self.sizes[v.index()])
    }

    /// The length of an edge over that requested of it.
    pub(super) fn ratio(&self, edge: [VertexId; 2]) -> f64 {
        length(&self.sheet, edge) / self.size(edge)
    }

    /// Splits an edge in the middle; away from lines, the middle is moved onto the given surface where that
    /// is allowed.
    pub(super) fn split(&mut self, edge: [VertexId; 2]) -> bool {
        let middle = self.sheet.middle(edge);
        let is_line = self.features.is_line(edge);
        let Some(t) = self.sheet.at_edge(edge[0], edge[1]).next() else { return false };
        let label = self.sheet.label(t);
        let on_surface = self.original.near(label, middle, self.original.distance).map(|found| found.point);
        let is_off = |place: &Point| distance(*place, middle) > NEGLIGIBLE * self.original.distance;
        let place = on_surface.filter(is_off).filter(|_| !is_line);
        for place in [place, Some(middle)].into_iter().flatten() {
            let change = self.sheet.split(edge, place);
            let moves = match place == middle {
                true if self.near.crosses(&mut self.sheet, &change, true) => Err(Refusal::Bad),
                // A split in place leaves the surface where it is.
                true => self.cover.moves(&self.sheet, &change, f64::INFINITY).ok_or(Refusal::Far),
                false => self.allowed(&change),
            };
            let Ok(moves) = moves else { continue };
            let size = self.size(edge);
            let new = VertexId::new(self.sheet.points.len());
            self.commit(&change, &moves);
            if let Some(place) = on_surface {
                self.cover.add_near(&self.sheet, new, place);
            }
            self.sizes.push(size);
            self.features.kinds.push(if is_line { Kind::OnLine } else { Kind::Free });
            if is_line {
                let line = self.features.lines.remove(edge).unwrap_or_default();
                let is_crease = line.is_crease;
                let [a, b] = edge.map(|v| self.sheet.points[v.index()]);
                let is_nearer = |p: &Point| segment::closest([a, b], *p) < 0.5;
                let (first, second): (Vec<_>, Vec<_>) = line.places.into_iter().partition(is_nearer);
                self.features.lines.insert([edge[0], new], Line { places: first, is_crease });
                self.features.lines.insert([new, edge[1]], Line { places: second, is_crease });
            }
            return true;
        }
        false
    }

    /// Collapses an edge to the first place that `admits` the change, given the surface; places are the
    /// middle, moved onto the given surface, and the ends.
    ///
    /// # Errors
    /// When there is no such place: why not.
    pub(super) fn collapse(
        &mut self,
        edge: [VertexId; 2],
        admits: impl Fn(&Sheet, &Change) -> bool,
    ) -> Result<(), Refusal> {
        let [u, v] = edge;
        let is_line = self.features.is_line(edge);
        let [of_u, of_v] = edge.map(|v| self.sheet.points[v.index()]);
        let mut candidates: Vec<(VertexId, VertexId, Point)> = Vec::new();
        match (self.features.kind(u), self.features.kind(v)) {
            (Kind::Free, Kind::Free) => {
                let label = self.sheet.star(u).first().map_or(0, |&t| self.sheet.label(t));
                let middle = self.original.near(label, self.sheet.middle(edge), self.original.distance);
                candidates.extend(middle.map(|found| (v, u, found.point)));
                candidates.extend([(v, u, of_u), (u, v, of_v)]);
            }
            (_, Kind::Free) => candidates.push((v, u, of_u)),
            (Kind::Free, _) => candidates.push((u, v, of_v)),
            (Kind::OnLine, Kind::OnLine) if is_line => candidates.extend([(v, u, of_u), (u, v, of_v)]),
            (_, Kind::OnLine) if is_line => candidates.push((v, u, of_u)),
            (Kind::OnLine, _) if is_line => candidates.push((u, v, of_v)),
            _ => {}
        }
        let mut refusal = if candidates.is_empty() { Refusal::Held } else { Refusal::Bad };
        for (removed, kept, place) in candidates {
            let Some(change) = self.sheet.collapse(removed, kept, place) else { continue };
            let line = match is_line {
                true => match self.line_after(removed, kept) {
                    Ok(line) => Some(line),
                    Err(why) => {
                        refusal = why;
                        continue;
                    }
                },
                false => None,
            };
            if !admits(&self.sheet, &change) {
                continue;
            }
            match self.allowed(&change) {
                Ok(moves) => {
                    self.commit(&change, &moves);
                    self.sizes[kept.index()] = self.size(edge);
                    if let Some((end, line)) = line {
                        self.features.lines.remove(edge);
                        self.features.lines.remove([removed, end]);
                        self.features.lines.insert([kept, end], line);
                    }
                    return Ok(());
                }
                Err(Refusal::Far) => refusal = Refusal::Far,
                Err(_) => {}
            }
        }
        Err(refusal)
    }

    /// The line after one of its edges is collapsed: the other end of the line at the removed vertex, and the
    /// edge from there to the vertex that is kept.
    fn line_after(&self, removed: VertexId, kept: VertexId) -> Result<(VertexId, Line), Refusal> {
        let ends = self.features.line_ends(&self.sheet, removed);
        let end = ends.into_iter().find(|v| *v != kept).ok_or(Refusal::Bad)?;
        if self.features.is_line([kept, end]) {
            return Err(Refusal::Bad);
        }
        let line = self.joined_line([kept, removed, end]).ok_or(Refusal::Bad)?;
        let ends = [kept, end].map(|v| self.sheet.points[v.index()]);
        if line.places.iter().any(|p| distance(*p, on_segment(ends, *p)) > self.original.distance) {
            return Err(Refusal::Far);
        }
        Ok((end, line))
    }

    /// Two edges of a line as one, with the place of the vertex between them if the given line has it.
    fn joined_line(&self, [from, between, to]: [VertexId; 3]) -> Option<Line> {
        let [first, second] = [[from, between], [between, to]].map(|edge| self.features.lines.get(edge));
        let (first, second) = first.zip(second)?;
        let place = self.features.lines.is_on(between).then(|| self.sheet.points[between.index()]);
        let places = first.places.iter().chain(&place).chain(&second.places).copied().collect();
        Some(Line { places, is_crease: first.is_crease && second.is_crease })
    }

    /// Flips an edge, if `admits` the change.
    pub(super) fn flip(&mut self, edge: [VertexId; 2], admits: impl Fn(&Sheet, &Change) -> bool) -> bool {
        if self.features.is_line(edge) || self.is_held_edge(edge) {
            return false;
        }
        let Some(change) = self.sheet.flip(edge) else { return false };
        if !admits(&self.sheet, &change) {
            return false;
        }
        let Ok(moves) = self.allowed(&change) else { return false };
        self.commit(&change, &moves);
        true
    }

    /// Moves a vertex that is not on a line, if `admits` the change.
    pub(super) fn shift(
        &mut self,
        v: VertexId,
        place: Point,
        admits: impl Fn(&Sheet, &Change) -> bool,
    ) -> bool {
        let change = self.sheet.moved(v, place);
        if !admits(&self.sheet, &change) {
            return false;
        }
        let Ok(moves) = self.allowed(&change) else { return false };
        self.commit(&change, &moves);
        true
    }

    /// Moves a vertex of a line with two ends there, if `admits` the change and the given line stays near.
    pub(super) fn shift_line(
        &mut self,
        v: VertexId,
        place: Point,
        admits: impl Fn(&Sheet, &Change) -> bool,
    ) -> bool {
        let ends = self.features.line_ends(&self.sheet, v);
        let &[from, to] = ends.as_slice() else { return false };
        let segments = [[from, v], [v, to]]
            .map(|edge| edge.map(|w| if w == v { place } else { self.sheet.points[w.index()] }));
        let Some(Line { places, is_crease }) = self.joined_line([from, v, to]) else { return false };
        let mut parts = [Vec::new(), Vec::new()];
        for p in places {
            let [first, second] = segments.map(|segment| distance(p, on_segment(segment, p)));
            if first.min(second) > self.original.distance {
                return false;
            }
            parts[usize::from(second < first)].push(p);
        }
        if !self.shift(v, place, admits) {
            return false;
        }
        let [first, second] = parts;
        self.features.lines.insert([from, v], Line { places: first, is_crease });
        self.features.lines.insert([v, to], Line { places: second, is_crease });
        self.features.lines.set_off(v);
        true
    }

    fn allowed(&mut self, change: &Change) -> Result<Moves, Refusal> {
        let moves = self.allowed_near(change)?;
        if folds(&self.sheet, change) || self.near.crosses(&mut self.sheet, change, false) {
            return Err(Refusal::Bad);
        }
        Ok(moves)
    }

    /// Whether the new triangles are near the given surface, which is known of vertices and edges that stay
    /// as they are, and that surface near them.
    fn allowed_near(&self, change: &Change) -> Result<Moves, Refusal> {
        let sheet = &self.sheet;
        let placed = change.placed.map(|(v, _)| v);
        let is_old = |edge: &[VertexId; 2]| {
            !edge.iter().any(|v| Some(*v) == placed)
                && change.removed.iter().any(|&t| edge.iter().all(|v| sheet.triangle(t).contains(v)))
        };
        let mut seen: Vec<([VertexId; 2], u32)> = Vec::new();
        let is_long = |length: f64| length > DENSE * self.original.distance;
        let mixed = |a: Point, b: Point, share: f64| add(scale(a, 1.0 - share), scale(b, share));
        let mut last = None;
        for &(triangle, label) in &change.added {
            let corners = triangle.map(|v| sheet.place(change, v));
            let middle = centroid(corners);
            let mut is_near = |p: Point| self.original.is_near(label, p, &mut last);
            let is_large = is_long(longest_side(corners));
            if !self.original.faces(label, corners)
                || is_large && !corners.into_iter().all(|p| is_near(mixed(middle, p, 0.5)))
            {
                return Err(Refusal::Far);
            }
            for edge in edges_of(triangle).map(sorted_ids) {
                if seen.contains(&(edge, label)) || is_old(&edge) {
                    continue;
                }
                seen.push((edge, label));
                let [a, b] = edge.map(|v| sheet.place(change, v));
                let shares: &[f64] = if is_long(distance(a, b)) { &[0.5, 0.25, 0.75] } else { &[0.5] };
                if !shares.iter().all(|share| is_near(mixed(a, b, *share))) {
                    return Err(Refusal::Far);
                }
            }
        }
        self.cover.moves(sheet, change, self.original.distance).ok_or(Refusal::Far)
    }

    fn commit(&mut self, change: &Change, moves: &Moves) {
        self.near.remove(&self.sheet, change);
        let ids = self.sheet.commit(change);
        self.near.add(&self.sheet, &ids);
        self.cover.commit(change, moves, &ids);
        self.changes.record(change.added.iter().flat_map(|(t, _)| *t));
    }
}

fn on_segment(ends: [Point; 2], p: Point) -> Point {
    segment::at(ends, segment::closest(ends, p))
}

/// Whether a change folds triangles onto their neighbours where none was folded: they would not cross, but
/// be apart by rounding alone.
fn folds(sheet: &Sheet, change: &Change) -> bool {
    let before = |v: VertexId| sheet.points[v.index()];
    let old: Vec<[VertexId; 3]> = change.removed.iter().map(|&t| sheet.triangle(t)).collect();
    let new: Vec<[VertexId; 3]> = change.added.iter().map(|(t, _)| *t).collect();
    sharpest(sheet, change, &new, |v| sheet.place(change, v)) < MIN_FOLD
        && sharpest(sheet, change, &old, before) >= MIN_FOLD
}

/// The least cosine between the normals of neighbours across an edge, of `triangles` among each other and
/// with those that a change does not remove.
fn sharpest(
    sheet: &Sheet,
    change: &Change,
    triangles: &[[VertexId; 3]],
    place: impl Fn(VertexId) -> Point,
) -> f64 {
    let normal = |t: [VertexId; 3]| unit(area_vector(t.map(&place)));
    let normals: Vec<Option<Point>> = triangles.iter().map(|t| normal(*t)).collect();
    let mut least: f64 = 1.0;
    for (k, t) in triangles.iter().enumerate() {
        let Some(own) = normals[k] else { continue };
        for [a, b] in edges_of(*t) {
            let among = triangles[..k].iter().position(|other| edges_of(*other).contains(&[b, a]));
            let other = match among {
                Some(i) => normals[i],
                None => sheet
                    .at_edge(a, b)
                    .filter(|other| !change.removed.contains(other))
                    .map(|other| sheet.triangle(other))
                    .find(|other| edges_of(*other).contains(&[b, a]))
                    .and_then(normal),
            };
            least = other.map_or(least, |other| least.min(dot(own, other)));
        }
    }
    least
}

/// The largest cosines of the triangles before and after a change.
pub(super) fn cosines(sheet: &Sheet, change: &Change) -> [f64; 2] {
    let before = change.removed.iter().map(|&t| largest_cosine(sheet.corners(t))).fold(-1.0, f64::max);
    let after = sheet.corners_after(change).map(largest_cosine).fold(-1.0, f64::max);
    [before, after]
}

/// When changes of edges were last tried.
pub(super) type Tried = HashMap<[VertexId; 2], u32>;

/// Whether a thing with these vertices, last tried at this time, was not tried yet, or something at them has
/// changed since; it is being tried now.
pub(super) fn is_due(changes: &Changes, tried: &mut u32, vertices: &[VertexId]) -> bool {
    let time = std::mem::replace(tried, changes.now());
    !vertices.iter().all(|v| changes.none_since(*v, time))
}
