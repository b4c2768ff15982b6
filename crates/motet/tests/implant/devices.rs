//! Devices in a mesh, compared with what is promised: every triangle is a facet, the mesh is conforming,
//! volumes are right, and the rest stays to the bit.

use std::collections::{BTreeMap, HashMap, HashSet};

use crate::common::devices::{coil, key, moved, random_device, room, small_ball, tets};
use crate::common::random::Random;
use crate::common::solid_angle::encloses;
use motet::base::{CellId, Point, Threads, VertexId};
use motet::geometry::tet::{EDGES, FACETS, centroid, volume};
use motet::geometry::triangle;
use motet::geometry::vector::{cross, distance, dot, norm, sub};
use motet::implant::{Adapt, Device, Inside, Interface, Options, Report, implant};
use motet::mesh::check::{check, is_conforming};
use motet::mesh::history::{Changed, Origin, Rules, field_ledger};
use motet::mesh::shapes::{Coil, ball, box_grid};
use motet::mesh::{CellKind, Cells, Field, Mesh, Surface};

fn put(host: &Mesh, devices: &[Device], options: &Options) -> motet::Result<Changed<Report>> {
    implant(host, devices, options, &Rules::default(), &Threads::single())
}

fn surface(device: &Device) -> Surface {
    let own = Surface::of(&device.mesh);
    if device.inside == Inside::Own || own.triangles.is_empty() {
        Surface::boundary_of(&device.mesh)
    } else {
        own
    }
}

/// The faults of a result that is reported as valid.
fn faults(host: &Mesh, devices: &[Device], options: &Options, made: &Changed<Report>) -> Vec<String> {
    let mut faults = Vec::new();
    let mesh = &made.mesh;
    if mesh.validate().is_err() || !is_conforming(&check(mesh)) {
        faults.push("does not conform".to_owned());
    }
    faults.extend(
        tets(mesh)
            .filter(|(_, tet)| volume(*tet) <= 0.0)
            .map(|(cell, _)| format!("cell {cell} is not positive")),
    );
    let mut users: HashMap<[[u64; 3]; 3], usize> = HashMap::new();
    for (_, tet) in tets(mesh) {
        FACETS.iter().for_each(|f| *users.entry(key(f.map(|k| tet[k]))).or_default() += 1);
    }
    let of_host: HashSet<_> = {
        let boundary = Surface::boundary_of(host);
        (0..boundary.triangles.len()).map(|t| key(boundary.corners(t))).collect()
    };
    let mut of_devices: HashMap<[[u64; 3]; 3], bool> = HashMap::new();
    for device in devices {
        let surface = surface(device);
        for t in 0..surface.triangles.len() {
            let is_hollow = device.inside == Inside::Hollow;
            of_devices.entry(key(surface.corners(t))).and_modify(|h| *h = false).or_insert(is_hollow);
        }
    }
    for (facet, &is_hollow) in &of_devices {
        let n = users.get(facet).copied().unwrap_or(0);
        if n != if is_hollow { 1 } else { 2 } {
            faults.push(format!("a triangle of a device is a facet of {n} tets"));
        }
    }
    let is_open = |(facet, n): (&[[u64; 3]; 3], &usize)| {
        *n == 1 && !of_devices.contains_key(facet) && !of_host.contains(facet)
    };
    // Refined walls have other facets.
    if options.adapt == Adapt::No {
        let n_open = users.iter().filter(|x| is_open(*x)).count();
        if n_open > 0 {
            faults.push(format!("{n_open} facets are open"));
        }
    }
    let off = made.report.volume_deviation();
    if off.is_nan() || off > 1e-9 {
        faults.push(format!("volumes are off by {off}"));
    }
    faults.extend(touched_beyond(host, devices, options, made));
    faults
}

/// Tets of the host farther from all devices than the reach that are no longer there.
fn touched_beyond(
    host: &Mesh,
    devices: &[Device],
    options: &Options,
    made: &Changed<Report>,
) -> Option<String> {
    if options.adapt != Adapt::No {
        return None;
    }
    let now: HashSet<_> = tets(&made.mesh).map(|(_, tet)| key(tet)).collect();
    let surfaces: Vec<Surface> = devices.iter().map(surface).collect();
    let off = |p: Point| {
        let all = surfaces.iter().flat_map(|s| (0..s.triangles.len()).map(move |t| s.corners(t)));
        all.map(|t| distance(p, triangle::at(t, triangle::closest(t, p)))).fold(f64::INFINITY, f64::min)
    };
    let removed = tets(host).filter(|(_, tet)| !now.contains(&key(*tet)));
    let is_far = |(_, tet): &(CellId, [Point; 4])| {
        let size = EDGES.iter().map(|&[i, j]| distance(tet[i], tet[j])).sum::<f64>() / 6.0;
        let centre = centroid(*tet);
        let radius = tet.iter().map(|&p| distance(p, centre)).fold(0.0, f64::max);
        // Within a device the distance to its surface says nothing.
        let is_within = || surfaces.iter().any(|s| encloses(&s.points, &s.triangles, centre));
        off(centre) > radius + options.reach * size && !is_within()
    };
    let n = removed.filter(is_far).count();
    (n > 0).then(|| format!("{n} tets far from all devices are not as they were"))
}

fn sound(host: &Mesh, devices: &[Device], options: &Options) -> Changed<Report> {
    let made = put(host, devices, options).unwrap();
    let faults = faults(host, devices, options, &made);
    assert!(faults.is_empty(), "{} faults, {}", faults.len(), faults[0]);
    assert!(made.report.is_valid());
    made
}

fn no_adapt() -> Options {
    Options { adapt: Adapt::No, ..Options::default() }
}

#[test]
fn a_ball_in_a_box_keeps_its_tets_and_shares_its_vertices() {
    let host = room(8);
    let device = Device::new(small_ball(0.5, [0.1, 0.05, -0.1]), "ball");
    assert_eq!(device.inside, Inside::Own);
    let made = sound(&host, std::slice::from_ref(&device), &no_adapt());
    assert!(made.report.is_complete());
    let now: HashSet<_> = tets(&made.mesh).map(|(_, tet)| key(tet)).collect();
    assert!(tets(&device.mesh).all(|(_, tet)| now.contains(&key(tet))));
    let regions = made.mesh.regions().unwrap();
    assert_eq!(regions.names.get(&2).map(String::as_str), Some("ball"));
    assert_eq!(regions.ids.iter().filter(|id| **id == 2).count(), device.mesh.cells.tets().count());
    let patches = made.mesh.patches().unwrap();
    assert_eq!(patches.find("ball"), Some(7));
    assert_eq!(patches.name(1), "xmin");
}

#[test]
fn the_regions_of_a_device_stay_apart() {
    let mut mesh = small_ball(0.5, [0.1, 0.05, -0.1]);
    let is_core = |tet: &[Point; 4]| distance(centroid(*tet), [0.1, 0.05, -0.1]) < 0.25;
    let mut ids = vec![0; mesh.cells.len()];
    tets(&mesh).for_each(|(cell, tet)| ids[cell.index()] = if is_core(&tet) { 4 } else { 9 });
    mesh.set_cell_field(Field::scalars("region", ids));
    mesh.label_names.regions = BTreeMap::from([(4, "core".to_owned())]);
    let of = |id: i32| -> f64 {
        let ids = mesh.regions().unwrap().ids;
        tets(&mesh).filter(|(cell, _)| ids[cell.index()] == id).map(|(_, tet)| volume(tet)).sum()
    };
    let expected = [of(4), of(9)];
    let made = sound(&room(8), &[Device::new(mesh, "ball")], &no_adapt());
    assert_eq!(made.report.devices[0].regions, [2, 3]);
    let regions = made.mesh.regions().unwrap();
    assert_eq!((regions.name(2), regions.name(3)), ("ball-core".to_owned(), "ball-9".to_owned()));
    for (id, expected) in [2, 3].into_iter().zip(expected) {
        let body = made.report.regions.iter().find(|body| body.region == id).unwrap();
        assert!(expected > 0.0 && (body.volume - expected).abs() < 1e-14);
    }
}

#[test]
fn a_coil_is_filled_or_hollow() {
    let host = room(8);
    let mut device = Device::new(coil([0.0; 3]), "coil");
    assert_eq!(device.inside, Inside::Filled);
    let made = sound(&host, std::slice::from_ref(&device), &no_adapt());
    assert!(made.report.is_complete(), "{} left", made.report.improved.left.len());
    device.inside = Inside::Hollow;
    let made = sound(&host, std::slice::from_ref(&device), &no_adapt());
    assert!(made.report.devices[0].regions.is_empty());
    assert!(made.mesh.regions().unwrap().ids.iter().all(|id| [0, 1].contains(id)));
    assert!((made.report.volume - 27.0 + made.report.devices[0].enclosed).abs() < 1e-9);
}

#[test]
fn devices_lie_side_by_side_within_each_other_and_share_facets() {
    let host = room(8);
    let beside = [
        Device::new(small_ball(0.3, [-0.6, 0.0, 0.0]), "left"),
        Device::new(small_ball(0.3, [0.6, 0.0, 0.0]), "right"),
    ];
    let made = sound(&host, &beside, &no_adapt());
    assert_eq!(made.report.regions.len(), 3);
    let mut nested =
        [Device::new(small_ball(0.8, [0.0; 3]), "outer"), Device::new(small_ball(0.3, [0.0; 3]), "inner")];
    nested.iter_mut().for_each(|device| device.inside = Inside::Filled);
    let made = put(&host, &nested, &no_adapt()).unwrap();
    let volumes: Vec<f64> = made.report.devices.iter().map(|device| device.volume).collect();
    let enclosed: Vec<f64> = made.report.devices.iter().map(|device| device.enclosed).collect();
    assert!((volumes[1] - enclosed[1]).abs() < 1e-12);
    assert!((volumes[0] - enclosed[0] + enclosed[1]).abs() < 1e-12);
    // Two cubes with a common side.
    let cube =
        |x: f64| Device::new(box_grid([2; 3], [[x, -0.3, -0.3], [x + 0.5, 0.3, 0.3]]), format!("cube {x}"));
    let made = sound(&host, &[cube(-0.5), cube(0.0)], &no_adapt());
    assert!(made.report.devices.iter().all(|device| (device.volume - 0.18).abs() < 1e-12));
}

/// The room in two halves, with or without a wall between them.
fn halves() -> Mesh {
    let mut host = room(8);
    let is_right = |p: Point| p[0] > 0.0;
    let ids: Vec<i32> = host
        .cells
        .iter()
        .map(|(_, kind, v)| match (kind, v) {
            (CellKind::TETRA, &[a, b, c, d]) => {
                1 + i32::from(is_right(centroid([a, b, c, d].map(|v| host.points[v.index()]))))
            }
            _ => 0,
        })
        .collect();
    host.set_cell_field(Field::scalars("region", ids));
    host.label_names.regions = BTreeMap::from([(1, "blood".to_owned()), (2, "clot".to_owned())]);
    host
}

#[test]
fn regions_and_their_interface_stay() {
    let host = halves();
    let device = Device::new(small_ball(0.4, [-0.6, 0.0, 0.0]), "ball");
    let made = sound(&host, &[device], &no_adapt());
    let volumes: Vec<(Option<&str>, f64)> =
        made.report.regions.iter().map(|body| (body.name.as_deref(), body.volume)).collect();
    assert_eq!(volumes.len(), 3);
    assert_eq!((volumes[0].0, volumes[1].0, volumes[2].0), (Some("blood"), Some("clot"), Some("ball")));
    assert!((volumes[0].1 + volumes[2].1 - 13.5).abs() < 1e-11 && (volumes[1].1 - 13.5).abs() < 1e-11);
}

#[test]
fn a_wall_that_is_near_is_refined() {
    let host = room(4);
    let device = Device::new(small_ball(0.3, [0.0, 0.0, 1.15]), "ball");
    let plain = put(&host, std::slice::from_ref(&device), &no_adapt()).unwrap();
    let made = sound(&host, std::slice::from_ref(&device), &Options::default());
    assert!(made.report.adapted.is_some_and(|adapted| adapted.generations > 0));
    let worst = |made: &Changed<Report>| made.report.improved.after.worst.unwrap().eas;
    assert!(made.report.is_complete() && worst(&made) > worst(&plain), "{} {}", worst(&made), worst(&plain));
    let all = Options { adapt: Adapt::All, ..Options::default() };
    let made = sound(&host, &[device], &all);
    assert!(made.report.adapted.is_some_and(|adapted| adapted.tets_after > 2 * adapted.tets_before));
}

#[test]
fn fields_go_along() {
    let mut host = room(8);
    let linear = |p: Point| 1.0 + 2.0 * p[0] - p[1] + 0.5 * p[2];
    host.set_point_field(Field::scalars("p", host.points.iter().map(|p| linear(*p)).collect::<Vec<_>>()));
    let ids: Vec<i64> = (0..host.cells.len() as i64).collect();
    let means: Vec<f64> = host
        .cells
        .iter()
        .map(|(_, _, v)| v.iter().map(|v| linear(host.points[v.index()])).sum::<f64>() / v.len() as f64)
        .collect();
    host.set_cell_field(Field::scalars("mean", means));
    host.set_cell_field(Field::scalars("id", ids));
    for options in [no_adapt(), Options { adapt: Adapt::All, ..Options::default() }] {
        let made = put(&host, &[Device::new(small_ball(0.5, [0.0; 3]), "ball")], &options).unwrap();
        let p = made.mesh.point_field("p").unwrap().values.to_f64().unwrap();
        let off = p.iter().zip(&made.mesh.points).map(|(x, p)| (x - linear(*p)).abs()).fold(0.0, f64::max);
        assert!(off < 1e-13, "{off}");
        let ledger = field_ledger(&host, &made.mesh, &Rules::default(), &Threads::single());
        let of_mean = ledger.iter().find(|field| field.name == "mean").unwrap();
        assert!(of_mean.range_after.unwrap()[0] >= of_mean.range_before.unwrap()[0]);
        // The sum over all regions is preserved: what lies in the ball came from the box.
        let integral = |mesh: &Mesh| -> f64 {
            let mean = mesh.cell_field("mean").unwrap().values.to_f64().unwrap();
            tets(mesh).map(|(cell, tet)| mean[cell.index()] * volume(tet)).sum()
        };
        let (before, after) = (integral(&host), integral(&made.mesh));
        assert!((before - after).abs() < 1e-9 * before.abs().max(27.0), "{before} {after}");
        // Kept cells keep their values.
        for (cell, origin) in (0u32..).map(CellId).zip(made.history.cells.iter()) {
            if let (Origin::Kept(old), Adapt::No) = (origin, options.adapt) {
                let now = made.mesh.cells.vertices(cell).iter().map(|v| made.mesh.points[v.index()]);
                let was = host.cells.vertices(old).iter().map(|v| host.points[v.index()]);
                assert!(now.eq(was));
            }
        }
    }
}

#[test]
fn threads_change_nothing() {
    let host = room(8);
    let devices = [Device::new(coil([0.0; 3]), "coil")];
    let one = implant(&host, &devices, &Options::default(), &Rules::default(), &Threads::single()).unwrap();
    let three = Threads::new(3).unwrap();
    let more = implant(&host, &devices, &Options::default(), &Rules::default(), &three).unwrap();
    assert_eq!(one.mesh, more.mesh);
    assert_eq!(one.history, more.history);
}

#[test]
fn what_cannot_be_put_in_is_refused_with_the_reason() {
    let host = room(4);
    let refused = |device: Mesh| put(&host, &[Device::new(device, "thing")], &no_adapt()).unwrap_err();
    let reported = |device: Mesh, what: &str| {
        let error = refused(device);
        assert!(error.what().contains(what) && error.remedy_text().is_some(), "{error}");
    };
    reported(small_ball(0.4, [5.0, 0.0, 0.0]), "`thing` lies outside of the host");
    reported(small_ball(9.0, [0.0; 3]), "`thing` contains the whole host");
    reported(small_ball(0.4, [1.4, 0.0, 0.0]), "keeps its tets, but a ");
    reported(box_grid([1; 3], [[0.5, 0.1, 0.0], [1.5, 0.5, 0.5]]), "keeps its tets, but a wall");
    let mut both = small_ball(0.3, [0.0; 3]);
    let other = small_ball(0.3, [5.0, 0.0, 0.0]);
    let first = both.points.len();
    both.points.extend(&other.points);
    for (_, kind, vertices) in other.cells.iter() {
        both.cells.push(kind, vertices.iter().map(|v| VertexId::new(first + v.index())));
    }
    both.cell_data.clear();
    reported(both, "keeps its tets, but a part of it lies outside of the host");
    let mut open = Surface::boundary_of(&small_ball(0.3, [0.0; 3]));
    open.triangles.pop();
    let open = Mesh::new(
        open.points.clone(),
        Cells::uniform(CellKind::TRIANGLE, open.triangles.as_flattened().to_vec()).unwrap(),
    );
    reported(open, "the surface ends at the edge");
    reported(Mesh::default(), "`thing`");
    let crossing =
        [Device::new(small_ball(0.4, [0.0; 3]), "one"), Device::new(small_ball(0.4, [0.3, 0.0, 0.0]), "two")];
    assert!(put(&host, &crossing, &no_adapt()).unwrap_err().what().contains("triangles meet"));
    let twice = |inside: Inside| {
        let mut device = Device::new(small_ball(0.4, [0.0; 3]), "one");
        device.inside = inside;
        put(&host, &[device.clone(), Device { name: "two".to_owned(), ..device }], &no_adapt()).unwrap_err()
    };
    assert!(twice(Inside::Own).what().contains("`one` keeps its tets"));
    assert!(twice(Inside::Filled).what().contains("later devices take all the space of the device `one`"));
    let surface = coil([0.0; 3]);
    assert!(put(&surface, &[Device::new(small_ball(0.1, [0.0; 3]), "x")], &no_adapt()).is_err());
    assert!(put(&host, &[], &no_adapt()).is_err());
    let odd = [
        Options { size: Some(-1.0), ..Options::default() },
        Options { growth: 0.0, ..Options::default() },
        Options { carve: 4.0, reach: 3.0, ..Options::default() },
        Options { reach: f64::NAN, ..Options::default() },
    ];
    for options in odd {
        assert!(put(&host, &[Device::new(small_ball(0.3, [0.0; 3]), "x")], &options).is_err());
    }
}

fn conform(tolerance: Option<f64>) -> Options {
    Options { interface: Interface::Conform { tolerance }, ..no_adapt() }
}

/// Both surfaces as one device, whether they meet or not.
fn together(a: &Mesh, b: &Mesh) -> Mesh {
    let mut points = Vec::new();
    let mut cells = Cells::new();
    for mesh in [a, b] {
        let surface =
            if mesh.cells.dim() == Some(3) { Surface::boundary_of(mesh) } else { Surface::of(mesh) };
        let moved = |v: VertexId| VertexId::new(points.len() + v.index());
        surface.triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, t.map(moved)));
        points.extend(surface.points);
    }
    Mesh::new(points, cells)
}

#[test]
fn what_crosses_itself_gets_a_new_surface_within_the_tolerance() {
    let host = room(8);
    // Overlapping turns; two balls, one partly in the other; a ball given twice; a ball with a hole.
    let overlapping = Coil { centre: [0.0; 3], radius: 0.6, pitch: 0.2, turns: 2.5, wire_radius: 0.12 };
    let lens = |r: f64, d: f64| std::f64::consts::PI * (4.0 * r + d) * (2.0 * r - d).powi(2) / 12.0;
    let sphere = |r: f64| std::f64::consts::PI * 4.0 / 3.0 * r * r * r;
    let one = moved(ball(8, 1), |p| [0, 1, 2].map(|i| 0.5 * p[i]));
    let other = moved(one.clone(), |p| [p[0] + 0.6, p[1], p[2]]);
    let holed = {
        let whole = together(&one, &Mesh::default());
        let kept = whole.cells.iter().skip(12).map(|(_, _, v)| v.to_vec()).collect::<Vec<_>>();
        let mut cells = Cells::new();
        kept.iter().for_each(|v| cells.push(CellKind::TRIANGLE, v.iter().copied()));
        Mesh::new(whole.points, cells)
    };
    let both = 2.0 * sphere(0.5) - lens(0.5, 0.6);
    let cases = [
        ("coil", overlapping.mesh(40, 8).unwrap(), None),
        ("balls", together(&one, &other), Some(both)),
        ("twice", together(&one, &one), Some(sphere(0.5))),
        ("holed", holed, Some(sphere(0.5))),
    ];
    for (name, mesh, volume) in cases {
        let device = Device::new(mesh, name);
        assert!(put(&host, std::slice::from_ref(&device), &no_adapt()).is_err(), "{name}");
        let made = put(&host, &[device], &conform(None)).unwrap();
        let reported = &made.report.devices[0];
        let fit = reported.fit.unwrap();
        assert!(made.report.is_valid() && check(&made.mesh).is_empty(), "{name}");
        assert!(made.report.volume_deviation() < 1e-9, "{name}");
        assert_eq!(made.report.n_unforced(), 0, "{name}");
        assert!(fit.to_old <= fit.tolerance, "{name} {fit:?}");
        // The hole is closed by a surface that has no counterpart in the old one.
        assert!(name == "holed" || fit.is_reached(), "{name} {fit:?}");
        if let Some(volume) = volume {
            let off = (reported.volume - volume).abs() / volume;
            assert!(off < 0.05, "{name}: {} of {volume}", reported.volume);
        }
    }
}

/// The surface with opposite orientation.
fn turned(mesh: &Mesh) -> Mesh {
    let mut surface = together(mesh, &Mesh::default());
    let turned: Vec<VertexId> = surface.cells.iter().flat_map(|(_, _, v)| [v[0], v[2], v[1]]).collect();
    surface.cells = Cells::uniform(CellKind::TRIANGLE, turned).unwrap();
    surface
}

#[test]
fn parts_are_taken_as_they_are_meant_whichever_way_they_face() {
    let host = room(8);
    let volume = |mesh: Mesh| {
        let made = put(&host, &[Device::new(mesh, "thing")], &conform(Some(0.03))).unwrap();
        assert!(made.report.is_complete());
        made.report.devices[0].volume
    };
    let at = |radius: f64, x: f64| moved(ball(5, 1), |p| [x + radius * p[0], radius * p[1], radius * p[2]]);
    let [one, other, within] = [at(0.5, 0.0), at(0.4, 0.6), at(0.3, 0.0)];
    let mixed = turned(&together(&one, &Mesh::default()));
    let [of_one, of_within] = [&one, &within].map(|mesh| volume(mesh.clone()));
    let of_both = volume(together(&one, &other));
    let is_near = |mesh: &Mesh, expected: f64| {
        let volume = volume(mesh.clone());
        assert!((volume - expected).abs() < 0.03 * expected, "{volume}, expected {expected}");
    };
    is_near(&mixed, of_one);
    is_near(&together(&mixed, &other), of_both);
    is_near(&together(&mixed, &turned(&other)), of_both);
    // A cavity is oriented opposite to the surface around it; two nested surfaces with the same orientation
    // are one body.
    let shell = together(&one, &turned(&within));
    for shell in [&shell, &turned(&shell)] {
        is_near(shell, of_one - of_within);
    }
    let filled = together(&one, &within);
    for filled in [&filled, &turned(&filled)] {
        is_near(filled, of_one);
    }
    // One triangle of many reversed, and an open ball.
    let mut odd = together(&one, &Mesh::default());
    let first: Vec<VertexId> = odd.cells.vertices(CellId(0)).to_vec();
    let all: Vec<VertexId> = odd.cells.iter().flat_map(|(_, _, v)| v.to_vec()).collect();
    let tail = &all[3..];
    let one_turned = [&[first[0], first[2], first[1]][..], tail].concat();
    odd.cells = Cells::uniform(CellKind::TRIANGLE, one_turned).unwrap();
    is_near(&odd, of_one);
    odd.cells = Cells::uniform(CellKind::TRIANGLE, tail.to_vec()).unwrap();
    is_near(&turned(&odd), of_one);
}

#[test]
fn new_surfaces_have_no_narrow_triangles() {
    let host = room(8);
    // Turns that overlap, and turns that touch.
    for pitch in [0.2, 0.24] {
        let coil = Coil { centre: [0.0; 3], radius: 0.6, pitch, turns: 2.5, wire_radius: 0.12 };
        let device = Device::new(coil.mesh(40, 8).unwrap(), "coil");
        let made = put(&host, &[device], &conform(None)).unwrap();
        assert!(made.report.devices[0].fit.unwrap().is_reached());
        let surface = Surface::of(&made.mesh);
        let least = |t: usize| {
            let corners = surface.corners(t);
            (0..3).map(|k| angle([0, 1, 2].map(|i| corners[(k + i) % 3]))).fold(180.0, f64::min)
        };
        let least = (0..surface.triangles.len()).map(least).fold(180.0, f64::min);
        println!("pitch {pitch}: {} triangles, smallest angle {least:.1}", surface.triangles.len());
        assert!(least > 20.0, "pitch {pitch}: {least}");
    }
}

/// The angle at the first corner, in degrees.
fn angle([a, b, c]: [Point; 3]) -> f64 {
    let [u, v] = [b, c].map(|p| sub(p, a));
    norm(cross(u, v)).atan2(dot(u, v)).to_degrees()
}

#[test]
fn a_tolerance_is_kept_and_what_goes_round_nothing_refused() {
    let host = room(8);
    let device = Device::new(moved(ball(8, 1), |p| [0, 1, 2].map(|i| 0.5 * p[i])), "ball");
    let made = |tolerance| put(&host, std::slice::from_ref(&device), &conform(Some(tolerance))).unwrap();
    let [fine, coarse] = [0.004, 0.02].map(made);
    for (made, tolerance) in [(&fine, 0.004), (&coarse, 0.02)] {
        let fit = made.report.devices[0].fit.unwrap();
        assert!(fit.is_reached() && fit.tolerance == tolerance, "{fit:?}");
    }
    assert!(fine.report.devices[0].triangles > coarse.report.devices[0].triangles);
    let three = Threads::new(3).unwrap();
    let options = conform(Some(0.02));
    let again = implant(&host, std::slice::from_ref(&device), &options, &Rules::default(), &three).unwrap();
    assert_eq!(again.mesh, coarse.mesh);
    let refused =
        |mesh: Mesh, options: &Options| put(&host, &[Device::new(mesh, "thing")], options).unwrap_err();
    assert!(refused(Mesh::default(), &conform(None)).what().contains("encloses no volume"));
    // Refused before any work, with what is possible instead.
    let too_fine = refused(device.mesh.clone(), &conform(Some(1e-6)));
    assert!(too_fine.what().contains("too many cubes"));
    assert!(too_fine.remedy_text().unwrap().contains("a tolerance of at least 2"), "{too_fine}");
    assert!(refused(device.mesh.clone(), &conform(Some(-1.0))).what().contains("the tolerance is -1"));
    let mut odd = together(&device.mesh, &Mesh::default());
    let first = odd.cells.vertices(CellId(0))[0];
    odd.points[first.index()][1] = f64::NAN;
    assert!(refused(odd, &conform(None)).what().contains("not finite"));
}

/// `MOTET_CASES=500` makes more placements. Those that meet walls have their own test.
#[test]
fn random_placements_away_from_walls_are_sound() {
    let n: usize = std::env::var("MOTET_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(40);
    let host = room(8);
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut n_sound = 0;
    for _ in 0..n {
        let (name, device) = random_device(&mut random);
        let options = no_adapt();
        let Ok(made) = put(&host, std::slice::from_ref(&device), &options) else { continue };
        if made.report.devices[0].triangles_kept == made.report.devices[0].triangles
            && made.report.devices[0].contact_patch.is_none()
        {
            let faults = faults(&host, std::slice::from_ref(&device), &options, &made);
            assert!(faults.is_empty() && made.report.is_valid(), "{name}: {}", faults[0]);
            n_sound += 1;
        }
    }
    println!("{n_sound} of {n} sound and away from walls");
    assert!(3 * n_sound > n);
}
