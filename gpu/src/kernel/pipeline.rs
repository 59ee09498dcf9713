//! A pipeline, and what binds buffers to it.

use std::sync::Arc;

use crate::context::Gpu;
use crate::pass::Uses;
use crate::wgsl::Depth;

/// A pipeline and the variables that it uses.
pub struct Kernel {
    /// Compute or render.
    pub pipeline: Pipeline,
    /// What it has to do with depth.
    pub(crate) depth: Depth,
    /// Variable name and binding number, both stages of a render pipeline together.
    pub(super) bindings: Vec<(String, u32)>,
    /// What it does to plain data.
    pub uses: Arc<Uses>,
}

/// The two kinds of pipeline.
pub enum Pipeline {
    /// One entry point.
    Compute(wgpu::ComputePipeline),
    /// A vertex and a fragment entry point, without colour writes.
    Render(wgpu::RenderPipeline),
}

impl Kernel {
    /// Binds the variables that the kernel uses to the buffers of those names.
    ///
    /// # Panics
    /// If a variable has no buffer: a kernel and its host code belong together.
    pub fn bind(&self, gpu: &Gpu, buffers: &[(&str, &wgpu::Buffer)]) -> wgpu::BindGroup {
        let entry = |(name, binding): &(String, u32)| {
            let buffer = buffers.iter().find(|(given, _)| given == name);
            wgpu::BindGroupEntry {
                binding: *binding,
                resource: buffer
                    .unwrap_or_else(|| panic!("no buffer for the variable {name}"))
                    .1
                    .as_entire_binding(),
            }
        };
        let entries: Vec<_> = self.bindings.iter().map(entry).collect();
        let layout = match &self.pipeline {
            Pipeline::Compute(p) => p.get_bind_group_layout(0),
            Pipeline::Render(p) => p.get_bind_group_layout(0),
        };
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &entries,
        })
    }
}
