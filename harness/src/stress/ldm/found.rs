//! What points find in maps, held against the scene as its files have it.
//!
//! For each asker and map, the triangles at the middle of its pixel are worked out without any
//! rounding, each with the interval that its key is in (`texel.rs`). Two things must hold on
//! both sides of the point's own band, and either can fail:
//!
//! - **nothing invented**: what is found is the key of a triangle that the list has or may have, so
//!   it is within that triangle's bound of its depth at the pixel's middle;
//! - **nothing lost**: a triangle that the list must have a key of, and whose whole interval is
//!   beyond the band, hides whatever is behind it, so what is found is not behind its interval.
//!
//! Beside that, the point's key must be its depth but for rounding, and its pixel one whose middle
//! is within half a pixel and what rounding adds, along both sides. So what a triangle is from the
//! point along the map's direction differs from what is found by its bound and at most what its
//! depth changes by within half a pixel.
//!
//! What that costs is told by rays from the points as the files have them: of all weight, how much
//! meets something that the maps do not find, because it is at the pixel's middle but within the
//! band, or is not there at all; and how much meets nothing where the maps find something.

use rayon::prelude::*;
use triptych_spec::ldm::{Hits, KEYS_PER_STEP, Map, neighbours, own_band, weight};

use super::alone::{STEEPEST, slope};
use super::exact::{Around, Exact};
use super::texel::{Holds, Projected, There};
use crate::replay::ldm::{Asker, LdmRun, LdmTurn};
use crate::vector::scale;

/// What came of all askers in all maps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Found {
    /// Pairs of an asker, a map and a side.
    pub sides: u64,
    /// Of these, such of which bounds say what is found, or that nothing is.
    pub certain: u64,
    /// The largest error of a key, over its bound.
    pub key: f64,
    /// The same of a point's distance from what is found.
    pub distance: f64,
    /// The same of a point's own key.
    pub own: f64,
    /// Sides that are not as they must be.
    pub wrong: u64,
    /// The first of these, in words.
    pub first: Option<String>,
    /// Weight of all sides that askers look to.
    pub weight: f64,
    /// Of this, such that rays meet something to, which is within the band.
    pub band: f64,
    /// Such that rays meet something to, which is not at the pixel's middle.
    pub beside: f64,
    /// Such that rays meet nothing to, and the maps something.
    pub extra: f64,
    /// Of a triangle that rays meet and that is at the pixel's middle: the largest distance over
    /// the band at which it was not found; none if it always was.
    pub farthest_lost: Option<f64>,
    /// The least at which it was.
    pub nearest_found: Option<f64>,
    /// Keys by which one that was not found is beyond two bands and the bounds of both surfaces'
    /// keys; of faces that are not steeper than is told apart.
    pub late: Option<f64>,
}

impl Found {
    /// Of all askers of a run.
    pub(super) fn of(run: &LdmRun, exact: &Exact) -> Self {
        let arounds: Vec<Option<Around>> = run
            .setup
            .receivers
            .par_iter()
            .map(|asker| Some(exact.around(&exact.from(&run.setup, asker)?)))
            .collect();
        let maps = run
            .turns
            .iter()
            .flat_map(|turn| turn.maps.maps.iter().map(move |m| (turn, m)));
        let maps: Vec<(&LdmTurn, &Map)> = maps.collect();
        let of = |(turn, map): &(&LdmTurn, &Map)| {
            let projected = Projected::new(&turn.maps, map, &exact.blockers);
            let mut found = Self::default();
            for (asker, around) in run.setup.receivers.iter().zip(&arounds) {
                found.asker(run, (turn, map), &projected, (asker, around.as_ref()));
            }
            found
        };
        let all: Vec<Self> = maps.par_iter().map(of).collect();
        all.into_iter().fold(Self::default(), Self::and)
    }

    fn and(mut self, other: Self) -> Self {
        self.sides += other.sides;
        self.certain += other.certain;
        self.wrong += other.wrong;
        self.key = worse(self.key, other.key);
        self.distance = worse(self.distance, other.distance);
        self.own = worse(self.own, other.own);
        self.first = self.first.or(other.first);
        self.weight += other.weight;
        self.band += other.band;
        self.beside += other.beside;
        self.extra += other.extra;
        self.farthest_lost = either(self.farthest_lost, other.farthest_lost, f64::max);
        self.nearest_found = either(self.nearest_found, other.nearest_found, f64::min);
        self.late = either(self.late, other.late, f64::max);
        self
    }

    fn asker(
        &mut self,
        run: &LdmRun,
        (turn, map): (&LdmTurn, &Map),
        projected: &Projected,
        (asker, around): (&Asker, Option<&Around>),
    ) {
        let receiver = &asker.receiver;
        let maps = &turn.maps;
        let hits = neighbours(maps, map, &turn.layers, receiver);
        let band = f64::from(own_band(maps, map, receiver));
        let middle = projected.middle(maps.place(map, receiver.point));
        let exact = projected.place_of(receiver.point);
        let way = [0, 1].map(|i| exact[i] - middle[i]);
        let off = (f64::from(hits.key) - exact[2]).abs() / own_bound(receiver.point);
        self.own = worse(self.own, off);
        let half = f64::from(1_u32 << (maps.bits - 1)) + 0.5 + 1e-3;
        let there: Vec<There> = projected.there(middle).collect();
        let named = || format!("point {:?} along {:?}", receiver.point, map.direction);
        if !(off <= 1.0 && way.iter().all(|w| w.abs() <= half)) {
            self.is_wrong(|| format!("{}: its key or its pixel is another's", named()));
        }
        for side in [-1.0, 1.0] {
            let side = Side {
                sign: side,
                key: f64::from(hits.key),
                band,
                found: if side < 0.0 { hits.before } else { hits.behind }.map(f64::from),
            };
            self.side(&side, &there, (way, half), named);
        }
        if let Some(around) = around {
            let normal = run
                .setup
                .model
                .face(asker.triangle)
                .normal
                .map(|c| c as f64);
            let steep = slope(map, normal) > STEEPEST;
            self.rays((map, &hits), receiver.normal, around, (&there, band, steep));
        }
    }

    fn side(
        &mut self,
        side: &Side,
        there: &[There],
        (way, half): ([f64; 2], f64),
        named: impl Fn() -> String,
    ) {
        self.sides += 1;
        let hides = there.iter().filter_map(|there| side.hides(there));
        let hides = hides.reduce(f64::min);
        let may = there.iter().any(|there| side.may(there));
        self.certain += u64::from(hides.is_some() || !may);
        let Some(found) = side.found else {
            if hides.is_some() {
                self.is_wrong(|| format!("{}: what is beyond its band is not found", named()));
            }
            return;
        };
        let nearest = there
            .iter()
            .min_by(|a, b| a.ratio(found).total_cmp(&b.ratio(found)));
        let ratio = nearest.map_or(f64::INFINITY, |there| there.ratio(found));
        self.key = worse(self.key, ratio);
        if !(..=1.0).contains(&ratio) {
            self.is_wrong(|| format!("{}: finds {found}, where nothing is", named()));
        }
        if hides.is_some_and(|hides| side.away(found) > hides) {
            self.is_wrong(|| format!("{}: finds {found}, which something hides", named()));
        }
        if let Some(there) = nearest.filter(|there| there.bound.is_finite()) {
            let own = there.depth + there.change(way);
            let distance = (found - own).abs() / (there.bound + there.steepest(half));
            self.distance = worse(self.distance, distance);
        }
    }

    fn is_wrong(&mut self, words: impl Fn() -> String) {
        self.wrong += 1;
        self.first.get_or_insert_with(words);
    }

    /// What rays from the exact point say to the side that the asker looks to.
    fn rays(
        &mut self,
        (map, hits): (&Map, &Hits),
        normal: [i32; 3],
        around: &Around,
        (there, band, steep): (&[There], f64, bool),
    ) {
        let weight = weight(map, normal);
        let share = f64::from(weight.unsigned_abs());
        if weight == 0 {
            return;
        }
        self.weight += share;
        let found = if weight > 0 { hits.before } else { hits.behind };
        let met = around.closest(scale(map.direction, f64::from(weight.signum())));
        let Some((steps, row)) = met else {
            self.extra += if found.is_some() { share } else { 0.0 };
            return;
        };
        let at = there
            .iter()
            .find(|t| t.row == row && t.holds == Holds::Must);
        if found.is_none() {
            *(if at.is_some() {
                &mut self.band
            } else {
                &mut self.beside
            }) += share;
        }
        let Some(at) = at else {
            return;
        };
        let keys = steps * f64::from(KEYS_PER_STEP);
        let distance = keys / band;
        let is_it = found.is_some_and(|found| at.ratio(f64::from(found)) <= 1.0);
        match (is_it, found) {
            (true, _) => {
                self.nearest_found = either(self.nearest_found, Some(distance), f64::min);
            }
            (false, None) => {
                self.farthest_lost = either(self.farthest_lost, Some(distance), f64::max);
                let late = (!steep).then_some(keys - 2.0 * (band + at.bound));
                self.late = either(self.late, late, f64::max);
            }
            // Something else is before it at the pixel's middle.
            (false, Some(_)) => {}
        }
    }
}

/// What is before a point's band (sign -1), or behind it.
struct Side {
    sign: f64,
    key: f64,
    band: f64,
    found: Option<f64>,
}

impl Side {
    /// How far a key is from the point's, to this side.
    fn away(&self, key: f64) -> f64 {
        self.sign * (key - self.key)
    }

    /// How far away a triangle is at most, if it is surely there, and beyond the band.
    fn hides(&self, there: &There) -> Option<f64> {
        let ends = there.ends().map(|end| self.away(end));
        let sure = there.holds == Holds::Must && ends[0].min(ends[1]) > self.band;
        sure.then_some(ends[0].max(ends[1]))
    }

    /// Whether a triangle may be there, and beyond the band.
    fn may(&self, there: &There) -> bool {
        there.ends().iter().any(|end| self.away(*end) > self.band)
    }
}

/// How far a point's own key may be from its depth: it is rounded to the nearest, and so is each
/// component of the row of depth, by half of 2^-27.
fn own_bound(point: [i32; 3]) -> f64 {
    let size: f64 = point.iter().map(|c| f64::from(c.unsigned_abs())).sum();
    0.5 + libm::scalbn(size, -28) + 1e-6
}

fn worse(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

fn either(a: Option<f64>, b: Option<f64>, of: fn(f64, f64) -> f64) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(of(a, b)),
        (a, b) => a.or(b),
    }
}
