//! What one eye sees, in view space.

use triptych_spec::camera::Projection;
use triptych_spec::rsm::{Model, Surface, View};
use triptych_spec::scene::Size;

use bytemuck::{Pod, Zeroable};

/// What a pixel sees: `seen` of `hbao.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Pixel {
    /// At length 1, on the side that is seen: x right, y down, z away from the viewer. Zero where
    /// nothing is seen.
    pub normal: [f32; 3],
    /// Along z, in lattice steps: from the eye of a perspective, and positive; from anywhere of an
    /// orthographic view.
    pub depth: f32,
}

impl Pixel {
    /// Nothing is seen.
    pub const NOTHING: Self = Self {
        normal: [0.0; 3],
        depth: 0.0,
    };
}

/// All that is seen, and how it came to the screen. The point that a pixel sees lies in the
/// pixel's middle: `scale` times x over depth, or x if it is orthographic, from the picture's.
#[derive(Clone, Debug, PartialEq)]
pub struct Screen {
    /// Of the picture, at least a pixel.
    pub size: Size,
    /// Whether it is a perspective.
    pub near: bool,
    /// Pixels of a step along x and y, for a perspective at depth 1.
    pub scale: [f32; 2],
    /// Row by row.
    pub pixels: Vec<Pixel>,
}

impl Screen {
    /// The surfaces of a view's picture. Depths are those of the surfaces' lattice points, in
    /// `f64` and rounded once, so a plane's are off by the step that a point was snapped by.
    pub fn new(view: &View, model: &Model, surfaces: &[Option<Surface>]) -> Self {
        let [x, y, z, w] = view.matrix.rows;
        let near = matches!(view.projection, Projection::Perspective { .. });
        let ahead = if near { w } else { z };
        let steps = length(ahead);
        let axes = [unit(x), unit(y).map(|c| -c), unit(ahead)];
        let pixel = |surface: &Option<Surface>| {
            let Some(surface) = surface else {
                return Pixel::NOTHING;
            };
            let point = surface.point.map(f64::from);
            let depth = (dot(ahead, point) + ahead[3]) / steps;
            if near && depth <= 0.0 {
                return Pixel::NOTHING;
            }
            let side = f64::from(surface.side);
            let normal = model.face(surface.triangle).unit;
            let normal = normal.map(|c| side * f64::from(c));
            Pixel {
                normal: axes.map(|axis| rounded(dot4(axis, normal))),
                depth: rounded(depth),
            }
        };
        let halves = [view.size.width, view.size.height].map(|side| f64::from(side) / 2.0);
        Self {
            size: view.size,
            near,
            scale: [halves[0] * length(x), halves[1] * length(y)].map(rounded),
            pixels: surfaces.iter().map(pixel).collect(),
        }
    }
}

fn dot(row: [f64; 4], p: [f64; 3]) -> f64 {
    row[0] * p[0] + row[1] * p[1] + row[2] * p[2]
}

fn dot4(axis: [f64; 3], p: [f64; 3]) -> f64 {
    axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2]
}

fn length([x, y, z, _]: [f64; 4]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

fn unit(row: [f64; 4]) -> [f64; 3] {
    let length = length(row);
    [row[0], row[1], row[2]].map(|c| c / length)
}

#[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
fn rounded(c: f64) -> f32 {
    c as f32
}
