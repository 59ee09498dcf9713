//! The comparer on scenes whose answer is known.

mod counts;
mod planted;
mod rays;
mod reach;
mod world;

use triptych_spec::raster::{Setup, cover, sample};
use triptych_spec::scene::Size;
use triptych_spec::vertex::{DEPTH_ONE, Primitives};

use super::edge::is_edge;
use super::{EmbreeVote, compare};
use crate::dispatch::share;
use crate::embree::{EmbreeScene, ScreenHits};

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn within(&mut self, low: i32, high: i32) -> i32 {
        let width = u64::from(low.abs_diff(high)) + 1;
        low + i32::try_from(self.next() % width).expect("ranges here are short")
    }

    fn corner(&mut self, low: i32, high: i32) -> [i32; 3] {
        let xy = [self.within(low, high), self.within(low, high)];
        [xy[0], xy[1], self.within(0, DEPTH_ONE)]
    }
}

fn scene(side: u32, triangles: &[[[i32; 3]; 3]]) -> Primitives {
    let rows: Vec<u32> = (0_u32..).zip(triangles).map(|(row, _)| row).collect();
    Primitives {
        samples: triptych_spec::raster::Samples::ONE,
        size: Size {
            width: side,
            height: side,
        },
        bits: 8,
        snapped: triangles.iter().flatten().copied().collect(),
        prims: rows.iter().map(|r| [3 * r, 3 * r + 1, 3 * r + 2]).collect(),
        source: rows,
    }
}

/// Triangles somewhat larger than a target of 64 pixels.
fn large(count: usize) -> Primitives {
    let mut random = Random(1);
    let mut triangle = || [0; 3].map(|_| random.corner(-4096, 5 * 4096));
    let triangles: Vec<_> = (0..count).map(|_| triangle()).collect();
    scene(64, &triangles)
}

/// Triangles across the whole guard rectangle, at most two sub-pixels thick.
fn slivers(count: usize) -> Primitives {
    let mut random = Random(2);
    let mut triangle = || {
        let [a, mut b] = [0; 2].map(|_| random.corner(-(1 << 19), 1 << 19));
        // Through the target's neighbourhood, or few would meet a sample.
        for i in 0..2 {
            b[i] = -a[i] + random.within(0, 1 << 14);
        }
        let mut c = random.corner(0, 0);
        let part = i64::from(random.within(1, 1023));
        for i in 0..2 {
            let on_line = i64::from(a[i]) + i64::from(b[i] - a[i]) * part / 1024;
            c[i] = i32::try_from(on_line).expect("between a and b") + random.within(-2, 2);
        }
        [a, b, c]
    };
    let triangles: Vec<_> = (0..count).map(|_| triangle()).collect();
    scene(64, &triangles)
}

/// One triangle over the middle, one elsewhere, one without area.
fn three() -> Primitives {
    let covering = [[0, 0, 1 << 20], [16384, 0, 1 << 20], [0, 16384, 1 << 20]];
    let elsewhere = [[0, 0, 7], [256, 0, 7], [0, 256, 7]];
    let flat = [[8192, 0, 0], [8192, 512, 0], [8192, 9000, 0]];
    scene(64, &[covering, elsewhere, flat])
}

fn vote(spec: &Primitives, embree: &impl ScreenHits) -> EmbreeVote {
    compare(spec, embree).expect("Embree traces")
}

fn embree(primitives: &Primitives) -> EmbreeScene {
    EmbreeScene::new(primitives).expect("Embree builds")
}

#[test]
fn large_triangles_agree() {
    let spec = large(300);
    let vote = vote(&spec, &embree(&spec));
    let mut fragments = 0;
    cover(&spec, |_| fragments += 1);
    assert_eq!(vote.rays, 64 * 64, "{vote}");
    assert_eq!(vote.disagreeing(), 0, "{vote}");
    assert_eq!(vote.causes().len(), 0, "{vote}");
    assert!(vote.pairs >= fragments && fragments > 100_000, "{vote}");
    assert!(vote.depths + vote.admitted() >= fragments, "{vote}");
    assert!(vote.steps > 100_000, "{vote}");
    assert!(vote.admitted() * 1000 <= vote.pairs, "{vote}");
    assert!((0.1..=1.0).contains(&vote.error_over_bound), "{vote}");
}

#[test]
fn corners_on_samples_are_in_class_edge() {
    let mut spec = large(300);
    for corner in &mut spec.snapped {
        corner[0] = (corner[0] & !255) + 128;
        corner[1] = (corner[1] & !255) + 128;
    }
    let vote = vote(&spec, &embree(&spec));
    let setups = (0..300).filter_map(|prim| Setup::new(&spec, prim));
    let near = |setup: Setup| {
        let at = |pixel: u32| [sample(pixel % 64, 8), sample(pixel / 64, 8)];
        (0..64 * 64)
            .filter(|pixel| is_edge(setup.edges(at(*pixel))))
            .count() as u64
    };
    assert_eq!(
        vote.edge,
        setups.map(near).sum::<u64>(),
        "none left out: {vote}"
    );
    assert_eq!(vote.disagreeing(), 0, "{vote}");
    assert!(vote.edge > 300, "{vote}");
    assert!(
        (1..vote.edge).contains(&vote.edge_agreeing),
        "the fill rule is the spec's own: {vote}"
    );
}

#[test]
fn slivers_agree_where_single_precision_can_tell() {
    let spec = slivers(30_000);
    let vote = vote(&spec, &embree(&spec));
    assert_eq!(vote.disagreeing(), 0, "{vote}");
    assert!(vote.depths > 5_000, "{vote}");
    assert!(vote.unresolved > 50, "{vote}");
    assert!(
        (1..vote.unresolved).contains(&vote.unresolved_agreeing),
        "the class is needed: {vote}"
    );
    assert!(
        vote.unresolved * 10 < vote.depths,
        "the class is small: {vote}"
    );
}

#[test]
fn nothing_to_compare_is_seen_as_such() {
    let spec = scene(64, &[]);
    let vote = vote(&spec, &embree(&spec));
    assert_eq!((vote.rays, vote.pairs), (64 * 64, 0), "{vote}");
}

#[test]
fn the_result_does_not_depend_on_threads() {
    let spec = large(50);
    let embree = embree(&spec);
    let alone = share::with_threads(1, || vote(&spec, &embree));
    let many = share::with_threads(5, || vote(&spec, &embree));
    assert_eq!(alone, many, "one thread against many");
}

#[test]
fn what_single_precision_cannot_hold_is_refused() {
    let mut far = three();
    far.snapped[4][1] = 1 << 22;
    let mut dangling = three();
    dangling.prims[1][2] = 9;
    let mut fine = three();
    fine.bits = 9;
    for (spec, word) in [
        (far, "guard"),
        (dangling, "no corner 9"),
        (fine, "9 sub-pixel bits"),
    ] {
        let error = EmbreeScene::new(&spec).err().expect("refused").to_string();
        assert!(error.contains(word), "{error}");
    }
}
