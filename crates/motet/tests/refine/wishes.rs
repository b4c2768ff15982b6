//! Wishes for each tet: several criteria together, what may be taken back, expected counts, limits.

use crate::common::criteria::{case, corners, longest, target, tets_where, whole, with_fields};
use motet::base::{TetId, Threads};
use motet::mesh::TetPart;
use motet::mesh::shapes::box_grid;
use motet::refine::wish::{Wish, check_expected, coarser, expected_tets, marked};
use motet::refine::{
    Aim, Amount, Criterion, Estimator, HessianSizes, Limits, Options, Refinement, Size, marks_of_all, sizes,
    wishes_of_all,
};

#[test]
fn several_criteria_mark_what_any_of_them_does_on_any_number_of_threads() {
    let (one, three) = (Threads::single(), Threads::new(3).unwrap());
    let (mesh, part) = case();
    let criteria = all_criteria(&one);
    let mut expected: Vec<TetId> = Vec::new();
    for criterion in &criteria[..4] {
        expected.extend(criterion.marks(&mesh, &part, &one).unwrap());
    }
    expected.sort_unstable();
    expected.dedup();
    assert_eq!(marks_of_all(&criteria[..4], &mesh, &part, &one).unwrap(), expected);
    let wishes = wishes_of_all(&criteria, &mesh, &part, &one).unwrap();
    assert_eq!(wishes, wishes_of_all(&criteria, &mesh, &part, &three).unwrap());
    let none = wishes_of_all(&[], &mesh, &part, &one).unwrap();
    assert_eq!((marked(&none), coarser(&none).len()), (vec![], part.mesh.tets.len()));
}

/// One criterion of each kind.
fn all_criteria(threads: &Threads) -> Vec<Criterion> {
    let hessian = |aim| {
        let arrays = vec!["p".into(), "v".into()];
        Criterion::Hessian(HessianSizes { arrays, aim, limits: sizes::SizeLimits::default() })
    };
    let amount = Amount::Share(0.3);
    vec![
        Criterion::Ball { centre: [1.0, 0.0, 0.0], radius: 0.5 },
        Criterion::Near { target: target(threads), within: 0.3 },
        Criterion::NearSize { target: target(threads), size: 0.4, growth: 0.8 },
        Criterion::Where("v:x>4".parse().unwrap()),
        Criterion::Region("right".into()),
        Criterion::Patch { patch: "sphere".into(), within: None },
        Criterion::Patch { patch: "sphere".into(), within: Some(0.6) },
        Criterion::Size(Size::Uniform(1.2)),
        Criterion::Size(Size::Array("h".into())),
        Criterion::Box([[-1.0; 3], [2.0; 3]]),
        Criterion::Gradient { array: "p".into(), above: 1.0 },
        Criterion::Estimate { array: "v".into(), by: Estimator::Jump, amount },
        Criterion::Estimate { array: "p".into(), by: Estimator::Recovery, amount },
        hessian(Aim::Error(0.1)),
        hessian(Aim::RangePart(0.02)),
        hessian(Aim::Tets(20_000)),
        Criterion::Vorticity { array: "v".into(), above: 3.0 },
        Criterion::Q { array: "v".into(), above: 0.5 },
        Criterion::All,
    ]
}

#[test]
fn what_may_be_taken_back_would_not_be_divided_again() {
    let threads = Threads::single();
    let (first, part) = case();
    let mut refinement = Refinement::new(&part.mesh, Options::default(), &threads).unwrap();
    let all: Vec<TetId> = (0..part.mesh.tets.len()).map(TetId::new).collect();
    refinement.refine(&all, &threads).unwrap();
    let mut fine = with_fields(whole(refinement.mesh()));
    fine.label_names = first.label_names.clone();
    let fine_part = TetPart::of(&fine).unwrap();
    let roots: Vec<TetId> = refinement.roots().collect();
    for criterion in &all_criteria(&threads)[..9] {
        let mut is_marked = vec![false; part.mesh.tets.len()];
        criterion.marks(&first, &part, &threads).unwrap().iter().for_each(|t| is_marked[t.index()] = true);
        let wishes = criterion.wishes(&fine, &fine_part, &threads).unwrap();
        let mut is_whole = vec![true; part.mesh.tets.len()];
        for (root, wish) in roots.iter().zip(&wishes) {
            is_whole[root.index()] &= *wish == Wish::Coarser;
        }
        let n = is_whole.iter().filter(|is_whole| **is_whole).count();
        let n_again = is_whole.iter().zip(&is_marked).filter(|(whole, marked)| **whole && **marked).count();
        let n_marked = is_marked.iter().filter(|is_marked| **is_marked).count();
        println!("{n} of {} may be taken back, {n_marked} were marked", is_whole.len());
        assert_eq!(n_again, 0, "{criterion:?}");
        assert!(n > 0, "{criterion:?}");
    }
}

#[test]
fn as_many_tets_come_as_were_expected() {
    let threads = Threads::single();
    let first = TetPart::of(&box_grid([3, 3, 3], [[0.0; 3], [1.0; 3]])).unwrap().mesh;
    for size in [0.3, 0.15] {
        let criterion = Criterion::Size(Size::Uniform(size));
        let mut refinement = Refinement::new(&first, Options::default(), &threads).unwrap();
        let mut expected = None;
        loop {
            let part = TetPart::of(&whole(refinement.mesh())).unwrap();
            let wishes = criterion.wishes(&whole(&part.mesh), &part, &threads).unwrap();
            let n = *expected.get_or_insert(expected_tets(&wishes));
            if marked(&wishes).is_empty() {
                assert_eq!(n, refinement.mesh().tets.len() as f64);
                break;
            }
            refinement.refine(&marked(&wishes), &threads).unwrap();
        }
    }
    let mesh = whole(&first);
    let part = TetPart::of(&mesh).unwrap();
    let wishes = |h: f64| Criterion::Size(Size::Uniform(h)).wishes(&mesh, &part, &threads).unwrap();
    assert!(check_expected(&wishes(1e-2)).is_ok());
    let reported = check_expected(&wishes(1e-6)).unwrap_err().to_string();
    assert!(reported.contains("e20 tets") && reported.contains("times as large"), "{reported}");
}

#[test]
fn limits_hold() {
    let threads = Threads::single();
    let (mesh, part) = case();
    let wishes = Criterion::Size(Size::Uniform(0.1)).wishes(&mesh, &part, &threads).unwrap();
    let limited = |limits: Limits, generations: &[u8]| {
        let mut limited = wishes.clone();
        limits.apply(&part.mesh, generations, &mut limited);
        limited
    };
    assert_eq!(limited(Limits::default(), &[]), wishes);
    let generations: Vec<u8> = (0..part.mesh.tets.len()).map(|t| (t % 4) as u8).collect();
    let by_generation = limited(Limits { generation: Some(2), ..Limits::default() }, &generations);
    assert_eq!(marked(&by_generation), tets_where(&part, |t| t % 4 < 2 && wishes[t].is_divided()));
    assert!(by_generation.iter().all(|wish| *wish <= Wish::Divided(2)));
    let by_size = limited(Limits { smallest: Some(0.6), ..Limits::default() }, &[]);
    assert_eq!(marked(&by_size), tets_where(&part, |t| longest(corners(&part.mesh, t)) >= 1.2));
    let n = part.mesh.tets.len();
    let by_count = limited(Limits { n_tets: Some(n + 77), ..Limits::default() }, &[]);
    assert_eq!(marked(&by_count).len(), 11);
    let least = marked(&by_count).iter().map(|t| longest(corners(&part.mesh, t.index()))).fold(9.0, f64::min);
    let longer = tets_where(&part, |t| longest(corners(&part.mesh, t)) > least);
    assert!(longer.iter().all(|t| marked(&by_count).contains(t)));
    assert!(marked(&limited(Limits { n_tets: Some(3), ..Limits::default() }, &[])).is_empty());
}
