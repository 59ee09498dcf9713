//! Transfer function and colour scale.

/// The sRGB transfer function (IEC 61966-2-1): a linear component as eight bits,
/// clamped to 0..1 and rounded to the nearest code. NaN gives 0.
pub fn srgb(linear: f64) -> u8 {
    let c = linear.clamp(0.0, 1.0);
    let encoded = if c <= 0.003_130_8 {
        12.92 * c
    } else {
        1.055 * libm::pow(c, 1.0 / 2.4) - 0.055
    };
    byte(encoded)
}

/// Where the heat scale passes through, at equal distances, in sRGB. Luminance
/// rises from each to the next (a test checks every step), so that the order of
/// counts survives in grey, in print and for every kind of colour vision.
const HEAT: [[u8; 3]; 7] = [
    [0, 0, 0],
    [44, 17, 95],
    [114, 31, 129],
    [183, 55, 121],
    [241, 96, 93],
    [254, 175, 120],
    [252, 253, 191],
];

/// Colour of a count on a scale from 0 (black) to `max`: position
/// `log(1 + n) / log(1 + max)` between the scale's points.
pub fn heat(n: u32, max: u32) -> [u8; 3] {
    if n == 0 || max == 0 {
        return HEAT[0];
    }
    let log = |n: u32| libm::log1p(f64::from(n));
    scale((log(n) / log(max)).min(1.0))
}

/// The heat scale at a position in 0..1.
pub fn scale(position: f64) -> [u8; 3] {
    let last = HEAT.len() - 1;
    let at = position.clamp(0.0, 1.0) * last as f64;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and the number of points"
    )]
    let i = (at as usize).min(last - 1);
    let t = at - i as f64;
    [0, 1, 2].map(|c| {
        let (a, b) = (f64::from(HEAT[i][c]), f64::from(HEAT[i + 1][c]));
        byte((a + t * (b - a)) / 255.0)
    })
}

fn byte(unit: f64) -> u8 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and 255"
    )]
    let byte = (unit.clamp(0.0, 1.0) * 255.0).round() as u8;
    byte
}
