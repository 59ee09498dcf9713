//! What a run writes: one CSV row for each step, leg and stage, and a page of Markdown.

use std::fmt::Write;
use std::io;
use std::path::{Path, PathBuf};

use super::extremes::Pages;
use super::judge::Wrong;
use super::measure::{Bound, Measured, bounded, exceeds};
use super::sweeps::Sweep;
use super::table::{Lines, Table};
use crate::report::RunInfo;
use crate::row::Row;
use crate::text::{count, markdown as escaped, quoted};

/// Files that a run wrote.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// For people.
    pub markdown: PathBuf,
    /// For programs.
    pub csv: PathBuf,
}

/// Both of what a run writes.
pub(super) fn pages(run: &RunInfo, sweeps: &[Sweep], all: &[Measured], wrong: &[Wrong]) -> Pages {
    Pages {
        page: markdown(run, sweeps, all, wrong),
        table: csv(all),
    }
}

/// Writes both, with the endings of their kinds after `stem`.
///
/// # Errors
/// A folder or file that cannot be written.
pub fn write(stem: &Path, pages: &Pages) -> io::Result<Written> {
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
    std::fs::write(&written.csv, &pages.table)?;
    std::fs::write(&written.markdown, &pages.page)?;
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
            let mut cells = vec![m.sweep.to_owned(), m.step.clone(), m.value.to_string()];
            cells.extend(of_row(row));
            cells.extend([
                optional(row.admitted_budget),
                n.vertices.to_string(),
                n.unbounded.to_string(),
                n.subnormal.to_string(),
                n.overflow.to_string(),
                row.skipped.clone().unwrap_or_default(),
            ]);
            text += &values(&cells);
        }
    }
    text
}

/// A line of values.
pub(super) fn values(cells: &[String]) -> String {
    let cells: Vec<_> = cells.iter().map(|cell| quoted(cell)).collect();
    cells.join(",") + "\n"
}

/// What every row says: `stage` to `admitted_share`.
pub(super) fn of_row(row: &Row) -> [String; 12] {
    let class = serde_json::to_string(&row.class).unwrap_or_default();
    [
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
    ]
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

/// How much was compared, and what does not hold; else that all is `sound`, in words.
pub(super) fn summary(
    run: &RunInfo,
    (steps, compared): (usize, u64),
    wrong: &[Wrong],
    sound: &str,
) -> String {
    let verdict = match wrong.len() {
        0 => sound.to_owned(),
        n => format!("{n} things do not hold:"),
    };
    let mut text = format!(
        "\n{steps} steps, {} items compared in {:.0} s. {verdict}\n",
        count(compared),
        run.seconds
    );
    for wrong in wrong {
        line(&mut text, format_args!("- {}", escaped(&wrong.to_string())));
    }
    text
}

fn markdown(run: &RunInfo, sweeps: &[Sweep], all: &[Measured], wrong: &[Wrong]) -> String {
    let mut text = preamble("Stability", run);
    let compared = all.iter().map(Measured::compared).sum();
    let sound = "Exact stages agree bit for bit at every step, and no error exceeds its bound.";
    text += &summary(run, (all.len(), compared), wrong, sound);
    text += &largest(all);
    for sweep in sweeps {
        let steps = all.iter().filter(|m| m.sweep == sweep.name);
        text += &section::<Table, _>(sweep, steps);
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

/// A sweep's table, of its own steps.
pub(super) fn section<'m, T: Lines<Measured: 'm>, S>(
    sweep: &Sweep<S>,
    steps: impl Iterator<Item = &'m T::Measured>,
) -> String {
    let mut text = format!("\n## {}: {}\n\n{}.\n\n", sweep.name, sweep.axis, T::ABOVE);
    let names = T::names();
    line(&mut text, format_args!("| {} |", names.join(" | ")));
    line(&mut text, format_args!("|{}", "---|".repeat(names.len())));
    let mut table = T::default();
    for measured in steps {
        let cells = table.cells(measured);
        let cells: Vec<String> = cells.iter().map(|cell| escaped(cell)).collect();
        line(&mut text, format_args!("| {} |", cells.join(" | ")));
    }
    for note in table.notes() {
        line(&mut text, format_args!("\n{}", escaped(&note)));
    }
    text
}

pub(super) fn line(text: &mut String, words: std::fmt::Arguments<'_>) {
    writeln!(text, "{words}").expect("memory takes all");
}
