//! Dispatches of compute kernels, each a pass of its own.

use std::time::{Duration, Instant};

use crate::context::Gpu;
use crate::error::GpuError;
use crate::kernel::{Kernels, Pipeline};
use crate::timer::Writes;

/// Most workgroups along a dimension of a dispatch (WebGPU's default).
const GROUPS: u32 = 65_535;

/// Most workgroups of a dispatch of ours, in rows.
pub(crate) const GROUPS_MAX: u32 = GROUPS * GROUPS;

/// A dispatch that can be recorded any number of times.
pub(crate) struct Ready {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    groups: Groups,
    /// What is set before.
    set: Vec<Set>,
}

/// How many workgroups there are.
enum Groups {
    Fixed(u32),
    /// Three words of a buffer, which an earlier pass has written: along x, y and z.
    Counted(wgpu::Buffer),
}

/// A buffer that is set before a pass.
enum Set {
    Zero(wgpu::Buffer),
    As {
        buffer: wgpu::Buffer,
        pattern: wgpu::Buffer,
    },
    /// One word, from a byte of one buffer to a byte of another.
    Word {
        from: (wgpu::Buffer, u64),
        to: (wgpu::Buffer, u64),
    },
}

impl Ready {
    /// So many workgroups of a file's entry point. Buffers that it does not use are left out.
    pub(crate) fn new(
        gpu: &Gpu,
        kernels: &Kernels,
        (file, entry): (&str, &str),
        groups: u32,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<Self, GpuError> {
        let kernel = kernels.compute(gpu, file, entry)?;
        let Pipeline::Compute(pipeline) = &kernel.pipeline else {
            unreachable!("it was asked for as a compute kernel");
        };
        Ok(Self {
            group: kernel.bind(gpu, buffers),
            pipeline: pipeline.clone(),
            groups: Groups::Fixed(groups),
            set: Vec::new(),
        })
    }

    /// The same after a buffer has been set to zero.
    pub(crate) fn after_clearing(mut self, buffer: wgpu::Buffer) -> Self {
        self.clear(buffer);
        self
    }

    /// Sets a buffer to zero before it.
    pub(crate) fn clear(&mut self, buffer: wgpu::Buffer) {
        self.set.push(Set::Zero(buffer));
    }

    /// The same after a buffer has been made like the beginning of another, which is no shorter.
    pub(crate) fn after_copying(mut self, pattern: wgpu::Buffer, buffer: wgpu::Buffer) -> Self {
        self.set.push(Set::As { buffer, pattern });
        self
    }

    /// The same after a word has been copied from a byte of one buffer to a byte of another.
    pub(crate) fn after_word(
        mut self,
        from: (&wgpu::Buffer, u64),
        to: (&wgpu::Buffer, u64),
    ) -> Self {
        let [from, to] = [from, to].map(|(buffer, at)| (buffer.clone(), at));
        self.set.push(Set::Word { from, to });
        self
    }

    /// The same with as many workgroups as the first three words of a buffer say then.
    pub(crate) fn counted(mut self, arguments: &wgpu::Buffer) -> Self {
        self.groups = Groups::Counted(arguments.clone());
        self
    }

    /// Records a pass of its own: what it writes is there for the next. Workgroups beyond what
    /// a row holds go to further rows, and may be more than were asked for.
    pub(crate) fn record(&self, encoder: &mut wgpu::CommandEncoder, writes: Option<Writes<'_>>) {
        for set in &self.set {
            match set {
                Set::Zero(buffer) => encoder.clear_buffer(buffer, 0, None),
                Set::As { buffer, pattern } => {
                    encoder.copy_buffer_to_buffer(pattern, 0, buffer, 0, buffer.size());
                }
                Set::Word { from, to } => {
                    encoder.copy_buffer_to_buffer(&from.0, from.1, &to.0, to.1, 4);
                }
            }
        }
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: None,
            timestamp_writes: writes.map(Writes::compute),
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        match &self.groups {
            Groups::Fixed(0) => {}
            Groups::Fixed(groups) => {
                pass.dispatch_workgroups(*groups.min(&GROUPS), groups.div_ceil(GROUPS), 1);
            }
            Groups::Counted(arguments) => pass.dispatch_workgroups_indirect(arguments, 0),
        }
    }

    /// Runs it, and waits for the end.
    pub(crate) fn run(&self, gpu: &Gpu) -> Result<Duration, GpuError> {
        let mut encoder = gpu.encoder();
        self.record(&mut encoder, None);
        let start = Instant::now();
        gpu.submit(encoder)?;
        Ok(start.elapsed())
    }
}
