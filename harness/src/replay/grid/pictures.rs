//! Pictures of a grid for the report: what legs see through it, its lists, and where its rays
//! meet something.

use triptych_spec::grid::axis::Axis;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::{Query, blocked, closest};
use triptych_spec::scene::Scene;

use super::spec::GridRun;
use super::view::{Met, View};
use crate::dispatch::share;
use crate::embree::EmbreeError;
use crate::embree::rays::{RayAnswers, RayScene};
use crate::picture;
use crate::report::Picture;
use crate::text::{count, share};

/// Pixels along a side of the blocks in which hits are counted: a scene's few thousand rays
/// would be lost among as many pixels.
const BLOCK: u32 = 8;

/// What a leg sees. The caption is the same for all.
pub(super) fn leg(view: &View<'_>, label: &str, pixels: &[[f32; 3]]) -> Picture {
    let from = match view.is_cut() {
        true => ", cut through the middle as its front is closed",
        false => "",
    };
    Picture {
        title: label.into(),
        caption: format!(
            "What this leg's rays see through the grid, along {}{from} and without perspective: the first \
             triangle of each, darker where a second ray, to a light on the upper left in front, is \
             blocked.",
            view.direction(),
        ),
        image: picture::linear(view.size, pixels),
    }
}

/// What the spec sees, and three maps: entries, longest lists, hits; `None` if that would take too
/// long.
pub(super) fn spec(run: &GridRun, scene: &Scene) -> Option<[Picture; 4]> {
    let view = View::new(&run.grid)?;
    let seen: Result<_, std::convert::Infallible> =
        view.seen(scene, |rays, query| Ok(asked(run, rays, query)));
    let Ok(seen) = seen;
    Some([
        leg(&view, "spec", &seen),
        entries(run, &view),
        longest(run, &view),
        hits(run, &view),
    ])
}

/// The spec's answers, the work spread over all cores.
fn asked(run: &GridRun, rays: &[Ray], query: Query) -> Met {
    let (grid, blockers) = (&run.grid, &run.blockers);
    let met = |ray: &Ray| match query {
        Query::Any => blocked(grid, blockers, *ray).then_some((0, 0.0)),
        Query::Closest => {
            let first = closest(grid, blockers, *ray)?;
            Some((first.prim, first.time.value()))
        }
    };
    share::map(rays, 1024, met)
}

/// What Embree sees, if anyone looks.
pub(super) fn embree(run: &GridRun, scene: &Scene) -> Result<Option<Picture>, EmbreeError> {
    let Some(view) = View::new(&run.grid) else {
        return Ok(None);
    };
    let rays = RayScene::new(&run.blockers)?;
    let seen = view.seen(scene, |asked, query| {
        let met = |ray: &Ray| match query {
            Query::Any => rays.occluded(ray).then_some((0, 0.0)),
            Query::Closest => rays.closest(ray).map(|hit| (hit.prim, f64::from(hit.t))),
        };
        let met = asked.iter().map(met).collect();
        rays.check().map(|()| met)
    })?;
    Ok(Some(leg(&view, "embree", &seen)))
}

fn entries(run: &GridRun, view: &View<'_>) -> Picture {
    let [x, y, z] = run.grid.axes.each_ref().map(Axis::cells);
    let empty = run.counts.iter().filter(|count| **count == 0).count();
    let share = share(empty as f64 / run.counts.len().max(1) as f64);
    Picture {
        title: "entries".into(),
        caption: format!(
            "How full the grid is: entries in all cells behind each other, along {}. Of {x} × {y} × {z} \
             cells {share} are empty; the others list {} entries for {} triangles.",
            view.direction(),
            count(run.grid.prims.len() as u64),
            count(run.blockers.triangles.len() as u64),
        ),
        image: picture::counts(view.size, &view.columns(u32::saturating_add)),
    }
}

fn longest(run: &GridRun, view: &View<'_>) -> Picture {
    let most = run.counts.iter().copied().max().unwrap_or(0);
    let at = run.counts.iter().position(|count| *count == most);
    let [x, y, _] = run.grid.axes.each_ref().map(|axis| axis.cells() as usize);
    let at = at.unwrap_or(0);
    let [i, j, k] = [at % x, at / x % y, at / (x * y)];
    Picture {
        title: "longest list".into(),
        caption: format!(
            "What a ray meets at worst: the longest list among the cells behind each other. The longest \
             of all holds {} triangles, in cell ({i}, {j}, {k}).",
            count(most.into()),
        ),
        image: picture::counts(view.size, &view.columns(u32::max)),
    }
}

/// Where the scene's rays first meet something.
fn hits(run: &GridRun, view: &View<'_>) -> Picture {
    let mut blocks = std::collections::BTreeMap::new();
    let block = |pixel: usize| {
        let width = view.size.width as usize;
        [pixel % width, pixel / width].map(|at| at / BLOCK as usize)
    };
    let mut met = 0;
    for (ray, answer) in run.rays.iter().zip(&run.answers) {
        let Some(first) = answer else { continue };
        met += 1;
        let time = first.time.value();
        let at = |axis: usize| f64::from(ray.origin[axis]) + time * f64::from(ray.direction[axis]);
        if let Some(pixel) = view.pixel([0, 1, 2].map(at)) {
            *blocks.entry(block(pixel)).or_insert(0) += 1;
        }
    }
    let of = |pixel| blocks.get(&block(pixel)).copied().unwrap_or(0);
    let counts: Vec<u32> = (0..view.size.pixels()).map(of).collect();
    Picture {
        title: "hits".into(),
        caption: format!(
            "Where the scene's rays go: of {} that all legs are asked {} meet a triangle, here as many in \
             each block of {BLOCK} × {BLOCK} pixels.",
            count(run.rays.len() as u64),
            count(met),
        ),
        image: picture::counts(view.size, &counts),
    }
}
