//! Stage `cover`: two streams of fragments as multisets.

use std::cmp::Ordering;

use triptych_spec::raster::{Fragment, Setup, sample};
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

/// What a stream must contain.
pub enum Rule<'a> {
    /// Exactly the spec's fragments.
    Exact,
    /// A driver whose sub-pixel grid is unknown: corners may have moved by one
    /// sub-pixel, so a pixel within that of an edge may go either way.
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
                missing(&mut judgement, f, width, rule);
            }
            Ordering::Greater => {
                let f = b.next().expect("peeked");
                extra(&mut judgement, f, width, rule, last == Some(id(f)));
            }
            Ordering::Equal => {
                let (x, y) = (a.next().expect("peeked"), b.next().expect("peeked"));
                last = Some(id(x));
                same(&mut judgement, x, y, width, rule);
            }
        }
    }
    if judgement.compared == 0 {
        judgement.unit = "empty pixels";
        judgement.compared = size.pixels() as u64;
    }
    judgement
}

fn missing(judgement: &mut Judgement, f: &Fragment, width: u32, rule: &Rule<'_>) {
    if rule.may(f) {
        judgement.admitted += 1;
        return;
    }
    judgement.differs(Cause::Coverage, Some(f.pixel), || {
        format!(
            "{} must be covered by triangle row {}, is not",
            at(f.pixel, width),
            f.prim
        )
    });
}

fn extra(judgement: &mut Judgement, f: &Fragment, width: u32, rule: &Rule<'_>, again: bool) {
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
    } else {
        judgement.differs(Cause::Coverage, Some(f.pixel), || {
            format!(
                "{} must not be covered by triangle row {}, is",
                at(f.pixel, width),
                f.prim
            )
        });
    }
}

fn same(judgement: &mut Judgement, x: &Fragment, y: &Fragment, width: u32, rule: &Rule<'_>) {
    if x.key != y.key && matches!(rule, Rule::Exact) {
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
    /// Whether a pixel may go either way: if every corner moves by at most one
    /// sub-pixel in x and in y, an edge function `(b - a) x (p - a)` with
    /// differences up to `d` moves by at most `2 (|dx| + |dy|) + 4`, since each of
    /// the two factors of either product moves by at most 2.
    fn may(&self, f: &Fragment) -> bool {
        let Self::Band(primitives) = self else {
            return false;
        };
        let corners = primitives.prims[f.prim as usize]
            .map(|c| primitives.snapped[c as usize].map(i64::from));
        let size = primitives.size;
        let point = [
            sample(f.pixel % size.width, primitives.bits),
            sample(f.pixel / size.width, primitives.bits),
        ];
        let reach = |i: usize| {
            let (a, b) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
            let spans = [b[0] - a[0], b[1] - a[1], point[0] - a[0], point[1] - a[1]];
            2 * spans.iter().map(|s| s.abs()).sum::<i64>() + 8
        };
        let edges = match Setup::new(primitives, f.prim) {
            Some(setup) => setup.edges(point),
            // Without area on this grid it may have some on another.
            None => return true,
        };
        let least_reach = (0..3).map(reach).max().unwrap_or(0);
        edges.iter().all(|e| *e >= -least_reach) && edges.iter().any(|e| *e <= least_reach)
    }
}

/// A pixel in words.
pub fn at(pixel: u32, width: u32) -> String {
    format!("pixel ({}, {})", pixel % width, pixel / width)
}
