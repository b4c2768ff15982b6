//! On which side of a surface the line to another one starts.

use super::super::Side;
use super::measure::Part;
use super::sites::{SiteId, Sites};
use crate::base::{BodyId, Point};
use crate::geometry::distance::{Feature, point_segment, point_triangle};
use crate::geometry::triangle::{area_vector, normal_where_they_meet};
use crate::geometry::vector::{dot, norm, scale, sub};

/// Whether the direction `along`, from the point of a part with these weights, starts on this side of the
/// body; one within the surface starts on both.
///
/// The side is that of a point a little farther along, by the nearest point of the triangles around: by the
/// normal of the triangle, the sum of the two normals at an edge, or the sum of the normals weighted by their
/// angles at a vertex (Baerentzen and Aanaes 2005). The step is a quarter of the distance to where these
/// triangles end, so that nothing else can be nearest.
pub(super) fn starts_on(
    side: Side,
    part: &Part,
    on: &[f64; 4],
    along: Point,
    sites: &Sites,
    points: &[Point],
) -> bool {
    if side == Side::Both {
        return true;
    }
    let held = (0..4).filter(|&i| on[i] != 0.0);
    let feature: Vec<SiteId> = held.filter_map(|i| part.sites[i].get()).collect();
    let from = part.at(on);
    let star = Star::new(part.body, &feature, from, sites, points);
    let length = norm(along);
    if !(length > 0.0 && star.reach > 0.0 && star.reach.is_finite()) {
        return true;
    }
    let ahead = star.height(scale(along, 0.25 * star.reach / length));
    match side {
        Side::Both => true,
        Side::Outside => ahead >= 0.0,
        Side::Inside => ahead <= 0.0,
    }
}

/// The triangles around a point of a surface, relative to it.
struct Star {
    triangles: Vec<[Point; 3]>,
    sites: Vec<[SiteId; 3]>,
    /// The distance of the nearest edge that the point is not on.
    reach: f64,
}

impl Star {
    fn new(body: BodyId, feature: &[SiteId], from: Point, sites: &Sites, points: &[Point]) -> Self {
        let mut star = Self { triangles: Vec::new(), sites: Vec::new(), reach: f64::INFINITY };
        for t in sites.star_of(body, feature) {
            let corners = sites.corners[t].map(|v| sub(points[v.index()], from));
            if area_vector(corners) == [0.0; 3] {
                continue;
            }
            let ids = sites.triangles[t];
            for i in 0..3 {
                let [j, k] = [(i + 1) % 3, (i + 2) % 3];
                if !feature.iter().all(|s| [ids[j], ids[k]].contains(s)) {
                    let away = point_segment::closest([0.0; 3], [corners[j], corners[k]]);
                    star.reach = star.reach.min(away.distance());
                }
            }
            star.triangles.push(corners);
            star.sites.push(ids);
        }
        star
    }

    /// How far a place is above the surface, along the normal at its nearest point; only the sign counts.
    fn height(&self, place: Point) -> f64 {
        let nearest = self.triangles.iter().map(|t| point_triangle::closest(place, *t)).enumerate();
        let nearest = nearest.min_by(|x, y| x.1.distance_squared.total_cmp(&y.1.distance_squared));
        let Some((t, closest)) = nearest else { return 0.0 };
        let own = match closest.features()[1] {
            Feature::Face => vec![self.sites[t][0], self.sites[t][1], self.sites[t][2]],
            Feature::Edge(i) => [1, 2].map(|k| self.sites[t][(usize::from(i) + k) % 3]).to_vec(),
            Feature::Vertex(i) => vec![self.sites[t][usize::from(i)]],
        };
        let around = self.sites.iter().zip(&self.triangles);
        let around = around.filter(|(ids, _)| own.iter().all(|s| ids.contains(s)));
        let corner = |ids: &[SiteId; 3]| match own.as_slice() {
            &[one] => ids.iter().position(|&s| s == one),
            _ => None,
        };
        let sum = normal_where_they_meet(around.map(|(ids, t)| (*t, corner(ids))));
        // The offset runs from the place to its nearest point.
        -dot(sum, closest.offset)
    }
}
