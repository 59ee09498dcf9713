//! The stages that kernels implement: where each one's entry points are, and what an
//! invocation of it does.

mod dispatch;
mod layouts;
mod rivals;
mod tiles;
mod vertex;

use super::Stage;

/// Every stage, in the order in which they run.
pub const STAGES: [Stage; 51] = [
    vertex::TRANSFORM,
    vertex::CLIP,
    vertex::SNAP,
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
    rivals::PEEL,
    rivals::DUAL,
    rivals::ALPHA,
    rivals::WEIGHTED,
    rivals::DENSITY,
    rivals::DEFOCUS,
    rivals::REDUCED,
    tiles::BIN,
    tiles::JAGGED,
    tiles::SHADE,
    tiles::LOCAL,
    tiles::LINKED,
    layouts::BUCKET,
    layouts::PRECALC,
    layouts::RANK,
    layouts::PACKED,
    layouts::REGIONS,
    layouts::ORDERED,
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
            Third, 64 cells a workgroup: their lists in order, or the length of one in unfinished if \
            it exceeds 512. If any does, entry i of a longer list to merged. Fourth: each run of 64 \
            entries is in order there. Fifth, for cells.run of 64, 128, and so on: two such runs become one.",
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
    Stage {
        name: "gbuffer",
        file: "rsm",
        compute: &["gbuffer"],
        fragment: &[],
        contract: "seen[i] is the point of triangle sources[nearest[i]] that pixel i of the view \
            sees, snapped to the nearest integers, kept in the triangle's box, and moved \
            parameters.offset steps off its face to the side that is seen; its face is twice the \
            triangle, and 1 more if its normal points away from the viewer. Where nearest[i] is \
            0xffffffff, so is the face.",
    },
    Stage {
        name: "rsm",
        file: "rsm",
        compute: &["rsm"],
        fragment: &[],
        contract: "lights[i] is what texel i of the light's map sees, as for gbuffer, with the \
            unit normal on that side; intensities[i] is its weight times the lamp's strength \
            times the face's colour.",
    },
    Stage {
        name: "place",
        file: "rsm",
        compute: &["place"],
        fragment: &[],
        contract: "places[i] is the texel of the light's map and the depth key of the point of \
            seen[i], both rounded down; known is 0 for what is not in front of the light, and \
            where nothing is seen.",
    },
    Stage {
        name: "direct",
        file: "rsm",
        compute: &["direct"],
        fragment: &[],
        contract: "lit[i] is the irradiance of seen[i] by the lamp, and 1, if it faces the lamp, \
            lies in its map, and is at most parameters.bias keys behind keys there; else zeros.",
    },
    Stage {
        name: "gather",
        file: "rsm",
        compute: &["gather"],
        fragment: &[],
        contract: "Adds to all_light[i] the irradiance of seen[i] by the texels of its kernel's \
            parameters.rows rows from parameters.first on; row 0 starts from zero. Only texels \
            count that face the point and are faced by it.",
    },
    Stage {
        name: "block",
        file: "rsm",
        compute: &["block_rays", "block_bits", "block_sum"],
        fragment: &[],
        contract: "First pass: pair parameters.first + i of a pixel of buffer B and a texel of \
            its kernel appends a ray to rays, and a fresh hit, if the texel would give light. \
            After the search, second: the bit of ray i's pair, if it met anything. Third: as \
            gather, of pixel i of buffer B, for texels whose bits are set.",
    },
    Stage {
        name: "blur",
        file: "rsm",
        compute: &["blur"],
        fragment: &[],
        contract: "blurred[i] is the mean of blocked over the pixels of buffer B at most \
            parameters.blur from pixel i that see the same surface.",
    },
    Stage {
        name: "compose",
        file: "rsm",
        compute: &["compose"],
        fragment: &[],
        contract: "picture[i] is the colour of seen[i] times the sum of lit and of all_light \
            less blurred, at least 0: that of the nearest pixel of buffer B around it that sees \
            the same surface, else of the nearest; the background where nothing is seen.",
    },
    Stage {
        name: "layers",
        file: "ldm",
        compute: &[
            "layers_larges",
            "layers_count",
            "layers_count_large",
            "layers_tiles",
            "layers_sums",
            "layers_ends",
            "layers_fill",
            "layers_fill_large",
            "layers_sort",
            "layers_runs",
            "layers_merge",
        ],
        fragment: &[],
        contract: "Before all: triangle i, if its box is longer than told.small along an axis, to \
            larges; unfinished counts them. First and second pass: adds 1 to counts of every pixel \
            of a map that a triangle covers. A workgroup of the first has 64 triangles and 8 maps, and \
            draws the small ones; of the second, 16 of larges and one map, and rows from told.first_row \
            on. Third to fifth, as for scan: the sum of all counts up to and with pixel i, in its place, and \
            of all in counts[told.items]. Sixth and seventh, as the first two: the key of every covered \
            pixel at its count, less 1, unless that is beyond told.capacity. Then, as for fill, lists in \
            order: 64 pixels a workgroup, and the longest in runs.",
    },
    Stage {
        name: "chain",
        file: "ldm",
        compute: &["chain", "chain_large", "chain_sort"],
        fragment: &[],
        contract: "First and second pass, as for layers: puts the key of every covered pixel at the head \
            of its linked list. The counter counts attempts, also those beyond told.capacity, which must \
            touch neither heads nor nodes. Heads start as 0xffffffff, which also ends a list. Third: the \
            list of pixel i in order of key; sets unfinished if it needs another dispatch, before which \
            progress is kept, all zero at first.",
    },
    Stage {
        name: "neighbours",
        file: "ldm",
        compute: &["neighbours"],
        fragment: &[],
        contract: "hits[i], for i below told.maps * told.items: in map told.first_map + i / told.items, \
            the key of receivers[i % told.items], and the nearest keys of its pixel's list before and \
            behind its own band; 0xffffffff where there is none, and beside the map.",
    },
    Stage {
        name: "occlusion",
        file: "ldm",
        compute: &["occlusion"],
        fragment: &[],
        contract: "Adds to opened[i], over told.maps maps, what receivers[i] sees on its side: to whole \
            the weight of a map where nothing blocks, or what blocks is told.most keys away or more; to \
            part its weight times (keys / told.most)^told.power else. With told.most 0 all hits block.",
    },
    Stage {
        name: "environment",
        file: "ldm",
        compute: &["environment"],
        fragment: &[],
        contract: "Adds to light[i], over told.maps maps, the weight of each on whose side nothing blocks \
            receivers[i], times the radiance in skies from there: the first of a map from its direction, \
            the second from the opposite one.",
    },
    Stage {
        name: "mirror",
        file: "ldm",
        compute: &["mirror"],
        fragment: &[],
        contract: "mirrored[i] is, of told.maps maps and what it was, whose map is 0xffffffff at first, the \
            direction on the side of receivers[i] with the largest dot product with its mirror vector, of \
            equals the first: the map, 1 for its opposite direction, the receiver's key, the nearest key \
            there or 0xffffffff, and then the radiance in skies, else 0. views[i] is the vector to the eye; \
            0 finds nothing, as do maps without weight.",
    },
    dispatch::PRIMARY,
    dispatch::INTERSECT,
    dispatch::LOCATE,
    dispatch::LIGHT,
    dispatch::REFLECT,
    dispatch::DEPOSIT,
];
