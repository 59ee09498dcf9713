//! Planes, corners and posts, whose openness is known, or found by rays.

use std::f64::consts::PI;

use proptest::prelude::*;
use triptych_gpu::hbao::Settings;
use triptych_spec::ldm::Falloff;

use super::scenes::{Eye, Shape, V, dot, traced, unit};
use super::{openness, settings};
use crate::config;

/// Two planes at a right angle, each as steep as the other to an eye that looks along z.
fn corner() -> [Shape; 2] {
    [-1.0, 1.0].map(|up| {
        let normal = unit([0.0, up, -1.0]);
        let at = normal[2] * 1000.0;
        Shape::Half { normal, at }
    })
}

/// What a wall blocks of a floor's point at `k` times `most`: the part of the unit disc with
/// `x >= k`, each of its parts as far as the distance `k most / x` lets it.
fn wall(k: f64, power: u32) -> f64 {
    let root = (1.0 - k * k).max(0.0).sqrt();
    let part = k.min(1.0).acos() - k * root;
    match power {
        _ if k >= 1.0 => 0.0,
        0 => part / PI,
        1 => (part - 2.0 * k * (((1.0 + root) / k).ln() - root)) / PI,
        _ => unreachable!("only these are tried"),
    }
}

/// Errors of a corner's pixels: the pixels to the wall, and how much too open.
fn corner_errors(side: u32, power: u32, settings: Settings) -> Vec<(f64, f64)> {
    let (most, shapes) = (300.0, corner());
    let eye = Eye::square(side, false, f64::from(side) / 960.0);
    let mut errors: Vec<(f64, f64)> = Vec::new();
    for (name, found) in openness(&eye.screen(&shapes), settings) {
        for (pixel, open) in found.into_iter().enumerate() {
            let (point, _) = eye.sees(&shapes, pixel).expect("planes are everywhere");
            // Nearer, pixels are as wide as the way to the wall; beyond, the border may hide
            // what is near enough.
            if point[0].abs() < 160.0 && (40.0..200.0).contains(&point[1].abs()) {
                let off = point[1].abs() * 2.0_f64.sqrt();
                let error = f64::from(open) - (1.0 - wall(off / most, power));
                assert!(error.is_finite(), "{name}: {open}");
                errors.push((point[1].abs() * eye.scale, error));
            }
        }
    }
    errors
}

fn rms(errors: &[(f64, f64)]) -> f64 {
    let squares: f64 = errors.iter().map(|(_, error)| error * error).sum();
    (squares / errors.len() as f64).sqrt()
}

fn limited(power: u32) -> Falloff {
    Falloff::Distance { most: 300, power }
}

/// Many slices and steps, all from the finest level.
fn fine(power: u32) -> Settings {
    Settings {
        detail: 31,
        ..settings(limited(power), 8, 96)
    }
}

/// A sample is off its slice by up to 0.71 pixels, and by as many farther or nearer than where
/// a horizon is highest; each moves an angle by no more than that over the distance, and
/// an arc by no more than the angle; steps are `2 / steps` of the way apart at its end.
fn first_order(pixels: f64, steps: u32) -> f64 {
    1.5 / pixels + 2.0 / f64::from(steps)
}

#[test]
fn a_corner_comes_to_its_closed_form_with_resolution() {
    for power in [0, 1] {
        let coarse = corner_errors(48, power, fine(power));
        let fine = corner_errors(192, power, fine(power));
        for (pixels, error) in coarse.iter().chain(&fine) {
            let bound = first_order(*pixels, 96);
            assert!(error.abs() <= bound, "{error} {pixels} pixels off");
        }
        let (coarse, fine) = (rms(&coarse), rms(&fine));
        assert!(fine <= coarse / 2.0, "{fine} after {coarse}");
    }
}

#[test]
fn a_corner_comes_to_its_closed_form_with_slices_and_steps() {
    for power in [0, 1] {
        let made = [(1, 4), (2, 8), (8, 32)].map(|(slices, steps)| {
            let errors = corner_errors(96, power, settings(limited(power), slices, steps));
            rms(&errors)
        });
        assert!(
            made[1] <= made[0] / 2.0 && made[2] <= made[1] / 2.0,
            "{made:?}"
        );
    }
}

/// Errors of a floor's pixels around a post with a round top, which from above is a height field,
/// against rays: the pixels to the post, and how much too open.
fn post_errors(slices: u32, steps: u32) -> Vec<(f64, f64)> {
    let normal = [0.0, 0.0, -1.0];
    let floor = Shape::Half {
        normal,
        at: -1000.0,
    };
    let (centre, radius) = ([40.0, -30.0, 900.0], 120.0);
    let shapes = [floor, Shape::Post { centre, radius }];
    let eye = Eye::square(96, false, 0.1);
    let mut errors = Vec::new();
    let settings = Settings {
        detail: 31,
        ..settings(Falloff::None, slices, steps)
    };
    for (_, found) in openness(&eye.screen(&shapes), settings) {
        for pixel in (0..found.len()).step_by(31) {
            let (point, normal) = eye.sees(&shapes, pixel).expect("the floor is everywhere");
            let off = (point[0] - centre[0]).hypot(point[1] - centre[1]) - radius;
            if off > 40.0 && off < 300.0 && point[2] > 999.0 {
                let must = traced(&shapes, point, normal, Falloff::None, 200);
                errors.push((off * eye.scale, f64::from(found[pixel]) - must));
            }
        }
    }
    assert!(errors.len() > 40, "{} pixels around the post", errors.len());
    errors
}

/// Without a falloff, as rays end at the post's side, which is not seen: samples know of its top's
/// distance only. Slices miss or meet the post as a whole: first order in slices as well.
#[test]
fn a_post_blocks_what_rays_find() {
    let made = [(2, 12), (8, 24), (32, 48)].map(|(slices, steps)| {
        let errors = post_errors(slices, steps);
        for (pixels, error) in &errors {
            let bound = first_order(*pixels, steps) + 1.0 / f64::from(slices);
            assert!(error.abs() <= bound, "{error} {pixels} pixels off");
        }
        rms(&errors)
    });
    assert!(
        made[1] <= made[0] / 2.0 && made[2] <= made[1] / 2.0,
        "{made:?}"
    );
}

/// A ball that floats farther above the floor than anything may be to block it.
#[test]
fn what_is_too_far_does_not_block() {
    let floor = Shape::Half {
        normal: [0.0, 0.0, -1.0],
        at: -1000.0,
    };
    let ball = Shape::Ball {
        centre: [0.0, 0.0, 300.0],
        radius: 60.0,
    };
    for near in [false, true] {
        let eye = Eye::square(64, near, if near { 64.0 } else { 0.06 });
        let screen = eye.screen(&[floor, ball]);
        let lowest = |most: u32, power: u32| {
            let settings = settings(Falloff::Distance { most, power }, 4, 16);
            let on_floor = |found: &[f32]| {
                let all = found.iter().zip(&screen.pixels);
                let floor = all
                    .filter(|(_, pixel)| pixel.depth > 999.0)
                    .map(|(open, _)| *open);
                floor.fold(1.0, f32::min)
            };
            openness(&screen, settings)
                .iter()
                .map(|(_, found)| on_floor(found))
                .fold(1.0, f32::min)
        };
        // A ray's 640 steps to the ball, and what planes are off by.
        for power in [0, 2] {
            assert!(
                lowest(639, power) > 1.0 - 1e-4,
                "{} at {near}",
                lowest(639, power)
            );
            assert!(
                lowest(1000, power) < 0.98,
                "{} at {near}",
                lowest(1000, power)
            );
        }
    }
}

/// The same point at all places of a tile: the mean of its slices is what as many slices find.
#[test]
fn turning_slices_does_not_bias() {
    let tilted = |x: f64, y: f64| -> V { unit([x, y, -1.0]) };
    let normals = [tilted(0.2, -0.7), tilted(-0.4, 0.9)];
    let shifted = |by: [f64; 2]| {
        normals.map(|normal| Shape::Half {
            normal,
            at: dot(normal, [by[0], by[1], 1000.0]),
        })
    };
    let eye = Eye::square(64, false, 0.1);
    let (mut once, mut all, mut means, mut count) = (0.0, 0.0, 0.0, 0.0);
    let dense = openness(
        &eye.screen(&shifted([0.0; 2])),
        Settings {
            detail: 31,
            ..settings(limited(1), 16, 96)
        },
    );
    let mut turned = vec![Vec::new(); dense.len()];
    for (x, y) in (0..16).map(|i| (i % 4, i / 4)) {
        let screen = eye.screen(&shifted([
            f64::from(x) / eye.scale,
            f64::from(y) / eye.scale,
        ]));
        let found = openness(
            &screen,
            Settings {
                detail: 31,
                ..settings(limited(1), 1, 96)
            },
        );
        for (all, (_, found)) in turned.iter_mut().zip(found) {
            all.push((64 * y as usize + x as usize, found));
        }
    }
    for ((_, dense), turned) in dense.iter().zip(&turned) {
        for (row, column) in (28..36).flat_map(|row| (28..36).map(move |column| (row, column))) {
            let at = 64 * row + column;
            let must = f64::from(dense[at]);
            let own = turned
                .iter()
                .map(|(by, found)| f64::from(found[at + by]) - must);
            let own: Vec<f64> = own.collect();
            once += own.iter().map(|error| error * error).sum::<f64>() / 16.0;
            let mean = own.iter().sum::<f64>() / 16.0;
            all += mean * mean;
            means += mean;
            count += 1.0;
        }
    }
    let (once, all, bias) = ((once / count).sqrt(), (all / count).sqrt(), means / count);
    // Where steps are differs, by parts of a 96th of the way.
    assert!(
        bias.abs() < 1.0 / 96.0 && all < 2.0 / 96.0,
        "{all}, of it {bias}"
    );
    assert!(once > 10.0 * bias.abs(), "single slices are off by {once}");
}

proptest! {
    #![proptest_config(config(24))]

    #[test]
    fn planes_are_open(
        [x, y] in prop::array::uniform2(-0.8..0.8_f64),
        near in any::<bool>(),
        none in any::<bool>(),
        slices in 1..4_u32,
        denoise in 0..3_u32,
    ) {
        let normal = unit([x, y, -1.0]);
        let shapes = [Shape::Half { normal, at: normal[2] * 1000.0 }];
        let eye = Eye::square(40, near, if near { 45.0 } else { 0.05 });
        let screen = eye.screen(&shapes);
        let falloff = if none { Falloff::None } else { limited(1) };
        let depths = || screen.pixels.iter().filter(|p| p.normal != [0.0; 3]).map(|p| f64::from(p.depth));
        let (low, high) = (depths().fold(f64::MAX, f64::min), depths().fold(0.0, f64::max));
        // Points are off by fewer than 32 roundings of the farthest's distance (twin.rs), over
        // that of neighbours: a height at which an arc of any length has no more than 1.3 times
        // as much below, whose two arcs are off by fewer than 48 roundings each.
        let unit = 1.0 / 16_777_216.0;
        let apart = if near { low / eye.scale } else { 1.0 / eye.scale };
        let height = 32.0 * unit * (2.0 * high / apart + 1.0);
        let bound = 2.0 * (1.3 * height + 96.0 * unit);
        for (name, found) in openness(&screen, Settings { denoise, ..settings(falloff, slices, 8) }) {
            for open in found {
                let open = f64::from(open);
                prop_assert!(open >= 1.0 - bound && open <= 1.0 + bound, "{name}: {open} within {bound:e}");
            }
        }
    }
}
