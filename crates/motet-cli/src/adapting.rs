//! Options of verbs that replace triangles of surfaces by even ones; the help is that of the verb's words.

use std::marker::PhantomData;

use clap::Args;
use motet::base::Words;
use motet::meshing::{Adapting, EdgeLength};

use crate::help;
use crate::words::positive;

/// Sizes, distance and repair of surfaces.
#[derive(Debug, Args)]
pub(crate) struct AdaptArgs<W: Words> {
    #[arg(long, help = help::effect::<W>("size"), value_name = "H|auto", value_parser = EdgeLength::of_text)]
    pub(crate) size: Option<EdgeLength>,
    #[arg(long, help = help::effect::<W>("distance"), value_name = "D", value_parser = positive)]
    pub(crate) distance: Option<f64>,
    #[arg(long, help = help::effect::<W>("feature_angle"), value_name = "DEG",
        default_value_t = Adapting::default().feature_angle)]
    pub(crate) feature_angle: f64,
    #[arg(long, help = help::effect::<W>("growth"), value_name = "G", value_parser = positive)]
    pub(crate) growth: Option<f64>,
    #[arg(long, help = help::effect::<W>("size_array"), value_name = "NAME")]
    pub(crate) size_array: Option<String>,
    #[arg(long, help = help::effect::<W>("repair"))]
    pub(crate) repair: bool,
    #[arg(long, help = help::effect::<W>("merge"), value_name = "DISTANCE", requires = "repair")]
    pub(crate) merge: Option<f64>,
    #[arg(long, help = help::effect::<W>("unite"))]
    pub(crate) unite: bool,
    #[arg(long, help = help::effect::<W>("wrap"), value_name = "DISTANCE", value_parser = positive,
        conflicts_with = "unite")]
    pub(crate) wrap: Option<f64>,
    #[arg(skip)]
    words: PhantomData<W>,
}
