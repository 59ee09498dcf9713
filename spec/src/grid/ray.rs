//! Rays and segments on the lattice.

use super::exact::{Time, minus};
use super::lattice::{Point, REACH};

/// What a ray asks for: points `origin + t * direction`, `0 <= t`, and `t <= 1` for a
/// segment.
///
/// A segment's direction is the difference of its ends, exactly. A direction of length 0
/// meets nothing, by rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ray {
    /// Where it starts; at most [`REACH`] in each coordinate.
    pub origin: Point,
    /// Where it goes; at most 2 [`REACH`] in each component.
    pub direction: Point,
    /// Whether it ends at `origin + direction`.
    pub segment: bool,
}

impl Ray {
    /// From one point to another; both belong to it.
    pub fn between(from: Point, to: Point) -> Self {
        debug_assert!(
            from.iter().chain(&to).all(|c| c.abs() <= REACH),
            "ends are points of the lattice"
        );
        Self {
            origin: from,
            direction: minus(to, from),
            segment: true,
        }
    }

    /// From a point without end. The direction is scaled by a power of two until its
    /// longest component has 24 bits, then rounded to integers; it is 0 if it was, or if
    /// it is not finite.
    pub fn along(origin: Point, direction: [f64; 3]) -> Self {
        let longest = direction.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        let finite = direction.iter().all(|c| c.is_finite());
        let (_, binary) = libm::frexp(longest);
        let scaled = direction.map(|c| {
            let rounded = libm::rint(libm::scalbn(c, 24 - binary));
            #[expect(clippy::cast_possible_truncation, reason = "at most 2^24")]
            let integer = rounded as i32;
            integer
        });
        Self {
            origin,
            direction: if finite { scaled } else { [0; 3] },
            segment: false,
        }
    }

    /// Whether it goes anywhere.
    pub fn moves(&self) -> bool {
        self.direction != [0; 3]
    }

    /// Whether a time belongs to it.
    pub fn holds(&self, time: Time) -> bool {
        time >= Time::START && (!self.segment || time <= Time::END)
    }
}
