//! Counts, offsets and entries of cells.

use super::{Runs, listed};
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

/// Stage `count`: every cell lists as many triangles.
pub fn counts(spec: &[u32], seen: &[u32]) -> Judgement {
    numbers("cells", Cause::Coverage, spec, seen)
}

/// Stage `scan`: every run starts where it should, and the last ends there.
pub fn offsets(spec: &[u32], seen: &[u32]) -> Judgement {
    numbers("offsets", Cause::CorruptLink, spec, seen)
}

fn numbers(unit: &'static str, cause: Cause, spec: &[u32], seen: &[u32]) -> Judgement {
    let mut judgement = Judgement {
        compared: spec.len() as u64,
        ..Judgement::new(Class::Exact, unit)
    };
    if spec.len() != seen.len() {
        judgement.differs(Cause::ReferenceMissing, None, || {
            format!("{} {unit}, must be {}", seen.len(), spec.len())
        });
    }
    for (at, (spec, seen)) in spec.iter().zip(seen).enumerate() {
        if spec != seen {
            judgement.differs(cause, None, || {
                format!("number {at} is {seen}, must be {spec}")
            });
        }
    }
    judgement
}

/// Stage `fill`: every cell's run holds the same ids, rising. A cell that differs is counted
/// once, by its first difference.
pub fn entries(spec: Runs<'_>, seen: &[u32]) -> Judgement {
    let mut judgement = listed(Class::Exact, spec.prims.len() as u64, spec.cells());
    let runs = Runs {
        prims: seen,
        ..spec
    };
    for cell in 0..spec.cells() {
        let (spec, seen) = (spec.list(cell), runs.list(cell));
        if spec != seen {
            let cause = cause(spec, seen);
            judgement.differs(cause, None, || lists(cell, spec, seen));
        }
    }
    judgement
}

/// Why two lists differ, of which the first is right.
fn cause(spec: &[u32], seen: &[u32]) -> Cause {
    let mut sorted = seen.to_vec();
    sorted.sort_unstable();
    let foreign = sorted.iter().any(|prim| spec.binary_search(prim).is_err());
    let twice = sorted.windows(2).any(|pair| pair[0] == pair[1]);
    match () {
        () if sorted == spec => Cause::SortOrder,
        // Another cell's, or nobody's.
        () if foreign => Cause::Coverage,
        () if twice => Cause::Duplicate,
        () => Cause::LostNode,
    }
}

fn lists(cell: usize, spec: &[u32], seen: &[u32]) -> String {
    let shown = |list: &[u32]| {
        let more = if list.len() > 8 { ", …" } else { "" };
        let first: Vec<String> = list.iter().take(8).map(u32::to_string).collect();
        format!("[{}{more}]", first.join(", "))
    };
    format!(
        "cell {cell} lists {}, must list {}",
        shown(seen),
        shown(spec)
    )
}

/// Lists of which a kernel may hold more than the spec, where it cannot prove that a triangle
/// misses a cell that its box touches: between the spec's lists and those of boxes. What is
/// beyond the spec's is counted as admitted.
pub fn within(least: Runs<'_>, seen: Runs<'_>, most: Runs<'_>) -> Judgement {
    let mut judgement = listed(Class::Decision, most.prims.len() as u64, most.cells());
    for cell in 0..least.cells() {
        let (low, list, high) = (least.list(cell), seen.list(cell), most.list(cell));
        let rises = list.windows(2).all(|pair| pair[0] < pair[1]);
        let lost = low.iter().any(|prim| !list.contains(prim));
        let foreign = list.iter().any(|prim| high.binary_search(prim).is_err());
        let cause = match () {
            () if lost => Some(Cause::LostNode),
            () if foreign => Some(Cause::Coverage),
            () if !rises => Some(Cause::SortOrder),
            () => None,
        };
        match cause {
            Some(cause) => judgement.differs(cause, None, || lists(cell, low, list)),
            None => judgement.admitted += (list.len() - low.len()) as u64,
        }
    }
    judgement.note = format!(
        "{} of {} entries by boxes are dropped, {} by the spec",
        most.prims.len() - seen.prims.len().min(most.prims.len()),
        most.prims.len(),
        most.prims.len() - least.prims.len()
    );
    judgement
}

/// Stage `count` of such lists: between the spec's counts and those of boxes.
pub fn counts_within(least: &[u32], seen: &[u32], most: Runs<'_>) -> Judgement {
    let mut judgement = Judgement {
        compared: least.len() as u64,
        ..Judgement::new(Class::Decision, "cells")
    };
    if seen.len() != least.len() {
        judgement.differs(Cause::ReferenceMissing, None, || {
            format!("{} cells, must be {}", seen.len(), least.len())
        });
    }
    for (cell, (low, seen)) in least.iter().zip(seen).enumerate() {
        let high = most.list(cell).len() as u64;
        if !(u64::from(*low)..=high).contains(&u64::from(*seen)) {
            judgement.differs(Cause::Coverage, None, || {
                format!("cell {cell} counts {seen}, must count {low} to {high}")
            });
        } else if low != seen {
            judgement.admitted += 1;
        }
    }
    judgement
}

/// An attempt of stage `fill` without room for all: what is stored belongs to its cell, no
/// entry twice.
pub fn overflowed(spec: Runs<'_>, seen: &[u32]) -> Judgement {
    let mut judgement = listed(Class::Structure, seen.len() as u64, spec.cells());
    for cell in 0..spec.cells() {
        let start = (spec.offsets[cell] as usize).min(seen.len());
        let end = (spec.offsets[cell + 1] as usize).min(seen.len());
        let mut stored = seen[start..end].to_vec();
        stored.sort_unstable();
        let list = spec.list(cell);
        let foreign = stored.iter().any(|prim| list.binary_search(prim).is_err());
        let twice = stored.windows(2).any(|pair| pair[0] == pair[1]);
        if foreign || twice {
            let cause = if foreign {
                Cause::Overflow
            } else {
                Cause::Duplicate
            };
            judgement.differs(cause, None, || lists(cell, list, &stored));
        }
    }
    judgement
}
