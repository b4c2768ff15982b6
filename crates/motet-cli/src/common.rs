//! Options common to all verbs.

use std::cell::OnceCell;

use clap::Args;
use motet::base::{Simulation, Threads};

/// Options common to all verbs.
#[derive(Debug, Args)]
#[command(next_help_heading = "Everywhere")]
pub(crate) struct Common {
    /// Print one JSON object on standard output and everything else on standard error
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// Number of threads; 0 = one per core. Results do not depend on it
    #[arg(long, global = true, value_name = "N", default_value_t = 0, allow_negative_numbers = true)]
    threads: usize,
    /// Work on one thread, and tell what N threads would save, by the times of their tasks
    #[arg(long, global = true, value_name = "N", hide = true)]
    simulate_threads: Option<usize>,
    #[arg(skip)]
    simulation: OnceCell<Simulation>,
    /// Print only errors (and the JSON object)
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Print more: what is read, found and written, with times
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
}

impl Common {
    /// The threads that the call requests.
    pub(crate) fn threads(&self) -> motet::Result<Threads> {
        match self.simulate_threads {
            Some(n) => Ok(Threads::simulated(self.simulation.get_or_init(|| Simulation::new(n)))),
            None => Threads::new(self.threads),
        }
    }

    /// The simulated threads, where the call requested them and had work for them.
    pub(crate) fn simulation(&self) -> Option<&Simulation> {
        self.simulation.get()
    }
}
