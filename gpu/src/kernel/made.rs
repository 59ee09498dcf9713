//! Pipelines that a device has already: kernels of other sources are alike but for a few entry
//! points, and some drivers take longer to compile one than to run a scene with it.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use naga::back::pipeline_constants::process_overrides;
use naga::back::spv;

use super::Kernel;
use super::module::{Checks, Module};
use crate::wgsl::{Depth, Program};

/// All that a pipeline follows from.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Recipe {
    /// SPIR-V of each entry point alone with what it calls, names included: equal words are equal
    /// kernels.
    stages: Vec<Vec<u32>>,
    /// Bound variables by our file's names, which a foreign file's words do not tell.
    bindings: Vec<(String, u32)>,
    state: State,
}

/// What is fixed about a pipeline beside its entry points.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct State {
    pub(super) samples: u32,
    pub(super) checks: Checks,
    /// Whether it writes the colour that it returns.
    pub(super) colour: bool,
    pub(super) depth: Depth,
    /// The targets that it blends into, in wgpu's words.
    pub(super) into: String,
}

impl Recipe {
    /// `None` if an entry point cannot be written down; then its pipeline is nobody else's.
    pub(super) fn new(
        entries: &[(&Module, &str)],
        bindings: &[(String, u32)],
        state: State,
    ) -> Option<Self> {
        let written = |(module, entry): &(&Module, &str)| words(&module.program, entry);
        Some(Self {
            stages: entries.iter().map(written).collect::<Option<_>>()?,
            bindings: bindings.to_vec(),
            state,
        })
    }
}

/// An entry point without the rest of its program.
fn words(program: &Program, entry: &str) -> Option<Vec<u32>> {
    let mut all = program.module.entry_points.iter();
    let stage = all.find(|e| e.name == entry)?.stage;
    let (module, info) = process_overrides(
        &program.module,
        &program.info,
        Some((stage, entry)),
        &naga::back::PipelineConstants::default(),
    )
    .ok()?;
    let mut options = spv::Options::default();
    options.flags |= spv::WriterFlags::DEBUG;
    let pipeline = spv::PipelineOptions {
        shader_stage: stage,
        entry_point: entry.to_owned(),
    };
    spv::write_vec(&module, &info, &options, Some(&pipeline)).ok()
}

/// Most pipelines that are kept: more than the shipped kernels have in all.
const KEPT: usize = 512;

/// The pipelines of a device, those that were asked for last.
#[derive(Default)]
pub(crate) struct Made(Mutex<Shelf>);

#[derive(Default)]
struct Shelf {
    /// Each with when it was asked for last, counted in requests.
    kernels: BTreeMap<Recipe, (u64, Arc<Kernel>)>,
    requests: u64,
}

impl Made {
    pub(super) fn find(&self, recipe: &Recipe) -> Option<Arc<Kernel>> {
        let mut shelf = self.shelf();
        shelf.requests += 1;
        let now = shelf.requests;
        let (last, kernel) = shelf.kernels.get_mut(recipe)?;
        *last = now;
        Some(kernel.clone())
    }

    pub(super) fn keep(&self, recipe: Recipe, kernel: &Arc<Kernel>) {
        let mut shelf = self.shelf();
        if shelf.kernels.len() == KEPT {
            let oldest = shelf.kernels.values().map(|(last, _)| *last).min();
            shelf.kernels.retain(|_, (last, _)| Some(*last) != oldest);
        }
        let now = shelf.requests;
        shelf.kernels.insert(recipe, (now, kernel.clone()));
    }

    fn shelf(&self) -> MutexGuard<'_, Shelf> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::context::{Gpu, adapters};
    use crate::kernel::Kernels;
    use crate::wgsl::Sources;

    /// A device and a kernel of its.
    fn first() -> (Gpu, Kernels, Arc<Kernel>) {
        let adapter = adapters(wgpu::Backends::VULKAN).swap_remove(0);
        let gpu = Gpu::open(&adapter).expect("a device");
        let kernels = Kernels::new(Sources::shipped(false));
        let sort = kernels.compute(&gpu, "abuffer", "sort").expect("ours");
        (gpu, kernels, sort)
    }

    #[test]
    fn what_differs_elsewhere_is_made_once() {
        let (gpu, kernels, sort) = first();
        let build = kernels.compute(&gpu, "abuffer", "build").expect("ours");
        let (find, replace) = ("x.key < y.key ||", "x.key > y.key ||");
        let patched = Sources::shipped(false).patched("abuffer", find, replace);
        let patched = patched.expect("the kernel has this text once");
        let other = Kernels::new(patched);
        let of = |kernels: &Kernels, entry| kernels.compute(&gpu, "abuffer", entry).expect("ours");
        assert!(
            Arc::ptr_eq(&build, &of(&other, "build")),
            "it does not sort"
        );
        assert!(
            !Arc::ptr_eq(&sort, &of(&other, "sort")),
            "the order is another"
        );
        let trusted = Kernels::trusted(false, |sources| sources);
        let same = Arc::ptr_eq(&build, &of(&trusted, "build"));
        assert!(!same, "its checks are left out");
    }

    #[test]
    fn those_asked_for_last_are_kept() {
        let (_, _, kernel) = first();
        let recipe = |word: usize| Recipe {
            stages: Vec::new(),
            bindings: Vec::new(),
            state: State {
                samples: 0,
                checks: Checks::Kept,
                depth: Depth::Unused,
                colour: false,
                into: word.to_string(),
            },
        };
        let made = Made::default();
        for word in 0..=KEPT {
            assert!(made.find(&recipe(word)).is_none(), "{word} is new");
            made.keep(recipe(word), &kernel);
            assert!(made.find(&recipe(0)).is_some(), "asked for again");
        }
        let gone = (0..=KEPT).filter(|word| made.find(&recipe(*word)).is_none());
        assert_eq!(gone.collect::<Vec<_>>(), [1], "for which nobody asked");
    }
}
