//! Sweeps of how large, how far away and how thin things are.

use super::super::shot::Vertex;
use super::super::sweeps::{Step, power, scaled, step};
use super::super::triangles::slivers;
use super::scenes::{SEED, Triangles, floor, in_the_air, room};
use super::shot::{Form, LdmShot};
use crate::generate::Random;
use crate::vector::{add, normalize, scale};

/// A scene of this many units, and all that is seen of it alike.
fn of_size(plain: &LdmShot, factor: f64) -> LdmShot {
    LdmShot {
        eye: scale(plain.eye, factor),
        target: scale(plain.target, factor),
        planes: plain.planes.map(|d| d * factor),
        seen: scaled(&plain.seen, factor),
        hidden: scaled(&plain.hidden, factor),
        far: plain.far.map(|far| far * factor),
        ..plain.clone()
    }
}

/// The scene of sizes and offsets.
fn plain() -> LdmShot {
    LdmShot {
        seen: room(),
        far: Some(1.2),
        ..LdmShot::default()
    }
}

/// Powers of two: but for the ends of `f32`, nothing may change at all.
pub(super) fn scale_of_scene() -> Vec<Step<LdmShot>> {
    let of = |exponent: i32| {
        let (label, factor) = power(exponent);
        let shot = LdmShot {
            purpose: format!("a scene of {label} units"),
            // Below, corners are subnormal in the file.
            form: if exponent > -120 {
                Form::Alike
            } else {
                Form::Any
            },
            ..of_size(&plain(), factor)
        };
        step(label, factor, shot)
    };
    let stated = (-2..=2).map(|tens| 10 * tens);
    [-140, -110, -60]
        .into_iter()
        .chain(stated)
        .chain([60, 110])
        .map(of)
        .collect()
}

/// A scene moved from the origin: corners are rounded to `f32` in the file, which the lattice
/// follows.
pub(super) fn offset_over_size() -> Vec<Step<LdmShot>> {
    let of = |(label, factor): (String, f64)| {
        let by = scale([1.0, -0.75, 0.5], 2.0 * factor);
        let moved = |t: &[Vertex; 3]| t.map(|v| add(v, by));
        let plain = plain();
        let shot = LdmShot {
            purpose: format!("a scene at {label} times its size from the origin"),
            eye: add(plain.eye, by),
            target: by,
            seen: plain.seen.iter().map(moved).collect(),
            ..plain
        };
        step(label, factor, shot)
    };
    let none = [("0".to_owned(), 0.0), ("1".to_owned(), 1.0)];
    none.into_iter()
        .chain([4, 8, 12, 16, 18, 20, 22].map(power))
        .map(of)
        .collect()
}

/// An eye ever farther away: it is on the lattice, so the scene has ever fewer steps of it, down to
/// where a pixel is as narrow as one may be.
pub(super) fn eye_far_away() -> Vec<Step<LdmShot>> {
    let of = |exponent: i32| {
        let (label, factor) = power(exponent);
        let distance = 2.0 * factor;
        let eye = scale(normalize([2.0, 2.6, 3.4]), distance);
        let fov = 2.0 * libm::atan(1.3 / distance).to_degrees();
        let shot = LdmShot {
            purpose: format!("seen from {label} times its size away"),
            eye,
            projection: format!("fov = {fov:?}"),
            planes: [0.5 * distance, 2.0 * distance],
            ..plain()
        };
        step(label, factor, shot)
    };
    [1, 2, 4, 6, 8, 10, 11, 12, 13, 14, 16, 18].map(of).to_vec()
}

/// Needles of one length over a floor, ever thinner, until the lattice has no width for them.
pub(super) fn aspect() -> Vec<Step<LdmShot>> {
    let of = |exponent| {
        let (label, aspect) = power(exponent);
        let needles = slivers(&mut Random::new(SEED), 40, [1.2, 1.2 / aspect]);
        let up = |t: &[Vertex; 3]| t.map(|v| add(v, [0.0, 0.7, 0.0]));
        let (above, among): (Triangles, Triangles) = needles
            .iter()
            .map(up)
            .partition(|t| t.iter().all(|v| v[1] > 0.1));
        let shot = LdmShot {
            purpose: format!("needles {label} times as long as wide"),
            seen: [floor(), above].concat(),
            hidden: among,
            ..LdmShot::default()
        };
        step(label, aspect, shot)
    };
    (0..=12).map(|twos| of(2 * twos)).collect()
}

/// Triangles over a floor, from some pixels to less than a step of the lattice.
pub(super) fn size_in_pixels() -> Vec<Step<LdmShot>> {
    let of = |exponent: i32| {
        let (label, size) = power(exponent);
        let pixel = libm::sqrt(8.0) / 64.0;
        let shot = LdmShot {
            purpose: format!("triangles of {label} pixels"),
            seen: floor(),
            hidden: in_the_air(60, [size * pixel, 0.8]),
            ..LdmShot::default()
        };
        step(label, size, shot)
    };
    [3, 2, 1, 0, -1, -2, -4, -6, -7, -8, -12, -16, -20]
        .map(of)
        .to_vec()
}
