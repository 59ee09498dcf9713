//! The map of causes: where two legs differ, and why.

use std::collections::BTreeMap;

use triptych_spec::scene::Size;

use super::{Image, Legend, SIDE_MAX, png, srgb};
use crate::cause::Cause;

/// One cause in a map of causes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Mark {
    /// Why these pixels differ; `None` if nothing explains them.
    pub cause: Option<Cause>,
    /// How many pixels.
    pub pixels: u64,
    /// Column and row of the first, in order of rows.
    pub first: [u32; 2],
}

/// Colours that people with any colour vision tell apart (Okabe and Ito 2008),
/// less black, which is the ground.
const COLOURS: [[u8; 3]; 7] = [
    [230, 159, 0],
    [86, 180, 233],
    [0, 158, 115],
    [240, 228, 66],
    [0, 114, 178],
    [213, 94, 0],
    [204, 121, 167],
];

/// Patterns of 4 × 4 pixels, one bit each from the top left: solid, falling,
/// rising, upright, level, dots, checks, cross.
const PATTERNS: [u16; 8] = [
    0xffff, 0x8421, 0x1248, 0xaaaa, 0xf0f0, 0xa0a0, 0xcc33, 0x4e44,
];

/// What lies between the strokes of a pattern.
const GAP: [u8; 3] = [255, 255, 255];

/// Smallest size of a mark in pixels of the picture, so that a single differing
/// pixel of a large picture is seen.
const MARK_MIN: u32 = 5;

/// A small picture is enlarged by the largest whole factor up to this side, so
/// that a pixel shows its pattern.
const SIDE_SMALL: u32 = SIDE_MAX / 2;

/// Largest enlargement.
const ENLARGE_MAX: u32 = 32;

/// A map of the pixels that differ over a dimmed picture of the scene.
///
/// Where causes meet in a mark, the first of [`Cause`]'s order is shown, and what
/// has no cause before all. Colour and pattern are fixed per cause, so that maps
/// of different scenes read alike.
pub fn causes(
    size: Size,
    ground: Option<&[[f32; 3]]>,
    marks: impl IntoIterator<Item = (u32, Option<Cause>)>,
) -> Image {
    let side = size.width.max(size.height);
    let reduce = super::reduction(size);
    let enlarge = (SIDE_SMALL / side).clamp(1, ENLARGE_MAX);
    let out = [size.width, size.height].map(|n| n.div_ceil(reduce) * enlarge);
    let mut by_cause: BTreeMap<Option<Cause>, Vec<u32>> = BTreeMap::new();
    for (pixel, cause) in marks {
        assert!((pixel as usize) < size.pixels(), "a pixel of the picture");
        by_cause.entry(cause).or_default().push(pixel);
    }
    let mut rgb = dimmed(size, ground, reduce, enlarge, out);
    // Last painted is on top.
    for (&cause, pixels) in by_cause.iter().rev() {
        for &pixel in pixels {
            let at = [pixel % size.width, pixel / size.width];
            paint(
                &mut rgb,
                out,
                at.map(|n| n / reduce * enlarge),
                enlarge,
                cause,
            );
        }
    }
    let legend = by_cause.into_iter().map(|(cause, mut pixels)| {
        pixels.sort_unstable();
        pixels.dedup();
        Mark {
            cause,
            pixels: pixels.len() as u64,
            first: [pixels[0] % size.width, pixels[0] / size.width],
        }
    });
    let legend: Vec<Mark> = legend.collect();
    Image {
        png: png(out[0], out[1], rgb),
        width: out[0],
        height: out[1],
        note: note(size, reduce, enlarge),
        legend: Legend::Causes(legend),
    }
}

fn note(size: Size, reduce: u32, enlarge: u32) -> String {
    let (w, h) = (size.width, size.height);
    let scale = match (reduce, enlarge) {
        (1, 1) => String::new(),
        (1, _) => format!(", shown {enlarge} times as large"),
        _ => format!(", shown at 1/{reduce}"),
    };
    let marks = match enlarge < MARK_MIN {
        true => format!("; a mark is at least {MARK_MIN} × {MARK_MIN} on the picture"),
        false => String::new(),
    };
    format!("{w} × {h} pixels{scale}{marks}")
}

/// The ground: the picture in grey at a quarter of its brightness.
fn dimmed(
    size: Size,
    ground: Option<&[[f32; 3]]>,
    reduce: u32,
    enlarge: u32,
    out: [u32; 2],
) -> Vec<u8> {
    let mut rgb = Vec::with_capacity(out[0] as usize * out[1] as usize * 3);
    for y in 0..out[1] {
        for x in 0..out[0] {
            let [x, y] = [x, y].map(|n| n / enlarge * reduce);
            let pixel = y as usize * size.width as usize + x as usize;
            let grey = ground.map_or(0.02, |pixels| {
                let [r, g, b] = pixels[pixel].map(f64::from);
                0.02 + 0.23 * (0.2126 * r + 0.7152 * g + 0.0722 * b).clamp(0.0, 1.0)
            });
            rgb.extend([srgb(grey); 3]);
        }
    }
    rgb
}

/// Paints a mark whose top left is at `at`, grown around its middle to at least
/// [`MARK_MIN`] and cut at the picture's edge.
fn paint(rgb: &mut [u8], out: [u32; 2], at: [u32; 2], side: u32, cause: Option<Cause>) {
    let grown = side.max(MARK_MIN);
    let start = at.map(|n| n.saturating_sub((grown - side) / 2));
    let end = [0, 1].map(|i| (start[i] + grown).min(out[i]));
    for y in start[1]..end[1] {
        for x in start[0]..end[0] {
            let byte = (y as usize * out[0] as usize + x as usize) * 3;
            rgb[byte..byte + 3].copy_from_slice(&stroke(cause, x, y));
        }
    }
}

/// Colour of a cause's pattern at a pixel of the picture.
fn stroke(cause: Option<Cause>, x: u32, y: u32) -> [u8; 3] {
    let Some(cause) = cause else {
        // No cause: solid red, the one thing that must not be overlooked.
        return [255, 0, 0];
    };
    let i = cause as usize;
    // Seven colours and eight patterns have no common factor: 56 pairs.
    let pattern = PATTERNS[i % PATTERNS.len()];
    let bit = 15 - (y % 4 * 4 + x % 4);
    match pattern >> bit & 1 {
        1 => COLOURS[i % COLOURS.len()],
        _ => GAP,
    }
}

/// A sample of a cause's colour and pattern for a legend, as PNG.
pub fn swatch(cause: Option<Cause>) -> Vec<u8> {
    const SIDE: u32 = 16;
    let pixels = (0..SIDE * SIDE).flat_map(|i| stroke(cause, i % SIDE, i / SIDE));
    png(SIDE, SIDE, pixels.collect())
}
