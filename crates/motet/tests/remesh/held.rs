//! What remeshing holds: regions and patches by name, required cells and vertices, and facets that have a
//! twin.

use std::collections::BTreeSet;

use motet::base::{Point, Threads, VertexId};
use motet::geometry::tet::FACETS;
use motet::mesh::history::{Changed, Rules};
use motet::mesh::marks::{CORNER, REQUIRED};
use motet::mesh::shapes::box_grid;
use motet::mesh::{CellKind, Field, Mesh, Values};
use motet::remesh::{Goal, Held, Options, Report, Sizes, SurfaceRule, remesh_mesh};

const ADAPT: SurfaceRule = SurfaceRule::Adapt { distance: None };

fn remeshed(mesh: &Mesh, options: &Options) -> Changed<Report> {
    remesh_mesh(mesh, options, &Rules::default(), &Threads::single()).unwrap()
}

/// The corners of cells, to the bit, in any order.
fn places<'a>(mesh: &'a Mesh, is_one: impl Fn(usize) -> bool + 'a) -> BTreeSet<Vec<[u64; 3]>> {
    let all = mesh.cells.iter().filter(|(cell, ..)| is_one(cell.index()));
    let corner = |v: &VertexId| mesh.points[v.index()].map(f64::to_bits);
    all.map(|(_, _, vertices)| {
        let mut corners: Vec<[u64; 3]> = vertices.iter().map(corner).collect();
        corners.sort_unstable();
        corners
    })
    .collect()
}

fn labels(mesh: &Mesh, name: &str) -> Vec<i64> {
    mesh.cell_field(name).unwrap().values.to_i64().unwrap()
}

/// A box of two halves, `left` and `right`, with displaced inner vertices.
fn halves() -> Mesh {
    let mut mesh = box_grid([6, 3, 3], [[0.0; 3], [2.0, 1.0, 1.0]]);
    let centre = |mesh: &Mesh, vertices: &[VertexId]| {
        vertices.iter().map(|v| mesh.points[v.index()][0]).sum::<f64>() / 4.0
    };
    let regions: Vec<i32> = (mesh.cells.iter())
        .map(|(_, kind, v)| {
            if kind != CellKind::TETRA {
                0
            } else if centre(&mesh, v) < 1.0 {
                1
            } else {
                2
            }
        })
        .collect();
    mesh.set_cell_field(Field::scalars("region", regions));
    mesh.label_names.regions = [(1, "left".to_owned()), (2, "right".to_owned())].into();
    let inside = |p: &Point| p[1] > 0.1 && p[1] < 0.9 && p[2] > 0.1 && p[2] < 0.9 && p[0] > 0.1 && p[0] < 1.9;
    for (k, p) in mesh.points.iter_mut().enumerate().filter(|(_, p)| inside(p) && (p[0] - 1.0).abs() > 0.1) {
        p[0] += 0.16 * if k % 2 == 0 { 1.0 } else { -1.0 };
        p[2] += 0.13 * if k % 3 == 0 { 1.0 } else { -1.0 };
    }
    mesh
}

#[test]
fn a_region_and_a_patch_that_are_held_stay_to_the_bit() {
    let first = halves();
    let held = Held::of_names(&first, &["left".to_owned(), "xmax".to_owned()]).unwrap();
    assert!(Held::of_names(&first, &["nothing".to_owned()]).unwrap_err().to_string().contains("left"));
    let xmax = first.find_patch("xmax").unwrap();
    for (goal, sizes) in
        [(Goal::Repair, None), (Goal::Best, None), (Goal::Repair, Some(Sizes::Uniform(0.15)))]
    {
        let options =
            Options { held: held.clone(), goal, sizes, surface: ADAPT, min_eas: 0.3, ..Options::default() };
        let Changed { mesh, report, .. } = remeshed(&first, &options);
        assert!(report.held > 0 && report.after.tets != report.before.tets, "{report:?}");
        let left = |mesh: &Mesh| {
            let regions = labels(mesh, "region");
            places(mesh, |c| regions[c] == 1 && mesh.cells.kinds()[c] == CellKind::TETRA)
        };
        assert_eq!(left(&first), left(&mesh));
        let facets = |mesh: &Mesh| {
            let patches = labels(mesh, "patch");
            places(mesh, |c| patches[c] == i64::from(xmax) && mesh.cells.kinds()[c] == CellKind::TRIANGLE)
        };
        assert_eq!(facets(&first), facets(&mesh));
    }
}

#[test]
fn what_is_required_stays_and_is_marked_once() {
    let mut first = halves();
    let n = first.cells.len();
    let is_required = |c: &usize| c.is_multiple_of(7);
    first.set_cell_field(Field::scalars(
        REQUIRED,
        (0..n).map(|c| u8::from(is_required(&c))).collect::<Vec<_>>(),
    ));
    let n_points = first.points.len();
    first.set_point_field(Field::scalars(
        REQUIRED,
        (0..n_points).map(|v| u8::from(v % 11 == 0)).collect::<Vec<_>>(),
    ));
    first
        .set_point_field(Field::scalars(CORNER, (0..n_points).map(|v| u8::from(v == 5)).collect::<Vec<_>>()));
    let options = Options { sizes: Some(Sizes::Uniform(0.16)), surface: ADAPT, ..Options::default() };
    let Changed { mesh, report, .. } = remeshed(&first, &options);
    assert!(report.after.tets > 2 * report.before.tets);
    let required = |mesh: &Mesh| {
        let marks = labels(mesh, REQUIRED);
        places(mesh, |c| marks[c] != 0)
    };
    assert_eq!(required(&first), required(&mesh));
    assert_eq!(
        labels(&mesh, REQUIRED).iter().filter(|mark| **mark != 0).count(),
        (0..n).filter(is_required).count()
    );
    for array in [REQUIRED, CORNER] {
        let marked = |mesh: &Mesh| -> Vec<[u64; 3]> {
            let Values::U8(marks) = &mesh.point_field(array).unwrap().values else { panic!("bytes") };
            let mut all: Vec<_> = (0..marks.len())
                .filter(|&v| marks[v] != 0)
                .map(|v| mesh.points[v].map(f64::to_bits))
                .collect();
            all.sort_unstable();
            all
        };
        assert_eq!(marked(&first), marked(&mesh), "{array}");
    }
}

/// A box whose halves meet in a plane with duplicate points.
fn doubled() -> Mesh {
    let mut mesh = halves();
    let cells: Vec<_> = mesh.cells.iter().map(|(_, kind, v)| (kind, v.to_vec())).collect();
    let n = mesh.points.len();
    let mut twin = vec![None; n];
    for (v, twin) in twin.iter_mut().enumerate() {
        if (mesh.points[v][0] - 1.0).abs() < 1e-9 {
            *twin = Some(VertexId::new(mesh.points.len()));
            mesh.points.push(mesh.points[v]);
        }
    }
    let mut cells_now = motet::mesh::Cells::new();
    for (kind, vertices) in cells {
        let is_right = vertices.iter().any(|v| mesh.points[v.index()][0] > 1.0 + 1e-9);
        let now = vertices.iter().map(|v| if is_right { twin[v.index()].unwrap_or(*v) } else { *v });
        cells_now.push(kind, now.collect::<Vec<_>>());
    }
    let mut now = Mesh::new(mesh.points.clone(), cells_now);
    now.cell_data = mesh.cell_data.clone();
    now
}

#[test]
fn facets_that_lie_on_others_stay_so() {
    let first = doubled();
    // The facets of each half in the plane.
    let sides = |mesh: &Mesh| -> [BTreeSet<Vec<[u64; 3]>>; 2] {
        let mut sides = [BTreeSet::new(), BTreeSet::new()];
        for (_, tet) in mesh.cells.tets() {
            for facet in FACETS.map(|facet| facet.map(|i| mesh.points[tet[i].index()])) {
                if facet.iter().all(|p| (p[0] - 1.0).abs() < 1e-9) {
                    let is_right = tet.iter().any(|v| mesh.points[v.index()][0] > 1.0 + 1e-9);
                    let mut corners: Vec<[u64; 3]> = facet.iter().map(|p| p.map(f64::to_bits)).collect();
                    corners.sort_unstable();
                    sides[usize::from(is_right)].insert(corners);
                }
            }
        }
        sides
    };
    let options = Options { sizes: Some(Sizes::Uniform(0.2)), surface: ADAPT, ..Options::default() };
    let Changed { mesh, .. } = remeshed(&first, &options);
    let [left, right] = sides(&mesh);
    assert!(!left.is_empty());
    assert_eq!(left, right);
    assert_eq!(left, sides(&first)[0]);
}

#[test]
fn lines_that_are_required_stay_where_others_are_merged() {
    let n = 6;
    let mut first = box_grid([n; 3], [[0.0; 3], [1.0; 3]]);
    let vertex = |mesh: &Mesh, at: Point| {
        VertexId::new(mesh.points.iter().position(|p| (0..3).all(|k| (p[k] - at[k]).abs() < 1e-9)).unwrap())
    };
    // Lines along two edges of the box; those of the second are required.
    for z in [0.0, 1.0] {
        let place = |i: usize| [i as f64 / n as f64, 0.0, z];
        for i in 0..n {
            first.cells.push(CellKind::LINE, [place(i), place(i + 1)].map(|at| vertex(&first, at)));
        }
    }
    let n_cells = first.cells.len();
    for field in &mut first.cell_data {
        let n_rows = field.values.len();
        let mut rows = field.values.to_i64().unwrap();
        rows.extend(vec![1; n_cells - n_rows]);
        *field = Field::scalars(&field.name, rows.into_iter().map(|x| x as i32).collect::<Vec<_>>());
    }
    let marks: Vec<u8> = (0..n_cells).map(|c| u8::from(c >= n_cells - n)).collect();
    first.set_cell_field(Field::scalars(REQUIRED, marks));
    let options = Options { sizes: Some(Sizes::Uniform(0.5)), surface: ADAPT, ..Options::default() };
    let Changed { mesh, .. } = remeshed(&first, &options);
    let lines = |mesh: &Mesh, z: f64| {
        places(mesh, |c| {
            let (_, kind, vertices) = mesh.cells.iter().nth(c).unwrap();
            kind == CellKind::LINE && vertices.iter().all(|v| mesh.points[v.index()][2] == z)
        })
    };
    assert_eq!(lines(&first, 1.0), lines(&mesh, 1.0));
    assert!(lines(&mesh, 0.0).len() < n, "{} lines of {n}", lines(&mesh, 0.0).len());
}
