//! A sweep as a table: a line for each step, and what its notes stand for.

use super::measure::{Bound, Measured, bounded};
use super::notes::Notes;
use crate::text::{compact, share};

/// Columns, and how wide they are on a terminal.
const COLUMNS: [(&str, usize); 15] = [
    ("step", 8),
    ("compared", 9),
    ("transform", 10),
    ("clip", 8),
    ("snap", 8),
    ("resolve", 8),
    ("embree", 8),
    ("world", 8),
    ("worst", 10),
    ("edge", 9),
    ("world edge", 11),
    ("unjudged", 9),
    ("no bound", 9),
    ("subnormal", 10),
    ("overflow", 9),
];

/// Above the numbers: whose they are.
const ABOVE: &str = "error over bound, the largest of all legs, by stage, Embree's in screen and in world space; \
     share of Embree's pairs in class edge, in both; largest share unjudged; vertices";

/// A sweep as a table.
pub trait Lines: Default {
    /// What came of a step.
    type Measured;
    /// Columns, and how wide they are on a terminal; what was skipped follows them.
    const COLUMNS: &'static [(&'static str, usize)];
    /// Above the numbers: what they are.
    const ABOVE: &'static str;

    /// The cells of a step.
    fn cells(&mut self, measured: &Self::Measured) -> Vec<String>;

    /// What the marks of skipped rows stand for, and what else there is to say.
    fn notes(&self) -> Vec<String>;

    /// Names of the columns.
    fn names() -> Vec<&'static str> {
        let names = Self::COLUMNS.iter().map(|(name, _)| *name);
        names.chain(["skipped"]).collect()
    }

    /// A line on a terminal.
    fn line(cells: &[impl AsRef<str>]) -> String {
        laid_out(Self::COLUMNS, cells)
    }
}

/// Lines of one sweep, as they come.
#[derive(Default)]
pub struct Table {
    notes: Notes,
}

impl Lines for Table {
    type Measured = Measured;
    const COLUMNS: &'static [(&'static str, usize)] = &COLUMNS;
    const ABOVE: &'static str = ABOVE;

    fn cells(&mut self, m: &Measured) -> Vec<String> {
        let mut cells = vec![m.step.clone(), compact(m.compared())];
        let worst = bounded().map(|stage| (stage, m.worst(stage).map(|(ratio, _)| ratio)));
        cells.extend(worst.iter().map(|(_, ratio)| ratio_of(*ratio)));
        let largest = worst
            .iter()
            .filter_map(|(stage, ratio)| Some((*stage, (*ratio)?)));
        let largest = largest.reduce(|a, b| if b.1 > a.1 { b } else { a });
        let name = |(stage, _): (Bound, f64)| stage.name().to_owned();
        cells.push(largest.map_or_else(dash, name));
        cells.extend(
            [Bound::Embree, Bound::World].map(|vote| m.edge(vote).map_or_else(dash, share)),
        );
        cells.push(share(m.unjudged()));
        let n = m.numbers;
        cells.extend([n.unbounded, n.subnormal, n.overflow].map(|count| {
            let part = count as f64 / n.vertices.max(1) as f64;
            share(part)
        }));
        cells.push(self.notes.marks(m.skipped()));
        cells
    }

    fn notes(&self) -> Vec<String> {
        self.notes.lines().collect()
    }
}

/// Cells in columns of these widths, and whatever follows them.
fn laid_out(columns: &[(&str, usize)], cells: &[impl AsRef<str>]) -> String {
    let widths = columns.iter().map(|(_, width)| *width).chain([0]);
    let cell = |(cell, width): (&_, usize)| match width {
        0 => format!("  {}", AsRef::<str>::as_ref(cell)),
        _ => format!("{:>width$}", AsRef::<str>::as_ref(cell)),
    };
    let line: String = cells.iter().zip(widths).map(cell).collect();
    line.trim_end().to_owned()
}

pub(super) fn dash() -> String {
    "–".to_owned()
}

/// Error over bound with four digits after the point; what is there but would print as
/// nothing in its own way.
pub(super) fn ratio_of(ratio: Option<f64>) -> String {
    match ratio {
        None => dash(),
        Some(0.0) => "0".to_owned(),
        Some(ratio) if ratio < 5e-5 => format!("{ratio:.0e}"),
        Some(ratio) => format!("{ratio:.4}"),
    }
}

#[cfg(test)]
mod tests {
    use super::ratio_of;

    #[test]
    fn ratios_are_short() {
        assert_eq!(ratio_of(None), "–");
        assert_eq!(ratio_of(Some(0.0)), "0");
        assert_eq!(ratio_of(Some(0.25)), "0.2500");
        assert_eq!(ratio_of(Some(3e-6)), "3e-6", "there, but small");
    }
}
