//! Layouts on every adapter: what scenes with enough memory cannot show.

use triptych_gpu::layouts::{Built, Layout, Options, Timed, memory, run};
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_harness::compare::lists::certify;
use triptych_harness::compare::order::flatten;
use triptych_spec::abuffer::{Lists, Opaque, Sorted, opaque};

use super::super::tiles::stack;
use super::lists;
use crate::adapters::devices;

fn options(opaque: &Opaque, arrays: Option<u32>, capacity: Option<u32>) -> Options<'_> {
    Options {
        opaque,
        depth_test: false,
        background: [1.0; 3],
        capacity,
        arrays,
        nearest: &[],
    }
}

/// A stack of layers in some layout on every adapter, held to what the spec says.
fn each(
    depth: u32,
    layout: Layout,
    (arrays, capacity): (Option<u32>, Option<u32>),
    look: impl Fn(&str, &Built, &Sorted),
) {
    let layers = stack(depth);
    let primitives = &layers.primitives;
    let surfaces = opaque(&layers.scene, primitives);
    let must = lists(&layers, &surfaces, false);
    let faces = vec![[0.5, 0.25, 0.125, 0.5]; depth as usize];
    for (gpu, kernels) in devices() {
        let rasterizer = Rasterizer::new(gpu, &kernels[0], Path::Compute, primitives, &faces);
        let rasterizer = rasterizer.expect("few triangles");
        let options = options(&surfaces, arrays, capacity);
        let inspect = |lists: &Lists| certify(lists).longest();
        let seen = run(&rasterizer, layout, options, |_| false, inspect).expect("it runs");
        let found = seen.bands[0].sorted.as_ref().and_then(flatten);
        let words = format!("{}, {depth} layers", gpu.name);
        assert_eq!(found.as_ref(), Some(&must), "{words}");
        assert_eq!(seen.image.len(), 81, "{words}");
        look(&words, &seen, &must);
    }
}

/// However few entries arrays may have, ranges of depth hold all layers one after another, and their
/// picture is that of one range.
#[test]
fn ranges_of_depth_hold_what_one_does_not() {
    for depth in [1, 40] {
        let pictures = std::cell::RefCell::new(Vec::new());
        for most in [1, 3, 64] {
            each(
                depth,
                Layout::Bucket,
                (Some(most), None),
                |words, seen, _| {
                    assert!(seen.entries <= most, "{words}: {} entries", seen.entries);
                    let least = depth.div_ceil(most);
                    assert!(seen.ranges >= least, "{words}: {} ranges", seen.ranges);
                    assert_eq!(seen.overflowed.is_empty(), depth <= most.min(8), "{words}");
                    let picture = seen.image.clone();
                    pictures.borrow_mut().push((words.to_owned(), picture));
                },
            );
        }
        let pictures = pictures.into_inner();
        for (words, picture) in &pictures {
            let first = pictures.iter().find(|(first, _)| first == words);
            assert_eq!(first.map(|(_, first)| first), Some(picture), "{words}");
        }
    }
}

/// Lists that are longer than a workgroup sorts, in every layout that takes any length.
#[test]
fn long_lists_are_put_in_order() {
    for layout in [
        Layout::Bucket,
        Layout::Precalc,
        Layout::Packed,
        Layout::Regions,
    ] {
        each(600, layout, (None, None), |_, _, _| {});
    }
}

/// Too few nodes are counted, and asked for again.
#[test]
fn layouts_get_the_room_that_they_need() {
    for layout in Layout::ALL {
        each(20, layout, (None, Some(0)), |words, seen, must| {
            let counted = seen.bands[0].built.attempts as usize;
            assert_eq!(counted, must.fragments.len(), "{words} {layout:?}");
        });
    }
}

/// A frame that is set up to be timed has the same lists and picture, again and again, and takes the bytes
/// that the formula says.
#[test]
fn frames_that_are_timed_are_the_same_and_as_large_as_stated() {
    for depth in [20, 600] {
        let layers = stack(depth);
        let primitives = &layers.primitives;
        let surfaces = opaque(&layers.scene, primitives);
        let must = lists(&layers, &surfaces, false);
        let fragments = must.fragments.len() as u64;
        let faces = vec![[0.5, 0.25, 0.125, 0.5]; depth as usize];
        for (gpu, kernels) in devices() {
            let rasterizer = Rasterizer::new(gpu, &kernels[0], Path::Compute, primitives, &faces);
            let rasterizer = rasterizer.expect("few triangles");
            for layout in Layout::ALL {
                if layout == Layout::Ordered && depth > 20 {
                    continue;
                }
                let words = format!("{}, {depth} layers, {layout:?}", gpu.name);
                let options = options(&surfaces, None, None);
                let inspect = |lists: &Lists| certify(lists).longest();
                let timed = Timed::new(&rasterizer, layout, options, |_| false, inspect);
                let timed = timed.unwrap_or_else(|e| panic!("{words}: {e}"));
                let first = timed.frame().expect("it runs");
                for _ in 0..2 {
                    let (seen, picture) = timed.frame().expect("it runs");
                    assert_eq!(flatten(&seen).as_ref(), Some(&must), "{words}");
                    assert_eq!(picture, first.1, "{words}");
                }
                assert_eq!(u64::from(timed.fragments), fragments, "{words}");
                assert_eq!(timed.longest, depth, "{words}");
                let bytes = memory::peak(layout, [81, 1], fragments, depth, timed.capacity);
                assert_eq!(timed.bytes(), bytes, "{words}");
            }
        }
    }
}
