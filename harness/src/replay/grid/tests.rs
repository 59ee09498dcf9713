//! From a scene file to rays: limits and defaults.

use std::path::Path;

use super::*;
use crate::corpus::Entry;
use crate::dispatch::share;
use crate::mesh::Intake;
use crate::rays::Kind;
use crate::scene::{Loaded, load_text};

/// Quads, all in the cells of one row, and so many rays of each kind.
fn scene(layers: u32, rays: [u32; Kind::ALL.len()]) -> Loaded {
    let rays = Kind::ALL.iter().zip(rays);
    let rays = rays.map(|(kind, count)| format!("{} = {count}", kind.name()));
    let rays = rays.collect::<Vec<_>>().join(", ");
    let text = format!(
        "
purpose = 'quads'
size = [8, 8]
[[mesh]]
generate.stack = {{ layers = {layers}, spacing = 0.0001, size = [4, 4] }}
[grid]
resolution = [1024, 1, 1]
rays = {{ {rays} }}
"
    );
    let entry = Entry {
        family: "grid".to_owned(),
        ..Entry::outside(Path::new("quads/scene.toml"))
    };
    load_text(&mut Intake::from_disk(), &entry, None, &text).expect("a scene")
}

/// A ray passes a thousand cells with thousands of triangles in each: tens of thousands of rays
/// would take the spec an hour, though no list is long.
#[test]
fn rays_through_many_long_lists_are_refused() {
    let random = [40_000, 0, 0, 0, 0, 0];
    let loaded = scene(2048, random);
    let told = |threads| {
        let run = || GridRun::new(&loaded).map(|_| ());
        share::with_threads(threads, run).expect_err("too much")
    };
    let mistake = told(1);
    assert_eq!(mistake.key.and_then(|key| loaded.lines.of(key)), Some(8));
    let words =
        "grid.rays: 40000 rays pass more than 34359738368 cells and triangles in their lists";
    assert!(mistake.to_string().starts_with(words), "{mistake}");
    assert_eq!(mistake, told(3), "whatever the number of threads");
    assert!(GridRun::new(&scene(4, random)).is_ok());
}

/// By default, what is aimed where Embree cannot tell may go unjudged, and a thousandth of the
/// rest.
#[test]
fn the_budget_is_what_rays_are_drawn_for() {
    let is = |rays, expected: f64| {
        let run = GridRun::new(&scene(2, rays)).expect("small");
        let share = embree::drawn_for_edges(&run);
        assert!((share - expected).abs() < 1e-12, "{rays:?}: {share}");
    };
    is([0; 6], 0.0);
    is([6, 0, 0, 0, 0, 0], 0.001);
    is([6, 0, 2, 0, 0, 0], (2.0 + 0.006) / 8.0);
    is([6, 0, 0, 2, 0, 0], (2.0 + 0.006) / 8.0);
    is([6, 0, 0, 0, 0, 2], 0.001);
    // Those that end where they are aimed at meet something there.
    let run = GridRun::new(&scene(2, [0, 100, 0, 0, 0, 0])).expect("small");
    let ends = run.rays.iter().filter(|ray| ray.segment).count() as f64;
    assert!((20.0..80.0).contains(&ends), "{ends}");
    is(
        [0, 100, 0, 0, 0, 0],
        (ends + 0.001 * (100.0 - ends)) / 100.0,
    );
}
