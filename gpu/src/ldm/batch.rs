//! Batches of maps: as many as a binding and a budget of memory hold.

use std::ops::Range;

use triptych_spec::ldm::Maps;

use super::{LARGE_AT_ONCE, Told};
use crate::frame::WORKGROUP;

/// Pixels of a map that a workgroup looks at in a dispatch, at most: if all its large triangles are
/// as large as the map, an invocation has a 64th of each. llvmpipe leaves every loop after 65,535
/// iterations in all.
const DRAWN: u32 = 60_000 / LARGE_AT_ONCE * WORKGROUP;

/// Maps that are built at once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Span {
    /// Their numbers.
    pub(super) maps: Range<u32>,
    /// Their pixels among those of all maps.
    pub(super) pixels: Range<u32>,
    /// Rows of the highest.
    height: u32,
    /// Pixels a row of the widest.
    width: u32,
}

/// Runs of maps with at most so many pixels each, or one map.
pub(super) fn spans(maps: &Maps, pixels: u64) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    for number in (0..).take(maps.maps.len()) {
        let own = Span::of(maps, number..number + 1);
        match spans.last_mut() {
            Some(last) if u64::from(own.pixels.end - last.pixels.start) <= pixels => {
                *last = Span::of(maps, last.maps.start..number + 1);
            }
            _ => spans.push(own),
        }
    }
    spans
}

impl Span {
    fn of(maps: &Maps, numbers: Range<u32>) -> Self {
        let own = &maps.maps[numbers.start as usize..numbers.end as usize];
        let pixels = own.iter().map(|map| map.size.width * map.size.height);
        let first = own.first().map_or(0, |map| map.first);
        let most = |side: fn(&triptych_spec::ldm::Map) -> u32| own.iter().map(side).max();
        Self {
            pixels: first..first + pixels.sum::<u32>(),
            maps: numbers,
            width: most(|map| map.size.width).unwrap_or(0),
            height: most(|map| map.size.height).unwrap_or(0),
        }
    }

    /// The two halves of two maps or more.
    pub(super) fn halves(&self, maps: &Maps) -> Option<[Self; 2]> {
        let Range { start, end } = self.maps;
        let middle = start.midpoint(end);
        let halves = [start..middle, middle..end];
        (middle > start).then(|| halves.map(|half| Self::of(maps, half)))
    }

    /// Number of pixels.
    pub(super) fn len(&self) -> u32 {
        self.pixels.end - self.pixels.start
    }

    /// What dispatches over the pixels of these maps are told.
    pub(super) fn told(&self, told: Told) -> Told {
        Told {
            first_map: self.maps.start,
            maps: self.count(),
            first_pixel: self.pixels.start,
            pixels: self.len(),
            items: self.len(),
            ..told
        }
    }

    /// The dispatch that draws small triangles, and those that draw large ones, each into some rows
    /// of all maps.
    pub(super) fn drawn(&self, told: Told) -> (Told, impl Iterator<Item = Told>) {
        let all = Told {
            rows: self.height,
            ..self.told(told)
        };
        let rows = (DRAWN / self.width.max(1)).max(1);
        let firsts = (0..self.height).step_by(rows as usize);
        let parts = firsts.map(move |first_row| Told {
            first_row,
            rows,
            ..all
        });
        (all, parts)
    }

    /// Number of maps.
    pub(super) fn count(&self) -> u32 {
        self.maps.end - self.maps.start
    }
}
