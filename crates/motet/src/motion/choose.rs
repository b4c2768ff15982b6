//! Which method to take: the cheapest that keeps the mesh good.

use std::time::Instant;

use serde::Serialize;

use crate::base::{Error, ErrorKind, Point, Result, Threads};
use crate::mesh::Mesh;
use crate::motion::certificate::{Certificate, Worst};
use crate::motion::mover::Mover;
use crate::motion::options::{Elastic, Method, Options};

/// What was chosen, and why.
#[derive(Clone, Debug)]
pub struct Choice {
    /// The method to take.
    pub method: Method,
    /// The bound: no cell was to be worse.
    pub least: f64,
    /// What was tried, the cheapest first; the last one is not always the one that was chosen.
    pub tried: Vec<Tried>,
}

/// What a method came to.
#[derive(Clone, Debug, Serialize)]
pub struct Tried {
    /// Its name, as [`Method::name`] has it.
    pub method: &'static str,
    /// Whether it reached every frame, and no cell was worse than the bound.
    pub kept: bool,
    /// Frames that it reached.
    pub frames: usize,
    /// The worst cell of all of these: EAS of tets, scaled Jacobian of others.
    pub worst: Option<f64>,
    /// Why it could not be tried.
    pub refused: Option<String>,
    /// Set-up and all frames.
    pub seconds: f64,
}

/// A mesh is allowed to get twice as bad as it came, and no worse than this is asked for.
const LEAST: f64 = 0.1;

/// Tries the graph, bodies (those of `options`, where it names some), the graph whose nodes turn, and elasticity, in this order, which is that of their price, on all frames of a motion;
/// takes the first that keeps every cell at an EAS (or scaled Jacobian) of `least`. Where none does: the one whose worst cell is the best.
///
/// `frames` begins anew with each call and gives displacements as [`Mover::advance`] takes them. `least`: half of the worst cell as the mesh came, at most 0.1, when `None`.
///
/// # Errors
/// Those of the frames; as [`Mover::new`] or [`Mover::advance`], where all methods refuse.
pub fn choose<I: Iterator<Item = Result<Vec<Point>>>>(
    mesh: &Mesh,
    options: &Options,
    least: Option<f64>,
    mut frames: impl FnMut() -> Result<I>,
    threads: &Threads,
) -> Result<Choice> {
    if let Some(least) = least.filter(|least| !(0.0..=1.0).contains(least)) {
        return Err(Error::options(format!("an EAS of {least} as the least, expected a number in [0, 1]"))
            .remedy("leave it out"));
    }
    let bodies = match &options.method {
        Method::Bodies(sets) => sets.clone(),
        _ => Vec::new(),
    };
    let ladder =
        [Method::Delaunay, Method::Bodies(bodies), Method::Guided, Method::Elastic(Elastic::default())];
    let mut choice = Choice { method: Method::Delaunay, least: least.unwrap_or(LEAST), tried: Vec::new() };
    let mut best: Option<f64> = None;
    let mut refusal = None;
    let n_methods = ladder.len();
    for (k, method) in ladder.into_iter().enumerate() {
        threads.watch().go_on("trying methods", k, n_methods)?;
        let begin = Instant::now();
        let mut tried =
            Tried { method: method.name(), kept: false, frames: 0, worst: None, refused: None, seconds: 0.0 };
        match Mover::new(mesh, &Options { method: method.clone(), ..options.clone() }, threads) {
            Err(error) if error.kind() == ErrorKind::Stopped => return Err(error),
            Err(error) => {
                tried.refused = Some(error.what().to_string());
                refusal = Some(error);
            }
            Ok(mut mover) => {
                if least.is_none() {
                    let came = worst(&mover.quality(mover.reference(), threads));
                    choice.least = came.map_or(LEAST, |came| LEAST.min(0.5 * came));
                }
                tried.go(&mut mover, frames()?, choice.least, threads)?;
            }
        }
        tried.seconds = begin.elapsed().as_secs_f64();
        let value = tried.worst.unwrap_or(f64::NEG_INFINITY);
        let (is_better, kept) = (best.is_none_or(|best| value > best), tried.kept);
        if tried.refused.is_none() && (kept || is_better) {
            (best, choice.method) = (Some(value), method);
        }
        choice.tried.push(tried);
        if kept {
            break;
        }
    }
    match refusal {
        Some(error) if best.is_none() => Err(error),
        _ => Ok(choice),
    }
}

impl Tried {
    /// All frames, or as many as can be reached.
    fn go(
        &mut self,
        mover: &mut Mover,
        frames: impl Iterator<Item = Result<Vec<Point>>>,
        least: f64,
        threads: &Threads,
    ) -> Result<()> {
        let mut points = mover.reference().to_vec();
        self.kept = true;
        for displacement in frames {
            let certificate = match mover.advance(&displacement?, &mut points, threads) {
                Ok(certificate) => certificate,
                Err(error) if error.kind() == ErrorKind::Stopped => return Err(error),
                Err(error) => {
                    (self.kept, self.refused) = (false, Some(error.what().to_string()));
                    break;
                }
            };
            if let Some(now) = worst(&certificate) {
                self.worst = Some(self.worst.map_or(now, |before| before.min(now)));
            }
            self.kept &= certificate.complete && worst(&certificate).is_none_or(|now| now >= least);
            if !certificate.complete {
                // As bad as can be: it does not get there.
                self.worst = Some(self.worst.map_or(0.0, |worst| worst.min(0.0)));
                break;
            }
            self.frames += 1;
        }
        Ok(())
    }
}

fn worst(certificate: &Certificate) -> Option<f64> {
    let value = |worst: Option<Worst>| worst.map(|worst| worst.value);
    let quality = &certificate.quality;
    let all = [quality.worst_eas, quality.worst_scaled_jacobian, quality.worst_curved_jacobian];
    all.into_iter().filter_map(value).reduce(f64::min)
}
