//! The front: time against error, a panel for each scene, a line for each leg.
//!
//! Right and down is worse. Time is logarithmic. Above [`ROUNDING`] decibels only
//! rounding is left, and such points, and exact ones, lie on one line at the top.
//! Lines differ in colour, and their points in shape.

mod axis;
mod mark;

use maud::{Markup, PreEscaped, html};

use super::{Bench, Row};
use crate::text::clean;
use axis::{Horizontal, Vertical};
use mark::mark;

/// Decibels from which on a picture counts as right.
pub const ROUNDING: f64 = 100.0;

/// Legs that have a colour and a shape of their own; more begin again.
const STYLES: usize = 8;

const WIDTH: f64 = 960.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 870.0;
const PANEL: f64 = 290.0;
/// Of a panel, from its top.
const PLOT: [f64; 2] = [52.0, 240.0];
const LEGEND_LINE: f64 = 20.0;
const LEGEND_COLUMNS: usize = 3;

const STYLE: &str = "
.front { font: 12px system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif; }
.front text { fill: #1d1f21; }
.front .soft { fill: #5c6166; }
.front .ground { fill: #fcfcfa; }
.front .grid { stroke: #dcdcd6; }
.front .axis { stroke: #5c6166; }
.front .line { fill: none; stroke-width: 1.6; }
.front .s0 { stroke: #1d1f21; color: #1d1f21; } .front .s1 { stroke: #0b57a4; color: #0b57a4; }
.front .s2 { stroke: #b35900; color: #b35900; } .front .s3 { stroke: #17663a; color: #17663a; }
.front .s4 { stroke: #a1308a; color: #a1308a; } .front .s5 { stroke: #0d7a86; color: #0d7a86; }
.front .s6 { stroke: #b3141d; color: #b3141d; } .front .s7 { stroke: #6344b8; color: #6344b8; }
.front .mark { fill: currentColor; stroke-width: 1.2; }
@media (prefers-color-scheme: dark) {
.front text { fill: #e6e6e3; }
.front .soft { fill: #a0a6ab; }
.front .ground { fill: #16181a; }
.front .grid { stroke: #373c41; }
.front .axis { stroke: #a0a6ab; }
.front .s0 { stroke: #e6e6e3; color: #e6e6e3; } .front .s1 { stroke: #8cbcf0; color: #8cbcf0; }
.front .s2 { stroke: #f0a860; color: #f0a860; } .front .s3 { stroke: #6fd394; color: #6fd394; }
.front .s4 { stroke: #e79ad6; color: #e79ad6; } .front .s5 { stroke: #6fd0da; color: #6fd0da; }
.front .s6 { stroke: #ff8f8a; color: #ff8f8a; } .front .s7 { stroke: #b8a3f5; color: #b8a3f5; }
}
";

/// The front by itself, as a file.
pub fn file(bench: &Bench) -> String {
    let space = "http://www.w3.org/2000/svg";
    format!("{}\n", front(bench, Some(space)).into_string())
}

/// The front as an element of a page, which knows what an SVG is.
pub fn element(bench: &Bench) -> Markup {
    front(bench, None)
}

fn front(bench: &Bench, space: Option<&str>) -> Markup {
    let legs = bench.legs();
    let legend = LEGEND_LINE * legs.len().div_ceil(LEGEND_COLUMNS) as f64;
    let top = 60.0 + legend;
    let scenes = bench.scenes();
    let height = top + PANEL * scenes.len() as f64;
    let words = format!(
        "Time against error of the A-buffer with 1, 2, 4, … nearest layers, {}, {}",
        bench.date, bench.machine.slug
    );
    html! {
        svg.front xmlns=[space] role="img" viewBox=(format!("0 0 {WIDTH} {height}")) {
            title { (clean(&words)) }
            style { (PreEscaped(STYLE)) }
            rect.ground width=(WIDTH) height=(height) {}
            text x="24" y="28" font-size="17" font-weight="600" { "Time against error: A-buffer, nearest layers" }
            text.soft x="24" y="46" { (clean(&format!("{}, {}", bench.date, bench.machine.cpu))) }
            text.soft x=(RIGHT) y="46" text-anchor="end" {
                "exact*: equal, or unequal by rounding alone (above 100 dB)"
            }
            @for (at, leg) in legs.iter().enumerate() { (entry(at, leg)) }
            @for (at, scene) in scenes.iter().enumerate() {
                g transform=(format!("translate(0 {})", top + PANEL * at as f64)) {
                    (panel(bench, &legs, scene))
                }
            }
        }
    }
}

/// A line of the legend.
fn entry(at: usize, leg: &str) -> Markup {
    let x = 32.0 + 304.0 * (at % LEGEND_COLUMNS) as f64;
    let y = 68.0 + LEGEND_LINE * (at / LEGEND_COLUMNS) as f64;
    let style = at % STYLES;
    html! {
        line class=(format!("line s{style}")) x1=(x - 8.0) x2=(x + 20.0) y1=(y) y2=(y) {}
        (mark(style, [x + 6.0, y]))
        text x=(x + 28.0) y=(y + 4.0) { (clean(leg)) }
    }
}

fn panel(bench: &Bench, legs: &[&str], scene: &str) -> Markup {
    let rows: Vec<&Row> = bench.fastest().filter(|row| row.scene == scene).collect();
    let times = Horizontal::of(rows.iter().map(|r| r.time.median), [LEFT, RIGHT]);
    let errors = Vertical::of(rows.iter().map(|r| r.psnr), PLOT);
    let at = |row: &Row| [times.at(row.time.median), errors.at(row.psnr)];
    html! {
        text x="24" y="20" font-weight="600" { (clean(&super::table::heading(bench, scene))) }
        text.soft x="24" y="40" { "PSNR, dB" }
        (errors.grid([LEFT, RIGHT]))
        (times.grid(PLOT))
        (levels(&rows, &errors))
        @for (number, leg) in legs.iter().enumerate() {
            @let own: Vec<&Row> = rows.iter().copied().filter(|row| row.leg == *leg).collect();
            @let points: Vec<String> = own.iter().map(|r| at(r)).map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
            polyline class=(format!("line s{}", number % STYLES)) points=(points.join(" ")) {}
            @for row in own { (mark(number % STYLES, at(row))) }
        }
    }
}

/// The numbers of layers, beside where the first leg's points lie; of those that would
/// overlap, not all.
fn levels(rows: &[&Row], errors: &Vertical) -> Markup {
    let leg = rows.first().map(|row| row.leg.as_str());
    let own = rows.iter().filter(|row| Some(row.leg.as_str()) == leg);
    let mut shown: Vec<(f64, String)> = Vec::new();
    // All layers first, then one, then the others from there on.
    let mut own: Vec<&&Row> = own.collect();
    own.sort_by_key(|row| (!row.all, row.layers));
    for row in own {
        let y = errors.at(row.psnr);
        if shown.iter().all(|(other, _)| (other - y).abs() >= 12.0) {
            let words = match (row.all, row.layers) {
                (true, n) => format!("all {n}"),
                (false, 1) => "1 layer".to_owned(),
                (false, n) => n.to_string(),
            };
            shown.push((y, words));
        }
    }
    html! { @for (y, words) in &shown {
        line.grid x1=(RIGHT) x2=(RIGHT + 6.0) y1=(y) y2=(y) {}
        text x=(RIGHT + 10.0) y=(y + 4.0) { (words) }
    } }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::bench_example;

    /// A viewer of XML refuses all that a browser forgives in HTML.
    #[test]
    fn the_file_is_sound_xml() {
        let text = file(&bench_example());
        let mut open = Vec::new();
        for tag in text.split('<').skip(1) {
            let (tag, _) = tag.split_once('>').expect("a tag ends");
            let name = tag
                .split([' ', '/'])
                .find(|n| !n.is_empty())
                .expect("a name");
            match (tag.starts_with('/'), tag.ends_with('/')) {
                (true, _) => assert_eq!(open.pop(), Some(name), "closes what is open"),
                (false, true) => {}
                (false, false) => open.push(name),
            }
            let mut names: Vec<&str> = tag.split('"').step_by(2).map(str::trim).collect();
            names.retain(|n| n.ends_with('='));
            let all = names.len();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), all, "an attribute twice: <{tag}>");
        }
        assert_eq!(open, [""; 0], "all is closed");
        assert!(!text.contains("script>"), "no script: {text}");
    }

    #[test]
    fn a_point_for_each_row_and_a_line_for_each_leg() {
        let text = file(&bench_example());
        // Those of the legend as well.
        assert_eq!(text.matches("class=\"mark ").count(), 3 + 2, "{text}");
        assert_eq!(text.matches("<polyline").count(), 2, "{text}");
        assert!(!text.contains("NaN") && !text.contains("inf\""), "{text}");
    }
}
