//! Random scenes, and how they come to be on a lattice.

use proptest::prelude::*;
use triptych_spec::camera::{Camera, Projection};
use triptych_spec::grid::lattice::Lattice;
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::{Blockers, Grid, Membership};
use triptych_spec::rsm::{EDGE_MAX, Lamp, Model, Parameters, View};
use triptych_spec::scene::Size;

use super::{Corners, Scene, quad, rows};

/// Half the side of the box that random scenes are in, in world units.
pub const R: i32 = 1 << 20;

/// A scene before it is on a lattice. Its numbers are integers, so that moving it by
/// integers and scaling it by powers of two rounds nothing.
#[derive(Clone, Debug)]
pub struct World {
    pub triangles: Vec<Corners>,
    pub colours: Vec<[f32; 3]>,
    pub blockers: Vec<Corners>,
    pub eye: Camera,
    pub light: Camera,
    pub size: Size,
    pub map: Size,
    pub strength: [f32; 3],
    pub parameters: Parameters,
}

impl World {
    /// Laid on a lattice, after it has been moved and scaled.
    pub fn scene(&self, by: [i32; 3], power: i32) -> Scene {
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

/// A point so far from 0.
pub fn place(reach: i32) -> impl Strategy<Value = [i32; 3]> {
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
        // Steps, or a good part of the scene: then faces that meet at an angle are near.
        prop_oneof![0..1_u32 << 12, 0..=EDGE_MAX],
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
pub fn worlds() -> impl Strategy<Value = World> {
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

/// Random scenes on their lattices.
pub fn scenes() -> impl Strategy<Value = Scene> {
    worlds().prop_map(|world| world.scene([0; 3], 0))
}
