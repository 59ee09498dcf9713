//! The kill matrix: what the harness finds where something is wrong.

use std::collections::BTreeMap;

use maud::{Markup, html};

use super::text;
use crate::digest::leg_parts;
use crate::json::MutantRun;
use crate::mutants::{Cell, Outcome, by_mutant, legs};
use crate::text::{clean, count};

/// One table for each run.
pub fn section(runs: &[MutantRun]) -> Markup {
    html! {
        section aria-labelledby="mutants" {
            h2 #mutants { "Mutants" }
            p {
                "Kernels with a named defect each, on a scene on which the shipped ones agree. Killed by "
                em { "result" } ": some stage gives another value. By " em { "structure" }
                ": a certificate of lists, counter or passes is broken. " em { "Not seen" }
                ": not observable on this driver, which proves nothing."
            }
            @if runs.is_empty() {
                p.skipped { "Not run yet: " code { "cargo triptych mutants" } }
            }
            @for run in runs { (table(run)) }
        }
    }
}

fn table(run: &MutantRun) -> Markup {
    let legs = legs(&run.cells);
    html! {
        h3 { (text(&run.matrix.date)) ": " (text(&run.matrix.headline())) }
        @if !run.matrix.is_current() {
            p.diverge { "Of other kernels or mutants than this program's: " code { "cargo triptych mutants" } }
        }
        div.scroll tabindex="0" role="region" aria-label="Kill matrix" {
            table {
                thead { tr {
                    th scope="col" { "mutant" } th scope="col" { "scene" }
                    @for leg in &legs { th scope="col" { (heading(leg)) } }
                    th scope="col" { "causes" }
                } }
                tbody { @for (name, cells) in by_mutant(&run.cells) { (line(name, &cells, &legs)) } }
            }
        }
    }
}

fn heading(label: &str) -> Markup {
    let (leg, adapter, path) = leg_parts(label);
    html! {
        (text(adapter.unwrap_or(leg)))
        @if let Some(path) = path { br; span.path { (text(path)) } }
    }
}

fn line(name: &str, cells: &[&Cell], legs: &[&str]) -> Markup {
    let of = |leg: &str| cells.iter().find(|c| c.leg == leg).copied();
    let absent = of("");
    let dead = cells.iter().any(|c| c.outcome.kills());
    let bad = absent.is_none() && !dead;
    let defect = cells.first().map_or("", |c| c.defect.as_str());
    let scene = cells.first().map_or("", |c| c.scene.as_str());
    html! {
        tr class=[bad.then_some("bad")] {
            th scope="row" { (text(name)) br; span.path { (text(defect)) } }
            td { (text(scene)) }
            @if let Some(cell) = absent {
                td colspan=(legs.len() + 1) { span.skipped { "absent: " (text(&cell.note)) } }
            } @else {
                @for leg in legs { td { @if let Some(cell) = of(leg) { (outcome(cell)) } } }
                td { (causes(cells)) @if bad { strong.diverge { "survives" } } }
            }
        }
    }
}

fn outcome(cell: &Cell) -> Markup {
    let class = match cell.outcome {
        Outcome::Result | Outcome::Structure => "agree",
        Outcome::NotObservable | Outcome::NotRun => "skipped",
    };
    html! { span class=(class) title=(clean(&cell.note)) { (cell.outcome.word()) } }
}

/// The most of each cause that a leg reported.
fn causes(cells: &[&Cell]) -> Markup {
    let mut most = BTreeMap::new();
    for (cause, n) in cells.iter().flat_map(|c| &c.causes) {
        let known = most.entry(*cause).or_insert(0);
        *known = n.max(known).to_owned();
    }
    html! { @for (i, (cause, n)) in most.iter().enumerate() {
        @if i > 0 { ", " }
        span.cause { a href={"#cause-" (cause.name())} { (cause.name()) } " " (count(*n)) }
    } }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::cause::Cause;
    use crate::mutants::Matrix;

    /// One that is killed, one that survives, and one that is absent, with a hostile note.
    pub fn example() -> MutantRun {
        let cell = |mutant: &str, leg: &str, outcome| Cell {
            mutant: mutant.into(),
            defect: "what is <wrong>".into(),
            scene: "abuffer/quads".into(),
            leg: leg.into(),
            outcome,
            causes: [(Cause::Cycle, 12)].into(),
            unexplained: 0,
            stages: [].into(),
            note: "\"<script>".into(),
        };
        let leg = "gpu@llvmpipe/compute";
        let cells = vec![
            cell("dead", leg, Outcome::Structure),
            cell("alive", leg, Outcome::NotObservable),
            cell("absent", "", Outcome::NotRun),
        ];
        MutantRun {
            matrix: Matrix::of(&cells, 3.0, "2026-01-02".into()),
            cells,
        }
    }

    #[test]
    fn a_survivor_and_old_kernels_stand_out() {
        let mut run = example();
        let html = section(std::slice::from_ref(&run)).into_string();
        assert_eq!(html.matches("survives</strong>").count(), 1, "{html}");
        assert_eq!(html.matches("absent: ").count(), 1, "{html}");
        assert!(html.contains("title=\"&quot;&lt;script&gt;\""), "{html}");
        assert!(!html.contains("Of other kernels"), "{html}");
        run.matrix.kernels = "others".into();
        let html = section(&[run]).into_string();
        assert!(html.contains("Of other kernels"), "{html}");
    }

    #[test]
    fn no_run_says_how_to_make_one() {
        let html = section(&[]).into_string();
        assert!(
            html.contains("<code>cargo triptych mutants</code>"),
            "{html}"
        );
    }
}
