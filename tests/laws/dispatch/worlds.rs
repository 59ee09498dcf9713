//! Random worlds, on the lattice from the beginning.

use proptest::prelude::*;
use proptest::sample::Index;
use triptych_spec::camera::{Camera, Projection};
use triptych_spec::dispatch::{Eye, Lamp, Material, World};
use triptych_spec::grid::lattice::{EXTENT, Lattice, Point, REACH};
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::{Blockers, Grid, Membership};
use triptych_spec::scene::Size;

use super::Scene;

/// Half the side of the room that most worlds are in.
pub const R: i32 = 1 << 20;

/// A lattice whose steps are units.
pub const UNIT: Lattice = Lattice {
    centre: [0.0; 3],
    exponent: 0,
};

/// What a world is made of.
#[derive(Clone, Debug)]
pub struct Plain {
    pub triangles: Vec<[Point; 3]>,
    pub materials: Vec<Material>,
    pub lamps: Vec<Lamp>,
    pub background: [f32; 3],
    pub camera: Camera,
    pub size: Size,
    pub depth: u32,
    pub resolution: Resolution,
}

impl Plain {
    /// `None` if the camera has no picture on the lattice.
    pub fn scene(&self) -> Option<Scene> {
        let rows = (0..).take(self.triangles.len());
        let blockers = Blockers {
            vertices: self.triangles.iter().flatten().copied().collect(),
            triangles: rows.map(|t: u32| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
        };
        let grid = Grid::build(&blockers, self.resolution, Membership::Box).expect("within limits");
        let world = World::new(
            blockers,
            &self.materials,
            self.lamps.clone(),
            self.background,
            Eye::new(&self.camera, &UNIT, self.size).ok()?,
            self.depth,
        );
        Some(Scene {
            world: world.expect("within limits"),
            grid,
        })
    }
}

/// A point so far from 0.
pub fn place(reach: i32) -> impl Strategy<Value = Point> + Clone {
    let c = -reach..=reach;
    [c.clone(), c.clone(), c]
}

fn corner() -> BoxedStrategy<Point> {
    let border = prop::sample::select(vec![-EXTENT, EXTENT, EXTENT - 1, 0]);
    let far = prop_oneof![2 => -EXTENT..=EXTENT, 1 => border];
    prop_oneof![
        4 => place(R),
        2 => [far.clone(), far.clone(), far],
        1 => place(40),
    ]
    .boxed()
}

fn moved(at: Point, by: Point) -> Point {
    [0, 1, 2].map(|i| (at[i] + by[i]).clamp(-EXTENT, EXTENT))
}

/// Large, small and thin ones; some without area.
fn triangle() -> BoxedStrategy<[Point; 3]> {
    let beside = |reach: i32| {
        (corner(), place(reach), place(reach)).prop_map(|(a, b, c)| [a, moved(a, b), moved(a, c)])
    };
    let sliver = (corner(), corner(), place(3)).prop_map(|(a, b, by)| {
        let middle = [0, 1, 2].map(|i| i32::midpoint(a[i], b[i]));
        [a, b, moved(middle, by)]
    });
    prop_oneof![
        4 => [corner(), corner(), corner()],
        2 => beside(R / 4),
        1 => beside(8),
        2 => sliver,
    ]
    .boxed()
}

/// A box around the middle, turned inside, so that mirrors go on and on.
fn room() -> Vec<[Point; 3]> {
    let [l, h] = [-R, R];
    let quad = |[a, b, c, d]: [Point; 4]| [[a, b, c], [a, c, d]];
    [
        quad([[l, l, l], [h, l, l], [h, l, h], [l, l, h]]),
        quad([[l, l, l], [l, h, l], [h, h, l], [h, l, l]]),
        quad([[l, l, l], [l, l, h], [l, h, h], [l, h, l]]),
        quad([[h, h, h], [h, h, l], [h, l, l], [h, l, h]]),
    ]
    .concat()
}

fn material() -> BoxedStrategy<Material> {
    let share = prop_oneof![
        Just(0.0_f32),
        Just(1.0),
        0.0..1.0_f32,
        Just(1e-4),
        Just(1e-40)
    ];
    let colour = [share.clone(), share.clone(), share];
    (colour.clone(), colour)
        .prop_map(|(diffuse, mirror)| Material { diffuse, mirror })
        .boxed()
}

/// Anywhere, within triangles and at their corners.
fn lamp(triangles: &[[Point; 3]]) -> BoxedStrategy<Lamp> {
    let corners: Vec<Point> = triangles.iter().flatten().copied().collect();
    let inside = (
        prop::sample::select(corners.clone()),
        prop::sample::select(corners.clone()),
    )
        .prop_map(|(a, b)| [0, 1, 2].map(|i| i32::midpoint(a[i], b[i])));
    // Where a face's points and the lamp are about as far off its plane.
    let beside = (
        prop::sample::select(triangles.to_vec()),
        0..3_usize,
        place(3),
    );
    let beside = beside.prop_map(|(t, i, by)| {
        let (a, b) = (t[i], t[(i + 1) % 3]);
        [0, 1, 2].map(|i| i32::midpoint(a[i], b[i]) + by[i])
    });
    let position = prop_oneof![
        4 => place(R),
        2 => beside,
        1 => place(REACH),
        1 => prop::sample::select(corners),
        1 => inside,
    ];
    let strength = prop_oneof![Just(0.0_f32), 0.0..4.0_f32, Just(1e-40)];
    let strength = [strength.clone(), strength.clone(), strength];
    let least = prop_oneof![Just(1_u32), 1..1_u32 << 24];
    (position, strength, 1..1_u32 << 24, least)
        .prop_map(|(position, strength, reference, least)| {
            // 2^18 at most.
            let least = least.max(reference >> 8).max(1);
            Lamp::new(position, strength, reference, least).expect("within limits")
        })
        .boxed()
}

fn camera() -> BoxedStrategy<Camera> {
    let projection = prop_oneof![
        3 => (20.0..120.0_f64).prop_map(|fov| Projection::Perspective { fov }),
        1 => (1..3 * R).prop_map(|height| Projection::Orthographic { height: height.into() }),
    ];
    let eye = prop_oneof![4 => place(R - 1), 1 => place(REACH)];
    (projection, eye, place(R))
        .prop_map(|(projection, eye, target)| Camera {
            eye: eye.map(f64::from),
            target: target.map(|c| f64::from(c) + 0.25),
            up: [0.1, 1.0, 0.2],
            projection,
            near: 1.0,
            far: f64::from(1_u32 << 26),
        })
        .boxed()
}

fn size() -> impl Strategy<Value = Size> {
    (1..=9_u32, 1..=9_u32).prop_map(|(width, height)| Size { width, height })
}

/// Triangles, some of them twice, with or without a room around them.
fn triangles() -> impl Strategy<Value = Vec<[Point; 3]>> {
    let loose = prop::collection::vec(triangle(), 1..10);
    let again = prop::collection::vec(any::<Index>(), 0..3);
    let base = prop_oneof![3 => Just(room()), 1 => Just(Vec::new())];
    (base, loose, again).prop_map(|(base, loose, again)| {
        let mut all = [base, loose].concat();
        for index in again {
            // Turned, so that it is no copy for a kernel that starts from its first corner.
            let [a, b, c] = all[index.index(all.len())];
            all.push([b, c, a]);
        }
        all
    })
}

pub fn plains() -> impl Strategy<Value = Plain> {
    let shine = prop_oneof![Just(0.0_f32), 0.0..2.0_f32, 0.0..1e6_f32];
    let background = [shine.clone(), shine.clone(), shine];
    let resolution = prop_oneof![
        2 => Just(Resolution::FromScene),
        1 => [1..9_u32, 1..9_u32, 1..9_u32].prop_map(Resolution::Given),
    ];
    (
        triangles(),
        background,
        camera(),
        size(),
        0..=6_u32,
        resolution,
    )
        .prop_flat_map(|(triangles, background, camera, size, depth, resolution)| {
            let materials = prop::collection::vec(material(), triangles.len());
            let lamps = prop::collection::vec(lamp(&triangles), 0..4);
            (materials, lamps).prop_map(move |(materials, mut lamps)| {
                // Rays are told apart by pixel and lamp.
                lamps.sort_by_key(|lamp| lamp.position);
                lamps.dedup_by_key(|lamp| lamp.position);
                Plain {
                    triangles: triangles.clone(),
                    materials,
                    lamps,
                    background,
                    camera,
                    size,
                    depth,
                    resolution,
                }
            })
        })
}

/// White triangles before an eye that does not matter, in cells of their own.
pub fn alone(triangles: Vec<[Point; 3]>) -> Scene {
    alone_in(triangles, Resolution::FromScene)
}

/// The same in given cells.
pub fn alone_in(triangles: Vec<[Point; 3]>, resolution: Resolution) -> Scene {
    let white = Material {
        diffuse: [1.0; 3],
        mirror: [0.0; 3],
    };
    let plain = Plain {
        materials: vec![white; triangles.len()],
        triangles,
        lamps: Vec::new(),
        background: [0.0; 3],
        camera: Camera {
            eye: [0.0; 3],
            target: [1.0, 0.0, 0.0],
            up: [0.0, 1.0, 0.0],
            projection: Projection::Perspective { fov: 60.0 },
            near: 1.0,
            far: 2.0,
        },
        size: Size {
            width: 2,
            height: 1,
        },
        depth: 0,
        resolution,
    };
    plain.scene().expect("there is a picture")
}

pub fn scenes() -> impl Strategy<Value = Scene> {
    plains().prop_filter_map("the camera has no picture", |plain| plain.scene())
}
