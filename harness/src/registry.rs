//! What a stage is called, and where each leg keeps it: the function of the spec, the
//! entry points in WGSL, the name on the command line and in results.
//!
//! `tests/registry.rs` holds it against the code in both directions: nothing listed
//! is absent, and no stage of the spec and no entry point is missing here.

mod families;

pub use families::FAMILIES;

/// A group of stages with one stem everywhere: `spec/src/F.rs`, `gpu/src/F.rs`,
/// `gpu/src/F.wgsl` (those two once a stage has a twin), `tests/laws/F.rs`, `corpus/F`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Family {
    /// The stem.
    pub name: &'static str,
    /// WGSL files beside its own that have entry points of its stages.
    pub files: &'static [&'static str],
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
    /// Rays in queues: a scene with a `[dispatch]`.
    Traced,
}

/// A stage. Its name is that of the spec's function, of its pass in a plan, and, unless it is
/// one of [`RIVALS`], of the value of `--gpu-from` that begins with it.
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
    /// Entry points of the family's WGSL files, one for each pass.
    Entries(&'static [&'static str]),
    /// None, and why.
    None(&'static str),
}

/// The file of the vertex entry points of every pipeline on the fragment path, and the
/// entry point for the snapped triangles.
pub const PLACE: &str = "place";

/// The other: the driver divides, clips and snaps (`--vertex hardware`).
pub const PLACE_HANDED: &str = "place_handed";

/// Kernels that are no stage by themselves: `triptych bench` compares and measures them, or they
/// are a stage's in some scenes.
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
        file: "fans",
        over: Some("vertex"),
        entries: &["fan_count", "fan_snap"],
        spec: None,
    },
    Measured {
        file: "fan_scan",
        over: None,
        entries: &["fan_parts", "fan_sums", "fan_offsets"],
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
    // Stage resolve, where pixels have several samples: in place of its one kernel.
    Measured {
        file: "multisample",
        over: Some("abuffer"),
        entries: &[
            "resolve_pixel",
            "key_samples",
            "resolve_sample",
            "resolve_mean",
        ],
        spec: Some("resolve_samples"),
    },
    // The same of lists in other layouts: what the stages' own kernels do for one sample.
    Measured {
        file: "layouts_samples",
        over: Some("layouts"),
        entries: &["rank_blend_samples"],
        spec: None,
    },
    Measured {
        file: "packed_samples",
        over: Some("packed"),
        entries: &["packed_resolve_samples", "packed_taken_samples"],
        spec: None,
    },
    Measured {
        file: "regions_samples",
        over: Some("regions"),
        entries: &["regions_blend_samples"],
        spec: None,
    },
    Measured {
        file: "ordered_samples",
        over: Some("ordered"),
        entries: &["ordered_blend_samples"],
        spec: None,
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

/// The stages of a chain, in the order in which they run.
pub fn stages_of(chain: Chain) -> impl Iterator<Item = &'static Stage> {
    let families = FAMILIES.iter().filter(move |family| family.chain == chain);
    families.flat_map(|family| family.stages)
}

/// Every stage, in the order in which they run.
pub fn stages() -> impl Iterator<Item = &'static Stage> {
    FAMILIES.iter().flat_map(|family| family.stages)
}

/// The stages that need no lists, or do more with them than the paper's: the rivals of the
/// A-buffer. They run beside it, from the same triangles and surfaces.
pub const RIVALS: [&str; 7] = [
    "peel", "dual", "alpha", "weighted", "density", "defocus", "reduced",
];

/// The stages of a frame that hand on what they make: not what takes the place of linked lists.
pub fn handing_on() -> impl Iterator<Item = &'static Stage> {
    let is_apart = |family: &Family| ["tiles", "layouts"].contains(&family.name);
    let own = move |family: &&Family| family.chain == Chain::Frame && !is_apart(family);
    let stages = FAMILIES.iter().filter(own).flat_map(|family| family.stages);
    stages.filter(|stage| !RIVALS.contains(&stage.name))
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
