//! What tiles hold, as the lists that others are compared with.

use triptych_spec::abuffer::{EOL, Lists, Node};

use super::{PRIM_BITS, SIDE, tiles};
use crate::frame::{Band, WORKGROUP};

/// Runs of one array as lists, each node linked to the one after it. `offsets` has one entry more
/// than there are lists, which are those of [`super::lists`].
pub(super) fn of_runs(
    (width, band): (u32, Band),
    offsets: &[u32],
    entries: &[[u32; 2]],
    faces: &[[f32; 4]],
) -> Lists {
    let [across, _] = tiles(width, band);
    let mut lists = Lists {
        heads: Vec::with_capacity((width * band.rows) as usize),
        nodes: Vec::with_capacity(entries.len()),
        colours: Vec::with_capacity(entries.len()),
        attempts: offsets.last().copied().unwrap_or(0),
        capacity: offsets.last().copied().unwrap_or(0),
    };
    let mut last = vec![false; entries.len()];
    for run in offsets.windows(2).filter(|run| run[0] < run[1]) {
        if let Some(last) = last.get_mut(run[1] as usize - 1) {
            *last = true;
        }
    }
    for (&[key, prim], (address, is_last)) in entries.iter().zip((1..).zip(last)) {
        let next = if is_last { EOL } else { address };
        lists.nodes.push(Node {
            key,
            next,
            prim,
            mask: 1,
        });
        let colour = faces.get(prim as usize).copied();
        lists.colours.push(colour.unwrap_or([f32::NAN; 4]));
    }
    for (y, x) in (0..band.rows).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let tile = y / SIDE * across + x / SIDE;
        let list = (tile * WORKGROUP + y % SIDE * SIDE + x % SIDE) as usize;
        let empty = offsets[list] >= offsets[list + 1];
        lists.heads.push(if empty { EOL } else { offsets[list] });
    }
    lists
}

/// Nodes of 16 bytes as lists: key, next, mask and triangle, colour.
pub(super) fn of_nodes(
    heads: Vec<u32>,
    nodes: &[[u32; 4]],
    (attempts, capacity): (u32, u32),
) -> Lists {
    let node = |&[key, next, source, _]: &[u32; 4]| Node {
        key,
        next,
        prim: source & ((1 << PRIM_BITS) - 1),
        mask: source >> PRIM_BITS,
    };
    let colour = |&[_, _, _, packed]: &[u32; 4]| packed.to_le_bytes().map(|c| f32::from(c) / 255.0);
    Lists {
        heads,
        nodes: nodes.iter().map(node).collect(),
        colours: nodes.iter().map(colour).collect(),
        attempts,
        capacity,
    }
}
