//! Pipelines by the name of their entry point, bound by the names of variables.

mod blending;
mod depth;
mod foreign;
mod layout;
mod made;
mod module;
mod pipeline;
mod skeleton;
mod stage;
mod stages;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::context::Gpu;
use crate::error::GpuError;
use crate::wgsl::{Sources, WgslError};
pub(crate) use made::Made;
use made::{Recipe, State};
use module::{Checks, Module, bindings, uses};

pub(crate) use depth::DEPTH_FORMAT;
pub use foreign::Foreign;
pub use pipeline::{Kernel, Pipeline};
pub use skeleton::skeleton;
pub use stage::Stage;
pub use stages::STAGES;

/// Format of the target that fragment-stage kernels run over. They never write
/// it: llvmpipe drops side effects of fragments that a later opaque write covers.
pub const TARGET_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// A defect on purpose of what the host does around its kernels. Only the harness's
/// tests of itself have any.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Heads are what their memory held, which WebGPU makes zeros.
    HeadsNotCleared,
    /// The counter starts where another frame left it.
    CounterNotCleared,
    /// A fragment kernel that returns a colour writes it.
    ColourWritten,
}

/// By file; vertex entry point (none of a compute kernel's), entry point and targets that it blends
/// into, if any; and samples of a pixel of its target (none of a compute kernel's).
type Built = BTreeMap<(String, [String; 3], u32), Arc<Kernel>>;

/// The kernels of one device, compiled when first asked for.
pub struct Kernels {
    sources: Sources,
    checks: Checks,
    fault: Option<Fault>,
    /// Where an entry point comes from, if not from the file that ships it.
    foreign: BTreeMap<&'static str, String>,
    programs: Mutex<BTreeMap<String, Arc<Module>>>,
    kernels: Mutex<Built>,
}

impl Kernels {
    /// Kernels from these sources.
    pub fn new(sources: Sources) -> Self {
        Self {
            sources,
            checks: Checks::Kept,
            fault: None,
            foreign: BTreeMap::new(),
            programs: Mutex::default(),
            kernels: Mutex::default(),
        }
    }

    /// Kernels as they ship, without the checks that WebGPU adds: for timing them on what
    /// the host has certified, and for nothing else. `add` gives them further files.
    pub fn trusted(native: bool, add: impl FnOnce(Sources) -> Sources) -> Self {
        Self {
            checks: Checks::LeftOut,
            ..Self::new(add(Sources::shipped(native)))
        }
    }

    /// Kernels from these sources, but for the stages of `foreign`.
    pub fn with_foreign(mut sources: Sources, foreign: &[Foreign]) -> Self {
        let mut entries = BTreeMap::new();
        for kernel in foreign {
            sources = kernel.add_to(sources);
            entries.extend(kernel.entries().map(|entry| (entry, kernel.key())));
        }
        Self {
            foreign: entries,
            ..Self::new(sources)
        }
    }

    /// The same with a defect in the sources or in the host's part. What links to the
    /// same text as here, and is compiled here, is not compiled again.
    ///
    /// # Errors
    /// Sources that do not link.
    pub fn mutated(&self, sources: Sources, fault: Option<Fault>) -> Result<Self, WgslError> {
        let mut programs = self.programs().clone();
        let mut same = BTreeMap::new();
        for (file, program) in &programs {
            let text = sources.link(file)?.text;
            same.insert(file.clone(), text == program.program.linked.text);
        }
        programs.retain(|file, _| same[file]);
        let mut kernels = self.kernels().clone();
        kernels.retain(|(file, ..), _| same[file]);
        Ok(Self {
            sources,
            checks: self.checks,
            fault,
            foreign: self.foreign.clone(),
            programs: Mutex::new(programs),
            kernels: Mutex::new(kernels),
        })
    }

    /// Whether an entry point is the one that ships, as far as files go.
    pub(crate) fn is_ours(&self, entry: &str) -> bool {
        !self.foreign.contains_key(entry)
    }

    /// What the host does wrong on purpose.
    pub fn fault(&self) -> Option<Fault> {
        self.fault
    }

    /// Whether two files are alike, as where one stands in for the other.
    pub fn alike(&self, file: &str, other: &str) -> bool {
        let of = |name: &str| self.sources.files().find(|(file, _)| *file == name);
        of(file).map(|f| f.1) == of(other).map(|f| f.1)
    }

    fn programs(&self) -> MutexGuard<'_, BTreeMap<String, Arc<Module>>> {
        self.programs.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn kernels(&self) -> MutexGuard<'_, Built> {
        self.kernels.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The compute kernel `entry` of `file`.
    ///
    /// # Errors
    /// WGSL errors at their place; what the device refuses.
    pub fn compute(&self, gpu: &Gpu, file: &str, entry: &str) -> Result<Arc<Kernel>, GpuError> {
        self.get(gpu, file, (["", entry, ""], 0), |_, module| {
            let pipeline = gpu
                .device
                .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: Some(entry),
                    layout: None,
                    module: &module.shader,
                    entry_point: Some(entry),
                    compilation_options: wgpu::PipelineCompilationOptions {
                        // Kernels of ours set what they read first.
                        zero_initialize_workgroup_memory: self.checks == Checks::Kept,
                        ..Default::default()
                    },
                    cache: None,
                });
            Pipeline::Compute(pipeline)
        })
    }

    /// The fragment kernel `entry` of `file`, fed by the vertex entry point `place`, over a
    /// target with so many samples a pixel.
    ///
    /// # Errors
    /// WGSL errors at their place; what the device refuses.
    pub fn fragment(
        &self,
        gpu: &Gpu,
        file: &str,
        [place, entry]: [&str; 2],
        samples: u32,
    ) -> Result<Arc<Kernel>, GpuError> {
        self.get(gpu, file, ([place, entry, ""], samples), |ours, module| {
            let target = wgpu::ColorTargetState {
                format: TARGET_FORMAT,
                blend: None,
                write_mask: match self.writes_colour(module, entry) {
                    true => wgpu::ColorWrites::ALL,
                    false => wgpu::ColorWrites::empty(),
                },
            };
            let pipeline = gpu
                .device
                .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                    label: Some(entry),
                    layout: None,
                    vertex: wgpu::VertexState {
                        module: &ours.shader,
                        entry_point: Some(place),
                        compilation_options: wgpu::PipelineCompilationOptions::default(),
                        buffers: &[],
                    },
                    primitive: wgpu::PrimitiveState::default(),
                    depth_stencil: depth::state(module.program.depth(entry)),
                    multisample: wgpu::MultisampleState {
                        count: samples,
                        ..Default::default()
                    },
                    fragment: Some(wgpu::FragmentState {
                        module: &module.shader,
                        entry_point: Some(entry),
                        compilation_options: wgpu::PipelineCompilationOptions::default(),
                        targets: &[Some(target)],
                    }),
                    multiview_mask: None,
                    cache: None,
                });
            Pipeline::Render(pipeline)
        })
    }

    fn get(
        &self,
        gpu: &Gpu,
        file: &str,
        ([place, entry, into], samples): ([&str; 3], u32),
        make: impl FnOnce(&Module, &Module) -> Pipeline,
    ) -> Result<Arc<Kernel>, GpuError> {
        let mut kernels = self.kernels();
        let names = [place, entry, into].map(str::to_owned);
        let key = (file.to_owned(), names, samples);
        if let Some(kernel) = kernels.get(&key) {
            return Ok(kernel.clone());
        }
        let ours = self.module(gpu, file)?;
        let module = match self.foreign.get(entry) {
            Some(foreign) => self.module(gpu, foreign)?,
            None => ours.clone(),
        };
        let both = [(&*ours, place), (&*module, entry)];
        let entries = if place.is_empty() { &both[1..] } else { &both };
        let bindings = bindings(&ours, entries);
        let state = State {
            samples,
            checks: self.checks,
            colour: self.writes_colour(&module, entry),
            depth: module.program.depth(entry),
            into: into.to_owned(),
        };
        let recipe = Recipe::new(entries, &bindings, state);
        let known = recipe.as_ref().and_then(|recipe| gpu.made.find(recipe));
        let kernel = match known {
            Some(kernel) => kernel,
            None => {
                let kernel = Arc::new(Kernel {
                    pipeline: make(&ours, &module),
                    depth: module.program.depth(entry),
                    bindings,
                    uses: uses(entries),
                });
                gpu.check()?;
                if let Some(recipe) = recipe {
                    gpu.made.keep(recipe, &kernel);
                }
                kernel
            }
        };
        kernels.insert(key, kernel.clone());
        Ok(kernel)
    }

    fn writes_colour(&self, module: &Module, entry: &str) -> bool {
        self.fault == Some(Fault::ColourWritten) && module.program.returns(entry)
    }

    fn module(&self, gpu: &Gpu, file: &str) -> Result<Arc<Module>, GpuError> {
        let mut programs = self.programs();
        if let Some(module) = programs.get(file) {
            return Ok(module.clone());
        }
        let module = Arc::new(Module::new(gpu, &self.sources, file, self.checks)?);
        programs.insert(file.to_owned(), module.clone());
        Ok(module)
    }
}
