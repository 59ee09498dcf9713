//! Stage `trace`: a kernel's answers to rays.

use triptych_gpu::grid::Hit;
use triptych_spec::abuffer::NOTHING;
use triptych_spec::bound::Bounded;
use triptych_spec::grid::Blockers;
use triptych_spec::grid::hit::{crossing, timed};
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::Closest;

use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

/// Rays and the spec's answers.
#[derive(Clone, Copy)]
pub struct Asked<'a> {
    /// What blocks them.
    pub blockers: &'a Blockers,
    /// The rays.
    pub rays: &'a [Ray],
    /// What each meets first.
    pub answers: &'a [Option<Closest>],
}

impl Asked<'_> {
    /// A triangle that a ray meets; `None` if a kernel made it up.
    fn corners_of(&self, prim: u32) -> Option<[[i32; 3]; 3]> {
        let known = (prim as usize) < self.blockers.triangles.len();
        known.then(|| self.blockers.corners(prim))
    }

    /// What a hit is wrong about before its time is looked at.
    fn unmet(&self, ray: &Ray, answer: Option<Closest>, hit: &Hit) -> Option<String> {
        let met = hit.prim != NOTHING;
        match answer {
            None if met => Some(format!("meets {} and must meet nothing", hit.prim)),
            Some(first) if !met => Some(format!("meets nothing and must meet {}", first.prim)),
            Some(_) => {
                let corners = self.corners_of(hit.prim);
                let is_met = corners.is_some_and(|c| crossing(ray, c).is_some());
                (!is_met).then(|| format!("meets {}, which it does not", hit.prim))
            }
            None => None,
        }
    }
}

/// Any hit, exact: a ray is blocked if and only if something blocks it, and the blocker that a
/// kernel names does.
pub fn any(asked: Asked<'_>, seen: &[Hit]) -> Judgement {
    let mut judgement = rays(Class::Exact, asked, seen);
    let answers = asked.rays.iter().zip(asked.answers).zip(seen);
    for (at, ((ray, answer), hit)) in answers.enumerate() {
        if let Some(wrong) = asked.unmet(ray, *answer, hit) {
            judgement.differs(Cause::Coverage, None, || {
                format!("ray {at}, {ray:?}, {wrong}")
            });
        }
    }
    let blocked = asked.answers.iter().flatten().count();
    judgement.note = format!("any hit: {blocked} blocked");
    judgement
}

/// Closest hit, a decision: what a kernel names is met, its time is within the bound, and the
/// nearest, whose time a kernel may have as late as its own bound, is not before it. Where bounds
/// leave open which comes first, either may; those rays are counted as admitted if the kernel took
/// another than the spec.
pub fn closest(asked: Asked<'_>, seen: &[Hit]) -> Judgement {
    let mut judgement = rays(Class::Decision, asked, seen);
    let mut largest = [0.0_f64; 2];
    let answers = asked.rays.iter().zip(asked.answers).zip(seen);
    for (at, ((ray, answer), hit)) in answers.enumerate() {
        if let Some(wrong) = asked.unmet(ray, *answer, hit) {
            judgement.differs(Cause::Coverage, None, || {
                format!("ray {at}, {ray:?}, {wrong}")
            });
            continue;
        }
        let Some(first) = answer else { continue };
        let [time, nearest] = [hit.prim, first.prim].map(|prim| time_of(asked, ray, prim));
        let seen = f64::from(hit.time);
        let error = (seen - time.value).abs();
        if !time.admits(seen) {
            judgement.differs(Cause::Interval, None, || {
                format!(
                    "ray {at} meets {} at {seen:e}, must at {:e}",
                    hit.prim, time.value
                )
            });
            continue;
        }
        if error > 0.0 {
            largest = [largest[0].max(error), largest[1].max(error / time.bound)];
        }
        if seen > nearest.value + nearest.bound {
            judgement.differs(Cause::DepthKey, None, || {
                let (other, at_first) = (hit.prim, nearest.value);
                format!(
                    "ray {at} meets {other} at {seen:e}, and {} at {at_first:e}",
                    first.prim
                )
            });
        } else if hit.prim != first.prim {
            judgement.admitted += 1;
        }
    }
    judgement.error = Some(largest[0]);
    judgement.error_over_bound = Some(largest[1]);
    judgement.note = "closest hit".to_owned();
    judgement
}

fn time_of(asked: Asked<'_>, ray: &Ray, prim: u32) -> Bounded {
    timed(ray, asked.blockers.corners(prim)).expect("a triangle that is met")
}

fn rays(class: Class, asked: Asked<'_>, seen: &[Hit]) -> Judgement {
    let mut judgement = Judgement {
        compared: asked.rays.len() as u64,
        ..Judgement::new(class, "rays")
    };
    if seen.len() != asked.rays.len() {
        judgement.differs(Cause::ReferenceMissing, None, || {
            format!("{} answers to {} rays", seen.len(), asked.rays.len())
        });
    }
    judgement
}
