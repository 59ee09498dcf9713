//! Which pixels to look at first.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use triptych_spec::bound::Bounded;

use super::rows::Rows;
use crate::cause::Cause;

/// How many pixels are named.
pub const NAMED_MAX: usize = 100;

/// The pixels that differ, the worst first: those with the most items that differ, over
/// all rows; of equally many, those whose colour is farthest off; then by rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Worst {
    /// The first of them, at most [`NAMED_MAX`].
    pub pixels: Vec<WorstPixel>,
    /// How many there are.
    pub all: u64,
}

/// A pixel that differs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WorstPixel {
    /// Column and row.
    pub at: [u32; 2],
    /// Items that differ, by cause.
    pub causes: BTreeMap<Cause, u64>,
    /// Stages and legs that report it, in order of rows.
    pub seen_by: Vec<(String, String)>,
    /// Largest distance of a component of colour, over all legs; `None` if no leg with
    /// a picture reports the pixel.
    pub error: Option<f32>,
}

/// How far off a pixel's colour is in the worst leg.
#[derive(Debug, Default)]
pub struct Errors(BTreeMap<u32, f32>);

impl Errors {
    /// Notes a leg's colours at the pixels that it reports.
    pub fn note(&mut self, pixels: &BTreeSet<u32>, spec: &[[Bounded; 3]], leg: &[[f32; 3]]) {
        for &pixel in pixels {
            let (Some(must), Some(is)) = (spec.get(pixel as usize), leg.get(pixel as usize)) else {
                continue;
            };
            #[expect(clippy::cast_possible_truncation, reason = "for showing and ranking")]
            let apart = |(must, is): (&Bounded, &f32)| (must.value - f64::from(*is)).abs() as f32;
            // What is no number is as far off as can be.
            let far = |error: f32| if error.is_nan() { f32::INFINITY } else { error };
            let error = must.iter().zip(is).map(apart).map(far).fold(0.0, f32::max);
            self.at_least(pixel, error);
        }
    }

    /// Notes what other legs have noted.
    pub fn add(&mut self, others: Self) {
        for (pixel, error) in others.0 {
            self.at_least(pixel, error);
        }
    }

    fn at_least(&mut self, pixel: u32, error: f32) {
        let worst = self.0.entry(pixel).or_default();
        *worst = worst.max(error);
    }
}

impl Worst {
    /// Ranks the pixels of all spots; a picture is so many pixels wide.
    pub fn of(rows: &Rows, errors: &Errors, width: u32) -> Self {
        let mut spots = rows.spots.clone();
        spots.sort_unstable();
        let mut pixels: Vec<(u32, usize)> = spots
            .chunk_by(|a, b| a.pixel == b.pixel)
            .map(|chunk| (chunk[0].pixel, chunk.len()))
            .collect();
        let all = pixels.len() as u64;
        let error = |pixel| errors.0.get(&pixel).copied();
        pixels.sort_by(|a, b| {
            let far = |pixel| error(pixel).unwrap_or(0.0);
            (Reverse(a.1).cmp(&Reverse(b.1))).then(far(b.0).total_cmp(&far(a.0)))
        });
        pixels.truncate(NAMED_MAX);
        let named = pixels.into_iter().map(|(pixel, _)| {
            let first = spots.partition_point(|s| s.pixel < pixel);
            let own = spots[first..].iter().take_while(|s| s.pixel == pixel);
            let mut causes = BTreeMap::new();
            let mut by = BTreeSet::new();
            for spot in own {
                *causes.entry(spot.cause).or_default() += 1;
                by.insert(spot.by);
            }
            WorstPixel {
                at: [pixel % width, pixel / width],
                causes,
                seen_by: by.into_iter().map(|by| rows.seen_by[by].clone()).collect(),
                error: error(pixel),
            }
        });
        Self {
            pixels: named.collect(),
            all,
        }
    }
}

#[cfg(test)]
mod tests {
    use triptych_spec::bound::Real;

    use super::*;
    use crate::replay::rows::Spot;

    #[test]
    fn most_items_first_then_the_farthest_colour_then_rows() {
        let mut rows = Rows::new("a/b", "a");
        rows.seen_by = vec![("build".into(), "x".into()), ("sort".into(), "y".into())];
        let spot = |pixel, cause, by| Spot { pixel, cause, by };
        rows.spots = vec![
            spot(9, Cause::Coverage, 0),
            spot(2, Cause::Coverage, 0),
            spot(5, Cause::TieOrder, 1),
            spot(5, Cause::Coverage, 0),
            spot(5, Cause::Coverage, 0),
            spot(7, Cause::Coverage, 1),
        ];
        let mut errors = Errors::default();
        let exact = |value| [Bounded::exact(value); 3];
        let seven = BTreeSet::from([7]);
        errors.note(&seven, &[exact(0.5); 8], &[[0.5, 0.25, f32::NAN]; 8]);
        let worst = Worst::of(&rows, &errors, 4);
        let order: Vec<[u32; 2]> = worst.pixels.iter().map(|p| p.at).collect();
        assert_eq!(order, [[1, 1], [3, 1], [2, 0], [1, 2]], "5, 7, 2, 9");
        assert_eq!(worst.all, 4, "pixels, not items");
        let first = &worst.pixels[0];
        assert_eq!(first.causes[&Cause::Coverage], 2, "each item counts");
        assert_eq!(first.seen_by.len(), 2, "both rows");
        assert_eq!(first.error, None, "no picture");
        assert_eq!(worst.pixels[1].error, Some(f32::INFINITY), "no number");
    }

    #[test]
    fn what_is_not_named_is_counted() {
        let mut rows = Rows::new("a/b", "a");
        rows.seen_by = vec![("build".into(), "x".into())];
        let spot = |pixel| Spot {
            pixel,
            cause: Cause::Coverage,
            by: 0,
        };
        rows.spots = (0..1000).map(spot).collect();
        let worst = Worst::of(&rows, &Errors::default(), 10);
        assert_eq!((worst.pixels.len(), worst.all), (NAMED_MAX, 1000));
    }
}
