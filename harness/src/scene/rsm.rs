//! The `[rsm]` of a scene: one bounce of indirect light, with indirect shadows.
//!
//! All triangles are opaque here: a reflective shadow map has one surface for each texel.
//! Materials that let light through are drawn as if they did not, and a remark says so.

use serde::Deserialize;
use toml::Spanned;
use triptych_spec::rsm::{BLUR_MAX, DIVISOR_MAX, OFFSET_MAX, OFFSET_MIN, RADIUS_MAX, STRIDE_MAX};

use super::file::{CameraEntry, MeshEntry};
use super::flatten::PLACEMENT_MAX;
use super::source::Source;
use super::value::{Colour, ImageSize, Point};
use super::{Parsed, effect};
use crate::error::InputError;

/// Most frames of a scene.
pub const FRAMES_MAX: u32 = 16;

/// Most pixels and texels of a map, over all frames: a frame costs about 400 bytes for each.
pub const PIXELS_MAX: u64 = 1 << 22;

/// Most pairs of a pixel and a texel of its kernel, over all frames: the spec gathers ten
/// million of them a second, and Embree traces each for the reference.
pub const PAIRS_MAX: u64 = 1 << 28;

/// Most triangles of all frames together, which are held at once: one that is seen and blocks takes
/// 188 bytes in each, so that this is 1.6 GB.
pub const FRAME_TRIANGLES_MAX: u64 = 1 << 23;

/// What lights the scene, and how its light is gathered. Lengths are in world units where
/// nothing else is said.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rsm {
    /// What the lamp shines at: `fov` makes it a spot light, `height` a directional light.
    pub lamp: Spanned<CameraEntry>,
    /// Columns and rows of the lamp's map.
    #[serde(default = "Rsm::map")]
    pub map: ImageSize,
    /// Irradiance of a surface at right angles to the light; from a spot light at the
    /// reference distance.
    #[serde(default = "Rsm::strength")]
    pub strength: Colour,
    /// Reference distance of a spot light; left out: from the lamp's eye to its target.
    pub reference: Option<Length>,
    /// The kernel reaches so many of its texels to each side.
    #[serde(default = "Rsm::radius")]
    pub radius: Whole<0, RADIUS_MAX>,
    /// Texels of the map from one of the kernel to the next.
    #[serde(default = "Rsm::stride")]
    pub stride: Whole<1, STRIDE_MAX>,
    /// Rays are traced for every so-many-th pixel, in x and in y.
    #[serde(default = "Rsm::divisor")]
    pub divisor: Whole<1, DIVISOR_MAX>,
    /// What they find is averaged over so many of those pixels to each side.
    #[serde(default = "Rsm::blur")]
    pub blur: Whole<0, BLUR_MAX>,
    /// How far behind the surface in the map, measured at the lamp's target along its axis, a
    /// point is still lit; left out: two of the map's texels there.
    pub bias: Option<Length>,
    /// Shorter distances of a texel and a point count as this one, or a texel would be
    /// infinitely bright; left out: two of the kernel's texels at the lamp's target.
    pub clamp: Option<Length>,
    /// Steps of the lattice by which points are moved off their faces.
    #[serde(default = "Rsm::offset")]
    pub offset: Whole<OFFSET_MIN, OFFSET_MAX>,
    /// How far from each other's planes two points of one surface may be; left out: a 256th
    /// of the lattice's side.
    pub edge: Option<Length>,
    /// How many frames there are, in which meshes may move.
    #[serde(default = "Rsm::frames")]
    pub frames: Whole<1, FRAMES_MAX>,
}

impl Rsm {
    fn map() -> ImageSize {
        ImageSize::square(64)
    }
    fn strength() -> Colour {
        Colour([1.0; 3])
    }
    fn radius() -> Whole<0, RADIUS_MAX> {
        Whole(4)
    }
    fn stride() -> Whole<1, STRIDE_MAX> {
        Whole(2)
    }
    fn divisor() -> Whole<1, DIVISOR_MAX> {
        Whole(2)
    }
    fn blur() -> Whole<0, BLUR_MAX> {
        Whole(1)
    }
    fn offset() -> Whole<OFFSET_MIN, OFFSET_MAX> {
        Whole(8)
    }
    fn frames() -> Whole<1, FRAMES_MAX> {
        Whole(1)
    }

    /// Refuses what would take too long or too much room.
    fn check(&self, size: u64) -> Result<(), String> {
        let [map, frames] = [self.map.0.pixels() as u64, u64::from(self.frames.0)];
        let pixels = frames * (size + map);
        if pixels > PIXELS_MAX {
            return Err(format!(
                "{pixels} pixels and texels in all frames exceed the limit of {PIXELS_MAX}"
            ));
        }
        let side = 2 * u64::from(self.radius.0) + 1;
        // Below 2^4 * 2^22 * 2^22.
        let pairs = frames * size * side * side;
        match pairs > PAIRS_MAX {
            false => Ok(()),
            true => Err(format!(
                "{pairs} pairs of a pixel and a texel of its kernel in all frames exceed the \
                 limit of {PAIRS_MAX}"
            )),
        }
    }
}

/// How a mesh moves from frame to frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Degrees a frame about x, then y, then z of the mesh itself, before it is placed.
    #[serde(default)]
    pub rotate: Point,
    /// Offset a frame, after it is placed.
    #[serde(default)]
    pub translate: Point,
}

/// An integer from `LEAST` to `MOST`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "i64")]
pub struct Whole<const LEAST: u32, const MOST: u32>(pub u32);

impl<const LEAST: u32, const MOST: u32> TryFrom<i64> for Whole<LEAST, MOST> {
    type Error = String;
    fn try_from(v: i64) -> Result<Self, String> {
        let given = u32::try_from(v).ok();
        let given = given.filter(|n| (LEAST..=MOST).contains(n));
        given
            .map(Self)
            .ok_or_else(|| format!("{v} is outside {LEAST} to {MOST}"))
    }
}

/// A length: finite, not negative.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "f64")]
pub struct Length(pub f64);

impl TryFrom<f64> for Length {
    type Error = String;
    fn try_from(v: f64) -> Result<Self, String> {
        match v.is_finite() && v >= 0.0 {
            true => Ok(Self(v)),
            false => Err(format!("{v} is no length: 0 or more is right")),
        }
    }
}

impl MeshEntry {
    /// Whether eye and lamp see it, or the eye alone of a scene with `[ldm]`.
    pub fn is_seen(&self) -> bool {
        self.seen.unwrap_or(true)
    }

    /// Whether it blocks indirect light, or is in the maps of a scene with `[ldm]`.
    pub fn does_block(&self) -> bool {
        self.blocks.unwrap_or(false)
    }

    /// How it moves.
    pub fn motion(&self) -> Motion {
        self.moves.unwrap_or_default()
    }
}

/// Holds a scene's keys against each other: which go with `[rsm]`, and which do not.
pub(super) fn check(parsed: &Parsed) -> Result<(), InputError> {
    let file = &parsed.file;
    let Some(rsm) = &file.rsm else {
        if file.is_lit_later() {
            return Ok(());
        }
        let strange = |m: &&Spanned<MeshEntry>| {
            let m = m.get_ref();
            m.seen.is_some() || m.blocks.is_some() || m.moves.is_some()
        };
        return file.mesh.iter().find(strange).map_or(Ok(()), |mesh| {
            let message = "`seen` and `blocks` are for scenes with [rsm] or [ldm], `moves` is for those with [rsm]";
            Err(parsed.error(mesh.span(), message))
        });
    };
    effect::check(parsed, "[rsm]", rsm.span())?;
    let idle = |m: &&Spanned<MeshEntry>| !m.get_ref().is_seen() && !m.get_ref().does_block();
    if let Some(mesh) = file.mesh.iter().find(idle) {
        let message = "a mesh that is not seen must block light, or it does nothing";
        return Err(parsed.error(mesh.span(), message));
    }
    let checked = rsm.get_ref().check(file.size.0.pixels() as u64);
    checked.map_err(|message| parsed.error(rsm.span(), message))?;
    check_moves(parsed, rsm.get_ref().frames.0)?;
    let lamp = &rsm.get_ref().lamp;
    let map = rsm.get_ref().map.0;
    let aspect = f64::from(map.width) / f64::from(map.height);
    let camera = lamp.get_ref().camera();
    let matrix = camera.and_then(|camera| camera.matrix(aspect).map_err(|e| e.to_string()));
    matrix.map(|_| ()).map_err(|message| {
        let message = message.replacen("camera:", "lamp:", 1);
        parsed.error(lamp.span(), message)
    })
}

/// Holds meshes to where they may be placed in the last of so many frames.
fn check_moves(parsed: &Parsed, frames: u32) -> Result<(), InputError> {
    let steps = f64::from(frames - 1);
    for (number, mesh) in parsed.file.mesh.iter().enumerate() {
        let Motion { rotate, translate } = mesh.get_ref().motion();
        for (name, by) in [("rotate", rotate), ("translate", translate)] {
            let far =
                by.0.into_iter()
                    .find(|by| (by * steps).abs() > PLACEMENT_MAX);
            if let Some(by) = far {
                let key = format!("mesh.{number}.moves.{name}");
                let message = format!(
                    "{by:e} in each of {frames} frames is beyond {PLACEMENT_MAX:e} at the end"
                );
                return Err(parsed.mistake(&key, message));
            }
        }
    }
    Ok(())
}

/// Holds what was loaded against what all frames may hold together.
pub(super) fn check_meshes(parsed: &Parsed, meshes: &[Source]) -> Result<(), InputError> {
    let Some(rsm) = &parsed.file.rsm else {
        return Ok(());
    };
    let frames = rsm.get_ref().frames.0;
    let triangles = |mesh: &Source| mesh.stats.instances * mesh.mesh.triangles.len() as u64;
    // Below 2^4 * 2^22, as the sums of a scene have limits of their own.
    let all: u64 = meshes.iter().map(triangles).sum();
    let total = u64::from(frames) * all;
    if total <= FRAME_TRIANGLES_MAX {
        return Ok(());
    }
    let message = format!(
        "{frames} frames of {all} triangles are {total}, and {FRAME_TRIANGLES_MAX} in all frames are \
         the limit"
    );
    Err(parsed.mistake("rsm.frames", message))
}
