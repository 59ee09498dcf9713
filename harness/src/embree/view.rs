//! Camera rays through the samples, in world space.
//!
//! The camera's basis is worked out here once more, from its eye, target and up alone: the
//! matrices that the other legs share have no part in it.

use triptych_spec::camera::{Camera, Projection};
use triptych_spec::scene::Size;
use triptych_spec::vertex::DEPTH_ONE;

use crate::vector::{add, cross, normalize, scale, sub};

/// A camera and its target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    camera: Camera,
    right: [f64; 3],
    up: [f64; 3],
    forward: [f64; 3],
    size: Size,
}

/// A ray in world units. The distance along it is counted in lengths of its direction,
/// which is depth along the line of sight, from its origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: [f64; 3],
    /// One unit of depth.
    pub direction: [f64; 3],
    /// The distances between which the camera sees.
    pub range: [f64; 2],
}

impl View {
    /// The view of a camera.
    pub fn new(camera: Camera, size: Size) -> Self {
        let forward = normalize(sub(camera.target, camera.eye));
        let right = normalize(cross(forward, normalize(camera.up)));
        Self {
            camera,
            right,
            up: cross(right, forward),
            forward,
            size,
        }
    }

    /// Size of the target.
    pub fn size(&self) -> Size {
        self.size
    }

    /// The ray through the sample of a pixel.
    pub fn ray(&self, [column, row]: [u32; 2]) -> Ray {
        let (width, height) = (f64::from(self.size.width), f64::from(self.size.height));
        // In halves of the picture's height.
        let x = (f64::from(column) + 0.5 - width / 2.0) / (height / 2.0);
        let y = (height / 2.0 - f64::from(row) - 0.5) / (height / 2.0);
        let Camera { eye, near, far, .. } = self.camera;
        let aside = |half: f64| add(scale(self.right, x * half), scale(self.up, y * half));
        match self.camera.projection {
            Projection::Perspective { fov } => Ray {
                origin: eye,
                direction: add(self.forward, aside((fov.to_radians() / 2.0).tan())),
                range: [near, far],
            },
            // From the near plane: a ray has no hits behind its origin.
            Projection::Orthographic { height } => Ray {
                origin: add(add(eye, aside(height / 2.0)), scale(self.forward, near)),
                direction: self.forward,
                range: [0.0, far - near],
            },
        }
    }

    /// The depth key, as a real number, at a distance along a ray.
    pub fn key(&self, t: f64) -> f64 {
        let Camera { near, far, .. } = self.camera;
        let depth = match self.camera.projection {
            Projection::Perspective { .. } => far / (far - near) * (1.0 - near / t),
            Projection::Orthographic { .. } => t / (far - near),
        };
        depth * f64::from(DEPTH_ONE)
    }

    /// The most by which the key changes where the distance changes by `by`.
    pub fn key_bound(&self, t: f64, by: f64) -> f64 {
        let Camera { near, far, .. } = self.camera;
        let slope = match self.camera.projection {
            // Steepest at the nearest distance; without a bound if that is the eye.
            Projection::Perspective { .. } => {
                let least = (t - by).max(0.0);
                far * near / (far - near) / (least * least)
            }
            Projection::Orthographic { .. } => 1.0 / (far - near),
        };
        slope * by * f64::from(DEPTH_ONE)
    }

    /// The largest coordinate of what every ray starts from.
    pub fn reach(&self) -> f64 {
        let corners = [
            [0, 0],
            [self.size.width - 1, self.size.height - 1],
            [0, self.size.height - 1],
            [self.size.width - 1, 0],
        ];
        let largest = |v: [f64; 3]| v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let origins = corners.map(|pixel| largest(self.ray(pixel).origin));
        origins.into_iter().fold(0.0, f64::max)
    }
}
