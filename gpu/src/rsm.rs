//! The frame of indirect light on the device.
//!
//! Each stage is given what the stages before should have made, and gives what the device makes
//! of it. Twin: `spec/src/rsm.rs`.

mod device;
mod faces;
mod records;
mod setup;
mod stages;
mod timed;

use bytemuck::{Pod, Zeroable};
use triptych_spec::rsm::{Place as SpecPlace, Setting, View as SpecView, Viewpoint};
use triptych_spec::vertex::viewport;

pub use faces::gbuffer;
pub use records::{Face, Light, Place, Surface};
pub use stages::{Blocked, Colours, Stages, Surfaces};
pub use timed::{Span, Timed, Work};

/// What a kernel is told. Twin: `Parameters` in `parameters.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Parameters {
    /// Pixels a row of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// Texels a row of the light's map.
    pub map_width: u32,
    /// Rows of the light's map.
    pub map_height: u32,
    /// Pixels a row of buffer B.
    pub coarse_width: u32,
    /// Rows of buffer B.
    pub coarse_height: u32,
    /// Texels of a kernel to each side.
    pub radius: u32,
    /// Texels from one of a kernel to the next.
    pub stride: u32,
    /// Pixels to one of buffer B, along x and y.
    pub divisor: u32,
    /// Pixels of buffer B to each side that are averaged.
    pub blur: u32,
    /// How far a point is moved off its face.
    pub offset: u32,
    /// How much deeper than the map's a lit point's key may be.
    pub bias: u32,
    /// Least squared distance, rounded.
    pub clamp: f32,
    /// Farthest from each other's planes that two points of a surface may be.
    pub edge: u32,
    /// Pixels, texels, pairs or rays of a dispatch.
    pub items: u32,
    /// The first of them, or of a kernel's rows.
    pub first: u32,
    /// Rows of a kernel in a dispatch.
    pub rows: u32,
    /// Reference distance of a spot light.
    pub reference: f32,
    /// Up to a multiple of 16 bytes.
    pub unused: [u32; 2],
    /// The lamp's; the fourth number is not used.
    pub strength: [f32; 4],
    /// Where nothing is seen; the fourth number is not used.
    pub background: [f32; 4],
}

impl From<&Setting<'_>> for Parameters {
    fn from(setting: &Setting<'_>) -> Self {
        let given = setting.parameters;
        let (eye, map) = (setting.eye.size, setting.lamp.view.size);
        let coarse = given.coarse(eye);
        let [r, g, b] = setting.lamp.strength;
        let [red, green, blue] = setting.background;
        Self {
            width: eye.width,
            height: eye.height,
            map_width: map.width,
            map_height: map.height,
            coarse_width: coarse.width,
            coarse_height: coarse.height,
            radius: given.radius,
            stride: given.stride,
            divisor: given.divisor,
            blur: given.blur,
            offset: given.offset,
            bias: given.bias,
            clamp: given.clamp as f32,
            edge: given.edge,
            reference: setting.lamp.reference as f32,
            strength: [r, g, b, 0.0],
            background: [red, green, blue, 0.0],
            ..Self::default()
        }
    }
}

/// A view as kernels are told it. Twin: `View` in `view.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct View {
    /// Homogeneous pixels and depth from lattice steps, rounded.
    pub rows: [[f32; 4]; 4],
    /// The eye, or the direction to it.
    pub viewpoint: [f32; 3],
    /// 1: it is a point, 0: a direction.
    pub near: u32,
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Up to a multiple of 16 bytes.
    pub unused: [u32; 2],
}

impl From<&SpecView> for View {
    #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
    fn from(view: &SpecView) -> Self {
        let rows = viewport(view.size).times(&view.matrix).rows;
        let (near, point) = match view.viewpoint {
            Viewpoint::Near(eye) => (1, eye),
            Viewpoint::Far(direction) => (0, direction),
        };
        Self {
            rows: rows.map(|row| row.map(|c| c as f32)),
            // Integers of 24 bits, exact.
            viewpoint: point.map(|c| c as f32),
            near,
            width: view.size.width,
            height: view.size.height,
            unused: [0; 2],
        }
    }
}

/// All that a frame made by itself, from snapped triangles to the picture. Colours are linear.
#[derive(Clone, Debug, PartialEq)]
pub struct Made {
    /// What the eye sees.
    pub seen: Surfaces,
    /// What the light sees.
    pub lights: Surfaces,
    /// The light's depth keys.
    pub keys: Vec<u32>,
    /// Intensities of the light's texels.
    pub intensities: Colours,
    /// The eye's points in the light's map.
    pub places: Vec<Option<SpecPlace>>,
    /// Whether the light reaches them.
    pub lit: Vec<bool>,
    /// Light that comes straight.
    pub direct: Colours,
    /// Buffer A.
    pub all: Colours,
    /// Which texels are blocked.
    pub bits: Vec<u32>,
    /// Buffer B.
    pub blocked: Colours,
    /// Buffer B, averaged.
    pub blurred: Colours,
    /// The picture.
    pub picture: Colours,
}
