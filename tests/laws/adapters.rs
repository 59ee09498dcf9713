//! The adapters of this machine.

use std::sync::OnceLock;

use triptych_gpu::context::{Gpu, adapters};
use triptych_gpu::grid::{Device, Shape, Stages};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::wgsl::Sources;
use triptych_spec::grid::{Blockers, Grid, Membership};

/// Opened once, with kernels of both kinds.
pub fn devices() -> &'static [(Gpu, Vec<Kernels>)] {
    static DEVICES: OnceLock<Vec<(Gpu, Vec<Kernels>)>> = OnceLock::new();
    DEVICES.get_or_init(|| {
        let open = |adapter: wgpu::Adapter| {
            let gpu = Gpu::open(&adapter).expect("a device");
            let natives = [false, true]
                .into_iter()
                .take(1 + usize::from(gpu.has_int64()));
            let kernels = natives.map(|native| Kernels::new(Sources::shipped(native)));
            let kernels = kernels.collect();
            (gpu, kernels)
        };
        let all: Vec<_> = adapters(wgpu::Backends::VULKAN)
            .into_iter()
            .map(open)
            .collect();
        assert!(
            !all.is_empty(),
            "no adapter; `triptych doctor` says what is missing"
        );
        all
    })
}

/// What the cells of some blockers need, by a checked run; `None` where nothing is to be found.
pub fn shape(gpu: &Gpu, kernels: &Kernels, blockers: &Blockers, grid: &Grid) -> Option<Shape> {
    if blockers.triangles.is_empty() {
        return None;
    }
    let device = Device::new(gpu, kernels, blockers, &grid.axes, Membership::Box).unwrap();
    let mut stages = Stages::new(device).unwrap();
    stages.count().unwrap();
    let offsets = stages.scan().unwrap();
    let entries = *offsets.last().unwrap();
    stages.fill(entries, entries).unwrap();
    Some(Shape::of(&offsets, stages.chunks))
}
