//! Times as bars, each of several parts: what lists cost in one layout and another.

use maud::{Markup, html};

use crate::text::clean;

/// What the parts of a bar are, from the left.
const PARTS: [&str; 3] = ["opaque surfaces", "lists built", "ordered and blended"];

/// A scene.
pub(in crate::bench) struct Bars {
    pub(in crate::bench) heading: String,
    /// Legs, each with its bars, of which the longest fills the width.
    pub(in crate::bench) legs: Vec<(String, Vec<Bar>)>,
}

/// A bar.
pub(in crate::bench) struct Bar {
    pub(in crate::bench) name: String,
    /// Milliseconds of [`PARTS`].
    pub(in crate::bench) parts: [f64; PARTS.len()],
    /// Beside it.
    pub(in crate::bench) words: String,
}

const LEFT: f64 = 132.0;
const WIDTH: f64 = 470.0;
const TOP: f64 = 52.0;
const LINE: f64 = 18.0;
const THICK: f64 = 12.0;

impl Bars {
    /// Pixels from top to bottom.
    pub(super) fn height(&self) -> f64 {
        let lines: usize = self.legs.iter().map(|(_, bars)| bars.len() + 1).sum();
        TOP + LINE * lines as f64 + 24.0
    }

    pub(super) fn markup(&self) -> Markup {
        // Where a leg begins: below all lines of those before it.
        let lines = |at: usize| self.legs[..at].iter().map(|(_, bars)| bars.len() + 1);
        let top = |at| TOP + LINE * lines(at).sum::<usize>() as f64;
        html! {
            text x="24" y="20" font-weight="600" { (clean(&self.heading)) }
            @for (at, part) in PARTS.iter().enumerate() {
                @let x = LEFT + 160.0 * at as f64;
                rect class=(format!("b{at}")) x=(x) y="29" width="12" height="12" {}
                text.soft x=(x + 18.0) y="39" { (part) }
            }
            text.soft x=(LEFT + 160.0 * PARTS.len() as f64) y="39" { "each leg at a scale of its own" }
            @for (number, (leg, bars)) in self.legs.iter().enumerate() {
                @let most = bars.iter().map(Bar::sum).fold(f64::MIN_POSITIVE, f64::max);
                text.soft x="24" y=(top(number) + 13.0) { (clean(leg)) }
                @for (at, bar) in bars.iter().enumerate() {
                    (bar.markup(top(number) + LINE * (at + 1) as f64, WIDTH / most))
                }
            }
        }
    }
}

impl Bar {
    fn sum(&self) -> f64 {
        self.parts.iter().sum()
    }

    /// At this height, with so many pixels to a millisecond.
    fn markup(&self, y: f64, scale: f64) -> Markup {
        let before = |at: usize| self.parts[..at].iter().sum::<f64>();
        html! {
            text x=(LEFT - 10.0) y=(y + 11.0) text-anchor="end" { (self.name) }
            @for (at, ms) in self.parts.iter().enumerate() {
                @let x = format!("{:.1}", LEFT + scale * before(at));
                rect class=(format!("b{at}")) x=(x) y=(y) width=(format!("{:.1}", scale * ms)) height=(THICK) {}
            }
            text x=(format!("{:.1}", LEFT + scale * self.sum() + 8.0)) y=(y + 11.0) { (self.words) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_lie_end_to_end_and_the_longest_fills_the_width() {
        let bar = |parts| Bar {
            name: "x".to_owned(),
            parts,
            words: String::new(),
        };
        let bars = Bars {
            heading: "a < b".to_owned(),
            legs: vec![
                (
                    "leg".to_owned(),
                    vec![bar([1.0, 2.0, 1.0]), bar([0.0, 1.0, 1.0])],
                ),
                ("slow".to_owned(), vec![bar([0.0, 900.0, 0.0])]),
            ],
        };
        let text = bars.markup().into_string();
        for (class, x, width) in [
            ("b1", 249.5, 235.0),
            ("b2", 484.5, 117.5),
            ("b2", 249.5, 117.5),
            ("b1", 132.0, 470.0),
        ] {
            let own = format!("class=\"{class}\" x=\"{x:.1}\"");
            let wide = format!("width=\"{width:.1}\"");
            let found = text
                .split("<rect ")
                .find(|tag| tag.contains(&own) && tag.contains(&wide));
            assert!(found.is_some(), "{own} {wide} in {text}");
        }
        assert!(text.contains("a &lt; b"), "{text}");
        assert!((bars.height() - (52.0 + 90.0 + 24.0)).abs() < 1e-9);
    }
}
