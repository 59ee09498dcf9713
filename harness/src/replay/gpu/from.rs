//! Where the GPU takes over.

use clap::ValueEnum;

/// From which stage on the GPU's own results are used; before it, the spec's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum From {
    /// Everything is the GPU's own, end to end
    Transform,
    /// The spec's positions, rounded to f32
    Clip,
    /// The spec's polygons, rounded to f32
    Snap,
    /// The spec's triangles; the vertex stages are compared beside it
    #[default]
    Cover,
    /// The spec's triangles, without a comparison of coverage alone
    Opaque,
    /// The spec's triangles and opaque surfaces
    Build,
    /// The spec's unsorted lists
    Sort,
    /// The spec's sorted lists
    Resolve,
}

impl From {
    /// Why a row of a stage before compares nothing.
    pub const GIVEN: &str = "the spec's result is used (--gpu-from)";

    /// All of them, in the order in which the stages run.
    pub fn all() -> &'static [Self] {
        Self::value_variants()
    }

    /// The stage's name.
    pub fn name(self) -> String {
        let value = self.to_possible_value().expect("no stage is hidden");
        value.get_name().to_owned()
    }

    /// The first of the vertex stages that runs on the GPU; `None` if none does. The
    /// default runs them for a comparison of their own, and hands on the spec's triangles.
    pub fn vertex(self) -> Option<Self> {
        match self {
            Self::Transform | Self::Cover => Some(Self::Transform),
            Self::Clip | Self::Snap => Some(self),
            Self::Opaque | Self::Build | Self::Sort | Self::Resolve => None,
        }
    }
}
