//! What a stage is called, and where each leg keeps it: the function of the spec, the
//! entry points in WGSL, the name on the command line and in results.
//!
//! `tests/registry.rs` holds it against the code in both directions: nothing listed
//! is absent, and no stage of the spec and no entry point is missing here.

/// A group of stages with one stem everywhere: `spec/src/F.rs`, `gpu/src/F.rs`,
/// `gpu/src/F.wgsl` (those two once a stage has a twin), `tests/laws/F.rs`, `corpus/F`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Family {
    /// The stem.
    pub name: &'static str,
    /// Which scenes it is for.
    pub chain: Chain,
    /// Its stages, in the order in which they run.
    pub stages: &'static [Stage],
    /// Why it has no scenes of its own, if it has none.
    pub no_corpus: Option<&'static str>,
}

/// What a scene is replayed as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chain {
    /// Triangles to a picture.
    Frame,
    /// Triangles in a grid, and rays at them: a scene with a `[grid]`.
    Rays,
    /// Indirect light and its shadows: a scene with an `[rsm]`.
    Indirect,
    /// Layered depth maps: a scene with an `[ldm]`.
    Maps,
}

/// A stage. Its name is that of the spec's function, of its pass in a plan, and of the
/// value of `--gpu-from` that begins with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stage {
    /// The name.
    pub name: &'static str,
    /// On the compute path.
    pub compute: Twin,
    /// On the fragment path, after the vertex entry point [`PLACE`].
    pub fragment: Twin,
}

/// A stage's counterpart on a path of the GPU leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Twin {
    /// Entry points of the family's WGSL file, one for each pass.
    Entries(&'static [&'static str]),
    /// None, and why.
    None(&'static str),
}

/// The file of the vertex entry points of every pipeline on the fragment path, and the
/// entry point for the snapped triangles.
pub const PLACE: &str = "place";

/// The other: the driver divides, clips and snaps (`--vertex hardware`).
pub const PLACE_HANDED: &str = "place_handed";

/// All families, in the order in which they run.
pub const FAMILIES: &[Family] = &[
    Family {
        name: "vertex",
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
        ],
        no_corpus: None,
    },
    Family {
        name: "grid",
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
];

/// Kernels that are no stage of a replay: `triptych bench` compares and measures them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measured {
    /// The WGSL file, in which no other has entry points.
    pub file: &'static str,
    /// A file that it imports whose own entry points are listed elsewhere.
    pub over: Option<&'static str>,
    /// Its compute entry points.
    pub entries: &'static [&'static str],
    /// The function of the spec that says what they compute; its documentation begins
    /// with "Technique" and its name. `None`: none does; they compute nothing that is shown, or
    /// what laws hold against closed forms.
    pub spec: Option<&'static str>,
}

/// All of them.
pub const MEASURED: &[Measured] = &[
    Measured {
        file: "ceiling",
        over: None,
        entries: &["copy", "exchange"],
        spec: None,
    },
    Measured {
        file: "hbao",
        over: None,
        entries: &["prepare", "horizons", "denoise"],
        spec: None,
    },
    Measured {
        file: "nearest",
        over: Some("abuffer"),
        entries: &[
            "clear_lists",
            "clear_progress",
            "nearest_layers",
            "nearest_layers_sorted",
        ],
        spec: Some("nearest_layers"),
    },
];

/// Names of result rows that are no stage, and what they compare.
pub const ROWS: &[(&str, &str)] = &[
    ("expect", "the spec with a scene's closed-form answers"),
    ("overflow", "attempts that ran out of nodes"),
    ("end to end", "all stages from the GPU's own vertices"),
    (
        "vertex",
        "lists from the GPU's own vertices with the spec's own (--vertex gpu)",
    ),
    ("world", "coverage with Embree's in world space"),
    ("plan", "a leg with and without skipping"),
    ("leg", "a leg that could not run"),
    ("all", "a scene that could not be replayed"),
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

const fn of_maps(name: &'static str, entries: &'static [&'static str]) -> Stage {
    Stage {
        name,
        compute: Twin::Entries(entries),
        fragment: Twin::None("works on maps, pixels and points, in compute kernels"),
    }
}

/// The stages of a chain, in the order in which they run.
pub fn stages_of(chain: Chain) -> impl Iterator<Item = &'static Stage> {
    let families = FAMILIES.iter().filter(move |family| family.chain == chain);
    families.flat_map(|family| family.stages)
}

/// Every stage, in the order in which they run.
pub fn stages() -> impl Iterator<Item = &'static Stage> {
    FAMILIES.iter().flat_map(|family| family.stages)
}

/// Whether a result row may be called so.
pub fn names_row(name: &str) -> bool {
    stages().any(|stage| stage.name == name) || ROWS.iter().any(|(row, _)| *row == name)
}

impl Family {
    /// Whether any of its stages runs on a GPU.
    pub fn has_twins(&self) -> bool {
        let twins = self.stages.iter().flat_map(|s| [s.compute, s.fragment]);
        twins.into_iter().any(|twin| !twin.entries().is_empty())
    }
}

impl Twin {
    /// Entry points; none where there is no twin.
    pub fn entries(self) -> &'static [&'static str] {
        match self {
            Self::Entries(entries) => entries,
            Self::None(_) => &[],
        }
    }
}
