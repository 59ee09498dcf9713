//! Light from all around: one colour, a gradient, or a picture of everything.
//!
//! Radiance is asked for once for each direction and its opposite, in `f64`, and rounded to `f32`
//! once; every leg is given these numbers.

mod image;
#[cfg(test)]
mod tests;

use std::f64::consts::{PI, TAU};
use std::path::Path;

use serde::Deserialize;
use sha2::{Digest, Sha256};
use triptych_spec::ldm;

use super::value::{COLOUR_MAX, Colour, Direction};
use super::{LoadError, Parsed};
use crate::mesh::Intake;
use crate::vector::{cross, dot, length, normalize};
pub use image::{Panorama, SKY_BYTES_MAX, SKY_PIXELS_MAX};

/// A sky as a scene file states it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum SkyEntry {
    /// The same radiance from everywhere.
    Constant(Colour),
    /// From one radiance straight up to another straight down, by the cosine of the angle.
    Gradient {
        /// Straight up.
        zenith: Colour,
        /// Straight down.
        nadir: Colour,
        /// Which way up is.
        #[serde(default = "SkyEntry::y")]
        up: Direction,
    },
    /// A picture of everything, in longitude and latitude.
    Image {
        /// An .exr or .hdr, relative to the scene; linear radiance.
        file: String,
        /// Where its top row is.
        #[serde(default = "SkyEntry::y")]
        up: Direction,
        /// What is in its middle column, not parallel to `up`.
        #[serde(default = "SkyEntry::front")]
        front: Direction,
        /// How it is looked up.
        #[serde(default)]
        filter: Filter,
    },
}

impl SkyEntry {
    fn y() -> Direction {
        Direction([0.0, 1.0, 0.0])
    }
    fn front() -> Direction {
        Direction([0.0, 0.0, -1.0])
    }
}

/// How a picture of the sky is looked up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Filter {
    /// The texel that the direction is in.
    #[default]
    Nearest,
    /// Weighted by the distances from the middles of the four around it.
    Bilinear,
}

/// A sky that gives radiance.
#[derive(Clone, Debug, PartialEq)]
pub enum Sky {
    /// See [`SkyEntry::Constant`].
    Constant([f64; 3]),
    /// See [`SkyEntry::Gradient`].
    Gradient {
        /// Straight up.
        zenith: [f64; 3],
        /// Straight down.
        nadir: [f64; 3],
        /// Unit vector.
        up: [f64; 3],
    },
    /// See [`SkyEntry::Image`].
    Image {
        /// What is there.
        panorama: Panorama,
        /// Unit vectors to the right of the middle, up, and to the middle.
        axes: [[f64; 3]; 3],
        /// How it is looked up.
        filter: Filter,
    },
}

impl Sky {
    /// Radiance from a direction, a unit vector that points to where the light comes from.
    ///
    /// A gradient is `nadir + (zenith - nadir) (1 + cos) / 2` with the cosine of the angle to
    /// `up`. A picture of `w x h` texels has longitude `u = atan2(right, front)` and the angle
    /// from the top `v`; column `w (u / 2 pi + 1/2)` and row `h v / pi`, both from the upper left
    /// corner of texel (0, 0). The nearest texel is that of both numbers rounded down; columns go
    /// around, and rows end at the poles.
    pub fn radiance(&self, direction: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Constant(colour) => *colour,
            Self::Gradient { zenith, nadir, up } => {
                let part = ((1.0 + dot(direction, *up)) / 2.0).clamp(0.0, 1.0);
                [0, 1, 2].map(|i| nadir[i] + (zenith[i] - nadir[i]) * part)
            }
            Self::Image {
                panorama,
                axes,
                filter,
            } => {
                let [right, up, front] = axes.map(|axis| dot(direction, axis));
                let u = libm::atan2(right, front) / TAU + 0.5;
                let v = libm::atan2(libm::hypot(right, front), up) / PI;
                panorama.at([u, v], *filter)
            }
        }
    }

    /// From a map's direction and from the opposite one, as every leg has it.
    pub fn sides(&self, direction: [f64; 3]) -> ldm::Sky {
        #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
        let single = |colour: [f64; 3]| colour.map(|c| c as f32);
        let opposite = direction.map(|c| -c);
        [direction, opposite].map(|d| single(self.radiance(d)))
    }
}

/// The sky of a scene, if it has one; what is read for it goes to the digest.
pub(super) fn load(
    intake: &mut Intake,
    parsed: &Parsed,
    digest: &mut Sha256,
) -> Result<Option<Sky>, LoadError> {
    let ldm = parsed.file.ldm.as_ref();
    let Some(entry) = ldm.and_then(|ldm| ldm.get_ref().sky.as_ref()) else {
        return Ok(None);
    };
    let sky = match entry.get_ref() {
        SkyEntry::Constant(colour) => Sky::Constant(colour.0),
        SkyEntry::Gradient { zenith, nadir, up } => Sky::Gradient {
            zenith: zenith.0,
            nadir: nadir.0,
            up: normalize(up.0),
        },
        SkyEntry::Image {
            file,
            up,
            front,
            filter,
        } => {
            let axes = axes(up.0, front.0).ok_or_else(|| {
                let message = "sky: front is parallel to up, so nothing is to the right";
                parsed.error(entry.span(), message)
            })?;
            let folder = parsed.path.parent().unwrap_or(Path::new(""));
            let path = folder.join(file);
            let bytes = intake.read(&path, SKY_BYTES_MAX)?;
            digest.update(Sha256::digest(&bytes));
            let panorama = image::decode(&path, &bytes)?;
            Sky::Image {
                panorama,
                axes,
                filter: *filter,
            }
        }
    };
    Ok(Some(sky))
}

/// Right, up and front, at right angles to each other.
fn axes(up: [f64; 3], front: [f64; 3]) -> Option<[[f64; 3]; 3]> {
    let (up, front) = (normalize(up), normalize(front));
    let right = cross(front, up);
    // Vectors this close are no statement about where right is.
    if length(right) < 1e-6 {
        return None;
    }
    let right = normalize(right);
    Some([right, up, cross(up, right)])
}
