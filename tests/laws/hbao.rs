//! Horizons over one view, the rival of layered depth maps.

#[path = "hbao/adapters.rs"]
mod adapters;
#[path = "hbao/closed_forms.rs"]
mod closed_forms;
#[path = "hbao/means.rs"]
mod means;
#[path = "hbao/runs.rs"]
mod runs;
#[path = "hbao/scenes.rs"]
mod scenes;
#[path = "hbao/surfaces.rs"]
mod surfaces;
#[path = "hbao/twin.rs"]
mod twin;

use triptych_gpu::hbao::{DETAIL, Hbao, Screen, Settings};
use triptych_spec::ldm::Falloff;

use crate::adapters::devices;

/// Without denoising.
fn settings(falloff: Falloff, slices: u32, steps: u32) -> Settings {
    Settings {
        falloff,
        slices,
        steps,
        denoise: 0,
        detail: DETAIL,
    }
}

/// What each adapter finds, with its name.
fn openness(screen: &Screen, settings: Settings) -> Vec<(&'static str, Vec<f32>)> {
    let find = |(gpu, kernels): &'static (_, Vec<_>)| {
        let made = Hbao::new(gpu, &kernels[0], screen, settings).expect("within the limits");
        made.run().expect("it runs");
        (gpu.name.as_str(), made.openness().expect("it is there"))
    };
    devices().iter().map(find).collect()
}
