//! Both ways, in turn.

use triptych_gpu::kernel::Kernels;
use triptych_gpu::ldm::{ChainSpan, Question, Span, Timed, TimedChains};
use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{Layers, Maps};

use super::super::super::legs::Station;
use super::super::case::Case;
use super::super::gpu::leg;
use super::super::judge::{Made, check_chains, check_sums, made, opened, words};
use super::super::rounds::{Frame, Rounds, part, rounds, spread};
use super::built::{Built, skip};
use super::patch::{CHAINS_OF_ONE, RUNS_OF_ONE, patched};
use super::{ALL_KEYS, Skip, Skips, lengths};
use crate::replay::ldm::Turn;

/// Where and of what.
struct Bench<'b> {
    station: &'b Station<'b>,
    case: &'b Case<'b>,
    runs: u32,
}

/// Measures all that is left out of a scene, at its own setting.
///
/// # Errors
/// What the device refuses; what is not the spec's, or not the same both ways, in words.
pub(in crate::bench::ldm) fn measure(
    station: &Station<'_>,
    case: &Case<'_>,
    runs: u32,
) -> Result<Skips, String> {
    let bench = Bench {
        station,
        case,
        runs,
    };
    let [planned, all] = case.turns()?;
    let made = made(station, case, &planned.maps, true)?;
    if let Some(why) = made.without_chains() {
        return Err(why);
    }
    let own = Built {
        maps: &planned.maps,
        made: &made,
    };
    let remade = |of: &Turn, cropped| {
        let directions: Vec<[f64; 3]> = of.maps.maps.iter().map(|map| map.direction).collect();
        case.setup.maps(&directions, cropped)
    };
    let mut rows = vec![
        bench.maps("directions", own, &remade(&all, true)?)?,
        bench.maps("cropping", own, &remade(&planned, false)?)?,
    ];
    if case.has_sky() {
        rows.push(bench.dark(own, &planned)?);
    }
    rows.push(bench.runs_of_one(own)?);
    rows.push(bench.chains_of_one(own)?);
    rows.push(bench.all_keys(own)?);
    Ok(Skips {
        scene: case.name.clone(),
        leg: leg(station, &made),
        clock: station.clock_name(),
        directions: case.setup.directions,
        resolution: case.setup.resolution,
        lengths: lengths(&made.layers),
        rows,
    })
}

impl Bench<'_> {
    /// Frames of the planned maps, and of others that must say the same.
    fn maps(&self, what: &'static str, own: Built<'_>, others: &Maps) -> Result<Skip, String> {
        let made = made(self.station, self.case, others, false)?;
        let other = Built {
            maps: others,
            made: &made,
        };
        let kernels = Kernels::trusted(own.made.native, |sources| sources);
        let question = Question::Occlusion(self.case.setup.falloff);
        let timed = [own, other].map(|of| self.timed(&kernels, of, question));
        let [one, two] = timed;
        let (one, two) = (one?, two?);
        let times = self.rounds([Frame::from(&one), Frame::from(&two)])?;
        let mut answers = Vec::new();
        for (timed, of) in [(&one, own), (&two, other)] {
            let opened = unchanged(timed, of).and_then(|()| opened(timed))?;
            check_sums(self.case, (of.maps, &of.made.layers), &opened)?;
            answers.push(opened);
        }
        if answers[0] != answers[1] {
            return Err(format!("{what}: left out, they change what is open"));
        }
        let sides = [own, other].map(Built::side);
        Ok(skip((what, "frame"), sides, &times, |rounds| {
            part(rounds, &Span::ALL)
        }))
    }

    /// Stage `environment` with maps that are lit, and with all.
    fn dark(&self, own: Built<'_>, turn: &Turn) -> Result<Skip, String> {
        let kernels = Kernels::trusted(own.made.native, |sources| sources);
        let all = vec![true; turn.lit.len()];
        let ask = |lit| self.timed(&kernels, own, Question::Environment(&turn.sky, lit));
        let (one, two) = (ask(&turn.lit)?, ask(&all)?);
        let times = self.rounds([Frame::from(&one), Frame::from(&two)])?;
        unchanged(&one, own)?;
        unchanged(&two, own)?;
        let light = |timed: &Timed<'_>| -> Result<Vec<[u32; 3]>, String> {
            let light = timed.light().map_err(words)?;
            let bits = |[r, g, b, _]: &[f32; 4]| [r, g, b].map(|c| c.to_bits());
            Ok(light.iter().map(bits).collect())
        };
        if light(&one)? != light(&two)? {
            return Err("dark directions: left out, they change the light".to_owned());
        }
        let sides = [own.lit(&turn.lit), own.lit(&all)];
        Ok(skip(("dark directions", "ask"), sides, &times, |rounds| {
            part(rounds, &[Span::Ask])
        }))
    }

    /// Lists as runs, sorted by our kernels and by some that do not leave those of one.
    fn runs_of_one(&self, own: Built<'_>) -> Result<Skip, String> {
        let question = Question::Occlusion(self.case.setup.falloff);
        let kernels = [None, Some(RUNS_OF_ONE)].map(|patch| patched(own.made.native, patch));
        let one = self.timed(&kernels[0], own, question)?;
        let two = self.timed(&kernels[1], own, question)?;
        let times = self.rounds([Frame::from(&one), Frame::from(&two)])?;
        unchanged(&one, own)?;
        unchanged(&two, own)?;
        let sides = [2, 1].map(|least| own.lists(least));
        Ok(skip(
            ("lists of one, runs", "sort"),
            sides,
            &times,
            |rounds| part(rounds, &[Span::Sort]),
        ))
    }

    /// The same of the paper's lists.
    fn chains_of_one(&self, own: Built<'_>) -> Result<Skip, String> {
        let kernels = [None, Some(CHAINS_OF_ONE)].map(|patch| patched(own.made.native, patch));
        let (one, two) = (
            self.chains(&kernels[0], own)?,
            self.chains(&kernels[1], own)?,
        );
        let times = self.rounds([Frame::from(&one), Frame::from(&two)])?;
        for chains in [&one, &two] {
            let seen = chains.chains().map_err(words)?;
            check_chains(own.maps, &own.made.layers, seen)?;
        }
        let sides = [2, 1].map(|least| own.lists(least));
        Ok(skip(
            ("lists of one, chains", "sort"),
            sides,
            &times,
            |rounds| spread(rounds, |spans| spans[ChainSpan::Sort as usize]),
        ))
    }

    /// Lists as runs, sorted, and the same maps with nothing in them: every list is empty.
    fn all_keys(&self, own: Built<'_>) -> Result<Skip, String> {
        let made = Made {
            layers: Layers {
                offsets: vec![0; own.made.layers.offsets.len()],
                keys: Vec::new(),
            },
            turns: None,
            native: own.made.native,
        };
        let nothing = Built { made: &made, ..own };
        let kernels = patched(own.made.native, None);
        let question = Question::Occlusion(self.case.setup.falloff);
        let nobody = Blockers {
            vertices: Vec::new(),
            triangles: Vec::new(),
        };
        let one = self.timed_of(&kernels, (nothing, &nobody), question)?;
        let two = self.timed(&kernels, own, question)?;
        let times = self.rounds([Frame::from(&one), Frame::from(&two)])?;
        unchanged(&one, nothing)?;
        unchanged(&two, own)?;
        let sides = [nothing, own].map(Built::side);
        Ok(skip((ALL_KEYS, "sort"), sides, &times, |rounds| {
            part(rounds, &[Span::Sort])
        }))
    }

    fn timed<'t>(
        &'t self,
        kernels: &'t Kernels,
        of: Built<'t>,
        question: Question<'_>,
    ) -> Result<Timed<'t>, String> {
        self.timed_of(kernels, (of, &self.case.setup.blockers), question)
    }

    fn timed_of<'t>(
        &'t self,
        kernels: &'t Kernels,
        (of, blockers): (Built<'t>, &Blockers),
        question: Question<'_>,
    ) -> Result<Timed<'t>, String> {
        let gpu = &self.station.adapter.gpu;
        let maps = (of.maps, blockers);
        let asking = (&self.case.receivers[..], question);
        Timed::new(gpu, kernels, maps, &of.made.layers, asking).map_err(words)
    }

    fn chains<'t>(
        &'t self,
        kernels: &'t Kernels,
        of: Built<'t>,
    ) -> Result<TimedChains<'t>, String> {
        let gpu = &self.station.adapter.gpu;
        let maps = (of.maps, &self.case.setup.blockers);
        let turns = of.made.turns.clone().unwrap_or(Ok(0))?;
        TimedChains::new(gpu, kernels, maps, &of.made.layers, turns).map_err(words)
    }

    fn rounds(&self, frames: [Frame<'_>; 2]) -> Result<Vec<Rounds>, String> {
        rounds(self.station, &frames, self.runs).map_err(words)
    }
}

/// Refuses lists that are not those of the checked run.
fn unchanged(timed: &Timed<'_>, of: Built<'_>) -> Result<(), String> {
    match timed.layers().map_err(words)? == of.made.layers {
        true => Ok(()),
        false => Err("lists unlike those of the checked run".to_owned()),
    }
}
