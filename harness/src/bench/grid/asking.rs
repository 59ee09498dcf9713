//! Rays of a kind, what the spec says of them, and whether others say the same.

use rayon::prelude::*;
use triptych_spec::grid::hit::crossing;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::{Closest, Query, closest};
use triptych_spec::grid::{Blockers, Grid};

use super::cpu::{Rivals, of_embree};
use super::{RAYS_OF_CPU, RAYS_OF_SPEC};
use crate::compare::embree::compare_rays;
use crate::compare::grid::Asked;
use crate::embree::rays::bound::{Pair, pair};
use crate::rays::{Kind, Source, view};

/// Rays of a kind; answers to as many of them as are timed.
pub(super) struct Asking {
    pub(super) kind: &'static str,
    pub(super) rays: Vec<Ray>,
    answers: Vec<Option<Closest>>,
    /// Of [`RAYS_OF_CPU`] rays, any and closest.
    compared: [Compared; 2],
}

/// How Embree and `obvhs` decide, beside the spec.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Compared {
    /// Rays that each decides unlike the spec.
    pub(super) unlike: [u64; 2],
    /// Why one is not measured.
    pub(super) refused: [Option<String>; 2],
}

impl Asking {
    /// Draws `count` rays of each kind; the spec answers them, if `boards` trace them, or else
    /// what CPUs and software drivers trace.
    pub(super) fn all(
        (blockers, grid): (&Blockers, &Grid),
        seed: u64,
        (count, boards): (u32, bool),
        rivals: &Rivals,
    ) -> Vec<Self> {
        let mut source = Source::new(blockers, grid, seed);
        let mut drawn = Vec::new();
        for kind in [Kind::Random, Kind::Aimed] {
            let rays: Vec<Ray> = (0..count).map(|_| source.next(kind)).collect();
            drawn.push((kind.name(), rays));
        }
        drawn.push(("view", view(grid, count)));
        let answered = |(kind, rays): (&'static str, Vec<Ray>)| {
            let timed = match boards {
                true => rays.len(),
                false => rays.len().min(RAYS_OF_CPU),
            };
            let timed = rays[..timed].par_iter();
            let answers = timed.map(|ray| closest(grid, blockers, *ray)).collect();
            let mut own = Self {
                kind,
                rays,
                answers,
                compared: Default::default(),
            };
            let asked = own.asked(blockers, RAYS_OF_CPU);
            own.compared =
                [Query::Any, Query::Closest].map(|query| rivals.compare(grid, asked, query));
            own
        };
        drawn.into_iter().map(answered).collect()
    }

    /// The first so many rays, as far as there are answers.
    pub(super) fn asked<'a>(&'a self, blockers: &'a Blockers, count: usize) -> Asked<'a> {
        let count = count.min(self.answers.len());
        Asked {
            blockers,
            rays: &self.rays[..count],
            answers: &self.answers[..count],
        }
    }

    /// How rivals decide.
    pub(super) fn rivals(&self, query: Query) -> &Compared {
        &self.compared[usize::from(query == Query::Closest)]
    }

    /// Rays that a leg on the CPU traces in a round.
    pub(super) fn on_cpu(&self, spec: bool) -> &[Ray] {
        let count = if spec { RAYS_OF_SPEC } else { RAYS_OF_CPU };
        &self.rays[..count.min(self.rays.len())]
    }
}

impl Rivals {
    /// Holds both against the spec. Embree must agree wherever the bounds of its arithmetic say
    /// that it can. None are derived for `obvhs`, which also rounds in `f32` and decides by the
    /// same volumes: it may be unlike the spec on as many rays as are in class edge for Embree.
    fn compare(&self, grid: &Grid, asked: Asked<'_>, query: Query) -> Compared {
        let unlike = [
            unlike(asked, query, |ray| of_embree(&self.embree, query, ray)),
            unlike(asked, query, |ray| self.obvhs.meets(query, ray)),
        ];
        let vote = compare_rays(grid, asked.blockers, asked.rays, query, &self.embree);
        let refused = match vote {
            Err(error) => [Some(error.to_string()), None],
            Ok(vote) => [
                (vote.disagree > 0).then(|| format!("unlike the spec: {vote}")),
                (unlike[1] > vote.edge).then(|| {
                    let (differ, rays, edge) = (unlike[1], asked.rays.len(), vote.edge);
                    format!(
                        "decides {differ} of {rays} rays unlike the spec, and {edge} are in \
                         class edge"
                    )
                }),
            ],
        };
        Compared { unlike, refused }
    }
}

/// Rays of which a tracer says what the spec does not: whether anything is met; of closest hits
/// also that a triangle is met which is not, or is later than the bounds of `f32` explain.
fn unlike(asked: Asked<'_>, query: Query, met: impl Fn(&Ray) -> Option<Option<u32>> + Sync) -> u64 {
    let differs = |(ray, answer): (&Ray, &Option<Closest>)| match (answer, met(ray)) {
        (None, None) => false,
        (Some(_), Some(_)) if query == Query::Any => false,
        (Some(first), Some(Some(prim))) => prim != first.prim && is_later(asked, ray, prim, first),
        _ => true,
    };
    let pairs = asked.rays.par_iter().zip(asked.answers);
    pairs.filter(|pair| differs(*pair)).count() as u64
}

/// Whether a triangle is not met, or so much later than the first that no rounding explains it:
/// by Embree's bounds.
fn is_later(asked: Asked<'_>, ray: &Ray, prim: u32, first: &Closest) -> bool {
    let corners = [prim, first.prim].map(|prim| asked.blockers.corners(prim));
    match crossing(ray, corners[0]) {
        None => true,
        Some(time) if time == first.time => false,
        Some(_) => match corners.map(|corners| pair(ray, corners)) {
            [
                Pair::Inside(own) | Pair::Edge(Some(own)),
                Pair::Inside(first) | Pair::Edge(Some(first)),
            ] => own.earliest() > first.latest(),
            _ => true,
        },
    }
}

#[cfg(test)]
mod tests {
    use triptych_spec::grid::resolution::Resolution;
    use triptych_spec::grid::{Blockers, Grid, Membership};

    use super::{Asking, Compared, Query, Rivals, unlike};

    /// Two sheets behind each other, as large as the box.
    fn sheets() -> Blockers {
        let sheet = |z| [[-4096, -4096, z], [8192, -4096, z], [-4096, 8192, z]];
        Blockers {
            vertices: [sheet(0), sheet(4096)].concat(),
            triangles: vec![[0, 1, 2], [3, 4, 5]],
        }
    }

    #[test]
    fn who_misses_or_takes_another_is_counted() {
        let blockers = sheets();
        let grid = Grid::build(&blockers, Resolution::FromScene, Membership::Box);
        let grid = grid.expect("within the limits");
        let rivals = Rivals::new(&blockers).expect("Embree builds");
        let kinds = Asking::all((&blockers, &grid), 3, (2000, false), &rivals);
        let [random, _, through] = &kinds[..] else {
            panic!("three kinds");
        };
        let asked = through.asked(&blockers, 2000);
        let met = asked.answers.iter().flatten().count() as u64;
        assert!(
            (100..1900).contains(&met),
            "{met} of 2000 rays meet something"
        );
        for query in [Query::Any, Query::Closest] {
            assert_eq!(unlike(asked, query, |_| None), met, "misses everything");
            let all = unlike(asked, query, |_| Some(Some(0)));
            assert!(all >= 2000 - met, "{all}: meets everything");
        }
        let both = |answers: &[Option<super::Closest>]| {
            let rays = asked.rays.iter().zip(answers);
            let both = rays.filter(|(ray, first)| {
                let behind = first.map(|first| blockers.corners(1 - first.prim));
                behind.is_some_and(|corners| super::crossing(ray, corners).is_some())
            });
            both.count() as u64
        };
        // Each answer but the nearest is wrong, whether it is met or not.
        let other = |ray: &super::Ray| {
            let first = super::closest(&grid, &blockers, *ray)?;
            Some(Some(1 - first.prim))
        };
        assert_eq!(unlike(asked, Query::Closest, other), met);
        assert_eq!(unlike(asked, Query::Any, other), 0, "any will do");
        assert!(both(asked.answers) > 50, "some pass both sheets");
        // Segments between random points: neither has anything to err about.
        assert_eq!(*random.rivals(Query::Any), Compared::default());
        assert_eq!(*random.rivals(Query::Closest), Compared::default());
    }

    #[test]
    fn who_is_too_unlike_is_refused() {
        let blockers = sheets();
        let grid = Grid::build(&blockers, Resolution::FromScene, Membership::Box);
        let grid = grid.expect("within the limits");
        // Trees of one of both sheets: they miss the other.
        let other = Blockers {
            triangles: vec![[0, 1, 2]],
            ..sheets()
        };
        let rivals = Rivals::new(&other).expect("Embree builds");
        let kinds = Asking::all((&blockers, &grid), 3, (2000, false), &rivals);
        for asking in &kinds {
            for query in [Query::Any, Query::Closest] {
                let Compared { unlike, refused } = asking.rivals(query);
                assert!(unlike.iter().all(|n| *n > 50), "{unlike:?}");
                let [embree, obvhs] = refused.each_ref().map(|why| why.as_deref());
                let embree = embree.expect("misses what it must meet");
                assert!(embree.starts_with("unlike the spec: "), "{embree}");
                let obvhs = obvhs.expect("misses what it must meet");
                assert!(obvhs.contains("of 2000 rays unlike the spec"), "{obvhs}");
            }
        }
    }
}
