//! The kill matrix: mutant by scene by leg.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::Mutant;
use crate::cause::Cause;
use crate::row::{Row, Verdict};

/// What a leg made of a mutant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// Killed: some stage gives another value than the spec.
    Result,
    /// Killed: a certificate of lists, counter or passes is broken.
    Structure,
    /// Everything agrees; that proves nothing.
    NotObservable,
    /// The leg cannot run it, or there is no such code to break.
    NotRun,
}

/// One mutant on one leg. Serialised as one JSON line; the field names are part of the
/// interface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// What the mutant is called.
    pub mutant: String,
    /// What is wrong with it, in words.
    pub defect: String,
    /// The scene that it ran on; empty if it never did.
    pub scene: String,
    /// The leg, such as `gpu@llvmpipe/compute`; empty if it never ran.
    pub leg: String,
    /// What came of it.
    pub outcome: Outcome,
    /// Causes that were reported, and how many of each.
    pub causes: BTreeMap<Cause, u64>,
    /// Items that differ without a cause.
    pub unexplained: u64,
    /// Stages whose rows diverge.
    pub stages: BTreeSet<String>,
    /// The first difference, or why it was not run.
    pub note: String,
}

/// The last JSON line of a run of mutants.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Matrix {
    /// Mutants that ran.
    pub mutants: u64,
    /// Of these, killed on some leg.
    pub killed: u64,
    /// Mutants for which there is no code to break.
    pub absent: u64,
    /// Cells above this line since the last such line.
    pub cells: u64,
    /// Wall time of the run.
    pub seconds: f64,
    /// Day of the run, year-month-day.
    pub date: String,
    /// SHA-256 of kernels and mutants.
    pub kernels: String,
}

impl Outcome {
    /// How a cause kills.
    pub fn of(cause: Cause) -> Self {
        match cause {
            Cause::Duplicate
            | Cause::LostNode
            | Cause::CorruptLink
            | Cause::Cycle
            | Cause::Overflow
            | Cause::StalePass => Self::Structure,
            _ => Self::Result,
        }
    }

    /// Whether the mutant is dead.
    pub fn kills(self) -> bool {
        matches!(self, Self::Result | Self::Structure)
    }

    /// In a column of a table.
    pub fn word(self) -> &'static str {
        match self {
            Self::Result => "result",
            Self::Structure => "structure",
            Self::NotObservable => "not seen",
            Self::NotRun => "–",
        }
    }
}

impl Cell {
    /// A cell of a mutant that has not run.
    pub fn blank(mutant: &Mutant, leg: String, note: String) -> Self {
        Self {
            mutant: mutant.name.clone(),
            defect: mutant.defect.clone(),
            scene: mutant.scene.clone(),
            leg,
            outcome: Outcome::NotRun,
            causes: BTreeMap::new(),
            unexplained: 0,
            stages: BTreeSet::new(),
            note,
        }
    }

    /// What a leg's rows come to.
    ///
    /// # Errors
    /// Rows that compared nothing at all: neither killed nor agreed.
    pub fn of(mutant: &Mutant, leg: String, rows: &[Row]) -> Result<Self, String> {
        let mut cell = Self::blank(mutant, leg, String::new());
        for row in rows.iter().filter(|r| r.verdict() == Verdict::Diverge) {
            cell.unexplained += row.unexplained;
            cell.stages.insert(row.stage.clone());
            for (cause, count) in &row.causes {
                *cell.causes.entry(*cause).or_default() += count;
            }
            if cell.note.is_empty() {
                cell.note = format!("{}: {}", row.stage, row.note);
            }
        }
        let diverges = rows.iter().any(|r| r.verdict() == Verdict::Diverge);
        let agrees = rows.iter().any(|r| r.verdict() == Verdict::Agree);
        let structure = |cause: &Cause| Outcome::of(*cause) == Outcome::Structure;
        cell.outcome = match (diverges, agrees) {
            (true, _) if cell.causes.keys().any(structure) => Outcome::Structure,
            (true, _) => Outcome::Result,
            (false, true) => Outcome::NotObservable,
            (false, false) => return Err(format!("{}: nothing was compared", cell.leg)),
        };
        Ok(cell)
    }
}

impl Mutant {
    /// Whether its cells are what the table says.
    ///
    /// # Errors
    /// One line for each that is not.
    pub fn judge(&self, cells: &[Cell]) -> Result<(), String> {
        let mut wrong = Vec::new();
        if self.absent.is_none() && !cells.iter().any(|c| c.outcome.kills()) {
            wrong.push(format!("{} survives: {}", self.name, self.defect));
        }
        for cell in cells {
            let Cell {
                leg, outcome, note, ..
            } = cell;
            if *outcome == Outcome::NotObservable && !self.racy {
                wrong.push(format!("{leg} does not see {}", self.name));
            }
            if !outcome.kills() {
                continue;
            }
            let found: Vec<String> = cell
                .causes
                .iter()
                .map(|(c, n)| format!("{} {n}", c.name()))
                .collect();
            let found = format!(
                "{}, {} unexplained; {note}",
                found.join(", "),
                cell.unexplained
            );
            if let Some(cause) = self.cause
                && (cell.unexplained > 0 || !cell.causes.keys().eq([&cause]))
            {
                wrong.push(format!("{leg}: not exactly {}: {found}", cause.name()));
            } else if let Some(stage) = &self.stage
                && !cell.stages.iter().eq([stage])
            {
                wrong.push(format!("{leg}: not in {stage} alone: {:?}", cell.stages));
            } else if self.expected().is_some_and(|e| e != *outcome) {
                wrong.push(format!("{leg}: killed by {}: {found}", outcome.word()));
            }
        }
        match wrong.is_empty() {
            true => Ok(()),
            false => Err(wrong.join("\n")),
        }
    }
}

impl Matrix {
    /// The end of a run.
    pub fn of(cells: &[Cell], seconds: f64, date: String) -> Self {
        let names = |wanted: &dyn Fn(&&Cell) -> bool| {
            let names: BTreeSet<&str> = cells
                .iter()
                .filter(wanted)
                .map(|c| c.mutant.as_str())
                .collect();
            names.len() as u64
        };
        Self {
            mutants: names(&|c| !c.leg.is_empty()),
            killed: names(&|c| c.outcome.kills()),
            absent: names(&|c| c.leg.is_empty()),
            cells: cells.len() as u64,
            seconds,
            date,
            kernels: super::table::digest(),
        }
    }

    /// Whether the kernels and mutants of this binary are those of the run.
    pub fn is_current(&self) -> bool {
        self.kernels == super::table::digest()
    }
}

/// The legs of cells, in order.
pub fn legs(cells: &[Cell]) -> Vec<&str> {
    let legs: BTreeSet<&str> = cells.iter().map(|c| c.leg.as_str()).collect();
    legs.into_iter().filter(|leg| !leg.is_empty()).collect()
}

/// Cells by mutant, in the order in which they came.
pub fn by_mutant(cells: &[Cell]) -> Vec<(&str, Vec<&Cell>)> {
    let mut mutants: Vec<(&str, Vec<&Cell>)> = Vec::new();
    for cell in cells {
        match mutants.iter_mut().find(|(name, _)| *name == cell.mutant) {
            Some((_, of)) => of.push(cell),
            None => mutants.push((&cell.mutant, vec![cell])),
        }
    }
    mutants
}

#[cfg(test)]
mod tests;
