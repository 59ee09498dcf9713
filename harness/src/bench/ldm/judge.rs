//! An adapter's lists and sums, held against the spec's before anything is believed to be timed.

use triptych_gpu::error::GpuError;
use triptych_gpu::ldm::{self as device, Stages, Timed};
use triptych_spec::bound::{Bounded, Real};
use triptych_spec::ldm::{Layers, Maps, Open, layers, neighbours, occlusion};

use super::super::legs::Station;
use super::case::Case;
use crate::compare::ldm as judge;
use crate::replay::ldm::chains as as_spec;

/// Pairs of a triangle and a map that the spec draws to compare lists, about.
const DRAWN: usize = 1 << 22;

/// Receivers at which sums are compared, at most.
const SUMMED: usize = 64;

/// A scene's lists as a checked run made them.
pub(super) struct Made {
    pub(super) layers: Layers,
    /// Dispatches that the paper's lists took to be put in order, if they were asked for.
    pub(super) turns: Option<Result<u32, String>>,
    pub(super) native: bool,
}

impl Made {
    /// Why the paper's lists are not measured, though they were asked for.
    pub(super) fn without_chains(&self) -> Option<String> {
        let why = self.turns.as_ref()?.as_ref().err()?;
        Some(format!("chains: {why}"))
    }
}

/// Lists by an adapter's checked kernels, some of them held against the spec's; with `chains` also
/// the paper's, all of which must be the same.
///
/// # Errors
/// What the device refuses; what is not the spec's, in words.
pub(super) fn made(
    station: &Station<'_>,
    case: &Case<'_>,
    maps: &Maps,
    chains: bool,
) -> Result<Made, String> {
    let gpu = &station.adapter.gpu;
    let native = gpu.has_int64();
    let checked = station.adapter.native.as_ref().filter(|_| native);
    let checked = checked.unwrap_or(&station.adapter.kernels);
    let stages = Stages::new(gpu, checked, maps, &case.setup.blockers, u64::MAX);
    let mut stages = stages.map_err(words)?;
    let layers = stages.layers().map_err(words)?;
    check_lists(case, maps, &layers)?;
    Ok(Made {
        turns: chains.then(|| chained(&mut stages, maps, &layers)),
        layers,
        native,
    })
}

/// The paper's lists by checked kernels: the dispatches that put them in order.
fn chained(stages: &mut Stages<'_>, maps: &Maps, layers: &Layers) -> Result<u32, String> {
    let capacity = u32::try_from(layers.keys.len()).map_err(|_| "2^32 keys or more".to_owned())?;
    let sound = |own: &device::Chains, room| judge::may_follow(&as_spec(own.clone(), room));
    let seen = stages.chain(capacity, sound).map_err(words)?;
    check_chains(maps, layers, seen)?;
    Ok(stages.turns)
}

/// What a run found open.
pub(super) fn opened(timed: &Timed<'_>) -> Result<Vec<Open>, String> {
    let open = |open: &device::Open| Open {
        whole: open.whole,
        part: Bounded::exact(f64::from(open.part)),
    };
    let opened = timed.opened().map_err(words)?;
    Ok(opened.iter().map(open).collect())
}

pub(super) fn words(error: GpuError) -> String {
    error.to_string()
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

/// Refuses the paper's lists unless they hold what runs hold, in the same order.
pub(super) fn check_chains(maps: &Maps, must: &Layers, seen: device::Chains) -> Result<(), String> {
    let capacity = u32::try_from(must.keys.len()).unwrap_or(u32::MAX);
    let judgement = judge::chains(maps, must, &as_spec(seen, capacity));
    match judgement.described.first() {
        Some(words) => Err(words.clone()),
        None if judgement.differ() > 0 => Err("unlike the runs".to_owned()),
        None => Ok(()),
    }
}

/// Refuses sums that are not what the spec makes of the lists, at some receivers, evenly chosen.
pub(super) fn check_sums(
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
