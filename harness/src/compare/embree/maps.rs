//! Lists of layered depth maps against all that Embree finds along rays through their pixels.
//!
//! Embree has the triangles as they lie on the lattice, so this votes on the projection as well.
//! A pair is a pixel of a map and a triangle. Two things are decided of it before either side is
//! looked at: whether the pixel's list has a key of the triangle ([`pair`]), and whether Embree
//! reports it along the pixel's ray ([`crate::embree::rays::bound`]). Either is yes, no, or open;
//! a pair of which one is open is in class edge. Where both are decided they are the same, or the
//! projection is wrong.
//!
//! A list has keys and no triangles. So it is held against intervals, one for each triangle that
//! it has or may have a key of: each key must be in one of its own, and each triangle that must
//! have a key must have one of its own ([`lists`]). An interval is around Embree's time.

mod lists;
mod pair;
mod ray;
mod vote;

#[cfg(test)]
mod tests;

use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{Layers, Map, Maps};

use super::super::ldm::drawn;
use crate::dispatch::share;
use crate::embree::rays::RayLists;
use crate::embree::rays::bound::{self, Met, Pair};
use crate::embree::{EmbreeError, Hit};
use lists::{Interval, matched};
use pair::{Covers, Judged};
use ray::{Projection, Through};
pub use vote::{MapConflict, MapDisagreement, MapVote};

/// Pixels of a map that are asked about: every so-many-th column and row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampled {
    /// Number of the map.
    pub map: usize,
    /// From one column, or row, to the next; the first is in the middle of as many.
    pub stride: u32,
}

/// Compares the lists of sampled pixels with what Embree finds there.
///
/// # Errors
/// The first error that Embree reports, in order of maps.
pub fn compare_maps<E: RayLists>(
    maps: &Maps,
    layers: &Layers,
    blockers: &Blockers,
    sampled: &[Sampled],
    embree: &E,
) -> Result<MapVote, EmbreeError> {
    let votes: Vec<Result<MapVote, EmbreeError>> = share::map(sampled, 1, |sampled| {
        let map = &maps.maps[sampled.map];
        let judge = Judge {
            maps,
            map,
            layers,
            blockers,
            embree,
            projection: Projection::new(maps, map),
        };
        judge.map(*sampled)
    });
    let mut total = MapVote::default();
    for vote in votes {
        total.add(vote?);
    }
    Ok(total)
}

/// Judges one map.
struct Judge<'a, E> {
    maps: &'a Maps,
    map: &'a Map,
    layers: &'a Layers,
    blockers: &'a Blockers,
    embree: &'a E,
    projection: Projection<'a>,
}

/// A pixel that is asked about, and the triangles that are near it, rising.
struct Asked {
    pixel: u32,
    through: Through,
    near: Vec<u32>,
}

impl<E: RayLists> Judge<'_, E> {
    fn map(&self, sampled: Sampled) -> Result<MapVote, EmbreeError> {
        let snapped = drawn(self.maps, self.map, self.blockers);
        let stride = sampled.stride;
        let first = stride / 2;
        let size = self.map.size;
        let count = |side: u32| side.saturating_sub(first).div_ceil(stride);
        let (columns, rows) = (count(size.width), count(size.height));
        let mut asked = Vec::with_capacity((columns * rows) as usize);
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |c| (row, c))) {
            let at = [first + column * stride, first + row * stride];
            asked.push(Asked {
                pixel: at[1] * size.width + at[0],
                through: self.projection.through(at),
                near: Vec::new(),
            });
        }
        // Corners are off by half a sub-pixel, and rays as far as they stray.
        let strays = asked.iter().map(|asked| asked.through.stray);
        #[expect(clippy::cast_possible_truncation, reason = "a few sub-pixels")]
        let margin = libm::ceil(strays.fold(0.0, f64::max)) as i32 + 1;
        for (prim, corners) in (0_u32..).zip(&snapped.prims) {
            let places = corners.map(|row| snapped.snapped[row as usize]);
            let span = |axis: usize, count: u32| {
                let ends = places.map(|p| p[axis]);
                let low = ends[0].min(ends[1]).min(ends[2]) - margin;
                let high = ends[0].max(ends[1]).max(ends[2]) + margin;
                self.within([low, high], first, stride, count)
            };
            let (columns_near, rows_near) = (span(0, columns), span(1, rows));
            for row in rows_near {
                for column in columns_near.clone() {
                    asked[(row * columns + column) as usize].near.push(prim);
                }
            }
        }
        let mut vote = MapVote::default();
        for asked in &asked {
            let mut pixel = OfPixel::new(self, asked)?;
            for &prim in &asked.near {
                let rows = self.blockers.triangles[prim as usize];
                pixel.pair(prim, rows.map(|row| snapped.snapped[row as usize]));
            }
            pixel.rest();
            let list = self.layers.list(self.map.first + asked.pixel);
            pixel.wrong.extend(matched(list, &pixel.intervals));
            pixel.vote.keys += list.len() as u64;
            for conflict in pixel.wrong {
                pixel.vote.differs(MapDisagreement {
                    map: sampled.map,
                    pixel: asked.pixel,
                    conflict,
                });
            }
            vote.add(pixel.vote);
        }
        Ok(vote)
    }

    /// Which of the sampled columns, or rows, have their middles between two sub-pixels.
    fn within(
        &self,
        [low, high]: [i32; 2],
        first: u32,
        stride: u32,
        count: u32,
    ) -> std::ops::Range<u32> {
        let (bits, half) = (self.maps.bits, 1_i64 << (self.maps.bits - 1));
        let middle = |number: u32| (i64::from(first + number * stride) << bits) + half;
        let below = |bound: i64| {
            let (mut start, mut end) = (0, count);
            while start < end {
                let at = u32::midpoint(start, end);
                match middle(at) < bound {
                    true => start = at + 1,
                    false => end = at,
                }
            }
            start
        };
        below(i64::from(low))..below(i64::from(high) + 1)
    }
}

/// Judges one pixel.
struct OfPixel<'j, E> {
    judge: &'j Judge<'j, E>,
    asked: &'j Asked,
    /// What Embree reports along the pixel's ray, in order of triangles.
    hits: Vec<Hit>,
    /// Where the list's keys must be, or may.
    intervals: Vec<Interval>,
    wrong: Vec<MapConflict>,
    vote: MapVote,
}

impl<'j, E: RayLists> OfPixel<'j, E> {
    fn new(judge: &'j Judge<'j, E>, asked: &'j Asked) -> Result<Self, EmbreeError> {
        let mut hits = Vec::new();
        if let Some(way) = &asked.through.way {
            judge.embree.all(&way.ray, &mut hits)?;
        }
        Ok(Self {
            judge,
            asked,
            hits,
            intervals: Vec::new(),
            wrong: Vec::new(),
            vote: MapVote {
                rays: 1,
                ..MapVote::default()
            },
        })
    }

    /// In which class the pixel's ray and a triangle are for Embree.
    fn of_ray(&self, prim: u32) -> Pair {
        let way = self.asked.through.way.as_ref();
        let corners = self.judge.blockers.corners(prim);
        way.map_or(Pair::Outside, |way| bound::pair(&way.ray, corners))
    }

    /// A triangle that is near.
    fn pair(&mut self, prim: u32, places: [[i32; 3]; 3]) {
        let Judge {
            projection,
            blockers,
            ..
        } = self.judge;
        let through = &self.asked.through;
        let judged = Judged::new(projection, through, blockers.corners(prim), places);
        let (covers, pair) = (judged.covers, self.of_ray(prim));
        let hit = self.hits.iter().find(|hit| hit.prim == prim).copied();
        if covers == Covers::No && pair == Pair::Outside && hit.is_none() {
            return;
        }
        self.vote.pairs += 1;
        let interval = match (covers, pair) {
            (Covers::Yes, Pair::Outside) | (Covers::No, Pair::Inside(_)) => {
                self.wrong.push(MapConflict::Projection { prim });
                return;
            }
            (Covers::No, _) => None,
            (Covers::Open, _) => Some(judged.range()),
            (Covers::Yes, _) => Some(Interval {
                must: true,
                ..judged.range()
            }),
        };
        let is_open = covers == Covers::Open || matches!(pair, Pair::Edge(_));
        self.vote.edge += u64::from(is_open);
        let seen = match (pair, hit) {
            (Pair::Inside(_), None) => {
                self.wrong.push(MapConflict::Missed { prim });
                None
            }
            (Pair::Outside, Some(_)) => {
                self.wrong.push(MapConflict::Invented { prim });
                None
            }
            (Pair::Inside(met), Some(hit)) => self.time(hit, met),
            _ => None,
        };
        // Embree's own time says where the key must be, where it may be held to.
        let narrow = match (interval, seen, &through.way) {
            (Some(interval), Some((time, bound)), Some(way)) if interval.must => {
                Some(judged.interval(through.stray, way, time, bound))
            }
            _ => interval,
        };
        self.intervals.extend(narrow);
    }

    /// Embree's time and its bound, if it is within.
    fn time(&mut self, hit: Hit, met: Met) -> Option<(f64, f64)> {
        let time = f64::from(hit.t);
        let off = (time - met.t).abs() / met.bound;
        let off = if off.is_nan() { f64::INFINITY } else { off };
        self.vote.times += 1;
        self.vote.error_over_bound = self.vote.error_over_bound.max(off);
        if off > 1.0 {
            self.wrong.push(MapConflict::Time { prim: hit.prim });
            return None;
        }
        Some((time, met.bound))
    }

    /// What Embree reports of triangles that are not near: it may where that is open.
    fn rest(&mut self) {
        for hit in std::mem::take(&mut self.hits) {
            if self.asked.near.binary_search(&hit.prim).is_ok() {
                continue;
            }
            let known = (hit.prim as usize) < self.judge.blockers.triangles.len();
            match known && matches!(self.of_ray(hit.prim), Pair::Edge(_)) {
                true => {
                    (self.vote.pairs, self.vote.edge) = (self.vote.pairs + 1, self.vote.edge + 1)
                }
                false => self.wrong.push(MapConflict::Invented { prim: hit.prim }),
            }
        }
    }
}
