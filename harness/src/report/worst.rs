//! What to look at first: the first stage that diverges, and the worst pixels.

use maud::{Markup, html};

use super::{SceneReport, text};
use crate::digest::{self, column_order};
use crate::replay::worst::{Worst, WorstPixel};
use crate::row::{Row, Verdict};
use crate::text::{clean, count, plural};

/// Rows in the order in which stages depend on each other, with those that stand for a
/// whole leg before, and those that draw stages together behind.
const ORDER: [&str; 57] = [
    "leg",
    "all",
    "expect",
    "transform",
    "clip",
    "snap",
    "cover",
    "opaque",
    "overflow",
    "build",
    "sort",
    "resolve",
    "peel",
    "dual",
    "alpha",
    "weighted",
    "density",
    "defocus",
    "reduced",
    "bin",
    "jagged",
    "shade",
    "local",
    "linked",
    "bucket",
    "precalc",
    "rank",
    "packed",
    "regions",
    "ordered",
    "count",
    "scan",
    "fill",
    "link",
    "trace",
    "gbuffer",
    "rsm",
    "place",
    "direct",
    "gather",
    "block",
    "blur",
    "compose",
    "layers",
    "chain",
    "neighbours",
    "occlusion",
    "environment",
    "mirror",
    "primary",
    "intersect",
    "locate",
    "light",
    "reflect",
    "deposit",
    "end to end",
    "plan",
];

/// The row to begin with: of the first stage that diverges, in the first column.
pub fn first(rows: &[Row]) -> Option<&Row> {
    let stage = |row: &Row| ORDER.iter().position(|stage| *stage == row.stage);
    let diverging = rows.iter().filter(|r| r.verdict() == Verdict::Diverge);
    diverging.min_by(|x, y| {
        let stages = stage(x)
            .unwrap_or(ORDER.len())
            .cmp(&stage(y).unwrap_or(ORDER.len()));
        stages.then_with(|| column_order(&x.a, &x.b).cmp(&column_order(&y.a, &y.b)))
    })
}

/// Where it begins, in a sentence.
pub fn lead(scene: &SceneReport) -> Markup {
    let Some(row) = first(&scene.rows) else {
        return html! {};
    };
    let same = |r: &&Row| r.stage == row.stage && r.verdict() == Verdict::Diverge;
    let others = scene.rows.iter().filter(same).count() - 1;
    html! {
        p.lead {
            "Look first at stage " strong { (text(&row.stage)) } " of " strong { (text(&row.b)) }
            ": " (count(row.differ)) " of " (count(row.compared)) " " (text(&row.unit)) " differ"
            @for (i, (cause, n)) in digest::causes([row]).into_iter().enumerate() {
                (if i == 0 { "; " } else { ", " })
                a href={"#cause-" (cause.name())} { (cause.name()) } " " (count(n))
            }
            @if row.unexplained > 0 { "; " (count(row.unexplained)) " without a cause" }
            "."
            @if others > 0 { " The same stage diverges on " (plural(others as u64, "other leg")) "." }
            " Later stages inherit what it did."
            @if !row.note.is_empty() { br; span.soft { (text(&row.note)) } }
        }
    }
}

/// The pixels to look at, the worst first; places that a script makes buttons of.
pub fn table(worst: &Worst) -> Markup {
    html! {
        @if worst.all > 0 {
            h4 { "Worst pixels" }
            p.soft {
                (plural(worst.all, "pixel")) " differ"
                @if worst.all == 1 { "s" }
                @if (worst.pixels.len() as u64) < worst.all { ", of which these are the worst " (worst.pixels.len()) }
                ". Most items that differ first, over all stages and legs; then the farthest colour."
            }
            div.scroll.worst tabindex="0" role="region" aria-label="Worst pixels" {
                table {
                    thead { tr {
                        th scope="col" { "column, row" } th.n scope="col" { "items" }
                        th scope="col" { "causes" } th.n scope="col" { "colour off by" }
                        th scope="col" { "seen in" }
                    } }
                    tbody { @for pixel in &worst.pixels { (line(pixel)) } }
                }
            }
        }
    }
}

fn line(pixel: &WorstPixel) -> Markup {
    let [x, y] = pixel.at;
    let all = pixel
        .seen_by
        .iter()
        .map(|(stage, leg)| format!("{} of {}", clean(stage), clean(leg)));
    let all: Vec<String> = all.collect();
    let mut legs: Vec<(&str, u64)> = Vec::new();
    for (stage, _) in &pixel.seen_by {
        match legs.iter_mut().find(|(known, _)| known == stage) {
            Some((_, n)) => *n += 1,
            None => legs.push((stage, 1)),
        }
    }
    let stage = |(stage, n): (&str, u64)| format!("{} ({})", clean(stage), plural(n, "leg"));
    let stages: Vec<String> = legs.into_iter().map(stage).collect();
    html! {
        tr {
            td { span.pixel data-at={(x) "," (y)} { (x) ", " (y) } }
            td.n { (count(pixel.causes.values().sum())) }
            td { @for (i, (cause, n)) in pixel.causes.iter().enumerate() {
                @if i > 0 { ", " }
                a href={"#cause-" (cause.name())} { (cause.name()) } " " (count(*n))
            } }
            td.n { @if let Some(error) = pixel.error { (colour(error)) } }
            td title=(all.join("; ")) { (stages.join(", ")) }
        }
    }
}

fn colour(error: f32) -> String {
    match error {
        0.0 => "0".to_owned(),
        _ if error.is_infinite() => "not finite".to_owned(),
        _ if error < 0.001 => format!("{error:.1e}"),
        _ => format!("{error:.3}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::digest::tests::row;
    use crate::registry::stages;

    #[test]
    fn every_stage_has_its_turn() {
        let places: Vec<usize> = stages()
            .map(|s| ORDER.iter().position(|o| *o == s.name).expect("in order"))
            .collect();
        assert!(places.is_sorted(), "the registry's order: {places:?}");
    }

    #[test]
    fn the_first_stage_comes_before_the_first_leg() {
        let diverges = |stage, leg| Row {
            differ: 1,
            unexplained: 1,
            ..row("a/b", stage, "spec", leg)
        };
        let rows = [
            row("a/b", "cover", "spec", "gpu@a/compute"),
            diverges("sort", "gpu@a/compute"),
            diverges("build", "gpu@b/compute"),
            diverges("build", "gpu@a/fragment"),
        ];
        let first = first(&rows).expect("some diverge");
        assert_eq!(
            (first.stage.as_str(), first.b.as_str()),
            ("build", "gpu@a/fragment")
        );
        assert_eq!(super::first(&rows[..1]), None, "all agree");
    }
}
