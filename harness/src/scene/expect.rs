//! Closed-form answers of analytic scenes, held against the spec.

use serde::Deserialize;
use triptych_spec::abuffer::{NOTHING, Opaque, Sorted};
use triptych_spec::raster::cover;
use triptych_spec::scene::Scene;
use triptych_spec::vertex::Primitives;

/// What is known of a scene without running anything. What is left out is not
/// checked. Pixels count from 0 at the top left.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Transparent fragments in all lists.
    pub fragments: Option<u64>,
    /// Length of the longest list.
    pub layers_max: Option<u64>,
    /// Pixels with an opaque surface.
    pub opaque: Option<u64>,
    /// Covered pairs of pixel and triangle, opaque or not, hidden or not.
    pub covered: Option<u64>,
    /// How many triangles cover each pixel of a rectangle.
    #[serde(default)]
    pub cover: Vec<Cover>,
    /// Single pixels' lists.
    #[serde(default)]
    pub lists: Vec<List>,
}

/// Each pixel of a rectangle is covered by exactly `times` triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cover {
    /// First column and the one after the last.
    pub x: [u32; 2],
    /// First row and the one after the last.
    pub y: [u32; 2],
    /// Number of triangles.
    pub times: u32,
}

/// One pixel's list.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct List {
    /// Column and row.
    pub at: [u32; 2],
    /// Source triangles' numbers, nearest first.
    pub prims: Vec<u32>,
}

/// What of `expect` the spec's result contradicts, one line each; empty if
/// nothing.
pub fn check(
    expect: &Expect,
    scene: &Scene,
    primitives: &Primitives,
    opaque: &Opaque,
    sorted: &Sorted,
) -> Vec<String> {
    let mut wrong = Vec::new();
    let mut number = |what: &str, expected: Option<u64>, got: usize| {
        if expected.is_some_and(|e| e != got as u64) {
            let expected = expected.unwrap_or_default();
            wrong.push(format!("{what}: {got}, expected {expected}"));
        }
    };
    let longest = sorted.offsets.windows(2).map(|w| w[1] - w[0]).max();
    let hidden = opaque.prim.iter().filter(|p| **p != NOTHING).count();
    let counts = coverage(primitives);
    number("fragments", expect.fragments, sorted.fragments.len());
    number(
        "layers_max",
        expect.layers_max,
        longest.unwrap_or(0) as usize,
    );
    number("opaque", expect.opaque, hidden);
    number(
        "covered",
        expect.covered,
        counts.iter().map(|c| *c as usize).sum(),
    );
    wrong.extend(
        expect
            .cover
            .iter()
            .filter_map(|c| check_cover(c, scene, &counts)),
    );
    let list = |l: &List| check_list(l, scene, primitives, sorted);
    wrong.extend(expect.lists.iter().filter_map(list));
    wrong
}

/// How many triangles cover each pixel.
fn coverage(primitives: &Primitives) -> Vec<u32> {
    let mut counts = vec![0; primitives.size.pixels()];
    cover(primitives, |f| counts[f.pixel as usize] += 1);
    counts
}

fn check_cover(cover: &Cover, scene: &Scene, counts: &[u32]) -> Option<String> {
    let Cover { x, y, times } = *cover;
    if x[0] >= x[1] || y[0] >= y[1] || x[1] > scene.size.width || y[1] > scene.size.height {
        return Some(format!(
            "cover: x {x:?}, y {y:?} is empty or leaves the picture"
        ));
    }
    let pixels = (y[0]..y[1]).flat_map(|row| (x[0]..x[1]).map(move |column| (column, row)));
    for (column, row) in pixels {
        let got = counts[(row * scene.size.width + column) as usize];
        if got != times {
            let message = format!("cover: {got} triangles at [{column}, {row}], expected {times}");
            return Some(message);
        }
    }
    None
}

fn check_list(
    list: &List,
    scene: &Scene,
    primitives: &Primitives,
    sorted: &Sorted,
) -> Option<String> {
    let [x, y] = list.at;
    if x >= scene.size.width || y >= scene.size.height {
        return Some(format!("lists: [{x}, {y}] is outside the picture"));
    }
    let source = |prim: u32| scene.triangles[primitives.source[prim as usize] as usize].primitive;
    let fragments = sorted.list((y * scene.size.width + x) as usize);
    let got: Vec<u32> = fragments.iter().map(|f| source(f.prim)).collect();
    let message = || format!("lists: {got:?} at [{x}, {y}], expected {:?}", list.prims);
    (got != list.prims).then(message)
}
