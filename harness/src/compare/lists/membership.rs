//! Whether the lists hold what they must.

use std::collections::BTreeSet;

use triptych_spec::abuffer::Lists;
use triptych_spec::raster::Fragment;

use super::unowned::Unowned;
use super::{Certificate, Expected, Fault};
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::compare::fragments::at;

/// Judges lists against the spec's. With `complete` false they may hold any subset.
pub fn judge(
    expected: &Expected<'_>,
    lists: &Lists,
    certificate: &Certificate,
    complete: bool,
    judgement: &mut Judgement,
) {
    let mut unowned = Unowned::new(lists, certificate);
    let overflow = certificate
        .faults
        .iter()
        .any(|f| f.cause == Cause::Overflow);
    let last = lists.capacity.checked_sub(1).filter(|_| overflow);
    let owners: BTreeSet<u32> = certificate.faults.iter().filter_map(|f| f.owner).collect();
    let in_doubt = |pixel| {
        let holds = |address| certificate.list(pixel).contains(&address);
        owners.contains(&pixel) || last.is_some_and(holds)
    };
    let mut faults = certificate.faults.iter().peekable();
    let pixels = u32::try_from(lists.heads.len()).expect("a target has fewer than 2^32 pixels");
    for pixel in 0..pixels {
        // What follows from a fault is not counted again.
        if let Some(fault) = faults.next_if(|f| f.pixel == pixel) {
            report_fault(expected, fault, judgement);
            continue;
        }
        if in_doubt(pixel) {
            continue;
        }
        let mut list = List {
            expected,
            pixel,
            judgement,
        };
        list.judge(
            &list_of(lists, certificate, pixel),
            complete.then_some(&mut unowned),
        );
    }
    // With faults about, a node may be unowned because a link went astray.
    if certificate.faults.is_empty() {
        unowned.report(expected, judgement);
    }
}

fn report_fault(expected: &Expected<'_>, fault: &Fault, judgement: &mut Judgement) {
    let pixel = expected.first_pixel + fault.pixel;
    judgement.differs(fault.cause, Some(pixel), || {
        format!(
            "{}: a link leads to address {}",
            at(pixel, expected.width),
            fault.address
        )
    });
}

/// A pixel's fragments and colours in order of triangle.
fn list_of(lists: &Lists, certificate: &Certificate, pixel: u32) -> Vec<(Fragment, [f32; 4])> {
    let fragment = |&address: &u32| {
        let node = lists.nodes[address as usize];
        let fragment = Fragment {
            pixel,
            prim: node.prim,
            key: node.key,
            mask: node.mask,
        };
        (fragment, lists.colours[address as usize])
    };
    let mut list: Vec<_> = certificate.list(pixel).iter().map(fragment).collect();
    list.sort_unstable_by_key(|(f, _)| *f);
    list
}

/// One pixel's list, under judgement.
struct List<'a, 'e> {
    expected: &'a Expected<'e>,
    pixel: u32,
    judgement: &'a mut Judgement,
}

impl List<'_, '_> {
    fn judge(&mut self, seen: &[(Fragment, [f32; 4])], unowned: Option<&mut Unowned>) {
        let mut must = self.expected.list(self.pixel).to_vec();
        must.sort_unstable_by_key(|f| f.prim);
        let mut here = vec![false; must.len()];
        let mut last = None;
        for (f, colour) in seen {
            let again = last.replace(f.prim) == Some(f.prim);
            match must.binary_search_by_key(&f.prim, |m| m.prim) {
                Ok(_) if again => self.differs(Cause::Duplicate, f, "is held more than once"),
                Ok(i) => {
                    here[i] = true;
                    self.judge_node(&must[i], f, *colour);
                }
                Err(_) => self.differs(Cause::Coverage, f, "is held, must not be"),
            }
        }
        let Some(unowned) = unowned else { return };
        for (f, _) in must.iter().zip(&here).filter(|(_, here)| !**here) {
            if unowned.take(self.pixel, f) {
                self.differs(
                    Cause::LostNode,
                    f,
                    "has a node that the list does not lead to",
                );
            } else {
                self.differs(Cause::Coverage, f, "is missing");
            }
        }
    }

    fn judge_node(&mut self, must: &Fragment, seen: &Fragment, colour: [f32; 4]) {
        let face = self.expected.faces[must.prim as usize];
        if seen.key != must.key {
            let words = format!("has key {}, must be {}", seen.key, must.key);
            self.differs(Cause::DepthKey, seen, &words);
        } else if seen.mask != must.mask {
            let words = format!("has mask {:#x}, must be {:#x}", seen.mask, must.mask);
            self.differs(Cause::SampleMask, seen, &words);
        } else if colour.map(f32::to_bits) != face.map(f32::to_bits) {
            let words = format!("has colour {colour:?}, must be {face:?}");
            self.differs(Cause::Interval, seen, &words);
        }
    }

    fn differs(&mut self, cause: Cause, f: &Fragment, words: &str) {
        let pixel = self.expected.first_pixel + self.pixel;
        let width = self.expected.width;
        self.judgement.differs(cause, Some(pixel), || {
            format!("{} triangle row {} {words}", at(pixel, width), f.prim)
        });
    }
}
