//! The `[dispatch]` of a scene: lamps and mirrors, for rays in work queues.
//!
//! All triangles are opaque here, as with `[rsm]` and `[ldm]`: a ray ends at what it meets first.

use serde::Deserialize;
use toml::Spanned;
use triptych_spec::dispatch::{DEPTH_MAX, LAMPS_MAX};

use super::file::{MaterialEntry, MeshEntry};
use super::rsm::{Length, Whole};
use super::value::{Colour, Point, Shares, at_most};
use super::{Parsed, effect};
use crate::error::InputError;

/// Most rays that a scene could ask for, if every ray met a surface that all lamps light and that
/// mirrors: a replay holds them all, with what they meet, on every leg.
pub const RAYS_MAX: u64 = 1 << 23;

/// What lights the scene, and how many mirrors a ray may see. Lengths are in world units.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dispatch {
    /// Point lights.
    #[serde(default, deserialize_with = "at_most::<LAMPS_MAX, _, _>")]
    pub lamp: Vec<Spanned<LampEntry>>,
    /// Most mirrors on the way of a ray.
    #[serde(default = "Dispatch::depth")]
    pub depth: Whole<0, DEPTH_MAX>,
}

/// A point light, which shines in all directions alike.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LampEntry {
    /// Where it is.
    pub position: Point,
    /// Irradiance of a surface at right angles to its light, at the reference distance.
    pub strength: Colour,
    /// The reference distance; 1 if left out.
    #[serde(default = "LampEntry::one")]
    pub reference: Length,
    /// Shorter distances count as this one, or the lamp would be infinitely bright; left out: a
    /// 16th of the reference distance.
    pub least: Option<Length>,
}

impl LampEntry {
    fn one() -> Length {
        Length(1.0)
    }

    /// The least distance.
    pub fn least(&self) -> f64 {
        self.least
            .map_or(self.reference.0 / 16.0, |length| length.0)
    }
}

impl Dispatch {
    fn depth() -> Whole<0, DEPTH_MAX> {
        Whole(4)
    }

    /// Most rays of a picture of so many pixels; below 2^22 * 2^7 * 2^7.
    pub fn rays(&self, pixels: u64, mirrors: bool) -> u64 {
        let bounces = if mirrors {
            u64::from(self.depth.0) + 1
        } else {
            1
        };
        pixels * bounces * (1 + self.lamp.len() as u64)
    }
}

/// Holds a scene's keys against each other: which go with `[dispatch]`, and which do not.
pub(super) fn check(parsed: &Parsed) -> Result<(), InputError> {
    let file = &parsed.file;
    let Some(dispatch) = &file.dispatch else {
        let mirror = file.material.iter().find(|m| m.mirror.is_some());
        return mirror.map_or(Ok(()), |material| {
            let message = "`mirror` of a material is for scenes with [dispatch]";
            Err(parsed.error(material.name.span(), message))
        });
    };
    effect::check(parsed, "[dispatch]", dispatch.span())?;
    let only_elsewhere =
        |m: &MeshEntry| m.moves.is_some() || m.seen.is_some() || m.blocks.is_some();
    let strange = file.mesh.iter().find(|m| only_elsewhere(m.get_ref()));
    if let Some(mesh) = strange {
        let message = "`seen`, `blocks` and `moves` have no effect on a scene with [dispatch]";
        return Err(parsed.error(mesh.span(), message));
    }
    let mirrors = |m: &MaterialEntry| m.mirror.is_some_and(|m| m != Shares::default());
    let mirrors = file.material.iter().any(mirrors);
    let rays = dispatch
        .get_ref()
        .rays(file.size.0.pixels() as u64, mirrors);
    match rays > RAYS_MAX {
        false => Ok(()),
        true => Err(parsed.mistake(
            "size",
            format!(
                "pixels, lamps and mirrors may ask for {rays} rays, and {RAYS_MAX} are the limit; use \
                 a smaller size, fewer lamps or less depth"
            ),
        )),
    }
}
