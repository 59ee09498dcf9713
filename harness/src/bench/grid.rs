//! Grids: how fast they are built, and how fast rays go through them, against the resolution,
//! the scene and the kind of rays; beside Embree and a Rust BVH.
//!
//! From the same triangles and rays on the lattice: the spec on one core; Embree's single rays
//! and `obvhs`' eight-wide tree, each on one core and on all; and every adapter. A *build* is
//! everything from corners to sorted lists and bricks (of a tree, to the tree). Not timed:
//! transfers, compilation, drawing rays. Rounds run all of a scene in turn, every other one
//! backwards; [`WARM_UP`](super::WARM_UP) rounds come before the first that counts.
//!
//! An adapter is measured only if it meets what the spec does with every ray: its any hits are
//! the spec's, so are its closest hits up to their bounds.

mod cpu;
mod gpu;
mod run;
mod scene;

use super::legs::{Legs, Row};

pub use run::{Options, run};

/// The scenes that are measured if none is asked for: a closed mesh of small triangles, one of
/// 202,520, large beside small ones, and needles.
pub const SCENES: [&str; 4] = ["grid/bunny", "grid/dragon", "grid/sponza", "grid/furball"];

/// Cells along each axis, over those that the scene decides.
pub const SCALES: [f64; 3] = [0.5, 1.0, 2.0];

/// Rays of a kind: enough to fill a board for milliseconds.
pub const RAYS: u32 = 1 << 20;

/// Of these, what legs on a CPU trace in a round.
pub const RAYS_OF_CPU: usize = 1 << 15;

/// What the page says of how it was measured.
pub const HOW: &str = "Medians of rounds after two to warm up, with minimum and maximum; a round runs all legs \
    of a scene,\nevery other one backwards, and ratios are taken within a round. *build*: from corners to sorted lists \
    and bricks,\nor to the tree, in triangles; *any* and *closest*: rays of a kind, in rays. From the same triangles \
    and rays,\nwithout transfers and compilation; a software driver has all cores. *random*: segments between random\n\
    points in and around the box; *aimed*: from such points at points on triangles, half of them segments;\n*view*: from \
    one point through a raster, row by row.";

/// The stem of the files.
pub fn stem(legs: &Legs) -> String {
    format!("grid-{}-{}", legs.date, legs.machine.slug)
}

/// What a row is about.
fn row(
    taken: &super::legs::Taken,
    scene: &str,
    what: &str,
    against: Option<&super::legs::Taken>,
) -> Row {
    taken.row(scene, what, against.map(|other| (other, None)))
}
