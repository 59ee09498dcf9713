//! Nodes of tiles' regions, as the lists that others are compared with.

use triptych_spec::abuffer::{EOL, Lists, Node};

use super::linked::Region;
use super::room::Room;
use crate::error::GpuError;
use crate::frame::Band;

/// The nodes of all regions, one region after another without gaps, with links to match. What leads to a
/// place that no counter handed out leads nowhere.
pub(super) fn lists(
    room: &Room<'_, '_>,
    band: Band,
    regions: &[Region],
) -> Result<Lists, GpuError> {
    let rasterizer = room.rasterizer;
    let gpu = rasterizer.gpu;
    let all = regions.last().map_or(0, |last| last.first + last.capacity);
    let nodes: Vec<[u32; 4]> = gpu.read(room.buffers.get("nodes"), all as usize)?;
    let pixels = band.pixels(rasterizer.size) as usize;
    let heads: Vec<u32> = gpu.read(room.buffers.get("heads"), pixels)?;
    // By address, the node's number among those that are stored.
    let mut numbers = vec![None; nodes.len()];
    let mut count = 0;
    for region in regions {
        for at in region.first..region.first + region.attempts.min(region.capacity) {
            numbers[at as usize] = Some(count);
            count += 1;
        }
    }
    // One less than the end of a list is no address.
    let moved = |at: u32| match numbers.get(at as usize) {
        _ if at == EOL => EOL,
        Some(Some(number)) => *number,
        _ => EOL - 1,
    };
    let stored = numbers
        .iter()
        .zip(&nodes)
        .filter(|(number, _)| number.is_some());
    let nodes: Vec<Node> = stored
        .map(|(_, &[key, next, prim, mask])| Node {
            key,
            next: moved(next),
            prim,
            mask,
        })
        .collect();
    let attempts: u64 = regions.iter().map(|r| u64::from(r.attempts)).sum();
    let face = |node: &Node| rasterizer.colours.get(node.prim as usize).copied();
    let colours = nodes.iter().map(|node| face(node).unwrap_or([f32::NAN; 4]));
    Ok(Lists {
        heads: heads.into_iter().map(moved).collect(),
        colours: colours.collect(),
        nodes,
        attempts: u32::try_from(attempts).unwrap_or(u32::MAX),
        capacity: count,
    })
}
