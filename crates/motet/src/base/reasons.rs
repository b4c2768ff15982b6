//! Why a result is less than was requested, in words.

/// The reasons that there are, one after the other; `None` where there is none.
pub fn reasons<const N: usize>(all: [Option<String>; N]) -> Option<String> {
    let all: Vec<String> = all.into_iter().flatten().collect();
    (!all.is_empty()).then(|| all.join("; "))
}
