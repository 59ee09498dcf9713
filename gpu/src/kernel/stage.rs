//! The stages that kernels implement: where each one's entry points are, and what an
//! invocation of it does.

/// A stage as far as its kernels go.
#[derive(Debug, PartialEq, Eq)]
pub struct Stage {
    /// Its name, as in the spec and on the command line.
    pub name: &'static str,
    /// The WGSL file that ships its entry points.
    pub file: &'static str,
    /// Its compute kernels, in the order in which they run.
    pub compute: &'static [&'static str],
    /// Its fragment kernels; none where the stage needs no rasteriser.
    pub fragment: &'static [&'static str],
    /// What one invocation does, in sentences.
    pub contract: &'static str,
}

const ROW: &str = "Compute: item `i` below frame.items is one row of one triangle: of the \
    last entry of `work` from frame.work_first, frame.work_count of them, whose y is at most i; \
    its x is the triangle, whose corners are nine numbers of `corners`. Fragment: the hardware's \
    rasteriser calls it for every covered pixel, with the triangle at location 0.";

/// Every stage, in the order in which they run.
pub const STAGES: [Stage; 13] = [
    Stage {
        name: "transform",
        file: "vertex",
        compute: &["transform"],
        fragment: &[],
        contract: "positions[frame.work_first + i] is the product of the vertex and the four \
            rows of its instance's matrix, for i below frame.items.",
    },
    Stage {
        name: "clip",
        file: "vertex",
        compute: &["clip"],
        fragment: &[],
        contract: "Cuts triangle i of frame.items at the depth range and the guard rectangle; \
            counts[i] corners go to polygons[9 i ..].",
    },
    Stage {
        name: "snap",
        file: "vertex",
        compute: &["snap"],
        fragment: &[],
        contract: "Rounds the counts[i] corners of polygon i to the grid of frame.bits; three \
            numbers each, from snapped[3 offsets[i]].",
    },
    Stage {
        name: "cover",
        file: "raster",
        compute: &["cover"],
        fragment: &["cover_fragment"],
        contract: "Appends every covered pixel to `stream`; the counter counts also what no \
            longer fits frame.capacity.",
    },
    Stage {
        name: "opaque",
        file: "abuffer",
        compute: &["opaque_nearest", "opaque_first"],
        fragment: &["opaque_nearest_fragment", "opaque_first_fragment"],
        contract: "First pass: the smallest depth key of every pixel. Second pass: the smallest \
            triangle with that key. Both buffers start as 0xffffffff.",
    },
    Stage {
        name: "build",
        file: "abuffer",
        compute: &["build"],
        fragment: &["build_fragment"],
        contract: "Puts every fragment, unless frame.depth_test says that one at or behind the \
            opaque key is hidden, into its pixel's list. The counter counts attempts, also those \
            beyond frame.capacity, which must touch neither heads nor nodes. Heads start as \
            0xffffffff, which also ends a list.",
    },
    Stage {
        name: "sort",
        file: "abuffer",
        compute: &["sort"],
        fragment: &[],
        contract: "Relinks the list of pixel i: nearest key first, ties by prim. Sets \
            progress.unfinished if it needs another dispatch, before which progress.pixels is \
            kept; all zero at first.",
    },
    Stage {
        name: "resolve",
        file: "abuffer",
        compute: &["resolve"],
        fragment: &[],
        contract: "Blends the sorted list of pixel i over the opaque surface or the background \
            into picture[i], in front of the opaque key only. Sets progress.unfinished if it \
            needs another dispatch.",
    },
    Stage {
        name: "count",
        file: "grid",
        compute: &["count", "count_chunks"],
        fragment: &[],
        contract: "First pass: adds 1 to counts of every cell that lists triangle i of \
            cells.items: those that its box touches when widened. A box that is too large for one \
            invocation may be left to chunks, of which cells.chunks have room; unfinished, 0 at \
            first, counts them. Second pass, if it is not 0: a workgroup for each of cells.items \
            chunks. i counts invocations, or workgroups, in rows of num_workgroups.x workgroups.",
    },
    Stage {
        name: "scan",
        file: "grid",
        compute: &["scan_tiles", "scan_sums", "scan"],
        fragment: &[],
        contract: "offsets[c] is the sum of all counts before cell c, offsets[cells.items] of \
            all, or 0xffffffff where 32 bits cannot hold it. First pass: sums of tiles of 1,024 \
            cells. Second pass, one workgroup: sums of all tiles before. Third: offsets.",
    },
    Stage {
        name: "fill",
        file: "grid",
        compute: &[
            "fill",
            "fill_chunks",
            "fill_sort",
            "fill_runs",
            "fill_merge",
        ],
        fragment: &[],
        contract: "First and second pass, as for count: triangle i into the run of every cell \
            that lists it, unless its address is beyond cells.capacity; counts may be used up. \
            Third: the list of cell i in order, or its length in unfinished if it exceeds 64. If \
            any does, entry i of a longer list to merged. Fourth: each run of 64 entries is in \
            order there. Fifth, for cells.run of 64, 128, and so on: two such runs become one.",
    },
    Stage {
        name: "link",
        file: "grid",
        compute: &["link", "link_chunks"],
        fragment: &[],
        contract: "Puts triangle i at the head of the linked list of every cell that lists it, \
            in two passes as for count. The counter counts attempts, also those beyond \
            cells.capacity, which must touch neither heads nor entries. Heads start as 0xffffffff, which also ends a \
            list.",
    },
    Stage {
        name: "trace",
        file: "grid",
        compute: &["trace_bricks", "trace"],
        fragment: &[],
        contract: "First pass: the 64 bits of brick i, one for each cell with a list. Second: \
            what ray i meets, any triangle if cells.any is 1, or the nearest with its time, in hits[i]; its state \
            starts as 0xffffffff and ends as 0xfffffffe. Sets unfinished if it needs another \
            dispatch, before which hits are kept.",
    },
];

impl Stage {
    /// The stage of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        STAGES.iter().find(|stage| stage.name == name)
    }

    /// What one invocation does, in full.
    pub fn invocation(&self) -> String {
        match self.fragment {
            [] => self.contract.to_owned(),
            _ => format!("{} {ROW}", self.contract),
        }
    }
}
