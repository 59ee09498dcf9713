//! Stage `primary`: the rays of pixels.

use super::DispatchError;
use super::ray::{Carried, Ray, WEIGHT_ONE};
use crate::camera::{Camera, Projection};
use crate::grid::lattice::{Lattice, Point, REACH};
use crate::grid::ray::Ray as Way;
use crate::scene::Size;
use crate::vertex::TARGET_MAX;

/// Bits behind the point of what a row or a column adds.
const FRACTION: u32 = 7;

/// Largest component of a direction, so that with [`FRACTION`] bits it has 30.
const LONGEST: f64 = (1_u32 << 22) as f64;

/// A point or a direction that differs from pixel to pixel: `corner + x right + y down`, in
/// units of 2^-7, to which each of the three is rounded: a pixel's is off by `(1 + x + y) / 256`
/// at most, before it is rounded itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plane {
    /// Of the first pixel of the first row.
    pub corner: Point,
    /// From one column to the next.
    pub right: Point,
    /// From one row to the next.
    pub down: Point,
}

impl Plane {
    /// Of three vectors whose sums over the picture stay below 2^23 in each component.
    fn new(corner: [f64; 3], right: [f64; 3], down: [f64; 3]) -> Self {
        let scale = f64::from(1_u32 << FRACTION);
        #[expect(clippy::cast_possible_truncation, reason = "below 2^30")]
        let fixed = |v: [f64; 3]| v.map(|c| libm::rint(c * scale) as i32);
        Self {
            corner: fixed(corner),
            right: fixed(right),
            down: fixed(down),
        }
    }

    /// At a pixel, rounded to the nearest integers, halves up. Sums may leave 32 bits on the
    /// way, but not in the end, so that kernels may let them wrap around.
    pub fn at(&self, x: u32, y: u32) -> Point {
        let half = 1_i64 << (FRACTION - 1);
        [0, 1, 2].map(|axis| {
            let step = |by: Point, times: u32| i64::from(by[axis]) * i64::from(times);
            let sum = i64::from(self.corner[axis]) + step(self.right, x) + step(self.down, y);
            i32::try_from((sum + half) >> FRACTION).expect("below 2^24")
        })
    }
}

/// What is seen of the world: where each pixel's ray starts, and where it goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Eye {
    /// Of the picture.
    pub size: Size,
    /// Where rays start; the same for all pixels of a perspective.
    pub origin: Plane,
    /// Where they go; the same for all pixels of an orthographic view.
    pub direction: Plane,
}

impl Eye {
    /// A camera of the world, on the lattice. Its clip planes are not used: a ray begins at the eye.
    ///
    /// # Errors
    /// A size beyond the limits, a camera without a matrix, an eye or a picture that is not on
    /// the lattice.
    pub fn new(camera: &Camera, lattice: &Lattice, size: Size) -> Result<Self, DispatchError> {
        for (name, value) in [("the width", size.width), ("the height", size.height)] {
            super::world::within(name, value.into(), 1, TARGET_MAX.into())?;
        }
        let [width, height] = [size.width, size.height].map(f64::from);
        let [right, up, forward] = camera.axes(width / height)?;
        // Of the whole picture, and of a pixel.
        let sum = |terms: [([f64; 3], f64); 3]| {
            [0, 1, 2].map(|axis| terms.iter().map(|(v, by)| v[axis] * by).sum::<f64>())
        };
        let first = [1.0 / width - 1.0, 1.0 - 1.0 / height];
        let spread = |forward: [f64; 3], ahead: f64, scale: f64| {
            let corner = sum([
                (right, first[0] * scale),
                (up, first[1] * scale),
                (forward, ahead * scale),
            ]);
            let steps = [2.0 / width, -2.0 / height].map(|s| s * scale);
            let [across, below] =
                [(right, steps[0]), (up, steps[1])].map(|(v, s)| v.map(|c| c * s));
            Plane::new(corner, across, below)
        };
        let still = |v: [f64; 3]| Plane::new(v, [0.0; 3], [0.0; 3]);
        match camera.projection {
            Projection::Perspective { .. } => {
                let eye = lattice
                    .snap(camera.eye)
                    .ok_or(DispatchError::TooFar("the eye"))?;
                let largest = [0, 1, 2]
                    .map(|axis| right[axis].abs() + up[axis].abs() + forward[axis].abs())
                    .into_iter()
                    .fold(0.0, f64::max);
                Ok(Self {
                    size,
                    origin: still(eye.map(f64::from)),
                    direction: spread(forward, 1.0, LONGEST / largest),
                })
            }
            Projection::Orthographic { .. } => {
                let steps = |length: f64| libm::scalbn(length, -lattice.exponent);
                let eye = [0, 1, 2].map(|axis| steps(camera.eye[axis] - lattice.centre[axis]));
                let reach = [0, 1, 2]
                    .map(|axis| eye[axis].abs() + steps(right[axis].abs() + up[axis].abs()));
                let within = reach.iter().all(|c| *c <= f64::from(REACH - 1));
                if !within {
                    return Err(DispatchError::TooFar("the picture"));
                }
                let mut origin = spread([0.0; 3], 0.0, steps(1.0));
                let base = still(eye);
                origin.corner = [0, 1, 2].map(|axis| origin.corner[axis] + base.corner[axis]);
                let direction = still(forward.map(|c| c * LONGEST));
                let eye = Self {
                    size,
                    origin,
                    direction,
                };
                // Rounded steps add up: to 17 at most in the last corner.
                match eye.begins_within(REACH) {
                    true => Ok(eye),
                    false => Err(DispatchError::TooFar("the picture")),
                }
            }
        }
    }

    /// Whether all rays begin where coordinates are at most `reach`: those of the corners do, then.
    fn begins_within(&self, reach: i32) -> bool {
        let [right, bottom] = [self.size.width - 1, self.size.height - 1];
        let corners = [[0, 0], [right, 0], [0, bottom], [right, bottom]];
        let within = |p: Point| p.iter().all(|c| (-reach..=reach).contains(c));
        corners.iter().all(|[x, y]| within(self.origin.at(*x, *y)))
    }

    /// The ray of a pixel.
    pub fn ray(&self, pixel: u32) -> Way {
        let (x, y) = (pixel % self.size.width, pixel / self.size.width);
        Way {
            origin: self.origin.at(x, y),
            direction: self.direction.at(x, y),
            segment: false,
        }
    }
}

/// Stage `primary` (paper listing 3, `Generate_PrimRays`): the ray through the middle of each
/// pixel, row by row.
pub fn primary(eye: &Eye) -> impl Iterator<Item = Ray> + '_ {
    let pixels = eye.size.width * eye.size.height;
    (0..pixels).map(|pixel| Ray {
        way: eye.ray(pixel),
        pixel,
        depth: 0,
        carried: Carried::Weight([WEIGHT_ONE; 3]),
    })
}
