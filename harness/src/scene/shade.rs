//! Colours of faces: one per triangle and instance, before any leg runs.

use super::file::Light;
use super::value::COLOUR_MAX;
use crate::vector::{add, cross, dot, length, normalize, scale, sub};

/// Flat, two-sided Lambertian shading without shadows.
///
/// `corners` are in world space; the light is taken at their centroid. A face
/// without a normal, or on top of a point light, gets ambient light only. The
/// result is rounded to `f32` once.
///
/// # Errors
/// A component beyond [`COLOUR_MAX`], which a near point light can cause.
pub(super) fn face(
    lights: &[Light],
    reflectance: [f64; 3],
    corners: [[f64; 3]; 3],
) -> Result<[f32; 3], String> {
    let [a, b, c] = corners;
    // Edges are brought to length 1 first: their product then neither vanishes nor
    // overflows, whatever the scale.
    let normal = normalize(cross(normalize(sub(b, a)), normalize(sub(c, a))));
    let third = |x: f64| x / 3.0;
    let centroid = add(add(a.map(third), b.map(third)), c.map(third));
    let light = lights.iter().fold([0.0; 3], |sum, light| {
        add(sum, arriving(light, normal, centroid))
    });
    let colour = [0, 1, 2].map(|i| light[i] * reflectance[i]);
    match colour.iter().find(|x| !(0.0..=COLOUR_MAX).contains(*x)) {
        None => Ok(colour.map(single)),
        Some(x) => Err(format!("shading gives {x:e}, beyond {COLOUR_MAX:e}")),
    }
}

fn arriving(light: &Light, normal: [f64; 3], at: [f64; 3]) -> [f64; 3] {
    match light {
        Light::Ambient { intensity } => intensity.0,
        Light::Directional {
            direction,
            intensity,
        } => scale(intensity.0, dot(normal, normalize(direction.0)).abs()),
        Light::Point {
            position,
            intensity,
        } => {
            let way = sub(at, position.0);
            let cosine = dot(normal, normalize(way)).abs();
            // A cosine of zero wins over a distance of zero.
            let falloff = match cosine > 0.0 {
                true => cosine / length(way) / length(way),
                false => 0.0,
            };
            scale(intensity.0, falloff)
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to f32 is the purpose; the range is checked"
)]
pub(super) fn single(v: f64) -> f32 {
    v as f32
}
