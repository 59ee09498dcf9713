//! Bands put together are the whole.

use triptych_spec::abuffer;
use triptych_spec::raster::count;
use triptych_spec::scene::Size;
use triptych_spec::vertex::primitives;

use super::{Asked, Drawn, draw};
use crate::corpus;
use crate::dispatch::share::with_threads;
use crate::replay::pieces::bands::{FRAGMENTS, Rows, bands, fragments, picture};
use crate::scene::load;

#[test]
fn bands_hold_every_row_once() {
    for height in [1, 7, 8, 9, 1000] {
        let size = Size { width: 3, height };
        let whole = bands(size, 10);
        assert_eq!(
            whole,
            [Rows {
                first: 0,
                count: height
            }],
            "few fragments"
        );
        let mut next = 0;
        for Rows { first, count } in bands(size, u64::MAX) {
            assert_eq!(first, next, "of {height}");
            assert!(count > 0, "of {height}");
            next += count;
        }
        assert_eq!(next, height, "all of them");
    }
}

#[test]
fn bands_together_are_the_whole() {
    for name in ["mixed", "msaa-mixed", "teapot"] {
        let file = corpus::root().join("abuffer").join(name).join("scene.toml");
        let scene = load(&file).unwrap_or_else(|e| panic!("{e}")).scene;
        let snapped = primitives(&scene, 8);
        assert!(count(&snapped) >= FRAGMENTS, "{name} is taken apart");
        let asked = Asked {
            cover: true,
            opaque: true,
            depth_test: true,
        };
        let whole = Drawn::new(&scene, &snapped, asked);
        for threads in [1, 3] {
            let made = with_threads(threads, || draw(&scene, &snapped, asked, u64::MAX));
            assert_eq!(fragments(&snapped), count(&snapped), "{name}");
            assert_eq!(made.cover, whole.cover, "{name}");
            assert_eq!(made.opaque, whole.opaque, "{name}");
            assert_eq!(made.sorted, whole.sorted, "{name}");
            assert_eq!(made.image, whole.image, "{name}");
            assert_eq!(made.lists.attempts, whole.lists.attempts, "{name}");
            assert_eq!(abuffer::sort(&made.lists), whole.sorted, "{name}: links");
        }
        // It knows one sample a pixel.
        if snapped.samples.count() > 1 {
            continue;
        }
        let weighted = |p: &_, o: &_| abuffer::weighted(&scene, p, o);
        let all = weighted(&snapped, &whole.opaque);
        assert_eq!(picture(&snapped, &whole.opaque, weighted), all, "{name}");
    }
}
