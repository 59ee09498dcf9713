//! Depth of the target, where a kernel has to do with any.

use crate::wgsl::Depth;

/// Its format: what a kernel writes is kept as it is.
pub(crate) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Depth is written wherever a triangle is, or lets those pass that are not behind it.
pub(super) fn state(depth: Depth) -> Option<wgpu::DepthStencilState> {
    let compare = match depth {
        Depth::Unused => return None,
        Depth::Written => wgpu::CompareFunction::Always,
        Depth::Tested => wgpu::CompareFunction::LessEqual,
    };
    Some(wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(depth == Depth::Written),
        depth_compare: Some(compare),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    })
}
