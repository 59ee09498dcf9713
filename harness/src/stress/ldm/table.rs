//! A sweep as a table: a line for each step.

use super::super::notes::Notes;
use super::super::table::{Lines, dash, ratio_of};
use super::{Bound, Form, Measured};
use crate::text::{compact, count, share};

/// Columns, and how wide they are on a terminal.
const COLUMNS: [(&str, usize); 19] = [
    ("step", 8),
    ("points", 7),
    ("maps", 6),
    ("compared", 9),
    ("differ", 7),
    ("gpu", 8),
    ("embree", 8),
    ("key", 7),
    ("whole", 9),
    ("directions", 11),
    ("noise", 9),
    ("quantised", 10),
    ("resolution", 11),
    ("largest", 9),
    ("of pixels", 10),
    ("in band", 9),
    ("beside", 9),
    ("extra", 9),
    ("own", 8),
];

/// Above the numbers: what they are.
const ABOVE: &str = "points that ask, and maps; items compared, and that differ, over all legs; error over bound of \
     the adapters' sums and light, of Embree's depths, and of what points find against the unrounded scene; what is open \
     against 4,096 random rays a point: RMSE, its parts by the number of directions (with the rays' noise), by rounding to \
     the lattice and by the maps' pixels, the largest error and the largest by pixels; of all weight, what rays meet and \
     maps lose within a point's own band, what they lose beside it, and what maps meet and rays do not; the most that a \
     point loses to its own surface, by itself";

/// Lines of one sweep, as they come.
#[derive(Default)]
pub struct Table {
    notes: Notes,
    /// Of each step, the farthest sheet that is lost and the nearest that is found.
    sheets: Vec<String>,
    /// Points in maps with a face by itself, such that are steep, and such that meet it.
    steep: [u64; 3],
    /// Pixels, RMSE by them.
    pixels: Vec<[f64; 2]>,
    /// Directions, RMSE by them without the rays' noise.
    directions: Vec<[f64; 2]>,
}

impl Table {
    fn remember(&mut self, m: &Measured) {
        if m.form == Form::Sheets {
            let bands = |n: Option<f64>| n.map_or_else(dash, |n| format!("{n:.3}"));
            let (lost, found) = (m.found.farthest_lost, m.found.nearest_found);
            self.sheets
                .push(format!("{}: {} / {}", m.step, bands(lost), bands(found)));
        }
        let of_step = [m.alone.pairs, m.alone.steep, m.alone.met];
        self.steep = [0, 1, 2].map(|i| self.steep[i] + of_step[i]);
        let parts = &m.parts;
        if m.sweep == "resolution" && (25.0..=400.0).contains(&m.value) {
            self.pixels.push([m.value, parts.resolution.rmse]);
        }
        if m.sweep == "directions" && (16.0..=1024.0).contains(&m.value) {
            let squares = parts.directions.rmse.powi(2) - parts.noise.powi(2);
            self.directions.push([m.value, squares.max(0.0).sqrt()]);
        }
    }
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
        self.remember(m);
        let gpu = [Bound::Occlusion, Bound::Environment].map(|bound| m.worst(bound));
        let gpu = gpu
            .into_iter()
            .flatten()
            .map(|(ratio, _)| ratio)
            .reduce(f64::max);
        let ratio = |bound| ratio_of(m.worst(bound).map(|(ratio, _)| ratio));
        let (parts, found) = (&m.parts, &m.found);
        let of_weight = |part: f64| share(part / found.weight.max(1.0));
        vec![
            m.step.clone(),
            compact(m.counts[0]),
            compact(m.counts[1]),
            compact(m.compared()),
            compact(m.differ()),
            ratio_of(gpu),
            ratio(Bound::Embree),
            ratio(Bound::Key),
            error(parts.whole.rmse),
            error(parts.directions.rmse),
            error(parts.noise),
            error(parts.quantisation.rmse),
            error(parts.resolution.rmse),
            error(parts.whole.most),
            error(parts.resolution.most),
            of_weight(found.band),
            of_weight(found.beside),
            of_weight(found.extra),
            error(m.alone.lost),
            self.notes.marks(m.reasons()),
        ]
    }

    fn notes(&self) -> Vec<String> {
        let of = |what: &'static str, points: &[[f64; 2]]| {
            let order = order(points)?;
            let [from, to] = [points.first()?[0], points.last()?[0]];
            Some(format!(
                "from {from} to {to}, the RMSE {what} falls by the power {order:.2} of the number"
            ))
        };
        let orders = [
            of("by pixels", &self.pixels),
            of("by directions, without the rays' noise,", &self.directions),
        ];
        let [pairs, steep, met] = self.steep;
        let steep = (steep > 0).then(|| {
            format!(
                "of {} points in maps, {} have a face steeper than 127 keys a key, by which no more is told \
                 apart; by itself, {} meet it",
                count(pairs),
                count(steep),
                count(met)
            )
        });
        let sheets = (!self.sheets.is_empty()).then(|| {
            format!(
                "the farthest sheet that is lost / the nearest that is found, in bands of a point's own \
                 surface: {}",
                self.sheets.join(", ")
            )
        });
        let more = [steep, sheets].into_iter().chain(orders).flatten();
        self.notes.lines().chain(more).collect()
    }
}

/// The power of a number by which another falls, by least squares of logarithms; `None` of fewer
/// than three points, or of zeros.
fn order(points: &[[f64; 2]]) -> Option<f64> {
    if points.len() < 3 || points.iter().flatten().any(|n| *n <= 0.0) {
        return None;
    }
    let logs: Vec<[f64; 2]> = points.iter().map(|p| p.map(libm::log)).collect();
    let count = logs.len() as f64;
    let mean = [0, 1].map(|i| logs.iter().map(|p| p[i]).sum::<f64>() / count);
    let sum = |of: &dyn Fn(&[f64; 2]) -> f64| logs.iter().map(of).sum::<f64>();
    let above = sum(&|p| (p[0] - mean[0]) * (p[1] - mean[1]));
    let below = sum(&|p| (p[0] - mean[0]).powi(2));
    (below > 0.0).then(|| -above / below)
}

/// An error with two digits.
fn error(error: f64) -> String {
    match error {
        0.0 => "0".to_owned(),
        error => format!("{error:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::order;

    #[test]
    fn orders_are_those_of_powers() {
        let of = |power: f64| [1.0, 2.0, 4.0, 8.0].map(|n: f64| [n, 3.0 * n.powf(-power)]);
        let found = order(&of(0.5)).expect("four points");
        assert!((found - 0.5).abs() < 1e-12, "{found}");
        assert_eq!(order(&of(1.0)[..2]), None, "two points are any line");
        assert_eq!(
            order(&[[1.0, 1.0], [2.0, 0.0], [3.0, 1.0]]),
            None,
            "nothing is left"
        );
    }
}
