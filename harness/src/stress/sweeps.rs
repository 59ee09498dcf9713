//! The sweeps, and the scene of each of their steps.

use triptych_spec::bound::{TINY, U};
use triptych_spec::vertex::GUARD;

use super::shot::{Edge, Shot, Vertex};
use super::triangles::{deep, grazing, layers, mix, slivers};
use crate::generate::Random;
use crate::vector::{add, scale};

/// Seed of everything that is drawn: a step is the same scene on every machine.
const SEED: u64 = 4;

/// One number that grows from step to step.
pub struct Sweep<S = Shot> {
    /// What it is called.
    pub name: &'static str,
    /// What the number is.
    pub axis: &'static str,
    make: fn() -> Vec<Step<S>>,
}

/// One scene of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Step<S = Shot> {
    /// The number as it is written: `2^-100`.
    pub label: String,
    /// The number.
    pub value: f64,
    /// The scene.
    pub shot: S,
}

impl<S> Sweep<S> {
    /// A sweep of the steps that a function makes.
    pub fn new(name: &'static str, axis: &'static str, make: fn() -> Vec<Step<S>>) -> Self {
        Self { name, axis, make }
    }

    /// Its steps, in order.
    pub fn steps(&self) -> Vec<Step<S>> {
        (self.make)()
    }
}

/// All of them.
pub fn sweeps() -> Vec<Sweep> {
    let sweep = Sweep::new;
    vec![
        sweep("scale", "size of the scene in units", scale_of_scene),
        sweep(
            "offset",
            "distance from the origin over size",
            offset_over_size,
        ),
        sweep("sliver", "length of a triangle over its width", aspect),
        sweep(
            "depth",
            "distance of the near plane over the far one's",
            near_over_far,
        ),
        sweep("edge-on", "degrees between a triangle and the view", angle),
        sweep("layers", "layers at every pixel", layers_per_pixel),
    ]
}

/// The sweeps whose name contains one of the patterns; all of them without one.
///
/// # Errors
/// A pattern that selects nothing, with the names that there are.
pub fn select<S>(all: Vec<Sweep<S>>, patterns: &[String]) -> Result<Vec<Sweep<S>>, String> {
    for pattern in patterns {
        if !all.iter().any(|s| s.name.contains(pattern.as_str())) {
            let names: Vec<&str> = all.iter().map(|s| s.name).collect();
            let names = names.join(", ");
            return Err(format!(
                "{pattern}: no sweep is called so; there are: {names}"
            ));
        }
    }
    let wanted = |s: &Sweep<S>| patterns.is_empty() || patterns.iter().any(|p| s.name.contains(p));
    Ok(all.into_iter().filter(wanted).collect())
}

pub(super) fn step<S>(label: String, value: f64, shot: S) -> Step<S> {
    Step { label, value, shot }
}

/// Share of triangles that may go unjudged where the numbers that decide are smaller, by
/// this factor, than those that they are a difference of. Five roundings of these
/// ([`Bounded`](triptych_spec::bound::Bounded), a sum of products) may then be a large
/// part of what decides: from an eighth on WGSL itself promises little, and anything may
/// go unjudged, which the table shows; below, what the corpus allows.
fn budget(cancellation: f64) -> f64 {
    match 5.0 * U * cancellation < 0.125 {
        true => 0.01,
        false => 1.0,
    }
}

/// A flushed subnormal is an error of so many roundings of the scene's size.
fn flushed(size: f64) -> f64 {
    TINY / (size * U)
}

/// Clipping multiplies `w`, which is at most eight sizes, by the guard: where that leaves
/// `f32`, WGSL promises nothing at all.
fn overflowing(size: f64) -> f64 {
    match 8.0 * size * f64::from(GUARD) <= f64::from(f32::MAX) {
        true => 0.0,
        false => f64::INFINITY,
    }
}

pub(super) fn power(exponent: i32) -> (String, f64) {
    (format!("2^{exponent}"), f64::from(exponent).exp2())
}

pub(super) fn scaled(triangles: &[[Vertex; 3]], factor: f64) -> Vec<[Vertex; 3]> {
    let one = |t: &[Vertex; 3]| t.map(|v| scale(v, factor));
    triangles.iter().map(one).collect()
}

/// From the smallest subnormal numbers to the largest of `f32`, and beyond in products. Powers of two,
/// so that rounding alone differs.
fn scale_of_scene() -> Vec<Step> {
    let triangles = mix(&mut Random::new(SEED), 160, 1.0);
    let of = |exponent| {
        let (label, factor) = power(exponent);
        let plain = Shot::default();
        let shot = Shot {
            purpose: format!("a scene of 2^{exponent} units"),
            eye: scale(plain.eye, factor),
            planes: plain.planes.map(|d| d * factor),
            triangles: scaled(&triangles, factor),
            real: Some(factor / 12.0),
            unjudged: budget(flushed(factor).max(overflowing(factor))),
            ..plain
        };
        step(label, factor, shot)
    };
    let small = [-148, -140, -132, -126, -122, -118, -112];
    let large = [100, 116, 120, 124];
    let between = [-100, -80, -60, -40, -20, 0, 20, 40, 60];
    let all = small.into_iter().chain(between).chain(large);
    all.map(of).collect()
}

/// Scene and camera moved from the origin; near 2^24 `f32` holds no more than a few
/// different corners.
fn offset_over_size() -> Vec<Step> {
    let triangles = mix(&mut Random::new(SEED), 160, 1.0);
    let of = |exponent| {
        let (label, factor) = power(exponent);
        let plain = Shot::default();
        // The scene is two units wide.
        let by = scale([1.0, -0.75, 0.5], 2.0 * factor);
        let moved = |t: &[Vertex; 3]| t.map(|v| add(v, by));
        let shot = Shot {
            purpose: format!("a scene at 2^{exponent} times its size from the origin"),
            eye: add(plain.eye, by),
            target: by,
            triangles: triangles.iter().map(moved).collect(),
            unjudged: budget(factor),
            ..plain
        };
        step(label, factor, shot)
    };
    (0..=12).map(|twos| of(2 * twos)).collect()
}

/// Needles of one length, ever thinner.
fn aspect() -> Vec<Step> {
    let of = |exponent| {
        let (label, aspect) = power(exponent);
        let shot = Shot {
            purpose: format!("triangles 2^{exponent} times as long as wide"),
            triangles: slivers(&mut Random::new(SEED), 200, [1.5, 1.5 / aspect]),
            ..Shot::default()
        };
        step(label, aspect, shot)
    };
    (0..=12).map(|twos| of(2 * twos)).collect()
}

/// From a slab thinner than `f32` resolves to a range of 2^24.
fn near_over_far() -> Vec<Step> {
    let of = |(label, near): (String, f64)| {
        let shot = Shot {
            purpose: format!("a near plane at {label} of the far one's distance"),
            eye: [0.0; 3],
            target: [0.0, 0.0, -1.0],
            planes: [8.0 * near, 8.0],
            triangles: deep(&mut Random::new(SEED), 200, [8.0 * near, 8.0]),
            unjudged: budget((1.0 / (1.0 - near)).max(1.0 / near)),
            ..Shot::default()
        };
        step(label, near, shot)
    };
    let thin = [20, 16, 12, 8, 4].map(|e| (format!("1-2^-{e}"), 1.0 - f64::from(-e).exp2()));
    let deep = [-1, -2, -4, -6, -8, -12, -16, -20, -24].map(power);
    thin.into_iter().chain(deep).map(of).collect()
}

/// From face to face with the camera to exactly along the view.
fn angle() -> Vec<Step> {
    let of = |(label, degrees): (String, f64)| {
        let shot = Shot {
            purpose: format!("triangles seen at {label} degrees"),
            eye: [0.0, 0.0, 4.0],
            projection: "height = 2".to_owned(),
            planes: [3.2, 4.8],
            triangles: grazing(&mut Random::new(SEED), 200, degrees.to_radians()),
            ..Shot::default()
        };
        step(label, degrees, shot)
    };
    let mut steps = vec![("90".to_owned(), 90.0), ("45".to_owned(), 45.0)];
    steps.extend((-8..=4).rev().map(power));
    steps.extend([-12, -20].map(power));
    steps.push(("0".to_owned(), 0.0));
    steps.into_iter().map(of).collect()
}

/// Layers of every opacity but 1, thinner where there are more, so that the last one is
/// still seen.
fn layers_per_pixel() -> Vec<Step> {
    let of = |exponent| {
        let (label, count) = power(exponent);
        let opacity = (1.5 / count).min(0.6);
        let shot = Shot {
            purpose: format!("2^{exponent} layers at every pixel"),
            size: [24, 16],
            eye: [0.0, 0.0, 4.0],
            projection: "height = 2".to_owned(),
            planes: [2.0, 6.0],
            triangles: layers(&mut Random::new(SEED), 1 << exponent),
            opacities: [1.0, 0.5, 0.8, 0.1].map(|share| share * opacity).to_vec(),
            edge: Edge(0.001),
            ..Shot::default()
        };
        step(label, count, shot)
    };
    (0..=12).map(of).collect()
}
