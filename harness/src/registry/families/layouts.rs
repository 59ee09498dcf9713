//! The A-buffer's lists in other layouts among the families.

use super::per_pixel;
use crate::registry::{Chain, Family, Stage, Twin};

/// The family.
pub(super) const LAYOUTS: Family = Family {
    name: "layouts",
    files: &["ordered", "packed", "regions"],
    chain: Chain::Frame,
    stages: &[
        Stage {
            name: "bucket",
            compute: Twin::Entries(&["bucket_clear", "bucket"]),
            fragment: Twin::Entries(&["bucket_fragment"]),
        },
        Stage {
            name: "precalc",
            compute: Twin::Entries(&[
                "precalc_count",
                "precalc_parts",
                "precalc_sums",
                "precalc_offsets",
                "precalc_fill",
            ]),
            fragment: Twin::Entries(&["precalc_count_fragment", "precalc_fill_fragment"]),
        },
        per_pixel(
            "rank",
            &["rank_lists", "rank_runs", "rank_merge", "rank_blend"],
        ),
        Stage {
            name: "packed",
            compute: Twin::Entries(&["packed", "packed_sort", "packed_resolve"]),
            fragment: Twin::Entries(&["packed_fragment"]),
        },
        Stage {
            name: "regions",
            compute: Twin::Entries(&["regions_clear", "regions", "regions_blend"]),
            fragment: Twin::Entries(&["regions_fragment"]),
        },
        Stage {
            name: "ordered",
            compute: Twin::Entries(&["ordered_clear", "ordered", "ordered_ties", "ordered_blend"]),
            fragment: Twin::Entries(&["ordered_fragment", "ordered_ties_fragment"]),
        },
    ],
    no_corpus: Some("every scene of a frame goes through it"),
};
