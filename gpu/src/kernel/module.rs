//! Programs on a device.

use std::sync::Arc;

use crate::context::Gpu;
use crate::error::GpuError;
use crate::pass::Uses;
use crate::wgsl::{Program, Sources};

/// A program on a device.
pub(super) struct Module {
    pub(super) program: Program,
    pub(super) shader: wgpu::ShaderModule,
}

/// Whether naga adds bounds checks and ends loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Checks {
    /// As WebGPU wants it: whatever a kernel does is defined.
    Kept,
    /// As a native engine has it, which is what times are taken of.
    LeftOut,
}

impl Module {
    /// Links, parses and compiles `file` of these sources.
    pub(super) fn new(
        gpu: &Gpu,
        sources: &Sources,
        file: &str,
        checks: Checks,
    ) -> Result<Self, GpuError> {
        let program = sources.link(file)?.parse()?;
        let descriptor = wgpu::ShaderModuleDescriptor {
            label: Some(file),
            source: wgpu::ShaderSource::Wgsl(program.linked.text.as_str().into()),
        };
        let shader = match checks {
            Checks::Kept => gpu.device.create_shader_module(descriptor),
            Checks::LeftOut => unchecked(gpu, descriptor),
        };
        Ok(Self { program, shader })
    }
}

#[expect(
    unsafe_code,
    reason = "wgpu trusts the caller with what it does not check"
)]
fn unchecked(gpu: &Gpu, descriptor: wgpu::ShaderModuleDescriptor<'_>) -> wgpu::ShaderModule {
    let checks = wgpu::ShaderRuntimeChecks::unchecked();
    // SAFETY: only `Kernels::trusted` comes here, with the kernels that ship. They index by
    // pixel below the band's, by triangle below those uploaded and by node below the
    // capacity, all of which the host has made the buffers for; and they follow no link
    // that the host has not certified for lists of the same fragments in the same buffers. Entries of
    // tiles and of runs are read where the same kernels have counted and filled them, from the same
    // triangles, in bins and lists whose capacity is that of the count; links of other layouts are
    // certified; those of `linked`, packed and ordered lists lead nowhere but to nodes that a counter
    // handed out. Rays of a queue are stored below its capacity, and read below the number that were.
    unsafe { gpu.device.create_shader_module_trusted(descriptor, checks) }
}

/// What entry points bind, by the names that our file gives the numbers: the host knows
/// no others.
pub(super) fn bindings(ours: &Module, entries: &[(&Module, &str)]) -> Vec<(String, u32)> {
    let names = ours.program.names();
    let used = |(module, entry): &(&Module, &str)| module.program.bindings(entry);
    let numbers = entries.iter().filter_map(used).flatten().map(|b| b.1);
    let named = |number| Some((names.get(&number)?.clone(), number));
    let mut all: Vec<(String, u32)> = numbers.filter_map(named).collect();
    all.sort_by_key(|b| b.1);
    all.dedup();
    all
}

/// What entry points do to plain data together.
pub(super) fn uses(entries: &[(&Module, &str)]) -> Arc<Uses> {
    let mut all = Uses::default();
    for (module, entry) in entries {
        let Uses { reads, writes } = Uses::of(&module.program, &[entry]);
        all.reads.extend(reads);
        all.writes.extend(writes);
    }
    Arc::new(all)
}
