//! Pipelines by the name of their entry point, bound by the names of variables.

mod blending;
mod foreign;
mod layout;
mod module;
mod skeleton;
mod stage;
mod stages;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::context::Gpu;
use crate::error::GpuError;
use crate::pass::Uses;
use crate::wgsl::{Sources, WgslError};
use module::{Checks, Module, bindings, uses};

pub use foreign::Foreign;
pub use skeleton::skeleton;
pub use stage::Stage;
pub use stages::STAGES;

/// A pipeline and the variables that it uses.
pub struct Kernel {
    /// Compute or render.
    pub pipeline: Pipeline,
    /// Variable name and binding number, both stages of a render pipeline together.
    bindings: Vec<(String, u32)>,
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

/// By file, vertex entry point (none of a compute kernel's), entry point, and samples of a pixel
/// of its target (none of a compute kernel's).
type Built = BTreeMap<(String, [String; 2], u32), Arc<Kernel>>;

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
        self.get(gpu, file, (["", entry], 0), |ours, module| {
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
            Ok(Kernel {
                pipeline: Pipeline::Compute(pipeline),
                bindings: bindings(ours, [(module, entry)]),
                uses: uses([(module, entry)]),
            })
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
        self.get(gpu, file, ([place, entry], samples), |ours, module| {
            let returns = self.fault == Some(Fault::ColourWritten) && module.program.returns(entry);
            let target = wgpu::ColorTargetState {
                format: TARGET_FORMAT,
                blend: None,
                write_mask: match returns {
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
                    depth_stencil: None,
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
            Ok(Kernel {
                pipeline: Pipeline::Render(pipeline),
                bindings: bindings(ours, [(ours, place), (module, entry)]),
                uses: uses([(ours, place), (module, entry)]),
            })
        })
    }

    fn get(
        &self,
        gpu: &Gpu,
        file: &str,
        ([place, entry], samples): ([&str; 2], u32),
        make: impl FnOnce(&Module, &Module) -> Result<Kernel, GpuError>,
    ) -> Result<Arc<Kernel>, GpuError> {
        let mut kernels = self.kernels();
        let key = (file.to_owned(), [place, entry].map(str::to_owned), samples);
        if let Some(kernel) = kernels.get(&key) {
            return Ok(kernel.clone());
        }
        let ours = self.module(gpu, file)?;
        let module = match self.foreign.get(entry) {
            Some(foreign) => self.module(gpu, foreign)?,
            None => ours.clone(),
        };
        let kernel = Arc::new(make(&ours, &module)?);
        gpu.check()?;
        kernels.insert(key, kernel.clone());
        Ok(kernel)
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
