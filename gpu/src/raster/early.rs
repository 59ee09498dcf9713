//! Lists built by fragments that passed a test of depth before they ran, where an adapter has one.
//!
//! Yang et al. 2010, appendix A: `earlydepthstencil`. Without the attribute, a kernel that writes to buffers
//! runs before any test. What passes is tested by the exact key all the same.

use super::{Rasterizer, Ready, Work, texture};
use crate::error::GpuError;
use crate::frame::Frame;
use crate::kernel::DEPTH_FORMAT;

impl Rasterizer<'_> {
    /// Behaves as on an adapter without such a test.
    pub fn forgo_early_test(&mut self) {
        self.early = false;
    }

    /// Whether lists are built behind such a test: on the fragment path, with kernels of ours, where hidden
    /// fragments are left out.
    fn tests_early(&self, frame: &Frame) -> bool {
        self.early && self.kernels.is_ours("build_fragment") && frame.depth_test != 0
    }

    /// Makes the target's depth, unless it is there; whether there is room for it.
    fn has_depth(&self) -> Result<bool, GpuError> {
        if self.depth.get().is_some() {
            return Ok(true);
        }
        let format = ("depth", DEPTH_FORMAT, 4);
        match texture(self.gpu, format, self.size, self.samples.count()) {
            Ok(made) => {
                self.depth.get_or_init(|| made);
                Ok(true)
            }
            // Bands share the target's depth: smaller ones need no less.
            Err(GpuError::Memory { .. }) => Ok(false),
            Err(error) => Err(error),
        }
    }

    /// The passes that build the lists of a band, whose opaque surfaces are known: one for each batch, and
    /// before them, if they are tested early, one that gives each pixel its depth.
    pub(crate) fn ready_build(
        &self,
        frame: Frame,
        work: &Work,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<Vec<Ready>, GpuError> {
        let tested = self.tests_early(&frame) && !work.batches.is_empty();
        if !tested || !self.has_depth()? {
            return self.ready("abuffer", "build", frame, work, buffers);
        }
        let file = match self.samples.count() {
            1 => "early",
            _ => "early_samples",
        };
        let kernel = |entries| {
            self.kernels
                .fragment(self.gpu, file, entries, self.samples.count())
        };
        let depth = kernel(["place_everywhere", "opaque_depth_fragment"])?;
        let frame_of_depth = Frame {
            work_count: 1,
            ..frame
        };
        let uniform = self.gpu.uniform("frame", &frame_of_depth)?;
        let mut all = vec![("frame", &uniform)];
        all.extend_from_slice(buffers);
        let mut passes = vec![Ready {
            group: depth.bind(self.gpu, &all),
            kernel: depth,
            stage: "build".into(),
            shared: false,
            frame: frame_of_depth,
            invocations: 0,
        }];
        let build = kernel(["place_nearest", "build_early_fragment"])?;
        passes.extend(self.ready_kernel(&build, "build", frame, work, buffers)?);
        Ok(passes)
    }
}
