//! The kill matrix as text: a line for each mutant, a column for each leg.

use std::collections::BTreeSet;

use super::matrix::{Cell, Matrix};
use crate::digest::leg_parts;
use crate::text::{clean, count, plural, time};

/// Width of a leg's column: the longest word of an outcome, and room.
const COLUMN: usize = 11;

/// How the lines of a matrix are laid out.
pub struct Columns {
    legs: Vec<String>,
    name: usize,
    scene: usize,
}

impl Columns {
    /// Columns for these legs, wide enough for these names and scenes.
    pub fn new<'a>(
        legs: &[String],
        rows: impl Iterator<Item = (&'a str, &'a str)> + Clone,
    ) -> Self {
        let longest = |lengths: &mut dyn Iterator<Item = usize>| lengths.max().unwrap_or(0);
        Self {
            legs: legs.iter().map(|leg| clean(leg).into_owned()).collect(),
            name: longest(&mut rows.clone().map(|(name, _)| name.len())),
            scene: longest(&mut rows.map(|(_, scene)| scene.len())),
        }
    }

    /// What the words mean, then the heads of the columns.
    pub fn header(&self) -> Vec<String> {
        let parts: Vec<_> = self.legs.iter().map(|leg| leg_parts(leg)).collect();
        let line = |part: &dyn Fn(usize) -> String| {
            let cells: String = (0..parts.len())
                .map(|i| format!("{:COLUMN$}", part(i)))
                .collect();
            let before = self.name + self.scene + 4;
            format!("{}{cells}", " ".repeat(before))
                .trim_end()
                .to_owned()
        };
        let adapter = |i: usize| {
            let of = |i: usize| parts[i].1.unwrap_or_default();
            let new = i == 0 || of(i) != of(i - 1);
            if new { of(i).to_owned() } else { String::new() }
        };
        vec![
            "result, structure: killed by a value, by a broken certificate".to_owned(),
            "not seen: not observable on this driver, which proves nothing".to_owned(),
            String::new(),
            line(&adapter),
            line(&|i| parts[i].2.unwrap_or_default().to_owned()),
        ]
    }

    /// The line of one mutant.
    pub fn line(&self, cells: &[&Cell]) -> String {
        let Some(first) = cells.first() else {
            return String::new();
        };
        let Self { name, scene, .. } = *self;
        let head = format!("{:name$}  {:scene$}  ", first.mutant, first.scene);
        if first.leg.is_empty() {
            return format!("{head}absent: {}", clean(&first.note));
        }
        let outcome = |leg: &String| {
            let cell = cells.iter().find(|c| c.leg == *leg);
            let word = cell.map_or("", |c| c.outcome.word());
            format!("{word:COLUMN$}")
        };
        let outcomes: String = self.legs.iter().map(outcome).collect();
        let causes: BTreeSet<_> = cells.iter().flat_map(|c| c.causes.keys()).collect();
        let causes: Vec<String> = causes.into_iter().map(|cause| cause.name()).collect();
        format!("{head}{outcomes}{}", causes.join(", "))
    }
}

impl Matrix {
    /// What the run came to, in one line.
    pub fn headline(&self) -> String {
        let survivors = self.mutants - self.killed.min(self.mutants);
        let survive = match survivors {
            0 => "none survives".to_owned(),
            1 => "1 survives".to_owned(),
            n => format!("{} survive", count(n)),
        };
        format!(
            "{}, {} killed, {survive}, {} absent, {}",
            plural(self.mutants, "mutant"),
            count(self.killed),
            count(self.absent),
            time(self.seconds * 1000.0)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mutants::{Outcome, mutants};

    #[test]
    fn a_line_has_a_word_for_each_leg() {
        let all = mutants();
        let legs = ["gpu@a/compute", "gpu@a/native", "gpu@b/compute"].map(str::to_owned);
        let columns = Columns::new(&legs, [("name", "scene")].into_iter());
        let heads = &columns.header()[3..];
        assert_eq!(heads[0], "             a                     b");
        assert_eq!(heads[1], "             compute    native     compute");
        let cell = |leg: &str, outcome| Cell {
            mutant: "name".into(),
            scene: "scene".into(),
            outcome,
            ..Cell::blank(&all[0], leg.into(), "no 64-bit integers".into())
        };
        let mut dead = cell(&legs[0], Outcome::Structure);
        dead.causes = [(crate::cause::Cause::Cycle, 3)].into();
        let hidden = cell(&legs[2], Outcome::NotObservable);
        assert_eq!(
            columns.line(&[&hidden, &dead]),
            "name  scene  structure             not seen   cycle"
        );
        let absent = cell("", Outcome::NotRun);
        assert_eq!(
            columns.line(&[&absent]),
            "name  scene  absent: no 64-bit integers"
        );
    }
}
