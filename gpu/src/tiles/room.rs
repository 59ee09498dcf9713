//! Buffers of a band that is drawn by tiles, and the passes over them.

use bytemuck::{Pod, Zeroable};
use triptych_spec::tiles::SIDE;

use super::pool::Pool;
use super::{Tiled, lists, tiles};
use crate::error::GpuError;
use crate::frame::{Band, Frame, WORKGROUP};
use crate::lists::TILE;
use crate::named::Named;
use crate::raster::{Need, Rasterizer};
use crate::ready::Ready;

/// Bytes of a list. Twin: `List` in `jagged.wgsl`.
const LIST: u64 = 12;

/// Workgroups that share large triangles, as long as that is enough.
const GROUPS: u32 = 2048;

/// Iterations of a workgroup over large triangles, at most: llvmpipe ends loops after 65,535.
const SHARED: u64 = 1 << 15;

/// Of a sample: opaque surface, picture. Of a pixel: list, longest lists. Of a fragment:
/// an entry, and one more while long lists are put in order.
pub(super) fn need(rasterizer: &Rasterizer<'_>) -> Need {
    let samples = u64::from(rasterizer.samples.count());
    let binding = rasterizer.gpu.binding_limit();
    // Lists are those of whole tiles.
    let row = LIST * u64::from(rasterizer.size.width.next_multiple_of(SIDE));
    let side = u64::from(SIDE);
    let rows = binding / row / side * side;
    Need {
        what: "jagged",
        pixel: SAMPLE * samples + LIST + 4,
        node: 16,
        pixels_max: (binding / (COLOUR * samples)).min(rows * u64::from(rasterizer.size.width)),
    }
}

/// Bytes of a colour.
pub(super) const COLOUR: u64 = 16;

/// Bytes of a sample: what is opaque, and what is seen.
pub(super) const SAMPLE: u64 = 2 * 4 + COLOUR;

/// What is known of lists once they are placed. Twin: `Longest` in `jagged.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(super) struct Longest {
    /// Entries of the longest.
    pub(super) length: u32,
    /// Which kernels of stage shade have any, a bit each.
    pub(super) kernels: u32,
    /// How many are longer than a workgroup sorts.
    pub(super) count: u32,
}

/// A band on the device.
pub(super) struct Room<'r, 'g> {
    pub(super) rasterizer: &'r Rasterizer<'g>,
    pub(super) frame: Frame,
    /// Tiles of the band.
    pub(super) tiles: u32,
    /// Lists of the band.
    pub(super) lists: u32,
    /// Triangles in bins, once they are filled.
    pub(super) binned: u32,
    /// All buffers by the names of variables.
    pub(super) buffers: Named,
    /// Where most of them come from.
    pub(super) pool: Pool,
    /// Triangles of each tile, while they are counted.
    in_tiles: wgpu::Buffer,
}

impl<'r, 'g> Room<'r, 'g> {
    /// Room for bins and lists, which are yet to be counted.
    pub(super) fn new(
        rasterizer: &'r Rasterizer<'g>,
        (band, pool): (Band, Pool),
        frame: Frame,
    ) -> Result<Self, GpuError> {
        let gpu = rasterizer.gpu;
        let width = rasterizer.size.width;
        let [across, down] = tiles(width, band);
        let (tiles, lists) = (across * down, lists(width, band));
        let samples = rasterizer.samples.count() * band.pixels(rasterizer.size);
        let bytes = |what, bytes| pool.storage(gpu, what, bytes);
        let words = |what, count: u32| bytes(what, 4 * u64::from(count));
        let buffers = vec![
            ("bins", words("offsets of tiles", tiles + 1)?),
            ("sums", words("sums of parts", tiles.div_ceil(TILE))?),
            ("larges", words("large triangles", rasterizer.prims() + 1)?),
            // These are made anew once it is known how many there are.
            ("binned", words("triangles in tiles", 0)?),
            ("rows", words("rows of tiles", 0)?),
            ("listed", words("entries of lists", 0)?),
            ("lists", bytes("lists", LIST * u64::from(lists))?),
            ("longest", words("longest lists", lists + 3)?),
            ("counter", words("counter", 1)?),
            ("unfinished", words("unfinished", 1)?),
            // Where all tiles have lists, there is one digest, of zeros.
            ("digests", gpu.storage("digests", 12)?),
            ("picture", bytes("picture", COLOUR * u64::from(samples))?),
        ];
        Ok(Self {
            in_tiles: words("triangles of tiles", tiles)?,
            rasterizer,
            frame,
            tiles,
            lists,
            binned: 0,
            buffers: buffers.into(),
            pool,
        })
    }

    /// All buffers.
    pub(super) fn held(&self) -> impl Iterator<Item = &wgpu::Buffer> {
        let named = self.buffers.iter().map(|(_, buffer)| buffer);
        named.chain([&self.in_tiles])
    }

    /// What the kernels found out of the lists, which hold so many entries. A kernel of a user's may
    /// have written anything.
    pub(super) fn longest(&self, entries: u32) -> Result<Longest, GpuError> {
        let gpu = self.rasterizer.gpu;
        let words: Vec<Longest> = gpu.read(self.buffers.get("longest"), 1)?;
        Ok(Longest {
            length: words[0].length.min(entries),
            kernels: words[0].kernels,
            count: words[0].count.min(self.lists),
        })
    }

    pub(super) fn pass(&self, entry: &str, tiled: Tiled, groups: u32) -> Result<Ready, GpuError> {
        self.pass_with(entry, tiled, groups, &[])
    }

    /// A pass, with other buffers in place of those of the same names.
    fn pass_with(
        &self,
        entry: &str,
        tiled: Tiled,
        groups: u32,
        others: &[(&str, &wgpu::Buffer)],
    ) -> Result<Ready, GpuError> {
        let Rasterizer { gpu, kernels, .. } = *self.rasterizer;
        let frame = gpu.uniform("frame", &self.frame)?;
        let tiled = gpu.uniform("tiled", &tiled)?;
        let mut all = others.to_vec();
        all.extend([
            ("frame", &frame),
            ("tiled", &tiled),
            ("corners", self.rasterizer.corners()),
            ("faces", &self.rasterizer.faces),
        ]);
        all.extend(self.buffers.iter());
        let file = match (entry, self.frame.samples) {
            ("local", 1) => "local",
            ("local", _) => "local_samples",
            ("linked" | "linked_sort" | "linked_blend", 1) => "linked",
            ("linked" | "linked_sort" | "linked_blend", _) => "linked_samples",
            (_, 1) => "tiles",
            _ => "tiles_samples",
        };
        Ready::new(gpu, kernels, (file, entry), groups, &all)
    }

    /// Counts the triangles of each tile, and where its bin begins.
    pub(super) fn count_bins(&self) -> Result<Vec<Ready>, GpuError> {
        let tiled = self.of_triangles(0);
        let others = [
            ("counts", &self.in_tiles),
            ("offsets", self.buffers.get("bins")),
        ];
        let small = self.pass_with("bin_count", tiled, tiled.items.div_ceil(WORKGROUP), &others)?;
        let small = small.after_clearing(self.in_tiles.clone());
        let mut passes = vec![
            small.after_clearing(self.buffers.get("larges").clone()),
            self.pass_with("bin_count_large", tiled, tiled.groups, &others)?,
        ];
        passes.extend(self.offsets(self.tiles, &others)?);
        Ok(passes)
    }

    /// Fills the bins, which have room for so many triangles, and puts them in order.
    pub(super) fn fill_bins(&self, binned: u32) -> Result<Vec<Ready>, GpuError> {
        let tiled = self.of_triangles(binned);
        let others = [
            ("counts", &self.in_tiles),
            ("offsets", self.buffers.get("bins")),
        ];
        Ok(vec![
            self.pass_with("bin_fill", tiled, tiled.items.div_ceil(WORKGROUP), &others)?,
            self.pass_with("bin_fill_large", tiled, tiled.groups, &others)?,
            self.pass("bin_sort", self.of_tiles(), self.tiles)?,
        ])
    }

    fn of_triangles(&self, capacity: u32) -> Tiled {
        let prims = self.rasterizer.prims();
        Tiled {
            items: prims,
            capacity,
            groups: groups(prims, self.tiles),
            ..Tiled::default()
        }
    }

    /// Where each of so many runs begins.
    fn offsets(
        &self,
        items: u32,
        others: &[(&str, &wgpu::Buffer)],
    ) -> Result<[Ready; 3], GpuError> {
        let tiled = Tiled {
            items,
            ..Tiled::default()
        };
        let parts = items.div_ceil(TILE);
        Ok([
            self.pass_with("bin_parts", tiled, parts, others)?,
            self.pass_with("bin_sums", tiled, 1, others)?,
            self.pass_with("bin_offsets", tiled, parts, others)?,
        ])
    }

    /// A kernel over all tiles, so many triangles at a time, of bins of at most `longest`.
    pub(super) fn drawn(
        &self,
        entry: &str,
        capacity: u32,
        (longest, drawn): (u32, u32),
    ) -> Result<Vec<Ready>, GpuError> {
        let pass = |first| {
            let tiled = Tiled {
                capacity,
                first,
                count: drawn,
                ..self.of_tiles()
            };
            self.pass(entry, tiled, self.tiles)
        };
        let mut passes = Vec::new();
        for first in (0..longest.max(1)).step_by(drawn.max(1) as usize) {
            passes.push(pass(first)?);
        }
        Ok(passes)
    }
}

/// Workgroups for large triangles: a triangle takes an iteration, and one for each 64 tiles.
fn groups(prims: u32, tiles: u32) -> u32 {
    let of_each = u64::from(tiles.div_ceil(WORKGROUP)) + 1;
    let needed = (u64::from(prims) * of_each).div_ceil(SHARED);
    u32::try_from(needed.max(GROUPS.into())).expect("fewer than triangles and tiles")
}
