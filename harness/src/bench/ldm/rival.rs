//! Maps against horizons of one view, the rival in screen space: at equal time on one adapter, over
//! the distance up to which things block (paper section 5.1, Figure 8).
//!
//! Both are held against the same random rays, at the same points. Horizons know what the eye sees
//! and nothing else: what is hidden or outside of the picture is open to them.

use triptych_gpu::error::GpuError;
use triptych_gpu::hbao::{DETAIL, Hbao, Screen, Settings};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::timer::Timer;
use triptych_spec::ldm::Falloff;

use super::super::csv::number;
use super::super::legs::Station;
use super::super::table::{aligned, spread};
use super::super::warm::wake;
use super::super::{Spread, WARM_UP, markdown};
use super::Sweep;
use super::case::{Case, apart};
use crate::text::{clean, markdown as text, quoted};

/// Parts of the scene's diagonal from which on nothing blocks; the last is far enough for all.
const FARS: [f64; 6] = [1.0 / 256.0, 1.0 / 64.0, 1.0 / 16.0, 1.0 / 4.0, 1.0, 2.0];

/// Directions of maps.
pub(super) const DIRECTIONS: [u32; 5] = [16, 64, 128, 256, 512];

/// Slices and steps of horizons.
const HORIZONS: [[u32; 2]; 6] = [[1, 4], [2, 6], [4, 8], [8, 16], [16, 32], [32, 64]];

/// Milliseconds at which both are compared.
const BUDGETS: [f64; 6] = [0.5, 1.0, 2.0, 4.0, 8.0, 16.0];

/// One technique with one setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Contest {
    /// The scene.
    pub scene: String,
    /// `gpu@adapter`.
    pub leg: String,
    /// From which part of the scene's diagonal on nothing blocks.
    pub far: f64,
    /// Maps, or horizons.
    pub technique: &'static str,
    /// Directions and resolution, or slices and steps.
    pub setting: String,
    /// Milliseconds.
    pub time: Spread,
    /// Root of the mean squared difference from random rays, and the largest.
    pub random: [f64; 2],
    /// Root of the mean variance of what those say.
    pub noise: f64,
}

/// The distances, in steps.
pub(super) fn fars(case: &Case<'_>) -> impl Iterator<Item = (f64, Falloff)> {
    let diagonal = case.diagonal();
    FARS.into_iter().map(move |far| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at most 2^26"
        )]
        let most = (far * diagonal).max(1.0) as u32;
        (far, Falloff::Distance { most, power: 2 })
    })
}

/// Horizons with all their settings.
///
/// # Errors
/// Whatever the device reports.
pub(super) fn horizons(
    station: &Station<'_>,
    case: &Case<'_>,
    far: f64,
    runs: u32,
) -> Result<Vec<Contest>, GpuError> {
    let gpu = &station.adapter.gpu;
    let native = gpu.has_int64();
    let kernels = Kernels::trusted(native, |sources| sources);
    let setup = &case.setup;
    let screen = Screen::new(&setup.eye, &setup.model, &setup.seen.surfaces);
    let mut all = Vec::new();
    for [slices, steps] in HORIZONS {
        let settings = Settings {
            falloff: setup.falloff,
            slices,
            steps,
            denoise: 1,
            detail: DETAIL,
        };
        let hbao = Hbao::new(gpu, &kernels, &screen, settings)?;
        let spans = u32::try_from(hbao.spans().count()).expect("three");
        let timer = Timer::new(gpu, &station.clock, spans)?;
        let mut times = Vec::new();
        for round in 0..WARM_UP + runs {
            if gpu.info.device_type != wgpu::DeviceType::Cpu {
                wake(|| hbao.time(&timer).map(drop))?;
            }
            let seconds: f64 = hbao.time(&timer)?.iter().sum();
            if round >= WARM_UP {
                times.push(1000.0 * seconds);
            }
        }
        let open = hbao.openness()?;
        let at = |receiver: &usize| {
            let pixel = setup.receivers[*receiver].pixel;
            f64::from(open[pixel as usize])
        };
        let own: Vec<f64> = case.sample.iter().map(at).collect();
        let (random, noise) = case.off_random(&own);
        all.push(Contest {
            scene: case.name.clone(),
            leg: format!("gpu@{}", gpu.name),
            far,
            technique: "horizons",
            setting: format!("{slices} slices, 2 x {steps}"),
            time: Spread::of(times),
            random: apart(random.into_iter()),
            noise,
        });
    }
    Ok(all)
}

/// Columns of the tables.
const COLUMNS: [&str; 8] = [
    "scene",
    "leg",
    "far",
    "technique",
    "setting",
    "time, ms",
    "RMSE",
    "largest",
];

fn cells(row: &Contest) -> [String; COLUMNS.len()] {
    [
        clean(&row.scene).into_owned(),
        clean(&row.leg).into_owned(),
        format!("{:.4}", row.far),
        row.technique.to_owned(),
        row.setting.clone(),
        spread(row.time, 1.0, 3),
        format!("{:.2e} ({:.1e})", row.random[0], row.noise),
        format!("{:.1e}", row.random[1]),
    ]
}

/// Lines for the terminal.
pub fn lines(sweep: &Sweep) -> Vec<String> {
    let mut table = vec![COLUMNS.map(str::to_owned)];
    table.extend(sweep.contests.iter().map(cells));
    let mut lines: Vec<String> = aligned(&table, 2).collect();
    lines.extend(verdicts(&sweep.contests));
    lines
}

/// For each distance, the least error of each technique within each budget of time.
fn verdicts(contests: &[Contest]) -> Vec<String> {
    let mut all: Vec<(&str, &str, f64)> = Vec::new();
    for row in contests {
        let own = (row.scene.as_str(), row.leg.as_str(), row.far);
        if !all.contains(&own) {
            all.push(own);
        }
    }
    let of = |(scene, leg, far): (&str, &str, f64)| {
        let least = |technique: &str, budget: f64| {
            let rows = contests.iter().filter(|row| {
                (row.scene.as_str(), row.leg.as_str(), row.far) == (scene, leg, far)
                    && row.technique == technique
                    && row.time.median <= budget
            });
            rows.map(|row| row.random[0]).min_by(f64::total_cmp)
        };
        let at = |budget: f64| {
            let shown =
                |error: Option<f64>| error.map_or("none".to_owned(), |e| format!("{e:.1e}"));
            let [maps, horizons] = ["maps", "horizons"].map(|t| least(t, budget));
            let better = match (maps, horizons) {
                (Some(a), Some(b)) if a < b => "maps",
                (Some(_), None) => "maps",
                (None, None) => "nobody",
                _ => "horizons",
            };
            let [maps, horizons] = [maps, horizons].map(shown);
            format!("{budget} ms: {better} ({maps} and {horizons})")
        };
        let budgets = BUDGETS.map(at).join("; ");
        format!(
            "{}, {}, far {far:.4}: the least error of maps and of horizons within {budgets}",
            clean(scene),
            clean(leg)
        )
    };
    all.into_iter().map(of).collect()
}

/// The page.
pub fn page(sweep: &Sweep) -> String {
    let mut lines = vec![
        format!("# Layered depth maps against horizons, {}", sweep.date),
        String::new(),
    ];
    lines.extend(markdown::machine(&sweep.machine));
    lines.extend(sweep.remarks.iter().map(|r| format!("- {}", text(r))));
    lines.push(String::new());
    lines.push(format!(
        "Medians of {} rounds, with minimum and maximum. *Far*: from which part of the scene's diagonal on nothing \
         blocks; what is\nnearer lets the square of its part of that pass. *Maps*: built anew and asked; *horizons*: pyramid of \
         depths, slices, one\npass over pixels of a surface. *RMSE*: from random rays of the same points, with their \
         noise in parentheses.",
        sweep.runs
    ));
    lines.push(String::new());
    lines.extend(
        verdicts(&sweep.contests)
            .iter()
            .map(|v| format!("- {}", text(v))),
    );
    lines.push(String::new());
    lines.push(format!("| {} |", COLUMNS.join(" | ")));
    lines.push(format!("|---|---|{}", "---:|".repeat(COLUMNS.len() - 2)));
    let row = |row: &Contest| format!("| {} |", cells(row).map(|cell| text(&cell)).join(" | "));
    lines.extend(sweep.contests.iter().map(row));
    lines.push(String::new());
    lines.join("\n")
}

/// The whole file of values.
pub fn csv(sweep: &Sweep) -> String {
    let mut text =
        "scene,leg,far,technique,setting,runs,time_ms,time_ms_min,time_ms_max,rmse,largest,noise\n"
            .to_owned();
    for row in &sweep.contests {
        let values = [
            quoted(&row.scene).into_owned(),
            quoted(&row.leg).into_owned(),
            number(row.far),
            row.technique.to_owned(),
            quoted(&row.setting).into_owned(),
            sweep.runs.to_string(),
            number(row.time.median),
            number(row.time.min),
            number(row.time.max),
            number(row.random[0]),
            number(row.random[1]),
            number(row.noise),
        ];
        text += &(values.join(",") + "\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(technique: &'static str, time: f64, error: f64) -> Contest {
        Contest {
            scene: "a".to_owned(),
            leg: "gpu@x".to_owned(),
            far: 0.25,
            technique,
            setting: String::new(),
            time: Spread::of([time]),
            random: [error, 2.0 * error],
            noise: 0.0,
        }
    }

    /// The cheaper one wins until the better one has time enough.
    #[test]
    fn curves_cross() {
        let rows = [
            row("horizons", 0.4, 0.2),
            row("horizons", 3.0, 0.1),
            row("maps", 0.9, 0.3),
            row("maps", 7.0, 0.01),
        ];
        let [line] = &verdicts(&rows)[..] else {
            panic!("one distance");
        };
        for words in [
            "0.5 ms: horizons (none and 2.0e-1)",
            "2 ms: horizons (3.0e-1 and 2.0e-1)",
            "8 ms: maps (1.0e-2 and 1.0e-1)",
        ] {
            assert!(line.contains(words), "no {words} in {line}");
        }
    }
}
