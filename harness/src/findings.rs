//! What drivers do wrong, each as a case that must be seen: `corpus/findings`.
//!
//! Our kernels avoid what drivers get wrong. A finding takes the avoidance away, as a
//! mutant takes away what makes a kernel right ([`crate::mutants`]), on a scene that shows
//! it. The drivers that it names must then diverge, in the stage and by the cause that it
//! states; once one agrees, it has been fixed, and the finding is to be removed. All
//! others must agree, unless a rule allows what they do.

use std::path::Path;

use serde::Deserialize;

use crate::corpus::{self, FINDINGS};
use crate::digest::leg_parts;
use crate::error::InputError;
use crate::mutants::{Cell, Mutant, Outcome};

/// Largest finding.toml in bytes.
const FILE_MAX: u64 = 1 << 16;

/// One thing that drivers do wrong.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Finding {
    /// Parts of names of the adapters that do it, in any case.
    pub drivers: Vec<String>,
    /// Whether a rule allows it, so that others may do it, too, and be right.
    #[serde(default)]
    pub allowed: bool,
    /// What they do, as `doctor` lists it.
    pub known: String,
    /// Why that follows, and how our kernels avoid it.
    pub reason: String,
    /// What is done differently, on which scene and paths, and the stage and cause that
    /// must show it.
    pub case: Mutant,
}

/// All findings below a corpus, by the name of their folder; none where there is no such
/// folder.
///
/// # Errors
/// A file that is missing or not as [`Finding`] says, in one line.
pub fn list(root: &Path) -> Result<Vec<Finding>, InputError> {
    let root = root.join(FINDINGS);
    if !root.is_dir() {
        return Ok(Vec::new());
    }
    let read = |name: &String| {
        let path = root.join(name).join("finding.toml");
        let bytes = crate::mesh::Intake::from_disk().read(&path, FILE_MAX)?;
        let text = String::from_utf8_lossy(&bytes);
        let parsed: Result<Finding, _> = toml::from_str(&text);
        let finding = parsed.map_err(|e| InputError::new(&path, e.message()))?;
        match finding.case.name == *name && finding.case.cause.is_some() {
            true => Ok(finding),
            false => Err(InputError::new(
                &path,
                format!("its case must be called {name}, and state a cause"),
            )),
        }
    };
    corpus::folders(&root)?.iter().map(read).collect()
}

impl Finding {
    /// Whether an adapter of this name is said to do it.
    pub fn concerns(&self, adapter: &str) -> bool {
        let adapter = adapter.to_lowercase();
        let mut drivers = self.drivers.iter();
        drivers.any(|driver| adapter.contains(&driver.to_lowercase()))
    }

    /// What is not as the finding says, a line for each leg.
    pub fn judge(&self, cells: &[Cell]) -> Vec<String> {
        cells.iter().filter_map(|cell| self.wrong(cell)).collect()
    }

    fn wrong(&self, cell: &Cell) -> Option<String> {
        let (_, adapter, _) = leg_parts(&cell.leg);
        let concerned = self.concerns(adapter.unwrap_or_default());
        let Mutant { name, stage, .. } = &self.case;
        let Cell { leg, note, .. } = cell;
        match (cell.outcome, concerned) {
            (Outcome::NotRun, _) | (Outcome::NotObservable, false) => None,
            (Outcome::NotObservable, true) => Some(format!(
                "{leg} does not show {name} any more: the driver has been fixed; remove the \
                 finding corpus/{FINDINGS}/{name}"
            )),
            (_, false) if self.allowed => None,
            (_, false) => Some(format!(
                "{leg} shows {name}, too, and is none of its drivers: {note}"
            )),
            (_, true) => {
                let cause = cell.unexplained == 0 && cell.causes.keys().eq(&self.case.cause);
                let alone = stage.as_ref().is_none_or(|s| cell.stages.iter().eq([s]));
                (!cause || !alone).then(|| {
                    let causes = cell.causes.keys().map(|cause| cause.name());
                    let causes: Vec<String> = causes.collect();
                    format!(
                        "{leg} shows {name} otherwise: {causes:?} in {:?}",
                        cell.stages
                    )
                })
            }
        }
    }
}

#[cfg(test)]
mod tests;
