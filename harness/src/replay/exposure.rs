//! How pictures of light of any size are shown.
//!
//! All pictures of a scene are toned alike, so that they compare: linear colours are
//! multiplied by one number, the power of two that brings the geometric mean of what is lit
//! nearest to a middle grey; `x / (1 + x)` keeps what is bright from being cut off (Reinhard et
//! al. 2002, equations 1 to 3); then they are encoded as sRGB.

use triptych_spec::scene::Size;

use crate::picture::{self, Image};

/// What the geometric mean becomes, about.
const MIDDLE_GREY: f64 = 0.18;

/// By what pictures are multiplied whose pixels, all together, are these.
pub(super) fn exposure(pixels: impl Iterator<Item = [f64; 3]>) -> f64 {
    let (mut sum, mut lit) = (0.0, 0.0);
    for [r, g, b] in pixels {
        let brightest = r.max(g).max(b);
        if brightest > 0.0 {
            sum += libm::log2(brightest);
            lit += 1.0;
        }
    }
    if lit == 0.0 {
        return 1.0;
    }
    libm::exp2(libm::round(libm::log2(MIDDLE_GREY) - sum / lit))
}

/// A picture as all are shown.
pub(super) fn exposed(size: Size, pixels: &[[f64; 3]], exposure: f64) -> Image {
    let toned = single(&toned(pixels, exposure));
    let image = picture::linear(size, &toned);
    Image {
        note: format!(
            "{}; x = {exposure} times the linear colour, shown as x / (1 + x) in sRGB",
            image.note
        ),
        ..image
    }
}

/// Linear colours from 0 to 1.
pub(super) fn toned(pixels: &[[f64; 3]], exposure: f64) -> Vec<[f64; 3]> {
    let toned = |c: f64| c * exposure / (1.0 + c * exposure);
    pixels.iter().map(|pixel| pixel.map(toned)).collect()
}

/// Rounded, for showing.
pub(super) fn single(pixels: &[[f64; 3]]) -> Vec<[f32; 3]> {
    #[expect(clippy::cast_possible_truncation, reason = "for showing")]
    let pixel = |pixel: &[f64; 3]| pixel.map(|c| c as f32);
    pixels.iter().map(pixel).collect()
}
