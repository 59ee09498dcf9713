//! Grids: how fast they are built, and how fast rays go through them, against the resolution,
//! the scene and the kind of rays; beside Embree and a Rust BVH.
//!
//! From the same triangles and rays on the lattice: the spec on one core; Embree's single rays
//! and `obvhs`' eight-wide tree, each on one core and on all; and every adapter. A *build* is
//! everything from corners to sorted lists and bricks (of a tree, to the tree). Not timed:
//! transfers, compilation, drawing rays. Rounds run all of a scene in turn, every other one
//! backwards; [`WARM_UP`](super::WARM_UP) rounds come before the first that counts.
//!
//! An adapter is measured only if it meets what the spec does, with every ray that is timed, before
//! the first round and after the last: its lists are the spec's, its any hits are, and its closest
//! hits are up to their bounds. Embree is measured only if it disagrees on no ray that its vote
//! judges, and `obvhs` if it decides no more rays unlike the spec than that vote leaves out.

mod asking;
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

/// Rounds that count, if no other number is asked for.
pub const RUNS: u32 = 9;

/// Rays of a kind: enough to fill a board for milliseconds.
pub const RAYS: u32 = 1 << 20;

/// Of these, what Embree and `obvhs` trace in a round: some for each of many threads.
pub const RAYS_OF_CPU: usize = 1 << 15;

/// Of these, what the spec traces in a round: it takes ten times as long for a ray.
pub const RAYS_OF_SPEC: usize = 1 << 12;

/// Of these, what software drivers trace in a round.
pub const RAYS_OF_SOFTWARE: usize = 1 << 12;

/// What the page says of how it was measured.
pub const HOW: &str = "Medians of rounds after two to warm up, with minimum and maximum; a round runs all legs \
    of a scene,\nevery other one backwards, and ratios are taken within a round. *build*: from corners to sorted lists \
    and bricks,\nor to the tree, in triangles; *any* and *closest*: rays of a kind, in rays. From the same triangles \
    and rays,\nwithout transfers and compilation; a software driver has all cores. *random*: segments between random\n\
    points in and around the box; *aimed*: from such points at points on triangles, half of them segments;\n*view*: from \
    one point through a raster, row by row.\n\n*unlike the spec*: an adapter's lists, and both hits of every ray that it \
    is timed with, are compared with the spec's\nbefore the first round and after the last; closest hits may differ within \
    their bounds, and one that differs otherwise\nis not measured. Embree and obvhs round, and decide some rays at edges \
    otherwise: counted are rays of which they say\nthat something is met and the spec that nothing is, or the reverse, and \
    closest hits later than Embree's bounds of times explain.\nEmbree is not measured if it disagrees on a ray that is not in class edge, nor is \
    obvhs, which has no bound of its own, if it\ndecides more rays unlike the spec than are in class edge for Embree. \
    *memory*: of rays the grid or tree with its\ntriangles; of an adapter's build all that it works on. *of bound*: the least time \
    for what must be moved, at the rates\nthat the adapter was measured to copy or count with, over the median; of rays that \
    is 64 bytes each, for itself and its\nhit, as if the grid cost nothing.";

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
