//! The default camera: a perspective that just shows everything.

use triptych_spec::camera::{Camera, Projection};

use crate::vector::{add, cross, dot, length, normalize, scale, sub};

/// Full vertical angle in degrees.
const FOV: f64 = 45.0;

/// The view is from here towards the middle: slightly right and above.
const FROM: [f64; 3] = [0.4, 0.35, 1.0];

/// Up on the picture, as far as the view allows.
const UP: [f64; 3] = [0.0, 1.0, 0.0];

/// The camera that comes as near to `points` as it can with all of them in view
/// and a margin; the unit cube's if there are none.
pub(super) fn camera<I: Iterator<Item = [f64; 3]>>(points: impl Fn() -> I, aspect: f64) -> Camera {
    let bounds = points().fold(None, |bounds: Option<[[f64; 3]; 2]>, p| {
        let [low, high] = bounds.unwrap_or([p, p]);
        let low = [0, 1, 2].map(|i| low[i].min(p[i]));
        Some([low, [0, 1, 2].map(|i| high[i].max(p[i]))])
    });
    let Some([low, high]) = bounds else {
        return camera(unit_cube, aspect);
    };
    let centre = add(scale(low, 0.5), scale(high, 0.5));
    // A single point has no size, and far from the origin a tiny one would drown in
    // rounding: 1e-9 of the distance leaves 23 bits for the picture.
    let radius = length(sub(scale(high, 0.5), scale(low, 0.5)));
    let radius = match radius.max(1e-9 * length(centre)) {
        0.0 => 1.0,
        radius => radius,
    };
    let back = normalize(FROM);
    let right = normalize(cross(UP, back));
    let up = cross(back, right);
    let tan = libm::tan(FOV.to_radians() / 2.0);
    // A point at height h over the line of sight is in view from h / tan behind it.
    let reach = |p: [f64; 3]| {
        let p = sub(p, centre);
        let aside = (dot(p, right).abs() / (tan * aspect)).max(dot(p, up).abs() / tan);
        dot(p, back) + 1.05 * aside
    };
    // At least a tenth of the radius is left in front of the nearest point.
    let distance = points().map(reach).fold(1.1 * radius, f64::max);
    let nearest = points().map(|p| dot(sub(p, centre), back));
    let nearest = nearest.fold(f64::NEG_INFINITY, f64::max);
    let distance = distance.max(nearest + 0.1 * radius);
    Camera {
        eye: add(centre, scale(back, distance)),
        target: centre,
        up: UP,
        projection: Projection::Perspective { fov: FOV },
        near: 0.9 * (distance - nearest),
        far: distance + 1.01 * radius,
    }
}

/// Two opposite corners of the unit cube around the origin.
fn unit_cube() -> std::array::IntoIter<[f64; 3], 2> {
    [[-0.5; 3], [0.5; 3]].into_iter()
}
