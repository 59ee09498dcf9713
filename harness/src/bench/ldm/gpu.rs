//! An adapter is timed, on lists that were judged.

use triptych_gpu::kernel::Kernels;
use triptych_gpu::ldm::{ChainSpan, Question, Span, Timed, TimedChains};
use triptych_spec::ldm::{Maps, Open};

use super::super::counts::Work;
use super::super::legs::Station;
use super::super::{Ceilings, Spread};
use super::case::Case;
use super::judge::{Made, check_chains, check_sums, opened, words};
use super::rounds::{Frame, Rounds, part, rounds, spread};
use super::{Asked, Layout, Row};

/// What was measured of a setting.
pub(super) struct Measured {
    /// Lists as runs, and as the paper has them if they were made.
    pub(super) rows: Vec<Row>,
    /// What it looks like, as PNG.
    pub(super) picture: Option<Vec<u8>>,
    /// Why a row that was asked for is missing.
    pub(super) missing: Option<String>,
}

/// Measures maps on one adapter: lists as runs, and as the paper has them if they were made.
///
/// # Errors
/// What the device refuses; what is not the spec's, in words.
pub(super) fn measure(
    (station, ceilings): (&Station<'_>, Option<&Ceilings>),
    case: &Case<'_>,
    (maps, directions): (&Maps, u32),
    (made, with_picture): (&Made, bool),
    runs: u32,
) -> Result<Measured, String> {
    let kernels = Kernels::trusted(made.native, |sources| sources);
    let gpu = &station.adapter.gpu;
    let of = (maps, &case.setup.blockers);
    let asking = (&case.receivers[..], Question::Occlusion(case.setup.falloff));
    let timed = Timed::new(gpu, &kernels, of, &made.layers, asking).map_err(words)?;
    let chains = match &made.turns {
        Some(Ok(turns)) => {
            let chains = TimedChains::new(gpu, &kernels, of, &made.layers, *turns);
            Some(chains.map_err(words)?)
        }
        _ => None,
    };
    let mut frames = vec![Frame::from(&timed)];
    frames.extend(chains.as_ref().map(Frame::from));
    let times = rounds(station, &frames, runs).map_err(words)?;
    if timed.layers().map_err(words)? != made.layers {
        return Err("lists unlike those of the checked run".to_owned());
    }
    let opened = opened(&timed)?;
    check_sums(case, (maps, &made.layers), &opened)?;
    let of = Of {
        station,
        ceilings,
        case,
        maps,
        made,
    };
    let mut row = of.runs(directions, &times[0], timed.bytes, &opened);
    let looked = with_picture.then(|| case.look(directions, &opened));
    let looked = looked.transpose()?;
    if let (Some(asked), Some(looked)) = (&mut row.asked, &looked) {
        asked.flip = Some(looked.flip);
    }
    let mut rows = vec![row];
    if let Some(chains) = &chains {
        check_chains(maps, &made.layers, chains.chains().map_err(words)?)?;
        rows.push(of.chains(&rows[0], &times[1], chains.bytes));
    }
    Ok(Measured {
        rows,
        picture: looked.map(|looked| looked.png),
        missing: made.without_chains(),
    })
}

/// What a row is made of.
struct Of<'m> {
    station: &'m Station<'m>,
    ceilings: Option<&'m Ceilings>,
    case: &'m Case<'m>,
    maps: &'m Maps,
    made: &'m Made,
}

impl Of<'_> {
    /// The row of lists as runs, and of what they were asked.
    fn runs(&self, directions: u32, times: &Rounds, bytes: u64, opened: &[Open]) -> Row {
        let (case, maps) = (self.case, self.maps);
        let (pixels, keys) = (u64::from(maps.pixels), self.made.layers.keys.len() as u64);
        let build = part(times, &Span::ALL[..4]);
        let off = case.off(directions, opened);
        let asked = Asked {
            frame: part(times, &Span::ALL),
            of_bound: self.of_bound(of_asking(case, maps, keys), part(times, &[Span::Ask])),
            same: off.same,
            random: off.random,
            noise: off.noise,
            flip: None,
        };
        Row {
            scene: case.name.clone(),
            leg: leg(self.station, self.made),
            clock: self.station.clock_name(),
            layout: Layout::Runs,
            directions,
            resolution: case.setup.resolution,
            triangles: case.setup.blockers.triangles.len() as u64,
            receivers: case.receivers.len() as u64,
            pixels,
            keys,
            build,
            parts: Span::ALL.map(|s| (name(s), part(times, &[s]))).into(),
            memory: [4 * (pixels + keys), bytes],
            of_bound: self.of_bound(of_build(case, maps, keys), build),
            asked: Some(asked),
        }
    }

    /// The row of the same lists as chains.
    fn chains(&self, runs: &Row, times: &Rounds, bytes: u64) -> Row {
        let build = spread(times, |spans| spans.iter().sum());
        let span = |s: ChainSpan| (name_of(s), spread(times, |spans| spans[s as usize]));
        Row {
            layout: Layout::Chains,
            build,
            parts: ChainSpan::ALL.map(span).into(),
            memory: [4 * runs.pixels + 8 * runs.keys, bytes],
            of_bound: self.of_bound(of_chains(self.case, self.maps, runs.keys), build),
            asked: None,
            ..runs.clone()
        }
    }

    /// The least time for something over what it took.
    fn of_bound(&self, work: Work, time: Spread) -> Option<f64> {
        let least = self.ceilings.map(|ceilings| ceilings.bound(work).1);
        least.map(|least| 1000.0 * least / time.median)
    }
}

/// A leg's name in tables.
pub(super) fn leg(station: &Station<'_>, made: &Made) -> String {
    let native = if made.native { ", native" } else { "" };
    format!("gpu@{}{native}", station.adapter.gpu.name)
}

/// A part's name in tables.
fn name_of(span: ChainSpan) -> &'static str {
    match span {
        ChainSpan::Link => "link",
        ChainSpan::Sort => "sort",
    }
}

/// A part's name in tables.
fn name(span: Span) -> &'static str {
    match span {
        Span::Count => "count",
        Span::Scan => "scan",
        Span::Fill => "fill",
        Span::Sort => "sort",
        Span::Ask => "ask",
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

/// What the paper's lists must move: corners are read once; heads are set, exchanged, and read and
/// written by the sort; entries of two words are written once, and by the sort read and linked
/// anew, once at least. Each takes an atomic for its address and one for its head.
fn of_chains(case: &Case<'_>, maps: &Maps, keys: u64) -> Work {
    let corners = 48 * case.setup.blockers.triangles.len() as u64;
    Work {
        bytes: corners + 4 * 3 * u64::from(maps.pixels) + 4 * 5 * keys,
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
