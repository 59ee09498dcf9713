//! The rows of a scene, and the times of its stages.

use maud::{Markup, html};

use super::glossary::class_name;
use super::{SceneReport, sign, text, worst};
use crate::digest::{self, Times, column_order, leg_parts};
use crate::row::{Row, Verdict};
use crate::text::{clean, count, share, time};

/// Every comparison of the scene.
pub fn table(scene: &SceneReport) -> Markup {
    let mut pairs = digest::pairs(&scene.rows);
    pairs.sort_by(|x, y| column_order(x.a, x.b).cmp(&column_order(y.a, y.b)));
    let first = worst::first(&scene.rows);
    html! {
        @if !scene.rows.is_empty() {
            h4 { "Comparisons" }
            div.scroll tabindex="0" role="region" aria-label={"Comparisons of " (clean(&scene.name))} {
                table.rows {
                    thead { tr {
                        th scope="col" { "stage" } th scope="col" { "verdict" } th scope="col" { "class" }
                        th.n scope="col" { "compared" } th.n scope="col" { "differ" }
                        th scope="col" { "causes" }
                        th.n scope="col" { "not judged" } th.n scope="col" { "error / bound" }
                        th scope="col" { "remark" }
                    } }
                    @for pair in &pairs { tbody {
                        tr.pair { th colspan="9" scope="rowgroup" {
                            (text(pair.a)) " : " (text(pair.b))
                        } }
                        @for row in &pair.rows { (line(row, first.is_some_and(|f| std::ptr::eq(f, *row)))) }
                    } }
                }
            }
        }
    }
}

fn line(row: &Row, is_first: bool) -> Markup {
    let class = class_name(row.class);
    let bad = row.verdict() == Verdict::Diverge;
    html! {
        tr class=[bad.then_some(if is_first { "bad first" } else { "bad" })] {
            th scope="row" {
                @if is_first { span role="img" aria-label="first divergence: " { "▶ " } }
                (text(&row.stage))
            }
            td { (sign(row.verdict())) @if row.cached { " " span.tag { "cached" } } }
            td { a href={"#class-" (class)} { (class) } }
            td.n { (count(row.compared)) " " (text(&row.unit)) }
            td.n { (count(row.differ)) }
            td { (causes(row)) }
            td.n { (not_judged(row)) }
            td.n { @if let Some(ratio) = row.error_over_bound { (ratio_of(ratio)) } }
            td.remark {
                @if let Some(reason) = &row.skipped { "skipped: " (text(reason)) " " }
                @if row.compared == 0 && row.skipped.is_none() { "nothing compared. " }
                (text(&row.note))
            }
        }
    }
}

fn causes(row: &Row) -> Markup {
    html! {
        @for (i, (cause, n)) in row.causes.iter().enumerate() {
            @if i > 0 { ", " }
            span.cause { a href={"#cause-" (cause.name())} { (cause.name()) } " " (count(*n)) }
        }
        @if row.unexplained > 0 {
            @if !row.causes.is_empty() { ", " }
            strong.diverge { (count(row.unexplained)) " without a cause" }
        }
    }
}

fn not_judged(row: &Row) -> Markup {
    let part = row.admitted_share();
    html! {
        @if row.admitted > 0 || row.admitted_budget.is_some() {
            (count(row.admitted)) " (" (share(part))
            @if let Some(budget) = row.admitted_budget {
                " of " (share(budget)) " allowed"
                @if part > budget { ", " strong.diverge { "over budget" } }
            }
            ")"
        }
    }
}

fn ratio_of(ratio: f64) -> String {
    match ratio {
        0.0 => "0".to_owned(),
        _ if ratio < 0.001 => format!("{ratio:.1e}"),
        _ => format!("{ratio:.3}"),
    }
}

/// Time by stage and leg, with a bar for each against the longest of the scene.
pub fn times(scene: &SceneReport) -> Markup {
    let times = Times::of(&scene.rows);
    let all = times.stages.iter().flat_map(|(_, cells)| cells).flatten();
    let longest = all.copied().fold(0.0, f64::max);
    html! {
        @if !times.legs.is_empty() {
            h4 { "Times" }
            div.scroll tabindex="0" role="region" aria-label={"Times of " (clean(&scene.name))} {
                table.times {
                    thead { tr {
                        th scope="col" { "stage" }
                        @for leg in &times.legs { th.n scope="col" { (heading(leg)) } }
                    } }
                    tbody { @for (stage, cells) in &times.stages { tr {
                        th scope="row" { (text(stage)) }
                        @for cell in cells { td.n {
                            @if let Some(ms) = cell {
                                (time(*ms))
                                span.bar style={"width:" (percent(*ms, longest)) "%"} {}
                            }
                        } }
                    } } }
                    tfoot { tr {
                        th scope="row" { "together" }
                        @for leg in 0..times.legs.len() { td.n {
                            @if let Some(ms) = times.total(leg) { (time(ms)) }
                        } }
                    } }
                }
            }
        }
    }
}

/// A leg over its adapter and path, so that columns stay narrow.
fn heading(label: &str) -> Markup {
    let (leg, adapter, path) = leg_parts(label);
    html! {
        (text(leg))
        @for part in [adapter, path].into_iter().flatten() { br; span.path { (text(part)) } }
    }
}

fn percent(ms: f64, longest: f64) -> String {
    let part = if longest > 0.0 {
        100.0 * ms / longest
    } else {
        0.0
    };
    format!("{:.1}", part.clamp(0.0, 100.0))
}
