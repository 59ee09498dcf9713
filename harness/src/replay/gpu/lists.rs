//! Lists in other forms.

use triptych_gpu::abuffer::Abuffer;
use triptych_spec::abuffer::{EOL, Lists, Node, Sorted};

use crate::compare;
use crate::replay::spec::SpecRun;

/// The spec's lists with links in sorted order.
pub(in crate::replay) fn relink(spec: &SpecRun) -> Lists {
    Lists {
        attempts: spec.lists.attempts,
        capacity: spec.lists.capacity,
        ..relinked(&spec.sorted, &spec.faces)
    }
}

/// Sorted lists with links in their order, and room for just these.
pub(in crate::replay) fn relinked(sorted: &Sorted, faces: &[[f32; 4]]) -> Lists {
    let count = u32::try_from(sorted.fragments.len()).expect("fewer than 2^32 fragments");
    let mut lists = Lists {
        heads: Vec::with_capacity(sorted.offsets.len()),
        nodes: Vec::with_capacity(sorted.fragments.len()),
        colours: sorted
            .fragments
            .iter()
            .map(|f| faces[f.prim as usize])
            .collect(),
        attempts: count,
        capacity: count,
    };
    for range in sorted.offsets.windows(2) {
        lists
            .heads
            .push(if range[0] < range[1] { range[0] } else { EOL });
        for address in range[0]..range[1] {
            let f = sorted.fragments[address as usize];
            let next = if address + 1 < range[1] {
                address + 1
            } else {
                EOL
            };
            lists.nodes.push(Node {
                key: f.key,
                next,
                prim: f.prim,
                mask: f.mask,
            });
        }
    }
    lists
}

/// The bands' sorted lists as one, with pixels counted from the target's first.
pub(super) fn join(abuffer: &Abuffer, width: u32) -> Option<Sorted> {
    let mut all = Sorted {
        offsets: vec![0],
        fragments: Vec::new(),
    };
    for band in &abuffer.bands {
        let flat = compare::order::flatten(band.sorted.as_ref()?)?;
        let start = *all.offsets.last()?;
        all.offsets
            .extend(flat.offsets[1..].iter().map(|o| start + o));
        let first = band.band.first * width;
        all.fragments
            .extend(flat.fragments.into_iter().map(|mut f| {
                f.pixel += first;
                f
            }));
    }
    Some(all)
}
