//! Which stages a defect is in, so that these alone are compared.

use triptych_gpu::wgsl::{Sources, WgslError};

use crate::registry::FAMILIES;

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
}

impl Part {
    /// Which stages' kernels are not those that ship: the first of them have the defect.
    pub(super) fn touched(sources: &Sources, native: bool) -> Result<Self, WgslError> {
        let shipped = Sources::shipped(native);
        let differs = |file: &&str| -> Result<bool, WgslError> {
            Ok(sources.link(file)?.text != shipped.link(file)?.text)
        };
        if differs(&"vertex")? {
            return Ok(Self::Vertex);
        }
        for file in ["raster", "abuffer"] {
            if differs(&file)? {
                return Ok(Self::Lists);
            }
        }
        let rivals = FAMILIES.iter().find(|family| family.name == "abuffer");
        for file in rivals.map_or(&[][..], |family| family.files) {
            if differs(file)? {
                return Ok(Self::Rivals);
            }
        }
        match differs(&"tiles")? {
            true => Ok(Self::Tiles),
            false => Ok(Self::Lists),
        }
    }
}
