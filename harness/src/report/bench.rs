//! Time against error: the front of the last run of `triptych bench`.

use maud::{Markup, html};

use super::text;
use crate::bench::{Bench, svg, table};

/// The front of a run, and what it was measured on.
pub fn section(bench: Option<&Bench>) -> Markup {
    html! {
        section aria-labelledby="bench" {
            h2 #bench { "Time against error" }
            p {
                "What the nearest 1, 2, 4, … layers of each pixel cost, and how far their picture "
                "is from that of all layers: PSNR of linear colours with peak 1. " em { "exact*" }
                ": no difference, or one of rounding alone. Each leg's faster method is shown. Below, where "
                "they were measured, the same lists in several layouts: how long building them takes, "
                "and what is made of them, with bytes of a fragment and of all buffers."
            }
            @match bench {
                None => p.skipped { "Not run yet: " code { "cargo triptych bench abuffer" } },
                Some(bench) => {
                    p { (text(&bench.date)) ", " (text(&bench.machine.cpu)) ", " (text(&bench.machine.version)) }
                    ul {
                        @for ceiling in &bench.ceilings { li { (text(&table::ceiling(ceiling))) } }
                        @for remark in &bench.remarks { li { (text(remark)) } }
                    }
                    div.scroll tabindex="0" role="region" aria-label="Front of time against error" {
                        (svg::element(bench))
                    }
                },
            }
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::bench::{Ceilings, Machine, Method, Row, Spread};

    /// Two legs of a scene with a hostile name, one of them at one layer only.
    pub fn example() -> Bench {
        let spread = |median| Spread::of([median]);
        let row = |leg: &str, layers, psnr, ms| Row {
            scene: "abuffer/<script>".into(),
            size: [64, 32],
            samples: 1,
            fragments: 1234,
            longest: 4,
            leg: leg.into(),
            clock: "host".into(),
            method: Method::Insertion,
            layers,
            all: layers == 4,
            runs: 1,
            time: spread(ms),
            frame: Some(spread(2.0 * ms)),
            ratio: spread(1.0),
            parts: vec![("build".into(), ms)],
            psnr,
            largest: 0.25,
            memory: 1 << 20,
            of_fragment: Some(32),
            bands: 1,
            fragments_per_second: 1e6,
            bound: "bytes".into(),
            bound_ms: 0.1,
            fraction: 0.1 / ms,
        };
        Bench {
            family: "abuffer".into(),
            date: "2026-01-02".into(),
            machine: Machine {
                slug: "a-board".into(),
                cpu: "a & b".into(),
                ..Machine::default()
            },
            runs: 1,
            ceilings: vec![Ceilings {
                name: "spec".into(),
                bytes: spread(1e9),
                atomics: None,
                clock: "host".into(),
            }],
            rows: vec![
                row("spec", 1, Some(20.0), 2.0),
                row("spec", 4, None, 3.0),
                row("gpu@\"<x>/compute", 1, Some(20.0), 0.5),
            ],
            remarks: vec!["not measured: <b>".into()],
        }
    }

    #[test]
    fn the_front_is_shown_and_names_are_escaped() {
        let html = section(Some(&example())).into_string();
        assert_eq!(html.matches("<polyline").count(), 2, "{html}");
        assert!(html.contains("gpu@&quot;&lt;x&gt;/compute"), "{html}");
        for hostile in ["<script>", "<b>", "a & b"] {
            assert!(!html.contains(hostile), "{hostile} in {html}");
        }
    }

    #[test]
    fn no_run_says_how_to_make_one() {
        let html = section(None).into_string();
        assert!(
            html.contains("<code>cargo triptych bench abuffer</code>"),
            "{html}"
        );
    }
}
