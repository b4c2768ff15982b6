//! The insertion loop: find a tet in conflict, dig the cavity, fill it (Bowyer 1981; Watson 1981).
//!
//! The whole loop is compiled twice, for any machine and for one with AVX2 and FMA, and dispatched once per
//! thousands of points: everything it calls is inlined or dispatched with it. The signs are exact either way,
//! so the results agree.

use super::cavity::Cavity;
use super::conflict::Newcomer;
use super::fill::Fill;
use super::gauge::LEAST;
use super::input::sides;
use super::start::first_tet;
use super::store::{MAX_TETS, Store};
use super::walk::walk;
use crate::base::{Error, Point, Result, Watch};
use crate::geometry::predicates::pair::U;
use pulp::{Arch, Simd, WithSimd};

/// Triangulates distinct points, of which the first four span a tet. Point 0 is not used: vertex 0 is the one
/// at infinity. `filtered` states whether floating-point filters may be trusted.
pub(super) fn triangulate(points: &[Point], filtered: bool, watch: &Watch) -> Result<Store> {
    let least = if filtered { LEAST } else { f32::INFINITY };
    // A million uniform points give 6.77 tets per point, and 1.01 ghosts per hull facet.
    let mut store = Store::with_capacity(7 * points.len() + 64);
    first_tet(&mut store, points, least);
    let sure = if filtered { static_bound(points) } else { f64::INFINITY };
    let mut fill = Fill::new(points.len(), least);
    let (n, mut hint, arch) = (points.len() as u32, 0, Arch::new());
    for from in (5..n).step_by(RUN as usize) {
        watch.report_and_check("triangulating points", from as usize, points.len())?;
        let vertices = from..n.min(from.saturating_add(RUN));
        hint =
            arch.dispatch(Insertion { store: &mut store, points, sure, fill: &mut fill, vertices, hint })?;
    }
    Ok(store)
}

/// Bounds the error of any 3x3 determinant of differences within the box: 8 u times six products, doubled.
fn static_bound(points: &[Point]) -> f64 {
    let [x, y, z] = sides(&points[1..]);
    16.0 * U * 6.0 * (x * y * z) + f64::MIN_POSITIVE
}

/// The watch is consulted each time this many points have been inserted.
const RUN: u32 = 8192;

/// The insertion loop with the data it works on.
struct Insertion<'a> {
    store: &'a mut Store,
    points: &'a [Point],
    sure: f64,
    fill: &'a mut Fill,
    vertices: std::ops::Range<u32>,
    /// The tet where the first walk starts.
    hint: u32,
}

impl WithSimd for Insertion<'_> {
    type Output = Result<u32>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Result<u32> {
        let mut cavity = Cavity::default();
        let mut hint = self.hint;
        for vertex in self.vertices {
            let new = Newcomer { vertex, point: self.points[vertex as usize] };
            let Some(first) = walk(simd, self.store, self.points, hint, new, self.sure) else {
                unreachable!("the points are distinct, so each is in conflict with the tet that holds it");
            };
            cavity.dig(simd, self.store, self.points, first, new);
            if self.store.n_slots() + cavity.facets().len() > MAX_TETS {
                return Err(Error::input(format!("more than {MAX_TETS} tets")).remedy("divide the set"));
            }
            hint = self.fill.fill(simd, self.store, self.points, &mut cavity, new);
        }
        Ok(hint)
    }
}
