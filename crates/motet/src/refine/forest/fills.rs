//! The best way to fill tets some or all of whose edges are split. It follows from the reference and the rule
//! alone, so results stay valid; and it follows from the shape, so it is computed once per class. In a mesh
//! divided five times towards a point that saved a fifth of the instructions.

use hashbrown::HashMap;

use super::bey;
use super::bounds::ShapeBounds;
use super::classes::{Class, ClassId, corners_at, inner_part};
use super::eight::ends;
use super::patterns::patterns;
use super::{Forest, with_middles};
use crate::base::{NodeId, Point, Threads};
use crate::geometry::quality::eas;
use crate::geometry::vector::{dot, sub};
use crate::refine::Rule;

/// The least number of divisions that a thread decides at a time.
const MIN_DIVISIONS: usize = 64;

/// How tets of a class are cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fill {
    /// The index of the pattern.
    pub(super) way: u8,
    /// The EAS of the worst piece; minus infinity if there is no way.
    pub(super) worst: f64,
}

/// What is known so far.
#[derive(Clone, Debug, Default)]
pub(super) struct Fills {
    /// Cuts, keyed by class, split edges and cuts of facets.
    cuts: HashMap<u64, Fill>,
    /// Ways to divide classes none of whose tets was divided yet.
    divisions: HashMap<ClassId, Way>,
}

impl Fills {
    pub(super) fn extend(&mut self, found: Self) {
        self.cuts.extend(found.cuts);
        self.divisions.extend(found.divisions);
    }

    /// The size in bytes: an entry of a hash map takes one byte more.
    pub(super) fn memory(&self) -> usize {
        self.cuts.capacity() * (size_of::<(u64, Fill)>() + 1)
            + self.divisions.capacity() * (size_of::<(ClassId, Way)>() + 1)
    }
}

/// Computes what is not known yet.
pub(super) struct Finder<'a> {
    pub(super) forest: &'a Forest,
    pub(super) bounds: ShapeBounds,
    found: Fills,
}

impl<'a> Finder<'a> {
    pub(super) fn new(forest: &'a Forest, bounds: ShapeBounds) -> Self {
        Self { forest, bounds, found: Fills::default() }
    }

    /// Returns what was computed.
    pub(super) fn into_found(self) -> Fills {
        self.found
    }

    /// How the facets of a tet are cut, and how it is then filled.
    pub(super) fn cut(&mut self, node: NodeId, mask: u8) -> (u8, Fill) {
        let forest = self.forest;
        let cuts = forest.cuts(node, mask);
        let class = forest.nodes[node.index()].shape.class();
        let key = u64::from(class.0) << 10 | u64::from(mask) << 4 | u64::from(cuts);
        let find = || best_cut(&with_middles(forest.corners_of_class(class)), mask, cuts);
        let known = forest.fills.cuts.get(&key);
        (cuts, known.copied().unwrap_or_else(|| *self.found.cuts.entry(key).or_insert_with(find)))
    }

    /// The worst EAS after dividing tets of a class.
    pub(super) fn divided(&mut self, class: ClassId) -> f64 {
        let forest = self.forest;
        let whole = forest.classes[class.index()].eas;
        if let Some([first, second]) = forest.best_classes(class) {
            return whole.min(first.eas).min(second.eas);
        }
        let known = forest.fills.divisions.get(&class);
        let find = || best_division(forest, class, self.bounds);
        known.unwrap_or_else(|| self.found.divisions.entry(class).or_insert_with(find)).worst(whole)
    }
}

impl Forest {
    /// Decides in which way each of these tets is divided.
    pub(super) fn decide(
        &mut self,
        tets: &[NodeId],
        bounds: ShapeBounds,
        threads: &Threads,
    ) -> Vec<(NodeId, u8)> {
        let class_of = |forest: &Self, node: &NodeId| forest.nodes[node.index()].shape.class();
        let mut is_open: Vec<bool> = self.classes.iter().map(|class| class.best.is_none()).collect();
        let classes = tets.iter().map(|node| class_of(self, node));
        let open: Vec<ClassId> =
            classes.filter(|class| std::mem::take(&mut is_open[class.index()])).collect();
        let ways = threads.map_parts(open.len(), MIN_DIVISIONS, |i| {
            let known = self.fills.divisions.get(&open[i]).copied();
            known.unwrap_or_else(|| best_division(self, open[i], bounds))
        });
        for (class, way) in open.into_iter().zip(ways) {
            self.fills.divisions.remove(&class);
            self.classes[class.index()].best = Some(way.place as u8);
            self.add_classes(class, way.place, way.inner);
        }
        let way = |node: &NodeId| (*node, self.classes[class_of(self, node).index()].best.unwrap_or(0));
        tets.iter().map(way).collect()
    }
}

fn best_division(forest: &Forest, class: ClassId, bounds: ShapeBounds) -> Way {
    let places = with_middles(forest.corners_of_class(class));
    match bounds.rule {
        Rule::Shortest => {
            let Class { eas, root_eas, .. } = forest.classes[class.index()];
            best_way(&places, eas, bounds.floor(root_eas))
        }
        Rule::Bey => Way::new(&places, bey::way(forest, class)),
    }
}

/// Among all ways to fill a tet with these edges split, the one whose worst tet is best.
fn best_cut(places: &[Point; 10], mask: u8, cuts: u8) -> Fill {
    let mut best = Fill { way: 0, worst: f64::NEG_INFINITY };
    for (tets, way) in patterns(mask, cuts).iter().zip(0..) {
        let mut worst = f64::INFINITY;
        for tet in tets {
            worst = eas(corners_at(places, tet)).abs().min(worst);
            if worst <= best.worst {
                break;
            }
        }
        if worst > best.worst {
            best = Fill { way, worst };
        }
    }
    best
}

/// Which of the three ways to divide a tet of the given EAS into eight: along the shortest diagonal of the
/// octahedron (Zhang 1995, *Successive subdivisions of tetrahedra and multigrid methods on tetrahedral
/// meshes*), unless one of the eight, or of their parts, would be below the floor: then along the diagonal
/// with the best parts.
fn best_way(places: &[Point; 10], whole: f64, floor: f64) -> Way {
    let length = |place: usize| {
        let [p, q] = ends(place);
        let along = sub(places[q], places[p]);
        dot(along, along)
    };
    let shortest = (0..3).reduce(|x, y| if length(y) < length(x) { y } else { x }).unwrap_or(0);
    let way = Way::new(places, shortest);
    // Two generations hardly more than halve the quality.
    let worst = way.worst(whole);
    if worst >= 2.0 * floor || worst >= floor && worst_below(places, &way, whole, 1) >= floor {
        return way;
    }
    let below = |place: usize| {
        let way = Way::new(places, place);
        (worst_below(places, &way, whole, 2), way)
    };
    let [mut best, second, third] = [0, 1, 2].map(below);
    for other in [second, third] {
        best = if other.0 > best.0 { other } else { best };
    }
    best.1
}

/// The worst EAS of the eight parts and of this many generations below, each along its best diagonal.
fn worst_below(places: &[Point; 10], way: &Way, whole: f64, generations: usize) -> f64 {
    let mut worst = way.worst(whole);
    if generations == 0 {
        return worst;
    }
    // Corner parts have the shape of the whole.
    for (inner, shape) in way.inner.into_iter().enumerate() {
        let places = with_middles(corners_at(places, inner_part(way.place, inner)));
        let below = |place| worst_below(&places, &Way::new(&places, place), shape, generations - 1);
        worst = (0..3).map(below).fold(f64::NEG_INFINITY, f64::max).min(worst);
    }
    worst
}

/// One of the three ways to divide a tet into eight.
#[derive(Clone, Copy, Debug)]
struct Way {
    place: usize,
    /// The EAS of the inner parts; the others have the shape of the whole.
    inner: [f64; 2],
}

impl Way {
    fn new(places: &[Point; 10], place: usize) -> Self {
        let inner = [0, 1].map(|k| eas(corners_at(places, inner_part(place, k))).abs());
        Self { place, inner }
    }

    fn worst(&self, whole: f64) -> f64 {
        self.inner.into_iter().fold(whole, f64::min)
    }
}
