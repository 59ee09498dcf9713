//! Laws of the techniques that need no lists, and of what else is made of layers.

#[path = "rivals/bounds.rs"]
mod bounds;
#[path = "rivals/closed_forms.rs"]
mod closed_forms;
#[path = "rivals/reduced.rs"]
mod reduced;

use proptest::prelude::*;
use triptych_spec::abuffer::{
    Lens, Sorted, Target, alpha, attenuation, defocus, density, dual, halves, nearest_layers, peel,
    resolve, sort, weighted,
};
use triptych_spec::bound::Bounded;
use triptych_spec::raster::Samples;
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
        samples: Samples::default(),
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
