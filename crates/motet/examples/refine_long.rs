//! Long refinement of a mesh, towards a target or along a moving front, with each step checked against the
//! guarantees of refinement.
//!
//! `refine_long MESH|random:N|box:N|ball:N --towards point|line|surface|scattered [--generations N] [--start
//! N] [--at X,Y,Z]` divides, in each of eight generations, the tets whose centre lies in a ball, or in a long
//! or a flat ellipsoid, about a place, by default the centre of the tet nearest to the middle of the mesh.
//! The region holds N tets at first (default 1000) and shrinks, so that 1.7 times as many are divided each
//! time. With `scattered`, three in a hundred tets of the first mesh are divided, a quarter of them (with all
//! their parts) in the next generation, and so on.
//!
//! `refine_long MESH --front plane|sphere [--generations G] [--steps N] [--at X,Y,Z]` moves a front through
//! the mesh: along x, or outward from a place. Tets that it touches within G steps are divided, up to
//! generation G (default 3); divisions of those that it left two steps behind are taken back. In the end
//! everything is taken back, and the first mesh must be recovered bit for bit.
//!
//! Both: `[--threads N] [--keep K] [--share S] [--most N] [--no-price]`; the run ends early beyond N tets
//! (default six million). Prints a row per step, relative to the first mesh's worst where a name says so;
//! rows below `without` use the same marks without preserving shapes. The exit status is 1 when a guarantee
//! is broken.

#[path = "../tests/common/mod.rs"]
mod common;

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use common::invariants::{First, corners};
use common::{Numbers, random_mesh};
use motet::base::{Point, TetId, Threads};
use motet::geometry::tet::centroid;
use motet::geometry::vector::{distance, sub};
use motet::io;
use motet::mesh::shapes::{ball, box_grid};
use motet::mesh::{TetMesh, TetPart, bounds};
use motet::refine::{Options, Refinement, Summary};

type Any<T> = Result<T, Box<dyn Error>>;

struct Call {
    mesh: String,
    towards: Option<Towards>,
    front: Option<Front>,
    generations: Option<u8>,
    steps: usize,
    start: usize,
    at: Option<Point>,
    threads: usize,
    options: Options,
    most: usize,
    is_priced: bool,
}

enum Towards {
    Shape(Shrinking),
    /// Three in a hundred tets of the first mesh, a quarter of them the next time, and so on.
    Scattered,
}

/// An ellipsoid that shrinks: the ratios of its initial half axes, and the factor by which each shrinks per
/// generation. Division makes eight tets of each, which together with these factors gives 1.7 times as many
/// per generation.
#[derive(Clone, Copy)]
struct Shrinking {
    axes: Point,
    factors: Point,
}

#[derive(Clone, Copy)]
enum Front {
    Plane,
    Sphere,
}

impl Towards {
    fn named(name: &str) -> Any<Self> {
        let (axes, factors) = match name {
            "point" => ([1.0; 3], [0.6; 3]),
            "line" => ([1.0, 1.0, 4.0], [0.5, 0.5, 0.864]),
            "surface" => ([4.0, 4.0, 1.0], [0.657, 0.657, 0.5]),
            "scattered" => return Ok(Self::Scattered),
            _ => {
                return Err(format!("--towards must be point, line, surface or scattered; got {name}").into());
            }
        };
        Ok(Self::Shape(Shrinking { axes, factors }))
    }
}

impl Shrinking {
    /// The normalised distance of a place from the centre, in the ellipsoids of a generation.
    fn out(&self, from: Point, place: Point, generation: i32) -> f64 {
        let away = sub(place, from);
        distance([0, 1, 2].map(|k| away[k] / (self.axes[k] * self.factors[k].powi(generation))), [0.0; 3])
    }
}

fn call() -> Any<Call> {
    let mut call = Call {
        mesh: String::new(),
        towards: None,
        front: None,
        generations: None,
        steps: 50,
        start: 1000,
        at: None,
        threads: 1,
        options: Options::default(),
        most: 6_000_000,
        is_priced: true,
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--towards" => call.towards = Some(Towards::named(&value()?)?),
            "--front" => {
                call.front = Some(match value()?.as_str() {
                    "plane" => Front::Plane,
                    "sphere" => Front::Sphere,
                    other => return Err(format!("--front must be plane or sphere; got {other}").into()),
                });
            }
            "--generations" => call.generations = Some(value()?.parse()?),
            "--steps" => call.steps = value()?.parse()?,
            "--start" => call.start = value()?.parse()?,
            "--threads" => call.threads = value()?.parse()?,
            "--keep" => call.options.keep = value()?.parse()?,
            "--share" => call.options.share = value()?.parse()?,
            "--most" => call.most = value()?.parse()?,
            "--no-price" => call.is_priced = false,
            "--at" => {
                let all = value()?.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>()?;
                call.at = Some(all.try_into().map_err(|_| "a place has three numbers")?);
            }
            _ => call.mesh = word,
        }
    }
    Ok(call)
}

fn mesh(name: &str) -> Any<TetMesh> {
    let built = |n: &str| n.parse::<usize>();
    Ok(match name.split_once(':') {
        Some(("random", n)) => random_mesh(built(n)?, 1),
        Some(("box", n)) => TetPart::of(&box_grid([built(n)?; 3], [[-1.0; 3], [1.0; 3]]))?.mesh,
        Some(("ball", n)) => TetPart::of(&ball(built(n)?, built(n)?))?.mesh,
        _ => TetPart::of(&io::read(name)?)?.mesh,
    })
}

fn centre(mesh: &TetMesh, tet: TetId) -> Point {
    centroid(corners(mesh, mesh.tets[tet.index()]))
}

fn tets_where(mesh: &TetMesh, is_marked: impl Fn(TetId) -> bool) -> Vec<TetId> {
    (0..mesh.tets.len()).map(TetId::new).filter(|t| is_marked(*t)).collect()
}

/// The centre of the tet nearest to the middle of the mesh.
fn middle(mesh: &TetMesh) -> Point {
    let [low, high] = bounds(&mesh.points).unwrap_or_default();
    let middle = [0, 1, 2].map(|k| 0.5 * (low[k] + high[k]));
    let centres = (0..mesh.tets.len()).map(|t| centre(mesh, TetId::new(t)));
    centres.min_by(|p, q| distance(*p, middle).total_cmp(&distance(*q, middle))).unwrap_or(middle)
}

/// The state of a run, and whether all guarantees have held so far.
struct Run {
    first: First,
    threads: Threads,
    refinement: Refinement,
    /// Refinement by the same marks without preserving shapes.
    without: Option<Refinement>,
    holds: bool,
}

/// Makes one step of refinement by marks computed from the mesh; returns their number, a summary and the
/// seconds.
fn advance(
    refinement: &mut Refinement,
    threads: &Threads,
    step: &dyn Fn(&mut Refinement, &Threads) -> Any<usize>,
) -> Any<(usize, Summary, f64)> {
    let begin = Instant::now();
    let n = step(refinement, threads)?;
    Ok((n, refinement.summary(), begin.elapsed().as_secs_f64()))
}

impl Run {
    fn new(call: &Call) -> Any<Self> {
        let threads = Threads::new(call.threads)?;
        let first = First::new(mesh(&call.mesh)?, &threads);
        let refinement = Refinement::new(&first.mesh, call.options, &threads)?;
        let free = Options { keep: 0.0, share: 0.0, ..Options::default() };
        let without = call.is_priced.then(|| Refinement::new(&first.mesh, free, &threads)).transpose()?;
        let quality = first.quality;
        println!(
            "{}: {} tets, worst EAS {:.4}, median {:.3}, worst mean ratio {:.4}\n",
            call.mesh.rsplit('/').next().unwrap_or_default(),
            first.mesh.tets.len(),
            quality.worst,
            quality.median,
            quality.worst_ratio
        );
        println!(
            "| step | marked | tets | worst / first | median | worst mean ratio / first | below 0.9 | in roots | promoted | cut | sweeps | seconds | \
             MB | without: tets | worst / first |"
        );
        println!("|{}", "---|".repeat(15));
        Ok(Self { first, threads, refinement, without, holds: true })
    }

    fn step(&mut self, name: usize, step: &dyn Fn(&mut Refinement, &Threads) -> Any<usize>) -> Any<usize> {
        let (n, summary, seconds) = advance(&mut self.refinement, &self.threads, step)?;
        let kept = self.first.compare(&self.refinement, &self.threads);
        let first = self.first.quality;
        let (now, memory) = (kept.quality, self.refinement.memory() / 1_000_000);
        print!(
            "| {name} | {n} | {} | {:.3} | {:.3} | {:.3} | {} | {} | {} | {} | {} | {seconds:.2} | {memory} |",
            summary.n_tets,
            now.worst / first.worst,
            now.median,
            now.worst_ratio / first.worst_ratio,
            now.n_below,
            kept.roots.len(),
            summary.n_promoted,
            summary.n_cut,
            summary.n_sweeps
        );
        if let Some(without) = &mut self.without {
            let (_, summary, _) = advance(without, &self.threads, step)?;
            let worst = self.first.compare(without, &self.threads).quality.worst;
            print!(" {} | {:.3} |", summary.n_tets, worst / first.worst);
        }
        println!();
        kept.broken.iter().for_each(|what| println!("BROKEN: {what}"));
        self.holds &= kept.broken.is_empty();
        Ok(summary.n_tets)
    }

    /// Divides the marked tets, generation by generation.
    fn divide(&mut self, call: &Call, marked: impl Fn(&Refinement, i32) -> Vec<TetId>) -> Any<()> {
        for generation in 0..call.generations.unwrap_or(8) {
            let n_tets = self.step(usize::from(generation) + 1, &|refinement, threads| {
                let marked = marked(refinement, i32::from(generation));
                refinement.refine(&marked, threads)?;
                Ok(marked.len())
            })?;
            if n_tets > call.most {
                println!("stopped: more than {} tets", call.most);
                break;
            }
        }
        Ok(())
    }

    fn towards(&mut self, call: &Call, towards: &Towards) -> Any<()> {
        let shape = match *towards {
            Towards::Shape(shape) => shape,
            Towards::Scattered => {
                let mut numbers = Numbers(1);
                let chances: Vec<f64> = self.first.mesh.tets.iter().map(|_| numbers.unit()).collect();
                return self.divide(call, |refinement, generation| {
                    let roots: Vec<TetId> = refinement.roots().collect();
                    let part = 0.03 * 0.25f64.powi(generation);
                    tets_where(refinement.mesh(), |t| chances[roots[t.index()].index()] < part)
                });
            }
        };
        let first = &self.first.mesh;
        let at = call.at.unwrap_or_else(|| middle(first));
        let mut all: Vec<f64> =
            (0..first.tets.len()).map(|t| shape.out(at, centre(first, TetId::new(t)), 0)).collect();
        all.sort_by(f64::total_cmp);
        let reach = all[call.start.clamp(1, all.len()) - 1];
        self.divide(call, |refinement, generation| {
            let mesh = refinement.mesh();
            tets_where(mesh, |t| shape.out(at, centre(mesh, t), generation) <= reach)
        })
    }

    fn front(&mut self, call: &Call, front: Front) -> Any<()> {
        let deepest = call.generations.unwrap_or(3);
        let at = call.at.unwrap_or_else(|| middle(&self.first.mesh));
        // The coordinate along which the front moves.
        let along = |p: Point| match front {
            Front::Plane => p[0],
            Front::Sphere => distance(p, at),
        };
        let places = self.first.mesh.points.iter().map(|p| along(*p));
        let [low, high] = places.fold([f64::MAX, f64::MIN], |[low, high], x| [low.min(x), high.max(x)]);
        let stride = (high - low) / (call.steps - 1) as f64;
        let ahead = f64::from(deepest) * stride;
        for step in 0..call.steps {
            let place = low + step as f64 * stride;
            let n_tets = self.step(step + 1, &|refinement, threads| {
                behind_and_ahead(
                    refinement,
                    threads,
                    along,
                    [place - 2.0 * stride, place, place + ahead],
                    deepest,
                )
            })?;
            if n_tets > call.most {
                println!("stopped: more than {} tets", call.most);
                break;
            }
        }
        self.back()
    }

    /// Takes everything back.
    fn back(&mut self) -> Any<()> {
        let mut n = 0;
        while self.refinement.mesh() != &self.first.mesh && n < 20 {
            let all = tets_where(self.refinement.mesh(), |_| true);
            self.refinement.coarsen(&all, &self.threads)?;
            n += 1;
        }
        let is_back = self.refinement.mesh() == &self.first.mesh;
        self.holds &= is_back;
        let what = if is_back { "the first mesh, bit for bit" } else { "BROKEN: not the first mesh" };
        println!("\nall taken back in {n} steps: {what}");
        Ok(())
    }
}

/// Takes back what lies behind the front, then divides once what reaches into the band ahead.
fn behind_and_ahead(
    refinement: &mut Refinement,
    threads: &Threads,
    along: impl Fn(Point) -> f64,
    [behind, begin, end]: [f64; 3],
    deepest: u8,
) -> Any<usize> {
    let reach = |mesh: &TetMesh, t: TetId| {
        let places = corners(mesh, mesh.tets[t.index()]).map(&along);
        [places.into_iter().fold(f64::MAX, f64::min), places.into_iter().fold(f64::MIN, f64::max)]
    };
    let mesh = refinement.mesh();
    let left = tets_where(mesh, |t| reach(mesh, t)[1] < behind);
    refinement.coarsen(&left, threads)?;
    let generations: Vec<u8> = refinement.generations().collect();
    let mesh = refinement.mesh();
    let met = tets_where(mesh, |t| {
        let [low, high] = reach(mesh, t);
        generations[t.index()] < deepest && low <= end && high >= begin
    });
    refinement.refine(&met, threads)?;
    Ok(met.len())
}

fn run() -> Any<bool> {
    let call = call()?;
    let mut run = Run::new(&call)?;
    match (&call.towards, call.front) {
        (Some(towards), _) => run.towards(&call, towards)?,
        (None, Some(front)) => run.front(&call, front)?,
        (None, None) => return Err("--towards or --front is needed".into()),
    }
    println!("\n{}", if run.holds { "all guarantees hold" } else { "BROKEN" });
    Ok(run.holds)
}

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(2)
        }
    }
}
