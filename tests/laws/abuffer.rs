//! Laws of the A-buffer.

#[path = "abuffer/multisample.rs"]
mod multisample;
#[path = "abuffer/nearest.rs"]
mod nearest;
#[path = "abuffer/order.rs"]
mod order;
#[path = "abuffer/resolve.rs"]
mod resolve;
#[path = "abuffer/rivals.rs"]
mod rivals;

use proptest::prelude::*;
use triptych_spec::abuffer::{EOL, Lists, NOTHING, Node, Opaque, Sorted, build, opaque, sort};
use triptych_spec::raster::Fragment;
use triptych_spec::scene::{Scene, Triangle};
use triptych_spec::vertex::Primitives;

use super::config;
use super::samples::{fragments, soup};

/// Opacities: opaque, invisible, nearly either, anything.
fn opacity() -> impl Strategy<Value = f32> {
    prop_oneof![
        2 => Just(1.0_f32),
        1 => Just(0.0_f32),
        1 => Just(1.0_f32.next_down()),
        1 => Just(1e-30_f32),
        5 => 0_f32..1.0,
    ]
}

/// Triangles on the grid with colours. Of neighbouring rows some come from one source
/// triangle, as pieces of a clipped one do, and some coincide.
#[derive(Clone, Debug)]
pub struct Layers {
    pub scene: Scene,
    pub primitives: Primitives,
}

fn layers(count: std::ops::Range<usize>) -> impl Strategy<Value = Layers> {
    coloured(soup(count))
}

/// The same from given triangles.
pub fn coloured(soup: impl Strategy<Value = Primitives>) -> impl Strategy<Value = Layers> {
    soup.prop_flat_map(|primitives| {
        let n = primitives.prims.len();
        let colour = (0_f32..2.0, 0_f32..2.0, 0_f32..2.0, opacity());
        let colours = prop::collection::vec(colour.prop_map(|(r, g, b, a)| [r, g, b, a]), n);
        let background = [0_f32..1.0, 0_f32..1.0, 0_f32..1.0];
        let pieces = prop::collection::vec(any::<[bool; 2]>(), n);
        (colours, background, pieces).prop_map(move |(colours, background, pieces)| {
            let mut primitives = primitives.clone();
            let mut source = 0;
            for (row, [piece, same]) in pieces.into_iter().enumerate() {
                primitives.source[row] = source;
                source += u32::from(!piece);
                if same && row > 0 {
                    primitives.prims[row] = primitives.prims[row - 1];
                }
            }
            let scene = painted(&primitives, &colours, background);
            Layers { scene, primitives }
        })
    })
}

/// A scene whose triangles have these colours. The raster stage looks at nothing else.
pub fn painted(primitives: &Primitives, colours: &[[f32; 4]], background: [f32; 3]) -> Scene {
    let triangle = |(primitive, colour): (u32, &[f32; 4])| Triangle {
        vertices: [0; 3],
        instance: 0,
        primitive,
        colour: *colour,
    };
    Scene {
        samples: triptych_spec::raster::Samples::ONE,
        order: triptych_spec::abuffer::Order::Centroid,
        size: primitives.size,
        instances: Vec::new(),
        vertices: Vec::new(),
        triangles: (0..).zip(colours).map(triangle).collect(),
        background,
    }
}

impl Layers {
    fn is_opaque(&self, f: &Fragment) -> bool {
        let source = self.primitives.source[f.prim as usize];
        self.scene.triangles[source as usize].is_opaque()
    }

    fn opaque(&self) -> Opaque {
        opaque(&self.scene, &self.primitives)
    }

    fn build(&self, depth_test: bool, capacity: u32) -> Lists {
        build(
            &self.scene,
            &self.primitives,
            &self.opaque(),
            depth_test,
            capacity,
        )
    }

    /// The nearest opaque fragment of each pixel, by looking at all of them.
    fn nearest(&self) -> Vec<Option<(u32, u32)>> {
        let all = fragments(&self.primitives);
        let at = |pixel| {
            let here = all.iter().filter(|f| f.pixel == pixel && self.is_opaque(f));
            here.map(|f| (f.key, f.prim)).min()
        };
        (0..self.pixels()).map(at).collect()
    }

    /// Every pixel's transparent fragments in front of the opaque one, in order.
    fn visible(&self) -> Vec<Vec<Fragment>> {
        let mut all = fragments(&self.primitives);
        all.sort_by_key(|f| (f.key, f.prim));
        let end = self.nearest();
        let at = |pixel: u32| {
            let front = |f: &&Fragment| end[pixel as usize].is_none_or(|(key, _)| f.key < key);
            let here = all
                .iter()
                .filter(|f| f.pixel == pixel && !self.is_opaque(f));
            here.filter(front).copied().collect()
        };
        (0..self.pixels()).map(at).collect()
    }

    /// Key, mask and colour of everything in each pixel's list, in some order of their own.
    fn contents(&self) -> Vec<Vec<(u32, u32, [u32; 4])>> {
        let sorted = sort(&self.build(true, u32::MAX));
        let content = |f: &Fragment| {
            let source = self.primitives.source[f.prim as usize];
            let colour = self.scene.triangles[source as usize].colour;
            (f.key, f.mask, colour.map(f32::to_bits))
        };
        let mut lists: Vec<Vec<_>> = by_pixel(&sorted)
            .iter()
            .map(|list| list.iter().map(content).collect())
            .collect();
        lists
            .iter_mut()
            .for_each(|list: &mut Vec<_>| list.sort_unstable());
        lists
    }

    fn pixels(&self) -> u32 {
        self.scene.size.width * self.scene.size.height
    }
}

/// Each pixel's sorted list.
fn by_pixel(sorted: &Sorted) -> Vec<Vec<Fragment>> {
    (0..sorted.offsets.len() - 1)
        .map(|pixel| sorted.list(pixel).to_vec())
        .collect()
}

/// Lists that hold these fragments, inserted in this order.
fn linked(pixels: usize, fragments: impl IntoIterator<Item = Fragment>) -> Lists {
    let mut lists = Lists {
        heads: vec![EOL; pixels],
        nodes: Vec::new(),
        colours: Vec::new(),
        attempts: 0,
        capacity: u32::MAX,
    };
    for Fragment {
        pixel,
        prim,
        key,
        mask,
    } in fragments
    {
        let next = std::mem::replace(&mut lists.heads[pixel as usize], lists.attempts);
        lists.nodes.push(Node {
            key,
            next,
            prim,
            mask,
        });
        lists.colours.push([0.0; 4]);
        lists.attempts += 1;
    }
    lists
}

/// Each node's pixel: the one whose list it is in; `None` for one in no list.
fn owners(lists: &Lists) -> Result<Vec<Option<u32>>, TestCaseError> {
    let mut owners = vec![None; lists.nodes.len()];
    for (pixel, head) in (0..).zip(&lists.heads) {
        let mut at = *head;
        while at != EOL {
            let owner: &mut Option<u32> = &mut owners[at as usize];
            prop_assert!(owner.replace(pixel).is_none(), "node {at} is met twice");
            at = lists.nodes[at as usize].next;
        }
    }
    Ok(owners)
}

proptest! {
    #![proptest_config(config(600))]

    /// The opaque surface is the smallest (key, row) of all.
    #[test]
    fn opaque_is_nearest(layers in layers(0..8)) {
        let seen = layers.opaque();
        for (pixel, nearest) in layers.nearest().into_iter().enumerate() {
            let seen = (seen.key[pixel], seen.prim[pixel]);
            prop_assert_eq!(seen, nearest.unwrap_or((NOTHING, NOTHING)));
        }
    }

    /// Lists, once sorted, are what sorting each pixel's fragments gives; without the
    /// depth test they are once what is hidden is removed.
    #[test]
    fn lists_are_sorted_pixels(layers in layers(0..10)) {
        let visible = layers.visible();
        let sorted = sort(&layers.build(true, u32::MAX));
        prop_assert_eq!(&by_pixel(&sorted), &visible);
        let mut all = by_pixel(&sort(&layers.build(false, u32::MAX)));
        let end = layers.opaque().key;
        for (pixel, list) in all.iter_mut().enumerate() {
            list.retain(|f| f.key < end[pixel]);
        }
        prop_assert_eq!(&all, &visible);
    }

    /// Nothing is lost or made up: lists and opaque triangles together have all
    /// fragments, and every node is in exactly one list, with its triangle's colour.
    #[test]
    fn conservation(layers in layers(0..10)) {
        let lists = layers.build(false, u32::MAX);
        let all = fragments(&layers.primitives);
        let opaque = all.iter().filter(|f| layers.is_opaque(f)).count();
        prop_assert_eq!(lists.nodes.len() + opaque, all.len());
        prop_assert_eq!(lists.attempts as usize, lists.nodes.len());
        let owners = owners(&lists)?;
        prop_assert!(owners.iter().all(Option::is_some));
        prop_assert_eq!(lists.colours.len(), lists.nodes.len());
        for (node, colour) in lists.nodes.iter().zip(&lists.colours) {
            let source = layers.primitives.source[node.prim as usize];
            prop_assert_eq!(*colour, layers.scene.triangles[source as usize].colour);
        }
        let hidden = layers.build(true, u32::MAX);
        let visible: usize = layers.visible().iter().map(Vec::len).sum();
        prop_assert_eq!(hidden.attempts as usize, visible);
    }

    /// A buffer that is too small loses the fragments that came last, and no list.
    #[test]
    fn capacity(layers in layers(0..8), share in 0_u32..=100, depth_test in any::<bool>()) {
        let full = layers.build(depth_test, u32::MAX);
        let capacity = full.attempts * share / 100;
        let small = layers.build(depth_test, capacity);
        prop_assert_eq!(small.attempts, full.attempts);
        prop_assert_eq!(small.nodes.len(), full.attempts.min(capacity) as usize);
        prop_assert!(owners(&small)?.iter().all(Option::is_some));
        let (all, kept) = (by_pixel(&sort(&full)), by_pixel(&sort(&small)));
        for (all, kept) in all.iter().zip(&kept) {
            prop_assert!(kept.iter().all(|f| all.contains(f)), "{kept:?} of {all:?}");
            let mut once = kept.clone();
            once.dedup();
            prop_assert_eq!(&once, kept);
        }
    }
}
