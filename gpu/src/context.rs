//! Adapters and devices.

mod buffers;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use triptych_spec::raster::Samples;

use crate::error::GpuError;
use crate::kernel::{DEPTH_FORMAT, Made, TARGET_FORMAT};

/// What a device has beyond WebGPU's defaults, if its adapter does: 64-bit integers for
/// path `native`, with atomics of these and blending of 32-bit floats for rivals of lists,
/// timestamps for `triptych bench`, targets of 2 and 8 samples a pixel.
const FEATURES: wgpu::Features = wgpu::Features::SHADER_INT64
    .union(wgpu::Features::SHADER_INT64_ATOMIC_MIN_MAX)
    .union(wgpu::Features::SHADER_INT64_ATOMIC_ALL_OPS)
    .union(wgpu::Features::FLOAT32_BLENDABLE)
    .union(wgpu::Features::SHADER_EARLY_DEPTH_TEST)
    .union(wgpu::Features::TIMESTAMP_QUERY)
    .union(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);

/// Which adapters a run is about.
pub fn adapters(backends: wgpu::Backends) -> Vec<wgpu::Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    // Where a driver says what it has left, wgpu refuses what exceeds that; some drivers
    // would go on, and slow down or die later.
    descriptor.memory_budget_thresholds.for_resource_creation = Some(90);
    let instance = wgpu::Instance::new(descriptor);
    pollster::block_on(instance.enumerate_adapters(backends))
}

/// A short name for an adapter: its own, without the parenthesis and the word
/// "Device" that some drivers append.
pub fn short_name(info: &wgpu::AdapterInfo) -> String {
    let name = info.name.split(" (").next().unwrap_or(&info.name);
    let name = name.strip_suffix(" Device").unwrap_or(name).trim();
    match info.backend {
        wgpu::Backend::Gl => format!("{name}-gl"),
        _ => name.to_owned(),
    }
}

/// A device with what it needs to be asked and to be believed.
pub struct Gpu {
    /// Short name of the adapter, with a number where another is called the same.
    pub name: String,
    /// The adapter's own words.
    pub info: wgpu::AdapterInfo,
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// The largest buffer that a kernel may see, in bytes.
    binding_limit: u64,
    /// How many samples a pixel of a target may have, and of its depth.
    samples: [Vec<u32>; 2],
    /// Bytes in all that are as good as there, for tests.
    memory_limit: Option<u64>,
    /// Pipelines, whosever sources they come from.
    pub(crate) made: Made,
    /// The first thing that went wrong behind our back.
    failure: Arc<Mutex<Option<GpuError>>>,
}

impl Gpu {
    /// Opens a device with WebGPU's default limits, buffers as large as the adapter
    /// allows, 64-bit integers and timestamps if it has them: whatever baseline kernels
    /// need beyond the default is an error on every adapter, not only on small ones.
    ///
    /// # Errors
    /// The driver's reason.
    pub fn open(adapter: &wgpu::Adapter) -> Result<Self, GpuError> {
        Self::open_as(adapter, &short_name(&adapter.get_info()))
    }

    /// The same under a name that tells the adapter from others of its short name.
    ///
    /// # Errors
    /// The driver's reason.
    pub fn open_as(adapter: &wgpu::Adapter, name: &str) -> Result<Self, GpuError> {
        let (info, name) = (adapter.get_info(), name.to_owned());
        let limits = wgpu::Limits {
            max_buffer_size: adapter.limits().max_buffer_size,
            max_storage_buffer_binding_size: adapter.limits().max_storage_buffer_binding_size,
            ..wgpu::Limits::default()
        };
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("triptych"),
            required_features: adapter.features() & FEATURES,
            required_limits: limits,
            ..Default::default()
        };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&descriptor)).map_err(|e| {
                GpuError::NoDevice {
                    adapter: name.clone(),
                    reason: one_line(&e),
                }
            })?;
        let failure = Arc::new(Mutex::new(None));
        watch(&device, &name, &failure);
        Ok(Self {
            name,
            info,
            binding_limit: binding_limit(&device),
            samples: [TARGET_FORMAT, DEPTH_FORMAT].map(|f| sample_counts(adapter, &device, f)),
            device,
            queue,
            memory_limit: None,
            made: Made::default(),
            failure,
        })
    }

    /// Whether the adapter computes with 64-bit integers.
    pub fn has_int64(&self) -> bool {
        self.device
            .features()
            .contains(wgpu::Features::SHADER_INT64)
    }

    /// Whether the adapter has atomic minima of 64-bit integers.
    pub fn has_int64_atomics(&self) -> bool {
        let needed = wgpu::Features::SHADER_INT64_ATOMIC_MIN_MAX;
        self.has_int64() && self.device.features().contains(needed)
    }

    /// Whether the adapter has all atomics of 64-bit integers, which tell what was there before.
    pub fn has_all_int64_atomics(&self) -> bool {
        let needed = wgpu::Features::SHADER_INT64_ATOMIC_ALL_OPS;
        self.has_int64() && self.device.features().contains(needed)
    }

    /// Whether the adapter tests depth before it runs a fragment that writes to buffers, in targets of so
    /// many samples a pixel.
    pub fn tests_depth_early(&self, samples: u32) -> bool {
        let needed = wgpu::Features::SHADER_EARLY_DEPTH_TEST;
        self.device.features().contains(needed) && self.samples[1].contains(&samples)
    }

    /// Whether the adapter blends 32-bit floats.
    pub fn blends_floats(&self) -> bool {
        self.device
            .features()
            .contains(wgpu::Features::FLOAT32_BLENDABLE)
    }

    /// Whether the adapter tells when a pass began and ended.
    pub fn has_timestamps(&self) -> bool {
        self.device
            .features()
            .contains(wgpu::Features::TIMESTAMP_QUERY)
    }

    /// Whether targets of the hardware's rasteriser may have so many samples a pixel.
    pub fn has_samples(&self, count: u32) -> bool {
        self.samples[0].contains(&count)
    }

    /// The largest buffer that a kernel may see, in bytes.
    pub fn binding_limit(&self) -> u64 {
        self.binding_limit
    }

    /// Behaves like an adapter that can bind no more than so many bytes.
    pub fn restrict_bindings(&mut self, bytes: u64) {
        self.binding_limit = self.binding_limit.min(bytes);
    }

    /// Behaves like the adapter that it is, again.
    pub fn lift_restrictions(&mut self) {
        self.binding_limit = binding_limit(&self.device);
        self.memory_limit = None;
    }

    /// Runs what was recorded and waits for it.
    ///
    /// # Errors
    /// Whatever the device reported meanwhile.
    pub fn submit(&self, encoder: wgpu::CommandEncoder) -> Result<(), GpuError> {
        self.queue.submit([encoder.finish()]);
        self.wait()
    }

    /// An encoder.
    pub fn encoder(&self) -> wgpu::CommandEncoder {
        self.device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    /// Whatever has gone wrong so far.
    ///
    /// # Errors
    /// The first failure.
    pub fn check(&self) -> Result<(), GpuError> {
        // A call that is refused may be so because the device is lost: let it be told.
        if matches!(*self.failure(), Some(GpuError::Refused { .. })) {
            let _ = self.device.poll(wgpu::PollType::Poll);
        }
        self.failure().clone().map_or(Ok(()), Err)
    }

    fn failure(&self) -> MutexGuard<'_, Option<GpuError>> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn wait(&self) -> Result<(), GpuError> {
        let polled = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        polled.map(|_| ()).map_err(|e| self.refused(&e))
    }

    /// A refused call, or what went wrong before it; a lost device says so when polled.
    fn refused(&self, error: &dyn std::error::Error) -> GpuError {
        let _ = self.device.poll(wgpu::PollType::Poll);
        self.failure().clone().unwrap_or_else(|| GpuError::Refused {
            adapter: self.name.clone(),
            reason: one_line(error),
        })
    }
}

/// WebGPU has 1 and 4 everywhere; others are the adapter's own.
fn sample_counts(
    adapter: &wgpu::Adapter,
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
) -> Vec<u32> {
    let own = wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES;
    let flags = adapter.get_texture_format_features(format).flags;
    let has = |count: &u32| match count {
        1 | 4 => true,
        _ => device.features().contains(own) && flags.sample_count_supported(*count),
    };
    Samples::COUNTS.into_iter().filter(has).collect()
}

fn binding_limit(device: &wgpu::Device) -> u64 {
    let limits = device.limits();
    limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size)
}

/// Keeps the first error for [`Gpu::check`], or the loss of the device, which is why
/// there are others.
fn watch(device: &wgpu::Device, name: &str, failure: &Arc<Mutex<Option<GpuError>>>) {
    let keep = |slot: &Mutex<Option<GpuError>>, error: GpuError| {
        let mut slot = slot.lock().unwrap_or_else(PoisonError::into_inner);
        match &error {
            GpuError::Lost { .. } => *slot = Some(error),
            _ => {
                slot.get_or_insert(error);
            }
        }
    };
    let (slot, adapter) = (failure.clone(), name.to_owned());
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        keep(
            &slot,
            GpuError::Refused {
                adapter: adapter.clone(),
                reason: one_line(&error),
            },
        );
    }));
    let (slot, adapter) = (failure.clone(), name.to_owned());
    // Also called when the device is dropped; then nobody is left to ask.
    device.set_device_lost_callback(move |reason, message| {
        let reason = format!("{reason:?}: {message}");
        let adapter = adapter.clone();
        keep(&slot, GpuError::Lost { adapter, reason });
    });
}

fn one_line(error: &dyn std::error::Error) -> String {
    error
        .to_string()
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}
