//! The A-buffer's lists in other layouts among the stages.

use super::Stage;

/// An array for each pixel.
pub(super) const BUCKET: Stage = Stage {
    name: "bucket",
    file: "layouts",
    compute: &["bucket_clear", "bucket"],
    fragment: &["bucket_fragment"],
    contract: "An entry is a depth key, and a triangle times 256 plus a mask, of a fragment as build stores \
        it. First pass: counts[p] is 0. Second: those from listing.from to before listing.until go to listed[listing.entries p + n] of pixel p, where n is \
        what counts[p] was before 1 is added, unless n is listing.entries or more.",
};

/// Runs of one array.
pub(super) const PRECALC: Stage = Stage {
    name: "precalc",
    file: "layouts",
    compute: &[
        "precalc_count",
        "precalc_parts",
        "precalc_sums",
        "precalc_offsets",
        "precalc_fill",
    ],
    fragment: &["precalc_count_fragment", "precalc_fill_fragment"],
    contract: "First pass: adds 1 to counts[p] for every fragment that build stores. Second to fourth, as \
        for scan: offsets[p] is the sum of all counts before, offsets[pixels] of all. Fifth: entries, as \
        for bucket, into each pixel's run, unless that is beyond frame.capacity; counts may be used up.",
};

/// Either in order, and blended.
pub(super) const RANK: Stage = Stage {
    name: "rank",
    file: "layouts",
    compute: &["rank_lists", "rank_runs", "rank_merge", "rank_blend"],
    fragment: &[],
    contract: "The entries of pixel p are the first counts[p] of listing.entries from listing.entries p on, \
        or, where that is 0, its run. First: 64 lists a workgroup in order, unless one exceeds 512. Second, for entry i of \
        listing.items: each run of 64 entries of a longer list in order in merged. Third, for listing.run of 64, 128, \
        and so on: two such runs become one. Fourth: the entries from listing.first on, 16,384 at most, \
        under picture[p], and listing.layers of a list at most; flag 1 begins with nothing, flag 2 ends with what \
        lies behind; with flag 4, offsets[p] of them have been shown, and flag 8 sets that for a later pass.",
};

/// Nodes of 16 bytes.
pub(super) const PACKED: Stage = Stage {
    name: "packed",
    file: "packed",
    compute: &["packed", "packed_sort", "packed_resolve"],
    fragment: &["packed_fragment"],
    contract: "First pass: as build, into nodes of four words: the colour in four bytes, the key, a \
        triangle times 256 plus a mask, and the next node's address plus 1. Heads are addresses plus 1 as \
        well; 0 is no node. Second and third: as sort and resolve, of listing.layers nodes at most. The third \
        takes each head that it reads, and the counter, so that the next frame begins with empty lists.",
};

/// Nodes of several counters.
pub(super) const REGIONS: Stage = Stage {
    name: "regions",
    file: "regions",
    compute: &["regions_clear", "regions", "regions_blend"],
    fragment: &["regions_fragment"],
    contract: "First pass: empty lists, and counters of 0. Second: as build, with a counter for each of listing.regions regions of frame.capacity nodes. Which \
        region a fragment takes a node of is left open; an address is the region times frame.capacity \
        plus what its counter was. What exceeds it is counted, and touches neither heads nor nodes. Third: as resolve, \
        once stage sort has put the lists in order; listing.layers nodes of each at most.",
};

/// Lists in order while they are built.
pub(super) const ORDERED: Stage = Stage {
    name: "ordered",
    file: "ordered",
    compute: &["ordered_clear", "ordered", "ordered_ties", "ordered_blend"],
    fragment: &["ordered_fragment", "ordered_ties_fragment"],
    contract: "First pass: listing.items links and the counter are 0xffffffff and 0, all nodes behind every \
        fragment. links[p] is the first node of pixel p, links[listing.links + n] the next one of node n. \
        Second: keys, as the fragments that build stores have them, into nodes along the links, in \
        rising order; new ones by the counter, which counts those beyond frame.capacity. Third: of \
        each key the triangle and mask, in rising order. Of a list, listing.layers nodes are kept, the nearest. \
        Fourth: these over what lies behind.",
};
