//! Choosing a method: the cheapest that keeps the mesh good.

use std::time::Instant;

use serde::Serialize;

use crate::base::{Error, ErrorKind, Point, Result, Threads};
use crate::mesh::Mesh;
use crate::motion::certificate::{Certificate, Worst};
use crate::motion::mover::Mover;
use crate::motion::options::{Elastic, Method, Options};
use crate::motion::words::MethodName;

/// What was chosen, and why.
#[derive(Clone, Debug)]
pub struct Choice {
    /// The method chosen.
    pub method: Method,
    /// The bound on quality that cells had to keep.
    pub least: f64,
    /// The methods tried, the cheapest first; the last is not always the one chosen.
    pub tried: Vec<Tried>,
}

/// The result of trying one method.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Tried {
    /// The name of the method, from [`Method::name`].
    pub method: MethodName,
    /// Whether it reached every frame, with no cell worse than the bound.
    pub kept: bool,
    /// Number of frames that it reached.
    pub frames: usize,
    /// The worst cell of all these frames: EAS of tets, scaled Jacobian of others. At most 0 where a frame
    /// was not completed.
    pub worst: Option<f64>,
    /// Why it could not be used.
    pub refused: Option<String>,
    /// Seconds for set-up and all frames.
    pub seconds: f64,
}

/// Default bound: the worst cell may lose half of its quality, and no more than this is required.
const DEFAULT_MIN_QUALITY: f64 = 0.1;

/// Chooses the cheapest method that keeps every cell of all frames of a motion at an EAS (or scaled Jacobian)
/// of `least`.
///
/// In order of cost, it tries the graph, bodies (those of `options`, where it names some), the graph whose
/// nodes rotate, and elasticity, and takes the first that meets the bound. Where none does, it takes the one
/// whose worst cell is best.
///
/// `frames` restarts the motion with each call and yields displacements as [`Mover::advance`] takes them.
/// When `least` is `None`, it is half of the worst cell of the mesh as given, at most 0.1.
///
/// # Errors
/// When `least` is not in [0, 1]; those of the frames; where all methods refuse, those of [`Mover::new`] or
/// [`Mover::advance`].
pub fn choose<I: Iterator<Item = Result<Vec<Point>>>>(
    mesh: &Mesh,
    options: &Options,
    least: Option<f64>,
    mut frames: impl FnMut() -> Result<I>,
    threads: &Threads,
) -> Result<Choice> {
    if let Some(least) = least.filter(|least| !(0.0..=1.0).contains(least)) {
        return Err(Error::options(format!("the smallest EAS allowed must be in [0, 1]; got {least}"))
            .remedy("leave it out to use the default"));
    }
    let bodies = match &options.method {
        Method::Bodies(sets) => sets.clone(),
        _ => Vec::new(),
    };
    let ladder =
        [Method::Delaunay, Method::Bodies(bodies), Method::Guided, Method::Elastic(Elastic::default())];
    let mut choice =
        Choice { method: Method::Delaunay, least: least.unwrap_or(DEFAULT_MIN_QUALITY), tried: Vec::new() };
    let mut best: Option<f64> = None;
    let mut refusal = None;
    let n_methods = ladder.len();
    for (k, method) in ladder.into_iter().enumerate() {
        threads.watch().report_and_check("trying methods", k, n_methods)?;
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
                    let initial = worst(&mover.quality(mover.reference(), threads));
                    choice.least =
                        initial.map_or(DEFAULT_MIN_QUALITY, |initial| DEFAULT_MIN_QUALITY.min(0.5 * initial));
                }
                tried.run(&mut mover, frames()?, choice.least, threads)?;
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
    /// Runs all frames, or as many as can be reached.
    fn run(
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
                // An incomplete frame counts as a flat cell.
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
