//! The table of scenes, with a filter.

use maud::{Markup, html};

use super::{ReportInput, SceneReport, sign, text, verdict_name};
use crate::digest::{self, Pair, column_order, leg_parts};
use crate::row::Verdict;
use crate::text::{clean, compact, count, share};

/// All scenes, one line each, one column per pair of legs; those of [`digest::PLAN`]
/// share one.
pub fn section(input: &ReportInput) -> Markup {
    let mut pairs: Vec<(&str, &str)> = Vec::new();
    for pair in input.scenes.iter().flat_map(|s| digest::columns(&s.rows)) {
        if !pairs.contains(&(pair.a, pair.b)) {
            pairs.push((pair.a, pair.b));
        }
    }
    pairs.sort_by(|x, y| column_order(x.0, x.1).cmp(&column_order(y.0, y.1)));
    html! {
        section aria-labelledby="scenes" {
            h2 #scenes { "Scenes" }
            (filter(input))
            div.scroll tabindex="0" role="region" aria-labelledby="scenes" {
                table.index {
                    thead { tr {
                        th scope="col" { "verdict" }
                        th scope="col" { "scene" }
                        @for (a, b) in &pairs { th.n scope="col" { (heading(a, b)) } }
                        th.n scope="col" { a href="#term-edge" { "edge" } }
                    } }
                    tbody {
                        @for (i, scene) in input.in_order() {
                            (line(i, scene, &pairs))
                        }
                    }
                }
            }
        }
    }
}

/// Shown by the script, which it needs.
fn filter(input: &ReportInput) -> Markup {
    let choices = [
        ("", "all", input.scenes.len()),
        ("diverge", "diverge", input.count(Verdict::Diverge)),
        ("agree", "agree", input.count(Verdict::Agree)),
        ("skipped", "skipped", input.count(Verdict::Skipped)),
    ];
    html! {
        form #filter hidden {
            fieldset {
                legend { "Show" }
                @for (value, name, n) in choices {
                    label {
                        input type="radio" name="verdict" value=(value) checked[value.is_empty()];
                        " " (name) " (" (n) ")"
                    }
                }
            }
            label { "Name contains " input type="search" name="name" autocomplete="off"; }
            output name="shown" aria-live="polite" {}
            @if input.count(Verdict::Diverge) > 0 {
                button type="button" data-key="n" hidden { "First divergence" }
            }
            button type="button" data-key="?" hidden { "Keys" }
        }
    }
}

fn heading(a: &str, b: &str) -> Markup {
    let (leg, adapter, path) = leg_parts(b);
    html! {
        span.against { (text(a)) " :" } br;
        (text(adapter.unwrap_or(leg)))
        @if let Some(path) = path { br; span.path { (text(path)) } }
    }
}

fn line(i: usize, scene: &SceneReport, pairs: &[(&str, &str)]) -> Markup {
    let own = digest::columns(&scene.rows);
    html! {
        tr data-verdict=(verdict_name(scene.verdict())) data-name=(clean(&scene.name)) {
            td { (sign(scene.verdict())) }
            th scope="row" {
                a href={"#scene-" (i)} { (text(&scene.name)) }
                @if scene.rows.iter().any(|r| r.cached) { " " span.tag { "cached" } }
            }
            @for (a, b) in pairs {
                td.n data-leg={(clean(a)) " : " (clean(b))} { @if let Some(pair) = own.iter().find(|p| p.a == *a && p.b == *b) { (cell(pair)) } }
            }
            td.n data-leg="edge" { @if let Some((part, over)) = digest::edge_share(&scene.rows) {
                (share(part))
                @if over { " " strong.diverge { "over budget" } }
            } }
        }
    }
}

fn cell(pair: &Pair<'_>) -> Markup {
    match pair.verdict() {
        Verdict::Agree => html! {
            span.agree role="img" aria-label="agrees," { "✓" } " "
            span title=(count(pair.compared())) { (compact(pair.compared())) }
        },
        Verdict::Diverge => html! {
            strong.diverge { span role="img" aria-label="diverges," { "✗" } " "
                @match pair.differ() {
                    0 => { "diverges" }
                    n => { (count(n)) " differ" }
                }
            }
        },
        Verdict::Skipped => {
            let skips = digest::skips(pair.rows.iter().copied());
            let reasons: Vec<_> = skips.iter().map(|(reason, _)| clean(reason)).collect();
            html! { span.skipped title=(reasons.join("; ")) { "– skipped" } }
        }
    }
}
