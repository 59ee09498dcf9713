//! The spec's share of a replay, with more and more threads: what spreading it over the cores gains.
//!
//! A scene's share is everything that the spec works out before any other leg is compared with it:
//! no loading, no pictures, no hashes. Each round runs it with every number of threads, every other round
//! backwards; times of a scene are those of one round, and a run's are sums over scenes.

use std::time::Instant;

use super::{Machine, Progress, Spread};
use crate::corpus::Entry;
use crate::dispatch::share::with_threads;
use crate::replay::spec_alone;
use crate::scene::{LoadError, load_entry};

/// What was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Shares {
    /// When, year-month-day.
    pub date: String,
    /// Where.
    pub machine: Machine,
    /// Rounds that count.
    pub runs: u32,
    /// Numbers of threads, one first.
    pub threads: Vec<usize>,
    /// By scene.
    pub rows: Vec<Share>,
    /// What was not measured, and why.
    pub remarks: Vec<String>,
}

/// A scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Share {
    /// `family/case`.
    pub scene: String,
    /// Seconds with each number of threads, round after round.
    pub seconds: Vec<Vec<f64>>,
}

impl Shares {
    /// Seconds of all scenes together with each number of threads, and how many times as fast as with one
    /// that is.
    pub fn total(&self) -> Vec<(Spread, Spread)> {
        let rounds = |at: usize| -> Vec<f64> {
            let round = |round: usize| self.rows.iter().map(|row| row.seconds[at][round]).sum();
            (0..self.runs as usize).map(round).collect()
        };
        let one = rounds(0);
        let of = |at: usize| {
            let own = rounds(at);
            let times = one.iter().zip(&own).map(|(one, own)| one / own);
            (Spread::of(own.iter().copied()), Spread::of(times))
        };
        (0..self.threads.len()).map(of).collect()
    }
}

/// Measures scenes with these numbers of threads.
///
/// # Errors
/// One line for a scene that cannot be read; a mesh that is missing skips its scene.
pub fn run(
    scenes: &[Entry],
    (threads, runs): (&[usize], u32),
    date: String,
    progress: &Progress,
) -> Result<Shares, String> {
    let mut shares = Shares {
        date,
        machine: Machine::here(&[]),
        runs,
        threads: threads.to_vec(),
        rows: Vec::new(),
        remarks: Vec::new(),
    };
    progress.begin(
        "the spec's share",
        u32::try_from(scenes.len()).unwrap_or(u32::MAX),
    );
    for entry in scenes {
        progress.step();
        let loaded = match load_entry(entry, None) {
            Ok(loaded) => loaded,
            Err(missing @ LoadError::Missing { .. }) => {
                let why = format!("not measured: {}: {missing}", entry.name);
                shares.remarks.push(why);
                continue;
            }
            Err(error) => return Err(error.to_string()),
        };
        let mut seconds = vec![Vec::new(); threads.len()];
        for round in 0..runs {
            let mut order: Vec<usize> = (0..threads.len()).collect();
            if round % 2 == 1 {
                order.reverse();
            }
            for at in order {
                let start = Instant::now();
                with_threads(threads[at], || spec_alone(&loaded))?;
                seconds[at].push(start.elapsed().as_secs_f64());
            }
        }
        shares.rows.push(Share {
            scene: entry.name.clone(),
            seconds,
        });
    }
    progress.end();
    Ok(shares)
}

/// A line for each number of threads, and one for each of the scenes that take longest.
pub fn lines(shares: &Shares) -> Vec<String> {
    let mut lines = vec![format!(
        "The spec's share of {} scenes: {} rounds on {} cores, {}; seconds, and over one thread's of the same round",
        shares.rows.len(),
        shares.runs,
        shares.machine.cores,
        shares.machine.version
    )];
    for (threads, (time, gain)) in shares.threads.iter().zip(shares.total()) {
        lines.push(format!(
            "{threads:>4} threads: {:.3} s ({:.3} to {:.3}), {:.2} times as fast ({:.2} to {:.2})",
            time.median, time.min, time.max, gain.median, gain.min, gain.max
        ));
    }
    let median = |row: &Share, at: usize| Spread::of(row.seconds[at].iter().copied()).median;
    let mut longest: Vec<&Share> = shares.rows.iter().collect();
    longest.sort_by(|a, b| median(b, 0).total_cmp(&median(a, 0)));
    for row in longest.into_iter().take(12) {
        let times = (0..shares.threads.len()).map(|at| format!("{:>9.1}", 1e3 * median(row, at)));
        lines.push(format!(
            "  {:<28}{} ms",
            row.scene,
            times.collect::<String>()
        ));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::{Share, Shares, lines};
    use crate::bench::Machine;

    #[test]
    fn totals_are_sums_of_rounds() {
        let row = |scene: &str, seconds: [[f64; 2]; 2]| Share {
            scene: scene.to_owned(),
            seconds: seconds.map(|s| s.to_vec()).to_vec(),
        };
        let shares = Shares {
            date: String::new(),
            machine: Machine::default(),
            runs: 2,
            threads: vec![1, 2],
            rows: vec![
                row("a", [[1.0, 3.0], [1.0, 1.0]]),
                row("b", [[3.0, 5.0], [1.0, 3.0]]),
            ],
            remarks: Vec::new(),
        };
        let total = shares.total();
        assert_eq!((total[0].0.min, total[0].0.max), (4.0, 8.0), "one thread");
        assert_eq!((total[0].1.min, total[0].1.max), (1.0, 1.0), "over itself");
        assert_eq!((total[1].0.min, total[1].0.max), (2.0, 4.0), "two");
        assert_eq!(total[1].1.median, 2.0, "twice as fast in both rounds");
        let lines = lines(&shares);
        assert!(lines[3].contains(" b "), "the longest first: {lines:?}");
    }
}
