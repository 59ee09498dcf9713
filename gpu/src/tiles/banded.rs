//! A target drawn over and over, each part timed: in bands of rows where not all of it fits at once, one
//! after another in the same buffers. The time of a part is then that of all bands.

use std::collections::BTreeMap;

use triptych_spec::tiles::SIDE;

use super::pool::Pool;
use super::timed::{Span, Timed};
use super::{Options, linked, room};
use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::{Attempts, Need, Rasterizer};
use crate::timer::Timer;

/// What a tile does with its fragments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Runs of entries: stages jagged and shade.
    Runs,
    /// Linked lists: stage linked.
    Linked,
    /// Nothing in memory, but where that does not do: stage local.
    Local,
}

/// Bytes of a pixel's digest.
const DIGEST: u64 = 8;

impl Way {
    /// What a band takes at least, beside its bins.
    fn need(self, rasterizer: &Rasterizer<'_>) -> Need {
        let runs = room::need(rasterizer);
        match self {
            // If lists are merged turns out as they are filled.
            Self::Runs => Need { node: 8, ..runs },
            Self::Linked => linked::need(rasterizer),
            Self::Local => Need {
                pixel: runs.pixel + DIGEST,
                node: 0,
                ..runs
            },
        }
    }
}

/// A whole target that is set up.
pub struct Banded<'r, 'g> {
    rasterizer: &'r Rasterizer<'g>,
    bands: Vec<Timed<'r, 'g>>,
    /// The parts, of which a band may lack some.
    parts: Vec<Span>,
    /// Band and part of all that runs, in this order.
    runs: Vec<[usize; 2]>,
}

impl<'r, 'g> Banded<'r, 'g> {
    /// Sets up a target, and pictures of these numbers of layers, in as many bands as it takes, each of
    /// whole tiles. The buffers hold no more than `budget` bytes together, unless those of a single row of
    /// tiles do. There are `rows` fragments in each row of pixels.
    ///
    /// # Errors
    /// A single row of tiles that does not fit, by name; WGSL errors, and whatever the device reports.
    pub fn new(
        rasterizer: &'r Rasterizer<'g>,
        options: &Options<'_>,
        (way, layers): (Way, &[u32]),
        rows: &[u32],
        budget: u64,
    ) -> Result<Self, GpuError> {
        let need = way.need(rasterizer);
        let pixels = rasterizer.size.pixels() as u64;
        let nodes: u64 = rows.iter().map(|nodes| u64::from(*nodes)).sum();
        let mut most = budget.min(need.pixel * pixels + need.node * nodes);
        loop {
            // What is stored nowhere takes no room.
            let stored = rows.iter().map(|nodes| nodes * u32::from(need.node > 0));
            let attempts = Attempts::new(rasterizer.gpu, rasterizer.size, need, None);
            let attempts = attempts.within(most).in_rows_of(SIDE).with_rows(stored);
            let bands: Vec<Band> = attempts.map(|(band, _)| band).collect();
            let many = bands.iter().any(|band| band.rows > SIDE);
            match Self::over(rasterizer, options, (way, layers), &bands) {
                Ok(made) if made.bytes() <= budget || !many => return Ok(made),
                // Bins, or lists of tiles that were left, take more than was known: in smaller bands.
                Ok(_) | Err(GpuError::Limit { .. } | GpuError::Memory { .. }) if many => most /= 2,
                made => return made,
            }
        }
    }

    /// The same in these bands.
    fn over(
        rasterizer: &'r Rasterizer<'g>,
        options: &Options<'_>,
        (way, layers): (Way, &[u32]),
        bands: &[Band],
    ) -> Result<Self, GpuError> {
        let make = match way {
            Way::Runs => Timed::new,
            Way::Linked => Timed::linked,
            Way::Local => Timed::local,
        };
        let made = |band: &Band, pool| make(rasterizer, options, layers, (*band, pool));
        let mut pool = Pool::default();
        if bands.len() > 1 {
            // How much there is in each band turns out as it is drawn: once by itself, to measure it.
            let mut sizes = BTreeMap::new();
            for band in bands {
                made(band, Pool::default())?.room.pool.raise(&mut sizes);
            }
            pool = Pool::of(rasterizer.gpu, &sizes)?;
        }
        let bands: Result<Vec<_>, _> = bands.iter().map(|band| made(band, pool.clone())).collect();
        let mut banded = Self {
            rasterizer,
            bands: bands?,
            parts: Vec::new(),
            runs: Vec::new(),
        };
        banded.number();
        Ok(banded)
    }

    /// Numbers what runs. The band with the most parts has all of them, or nearly: they come in its order.
    fn number(&mut self) {
        let parts = |timed: &Timed<'_, '_>| timed.spans().collect::<Vec<_>>();
        let mut all: Vec<Vec<Span>> = self.bands.iter().map(parts).collect();
        for (band, own) in all.iter().enumerate() {
            self.runs.extend((0..own.len()).map(|part| [band, part]));
        }
        all.sort_by_key(|own| std::cmp::Reverse(own.len()));
        for span in all.into_iter().flatten() {
            if !self.parts.contains(&span) {
                self.parts.push(span);
            }
        }
    }

    /// How many bands there are.
    pub fn bands(&self) -> usize {
        self.bands.len()
    }

    /// Bytes of all buffers, but for the triangles.
    pub fn bytes(&self) -> u64 {
        let mut held: Vec<&wgpu::Buffer> = Vec::new();
        for buffer in self.bands.iter().flat_map(|timed| timed.room.held()) {
            if !held.contains(&buffer) {
                held.push(buffer);
            }
        }
        held.iter().map(|buffer| buffer.size()).sum()
    }

    /// Triangles in bins.
    pub fn binned(&self) -> u64 {
        self.sum(|timed| timed.binned)
    }

    /// Whether lists of any band are so long that they are merged, from one array into another.
    pub fn merges(&self) -> bool {
        self.bands.iter().any(|timed| timed.merges)
    }

    /// Fragments in lists.
    pub fn fragments(&self) -> u64 {
        self.sum(|timed| timed.fragments)
    }

    /// Tiles that were left to lists; where all have linked lists, lists that are not in order.
    pub fn left(&self) -> u64 {
        self.sum(|timed| timed.left)
    }

    fn sum(&self, of: impl Fn(&Timed<'_, '_>) -> u32) -> u64 {
        self.bands.iter().map(|timed| u64::from(of(timed))).sum()
    }

    /// The parts, in the order in which they run.
    pub fn parts(&self) -> &[Span] {
        &self.parts
    }

    /// How many spans a timer of them needs.
    pub fn spans(&self) -> u32 {
        u32::try_from(self.runs.len()).expect("a few parts of each band")
    }

    /// Runs every part once, one after another, and shows each picture.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn pictures(&self, mut show: impl FnMut(u32, Vec<[f32; 3]>)) -> Result<(), GpuError> {
        let mut all: Vec<(u32, Vec<[f32; 3]>)> = Vec::new();
        for timed in &self.bands {
            timed.pictures(|layers, rows| {
                match all.iter_mut().find(|(other, _)| *other == layers) {
                    Some((_, picture)) => picture.extend(rows),
                    None => all.push((layers, rows)),
                }
            })?;
        }
        for (layers, picture) in all {
            show(layers, picture);
        }
        Ok(())
    }

    /// Runs every part once, and gives the seconds of each, over all bands.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        let gpu = self.rasterizer.gpu;
        let all = timer.time(gpu, 0..self.spans(), |number, encoder, queries| {
            let [band, part] = self.runs[number as usize];
            self.bands[band].record(part, number, encoder, queries);
        })?;
        let mut seconds = vec![0.0; self.parts.len()];
        for ([band, part], taken) in self.runs.iter().zip(all) {
            let span = self.bands[*band].spans().nth(*part);
            let at = self.parts.iter().position(|own| Some(*own) == span);
            seconds[at.expect("it runs, so it is listed")] += taken;
        }
        Ok(seconds)
    }
}
