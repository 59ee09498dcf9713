//! Layered depth maps: their lists, what points find in them, and what that adds up to.
//!
//! A leg's results are plain numbers, in the spec's order: pixels map by map, and for each
//! receiver, the maps. What differs is named by map and pixel, or by receiver and map.

mod chains;
mod found;
mod lists;

#[cfg(test)]
mod tests;

use std::ops::Range;

use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{Map, Maps};
use triptych_spec::vertex::Primitives;

use super::Judgement;
use crate::cause::Cause;
use crate::row::Class;

pub use chains::{chains, may_follow};
pub use found::{light, mirrored, neighbours, open};
pub use lists::layers;

/// The triangles as the spec draws them into a map.
pub fn drawn(maps: &Maps, map: &Map, blockers: &Blockers) -> Primitives {
    let places = blockers.vertices.iter().map(|v| maps.place(map, *v));
    Primitives {
        samples: triptych_spec::raster::Samples::ONE,
        size: map.size,
        bits: maps.bits,
        snapped: places.collect(),
        prims: blockers.triangles.clone(),
        source: Vec::new(),
    }
}

/// A pixel of all maps', in words.
fn named(maps: &Maps, pixel: usize) -> String {
    let number = maps.maps.partition_point(|map| map.first as usize <= pixel);
    match number.checked_sub(1) {
        Some(number) => {
            let map = &maps.maps[number];
            let at = pixel - map.first as usize;
            let width = map.size.width as usize;
            format!("map {number} pixel ({}, {})", at % width, at / width)
        }
        None => format!("pixel {pixel} of no map"),
    }
}

/// A comparison of two lists of as many items; another number is a difference by itself.
fn listed(class: Class, unit: &'static str, expected: usize, seen: usize) -> Judgement {
    let mut judgement = Judgement {
        compared: expected as u64,
        ..Judgement::new(class, unit)
    };
    if seen != expected {
        judgement.differs(Cause::ReferenceMissing, None, || {
            format!("{seen} {unit}, must be {expected}")
        });
    }
    judgement
}

/// The keys of a pixel, as far as they are there.
fn list(offsets: &[u32], keys: &[u32], pixel: usize) -> Range<usize> {
    let at = |i: usize| offsets.get(pixel + i).map_or(0, |o| *o as usize);
    let start = at(0).min(keys.len());
    start..at(1).clamp(start, keys.len())
}

/// Keys in words.
fn shown(keys: &[u32]) -> String {
    let more = if keys.len() > 8 { ", …" } else { "" };
    let first: Vec<String> = keys.iter().take(8).map(u32::to_string).collect();
    format!("[{}{more}]", first.join(", "))
}
