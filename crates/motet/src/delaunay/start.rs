//! The first tet: four points in general position, and the four ghosts around them.

use super::gauge::{Arm, of_ghost, of_tet};
use super::store::{FACETS, INFINITY, Tets, is_ghost};
use crate::base::{Error, Point, Result};
use crate::geometry::predicates::{collinear, orient3d};
use crate::geometry::vector::sub;
use pulp::Scalar;

/// Moves four points that span a tet to the front of `ids` (distinct points in the order of insertion).
pub(super) fn bring_tet_to_front(ids: &mut [u32], points: &[Point]) -> Result<()> {
    let point = |id: u32| points[id as usize];
    let all = format!("{} distinct points", ids.len());
    let remedy = "give at least four points that span a volume";
    if ids.len() < 4 {
        return Err(Error::input(format!("{all}, expected at least 4")).remedy(remedy));
    }
    let (a, b) = (point(ids[0]), point(ids[1]));
    let third = ids[2..].iter().position(|&id| !collinear(a, b, point(id)));
    let third = third.ok_or_else(|| Error::input(format!("all {all} lie on one line")).remedy(remedy))?;
    ids.swap(2, 2 + third);
    let c = point(ids[2]);
    let fourth = ids[3..].iter().position(|&id| orient3d(a, b, c, point(id)) != 0);
    let fourth = fourth.ok_or_else(|| Error::input(format!("all {all} lie in one plane")).remedy(remedy))?;
    ids.swap(3, 3 + fourth);
    Ok(())
}

/// Makes the tet of vertices 1 to 4, in slot 0, and its ghosts, in slots 1 to 4.
pub(super) fn first_tet(tets: Tets, points: &[Point], least: f32) {
    let [a, b, c, d] = [1, 2, 3, 4].map(|v| points[v]);
    let tet = if orient3d(a, b, c, d) > 0 { [1, 2, 3, 4] } else { [1, 3, 2, 4] };
    put(tets, 0, points, tet, least);
    for (slot, facet) in (1..).zip(FACETS) {
        let [i, j, k] = facet.map(|v| tet[v]);
        put(tets, slot, points, [i, j, k, INFINITY], least);
    }
    link_all(tets);
}

fn put(tets: Tets, slot: u32, points: &[Point], vertices: [u32; 4], least: f32) {
    let [a, i, j, k] = vertices;
    let [b, c, d] = [i, j, k].map(|v| Arm::new::<Scalar>(sub(points[v as usize], points[a as usize])));
    tets.vertices.set(slot, vertices);
    let gauge = match is_ghost(vertices) {
        true => of_ghost::<Scalar>(a, [&b, &c], 0, least),
        false => of_tet::<Scalar>(a, [&b, &c, &d], 0, least),
    };
    tets.gauges.set(slot, gauge);
}

/// Links facets with equal vertices by comparing all pairs; there are only five tets.
fn link_all(tets: Tets) {
    let sides: Vec<(u32, [u32; 3])> = (0..20u32)
        .map(|side| {
            let vertices = tets.vertices.get(side / 4);
            let mut facet = FACETS[side as usize % 4].map(|i| vertices[i]);
            facet.sort_unstable();
            (side, facet)
        })
        .collect();
    for &(side, facet) in &sides {
        let twin = sides.iter().find(|&&(other, same)| other != side && same == facet);
        tets.set_link(side, twin.map_or(0, |t| t.0));
    }
}
