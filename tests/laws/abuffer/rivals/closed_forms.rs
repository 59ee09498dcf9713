//! Rivals in closed form.

use triptych_spec::abuffer::{Lens, Target, halves};
use triptych_spec::raster::Samples;
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use super::super::{Layers, painted};
use super::{Picture, stack};

/// Four quads in closed form: half of what lies behind goes through each.
#[test]
fn closed_forms() {
    let quad = |key: i32, red: f32| (key, [red, 0.0, 1.0, 0.5]);
    let quarter = 1 << 29;
    let four = [
        quad(0, 1.0),
        quad(quarter, 2.0),
        quad(2 * quarter, 4.0),
        quad(3 * quarter, 8.0),
    ];
    let behind = [16.0, 0.0, 1.0];
    let layers = stack(&four, behind);
    let value = |picture: &Picture, c: usize| picture[0][c].value;
    let exactly = |seen: f64, must: f64, what: &str| {
        assert!(
            (seen - must).abs() <= 1e-12 * must.abs(),
            "{what}: {seen}, must be {must}"
        );
    };
    // 1/2 + 2/4 + 4/8 + 8/16 + 16/16.
    let opaque = layers.opaque();
    let ends = halves(&layers.scene, &layers.primitives, &opaque, &layers.sorted());
    exactly(value(&ends, 0), 3.0, "both ends");
    exactly(value(&ends, 2), 1.0, "white stays white");
    // In order of submission: ((((1/2) + 2) / 2 + 4) / 2 + 8) / 2 + 16/16, with halves of each.
    let submitted = 0.5 * 8.0 + 0.25 * 4.0 + 0.125 * 2.0 + 0.0625 + 1.0;
    exactly(value(&layers.alpha(Target::Single), 0), submitted, "alpha");
    // Weights by equation 10: (1 - d)^3 for d = 0, 1/4, 1/2, 3/4.
    let weights = [1.0, 27.0 / 64.0, 1.0 / 8.0, 1.0 / 64.0];
    let sum: f64 = weights.iter().sum();
    let mean = weights
        .iter()
        .zip([1.0, 2.0, 4.0, 8.0])
        .map(|(w, c)| w * c)
        .sum::<f64>()
        / sum;
    exactly(
        value(&layers.weighted(), 0),
        mean * 15.0 / 16.0 + 1.0,
        "weighted",
    );
    // A quarter of the depth range between neighbours.
    let e = (-0.5_f64).exp();
    let dense = 0.5 + e * 0.5 + e * e * 0.5 + e * e * e * 0.5 + e * e * e;
    exactly(value(&layers.dense(2.0), 0), dense, "density");
}

/// A lone pixel in the middle of a target spreads evenly over its square, and an even surface
/// stays even.
#[test]
fn circles_keep_light() {
    let lens = Lens {
        focus: 0,
        aperture: 4,
        radius: 8,
    };
    assert_eq!(
        [0, 1 << 29, 1 << 30, 3 << 29, u32::MAX >> 1].map(|key| lens.radius_at(key)),
        [0, 1, 2, 3, 3]
    );
    let key = 1 << 29;
    let size = Size {
        width: 7,
        height: 5,
    };
    let corners = |x: [i32; 2], y: [i32; 2]| {
        let [left, right] = x.map(|x| x * 256);
        let [top, bottom] = y.map(|y| y * 256);
        [
            [left, top, key],
            [right, top, key],
            [left, bottom, key],
            [right, bottom, key],
        ]
    };
    let picture = |x, y| {
        let primitives = Primitives {
            size,
            bits: 8,
            samples: Samples::default(),
            snapped: corners(x, y).to_vec(),
            prims: vec![[0, 1, 2], [1, 3, 2]],
            source: vec![0, 1],
        };
        let scene = painted(&primitives, &[[1.0, 1.0, 1.0, 0.5]; 2], [0.0; 3]);
        Layers { scene, primitives }.blurred(lens)
    };
    let lone = picture([3, 4], [2, 3]);
    for (pixel, [red, ..]) in (0_i32..).zip(&lone) {
        let within = (pixel % 7 - 3).abs() <= 1 && (pixel / 7 - 2).abs() <= 1;
        let must = if within { 0.5 / 9.0 } else { 0.0 };
        assert!((red.value - must).abs() < 1e-12, "pixel {pixel}: {red:?}");
    }
    for [red, ..] in picture([-8, 16], [-8, 16]) {
        assert!((red.value - 0.5).abs() < 1e-12, "an even surface: {red:?}");
    }
}
