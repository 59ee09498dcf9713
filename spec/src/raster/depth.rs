//! Exact quotients by a triangle's area.

/// An exact quotient by the area: `quotient + rest / area`, with `0 <= rest < area`.
#[derive(Clone, Copy)]
pub(super) struct Depth {
    pub(super) quotient: i64,
    pub(super) rest: i64,
}

impl Depth {
    /// The quotient at a covered sample.
    pub(super) fn key(self) -> u32 {
        u32::try_from(self.quotient).expect("a convex combination of 31-bit keys")
    }

    /// The sum of two quotients by the same area, which is as exact.
    pub(super) fn plus(self, step: Self, area: i64) -> Self {
        let (quotient, rest) = (self.quotient + step.quotient, self.rest + step.rest);
        match rest < area {
            true => Self { quotient, rest },
            false => Self {
                quotient: quotient + 1,
                rest: rest - area,
            },
        }
    }
}
