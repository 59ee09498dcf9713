//! The files that ship.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::{Sources, network};

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
            "asked",
            "bin",
            "bricks",
            "ceiling",
            "cells",
            "coarse",
            "counter",
            "cover",
            "depth",
            "frame",
            "grid",
            "hbao",
            "item",
            "jagged",
            "lamp",
            "ldm",
            "maps",
            "march",
            "meet",
            "mirror",
            "nearest",
            "opened",
            "overlap",
            "parameters",
            "place",
            "raster",
            "ray",
            "receiver",
            "relink",
            "rsm",
            "runs",
            "scan",
            "screen",
            "search",
            "shown",
            "slice",
            "sort",
            "surface",
            "sweep",
            "texel",
            "tile",
            "tiles",
            "triangle",
            "vertex",
            "view",
            "volume",
            "walk",
            "wide",
            "wide_native",
            "word",
        );
        let native_wide = files.remove("wide_native");
        if let (true, Some(text)) = (native, native_wide) {
            files.insert("wide".into(), text);
        }
        files.insert("network".into(), network::text().into());
        Self(files)
    }
}
