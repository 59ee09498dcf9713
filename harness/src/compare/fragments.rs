//! Stage `cover`: two streams of fragments as multisets.

mod band;

use std::cmp::Ordering;

use triptych_spec::raster::Fragment;
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

/// What a stream must contain.
pub enum Rule<'a> {
    /// Exactly the spec's fragments.
    Exact,
    /// A driver whose sub-pixel grid is unknown: what every grid covers must be
    /// covered, what none covers must not be; the rest may go either way, and is
    /// counted as admitted. Keys come from the spec's triangles and are exact.
    Band(&'a Primitives),
}

/// Compares the spec's fragments with a leg's; both are sorted here.
///
/// Where there is no fragment, the pixels are what was compared: all are empty.
pub fn compare(spec: &[Fragment], other: &[Fragment], size: Size, rule: &Rule<'_>) -> Judgement {
    let width = size.width;
    let (mut spec, mut other) = (spec.to_vec(), other.to_vec());
    spec.sort_unstable();
    other.sort_unstable();
    let class = match rule {
        Rule::Exact => Class::Exact,
        Rule::Band(_) => Class::Band,
    };
    let mut judgement = Judgement::new(class, "fragments");
    let (mut a, mut b) = (spec.iter().peekable(), other.iter().peekable());
    let mut last: Option<(u32, u32)> = None;
    let mut turned = 0_u64;
    loop {
        let id = |f: &Fragment| (f.pixel, f.prim);
        let order = match (a.peek(), b.peek()) {
            (None, None) => break,
            (Some(_), None) => Ordering::Less,
            (None, Some(_)) => Ordering::Greater,
            (Some(x), Some(y)) => id(x).cmp(&id(y)),
        };
        judgement.compared += 1;
        match order {
            Ordering::Less => {
                let f = a.next().expect("peeked");
                turned += missing(&mut judgement, f, width, rule);
            }
            Ordering::Greater => {
                let f = b.next().expect("peeked");
                turned += extra(&mut judgement, f, width, rule, last == Some(id(f)));
            }
            Ordering::Equal => {
                let (x, y) = (a.next().expect("peeked"), b.next().expect("peeked"));
                last = Some(id(x));
                judgement.admitted += u64::from(rule.may(x));
                same(&mut judgement, x, y, width);
            }
        }
    }
    if let (Rule::Band(_), 1..) = (rule, judgement.compared) {
        // Any share passes, short of all: the column of such shares shows it.
        judgement.admitted_budget = Some(1.0);
        let (may, all) = (judgement.admitted, judgement.compared);
        let share = 100.0 * may as f64 / all as f64;
        judgement.note = format!(
            "MAY: {may} of {all} fragments ({share:.2} %) lie within a sub-pixel of an edge, \
             {turned} of these went the other way"
        );
    }
    if judgement.compared == 0 {
        judgement.unit = "empty pixels";
        judgement.compared = size.pixels() as u64;
    }
    judgement
}

/// How many fragments go the other way: 1 or none.
fn missing(judgement: &mut Judgement, f: &Fragment, width: u32, rule: &Rule<'_>) -> u64 {
    if rule.may(f) {
        judgement.admitted += 1;
        return 1;
    }
    judgement.differs(Cause::Coverage, Some(f.pixel), || {
        format!(
            "{} must be covered by triangle row {}, is not",
            at(f.pixel, width),
            f.prim
        )
    });
    0
}

/// How many fragments go the other way: 1 or none.
fn extra(judgement: &mut Judgement, f: &Fragment, width: u32, rule: &Rule<'_>, again: bool) -> u64 {
    if again {
        judgement.differs(Cause::Duplicate, Some(f.pixel), || {
            format!(
                "{} holds triangle row {} more than once",
                at(f.pixel, width),
                f.prim
            )
        });
    } else if rule.may(f) {
        judgement.admitted += 1;
        return 1;
    } else {
        judgement.differs(Cause::Coverage, Some(f.pixel), || {
            format!(
                "{} must not be covered by triangle row {}, is",
                at(f.pixel, width),
                f.prim
            )
        });
    }
    0
}

fn same(judgement: &mut Judgement, x: &Fragment, y: &Fragment, width: u32) {
    if x.key != y.key {
        judgement.differs(Cause::DepthKey, Some(x.pixel), || {
            let (at, prim) = (at(x.pixel, width), x.prim);
            format!(
                "{at} triangle row {prim} has key {}, must be {}",
                y.key, x.key
            )
        });
    } else if x.mask != y.mask {
        judgement.differs(Cause::SampleMask, Some(x.pixel), || {
            let (at, prim) = (at(x.pixel, width), x.prim);
            format!(
                "{at} triangle row {prim} has mask {:#x}, must be {:#x}",
                y.mask, x.mask
            )
        });
    }
}

impl Rule<'_> {
    /// Whether the spec's coverage of a pixel is not binding.
    fn may(&self, f: &Fragment) -> bool {
        match self {
            Self::Exact => false,
            Self::Band(primitives) => band::may(primitives, f),
        }
    }
}

/// A pixel in words.
pub fn at(pixel: u32, width: u32) -> String {
    format!("pixel ({}, {})", pixel % width, pixel / width)
}

#[cfg(test)]
mod tests;
