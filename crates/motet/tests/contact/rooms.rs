//! Contact: which surfaces are closed, however their vertices are numbered, and which are rooms of others.

use crate::common::Numbers;
use crate::surfaces::{Shape, bodies, coil, cube, sheet, torus};
use motet::base::{BodyId, Point, Threads, VertexId};
use motet::contact::{Body, Contact, Gaps, Options, Room};

/// Every triangle with its own corners, as in STL files.
fn as_soup(shape: &Shape) -> Shape {
    let points = (0..shape.triangles.len()).flat_map(|t| shape.corners(t)).collect();
    let triangles = (0..shape.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    Shape { points, triangles }
}

/// The shape with its vertices in another order.
fn renumbered(shape: &Shape, numbers: &mut Numbers) -> Shape {
    let mut order: Vec<usize> = (0..shape.points.len()).collect();
    (1..order.len()).for_each(|i| order.swap(i, numbers.below(i + 1)));
    let mut new = vec![0; order.len()];
    order.iter().zip(0..).for_each(|(&old, i)| new[old] = i);
    Shape {
        points: order.iter().map(|&v| shape.points[v]).collect(),
        triangles: shape.triangles.iter().map(|t| t.map(|v| new[v as usize])).collect(),
    }
}

/// The shape with separate vertices for triangles whose corners all satisfy a condition, as for caps and
/// parts in OBJ and CAD files.
fn seamed(shape: &Shape, is_part: impl Fn(Point) -> bool) -> Shape {
    let n = shape.points.len() as u32;
    let mut seamed = shape.clone();
    seamed.points.extend(&shape.points);
    for (t, triangle) in seamed.triangles.iter_mut().enumerate() {
        if shape.corners(t).into_iter().all(&is_part) {
            *triangle = triangle.map(|v| v + n);
        }
    }
    seamed
}

fn variants(shape: &Shape) -> [Shape; 4] {
    let mut numbers = Numbers(3);
    let seamed = seamed(shape, |p| p[2] >= 0.5 || p[0] < 0.2);
    let soup = as_soup(shape);
    [renumbered(shape, &mut numbers), renumbered(&soup, &mut numbers), soup, seamed]
}

fn measured(shapes: &[Shape], rooms: &[Room], options: Options) -> (Contact, Gaps) {
    let (points, mut all) = bodies(shapes);
    all.iter_mut().zip(rooms).for_each(|(body, room)| body.room = room.clone());
    let mut contact = Contact::new(points, all, options, &Threads::single()).expect("the shapes are sound");
    let gaps = contact.measure(&Threads::single());
    (contact, gaps)
}

/// Gap bits and warning at every corner of every triangle.
fn at_corners(contact: &Contact, gaps: &Gaps) -> Vec<(u64, bool)> {
    let mut all = Vec::new();
    for (id, body) in (0..).map(BodyId).zip(&gaps.bodies) {
        for v in contact.triangles(id).as_flattened() {
            let i = body.vertices.binary_search(v).expect("a vertex of the body");
            all.push((body.gap[i].to_bits(), body.warning[i]));
        }
    }
    all
}

#[test]
fn gaps_are_the_same_to_the_bit_however_vertices_are_numbered_and_repeated() {
    let ring = torus(6, 9, [1.0, 0.4]);
    let strut = cube().map(|p| [0.9 + 0.3 * p[0], 0.45 + 0.1 * p[1], 0.5 + 0.1 * p[2]]);
    let turns = coil(6, 40, [1.0, 0.1], 0.24, 3.0);
    let free = Options { warn: Some(0.15), ..Options::default() };
    let facing = Options { facing: true, ..free };
    let own = Options { own: true, ..free };
    let cases = [
        (vec![strut.clone(), cube()], Room::Yes, free),
        (vec![strut.clone(), cube()], Room::No, free),
        (vec![strut, cube()], Room::Yes, facing),
        (vec![cube().scaled(0.5).shifted([0.2; 3]), cube()], Room::Found, facing),
        (vec![ring.clone(), torus(5, 8, [1.05, 0.35])], Room::Found, facing),
        (vec![ring, sheet(5, |x, _| 0.3 * x)], Room::Found, own),
        (vec![turns, cube().shifted([-0.5, -0.5, 0.0])], Room::Found, own),
    ];
    for (case, (shapes, room, options)) in cases.into_iter().enumerate() {
        let rooms = vec![room; shapes.len()];
        let (contact, gaps) = measured(&shapes, &rooms, options);
        let expected = at_corners(&contact, &gaps);
        let [first, second] = [0, 1].map(|k| variants(&shapes[k]));
        for (k, (first, second)) in first.into_iter().zip(second).enumerate() {
            let (other, found) = measured(&[first, second], &rooms, options);
            assert_eq!(at_corners(&other, &found), expected, "case {case}, variant {k}");
            assert_eq!(other.rooms(), contact.rooms(), "case {case}, variant {k}");
            assert_eq!(found.pairs[0].n_warned, gaps.pairs[0].n_warned);
            assert_eq!(found.pairs[0].crossings, gaps.pairs[0].crossings);
            let groups = |contact: &Contact, gaps: &Gaps| -> Vec<u64> {
                contact.warned(gaps).iter().map(|group| group.gap.to_bits()).collect()
            };
            assert_eq!(groups(&other, &found), groups(&contact, &gaps), "case {case}, variant {k}");
        }
    }
}

#[test]
fn what_leaves_a_room_with_a_lid_of_its_own_is_as_negative_as_it_is_far_out() {
    let room = seamed(&cube(), |p| p[2] == 1.0);
    let strut = cube().map(|p| [0.5 + 0.75 * p[0], 0.25 + 0.5 * p[1], 0.25 + 0.5 * p[2]]);
    let (contact, gaps) = measured(&[strut, room], &[Room::No, Room::Yes], Options::default());
    assert!(contact.is_closed(BodyId(1)));
    for (v, gap) in gaps.bodies[0].vertices.iter().zip(&gaps.bodies[0].gap) {
        let is_out = contact.points()[v.index()][0] > 1.0;
        assert_eq!(*gap, if is_out { -0.25 } else { 0.25 });
    }
    // The vertices of the lid are reported as given: twice, and each with its gap.
    assert_eq!(gaps.bodies[1].vertices.len(), 12);
    assert_eq!(gaps.pairs[0].n_wrong, [4, 0]);
}

#[test]
fn a_slit_is_no_seam() {
    // Two sheets at the same place, closed along their rim by shared vertices: repeated vertices inside it
    // belong to the other side.
    let flat = sheet(4, |_, _| 0.0);
    let n = flat.points.len() as u32;
    let is_rim = |p: Point| p[..2].iter().any(|&x| x == 0.0 || x == 1.0);
    let mut slit = flat.clone();
    slit.points.extend(&flat.points);
    let other = |v: u32| if is_rim(flat.points[v as usize]) { v } else { v + n };
    slit.triangles.extend(flat.triangles.iter().map(|&[a, b, c]| [a, c, b].map(other)));
    let (contact, gaps) = measured(&[slit], &[Room::Found], Options { own: true, ..Options::default() });
    assert!(contact.is_closed(BodyId(0)));
    let inner = gaps.bodies[0].vertices.iter().zip(&gaps.bodies[0].gap);
    let mut inner = inner.filter(|(v, _)| !is_rim(contact.points()[v.index()]));
    assert!(inner.all(|(_, gap)| *gap == 0.0), "the sides touch: {:?}", gaps.bodies[0].gap);
}

fn pairs(contact: &Contact) -> Vec<[u32; 2]> {
    contact.rooms().iter().map(|within| [within.room.0, within.body.0]).collect()
}

#[test]
fn closed_surfaces_are_rooms_of_what_they_enclose_and_nested_ones_of_all_within() {
    let nested = |factor: f64| cube().shifted([-0.5; 3]).scaled(factor);
    for turned in [false, true] {
        let balloon = if turned { nested(2.0).turned_inside_out() } else { nested(2.0) };
        let flap = sheet(2, |_, _| 0.0).shifted([-0.5, -0.5, 1.5]);
        let all = [nested(1.0), balloon, nested(4.0), flap];
        let (contact, gaps) = measured(&all, &[], Options { warn: Some(0.1), ..Options::default() });
        // The flap lies between the balloon and the vessel.
        assert_eq!(pairs(&contact), [[1, 0], [2, 0], [2, 1], [2, 3]]);
        assert!(contact.rooms().iter().all(|within| within.share == Some(1.0)));
        assert!(gaps.bodies.iter().flat_map(|body| &body.gap).all(|&gap| gap >= 0.5) && !gaps.is_warned());
        // Given rooms are rooms of everything except the rooms around them.
        let reported = [Room::No, Room::Yes, Room::Yes, Room::No];
        let (contact, _) = measured(&all, &reported, Options::default());
        assert_eq!(pairs(&contact), [[1, 0], [1, 3], [2, 0], [2, 1], [2, 3]]);
        // Without rooms, whatever is enclosed is where it must not be.
        let none = vec![Room::No; 4];
        let (contact, gaps) = measured(&all, &none, Options { warn: Some(0.1), ..Options::default() });
        assert!(contact.rooms().is_empty() && gaps.is_warned());
        // Of several depths the largest counts.
        assert!(gaps.bodies[0].gap.iter().all(|&gap| gap == -1.5));
    }
}

#[test]
fn what_pokes_through_has_the_room_that_most_of_it_is_in() {
    // A rod of this length along x, of which 1 lies in the cube.
    let rod = |length: f64| cube().map(|p| [0.5 + length * p[0], 0.4 + 0.2 * p[1], 0.4 + 0.2 * p[2]]);
    for (length, is_room) in [(0.4, true), (0.6, false), (5.0, false)] {
        let (contact, _) = measured(&[rod(length), cube()], &[], Options::default());
        // Corners stand for the area: half of them are beyond the wall at 1.
        assert_eq!(!contact.rooms().is_empty(), is_room, "{length}");
    }
    // For many rings the share of the area counts, and what is outside is negative.
    let ring = |shift: f64| torus(8, 24, [0.3, 0.05]).shifted([0.5 + shift, 0.5, 0.5]);
    let (contact, gaps) = measured(&[ring(0.3), cube()], &[], Options::default());
    let share = contact.rooms().first().and_then(|within| within.share).expect("most of it is inside");
    assert!((0.5..1.0).contains(&share) && gaps.bodies[0].gap.iter().any(|&gap| gap < 0.0));
    assert!(measured(&[ring(0.7), cube()], &[], Options::default()).0.rooms().is_empty());
}

#[test]
fn neither_of_two_that_overlap_nor_an_open_one_nor_one_beside_is_a_room() {
    let open = Shape { triangles: cube().triangles[2..].to_vec(), ..cube() };
    let small = cube().scaled(0.2).shifted([0.3; 3]);
    let cases = [
        [cube(), cube()],
        [cube(), cube().shifted([0.1, 0.2, 0.3])],
        [torus(8, 12, [1.0, 0.4]), torus(8, 12, [1.0, 0.4]).shifted([0.1, 0.0, 0.05])],
        [cube(), cube().shifted([3.0, 0.0, 0.0])],
        [small.clone(), open],
        // Beside the tube of a ring, within its bounding box.
        [small.shifted([-0.4, -0.4, -0.4]), torus(8, 12, [1.0, 0.4])],
    ];
    for (k, case) in cases.into_iter().enumerate() {
        let (contact, _) = measured(&case, &[], Options::default());
        assert!(contact.rooms().is_empty(), "case {k}: {:?}", contact.rooms());
    }
}

#[test]
fn what_is_a_room_is_decided_at_first() {
    let inner = cube().scaled(0.5).shifted([0.25; 3]);
    let (mut contact, _) = measured(&[inner, cube()], &[], Options::default());
    let mut points = contact.points().to_vec();
    points[..8].iter_mut().for_each(|p| p[0] += 2.0);
    contact.refit(&points, &Threads::single()).unwrap();
    let gaps = contact.measure(&Threads::single());
    assert_eq!(pairs(&contact), [[1, 0]]);
    assert!(gaps.bodies[0].gap.iter().all(|&gap| gap < 0.0), "all of it is outside its room");
    // The same bodies with other triangles keep their rooms.
    let reported = [0, 1].map(|id| contact.room(BodyId(id)));
    assert_eq!(reported, [Room::Of(vec![]), Room::Of(vec![BodyId(0)])]);
    let body = |id: BodyId| Body {
        name: contact.name(id).into(),
        triangles: contact.triangles(id).to_vec(),
        room: contact.room(id),
    };
    let again =
        Contact::new(points, vec![body(BodyId(0)), body(BodyId(1))], Options::default(), &Threads::single());
    let mut again = again.unwrap();
    assert_eq!(pairs(&again), [[1, 0]]);
    assert_eq!(again.measure(&Threads::single()).bodies[0].gap, gaps.bodies[0].gap);
}

#[test]
fn a_room_of_what_is_not_there_is_refused() {
    let (points, mut two) = bodies(&[cube(), cube().shifted([3.0, 0.0, 0.0])]);
    for others in [vec![2], vec![0, 7], vec![1]] {
        two[1].room = Room::Of(others.into_iter().map(BodyId).collect());
        let error = Contact::new(points.clone(), two.clone(), Options::default(), &Threads::single());
        assert!(error.unwrap_err().to_string().contains("body 1 cannot be the room of body"));
    }
}

/// A flap that hangs from an edge of its room shares vertices with it; the room is one nevertheless.
#[test]
fn a_closed_surface_is_the_room_of_a_flap_that_is_attached_to_it() {
    let cube = cube();
    let low =
        (0..3).map(|k| cube.points.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min)).collect::<Vec<_>>();
    let on_edge = |v: &u32| (1..3).all(|k| cube.points[*v as usize][k] == low[k]);
    let mut hinge: Vec<u32> = (0..cube.points.len() as u32).filter(on_edge).collect();
    hinge.sort_by(|a, b| cube.points[*a as usize][0].total_cmp(&cube.points[*b as usize][0]));
    let ends = [hinge[0], hinge[hinge.len() - 1]].map(|v| cube.points[v as usize]);
    let tip = [0.5 * (ends[0][0] + ends[1][0]), low[1] + 0.2, low[2] + 0.6];
    let mut points = cube.points.clone();
    points.push(tip);
    let id = VertexId;
    let flap = hinge.windows(2).map(|pair| [id(pair[0]), id(pair[1]), id(points.len() as u32 - 1)]).collect();
    let wall = cube.triangles.iter().map(|t| t.map(id)).collect();
    let body = |name: &str, triangles| Body { name: name.to_owned(), triangles, room: Room::Found };
    let bodies = vec![body("flap", flap), body("wall", wall)];
    let contact = Contact::new(points, bodies, Options::default(), &Threads::single());
    assert_eq!(pairs(&contact.expect("both are sound")), [[1, 0]]);
}
