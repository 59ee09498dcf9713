//! The `[ldm]` of a scene: layered depth maps in many directions, and what is open through them.
//!
//! All triangles are opaque here, as with `[rsm]`: a layer is there or not. What is seen blocks as
//! well, unless `blocks = false` says otherwise.

use serde::Deserialize;
use toml::Spanned;
use triptych_spec::ldm::{DIRECTIONS_MAX, RESOLUTION_MAX, RESOLUTION_MIN};
use triptych_spec::rsm::{OFFSET_MAX, OFFSET_MIN};

use super::file::{MeshEntry, SceneFile};
use super::rsm::{Length, Whole};
use super::sky::SkyEntry;
use super::{Parsed, effect};
use crate::error::InputError;

/// Most pairs of a pixel of the picture and a map, over all rotations: the spec looks 20 to 40
/// million of them up in a second, and Embree traces a ray for each.
pub const PAIRS_MAX: u64 = 1 << 29;

/// Largest power of the falloff.
pub const POWER_MAX: u32 = 8;

/// Which maps there are, and what is made of them. Lengths are in world units where nothing else
/// is said.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ldm {
    /// Directions of a set: half of the sphere, evenly.
    #[serde(default = "Ldm::directions")]
    pub directions: Whole<1, DIRECTIONS_MAX>,
    /// Pixels of a map across the diagonal of what blocks.
    #[serde(default = "Ldm::resolution")]
    pub resolution: Whole<RESOLUTION_MIN, RESOLUTION_MAX>,
    /// How many sets are summed up, each but the first turned at random from the scene's seed.
    #[serde(default = "Ldm::rotations")]
    pub rotations: Whole<1, DIRECTIONS_MAX>,
    /// From which distance on nothing blocks: obscurance; left out, everything blocks alike.
    pub far: Option<Length>,
    /// A hit at a distance lets `(distance / far)^power` pass; only with `far`.
    pub power: Option<Whole<0, POWER_MAX>>,
    /// Steps of the lattice by which points are moved off their faces.
    #[serde(default = "Ldm::offset")]
    pub offset: Whole<OFFSET_MIN, OFFSET_MAX>,
    /// Whether surfaces mirror: what each point sees in the direction nearest to its mirror
    /// direction.
    #[serde(default)]
    pub mirror: bool,
    /// Light from all around; left out, there is no stage `environment`.
    pub sky: Option<Spanned<SkyEntry>>,
}

impl Ldm {
    fn directions() -> Whole<1, DIRECTIONS_MAX> {
        Whole(64)
    }
    fn resolution() -> Whole<RESOLUTION_MIN, RESOLUTION_MAX> {
        Whole(100)
    }
    fn rotations() -> Whole<1, DIRECTIONS_MAX> {
        Whole(1)
    }
    fn offset() -> Whole<OFFSET_MIN, OFFSET_MAX> {
        Whole(8)
    }

    /// The power of the falloff.
    pub fn power(&self) -> u32 {
        self.power.map_or(2, |power| power.0)
    }

    /// Maps of all rotations; at most [`DIRECTIONS_MAX`].
    pub fn maps(&self) -> u32 {
        self.directions.0 * self.rotations.0
    }

    /// The key of a number beyond its limits, and why it is.
    fn check(&self, pixels: u64) -> Result<(), (&'static str, String)> {
        if self.power.is_some() && self.far.is_none() {
            return Err((
                "ldm.power",
                "has no effect without `far`; leave it out".to_owned(),
            ));
        }
        if self.far.is_some_and(|far| far.0 == 0.0) {
            let message = "0 is no distance to look; leave it out, or state a longer one";
            return Err(("ldm.far", message.to_owned()));
        }
        let maps = u64::from(self.directions.0) * u64::from(self.rotations.0);
        if maps > u64::from(DIRECTIONS_MAX) {
            return Err((
                "ldm.rotations",
                format!("{maps} directions in all rotations exceed the limit of {DIRECTIONS_MAX}"),
            ));
        }
        let pairs = pixels * maps;
        match pairs > PAIRS_MAX {
            false => Ok(()),
            true => Err((
                "ldm.directions",
                format!(
                    "{pairs} pairs of a pixel and a map exceed the limit of {PAIRS_MAX}; use fewer \
                     directions or a smaller size"
                ),
            )),
        }
    }
}

/// Holds a scene's keys against each other: which go with `[ldm]`, and which do not.
pub(super) fn check(parsed: &Parsed) -> Result<(), InputError> {
    let file = &parsed.file;
    let Some(ldm) = &file.ldm else {
        return Ok(());
    };
    effect::check(parsed, "[ldm]", ldm.span())?;
    let of = |wrong: fn(&MeshEntry) -> bool| file.mesh.iter().find(|m| wrong(m.get_ref()));
    if let Some(mesh) = of(|m| m.moves.is_some()) {
        let message = "`moves` is for scenes with [rsm]";
        return Err(parsed.error(mesh.span(), message));
    }
    if let Some(mesh) = of(|m| m.seen == Some(false) && m.blocks == Some(false)) {
        let message = "a mesh that is not seen must block light, or it does nothing";
        return Err(parsed.error(mesh.span(), message));
    }
    let checked = ldm.get_ref().check(file.size.0.pixels() as u64);
    checked.map_err(|(key, message)| parsed.mistake(key, message))
}

/// What blocks where a mesh does not say so: everything. Only [`check`] tells what is stated from
/// what is not, so this comes after it.
pub(super) fn settle(file: &mut SceneFile) {
    if file.ldm.is_some() {
        for mesh in &mut file.mesh {
            mesh.get_mut().blocks.get_or_insert(true);
        }
    }
}
