//! What people look at: each frame with and without indirect shadows, by what light there is
//! without them.

use super::embree::{Seen, rmse, values};
use super::spec::RsmRun;
use crate::dump::FrameArrays;
use crate::picture::{self, Image};
use crate::replay::exposure::{self, single, toned};
use crate::replay::pictures;
use crate::replay::rows::Spot;
use crate::report::Picture;

/// The spec's pictures.
pub(super) fn spec(run: &RsmRun) -> Vec<Picture> {
    let exposure = exposure(run);
    let mut pictures = Vec::new();
    for (number, frame) in (1..).zip(&run.frames) {
        let [with, without] = [values(&frame.frame.picture), values(&run.unblocked(frame))];
        let title = |title: &str| title_of(title, number);
        pictures.push(Picture {
            title: title("spec"),
            caption: "Direct light, and one bounce of it with indirect shadows: A - B.".into(),
            image: exposed(run, &with, exposure),
        });
        pictures.push(Picture {
            title: title("without indirect shadows"),
            caption: "The same as if nothing were in the way of the bounce: buffer A alone.".into(),
            image: exposed(run, &without, exposure),
        });
        let [with, without] = [with, without].map(|p| single(&p));
        pictures.push(Picture {
            title: title("indirect shadows"),
            caption: "What the blockers keep away: the largest difference of a component of \
                      the two."
                .into(),
            image: picture::difference(run.setup.eye.size, &without, &with),
        });
    }
    pictures
}

/// Embree's pictures.
pub(super) fn embree(run: &RsmRun, seen: &[Seen]) -> Vec<Picture> {
    let exposure = exposure(run);
    let mut pictures = Vec::new();
    for (number, (frame, seen)) in (1..).zip(run.frames.iter().zip(seen)) {
        let title = |title: &str| title_of(title, number);
        let own = rmse(&values(&frame.frame.picture), &seen.reference);
        let embree = rmse(&seen.picture, &seen.reference);
        pictures.push(Picture {
            title: title("embree"),
            caption: format!(
                "The same samples, with Embree saying what is blocked. RMSE against the \
                 reference: {embree:.2e}."
            ),
            image: exposed(run, &seen.picture, exposure),
        });
        pictures.push(Picture {
            title: title("reference"),
            caption: format!(
                "Without noise: every pixel traces its own rays to its whole kernel, nothing is \
                 blurred, Embree says what is blocked. RMSE of the spec's picture against it: \
                 {own:.2e}."
            ),
            image: exposed(run, &seen.reference, exposure),
        });
    }
    pictures
}

/// A GPU leg's pictures, end to end, of the frames that it came to draw.
pub(super) fn gpu(run: &RsmRun, label: &str, made: &[FrameArrays]) -> Vec<Picture> {
    let exposure = exposure(run);
    let mut shown = Vec::new();
    let made = made.iter().map(|frame| &frame.picture);
    let made = made.take_while(|picture| !picture.is_empty());
    for (number, (frame, made)) in (1..).zip(run.frames.iter().zip(made)) {
        let wide: Vec<[f64; 3]> = made.iter().map(|pixel| pixel.map(f64::from)).collect();
        let title = title_of(label, number);
        let own = single(&values(&frame.frame.picture));
        let difference = pictures::difference(&title, run.setup.eye.size, &own, made);
        shown.push(Picture {
            title,
            caption: "What this leg makes of the scene, from its own points and places on.".into(),
            image: exposed(run, &wide, exposure),
        });
        shown.extend(difference);
    }
    shown
}

/// Which pixels differ, and why, over the spec's picture of the first frame; `None` if none
/// does.
pub(super) fn causes(run: &RsmRun, spots: &[Spot]) -> Option<Picture> {
    let frame = run.frames.first().filter(|_| !spots.is_empty())?;
    let exposure = exposure(run);
    let picture = toned(&values(&frame.frame.picture), exposure);
    let marks = spots.iter().map(|spot| (spot.pixel, Some(spot.cause)));
    Some(Picture {
        title: "causes".into(),
        caption: "Pixels that differ in any leg and frame, over the spec's picture.".into(),
        image: picture::causes(run.setup.eye.size, Some(&single(&picture)), marks),
    })
}

/// A title, with the frame's number from the second on.
fn title_of(title: &str, number: usize) -> String {
    match number {
        1 => title.to_owned(),
        _ => format!("{title} frame {number}"),
    }
}

/// By what all pictures are multiplied.
fn exposure(run: &RsmRun) -> f64 {
    let all = run
        .frames
        .iter()
        .flat_map(|frame| values(&run.unblocked(frame)));
    exposure::exposure(all)
}

/// A picture as all are shown.
fn exposed(run: &RsmRun, pixels: &[[f64; 3]], exposure: f64) -> Image {
    exposure::exposed(run.setup.eye.size, pixels, exposure)
}
