//! Indirect light: what is seen, where it lies in the light's map, who lights whom, and how
//! bright that is.

mod blocked;
mod colours;
mod places;
mod surfaces;

#[cfg(test)]
mod tests;

use super::Judgement;
use crate::cause::Cause;
use crate::row::Class;

pub use blocked::blocked;
pub use colours::{colours, lit};
pub use places::places;
pub use surfaces::{surfaces, visible};

/// A comparison of two lists of as many items, `expected` of them; another number is a
/// difference by itself.
fn listed(class: Class, unit: &'static str, expected: usize, seen: usize) -> Judgement {
    let mut judgement = Judgement {
        compared: expected as u64,
        ..Judgement::new(class, unit)
    };
    if seen != expected {
        judgement.differs(Cause::ReferenceMissing, None, || {
            format!("{seen} {unit}, must be {expected}")
        });
    }
    judgement
}

/// A row as a pixel's number.
fn number(row: usize) -> u32 {
    u32::try_from(row).expect("pictures have fewer than 2^32 pixels")
}
