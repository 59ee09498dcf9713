//! The buffers of one attempt at one band.

use std::ops::Range;

use triptych_spec::abuffer::{EOL, Lists, NOTHING, Node};

use super::Given;
use crate::context::Gpu;
use crate::error::GpuError;
use crate::kernel::Fault;
use crate::lists::HEADER;
use crate::raster::Need;

/// Bytes of a pixel's progress. Twin: `Progress` in `abuffer.wgsl`.
pub const PROGRESS: u64 = 32;

/// Pixels that a dispatch of one workgroup row can serve.
const PIXELS_MAX: u64 = 65_535 * crate::frame::WORKGROUP as u64;

/// Bytes of a sample's colour in the picture.
const COLOUR: u64 = 16;

/// Bytes of a fragment in a list: node and colour.
pub const NODE: u64 = 16 + 16;

/// Bytes of the buffers of so many pixels with so many samples each, and of nodes; what sorts the
/// lists keeps its progress as well.
pub fn bytes([pixels, samples]: [u32; 2], nodes: u32, sorts: bool) -> u64 {
    let progress = if sorts { PROGRESS } else { 0 };
    let pixel = 4 + u64::from(samples) * (2 * 4 + COLOUR) + progress;
    pixel * u64::from(pixels) + NODE * u64::from(nodes)
}

/// Heads, opaque surfaces, picture and progress of a pixel; a node and its colour.
pub(super) fn need(gpu: &Gpu) -> Need {
    need_of(gpu, 1)
}

/// The same where pixels have so many samples: surfaces and picture are those of each.
pub(super) fn need_of(gpu: &Gpu, samples: u32) -> Need {
    let samples = u64::from(samples);
    let largest = PROGRESS.max(samples * COLOUR);
    let bindable = gpu.binding_limit().saturating_sub(HEADER) / largest;
    Need {
        what: "build",
        pixel: 4 + samples * (2 * 4 + COLOUR) + PROGRESS,
        node: NODE,
        pixels_max: PIXELS_MAX.min(bindable),
    }
}

/// Buffers of a band.
pub(super) struct Buffers {
    pub(super) counter: wgpu::Buffer,
    pub(super) opaque_key: wgpu::Buffer,
    pub(super) opaque_prim: wgpu::Buffer,
    pub(super) heads: wgpu::Buffer,
    pub(super) nodes: wgpu::Buffer,
    pub(super) colours: wgpu::Buffer,
    pub(super) picture: wgpu::Buffer,
    pub(super) progress: wgpu::Buffer,
}

impl Buffers {
    /// No surfaces, and empty lists with room for so many nodes.
    pub(super) fn empty(
        gpu: &Gpu,
        pixels: u32,
        capacity: u32,
        fault: Option<Fault>,
    ) -> Result<Self, GpuError> {
        Self::sampled(gpu, [pixels, 1], capacity, fault)
    }

    /// The same for so many pixels, and samples of each.
    pub(super) fn sampled(
        gpu: &Gpu,
        [pixels, samples]: [u32; 2],
        capacity: u32,
        fault: Option<Fault>,
    ) -> Result<Self, GpuError> {
        let opaque_key = gpu.filled("opaque_key", pixels * samples, NOTHING)?;
        let opaque_prim = gpu.filled("opaque_prim", pixels * samples, NOTHING)?;
        let surfaces = [opaque_key, opaque_prim];
        Self::in_front_of(gpu, surfaces, [pixels, samples], capacity, fault)
    }

    /// Empty lists, with room for so many nodes, in front of these surfaces.
    fn in_front_of(
        gpu: &Gpu,
        [opaque_key, opaque_prim]: [wgpu::Buffer; 2],
        [pixels, samples]: [u32; 2],
        capacity: u32,
        fault: Option<Fault>,
    ) -> Result<Self, GpuError> {
        let nodes = 16 * u64::from(capacity);
        let head = match fault {
            Some(Fault::HeadsNotCleared) => 0,
            _ => EOL,
        };
        let counted = match fault {
            Some(Fault::CounterNotCleared) => 64,
            _ => 0,
        };
        Ok(Self {
            counter: gpu.filled("counter", 1, counted)?,
            opaque_key,
            opaque_prim,
            heads: gpu.filled("heads", pixels, head)?,
            nodes: gpu.storage("nodes", nodes)?,
            colours: gpu.storage("colours", nodes)?,
            picture: gpu.storage("picture", COLOUR * u64::from(pixels) * u64::from(samples))?,
            progress: gpu.storage("progress", HEADER + PROGRESS * u64::from(pixels))?,
        })
    }

    /// The surfaces that are given for these pixels, and the lists, or room for so many
    /// nodes.
    pub(super) fn given(
        gpu: &Gpu,
        given: Given<'_>,
        (pixels, samples): (Range<usize>, u32),
        capacity: u32,
        fault: Option<Fault>,
    ) -> Result<Self, GpuError> {
        let each = samples as usize;
        let places = pixels.start * each..pixels.end * each;
        let opaque_key = gpu.upload("opaque_key", &given.opaque.key[places.clone()])?;
        let opaque_prim = gpu.upload("opaque_prim", &given.opaque.prim[places])?;
        let Some(lists) = given.lists else {
            let surfaces = [opaque_key, opaque_prim];
            let pixels = [word(pixels.len()), samples];
            return Self::in_front_of(gpu, surfaces, pixels, capacity, fault);
        };
        let count = pixels.len() as u64;
        let part = Part::of(lists, pixels);
        Ok(Self {
            counter: gpu.upload("counter", &[word(part.nodes.len())])?,
            opaque_key,
            opaque_prim,
            heads: gpu.upload("heads", &part.heads)?,
            nodes: gpu.upload("nodes", &part.nodes)?,
            colours: gpu.upload("colours", &part.colours)?,
            picture: gpu.storage("picture", COLOUR * count * u64::from(samples))?,
            progress: gpu.storage("progress", HEADER + PROGRESS * count)?,
        })
    }

    /// What the lists of so many pixels hold.
    pub(super) fn lists(&self, gpu: &Gpu, pixels: u32, capacity: u32) -> Result<Lists, GpuError> {
        let attempts = gpu.read::<u32>(&self.counter, 1)?[0];
        let stored = attempts.min(capacity) as usize;
        let nodes: Vec<[u32; 4]> = gpu.read(&self.nodes, stored)?;
        let node = |[key, next, prim, mask]: [u32; 4]| Node {
            key,
            next,
            prim,
            mask,
        };
        Ok(Lists {
            heads: gpu.read(&self.heads, pixels as usize)?,
            nodes: nodes.into_iter().map(node).collect(),
            colours: gpu.read(&self.colours, stored)?,
            attempts,
            capacity,
        })
    }

    pub(super) fn named(&self) -> [(&'static str, &wgpu::Buffer); 8] {
        [
            ("counter", &self.counter),
            ("opaque_key", &self.opaque_key),
            ("opaque_prim", &self.opaque_prim),
            ("heads", &self.heads),
            ("nodes", &self.nodes),
            ("colours", &self.colours),
            ("picture", &self.picture),
            ("progress", &self.progress),
        ]
    }
}

/// Lists as the kernels have them.
struct Part {
    heads: Vec<u32>,
    nodes: Vec<[u32; 4]>,
    colours: Vec<[f32; 4]>,
}

impl Part {
    /// The lists of some pixels alone: their nodes keep their order, and move up.
    fn of(lists: &Lists, pixels: Range<usize>) -> Self {
        let heads = &lists.heads[pixels];
        let mut kept: Vec<u32> = heads.iter().flat_map(|h| follow(lists, *h)).collect();
        kept.sort_unstable();
        kept.dedup();
        let moved = |at: u32| kept.binary_search(&at).map_or(EOL, word);
        let node = |&at: &u32| {
            let node = lists.nodes[at as usize];
            [node.key, moved(node.next), node.prim, node.mask]
        };
        Self {
            heads: heads.iter().map(|h| moved(*h)).collect(),
            nodes: kept.iter().map(node).collect(),
            colours: kept.iter().map(|&at| lists.colours[at as usize]).collect(),
        }
    }
}

/// Nodes of the lists of each row of `width` pixels.
pub(super) fn nodes_of_rows(lists: &Lists, width: u32) -> impl Iterator<Item = u32> {
    let rows = lists.heads.chunks(width as usize);
    rows.map(|heads| word(heads.iter().map(|head| follow(lists, *head).count()).sum()))
}

/// The addresses of a list's nodes; one that does not end is left sometime.
fn follow(lists: &Lists, head: u32) -> impl Iterator<Item = u32> {
    let inside = |at: u32| ((at as usize) < lists.nodes.len()).then_some(at);
    let next = move |at: &u32| inside(lists.nodes[*at as usize].next);
    std::iter::successors(inside(head), next).take(lists.nodes.len())
}

fn word(n: usize) -> u32 {
    u32::try_from(n).expect("addresses are words")
}
