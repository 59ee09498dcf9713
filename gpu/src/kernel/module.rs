//! Programs on a device.

use crate::context::Gpu;
use crate::error::GpuError;
use crate::wgsl::{Program, Sources};

/// A program on a device.
pub(super) struct Module {
    pub(super) program: Program,
    pub(super) shader: wgpu::ShaderModule,
}

/// Whether naga adds bounds checks and ends loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    // that the host has not certified for these very lists.
    unsafe { gpu.device.create_shader_module_trusted(descriptor, checks) }
}
