//! An adapter: checked once, then timed.

use triptych_gpu::error::GpuError;
use triptych_gpu::grid::Shape;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::Path;
use triptych_gpu::rsm::{Span, Timed, Work};
use triptych_gpu::timer::Timer;
use triptych_spec::rsm::Parameters;
use triptych_spec::vertex::SUBPIXEL_BITS;

use super::super::legs::Station;
use super::super::warm::wake;
use super::super::{Spread, WARM_UP};
use super::case::{Case, error};
use super::judge::check;
use super::{OfAdapter, Row, run::row};
use crate::calibrate::Grid;

/// Measures one setting on one adapter.
///
/// # Errors
/// What the device refuses; what is not the spec's, in words.
pub(super) fn measure(
    station: &Station<'_>,
    case: &Case,
    parameters: Parameters,
    runs: u32,
) -> Result<Row, String> {
    let words = |e: GpuError| e.to_string();
    let gpu = &station.adapter.gpu;
    let setting = case.setting(parameters);
    let work = Work {
        drawn: case.drawn.each_ref(),
        path: path(station),
        cells: Shape::checked(
            gpu,
            &station.adapter.kernels,
            setting.blockers,
            &setting.grid.axes,
        )
        .map_err(words)?,
        setting,
    };
    let native = gpu.has_int64();
    let kernels = Kernels::trusted(native, |sources| sources);
    let timed = Timed::new(gpu, &kernels, &work).map_err(words)?;
    let spans: Vec<Span> = timed.spans().collect();
    let whole = Timer::new(gpu, &station.clock, 1).map_err(words)?;
    let count = u32::try_from(spans.len()).expect("few");
    let each = Timer::new(gpu, &station.clock, count).map_err(words)?;
    timed.time_whole(&whole).map_err(words)?;
    let made = timed.made().map_err(words)?;
    check(&setting, &case.base, &made).map_err(|why| format!("unlike the spec: {why}"))?;

    let mut frames = Vec::new();
    let mut parts = vec![Vec::new(); spans.len()];
    for round in 0..WARM_UP + runs {
        if gpu.info.device_type != wgpu::DeviceType::Cpu {
            wake(|| timed.time_whole(&whole).map(drop)).map_err(words)?;
        }
        let frame = timed.time_whole(&whole).map_err(words)?;
        let seconds = timed.time(&each).map_err(words)?;
        if round >= WARM_UP {
            frames.push(1000.0 * frame);
            for (part, seconds) in parts.iter_mut().zip(seconds) {
                part.push(1000.0 * seconds);
            }
        }
    }
    let picture: Vec<[f64; 3]> = made.picture.iter().map(|c| c.map(f64::from)).collect();
    let named = spans.iter().map(|span| name(*span));
    let parts = parts.into_iter().map(Spread::of);
    Ok(Row {
        leg: format!("gpu@{}{}", gpu.name, if native { ", native" } else { "" }),
        clock: station.clock_name(),
        rays: timed.rays.into(),
        frame: Spread::of(frames),
        parts: named.zip(parts).collect(),
        own: Some(OfAdapter {
            memory: timed.bytes,
            ..apart(case, &made.lit, &picture)
        }),
        ..row(case, parameters, error(&case.reference, &picture))
    })
}

/// How many pixels are lit otherwise than the spec's, and how far the others are from the
/// reference at most.
fn apart(case: &Case, lit: &[bool], picture: &[[f64; 3]]) -> OfAdapter {
    let same: Vec<bool> = case
        .base
        .direct
        .lit
        .iter()
        .zip(lit)
        .map(|(a, b)| a == b)
        .collect();
    let kept = |colours: &[[f64; 3]]| -> Vec<[f64; 3]> {
        let pairs = colours.iter().zip(&same);
        pairs
            .filter(|(_, same)| **same)
            .map(|(colour, _)| *colour)
            .collect()
    };
    let [_, largest_elsewhere] = error(&kept(&case.reference), &kept(picture));
    OfAdapter {
        memory: 0,
        lit_otherwise: same.iter().filter(|same| !**same).count() as u64,
        largest_elsewhere,
    }
}

/// The hardware's rasteriser, if it samples the spec's grid.
fn path(station: &Station<'_>) -> Path {
    let adapter = station.adapter;
    let known = adapter.grid != Grid::Unknown;
    match known && adapter.bits(Path::Fragment) == SUBPIXEL_BITS {
        true => Path::Fragment,
        false => Path::Compute,
    }
}

/// A part's name in tables.
fn name(span: Span) -> &'static str {
    match span {
        Span::Eye => "eye",
        Span::Map => "map",
        Span::Cells => "cells",
        Span::Direct => "direct",
        Span::Gather => "A",
        Span::Block => "B",
        Span::Compose => "compose",
    }
}
