//! Rays in queues: what stages shoot, what rays meet and where, and what they bring to the picture.

mod rays;
#[cfg(test)]
mod tests;

use triptych_spec::dispatch::{Met, Ray, Sums};
use triptych_spec::rsm::Surface;

use super::Judgement;
use crate::cause::Cause;
use crate::row::Class;

pub use rays::{lights, overflow, shot};

/// Stage `intersect`: what each ray meets.
pub fn met(rays: &[Ray], must: &[Met], seen: &[Met]) -> Judgement {
    let mut judgement = counted("rays", must.len(), seen.len());
    for ((ray, must), seen) in rays.iter().zip(must).zip(seen) {
        if must != seen {
            judgement.differs(Cause::Coverage, Some(ray.pixel), || {
                format!("{ray:?} meets {seen:?} and must meet {must:?}")
            });
        }
    }
    judgement
}

/// Stage `locate`: triangle, side and point of what each ray meets.
pub fn located(rays: &[Ray], must: &[Option<Surface>], seen: &[Option<Surface>]) -> Judgement {
    let mut judgement = Judgement {
        compared: must.iter().flatten().count() as u64,
        ..Judgement::new(Class::Exact, "points")
    };
    if seen.len() != must.len() {
        judgement.differs(Cause::ReferenceMissing, None, || {
            format!("{} answers to {} rays", seen.len(), must.len())
        });
    }
    for ((ray, must), seen) in rays.iter().zip(must).zip(seen) {
        if must == seen {
            continue;
        }
        let triangle = |s: &Option<Surface>| s.map(|s| s.triangle);
        let cause = match triangle(must) == triangle(seen) {
            true => Cause::Vertex,
            false => Cause::Coverage,
        };
        judgement.differs(cause, Some(ray.pixel), || {
            format!("{ray:?} is at {seen:?}, must be at {must:?}")
        });
    }
    judgement
}

/// Stage `deposit`: a picture's sums, which are integers.
pub fn sums(must: &Sums, seen: &Sums) -> Judgement {
    let mut judgement = counted("pixels", must.pixels.len(), seen.pixels.len());
    for (pixel, (must, seen)) in (0..).zip(must.pixels.iter().zip(&seen.pixels)) {
        if must != seen {
            judgement.differs(Cause::Interval, Some(pixel), || {
                format!("pixel {pixel} is {seen:?} units, must be {must:?}")
            });
        }
    }
    judgement
}

/// The picture of a leg's own rays: light within its bound.
pub fn picture(must: &Sums, bounds: &[[f64; 3]], seen: &Sums) -> Judgement {
    let mut judgement = Judgement {
        class: Class::Interval,
        ..counted("pixels", must.pixels.len(), seen.pixels.len())
    };
    let mut largest = [0.0_f64; 2];
    for (pixel, bound) in bounds.iter().enumerate().take(seen.pixels.len()) {
        let [must, light] = [must, seen].map(|sums| sums.light(pixel));
        for channel in 0..3 {
            let error = (light[channel] - must[channel]).abs();
            if error == 0.0 {
                continue;
            }
            largest = [
                largest[0].max(error),
                largest[1].max(error / bound[channel]),
            ];
            if error > bound[channel] {
                let at = u32::try_from(pixel).ok();
                judgement.differs(Cause::Interval, at, || {
                    format!("pixel {pixel} is {light:?}, must be {must:?} within {bound:?}")
                });
                break;
            }
        }
    }
    judgement.error = Some(largest[0]);
    judgement.error_over_bound = Some(largest[1]);
    judgement
}

/// An exact comparison of so many items with so many; a difference if there are others.
fn counted(unit: &'static str, must: usize, seen: usize) -> Judgement {
    let mut judgement = Judgement {
        compared: must as u64,
        ..Judgement::new(Class::Exact, unit)
    };
    if must != seen {
        judgement.differs(Cause::ReferenceMissing, None, || {
            format!("{seen} {unit} in place of {must}")
        });
    }
    judgement
}
