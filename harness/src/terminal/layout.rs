//! How wide the columns are, and what stands above them.

use console::measure_text_width;

use crate::digest::leg_parts;

/// Verdict, mark of the cache and a space.
pub const MARK: usize = 3;

/// Narrowest and widest column of names.
const NAME: [usize; 2] = [24, 40];

/// The same where columns stand close.
const NAME_TIGHT: usize = 20;

/// Narrowest column with a compact count, one space before it.
const CELL_TIGHT: usize = 8;

/// Narrowest column with a count in full (`✓ 12,345,678`), and with a compact
/// count (`✓ 12.3M`), with the gap before it.
const CELL: [usize; 2] = [14, 10];

/// Widest column that a long name of an adapter gets.
const CELL_MAX: usize = 16;

/// Column of the edge share, and columns of times.
const EDGE: usize = 10;
const TIME: usize = 9;

/// Least space between columns.
const GAP: usize = 2;

/// A pair of legs that has a column.
pub type Columns = (String, String);

/// Widths that fit the window and the pairs of legs seen so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Column of names.
    pub name: usize,
    /// Column of a pair of legs.
    pub cell: usize,
    /// Whether cells hold counts in full.
    pub full: bool,
    /// Column of the edge share; 0 if there is no room.
    pub edge: usize,
    /// Columns of times, spec's and the fastest GPU leg's; 0 if there is no room.
    pub time: usize,
}

impl Layout {
    /// The richest layout that fits; `None` if not even the verdicts do, and each
    /// scene is better told in a sentence.
    pub fn fit(window: usize, pairs: &[Columns]) -> Option<Self> {
        let names = pairs.iter().flat_map(|(_, b)| above(b));
        let longest = names.map(measure_text_width).max().unwrap_or(0);
        let wide = (longest + GAP).min(CELL_MAX);
        let choices = [
            (CELL[0].max(wide), true, EDGE, TIME),
            (CELL[1].max(wide), false, EDGE, TIME),
            (CELL[1], false, EDGE, TIME),
            (CELL[1].max(wide), false, EDGE, 0),
            (CELL[1], false, EDGE, 0),
            (CELL[1], false, 0, 0),
            (CELL_TIGHT, false, 0, 0),
        ];
        for (cell, full, edge, time) in choices {
            let columns = MARK + pairs.len() * cell + edge + 2 * time;
            let name = if cell == CELL_TIGHT {
                NAME_TIGHT
            } else {
                NAME[0]
            };
            if columns + name <= window {
                let name = (window - columns).min(NAME[1]);
                return Some(Self {
                    name,
                    cell,
                    full,
                    edge,
                    time,
                });
            }
        }
        None
    }

    /// What a heading may take of its column.
    fn room(self) -> usize {
        self.cell - if self.cell == CELL_TIGHT { 1 } else { GAP }
    }

    /// The lines above the table: adapter or leg, and path.
    pub fn header(self, pairs: &[Columns]) -> Vec<String> {
        let side = pairs.first().map(|(a, _)| format!("{a} against"));
        let side = cut(&side.unwrap_or_default(), self.name);
        let mut lines = vec![
            format!("{}{}", " ".repeat(MARK), right(&side, self.name)),
            format!("{}{}", " ".repeat(MARK), pad("scene", self.name)),
        ];
        for (_, b) in pairs {
            for (line, text) in lines.iter_mut().zip(above(b)) {
                line.push_str(&right(&cut(text, self.room()), self.cell));
            }
        }
        for (title, width) in [("edge", self.edge), ("spec", self.time), ("gpu", self.time)] {
            if width > 0 {
                lines[1].push_str(&right(title, width));
            }
        }
        lines
    }

    /// Columns that the header does not tell from others, or whose first leg is
    /// not the one that it names; they must be listed in full.
    pub fn unclear(self, pairs: &[Columns]) -> Vec<usize> {
        let heading = |(_, b): &Columns| above(b).map(|text| cut(text, self.room()));
        let unclear = |pair: &Columns| {
            let same = pairs.iter().filter(|p| heading(p) == heading(pair));
            pair.0 != pairs[0].0 || same.count() > 1
        };
        (0..pairs.len()).filter(|&i| unclear(&pairs[i])).collect()
    }
}

/// What stands above the column of a leg.
fn above(label: &str) -> [&str; 2] {
    let (leg, adapter, path) = leg_parts(label);
    [adapter.unwrap_or(leg), path.unwrap_or("")]
}

/// Cuts text to a width, with a mark where something is missing.
pub fn cut(text: &str, width: usize) -> String {
    console::truncate_str(text, width, "…").into_owned()
}

/// Fills up on the right.
pub fn pad(text: &str, width: usize) -> String {
    let fill = width.saturating_sub(measure_text_width(text));
    format!("{text}{}", " ".repeat(fill))
}

/// Fills up on the left.
pub fn right(text: &str, width: usize) -> String {
    let fill = width.saturating_sub(measure_text_width(text));
    format!("{}{text}", " ".repeat(fill))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_first_is_what_matters_least() {
        let pair = |b: &str| ("spec".to_owned(), b.to_owned());
        let pairs = [pair("embree"), pair("gpu@llvmpipe/compute")];
        let mut widths: Vec<Option<Layout>> = (20..140).map(|w| Layout::fit(w, &pairs)).collect();
        widths.dedup_by_key(|l| l.map(|l| (l.full, l.edge, l.time)));
        let richness = widths.iter().flatten().map(|l| (l.time, l.edge, l.full));
        let expected = [
            (0, 0, false),
            (0, EDGE, false),
            (TIME, EDGE, false),
            (TIME, EDGE, true),
        ];
        assert_eq!(richness.collect::<Vec<_>>(), expected);
        assert_eq!(widths[0], None, "a sentence at last");
        let narrowest = widths[1].map(|l| (l.name, l.cell));
        assert_eq!(narrowest, Some((NAME_TIGHT, CELL_TIGHT)), "close columns");
        for (layout, window) in (20..140).map(|w| (Layout::fit(w, &pairs), w)) {
            let Some(l) = layout else { continue };
            assert!((NAME_TIGHT..=NAME[1]).contains(&l.name), "{window}: {l:?}");
            let all = MARK + l.name + pairs.len() * l.cell + l.edge + 2 * l.time;
            assert!(all <= window, "{all} > {window}");
            let roomy = l.cell == CELL_TIGHT || l.name >= NAME[0];
            assert!(roomy, "{window}: {l:?}");
        }
    }
}
