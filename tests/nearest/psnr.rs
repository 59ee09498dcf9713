//! How near a picture of the nearest layers is to that of all, on the corpus. The spec alone.
//!
//! With layers `c_i, a_i` over `b`, and `T_i` what is left of light behind `i` of them, the picture of all is
//! `sum_i T_i a_i c_i + T_N b`, and that of the `n` nearest ends after `n` terms, with `T_n b`. As
//! `sum_{i >= n} T_i a_i = T_n - T_N`, what is missing is
//!
//! ```text
//! e_n = sum_{i >= n} T_i a_i (c_i - b),    |e_n| <= (T_n - T_N) max_{i >= n} |c_i - b|.
//! ```
//!
//! With opacities from 0 to 1 neither factor of this bound rises with `n`. The error itself may: layers on
//! both sides of `b` cancel each other, so that fewer are nearer to all ([`fewer_may_be_nearer`]). It cannot
//! at a channel where all `c_i` are on one side of `b`, as `e_n - e_{n + 1}` then has the sign of `e_{n + 1}`.
//! So the bound is a law of every pixel, and that the PSNR of whole pictures rises is a fact of the corpus.

use std::sync::Mutex;

use triptych_harness::corpus::{self, Entry};
use triptych_harness::registry::Chain;
use triptych_harness::replay::rivals::NEAREST;
use triptych_harness::scene::{Loaded, load_entry};
use triptych_spec::abuffer::{self, NOTHING, Opaque, Order, Sorted, nearest_of, resolve, visible};
use triptych_spec::bound::Bounded;
use triptych_spec::raster::{self, samples_of};
use triptych_spec::scene::{Scene, Size};
use triptych_spec::vertex::{Primitives, primitives};

/// A scene's picture of each number of layers, and of all.
struct Pictures {
    scene: Scene,
    primitives: Primitives,
    opaque: Opaque,
    sorted: Sorted,
    all: Vec<[Bounded; 3]>,
}

impl Pictures {
    /// Of a scene that is loaded; `None` if it has no transparent layers.
    fn of(loaded: Loaded) -> Option<Self> {
        let Loaded { scene, .. } = loaded;
        if scene
            .triangles
            .iter()
            .all(triptych_spec::scene::Triangle::is_opaque)
        {
            return None;
        }
        let primitives = primitives(&scene, 8);
        let opaque = abuffer::opaque(&scene, &primitives);
        let lists = abuffer::build(&scene, &primitives, &opaque, true, u32::MAX);
        let sorted = abuffer::sort(&lists);
        let all = resolve(&scene, &primitives, &opaque, &sorted);
        let pictures = Self {
            scene,
            primitives,
            opaque,
            sorted,
            all,
        };
        (!pictures.sorted.fragments.is_empty()).then_some(pictures)
    }

    fn nearest(&self, n: u32) -> Vec<[Bounded; 3]> {
        let nearest = nearest_of(&self.sorted, n);
        resolve(&self.scene, &self.primitives, &self.opaque, &nearest)
    }

    /// Most that each channel of a pixel may miss with `n` layers, by the derivation above: the mean over
    /// samples of what each may.
    fn most(&self, pixel: usize, n: u32) -> [f64; 3] {
        let samples = self.primitives.samples.count() as usize;
        let colour = |prim: u32| {
            let source = self.primitives.source[prim as usize];
            self.scene.triangles[source as usize].colour.map(f64::from)
        };
        let mut most = [0.0; 3];
        for s in 0..samples {
            let behind = match self.opaque.prim[samples * pixel + s] {
                NOTHING => self.scene.background.map(f64::from),
                prim => [0, 1, 2].map(|c| colour(prim)[c]),
            };
            let (mut before, mut after, mut apart) = (1.0, 1.0, [0.0_f64; 3]);
            for (i, f) in (0..).zip(self.sorted.list(pixel)) {
                let shows = samples_of(visible(&self.primitives, &self.opaque, f));
                if !shows.into_iter().any(|shown| shown as usize == s) {
                    continue;
                }
                let c = colour(f.prim);
                after *= 1.0 - c[3];
                if i < n {
                    before *= 1.0 - c[3];
                } else {
                    apart = [0, 1, 2].map(|k| apart[k].max((c[k] - behind[k]).abs()));
                }
            }
            most = [0, 1, 2].map(|k| most[k] + (before - after) * apart[k] / samples as f64);
        }
        most
    }
}

/// The sum of the squares of what a picture misses of another.
fn missed(some: &[[Bounded; 3]], all: &[[Bounded; 3]]) -> f64 {
    let pairs = some.iter().flatten().zip(all.iter().flatten());
    pairs.map(|(a, b)| (a.value - b.value).powi(2)).sum()
}

/// What must hold of a scene; a word if it was looked at.
fn holds(entry: &Entry, pictures: &Pictures) {
    let name = &entry.name;
    let shown = NEAREST.map(|n| pictures.nearest(n));
    let errors = shown.each_ref().map(|some| missed(some, &pictures.all));
    for (pair, n) in errors.windows(2).zip(NEAREST) {
        // Peak and number of pixels are those of the scene, so that PSNR rises as this falls.
        let rises = pair[1] < pair[0] || (pair[0] == 0.0 && pair[1] == 0.0);
        let same = nearest_of(&pictures.sorted, n) == pictures.sorted;
        assert!(rises || same, "{name}, from {n} layers on: {errors:?}");
    }
    // By a sample's own keys, other layers are the nearest there.
    if pictures.scene.order == Order::Sample {
        return;
    }
    for (some, n) in shown.iter().zip(NEAREST) {
        for (pixel, (some, all)) in some.iter().zip(&pictures.all).enumerate() {
            let most = pictures.most(pixel, n);
            for c in 0..3 {
                let error = (some[c].value - all[c].value).abs();
                // Sums in another order round by less than the bounds of an `f32`.
                let off = some[c].bound + all[c].bound;
                assert!(
                    error <= most[c] + off,
                    "{name}, {n} layers, pixel {pixel}: {error} {most:?}"
                );
            }
        }
    }
}

/// On every scene of the corpus with layers the PSNR of the nearest rises with their number, until all are
/// shown; and no pixel misses more than what is behind them may add.
#[test]
fn more_layers_are_nearer_to_all() {
    let entries = corpus::list(&corpus::root()).expect("the corpus can be read");
    let (waiting, seen) = (Mutex::new(entries.iter()), Mutex::new(Vec::new()));
    let work = || {
        loop {
            let Some(entry) = waiting.lock().expect("nobody failed").next() else {
                return;
            };
            // Scenes whose meshes are not here are skipped aloud by the tests of scenes.
            let Ok(loaded) = load_entry(entry, None) else {
                continue;
            };
            if loaded.chain() == Chain::Frame
                && let Some(pictures) = Pictures::of(loaded)
            {
                holds(entry, &pictures);
                seen.lock().expect("nobody failed").push(entry.name.clone());
            }
        }
    };
    std::thread::scope(|scope| {
        let other = scope.spawn(work);
        work();
        other
            .join()
            .unwrap_or_else(|e| std::panic::resume_unwind(e));
    });
    let seen = seen.into_inner().expect("nobody failed");
    assert!(
        seen.len() > 30,
        "{} scenes are not the corpus: {seen:?}",
        seen.len()
    );
}

/// A white layer and a black one over grey: none at all is what both are, and one is not.
#[test]
fn fewer_may_be_nearer() {
    let colours = [[1.0, 1.0, 1.0, 0.25], [0.0, 0.0, 0.0, 1.0 / 3.0]];
    let corners = [
        [0, 0, 1],
        [512, 0, 1],
        [0, 512, 1],
        [0, 0, 2],
        [512, 0, 2],
        [0, 512, 2],
    ];
    let primitives = Primitives {
        size: Size {
            width: 1,
            height: 1,
        },
        bits: 8,
        samples: raster::Samples::ONE,
        snapped: corners.to_vec(),
        prims: vec![[0, 1, 2], [3, 4, 5]],
        source: vec![0, 1],
    };
    let triangle = |colour| triptych_spec::scene::Triangle {
        vertices: [0; 3],
        instance: 0,
        primitive: 0,
        colour,
    };
    let scene = Scene {
        samples: raster::Samples::ONE,
        order: Order::Centroid,
        size: primitives.size,
        instances: Vec::new(),
        vertices: Vec::new(),
        triangles: colours.map(triangle).to_vec(),
        background: [0.5; 3],
    };
    let opaque = Opaque::nothing(&primitives);
    let lists = abuffer::build(&scene, &primitives, &opaque, true, u32::MAX);
    let sorted = abuffer::sort(&lists);
    let all = resolve(&scene, &primitives, &opaque, &sorted);
    let error = |n| {
        let some = resolve(&scene, &primitives, &opaque, &nearest_of(&sorted, n));
        missed(&some, &all)
    };
    assert!(error(0) < 1e-12, "{}", error(0));
    assert!(error(1) > 0.01, "{}", error(1));
}
