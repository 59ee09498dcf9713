//! The table of all stages, by family.

mod layouts;

use super::{Chain, Family, Stage, Twin};

/// All families, in the order in which they run.
pub const FAMILIES: &[Family] = &[
    Family {
        name: "vertex",
        files: &[],
        chain: Chain::Frame,
        stages: &[
            vertex("transform", &["transform"]),
            vertex("clip", &["clip"]),
            vertex("snap", &["snap"]),
        ],
        no_corpus: Some("every scene of the other families goes through it"),
    },
    Family {
        name: "raster",
        files: &[],
        chain: Chain::Frame,
        stages: &[Stage {
            name: "cover",
            compute: Twin::Entries(&["cover"]),
            fragment: Twin::Entries(&["cover_fragment"]),
        }],
        no_corpus: None,
    },
    Family {
        name: "abuffer",
        files: &[
            "alpha", "defocus", "density", "dual", "peel", "reduced", "weighted",
        ],
        chain: Chain::Frame,
        stages: &[
            Stage {
                name: "opaque",
                compute: Twin::Entries(&["opaque_nearest", "opaque_first"]),
                fragment: Twin::Entries(&["opaque_nearest_fragment", "opaque_first_fragment"]),
            },
            Stage {
                name: "build",
                compute: Twin::Entries(&["build"]),
                fragment: Twin::Entries(&["build_fragment"]),
            },
            per_pixel("sort", &["sort"]),
            per_pixel("resolve", &["resolve"]),
            Stage {
                name: "peel",
                compute: Twin::Entries(&[
                    "peel_clear",
                    "peel_nearest",
                    "peel_first",
                    "peel",
                    "peel_behind",
                ]),
                fragment: Twin::Entries(&["peel_nearest_fragment", "peel_first_fragment"]),
            },
            Stage {
                name: "dual",
                compute: Twin::Entries(&[
                    "dual_clear",
                    "dual_nearest",
                    "dual_first",
                    "dual",
                    "dual_behind",
                ]),
                fragment: Twin::Entries(&["dual_nearest_fragment", "dual_first_fragment"]),
            },
            Stage {
                name: "alpha",
                compute: Twin::Entries(&[
                    "alpha_clear",
                    "alpha_next",
                    "alpha",
                    "alpha_single",
                    "alpha_half",
                    "alpha_behind",
                ]),
                fragment: Twin::Entries(&["alpha_fragment"]),
            },
            Stage {
                name: "weighted",
                compute: Twin::Entries(&[
                    "weighted_clear",
                    "weighted",
                    "weighted_behind",
                    "weighted_blended",
                ]),
                fragment: Twin::Entries(&["weighted_fragment"]),
            },
            per_pixel("density", &["density_clear", "density"]),
            per_pixel(
                "defocus",
                &[
                    "defocus_clear",
                    "defocus_layer",
                    "defocus",
                    "defocus_surface",
                    "defocus_behind",
                ],
            ),
            per_pixel(
                "reduced",
                &[
                    "reduced_clear",
                    "reduced_layers",
                    "reduced_nearest",
                    "reduced",
                ],
            ),
        ],
        no_corpus: None,
    },
    Family {
        name: "tiles",
        files: &["linked", "local"],
        chain: Chain::Frame,
        stages: &[
            in_tiles(
                "bin",
                &[
                    "bin_count",
                    "bin_count_large",
                    "bin_parts",
                    "bin_sums",
                    "bin_offsets",
                    "bin_fill",
                    "bin_fill_large",
                    "bin_sort",
                ],
            ),
            in_tiles("jagged", &["jagged_count", "jagged_place", "jagged_fill"]),
            in_tiles(
                "shade",
                &[
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
            ),
            in_tiles("local", &["local"]),
            in_tiles("linked", &["linked", "linked_sort", "linked_blend"]),
        ],
        no_corpus: Some("every scene of a frame goes through it"),
    },
    layouts::LAYOUTS,
    Family {
        name: "grid",
        files: &[],
        chain: Chain::Rays,
        stages: &[
            in_cells("count", &["count", "count_chunks"]),
            in_cells("scan", &["scan_tiles", "scan_sums", "scan"]),
            in_cells(
                "fill",
                &[
                    "fill",
                    "fill_chunks",
                    "fill_sort",
                    "fill_runs",
                    "fill_merge",
                ],
            ),
            in_cells("link", &["link", "link_chunks"]),
            in_cells("trace", &["trace_bricks", "trace"]),
        ],
        no_corpus: None,
    },
    Family {
        name: "rsm",
        files: &[],
        chain: Chain::Indirect,
        stages: &[
            of_pixels("gbuffer", &["gbuffer"]),
            of_pixels("rsm", &["rsm"]),
            of_pixels("place", &["place"]),
            of_pixels("direct", &["direct"]),
            of_pixels("gather", &["gather"]),
            of_pixels("block", &["block_rays", "block_bits", "block_sum"]),
            of_pixels("blur", &["blur"]),
            of_pixels("compose", &["compose"]),
        ],
        no_corpus: None,
    },
    Family {
        name: "ldm",
        files: &[],
        chain: Chain::Maps,
        stages: &[
            of_maps(
                "layers",
                &[
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
            ),
            of_maps("chain", &["chain", "chain_large", "chain_sort"]),
            of_maps("neighbours", &["neighbours"]),
            of_maps("occlusion", &["occlusion"]),
            of_maps("environment", &["environment"]),
            of_maps("mirror", &["mirror"]),
        ],
        no_corpus: None,
    },
    Family {
        name: "dispatch",
        files: &[],
        chain: Chain::Traced,
        stages: &[
            of_rays("primary", &["primary"]),
            of_rays("intersect", &["intersect_queue"]),
            of_rays("locate", &["locate"]),
            of_rays("light", &["light"]),
            of_rays("reflect", &["reflect"]),
            of_rays("deposit", &["deposit"]),
        ],
        no_corpus: None,
    },
];

const fn vertex(name: &'static str, entries: &'static [&'static str]) -> Stage {
    Stage {
        name,
        compute: Twin::Entries(entries),
        fragment: Twin::None("the vertex stages run in compute kernels on both paths"),
    }
}

const fn per_pixel(name: &'static str, entries: &'static [&'static str]) -> Stage {
    Stage {
        name,
        compute: Twin::Entries(entries),
        fragment: Twin::None("works on pixels, not on triangles: one kernel serves both paths"),
    }
}

const fn in_tiles(name: &'static str, entries: &'static [&'static str]) -> Stage {
    Stage {
        name,
        compute: Twin::Entries(entries),
        fragment: Twin::None("tiles are drawn by workgroups, not by the hardware's rasteriser"),
    }
}

const fn in_cells(name: &'static str, entries: &'static [&'static str]) -> Stage {
    Stage {
        name,
        compute: Twin::Entries(entries),
        fragment: Twin::None("works on triangles, cells and rays, not on fragments"),
    }
}

const fn of_pixels(name: &'static str, entries: &'static [&'static str]) -> Stage {
    Stage {
        name,
        compute: Twin::Entries(entries),
        fragment: Twin::None("works on pixels and texels that know their triangle"),
    }
}

const fn of_rays(name: &'static str, entries: &'static [&'static str]) -> Stage {
    Stage {
        name,
        compute: Twin::Entries(entries),
        fragment: Twin::None("works on rays, in compute kernels"),
    }
}

const fn of_maps(name: &'static str, entries: &'static [&'static str]) -> Stage {
    Stage {
        name,
        compute: Twin::Entries(entries),
        fragment: Twin::None("works on maps, pixels and points, in compute kernels"),
    }
}
