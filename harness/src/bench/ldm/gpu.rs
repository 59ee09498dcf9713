//! An adapter: checked once, then timed.

use triptych_gpu::error::GpuError;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::ldm::{Span, Stages, Timed};
use triptych_gpu::timer::Timer;
use triptych_spec::bound::{Bounded, Real};
use triptych_spec::ldm::{Layers, Maps, Open, layers, neighbours, occlusion};

use super::super::counts::Work;
use super::super::legs::Station;
use super::super::warm::wake;
use super::super::{Ceilings, Spread, WARM_UP};
use super::Row;
use super::case::Case;

/// Pairs of a triangle and a map that the spec draws to compare lists, about.
const DRAWN: usize = 1 << 22;

/// Receivers at which sums are compared, at most.
const SUMMED: usize = 64;

/// Measures maps on one adapter.
///
/// # Errors
/// What the device refuses; what is not the spec's, in words.
pub(super) fn measure(
    (station, ceilings): (&Station<'_>, Option<&Ceilings>),
    case: &Case<'_>,
    maps: &Maps,
    directions: u32,
    runs: u32,
) -> Result<Row, String> {
    let words = |e: GpuError| e.to_string();
    let gpu = &station.adapter.gpu;
    let native = gpu.has_int64();
    let checked = station.adapter.native.as_ref().filter(|_| native);
    let checked = checked.unwrap_or(&station.adapter.kernels);
    let blockers = &case.setup.blockers;
    let mut stages = Stages::new(gpu, checked, maps, blockers, u64::MAX).map_err(words)?;
    let made = stages.layers().map_err(words)?;
    drop(stages);
    check_lists(case, maps, &made)?;
    let kernels = Kernels::trusted(native, |sources| sources);
    let asking = (&case.receivers[..], case.setup.falloff);
    let timed = Timed::new(gpu, &kernels, (maps, blockers), &made, asking).map_err(words)?;
    let (frames, parts) = rounds(station, &timed, runs).map_err(words)?;
    if timed.layers().map_err(words)? != made {
        return Err("lists unlike those of the checked run".to_owned());
    }
    let opened = timed.opened().map_err(words)?;
    let opened: Vec<Open> = opened
        .iter()
        .map(|open| Open {
            whole: open.whole,
            part: Bounded::exact(f64::from(open.part)),
        })
        .collect();
    check_sums(case, (maps, &made), &opened)?;
    let off = case.off(directions, &opened);
    let (pixels, keys) = (u64::from(maps.pixels), made.keys.len() as u64);
    let bounds = ceilings.map(|ceilings| {
        let build: f64 = parts[..4].iter().map(|part| part.median).sum();
        let of = |work, milliseconds: f64| 1000.0 * ceilings.bound(work).1 / milliseconds;
        [
            of(of_build(case, maps, keys), build),
            of(of_asking(case, maps, keys), parts[4].median),
        ]
    });
    Ok(Row {
        scene: case.name.clone(),
        leg: format!("gpu@{}{}", gpu.name, if native { ", native" } else { "" }),
        clock: station.clock_name(),
        directions,
        resolution: case.setup.resolution,
        triangles: blockers.triangles.len() as u64,
        receivers: case.receivers.len() as u64,
        pixels,
        keys,
        frame: frames,
        parts: Span::ALL.map(name).into_iter().zip(parts).collect(),
        memory: [4 * (pixels + keys), timed.bytes],
        of_bound: bounds,
        same: off.same,
        random: off.random,
        noise: off.noise,
    })
}

/// Milliseconds of a frame and of its parts.
fn rounds(
    station: &Station<'_>,
    timed: &Timed<'_>,
    runs: u32,
) -> Result<(Spread, [Spread; 5]), GpuError> {
    let gpu = &station.adapter.gpu;
    let timer = Timer::new(gpu, &station.clock, 5)?;
    let mut parts = [const { Vec::new() }; 5];
    let mut frames = Vec::new();
    for round in 0..WARM_UP + runs {
        if gpu.info.device_type != wgpu::DeviceType::Cpu {
            wake(|| timed.time(&timer).map(drop))?;
        }
        let seconds = timed.time(&timer)?;
        if round >= WARM_UP {
            frames.push(1000.0 * seconds.iter().sum::<f64>());
            for (part, seconds) in parts.iter_mut().zip(seconds) {
                part.push(1000.0 * seconds);
            }
        }
    }
    Ok((Spread::of(frames), parts.map(Spread::of)))
}

/// A part's name in tables.
fn name(span: Span) -> &'static str {
    match span {
        Span::Count => "count",
        Span::Scan => "scan",
        Span::Fill => "fill",
        Span::Sort => "sort",
        Span::Occlusion => "ask",
    }
}

/// What a build must move: corners are read twice; offsets are cleared, summed up and replaced,
/// and read by the sort; keys are written once, and read and written by the sort. Each key takes an
/// atomic to be counted and one to be placed.
fn of_build(case: &Case<'_>, maps: &Maps, keys: u64) -> Work {
    let corners = 2 * 48 * case.setup.blockers.triangles.len() as u64;
    Work {
        bytes: corners + 4 * 5 * u64::from(maps.pixels) + 4 * 3 * keys,
        atomics: 2 * keys,
    }
}

/// What asking must move: lists and receivers are read once, sums written once.
fn of_asking(case: &Case<'_>, maps: &Maps, keys: u64) -> Work {
    Work {
        bytes: 4 * (u64::from(maps.pixels) + keys) + 40 * case.receivers.len() as u64,
        atomics: 0,
    }
}

/// Refuses lists that are not the spec's, in some of the maps, evenly chosen.
fn check_lists(case: &Case<'_>, maps: &Maps, made: &Layers) -> Result<(), String> {
    let blockers = &case.setup.blockers;
    let most = (DRAWN / blockers.triangles.len().max(1)).clamp(1, maps.maps.len());
    for number in (0..maps.maps.len()).step_by(maps.maps.len().div_ceil(most)) {
        let map = &maps.maps[number];
        let pixels = map.size.width * map.size.height;
        let mut alone = Maps {
            maps: vec![map.clone()],
            pixels,
            ..maps.clone()
        };
        alone.maps[0].first = 0;
        let must = layers(&alone, blockers).map_err(|e| e.to_string())?;
        for pixel in 0..pixels {
            if made.list(map.first + pixel) != must.list(pixel) {
                return Err(format!("unlike the spec: pixel {pixel} of map {number}"));
            }
        }
    }
    Ok(())
}

/// Refuses sums that are not what the spec makes of the lists, at some receivers, evenly chosen.
fn check_sums(
    case: &Case<'_>,
    (maps, made): (&Maps, &Layers),
    opened: &[Open],
) -> Result<(), String> {
    let stride = case.sample.len().div_ceil(SUMMED);
    for at in case.sample.iter().step_by(stride) {
        let receiver = &case.receivers[*at];
        let hits = maps
            .maps
            .iter()
            .map(|map| (map, neighbours(maps, map, made, receiver)));
        let must = occlusion(hits, receiver.normal, case.setup.falloff);
        let is = &opened[*at];
        if must.whole != is.whole || !must.part.admits(is.part.value) {
            return Err(format!(
                "unlike the spec: {is:?} over receiver {at}, must be {must:?}"
            ));
        }
    }
    Ok(())
}
