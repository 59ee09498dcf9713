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
        "bin_sort",
    ],
    fragment: &[],
    contract: "Counts the triangles of each tile of 8 x 8 pixels, adds the counts up to offsets, \
        and fills `binned`: those of tiled.items triangles whose faces are transparent. What is in many \
        tiles goes to `larges` in the first pass, and is shared by workgroups in the second. The last \
        pass puts bins of at most 512 in order, nearest first at about the tile's middle.",
};

/// Lists of a tile, side by side.
pub(super) const JAGGED: Stage = Stage {
    name: "jagged",
    file: "tiles",
    compute: &["jagged_count", "jagged_place", "jagged_fill"],
    fragment: &[],
    contract: "A workgroup for each tile of tiled.items: counts the fragments of each pixel from \
        the triangles tiled.first of its bin on, tiled.count of them; places the lists as jagged \
        diagonals: entry i of a list is at start + rows[rows[tile] + i], where rows[tile] is tiled.items \
        + bins[tile]; of a tile with one of more than 256, each list is a run of its own, and marked. \
        Fills them with key and triangle, and marks those that came in order.",
};

/// Lists in order, and blended.
pub(super) const SHADE: Stage = Stage {
    name: "shade",
    file: "tiles",
    compute: &[
        "shade_sort",
        "shade_runs",
        "shade_merge",
        "shade_ordered",
        "shade_8",
        "shade_16",
        "shade_32",
        "shade_64",
        "shade_long",
    ],
    fragment: &[],
    contract: "Blends marked lists of up to 16,384 entries as they are. Puts others in order: runs \
        of their own, and lists of more than 64 entries, in several passes; rows of at most 8, 16, 32 and \
        64 in registers, from where they are written back if tiled.stored says so. Blends all into \
        `picture`, in front of the opaque key only.",
};

/// The picture without lists in memory.
pub(super) const LOCAL: Stage = Stage {
    name: "local",
    file: "local",
    compute: &["local"],
    fragment: &[],
    contract: "A workgroup for each tile of tiled.items, of which it draws the whole bin, of at most \
        tiled.count triangles: blends the fragments of each pixel into `picture`, nearest first, and \
        writes how many they are and their digest to `digests`. A tile of which it cannot is left \
        as it is, and digests.left counts it; of others the highest bit of the first pixel's count is set.",
};

/// Linked lists, a region for each tile.
pub(super) const LINKED: Stage = Stage {
    name: "linked",
    file: "linked",
    compute: &["linked", "linked_sort", "linked_blend"],
    fragment: &[],
    contract: "A workgroup for each tile of tiled.items: links the fragments of each pixel from the \
        triangles tiled.first of its bin on, tiled.count of them, in nodes of its region, of which it \
        counts all attempts and stores as many as there is room for; says which lists came in order. \
        Second pass: relinks those that did not. Third: blends all into `picture`.",
};
