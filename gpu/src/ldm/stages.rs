//! What the host does for each stage.

use std::time::Duration;

use triptych_spec::abuffer::EOL;
use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{Layers, Maps};

use super::batch::spans;
use super::device::Device;
use super::lists::Batch;
use super::{Chains, Link, Told};
use crate::abuffer::PROGRESS;
use crate::context::Gpu;
use crate::error::GpuError;
use crate::kernel::Kernels;

/// Bytes of an entry of a linked list.
const LINK: u64 = 8;

/// Maps in the making. Stages are called in order; each takes what was given in its place, or
/// what the one before made.
pub struct Stages<'g> {
    pub(super) device: Device<'g>,
    pub(super) batches: Vec<Batch>,
    /// Time on the device of what ran last, without transfers.
    pub time: Duration,
    /// Dispatches after which the last run of stage `chain` had put a batch in order, at most.
    pub turns: u32,
}

impl<'g> Stages<'g> {
    /// Uploads maps and triangles. No buffer of lists takes more than `budget` bytes: maps are then
    /// made in several batches. They are, too, where the adapter binds no more.
    ///
    /// # Errors
    /// Limits by name, and whatever the device reports; so for all stages.
    pub fn new(
        gpu: &'g Gpu,
        kernels: &'g Kernels,
        maps: &'g Maps,
        blockers: &Blockers,
        budget: u64,
    ) -> Result<Self, GpuError> {
        Ok(Self {
            device: Device::new(gpu, kernels, maps, blockers, budget)?,
            batches: Vec::new(),
            time: Duration::ZERO,
            turns: 0,
        })
    }

    /// In how many batches the lists are.
    pub fn batches(&self) -> usize {
        self.batches.len()
    }

    /// Stage `layers`.
    pub fn layers(&mut self) -> Result<Layers, GpuError> {
        self.batches.clear();
        self.time = Duration::ZERO;
        for span in self.device.spans() {
            let (batches, time) = self.device.build(span)?;
            self.batches.extend(batches);
            self.time += time;
        }
        self.device.read(&self.batches)
    }

    /// Puts lists in place of the device's own.
    ///
    /// # Panics
    /// If they are not of these maps.
    pub fn give_layers(&mut self, layers: &Layers) -> Result<(), GpuError> {
        let maps = self.device.all;
        assert_eq!(layers.offsets.len(), maps.pixels as usize + 1, "other maps");
        self.batches.clear();
        for span in self.device.batches_of(layers) {
            let own = &layers.offsets[span.pixels.start as usize..=span.pixels.end as usize];
            let [first, end] = [own[0], own[own.len() - 1]];
            let offsets: Vec<u32> = own.iter().map(|at| at - first).collect();
            let keys = &layers.keys[first as usize..end as usize];
            self.batches.push(Batch {
                offsets: self.device.gpu.upload("offsets of pixels", &offsets)?,
                keys: self.device.gpu.upload("keys of pixels", keys)?,
                total: end - first,
                longest: 0,
                span,
            });
        }
        Ok(())
    }

    /// Stage `chain`: the paper's lists. Of all keys `capacity` have room. Those of a batch are put
    /// in order if `sound` says so of them, for which so many entries had room: a kernel follows
    /// no links that may lead anywhere.
    pub fn chain(
        &mut self,
        capacity: u32,
        sound: impl Fn(&Chains, u32) -> bool,
    ) -> Result<Chains, GpuError> {
        self.time = Duration::ZERO;
        self.turns = 0;
        let mut chains = Chains::default();
        let room = u32::try_from(self.device.room / LINK).unwrap_or(u32::MAX);
        let mut spans = spans(self.device.all, self.device.room / PROGRESS);
        spans.reverse();
        while let Some(span) = spans.pop() {
            let gpu = self.device.gpu;
            // As if all batches had one pool: what attempts have used up is gone.
            let base = u64::from(capacity).min(chains.attempts);
            let base = u32::try_from(base).expect("at most the capacity");
            let all = capacity - base;
            let left = all.min(room);
            let heads = gpu.filled("heads", span.len(), EOL)?;
            let nodes = gpu.storage("entries of lists", LINK * u64::from(left))?;
            let counter = gpu.storage("counter", 4)?;
            let buffers = [("heads", &heads), ("nodes", &nodes), ("counter", &counter)];
            let kernels = ["chain", "chain_large"];
            let drawn = self.device.draw(kernels, (&span, left), &buffers)?;
            self.time += self.device.run(&drawn)?;
            let attempts = gpu.word(&counter, 0)?;
            if attempts > left && left < all {
                // There is room, but no buffer holds as much.
                let halves = span.halves(self.device.all);
                let Some([first, second]) = halves else {
                    return Err(GpuError::Limit {
                        adapter: gpu.name.clone(),
                        what: "entries of a map's lists",
                        needed: LINK * u64::from(attempts),
                        limit: self.device.room,
                    });
                };
                spans.extend([second, first]);
                continue;
            }
            let stored = attempts.min(left) as usize;
            let read = || -> Result<Chains, GpuError> {
                Ok(Chains {
                    heads: gpu.read(&heads, span.len() as usize)?,
                    links: gpu.read(&nodes, stored)?,
                    attempts: attempts.into(),
                })
            };
            let mut own = read()?;
            if sound(&own, left) {
                self.relink(span.told(self.device.told), [&heads, &nodes])?;
                own = read()?;
            }
            chains.append(own, base);
        }
        Ok(chains)
    }

    /// Puts all lists of a batch in order.
    fn relink(&mut self, told: Told, [heads, nodes]: [&wgpu::Buffer; 2]) -> Result<(), GpuError> {
        let gpu = self.device.gpu;
        let progress = gpu.storage("progress of pixels", PROGRESS * u64::from(told.pixels))?;
        let buffers = [("heads", heads), ("nodes", nodes), ("progress", &progress)];
        // A list of n is sorted in at most n (log n + 3) steps, and looked at twice in each run.
        let keys = nodes.size() / LINK;
        let steps = 4 * keys * (u64::from(keys.max(2).ilog2()) + 3);
        let mut turn = 0;
        for _ in 0..=steps / u64::from(crate::grid::STEPS) {
            turn += 1;
            let pass = self.device.each("chain_sort", told, &buffers)?;
            self.time += self.device.run(&[pass])?;
            if gpu.take(&self.device.unfinished)? == 0 {
                self.turns = self.turns.max(turn);
                return Ok(());
            }
        }
        Err(GpuError::Endless {
            adapter: gpu.name.clone(),
            stage: "chain",
        })
    }
}

impl Chains {
    /// Those of further pixels, whose first entry has this address among all.
    pub(super) fn append(&mut self, other: Self, base: u32) {
        let moved = |at: u32| match at {
            EOL => EOL,
            _ => at.wrapping_add(base),
        };
        self.heads.extend(other.heads.into_iter().map(moved));
        self.links.extend(other.links.into_iter().map(|link| Link {
            next: moved(link.next),
            ..link
        }));
        self.attempts += other.attempts;
    }
}
