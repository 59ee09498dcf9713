//! Judging the pairs of a band of rows, pixel by pixel.

use rayon::prelude::*;
use triptych_spec::raster::{Setup, Span, sample};
use triptych_spec::vertex::Primitives;

use super::edge::{EDGE_BITS, flat_edges, is_edge};
use super::order::{self, Seen};
use super::vote::{Conflict, Disagreement, EmbreeVote};
use crate::embree::bound::{Promise, Triangle};
use crate::embree::{EmbreeError, Hit, RayHits};

/// A triangle that may cover samples of the band.
struct Candidate {
    prim: u32,
    setup: Setup,
    triangle: Triangle,
    rows: Span,
}

/// The columns of a row where a candidate makes a pair.
#[derive(Clone, Copy)]
struct Reach {
    start: u32,
    end: u32,
    /// Number of the candidate; they are in order of `prim`.
    candidate: usize,
}

struct Sweep<'a, E> {
    spec: &'a Primitives,
    embree: &'a E,
    vote: EmbreeVote,
    hits: Vec<Hit>,
    seen: Vec<Seen>,
}

/// The rows that each triangle may cover; none without area.
pub(super) fn rows(spec: &Primitives) -> Vec<Span> {
    let count = u32::try_from(spec.prims.len()).expect("Embree has accepted them");
    let rows = |prim| Setup::new(spec, prim).map_or(0..0, |s| s.rows(spec.size, spec.bits));
    (0..count).into_par_iter().map(rows).collect()
}

/// Compares the rows `band`; `rows` is what [`rows`] says of the triangles.
pub(super) fn judge<E: RayHits>(
    spec: &Primitives,
    embree: &E,
    rows: &[Span],
    band: Span,
) -> Result<EmbreeVote, EmbreeError> {
    let candidates = candidates(spec, embree, rows, &band);
    let mut sweep = Sweep {
        spec,
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

/// Triangles with area that reach one of the band's rows.
fn candidates<E: RayHits>(
    spec: &Primitives,
    embree: &E,
    rows: &[Span],
    band: &Span,
) -> Vec<Candidate> {
    let depth = embree.depth();
    let candidate = |(prim, rows): (u32, &Span)| {
        let meets = rows.start < band.end && band.start < rows.end;
        Some(Candidate {
            prim,
            setup: meets.then(|| Setup::new(spec, prim))??,
            triangle: Triangle::new(spec, &depth, prim),
            rows: rows.clone(),
        })
    };
    (0_u32..).zip(rows).filter_map(candidate).collect()
}

impl<E: RayHits> Sweep<'_, E> {
    /// Sweeps a row from left to right. `active` holds the candidates that make a
    /// pair with the current pixel, in order of `prim`.
    fn row(&mut self, row: u32, candidates: &[Candidate]) -> Result<(), EmbreeError> {
        let reaches = self.reaches(row, candidates);
        let mut coming = reaches.into_iter().peekable();
        let mut active: Vec<Reach> = Vec::new();
        for column in 0..self.spec.size.width {
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
    fn reaches(&self, row: u32, candidates: &[Candidate]) -> Vec<Reach> {
        let mut reaches = Vec::new();
        for (candidate, c) in candidates.iter().enumerate() {
            if c.rows.contains(&row) {
                // With E the least edge function, negative, the sum of all is at
                // most area + 4 |E|, so class edge ends at |E| = area 2^-22
                // (1 + 2^-19), which is below this as area is at most 2^40.
                let least = -(c.setup.area >> EDGE_BITS) - 3;
                let span = c
                    .setup
                    .span_above([least; 3], row, self.spec.size, self.spec.bits);
                if !span.is_empty() {
                    reaches.push(Reach {
                        start: span.start,
                        end: span.end,
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
        candidates: &[Candidate],
        active: &[Reach],
    ) -> Result<(), EmbreeError> {
        let mut hits = std::mem::take(&mut self.hits);
        self.embree.hits(column, row, &mut hits)?;
        let reported = hits.len();
        hits.dedup_by_key(|hit| hit.prim);
        self.vote.repeated += (reported - hits.len()) as u64;
        self.vote.rays += 1;
        self.seen.clear();

        let point = [sample(column, self.spec.bits), sample(row, self.spec.bits)];
        let pixel = row * self.spec.size.width + column;
        let mut unjoined = hits.iter().peekable();
        for reach in active {
            let c = &candidates[reach.candidate];
            while let Some(stray) = unjoined.next_if(|hit| hit.prim < c.prim) {
                self.stray(pixel, point, *stray);
            }
            let t = unjoined.next_if(|hit| hit.prim == c.prim).map(|hit| hit.t);
            self.pair(pixel, c.prim, Some(&c.setup), &c.triangle, point, t);
        }
        for stray in unjoined {
            self.stray(pixel, point, *stray);
        }
        self.order(pixel);
        self.hits = hits;
        Ok(())
    }

    /// A hit on a triangle that is nowhere near, or has no area, is judged too.
    fn stray(&mut self, pixel: u32, point: [i64; 2], hit: Hit) {
        let setup = Setup::new(self.spec, hit.prim);
        let triangle = Triangle::new(self.spec, &self.embree.depth(), hit.prim);
        self.pair(
            pixel,
            hit.prim,
            setup.as_ref(),
            &triangle,
            point,
            Some(hit.t),
        );
    }

    fn pair(
        &mut self,
        pixel: u32,
        prim: u32,
        setup: Option<&Setup>,
        triangle: &Triangle,
        point: [i64; 2],
        hit: Option<f32>,
    ) {
        let edges = setup.map_or_else(|| flat_edges(self.spec, prim, point), |s| s.edges(point));
        let covered = setup.is_some_and(|s| s.covers(edges));
        let agree = u64::from(covered == hit.is_some());
        let vote = &mut self.vote;
        vote.pairs += 1;
        if is_edge(edges) {
            vote.edge += 1;
            vote.edge_agreeing += agree;
            return;
        }
        let promise = triangle.promise(point);
        if promise == Promise::Unresolved {
            vote.unresolved += 1;
            vote.unresolved_agreeing += agree;
            return;
        }
        // What is expected is the spec's word; the promise only says that Embree
        // is able to give it, and how precise its depth is.
        match (setup, promise, hit) {
            (Some(setup), Promise::Hit { bound }, Some(t)) if covered => {
                self.depth(pixel, prim, setup.key(edges), bound, t);
            }
            (_, _, None) if covered => {
                vote.missed += 1;
                self.conflict(pixel, prim, Conflict::Missed);
            }
            (_, _, Some(_)) => {
                vote.invented += 1;
                self.conflict(pixel, prim, Conflict::Invented);
            }
            (_, _, None) => {}
        }
    }

    /// Compares a depth, and notes it for [`Self::order`].
    fn depth(&mut self, pixel: u32, prim: u32, key: u32, bound: f64, t: f32) {
        // The key is the floor of the exact depth: one key more on that side.
        let bound = bound + 1.0;
        let (exact, embree) = (f64::from(key), self.embree.depth().key(t));
        let error_keys = (embree - exact).abs();
        let error = error_keys / bound;
        self.vote.depths += 1;
        self.vote.error_keys = self.vote.error_keys.max(error_keys);
        self.vote.error_over_bound = self.vote.error_over_bound.max(error);
        if error > 1.0 || error.is_nan() {
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
    fn order(&mut self, pixel: u32) {
        let mut seen = std::mem::take(&mut self.seen);
        let disorder = |prim| self.conflict(pixel, prim, Conflict::Order);
        let (steps, disordered) = order::judge(&mut seen, disorder);
        self.vote.steps += steps;
        self.vote.steps_disordered += disordered;
        self.seen = seen;
    }

    fn conflict(&mut self, pixel: u32, prim: u32, conflict: Conflict) {
        self.vote.keep(Disagreement {
            pixel,
            prim,
            conflict,
        });
    }
}
