//! Fields on a mesh that is moved and repaired again and again, and what they must preserve.
//!
//! | field | on | while the mesh moves | in a repair |
//! |---|---|---|---|
//! | density, momentum | cells | the content of each tet stays: value times volume | integrals over regions stay |
//! | constant | cells | stays | stays, to the bit |
//! | id | cells | stays | is that of an old cell of the same region |
//! | linear | points | set anew, linear in space | stays linear |

use std::collections::BTreeMap;

use motet::base::{CellId, Point, Threads};
use motet::geometry::overlap::Solid;
use motet::mesh::history::{Changed, Rules};
use motet::mesh::{CellKind, Cells, Field, Mesh, TetMesh, TetPart, Values};
use motet::remesh::{Options, Report, SurfaceRule, remesh_mesh};

use super::cube::Distortion;
use super::membrane::{self, Bending};
use super::scatter::Numbers;
use super::{adapt, keep};

const CONSTANT: f64 = 0.1;
/// Density, and the three components of momentum.
const N: usize = 4;

/// A mesh with fields, and statistics of their changes so far.
pub struct Loaded {
    pub mesh: Mesh,
    pub tally: Tally,
    first: BTreeMap<i32, Amounts>,
    /// The initial region of each id.
    id_regions: Vec<i32>,
}

/// The contents of a region.
#[derive(Clone, Copy, Debug, Default)]
struct Amounts {
    /// The integral of each component.
    sum: [f64; N],
    /// The integral of its absolute value.
    size: [f64; N],
    /// The largest absolute value.
    largest: [f64; N],
}

/// The worst values over all regions and components. Amounts are relative to the initial integral of the
/// absolute value.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// The current deviation of integrals from their initial values.
    pub drift: f64,
    pub kept: Repairs,
    pub adapted: Repairs,
    /// Steps after which a tet was inverted.
    pub n_inverted: usize,
    /// The largest error of the linear field, relative to its range, in steps where no vertex was outside the
    /// old tets.
    pub linear: f64,
    /// The largest error of the linear field in steps where a vertex was outside, minus what its distance
    /// explains.
    pub linear_outside: f64,
    /// The deviation of the constant field.
    pub off_constant: f64,
    /// The number of new tets in all repairs.
    pub n_new_tets: usize,
}

/// Statistics of the repairs with the surface kept, or with an adapting one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Repairs {
    pub n: usize,
    /// Bad tets that were left, summed over the repairs.
    pub n_left: usize,
    /// Changes of integrals in single repairs: the sum of absolute values.
    pub drift: f64,
    /// The changes that the ledger allows: the sum.
    pub allowed: f64,
    /// The largest excess of one repair over what the ledger allows.
    pub beyond: f64,
    /// The volume that the ledger counts as deviation: the sum, relative to the initial volume.
    pub deviation: f64,
    /// Vertices outside of the old tets, and how far the farthest was.
    pub n_outside: usize,
    pub farthest_outside: f64,
}

fn linear(p: Point) -> f64 {
    3.0 - 2.0 * p[0] + 0.5 * p[1] + 7.0 * p[2]
}

/// The slope of the linear field.
const SLOPE: f64 = 7.5;

/// Tets and triangles as a mesh that files can hold.
pub fn whole(tets: &TetMesh) -> Mesh {
    let mut cells = Cells::new();
    tets.tets.iter().for_each(|t| cells.push(CellKind::TETRA, *t));
    tets.triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
    let nothing = |n: usize| std::iter::repeat_n(0, n);
    let regions = tets.regions.iter().copied().chain(nothing(tets.triangles.len()));
    let patches = nothing(tets.tets.len()).chain(tets.patches.iter().copied());
    let [regions, patches] = [regions.collect::<Vec<i32>>(), patches.collect()];
    let mut mesh = Mesh::new(tets.points.clone(), cells);
    mesh.set_cell_field(Field::scalars("region", regions));
    mesh.set_cell_field(Field::scalars("patch", patches));
    mesh
}

impl Loaded {
    pub fn new(tets: &TetMesh, seed: u64) -> Self {
        let mut numbers = Numbers(seed);
        let mut mesh = whole(tets);
        let n = mesh.cells.len();
        let id_regions = mesh.regions().expect("it has regions").ids;
        // Very different in the two regions, so that no exchange goes unnoticed.
        let density = id_regions.iter().map(|&r| numbers.between(0.5, 1.5) * if r == 1 { 1.0 } else { 1e3 });
        mesh.set_cell_field(Field::scalars("density", density.collect::<Vec<f64>>()));
        let momentum: Vec<Point> = (0..n).map(|_| [(); 3].map(|()| numbers.between(-1.0, 1.0))).collect();
        mesh.set_cell_field(Field::vectors("momentum", &momentum));
        mesh.set_cell_field(Field::scalars("constant", vec![CONSTANT; n]));
        mesh.set_cell_field(Field::scalars("id", (0..n as u32).collect::<Vec<_>>()));
        let first = amounts(&mesh);
        Self { mesh, tally: Tally::default(), first, id_regions }
    }

    /// The tets alone.
    pub fn tets(&self) -> TetMesh {
        TetPart::of(&self.mesh).expect("it has tets").mesh
    }

    /// Moves the points. The content of each tet is preserved; the linear field is set anew.
    pub fn move_to(&mut self, points: Vec<Point>) {
        let old = solids(&self.mesh);
        self.mesh.points = points;
        let new = solids(&self.mesh);
        let tets: Vec<CellId> = self.mesh.cells.tets().map(|(cell, _)| cell).collect();
        for field in &mut self.mesh.cell_data {
            let (Values::F64(values), "density" | "momentum") = (&mut field.values, field.name.as_str())
            else {
                continue;
            };
            for (cell, (old, new)) in tets.iter().zip(old.iter().zip(&new)) {
                let row = &mut values[cell.index() * field.components..][..field.components];
                row.iter_mut().for_each(|value| *value *= old.volume() / new.volume());
            }
        }
        let values: Vec<f64> = self.mesh.points.iter().map(|&p| linear(p)).collect();
        self.mesh.set_point_field(Field::scalars("linear", values));
        self.tally.n_inverted += usize::from(!new.iter().all(Solid::is_positive));
    }

    /// Repairs, and records the effect on fields. Returns the number of bad tets that are left.
    pub fn repair(&mut self, options: &Options) -> usize {
        let before = amounts(&self.mesh);
        let outcome = remesh_mesh(&self.mesh, options, &Rules::default(), &Threads::single()).unwrap();
        let after = amounts(&outcome.mesh);
        let n_left = outcome.report.after.bad;
        let repairs = match options.surface {
            SurfaceRule::Keep => &mut self.tally.kept,
            _ => &mut self.tally.adapted,
        };
        repairs.add(&outcome, [&before, &after], &self.first);
        let drifts = self.first.iter().flat_map(|(region, first)| {
            (0..N).map(|k| (after[region].sum[k] - first.sum[k]).abs() / first.size[k])
        });
        self.tally.drift = drifts.fold(0.0, f64::max);
        self.see_linear(&outcome);
        self.mesh = outcome.mesh;
        self.see_cells();
        self.tally.n_new_tets += outcome.history.cells.changed().len();
        n_left
    }

    fn see_linear(&mut self, outcome: &Changed<Report>) {
        let values =
            outcome.mesh.point_field("linear").and_then(|f| f.values.to_f64()).expect("it was carried");
        let exact: Vec<f64> = outcome.mesh.points.iter().map(|&p| linear(p)).collect();
        let largest = |x: &mut dyn Iterator<Item = f64>| x.fold(f64::NEG_INFINITY, f64::max);
        let range = largest(&mut exact.iter().copied()) + largest(&mut exact.iter().map(|x| -x));
        let error = largest(&mut values.iter().zip(&exact).map(|(x, y)| (x - y).abs()));
        let ledger = &outcome.history.ledger;
        let worst = match ledger.n_outside {
            0 => &mut self.tally.linear,
            _ => &mut self.tally.linear_outside,
        };
        *worst = worst.max((error - SLOPE * ledger.farthest_outside) / range);
    }

    fn see_cells(&mut self) {
        let array =
            |name: &str| self.mesh.cell_field(name).and_then(|f| f.values.to_f64()).expect("it was carried");
        let off = array("constant").iter().map(|x| (x - CONSTANT).abs()).fold(0.0, f64::max);
        self.tally.off_constant = self.tally.off_constant.max(off);
        let regions = self.mesh.regions().expect("it has regions").ids;
        let ids = array("id");
        for (cell, _) in self.mesh.cells.tets() {
            assert_eq!(self.id_regions[ids[cell.index()] as usize], regions[cell.index()], "{cell}");
        }
    }
}

impl Repairs {
    fn add(
        &mut self,
        outcome: &Changed<Report>,
        [before, after]: [&BTreeMap<i32, Amounts>; 2],
        first: &BTreeMap<i32, Amounts>,
    ) {
        let ledger = &outcome.history.ledger;
        let (mut drift, mut allowed, mut beyond) = (0.0f64, 0.0f64, 0.0f64);
        for (region, first) in first {
            let deviation = ledger.region(*region).map_or(0.0, |entry| entry.deviation);
            for k in 0..N {
                let went = (after[region].sum[k] - before[region].sum[k]).abs() / first.size[k];
                let may = before[region].largest[k] * deviation / first.size[k];
                drift = drift.max(went);
                allowed = allowed.max(may);
                beyond = beyond.max(went - may);
            }
            self.deviation += deviation;
        }
        self.n += 1;
        self.n_left += outcome.report.after.bad;
        self.drift += drift;
        self.allowed += allowed;
        self.beyond = self.beyond.max(beyond);
        self.n_outside += ledger.n_outside;
        self.farthest_outside = self.farthest_outside.max(ledger.farthest_outside);
    }
}

fn solids(mesh: &Mesh) -> Vec<Solid> {
    mesh.cells.tets().map(|(_, tet)| Solid::new(tet.map(|v| mesh.points[v.index()]))).collect()
}

/// The contents of each region, with accurate volumes.
fn amounts(mesh: &Mesh) -> BTreeMap<i32, Amounts> {
    let array = |name| mesh.cell_field(name).and_then(|f| f.values.to_f64()).expect("it was carried");
    let (density, momentum) = (array("density"), array("momentum"));
    let regions = mesh.regions().expect("it has regions").ids;
    let mut amounts: BTreeMap<i32, Amounts> = BTreeMap::new();
    for ((cell, _), solid) in mesh.cells.tets().zip(solids(mesh)) {
        let i = cell.index();
        let values = [density[i], momentum[3 * i], momentum[3 * i + 1], momentum[3 * i + 2]];
        let entry = amounts.entry(regions[i]).or_default();
        for (k, value) in values.into_iter().enumerate() {
            entry.sum[k] += value * solid.volume();
            entry.size[k] += value.abs() * solid.volume();
            entry.largest[k] = entry.largest[k].max(value.abs());
        }
    }
    amounts
}

/// Bends the membrane and restores it, repaired with the surface kept; where that leaves bad tets, `then`
/// repairs them.
pub fn bend(
    loaded: &mut Loaded,
    bending: &Bending,
    then: Option<&Options>,
    n_cycles: usize,
    mut see: impl FnMut(usize, &Loaded),
) {
    for cycle in 1..=n_cycles {
        for step in 0..bending.n_steps {
            loaded.move_to(membrane::moved(&loaded.tets(), bending, step).points);
            let n_left = loaded.repair(&keep());
            if let Some(then) = then.filter(|_| n_left > 0) {
                loaded.repair(then);
            }
        }
        see(cycle, loaded);
    }
}

/// Distorts the cube and restores it, repaired with a surface that adapts.
pub fn distort(
    loaded: &mut Loaded,
    distortion: &Distortion,
    n_steps: usize,
    n_cycles: usize,
    mut see: impl FnMut(usize, &Loaded),
) {
    for cycle in 1..=n_cycles {
        for step in 1..=2 * n_steps {
            let [old, part] =
                [step - 1, step].map(|s| (n_steps - s.abs_diff(n_steps)) as f64 / n_steps as f64);
            let moved = loaded.mesh.points.iter().map(|&p| distortion.map(distortion.back(p, old), part));
            loaded.move_to(moved.collect());
            loaded.repair(&adapt());
        }
        see(cycle, loaded);
    }
}
