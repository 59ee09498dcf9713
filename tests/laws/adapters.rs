//! The adapters of this machine.

use std::sync::OnceLock;

use triptych_gpu::context::{Gpu, adapters};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::wgsl::Sources;

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
