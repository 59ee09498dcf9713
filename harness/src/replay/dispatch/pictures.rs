//! What people look at: the picture, and how many rays each pixel asks for.

use triptych_spec::dispatch::Sums;

use super::spec::DispatchRun;
use crate::picture::{self, Image};
use crate::replay::exposure::{self, single, toned};
use crate::replay::pictures;
use crate::replay::rows::Spot;
use crate::report::Picture;

/// The spec's pictures.
pub(super) fn spec(run: &DispatchRun) -> Vec<Picture> {
    let size = run.setup.world.eye.size;
    let mut rays = vec![0; size.pixels()];
    let all = run
        .bounces
        .iter()
        .flat_map(|b| b.rays.iter().chain(&b.shadows));
    all.for_each(|ray| rays[ray.pixel as usize] += 1);
    vec![
        Picture {
            title: "spec".into(),
            caption: "Light of the lamps and of the background, and what mirrors show of it.".into(),
            image: exposed(run, &light(&run.sums)),
        },
        Picture {
            title: "rays".into(),
            caption: "How many rays each pixel asks for: its own, shadow rays to the lamps, mirror rays, \
                      and theirs. Where neighbours differ, threads that share nothing get unequal work."
                .into(),
            image: picture::counts(size, &rays),
        },
    ]
}

/// A GPU leg's picture.
pub(super) fn gpu(run: &DispatchRun, label: &str, sums: &Sums) -> Vec<Picture> {
    let (own, made) = (light(&run.sums), light(sums));
    let shown = Picture {
        title: label.to_owned(),
        caption: "What this leg makes of the scene, from its own rays.".into(),
        image: exposed(run, &made),
    };
    let size = run.setup.world.eye.size;
    let difference = pictures::difference(label, size, &single(&own), &single(&made));
    [shown].into_iter().chain(difference).collect()
}

/// Which pixels differ, and why, over the spec's picture; `None` if none does.
pub(super) fn causes(run: &DispatchRun, spots: &[Spot]) -> Option<Picture> {
    if spots.is_empty() {
        return None;
    }
    let picture = toned(&light(&run.sums), exposure(run));
    let marks = spots.iter().map(|spot| (spot.pixel, Some(spot.cause)));
    Some(Picture {
        title: "causes".into(),
        caption: "Pixels that differ in any leg, over the spec's picture.".into(),
        image: picture::causes(run.setup.world.eye.size, Some(&single(&picture)), marks),
    })
}

/// Linear light of all pixels.
pub(super) fn light(sums: &Sums) -> Vec<[f64; 3]> {
    (0..sums.pixels.len())
        .map(|pixel| sums.light(pixel))
        .collect()
}

/// By what all pictures are multiplied.
fn exposure(run: &DispatchRun) -> f64 {
    exposure::exposure(light(&run.sums).into_iter())
}

/// A picture as all are shown.
fn exposed(run: &DispatchRun, pixels: &[[f64; 3]]) -> Image {
    exposure::exposed(run.setup.world.eye.size, pixels, exposure(run))
}
