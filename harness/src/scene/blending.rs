//! What a scene makes of its layers beside blending them.

use serde::Deserialize;
use triptych_spec::abuffer::{HALVINGS_MAX, Lens, RADIUS_MAX, Reduction};
use triptych_spec::vertex::DEPTH_ONE;

/// Largest density: from there on, light comes through no difference of depth that matters.
const DENSITY_MAX: f64 = 1e6;

/// Largest aperture: it is a word of 16 bits.
const APERTURE_MAX: u32 = 65_535;

/// Density of a medium, in units of one over the depth range.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "f64")]
pub struct Density(pub f32);

impl TryFrom<f64> for Density {
    type Error = String;
    fn try_from(v: f64) -> Result<Self, String> {
        match (0.0..=DENSITY_MAX).contains(&v) {
            #[expect(
                clippy::cast_possible_truncation,
                reason = "rounded once, for all legs"
            )]
            true => Ok(Self(v as f32)),
            false => Err(format!("{v} is outside 0 to {DENSITY_MAX}")),
        }
    }
}

/// A lens, by its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "Stated")]
pub struct Defocus(pub Lens);

/// The same as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Stated {
    /// Depth in focus, 0 to 1.
    focus: f64,
    /// Pixels of radius as far from the focus as the whole depth range.
    aperture: i64,
    /// Largest radius, pixels.
    radius: i64,
}

impl TryFrom<Stated> for Defocus {
    type Error = String;
    fn try_from(stated: Stated) -> Result<Self, String> {
        let Stated {
            focus,
            aperture,
            radius,
        } = stated;
        if !(0.0..=1.0).contains(&focus) {
            return Err(format!("focus = {focus} is outside 0 to 1"));
        }
        let word = |name: &str, v: i64, range: std::ops::RangeInclusive<u32>| {
            let [least, most] = [range.start(), range.end()];
            let found = u32::try_from(v).ok().filter(|v| range.contains(v));
            found.ok_or_else(|| format!("{name} = {v} is outside {least} to {most}"))
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at most 2^31, and not negative"
        )]
        let key = (focus * f64::from(1_u32 << 31)) as u32;
        Ok(Self(Lens {
            focus: key.min(DEPTH_ONE.cast_unsigned()),
            aperture: word("aperture", aperture, 0..=APERTURE_MAX)?,
            radius: word("radius", radius, 1..=RADIUS_MAX)?,
        }))
    }
}

/// A reduced resolution, by the side of a pixel's block.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "StatedReduction")]
pub struct Reduced(pub Reduction);

/// The same as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StatedReduction {
    /// Pixels along a side: a power of two.
    side: i64,
    /// How fast weights fall with depth, in units of one over the depth range.
    falloff: f64,
}

impl TryFrom<StatedReduction> for Reduced {
    type Error = String;
    fn try_from(stated: StatedReduction) -> Result<Self, String> {
        let StatedReduction { side, falloff } = stated;
        let halvings = (0..=HALVINGS_MAX).find(|n| 1 << n == side);
        let halvings = halvings.ok_or_else(|| format!("side = {side} is not 1, 2 or 4"))?;
        let falloff = Density::try_from(falloff).map_err(|e| format!("falloff = {e}"))?;
        Ok(Self(Reduction {
            halvings,
            falloff: falloff.0,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn defocus(text: &str) -> Result<Defocus, String> {
        toml::from_str(text).map_err(|e| e.message().to_owned())
    }

    #[test]
    fn what_is_stated_is_read() {
        let lens = defocus("focus = 0.5\naperture = 40\nradius = 4").map(|d| d.0);
        let must = Lens {
            focus: 1 << 30,
            aperture: 40,
            radius: 4,
        };
        assert_eq!(lens, Ok(must), "half of 2^31");
        let far = defocus("focus = 1\naperture = 0\nradius = 8").map(|d| d.0.focus);
        assert_eq!(far, Ok(DEPTH_ONE.cast_unsigned()), "the largest key");
    }

    #[test]
    fn reductions_are_read() {
        let read = |text: &str| {
            let reduced = toml::from_str::<Reduced>(text);
            reduced
                .map(|r| (r.0.side(), r.0.falloff))
                .map_err(|e| e.message().to_owned())
        };
        assert_eq!(read("side = 4\nfalloff = 2.5"), Ok((4, 2.5)));
        assert_eq!(read("side = 1\nfalloff = 0"), Ok((1, 0.0)));
        for (text, words) in [
            ("side = 3\nfalloff = 1", "side = 3 is not 1, 2 or 4"),
            ("side = 8\nfalloff = 1", "side = 8 is not 1, 2 or 4"),
            (
                "side = 2\nfalloff = -1",
                "falloff = -1 is outside 0 to 1000000",
            ),
            (
                "side = 2\nfalloff = nan",
                "falloff = NaN is outside 0 to 1000000",
            ),
        ] {
            assert_eq!(read(text), Err(words.to_owned()));
        }
    }

    #[test]
    fn mistakes_are_named() {
        for (text, words) in [
            (
                "focus = 1.5\naperture = 1\nradius = 1",
                "focus = 1.5 is outside 0 to 1",
            ),
            (
                "focus = nan\naperture = 1\nradius = 1",
                "focus = NaN is outside 0 to 1",
            ),
            (
                "focus = 0\naperture = 65536\nradius = 1",
                "aperture = 65536 is outside 0 to 65535",
            ),
            (
                "focus = 0\naperture = -1\nradius = 1",
                "aperture = -1 is outside 0 to 65535",
            ),
            (
                "focus = 0\naperture = 1\nradius = 0",
                "radius = 0 is outside 1 to 8",
            ),
            (
                "focus = 0\naperture = 1\nradius = 9",
                "radius = 9 is outside 1 to 8",
            ),
        ] {
            assert_eq!(defocus(text), Err(words.to_owned()), "{text}");
        }
        assert!(defocus("focus = 0").is_err(), "all three are stated");
        for v in [-1.0, f64::NAN, 1e7] {
            let words = format!("{v} is outside 0 to 1000000");
            assert_eq!(Density::try_from(v), Err(words), "a density");
        }
    }
}
