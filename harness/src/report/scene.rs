//! One scene: pictures, differences, rows, times, plan.

use maud::{Markup, html};

use super::{
    Difference, PlanLine, SceneReport, figures, rows, sign, text, verdict_name, viewer, worst,
};
use crate::row::Verdict;
use crate::text::{clean, time};

/// A section that opens and closes; open from the start if the scene diverges.
pub fn section(i: usize, scene: &SceneReport) -> Markup {
    let open = scene.verdict() == Verdict::Diverge;
    html! {
        details.scene id={"scene-" (i)} open[open]
            data-verdict=(verdict_name(scene.verdict())) data-name=(clean(&scene.name)) {
            summary {
                (sign(scene.verdict())) " "
                h3 { (text(&scene.name)) }
                @if !scene.purpose.is_empty() { span.purpose { (text(&scene.purpose)) } }
            }
            @if scene.rows.is_empty() {
                p.diverge { "Nothing was compared, and no reason is known." }
            }
            (worst::lead(scene))
            @for command in scene.again() {
                p.again { "Again: " code { (text(&command)) } }
            }
            (figures::grid(scene))
            (worst::table(&scene.worst))
            (viewer::viewer(scene))
            (viewer::held(scene))
            (rows::table(scene))
            @if !scene.differences.is_empty() {
                h4 { "First differences" }
                (differences(&scene.differences))
            }
            (rows::times(scene))
            (plan(&scene.plan))
        }
    }
}

/// Differences in words, with lists side by side.
pub fn differences(differences: &[Difference]) -> Markup {
    html! {
        @for difference in differences {
            div.difference {
                pre.words { (lines(&difference.words)) }
                @if !difference.sides.is_empty() {
                    div.sides { @for (leg, list) in &difference.sides {
                        div {
                            h5 { (text(leg)) " (" (list.len()) ")" }
                            ol start="0" { @for entry in list { li { (text(entry)) } } }
                        }
                    } }
                }
            }
        }
    }
}

/// Text from outside with its line breaks.
fn lines(words: &str) -> Markup {
    html! { @for (i, line) in words.lines().enumerate() {
        @if i > 0 { "\n" }
        (text(line))
    } }
}

fn plan(plan: &[PlanLine]) -> Markup {
    let saved: Vec<f64> = plan.iter().filter_map(|p| p.saved_ms).collect();
    let (legs, saved) = (saved.len(), saved.iter().sum::<f64>());
    html! {
        @if !plan.is_empty() {
            h4 { "Plan" @if saved > 0.0 {
                ": " (time(saved)) " saved"
                @if legs > 1 { " on " (legs) " GPU legs together" }
            } }
            div.scroll tabindex="0" role="region" aria-label="Plan" {
                table {
                    thead { tr {
                        th scope="col" { "pass" } th scope="col" { "" }
                        th scope="col" { "why" } th.n scope="col" { "saved" }
                    } }
                    tbody { @for line in plan { tr {
                        th scope="row" { (text(&line.pass)) }
                        td { @if line.runs { "runs" } @else { span.skipped { "– skipped" } } }
                        td { (text(&line.reason)) }
                        td.n { @if let Some(ms) = line.saved_ms { (time(ms)) } }
                    } } }
                }
            }
        }
    }
}
