//! What a grid's walk finds, against every triangle.

use triptych_spec::grid::Blockers;
use triptych_spec::grid::hit::crossing;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::Closest;

use super::Asked;
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::dispatch::share;
use crate::row::Class;

/// Rays of a piece of work.
const RAYS: usize = 16;

/// What a ray meets first of all triangles, whatever any cell lists; of those that are met
/// at one time, the first.
fn nearest_of_all(blockers: &Blockers, ray: &Ray) -> Option<Closest> {
    let rows = (0_u32..).take(blockers.triangles.len());
    let met = rows.filter_map(|prim| {
        let time = crossing(ray, blockers.corners(prim))?;
        Some(Closest { prim, time })
    });
    met.reduce(|a, b| if b.time < a.time { b } else { a })
}

/// What each ray meets first of all triangles. The work is spread over all cores.
pub fn nearest_of_each(blockers: &Blockers, rays: &[Ray]) -> Vec<Option<Closest>> {
    let nearest = |ray: &Ray| nearest_of_all(blockers, ray);
    share::map(rays, RAYS, nearest)
}

/// Answers by way of a grid against those by way of none: the same triangle at the same
/// time, exactly. A grid may leave out no cell and no triangle that matters.
pub fn exhaustive(asked: Asked<'_>, nearest: &[Option<Closest>]) -> Judgement {
    let mut judgement = Judgement {
        compared: asked.rays.len() as u64,
        ..Judgement::new(Class::Exact, "rays")
    };
    let answers = asked.rays.iter().zip(asked.answers).zip(nearest);
    for (at, ((ray, own), nearest)) in answers.enumerate() {
        if own != nearest {
            let [own, must] = [own, nearest].map(|answer| answer.map(|first| first.prim));
            judgement.differs(Cause::Coverage, None, || {
                format!("ray {at}, {ray:?}, meets {own:?} by the grid, and {must:?} of all")
            });
        }
    }
    let met = nearest.iter().flatten().count();
    judgement.note = format!("against every triangle: {met} meet one");
    judgement
}
