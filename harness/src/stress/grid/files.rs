//! What a run writes: one CSV row for each step, leg and stage, and a page of Markdown.

use super::super::extremes::Pages;
use super::super::files::{of_row, optional, preamble, section, summary, values};
use super::super::judge::Wrong;
use super::super::measure::exceeds;
use super::super::sweeps::Sweep;
use super::table::Table;
use super::{GridShot, Measured};
use crate::report::RunInfo;
use crate::row::{Class, Row};
use crate::text::{count, markdown as escaped, share};

/// Both of what a run writes.
pub(super) fn pages(
    run: &RunInfo,
    sweeps: &[Sweep<GridShot>],
    all: &[Measured],
    wrong: &[Wrong],
) -> Pages {
    Pages {
        page: markdown(run, sweeps, all, wrong),
        table: csv(all),
    }
}

/// All rows; those of what the plan skipped stand before what came of it all the same.
pub(super) fn csv(all: &[Measured]) -> String {
    let mut text = "sweep,step,value,stage,a,b,class,unit,compared,differ,unexplained,error,\
                    error_over_bound,admitted,admitted_share,cells_x,cells_y,cells_z,longest_list,\
                    walk,walk_bound,cells_passed,steps_with_bricks,ms_a,ms_b,skipped,note\n"
        .to_owned();
    for m in all {
        if let Some(refused) = &m.refused {
            let mut cells = vec![m.sweep.to_owned(), m.step.clone(), m.value.to_string()];
            cells.resize(25, String::new());
            cells.extend([format!("refused: {refused}"), String::new()]);
            text += &values(&cells);
        }
        for row in m.skipped.iter().chain(&m.rows) {
            text += &values(&cells_of(m, row));
        }
    }
    text
}

fn cells_of(m: &Measured, row: &Row) -> Vec<String> {
    let mut cells = vec![m.sweep.to_owned(), m.step.clone(), m.value.to_string()];
    cells.extend(of_row(row));
    cells.extend(m.cells.map(|cells| cells.to_string()));
    cells.extend([
        m.list.to_string(),
        m.walks.longest.to_string(),
        m.walks.bound.to_string(),
        m.walks.cells.to_string(),
        m.walks.steps.to_string(),
        optional(row.ms_a),
        optional(row.ms_b),
        row.skipped.clone().unwrap_or_default(),
        row.note.clone(),
    ]);
    cells
}

fn markdown(
    run: &RunInfo,
    sweeps: &[Sweep<GridShot>],
    all: &[Measured],
    wrong: &[Wrong],
) -> String {
    let mut text = preamble("Stability of grids and rays", run);
    let compared = all.iter().map(Measured::compared).sum();
    let sound =
        "No leg disagrees, no error exceeds its bound, and no ray walks further than it may.";
    text += &summary(run, (all.len(), compared), wrong, sound);
    text += &legs(all);
    text += &walks(all);
    for sweep in sweeps {
        let steps = all.iter().filter(|m| m.sweep == sweep.name);
        text += &section::<Table, _>(sweep, steps);
    }
    text
}

/// What each leg was asked, and what came of it.
pub(super) fn legs(all: &[Measured]) -> String {
    let mut text = "\n## Legs\n\nRays over all steps, each query on its own; the spec is held against every \
                    triangle of a scene, without a grid.\nErrors are of the times of closest hits, in \
                    lengths of the ray's direction.\n\n\
                    | leg | rays compared | disagree | error over bound | at | error | class edge |\n\
                    |---|---|---|---|---|---|---|\n"
        .to_owned();
    let mut legs: Vec<&str> = Vec::new();
    for row in all.iter().flat_map(|m| &m.rows).filter(|row| of_rays(row)) {
        if !legs.contains(&row.b.as_str()) {
            legs.push(&row.b);
        }
    }
    for leg in legs {
        text += &of_leg(all, leg);
    }
    text
}

/// Whether a row is about rays, and not about lists.
fn of_rays(row: &Row) -> bool {
    row.unit == "rays" && row.skipped.is_none()
}

fn of_leg(all: &[Measured], leg: &str) -> String {
    let is_of = |row: &&Row| row.b == leg && of_rays(row);
    let rows = || all.iter().flat_map(|m| &m.rows).filter(is_of);
    let sum = |of: fn(&Row) -> u64| rows().map(of).sum::<u64>();
    let found = all.iter().filter_map(|m| {
        let (ratio, row) = m.worst_of(|row| row.b == leg)?;
        Some((ratio, row, m))
    });
    let worst = found.reduce(|a, b| if exceeds(b.0, a.0) { b } else { a });
    let [ratio, at, error] = worst.map_or_else(
        || ["–"; 3].map(str::to_owned),
        |(ratio, row, m)| {
            let error = row.error.map_or_else(String::new, |e| format!("{e:.3e}"));
            [
                format!("{ratio:.4}"),
                format!("{} {}", m.sweep, m.step),
                error,
            ]
        },
    );
    // What is wholly in class edge is skipped, and in the share all the same.
    let votes = all.iter().flat_map(|m| &m.rows);
    let votes = votes.filter(|row| row.b == leg && row.class == Class::Vote);
    let [edge, asked] = votes.fold([0, 0], |[edge, asked], row| {
        [edge + row.admitted, asked + row.compared.max(row.admitted)]
    });
    let edge = match asked {
        0 => "–".to_owned(),
        _ => share(edge as f64 / asked as f64),
    };
    let name = match leg {
        super::EVERY => "spec".to_owned(),
        leg => escaped(leg),
    };
    format!(
        "| {name} | {} | {} | {ratio} | {at} | {error} | {edge} |\n",
        count(sum(|row| row.compared)),
        count(sum(|row| row.differ)),
    )
}

/// How far rays walk, and what is saved.
fn walks(all: &[Measured]) -> String {
    // Of walks that are equally near to it, the one with more steps to go wrong.
    let nearness = |m: &Measured| (m.walks.share(), m.walks.bound);
    let steps = all.iter();
    let longest = steps.reduce(|a, b| if nearness(b) > nearness(a) { b } else { a });
    let Some(longest) = longest else {
        return String::new();
    };
    let [cells, steps] = all
        .iter()
        .fold([0, 0], |[c, s], m| [c + m.walks.cells, s + m.walks.steps]);
    let walks = &longest.walks;
    let mut text = format!(
        "\nThe longest walk over its bound: {} of {} steps, {:.3}, at {} {}.\n\
         Until their closest hit is certain, rays pass {} cells; with empty bricks in one step each, {} steps \
         ({} saved).\n",
        walks.longest,
        walks.bound,
        walks.share(),
        longest.sweep,
        longest.step,
        count(cells),
        count(steps),
        share(1.0 - steps as f64 / cells.max(1) as f64),
    );
    for m in all {
        if let Some(saved) = m.saved() {
            text += &format!(
                "At {} {} the plan skips {} passes on all legs; run all the same they take {:.1} ms, and no ray \
                 meets anything.\n",
                m.sweep, m.step, saved.passes, saved.ms
            );
        }
    }
    text
}
