//! Closed-form answers of analytic scenes, held against the spec.

use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;
use triptych_spec::abuffer::{Opaque, Sorted};
use triptych_spec::raster::cover;
use triptych_spec::scene::{Scene, Size};
use triptych_spec::vertex::Primitives;

use super::value::{at_most, exactly};

/// Most rectangles and lists of a scene: a rectangle may have all of its pixels.
const STATED_MAX: usize = 1 << 10;

/// What is known of a scene without running anything. What is left out is not
/// checked. Pixels count from 0 at the top left.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Transparent fragments in all lists.
    pub fragments: Option<u64>,
    /// Length of the longest list.
    pub layers_max: Option<u64>,
    /// The longest list has at least so many fragments.
    pub layers_min: Option<u64>,
    /// Pixels with an opaque surface.
    pub opaque: Option<u64>,
    /// Covered pairs of pixel and triangle, opaque or not, hidden or not.
    pub covered: Option<u64>,
    /// How many triangles cover each pixel of a rectangle.
    #[serde(default, deserialize_with = "at_most::<STATED_MAX, _, _>")]
    pub cover: Vec<Spanned<Cover>>,
    /// Single pixels' lists.
    #[serde(default, deserialize_with = "at_most::<STATED_MAX, _, _>")]
    pub lists: Vec<Spanned<List>>,
}

/// Each pixel of a rectangle is covered by exactly `times` triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cover {
    /// First column and the one after the last.
    #[serde(deserialize_with = "exactly")]
    pub x: [u32; 2],
    /// First row and the one after the last.
    #[serde(deserialize_with = "exactly")]
    pub y: [u32; 2],
    /// Number of triangles.
    pub times: u32,
}

/// One pixel's list.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct List {
    /// Column and row.
    #[serde(deserialize_with = "exactly")]
    pub at: [u32; 2],
    /// Source triangles' numbers, nearest first.
    pub prims: Vec<u32>,
}

impl Expect {
    /// How many statements the scene makes.
    pub fn stated(&self) -> u64 {
        // Named one by one, so that a new key cannot be forgotten here.
        let Self {
            fragments,
            layers_max,
            layers_min,
            opaque,
            covered,
            cover,
            lists,
        } = self;
        let numbers = [fragments, layers_max, layers_min, opaque, covered];
        let numbers = numbers.iter().filter(|n| n.is_some()).count();
        (numbers + cover.len() + lists.len()) as u64
    }

    /// Refuses a rectangle that is empty or leaves the picture and a pixel outside
    /// it: nothing that a leg does could make such a statement true.
    pub(super) fn check_places(&self, size: Size) -> Result<(), (Range<usize>, String)> {
        let Size { width, height } = size;
        for cover in &self.cover {
            let Cover { x, y, .. } = *cover.get_ref();
            for (axis, [first, end], side) in [("x", x, width), ("y", y, height)] {
                if first >= end || end > side {
                    let message = format!(
                        "expect.cover: {axis} = [{first}, {end}] is no range within [0, {side}]"
                    );
                    return Err((cover.span(), message));
                }
            }
        }
        for list in &self.lists {
            let [x, y] = list.get_ref().at;
            if x >= width || y >= height {
                let message = format!(
                    "expect.lists: at = [{x}, {y}] is outside the picture, which ends at [{}, {}]",
                    width - 1,
                    height - 1
                );
                return Err((list.span(), message));
            }
        }
        Ok(())
    }
}

/// What of `expect` the spec's result contradicts, one line each; empty if
/// nothing. Its places lie in the picture, as loading sees to.
pub fn check(
    expect: &Expect,
    scene: &Scene,
    primitives: &Primitives,
    opaque: &Opaque,
    sorted: &Sorted,
) -> Vec<String> {
    let mut wrong = Vec::new();
    let longest = u64::from(sorted.longest());
    let hidden = opaque.pixels(primitives.size.pixels());
    let counts = coverage(primitives);
    let covered = counts.iter().map(|c| u64::from(*c)).sum();
    let numbers = [
        ("fragments", expect.fragments, sorted.fragments.len() as u64),
        ("layers_max", expect.layers_max, longest),
        ("opaque", expect.opaque, hidden as u64),
        ("covered", expect.covered, covered),
    ];
    for (what, expected, got) in numbers {
        if let Some(expected) = expected.filter(|e| *e != got) {
            wrong.push(format!("{what}: {got}, expected {expected}"));
        }
    }
    if let Some(least) = expect.layers_min.filter(|least| longest < *least) {
        wrong.push(format!("layers_min: {longest}, expected {least} or more"));
    }
    let cover = |c: &Spanned<Cover>| check_cover(c.get_ref(), scene, &counts);
    wrong.extend(expect.cover.iter().filter_map(cover));
    let list = |l: &Spanned<List>| check_list(l.get_ref(), scene, primitives, sorted);
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
    let source = |prim: u32| scene.triangles[primitives.source[prim as usize] as usize].primitive;
    let fragments = sorted.list((y * scene.size.width + x) as usize);
    let got: Vec<u32> = fragments.iter().map(|f| source(f.prim)).collect();
    let message = || format!("lists: {got:?} at [{x}, {y}], expected {:?}", list.prims);
    (got != list.prims).then(message)
}
