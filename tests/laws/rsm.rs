//! Indirect light from a reflective shadow map, and its shadows.

#[path = "rsm/closed_forms.rs"]
mod closed_forms;
#[path = "rsm/loose.rs"]
mod loose;
#[path = "rsm/pictures.rs"]
mod pictures;
#[path = "rsm/points.rs"]
mod points;
#[path = "rsm/rays.rs"]
mod rays;

use proptest::prelude::*;
use triptych_spec::camera::{Camera, Projection};
use triptych_spec::grid::lattice::Lattice;
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::{Blockers, Grid, Membership};
use triptych_spec::rsm::{Colour, Face, Frame, Lamp, Model, Parameters, Setting, Surface, View};
use triptych_spec::scene::Size;

/// Half the side of the box that random scenes are in, in world units.
const R: i32 = 1 << 20;

/// A triangle of the world.
type Corners = [[i32; 3]; 3];

/// A scene before it is on a lattice. Its numbers are integers, so that moving it by
/// integers and scaling it by powers of two rounds nothing.
#[derive(Clone, Debug)]
struct World {
    triangles: Vec<Corners>,
    colours: Vec<[f32; 3]>,
    blockers: Vec<Corners>,
    eye: Camera,
    light: Camera,
    size: Size,
    map: Size,
    strength: [f32; 3],
    parameters: Parameters,
}

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

impl World {
    /// Laid on a lattice, after it has been moved and scaled.
    fn scene(&self, by: [i32; 3], power: i32) -> Scene {
        let scale = f64::from(power).exp2();
        let place = |p: [f64; 3]| [0, 1, 2].map(|axis| (p[axis] + f64::from(by[axis])) * scale);
        let points = self.triangles.iter().chain(&self.blockers).flatten();
        let points = points.map(|p| p.map(f64::from));
        let points = points.chain([self.eye.eye, self.light.eye]);
        let lattice = Lattice::around(points.map(place)).expect("finite");
        let snapped = |triangles: &[Corners]| {
            let points = triangles.iter().flatten();
            points
                .map(|p| lattice.snap(place(p.map(f64::from))).expect("inside"))
                .collect::<Vec<_>>()
        };
        let camera = |camera: &Camera| Camera {
            eye: place(camera.eye),
            target: place(camera.target),
            near: camera.near * scale,
            far: camera.far * scale,
            projection: match camera.projection {
                Projection::Orthographic { height } => Projection::Orthographic {
                    height: height * scale,
                },
                perspective @ Projection::Perspective { .. } => perspective,
            },
            ..*camera
        };
        let view = |c: &Camera, size| View::new(&camera(c), &lattice, size).expect("a view");
        let blockers = Blockers {
            vertices: snapped(&self.blockers),
            triangles: rows(self.blockers.len()),
        };
        let corners = snapped(&self.triangles);
        let model = Model::new(corners, rows(self.triangles.len()), self.colours.clone());
        Scene {
            model: model.expect("within the limits"),
            eye: view(&self.eye, self.size),
            lamp: Lamp::new(view(&self.light, self.map), self.strength, 1 << 21)
                .expect("within the limits"),
            grid: Grid::build(&blockers, Resolution::FromScene, Membership::Overlap)
                .expect("within the limits"),
            blockers,
            parameters: self.parameters,
        }
    }
}

impl Scene {
    fn frame(&self) -> Frame {
        let setting = Setting {
            model: &self.model,
            eye: &self.eye,
            lamp: &self.lamp,
            blockers: &self.blockers,
            grid: &self.grid,
            parameters: self.parameters,
            background: [0.25, 0.5, 0.75],
        };
        Frame::render(&setting).expect("within the limits")
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

fn place(reach: i32) -> impl Strategy<Value = [i32; 3]> {
    let c = -reach..=reach;
    [c.clone(), c.clone(), c]
}

fn triangle() -> impl Strategy<Value = Corners> {
    let small = (place(R), place(R / 4)).prop_flat_map(|(at, a)| {
        (place(R / 4)).prop_map(move |b| {
            let plus = |d: [i32; 3]| [0, 1, 2].map(|i| at[i] + d[i]);
            [at, plus(a), plus(b)]
        })
    });
    prop_oneof![
        4 => [place(R), place(R), place(R)],
        3 => small,
        // Without area, or hardly any.
        1 => (place(R), place(R)).prop_map(|(a, b)| [a, b, [0, 1, 2].map(|i| i32::midpoint(a[i], b[i]))]),
    ]
}

fn camera() -> impl Strategy<Value = Camera> {
    let projection = prop_oneof![
        (30.0..80.0_f64).prop_map(|fov| Projection::Perspective { fov }),
        Just(Projection::Orthographic {
            height: 3.0 * f64::from(R)
        }),
    ];
    let direction = (-20..=20_i32, 5..=30_i32, 10..=30_i32);
    (projection, direction, place(R / 8)).prop_map(|(projection, (x, y, z), target)| {
        let target = target.map(f64::from);
        let way = [x, y, z].map(|c| f64::from(c * (R / 16)));
        Camera {
            eye: [0, 1, 2].map(|i| target[i] + way[i]),
            target,
            up: [0.0, 1.0, 0.0],
            projection,
            near: f64::from(R / 8),
            far: f64::from(8 * R),
        }
    })
}

fn parameters() -> impl Strategy<Value = Parameters> {
    let kernel = (0..6_u32, 1..4_u32);
    let clamp = prop_oneof![Just(1), 1..=1_u64 << 40];
    (
        kernel,
        1..4_u32,
        0..3_u32,
        0..1_u32 << 24,
        clamp,
        2..=32_u32,
        0..1_u32 << 12,
    )
        .prop_map(
            |((radius, stride), divisor, blur, bias, clamp, offset, edge)| Parameters {
                radius,
                stride,
                divisor,
                blur,
                bias,
                clamp,
                offset,
                edge,
            },
        )
}

fn size(most: u32) -> impl Strategy<Value = Size> {
    (1..=most, 1..=most).prop_map(|(width, height)| Size { width, height })
}

/// A floor and a wall, and triangles before them; blockers of their own, or the same.
fn worlds() -> impl Strategy<Value = World> {
    let [l, h] = [-R, R];
    let floor = quad([[l, l, l], [h, l, l], [h, l, h], [l, l, h]]);
    let wall = quad([[l, l, l], [l, h, l], [h, h, l], [h, l, l]]);
    let loose = prop::collection::vec(triangle(), 0..6);
    let colour = prop_oneof![Just(0.0), 0.0..1.0_f32];
    let colours = prop::collection::vec([colour.clone(), colour.clone(), colour], 10);
    let blockers = prop::option::of(prop::collection::vec(triangle(), 1..8));
    let strength = [0.0..4.0_f32, 0.0..4.0, 0.0..1e3];
    let cameras = (camera(), camera());
    let sizes = (size(8), size(9));
    (
        loose,
        colours,
        blockers,
        strength,
        cameras,
        sizes,
        parameters(),
    )
        .prop_map(
            move |(
                loose,
                mut colours,
                blockers,
                strength,
                (eye, light),
                (size, map),
                parameters,
            )| {
                let triangles = [floor.to_vec(), wall.to_vec(), loose].concat();
                colours.truncate(triangles.len());
                World {
                    blockers: blockers.unwrap_or_else(|| triangles.clone()),
                    triangles,
                    colours,
                    eye,
                    light,
                    size,
                    map,
                    strength,
                    parameters,
                }
            },
        )
}

fn scenes() -> impl Strategy<Value = Scene> {
    worlds().prop_map(|world| world.scene([0; 3], 0))
}
