//! Devices that touch walls of the host or cross them: both are divided where they meet; the part outside is
//! cut off or kept.

use std::collections::{BTreeMap, HashMap};

use crate::common::devices::{coil, key, moved, random_device, room, small_ball, stent, tets};
use crate::common::random::Random;
use motet::base::{Point, Threads, VertexId};
use motet::delaunay::{EdgePoints, constrain};
use motet::geometry::overlap::Solid;
use motet::geometry::tet::{FACETS, volume};
use motet::geometry::triangle;
use motet::geometry::vector::distance;
use motet::implant::{Adapt, Device, Inside, Interface, Options, Outside, Report, implant};
use motet::mesh::check::{check, is_conforming};
use motet::mesh::history::{Changed, Rules};
use motet::mesh::shapes::{Coil, ball, box_grid};
use motet::mesh::{CellKind, Field, Mesh, Surface};

fn put(host: &Mesh, devices: &[Device], options: &Options) -> motet::Result<Changed<Report>> {
    implant(host, devices, options, &Rules::default(), &Threads::single())
}

/// Options by which surfaces stay where they are, except within a plane.
fn strict() -> Options {
    Options { adapt: Adapt::No, stray: Some(1e-9), ..Options::default() }
}

fn filled(mesh: Mesh, name: &str) -> Device {
    Device { mesh, name: name.to_owned(), inside: Inside::Filled }
}

/// The volume that a device and a box have in common: tets of the device, each intersected with the five of
/// the box.
fn common_volume(device: &Device, low: Point, high: Point) -> f64 {
    let mut surface = Surface::of(&device.mesh);
    if surface.triangles.is_empty() {
        surface = Surface::boundary_of(&device.mesh);
    }
    let used: std::collections::BTreeSet<VertexId> =
        surface.triangles.as_flattened().iter().copied().collect();
    let new: HashMap<VertexId, VertexId> = used.iter().copied().zip((0..).map(VertexId)).collect();
    let points: Vec<Point> = used.iter().map(|v| surface.points[v.index()]).collect();
    let triangles: Vec<[VertexId; 3]> = surface.triangles.iter().map(|t| t.map(|v| new[&v])).collect();
    let made = constrain(&points, &triangles, EdgePoints::Stay, &Threads::single()).unwrap();
    let of_box = box_grid([1; 3], [low, high]);
    let of_box: Vec<Solid> = tets(&of_box).map(|(_, tet)| Solid::new(tet)).collect();
    let of_device = made.tets.iter().map(|tet| Solid::new(tet.map(|v| made.points[v.index()])));
    of_device.map(|tet| of_box.iter().map(|other| tet.overlap(other)).sum::<f64>()).sum()
}

const LOW: Point = [-1.5; 3];
const HIGH: Point = [1.5; 3];

/// The faults of a result: open facets that belong neither to a wall of the box nor to the device, and
/// volumes that are not those of both.
fn faults(device: &Device, options: &Options, made: &Changed<Report>, stray: f64) -> Vec<String> {
    let mut faults = Vec::new();
    let mesh = &made.mesh;
    if mesh.validate().is_err() || !is_conforming(&check(mesh)) {
        faults.push("does not conform".to_owned());
    }
    if let Some((cell, _)) = tets(mesh).find(|(_, tet)| volume(*tet) <= 0.0) {
        faults.push(format!("cell {cell} is not positive"));
    }
    let mut users: HashMap<[[u64; 3]; 3], (usize, [Point; 3])> = HashMap::new();
    for (_, tet) in tets(mesh) {
        for facet in FACETS.map(|f| f.map(|k| tet[k])) {
            users.entry(key(facet)).or_insert((0, facet)).0 += 1;
        }
    }
    let surface = Surface::boundary_of(&device.mesh);
    let surface = if surface.triangles.is_empty() { Surface::of(&device.mesh) } else { surface };
    let to_device = |p: Point| {
        let off = |t: usize| {
            let corners = surface.corners(t);
            distance(p, triangle::at(corners, triangle::closest(corners, p)))
        };
        (0..surface.triangles.len()).map(off).fold(f64::INFINITY, f64::min)
    };
    let near = 2.0 * stray + 1e-9;
    let on_box = |facet: &[Point; 3]| {
        (0..3).any(|i| [-1.5, 1.5].iter().any(|x| facet.iter().all(|p| (p[i] - x).abs() <= near)))
    };
    for (n, facet) in users.values().filter(|(n, _)| *n == 1) {
        let on_device = || facet.iter().all(|p| to_device(*p) <= near);
        if *n == 1 && !on_box(facet) && !on_device() {
            faults.push(format!("a facet at {:?} is open", facet[0]));
        }
    }
    // Triangles of the device far from walls are kept: those that are divided, two rings around them and what
    // these touch may have changed.
    let longest = (0..surface.triangles.len()).flat_map(|t| {
        let [a, b, c] = surface.corners(t);
        [distance(a, b), distance(b, c), distance(c, a)]
    });
    let margin = longest.fold(0.0, f64::max) * 4.0 + near;
    for corners in (0..surface.triangles.len()).map(|t| surface.corners(t)) {
        let is_deep = corners.as_flattened().iter().all(|x| x.abs() < 1.5 - margin);
        let n = users.get(&key(corners)).map_or(0, |(n, _)| *n);
        let expected = if device.inside == Inside::Hollow { 1 } else { 2 };
        if is_deep && n != expected {
            faults.push(format!("a triangle of the device is a facet of {n} tets"));
        }
    }
    let (whole, part) = (common_volume(device, [-9.0; 3], [9.0; 3]), common_volume(device, LOW, HIGH));
    let (expected, of_device) = match (device.inside, options.outside) {
        (Inside::Hollow, _) => (27.0 - part, None),
        (_, Outside::Cut) => (27.0, Some(part)),
        (_, Outside::Keep) => (27.0 + whole - part, Some(whole)),
    };
    let all: f64 = tets(mesh).map(|(_, tet)| volume(tet)).sum();
    let mut expect = |what: &str, is: f64, expected: f64| {
        // The strayed part is a strip along the line where both meet, or all of a thin device.
        let bound = 1e-9 * expected.abs().max(1e-3) + 8.0 * stray * part.max(0.1);
        if (is - expected).abs() > bound {
            faults.push(format!("{what}: {is}, expected {expected}"));
        }
    };
    expect("the mesh", all, expected);
    if let Some(of_device) = of_device {
        expect("the device", made.report.devices[0].volume, of_device);
    }
    faults
}

fn sound(host: &Mesh, device: &Device, options: &Options) -> Changed<Report> {
    let made = put(host, std::slice::from_ref(device), options).unwrap();
    let faults = faults(device, options, &made, options.stray.unwrap_or(0.05));
    assert!(faults.is_empty() && made.report.is_valid(), "{} faults, {}", faults.len(), faults[0]);
    made
}

/// The area of a patch.
fn area(mesh: &Mesh, patch: i32) -> f64 {
    let ids = mesh.patches().unwrap().ids;
    let cells =
        mesh.cells.iter().filter(|(cell, kind, _)| *kind == CellKind::TRIANGLE && ids[cell.index()] == patch);
    let corners = cells.map(|(_, _, v)| [v[0], v[1], v[2]].map(|v| mesh.points[v.index()]));
    corners.map(triangle::area).sum()
}

#[test]
fn a_box_through_a_wall_is_cut_off_or_kept() {
    let host = room(8);
    // Not aligned with anything: half of it is outside.
    let device = |inside| Device {
        inside,
        ..filled(box_grid([2; 3], [[-0.31, -0.23, 1.2], [0.37, 0.41, 1.83]]), "box")
    };
    let made = sound(&host, &device(Inside::Filled), &strict());
    let reported = &made.report.devices[0];
    let (base, inside) = (0.68 * 0.64, 0.68 * 0.64 * 0.3);
    assert!((reported.volume - inside).abs() < 1e-12 && (reported.enclosed - inside).abs() < 1e-12);
    assert!((made.report.volume - 27.0).abs() < 1e-10 && made.report.volume_deviation() < 1e-12);
    assert_eq!(
        reported.triangles,
        reported.triangles_kept + reported.triangles_at_walls + reported.triangles_outside
    );
    let patches = made.mesh.patches().unwrap();
    let contact = reported.contact_patch.unwrap();
    assert_eq!(
        (patches.name(contact), patches.name(reported.patch)),
        ("box-contact".to_owned(), "box".to_owned())
    );
    assert!((area(&made.mesh, contact) - base).abs() < 1e-12);
    assert!((area(&made.mesh, patches.find("zmax").unwrap()) - (9.0 - base)).abs() < 1e-12);
    assert!((area(&made.mesh, reported.patch) - base - 2.0 * 0.3 * (0.68 + 0.64)).abs() < 1e-12);
    assert!(made.report.is_complete());

    let keep = Options { outside: Outside::Keep, ..strict() };
    let made = sound(&host, &device(Inside::Filled), &keep);
    let reported = &made.report.devices[0];
    assert!((reported.volume - base * 0.63).abs() < 1e-12 && reported.contact_patch.is_none());
    let all = 2.0 * base + 2.0 * 0.63 * (0.68 + 0.64);
    assert!((area(&made.mesh, reported.patch) - all).abs() < 1e-12);

    for outside in [Outside::Cut, Outside::Keep] {
        let made = sound(&host, &device(Inside::Hollow), &Options { outside, ..strict() });
        assert!((made.report.volume - 27.0 + inside).abs() < 1e-11 && made.report.volume_deviation() < 1e-12);
        assert!(made.report.devices[0].contact_patch.is_none());
    }
    let own = put(&host, &[device(Inside::Own)], &strict()).unwrap_err();
    assert!(
        own.what().contains("keeps its tets, but a wall of the host meets them") && own.place().is_some()
    );
}

#[test]
fn what_lies_on_a_wall_has_its_own_patch() {
    let host = room(8);
    // On the lattice, off it, and in a corner of the room.
    for (low, high) in [
        ([-0.375, -0.375, 0.75], [0.375, 0.375, 1.5]),
        ([-0.3, -0.2, 1.1], [0.4, 0.3, 1.5]),
        ([0.9, 1.0, 1.1], [1.5; 3]),
    ] {
        let device = filled(box_grid([2; 3], [low, high]), "box");
        let made = sound(&host, &device, &strict());
        let reported = &made.report.devices[0];
        let [x, y, z] = [0, 1, 2].map(|i| high[i] - low[i]);
        let on_walls = if low[0] == 0.9 { x * y + y * z + z * x } else { x * y };
        assert!((area(&made.mesh, reported.contact_patch.unwrap()) - on_walls).abs() < 1e-12);
        assert!((reported.volume - x * y * z).abs() < 1e-12 && made.report.is_complete());
        let other = Device { inside: Inside::Hollow, ..device };
        assert!(sound(&host, &other, &strict()).report.devices[0].contact_patch.is_none());
    }
    // A device that keeps its tets may have whole facets and corners on walls.
    let cube = Device::new(box_grid([1; 3], [[0.75, 0.0, 0.0], [1.5, 0.75, 0.75]]), "cube");
    let tip = Device::new(moved(ball(2, 1), |p| [0.3 * p[0], 0.3 * p[1], 1.2 + 0.3 * p[2]]), "tip");
    for (device, has_area) in [(cube, true), (tip, false)] {
        let made = sound(&room(4), &device, &strict());
        let reported = &made.report.devices[0];
        assert_eq!(
            (reported.triangles, reported.contact_patch.is_some()),
            (reported.triangles_kept, has_area)
        );
    }
    // A device outside only touches.
    let beside = filled(box_grid([2; 3], [[-0.3, -0.2, 1.5], [0.4, 0.3, 2.0]]), "box");
    assert!(put(&host, &[beside], &strict()).unwrap_err().what().contains("lies outside of the host"));
    // Two devices with common walls and a common side.
    let two = [[-0.5, 0.0], [0.0, 0.5]]
        .map(|[x, y]| filled(box_grid([2; 3], [[x, -0.3, 1.1], [y, 0.3, 1.7]]), "half"));
    let made = put(&host, &two, &strict()).unwrap();
    assert!(
        check(&made.mesh).is_empty()
            && made.report.devices.iter().all(|device| (device.volume - 0.12).abs() < 1e-12)
    );
}

#[test]
fn an_interface_of_regions_ends_at_the_device() {
    let mut host = room(8);
    let side = |v: &[VertexId]| v.iter().map(|v| host.points[v.index()][0]).sum::<f64>() > 0.0;
    let ids: Vec<i32> = host
        .cells
        .iter()
        .map(|(_, kind, v)| if kind == CellKind::TETRA { 1 + i32::from(side(v)) } else { 0 })
        .collect();
    host.set_cell_field(Field::scalars("region", ids));
    let ball = filled(small_ball(0.6, [0.05, 0.02, -0.01]), "ball");
    let made = put(&host, std::slice::from_ref(&ball), &strict()).unwrap();
    assert!(check(&made.mesh).is_empty() && made.report.volume_deviation() < 1e-12);
    let bodies: BTreeMap<i32, f64> =
        made.report.regions.iter().map(|body| (body.region, body.volume)).collect();
    let left = common_volume(&ball, LOW, [0.0, 1.5, 1.5]);
    assert!((bodies[&1] - 13.5 + left).abs() < 1e-11, "{bodies:?}");
    assert!((bodies[&2] - 13.5 + made.report.devices[0].volume - left).abs() < 1e-11, "{bodies:?}");
}

#[test]
fn labels_and_fields_of_walls_go_along() {
    let mut host = room(8);
    let ids = host.patches().unwrap().ids;
    let code: Vec<f64> = ids.iter().map(|id| f64::from(*id) * 10.0).collect();
    host.set_cell_field(Field::scalars("code", code));
    let ball = filled(small_ball(0.5, [0.1, 0.2, 1.3]), "ball");
    let made = sound(&host, &ball, &strict());
    let code = made.mesh.cell_field("code").unwrap().values.to_f64().unwrap();
    let patches = made.mesh.patches().unwrap();
    for (cell, kind, v) in made.mesh.cells.iter().filter(|(_, kind, _)| *kind == CellKind::TRIANGLE) {
        let id = patches.ids[cell.index()];
        if id <= 6 {
            assert_eq!(code[cell.index()], f64::from(id) * 10.0, "{kind:?} {v:?}");
        }
    }
    let n: usize = (1..=6).map(|id| patches.ids.iter().filter(|x| **x == id).count()).sum();
    assert!(n > 6 * 128);
}

#[test]
fn walls_that_may_stray_leave_no_bad_tets() {
    let host = room(8);
    let (mut n_strict, mut n_stray) = (0, 0);
    for at in [[0.1, 0.2, 1.3], [0.3, -0.4, 1.45], [1.2, 1.1, 0.3]] {
        let ball = filled(small_ball(0.5, at), "ball");
        n_strict += sound(&host, &ball, &strict()).report.improved.left.len();
        let made = sound(&host, &ball, &Options { adapt: Adapt::No, ..Options::default() });
        n_stray += made.report.improved.left.len();
    }
    assert!(n_stray < n_strict.max(1), "{n_stray} {n_strict}");
    let coil = filled(moved(coil([0.0; 3]), |p| [p[0], p[1], p[2] + 1.2]), "coil");
    let one = sound(&host, &coil, &Options::default());
    let three = Threads::new(3).unwrap();
    let more = implant(&host, &[coil], &Options::default(), &Rules::default(), &three).unwrap();
    assert!(one.mesh == more.mesh && one.history == more.history);
    let stent = filled(moved(stent(), |p| [0.5 * p[0], 0.5 * p[1], 0.7 + 0.5 * p[2]]), "stent");
    sound(&host, &stent, &strict());
}

#[test]
fn a_device_that_crosses_itself_goes_through_a_wall_with_a_new_surface() {
    let host = box_grid([8; 3], [LOW, HIGH]);
    let overlapping =
        Coil { centre: [0.1, 0.05, 1.35], radius: 0.6, pitch: 0.2, turns: 2.5, wire_radius: 0.12 };
    let device = filled(overlapping.mesh(40, 8).unwrap(), "coil");
    let interface = Interface::Conform { tolerance: Some(0.04) };
    let options = Options { interface, ..Options::default() };
    for outside in [Outside::Cut, Outside::Keep] {
        let made =
            put(&host, std::slice::from_ref(&device), &Options { outside, ..options.clone() }).unwrap();
        let reported = &made.report.devices[0];
        assert!(made.report.is_valid() && made.report.volume_deviation() < 1e-3);
        assert!(reported.fit.unwrap().is_reached() && reported.triangles_at_walls > 0);
        let all: f64 = tets(&made.mesh).map(|(_, tet)| volume(tet)).sum();
        assert_eq!(outside == Outside::Keep, all > 27.01);
        assert_eq!(
            outside == Outside::Cut,
            reported.triangles_outside > 0 && reported.contact_patch.is_some()
        );
    }
}

#[test]
fn what_takes_all_the_room_or_holds_cells_of_other_kinds_is_refused() {
    let host = room(4);
    let all = filled(room(2), "all");
    assert!(put(&host, &[all], &strict()).unwrap_err().what().contains("leaves nothing of the host"));
    let mut with_wire = room(4);
    let at = |p: Point| VertexId::new(with_wire.points.iter().position(|q| distance(*q, p) < 1e-9).unwrap());
    let ends = [at([0.0, 0.0, 1.5]), at([0.75, 0.0, 1.5])];
    with_wire.cells.push(CellKind::LINE, ends);
    with_wire.cell_data.clear();
    let ball = filled(small_ball(0.3, [0.375, 0.05, 1.5]), "ball");
    let error = put(&with_wire, &[ball], &strict()).unwrap_err();
    assert!(error.what().contains("cells that are not tets") && error.place().is_some(), "{error}");
}

/// `MOTET_CASES=500` makes more placements.
#[test]
fn random_placements_give_a_sound_mesh_or_a_named_refusal() {
    let n: usize = std::env::var("MOTET_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(60);
    let host = room(8);
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let (mut n_sound, mut n_through, mut n_left, mut reasons) = (0, 0, 0, BTreeMap::<String, usize>::new());
    for _ in 0..n {
        let (name, mut device) = random_device(&mut random);
        if device.inside == Inside::Own && random.next() < 0.8 {
            device.inside = Inside::Filled;
        }
        let stray = (random.next() < 0.5).then_some(1e-9);
        let outside = if random.next() < 0.3 { Outside::Keep } else { Outside::Cut };
        let options = Options { adapt: Adapt::No, stray, outside, ..Options::default() };
        match put(&host, std::slice::from_ref(&device), &options) {
            Ok(made) => {
                let strayed = stray.unwrap_or(0.05);
                let faults = faults(&device, &options, &made, strayed);
                assert!(
                    faults.is_empty() && made.report.is_valid(),
                    "{name}, {outside:?}, {stray:?}: {}",
                    faults[0]
                );
                n_sound += 1;
                n_through += usize::from(made.report.devices[0].triangles_at_walls > 0);
                n_left += made.report.n_unforced();
            }
            Err(error) => {
                assert!(error.remedy_text().is_some() && error.place().is_some(), "{name}: {error}");
                let is_known = ["keeps its tets, but", "lies outside of the host"];
                let reason = is_known.iter().find(|reason| error.what().contains(**reason));
                *reasons.entry(reason.map_or(error.to_string(), |r| (*r).to_owned())).or_default() += 1;
            }
        }
    }
    println!(
        "{n_sound} of {n} sound, {n_through} through walls, {n_left} bad tets left that nothing forces; refused: {reasons:?}"
    );
    assert!(reasons.keys().all(|reason| reason.len() < 40), "{reasons:?}");
    assert!(3 * n_sound > 2 * n && 4 * n_through > n);
}
