//! The lists in other layouts.

use super::Pass;

/// The stages of every layout. Nothing of the picture needs them.
pub(super) fn passes(transparent: usize, skip: bool) -> impl Iterator<Item = Pass> {
    let needed = transparent > 0;
    let reason = move || match (needed, skip) {
        (true, _) => format!("{transparent} transparent triangles"),
        (false, true) => "no transparent triangles".to_owned(),
        (false, false) => {
            "not needed (no transparent triangles), but nothing is skipped".to_owned()
        }
    };
    ["bucket", "precalc", "rank", "packed", "regions", "ordered"]
        .into_iter()
        .map(move |name| Pass {
            name,
            runs: needed || !skip,
            reason: reason(),
        })
}
