//! Rays through a grid against Embree's answers.
//!
//! A pair is a ray and a triangle; [`pair`] puts it into class *inside*, *outside* or
//! *edge*, from the two alone. The classes of a ray's pairs decide what Embree must say:
//!
//! - *Any*: with a pair inside it must be blocked. With none, and none in class edge, it must
//!   not. Otherwise the ray is in class edge.
//! - *Closest*: Embree visits every pair inside, so it reports something no later than
//!   `limit`, the least of what is the latest that it may see each of them. Where a pair in
//!   class edge may be seen as early, the ray is in class edge: what is reported must still
//!   not be outside. Otherwise it must be inside. Wherever a pair has a time, Embree's is
//!   within the bound of the exact one.
//!
//! **Which triangles.** What is inside is met, hence listed in a cell that the ray passes;
//! so only those listed are looked at. One that is not listed passes the ray by, but maybe
//! by so little that it is in class edge: it lies more than the widening of cells, 8 steps,
//! from the ray, and Embree may be off by more than that far from a ray's origin. Therefore,
//! where Embree reports what none of those listed explains, all triangles are looked at
//! before it is called wrong. The class of a pair still does not depend on what Embree said,
//! only whether it is worked out. A pair inside that turns up in this way is the grid's
//! error, and counts as a disagreement.

mod vote;

use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::{self, Query};
use triptych_spec::grid::walk::Walk;
use triptych_spec::grid::{Blockers, Grid};

use crate::dispatch::share;
use crate::embree::rays::RayAnswers;
use crate::embree::rays::bound::{Met, Pair, pair};
use crate::embree::{EmbreeError, Hit};
pub use vote::{OfKind, RayConflict, RayDisagreement, RayVote};

/// Rays that one task works through; the result does not depend on it.
const CHUNK: usize = 1024;

/// Compares what the blockers of a grid do to rays with what Embree says of them.
///
/// # Errors
/// The first error that Embree reports, in order of rays.
pub fn compare_rays<E: RayAnswers>(
    grid: &Grid,
    blockers: &Blockers,
    rays: &[Ray],
    query: Query,
    embree: &E,
) -> Result<RayVote, EmbreeError> {
    let chunks: Vec<_> = rays.chunks(CHUNK).enumerate().collect();
    let chunks: Vec<Result<RayVote, EmbreeError>> = share::map(&chunks, 1, |(chunk, rays)| {
        let mut judge = Judge {
            grid,
            blockers,
            embree,
            vote: RayVote::default(),
            listed: Vec::new(),
        };
        for (row, ray) in (chunk * CHUNK..).zip(*rays) {
            judge.ray(row, ray, query);
        }
        embree.check()?;
        Ok(judge.vote)
    });
    let mut total = RayVote::default();
    for chunk in chunks {
        total.add(chunk?);
    }
    Ok(total)
}

/// The same, with class edge counted for each kind; `kinds` are names and where each kind ends
/// in `rays`, rising. Rays behind the last are not asked.
///
/// # Errors
/// The first error that Embree reports, in order of rays.
pub fn compare_kinds<E: RayAnswers>(
    grid: &Grid,
    blockers: &Blockers,
    rays: &[Ray],
    kinds: impl IntoIterator<Item = (&'static str, usize)>,
    query: Query,
    embree: &E,
) -> Result<RayVote, EmbreeError> {
    let mut total = RayVote::default();
    let mut start = 0;
    for (name, end) in kinds {
        let vote = compare_rays(grid, blockers, &rays[start..end], query, embree)?;
        total.add_kind(name, vote, start);
        start = end;
    }
    Ok(total)
}

/// Judges rays one after another.
struct Judge<'a, E> {
    grid: &'a Grid,
    blockers: &'a Blockers,
    embree: &'a E,
    vote: RayVote,
    /// The triangles that the ray's cells list, rising.
    listed: Vec<u32>,
}

impl<E: RayAnswers> Judge<'_, E> {
    fn ray(&mut self, row: usize, ray: &Ray, query: Query) {
        self.vote.rays += 1;
        if !ray.moves() {
            self.vote.still += 1;
            return;
        }
        self.listed.clear();
        for passed in Walk::new(self.grid, *ray) {
            self.listed.extend(self.grid.list(passed.cell));
        }
        self.listed.sort_unstable();
        self.listed.dedup();
        let conflict = match query {
            Query::Any => self.any(ray),
            Query::Closest => self.closest(ray),
        };
        if let Some(conflict) = conflict {
            self.vote.differs(RayDisagreement { ray: row, conflict });
        }
    }

    fn pair(&self, ray: &Ray, prim: u32) -> Pair {
        pair(ray, self.blockers.corners(prim))
    }

    fn is_listed(&self, prim: u32) -> bool {
        self.listed.binary_search(&prim).is_ok()
    }

    fn any(&mut self, ray: &Ray) -> Option<RayConflict> {
        let mut edge = false;
        let mut inside = None;
        for &prim in &self.listed {
            match self.pair(ray, prim) {
                Pair::Inside(_) => {
                    inside = Some(prim);
                    break;
                }
                Pair::Edge(_) => edge = true,
                Pair::Outside => {}
            }
        }
        let occluded = self.embree.occluded(ray);
        if let Some(prim) = inside {
            return (!occluded).then_some(RayConflict::Missed { prim });
        }
        if occluded && !edge {
            match self.unlisted(ray) {
                Some(Unlisted::Inside(prim)) => return Some(RayConflict::Unlisted { prim }),
                Some(Unlisted::Edge) => edge = true,
                None => return Some(RayConflict::Invented),
            }
        }
        if edge {
            let blocked = trace::blocked(self.grid, self.blockers, *ray);
            self.vote.edge(blocked == occluded);
        }
        None
    }

    /// What explains that Embree reports something, beyond what is listed.
    fn unlisted(&self, ray: &Ray) -> Option<Unlisted> {
        let mut edge = None;
        for prim in (0_u32..).take(self.blockers.triangles.len()) {
            if !self.is_listed(prim) {
                match self.pair(ray, prim) {
                    Pair::Inside(_) => return Some(Unlisted::Inside(prim)),
                    Pair::Edge(_) => edge = Some(Unlisted::Edge),
                    Pair::Outside => {}
                }
            }
        }
        edge
    }

    fn closest(&mut self, ray: &Ray) -> Option<RayConflict> {
        let mut expected = Expected::new(ray);
        for &prim in &self.listed {
            expected.add(prim, self.pair(ray, prim));
        }
        let hit = self.embree.closest(ray);
        let reported = hit.map(|hit| self.reported(ray, hit));
        let conflict = match (hit, reported) {
            (None, _) => expected.nearest.map(|prim| RayConflict::Missed { prim }),
            (Some(hit), Some(Pair::Outside)) => Some(RayConflict::Wrong { prim: hit.prim }),
            (Some(hit), Some(Pair::Inside(_))) if !self.is_listed(hit.prim) => {
                Some(RayConflict::Unlisted { prim: hit.prim })
            }
            (Some(hit), Some(Pair::Inside(met) | Pair::Edge(Some(met)))) => {
                self.time(hit, met).or_else(|| expected.late(hit))
            }
            (Some(hit), _) => expected.late(hit),
        };
        // What is reported may be in class edge without being listed.
        if expected.is_edge() || matches!(reported, Some(Pair::Edge(_))) && conflict.is_none() {
            let own = trace::closest(self.grid, self.blockers, *ray);
            let agree = own.map(|own| own.prim) == hit.map(|hit| hit.prim);
            self.vote.edge(agree && conflict.is_none());
        }
        conflict
    }

    /// The pair that Embree says is met first; outside if there is no such triangle.
    fn reported(&self, ray: &Ray, hit: Hit) -> Pair {
        match (hit.prim as usize) < self.blockers.triangles.len() {
            true => self.pair(ray, hit.prim),
            false => Pair::Outside,
        }
    }

    /// Compares Embree's time with the exact one.
    fn time(&mut self, hit: Hit, met: Met) -> Option<RayConflict> {
        let error = (f64::from(hit.t) - met.t).abs();
        let within = error <= met.bound; // not if t is no number
        self.vote.times += 1;
        if within {
            self.vote.error = self.vote.error.max(error);
        }
        let ratio = if error.is_nan() {
            f64::INFINITY
        } else {
            error / met.bound
        };
        self.vote.error_over_bound = self.vote.error_over_bound.max(ratio);
        (!within).then_some(RayConflict::Time {
            prim: hit.prim,
            t: met.t,
            bound: met.bound,
            embree: hit.t,
        })
    }
}

/// What triangles that no cell on the way lists may be.
enum Unlisted {
    Inside(u32),
    Edge,
}

/// What must come first along a ray.
struct Expected {
    /// The pair inside that sets the limit.
    nearest: Option<u32>,
    /// The latest time at which Embree sees something.
    limit: f64,
    /// The earliest time at which it may see a pair in class edge.
    edge: f64,
}

impl Expected {
    fn new(ray: &Ray) -> Self {
        Self {
            nearest: None,
            limit: if ray.segment { 1.0 } else { f64::INFINITY },
            edge: f64::INFINITY,
        }
    }

    fn add(&mut self, prim: u32, pair: Pair) {
        match pair {
            Pair::Inside(met) if met.latest() < self.limit => {
                (self.nearest, self.limit) = (Some(prim), met.latest());
            }
            Pair::Edge(Some(met)) => self.edge = self.edge.min(met.earliest()),
            Pair::Edge(None) => self.edge = f64::NEG_INFINITY,
            Pair::Inside(_) | Pair::Outside => {}
        }
    }

    /// Whether a pair in class edge may come first.
    fn is_edge(&self) -> bool {
        self.edge < f64::INFINITY && self.edge <= self.limit
    }

    /// Whether Embree reports something behind what it must see, or behind the ray's end.
    fn late(&self, hit: Hit) -> Option<RayConflict> {
        let late = hit.t.is_nan() || f64::from(hit.t) > self.limit;
        late.then_some(RayConflict::Late {
            prim: hit.prim,
            embree: hit.t,
            limit: self.limit,
        })
    }
}
