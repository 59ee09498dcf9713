//! What the spec refuses of a scene, in the scene's own keys and units.

use triptych_spec::camera::{Camera, Projection};
use triptych_spec::grid::lattice::Lattice;
use triptych_spec::rsm::{EDGE_MAX, RsmError};

use super::setup::clamp;
use crate::scene::Mistake;
use crate::scene::rsm::Rsm;
use crate::vector::{length, sub};

/// A scene that is refused.
pub(super) struct Told<'a> {
    pub(super) rsm: &'a Rsm,
    /// What the lamp shines at.
    pub(super) light: &'a Camera,
    pub(super) lattice: &'a Lattice,
}

impl Told<'_> {
    /// A camera that has no view of the lattice. It has one of the world: loading saw to that.
    pub(super) fn view(&self, key: &'static str, error: &RsmError) -> Mistake {
        let words = error.to_string();
        let words = words.trim_start_matches("camera: ");
        let step = self.units(1.0);
        Mistake::of(
            key,
            format!(
                "{words}, in steps of {step} units; they are so long because one lattice holds all \
                 frames and eyes"
            ),
        )
    }

    /// A lamp without a strength or a distance.
    pub(super) fn lamp(&self, error: &RsmError) -> Mistake {
        let stated = self.rsm.reference.is_some();
        let key = if stated { "rsm.reference" } else { "rsm.lamp" };
        let distance = length(sub(self.light.target, self.light.eye));
        let distance = self.rsm.reference.map_or(distance, |length| length.0);
        match error {
            RsmError::Light(_) => Mistake::of(
                key,
                format!(
                    "a strength of {:?} at a distance of {distance:e} is more light than 32-bit numbers \
                     hold; a shorter one, or a smaller strength, is right",
                    self.rsm.strength.0
                ),
            ),
            RsmError::Limit { .. } => Mistake::of(
                key,
                format!(
                    "{distance:e} is no distance of a light; {:.3e}, half a step of the lattice, or more is \
                     right",
                    self.units(0.5)
                ),
            ),
            _ => Mistake::of(key, error.to_string()),
        }
    }

    /// A length beyond its limits, or too many rays.
    pub(super) fn parameters(&self, error: &RsmError) -> Mistake {
        let RsmError::Limit { name, .. } = error else {
            return Mistake::of("rsm", error.to_string());
        };
        match *name {
            "the squared distance" => self.clamp(),
            "the edge" => {
                let given = self.rsm.edge.map_or(0.0, |length| length.0);
                let most = self.units(f64::from(EDGE_MAX));
                let message =
                    format!("{given:e} is outside 0 to {most:.3e}, a 16th of the lattice's side");
                Mistake::of("rsm.edge", message)
            }
            "the number of rays" => Mistake::of(
                "rsm.radius",
                format!("{error}; use a smaller kernel or a larger divisor"),
            ),
            _ => Mistake::of("rsm", error.to_string()),
        }
    }

    fn clamp(&self) -> Mistake {
        let given = clamp(self.rsm, self.light);
        // The lattice's diagonal.
        let most = self.units(libm::sqrt(3.0) * 16_777_216.0);
        if self.rsm.clamp.is_some() {
            let message = format!("{given:e} is outside 0 to {most:.3e}, the lattice's diagonal");
            return Mistake::of("rsm.clamp", message);
        }
        let (key, name) = match self.light.projection {
            Projection::Perspective { .. } => ("rsm.lamp.fov", "fov"),
            Projection::Orthographic { .. } => ("rsm.lamp.height", "height"),
        };
        let message = format!(
            "two texels of the kernel, the default of clamp, are {given:.3e} long at the lamp's target, \
             outside 0 to {most:.3e}, the lattice's diagonal; state clamp or a smaller {name}"
        );
        Mistake::of(key, message)
    }

    /// Steps of the lattice in the world's units.
    fn units(&self, steps: f64) -> f64 {
        libm::scalbn(steps, self.lattice.exponent)
    }
}
