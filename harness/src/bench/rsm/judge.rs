//! Whether what a device made is what the spec makes of the same inputs.
//!
//! Surfaces, lights and places are held against the spec's, each pixel; what follows from the
//! device's own of these for a sample of pixels, since the spec has one core. Blur and
//! composition follow from the device's own buffers, each pixel again.

use triptych_gpu::rsm::Made;
use triptych_spec::bound::Bounded;
use triptych_spec::rsm::{
    Coarse, Colour, Frame, Gbuffer, Light, Setting, Surface, block, blur, compose, direct, fine,
    gather, place, rsm,
};

use crate::compare::Judgement;
use crate::compare::rsm as judge;

/// Pixels of a sample, at most.
pub(super) const SAMPLE: usize = 1 << 12;

/// Refuses what is not the spec's, in words. `base` is what the spec sees.
pub(super) fn check(setting: &Setting<'_>, base: &Frame, made: &Made) -> Result<(), String> {
    let Setting {
        model,
        lamp,
        parameters,
        ..
    } = setting;
    agree(judge::surfaces(&base.seen, &made.seen))?;
    let map = rsm(model, lamp, parameters);
    agree(judge::surfaces(&map.seen, &made.lights))?;
    agree(judge::colours(
        "intensities",
        &map.intensity,
        &made.intensities,
        |_| None,
    ))?;
    if made.keys != map.seen.keys {
        return Err("keys of the map unlike the spec's".to_owned());
    }
    let own = Gbuffer {
        surfaces: made.seen.clone(),
        ..base.seen.clone()
    };
    let expected = place(&lamp.view, &own);
    agree(judge::places(
        &lamp.view,
        &made.seen,
        &expected,
        &made.places,
    ))?;
    let expected = direct(model, &own, &made.places, lamp, &made.keys, parameters);
    agree(judge::lit(&expected.lit, &made.lit))?;
    agree(judge::colours(
        "direct light",
        &expected.light,
        &made.direct,
        |_| None,
    ))?;
    sampled(setting, &own, made)?;

    let coarse = Coarse::new(&own, parameters);
    let expected = blur(model, &coarse, &exact(&made.blocked), parameters);
    if !setting.blockers.triangles.is_empty() {
        agree(judge::colours(
            "buffer B, averaged",
            &expected,
            &made.blurred,
            |_| None,
        ))?;
    }
    let [direct, all] = [&made.direct, &made.all].map(|c| exact(c));
    let blurred = exact(&made.blurred);
    let light = [&direct[..], &all[..]];
    let expected = compose(
        model,
        &own,
        light,
        (&coarse, &blurred),
        parameters,
        setting.background,
    );
    agree(judge::colours("picture", &expected, &made.picture, |_| {
        None
    }))
}

/// Stages gather and block for some pixels that buffer B has.
fn sampled(setting: &Setting<'_>, own: &Gbuffer, made: &Made) -> Result<(), String> {
    let Setting {
        model,
        lamp,
        parameters,
        ..
    } = setting;
    let coarse = parameters.coarse(own.size);
    let every = coarse.pixels().div_ceil(SAMPLE);
    let cells: Vec<usize> = (0..coarse.pixels()).step_by(every).collect();
    let pixel = |cell: usize| fine(cell, coarse, own.size, parameters.divisor);
    let mut some = Gbuffer {
        surfaces: vec![None; own.surfaces.len()],
        ..own.clone()
    };
    for at in cells.iter().map(|cell| pixel(*cell)) {
        some.surfaces[at] = own.surfaces[at];
    }
    let light = |(surface, intensity): (&Option<Surface>, &[f32; 3])| {
        let (surface, intensity) = ((*surface)?, *intensity);
        Some(Light { surface, intensity })
    };
    let lights: Vec<_> = made
        .lights
        .iter()
        .zip(&made.intensities)
        .map(light)
        .collect();
    let size = lamp.view.size;
    let all = gather(model, &some, &made.places, &lights, size, parameters);
    let of =
        |colours: &[Colour]| -> Vec<Colour> { cells.iter().map(|c| colours[pixel(*c)]).collect() };
    let seen: Vec<[f32; 3]> = cells.iter().map(|c| made.all[pixel(*c)]).collect();
    agree(judge::colours("buffer A", &of(&all), &seen, |_| None))?;
    if setting.blockers.triangles.is_empty() {
        return Ok(());
    }
    let grid = (setting.grid, setting.blockers);
    let blocked = block(model, &some, &made.places, &lights, size, grid, parameters);
    let words = parameters.words();
    for cell in &cells {
        let bits = *cell * words..(*cell + 1) * words;
        if blocked.bits[bits.clone()] != made.bits[bits] {
            return Err(format!("pixel {cell} of buffer B has other texels blocked"));
        }
    }
    let expected: Vec<Colour> = cells.iter().map(|cell| blocked.light[*cell]).collect();
    let seen: Vec<[f32; 3]> = cells.iter().map(|cell| made.blocked[*cell]).collect();
    agree(judge::colours("buffer B", &expected, &seen, |_| None))
}

fn agree(judgement: Judgement) -> Result<(), String> {
    match (judgement.differ(), judgement.compared) {
        (0, 0) => Err("nothing was compared".to_owned()),
        (0, _) => Ok(()),
        _ => Err(judgement.described.join("; ")),
    }
}

/// Numbers that a device made, as inputs.
fn exact(colours: &[[f32; 3]]) -> Vec<Colour> {
    let one = |c: f32| Bounded {
        value: f64::from(c),
        bound: 0.0,
    };
    colours.iter().map(|colour| colour.map(one)).collect()
}
