//! Where the GPU takes over.

/// From which stage on the GPU's own results are used; before it, the spec's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
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
