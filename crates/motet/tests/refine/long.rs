//! Long refinement: towards a target, generation after generation, and behind a front, with each step checked
//! against the promises; and the number of shapes that result.

use crate::common::invariants::{First, corners};
use crate::common::{Numbers, random_mesh};
use motet::base::{Point, TetId, Threads, VertexId};
use motet::geometry::tet::{EDGES, centroid, volume};
use motet::geometry::vector::{distance, sub};
use motet::mesh::shapes::box_grid;
use motet::mesh::{TetMesh, TetPart};
use motet::refine::{Options, Refinement};
use proptest::prelude::*;

/// A box with a region on either side of a jagged interface, which is a patch as its sides are. Inner
/// vertices are a little off the grid.
fn box_of_two() -> TetMesh {
    let high = [5.0, 4.0, 4.0];
    let mut mesh = TetPart::of(&box_grid([5, 4, 4], [[0.0; 3], high])).unwrap().mesh;
    let mut numbers = Numbers(7);
    for p in &mut mesh.points {
        if (0..3).all(|k| p[k] > 0.0 && p[k] < high[k]) {
            *p = p.map(|x| x + 0.4 * (numbers.unit() - 0.5));
        }
    }
    let is_left = |t: &[VertexId; 4]| centroid(corners(&mesh, *t))[0] < 1.7;
    let left: Vec<bool> = mesh.tets.iter().map(is_left).collect();
    mesh.regions = left.iter().map(|left| if *left { 3 } else { 7 }).collect();
    let mut interface = Vec::new();
    motet::mesh::tet_facets::for_each_tet_facet(&mesh.tets, &[], |sharing| {
        if let &[(s, i), (t, _)] = sharing.tets
            && left[s.index()] != left[t.index()]
        {
            interface.push(motet::geometry::tet::FACETS[i].map(|k| mesh.tets[s.index()][k]));
        }
    });
    mesh.patches.resize(mesh.triangles.len() + interface.len(), 9);
    mesh.triangles.extend(interface);
    mesh
}

fn meshes() -> [(&'static str, TetMesh); 2] {
    [("box", box_of_two()), ("random", random_mesh(120, 5))]
}

fn tets_where(mesh: &TetMesh, is_marked: impl Fn(TetId, [Point; 4]) -> bool) -> Vec<TetId> {
    let all = (0..mesh.tets.len()).map(TetId::new);
    all.filter(|t| is_marked(*t, corners(mesh, mesh.tets[t.index()]))).collect()
}

/// Eight generations: divides the tets in an ellipsoid about a place, with half axes in these proportions,
/// that shrinks by these factors and holds twelve tets at first.
fn towards(axes: Point, factors: Point) {
    let threads = Threads::single();
    for (name, mesh) in meshes() {
        let first = First::new(mesh, &threads);
        let mut refinement = Refinement::new(&first.mesh, Options::default(), &threads).unwrap();
        let place = centroid(corners(&first.mesh, first.mesh.tets[first.mesh.tets.len() / 2]));
        let out = |corners: [Point; 4], generation: i32| {
            let away = sub(centroid(corners), place);
            distance([0, 1, 2].map(|k| away[k] / (axes[k] * factors[k].powi(generation))), [0.0; 3])
        };
        let mut all: Vec<f64> = first.mesh.tets.iter().map(|t| out(corners(&first.mesh, *t), 0)).collect();
        all.sort_by(f64::total_cmp);
        for generation in 0..8 {
            let marked = tets_where(refinement.mesh(), |_, c| out(c, generation) <= all[11]);
            assert!(!marked.is_empty());
            let summary = refinement.refine(&marked, &threads).unwrap();
            let kept = first.compare(&refinement, &threads);
            let worst = kept.quality.worst / first.quality.worst;
            println!("{name} {}: {summary:?} worst {worst:.3}", generation + 1);
            assert!(kept.broken.is_empty(), "{name} {generation}: {:?}", kept.broken);
            assert!(worst >= 0.9 && kept.roots.is_empty());
        }
        assert_eq!(refinement.generations().max(), Some(8));
    }
}

#[test]
fn towards_a_point_all_is_kept() {
    towards([1.0; 3], [0.6; 3]);
}

#[test]
fn towards_a_line_all_is_kept() {
    towards([1.0, 1.0, 4.0], [0.5, 0.5, 0.8]);
}

#[test]
fn towards_a_surface_all_is_kept() {
    towards([4.0, 4.0, 1.0], [0.62, 0.62, 0.5]);
}

/// In a uniform box all tets are as bad as the worst, and any cut is worse: if the worst were kept, the whole
/// box would be divided.
#[test]
fn in_an_even_box_a_division_stays_where_it_is() {
    let threads = Threads::single();
    let mesh = TetPart::of(&box_grid([4; 3], [[0.0; 3], [4.0; 3]])).unwrap().mesh;
    let mut refinement = Refinement::new(&mesh, Options::default(), &threads).unwrap();
    let summary = refinement.refine(&[TetId(0)], &threads).unwrap();
    println!("{} tets: {summary:?}", mesh.tets.len());
    assert!(summary.n_promoted < mesh.tets.len() / 4);
}

/// A front at x: tets that it reaches are divided, up to generation 2; divisions that it has left are taken
/// back.
fn pass(refinement: &mut Refinement, x: f64, stride: f64, threads: &Threads) {
    let reach = |c: [Point; 4]| {
        let [low, high] = [f64::min, f64::max].map(|of| c.map(|p| p[0]).into_iter().reduce(of).unwrap());
        [low - x, high - x]
    };
    let left = tets_where(refinement.mesh(), |_, c| reach(c)[1] < -2.0 * stride);
    refinement.coarsen(&left, threads).unwrap();
    let generations: Vec<u8> = refinement.generations().collect();
    let met = tets_where(refinement.mesh(), |t, c| {
        generations[t.index()] < 2 && reach(c)[0] <= 2.0 * stride && reach(c)[1] >= 0.0
    });
    refinement.refine(&met, threads).unwrap();
}

fn take_back(refinement: &mut Refinement, threads: &Threads) {
    for _ in 0..2 {
        let all = tets_where(refinement.mesh(), |_, _| true);
        refinement.coarsen(&all, threads).unwrap();
    }
}

#[test]
fn a_front_leaves_the_first_mesh_behind() {
    let threads = Threads::single();
    for (name, mesh) in [("box", box_of_two()), ("random", random_mesh(60, 2))] {
        let first = First::new(mesh, &threads);
        let length = first.mesh.points.iter().map(|p| p[0]).fold(0.0, f64::max);
        let stride = length / 49.0;
        let mut refinement = Refinement::new(&first.mesh, Options::default(), &threads).unwrap();
        let mut most = 0;
        for step in 0..50 {
            pass(&mut refinement, f64::from(step) * stride, stride, &threads);
            let kept = first.compare(&refinement, &threads);
            assert!(kept.broken.is_empty(), "{name} {step}: {:?}", kept.broken);
            assert!(kept.quality.worst >= 0.9 * first.quality.worst && kept.roots.is_empty());
            most = most.max(refinement.mesh().tets.len());
        }
        println!("{name}: {} tets, {most} at most", first.mesh.tets.len());
        assert!(most > 4 * first.mesh.tets.len());
        take_back(&mut refinement, &threads);
        assert_eq!(refinement.mesh(), &first.mesh);
        // A front that passes once more meets remembered divisions.
        let memory = refinement.memory();
        (0..50).for_each(|step| pass(&mut refinement, f64::from(step) * stride, stride, &threads));
        take_back(&mut refinement, &threads);
        assert_eq!(refinement.mesh(), &first.mesh);
        assert_eq!(refinement.memory(), memory);
    }
}

/// The edge lengths of a tet scaled to volume 1.
fn lengths(c: [Point; 4]) -> [f64; 6] {
    let size = volume(c).abs().cbrt();
    EDGES.map(|[i, j]| distance(c[i], c[j]) / size)
}

/// Whether two tets have the same shape up to reflection: some order of the corners gives the same lengths.
fn is_alike(x: [Point; 4], y: [Point; 4]) -> bool {
    let expected = lengths(x);
    let orders = (0..4).flat_map(|a| (0..4).flat_map(move |b| (0..4).map(move |c| [a, b, c])));
    orders.filter(|[a, b, c]| a != b && b != c && c != a).any(|[a, b, c]| {
        let found = lengths([a, b, c, 6 - a - b - c].map(|i| y[i]));
        found.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-8 * y)
    })
}

/// The number of shapes after each generation of uniform division, from one tet.
fn n_shapes(tet: [Point; 4], generations: usize) -> Vec<usize> {
    let threads = Threads::single();
    let first = TetMesh::new(tet.to_vec(), vec![[0, 1, 2, 3].map(VertexId)]);
    let mut refinement = Refinement::new(&first, Options::default(), &threads).unwrap();
    let mut counts = Vec::new();
    for generation in 1..=generations {
        let all = tets_where(refinement.mesh(), |_, _| true);
        refinement.refine(&all, &threads).unwrap();
        let mesh = refinement.mesh();
        assert_eq!(mesh.tets.len(), 1 << (3 * generation));
        let part = volume(tet).abs() / mesh.tets.len() as f64;
        let mut shapes: Vec<[Point; 4]> = Vec::new();
        for t in &mesh.tets {
            let c = corners(mesh, *t);
            assert!((volume(c).abs() / part - 1.0).abs() < 1e-10, "all parts are equally large");
            if !shapes.iter().any(|shape| is_alike(*shape, c)) {
                shapes.push(c);
            }
        }
        counts.push(shapes.len());
    }
    counts
}

#[test]
fn regular_and_path_tets_have_few_shapes_for_good() {
    let regular = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    assert_eq!(n_shapes(regular, 5), [2; 5]);
    let path = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]];
    assert_eq!(n_shapes(path, 5), [1; 5]);
    // Sommerville's second space-filler is divided into eight tets of its own shape.
    let sommerville = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]];
    assert_eq!(n_shapes(sommerville, 5), [1; 5]);
}

#[test]
fn random_tets_have_more() {
    let mut numbers = Numbers(4);
    let mut tet = || [(); 4].map(|()| [(); 3].map(|()| numbers.unit()));
    let counts: Vec<Vec<usize>> = (0..12).map(|_| n_shapes(tet(), 4)).collect();
    for generation in 0..4 {
        let all: Vec<usize> = counts.iter().map(|n| n[generation]).collect();
        println!("generation {}: {:?}", generation + 1, all);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// Four of eight have the shape of the whole, and the other four come in two pairs. So a shape gives at
    /// most two new ones.
    #[test]
    fn each_shape_brings_at_most_two(tet in prop::array::uniform4(prop::array::uniform3(0.0..1.0f64))) {
        prop_assume!(volume(tet).abs() > 0.01);
        let counts = n_shapes(tet, 3);
        let mut most = 1;
        for (n, before) in counts.iter().zip([1].iter().chain(&counts)) {
            prop_assert!(n >= before, "none is lost: four have the shape of the whole");
            most *= 3;
            prop_assert!(*n <= 3 * before && *n <= most, "{counts:?}");
        }
    }
}
