use triptych_gpu::wgsl::Sources;

use crate::bench::Method;
use crate::bench::rivals::tests::{device, wrong};

/// What ships is right; another order, colour or byte is refused by the layout's name, and no other layout is.
#[test]
fn a_layout_that_is_wrong_is_named() {
    let gpu = device();
    let wrong = |scene, sources| wrong(&gpu, scene, sources, |method| method.layout().is_some());
    let ships = Sources::shipped(false);
    assert_eq!(wrong("abuffer/mixed", ships.clone()), []);
    let names = |scene, (file, find, replace): (&str, &str, &str)| {
        let patched = ships.patched(file, find, replace);
        let found = wrong(scene, patched.expect("it is there once"));
        let starts = |(method, words): &(Method, String)| {
            let start = format!("leg, {}", method.name());
            assert!(words.starts_with(&start), "{words}");
            *method
        };
        found.iter().map(starts).collect::<Vec<_>>()
    };
    let [arrays, linked] = [
        [Method::Precalc, Method::Bucket],
        [Method::Packed, Method::Regions],
    ];
    // Of one colour, so that lists alone tell orders apart.
    let order = (
        "layouts",
        "return a.x < b.x || (a.x == b.x && a.y < b.y);",
        "return a.x > b.x || (a.x == b.x && a.y < b.y);",
    );
    assert_eq!(names("abuffer/quads", order), arrays, "order");
    let bytes = ("packed", "* 255.0 + 0.5", "* 254.0 + 0.5");
    assert_eq!(names("abuffer/mixed", bytes), linked[..1], "bytes");
    let colours = (
        "regions",
        "colours[address] = faces[fragment.prim];",
        "colours[address] = faces[0u];",
    );
    assert_eq!(names("abuffer/mixed", colours), linked[1..], "colours");
    let layers = ("ordered", "faces[slot.y >> MASK_BITS]", "faces[0u]");
    assert_eq!(names("abuffer/mixed", layers), [Method::Ordered], "layers");
}
