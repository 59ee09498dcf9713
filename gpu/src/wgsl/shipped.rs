//! The files that ship.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::{Sources, network};

macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../", $name, ".wgsl")))),*]
    };
}

/// Names and texts.
const FILES: &[(&str, &str)] = shipped![
    "abuffer",
    "abuffer_samples",
    "alpha",
    "asked",
    "bin",
    "bricks",
    "ceiling",
    "cells",
    "coarse",
    "counter",
    "covered",
    "covered_samples",
    "cover",
    "defocus",
    "density",
    "depth",
    "digest",
    "dispatch",
    "draw",
    "drawn",
    "drawn_samples",
    "dual",
    "early",
    "early_samples",
    "entry",
    "fan_scan",
    "fans",
    "first",
    "first_exact",
    "followed",
    "followed_samples",
    "frame",
    "grid",
    "grid_exact",
    "hbao",
    "item",
    "jagged",
    "jagged_run",
    "lamp",
    "layouts",
    "layouts_samples",
    "ldm",
    "linked",
    "linked_samples",
    "listing",
    "lit",
    "local",
    "local_samples",
    "located",
    "long",
    "maps",
    "march",
    "mean",
    "meet",
    "mirror",
    "mirrored",
    "multisample",
    "near",
    "near_wide",
    "nearest",
    "opened",
    "ordered",
    "ordered_samples",
    "overlap",
    "packed",
    "packed_samples",
    "parameters",
    "peel",
    "place",
    "raster",
    "raster_samples",
    "ratio",
    "ray",
    "receiver",
    "reduced",
    "regions",
    "regions_samples",
    "relink",
    "rival",
    "rsm",
    "run",
    "runs",
    "sampled",
    "scan",
    "screen",
    "search",
    "shade",
    "shown",
    "shown_samples",
    "slice",
    "slots",
    "slots_wide",
    "sort",
    "sorted",
    "steps",
    "steps_samples",
    "stride",
    "surface",
    "sweep",
    "task",
    "texel",
    "tile",
    "tiles",
    "tiles_samples",
    "triangle",
    "units",
    "vertex",
    "view",
    "volume",
    "walk",
    "weighted",
    "wide",
    "wide_native",
    "word",
];

impl Sources {
    /// The files as they ship. `native` takes 64-bit integers from the adapter
    /// (`SHADER_INT64`) in place of pairs of words.
    pub fn shipped(native: bool) -> Self {
        let file =
            |(name, text): &(&'static str, &'static str)| (Cow::from(*name), Cow::from(*text));
        let mut files: BTreeMap<_, _> = FILES.iter().map(file).collect();
        let native_wide = files.remove("wide_native");
        if let (true, Some(text)) = (native, native_wide) {
            files.insert("wide".into(), text);
        }
        for (name, has_samples) in [("network", false), ("network_samples", true)] {
            files.insert(name.into(), network::text(has_samples).into());
        }
        Self(files)
    }

    /// The same where the adapter has atomics of 64-bit integers as well
    /// (`SHADER_INT64_ATOMIC_MIN_MAX`): depth peeling finds key and triangle in one pass.
    pub fn with_wide_atomics(mut self) -> Self {
        if let Some(text) = self.0.get("near_wide").cloned() {
            self.0.insert("near".into(), text);
        }
        self
    }

    /// The same where it has all of them (`SHADER_INT64_ATOMIC_ALL_OPS`): lists that are in order
    /// while they are built take one pass.
    pub fn with_all_wide_atomics(mut self) -> Self {
        if let Some(text) = self.0.get("slots_wide").cloned() {
            self.0.insert("slots".into(), text);
        }
        self
    }
}
