//! What a run writes: one CSV row for each step, leg and stage, and a page of Markdown.

use std::fmt::Write;
use std::io;
use std::path::{Path, PathBuf};

use super::judge::Wrong;
use super::measure::{Bound, Measured, bounded, exceeds};
use super::sweeps::Sweep;
use super::table::{ABOVE, Table};
use crate::report::RunInfo;
use crate::row::Row;
use crate::text::{markdown as escaped, quoted};

/// Files that a run wrote.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// For people.
    pub markdown: PathBuf,
    /// For programs.
    pub csv: PathBuf,
}

/// Writes both, with the endings of their kinds after `stem`.
///
/// # Errors
/// A folder or file that cannot be written.
pub fn write(
    stem: &Path,
    run: &RunInfo,
    sweeps: &[Sweep],
    all: &[Measured],
    wrong: &[Wrong],
) -> io::Result<Written> {
    put(stem, &markdown(run, sweeps, all, wrong), &csv(all))
}

/// Writes what both hold.
pub(super) fn put(stem: &Path, markdown: &str, csv: &str) -> io::Result<Written> {
    if let Some(folder) = stem.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let ending = |ending: &str| {
        let mut name = stem.as_os_str().to_owned();
        name.push(ending);
        PathBuf::from(name)
    };
    let written = Written {
        markdown: ending(".md"),
        csv: ending(".csv"),
    };
    std::fs::write(&written.csv, csv)?;
    std::fs::write(&written.markdown, markdown)?;
    Ok(written)
}

/// All rows.
pub(super) fn csv(all: &[Measured]) -> String {
    let mut text = "sweep,step,value,stage,a,b,class,unit,compared,differ,unexplained,error,\
                    error_over_bound,admitted,admitted_share,admitted_budget,vertices,\
                    no_bound,subnormal,overflow,skipped\n"
        .to_owned();
    for m in all {
        for row in &m.rows {
            let n = m.numbers;
            let class = serde_json::to_string(&row.class).unwrap_or_default();
            let cells = [
                m.sweep.to_owned(),
                m.step.clone(),
                m.value.to_string(),
                row.stage.clone(),
                row.a.clone(),
                row.b.clone(),
                class.trim_matches('"').to_owned(),
                row.unit.clone(),
                row.compared.to_string(),
                row.differ.to_string(),
                row.unexplained.to_string(),
                optional(row.error),
                optional(row.error_over_bound),
                row.admitted.to_string(),
                row.admitted_share().to_string(),
                optional(row.admitted_budget),
                n.vertices.to_string(),
                n.unbounded.to_string(),
                n.subnormal.to_string(),
                n.overflow.to_string(),
                row.skipped.clone().unwrap_or_default(),
            ];
            let cells = cells.each_ref().map(|cell| quoted(cell));
            text += &(cells.join(",") + "\n");
        }
    }
    text
}

pub(super) fn optional(number: Option<f64>) -> String {
    number.map_or_else(String::new, |n| format!("{n:e}"))
}

/// Title, command, machine and adapters.
pub(super) fn preamble(title: &str, run: &RunInfo) -> String {
    let mut text = format!("# {title}, {}\n\n`{}`\n\n", run.date, run.command);
    let facts = run.machine.iter().chain(&run.versions);
    for (name, value) in facts {
        line(
            &mut text,
            format_args!("- {}: {}", escaped(name), escaped(value)),
        );
    }
    for adapter in &run.adapters {
        let facts = adapter.facts.iter().map(|(n, v)| format!("{n} {v}"));
        let facts = facts.collect::<Vec<_>>().join(", ");
        line(
            &mut text,
            format_args!("- {}: {}", escaped(&adapter.name), escaped(&facts)),
        );
    }
    text
}

fn markdown(run: &RunInfo, sweeps: &[Sweep], all: &[Measured], wrong: &[Wrong]) -> String {
    let mut text = preamble("Stability", run);
    let compared: u64 = all.iter().map(Measured::compared).sum();
    let (steps, seconds) = (all.len(), run.seconds);
    line(
        &mut text,
        format_args!(
            "\n{steps} steps, {compared} items compared in {seconds:.0} s. {}",
            match wrong.len() {
                0 =>
                    "Exact stages agree bit for bit at every step, and no error exceeds its bound."
                        .to_owned(),
                n => format!("{n} things do not hold:"),
            }
        ),
    );
    for wrong in wrong {
        line(&mut text, format_args!("- {}", escaped(&wrong.to_string())));
    }
    text += &largest(all);
    for sweep in sweeps {
        text += &section(sweep, all);
    }
    text
}

/// The largest error over bound of each stage on each adapter, and where.
pub(super) fn largest(all: &[Measured]) -> String {
    let mut text =
        "\n## Largest error over bound\n\n| stage | leg | error over bound | at | error |\n\
                    |---|---|---|---|---|\n"
            .to_owned();
    for stage in bounded() {
        let rows = all.iter().flat_map(|m| &m.rows);
        let mut legs: Vec<&str> = rows
            .filter(|row| stage.is_of(row))
            .map(|row| row.b.as_str())
            .collect();
        legs.sort_unstable();
        legs.dedup();
        for leg in legs {
            text += &largest_of(all, stage, leg);
        }
    }
    text
}

/// A line of that table, over all rows of the stage and leg; none if nothing was
/// compared.
fn largest_of(all: &[Measured], stage: Bound, leg: &str) -> String {
    let is_of = |row: &Row| stage.is_of(row) && row.b == leg;
    let found = all
        .iter()
        .filter_map(|m| m.worst_of(is_of).map(|(ratio, row)| (ratio, row, m)));
    let largest = found.reduce(|a, b| if exceeds(b.0, a.0) { b } else { a });
    let Some((ratio, row, m)) = largest else {
        return String::new();
    };
    format!(
        "| {} | {} | {ratio:.4} | {} {} | {} |\n",
        stage.name(),
        escaped(leg),
        m.sweep,
        m.step,
        row.error.map_or_else(String::new, |e| format!("{e:.3e}")),
    )
}

/// A sweep's table.
fn section(sweep: &Sweep, all: &[Measured]) -> String {
    let mut text = format!("\n## {}: {}\n\n{ABOVE}.\n\n", sweep.name, sweep.axis);
    let names = Table::names();
    line(&mut text, format_args!("| {} |", names.join(" | ")));
    line(&mut text, format_args!("|{}", "---|".repeat(names.len())));
    let mut table = Table::default();
    for m in all.iter().filter(|m| m.sweep == sweep.name) {
        let cells: Vec<String> = table.cells(m).iter().map(|cell| escaped(cell)).collect();
        let cells = cells.join(" | ");
        line(&mut text, format_args!("| {cells} |"));
    }
    for note in table.notes() {
        line(&mut text, format_args!("\n{}", escaped(&note)));
    }
    text
}

pub(super) fn line(text: &mut String, words: std::fmt::Arguments<'_>) {
    writeln!(text, "{words}").expect("memory takes all");
}
