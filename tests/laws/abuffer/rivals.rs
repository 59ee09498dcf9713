//! Laws of the techniques that need no lists, and of what else is made of layers.

#[path = "rivals/bounds.rs"]
mod bounds;

use proptest::prelude::*;
use triptych_spec::abuffer::{
    Lens, Sorted, Target, alpha, attenuation, defocus, density, dual, halves, nearest_layers, peel,
    resolve, sort, weighted,
};
use triptych_spec::bound::Bounded;
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use super::{Layers, by_pixel, layers, painted};
use crate::config;

type Picture = Vec<[Bounded; 3]>;

/// A stack over one pixel, in this order: keys and colours.
fn stack(layers: &[(i32, [f32; 4])], background: [f32; 3]) -> Layers {
    let count = u32::try_from(layers.len()).expect("few layers");
    let corners = |key: i32| [[-4096, -4096, key], [8192, -4096, key], [-4096, 8192, key]];
    let primitives = Primitives {
        size: Size {
            width: 1,
            height: 1,
        },
        bits: 8,
        snapped: layers.iter().flat_map(|(key, _)| corners(*key)).collect(),
        prims: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        source: (0..count).collect(),
    };
    let colours: Vec<[f32; 4]> = layers.iter().map(|(_, colour)| *colour).collect();
    Layers {
        scene: painted(&primitives, &colours, background),
        primitives,
    }
}

fn colours() -> impl Strategy<Value = [f32; 4]> {
    let opacity = prop_oneof![1 => Just(0.0_f32), 1 => Just(1.0_f32.next_down()), 6 => 0_f32..1.0];
    (0_f32..2.0, 0_f32..2.0, 0_f32..2.0, opacity).prop_map(|(r, g, b, a)| [r, g, b, a])
}

/// Transparent layers with keys of their own, nearest first.
fn stacks(most: usize) -> impl Strategy<Value = Vec<(i32, [f32; 4])>> {
    let keys = prop::collection::btree_set(0..i32::MAX, 1..most);
    keys.prop_flat_map(|keys| {
        let n = keys.len();
        prop::collection::vec(colours(), n)
            .prop_map(move |colours| keys.iter().copied().zip(colours).collect())
    })
}

impl Layers {
    fn sorted(&self) -> Sorted {
        sort(&self.build(true, u32::MAX))
    }

    fn resolved(&self) -> Picture {
        resolve(
            &self.scene,
            &self.primitives,
            &self.opaque(),
            &self.sorted(),
        )
    }

    fn peeled(&self, n: u32) -> Sorted {
        peel(&self.scene, &self.primitives, &self.opaque(), n)
    }

    fn weighted(&self) -> Picture {
        weighted(&self.scene, &self.primitives, &self.opaque())
    }

    fn alpha(&self, target: Target) -> Picture {
        alpha(&self.scene, &self.primitives, &self.opaque(), target)
    }

    fn dense(&self, sigma: f32) -> Picture {
        let opaque = self.opaque();
        density(
            &self.scene,
            &self.primitives,
            &opaque,
            &self.sorted(),
            sigma,
        )
    }

    fn blurred(&self, lens: Lens) -> Picture {
        let opaque = self.opaque();
        defocus(&self.scene, &self.primitives, &opaque, &self.sorted(), lens)
    }
}

/// Two values of one number, each within its bound, are no further apart than both bounds.
fn meet(a: &Picture, b: &Picture) -> Result<(), TestCaseError> {
    prop_assert_eq!(a.len(), b.len());
    for (x, y) in a.iter().flatten().zip(b.iter().flatten()) {
        let apart = (x.value - y.value).abs();
        prop_assert!(apart <= x.bound + y.bound, "{:?} and {:?}", x, y);
    }
    Ok(())
}

/// The same to the last bit, bounds and all.
fn bits(picture: &Picture) -> Vec<[u64; 2]> {
    let channels = picture.iter().flatten();
    channels
        .map(|c| [c.value.to_bits(), c.bound.to_bits()])
        .collect()
}

proptest! {
    #![proptest_config(config(300))]

    /// What is peeled in so many passes is the nearest layers of the lists.
    #[test]
    fn peeling_finds_the_nearest_layers(layers in layers(0..10), n in prop_oneof![0_u32..6, Just(256)]) {
        let lists = layers.build(true, u32::MAX);
        prop_assert_eq!(by_pixel(&layers.peeled(n)), by_pixel(&nearest_layers(&lists, n)));
    }

    /// From both ends come the same layers in the same order, and the same picture.
    #[test]
    fn both_ends_find_what_one_does(layers in layers(0..10)) {
        let (scene, prims, opaque) = (&layers.scene, &layers.primitives, layers.opaque());
        let sorted = dual(scene, prims, &opaque);
        prop_assert_eq!(by_pixel(&sorted), by_pixel(&layers.peeled(256)));
        meet(&halves(scene, prims, &opaque, &sorted), &layers.resolved())?;
    }

    /// Triangles that come from back to front are blended in order.
    #[test]
    fn alpha_from_back_to_front_is_resolve(stack_of in stacks(12), half in any::<bool>()) {
        let behind = [0.25, 0.5, 0.75];
        let reversed: Vec<_> = stack_of.iter().rev().copied().collect();
        let target = if half { Target::Half } else { Target::Single };
        meet(&stack(&reversed, behind).alpha(target), &stack(&stack_of, behind).resolved())?;
    }

    /// One layer has nothing to be weighed against.
    #[test]
    fn one_layer_weighted_is_resolve(colour in colours(), key in 0..i32::MAX) {
        let one = stack(&[(key, colour)], [0.25, 0.5, 0.75]);
        meet(&one.weighted(), &one.resolved())?;
    }

    /// The order of triangles is not even in the last bit of weighted sums.
    #[test]
    fn weights_know_no_order(of in stacks(12).prop_flat_map(|s| (Just(s.clone()), Just(s).prop_shuffle()))) {
        let [a, b] = [of.0, of.1].map(|of| bits(&stack(&of, [0.5; 3]).weighted()));
        prop_assert_eq!(a, b);
    }

    /// A medium of no density, and a lens without an aperture, change nothing.
    #[test]
    fn nothing_between_changes_nothing(layers in layers(0..8), focus in 0_u32..1 << 31, radius in 1_u32..=8) {
        let plain = layers.resolved();
        meet(&layers.dense(0.0), &plain)?;
        let lens = Lens { focus, aperture: 0, radius };
        meet(&layers.blurred(lens), &plain)?;
    }

    /// Light that is attenuated over two parts of a way is attenuated over all of it.
    #[test]
    fn ways_may_be_split(near in 0_u32..1 << 30, far in 0_u32..1 << 30, sigma in 0_f32..40.0) {
        use triptych_spec::bound::Real;
        let whole = attenuation(near + far, sigma);
        let parts = attenuation(near, sigma).mul(attenuation(far, sigma));
        meet(&vec![[whole; 3]], &vec![[parts; 3]])?;
    }

    /// An invisible layer within a medium splits a way, and shows nothing.
    #[test]
    fn invisible_layers_split_ways(of in stacks(8), share in 0_i64..=1000, sigma in 0_f32..20.0) {
        // In front of all and behind all there is no medium.
        let [first, last] = [of[0].0, of[of.len() - 1].0].map(i64::from);
        let key = i32::try_from(first + (last - first) * share / 1000).expect("between keys");
        let mut split = of.clone();
        split.push((key, [1.0, 1.0, 1.0, 0.0]));
        meet(&stack(&split, [0.5; 3]).dense(sigma), &stack(&of, [0.5; 3]).dense(sigma))?;
    }
}

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
