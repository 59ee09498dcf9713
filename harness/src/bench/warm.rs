//! The rounds before the first that counts.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use super::gpu::{Leg, Refusal};
use super::{AWAKE, WARM_UP, WARM_UP_WORK};

/// How far the adapters are.
#[derive(Default)]
struct WarmUp<'a> {
    /// Rounds that are done.
    rounds: u32,
    /// How long each adapter was at work, by its name and its own clock.
    work: BTreeMap<&'a str, Duration>,
}

impl<'a> WarmUp<'a> {
    /// Whether an adapter takes part in the next round.
    fn is_due(&self, adapter: &str) -> bool {
        let work = self.work.get(adapter).copied().unwrap_or_default();
        self.rounds < WARM_UP || work < WARM_UP_WORK
    }

    fn worked(&mut self, adapter: &'a str, time: Duration) {
        *self.work.entry(adapter).or_default() += time;
    }
}

/// Runs rounds that do not count: [`WARM_UP`] of everything, and more on each adapter
/// until it was at work for [`WARM_UP_WORK`], as clocks rise by time and not by rounds: a board
/// runs at a third of its clock in the first second. What does not count is the time in which
/// the host prepares. The legs that `keep` refuses are left out from there on.
pub(super) fn warm_up(legs: &mut Vec<Leg<'_>>, mut keep: impl FnMut(Result<(), Refusal>) -> bool) {
    let mut warm = WarmUp::default();
    while warm.rounds < WARM_UP || legs.iter().any(|leg| warm.is_due(leg.adapter)) {
        legs.retain(|leg| {
            if !warm.is_due(leg.adapter) {
                return true;
            }
            let result = leg.warm_up(warm.rounds);
            if let Ok(seconds) = result {
                // A clock that stands still would never end it.
                let least = Duration::from_millis(1);
                warm.worked(leg.adapter, Duration::from_secs_f64(seconds).max(least));
            }
            keep(result.map(drop))
        });
        warm.rounds += 1;
    }
}

/// A board's clocks fall in pauses, and while set-up went on: it is at work for [`AWAKE`]
/// before each round.
pub(super) fn wake<E>(mut work: impl FnMut() -> Result<(), E>) -> Result<(), E> {
    let start = Instant::now();
    while start.elapsed() < AWAKE {
        work()?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fast adapter needs many rounds, a slow one both.
    #[test]
    fn an_adapter_is_warm_by_rounds_and_by_time() {
        let mut warm = WarmUp::default();
        let mut rounds = BTreeMap::new();
        while ["fast", "slow"].iter().any(|adapter| warm.is_due(adapter)) {
            for (adapter, share) in [("fast", 100), ("slow", 1)] {
                if warm.is_due(adapter) {
                    warm.worked(adapter, WARM_UP_WORK / share);
                    *rounds.entry(adapter).or_insert(0) += 1;
                }
            }
            warm.rounds += 1;
        }
        assert_eq!(rounds, BTreeMap::from([("fast", 100), ("slow", WARM_UP)]));
    }
}
