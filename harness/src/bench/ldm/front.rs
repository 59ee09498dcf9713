//! The front of time against error: of each leg a line over directions and one over resolutions,
//! which meet at the scene's own setting. Errors are those from random rays.

use super::super::svg::{Line, Panel, Plot, alone};
use super::{Asked, Row, Sweep};

/// What lines vary.
const SWEEPS: [&str; 2] = ["directions", "resolution"];

/// The front as an SVG.
pub fn svg(sweep: &Sweep) -> String {
    let legs = distinct(&sweep.rows, |row| &row.leg);
    let scenes = distinct(&sweep.rows, |row| &row.scene);
    let (date, machine) = (&sweep.date, &sweep.machine);
    let named = |leg: &&str| SWEEPS.map(|swept| format!("{leg}: {swept}"));
    alone(&Plot {
        title: "Time against error: layered depth maps".to_owned(),
        words: format!(
            "Time against error of what is open, {date}, {}",
            machine.slug
        ),
        place: format!("{date}, {}", machine.cpu),
        legend: legs.iter().flat_map(named).collect(),
        panels: scenes
            .iter()
            .map(|scene| panel(&sweep.rows, &legs, scene))
            .collect(),
        bars: Vec::new(),
    })
}

fn distinct(rows: &[Row], of: fn(&Row) -> &String) -> Vec<&str> {
    let mut all: Vec<&str> = Vec::new();
    for name in rows.iter().map(of) {
        if !all.contains(&name.as_str()) {
            all.push(name);
        }
    }
    all
}

fn panel(rows: &[Row], legs: &[&str], scene: &str) -> Panel {
    let of_scene = || {
        let own = rows.iter().filter(|row| row.scene == scene);
        own.filter_map(|row| Some((row, row.asked.as_ref()?)))
    };
    // The first row of a scene has its own setting.
    let own = of_scene()
        .next()
        .map(|(row, _)| (row.directions, row.resolution));
    let mut lines = Vec::new();
    for (number, leg) in legs.iter().enumerate() {
        for sweep in 0..SWEEPS.len() {
            let is_of = |(row, _): &(&Row, &Asked)| {
                row.leg == *leg && own.is_some_and(|own| is_swept(row, own, sweep))
            };
            let mut swept: Vec<(&Row, &Asked)> = of_scene().filter(is_of).collect();
            swept.sort_by_key(|(row, _)| (row.directions, row.resolution));
            lines.push(Line {
                style: SWEEPS.len() * number + sweep,
                points: swept
                    .iter()
                    .map(|(_, asked)| (asked.frame.median, decibels(asked)))
                    .collect(),
            });
        }
    }
    let levels = of_scene().map(|(row, asked)| {
        let words = format!("{} at {}", row.directions, row.resolution);
        (decibels(asked), words)
    });
    Panel {
        heading: scene.to_owned(),
        levels: levels.collect(),
        lines,
    }
}

/// Whether a row differs from the own setting in nothing but what a line varies.
fn is_swept(row: &Row, (directions, resolution): (u32, u32), sweep: usize) -> bool {
    match sweep {
        0 => row.resolution == resolution,
        _ => row.directions == directions,
    }
}

/// With peak 1; `None`: exact.
fn decibels(asked: &Asked) -> Option<f64> {
    (asked.random[0] > 0.0).then(|| -20.0 * asked.random[0].log10())
}

#[cfg(test)]
mod tests {
    use super::super::super::{Machine, Spread};
    use super::super::Layout;
    use super::*;

    fn row(directions: u32, resolution: u32, error: f64) -> Row {
        Row {
            scene: "ldm/a".to_owned(),
            leg: "gpu@<x>".to_owned(),
            clock: "host",
            layout: Layout::Runs,
            directions,
            resolution,
            triangles: 2,
            receivers: 9,
            pixels: 8,
            keys: 31,
            build: Spread::of([0.75]),
            parts: vec![("count", Spread::of([0.5]))],
            memory: [156, 400],
            of_bound: Some(0.25),
            asked: Some(Asked {
                frame: Spread::of([f64::from(directions)]),
                of_bound: Some(0.125),
                same: [error / 2.0, error],
                random: [error, 2.0 * error],
                noise: 1e-3,
                flip: Some([0.5, 0.25]),
            }),
        }
    }

    fn chains() -> Row {
        Row {
            layout: Layout::Chains,
            asked: None,
            ..row(64, 50, 0.0)
        }
    }

    fn sweep() -> Sweep {
        Sweep {
            date: "2000-01-02".into(),
            machine: Machine::default(),
            runs: 1,
            rows: vec![
                row(64, 50, 1e-2),
                chains(),
                row(16, 50, 1e-1),
                row(64, 25, 0.0),
                row(64, 100, 1e-3),
            ],
            contests: Vec::new(),
            skips: Vec::new(),
            pictures: vec![("ldm/a".to_owned(), Vec::new())],
            remarks: Vec::new(),
        }
    }

    /// Two lines of a leg, of two and of three points, which meet at its own setting.
    #[test]
    fn sweeps_meet_at_the_own_setting() {
        let text = svg(&sweep());
        let lines = text.split("<polyline").skip(1).map(|line| {
            let points = line.split("points=\"").nth(1).expect("points");
            let points = points.split('"').next().unwrap_or_default();
            points.split_whitespace().count()
        });
        assert_eq!(lines.collect::<Vec<_>>(), [2, 3], "{text}");
        assert_eq!(text.matches("class=\"mark ").count(), 2 + 2 + 3, "{text}");
        assert!(text.contains(">64 at 50<") && text.contains("gpu@&lt;x&gt;: resolution"));
        assert!(!text.contains("NaN") && !text.contains("inf\""), "{text}");
    }

    #[test]
    fn values_have_a_line_for_each_part_and_whole() {
        let text = super::super::csv(&sweep());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines.len(),
            1 + 4 * 3 + 2,
            "frame, build, count; without a frame"
        );
        let columns = lines[0].split(',').count();
        assert!(lines.iter().all(|line| line.split(',').count() == columns));
        let page = super::super::page(&sweep());
        assert!(page.contains("| 3.88 |"), "keys a pixel: {page}");
        assert!(page.contains("| 0.5000 (0.2500) |") && page.contains("--ldm-a.png)"));
    }
}
