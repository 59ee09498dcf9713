//! Stage `rsm`: what the light sees, as lights.

use super::model::sound;
use super::parameters::within;
use super::{Colour, DARK, Gbuffer, Model, Parameters, RsmError, Surface, View, gbuffer};
use crate::bound::{Bounded, Real, U};
use crate::camera::Projection;

/// Largest reference distance, the longest difference of two coordinates.
const REFERENCE_MAX: u32 = 1 << 24;

/// A light: an orthographic view is a directional light, a perspective a spot light that
/// shines into the view's frustum, in all directions alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// What it shines at.
    pub view: View,
    /// Linear irradiance of a surface at right angles to the light: anywhere, or at the
    /// reference distance from a spot light.
    pub strength: [f32; 3],
    /// Reference distance of a spot light in lattice steps, 1 to 2^24.
    pub reference: u32,
}

impl Lamp {
    /// Checks a light.
    ///
    /// # Errors
    /// A strength that is negative or not finite, a distance beyond its limits.
    pub fn new(view: View, strength: [f32; 3], reference: u32) -> Result<Self, RsmError> {
        sound(strength)?;
        within("the reference distance", reference, 1, REFERENCE_MAX)?;
        Ok(Self {
            view,
            strength,
            reference,
        })
    }

    /// What a texel's strength and colour are multiplied by, in square steps: light that a
    /// directional light sends through a texel is strength times the texel's area; a spot
    /// light's is strength times the squared reference distance times the solid angle of
    /// the texel, its area on the plane at distance 1 times the third power of the cosine
    /// in the texel's middle. A surface gives back its colour's part, of which 1 / pi per
    /// unit of solid angle straight ahead (Lambert). A kernel that asks every `stride`-th texel
    /// takes it for the square of `stride` times `stride` around it.
    pub fn weight(&self, texel: usize, stride: u32) -> f64 {
        let [width, height] = [self.view.size.width, self.view.size.height].map(f64::from);
        let flux = match self.view.projection {
            Projection::Orthographic { height: steps } => {
                let side = steps / height;
                side * side
            }
            Projection::Perspective { fov } => {
                let side = 2.0 * libm::tan(fov.to_radians() / 2.0) / height;
                let columns = self.view.size.width as usize;
                let x = ((texel % columns) as f64 + 0.5 - width / 2.0) * side;
                let y = ((texel / columns) as f64 + 0.5 - height / 2.0) * side;
                let reach = side * f64::from(self.reference);
                let square = 1.0 + x * x + y * y;
                reach * reach / (square * square.sqrt())
            }
        };
        flux * f64::from(stride).powi(2) / std::f64::consts::PI
    }

    /// Intensity of a texel that sees a triangle. The weight is given to every leg, rounded
    /// to `f32` once.
    fn intensity(&self, model: &Model, texel: usize, surface: &Surface, stride: u32) -> Colour {
        let value = self.weight(texel, stride);
        let weight = Bounded {
            value,
            bound: U * value,
        };
        let colour = model.colours[surface.triangle as usize];
        [0, 1, 2].map(|i| {
            let [strength, colour] = [self.strength[i], colour[i]];
            weight
                .mul(Bounded::exact(f64::from(strength)))
                .mul(Bounded::exact(f64::from(colour)))
        })
    }
}

/// A texel as a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// From where, and to which side.
    pub surface: Surface,
    /// Linear intensity straight ahead of the surface, in irradiance times square steps.
    pub intensity: [f32; 3],
}

/// A reflective shadow map.
#[derive(Clone, Debug, PartialEq)]
pub struct Rsm {
    /// What the light sees.
    pub seen: Gbuffer,
    /// Intensity of each texel, [`DARK`] where nothing is seen.
    pub intensity: Vec<Colour>,
}

impl Rsm {
    /// The second half of [`rsm`], of what the light sees.
    pub fn lit(model: &Model, lamp: &Lamp, seen: Gbuffer, parameters: &Parameters) -> Self {
        let intensity = |(texel, surface): (usize, &Option<Surface>)| match surface {
            Some(surface) => lamp.intensity(model, texel, surface, parameters.stride),
            None => DARK,
        };
        Self {
            intensity: seen.surfaces.iter().enumerate().map(intensity).collect(),
            seen,
        }
    }

    /// The texels that are lights, as later stages are given them: rounded to `f32` once,
    /// and no brighter than it can say.
    pub fn lights(&self) -> Vec<Option<Light>> {
        let light = |(surface, intensity): (&Option<Surface>, &Colour)| {
            #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
            let intensity = intensity.map(|c| c.value.min(f64::from(f32::MAX)) as f32);
            surface.map(|surface| Light { surface, intensity })
        };
        let texels = self.seen.surfaces.iter().zip(&self.intensity);
        texels.map(light).collect()
    }
}

/// Stage `rsm`: [`gbuffer`] from the light, and the intensity of each texel, a light by
/// itself (Dachsbacher and Stamminger 2005, section 3.1).
pub fn rsm(model: &Model, lamp: &Lamp, parameters: &Parameters) -> Rsm {
    Rsm::lit(
        model,
        lamp,
        gbuffer(model, &lamp.view, parameters),
        parameters,
    )
}
