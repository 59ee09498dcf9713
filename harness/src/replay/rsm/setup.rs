//! From a loaded scene to what the spec is given: a lattice for all frames, and on it the
//! views, the parameters, and each frame's surfaces and blockers.

use triptych_spec::camera::{Camera, Projection};
use triptych_spec::grid::lattice::Lattice;
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::{Blockers, ENTRIES_MAX, Grid, GridError, Membership};
use triptych_spec::rsm::{BIAS_MAX, Lamp, Model, OFFSET_MIN, Parameters, View};
use triptych_spec::vertex::DEPTH_ONE;

use super::told::Told;
use crate::replay::pieces;
use crate::replay::placed::{self, nearest, steps};
use crate::scene::rsm::Rsm;
use crate::scene::{Loaded, Mistake};
use crate::vector::{length, sub};

/// Distance from a plane within which points are one surface, by default: a 256th of the
/// lattice's side.
const EDGE: u32 = 1 << 16;

/// A reference distance, in steps, that the spec takes.
const REFERENCE: f64 = 16_777_216.0;

/// What all frames share.
pub struct Setup {
    /// World space and the lattice: around everything in all frames, and around perspective
    /// eyes, so that frames compare.
    pub lattice: Lattice,
    /// From where the picture is seen.
    pub eye: View,
    /// What lights it.
    pub lamp: Lamp,
    /// In steps of the lattice.
    pub parameters: Parameters,
    /// How many frames there are.
    pub frames: u32,
}

/// What a frame is made of.
pub struct Parts {
    /// What is seen.
    pub model: Model,
    /// What blocks indirect light.
    pub blockers: Blockers,
    /// The blockers' cells.
    pub grid: Grid,
}

impl Setup {
    /// Of a scene with an `[rsm]`.
    ///
    /// # Errors
    /// Coordinates that are not finite, and whatever exceeds a limit of the spec, in one line, with
    /// the key to change.
    pub fn new(loaded: &Loaded) -> Result<Self, Mistake> {
        let rsm = loaded.file.rsm.as_ref();
        let rsm = rsm.ok_or_else(|| "has no [rsm]".to_owned())?.get_ref();
        let eye = loaded.world.camera;
        let light = rsm.lamp.get_ref().camera()?;
        let lattice = placed::lattice(loaded, rsm.frames.0, &[&eye, &light], &[])?;
        let told = Told {
            rsm,
            light: &light,
            lattice: &lattice,
        };
        let view =
            |key, camera, size| View::new(camera, &lattice, size).map_err(|e| told.view(key, &e));
        let lamp = view("rsm.lamp", &light, rsm.map.0)?;
        let (strength, reference) = bright(rsm, &light, &lattice);
        let lamp = Lamp::new(lamp, strength, reference).map_err(|e| told.lamp(&e))?;
        let parameters = parameters(rsm, &light, &lattice);
        let checked = parameters.check(loaded.scene.size);
        checked.map_err(|e| told.parameters(&e))?;
        Ok(Self {
            eye: view("camera", &eye, loaded.scene.size)?,
            lamp,
            parameters,
            frames: rsm.frames.0,
            lattice,
        })
    }

    /// What a frame is made of; the blockers' cells are built anew for each.
    ///
    /// # Errors
    /// Whatever exceeds a limit of the spec, in one line.
    pub fn parts(&self, loaded: &Loaded, frame: u32) -> Result<Parts, Mistake> {
        let (model, blockers) = placed::parts(loaded, &self.lattice, frame)?;
        let built = pieces::build(&blockers, Resolution::FromScene, Membership::Box);
        Ok(Parts {
            model,
            grid: built.map_err(|e| cells(frame, &e))?.grid,
            blockers,
        })
    }
}

/// Why blockers have no cells. Nobody states how many there are.
fn cells(frame: u32, error: &GridError) -> Mistake {
    let of = match error {
        GridError::Entries(entries) => {
            format!(
                "{entries} entries in the cells of the blockers, and {ENTRIES_MAX} are the limit"
            )
        }
        _ => error.to_string(),
    };
    Mistake::of(
        "rsm",
        format!("frame {}: {of}; use simpler blockers", frame + 1),
    )
}

/// The strength of the lamp, and at how many steps from it. A spot light that is so strong at a
/// distance is four times as strong at half of it; so any distance will do, also those that
/// are longer than the lattice. A directional light has none.
fn bright(rsm: &Rsm, light: &Camera, lattice: &Lattice) -> ([f32; 3], u32) {
    let mut strength = rsm.strength.0;
    let mut reference = match light.projection {
        Projection::Orthographic { .. } => 1.0,
        Projection::Perspective { .. } => {
            let distance = length(sub(light.target, light.eye));
            let distance = rsm.reference.map_or(distance, |length| length.0);
            libm::scalbn(distance, -lattice.exponent)
        }
    };
    // Where it is too strong for a number, the spec refuses it.
    while reference > REFERENCE && strength.iter().all(|c| c.is_finite()) {
        reference /= 2.0;
        strength = strength.map(|c| 4.0 * c);
    }
    #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
    let strength = strength.map(|c| c as f32);
    (
        strength,
        u32::try_from(nearest(reference)).unwrap_or(u32::MAX),
    )
}

/// Lengths of the world in steps, and the defaults. What is beyond a limit stays so, for the
/// spec to refuse.
fn parameters(rsm: &Rsm, light: &Camera, lattice: &Lattice) -> Parameters {
    let distance = length(sub(light.target, light.eye));
    let texel = texel(rsm, light);
    let bias = rsm.bias.map_or(2.0 * texel, |length| length.0);
    let clamp = steps(lattice, clamp(rsm, light));
    let edge = rsm.edge.map(|length| steps(lattice, length.0));
    let edge = edge.map(|steps| u32::try_from(steps).unwrap_or(u32::MAX));
    Parameters {
        radius: rsm.radius.0,
        stride: rsm.stride.0,
        divisor: rsm.divisor.0,
        blur: rsm.blur.0,
        bias: keys(light, distance, bias),
        clamp: clamp.saturating_mul(clamp).max(1),
        offset: rsm.offset.0.max(OFFSET_MIN),
        edge: edge.unwrap_or(EDGE),
    }
}

/// How wide a texel is at the lamp's target.
fn texel(rsm: &Rsm, light: &Camera) -> f64 {
    let side = match light.projection {
        Projection::Perspective { fov } => {
            let distance = length(sub(light.target, light.eye));
            2.0 * libm::tan(fov.to_radians() / 2.0) * distance
        }
        Projection::Orthographic { height } => height,
    };
    side / f64::from(rsm.map.0.height)
}

/// As which length shorter ones count.
pub(super) fn clamp(rsm: &Rsm, light: &Camera) -> f64 {
    let default = || 2.0 * texel(rsm, light) * f64::from(rsm.stride.0);
    rsm.clamp.map_or_else(default, |length| length.0)
}

/// Depth keys that a length along a camera's axis takes at a distance. All depths are equal
/// from [`BIAS_MAX`] on, so more is no error.
fn keys(camera: &Camera, distance: f64, length: f64) -> u32 {
    let (near, far) = (camera.near, camera.far);
    let slope = match camera.projection {
        // Depth is f / (f - n) (1 - n / d).
        Projection::Perspective { .. } => far * near / ((far - near) * distance * distance),
        Projection::Orthographic { .. } => 1.0 / (far - near),
    };
    let keys = nearest(slope * length * f64::from(DEPTH_ONE));
    u32::try_from(keys).unwrap_or(BIAS_MAX).min(BIAS_MAX)
}
