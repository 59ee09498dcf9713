//! Laws of fragments at a reduced resolution.

use proptest::prelude::*;
use triptych_spec::abuffer::{Reduction, Upsampling, reduced, resolve, sort};
use triptych_spec::raster::{Samples, Setup};
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use super::super::{Layers, layers, painted};
use super::Picture;
use crate::config;

const BOTH: [Upsampling; 2] = [Upsampling::Nearest, Upsampling::Joint];

impl Layers {
    fn full(&self) -> Picture {
        let sorted = sort(&self.build(true, u32::MAX));
        resolve(&self.scene, &self.primitives, &self.opaque(), &sorted)
    }

    fn reduced(&self, reduction: Reduction, upsampling: Upsampling) -> Picture {
        let lists = reduction.lists(&self.scene, &self.primitives);
        let how = (reduction, upsampling);
        reduced(&self.scene, &self.primitives, &self.opaque(), &lists, how)
    }
}

/// A target of many blocks with quads over parts of it: left and right ends, key, colour.
fn quads(width: u32, quads: &[([i32; 2], i32, [f32; 4])]) -> Layers {
    let size = Size { width, height: 16 };
    let (mut snapped, mut prims) = (Vec::new(), Vec::new());
    let mut colours = Vec::new();
    for (at, &([left, right], key, colour)) in (0..).zip(quads) {
        let [left, right, bottom] = [left, right, 16].map(|p| p << 8);
        snapped.extend([
            [left, 0, key],
            [right, 0, key],
            [right, bottom, key],
            [left, bottom, key],
        ]);
        let corner = |i: u32| 4 * at + i;
        prims.extend([[0, 1, 2], [0, 2, 3]].map(|p| p.map(corner)));
        colours.extend([colour; 2]);
    }
    let count = u32::try_from(prims.len()).expect("few");
    let primitives = Primitives {
        size,
        bits: 8,
        samples: Samples::ONE,
        snapped,
        prims,
        source: (0..count).collect(),
    };
    Layers {
        scene: painted(&primitives, &colours, [0.25, 0.5, 0.75]),
        primitives,
    }
}

proptest! {
    #![proptest_config(config(200))]

    /// A reduced pixel's lists are those of the triangles at its block's middle.
    #[test]
    fn lists_are_those_of_middles(layers in layers(0..10), halvings in 0_u32..=2) {
        let reduction = Reduction { halvings, falloff: 1.0 };
        let full = &layers.primitives;
        let low = reduction.lists(&layers.scene, full);
        let side = i64::from(reduction.side()) << full.bits;
        let is_opaque = |prim: u32| {
            layers.scene.triangles[full.source[prim as usize] as usize].is_opaque()
        };
        let width = low.primitives.size.width as usize;
        for q in 0..low.primitives.size.pixels() {
            let middle = [q % width, q / width].map(|p| i64::try_from(p).expect("few") * side + side / 2);
            let mut met: Vec<(u32, u32)> = Vec::new();
            let mut end = u32::MAX;
            for prim in 0..u32::try_from(full.prims.len()).expect("few") {
                let Some(setup) = Setup::new(full, prim) else {
                    continue;
                };
                let edges = setup.edges(middle);
                if setup.covers(edges) && is_opaque(prim) {
                    end = end.min(setup.key(edges));
                } else if setup.covers(edges) {
                    met.push((setup.key(edges), prim));
                }
            }
            met.retain(|(key, _)| *key < end);
            met.sort_unstable();
            let list: Vec<_> = low.sorted.list(q).iter().map(|f| (f.key, f.prim)).collect();
            prop_assert_eq!(list, met);
            prop_assert_eq!(low.opaque.key[q], end);
        }
    }

    /// Where a block is a pixel, its middle is the pixel's, and the picture is that of all fragments.
    #[test]
    fn a_block_of_one_pixel_is_that_pixel(layers in layers(0..10), falloff in 0_f32..1e6) {
        let must = layers.full();
        for upsampling in BOTH {
            let seen = layers.reduced(Reduction { halvings: 0, falloff }, upsampling);
            for (a, b) in must.iter().flatten().zip(seen.iter().flatten()) {
                prop_assert!((a.value - b.value).abs() <= 1e-12, "{:?} {:?} {:?}", upsampling, a, b);
            }
        }
    }

    /// Layers that are alike everywhere lose nothing, whatever lies behind them.
    #[test]
    fn even_layers_are_shown_as_they_are(
        colours in prop::collection::vec([0_f32..1.0, 0.0..1.0, 0.0..1.0, 0.0..0.99], 1..5),
        walls in prop::collection::vec(([0_i32..30, 1..31], 1000_i32..2000, [0_f32..1.0, 0.0..1.0, 0.0..1.0]), 0..5),
        (halvings, falloff) in (0_u32..=2, 0_f32..1e6),
        width in 1_u32..30,
    ) {
        // Quads reach beyond all blocks.
        let whole = [-64, 128];
        let glass = (0..).zip(&colours).map(|(key, colour)| (whole, key, *colour));
        let opaque = walls.iter().map(|([left, right], key, [r, g, b])| ([*left, left + right], *key, [*r, *g, *b, 1.0]));
        let all: Vec<_> = glass.chain(opaque).collect();
        let mut layers = quads(width, &all);
        // And below the last row of blocks.
        for corner in &mut layers.primitives.snapped {
            corner[1] = if corner[1] > 0 { 64 << 8 } else { corner[1] };
        }
        let must = layers.full();
        for upsampling in BOTH {
            let seen = layers.reduced(Reduction { halvings, falloff }, upsampling);
            for (a, b) in must.iter().flatten().zip(seen.iter().flatten()) {
                prop_assert!((a.value - b.value).abs() <= 1e-12, "{:?} {:?} {:?}", upsampling, a, b);
            }
        }
    }
}

/// Glass behind a wall that ends within blocks: the nearest reduced pixel shows it past the wall's end, or not
/// up to it, and by depth it ends where the wall does. Of the four around a pixel at least one has its surface,
/// with a weight of 1 or more; the others have 64 in all at most, over `1 + falloff d`.
#[test]
fn depth_keeps_layers_to_their_surfaces() {
    let near = 1 << 20;
    let falloff = 1e6_f32;
    for end in 9..16 {
        let glass = ([-64, 128], 1 << 28, [1.0, 0.0, 0.0, 0.75]);
        let layers = quads(32, &[glass, ([-64, end], near, [0.0, 1.0, 0.0, 1.0])]);
        let must = layers.full();
        let far = |upsampling| {
            let reduction = Reduction {
                halvings: 2,
                falloff,
            };
            let seen = layers.reduced(reduction, upsampling);
            let apart = must.iter().flatten().zip(seen.iter().flatten());
            apart
                .map(|(a, b)| (a.value - b.value).abs())
                .fold(0.0, f64::max)
        };
        // From the wall to where nothing is, most of the depth range.
        let most =
            64.0 / (1.0 + f64::from(falloff) * (1.0 - f64::from(near) / f64::from(1_u32 << 31)));
        assert!(
            far(Upsampling::Joint) <= most,
            "{end}: {} {most}",
            far(Upsampling::Joint)
        );
        let leaks = end % 4 != 0;
        assert_eq!(
            far(Upsampling::Nearest) > 0.1,
            leaks,
            "{end}: {}",
            far(Upsampling::Nearest)
        );
    }
}
