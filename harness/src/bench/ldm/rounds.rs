//! Frames that are timed in turn.

use triptych_gpu::error::GpuError;
use triptych_gpu::ldm::{ChainSpan, Span, Timed, TimedChains};
use triptych_gpu::timer::Timer;

use super::super::legs::Station;
use super::super::warm::wake;
use super::super::{Spread, WARM_UP};

/// Something that is timed in spans.
pub(super) struct Frame<'f> {
    spans: usize,
    time: Box<Time<'f>>,
}

/// Runs a frame once: the seconds of its spans.
type Time<'f> = dyn Fn(&Timer) -> Result<Vec<f64>, GpuError> + 'f;

impl<'f> From<&'f Timed<'_>> for Frame<'f> {
    fn from(timed: &'f Timed<'_>) -> Self {
        Self {
            spans: Span::ALL.len(),
            time: Box::new(|timer| timed.time(timer)),
        }
    }
}

impl<'f> From<&'f TimedChains<'_>> for Frame<'f> {
    fn from(timed: &'f TimedChains<'_>) -> Self {
        Self {
            spans: ChainSpan::ALL.len(),
            time: Box::new(|timer| timed.time(timer)),
        }
    }
}

/// Milliseconds of the spans of a frame, in each round.
pub(super) type Rounds = Vec<Vec<f64>>;

/// Frames in turn, in rounds, of which every other one runs backwards: what each took.
pub(super) fn rounds(
    station: &Station<'_>,
    frames: &[Frame<'_>],
    runs: u32,
) -> Result<Vec<Rounds>, GpuError> {
    let gpu = &station.adapter.gpu;
    let timer = |frame: &Frame<'_>| {
        let spans = u32::try_from(frame.spans).expect("few");
        Timer::new(gpu, &station.clock, spans)
    };
    let timers: Vec<Timer> = frames.iter().map(timer).collect::<Result<_, _>>()?;
    let mut all = vec![Rounds::new(); frames.len()];
    for round in 0..WARM_UP + runs {
        let mut order: Vec<usize> = (0..frames.len()).collect();
        if !round.is_multiple_of(2) {
            order.reverse();
        }
        for at in order {
            let (time, timer) = (&frames[at].time, &timers[at]);
            if gpu.info.device_type != wgpu::DeviceType::Cpu {
                wake(|| time(timer).map(drop))?;
            }
            let seconds = time(timer)?;
            if round >= WARM_UP {
                all[at].push(seconds.iter().map(|s| 1000.0 * s).collect());
            }
        }
    }
    Ok(all)
}

/// Something of each round.
pub(super) fn spread(rounds: &Rounds, of: impl Fn(&[f64]) -> f64) -> Spread {
    Spread::of(rounds.iter().map(|spans| of(spans)))
}

/// Some spans of a frame together.
pub(super) fn part(rounds: &Rounds, spans: &[Span]) -> Spread {
    spread(rounds, |all| spans.iter().map(|s| all[*s as usize]).sum())
}
