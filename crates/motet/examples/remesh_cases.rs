//! The cases of the paper on dynamic remeshing, in numbers.
//!
//! `remesh_cases channel | membrane | shear | twist | transfer [N]`, N the number of cycles (channel: of
//! steps of 0.1); `membrane [N] [A]`: the membrane comes within 0.5 - A of the wall; `shear [N] [SIZE]`: with
//! edges brought to a size at each step; `sphere FILE` writes a mesh of the channel after motion, for
//! docs/pictures.py

#[path = "../tests/remesh/moving_cases/mod.rs"]
#[allow(dead_code, unreachable_pub, reason = "tests share it, and use other parts of it")]
mod moving_cases;

use std::process::ExitCode;
use std::time::Instant;

use motet::base::Threads;
use motet::mesh::TetMesh;
use motet::remesh::{Options, Sizes, remesh};
use moving_cases::channel::{repaired_as_it_moves, stretched};
use moving_cases::cube::{self, Distortion, cube_mesh};
use moving_cases::measure::{boundary, labelled, quality, volumes};
use moving_cases::membrane::{self, Bending, Cycle, membrane_mesh};
use moving_cases::meshes::{Channel, INNER, prepared};
use moving_cases::transfer::{self, Loaded, Repairs};
use moving_cases::{adapt, keep};

fn describe(name: &str, mesh: &TetMesh) {
    let q = quality(mesh);
    println!(
        "{name}: {} points, {} tets, {} bad, {} inverted, worst EAS {:.4}",
        mesh.points.len(),
        mesh.tets.len(),
        q.bad,
        q.inverted,
        q.worst
    );
}

/// The numbers of bad tets that motion left in the paper's mesh, figure 11.
const PAPER: [&str; 4] = ["1", "66", "265", "598"];
/// Displacement between two rows of the table, chosen to produce about as many bad tets as in the paper.
const STRIDE: f64 = 0.22;

fn channel(n_steps: usize) {
    let channel = Channel {
        low: [0.0, -1.0, -1.0],
        high: [6.0, 1.0, 1.0],
        centre: [1.5, 0.0, 0.0],
        radius: 0.5,
        sizes: [0.1, 0.2],
        growth: 0.15,
    };
    let start = Instant::now();
    let raw = channel.mesh(1);
    describe("Delaunay", &raw);
    let mesh = prepared(&raw);
    describe("prepared", &mesh);
    println!("made in {:.1} s\n", start.elapsed().as_secs_f64());

    let shifts: Vec<f64> = (0..5).map(|i| STRIDE * i as f64).collect();
    println!("from the first place                | then repaired, surface kept");
    println!(
        "shift  paper   bad inverted    worst |   bad    worst   kept    tets  surface   volume  seconds"
    );
    for (i, state) in stretched(&mesh, &shifts).iter().enumerate() {
        let outcome = remesh(&state.mesh, &keep(), &Threads::single()).expect("it is a mesh");
        let after = &outcome.extract.mesh;
        let q = quality(after);
        let is_same = boundary(&state.mesh) == boundary(after) && labelled(&state.mesh) == labelled(after);
        let [before_volume, after_volume] = [&state.mesh, after].map(|m| volumes(m)[&1]);
        println!(
            "{:5.3} {:>6} {:5} {:8} {:8.4} | {:5} {:8.4} {:6.4} {:7} {:>8} {:8.1e} {:8.3}",
            state.shift,
            PAPER.get(i).unwrap_or(&""),
            state.quality.bad,
            state.quality.inverted,
            state.quality.worst,
            q.bad,
            q.worst,
            outcome.report.kept_share,
            after.tets.len(),
            if is_same { "same" } else { "CHANGED" },
            (after_volume / before_volume - 1.0).abs(),
            outcome.report.seconds.join + outcome.report.seconds.repair + outcome.report.seconds.extract,
        );
    }

    println!("\nrepaired after every step\nshift   bad inverted    worst |   bad    worst   kept    tets");
    repaired_as_it_moves(&mesh, 0.1, n_steps, &keep(), |step| {
        let [before, after] = [&step.moved, &step.repaired].map(quality);
        println!(
            "{:5.3} {:5} {:8} {:8.4} | {:5} {:8.4} {:6.4} {:7}",
            step.shift,
            before.bad,
            before.inverted,
            before.worst,
            after.bad,
            after.worst,
            step.report.kept_share,
            step.repaired.tets.len(),
        );
    });
}

/// Displacement of the sphere in the picture.
const SHIFT: f64 = 0.66;

fn sphere(file: &str) -> ExitCode {
    let channel = Channel {
        low: [-1.1, -1.0, -1.0],
        high: [1.7, 1.0, 1.0],
        centre: [0.0; 3],
        radius: 0.5,
        sizes: [0.08, 0.17],
        growth: 0.15,
    };
    let states = stretched(&prepared(&channel.mesh(1)), &[SHIFT]);
    describe("moved", &states[0].mesh);
    match motet::io::write(file, &transfer::whole(&states[0].mesh), &motet::io::WriteOptions::default()) {
        Ok(_) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn membrane(n_cycles: usize, amplitude: f64) {
    let mut mesh = membrane_mesh(0.1, 1);
    describe("prepared", &mesh);
    let bending = Bending { amplitude, n_steps: 40 };
    println!(
        "cycle     bad inverted  adapted  left    worst    tets    volume 1    volume 2  membrane         area features      length    flat"
    );
    let print = |name: usize, cycle: Option<&Cycle>, state: &membrane::State| {
        match cycle {
            Some(c) => print!(
                "{name:5} {:7} {:8} {:8} {:5} {:8.4}",
                c.most_bad, c.most_inverted, c.n_adapted, c.n_left, c.worst
            ),
            None => print!("{name:5} {:7} {:8} {:8} {:5} {:8}", "", "", "", "", ""),
        }
        println!(
            " {:7} {:11.8} {:11.8} {:9} {:12.9} {:8} {:11.8} {:7.1e}",
            state.n_tets,
            state.volumes[&1],
            state.volumes[&2],
            state.patches[&INNER].0,
            state.patches[&INNER].1,
            state.features.0,
            state.features.1,
            state.off_membrane,
        );
    };
    print(0, None, &membrane::state(&mesh));
    let mut n_left = 0;
    for i in 1..=n_cycles {
        let cycle = membrane::cycle(&mut mesh, &bending, &keep(), |_, mesh| n_left += quality(mesh).bad);
        if i <= 5 || i % 5 == 0 {
            print(i, Some(&cycle), &cycle.state);
        }
    }
    println!("bad tets left, over all steps of {n_cycles} cycles: {n_left}");
}

fn cube(distortion: Distortion, n_cycles: usize, sizes: Option<Sizes>) {
    let options = Options { sizes, ..adapt() };
    let mut mesh = cube_mesh(0.1, 1);
    describe("prepared", &mesh);
    println!(
        "columns: most bad, inverted before repair | left, summed over steps: forced by walls that meet, on a wall's angle, others | worst EAS | ... at the end"
    );
    println!(
        "cycle     bad inverted |  meet angle other     worst    tets    most      volume  off side  off edge  edges  corners"
    );
    let n_steps = 20;
    let (mut total, mut n_steps_with_others) = ([0; 3], 0);
    for i in 1..=n_cycles {
        let (mut bad, mut inverted, mut most_tets, mut worst) = (0, 0, 0, f64::INFINITY);
        let mut reasons = [0; 3];
        let mut last = cube::state(&mesh, &distortion, 0.0);
        cube::cycle(&mut mesh, &distortion, n_steps, &options, |step, _| {
            bad = bad.max(step.bad_before);
            inverted = inverted.max(step.inverted_before);
            most_tets = most_tets.max(step.state.n_tets);
            (0..3).for_each(|k| reasons[k] += step.reasons[k]);
            (0..3).for_each(|k| total[k] += step.reasons[k]);
            n_steps_with_others += usize::from(step.reasons[2] > 0);
            worst = step.worst.min(worst);
            last = step.state;
            if i == 1 {
                println!(
                    "  step {:5.3}: {:5} bad {:4} inverted -> {:4} bad {:?} worst {:7.4} {:6} tets off side {:8.1e} off edge {:8.1e}",
                    step.part,
                    step.bad_before,
                    step.inverted_before,
                    step.bad,
                    step.reasons,
                    step.worst,
                    step.state.n_tets,
                    step.state.off_side,
                    step.state.off_edge
                );
            }
        });
        if i <= 5 || i % 5 == 0 {
            println!(
                "{i:5} {bad:7} {inverted:8} | {:5} {:5} {:5} {worst:8.4} {:7} {most_tets:7} {:11.8} {:8.1e} {:8.1e} {:11.8} {}",
                reasons[0],
                reasons[1],
                reasons[2],
                last.n_tets,
                last.volume,
                last.off_side,
                last.off_edge,
                last.edges,
                last.corners
            );
        }
    }
    println!(
        "bad tets left, over all {} steps: {} between walls that meet, {} on a wall's angle, {} others in {} steps",
        2 * n_steps * n_cycles,
        total[0],
        total[1],
        total[2],
        n_steps_with_others
    );
}

/// Prints a row after some cycles of a case that carries fields.
fn print_fields(cycle: usize, loaded: &Loaded) {
    if cycle > 5 && !cycle.is_multiple_of(10) {
        return;
    }
    let t = &loaded.tally;
    print!(
        "{cycle:5} {:6} {:8} {:4} | {:8.1e} {:8.1e} {:8.1e} {:8.1e} |",
        loaded.mesh.cells.len(),
        t.n_new_tets,
        t.n_inverted,
        t.drift,
        t.linear,
        t.linear_outside,
        t.off_constant
    );
    let print_row = |r: &Repairs| {
        print!(
            "{:5} {:5} {:8.1e} {:8.1e} {:8.1e} {:8.1e} {:5} {:8.1e} |",
            r.n, r.n_left, r.drift, r.beyond, r.allowed, r.deviation, r.n_outside, r.farthest_outside
        );
    };
    print_row(&t.kept);
    print_row(&t.adapted);
    println!();
}

fn transfer(n_cycles: usize) {
    println!(
        "columns: new tets of all repairs, steps with inverted tets; of integrals over regions the drift from their first values, relative \
         to the integral of absolute values; errors of the linear field, relative to its range (out: where vertices lie outside of \
         the old tets, less what the way explains); error of the constant. Then of repairs with the surface kept, and with one \
         that adapts: how many, bad tets left; drifts without sign, the most that one was beyond the ledger's deviation, what that \
         allows; deviation by volume; vertices outside, and the farthest. Sums but for beyond and farthest."
    );
    let head = || {
        let repairs = " reps  left    drift   beyond  allowed deviated   out farthest |";
        println!("cycle  cells new tets inv. |    drift   linear      out constant |{repairs}{repairs}");
    };
    let adapt = adapt();
    for (name, then) in [("kept", None), ("kept, and adapting where that leaves bad tets", Some(&adapt))] {
        let begin = Instant::now();
        println!("\nmembrane, surface {name}, 40 steps a cycle");
        head();
        let bending = Bending { amplitude: 0.45, n_steps: 40 };
        transfer::bend(&mut Loaded::new(&membrane_mesh(0.1, 1), 1), &bending, then, n_cycles, print_fields);
        println!("{:.0} s", begin.elapsed().as_secs_f64());
    }
    for distortion in [Distortion::Shear(60.0), Distortion::Twist(90.0), Distortion::Twist(180.0)] {
        let begin = Instant::now();
        println!("\n{distortion:?}, 40 steps a cycle");
        head();
        transfer::distort(&mut Loaded::new(&cube_mesh(0.1, 1), 1), &distortion, 20, n_cycles, print_fields);
        println!("{:.0} s", begin.elapsed().as_secs_f64());
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let n = |default: usize| arguments.get(1).and_then(|n| n.parse().ok()).unwrap_or(default);
    match arguments.first().map(String::as_str) {
        Some("channel") => channel(n(30)),
        Some("membrane") => {
            membrane(n(100), arguments.get(2).and_then(|a| a.parse().ok()).unwrap_or(0.45));
        }
        Some("shear") => {
            let size = arguments.get(2).and_then(|size| size.parse().ok());
            cube(Distortion::Shear(80.0), n(100), size.map(Sizes::Uniform));
        }
        Some("twist") => cube(Distortion::Twist(90.0), n(100), None),
        Some("transfer") => transfer(n(100)),
        Some("sphere") if arguments.len() == 2 => return sphere(&arguments[1]),
        _ => {
            eprintln!("remesh_cases channel | membrane | shear | twist | transfer [N], sphere FILE");
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}
