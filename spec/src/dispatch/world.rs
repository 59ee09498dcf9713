//! What rays are traced in.

use super::lamp::{LIGHT_MAX, Lamp, largest};
use super::ray::{WEIGHT_BITS, Weight};
use super::{DEPTH_MAX, DispatchError, Eye, LAMPS_MAX};
use crate::grid::Blockers;
use crate::rsm::{Model, sound};

/// How a triangle treats light, on both of its sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// The part of a lamp's light that it gives back in all directions alike.
    pub diffuse: [f32; 3],
    /// The part of the light from its mirror direction that it gives back, 0 to 1.
    pub mirror: [f32; 3],
}

/// Triangles, lamps and an eye, on the lattice.
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    /// Triangles with their planes; its colours are what materials give back in all directions.
    pub model: Model,
    /// The same triangles as rays meet them.
    pub blockers: Blockers,
    /// What each triangle mirrors, rounded to a weight's units once.
    pub mirrors: Vec<Weight>,
    /// Point lights.
    pub lamps: Vec<Lamp>,
    /// Linear light along rays that meet nothing.
    pub background: [f32; 3],
    /// Whose picture it is.
    pub eye: Eye,
    /// Most mirrors on the way of a ray; at most [`DEPTH_MAX`].
    pub depth: u32,
}

impl World {
    /// Checks materials, lamps and the rest.
    ///
    /// # Errors
    /// Whatever is beyond its limits, by name: a background brighter than [`LIGHT_MAX`], and materials that
    /// make more of a lamp, among them.
    pub fn new(
        blockers: Blockers,
        materials: &[Material],
        lamps: Vec<Lamp>,
        background: [f32; 3],
        eye: Eye,
        depth: u32,
    ) -> Result<Self, DispatchError> {
        within("the depth", depth.into(), 0, DEPTH_MAX.into())?;
        within(
            "the number of lamps",
            lamps.len() as u64,
            0,
            LAMPS_MAX as u64,
        )?;
        if materials.len() != blockers.triangles.len() {
            let triangles = blockers.triangles.len();
            return Err(DispatchError::Materials(materials.len(), triangles));
        }
        sound(background).map_err(light)?;
        let white = materials.iter().map(|m| largest(m.diffuse));
        let white = white.fold(1.0, f64::max);
        let lamps_give = lamps.iter().map(|lamp| lamp.brightest() * white);
        let light_is = [largest(background)].into_iter().chain(lamps_give);
        if let Some(too_bright) = light_is.into_iter().find(|light| *light > LIGHT_MAX) {
            return Err(DispatchError::Bright(too_bright));
        }
        let diffuse = materials.iter().map(|m| m.diffuse).collect();
        let (vertices, triangles) = (blockers.vertices.clone(), blockers.triangles.clone());
        let model = Model::new(vertices, triangles, diffuse).map_err(light)?;
        let mirrors = materials.iter().map(|m| mirror(m.mirror));
        Ok(Self {
            mirrors: mirrors.collect::<Result<_, _>>()?,
            model,
            blockers,
            lamps,
            background,
            eye,
            depth,
        })
    }
}

/// What a mirror gives back, in a weight's units.
fn mirror(parts: [f32; 3]) -> Result<Weight, DispatchError> {
    let mut weight = [0; 3];
    for (unit, part) in weight.iter_mut().zip(parts) {
        // NaN is within nothing.
        if !(0.0..=1.0).contains(&part) {
            return Err(DispatchError::Mirror(part));
        }
        let steps = f64::from(part) * f64::from(1_u32 << WEIGHT_BITS);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "0 to 2^15"
        )]
        let rounded = libm::rint(steps) as u32;
        *unit = rounded;
    }
    Ok(weight)
}

/// The models' errors that are not about colours have been looked at before, where a lattice
/// was laid around the triangles.
pub(super) fn light(error: crate::rsm::RsmError) -> DispatchError {
    match error {
        crate::rsm::RsmError::Light(value) => DispatchError::Light(value),
        crate::rsm::RsmError::Outside(_) => DispatchError::TooFar("a corner"),
        other => unreachable!("a model of triangles that exist: {other}"),
    }
}

/// An error unless a number is within its limits.
pub(super) fn within(
    name: &'static str,
    value: u64,
    least: u64,
    most: u64,
) -> Result<(), DispatchError> {
    match (least..=most).contains(&value) {
        true => Ok(()),
        false => Err(DispatchError::Limit {
            name,
            value,
            least,
            most,
        }),
    }
}
