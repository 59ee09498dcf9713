//! How wrong what is open looks: FLIP (Andersson et al. 2020), between the picture that maps make
//! and the one that random rays make, as somebody sees both in turn at its authors' distance, 67
//! pixels a degree.
//!
//! Pictures are greys, what is open by the sRGB transfer function in eight bits, and black where
//! nothing is seen. Of a large view every second, third, … pixel along both axes stands for it.

use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8, FlipPool, flip, magma_lut};
use triptych_spec::ldm::{Open, openness};
use triptych_spec::scene::Size;

use super::case::Case;
use crate::embree::rays::RayAnswers;
use crate::picture::{png, srgb};
use crate::replay::ldm::{Asker, random};

/// Pixels of a picture along either axis, at most.
const SIDE: u32 = 200;

/// Rays at each pixel, in two halves: with [`SIDE`], some seconds on a few cores.
pub(super) const RAYS: u32 = 1024;

/// Every so many pixels of a view, along both axes.
#[derive(Clone, Copy)]
struct Coarse {
    size: Size,
    every: u32,
    /// The first, along both axes.
    first: [u32; 2],
    /// Pixels a row of the view.
    row: u32,
}

/// What random rays say is open, as a picture.
pub(super) struct Reference {
    coarse: Coarse,
    picture: Vec<u8>,
    /// The mean of FLIP between the halves of the rays.
    halves: f64,
}

/// A picture beside the reference.
pub(super) struct Seen {
    /// The mean of FLIP, and the same between the halves of the reference's rays.
    pub(super) flip: [f64; 2],
    /// The reference, the picture, and where they differ, side by side, as PNG.
    pub(super) png: Vec<u8>,
}

impl Coarse {
    fn new(view: Size) -> Self {
        let every = view.width.max(view.height).div_ceil(SIDE).max(1);
        let sides = [view.width, view.height];
        let first = sides.map(|side| (every / 2).min(side.saturating_sub(1)));
        let [width, height] = [0, 1].map(|axis| (sides[axis] - first[axis]).div_ceil(every));
        Self {
            size: Size { width, height },
            every,
            first,
            row: view.width,
        }
    }

    /// Where a pixel of the view is in the picture, if it is.
    fn place(self, pixel: u32) -> Option<usize> {
        let at = [pixel % self.row, pixel / self.row];
        let [x, y] = [0, 1].map(|axis| {
            let from = at[axis].checked_sub(self.first[axis])?;
            let is_shown = from.is_multiple_of(self.every);
            is_shown.then_some(from / self.every)
        });
        Some(y? as usize * self.size.width as usize + x? as usize)
    }

    /// Receivers that the picture shows, by their numbers, and where.
    fn shown(self, askers: &[Asker]) -> Vec<(usize, usize)> {
        let places = askers.iter().map(|asker| self.place(asker.pixel));
        let places = places.enumerate();
        places.filter_map(|(at, p)| Some((at, p?))).collect()
    }

    /// A picture of greys.
    fn picture(self, open: impl Iterator<Item = (usize, f64)>) -> Vec<u8> {
        let mut picture = vec![0; 3 * self.size.pixels()];
        for (place, open) in open {
            picture[3 * place..3 * place + 3].fill(srgb(open));
        }
        picture
    }

    /// The mean of FLIP between two pictures, and where it is, in colours.
    fn compared(self, reference: &[u8], picture: &[u8]) -> (f64, Vec<u8>) {
        let Size { width, height } = self.size;
        let of = |bytes| FlipImageRgb8::with_data(width, height, bytes);
        let map = flip(of(reference), of(picture), DEFAULT_PIXELS_PER_DEGREE);
        let mean = f64::from(FlipPool::from_image(&map).mean());
        (mean, map.apply_color_lut(&magma_lut()).to_vec())
    }
}

impl Reference {
    /// By Embree.
    ///
    /// # Errors
    /// What Embree reports.
    pub(super) fn new(case: &Case<'_>) -> Result<Self, String> {
        use rayon::prelude::*;
        let setup = &case.setup;
        let coarse = Coarse::new(setup.eye.size);
        let shown = coarse.shown(&setup.receivers);
        let half = |seed: u64| {
            let of = shown.par_iter().map(|(receiver, place)| {
                let asker = &setup.receivers[*receiver];
                let (open, _) = random(setup, asker, (seed, RAYS / 2), &case.rays);
                (*place, open)
            });
            of.collect::<Vec<_>>()
        };
        let halves = [1, 2].map(|n| half(case.seed().wrapping_add(n)));
        case.rays.check().map_err(|e| e.to_string())?;
        let both = halves[0].iter().zip(&halves[1]);
        let both = both.map(|((place, a), (_, b))| (*place, f64::midpoint(*a, *b)));
        let picture = coarse.picture(both);
        let [one, other] = halves.map(|half| coarse.picture(half.into_iter()));
        Ok(Self {
            halves: coarse.compared(&one, &other).0,
            picture,
            coarse,
        })
    }

    /// What sums over maps in so many directions look like.
    pub(super) fn seen(&self, case: &Case<'_>, directions: u32, opened: &[Open]) -> Seen {
        let shown = self.coarse.shown(&case.setup.receivers);
        let open = |at: usize| openness(&opened[at], directions).value;
        let of = shown.iter().map(|(at, place)| (*place, open(*at)));
        let picture = self.coarse.picture(of);
        let (mean, map) = self.coarse.compared(&self.picture, &picture);
        Seen {
            flip: [mean, self.halves],
            png: beside(self.coarse.size, [&self.picture, &picture, &map]),
        }
    }
}

/// Pictures of the same size side by side, as PNG.
fn beside(size: Size, pictures: [&Vec<u8>; 3]) -> Vec<u8> {
    let row = 3 * size.width as usize;
    let rows = (0..size.height as usize).flat_map(|y| {
        let of = move |p: &&Vec<u8>| p[y * row..(y + 1) * row].to_vec();
        pictures.iter().flat_map(of).collect::<Vec<u8>>()
    });
    png(3 * size.width, size.height, rows.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: Coarse = Coarse {
        size: Size {
            width: 40,
            height: 24,
        },
        every: 1,
        first: [0; 2],
        row: 40,
    };

    fn grey(open: f64) -> Vec<u8> {
        SMALL.picture((0..SMALL.size.pixels()).map(|at| (at, open)))
    }

    fn mean(one: &[u8], other: &[u8]) -> f64 {
        SMALL.compared(one, other).0
    }

    /// Lightness of a linear grey of luminance `y` (CIE 1976), whose other two coordinates are 0.
    fn lightness(y: f64) -> f64 {
        let f = |t: f64| match t > 216.0 / 24389.0 {
            true => libm::cbrt(t),
            false => (24389.0 / 27.0 * t + 16.0) / 116.0,
        };
        116.0 * f(y) - 16.0
    }

    /// FLIP of two greys without edges is the colours' difference alone: HyAB to the power of 0.7,
    /// in parts of that of green and blue, the part below 0.4 stretched to 0.95. These two are,
    /// by sRGB, L* a* b* (87.735, -86.183, 83.180) and (32.300, 79.196, -107.860); a* and b* are
    /// taken times L* / 100 for Hunt's effect.
    fn by_hand(one: u8, other: u8) -> f64 {
        let linear = |code: u8| match f64::from(code) / 255.0 {
            c if c <= 0.040_45 => c / 12.92,
            c => libm::pow((c + 0.055) / 1.055, 2.4),
        };
        let [green, blue] = [[87.735, -86.183, 83.180], [32.300, 79.196, -107.860]]
            .map(|[l, a, b]: [f64; 3]| [l, a * l / 100.0, b * l / 100.0]);
        let apart = libm::hypot(green[1] - blue[1], green[2] - blue[2]) + green[0] - blue[0];
        let most = libm::pow(apart, 0.7);
        let [a, b] = [one, other].map(|code| lightness(linear(code)));
        let part = libm::pow((a - b).abs(), 0.7) / most;
        match part < 0.4 {
            true => part * 0.95 / 0.4,
            false => 0.95 + (part - 0.4) / 0.6 * 0.05,
        }
    }

    /// The library rounds to `f32` in some hundred steps, its filters' weights among them: 1e-4 is
    /// a thousand of its roundings.
    #[test]
    fn greys_are_as_far_apart_as_their_colours() {
        for (one, other) in [(0.0, 1.0), (0.2, 0.9), (0.5, 0.55), (0.01, 0.0)] {
            let must = by_hand(srgb(one), srgb(other));
            let is = mean(&grey(one), &grey(other));
            assert!((is - must).abs() < 1e-4, "{one} {other}: {is}, must {must}");
            let back = mean(&grey(other), &grey(one));
            assert!((is - back).abs() < 1e-6, "either way: {is} and {back}");
        }
    }

    #[test]
    fn more_contrast_is_further_and_nothing_is_none() {
        let striped = |depth: f64| {
            let open = |at: usize| 0.5 + if at % 40 < 20 { depth } else { -depth };
            SMALL.picture((0..SMALL.size.pixels()).map(|at| (at, open(at))))
        };
        let far = [0.0, 0.05, 0.2, 0.5].map(|depth| mean(&grey(0.5), &striped(depth)));
        assert!(far[0].to_bits() == 0.0_f64.to_bits(), "{far:?}");
        assert!(far.is_sorted_by(|a, b| a < b) && far[3] <= 1.0, "{far:?}");
    }

    /// Every fourth pixel of 800 along both axes, every one of 200, and none that is beyond the border.
    #[test]
    fn a_large_view_is_thinned_evenly() {
        let size = |width, height| Size { width, height };
        let all = |view: Size| {
            let coarse = Coarse::new(view);
            let pixels = 0..u32::try_from(view.pixels()).expect("few");
            let places: Vec<usize> = pixels.filter_map(|p| coarse.place(p)).collect();
            assert_eq!(places, (0..coarse.size.pixels()).collect::<Vec<_>>());
            (coarse.size, coarse.every)
        };
        assert_eq!(all(size(800, 800)), (size(200, 200), 4));
        assert_eq!(all(size(200, 7)), (size(200, 7), 1));
        assert_eq!(all(size(601, 400)), (size(150, 100), 4));
        assert_eq!(all(size(500, 2)), (size(167, 1), 3));
        assert_eq!(all(size(900, 1)), (size(180, 1), 5));
    }
}
