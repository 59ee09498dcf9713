//! What tiles hold, as the lists that others are compared with.

use bytemuck::{Pod, Zeroable};
use triptych_spec::abuffer::{EOL, Lists, Node};
use triptych_spec::raster::Samples;
use triptych_spec::tiles::{ROWS, SIDE, unpacked};

use super::tiles;
use crate::frame::{Band, WORKGROUP};

/// A list as kernels have it. Twin: `List` in `jagged.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct List {
    /// Its first entry, and [`CONTIGUOUS`].
    pub start: u32,
    /// Entries.
    pub length: u32,
    /// How far it is filled, and [`IN_ORDER`].
    pub filled: u32,
}

/// Marks a list whose entries lie one after another. Twin: `CONTIGUOUS` in `jagged.wgsl`.
pub const CONTIGUOUS: u32 = 0x8000_0000;

/// Marks a list whose entries came in order. Twin: `IN_ORDER` in `jagged.wgsl`.
pub const IN_ORDER: u32 = 0x8000_0000;

/// Jagged diagonals as lists, each entry linked to the next one of its list. Where a list leads
/// astray, the links do: whoever follows them must find out.
pub(super) fn of_rows(
    (width, band): (u32, Band),
    (lists, rows): (&[List], &[u32]),
    (entries, samples): (&[[u32; 2]], Samples),
    faces: &[[f32; 4]],
) -> Lists {
    let [across, _] = tiles(width, band);
    let all = u32::try_from(entries.len()).expect("addresses are words");
    let node = |&[key, word]: &[u32; 2]| {
        let (prim, mask) = unpacked(samples, word);
        Node {
            key,
            next: EOL,
            prim,
            mask,
        }
    };
    let colour = |node: &Node| faces.get(node.prim as usize).copied();
    let nodes: Vec<Node> = entries.iter().map(node).collect();
    let mut linked = Lists {
        heads: Vec::with_capacity((width * band.rows) as usize),
        colours: nodes
            .iter()
            .map(|n| colour(n).unwrap_or([f32::NAN; 4]))
            .collect(),
        nodes,
        attempts: all,
        capacity: all,
    };
    let mut left = all.saturating_add(1);
    for (y, x) in (0..band.rows).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let tile = y / SIDE * across + x / SIDE;
        let list = lists[(tile * WORKGROUP + y % SIDE * SIDE + x % SIDE) as usize];
        let slot = |i: u32| match list.start & CONTIGUOUS {
            0 => {
                let row = rows.get(rows[tile as usize].wrapping_add(i) as usize);
                list.start.wrapping_add(row.copied().unwrap_or(EOL))
            }
            _ => (list.start & !CONTIGUOUS).wrapping_add(i),
        };
        let most = match list.start & CONTIGUOUS {
            0 => ROWS,
            _ => all,
        };
        // Lists that claim more entries than there are share some, which whoever compares finds out.
        let length = list.length.min(most).min(left);
        left -= length;
        let mut slots = (0..length).map(slot);
        let mut last = slots.next().unwrap_or(EOL);
        linked.heads.push(last);
        for next in slots {
            if let Some(node) = linked.nodes.get_mut(last as usize) {
                node.next = next;
            }
            last = next;
        }
    }
    linked
}
