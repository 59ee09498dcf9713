//! Why steps skipped something: a mark for each reason, explained below the table.

use std::collections::BTreeSet;

use crate::row::Row;
use crate::text::clean;

/// Reasons, in the order in which they came up, and the legs that gave them.
#[derive(Default)]
pub(super) struct Notes {
    /// Stage and reason, and the legs.
    notes: Vec<(String, BTreeSet<String>)>,
}

impl Notes {
    /// Marks of what a step skipped.
    pub(super) fn marks<'r>(
        &mut self,
        skipped: impl Iterator<Item = (&'r Row, &'r str)>,
    ) -> String {
        let mut marks: Vec<usize> = Vec::new();
        for (row, reason) in skipped {
            marks.push(self.mark(format!("{}: {reason}", row.stage), &row.b));
        }
        marks.sort_unstable();
        marks.dedup();
        runs(&marks)
    }

    /// The number of a reason.
    fn mark(&mut self, note: String, leg: &str) -> usize {
        let note = clean(&note).into_owned();
        let known = self.notes.iter().position(|(n, _)| *n == note);
        let number = known.unwrap_or_else(|| {
            self.notes.push((note, BTreeSet::new()));
            self.notes.len() - 1
        });
        self.notes[number].1.insert(leg.to_owned());
        number + 1
    }

    /// What the marks stand for.
    pub(super) fn lines(&self) -> impl Iterator<Item = String> {
        let numbered = (1..).zip(&self.notes);
        numbered.map(|(number, (note, legs))| {
            let legs: Vec<&str> = legs.iter().map(String::as_str).collect();
            format!("[{number}] {note} ({})", legs.join(", "))
        })
    }
}

/// `[1-3][7]`: numbers in rising order, neighbours as a range.
fn runs(numbers: &[usize]) -> String {
    let mut runs: Vec<[usize; 2]> = Vec::new();
    for &number in numbers {
        match runs.last_mut() {
            Some([_, end]) if *end + 1 == number => *end = number,
            _ => runs.push([number, number]),
        }
    }
    let run = |[start, end]: &[usize; 2]| match start == end {
        true => format!("[{start}]"),
        false => format!("[{start}-{end}]"),
    };
    runs.iter().map(run).collect()
}

#[cfg(test)]
mod tests {
    use super::runs;

    #[test]
    fn marks_are_short() {
        assert_eq!(runs(&[1, 2, 3, 7]), "[1-3][7]");
        assert_eq!(runs(&[]), "");
    }
}
