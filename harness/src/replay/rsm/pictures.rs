//! What people look at: each frame with and without indirect shadows.
//!
//! All pictures of a scene are multiplied by one number and then encoded as sRGB, so that they
//! compare: the largest power of two that leaves 99 of 100 components of the brightest, that
//! without indirect shadows, within 1.

use super::embree::{Seen, rmse, values};
use super::spec::RsmRun;
use crate::picture::{self, Image};
use crate::report::Picture;

/// The spec's pictures.
pub(super) fn spec(run: &RsmRun<'_>) -> Vec<Picture> {
    let exposure = exposure(run);
    let mut pictures = Vec::new();
    for (number, frame) in (1..).zip(&run.frames) {
        let [with, without] = [values(&frame.frame.picture), values(&run.unblocked(frame))];
        let title = |title: &str| title_of(run, title, number);
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
        let [with, without] = [with, without].map(|p| single(&p, 1.0));
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
pub(super) fn embree(run: &RsmRun<'_>, seen: &[Seen]) -> Vec<Picture> {
    let exposure = exposure(run);
    let mut pictures = Vec::new();
    for (number, (frame, seen)) in (1..).zip(run.frames.iter().zip(seen)) {
        let title = |title: &str| title_of(run, title, number);
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

/// A title, with the frame's number where there are several.
pub(super) fn title_of(run: &RsmRun<'_>, title: &str, number: usize) -> String {
    match run.frames.len() {
        1 => title.to_owned(),
        _ => format!("{title} frame {number}"),
    }
}

/// By what all pictures are multiplied.
pub(super) fn exposure(run: &RsmRun<'_>) -> f64 {
    let pictures = run.frames.iter().map(|frame| values(&run.unblocked(frame)));
    let all = pictures.flat_map(|picture| picture.into_iter().flatten().collect::<Vec<_>>());
    let mut all: Vec<f64> = all.filter(|c| *c > 0.0).collect();
    all.sort_unstable_by(f64::total_cmp);
    match all.get(all.len().saturating_sub(all.len() / 100 + 1)) {
        Some(bright) => libm::exp2(libm::floor(-libm::log2(*bright))),
        None => 1.0,
    }
}

/// A picture as all are shown.
pub(super) fn exposed(run: &RsmRun<'_>, pixels: &[[f64; 3]], exposure: f64) -> Image {
    let image = picture::linear(run.setup.eye.size, &single(pixels, exposure));
    Image {
        note: format!("{}; linear colour times {exposure}, as sRGB", image.note),
        ..image
    }
}

fn single(pixels: &[[f64; 3]], factor: f64) -> Vec<[f32; 3]> {
    #[expect(clippy::cast_possible_truncation, reason = "for showing")]
    let pixel = |pixel: &[f64; 3]| pixel.map(|c| (c * factor) as f32);
    pixels.iter().map(pixel).collect()
}
