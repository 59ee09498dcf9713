//! Laws of the A-buffer with several samples a pixel.

use proptest::prelude::*;
use triptych_spec::abuffer::{
    Order, average, build, opaque, resolve, resolve_pixels, resolve_samples, sort,
};
use triptych_spec::bound::Bounded;
use triptych_spec::raster::samples_of;

use super::{Layers, coloured};
use crate::config;
use crate::raster::multisample::sampled;

fn layers() -> impl Strategy<Value = Layers> {
    coloured(sampled(0..8)).prop_map(|mut layers| {
        layers.scene.samples = layers.primitives.samples;
        layers
    })
}

impl Layers {
    /// What one sample of every pixel sees.
    fn of_sample(&self, s: u32) -> Self {
        Self {
            scene: self.scene.clone(),
            primitives: self.primitives.of_sample(s),
        }
    }

    fn picture(&self, depth_test: bool, order: Order) -> Vec<[Bounded; 3]> {
        let sorted = sort(&self.build(depth_test, u32::MAX));
        let (scene, primitives) = (&self.scene, &self.primitives);
        resolve_samples(scene, primitives, &self.opaque(), &sorted, order)
    }
}

proptest! {
    #![proptest_config(config(200))]

    /// Every sample has its own surface behind it: what it sees by itself.
    #[test]
    fn surfaces_are_those_of_each_sample(layers in layers()) {
        let count = layers.primitives.samples.count();
        let all = layers.opaque();
        for s in 0..count {
            let one = layers.of_sample(s).opaque();
            let every = |of: &[u32]| -> Vec<u32> {
                of.iter().skip(s as usize).step_by(count as usize).copied().collect()
            };
            prop_assert_eq!(every(&all.key), one.key);
            prop_assert_eq!(every(&all.prim), one.prim);
        }
    }

    /// The depth test keeps a sample of a fragment if it would by itself, and the fragment if
    /// any is kept; the key does not change.
    #[test]
    fn depth_test_by_samples(layers in layers()) {
        let (kept, all) = (layers.build(true, u32::MAX), layers.build(false, u32::MAX));
        let (kept, all) = (sort(&kept), sort(&all));
        let mut must = Vec::new();
        for f in &all.fragments {
            let mask = samples_of(f.mask).filter(|s| {
                let one = layers.of_sample(*s);
                let lists = build(&one.scene, &one.primitives, &opaque(&one.scene, &one.primitives), true, u32::MAX);
                sort(&lists).list(f.pixel as usize).iter().any(|g| g.prim == f.prim)
            });
            let mask = mask.map(|s| 1_u32 << s).sum();
            must.extend((mask != 0).then_some(triptych_spec::raster::Fragment { mask, ..*f }));
        }
        prop_assert_eq!(kept.fragments, must);
    }

    /// By the true depth of each, a sample shows what it shows by itself.
    #[test]
    fn true_depth_is_one_sample_a_pixel(layers in layers(), depth_test: bool) {
        let count = layers.primitives.samples.count() as usize;
        let all = layers.picture(depth_test, Order::Sample);
        for s in 0..count {
            let one = layers.of_sample(u32::try_from(s).expect("at most eight"));
            let sorted = sort(&one.build(depth_test, u32::MAX));
            let must = resolve(&one.scene, &one.primitives, &one.opaque(), &sorted);
            let seen: Vec<_> = all.iter().skip(s).step_by(count).copied().collect();
            prop_assert_eq!(seen, must);
        }
    }

    /// A pixel at a time or a sample at a time, the picture is the same, and it is the same
    /// with the depth test and without.
    #[test]
    fn by_pixel_is_by_sample(layers in layers(), depth_test: bool) {
        let (scene, primitives) = (&layers.scene, &layers.primitives);
        let sorted = sort(&layers.build(true, u32::MAX));
        let by_pixel = resolve_pixels(scene, primitives, &layers.opaque(), &sorted);
        let by_sample = layers.picture(depth_test, Order::Centroid);
        let by_sample = average(&by_sample, primitives.samples.count());
        prop_assert_eq!(by_pixel, by_sample);
    }

    /// Means in `f32`, one sample after the other or by halves, are inside their bounds.
    #[test]
    fn means_stay_inside(colours in prop::collection::vec(0_f32..2.0, 8), n in 1_usize..4) {
        let colours = &colours[..1 << n];
        let exact = |c: &f32| [Bounded { value: f64::from(*c), bound: 0.0 }; 3];
        let samples: Vec<_> = colours.iter().map(exact).collect();
        let must = average(&samples, 1 << n)[0][0];
        let share = 1.0 / colours.len() as f32;
        let in_turn = share * colours.iter().sum::<f32>();
        let shares: f32 = colours.iter().map(|c| share * c).sum();
        let mut halves = colours.to_vec();
        while halves.len() > 1 {
            halves = halves.chunks(2).map(|pair| pair[0] + pair[1]).collect();
        }
        for mean in [in_turn, shares, share * halves[0]] {
            prop_assert!(must.admits(f64::from(mean)), "{mean} beside {must:?}");
        }
    }
}
