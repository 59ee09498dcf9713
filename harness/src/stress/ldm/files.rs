//! What a run writes: one CSV row for each step, leg and stage, and a page of Markdown.

use super::super::extremes::Pages;
use super::super::files::{line, of_row, optional, preamble, section, summary, values};
use super::super::judge::Wrong;
use super::super::sweeps::Sweep;
use super::table::Table;
use super::{Bound, LdmShot, Measured};
use crate::report::RunInfo;
use crate::text::{count, markdown as escaped};

/// Both of what a run writes.
pub(super) fn pages(
    run: &RunInfo,
    sweeps: &[Sweep<LdmShot>],
    all: &[Measured],
    wrong: &[Wrong],
) -> Pages {
    Pages {
        page: markdown(run, sweeps, all, wrong),
        table: csv(all),
    }
}

/// Names of what is of a step as a whole.
const OF_STEP: [&str; 26] = [
    "points",
    "maps",
    "keys",
    "pixel_steps",
    "whole_rmse",
    "whole_max",
    "directions_rmse",
    "directions_max",
    "noise",
    "quantisation_rmse",
    "quantisation_max",
    "resolution_rmse",
    "resolution_max",
    "sides",
    "sides_certain",
    "key_over_bound",
    "distance_over_bound",
    "own_over_bound",
    "weight_in_band",
    "weight_beside",
    "weight_extra",
    "farthest_lost",
    "nearest_found",
    "own_pairs_steep",
    "own_pairs_met",
    "own_lost",
];

/// All rows; what is of a step stands in each of its rows.
pub(super) fn csv(all: &[Measured]) -> String {
    let mut text = format!(
        "sweep,step,value,stage,a,b,class,unit,compared,differ,unexplained,error,error_over_bound,\
         admitted,admitted_share,{},skipped,note\n",
        OF_STEP.join(",")
    );
    for m in all {
        let named = [m.sweep.to_owned(), m.step.clone(), m.value.to_string()];
        if let Some(refused) = &m.refused {
            let mut cells = named.to_vec();
            cells.resize(15 + OF_STEP.len(), String::new());
            cells.extend([format!("refused: {refused}"), String::new()]);
            text += &values(&cells);
        }
        for row in &m.rows {
            let mut cells = named.to_vec();
            cells.extend(of_row(row));
            cells.extend(of_step(m));
            cells.extend([row.skipped.clone().unwrap_or_default(), row.note.clone()]);
            text += &values(&cells);
        }
    }
    text
}

fn of_step(m: &Measured) -> [String; OF_STEP.len()] {
    let (p, f, a) = (&m.parts, &m.found, &m.alone);
    let [points, maps, keys] = m.counts.map(|n| n.to_string());
    let number = |n: f64| format!("{n:e}");
    let of_weight = |part: f64| number(part / f.weight.max(1.0));
    [
        points,
        maps,
        keys,
        number(m.pixel),
        number(p.whole.rmse),
        number(p.whole.most),
        number(p.directions.rmse),
        number(p.directions.most),
        number(p.noise),
        number(p.quantisation.rmse),
        number(p.quantisation.most),
        number(p.resolution.rmse),
        number(p.resolution.most),
        f.sides.to_string(),
        f.certain.to_string(),
        number(f.key),
        number(f.distance),
        number(f.own),
        of_weight(f.band),
        of_weight(f.beside),
        of_weight(f.extra),
        optional(f.farthest_lost),
        optional(f.nearest_found),
        a.steep.to_string(),
        a.met.to_string(),
        number(a.lost),
    ]
}

fn markdown(run: &RunInfo, sweeps: &[Sweep<LdmShot>], all: &[Measured], wrong: &[Wrong]) -> String {
    let mut text = preamble("Stability of layered depth maps", run);
    let compared = all.iter().map(Measured::compared).sum();
    let sound = "No leg disagrees, no error exceeds its bound, and points find what they must.";
    text += &summary(run, (all.len(), compared), wrong, sound);
    text += &largest(all);
    text += &found(all);
    for sweep in sweeps {
        let steps = all.iter().filter(|m| m.sweep == sweep.name);
        text += &section::<Table, _>(sweep, steps);
    }
    text
}

/// The largest error over each bound, and where.
pub(super) fn largest(all: &[Measured]) -> String {
    let mut text = "\n## Largest error over bound\n\n| what | leg | error over bound | at |\n|---|---|---|---|\n"
        .to_owned();
    for bound in Bound::ALL {
        let steps = all.iter().filter_map(|m| Some((m.worst(bound)?, m)));
        let worst = steps.reduce(|a, b| {
            if b.0.0 > a.0.0 || b.0.0.is_nan() {
                b
            } else {
                a
            }
        });
        if let Some(((ratio, leg), m)) = worst {
            line(
                &mut text,
                format_args!(
                    "| {} | {} | {ratio:.4} | {} {} |",
                    bound.name(),
                    escaped(leg),
                    m.sweep,
                    m.step
                ),
            );
        }
    }
    text
}

/// What points find, and their own surfaces, over all steps.
fn found(all: &[Measured]) -> String {
    let sum = |of: fn(&Measured) -> u64| all.iter().map(of).sum::<u64>();
    let steepest = all.iter().map(|m| m.alone.steepest).fold(0.0, f64::max);
    format!(
        "\nOf {} sides of points in maps, {} are certain from the scene as its files have it; {} are not as they \
         must be.\nOf {} points and maps with a face by itself, {} meet it though it is no steeper than 127 keys a \
         key (the steepest of these: {steepest:.2}); of the {} that are steeper, {} do.\n",
        count(sum(|m| m.found.sides)),
        count(sum(|m| m.found.certain)),
        count(sum(|m| m.found.wrong)),
        count(sum(|m| m.alone.pairs)),
        count(sum(|m| m.alone.wrong)),
        count(sum(|m| m.alone.steep)),
        count(sum(|m| m.alone.met)),
    )
}
