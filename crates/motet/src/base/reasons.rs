//! Why a result is less than was requested, in words.

/// Joins the reasons that are present with semicolons; `None` where there is none.
pub fn reasons<const N: usize>(all: [Option<String>; N]) -> Option<String> {
    let all: Vec<String> = all.into_iter().flatten().collect();
    (!all.is_empty()).then(|| all.join("; "))
}
