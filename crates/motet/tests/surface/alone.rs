//! Surfaces alone, open and closed: rims and patches stay, arrays are carried, volume meshes give their surface.

use motet::Mesh;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::triangle::{area, area_vector, centroid};
use motet::geometry::vector::{add, distance, dot, norm};
use motet::mesh::history::{Changed, Origin};
use motet::mesh::shapes::{Aneurysm, ball, box_grid};
use motet::mesh::{CellKind, Cells, Field, Surface, Values};
use motet::meshing::even::{Options, Report, SurfaceWords, even_surface};
use motet::meshing::{Adapting, Sizes};
use motet::preflight::open_rims;

use crate::common::random::Random;

fn even(mesh: &Mesh, options: &Options) -> Changed<Report> {
    even_surface(mesh, options, &Threads::single()).unwrap()
}

fn options(size: f64, distance: f64) -> Options {
    Options {
        sizes: Some(Sizes::Uniform(size)),
        adapting: Adapting { distance: Some(distance), ..Adapting::default() },
        ..Options::default()
    }
}

fn triangles(points: Vec<Point>, all: impl IntoIterator<Item = [usize; 3]>) -> Mesh {
    let mut cells = Cells::new();
    all.into_iter().for_each(|t| cells.push(CellKind::TRIANGLE, t.map(VertexId::new)));
    Mesh::new(points, cells)
}

/// A grid of `n` by `m` quads, each cut in two, bent by `bend`; rows closed to a tube if `is_closed`.
fn grid([n, m]: [usize; 2], is_closed: bool, bend: impl Fn(f64, f64) -> Point) -> Mesh {
    let n_across = if is_closed { n } else { n + 1 };
    let points = (0..=m).flat_map(|j| (0..n_across).map(move |i| (i, j)));
    let points = points.map(|(i, j)| bend(i as f64 / n as f64, j as f64 / m as f64)).collect();
    let id = |i: usize, j: usize| j * n_across + i % n_across;
    let quads = (0..m).flat_map(|j| (0..n).map(move |i| (i, j)));
    triangles(
        points,
        quads.flat_map(|(i, j)| {
            let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            [[a, b, c], [a, c, d]]
        }),
    )
}

/// A cylinder without ends, of radius 1 and length 4, with narrow triangles.
fn cylinder() -> Mesh {
    grid([64, 6], true, |u, v| {
        let angle = std::f64::consts::TAU * u;
        [angle.cos(), angle.sin(), 4.0 * v]
    })
}

/// A flat ring between radii 1 and 3 in a slanted plane, of narrow triangles.
fn ring() -> Mesh {
    grid([48, 2], true, |u, v| {
        let (angle, radius) = (std::f64::consts::TAU * u, 1.0 + 2.0 * v);
        let [x, y] = [radius * angle.cos(), radius * angle.sin()];
        [x, y, 0.5 * x - 0.25 * y]
    })
}

fn surface(mesh: &Mesh) -> Surface {
    Surface::of(mesh)
}

fn rims(mesh: &Mesh) -> Vec<Vec<VertexId>> {
    let surface = surface(mesh);
    let [closed, unclosed] = open_rims(&surface.points, &surface.triangles);
    assert!(unclosed.is_empty());
    closed
}

/// The length of the rims.
fn rim_length(mesh: &Mesh) -> f64 {
    let at = |v: VertexId| mesh.points[v.index()];
    let next = |rim: &[VertexId], k: usize| rim[(k + 1) % rim.len()];
    rims(mesh)
        .iter()
        .map(|rim| (0..rim.len()).map(|k| distance(at(rim[k]), at(next(rim, k)))).sum::<f64>())
        .sum()
}

fn surface_area(mesh: &Mesh) -> f64 {
    let surface = surface(mesh);
    (0..surface.triangles.len()).map(|t| area(surface.corners(t))).sum()
}

fn check(name: &str, made: &Changed<Report>, min_angle: f64) {
    let report = &made.report;
    assert_eq!(report.not_reached(), None, "{name}");
    assert!(report.to_given.max(report.from_given) <= report.allowed, "{name}: {report:?}");
    assert_eq!(report.after.crossings, 0, "{name}");
    assert!(report.after.angles.worst > min_angle, "{name}: {report:?}");
    assert_eq!(report.after.triangles, made.mesh.cells.len(), "{name}");
    assert_eq!(report.after.points, made.mesh.points.len(), "{name}");
    made.mesh.validate().unwrap();
}

#[test]
fn the_rims_of_an_open_cylinder_stay_where_they_are() {
    let given = cylinder();
    let made = even(&given, &options(0.3, 0.02));
    check("cylinder", &made, 25.0);
    assert!(made.report.before.angles.worst < 9.0, "{:?}", made.report.before);
    assert_eq!([made.report.before.rims, made.report.after.rims], [2, 2]);
    assert_eq!(made.report.after.volume, None);
    for v in rims(&made.mesh).into_iter().flatten() {
        let [x, y, z] = made.mesh.points[v.index()];
        assert!(z == 0.0 || z == 4.0, "a rim leaves its plane: {z}");
        assert!((x.hypot(y) - 1.0).abs() < 0.02, "{x} {y}");
    }
    // Convex polygons between circles of radius 0.98 and 1.
    let shrunk = rim_length(&made.mesh) / (2.0 * std::f64::consts::TAU);
    assert!((0.98..1.0).contains(&shrunk), "{shrunk}");
    let [least, median, largest] = made.report.after.edges;
    assert!(least > 0.05 && (0.2..0.4).contains(&median) && largest < 0.6, "{:?}", made.report.after.edges);
}

#[test]
fn rims_keep_their_length_however_often_they_are_made_even() {
    let mut mesh = cylinder();
    for round in 0..16 {
        mesh = even(&mesh, &options(if round % 2 == 0 { 0.3 } else { 0.36 }, 0.02)).mesh;
        for v in rims(&mesh).into_iter().flatten() {
            let z = mesh.points[v.index()][2];
            assert!(z == 0.0 || z == 4.0, "a rim leaves its plane: {z}");
        }
    }
    let [rims, area] =
        [rim_length(&mesh) / 2.0, surface_area(&mesh) / 4.0].map(|x| x / std::f64::consts::TAU - 1.0);
    assert!(rims.abs() < 0.004 && area.abs() < 0.004, "{rims} {area}");
}

#[test]
fn a_linear_field_on_a_plane_with_a_hole_stays_exact() {
    let mut given = ring();
    let linear = |p: &Point| 2.0 + 3.0 * p[0] - p[1] + 0.5 * p[2];
    let spun = |p: &Point| [p[1], -p[0], 4.0 + p[2]];
    given.set_point_field(Field::scalars("p", given.points.iter().map(linear).collect::<Vec<f64>>()));
    given.set_point_field(Field::vectors("u", &given.points.iter().map(spun).collect::<Vec<_>>()));
    given.set_point_field(Field::scalars(
        "side",
        given.points.iter().map(|p| i32::from(p[0] > 0.0)).collect::<Vec<i32>>(),
    ));
    let made = even(&given, &options(0.35, 0.01));
    check("ring", &made, 25.0);
    assert_eq!(made.report.after.rims, 2);
    let area = |mesh: &Mesh| {
        let of = surface(mesh);
        norm((0..of.triangles.len()).map(|t| area_vector(of.corners(t))).fold([0.0; 3], add))
    };
    // The rims are polygons that may be cut short by the distance.
    assert!((area(&made.mesh) - area(&given)).abs() < 0.01 * 4.0 * std::f64::consts::TAU);
    let p = made.mesh.point_field("p").unwrap().values.to_f64().unwrap();
    let u = made.mesh.point_field("u").unwrap().to_vectors().unwrap();
    let side = made.mesh.point_field("side").unwrap().values.to_f64().unwrap();
    for (k, at) in made.mesh.points.iter().enumerate() {
        assert!((at[2] - (0.5 * at[0] - 0.25 * at[1])).abs() < 1e-12, "planes stay planes");
        assert!((p[k] - linear(at)).abs() < 1e-9, "{} {}", p[k], linear(at));
        assert!(distance(u[k], spun(at)) < 1e-9);
        if at[0].abs() > 1.0 {
            assert_eq!(side[k], f64::from(at[0] > 0.0), "{at:?}");
        }
    }
    assert!(matches!(made.mesh.point_field("side").unwrap().values, Values::I32(_)));
}

#[test]
fn patches_arrays_and_names_of_an_open_vessel_stay() {
    let whole = Aneurysm::default().mesh().unwrap();
    let labels = whole.patches().unwrap();
    // Without its inlet, with the volume left out.
    let inlet = labels.used()[1];
    let mut given = Mesh { cells: Cells::new(), cell_data: Vec::new(), ..whole.clone() };
    let mut patch = Vec::new();
    for (cell, kind, vertices) in whole.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2)) {
        if labels.ids[cell.index()] != inlet {
            given.cells.push(kind, vertices.iter().copied());
            patch.push(labels.ids[cell.index()]);
        }
    }
    let ids: Vec<i32> = (0..patch.len() as i32).collect();
    given.set_cell_field(Field::scalars("patch", patch.clone()));
    given.set_cell_field(Field::scalars("id", ids.clone()));
    given.set_cell_field(Field::scalars(
        "half",
        ids.iter().map(|id| 0.5 * f64::from(*id)).collect::<Vec<f64>>(),
    ));
    let made = even(&given, &options(0.25, 0.01));
    check("vessel", &made, 25.0);
    assert_eq!(made.mesh.label_names, given.label_names);
    let [old, new] = [&given, &made.mesh].map(surface);
    let of_new = made.mesh.patches().unwrap();
    for &patch in of_new.used().iter() {
        let area_of = |surface: &Surface| -> f64 {
            let own = (0..surface.triangles.len()).filter(|&t| surface.patches[t] == patch);
            own.map(|t| norm(area_vector(surface.corners(t)))).sum()
        };
        assert!((area_of(&old) - area_of(&new)).abs() < 0.03 * area_of(&old), "{patch}");
    }
    // The arrays of a triangle are those of one given triangle of its patch.
    let id = made.mesh.cell_field("id").unwrap().values.to_i64().unwrap();
    let half = made.mesh.cell_field("half").unwrap().values.to_f64().unwrap();
    let own = made.mesh.cell_field("patch").unwrap().values.to_i64().unwrap();
    for t in 0..id.len() {
        let from = id[t] as usize;
        assert_eq!(i64::from(patch[from]), own[t]);
        assert_eq!(half[t], 0.5 * from as f64);
        assert!(distance(centroid(new.corners(t)), centroid(old.corners(from))) < 1.0);
    }
}

#[test]
fn a_point_that_stays_is_kept_and_a_history_carries_later_arrays() {
    let given = Surface::boundary_of(&ball(6, 2));
    let mesh = triangles(given.points.clone(), given.triangles.iter().map(|t| t.map(VertexId::index)));
    let made = even(&mesh, &options(0.4, 0.02));
    let origins = &made.history.vertices;
    assert_eq!([origins.n_old(), origins.len()], [mesh.points.len(), made.mesh.points.len()]);
    let mut n_kept = 0;
    for (new, origin) in made.mesh.points.iter().zip(origins.iter()) {
        match origin {
            Origin::Kept(v) => {
                n_kept += 1;
                assert_eq!(mesh.points[v.index()], *new);
            }
            Origin::Changed(row) => {
                assert!((row.shares.iter().sum::<f64>() - 1.0).abs() < 1e-12 && row.from.len() <= 3);
                let place =
                    row.from.iter().zip(row.shares).fold([0.0; 3], |sum, (v, share)| {
                        add(sum, mesh.points[v.index()].map(|x| x * share))
                    });
                assert!(distance(place, *new) <= 0.02);
            }
        }
    }
    assert!(n_kept < made.mesh.points.len());
    let radii = mesh.points.iter().map(|p| norm(*p)).collect::<Vec<f64>>();
    let carried = made.history.transfer_points(&Field::scalars("r", radii)).unwrap();
    assert!(carried.values.to_f64().unwrap().iter().all(|r| (r - 1.0).abs() < 1e-12));
}

#[test]
fn double_points_and_flat_triangles_of_a_soup_are_no_rims() {
    let whole = surface(&cylinder());
    let mut points: Vec<Point> =
        whole.triangles.as_flattened().iter().map(|v| whole.points[v.index()]).collect();
    let n = points.len();
    points.extend([points[0], points[0], points[1]]);
    let soup =
        triangles(points, (0..n / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).chain([[n, n + 1, n + 2]]));
    let made = even(&soup, &options(0.3, 0.02));
    check("soup", &made, 25.0);
    assert_eq!(made.report.after.rims, 2);
    assert!(!made.report.repairs.is_empty());
}

#[test]
fn repair_turns_triangles_and_closes_holes_only_on_request() {
    let mut given = surface(&cylinder());
    given.triangles[40].swap(0, 1);
    given.triangles.remove(200);
    let mesh = triangles(given.points.clone(), given.triangles.iter().map(|t| t.map(VertexId::index)));
    let made = |words: SurfaceWords| {
        let words = SurfaceWords { distance: Some(0.02), ..words };
        even(&mesh, &words.options(&mesh).unwrap()).report
    };
    let repairing = || SurfaceWords { repair: true, ..SurfaceWords::default() };
    assert_eq!(made(repairing()).after.rims, 3);
    assert_eq!(made(SurfaceWords { hole_edges: 8, ..repairing() }).after.rims, 2);
    let as_is = made(SurfaceWords::default());
    assert!(as_is.repairs.is_empty() && as_is.after.open_edges > made(repairing()).after.open_edges);
}

#[test]
fn volume_meshes_give_their_boundary_and_quads_are_divided() {
    let mut solid = box_grid([2, 2, 2], [[0.0; 3], [1.0, 2.0, 3.0]]);
    let kept: Vec<_> = solid
        .cells
        .iter()
        .filter(|(_, kind, _)| kind.dim() == Some(3))
        .map(|(c, k, v)| (c, k, v.to_vec()))
        .collect();
    let mut cells = Cells::new();
    kept.iter().for_each(|(_, kind, vertices)| cells.push(*kind, vertices.iter().copied()));
    solid.cells = cells;
    solid.cell_data.clear();
    let made = even(&solid, &options(0.3, 0.01));
    check("box", &made, 25.0);
    assert!(made.report.is_boundary && made.report.left_out == 0);
    assert!((made.report.after.volume.unwrap() - 6.0).abs() < 1e-12);
    assert!((made.report.after.area - 22.0).abs() < 1e-12);
    let mut quads = Cells::new();
    let points: Vec<Point> =
        vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0]];
    for quad in [[0, 1, 2, 3], [1, 4, 5, 2]] {
        quads.push(CellKind::QUAD, quad.map(VertexId::new));
    }
    quads.push(CellKind::LINE, [0, 1].map(VertexId::new));
    let mut quads = Mesh::new(points, quads);
    quads.set_cell_field(Field::scalars("patch", vec![1, 2, 0]));
    let made = even(&quads, &options(0.25, 0.01));
    check("quads", &made, 25.0);
    assert_eq!((made.report.left_out, made.report.is_boundary), (1, false));
    let of = surface(&made.mesh);
    for t in 0..of.triangles.len() {
        assert_eq!(of.patches[t], if centroid(of.corners(t))[0] < 1.0 { 1 } else { 2 });
    }
    assert!((made.report.after.area - 2.0).abs() < 1e-12);
}

#[test]
fn sizes_come_from_arrays_and_are_followed() {
    let mut given = cylinder();
    let sizes = given.points.iter().map(|p| 0.1 + 0.1 * p[2]).collect::<Vec<f64>>();
    given.set_point_field(Field::scalars("h", sizes));
    let words =
        SurfaceWords { size_array: Some("h".into()), distance: Some(0.05), ..SurfaceWords::default() };
    let made = even(&given, &words.options(&given).unwrap());
    check("sizes", &made, 20.0);
    let of = surface(&made.mesh);
    let mean = |low: f64, high: f64| {
        let own =
            (0..of.triangles.len()).map(|t| of.corners(t)).filter(|t| (low..high).contains(&centroid(*t)[2]));
        let lengths: Vec<f64> =
            own.flat_map(|[a, b, c]| [distance(a, b), distance(b, c), distance(c, a)]).collect();
        lengths.iter().sum::<f64>() / lengths.len() as f64
    };
    assert!(
        (0.08..0.2).contains(&mean(0.0, 0.5)) && (0.3..0.6).contains(&mean(3.5, 4.0)),
        "{} {}",
        mean(0.0, 0.5),
        mean(3.5, 4.0)
    );
}

#[test]
fn smoothing_takes_noise_away_and_keeps_volume_and_rims() {
    let mut random = Random(5);
    let mut sphere = Surface::boundary_of(&ball(12, 2));
    for p in &mut sphere.points {
        let noisy = 1.0 + 0.02 * (random.next() - 0.5);
        *p = p.map(|x| x * noisy);
    }
    let mesh = triangles(sphere.points.clone(), sphere.triangles.iter().map(|t| t.map(VertexId::index)));
    let roughness = |mesh: &Mesh| {
        let of = surface(mesh);
        let radii: Vec<f64> = of.vertices().iter().map(|v| norm(of.points[v.index()])).collect();
        let mean = radii.iter().sum::<f64>() / radii.len() as f64;
        (radii.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / radii.len() as f64).sqrt()
    };
    let smooth = Options { smooth: 10, ..options(0.15, 0.002) };
    let made = even(&mesh, &smooth);
    check("sphere", &made, 20.0);
    let smoothed = made.report.smoothed.unwrap();
    assert!(smoothed.passes == 10 && smoothed.to_given < 0.02 && smoothed.to_given > 0.002);
    assert!(roughness(&made.mesh) < 0.5 * roughness(&mesh), "{} {}", roughness(&mesh), roughness(&made.mesh));
    let [before, after] = [made.report.before, made.report.after].map(|of| of.volume.unwrap());
    assert!((after - before).abs() < 0.01 * before, "{before} {after}");
    let tube = even(&cylinder(), &Options { smooth: 10, ..options(0.3, 0.02) });
    check("tube", &tube, 25.0);
    for v in rims(&tube.mesh).into_iter().flatten() {
        assert!([0.0, 4.0].contains(&tube.mesh.points[v.index()][2]));
    }
}

#[test]
fn what_has_no_surface_or_no_numbers_is_refused() {
    let refused = |mesh: &Mesh, options: &Options| {
        even_surface(mesh, options, &Threads::single()).unwrap_err().to_string()
    };
    let empty = Mesh::new(vec![[0.0; 3]], Cells::new());
    assert!(refused(&empty, &Options::default()).contains("no surface"));
    let mut broken = cylinder();
    broken.points[3][1] = f64::NAN;
    assert!(refused(&broken, &Options::default()).contains("not finite"));
    let flat = triangles(vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]], [[0, 1, 2]]);
    assert!(refused(&flat, &Options::default()).contains("has an area"));
    let wrong = Options { sizes: Some(Sizes::Uniform(-1.0)), ..Options::default() };
    assert!(refused(&cylinder(), &wrong).contains("size"));
    let few = Options { sizes: Sizes::of(None, false, None, Some(vec![0.1; 3])), ..Options::default() };
    assert!(refused(&cylinder(), &few).contains("3 sizes"));
    let far =
        Options { adapting: Adapting { distance: Some(-1.0), ..Adapting::default() }, ..Options::default() };
    assert!(refused(&cylinder(), &far).contains("distance"));
}

#[test]
fn neither_threads_nor_the_order_of_normals_matter() {
    let given = cylinder();
    let options = options(0.3, 0.02);
    let [one, three] = [1, 3].map(|n| even_surface(&given, &options, &Threads::exactly(n).unwrap()).unwrap());
    assert_eq!(one, three);
    // Turned inside out, the surface is as near.
    let mut turned = surface(&given);
    turned.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    let mesh = triangles(turned.points.clone(), turned.triangles.iter().map(|t| t.map(VertexId::index)));
    let made = even(&mesh, &options);
    check("turned", &made, 25.0);
    let of = surface(&made.mesh);
    let outward = (0..of.triangles.len()).filter(|&t| {
        let [x, y, _] = centroid(of.corners(t));
        dot(area_vector(of.corners(t)), [x, y, 0.0]) > 0.0
    });
    assert_eq!(outward.count(), 0);
}

/// Two surfaces as one mesh.
fn together(a: Surface, b: Surface) -> Mesh {
    let n = a.points.len();
    let moved = b.triangles.iter().map(|t| t.map(|v| v.index() + n));
    let all = a.triangles.iter().map(|t| t.map(VertexId::index)).chain(moved);
    triangles([a.points, b.points].concat(), all.collect::<Vec<_>>())
}

/// Two planes of needles that cross each other. Triangles at the crossing are changed like others, although they
/// cross the other plane as those before them did.
#[test]
fn sheets_that_cross_get_even_triangles_too() {
    let sheet = |upright: bool| {
        grid([24, 8], false, move |u, v| match upright {
            false => [4.0 * u, 4.0 * v, 0.0],
            true => [4.0 * u, 1.9, 4.0 * v - 2.0],
        })
    };
    let [flat, upright] = [false, true].map(|upright| surface(&sheet(upright)));
    let both = together(flat, upright);
    let made = even(&both, &options(0.2, 0.01));
    let report = &made.report;
    assert_eq!(report.not_reached(), None);
    assert!(report.before.crossings > 0 && report.after.crossings > 0);
    assert!((report.after.area - 32.0).abs() < 1e-9, "{report:?}");
    assert!(report.after.angles.worst > 25.0 && report.after.angles.median > 45.0, "{report:?}");
    assert!(report.after.triangles < 2500, "{report:?}");
}

/// Two wavy sheets of needles that are nearer to each other than each may stray: neither comes through the other.
#[test]
fn sheets_nearer_than_the_distance_do_not_cross() {
    let wave = |x: f64, y: f64| 0.2 * (2.0 * x).sin() * (1.5 * y).cos();
    let sheet = |up: f64| {
        grid([40, 10], false, move |u, v| {
            let (x, y) = (4.0 * u + 0.1 * up, 4.0 * v + 7.0 * up);
            [x, y, wave(x, y) + up]
        })
    };
    let [below, above] = [0.0, 0.01].map(|up| surface(&sheet(up)));
    let both = together(below, above);
    let made = even(&both, &options(0.2, 0.05));
    let report = &made.report;
    assert_eq!(report.not_reached(), None);
    assert_eq!((report.before.crossings, report.after.crossings), (0, 0), "{report:?}");
    assert!(report.after.triangles != report.before.triangles);
}
