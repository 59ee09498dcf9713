//! The vertex stages among the stages.

use super::Stage;

/// Vertices to clip space.
pub(super) const TRANSFORM: Stage = Stage {
    name: "transform",
    file: "vertex",
    compute: &["transform"],
    fragment: &[],
    contract: "positions[frame.work_first + i] is the product of the vertex and the four \
        rows of its instance's matrix, for i below frame.items.",
};

/// Triangles cut at the depth range and the guard rectangle.
pub(super) const CLIP: Stage = Stage {
    name: "clip",
    file: "vertex",
    compute: &["clip"],
    fragment: &[],
    contract: "Cuts triangle i of frame.items at the depth range and the guard rectangle; \
        counts[i] corners go to polygons[9 i ..].",
};

/// Corners on the sub-pixel grid.
pub(super) const SNAP: Stage = Stage {
    name: "snap",
    file: "vertex",
    compute: &["snap"],
    fragment: &[],
    contract: "Rounds the counts[i] corners of polygon i to the grid of frame.bits; three \
        numbers each, from snapped[3 offsets[i]].",
};
