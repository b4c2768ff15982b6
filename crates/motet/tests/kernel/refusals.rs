//! What the kernel refuses, by name, whether the surface is kept or adapts; and the mesh after folded tets
//! are removed.

use motet::base::{TetId, VertexId};
use motet::geometry::tet::FACETS;
use motet::kernel::{Behind, Change, Complex, Hold, NewLine, NewWall, Reject, Star, VertexChange};
use motet::mesh::shapes::box_grid;
use motet::mesh::{TetMesh, TetPart};
use motet::ops::collapse;

fn cube(n: usize) -> TetMesh {
    TetPart::of(&box_grid([n; 3], [[0.0; 3], [1.0; 3]])).unwrap().mesh
}

fn vertex_at(mesh: &TetMesh, place: [f64; 3]) -> VertexId {
    VertexId::new(mesh.points.iter().position(|&p| p == place).unwrap())
}

fn complex(mesh: &TetMesh, adapts: bool) -> Complex {
    let mut complex = Complex::new(mesh).unwrap();
    if adapts {
        complex.adapt_surface();
    }
    complex
}

/// The kernel's answer to the collapse of one vertex into another.
fn drawn(complex: &Complex, removed: VertexId, kept: VertexId) -> Result<(), Reject> {
    let (mut star, mut change) = (Star::default(), Change::default());
    star.gather(complex, removed);
    collapse(complex, &star.tets, removed, kept, -2.0, &mut change);
    complex.check_against(&change, 0.0).map(|_| ())
}

/// An edge from inside a cube to a vertex into which its end can be collapsed.
fn inner_edge(mesh: &TetMesh) -> [VertexId; 2] {
    let whole = complex(mesh, false);
    let free = |v: &VertexId| whole.hold(*v) == Hold::Free;
    let mut edges =
        mesh.tets.iter().flat_map(|t| (0..4).flat_map(move |i| (0..4).map(move |j| [t[i], t[j]])));
    edges.find(|[a, b]| a > b && free(a) && drawn(&whole, *a, *b).is_ok()).unwrap()
}

#[test]
fn fixed_edges_and_lines_are_kept_whichever_way_they_are_given() {
    let mesh = cube(4);
    let [a, b] = inner_edge(&mesh);
    assert!(a > b);
    for adapts in [false, true] {
        assert_eq!(drawn(&complex(&mesh, adapts), a, b), Ok(()));
        for edge in [[a, b], [b, a]] {
            let fixed = TetMesh { fixed_edges: vec![edge], ..mesh.clone() };
            let mut complex = complex(&fixed, adapts);
            assert!(complex.is_fixed_edge(a, b) && complex.is_fixed_edge(b, a) && !complex.may_divide(a, b));
            assert_eq!([a, b].map(|v| complex.hold(v)), [Hold::Fixed; 2]);
            assert_eq!(drawn(&complex, a, b), Err(Reject::Held(a)));
            complex.set_hold(a, Hold::Free);
            let refused = drawn(&complex, a, b);
            assert!(
                matches!(refused, Err(Reject::Edge(e)) if e.contains(&a) && e.contains(&b)),
                "{refused:?}"
            );
        }
    }
    let lined = TetMesh { lines: vec![[a, b]], line_labels: vec![3], ..mesh };
    let kept = complex(&lined, false);
    assert_eq!([a, b].map(|v| kept.hold(v)), [Hold::Edge, kept.hold(b)]);
    assert!(kept.line(b, a).is_some() && kept.is_kept_edge(a, b) && !kept.may_divide(a, b));
    assert_eq!(drawn(&kept, a, b), Err(Reject::Held(a)));
    let mut loose = complex(&lined, false);
    loose.set_hold(a, Hold::Free);
    assert!(matches!(drawn(&loose, a, b), Err(Reject::Edge(_))));
    // Where the surface may change, a line may be divided, but must not end.
    let adapting = complex(&lined, true);
    assert!(adapting.may_divide(a, b));
    assert!(matches!(drawn(&adapting, a, b), Err(Reject::Vertex(_))));
}

#[test]
fn a_wall_that_would_be_lost_is_named_as_one() {
    let whole = complex(&cube(4), false);
    // Facets with no tet behind them, and those with too many, are refused by other names.
    let one = whole.tets().find(|&t| (0..4).filter(|&i| whole.is_wall(t, i)).count() == 1).unwrap();
    let [a, b, c, d] = whole.vertices(one);
    let fill = |tets: &[[VertexId; 4]]| {
        let mut change = Change { cavity: vec![one], ..Change::default() };
        change.vertex = VertexChange::Insert(motet::geometry::tet::centroid(whole.corners(one)), Hold::Free);
        tets.iter().for_each(|tet| change.push(&whole, *tet, whole.region(one)));
        whole.check_against(&change, 0.0).map(|_| ())
    };
    let n = whole.next_vertex();
    let all = [[n, b, c, d], [a, n, c, d], [a, b, n, d], [a, b, c, n]];
    assert_eq!(fill(&all), Ok(()));
    let without = |place: usize| {
        fill(&[0, 1, 2, 3].into_iter().filter(|&i| i != place).map(|i| all[i]).collect::<Vec<_>>())
    };
    let (inner, wall): (Vec<usize>, Vec<usize>) = (0..4).partition(|&i| !whole.is_wall(one, i));
    assert!(matches!(without(wall[0]), Err(Reject::Wall(_))), "{:?}", without(wall[0]));
    assert!(matches!(without(inner[0]), Err(Reject::Open(_))), "{:?}", without(inner[0]));
    let twice: Vec<_> = all.into_iter().chain([all[inner[0]]]).collect();
    assert!(matches!(fill(&twice), Err(Reject::Crowded(_))), "{:?}", fill(&twice));
}

#[test]
fn lines_that_come_are_edges_of_the_fill_once() {
    let mesh = cube(4);
    let [a, b] = inner_edge(&mesh);
    let lined = TetMesh { lines: vec![[a, b]], line_labels: vec![3], ..mesh };
    let complex = complex(&lined, true);
    let source = complex.line(a, b).unwrap().source;
    let (mut shell, mut change) = (motet::kernel::Shell::default(), Change::default());
    let mut star = Star::default();
    star.gather(&complex, a);
    let start = star.tets.iter().copied().find(|&t| complex.vertices(t).contains(&b)).unwrap();
    shell.walk(&complex, start, a, b);
    let middle = [0, 1, 2].map(|k| 0.5 * (complex.point(a)[k] + complex.point(b)[k]));
    assert!(motet::ops::split_edge(&complex, &shell, [a, b], (middle, Hold::Edge), 0.0, &mut change));
    assert_eq!(complex.check_against(&change, 0.0).map(|_| ()), Ok(()));
    let n = complex.next_vertex();
    let with = |lines: &[[VertexId; 2]]| {
        let mut other = change.clone();
        other.lines = lines.iter().map(|&vertices| NewLine { vertices, source }).collect();
        complex.check_against(&other, 0.0).map(|_| ())
    };
    assert_eq!(with(&[[n, a], [b, n]]), Ok(()));
    assert!(matches!(with(&[[n, a]]), Err(Reject::Vertex(_))), "half of a line");
    assert!(matches!(with(&[]), Err(Reject::Vertex(_))), "no line");
    assert!(matches!(with(&[[n, a], [n, b], [a, n]]), Err(Reject::Edge(_))), "a line twice");
    let elsewhere = (0..lined.points.len())
        .map(VertexId::new)
        .find(|v| !change.fill.iter().any(|t| t.vertices.contains(v)));
    assert!(matches!(with(&[[n, a], [n, elsewhere.unwrap()]]), Err(Reject::Edge(_))), "no edge of the fill");
}

#[test]
fn what_is_folded_over_a_mesh_is_peeled_off_and_nothing_of_it_is_left() {
    let mesh = cube(4);
    let is_on = |v: &VertexId| mesh.points[v.index()][0] == 0.0;
    let [a, b, c] = mesh
        .tets
        .iter()
        .find_map(|t| <[VertexId; 3]>::try_from(t.iter().copied().filter(is_on).collect::<Vec<_>>()).ok())
        .unwrap();
    // To a new vertex, and to one of the mesh.
    for apex in [None, Some(vertex_at(&mesh, [0.75, 0.5, 0.5]))] {
        let mut folded = mesh.clone();
        let d = apex.unwrap_or(VertexId::new(mesh.points.len()));
        if apex.is_none() {
            folded.points.push([0.9, 0.4, 0.4]);
        }
        folded.tets.push([a, b, c, d]);
        folded.regions.push(0);
        let mut complex = Complex::new(&folded).unwrap();
        complex.verify().unwrap();
        assert_eq!((complex.peel(), complex.n_tets()), (1, mesh.tets.len()));
        complex.verify().unwrap();
        assert_eq!(complex.is_used(d), apex.is_some());
        assert_eq!(complex.n_used_vertices(), mesh.points.len());
        assert_eq!(complex.peel(), 0);
        // A folded tet that is locked, or that is the only one at a vertex, stays.
        let mut locked = Complex::new(&folded).unwrap();
        locked.lock(TetId::new(mesh.tets.len()));
        assert_eq!(locked.peel(), 0);
        let mut held = Complex::new(&folded).unwrap();
        held.set_hold(d, Hold::Fixed);
        assert_eq!(held.peel(), 0);
    }
}

#[test]
fn new_walls_are_facets_of_the_fill() {
    let mesh = cube(4);
    let complex = complex(&mesh, true);
    let (removed, kept) = (vertex_at(&mesh, [0.0, 0.5, 0.5]), vertex_at(&mesh, [0.0, 0.5, 0.25]));
    let (mut star, mut change) = (Star::default(), Change::default());
    star.gather(&complex, removed);
    collapse(&complex, &star.tets, removed, kept, -2.0, &mut change);
    assert_eq!(complex.check_against(&change, 0.0).map(|_| ()), Ok(()));
    let mut open = change.clone();
    open.walls.pop();
    assert!(matches!(complex.check_against(&open, 0.0), Err(Reject::Open(_))));
    let mut twice = change.clone();
    twice.walls.push(change.walls[0]);
    assert!(matches!(complex.check_against(&twice, 0.0), Err(Reject::Wall(_))));
    let mut elsewhere = change.clone();
    let far = vertex_at(&mesh, [1.0; 3]);
    elsewhere.walls.push(NewWall { vertices: [removed, kept, far], ..change.walls[0] });
    assert!(matches!(complex.check_against(&elsewhere, 0.0), Err(Reject::Wall(_))));
}

/// Lines along x through the middle of a cube, with their labels; and their vertices.
fn along_x(labels: &[&[i32]]) -> (TetMesh, Vec<VertexId>) {
    let mut mesh = cube(4);
    let vertices: Vec<VertexId> = (0..=4).map(|i| vertex_at(&mesh, [f64::from(i) / 4.0, 0.5, 0.5])).collect();
    for (i, of_edge) in labels.iter().enumerate() {
        for (k, &label) in of_edge.iter().enumerate() {
            let edge = [vertices[i + 1], vertices[i + 2]];
            mesh.lines.push(if k == 0 { edge } else { [edge[1], edge[0]] });
            mesh.line_labels.push(label);
        }
    }
    (mesh, vertices)
}

#[test]
fn lines_are_merged_if_their_labels_are_the_same() {
    for (labels, is_merged) in [
        ([&[1][..], &[1]], true),
        ([&[1], &[2]], false),
        ([&[1, 2], &[2, 1]], true),
        ([&[1, 2], &[1]], false),
        ([&[3, 3], &[3]], false),
    ] {
        let (mesh, v) = along_x(&labels);
        let complex = complex(&mesh, true);
        let sources = [[v[1], v[2]], [v[2], v[3]]].map(|[a, b]| complex.line(a, b).unwrap().source);
        let [x, y] = sources.map(|source| complex.line_label(source));
        assert_eq!(x == y, is_merged, "{labels:?}");
        let refused = drawn(&complex, v[2], v[1]);
        assert_eq!(refused.is_ok(), is_merged, "{labels:?}: {refused:?}");
        assert!(is_merged || matches!(refused, Err(Reject::Vertex(_))), "{refused:?}");
    }
}

#[test]
fn lines_that_are_no_edges_stay_with_their_vertices() {
    let (mut mesh, v) = along_x(&[&[1]]);
    mesh.lines.push([v[3], v[0]]);
    mesh.line_labels.push(2);
    let complex = complex(&mesh, true);
    assert_eq!(
        [v[0], v[1], v[2], v[3]].map(|v| complex.hold(v)),
        [Hold::Fixed, Hold::Edge, Hold::Edge, Hold::Fixed]
    );
    assert_eq!(complex.lines().len(), 1);
}

#[test]
fn edges_are_fixed_in_any_order() {
    let mesh = cube(4);
    let mut complex = complex(&mesh, false);
    let edges: Vec<[VertexId; 2]> = mesh.tets.iter().step_by(5).map(|&[a, _, _, b]| [b, a]).collect();
    complex.fix_edges(edges.iter().rev().copied());
    assert!(edges.iter().all(|&[a, b]| complex.is_fixed_edge(a, b) && complex.hold(a) == Hold::Fixed));
    let others = mesh.tets.iter().flat_map(|&[a, b, c, _]| [[a, b], [b, c]]);
    let is_one = |e: &[VertexId; 2]| edges.contains(e) || edges.contains(&[e[1], e[0]]);
    assert!(others.into_iter().all(|e| complex.is_fixed_edge(e[0], e[1]) == is_one(&e)));
}

#[test]
fn arrays_that_do_not_fit_make_no_complex_and_refusals_say_what_they_are_about() {
    let mut mesh = cube(2);
    mesh.regions.pop();
    assert!(Complex::new(&mesh).is_err());
    let v = VertexId(7);
    for (reject, word) in [
        (Reject::Quality { before: 0.25, after: 0.5 }, "0.25"),
        (Reject::Held(v), "7"),
        (Reject::Vertex(v), "7"),
        (Reject::Edge([v, v]), "7"),
        (Reject::Locked(TetId(9)), "9"),
    ] {
        assert!(reject.to_string().contains(word), "{reject}");
    }
}

/// A flat tet `abpq` on the boundary, with its edge `ab` outside and a tet behind `apq`; behind `bpq` is a
/// tet below or, where `b` lies within `apq`, above.
fn flat_on_the_boundary(is_within: bool) -> TetMesh {
    let (a, c) = ([0.0, 0.05, -1.0], [0.0, -1.0, 0.2]);
    let (b, d) =
        if is_within { ([0.0, 0.05, 0.5], [0.0, 1.0, 0.9]) } else { ([0.0, 0.05, 3.0], [0.0, -1.0, 1.8]) };
    let points = vec![a, b, [1.0, 0.0, 1.0], [-1.0, 0.0, 1.0], c, d];
    let turned = |mut tet: [usize; 4]| {
        if motet::geometry::tet::volume(tet.map(|v| points[v])) < 0.0 {
            tet.swap(0, 1);
        }
        tet.map(VertexId::new)
    };
    let tets = [[0, 1, 2, 3], [0, 2, 3, 4], [1, 2, 3, 5]].map(turned).to_vec();
    TetMesh::new(points, tets)
}

#[test]
fn walls_of_a_flat_tet_are_swapped_unless_they_would_fold() {
    for is_within in [false, true] {
        let complex = complex(&flat_on_the_boundary(is_within), true);
        let (mut removal, mut change) = (motet::ops::EdgeRemoval::default(), Change::default());
        let is_proposed = removal.propose(&complex, TetId(0), [VertexId(0), VertexId(1)], 0.0, &mut change);
        assert_eq!(is_proposed, !is_within);
        if is_proposed {
            assert_eq!((change.cavity.len(), change.fill.len(), change.walls.len()), (1, 0, 2));
        }
    }
}

#[test]
fn tets_on_the_wrong_side_of_bared_walls_are_refused() {
    let whole = complex(&cube(4), true);
    let one = whole.tets().find(|&t| (0..4).all(|i| !whole.is_wall(t, i))).unwrap();
    let vertices = whole.vertices(one);
    let facets = FACETS.map(|facet| facet.map(|i| vertices[i]));
    let others = [0, 1, 2, 3].map(|i| match whole.behind(one, i) {
        Behind::Tet(half) => half.tet(),
        Behind::Wall(_) => unreachable!("it is inside"),
    });
    let wall = |vertices: [VertexId; 3]| NewWall { vertices, patch: 7, triangle: 0 };
    let with = |fill: &[TetId]| {
        // One tet is removed, others are duplicated; walls on all facets without another tet behind them.
        let mut change = Change { cavity: vec![one], ..Change::default() };
        change.walls = facets.map(wall).to_vec();
        for &other in fill {
            let again = whole.vertices(other);
            change.push(&whole, again, whole.region(other));
            let outer = FACETS.map(|f| f.map(|i| again[i]));
            let outer = outer.into_iter().filter(|f| !facets.iter().any(|g| f.iter().all(|v| g.contains(v))));
            change.walls.extend(outer.map(wall));
        }
        whole.check_against(&change, 0.0).map(|_| ()).err()
    };
    assert_eq!(with(&[one]), None);
    // Duplicates of the tets behind two of its facets: on the same side of a wall as the originals.
    for [i, j] in [[0, 1], [1, 2], [2, 3], [0, 3]] {
        let refused = with(&[others[i], others[j]]);
        let keys = [i, j].map(|k| {
            let mut key = facets[k];
            key.sort_unstable();
            key
        });
        assert!(matches!(refused, Some(Reject::Crowded(key)) if keys.contains(&key)), "{refused:?} {keys:?}");
    }
}
