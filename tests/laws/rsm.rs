//! Indirect light from a reflective shadow map, and its shadows.

#[path = "rsm/adapters.rs"]
mod adapters;
#[path = "rsm/closed_forms.rs"]
mod closed_forms;
#[path = "rsm/extremes.rs"]
mod extremes;
#[path = "rsm/kernels.rs"]
mod kernels;
#[path = "rsm/limits.rs"]
mod limits;
#[path = "rsm/loose.rs"]
mod loose;
#[path = "rsm/pictures.rs"]
mod pictures;
#[path = "rsm/points.rs"]
mod points;
#[path = "rsm/rays.rs"]
mod rays;
#[path = "rsm/worlds.rs"]
mod worlds;

use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::{Blockers, Grid, Membership};
use triptych_spec::rsm::{Colour, Face, Frame, Lamp, Model, Parameters, Setting, Surface, View};

use worlds::{R, place, scenes, worlds};

/// Within all limits.
const PARAMETERS: Parameters = Parameters {
    radius: 4,
    stride: 1,
    divisor: 2,
    blur: 1,
    bias: 0,
    clamp: 1,
    offset: 2,
    edge: 9,
};

/// A triangle.
type Corners = [[i32; 3]; 3];

/// A world on its lattice.
#[derive(Clone, Debug)]
struct Scene {
    model: Model,
    eye: View,
    lamp: Lamp,
    blockers: Blockers,
    grid: Grid,
    parameters: Parameters,
}

impl Scene {
    fn setting(&self) -> Setting<'_> {
        Setting {
            model: &self.model,
            eye: &self.eye,
            lamp: &self.lamp,
            blockers: &self.blockers,
            grid: &self.grid,
            parameters: self.parameters,
            background: [0.25, 0.5, 0.75],
        }
    }

    fn frame(&self) -> Frame {
        Frame::render(&self.setting()).expect("within the limits")
    }

    /// The same with other blockers.
    fn with(&self, vertices: Vec<[i32; 3]>) -> Self {
        let blockers = Blockers {
            triangles: rows(vertices.len() / 3),
            vertices,
        };
        Self {
            grid: Grid::build(&blockers, Resolution::FromScene, Membership::Box)
                .expect("within the limits"),
            blockers,
            ..self.clone()
        }
    }

    /// The texels of the kernel of a pixel, by the definition: column and row in the kernel
    /// first, whatever they are in the map.
    fn kernel(&self, [x, y]: [i32; 2]) -> Vec<(usize, usize)> {
        let (r, s) = (
            self.parameters.radius.cast_signed(),
            self.parameters.stride.cast_signed(),
        );
        let map = self.lamp.view.size;
        let mut all = Vec::new();
        for (j, row) in (-r..=r).map(|j| y + s * j).enumerate() {
            for (i, column) in (-r..=r).map(|i| x + s * i).enumerate() {
                let inside = (0..map.width.cast_signed()).contains(&column)
                    && (0..map.height.cast_signed()).contains(&row);
                if inside {
                    let texel = row * map.width.cast_signed() + column;
                    let side = (2 * r + 1).cast_unsigned() as usize;
                    all.push((j * side + i, texel.cast_unsigned() as usize));
                }
            }
        }
        all
    }
}

fn rows(triangles: usize) -> Vec<[u32; 3]> {
    let triangles = u32::try_from(triangles).expect("few");
    (0..triangles)
        .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
        .collect()
}

/// Two triangles.
fn quad([a, b, c, d]: [[i32; 3]; 4]) -> [Corners; 2] {
    [[a, b, c], [a, c, d]]
}

/// `n . d` of a face, from its corners alone.
fn volume([a, b, c]: [[i32; 3]; 3], d: [i32; 3]) -> i128 {
    let [u, v] = [b, c].map(|p| [0, 1, 2].map(|i| i128::from(p[i] - a[i])));
    let cross = |j: usize, k: usize| u[j] * v[k] - u[k] * v[j];
    cross(1, 2) * i128::from(d[0]) + cross(2, 0) * i128::from(d[1]) + cross(0, 1) * i128::from(d[2])
}

/// A pixel's point before it was moved off its face.
fn unmoved(model: &Model, surface: &Surface, offset: u32) -> [i32; 3] {
    let corners = model.corners(surface.triangle);
    let normal = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(|axis| volume(corners, axis));
    let longest = normal.iter().map(|c| c.abs()).max().expect("three");
    let axis = normal
        .iter()
        .position(|c| c.abs() == longest)
        .expect("of them");
    let mut point = surface.point;
    let way = i32::try_from(normal[axis].signum()).expect("a sign") * surface.side;
    point[axis] -= way * offset.cast_signed();
    point
}

/// Whether a surface faces a point, from its corners alone.
fn facing(model: &Model, from: &Surface, to: [i32; 3]) -> bool {
    let d = [0, 1, 2].map(|i| to[i] - from.point[i]);
    volume(model.corners(from.triangle), d) * i128::from(from.side) > 0
}

/// What a texel gives, in `f64` and without a bound.
fn given(model: &Model, to: &Surface, from: &Surface, clamp: u64) -> f64 {
    let unit = |s: &Surface| {
        let Face { unit, .. } = *model.face(s.triangle);
        unit.map(|c| f64::from(c) * f64::from(s.side))
    };
    let d = [0, 1, 2].map(|i| f64::from(from.point[i] - to.point[i]));
    let along = |n: [f64; 3]| n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
    let square = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).max(clamp as f64);
    along(unit(to)).max(0.0) * (-along(unit(from))).max(0.0) / (square * square)
}

/// Whether two colours are as near as their bounds say, and rounding in `f64`.
fn agree(a: &Colour, b: &Colour) -> bool {
    (0..3).all(|i| {
        let room = a[i].bound + b[i].bound + 1e-13 * (a[i].value.abs() + b[i].value.abs());
        (a[i].value - b[i].value).abs() <= room
    })
}
