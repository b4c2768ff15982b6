//! The point deepest inside half-spaces: the one farthest from the nearest of their planes.
//!
//! This is a linear program in three coordinates and the depth, solved one constraint at a time: where the
//! optimum so far violates a constraint, the new optimum lies on it, which leaves the same problem with one
//! unknown fewer (Seidel 1991, *Small-dimensional linear programming and convex hulls made easy*). The
//! expected time is linear in the number of half-spaces.

use crate::base::{Point, splitmix64};

/// The number of unknowns of the program: three coordinates, then the depth.
const N: usize = 4;

/// The bound on the magnitude of coordinates and depth.
const REACH: f64 = 1.0;

/// The starting value of an unknown that no constraint has bounded yet.
const FAR: f64 = 16.0;

/// Coefficients, and violations of constraints, below this are rounding.
const ROUNDING: f64 = 1e-15;

/// `a . x <= b`
#[derive(Clone, Copy)]
struct Constraint {
    a: [f64; N],
    b: f64,
}

impl Constraint {
    fn is_violated(&self, x: &[f64; N]) -> bool {
        self.excess(x) > ROUNDING
    }

    /// `a . x - b`
    fn excess(&self, x: &[f64; N]) -> f64 {
        self.a.iter().zip(x).map(|(a, x)| a * x).sum::<f64>() - self.b
    }

    /// The unknown with the largest coefficient, unless all coefficients are zero up to rounding.
    fn largest(&self) -> Option<usize> {
        let largest = (0..N).max_by(|&i, &j| self.a[i].abs().total_cmp(&self.a[j].abs()))?;
        (self.a[largest].abs() > ROUNDING).then_some(largest)
    }

    /// This constraint with `x[gone]` eliminated by requiring equality in `other`.
    fn on(&self, other: &Self, eliminated: usize) -> Self {
        let share = self.a[eliminated] / other.a[eliminated];
        let mut a: [f64; N] = std::array::from_fn(|i| self.a[i] - share * other.a[i]);
        a[eliminated] = 0.0;
        Self { a, b: self.b - share * other.b }
    }
}

/// The point of the cube from -1 to 1 that is deepest inside the half-spaces `normal . p >= offset`, and its
/// depth: negative where no point is inside all of them. Normals must be unit vectors. Accurate to a few
/// roundings.
pub(crate) fn deepest(half_spaces: impl Iterator<Item = (Point, f64)>) -> (Point, f64) {
    let mut constraints: Vec<Constraint> =
        half_spaces.map(|([x, y, z], offset)| Constraint { a: [-x, -y, -z, 1.0], b: -offset }).collect();
    for unknown in 0..N {
        for side in [1.0, -1.0] {
            let mut a = [0.0; N];
            a[unknown] = side;
            constraints.push(Constraint { a, b: REACH });
        }
    }
    shuffle(&mut constraints);
    let depth = Constraint { a: [0.0, 0.0, 0.0, 1.0], b: 0.0 };
    let [x, y, z, depth] = maximum(&constraints, depth, &[0, 1, 2, 3]);
    ([x, y, z], depth)
}

/// Shuffles the constraints, in the same way every time, so that their order does not depend on that of the
/// input.
fn shuffle(constraints: &mut [Constraint]) {
    for i in (1..constraints.len()).rev() {
        constraints.swap(i, splitmix64(i as u64) as usize % (i + 1));
    }
}

/// The point that maximises `of . x` over the given unknowns; the others are 0.
fn maximum(constraints: &[Constraint], of: Constraint, unknowns: &[usize]) -> [f64; N] {
    if let [last] = *unknowns {
        let mut x = [0.0; N];
        x[last] = farthest(constraints, of.a[last], last);
        return x;
    }
    let mut x = [0.0; N];
    unknowns.iter().filter(|&&i| of.a[i] != 0.0).for_each(|&i| x[i] = FAR.copysign(of.a[i]));
    for (i, tight) in constraints.iter().enumerate() {
        if !tight.is_violated(&x) {
            continue;
        }
        let Some(eliminated) = tight.largest() else { continue };
        let before: Vec<Constraint> = constraints[..i].iter().map(|c| c.on(tight, eliminated)).collect();
        let others: Vec<usize> = unknowns.iter().copied().filter(|&i| i != eliminated).collect();
        x = maximum(&before, of.on(tight, eliminated), &others);
        x[eliminated] = -tight.excess(&x) / tight.a[eliminated];
    }
    x
}

/// The extreme permitted value of the only unknown in the direction of `slope`.
fn farthest(constraints: &[Constraint], slope: f64, unknown: usize) -> f64 {
    let [mut low, mut high] = [-FAR, FAR];
    for constraint in constraints {
        let a = constraint.a[unknown];
        if a > ROUNDING {
            high = high.min(constraint.b / a);
        } else if a < -ROUNDING {
            low = low.max(constraint.b / a);
        }
    }
    // Only by rounding can they have passed each other.
    match slope {
        _ if low > high => 0.5 * (low + high),
        s if s > 0.0 => high,
        s if s < 0.0 => low,
        _ => 0.0f64.clamp(low, high),
    }
}

#[cfg(test)]
mod tests {
    use super::deepest;
    use crate::base::Point;
    use crate::geometry::tet::{FACETS, volume};
    use crate::geometry::triangle::area_vector;
    use crate::geometry::vector::{dot, norm, scale, sub};
    use proptest::prelude::*;

    /// The half-spaces bounded by the planes of these faces, seen from inside.
    fn inside(faces: impl Iterator<Item = [Point; 3]>) -> Vec<(Point, f64)> {
        let half_space = |face: [Point; 3]| {
            let outwards = area_vector(face);
            let normal = scale(outwards, -1.0 / norm(outwards));
            (normal, dot(normal, face[0]))
        };
        faces.map(half_space).collect()
    }

    fn height(half_spaces: &[(Point, f64)], p: Point) -> f64 {
        half_spaces.iter().map(|&(normal, offset)| dot(normal, p) - offset).fold(f64::INFINITY, f64::min)
    }

    fn number() -> impl Strategy<Value = f64> {
        prop_oneof![-0.9..0.9f64, (-2i8..3).prop_map(|i| f64::from(i) / 4.0)]
    }

    proptest! {
        #[test]
        fn in_a_tet_it_is_the_middle_of_the_sphere_inscribed(
            corners in prop::array::uniform4(prop::array::uniform3(number())),
            flatness in prop_oneof![Just(1.0), Just(1e-3), Just(1e-9)],
        ) {
            let mut corners = corners.map(|[x, y, z]| [x, y, z * flatness]);
            if volume(corners) < 0.0 {
                corners.swap(0, 1);
            }
            prop_assume!(volume(corners) > 1e-3 * flatness);
            let faces = FACETS.map(|facet| facet.map(|i| corners[i]));
            let radius = 3.0 * volume(corners) / faces.iter().map(|&f| norm(area_vector(f))).sum::<f64>();
            let half_spaces = inside(faces.into_iter());
            let (p, depth) = deepest(half_spaces.iter().copied());
            prop_assert!((depth - radius).abs() < 1e-6 * radius + 1e-14, "{depth} for {radius}");
            prop_assert!((height(&half_spaces, p) - radius).abs() < 1e-6 * radius + 1e-14);
        }

        #[test]
        fn no_other_point_is_deeper(
            planes in prop::collection::vec((prop::array::uniform3(number()), -0.5..0.3f64), 1..30),
            others in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 200),
        ) {
            let is_long = |normal: &Point| norm(*normal) > 0.1;
            let half_spaces: Vec<(Point, f64)> = planes
                .into_iter()
                .filter(|(normal, _)| is_long(normal))
                .map(|(normal, offset)| (scale(normal, 1.0 / norm(normal)), offset))
                .collect();
            let (p, depth) = deepest(half_spaces.iter().copied());
            prop_assert!(p.iter().all(|x| x.abs() <= 1.0 + 1e-12) && depth <= 1.0 + 1e-12);
            prop_assert!((height(&half_spaces, p).min(1.0) - depth).abs() < 1e-12);
            for other in others {
                prop_assert!(height(&half_spaces, other).min(1.0) <= depth + 1e-12);
                // No point nearby is deeper either.
                let near = sub(p, scale(sub(p, other), 1e-3));
                prop_assert!(height(&half_spaces, near).min(1.0) <= depth + 1e-12);
            }
        }
    }
}
