//! Judging the pairs of a band of rows, pixel by pixel, whatever space they are in.

use triptych_spec::raster::Span;

use super::known::{Band, Known, Shares};
use super::order::{self, Seen};
use super::pair::{DepthPair, Pair};
use super::pairs::{Expected, Pairs};
use super::vote::{Conflict, Disagreement, EmbreeVote};
use crate::embree::{EmbreeError, Hit, RayHits};

struct Sweep<'a, P, E> {
    pairs: &'a P,
    embree: &'a E,
    vote: EmbreeVote,
    hits: Vec<Hit>,
    seen: Vec<Seen>,
}

/// Compares the rows `rows`, which are band `band` of those that `shares` is of.
pub(super) fn judge<P: Pairs, E: RayHits>(
    pairs: &P,
    embree: &E,
    shares: &Shares,
    band: usize,
    rows: Span,
) -> Result<EmbreeVote, EmbreeError> {
    let known = Band::new(pairs, shares, band, &rows);
    let mut sweep = Sweep {
        pairs,
        embree,
        vote: EmbreeVote::default(),
        hits: Vec::new(),
        seen: Vec::new(),
    };
    let columns = 0..pairs.size().width;
    let pixels = rows.flat_map(|row| columns.clone().map(move |column| [column, row]));
    for (number, pixel) in pixels.enumerate() {
        sweep.pixel(pixel, known.of(number))?;
    }
    Ok(sweep.vote)
}

impl<P: Pairs, E: RayHits> Sweep<'_, P, E> {
    /// Joins what is known with Embree's hits; both are in order of `prim`.
    fn pixel<'k>(
        &mut self,
        pixel: [u32; 2],
        known: impl Iterator<Item = &'k Known>,
    ) -> Result<(), EmbreeError> {
        let mut hits = std::mem::take(&mut self.hits);
        self.embree.hits(pixel[0], pixel[1], &mut hits)?;
        let reported = hits.len();
        hits.dedup_by_key(|hit| hit.prim);
        self.vote.repeated += (reported - hits.len()) as u64;
        self.vote.rays += 1;
        self.seen.clear();

        let mut unjoined = hits.iter().peekable();
        for Known { prim, expected } in known {
            while let Some(stray) = unjoined.next_if(|hit| hit.prim < *prim) {
                self.stray(pixel, *stray);
            }
            let t = unjoined.next_if(|hit| hit.prim == *prim).map(|hit| hit.t);
            self.pair(pixel, *prim, *expected, t);
        }
        for stray in unjoined {
            self.stray(pixel, *stray);
        }
        self.order(pixel);
        self.hits = hits;
        Ok(())
    }

    /// A hit on a triangle that is nowhere near, or has no area, is judged too.
    fn stray(&mut self, pixel: [u32; 2], hit: Hit) {
        let triangle = self.pairs.candidate(hit.prim);
        let (_, row) = self.pairs.reach(&triangle, pixel[1]);
        let expected = self.pairs.expect(&triangle, &row, pixel);
        self.pair(pixel, hit.prim, expected, Some(hit.t));
    }

    fn pair(&mut self, pixel: [u32; 2], prim: u32, expected: Expected, hit: Option<f32>) {
        let vote = &mut self.vote;
        vote.pairs += 1;
        match expected.with(hit, |t| self.pairs.key(t)) {
            Pair::Edge { agree } => {
                vote.edge += 1;
                vote.edge_agreeing += u64::from(agree);
            }
            Pair::Unresolved { agree } => {
                vote.unresolved += 1;
                vote.unresolved_agreeing += u64::from(agree);
            }
            Pair::Depth(depth) => {
                let t = hit.expect("a depth is that of a hit");
                self.depth(pixel, prim, depth, t);
            }
            Pair::Missed => {
                vote.missed += 1;
                self.conflict(pixel, prim, Conflict::Missed);
            }
            Pair::Invented => {
                vote.invented += 1;
                self.conflict(pixel, prim, Conflict::Invented);
            }
            Pair::Neither => {}
        }
    }

    /// Judges a depth, and notes it for [`Self::order`].
    fn depth(&mut self, pixel: [u32; 2], prim: u32, depth: DepthPair, t: f32) {
        let DepthPair { key, embree, bound } = depth;
        let exact = f64::from(key);
        self.vote.depths += 1;
        self.vote.error_keys = self.vote.error_keys.max(depth.error());
        self.vote.error_over_bound = self.vote.error_over_bound.max(depth.ratio());
        if depth.is_outside() {
            self.vote.depths_outside += 1;
            self.conflict(pixel, prim, Conflict::Depth { key, embree, bound });
        }
        self.seen.push(Seen {
            prim,
            low: exact - bound,
            high: exact + bound,
            t,
        });
    }

    /// Compares the order along a ray.
    fn order(&mut self, pixel: [u32; 2]) {
        let mut seen = std::mem::take(&mut self.seen);
        let disorder = |prim| self.conflict(pixel, prim, Conflict::Order);
        let (steps, disordered) = order::judge(&mut seen, disorder);
        self.vote.steps += steps;
        self.vote.steps_disordered += disordered;
        self.seen = seen;
    }

    fn conflict(&mut self, [column, row]: [u32; 2], prim: u32, conflict: Conflict) {
        self.vote.keep(Disagreement {
            pixel: row * self.pairs.size().width + column,
            prim,
            conflict,
        });
    }
}
