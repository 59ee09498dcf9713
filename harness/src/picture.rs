//! Pictures for people: linear colours, counts, causes and differences as 8-bit
//! sRGB PNG. Nothing here decides a comparison.
//!
//! Size policy: a picture whose longer side exceeds [`SIDE_MAX`] is scaled down by
//! the smallest whole factor that fits; each pixel then stands for a square block,
//! and what it shows of the block (mean, maximum, any mark) is in the note. Small
//! pictures are stored as they are and enlarged by whole factors when shown.

mod causes;
mod colour;

use std::io::Cursor;

use serde::{Deserialize, Serialize};
use triptych_spec::scene::Size;

pub use causes::{Mark, causes, swatch};
pub use colour::{heat, srgb};

/// Longest side of a picture that is not scaled down.
pub const SIDE_MAX: u32 = 640;

/// What stands for a colour with a component that is infinite or no number.
const NOT_FINITE: [u8; 3] = [255, 0, 255];

/// A picture, encoded, and what a reader must know to read it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Image {
    /// PNG, 8-bit sRGB; kept in a file of its own.
    #[serde(skip)]
    pub png: Vec<u8>,
    /// Width of the PNG.
    pub width: u32,
    /// Height of the PNG.
    pub height: u32,
    /// How the picture was made: scale, factors, what its pixels stand for.
    pub note: String,
    /// What its colours mean.
    pub legend: Legend,
}

/// What the colours of a picture mean.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Legend {
    /// They are the scene's own.
    Colours,
    /// Counts from 0 to a maximum, on the scale of [`heat`].
    Heat {
        /// The largest count.
        max: u32,
    },
    /// One colour and pattern per cause.
    Causes(Vec<Mark>),
}

/// The whole factor by which a picture of this size is scaled down.
pub fn reduction(size: Size) -> u32 {
    size.width.max(size.height).div_ceil(SIDE_MAX).max(1)
}

/// A picture of linear colours, row by row from the top left.
///
/// Components are clamped to 0..1 and encoded by the sRGB transfer function
/// (IEC 61966-2-1). A pixel with a component that is not finite is magenta, and so
/// is a block that holds one.
pub fn linear(size: Size, pixels: &[[f32; 3]]) -> Image {
    assert_eq!(pixels.len(), size.pixels(), "one colour per pixel");
    let bad = pixels.iter().filter(|p| !finite(p)).count();
    let mut note = reduced(size, "the mean");
    if bad > 0 {
        note.push(format!("{bad} pixels are not finite and shown magenta"));
    }
    let mean = |block: &mut dyn Iterator<Item = usize>| {
        let (mut sum, mut n, mut all_finite) = ([0.0_f64; 3], 0.0, true);
        for pixel in block {
            let colour = &pixels[pixel];
            all_finite &= finite(colour);
            n += 1.0;
            for (sum, &c) in sum.iter_mut().zip(colour) {
                *sum += f64::from(c.clamp(0.0, 1.0));
            }
        }
        match all_finite {
            true => sum.map(|s| srgb(s / n)),
            false => NOT_FINITE,
        }
    };
    encode(size, mean, note, Legend::Colours)
}

/// A heat map of counts, such as fragments per pixel (Yang et al. 2010, figure
/// 3b). Black is 0; the scale is logarithmic, so that a single deep pixel leaves
/// the rest readable.
pub fn counts(size: Size, counts: &[u32]) -> Image {
    assert_eq!(counts.len(), size.pixels(), "one count per pixel");
    let max = counts.iter().copied().max().unwrap_or(0);
    let largest = |block: &mut dyn Iterator<Item = usize>| {
        heat(block.map(|p| counts[p]).max().unwrap_or(0), max)
    };
    let note = reduced(size, "the largest");
    encode(size, largest, note, Legend::Heat { max })
}

/// How much two pictures differ: per pixel the largest difference of a component,
/// amplified by the largest power of two that keeps every one within 1.
pub fn difference(size: Size, a: &[[f32; 3]], b: &[[f32; 3]]) -> Image {
    assert_eq!(a.len(), size.pixels(), "one colour per pixel");
    assert_eq!(b.len(), size.pixels(), "one colour per pixel");
    let by_pixel: Vec<f64> = a.iter().zip(b).map(|(a, b)| distance(a, b)).collect();
    let finite = by_pixel.iter().copied().filter(|d| d.is_finite());
    let max = finite.fold(0.0, f64::max);
    let factor = if max > 0.0 {
        libm::exp2(libm::floor(-libm::log2(max)))
    } else {
        1.0
    };
    let shade = |block: &mut dyn Iterator<Item = usize>| {
        let worst = block.map(|p| by_pixel[p]).fold(0.0, f64::max);
        match worst.is_finite() {
            true => [srgb(worst * factor); 3],
            false => NOT_FINITE,
        }
    };
    let mut note = reduced(size, "the largest");
    note.push(match max > 0.0 {
        true => format!("amplified {factor} times; the largest difference is {max:.3e}"),
        false => "no difference".to_owned(),
    });
    let bad = by_pixel.iter().filter(|d| !d.is_finite()).count();
    if bad > 0 {
        note.push(format!(
            "{bad} pixels are not finite in one of the two and shown magenta"
        ));
    }
    encode(size, shade, note, Legend::Colours)
}

/// Largest difference of a component; infinite where only one is finite or they
/// are different kinds of not finite.
fn distance(a: &[f32; 3], b: &[f32; 3]) -> f64 {
    let of = |(a, b): (&f32, &f32)| {
        let apart = (f64::from(*a) - f64::from(*b)).abs();
        match a.to_bits() == b.to_bits() {
            true => 0.0,
            false if apart.is_nan() => f64::INFINITY,
            false => apart,
        }
    };
    a.iter().zip(b).map(of).fold(0.0, f64::max)
}

fn finite(colour: &[f32; 3]) -> bool {
    colour.iter().all(|c| c.is_finite())
}

/// The note on scale, where there is one to make.
fn reduced(size: Size, what: &str) -> Vec<String> {
    let factor = reduction(size);
    let (w, h) = (size.width, size.height);
    match factor {
        1 => vec![format!("{w} × {h} pixels")],
        _ => vec![format!(
            "{w} × {h} pixels, shown at 1/{factor}: each stands for {what} of \
             {factor} × {factor}"
        )],
    }
}

/// The pixels of a block, row-major numbers, cut at the picture's edge.
fn block(size: Size, factor: u32, x: u32, y: u32) -> impl Iterator<Item = usize> {
    let end = |at: u32, side: u32| ((at + 1) * factor).min(side);
    let columns = x * factor..end(x, size.width);
    (y * factor..end(y, size.height)).flat_map(move |row| {
        let start = row as usize * size.width as usize;
        columns.clone().map(move |column| start + column as usize)
    })
}

fn encode(
    size: Size,
    shade: impl Fn(&mut dyn Iterator<Item = usize>) -> [u8; 3],
    note: Vec<String>,
    legend: Legend,
) -> Image {
    let factor = reduction(size);
    let (width, height) = (size.width.div_ceil(factor), size.height.div_ceil(factor));
    let mut rgb = Vec::with_capacity(width as usize * height as usize * 3);
    for y in 0..height {
        for x in 0..width {
            rgb.extend(shade(&mut block(size, factor, x, y)));
        }
    }
    Image {
        png: png(width, height, rgb),
        width,
        height,
        note: note.join("; "),
        legend,
    }
}

/// Encodes 8-bit sRGB triples, row by row from the top left.
pub fn png(width: u32, height: u32, rgb: Vec<u8>) -> Vec<u8> {
    let buffer: image::RgbImage =
        image::ImageBuffer::from_raw(width, height, rgb).expect("three bytes per pixel");
    let mut out = Cursor::new(Vec::new());
    buffer
        .write_to(&mut out, image::ImageFormat::Png)
        .expect("writing a PNG to memory cannot fail");
    out.into_inner()
}

#[cfg(test)]
mod tests;
