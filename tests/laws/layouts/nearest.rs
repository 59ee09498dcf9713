//! The nearest layers alone, in every layout and by tiles, on every adapter: never those that came first.

use triptych_gpu::layouts::{Layout, Options, Timed, run};
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::tiles::{self, Banded, Way};
use triptych_harness::compare::image;
use triptych_harness::compare::lists::certify;
use triptych_harness::compare::{Judgement, compare};
use triptych_harness::observe::{Gpu, Observed, Spec};
use triptych_harness::replay::rivals::NEAREST;
use triptych_spec::abuffer::{Lists, Opaque, Sorted, nearest_of, opaque, resolve_pixels};
use triptych_spec::bound::Bounded;
use triptych_spec::layouts::packed;
use triptych_spec::raster::{Fragment, Samples};
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use super::super::abuffer::{Layers, painted};
use super::lists;
use crate::adapters::devices;

/// More than any number that is shown alone, and no multiple of what tiles sort at once.
const DEPTH: u32 = 71;

const SIDE: u32 = 9;

/// Layers of all colours over a target, far and near ones in turn, two of each key, the least of them over
/// a few pixels alone; an opaque surface behind a part of the picture, before the last layers.
fn layers(samples: u32) -> Layers {
    let samples = Samples::standard(samples).expect("a pattern");
    let key = |i: u32| 10 + (i * 37 % DEPTH) / 2;
    let corners = |side: i32, key: i32| [[0, 0, key], [side, 0, key], [0, side, key]];
    let mut snapped = Vec::new();
    let mut colours = Vec::new();
    for i in 0..DEPTH {
        // Sides end within pixels, so that samples differ.
        let side = [18, 14, 18, 6][i as usize % 4] * 256 + 70;
        snapped.extend(corners(side, i32::try_from(key(i)).expect("small")));
        let part = |by: u32| (i * by % 64) as f32 / 64.0;
        colours.push([part(11), part(23), part(37), 0.015625 + part(5) / 32.0]);
    }
    snapped.extend(corners(5 * 256, 40));
    colours.push([0.25, 0.75, 0.5, 1.0]);
    let prims = DEPTH + 1;
    let primitives = Primitives {
        size: Size {
            width: SIDE,
            height: SIDE,
        },
        bits: 8,
        samples,
        snapped,
        prims: (0..prims).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        source: (0..prims).collect(),
    };
    let mut scene = painted(&primitives, &colours, [0.1, 0.9, 0.3]);
    scene.samples = samples;
    Layers { scene, primitives }
}

/// A picture of some lists, as a layout has it.
fn blended(
    of: &Layers,
    surfaces: &Opaque,
    layout: Option<Layout>,
    sorted: &Sorted,
) -> Vec<[Bounded; 3]> {
    let Layers { scene, primitives } = of;
    match layout {
        Some(Layout::Packed) => packed(scene, primitives, surfaces, sorted),
        _ => resolve_pixels(scene, primitives, surfaces, sorted),
    }
}

/// The first of each list as triangles come, in order: what a full array would hold.
fn first_of(sorted: &Sorted, n: u32) -> Sorted {
    let mut all = Sorted {
        offsets: vec![0],
        fragments: Vec::new(),
    };
    for pixel in 0..sorted.offsets.len() - 1 {
        let mut list: Vec<Fragment> = sorted.list(pixel).to_vec();
        list.sort_by_key(|f| f.prim);
        list.truncate(n as usize);
        list.sort_by_key(|f| (f.key, f.prim));
        all.fragments.extend(list);
        all.offsets
            .push(u32::try_from(all.fragments.len()).expect("few"));
    }
    all
}

fn judge(must: &[[Bounded; 3]], seen: &[[f32; 3]]) -> Judgement {
    let must = Observed::<Spec, _>::new("spec", must);
    let seen = Observed::<Gpu, _>::new("gpu", seen);
    compare(&must, &seen, |a, b| image::compare(a, b, SIDE))
}

/// All numbers that are shown alone, and more than there are layers.
fn numbers() -> Vec<u32> {
    NEAREST.into_iter().chain([DEPTH, u32::MAX]).collect()
}

fn options<'a>(
    surfaces: &'a Opaque,
    of: &Layers,
    nearest: &'a [u32],
    arrays: Option<u32>,
) -> Options<'a> {
    Options {
        opaque: surfaces,
        depth_test: true,
        background: of.scene.background,
        capacity: None,
        arrays,
        nearest,
    }
}

/// Calls with every adapter, its kernels with words and with native integers, and layers of so many samples.
fn each(samples: &[u32], look: impl Fn(&str, &Layers, &Rasterizer<'_>)) {
    for &samples in samples {
        let layers = layers(samples);
        let colours: Vec<[f32; 4]> = layers.scene.triangles.iter().map(|t| t.colour).collect();
        for (gpu, kernels) in devices() {
            // The arithmetic of keys is all that is native.
            let paths = [Path::Compute, Path::Native];
            for (kernels, path) in kernels
                .iter()
                .zip(paths)
                .take(if samples == 1 { 2 } else { 1 })
            {
                let made = Rasterizer::new(gpu, kernels, path, &layers.primitives, &colours);
                let rasterizer = made.expect("few triangles");
                let words = format!("{}/{}, {samples} samples", gpu.name, path.name());
                look(&words, &layers, &rasterizer);
            }
        }
    }
}

/// What comes first is told from what is nearest, at every number of layers, or nothing below says anything. Half a
/// step of each of more than 16 packed colours is more than what their order makes.
#[test]
fn the_first_are_not_the_nearest() {
    for samples in [1, 4] {
        let layers = layers(samples);
        let surfaces = opaque(&layers.scene, &layers.primitives);
        let sorted = lists(&layers, &surfaces, true);
        for layout in [None, Some(Layout::Packed)] {
            let most = if layout.is_some() { 16 } else { 64 };
            for n in NEAREST.into_iter().filter(|n| (1..=most).contains(n)) {
                let must = blended(&layers, &surfaces, layout, &nearest_of(&sorted, n));
                let wrong = blended(&layers, &surfaces, layout, &first_of(&sorted, n));
                let apart = must.iter().flatten().zip(wrong.iter().flatten());
                let apart = apart.filter(|(a, b)| (a.value - b.value).abs() > a.bound + b.bound);
                assert!(apart.count() > 0, "{n} of {layout:?}, {samples} samples");
            }
        }
    }
}

/// Every layout shows the nearest layers, however many; arrays also in several ranges of depth; and what is
/// set up to be timed shows the same.
#[test]
fn every_layout_shows_the_nearest() {
    let numbers = numbers();
    each(&[1, 4], |words, layers, rasterizer| {
        let surfaces = opaque(&layers.scene, &layers.primitives);
        let sorted = lists(layers, &surfaces, true);
        let is_opaque = |prim| prim == DEPTH;
        let inspect = |lists: &Lists| certify(lists).longest();
        for (layout, arrays) in Layout::ALL
            .map(|l| (l, None))
            .into_iter()
            .chain([(Layout::Bucket, Some(3))])
        {
            let words = format!("{words}, {layout:?} {arrays:?}");
            let options = options(&surfaces, layers, &numbers, arrays);
            let built = run(rasterizer, layout, options, is_opaque, inspect);
            let built = built.unwrap_or_else(|e| panic!("{words}: {e}"));
            assert_eq!(built.ranges > 1, arrays.is_some(), "{words}");
            assert_eq!(built.nearest.len(), numbers.len(), "{words}");
            for (n, seen) in numbers.iter().zip(&built.nearest) {
                let must = blended(layers, &surfaces, Some(layout), &nearest_of(&sorted, *n));
                let judgement = judge(&must, seen);
                assert_eq!(
                    judgement.differ(),
                    0,
                    "{words}, {n}: {:?}",
                    judgement.described
                );
            }
            assert_eq!(built.nearest.last(), Some(&built.image), "{words}");
            if arrays.is_none() && layers.primitives.samples.count() == 1 {
                let timed = Timed::new(rasterizer, layout, options, is_opaque, inspect);
                let timed = timed.unwrap_or_else(|e| panic!("{words}: {e}"));
                let (_, image) = timed.frame().unwrap_or_else(|e| panic!("{words}: {e}"));
                let nearest = timed.nearest().unwrap_or_else(|e| panic!("{words}: {e}"));
                assert!(
                    image == built.image && nearest == built.nearest,
                    "{words}, timed"
                );
            }
        }
    });
}

/// So do lists by tiles: jagged, none in memory, and linked.
#[test]
fn tiles_show_the_nearest() {
    let numbers = numbers();
    each(&[1, 4], |words, layers, rasterizer| {
        let surfaces = opaque(&layers.scene, &layers.primitives);
        let sorted = lists(layers, &surfaces, true);
        let options = tiles::Options {
            opaque: &surfaces,
            depth_test: true,
            background: layers.scene.background,
            capacity: None,
            drawn: tiles::DRAWN,
        };
        let rows = sorted.rows(rasterizer.size.width);
        let ways = [
            ("shade", Way::Runs),
            ("local", Way::Local),
            ("linked", Way::Linked),
        ];
        for (stage, way) in ways {
            let timed = Banded::new(rasterizer, &options, (way, &numbers), &rows, u64::MAX);
            let timed = timed.unwrap_or_else(|e| panic!("{words}, {stage}: {e}"));
            let mut seen = Vec::new();
            let shown = timed.pictures(|n, picture| seen.push((n, picture)));
            shown.unwrap_or_else(|e| panic!("{words}, {stage}: {e}"));
            assert_eq!(
                seen.iter().map(|(n, _)| *n).collect::<Vec<_>>(),
                numbers,
                "{words}, {stage}"
            );
            for (n, seen) in &seen {
                let must = blended(layers, &surfaces, None, &nearest_of(&sorted, *n));
                let judgement = judge(&must, seen);
                assert_eq!(
                    judgement.differ(),
                    0,
                    "{words}, {stage}, {n}: {:?}",
                    judgement.described
                );
            }
        }
    });
}
