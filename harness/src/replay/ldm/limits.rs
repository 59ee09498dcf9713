//! What all maps of a scene together may take, counted before any is drawn.

use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{Map, Maps};
use triptych_spec::raster::count;

use super::setup::Turn;
use crate::compare::ldm::drawn;
use crate::dispatch::share;
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
    let each = turns
        .iter()
        .flat_map(|turn| turn.maps.maps.iter().map(move |map| (&turn.maps, map)));
    let each: Vec<(&Maps, &Map)> = each.collect();
    let meter = Meter::new(MAP_ROWS_MAX);
    let within = |(maps, map): (&Maps, &Map)| meter.takes(rows(maps, map, blockers));
    if !share::all(each.len(), 1, |at| within(each[at])) {
        return Err(too_many());
    }
    let meter = Meter::new(MAP_KEYS_MAX);
    let keys = |(maps, map): (&Maps, &Map)| count(&drawn(maps, map, blockers));
    match share::all(each.len(), 1, |at| meter.takes(keys(each[at]))) {
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
