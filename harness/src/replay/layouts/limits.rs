//! Which layouts run on a leg: what a plan, a driver's time and an invocation's steps allow.

use std::collections::BTreeMap;

use triptych_gpu::abuffer::STEPS;
use triptych_gpu::layouts::Layout;
use triptych_gpu::raster::Path;
use triptych_spec::abuffer::Sorted;
use wgpu::DeviceType;

use super::super::Extent;
use super::super::gpu::{From, GpuLeg};
use super::super::spec::SpecRun;

/// Most triangles and fragments that a default run has on a software driver.
const WORK_MAX: u64 = 1 << 15;

/// Most slots of the arrays of all pixels.
const SLOTS_MAX: u64 = 1 << 18;

/// The same where each fragment goes along its list: steps of all.
const STEPS_MAX: u64 = 1 << 18;

/// Why a layout does not run on a leg; `None` if it does.
pub(super) fn reason_not_run(leg: &GpuLeg<'_>, extent: Extent, layout: Layout) -> Option<String> {
    if let Some(planned) = leg.plan.skipped(layout.name()) {
        return Some(planned);
    }
    if leg.from > From::Build {
        return Some(From::GIVEN.to_owned());
    }
    if leg.by_band() {
        return Some("the driver's sub-pixel grid is unknown".to_owned());
    }
    let spec = &leg.spec.value;
    if layout == Layout::Ordered
        && let Some(words) = too_many_steps(spec, leg.path)
    {
        return Some(format!("plan: {words}"));
    }
    let is_slow = leg.adapter.gpu.info.device_type == DeviceType::Cpu;
    let work = (spec.primitives.prims.len() + spec.sorted.fragments.len()) as u64;
    let is_large = work > WORK_MAX
        || match layout {
            Layout::Bucket => slots(&spec.sorted) > SLOTS_MAX,
            Layout::Ordered => steps(&spec.sorted) > STEPS_MAX,
            _ => false,
        };
    (extent == Extent::Small && is_slow && is_large)
        .then(|| "of a scene of its size only if asked for: --rivals".to_owned())
}

/// Slots of arrays that are as long as the longest list.
pub fn slots(sorted: &Sorted) -> u64 {
    u64::from(sorted.longest()) * sorted.lengths().count() as u64
}

/// Steps of all fragments along their lists.
pub fn steps(sorted: &Sorted) -> u64 {
    sorted
        .lengths()
        .map(|length| u64::from(length).pow(2))
        .sum()
}

/// Why lists cannot be put in order while they are built on a path; `None` if they can.
pub fn too_many_steps(spec: &SpecRun, path: Path) -> Option<String> {
    let most = steps_of_an_invocation(spec, path);
    let words =
        || format!("an invocation may take {most} steps along lists, more than its {STEPS}");
    (most > STEPS).then(words)
}

/// The most steps of an invocation along lists that are in order: one for each node, and one where
/// another invocation was first to hang a node there. It has a fragment, and on the compute paths no more
/// than all of a row of a triangle.
fn steps_of_an_invocation(spec: &SpecRun, path: Path) -> u64 {
    let pixels = 0..spec.sorted.offsets.len() - 1;
    let steps = |pixel: usize| 2 * spec.sorted.list(pixel).len() as u64;
    if path == Path::Fragment {
        return pixels.map(steps).max().unwrap_or(0);
    }
    let width = spec.primitives.size.width;
    let mut most = BTreeMap::<(u32, u32), u64>::new();
    for pixel in pixels {
        for f in spec.sorted.list(pixel) {
            *most.entry((f.prim, f.pixel / width)).or_default() += steps(pixel);
        }
    }
    most.into_values().max().unwrap_or(0)
}
