//! What a report says about the run and its scenes.

use std::time::{SystemTime, UNIX_EPOCH};

use crate::again::program;
use crate::calibrate::Grid;
use crate::embree::Library;
use crate::replay::Outcome;
use crate::replay::gpu::{Adapter, Broken};
use crate::report::{AdapterInfo, Difference, PlanLine, RunInfo, SceneReport};
use crate::text::shell_word;

/// What was run, where and with what.
pub fn run_info(
    adapters: &[Adapter],
    broken: &[Broken],
    embree: Option<&Library>,
    seconds: f64,
) -> RunInfo {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .map(|w| shell_word(&w).into())
        .collect();
    let mut versions = vec![("triptych".to_owned(), env!("CARGO_PKG_VERSION").to_owned())];
    versions.extend(embree.map(|library| ("embree".to_owned(), library.named().to_string())));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    RunInfo {
        command: format!("{} {}", program(), words.join(" ")),
        date: today(),
        seconds,
        versions,
        machine: vec![
            (
                "system".into(),
                format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            ),
            ("cores".into(), cores.to_string()),
        ],
        adapters: adapters
            .iter()
            .map(adapter_info)
            .chain(broken.iter().map(broken_info))
            .collect(),
    }
}

fn adapter_info(adapter: &Adapter) -> AdapterInfo {
    let info = &adapter.gpu.info;
    let grid = match adapter.grid {
        Grid::Bits(bits) => format!("1/{}", 1 << bits),
        Grid::Unknown => "unknown: compared by a band".into(),
    };
    let limit = adapter.gpu.binding_limit() >> 20;
    AdapterInfo {
        name: adapter.gpu.name.clone(),
        facts: vec![
            ("device".into(), info.name.clone()),
            (
                "driver".into(),
                format!("{} {}", info.driver, info.driver_info),
            ),
            ("back end".into(), format!("{:?}", info.backend)),
            ("sub-pixel grid".into(), grid),
            ("largest binding".into(), format!("{limit} MiB")),
        ],
    }
}

fn broken_info(broken: &Broken) -> AdapterInfo {
    AdapterInfo {
        name: broken.name.clone(),
        facts: vec![("cannot be used".into(), broken.reason())],
    }
}

/// A scene's outcome as the report shows it.
pub fn scene_report(outcome: Outcome) -> SceneReport {
    let mut plan: Vec<PlanLine> = outcome
        .passes
        .into_iter()
        .map(|p| PlanLine {
            pass: p.name.into(),
            runs: p.runs,
            reason: p.reason,
            saved_ms: None,
        })
        .collect();
    plan.extend(outcome.saved.into_iter().map(|(leg, ms)| PlanLine {
        pass: "all of the above".into(),
        runs: true,
        reason: format!("skipping on {leg}, against the same leg with --no-skip"),
        saved_ms: Some(ms),
    }));
    SceneReport {
        name: outcome.name,
        purpose: outcome.purpose,
        rows: outcome.rows,
        size: outcome.size,
        pictures: outcome.pictures,
        sheets: outcome.sheets,
        worst: outcome.worst,
        left_out: Vec::new(),
        plan,
        differences: outcome
            .described
            .into_iter()
            .map(Difference::from)
            .collect(),
    }
}

/// Today's date in UTC, year-month-day.
pub fn today() -> String {
    let since = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .unwrap_or_default();
    let (year, month, day) = civil(since.as_secs() / 86_400);
    format!("{year}-{month:02}-{day:02}")
}

/// Calendar date of a day counted from 1970-01-01 (proleptic Gregorian; years
/// begin in March, so that leap days come last).
fn civil(days: u64) -> (u64, u64, u64) {
    let days = days + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * day_of_year + 2) / 153;
    let month = if shifted < 10 {
        shifted + 3
    } else {
        shifted - 9
    };
    let year = 400 * era + year_of_era + u64::from(month <= 2);
    (year, month, day_of_year - (153 * shifted + 2) / 5 + 1)
}

#[cfg(test)]
mod tests {
    use super::civil;

    #[test]
    fn days_become_dates() {
        assert_eq!(civil(0), (1970, 1, 1), "the epoch");
        assert_eq!(
            civil(11_016),
            (2000, 2, 29),
            "a leap day of a year that 400 divides"
        );
        assert_eq!(civil(20_779), (2026, 11, 22), "a day of writing");
    }
}
