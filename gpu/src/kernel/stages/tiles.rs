//! The A-buffer by tiles among the stages.

use super::Stage;

/// Triangles in bins.
pub(super) const BIN: Stage = Stage {
    name: "bin",
    file: "tiles",
    compute: &[
        "bin_count",
        "bin_count_large",
        "bin_parts",
        "bin_sums",
        "bin_offsets",
        "bin_fill",
        "bin_fill_large",
    ],
    fragment: &[],
    contract: "Counts the triangles of each tile of 8 x 8 pixels, adds the counts up to offsets, \
        and fills `binned`: those of tiled.items triangles whose faces are transparent. What is in many \
        tiles goes to `larges` in the first pass, and is shared by workgroups in the second.",
};

/// Lists of a tile, side by side.
pub(super) const JAGGED: Stage = Stage {
    name: "jagged",
    file: "tiles",
    compute: &["jagged_count", "jagged_place", "jagged_fill"],
    fragment: &[],
    contract: "A workgroup for each tile of tiled.items: counts the fragments of each pixel from \
        the triangles tiled.first of its bin on, tiled.count of them; places the lists as jagged \
        diagonals; fills them with key and triangle. Lists of more than 64 lie one after another.",
};

/// Lists in order, and blended.
pub(super) const SHADE: Stage = Stage {
    name: "shade",
    file: "tiles",
    compute: &[
        "shade_sort",
        "shade_runs",
        "shade_merge",
        "shade_8",
        "shade_16",
        "shade_32",
        "shade_64",
        "shade_long",
    ],
    fragment: &[],
    contract: "Puts lists of more than 64 entries in order, in several passes; those of at most \
        8, 16, 32 and 64 in registers, from where they are written back if tiled.stored says so. \
        Blends both into `picture`, in front of the opaque key only.",
};
