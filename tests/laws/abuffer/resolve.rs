//! Laws of blending.

use proptest::prelude::*;
use triptych_spec::abuffer::{NOTHING, Opaque, Sorted, resolve};
use triptych_spec::bound::{Bounded, TINY, gamma};
use triptych_spec::raster::Fragment;
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use super::{Layers, layers, opacity, painted, sort};
use crate::config;
use crate::loose::Loose;

/// One channel of a list: colour and opacity of each layer, nearest first.
type Channel = Vec<[f32; 2]>;

/// A stack of layers over one pixel, resolved.
fn pixel(layers: &[[f32; 4]], behind: [f32; 3]) -> [Bounded; 3] {
    let rows = 0..u32::try_from(layers.len()).expect("few layers");
    let primitives = Primitives {
        samples: triptych_spec::raster::Samples::ONE,
        size: Size {
            width: 1,
            height: 1,
        },
        bits: 8,
        snapped: Vec::new(),
        prims: vec![[0; 3]; layers.len()],
        source: rows.clone().collect(),
    };
    let nothing = Opaque {
        key: vec![NOTHING],
        prim: vec![NOTHING],
    };
    let fragment = |prim| Fragment {
        pixel: 0,
        prim,
        key: prim,
        mask: 1,
    };
    let sorted = Sorted {
        offsets: vec![0, rows.end],
        fragments: rows.map(fragment).collect(),
    };
    resolve(
        &painted(&primitives, layers, behind),
        &primitives,
        &nothing,
        &sorted,
    )[0]
}

/// Colours: dark, plain, and as bright as a strong light makes them.
fn shade() -> impl Strategy<Value = f32> {
    prop_oneof![1 => Just(0.0_f32), 5 => 0_f32..2.0, 1 => 0_f32..1e6, 1 => (0_f32..1.0).prop_map(|x| x * 1e-36)]
}

fn stack(most: usize) -> impl Strategy<Value = Vec<[f32; 4]>> {
    let layer = (shade(), shade(), shade(), opacity());
    prop::collection::vec(layer.prop_map(|(r, g, b, a)| [r, g, b, a]), 0..most)
}

fn behind() -> impl Strategy<Value = [f32; 3]> {
    [shade(), shade(), shade()]
}

fn front_to_back(machine: &mut Loose, layers: &Channel, behind: f32) -> f32 {
    let (mut sum, mut transmittance) = (0.0, 1.0);
    for [colour, a] in layers {
        let weight = machine.mul(transmittance, *a);
        sum = machine.mul_add(weight, *colour, sum);
        let through = machine.sub(1.0, *a);
        transmittance = machine.mul(transmittance, through);
    }
    machine.mul_add(transmittance, behind, sum)
}

fn back_to_front(machine: &mut Loose, layers: &Channel, behind: f32) -> f32 {
    layers.iter().rev().fold(behind, |below, [colour, a]| {
        let through = machine.sub(1.0, *a);
        let rest = machine.mul(through, below);
        machine.mul_add(*a, *colour, rest)
    })
}

/// Colour and transmittance of some layers, each half for itself.
fn in_halves(machine: &mut Loose, layers: &[[f32; 2]]) -> [f32; 2] {
    match layers {
        [] => [0.0, 1.0],
        [[colour, a]] => [machine.mul(*a, *colour), machine.sub(1.0, *a)],
        _ => {
            let (front, back) = layers.split_at(layers.len() / 2);
            let (front, back) = (in_halves(machine, front), in_halves(machine, back));
            let sum = machine.mul_add(front[1], back[0], front[0]);
            [sum, machine.mul(front[1], back[1])]
        }
    }
}

fn resolved(layers: &Layers, depth_test: bool) -> Vec<[Bounded; 3]> {
    let sorted = sort(&layers.build(depth_test, u32::MAX));
    resolve(&layers.scene, &layers.primitives, &layers.opaque(), &sorted)
}

/// Room for the roundings of two evaluations in f64 that differ in order: each has
/// at most `3n + 3` a term, none of which exceeds `scale`.
fn f64_error(n: usize, scale: f64) -> f64 {
    2.0 * (3 * n + 3) as f64 * f64::EPSILON * scale
}

/// The closed form of the bound, by hand: neither looser nor tighter than derived.
#[test]
fn the_bound_counts_roundings() {
    let mut layers = [[0.0, 0.0, 0.0, 0.5]; 5];
    // Red and the background meet roundings: 2 * 3 + 5 + 3 and 2 * 5 + 5 + 3.
    layers[3][0] = 2.0;
    let [red, green, blue] = pixel(&layers, [0.0, 4.0, 0.0]);
    let close = |bounded: Bounded, k: u32| {
        let must = gamma(k) * bounded.value;
        assert!(
            (bounded.bound / must - 1.0).abs() < 1e-12,
            "{bounded:?} {k}"
        );
    };
    close(red, 14);
    close(green, 18);
    // Six terms of nothing, each of three operations that flush.
    assert_eq!(blue.bound.to_bits(), (18.0 * TINY).to_bits(), "{blue:?}");
    // An invisible layer's colour is a factor of what its weight's operations flush.
    layers[3] = [2.0, 0.0, 0.0, 0.0];
    let [red, ..] = pixel(&layers, [0.0; 3]);
    let must = (f64::from(3 * 3 + 2) * 2.0 + 18.0) * TINY;
    assert_eq!(red.bound.to_bits(), must.to_bits(), "{red:?}");
}

proptest! {
    #![proptest_config(config(4000))]

    /// Blended in f32 from the front, from the back or in halves, rounded, fused and
    /// flushed at will, a pixel stays inside its bound.
    #[test]
    fn bounds_hold(layers in stack(40), behind in behind(), seed in any::<u64>()) {
        let bounded = pixel(&layers, behind);
        let mut machine = Loose::new(seed);
        for (channel, bounded) in bounded.iter().enumerate() {
            let all: Channel = layers.iter().map(|l| [l[channel], l[3]]).collect();
            let behind = behind[channel];
            let [sum, through] = in_halves(&mut machine, &all);
            let seen = [
                front_to_back(&mut machine, &all, behind),
                back_to_front(&mut machine, &all, behind),
                machine.mul_add(through, behind, sum),
            ];
            for seen in seen {
                prop_assert!(bounded.admits(f64::from(seen)), "{seen:e} against {bounded:?}");
            }
        }
    }

    /// Layers of opacity 0 change no value.
    #[test]
    fn invisible_layers(
        layers in stack(12),
        behind in behind(),
        at in prop::collection::vec(any::<prop::sample::Index>(), 0..4),
    ) {
        let mut more = layers.clone();
        for at in at {
            more.insert(at.index(more.len() + 1), [1.0, 1.0, 1.0, 0.0]);
        }
        let (plain, more) = (pixel(&layers, behind), pixel(&more, behind));
        prop_assert_eq!(plain.map(|c| c.value), more.map(|c| c.value));
    }

    /// `n` equal layers: `c (1 - (1 - a)^n) + (1 - a)^n b`.
    #[test]
    fn equal_layers(n in 0_u16..60, layer in [0_f32..2.0, 0_f32..2.0, 0_f32..2.0, 0_f32..1.0], behind in behind()) {
        let seen = pixel(&vec![layer; n.into()], behind);
        let through = (1.0 - f64::from(layer[3])).powi(n.into());
        for channel in 0..3 {
            let [c, b] = [layer[channel], behind[channel]].map(f64::from);
            let expected = c * (1.0 - through) + through * b;
            let error = (seen[channel].value - expected).abs();
            prop_assert!(error <= f64_error(n.into(), b.max(c)), "{seen:?} for {expected}");
        }
    }

    /// A pixel is no darker than its darkest layer and no brighter than its brightest,
    /// what lies behind included; so in a furnace of one colour, all is that colour.
    #[test]
    fn blending_is_a_mean(layers in stack(20), behind in behind(), furnace in any::<bool>()) {
        let layers: Vec<[f32; 4]> = match furnace {
            true => layers.iter().map(|l| [behind[0], behind[1], behind[2], l[3]]).collect(),
            false => layers,
        };
        let seen = pixel(&layers, behind);
        for channel in 0..3 {
            let all = || layers.iter().map(|l| l[channel]).chain([behind[channel]]);
            let (low, high) = (all().fold(f32::MAX, f32::min), all().fold(0.0, f32::max));
            let (low, high) = (f64::from(low), f64::from(high));
            let room = f64_error(layers.len(), high);
            let value = seen[channel].value;
            prop_assert!(low - room <= value && value <= high + room, "{low} {value} {high}");
        }
    }

    /// Colours and background times a power of two: the picture times it, exactly.
    #[test]
    fn powers_of_two(layers in stack(20), behind in behind(), exponent in 0_i32..40) {
        let factor = f64::from(exponent).exp2();
        #[expect(clippy::cast_possible_truncation, reason = "a power of two is exact")]
        let short = factor as f32;
        let brighter = |[r, g, b, a]: &[f32; 4]| [r * short, g * short, b * short, *a];
        let scaled: Vec<[f32; 4]> = layers.iter().map(brighter).collect();
        let seen = pixel(&scaled, behind.map(|c| c * short));
        let must = pixel(&layers, behind).map(|c| c.value * factor);
        prop_assert_eq!(seen.map(|c| c.value), must);
    }

    /// What lies at or behind an opaque surface does not show, stored or not.
    #[test]
    fn hidden_layers(layers in layers(0..8)) {
        prop_assert_eq!(resolved(&layers, true), resolved(&layers, false));
    }
}
