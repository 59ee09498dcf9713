//! Which stages can see a defect.

use triptych_gpu::wgsl::{Sources, WgslError};

use crate::registry::RIVALS;

/// Files of the stages from the spec's triangles to the picture.
const LISTS: [&str; 5] = ["raster", "abuffer", "early", "early_samples", "multisample"];

/// Files of the lists in other layouts.
const LAYOUTS: [&str; 8] = [
    "layouts",
    "packed",
    "regions",
    "ordered",
    "layouts_samples",
    "packed_samples",
    "regions_samples",
    "ordered_samples",
];

/// Files of the lists by tiles.
const TILES: [&str; 6] = [
    "tiles",
    "tiles_samples",
    "linked",
    "linked_samples",
    "local",
    "local_samples",
];

/// What of a scene of triangles is compared.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Part {
    /// The vertex stages.
    Vertex,
    /// The stages that start from the spec's triangles.
    Lists,
    /// The rivals of the lists.
    Rivals,
    /// The lists by tiles.
    Tiles,
    /// The lists in other layouts.
    Layouts,
}

impl Part {
    /// The programs of it that run one without another.
    pub(super) fn files(self) -> &'static [&'static str] {
        match self {
            Self::Vertex | Self::Lists => &[],
            Self::Rivals => &RIVALS,
            Self::Tiles => &TILES,
            Self::Layouts => &LAYOUTS,
        }
    }
}

/// Which stages' kernels are not those that ship: the first of them have the defect.
pub(super) fn touched(sources: &Sources, native: bool) -> Result<Part, WgslError> {
    if differ(sources, native, &["vertex"])?.next().is_some() {
        return Ok(Part::Vertex);
    }
    let lists = differ(sources, native, &LISTS)?.next();
    let rivals = differ(sources, native, &RIVALS)?.next();
    let tiles = differ(sources, native, &TILES)?.next();
    let layouts = differ(sources, native, &LAYOUTS)?.next();
    Ok(match (lists, rivals, tiles, layouts) {
        (None, Some(_), ..) => Part::Rivals,
        (None, None, Some(_), _) => Part::Tiles,
        (None, None, None, Some(_)) => Part::Layouts,
        _ => Part::Lists,
    })
}

/// Those of these files that are not as they ship, with what they import.
pub(super) fn differ<'f>(
    sources: &Sources,
    native: bool,
    files: &[&'f str],
) -> Result<impl Iterator<Item = &'f str> + use<'f>, WgslError> {
    let shipped = Sources::shipped(native);
    let mut found = Vec::new();
    for file in files {
        if sources.link(file)?.text != shipped.link(file)?.text {
            found.push(*file);
        }
    }
    Ok(found.into_iter())
}
