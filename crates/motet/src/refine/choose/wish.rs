//! What a criterion wants done with a tet: divide it, with an estimate of how often; keep it; or allow its
//! division to be taken back.

use crate::base::{Error, Result, TetId};

/// The largest number of tets that may be requested. There are ids for slightly more, but a forest also keeps
/// the divided tets: one for every seven tets added.
pub const MOST_TETS: f64 = (TetId::MAX_COUNT / 8 * 7) as f64;

/// What a criterion wants done with a tet. Of two wishes the larger counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Wish {
    /// Not even a tet twice as large would be divided: the division that this tet comes from may be taken
    /// back.
    Coarser,
    /// Keep it as it is.
    #[default]
    Kept,
    /// Divide it, and its parts again, this many times in all, at least once. Beyond the first time this is
    /// an estimate.
    Divided(u8),
}

impl Wish {
    /// The wish for a tet that is too large by this ratio: it is halved until it no longer is.
    pub fn of_ratio(ratio: f64) -> Self {
        match ratio {
            r if r > 1.0 => Self::Divided(r.log2().ceil().clamp(1.0, 255.0) as u8),
            r if r <= 0.5 => Self::Coarser,
            _ => Self::Kept,
        }
    }

    /// The wish for a tet that a criterion marks, or does not mark, by its place or contents.
    pub fn of_mark(is_marked: bool) -> Self {
        if is_marked { Self::Divided(1) } else { Self::Coarser }
    }

    /// How often the tet is to be divided.
    pub fn divisions(self) -> u8 {
        match self {
            Self::Divided(n) => n,
            Self::Coarser | Self::Kept => 0,
        }
    }

    /// Whether the tet is to be divided.
    pub fn is_divided(self) -> bool {
        self >= Self::Divided(0)
    }
}

/// The tets to divide, in ascending order.
pub fn marked(wishes: &[Wish]) -> Vec<TetId> {
    tets_with(wishes, Wish::is_divided)
}

/// The tets whose division may be taken back, in ascending order.
pub fn coarser(wishes: &[Wish]) -> Vec<TetId> {
    tets_with(wishes, |wish| wish == Wish::Coarser)
}

fn tets_with(wishes: &[Wish], is_one: impl Fn(Wish) -> bool) -> Vec<TetId> {
    (0..wishes.len()).filter(|&t| is_one(wishes[t])).map(TetId::new).collect()
}

/// The approximate number of tets once all wishes are fulfilled: each tet counts eight to the power of its
/// number of divisions. Tets divided or cut only because of their neighbours are not counted.
pub fn expected_tets(wishes: &[Wish]) -> f64 {
    let mut counts = [0usize; 1 + u8::MAX as usize];
    wishes.iter().for_each(|wish| counts[usize::from(wish.divisions())] += 1);
    (0..).zip(counts).map(|(n, count)| count as f64 * 8f64.powi(n)).sum()
}

/// Rejects wishes for more tets than there can be, before any work is done.
///
/// # Errors
/// When more than [`MOST_TETS`] are [expected](expected_tets).
pub fn check_expected(wishes: &[Wish]) -> Result<()> {
    let expected = expected_tets(wishes);
    if expected <= MOST_TETS {
        return Ok(());
    }
    let factor = (expected / MOST_TETS).cbrt();
    let factor = if factor < 1e6 { format!("{:.1}", factor + 0.05) } else { format!("{factor:.1e}") };
    Err(Error::input(format!(
        "would be divided into about {expected:.1e} tets, but there are ids for only {MOST_TETS:.1e}"
    ))
    .remedy(format!(
        "request sizes {factor} times as large, or limit the smallest size or the number of tets"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ratio_says_how_often() {
        let all = [0.3, 0.5, 0.51, 1.0, 1.0 + 1e-15, 2.0, 2.1, 8.0, 1e300, f64::INFINITY, f64::NAN];
        let found = all.map(Wish::of_ratio);
        use Wish::{Coarser, Divided, Kept};
        let expected = [Coarser, Coarser, Kept, Kept].into_iter();
        let expected = expected.chain([1, 1, 2, 3, 255, 255].map(Divided)).chain([Kept]);
        assert_eq!(found.to_vec(), expected.collect::<Vec<_>>());
        assert!(Coarser < Kept && Kept < Divided(0) && Divided(1) < Divided(2));
    }

    #[test]
    fn what_would_be_too_many_is_refused_before_work() {
        let wishes = |n| vec![Wish::Divided(n), Wish::Kept, Wish::Coarser];
        assert_eq!(expected_tets(&wishes(2)), 66.0);
        assert!(check_expected(&wishes(10)).is_ok());
        let error = check_expected(&wishes(11)).unwrap_err();
        assert_eq!(error.kind(), crate::base::ErrorKind::Input);
        assert!(error.to_string().contains("8.6e9 tets"), "{error}");
        assert!(error.to_string().contains("sizes 1.4 times as large"), "{error}");
        // Rejected even where the count overflows to infinity.
        assert!(check_expected(&[Wish::Divided(255), Wish::Divided(255)]).is_err());
        assert_eq!((marked(&wishes(1)), coarser(&wishes(1))), (vec![TetId(0)], vec![TetId(2)]));
    }
}
