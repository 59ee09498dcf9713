//! What each adapter, and one core, can do at most.

use std::hint::black_box;

use serde::{Deserialize, Serialize};
use triptych_gpu::ceiling::Ceiling;
use triptych_gpu::context::Gpu;
use triptych_gpu::error::GpuError;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::timer::Clock;

use super::counts::Work;
use super::{Spread, WARM_UP};
use crate::replay::spec::timed;

/// Bytes that one core copies, more than caches hold.
const COPIED: usize = 128 << 20;

/// Rates, measured in the run whose rows are held to them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ceilings {
    /// The adapter's name, or `spec`.
    pub name: String,
    /// Bytes read and written per second by a copy.
    pub bytes: Spread,
    /// Atomics per second where lists are built; one core needs none.
    pub atomics: Option<Spread>,
    /// Who says how long something takes: `device` by its timestamps, or `host`.
    pub clock: String,
}

impl Ceilings {
    /// Of an adapter, and the clock that they were measured by.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn of(gpu: &Gpu, kernels: &Kernels, runs: u32) -> Result<(Self, Clock), GpuError> {
        let ceiling = Ceiling::new(gpu, kernels)?;
        let mut rates = Vec::new();
        for round in 0..WARM_UP + runs {
            let rate = ceiling.measure()?;
            if round >= WARM_UP {
                rates.push(rate);
            }
        }
        let clock = ceiling.clock().clone();
        let ceilings = Self {
            name: gpu.name.clone(),
            bytes: Spread::of(rates.iter().map(|r| r.bytes)),
            atomics: Some(Spread::of(rates.iter().map(|r| r.atomics))),
            clock: match clock {
                Clock::Device => "device",
                Clock::Host(_) => "host",
            }
            .to_owned(),
        };
        Ok((ceilings, clock))
    }

    /// Of one core of the CPU.
    pub fn of_core(runs: u32) -> Self {
        let source = vec![1_u8; COPIED];
        let mut copied = vec![0_u8; COPIED];
        let mut copy = || {
            let ((), time) = timed(|| black_box(&mut copied).copy_from_slice(black_box(&source)));
            2.0 * COPIED as f64 / time.as_secs_f64()
        };
        for _ in 0..WARM_UP {
            copy();
        }
        Self {
            name: "spec".to_owned(),
            bytes: Spread::of((0..runs).map(|_| copy())),
            atomics: None,
            clock: "host".to_owned(),
        }
    }

    /// What bounds such work, and the seconds that it allows at least: the larger of bytes
    /// over the rate of copies and atomics over theirs.
    pub fn bound(&self, work: Work) -> (&'static str, f64) {
        let bytes = work.bytes as f64 / self.bytes.median;
        let atomics = self.atomics.map_or(0.0, |a| work.atomics as f64 / a.median);
        match atomics > bytes {
            true => ("atomics", atomics),
            false => ("bytes", bytes),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slower_of_both_bounds() {
        let rate = |rate| Spread::of([rate]);
        let mut ceilings = Ceilings {
            name: "x".into(),
            bytes: rate(100.0),
            atomics: Some(rate(10.0)),
            clock: "host".into(),
        };
        let work = Work {
            bytes: 50,
            atomics: 20,
        };
        assert_eq!(ceilings.bound(work), ("atomics", 2.0));
        ceilings.atomics = None;
        assert_eq!(ceilings.bound(work), ("bytes", 0.5));
    }
}
