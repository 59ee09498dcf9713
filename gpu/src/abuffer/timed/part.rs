//! What is timed of a frame, and which kernels show how many layers.

use crate::abuffer::STEPS;
use crate::wgsl::Sources;

/// The file that ships the kernels of the nearest layers.
pub(super) const FILE: &str = "nearest";

/// Most layers that [`Part::Nearest`] keeps: two words each in an invocation's own
/// memory, of which drivers have little.
pub const KEPT_MAX: u32 = 64;

/// A part of a frame, which is timed by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Empties lists and surfaces.
    Clear,
    /// Both passes of stage opaque.
    Opaque,
    /// Stage build.
    Build,
    /// The picture of so many nearest layers, from the lists as they were built.
    Nearest(u32),
    /// Stage sort.
    Sort,
    /// The picture of so many nearest layers, from the sorted lists.
    NearestSorted(u32),
    /// Stage resolve: the picture of all layers, from the sorted lists.
    Resolve,
}

impl Part {
    /// Whether it makes a picture.
    pub fn draws(self) -> bool {
        matches!(
            self,
            Self::Nearest(_) | Self::NearestSorted(_) | Self::Resolve
        )
    }
}

/// The kernels that ship, and those that show so many layers.
pub fn with_layers(sources: Sources, layers: &[u32]) -> Sources {
    let ours = |(name, _): &(&str, &str)| *name == FILE;
    let text = sources.files().find(ours).map(|(_, text)| text.to_owned());
    let text = text.unwrap_or_default();
    layers.iter().fold(sources, |sources, n| {
        let text = text.replacen("LAYERS: u32 = 1u;", &format!("LAYERS: u32 = {n}u;"), 1);
        sources.with(file(*n), text)
    })
}

pub(super) fn file(layers: u32) -> String {
    format!("{FILE}-{layers}")
}

/// Whether every list of up to `longest` nodes is served by [`Part::Nearest`] in one
/// dispatch: a step for each node, and one for each that an insertion moves.
pub fn can_keep(layers: u32, longest: u32) -> bool {
    let [layers, longest] = [layers, longest].map(u64::from);
    layers <= KEPT_MAX.into() && longest * (1 + layers.min(longest)) + layers <= STEPS
}
