//! The default camera: a perspective that shows everything.

use triptych_spec::camera::{Camera, Projection};

use crate::vector::{add, length, normalize, scale, sub};

/// Full vertical angle in degrees.
const FOV: f64 = 45.0;

/// The view is from here towards the middle: slightly right and above.
const FROM: [f64; 3] = [0.4, 0.35, 1.0];

/// A camera that sees the ball around the bounding box of `points`; the unit cube
/// if there are none.
pub(super) fn camera(points: impl Iterator<Item = [f64; 3]>, aspect: f64) -> Camera {
    let mut bounds: Option<[[f64; 3]; 2]> = None;
    for p in points {
        let [low, high] = bounds.unwrap_or([p, p]);
        bounds = Some([
            [0, 1, 2].map(|i| low[i].min(p[i])),
            [0, 1, 2].map(|i| high[i].max(p[i])),
        ]);
    }
    let [low, high] = bounds.unwrap_or([[-0.5; 3], [0.5; 3]]);
    let centre = add(scale(low, 0.5), scale(high, 0.5));
    // A single point has no size, and far from the origin a tiny one would drown in
    // rounding: 1e-9 of the distance leaves 23 bits for the picture.
    let radius = length(sub(scale(high, 0.5), scale(low, 0.5)));
    let radius = match radius.max(1e-9 * length(centre)) {
        0.0 => 1.0,
        radius => radius,
    };
    let half = libm::tan(FOV.to_radians() / 2.0) * aspect.min(1.0);
    // sin(atan(x)) = x / sqrt(1 + x^2); at most sin(22.5 degrees), so the eye stays
    // outside of the ball.
    let distance = radius * (1.0 + half * half).sqrt() / half;
    Camera {
        eye: add(centre, scale(normalize(FROM), distance)),
        target: centre,
        up: [0.0, 1.0, 0.0],
        projection: Projection::Perspective { fov: FOV },
        near: distance - 1.01 * radius,
        far: distance + 1.01 * radius,
    }
}
