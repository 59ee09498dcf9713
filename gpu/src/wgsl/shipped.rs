//! The files that ship.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::Sources;

macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        BTreeMap::from([$((
            Cow::Borrowed($name),
            Cow::Borrowed(include_str!(concat!("../", $name, ".wgsl")))
        )),*])
    };
}

impl Sources {
    /// The files as they ship. `native` takes 64-bit integers from the adapter
    /// (`SHADER_INT64`) in place of pairs of words.
    pub fn shipped(native: bool) -> Self {
        let mut files = shipped!(
            "abuffer",
            "abuffer_samples",
            "asked",
            "bricks",
            "ceiling",
            "cells",
            "coarse",
            "counter",
            "cover",
            "depth",
            "drawn",
            "drawn_samples",
            "frame",
            "grid",
            "hbao",
            "item",
            "lamp",
            "ldm",
            "maps",
            "march",
            "meet",
            "mirror",
            "multisample",
            "nearest",
            "opened",
            "overlap",
            "parameters",
            "place",
            "raster",
            "raster_samples",
            "ray",
            "receiver",
            "relink",
            "rsm",
            "runs",
            "scan",
            "screen",
            "search",
            "slice",
            "sort",
            "surface",
            "sweep",
            "texel",
            "triangle",
            "vertex",
            "view",
            "volume",
            "walk",
            "wide",
            "wide_native",
        );
        let native_wide = files.remove("wide_native");
        if let (true, Some(text)) = (native, native_wide) {
            files.insert("wide".into(), text);
        }
        Self(files)
    }
}
