//! The paper's figures, of what was measured here: frames per second and speed-up (Figures 3 to 5),
//! idle times (6) and access times (7).

use std::fmt::Write;

use super::{Measured, Method, Row};
use crate::text::clean;

const WIDTH: f64 = 460.0;
const HEIGHT: f64 = 300.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = 408.0;
const TOP: f64 = 44.0;
const BOTTOM: f64 = 244.0;

const STYLE: &str = "
.plot { font: 12px system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif; }
.plot text { fill: #1d1f21; } .plot .soft { fill: #5c6166; } .plot .ground { fill: #fcfcfa; }
.plot .grid { stroke: #dcdcd6; } .plot .line { fill: none; stroke-width: 2; }
.plot .s0 { stroke: #b3141d; } .plot .f0 { fill: #b3141d; } .plot .s1 { stroke: #0b57a4; } .plot .f1 { fill: #0b57a4; }
.plot .s2 { stroke: #17663a; } .plot .f2 { fill: #17663a; } .plot .bar { opacity: 0.35; }
@media (prefers-color-scheme: dark) {
.plot text { fill: #e6e6e3; } .plot .soft { fill: #a0a6ab; } .plot .ground { fill: #16181a; }
.plot .grid { stroke: #373c41; }
.plot .s0 { stroke: #ff8f8a; } .plot .f0 { fill: #ff8f8a; } .plot .s1 { stroke: #8cbcf0; } .plot .f1 { fill: #8cbcf0; }
.plot .s2 { stroke: #6fd394; } .plot .f2 { fill: #6fd394; }
}
";

/// A picture of its own for each file: what its name ends with, and the SVG.
pub fn plots(measured: &Measured) -> Vec<(&'static str, String)> {
    vec![
        ("speed", page(measured, speed)),
        ("idle", page(measured, idle)),
        ("access", page(measured, access)),
    ]
}

/// Text as XML has it.
fn escaped(text: &str) -> String {
    let text = clean(text).replace('&', "&amp;");
    text.replace('<', "&lt;").replace('>', "&gt;")
}

/// A panel for each scene, two in a row.
fn page(measured: &Measured, panel: fn(&Measured, &str) -> String) -> String {
    let scenes = measured.scenes();
    let rows = scenes.len().div_ceil(2) as f64;
    let (width, height) = (2.0 * WIDTH, rows * HEIGHT + 24.0);
    let mut text = format!(
        "<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 {width} {height}\">\
         <style>{STYLE}</style><rect class=\"ground\" width=\"{width}\" height=\"{height}\"/>\
         <text class=\"soft\" x=\"16\" y=\"16\">{}, {} cores, {}</text>",
        escaped(&measured.machine.cpu),
        measured.machine.cores,
        measured.date
    );
    for (at, scene) in scenes.iter().enumerate() {
        let (x, y) = ((at % 2) as f64 * WIDTH, (at / 2) as f64 * HEIGHT + 20.0);
        let _ = write!(
            text,
            "<g transform=\"translate({x} {y})\">{}</g>",
            panel(measured, scene)
        );
    }
    text += "</svg>\n";
    text
}

/// The paper's three on a scene, by their numbers of threads.
fn of<'m>(measured: &'m Measured, scene: &'m str, method: Method) -> Vec<&'m Row> {
    let own = |row: &&Row| row.scene == scene && row.method == method;
    measured.rows.iter().filter(own).collect()
}

/// What stands over a panel, with the three methods' names in their colours.
fn heading(scene: &str, words: &str) -> String {
    let mut text = format!(
        "<text x=\"16\" y=\"18\" font-weight=\"600\">{}</text><text class=\"soft\" x=\"16\" y=\"34\">{words}</text>",
        escaped(scene)
    );
    for (at, method) in Method::PAPERS.iter().enumerate() {
        let x = 262.0 + 62.0 * at as f64;
        let _ = write!(
            text,
            "<rect class=\"f{at}\" x=\"{x}\" y=\"25\" width=\"10\" height=\"10\"/><text x=\"{}\" y=\"34\">{}</text>",
            x + 14.0,
            method.name()
        );
    }
    text
}

/// Horizontal lines from 0 to a round number, with numbers at the left, and those of another scale at the
/// right if there is one.
fn scale(most: f64, right: Option<f64>) -> String {
    let mut text = String::new();
    for part in 0..=4 {
        let share = f64::from(part) / 4.0;
        let y = BOTTOM - share * (BOTTOM - TOP);
        let _ = write!(
            text,
            "<line class=\"grid\" x1=\"{LEFT}\" x2=\"{RIGHT}\" y1=\"{y}\" y2=\"{y}\"/>\
             <text class=\"soft\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>",
            LEFT - 6.0,
            y + 4.0,
            short(share * most)
        );
        if let Some(most) = right {
            let (x, y) = (RIGHT + 6.0, y + 4.0);
            let _ = write!(
                text,
                "<text class=\"soft\" x=\"{x}\" y=\"{y}\">{}</text>",
                short(share * most)
            );
        }
    }
    text
}

/// A number in few digits.
fn short(value: f64) -> String {
    match value {
        v if v >= 100.0 => format!("{v:.0}"),
        v if v >= 1.0 => format!("{v:.1}"),
        v => format!("{v:.3}"),
    }
}

/// A round number that is at least this.
fn round_up(value: f64) -> f64 {
    let power = 10_f64.powf(value.max(1e-9).log10().floor());
    let steps = [1.0, 2.0, 4.0, 5.0, 8.0, 10.0];
    let fits = steps
        .into_iter()
        .map(|step| step * power)
        .find(|top| *top >= value);
    fits.unwrap_or(value)
}

/// Numbers of threads, each with room of its own: its middle, and how wide it is.
struct Columns {
    threads: Vec<usize>,
    wide: f64,
}

impl Columns {
    fn new(measured: &Measured) -> Self {
        let threads = measured.threads();
        let wide = (RIGHT - LEFT) / threads.len().max(1) as f64;
        Self { threads, wide }
    }

    fn middle(&self, threads: usize) -> f64 {
        let at = self.threads.iter().position(|t| *t == threads).unwrap_or(0);
        LEFT + self.wide * (at as f64 + 0.5)
    }

    fn names(&self) -> String {
        let name = |threads: &usize| {
            let x = self.middle(*threads);
            let y = BOTTOM + 16.0;
            format!(
                "<text class=\"soft\" x=\"{x:.1}\" y=\"{y}\" text-anchor=\"middle\">{threads}</text>"
            )
        };
        let middle = f64::midpoint(LEFT, RIGHT);
        let y = BOTTOM + 32.0;
        let names: String = self.threads.iter().map(name).collect();
        format!(
            "{names}<text class=\"soft\" x=\"{middle}\" y=\"{y}\" text-anchor=\"middle\">threads</text>"
        )
    }
}

/// Where a value is, from the bottom.
fn height(value: f64, most: f64) -> f64 {
    BOTTOM - value / most * (BOTTOM - TOP)
}

/// The largest of some values of the paper's methods on a scene, rounded up.
fn most(measured: &Measured, scene: &str, value: impl Fn(&Row) -> f64) -> f64 {
    let rows = Method::PAPERS
        .into_iter()
        .flat_map(|m| of(measured, scene, m));
    round_up(rows.map(value).fold(0.0, f64::max))
}

/// A line for each method.
fn polylines(
    measured: &Measured,
    scene: &str,
    columns: &Columns,
    top: f64,
    value: impl Fn(&Row) -> f64,
) -> String {
    let mut text = String::new();
    for (at, method) in Method::PAPERS.into_iter().enumerate() {
        let points = of(measured, scene, method).into_iter().map(|row| {
            format!(
                "{:.1},{:.1}",
                columns.middle(row.threads),
                height(value(row), top)
            )
        });
        let points = points.collect::<Vec<_>>().join(" ");
        let _ = write!(text, "<polyline class=\"line s{at}\" points=\"{points}\"/>");
    }
    text
}

/// Bars side by side for each number of threads.
fn bars(
    measured: &Measured,
    scene: &str,
    columns: &Columns,
    top: f64,
    value: impl Fn(&Row) -> f64,
) -> String {
    let wide = columns.wide * 0.26;
    let mut text = String::new();
    for (at, method) in Method::PAPERS.into_iter().enumerate() {
        for row in of(measured, scene, method) {
            let x = columns.middle(row.threads) + (at as f64 - 1.5) * wide;
            let y = height(value(row), top);
            let _ = write!(
                text,
                "<rect class=\"bar f{at}\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{wide:.1}\" height=\"{:.1}\"/>",
                BOTTOM - y
            );
        }
    }
    text
}

/// Figures 3 to 5.
fn speed(measured: &Measured, scene: &str) -> String {
    let columns = Columns::new(measured);
    let [fps, up] = [
        most(measured, scene, |row| row.fps.median),
        most(measured, scene, |row| row.speed_up.median),
    ];
    heading(scene, "lines: frames/s (left); bars: speed-up")
        + &scale(fps, Some(up))
        + &bars(measured, scene, &columns, up, |row| row.speed_up.median)
        + &polylines(measured, scene, &columns, fps, |row| row.fps.median)
        + &columns.names()
}

/// Figure 6, for every number of threads.
fn idle(measured: &Measured, scene: &str) -> String {
    let columns = Columns::new(measured);
    let value = |row: &Row| row.spent.map_or(0.0, |spent| spent.idle);
    let top = most(measured, scene, value);
    heading(scene, "ms idle, a thread in a frame")
        + &scale(top, None)
        + &bars(measured, scene, &columns, top, value)
        + &columns.names()
}

/// Figure 7.
fn access(measured: &Measured, scene: &str) -> String {
    let columns = Columns::new(measured);
    let value = |row: &Row| row.spent.map_or(0.0, |spent| spent.access);
    let top = most(measured, scene, value);
    heading(scene, "ms in the queue, all threads")
        + &scale(top, None)
        + &polylines(measured, scene, &columns, top, value)
        + &columns.names()
}
