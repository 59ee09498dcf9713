//! Bytes of each layout, as formulas: what a table of memory states, and what attempts are planned by.

use super::{Layout, REGIONS};
use crate::abuffer::PROGRESS;

/// Opaque key and triangle of a sample, and its colour in the picture.
const SAMPLE: u64 = 2 * 4 + 16;

/// An entry: key, triangle and mask.
pub const ENTRY: u64 = 8;

/// Bytes of each pixel, whatever its lists hold, but for arrays of [`Layout::Bucket`].
pub fn of_pixel(layout: Layout, samples: u32) -> u64 {
    let sample = SAMPLE * u64::from(samples);
    sample
        + match layout {
            // A counter.
            Layout::Bucket => 4,
            // A counter and an offset.
            Layout::Precalc => 4 + 4,
            // Head, and how far its list is sorted or blended.
            Layout::Packed | Layout::Regions => 4 + PROGRESS,
            // Head.
            Layout::Ordered => 4,
        }
}

/// Bytes of each node or entry.
pub fn of_node(layout: Layout) -> u64 {
    match layout {
        Layout::Bucket | Layout::Precalc => ENTRY,
        Layout::Packed => 16,
        // Key, link, triangle, mask; colour.
        Layout::Regions => 16 + 16,
        // Entry and link.
        Layout::Ordered => ENTRY + 4,
    }
}

/// Bytes of each node or entry where a list has `longest`: such as are merged from one buffer to
/// another lie in two.
pub fn of_fragment(layout: Layout, longest: u32) -> u64 {
    match layout {
        Layout::Bucket | Layout::Precalc if longest > crate::lists::LONG => 2 * ENTRY,
        _ => of_node(layout),
    }
}

/// Bytes of a buffer, of which none is shorter.
fn buffer(bytes: u64) -> u64 {
    bytes.max(16)
}

/// Most bytes at a time of the lists of a whole target of so many pixels, each with so many samples, with
/// the picture and the opaque surfaces: `fragments` in all, `longest` of a pixel. Of regions, each has room
/// for `fullest` nodes. For targets of 4 pixels or more.
pub fn peak(
    layout: Layout,
    [pixels, samples]: [u32; 2],
    fragments: u64,
    longest: u32,
    fullest: u32,
) -> u64 {
    let pixels = u64::from(pixels);
    let nodes = match layout {
        Layout::Bucket => pixels * u64::from(longest.max(1)),
        Layout::Regions => u64::from(REGIONS) * u64::from(fullest),
        Layout::Precalc | Layout::Packed => fragments,
        // An invocation may find the node unneeded that it took.
        Layout::Ordered => 2 * fragments,
    };
    let word = buffer(4);
    let few = match layout {
        // Words that kernels bind.
        Layout::Bucket => 2 * word,
        // One more offset, sums of parts of the pixels, a word.
        Layout::Precalc => 4 + buffer(4 * pixels.div_ceil(crate::lists::TILE.into())) + word,
        // Counter, word before the pixels' progress.
        Layout::Packed => word + 4,
        Layout::Regions => 4 * u64::from(REGIONS) + 4,
        Layout::Ordered => 2 * word,
    };
    of_pixel(layout, samples) * pixels + of_fragment(layout, longest) * nodes + few
}
