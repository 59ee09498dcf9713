//! Queues: the same rays, in any order.

use triptych_spec::dispatch::{Carried, Ray};
use triptych_spec::rsm::Colour;

use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

/// What is exact of a ray: all but the light that it carries.
type Key = ((u32, u32), [i32; 3], [i32; 3], bool, [u32; 3]);

fn key(ray: &Ray) -> Key {
    let weight = match ray.carried {
        Carried::Weight(weight) => weight,
        Carried::Light(_) => [u32::MAX; 3],
    };
    let way = ray.way;
    let whose = (ray.pixel, ray.depth);
    (whose, way.origin, way.direction, way.segment, weight)
}

/// Rows of rays in order of their keys.
fn order(rays: &[Ray]) -> Vec<(Key, usize)> {
    let mut order: Vec<(Key, usize)> = rays.iter().map(key).zip(0..).collect();
    order.sort_unstable();
    order
}

/// Two queues side by side.
struct Matched {
    /// Rows of rays that are in both, the spec's first.
    both: Vec<[usize; 2]>,
    /// Rows of the spec's that are missing.
    missing: Vec<usize>,
    /// Rows of a leg's that are too many.
    more: Vec<usize>,
}

fn matched(must: &[Ray], seen: &[Ray]) -> Matched {
    let mut matched = Matched {
        both: Vec::new(),
        missing: Vec::new(),
        more: Vec::new(),
    };
    let [mut a, mut b] = [order(must), order(seen)].map(|all| all.into_iter().peekable());
    loop {
        match (a.peek(), b.peek()) {
            (Some((x, _)), Some((y, _))) if x == y => {
                let pair = a.next().zip(b.next()).expect("both are there");
                matched.both.push([pair.0.1, pair.1.1]);
            }
            (Some((x, _)), other) if other.is_none_or(|(y, _)| x < y) => {
                matched.missing.extend(a.next().map(|(_, row)| row));
            }
            (_, Some(_)) => matched.more.extend(b.next().map(|(_, row)| row)),
            (_, None) => return matched,
        }
    }
}

/// Stages `primary`, `light` and `reflect`: which rays are in a queue. A ray that must not be there is
/// paired with one of its pixel that is missing, and is wrong; what is missing beside these was lost, and what is
/// there beside them is too much.
pub fn shot(must: &[Ray], seen: &[Ray]) -> Judgement {
    let mut judgement = Judgement {
        compared: must.len() as u64,
        ..Judgement::new(Class::Exact, "rays")
    };
    let Matched { missing, more, .. } = matched(must, seen);
    let whose = |ray: &Ray| (ray.pixel, ray.depth);
    let [mut a, mut b] = [(&missing, must), (&more, seen)].map(|(rows, rays)| {
        let rays = rows.iter().map(|row| rays[*row]);
        rays.collect::<Vec<Ray>>().into_iter().peekable()
    });
    loop {
        let (cause, pixel, words) = match (a.peek(), b.peek()) {
            (Some(x), Some(y)) if whose(x) == whose(y) => {
                let words = format!("{y:?}, must be {x:?}");
                let pixel = x.pixel;
                a.next();
                b.next();
                (Cause::Interval, pixel, words)
            }
            (Some(x), y) if y.is_none_or(|y| whose(x) < whose(y)) => {
                let (pixel, words) = (x.pixel, format!("{x:?} is not there"));
                a.next();
                (Cause::LostNode, pixel, words)
            }
            (_, Some(y)) => {
                let (pixel, words) = (y.pixel, format!("{y:?} must not be there"));
                b.next();
                (Cause::Duplicate, pixel, words)
            }
            (_, None) => return judgement,
        };
        judgement.differs(cause, Some(pixel), || words);
    }
}

/// Stage `light`: the light that rays bring, of those that are the spec's.
pub fn lights(must: &[Ray], bounds: &[Colour], seen: &[Ray]) -> Judgement {
    let mut judgement = Judgement::new(Class::Interval, "lights");
    let mut largest = [0.0_f64; 2];
    for [own, other] in matched(must, seen).both {
        let Carried::Light(light) = seen[other].carried else {
            continue;
        };
        judgement.compared += 1;
        for (light, bound) in light.into_iter().zip(bounds[own]) {
            let light = f64::from(light);
            let error = (light - bound.value).abs();
            if error > 0.0 {
                largest = [largest[0].max(error), largest[1].max(error / bound.bound)];
            }
            if !bound.admits(light) {
                judgement.differs(Cause::Interval, Some(must[own].pixel), || {
                    format!("{:?} brings {light:e}, must bring {bound:?}", seen[other])
                });
                break;
            }
        }
    }
    judgement.error = Some(largest[0]);
    judgement.error_over_bound = Some(largest[1]);
    judgement
}

/// An attempt with too little room: as many attempts as the spec has rays, and as many of them as there is room
/// for, each of them the spec's.
pub fn overflow(must: &[Ray], [capacity, attempts]: [u32; 2], seen: &[Ray]) -> Judgement {
    let mut judgement = Judgement {
        compared: must.len() as u64,
        ..Judgement::new(Class::Structure, "rays")
    };
    let stored = must.len().min(capacity as usize);
    if attempts as usize != must.len() || seen.len() != stored {
        judgement.differs(Cause::Overflow, None, || {
            format!(
                "{attempts} attempts and {} rays with room for {capacity}, must be {} and {stored}",
                seen.len(),
                must.len()
            )
        });
    }
    for row in matched(must, seen).more {
        let ray = &seen[row];
        judgement.differs(Cause::Duplicate, Some(ray.pixel), || {
            format!("{ray:?} must not be there")
        });
    }
    judgement
}
