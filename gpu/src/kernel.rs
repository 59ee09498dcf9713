//! Pipelines by the name of their entry point, bound by the names of variables.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::context::Gpu;
use crate::error::GpuError;
use crate::pass::Uses;
use crate::wgsl::{Program, Sources, WgslError};

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
    /// `place` and a fragment entry point, without colour writes.
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
}

/// A compiled file.
type Module = Arc<(Program, wgpu::ShaderModule)>;

/// The kernels of one device, compiled when first asked for.
pub struct Kernels {
    sources: Sources,
    fault: Option<Fault>,
    programs: Mutex<BTreeMap<String, Module>>,
    kernels: Mutex<BTreeMap<(String, String), Arc<Kernel>>>,
}

impl Kernels {
    /// Kernels from these sources.
    pub fn new(sources: Sources) -> Self {
        Self {
            sources,
            fault: None,
            programs: Mutex::default(),
            kernels: Mutex::default(),
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
            same.insert(file.clone(), text == program.0.linked.text);
        }
        programs.retain(|file, _| same[file]);
        let mut kernels = self.kernels().clone();
        kernels.retain(|(file, _), _| same[file]);
        Ok(Self {
            sources,
            fault,
            programs: Mutex::new(programs),
            kernels: Mutex::new(kernels),
        })
    }

    /// What the host does wrong on purpose.
    pub fn fault(&self) -> Option<Fault> {
        self.fault
    }

    fn programs(&self) -> MutexGuard<'_, BTreeMap<String, Module>> {
        self.programs.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn kernels(&self) -> MutexGuard<'_, BTreeMap<(String, String), Arc<Kernel>>> {
        self.kernels.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The compute kernel `entry` of `file`.
    ///
    /// # Errors
    /// WGSL errors at their place; what the device refuses.
    pub fn compute(&self, gpu: &Gpu, file: &str, entry: &str) -> Result<Arc<Kernel>, GpuError> {
        self.get(gpu, file, entry, |program, module| {
            let pipeline = gpu
                .device
                .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: Some(entry),
                    layout: None,
                    module,
                    entry_point: Some(entry),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    cache: None,
                });
            Ok(Kernel {
                pipeline: Pipeline::Compute(pipeline),
                bindings: bindings(program, &[entry]),
                uses: Arc::new(Uses::of(program, &[entry])),
            })
        })
    }

    /// The fragment kernel `entry` of `file`, fed by `place`.
    ///
    /// # Errors
    /// WGSL errors at their place; what the device refuses.
    pub fn fragment(&self, gpu: &Gpu, file: &str, entry: &str) -> Result<Arc<Kernel>, GpuError> {
        self.get(gpu, file, entry, |program, module| {
            let target = wgpu::ColorTargetState {
                format: TARGET_FORMAT,
                blend: None,
                write_mask: wgpu::ColorWrites::empty(),
            };
            let pipeline = gpu
                .device
                .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                    label: Some(entry),
                    layout: None,
                    vertex: wgpu::VertexState {
                        module,
                        entry_point: Some("place"),
                        compilation_options: wgpu::PipelineCompilationOptions::default(),
                        buffers: &[],
                    },
                    primitive: wgpu::PrimitiveState::default(),
                    depth_stencil: None,
                    multisample: wgpu::MultisampleState::default(),
                    fragment: Some(wgpu::FragmentState {
                        module,
                        entry_point: Some(entry),
                        compilation_options: wgpu::PipelineCompilationOptions::default(),
                        targets: &[Some(target)],
                    }),
                    multiview_mask: None,
                    cache: None,
                });
            Ok(Kernel {
                pipeline: Pipeline::Render(pipeline),
                bindings: bindings(program, &["place", entry]),
                uses: Arc::new(Uses::of(program, &["place", entry])),
            })
        })
    }

    fn get(
        &self,
        gpu: &Gpu,
        file: &str,
        entry: &str,
        make: impl FnOnce(&Program, &wgpu::ShaderModule) -> Result<Kernel, GpuError>,
    ) -> Result<Arc<Kernel>, GpuError> {
        let mut kernels = self.kernels();
        let key = (file.to_owned(), entry.to_owned());
        if let Some(kernel) = kernels.get(&key) {
            return Ok(kernel.clone());
        }
        let program = self.program(gpu, file)?;
        let kernel = Arc::new(make(&program.0, &program.1)?);
        gpu.check()?;
        kernels.insert(key, kernel.clone());
        Ok(kernel)
    }

    fn program(&self, gpu: &Gpu, file: &str) -> Result<Module, GpuError> {
        let mut programs = self.programs();
        if let Some(program) = programs.get(file) {
            return Ok(program.clone());
        }
        let program = self.sources.link(file)?.parse()?;
        let module = gpu
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(file),
                source: wgpu::ShaderSource::Wgsl(program.linked.text.as_str().into()),
            });
        let program = Arc::new((program, module));
        programs.insert(file.to_owned(), program.clone());
        Ok(program)
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

fn bindings(program: &Program, entries: &[&str]) -> Vec<(String, u32)> {
    let mut all: Vec<(String, u32)> = entries
        .iter()
        .filter_map(|e| program.bindings(e))
        .flatten()
        .collect();
    all.sort_by_key(|b| b.1);
    all.dedup();
    all
}
