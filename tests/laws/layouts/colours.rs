//! What is left of colours in bytes.

use proptest::prelude::*;
use triptych_spec::abuffer::opaque;
use triptych_spec::layouts::{packed, rounds_to};

use super::super::abuffer::{Layers, coloured};
use super::super::config;
use super::super::samples::soup;
use super::lists;

/// A byte that a channel may be rounded to, towards one side or the other.
fn byte(channel: f32, up: bool) -> f32 {
    let exact = 255.0 * f64::from(channel.clamp(0.0, 1.0));
    let may = |byte: &u32| rounds_to(channel, *byte);
    let near = exact.floor();
    #[expect(clippy::cast_possible_truncation, reason = "at most 255")]
    #[expect(clippy::cast_sign_loss, reason = "at least 0")]
    let near = near as u32;
    let bytes: Vec<u32> = (near..=near + 1).filter(may).collect();
    let chosen = if up { bytes.last() } else { bytes.first() };
    *chosen.expect("there is one at half a step at most") as f32 / 255.0
}

/// The blend in `f32` as kernels have it.
fn blended(layers: &[[f32; 4]], behind: [f32; 3]) -> [f32; 3] {
    let (mut seen, mut through) = ([0.0_f32; 3], 1.0_f32);
    for &[r, g, b, a] in layers {
        for (sum, c) in seen.iter_mut().zip([r, g, b]) {
            *sum += through * a * c;
        }
        through *= 1.0 - a;
    }
    for (sum, c) in seen.iter_mut().zip(behind) {
        *sum += through * c;
    }
    seen
}

proptest! {
    #![proptest_config(config(256))]

    /// Whichever way channels are rounded, the blend stays inside the bound; and where each can be rounded in
    /// one way alone, the bound holds what `f32` makes of it and no more.
    #[test]
    fn rounded_colours_stay_inside_the_bound(layers in coloured(soup(1..24)), up: bool) {
        let Layers { scene, primitives } = &layers;
        let surfaces = opaque(scene, primitives);
        let sorted = lists(&layers, &surfaces, true);
        let must = packed(scene, primitives, &surfaces, &sorted);
        let colour = |prim: u32| scene.triangles[primitives.source[prim as usize] as usize].colour;
        for (pixel, must) in must.iter().enumerate() {
            let list = sorted.list(pixel);
            let either = |c: &f32| byte(*c, true) != byte(*c, false);
            let is_open = list.iter().any(|f| colour(f.prim).iter().any(either));
            let bytes: Vec<[f32; 4]> =
                list.iter().map(|f| colour(f.prim).map(|c| byte(c, up))).collect();
            let behind = match surfaces.prim[pixel] {
                u32::MAX => scene.background,
                prim => [0, 1, 2].map(|i| colour(prim)[i]),
            };
            let seen = blended(&bytes, behind);
            for channel in 0..3 {
                let must = must[channel];
                prop_assert!(must.admits(f64::from(seen[channel])), "{:?} {:?}", must, seen);
                // Each layer meets a few operations on numbers of about 1, each within 2^-21 of it.
                let most = 1e-5 * (list.len() + 1) as f64;
                prop_assert!(is_open || must.bound < most, "{:?}: {:?}", list.len(), must);
            }
        }
    }
}
