//! How far a picture is from the exact one: the spec's, with all layers.

use triptych_spec::bound::Bounded;

/// How wrong a picture is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Error {
    /// Decibels; `None` if nothing differs.
    pub psnr: Option<f64>,
    /// The largest difference of a channel.
    pub largest: f64,
}

/// Peak signal-to-noise ratio in decibels: `-10 log10` of the mean square of the
/// differences of all channels of all pixels. Colours are linear, and the peak is 1,
/// whether or not a scene reaches or exceeds it. Beside it the largest absolute
/// difference.
pub fn psnr<'e>(
    exact: impl IntoIterator<Item = &'e [Bounded; 3]>,
    seen: impl IntoIterator<Item = [f64; 3]>,
) -> Error {
    let (mut sum, mut count, mut largest) = (0.0, 0_u64, 0.0_f64);
    for (exact, seen) in exact.into_iter().zip(seen) {
        for (exact, seen) in exact.iter().zip(seen) {
            let difference = (seen - exact.value).abs();
            sum += difference * difference;
            largest = largest.max(difference);
            count += 1;
        }
    }
    Error {
        psnr: (sum > 0.0).then(|| -10.0 * libm::log10(sum / count as f64)),
        largest,
    }
}

/// A ratio as people read it.
pub fn decibels(psnr: Option<f64>) -> String {
    psnr.map_or_else(|| "exact".to_owned(), |psnr| format!("{psnr:.1}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tenth_everywhere_is_twenty_decibels() {
        let exact = [[Bounded {
            value: 0.5,
            bound: 0.0,
        }; 3]; 4];
        let seen = psnr(&exact, [[0.6, 0.4, 0.6]; 4]);
        let decibels = seen.psnr.expect("it differs");
        assert!((decibels - 20.0).abs() < 1e-9, "{decibels}");
        assert!((seen.largest - 0.1).abs() < 1e-12, "{}", seen.largest);
        // One channel of twelve: a twelfth of the mean square.
        let mut one = [[0.5; 3]; 4];
        one[2][1] = 0.4;
        let decibels = psnr(&exact, one).psnr.expect("it differs");
        assert!(
            (decibels - 20.0 - 10.0 * 12_f64.log10()).abs() < 1e-9,
            "{decibels}"
        );
    }

    #[test]
    fn nothing_that_differs_is_exact() {
        let exact = [[Bounded {
            value: 0.5,
            bound: 0.1,
        }; 3]; 4];
        let seen = psnr(&exact, [[0.5; 3]; 4]);
        assert_eq!((seen.psnr, seen.largest), (None, 0.0));
        assert_eq!(decibels(seen.psnr), "exact");
    }
}
