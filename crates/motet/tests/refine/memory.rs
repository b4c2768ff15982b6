//! The memory of a refined mesh: stored, restored, and restored after others have changed the mesh.

use std::collections::{HashMap, HashSet};

use crate::common::invariants::{corners, fits};
use crate::common::refined::{ball_in_box, facets, nearest, worst};
use crate::common::{Numbers, random_mesh};
use motet::base::{MaybeId, Point, TetId, Threads, VertexId};
use motet::geometry::quality::eas;
use motet::geometry::tet::{FACETS, centroid};
use motet::geometry::vector::distance;
use motet::mesh::TetMesh;
use motet::refine::{Memory, Options, Refinement};
use motet::remesh;

fn single() -> Threads {
    Threads::single()
}

fn refined(first: &TetMesh, place: Point, generations: usize) -> Refinement {
    let mut refinement = Refinement::new(first, Options::default(), &single()).unwrap();
    for _ in 0..generations {
        let marked = nearest(refinement.mesh(), place, 120);
        refinement.refine(&marked, &single()).unwrap();
    }
    refinement
}

/// Options by which little is divided for shape alone.
fn loose() -> Options {
    Options { keep: 0.5, share: 0.3, ..Options::default() }
}

fn all(mesh: &TetMesh) -> Vec<TetId> {
    (0..mesh.tets.len()).map(TetId::new).collect()
}

/// Takes back all divisions that can be.
fn coarsest(refinement: &mut Refinement) {
    loop {
        let n = refinement.mesh().tets.len();
        refinement.coarsen(&all(refinement.mesh()), &single()).unwrap();
        if refinement.mesh().tets.len() == n {
            return;
        }
    }
}

fn told_and_recalled(refinement: &Refinement) -> Refinement {
    let memory = refinement.memory_to_keep(&single());
    Refinement::recall(refinement.mesh(), &memory, Options::default(), &single()).unwrap()
}

fn some(n: usize, numbers: &mut Numbers, share: u64) -> Vec<TetId> {
    (0..n).filter(|_| numbers.next() % 100 < share).map(TetId::new).collect()
}

/// A mesh in which all tets but the first are numbered the other way round.
fn turned(mut mesh: TetMesh) -> TetMesh {
    for tet in mesh.tets.iter_mut().skip(1) {
        tet.swap(1, 3);
    }
    mesh
}

#[test]
fn a_refinement_that_was_recalled_goes_on_as_the_one_that_told() {
    for (name, first) in [
        ("ball in a box", ball_in_box()),
        ("numbered the other way round", turned(ball_in_box())),
        ("random", random_mesh(200, 3)),
    ] {
        let mut one = refined(&first, first.points[20], 3);
        let mut numbers = Numbers(7);
        for step in 0..4 {
            let mut other = told_and_recalled(&one);
            assert!(one.mesh() == other.mesh(), "{name}, step {step}");
            assert!(one.generations().eq(other.generations()));
            let marked = some(one.mesh().tets.len(), &mut numbers, if step % 2 == 0 { 2 } else { 90 });
            for refinement in [&mut one, &mut other] {
                match step % 2 {
                    0 => refinement.refine(&marked, &single()).unwrap(),
                    _ => refinement.coarsen(&marked, &single()).unwrap(),
                };
            }
            assert!(one.mesh() == other.mesh(), "{name}, after step {step}");
            assert!(one.roots().eq(other.roots()));
        }
        let mut last = told_and_recalled(&one);
        coarsest(&mut last);
        assert!(last.mesh() == &first, "{name}");
    }
}

fn moved(points: &[Point]) -> Vec<Point> {
    points.iter().map(|&[x, y, z]| [x + 0.1 * y * y + 3.0, y - 0.05 * x * z, 1.1 * z]).collect()
}

#[test]
fn motion_in_between_changes_nothing_of_what_is_remembered() {
    let first = ball_in_box();
    let mut one = refined(&first, first.points[20], 3);
    let points = moved(&one.mesh().points);
    one.set_points(&points).unwrap();
    let mut other = told_and_recalled(&one);
    assert!(one.mesh() == other.mesh());
    for refinement in [&mut one, &mut other] {
        let marked = nearest(refinement.mesh(), [3.4, 0.3, 0.2], 50);
        refinement.refine(&marked, &single()).unwrap();
    }
    assert!(one.mesh() == other.mesh());
    coarsest(&mut other);
    assert_eq!(other.mesh().tets, first.tets);
    assert_eq!(other.mesh().points, moved(&first.points));
}

/// Removes the tets around some places from the memory, as if others had inserted theirs there.
fn forgets(memory: &Memory, mesh: &TetMesh, places: &[Point], radius: f64) -> (Memory, HashSet<usize>) {
    let is_forgotten = |t: &usize| {
        let centre = centroid(corners(mesh, mesh.tets[*t]));
        places.iter().any(|place| distance(centre, *place) < radius)
    };
    let forgotten: HashSet<usize> = (0..mesh.tets.len()).filter(is_forgotten).collect();
    let mut memory = memory.clone();
    forgotten.iter().for_each(|&t| memory.roots[t] = MaybeId::NONE);
    (memory, forgotten)
}

#[test]
fn what_others_put_in_between_fits_whatever_is_divided_and_taken_back() {
    for (seed, first) in [(1, ball_in_box()), (2, random_mesh(150, 9)), (3, turned(ball_in_box()))] {
        let mut numbers = Numbers(seed);
        for round in 0..6 {
            let mut fine = Refinement::new(&first, Options::default(), &single()).unwrap();
            for _ in 0..2 + round % 2 {
                let marked = some(fine.mesh().tets.len(), &mut numbers, 4);
                fine.refine(&marked, &single()).unwrap();
            }
            let given = fine.mesh().clone();
            let places: Vec<Point> = (0..1 + round % 3)
                .map(|_| given.points[numbers.next() as usize % given.points.len()])
                .collect();
            let (memory, forgotten) = forgets(&fine.memory_to_keep(&single()), &given, &places, 0.15);
            let mut other = Refinement::recall(&given, &memory, Options::default(), &single()).unwrap();
            assert!(other.mesh() == &given);

            coarsest(&mut other);
            fits(&given, other.mesh());
            let coarse: HashSet<[VertexId; 4]> = other.mesh().tets.iter().copied().collect();
            let place = |v: VertexId| given.points[v.index()].map(f64::to_bits);
            let at = |v: VertexId| other.mesh().points[v.index()].map(f64::to_bits);
            let there: HashSet<[[u64; 3]; 4]> = coarse.iter().map(|t| t.map(at)).collect();
            // The tets of others are still there, whole or divided.
            let n_there = forgotten.iter().filter(|t| there.contains(&given.tets[**t].map(place))).count();
            assert_eq!(n_there, forgotten.len(), "round {round}");
            assert!(
                other.mesh().tets.len() < given.tets.len() || fine.mesh().tets.len() == first.tets.len(),
                "something comes back"
            );

            for _ in 0..2 {
                let marked = some(other.mesh().tets.len(), &mut numbers, 5);
                other.refine(&marked, &single()).unwrap();
                fits(&given, other.mesh());
                let again = told_and_recalled(&other);
                assert!(again.mesh() == other.mesh());
            }
            coarsest(&mut other);
            assert_eq!(other.mesh().tets.iter().copied().collect::<HashSet<_>>(), coarse, "round {round}");
        }
    }
}

/// The mesh and its memory with the tets renumbered.
fn shuffled(mesh: &TetMesh, memory: &Memory, numbers: &mut Numbers) -> (TetMesh, Memory) {
    let mut order: Vec<usize> = (0..mesh.tets.len()).collect();
    (1..order.len()).for_each(|i| order.swap(i, numbers.next() as usize % (i + 1)));
    fn by<T: Copy>(order: &[usize], list: &[T]) -> Vec<T> {
        order.iter().map(|&t| list[t]).collect()
    }
    let tets = by(&order, &mesh.tets);
    let regions = by(&order, &mesh.regions);
    let memory = Memory {
        roots: by(&order, &memory.roots),
        paths: by(&order, &memory.paths),
        pieces: by(&order, &memory.pieces),
        n_requested: by(&order, &memory.n_requested),
        ..memory.clone()
    };
    (TetMesh { tets, regions, ..mesh.clone() }, memory)
}

/// Adds triangles between the tets on both sides of a plane.
fn with_sheet(mut mesh: TetMesh) -> TetMesh {
    let is_left: Vec<bool> = mesh.tets.iter().map(|t| centroid(corners(&mesh, *t))[0] < 0.5).collect();
    let sorted = |mut t: [VertexId; 3]| {
        t.sort_unstable();
        t
    };
    let mut sides: HashMap<[VertexId; 3], Vec<bool>> = HashMap::new();
    for (tet, left) in mesh.tets.iter().zip(is_left) {
        FACETS.iter().for_each(|f| sides.entry(sorted(f.map(|k| tet[k]))).or_default().push(left));
    }
    let mut sheet: Vec<[VertexId; 3]> = sides
        .into_iter()
        .filter(|(_, sides)| sides.len() == 2 && sides[0] != sides[1])
        .map(|(t, _)| t)
        .collect();
    let there: HashSet<[VertexId; 3]> = mesh.triangles.iter().map(|t| sorted(*t)).collect();
    sheet.retain(|t| !there.contains(t));
    sheet.sort_unstable();
    mesh.patches.extend(sheet.iter().map(|_| SHEET));
    mesh.triangles.extend(sheet);
    mesh
}

const SHEET: i32 = 77;

#[test]
fn triangles_inside_are_there_once_whichever_side_was_changed() {
    let first = with_sheet(random_mesh(60, 5));
    let on_sheet = first.triangles.iter().zip(&first.patches).filter(|(_, p)| **p == SHEET);
    let on_sheet: Vec<VertexId> = on_sheet.flat_map(|(t, _)| *t).collect();
    let mut numbers = Numbers(17);
    for _ in 0..20 {
        let mut fine = Refinement::new(&first, loose(), &single()).unwrap();
        fine.refine(&all(&first), &single()).unwrap();
        let (given, memory) = shuffled(fine.mesh(), &fine.memory_to_keep(&single()), &mut numbers);
        let place = first.points[on_sheet[numbers.next() as usize % on_sheet.len()].index()];
        let (memory, forgotten) = forgets(&memory, &given, &[place], 0.2);
        assert!(!forgotten.is_empty());
        let mut other = Refinement::recall(&given, &memory, loose(), &single()).unwrap();
        coarsest(&mut other);
        fits(&given, other.mesh());
        assert!(other.mesh().tets.len() < given.tets.len(), "something comes back");
    }
}

#[test]
fn a_moved_and_remeshed_mesh_is_coarsened_where_it_was_not_touched() {
    let first = ball_in_box();
    // Refined at two corners; then one of them is bent until tets are bad, and repaired.
    let mut fine = Refinement::new(&first, loose(), &single()).unwrap();
    for _ in 0..3 {
        let marked = nearest(fine.mesh(), [-0.9, -0.9, -0.9], 30);
        fine.refine(&marked, &single()).unwrap();
        let marked = nearest(fine.mesh(), [0.9, 0.9, 0.9], 30);
        fine.refine(&marked, &single()).unwrap();
    }
    let options = remesh::Options { min_eas: 0.95 * worst(fine.mesh(), eas), ..remesh::Options::default() };
    let mut numbers = Numbers(3);
    let points: Vec<Point> = fine.mesh().points.clone();
    let mut bent = points.clone();
    for (v, point) in bent.iter_mut().enumerate() {
        let is_inside = point.iter().all(|x| x.abs() < 0.999);
        if v % 3 == 0 && is_inside && distance(*point, [0.9; 3]) < 0.3 {
            *point = point.map(|x| x + 0.1 * (numbers.next() as f64 / u64::MAX as f64 - 0.5));
        }
    }
    fine.set_points(&bent).unwrap();
    let outcome = remesh::remesh(fine.mesh(), &options, &Threads::single()).unwrap();
    let n_new = outcome.extract.new_tets.len();
    println!("{} tets, {n_new} new, {:?}", fine.mesh().tets.len(), fine.summary());
    assert!(n_new > 0);
    let memory = fine.memory_to_keep(&single()).after(&outcome.extract);
    let mesh = &outcome.extract.mesh;
    let mut other = Refinement::recall(mesh, &memory, loose(), &single()).unwrap();
    assert!(other.mesh() == mesh);
    coarsest(&mut other);
    fits(mesh, other.mesh());
    println!("{} tets coarsened, {} at first", other.mesh().tets.len(), first.tets.len());

    // All tets of the first mesh, except where others were.
    let bits = |mesh: &TetMesh| -> HashSet<[[u64; 3]; 4]> {
        mesh.tets.iter().map(|t| corners(mesh, *t).map(|p| p.map(f64::to_bits))).collect()
    };
    let (is, was) = (bits(other.mesh()), bits(&first));
    let far = first.tets.iter().filter(|t| centroid(corners(&first, **t)).iter().sum::<f64>() < 0.0);
    assert!(far.clone().all(|t| is.contains(&corners(&first, *t).map(|p| p.map(f64::to_bits)))));
    println!("{} of {} tets of the first mesh are back", is.intersection(&was).count(), was.len());
    assert!(is.intersection(&was).count() > was.len() * 9 / 10);
    assert!(worst(other.mesh(), eas) > 0.5 * worst(mesh, eas));
    assert!(facets(other.mesh()).values().all(|n| *n <= 2));
}

#[test]
fn a_memory_of_another_mesh_is_refused_or_falls_apart() {
    let first = ball_in_box();
    let fine = refined(&first, first.points[20], 2);
    let memory = fine.memory_to_keep(&single());
    let recall =
        |mesh: &TetMesh, memory: &Memory| Refinement::recall(mesh, memory, Options::default(), &single());

    let mut short = memory.clone();
    short.paths.pop();
    let error = recall(fine.mesh(), &short).unwrap_err().to_string();
    assert!(error.contains("one entry for each"), "{error}");

    // Arbitrary numbers: either refused, or the mesh conforms.
    let mut numbers = Numbers(11);
    let (mut n_refused, n) = (0, fine.mesh().tets.len());
    for _ in 0..200 {
        let mut wrong = memory.clone();
        for _ in 0..1 + numbers.next() % 5 {
            let (t, value) = (numbers.next() as usize % n, numbers.next());
            match numbers.next() % 5 {
                0 => wrong.roots[t] = TetId((value % 50) as u32).into(),
                1 => wrong.paths[t] = value >> (value % 64),
                2 => wrong.pieces[t] = value as u16,
                3 => wrong.n_requested[t] = value as u8,
                _ => wrong.paths[t] ^= 1 << (value % 12),
            }
        }
        match recall(fine.mesh(), &wrong) {
            Err(error) => {
                n_refused += 1;
                assert!(error.to_string().contains("does not fit the mesh"), "{error}");
            }
            Ok(mut other) => {
                coarsest(&mut other);
                fits(fine.mesh(), other.mesh());
            }
        }
    }
    println!("{n_refused} of 200 refused");
}
