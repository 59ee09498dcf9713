//! The front: time against error, a panel for each scene, a line for each leg, or several.
//!
//! Right and down is worse. Time is logarithmic. Above [`ROUNDING`] decibels only
//! rounding is left, and such points, and exact ones, lie on one line at the top.
//! Lines differ in colour, and their points in shape.

mod abuffer;
mod axis;
mod bars;
mod mark;

use maud::{Markup, PreEscaped, html};

use super::Bench;
use crate::text::clean;
use axis::{Horizontal, Vertical};
pub(super) use bars::{Bar, Bars};
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
.front .b0 { fill: #a0a6ab; } .front .b1 { fill: #0b57a4; } .front .b2 { fill: #d98a3d; }
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
.front .b0 { fill: #6b7278; } .front .b1 { fill: #8cbcf0; } .front .b2 { fill: #f0a860; }
}
";

/// What a front shows.
pub(super) struct Plot {
    /// Above it.
    pub(super) title: String,
    /// For those who do not see it.
    pub(super) words: String,
    /// Under the title: when and where.
    pub(super) place: String,
    /// What a line of the legend each stands for; the numbers of [`Line::style`].
    pub(super) legend: Vec<String>,
    /// One below the other.
    pub(super) panels: Vec<Panel>,
    /// Below them.
    pub(super) bars: Vec<Bars>,
}

/// A scene.
pub(super) struct Panel {
    pub(super) heading: String,
    pub(super) lines: Vec<Line>,
    /// Names of errors, beside them; of those that would overlap the first is shown.
    pub(super) levels: Vec<(Option<f64>, String)>,
}

/// Points of a leg, in order: milliseconds, and decibels unless it is exact.
pub(super) struct Line {
    pub(super) style: usize,
    pub(super) points: Vec<(f64, Option<f64>)>,
}

/// A front by itself, as a file.
pub(super) fn alone(plot: &Plot) -> String {
    let space = "http://www.w3.org/2000/svg";
    format!("{}\n", front(plot, Some(space)).into_string())
}

/// The front of a run of `bench abuffer`, as a file.
pub fn file(bench: &Bench) -> String {
    alone(&abuffer::plot(bench))
}

/// The same as an element of a page, which knows what an SVG is.
pub fn element(bench: &Bench) -> Markup {
    front(&abuffer::plot(bench), None)
}

fn front(plot: &Plot, space: Option<&str>) -> Markup {
    let legend = LEGEND_LINE * plot.legend.len().div_ceil(LEGEND_COLUMNS) as f64;
    let top = 60.0 + legend;
    let end = top + PANEL * plot.panels.len() as f64;
    let height = end + plot.bars.iter().map(Bars::height).sum::<f64>();
    html! {
        svg.front xmlns=[space] role="img" viewBox=(format!("0 0 {WIDTH} {height}")) {
            title { (clean(&plot.words)) }
            style { (PreEscaped(STYLE)) }
            rect.ground width=(WIDTH) height=(height) {}
            text x="24" y="28" font-size="17" font-weight="600" { (plot.title) }
            text.soft x="24" y="46" { (clean(&plot.place)) }
            text.soft x=(RIGHT) y="46" text-anchor="end" {
                "exact*: equal, or unequal by rounding alone (above 100 dB)"
            }
            @for (at, leg) in plot.legend.iter().enumerate() { (entry(at, leg)) }
            @for (at, own) in plot.panels.iter().enumerate() {
                g transform=(format!("translate(0 {})", top + PANEL * at as f64)) { (panel(own)) }
            }
            @for (at, own) in plot.bars.iter().enumerate() {
                @let before: f64 = plot.bars[..at].iter().map(Bars::height).sum();
                g transform=(format!("translate(0 {})", end + before)) { (own.markup()) }
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

fn panel(panel: &Panel) -> Markup {
    let points = || panel.lines.iter().flat_map(|line| &line.points);
    let times = Horizontal::of(points().map(|(time, _)| *time), [LEFT, RIGHT]);
    let errors = Vertical::of(points().map(|(_, error)| *error), PLOT);
    let at = |(time, error): &(f64, Option<f64>)| [times.at(*time), errors.at(*error)];
    html! {
        text x="24" y="20" font-weight="600" { (clean(&panel.heading)) }
        text.soft x="24" y="40" { "PSNR, dB" }
        (errors.grid([LEFT, RIGHT]))
        (times.grid(PLOT))
        (levels(&panel.levels, &errors))
        @for line in &panel.lines {
            @let style = line.style % STYLES;
            @let points: Vec<String> = line.points.iter().map(at).map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
            polyline class=(format!("line s{style}")) points=(points.join(" ")) {}
            @for point in &line.points { (mark(style, at(point))) }
        }
    }
}

fn levels(named: &[(Option<f64>, String)], errors: &Vertical) -> Markup {
    let mut shown: Vec<(f64, &String)> = Vec::new();
    for (error, words) in named {
        let y = errors.at(*error);
        if shown.iter().all(|(other, _)| (other - y).abs() >= 12.0) {
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
