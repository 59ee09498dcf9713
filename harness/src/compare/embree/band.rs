//! Judging the pairs of a band of rows, pixel by pixel, whatever space they are in.

use rayon::prelude::*;
use triptych_spec::raster::Span;

use super::order::{self, Seen};
use super::pair::{DepthPair, Pair};
use super::pairs::{Expected, Pairs};
use super::vote::{Conflict, Disagreement, EmbreeVote};
use crate::embree::{EmbreeError, Hit, RayHits};

/// A triangle that may make pairs in the band.
struct Candidate<P: Pairs> {
    prim: u32,
    triangle: P::Candidate,
    rows: Span,
}

/// The columns of a row where a candidate makes a pair.
#[derive(Clone)]
struct Reach<R> {
    start: u32,
    end: u32,
    row: R,
    /// Number of the candidate; they are in order of `prim`.
    candidate: usize,
}

struct Sweep<'a, P, E> {
    pairs: &'a P,
    embree: &'a E,
    vote: EmbreeVote,
    hits: Vec<Hit>,
    seen: Vec<Seen>,
}

/// The rows in which each triangle makes pairs.
pub(super) fn rows(pairs: &impl Pairs) -> Vec<Span> {
    let all = (0..pairs.count()).into_par_iter();
    all.map(|prim| pairs.rows(prim)).collect()
}

/// Compares the rows `band`; `rows` is what [`rows`] says of the triangles.
pub(super) fn judge<P: Pairs, E: RayHits>(
    pairs: &P,
    embree: &E,
    rows: &[Span],
    band: Span,
) -> Result<EmbreeVote, EmbreeError> {
    let candidates = candidates(pairs, rows, &band);
    let mut sweep = Sweep {
        pairs,
        embree,
        vote: EmbreeVote::default(),
        hits: Vec::new(),
        seen: Vec::new(),
    };
    for row in band {
        sweep.row(row, &candidates)?;
    }
    Ok(sweep.vote)
}

/// Triangles that reach one of the band's rows.
fn candidates<P: Pairs>(pairs: &P, rows: &[Span], band: &Span) -> Vec<Candidate<P>> {
    let meets = |rows: &Span| rows.start < band.end && band.start < rows.end;
    let candidate = |(prim, rows): (u32, &Span)| Candidate {
        prim,
        triangle: pairs.candidate(prim),
        rows: rows.clone(),
    };
    let all = (0_u32..).zip(rows).filter(|(_, rows)| meets(rows));
    all.map(candidate).collect()
}

impl<P: Pairs, E: RayHits> Sweep<'_, P, E> {
    /// Sweeps a row from left to right. `active` holds the candidates that make a
    /// pair with the current pixel, in order of `prim`.
    fn row(&mut self, row: u32, candidates: &[Candidate<P>]) -> Result<(), EmbreeError> {
        let reaches = self.reaches(row, candidates);
        let mut coming = reaches.into_iter().peekable();
        let mut active: Vec<Reach<P::Row>> = Vec::new();
        for column in 0..self.pairs.size().width {
            active.retain(|reach| reach.end > column);
            let known = active.len();
            while let Some(reach) = coming.next_if(|reach| reach.start == column) {
                active.push(reach);
            }
            if active.len() > known {
                active.sort_unstable_by_key(|reach| reach.candidate);
            }
            self.pixel(column, row, candidates, &active)?;
        }
        Ok(())
    }

    /// Where the candidates are covered or near an edge, from left to right.
    fn reaches(&mut self, row: u32, candidates: &[Candidate<P>]) -> Vec<Reach<P::Row>> {
        let mut reaches = Vec::new();
        for (candidate, c) in candidates.iter().enumerate() {
            if c.rows.contains(&row) {
                let (span, prepared) = self.pairs.reach(&c.triangle, row);
                if !span.is_empty() {
                    reaches.push(Reach {
                        start: span.start,
                        end: span.end,
                        row: prepared,
                        candidate,
                    });
                }
            }
        }
        reaches.sort_unstable_by_key(|reach| (reach.start, reach.candidate));
        reaches
    }

    /// Joins the active candidates with Embree's hits; both are in order of `prim`.
    fn pixel(
        &mut self,
        column: u32,
        row: u32,
        candidates: &[Candidate<P>],
        active: &[Reach<P::Row>],
    ) -> Result<(), EmbreeError> {
        let mut hits = std::mem::take(&mut self.hits);
        self.embree.hits(column, row, &mut hits)?;
        let reported = hits.len();
        hits.dedup_by_key(|hit| hit.prim);
        self.vote.repeated += (reported - hits.len()) as u64;
        self.vote.rays += 1;
        self.seen.clear();

        let pixel = [column, row];
        let mut unjoined = hits.iter().peekable();
        for reach in active {
            let c = &candidates[reach.candidate];
            while let Some(stray) = unjoined.next_if(|hit| hit.prim < c.prim) {
                self.stray(pixel, *stray);
            }
            let t = unjoined.next_if(|hit| hit.prim == c.prim).map(|hit| hit.t);
            let expected = self.pairs.expect(&c.triangle, &reach.row, pixel);
            self.pair(pixel, c.prim, expected, t);
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
