//! Whatever WGSL allows stays inside the bounds of the rivals.

use proptest::prelude::*;
use triptych_spec::abuffer::{SUM_LEAST, Target, attenuation, halves, middle};

use super::{stack, stacks};
use crate::config;
use crate::loose::Loose;

proptest! {
    #![proptest_config(config(300))]

    /// In arithmetic as loose as WGSL's, the picture from both ends, the blend in order of
    /// submission and the weighted sums stay inside their bounds.
    #[test]
    fn bounds_hold(of in stacks(20), seed in any::<u64>()) {
        let behind = [0.25, 0.5, 0.75];
        let layers = stack(&of, behind);
        let opaque = layers.opaque();
        let ends = halves(&layers.scene, &layers.primitives, &opaque, &layers.sorted());
        let alpha = layers.alpha(Target::Single);
        let weights = layers.weighted();
        let mut machine = Loose::new(seed);
        for (c, behind) in behind.into_iter().enumerate() {
            let channel: Vec<[f32; 2]> = of.iter().map(|(_, l)| [l[c], l[3]]).collect();
            for (must, seen) in [
                (ends[0][c], from_both_ends(&mut machine, &channel, behind)),
                (alpha[0][c], in_order(&mut machine, &channel, behind)),
                (weights[0][c], by_weight(&mut machine, &of, c, behind)),
            ] {
                prop_assert!(must.admits(seen.into()), "{seen} is not in {must:?}");
            }
        }
    }

    /// The same of `exp` alone.
    #[test]
    fn bounds_of_attenuation_hold(keys in 0_u32..1 << 31, sigma in 0_f32..80.0, seed in any::<u64>()) {
        let must = attenuation(keys, sigma);
        let mut machine = Loose::new(seed);
        let distance = machine.round(f64::from(keys) / f64::from(1_u32 << 31));
        let x = machine.mul(sigma, distance);
        let seen = exp_of_minus(&mut machine, x);
        prop_assert!(must.admits(seen.into()), "{seen} is not in {must:?}");
    }

    /// The same of what goes through black layers alone, where no colour hides its bound.
    #[test]
    fn bounds_of_what_goes_through_hold(of in stacks(20), seed in any::<u64>()) {
        let black: Vec<_> = of.iter().map(|(key, l)| (*key, [0.0, 0.0, 0.0, l[3]])).collect();
        let must = stack(&black, [0.75; 3]).weighted()[0][0];
        let seen = by_weight(&mut Loose::new(seed), &black, 0, 0.75);
        prop_assert!(must.admits(seen.into()), "{seen} is not in {must:?}");
    }

    /// The same of a medium, with `exp` as far off as WGSL lets it be.
    #[test]
    fn bounds_of_a_medium_hold(of in stacks(12), sigma in 0_f32..30.0, seed in any::<u64>()) {
        let behind = [0.25, 0.5, 0.75];
        let must = stack(&of, behind).dense(sigma)[0];
        let mut machine = Loose::new(seed);
        for (c, behind) in behind.into_iter().enumerate() {
            let seen = through_medium(&mut machine, &of, c, behind, sigma);
            prop_assert!(must[c].admits(seen.into()), "{seen} is not in {:?}", must[c]);
        }
    }
}

fn through_medium(
    machine: &mut Loose,
    layers: &[(i32, [f32; 4])],
    c: usize,
    behind: f32,
    sigma: f32,
) -> f32 {
    let (mut sum, mut through) = (0.0, 1.0);
    for (i, (key, colour)) in layers.iter().enumerate() {
        let weight = machine.mul(through, colour[3]);
        sum = machine.mul_add(weight, colour[c], sum);
        let rest = machine.sub(1.0, colour[3]);
        through = machine.mul(through, rest);
        if let Some((next, _)) = layers.get(i + 1) {
            let distance = machine.round(f64::from(next - key) / f64::from(1_u32 << 31));
            let x = machine.mul(sigma, distance);
            let left = exp_of_minus(machine, x);
            through = machine.mul(through, left);
        }
    }
    machine.mul_add(through, behind, sum)
}

/// `exp(-x)`, up to `3 + 2 x` units in the last place from the exact one.
fn exp_of_minus(machine: &mut Loose, x: f32) -> f32 {
    let exact = f64::from(-x).exp();
    let unit = exact.log2().floor().exp2() * f64::from(f32::EPSILON);
    let off = (2.0 + 2.0 * f64::from(x)) * unit;
    match machine.choose(3) {
        0 => machine.round(exact - off),
        1 => machine.round(exact + off),
        _ => machine.round(exact),
    }
}

fn over(machine: &mut Loose, [colour, a]: [f32; 2], below: f32) -> f32 {
    let through = machine.sub(1.0, a);
    let rest = machine.mul(through, below);
    machine.mul_add(a, colour, rest)
}

fn from_both_ends(machine: &mut Loose, layers: &[[f32; 2]], behind: f32) -> f32 {
    let (front, back) = layers.split_at(middle(layers.len()));
    let back = back
        .iter()
        .rev()
        .fold(behind, |below, layer| over(machine, *layer, below));
    let (mut sum, mut through) = (0.0, 1.0);
    for [colour, a] in front {
        let weight = machine.mul(through, *a);
        sum = machine.mul_add(weight, *colour, sum);
        let rest = machine.sub(1.0, *a);
        through = machine.mul(through, rest);
    }
    machine.mul_add(through, back, sum)
}

fn in_order(machine: &mut Loose, layers: &[[f32; 2]], behind: f32) -> f32 {
    let (mut sum, mut through) = (0.0, 1.0);
    for layer in layers {
        sum = over(machine, *layer, sum);
        let rest = machine.sub(1.0, layer[1]);
        through = machine.mul(rest, through);
    }
    machine.mul_add(through, behind, sum)
}

fn by_weight(machine: &mut Loose, layers: &[(i32, [f32; 4])], c: usize, behind: f32) -> f32 {
    let (mut colours, mut weights, mut through) = (Vec::new(), Vec::new(), 1.0);
    for (key, colour) in layers {
        let near =
            machine.round((f64::from(1_u32 << 31) - f64::from(*key)) / f64::from(1_u32 << 31));
        let square = machine.mul(near, near);
        let cube = machine.mul(square, near);
        let weight = machine.mul(3000.0, cube).max(0.01);
        let weight = machine.mul(colour[3], weight);
        let weight = machine.mul(colour[3], weight);
        weights.push(weight);
        colours.push(machine.mul(weight, colour[c]));
        let rest = machine.sub(1.0, colour[3]);
        through = machine.mul(through, rest);
    }
    let whole = machine.sum(&weights).max(SUM_LEAST);
    let colour = machine.sum(&colours);
    let mean = machine.div(colour, whole);
    let covered = machine.sub(1.0, through);
    let behind = machine.mul(behind, through);
    machine.mul_add(mean, covered, behind)
}
