//! What a device sees of a view by itself.

use triptych_gpu::abuffer::{self, Options};
use triptych_gpu::error::GpuError;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_spec::abuffer::{NOTHING, Order};
use triptych_spec::rsm::{Model, View};
use triptych_spec::vertex::{SUBPIXEL_BITS, primitives};

use super::gpu::Adapter;

/// What a view shows: of each pixel, row-major.
pub(super) struct Visible {
    /// Depth keys, or [`NOTHING`].
    pub(super) keys: Vec<u32>,
    /// Rows of triangles in the model, or [`NOTHING`].
    pub(super) triangles: Vec<u32>,
}

/// Which triangle each pixel of a view sees, by the device's own drawing of snapped triangles.
pub(super) fn visible(
    (adapter, path): (&Adapter, Path),
    view: &View,
    model: &Model,
) -> Result<Visible, GpuError> {
    let drawn = primitives(&view.scene(model), SUBPIXEL_BITS);
    let colours = vec![[0.0; 4]; drawn.prims.len()];
    let kernels = adapter.kernels(path);
    let rasterizer = Rasterizer::new(&adapter.gpu, kernels, path, &drawn, &colours)?;
    let options = Options {
        given: None,
        capacity: None,
        opaque: true,
        lists: false,
        depth_test: false,
        order: Order::Centroid,
        once: false,
        background: [0.0; 3],
    };
    // There are no lists to be followed.
    let opaque = abuffer::run(&rasterizer, options, |_| true, |_, _| None)?.opaque;
    let triangle = |prim: &u32| drawn.source.get(*prim as usize).copied();
    let triangles = opaque.prim.iter().map(|p| triangle(p).unwrap_or(NOTHING));
    Ok(Visible {
        triangles: triangles.collect(),
        keys: opaque.key,
    })
}
