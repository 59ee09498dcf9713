//! The front of time against error: of each leg a line for kernels, one for resolutions of buffer B
//! and one for blurs, which meet at the scene's own setting.

use super::super::svg::{Line, Panel, Plot, alone};
use super::{Frames, Row};

/// What lines vary.
const SWEEPS: [&str; 3] = ["kernel", "buffer B", "blur"];

/// The front as an SVG.
pub fn svg(frames: &Frames) -> String {
    let mut legs: Vec<&str> = Vec::new();
    let mut scenes: Vec<&str> = Vec::new();
    for row in &frames.rows {
        if !legs.contains(&row.leg.as_str()) {
            legs.push(&row.leg);
        }
        if !scenes.contains(&row.scene.as_str()) {
            scenes.push(&row.scene);
        }
    }
    let (date, machine) = (&frames.date, &frames.machine);
    let named = |leg: &&str| SWEEPS.map(|sweep| format!("{leg}: {sweep}"));
    alone(&Plot {
        title: "Time against error: indirect light".to_owned(),
        words: format!(
            "Time against error of frames of indirect light, {date}, {}",
            machine.slug
        ),
        place: format!("{date}, {}", machine.cpu),
        legend: legs.iter().flat_map(named).collect(),
        panels: scenes
            .iter()
            .map(|scene| panel(frames, &legs, scene))
            .collect(),
        bars: Vec::new(),
    })
}

fn panel(frames: &Frames, legs: &[&str], scene: &str) -> Panel {
    let of_scene = || frames.rows.iter().filter(|row| row.scene == scene);
    let mut lines = Vec::new();
    for (number, leg) in legs.iter().enumerate() {
        let rows: Vec<&Row> = of_scene().filter(|row| row.leg == *leg).collect();
        // A leg of which the own setting is missing has no lines that meet.
        let Some(own) = of_scene().next() else {
            continue;
        };
        for (sweep, _) in SWEEPS.iter().enumerate() {
            let mut swept: Vec<&&Row> = rows.iter().filter(|row| is_of(row, own, sweep)).collect();
            swept.sort_by_key(|row| (row.kernel, row.divisor, row.blur));
            lines.push(Line {
                style: SWEEPS.len() * number + sweep,
                points: swept
                    .iter()
                    .map(|row| (row.frame.median, decibels(row)))
                    .collect(),
            });
        }
    }
    Panel {
        heading: scene.to_owned(),
        lines,
        levels: levels(&of_scene().collect::<Vec<_>>()),
    }
}

/// Whether a row differs from the scene's own setting in nothing but what a line varies.
fn is_of(row: &Row, own: &Row, sweep: usize) -> bool {
    let same = [
        (row.kernel, row.stride) == (own.kernel, own.stride),
        row.divisor == own.divisor,
        row.blur == own.blur,
    ];
    (0..SWEEPS.len()).all(|at| at == sweep || same[at])
}

/// With peak 1; `None`: exact.
fn decibels(row: &Row) -> Option<f64> {
    (row.rmse > 0.0).then(|| -20.0 * row.rmse.log10())
}

/// Settings beside the errors of the first leg that has the most.
fn levels(rows: &[&Row]) -> Vec<(Option<f64>, String)> {
    let Some(own) = rows.first() else {
        return Vec::new();
    };
    let count = |leg: &str| rows.iter().filter(|row| row.leg == leg).count();
    let most = rows.iter().map(|row| count(&row.leg)).max();
    let first = rows.iter().find(|row| Some(count(&row.leg)) == most);
    let of_leg = rows
        .iter()
        .filter(|row| Some(&row.leg) == first.map(|first| &first.leg));
    let words = |row: &Row| {
        let is = |sweep| is_of(row, own, sweep);
        match (is(0), is(1)) {
            (true, true) => "own".to_owned(),
            (true, false) => format!("{0}x{0}", row.kernel),
            (false, true) => format!("B 1/{}", row.divisor),
            (false, false) => format!("blur {}", row.blur),
        }
    };
    of_leg.map(|row| (decibels(row), words(row))).collect()
}

#[cfg(test)]
mod tests {
    use super::super::super::{Machine, Spread};
    use super::{Frames, Row, svg};

    fn row(leg: &str, kernel: u32, divisor: u32, blur: u32, rmse: f64) -> Row {
        Row {
            scene: "rsm/a".to_owned(),
            leg: leg.to_owned(),
            clock: "host",
            kernel,
            stride: 1,
            divisor,
            blur,
            pixels: 64,
            blockers: 2,
            rays: 8,
            frame: Spread::of([f64::from(kernel)]),
            parts: Vec::new(),
            rmse,
            largest: rmse,
            own: None,
        }
    }

    /// Three lines of a leg, which meet at its own setting: a point of each, and one more of
    /// kernels, of buffer B, and of blur.
    #[test]
    fn sweeps_meet_at_the_own_setting() {
        let rows = vec![
            row("spec", 9, 2, 1, 1e-2),
            row("gpu@<x>", 9, 2, 1, 1e-2),
            row("gpu@<x>", 5, 2, 1, 1e-1),
            row("gpu@<x>", 9, 1, 1, 0.0),
            row("gpu@<x>", 9, 2, 0, 1e-3),
        ];
        let text = svg(&Frames {
            date: "2000-01-02".into(),
            machine: Machine::default(),
            runs: 1,
            rows,
            remarks: Vec::new(),
        });
        let legend = 2 * 3;
        assert_eq!(text.matches("<polyline").count(), 2 * 3, "{text}");
        let marks = text.matches("class=\"mark ").count();
        assert_eq!(marks, legend + 3 + 3 + 3, "{text}");
        for words in [
            ">own<",
            ">5x5<",
            ">B 1/1<",
            ">blur 0<",
            ">gpu@&lt;x&gt;: blur<",
        ] {
            assert!(text.contains(words), "no {words} in {text}");
        }
        assert!(!text.contains("NaN") && !text.contains("inf\""), "{text}");
    }
}
