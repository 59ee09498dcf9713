//! Stage `build`: linked lists by certificate, then as multisets.
//!
//! First the counter: if it is less than the number of fragments and a link leads
//! astray, addresses were handed out twice, and anything may be in any list: all of
//! it is `overflow`, once for each address that the counter lacks.
//!
//! Then per pixel; the first that applies is the cause:
//!
//! 1. A head or link to an address that was handed out but lies beyond the
//!    capacity is `overflow`; to one inside the capacity that was never handed
//!    out, `stale-pass`; to any other, `corrupt-link`. A link to a node that the
//!    same list holds already is `cycle`; to one of another list, `corrupt-link`,
//!    and as either of the two may be the one that went astray, the other is not
//!    judged.
//!    Where there is an `overflow`, a list that holds the last node is not judged: a
//!    store beyond the end may land there (WGSL leaves open where it goes).
//! 2. A fragment that the list lacks is `lost-node` if a node that no list leads to
//!    holds it, and does not link to another pixel's list; else `coverage`.
//! 3. A fragment that the list holds too often is `duplicate` if it belongs there
//!    once; with another key than the spec's `depth-key`, with another mask
//!    `sample-mask`, with another colour `interval`; else `coverage`.
//!
//! Last, over all pixels: nodes that no list leads to and no list lacks are
//! `overflow` if nothing was ever stored in them, for then the counter counted too
//! much, else `lost-node`; a counter that is not explained by the above is
//! `overflow`. What the passes did is judged beside the lists: see `passes.rs`.

mod certificate;
mod membership;
#[cfg(test)]
pub(super) mod tests;
mod unowned;

use triptych_spec::abuffer::{Lists, Sorted};
use triptych_spec::raster::Fragment;

use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

pub use certificate::{Certificate, Fault, certify};

/// What the spec says a band's lists must hold.
pub struct Expected<'a> {
    /// The spec's lists for the whole target.
    pub sorted: &'a Sorted,
    /// First pixel of the band.
    pub first_pixel: u32,
    /// Colour of each triangle.
    pub faces: &'a [[f32; 4]],
    /// Pixels per row.
    pub width: u32,
}

impl Expected<'_> {
    fn list(&self, pixel: u32) -> &[Fragment] {
        self.sorted.list((self.first_pixel + pixel) as usize)
    }

    /// Fragments of the pixels of a band.
    fn total(&self, pixels: usize) -> u64 {
        let first = self.first_pixel as usize;
        let offsets = &self.sorted.offsets;
        u64::from(offsets[first + pixels] - offsets[first])
    }
}

/// Compares a band's lists, which must hold everything.
pub fn compare(expected: &Expected<'_>, lists: &Lists) -> Judgement {
    let needed = expected.total(lists.heads.len());
    let mut judgement = Judgement {
        compared: needed,
        ..Judgement::new(Class::Structure, "fragments")
    };
    if needed == 0 {
        judgement.unit = "empty lists";
        judgement.compared = lists.heads.len() as u64;
    }
    let certificate = certify(lists);
    if judge_shared(needed, lists, &certificate, &mut judgement) {
        return judgement;
    }
    membership::judge(expected, lists, &certificate, true, &mut judgement);
    // A fragment too many or too few was counted, too: that is no second cause.
    if judgement.differ() == 0 {
        judge_counter(needed, lists, &mut judgement);
    }
    judgement
}

/// Compares what an overflowing attempt stored: an arbitrary subset, but every
/// node in one list, every fragment one of the spec's, and the counter the same as
/// that of the attempt with enough room, which [`compare`] judges.
pub fn compare_overflowed(expected: &Expected<'_>, lists: &Lists, enough: u64) -> Judgement {
    let mut judgement = Judgement::new(Class::Structure, "nodes");
    // The counter is an item, too: with no capacity it is the only one.
    judgement.compared = lists.nodes.len() as u64 + 1;
    let certificate = certify(lists);
    let needed = expected.total(lists.heads.len());
    if judge_shared(needed, lists, &certificate, &mut judgement) {
        return judgement;
    }
    membership::judge(expected, lists, &certificate, false, &mut judgement);
    if judgement.differ() == 0 {
        judge_counter(enough, lists, &mut judgement);
    }
    judgement
}

/// Whether the counter handed out addresses twice, which explains everything else.
fn judge_shared(
    needed: u64,
    lists: &Lists,
    certificate: &Certificate,
    judgement: &mut Judgement,
) -> bool {
    let lacking = needed.saturating_sub(u64::from(lists.attempts));
    let shared = lacking > 0 && !certificate.faults.is_empty();
    for _ in 0..if shared { lacking } else { 0 } {
        judgement.differs(Cause::Overflow, None, || {
            let attempts = lists.attempts;
            format!("the counter is {attempts}, must be {needed}: addresses are shared")
        });
    }
    shared
}

fn judge_counter(needed: u64, lists: &Lists, judgement: &mut Judgement) {
    if u64::from(lists.attempts) != needed {
        judgement.differs(Cause::Overflow, None, || {
            format!("the counter is {}, must be {needed}", lists.attempts)
        });
    }
}
