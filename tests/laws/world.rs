//! Random scenes: triangles in space, seen by a camera.

use proptest::prelude::*;
use triptych_spec::camera::{Camera, Projection};
use triptych_spec::matrix::Matrix;
use triptych_spec::scene::{Scene, Size, Triangle, Vertex};

/// A camera and what it looks at.
#[derive(Clone, Debug)]
pub struct World {
    pub size: Size,
    pub camera: Camera,
    pub vertices: Vec<[f32; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

impl World {
    /// The scene, all of one instance; every triangle is opaque.
    pub fn scene(&self) -> Scene {
        let aspect = f64::from(self.size.width) / f64::from(self.size.height);
        let matrix = self
            .camera
            .matrix(aspect)
            .expect("the strategy makes sound cameras");
        scene(self.size, matrix, &self.vertices, &self.triangles)
    }
}

/// A scene of one instance.
pub fn scene(size: Size, matrix: Matrix, vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Scene {
    let vertex = |p: &[f32; 3]| Vertex {
        position: *p,
        instance: 0,
    };
    let triangle = |(primitive, corners): (u32, &[u32; 3])| Triangle {
        vertices: *corners,
        instance: 0,
        primitive,
        colour: [1.0; 4],
    };
    Scene {
        samples: triptych_spec::raster::Samples::ONE,
        order: triptych_spec::abuffer::Order::Centroid,
        size,
        instances: vec![matrix],
        vertices: vertices.iter().map(vertex).collect(),
        triangles: (0..).zip(triangles).map(triangle).collect(),
        background: [0.0; 3],
    }
}

fn size() -> impl Strategy<Value = Size> {
    let side = || prop_oneof![1_u32..100, Just(2048_u32)];
    (side(), side()).prop_map(|(width, height)| Size { width, height })
}

fn projection() -> impl Strategy<Value = Projection> {
    prop_oneof![
        (1_u32..170).prop_map(|fov| Projection::Perspective {
            fov: f64::from(fov)
        }),
        (1_u32..1000).prop_map(|height| Projection::Orthographic {
            height: f64::from(height) / 8.0
        }),
    ]
}

/// Cameras that look down some axis or slantwise, with coordinates in eighths, so
/// that powers of two scale them exactly.
pub fn camera() -> impl Strategy<Value = Camera> {
    let eighths = || (-800_i32..800).prop_map(|n| f64::from(n) / 8.0);
    let point = move || [eighths(), eighths(), eighths()];
    (point(), point(), projection(), 1_i32..80, 1_i32..8000).prop_filter_map(
        "eye, target and up span a plane",
        |(eye, target, projection, near, depth)| {
            let camera = Camera {
                eye,
                target,
                up: [0.25, 1.0, 0.0],
                projection,
                near: f64::from(near) / 8.0,
                far: f64::from(near + depth) / 8.0,
            };
            camera.matrix(1.0).is_ok().then_some(camera)
        },
    )
}

/// Points in 1/1024, before, behind, far beside the camera, and at its eye's height.
fn point() -> impl Strategy<Value = [f32; 3]> {
    let near = || (-100_000_i32..100_000).prop_map(|n| n as f32 / 1024.0);
    let far = || (-1_000_000_i32..1_000_000).prop_map(|n| n as f32);
    prop_oneof![4 => [near(), near(), near()], 1 => [far(), far(), far()]]
}

/// Any world with so many triangles.
pub fn world(triangles: std::ops::Range<usize>) -> impl Strategy<Value = World> {
    let vertices = prop::collection::vec(point(), 3..9);
    (size(), camera(), vertices).prop_flat_map(move |(size, camera, vertices)| {
        let count = u32::try_from(vertices.len()).expect("few vertices");
        let corners = [0..count, 0..count, 0..count];
        prop::collection::vec(corners, triangles.clone()).prop_map(move |triangles| World {
            size,
            camera,
            vertices: vertices.clone(),
            triangles,
        })
    })
}
