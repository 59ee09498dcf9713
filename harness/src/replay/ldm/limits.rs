//! What all maps of a scene together may take, counted before any is drawn.

use rayon::prelude::*;
use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{Map, Maps};
use triptych_spec::raster::count;

use super::setup::Turn;
use crate::compare::ldm::drawn;
use crate::replay::work::Meter;
use crate::scene::Mistake;

/// Most pixels of all maps of all rotations, 4 bytes each on every leg.
pub const MAP_PIXELS_MAX: u64 = 1 << 27;

/// Most keys in them, 4 bytes each; while a map is drawn, its own take 8 more.
pub const MAP_KEYS_MAX: u64 = 1 << 27;

/// Most rows of pixels that the boxes of all triangles in all maps meet, and one more for each
/// triangle and map: what a rasteriser looks at, whether or not anything is covered. At 10 to 30 ns
/// a row, up to two minutes on one core.
pub const MAP_ROWS_MAX: u64 = 1 << 32;

/// Refuses maps that would take too much room or time.
pub(super) fn check(blockers: &Blockers, turns: &[Turn]) -> Result<(), Mistake> {
    let pixels: u64 = turns.iter().map(|t| u64::from(t.maps.pixels)).sum();
    if pixels > MAP_PIXELS_MAX {
        return Err(Mistake::of(
            "ldm.resolution",
            format!(
                "{pixels} pixels in all maps, and {MAP_PIXELS_MAX} are the limit; use a smaller \
                 resolution or fewer directions"
            ),
        ));
    }
    let of_turn = |turn: &'_ Turn| turn.maps.maps.len() as u64;
    let maps: u64 = turns.iter().map(of_turn).sum();
    let triangles = blockers.triangles.len() as u64;
    let too_many = || {
        let message = format!(
            "{triangles} triangles in {maps} maps meet more than {MAP_ROWS_MAX} rows of pixels, the \
             limit; use fewer directions, a smaller resolution or simpler meshes"
        );
        Mistake::of("ldm.directions", message)
    };
    if triangles.saturating_mul(maps) > MAP_ROWS_MAX {
        return Err(too_many());
    }
    let each = || {
        let of = |turn: &'_ Turn| (0..turn.maps.maps.len()).collect::<Vec<_>>();
        let all = turns.par_iter();
        all.flat_map_iter(move |turn| of(turn).into_iter().map(move |map| (&turn.maps, map)))
    };
    let meter = Meter::new(MAP_ROWS_MAX);
    if !each().all(|(maps, map)| meter.takes(rows(maps, &maps.maps[map], blockers))) {
        return Err(too_many());
    }
    let meter = Meter::new(MAP_KEYS_MAX);
    let keys = |(maps, map): (&Maps, usize)| count(&drawn(maps, &maps.maps[map], blockers));
    match each().all(|map| meter.takes(keys(map))) {
        true => Ok(()),
        false => Err(Mistake::of(
            "ldm.resolution",
            format!(
                "the triangles have more than {MAP_KEYS_MAX} keys in all maps, the limit; use a \
                 smaller resolution or fewer directions"
            ),
        )),
    }
}

/// Rows of pixels that the triangles' boxes meet in a map, and one more for each.
fn rows(maps: &Maps, map: &Map, blockers: &Blockers) -> u64 {
    let rows: Vec<i32> = blockers
        .vertices
        .iter()
        .map(|v| maps.place(map, *v)[1] >> maps.bits)
        .collect();
    let of = |corners: &[u32; 3]| {
        let at = corners.map(|row| rows[row as usize]);
        let (low, high) = (at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]));
        u64::from(high.abs_diff(low)) + 2
    };
    blockers.triangles.iter().map(of).sum()
}
