//! The lists in other layouts.

use super::Pass;

/// The stages of every layout, where a scene asks for rivals. Nothing of the picture needs them, so that
/// they are left out also where nothing is skipped.
pub(super) fn passes(asked: bool, transparent: usize) -> impl Iterator<Item = Pass> {
    let reason = move || match (transparent, asked) {
        (0, _) => "no transparent triangles".to_owned(),
        (_, false) => "scenes of raster are about coverage".to_owned(),
        (_, true) => format!("{transparent} transparent triangles"),
    };
    ["bucket", "precalc", "rank", "packed", "regions", "ordered"]
        .into_iter()
        .map(move |name| Pass {
            name,
            runs: asked && transparent > 0,
            reason: reason(),
        })
}
