//! A sweep as a table: a line for each step.

use super::super::notes::Notes;
use super::super::table::{Lines, dash, ratio_of};
use super::{Bound, Measured};
use crate::text::{compact, share, time};

/// Columns, and how wide they are on a terminal.
const COLUMNS: [(&str, usize); 13] = [
    ("step", 10),
    ("rays", 7),
    ("compared", 9),
    ("differ", 7),
    ("gpu", 8),
    ("embree", 8),
    ("edge any", 9),
    ("closest", 8),
    ("admitted", 9),
    ("cells", 13),
    ("list", 6),
    ("walk", 8),
    ("bricks", 8),
];

/// Above the numbers: what they are.
const ABOVE: &str = "rays of each leg; items compared, and that differ, over all legs; error over bound of the times of \
     closest hits, the largest of all adapters and Embree's; share of Embree's rays in class edge, by query; largest share \
     of an adapter's closest hits that bounds do not tell from the spec's; cells along the axes, the longest list; the \
     longest walk over the most steps that it may take; steps that empty bricks save";

/// Lines of one sweep, as they come.
#[derive(Default)]
pub struct Table {
    notes: Notes,
    saved: Vec<String>,
}

impl Lines for Table {
    type Measured = Measured;
    const COLUMNS: &'static [(&'static str, usize)] = &COLUMNS;
    const ABOVE: &'static str = ABOVE;

    fn cells(&mut self, m: &Measured) -> Vec<String> {
        if let Some(refused) = &m.refused {
            let mut cells = vec![m.step.clone()];
            cells.extend(COLUMNS[1..].iter().map(|_| dash()));
            cells.push(format!("refused: {}", crate::text::clean(refused)));
            return cells;
        }
        if let Some(saved) = m.saved() {
            self.saved.push(format!(
                "step {}: the plan skips {} passes on all legs, which take {} if they run all the same",
                m.step,
                saved.passes,
                time(saved.ms)
            ));
        }
        let ratio = |bound| ratio_of(m.worst(bound).map(|(ratio, _)| ratio));
        let [any, closest] = m.edge().map(|edge| edge.map_or_else(dash, share));
        let axes = m.cells.map(|cells| cells.to_string());
        vec![
            m.step.clone(),
            compact(m.rays),
            compact(m.compared()),
            compact(m.differ()),
            ratio(Bound::Gpu),
            ratio(Bound::Embree),
            any,
            closest,
            share(m.admitted()),
            axes.join("x"),
            compact(m.list.into()),
            format!("{:.3}", m.walks.share()),
            share(m.walks.saved()),
            self.notes.marks(m.reasons()),
        ]
    }

    fn notes(&self) -> Vec<String> {
        self.notes
            .lines()
            .chain(self.saved.iter().cloned())
            .collect()
    }
}
