//! The stages that take longest, pixels by themselves: over the cores, and in order.

use triptych_spec::grid::{Blockers, Grid};
use triptych_spec::rsm::{
    Blocked, Colour, Gbuffer, Light, Model, Parameters, Place, block, gather,
};
use triptych_spec::scene::Size;

use crate::dispatch::share;

/// Pixels of buffer A that are worked out by themselves.
const PIXELS: usize = 256;

/// Stage gather.
pub(super) fn gathered(
    model: &Model,
    seen: &Gbuffer,
    places: &[Option<Place>],
    lights: &[Option<Light>],
    size: Size,
    parameters: &Parameters,
) -> Vec<Colour> {
    share::runs(seen.surfaces.len(), PIXELS, |run| {
        let row = Size {
            width: u32::try_from(run.len()).expect("few"),
            height: 1,
        };
        let part = part(seen, run.clone(), row);
        gather(model, &part, &places[run], lights, size, parameters)
    })
}

/// Stage block, a row of buffer B at a time.
pub(super) fn blocked(
    model: &Model,
    seen: &Gbuffer,
    places: &[Option<Place>],
    lights: &[Option<Light>],
    size: Size,
    cells: (&Grid, &Blockers),
    parameters: &Parameters,
) -> Blocked {
    let Size { width, height } = seen.size;
    let coarse = parameters.coarse(seen.size);
    let rows = share::each(coarse.height as usize, |row| {
        let first = u32::try_from(row).expect("a row") * parameters.divisor;
        let rows = parameters.divisor.min(height - first);
        let run = (first * width) as usize..((first + rows) * width) as usize;
        let part = part(
            seen,
            run.clone(),
            Size {
                width,
                height: rows,
            },
        );
        block(model, &part, &places[run], lights, size, cells, parameters)
    });
    let mut all = Blocked {
        size: coarse,
        bits: Vec::new(),
        rays: 0,
        light: Vec::new(),
    };
    for row in rows {
        all.bits.extend(row.bits);
        all.rays += row.rays;
        all.light.extend(row.light);
    }
    all
}

/// Some of what pixels see, as a picture of this size.
fn part(seen: &Gbuffer, run: std::ops::Range<usize>, size: Size) -> Gbuffer {
    Gbuffer {
        size,
        keys: seen.keys[run.clone()].to_vec(),
        surfaces: seen.surfaces[run.clone()].to_vec(),
        stray: seen.stray[run].to_vec(),
    }
}
