//! Limits on refinement: generations, sizes and the number of tets.

use super::estimate::{corners, longest_edge};
use super::wish::Wish;
use crate::base::{Error, Result};
use crate::mesh::TetMesh;

/// Limits beyond which no tet is divided. Tets that must be divided so that others fit are exempt.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// A tet of this generation or a later one is not divided. Default: none.
    pub generation: Option<u8>,
    /// A tet is not divided where the longest edge of its parts, half of its own, would be shorter than this.
    /// Default: none.
    pub smallest: Option<f64>,
    /// Division stops at this number of tets; tets added by the closure come on top. Among tets with equal
    /// wishes the largest are divided first. Default: none.
    pub n_tets: Option<usize>,
}

impl Limits {
    /// Checks the smallest length.
    ///
    /// # Errors
    /// When it is negative or NaN.
    pub(crate) fn check(&self) -> Result<()> {
        match self.smallest.filter(|smallest| smallest.is_nan() || *smallest < 0.0) {
            None => Ok(()),
            Some(smallest) => Err(Error::options(format!("the smallest edge length is {smallest}"))
                .remedy("give a length of 0 or more, or omit it")),
        }
    }

    /// Withdraws wishes beyond the limits: such tets stay. `generations` gives the generation of each tet; if
    /// it is empty, all are of generation 0.
    pub fn apply(&self, mesh: &TetMesh, generations: &[u8], wishes: &mut [Wish]) {
        let longest = |t: usize| longest_edge(corners(mesh, mesh.tets[t]));
        for (t, wish) in wishes.iter_mut().enumerate() {
            let Wish::Divided(n) = *wish else { continue };
            let generation = generations.get(t).copied().unwrap_or(0);
            let left = self.generation.map_or(n, |most| most.saturating_sub(generation).min(n));
            let halvings = self.smallest.map_or(left, |smallest| halvings(longest(t), smallest).min(left));
            *wish = if halvings > 0 { Wish::Divided(halvings) } else { Wish::Kept };
        }
        if let Some(most) = self.n_tets {
            self.keep_first(most.saturating_sub(wishes.len()) / 7, longest, wishes);
        }
    }

    fn keep_first(&self, n: usize, longest: impl Fn(usize) -> f64, wishes: &mut [Wish]) {
        let mut order: Vec<usize> = (0..wishes.len()).filter(|&t| wishes[t].is_divided()).collect();
        if order.len() > n {
            order.sort_by(|&a, &b| {
                wishes[b].cmp(&wishes[a]).then_with(|| longest(b).total_cmp(&longest(a))).then(a.cmp(&b))
            });
        }
        order.into_iter().skip(n).for_each(|t| wishes[t] = Wish::Kept);
    }
}

/// How often a length can be halved without falling below another.
fn halvings(length: f64, smallest: f64) -> u8 {
    (length / smallest).log2().floor().clamp(0.0, 255.0) as u8
}
