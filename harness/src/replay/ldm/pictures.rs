//! What people look at: what is open, what the sky lights, and some of the maps as clouds of
//! points.

use triptych_spec::ldm::Falloff;

use super::cloud;
use super::spec::LdmRun;
use crate::picture;
use crate::replay::exposure::{exposed, exposure, single};
use crate::replay::rows::Spot;
use crate::report::Picture;
use crate::scene::Loaded;

/// The spec's pictures.
pub(super) fn spec(loaded: &Loaded, run: &LdmRun) -> Vec<Picture> {
    let size = run.setup.eye.size;
    let maps = run.setup.directions * run.setup.rotations;
    let caption = match run.setup.falloff {
        Falloff::None => format!(
            "The part of each point's hemisphere that is open, by cosine, in {maps} directions."
        ),
        Falloff::Distance { power, .. } => format!(
            "Obscurance in {maps} directions: what is hit lets the power {power} of its distance \
             pass, in parts of the largest that counts."
        ),
    };
    let mut pictures = vec![Picture {
        title: "spec".into(),
        caption,
        image: picture::linear(size, &single(&openness(run))),
    }];
    if run.lit {
        let lit: Vec<[f64; 3]> = run.picture().iter().map(|p| p.map(|c| c.value)).collect();
        pictures.push(Picture {
            title: "light of the sky".into(),
            caption: "Direct light from all around, by what is open.".into(),
            image: exposed(size, &lit, exposure(lit.iter().copied())),
        });
    }
    if !run.mirrored.is_empty() {
        let mut seen = vec![[0.0; 3]; size.pixels()];
        for (asker, mirrored) in run.setup.receivers.iter().zip(&run.mirrored) {
            seen[asker.pixel as usize] = mirrored.light.map(f64::from);
        }
        pictures.push(Picture {
            title: "what is mirrored".into(),
            caption: format!(
                "The sky in the nearest of {maps} directions to each point's mirror direction; black \
                 where anything is in the way."
            ),
            image: exposed(size, &seen, exposure(seen.iter().copied())),
        });
    }
    pictures.extend(cloud::picture(loaded, run));
    pictures
}

/// Which pixels differ, and why, over what is open; `None` if none does.
pub(super) fn causes(run: &LdmRun, spots: &[Spot]) -> Option<Picture> {
    if spots.is_empty() {
        return None;
    }
    let marks = spots.iter().map(|spot| (spot.pixel, Some(spot.cause)));
    let ground = single(&openness(run));
    Some(Picture {
        title: "causes".into(),
        caption: "Pixels that differ in any leg, over the spec's picture.".into(),
        image: picture::causes(run.setup.eye.size, Some(&ground), marks),
    })
}

/// What is open at each pixel, as grey; the background where nothing is seen.
fn openness(run: &LdmRun) -> Vec<[f64; 3]> {
    let background = run.background.map(f64::from);
    let mut pixels = vec![background; run.setup.eye.size.pixels()];
    for (asker, open) in run.setup.receivers.iter().zip(&run.openness) {
        pixels[asker.pixel as usize] = [open.value; 3];
    }
    pixels
}
