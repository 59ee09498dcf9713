use triptych_gpu::wgsl::Sources;

use crate::bench::Method;
use crate::bench::rivals::tests::{device, wrong};

/// What ships is right; weights without depth, and lists in another order, are refused by name.
#[test]
fn reduced_frames_that_are_wrong_are_named() {
    let (gpu, ships) = (device(), Sources::shipped(false));
    let both = [Method::Half, Method::Quarter];
    let wrong = |sources| wrong(&gpu, "abuffer/reduced", sources, |m| both.contains(&m));
    assert_eq!(wrong(ships.clone()), []);
    for ((file, find, replace), starts) in [
        (
            (
                "reduced",
                "f32(place) * weight_of(key, guide[at])",
                "f32(place)",
            ),
            ["leg, half: ", "leg, quarter: "],
        ),
        (
            (
                "abuffer",
                "return x.key < y.key ||",
                "return x.key > y.key ||",
            ),
            ["leg, half, sorted lists", "leg, quarter, sorted lists"],
        ),
    ] {
        let patched = ships.patched(file, find, replace);
        let found = wrong(patched.expect("it is there once"));
        let is_named = |(found, start): (&(Method, String), &str)| found.1.starts_with(start);
        assert!(
            found.len() == 2 && found.iter().zip(starts).all(is_named),
            "{found:?}"
        );
    }
}
