//! Scenes at random: perspective and orthographic, through the near plane, through
//! the camera, beyond the guard, at scales that use up f32's range.

use triptych_spec::camera::{Camera, Projection};
use triptych_spec::matrix::Matrix;
use triptych_spec::scene::{Scene, Size, Triangle, Vertex};
use triptych_spec::vertex::{DEPTH_ONE, GUARD, guard_origin};

use crate::generate::Random;

/// Sub-pixel bits of these tests.
pub const BITS: u32 = 8;

const SIZE: Size = Size {
    width: 320,
    height: 200,
};

/// Triangles whose vertices are given in world space.
pub fn scene(camera: Camera, vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> Scene {
    placed(camera, Matrix::IDENTITY, vertices, faces)
}

fn placed(camera: Camera, world: Matrix, vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> Scene {
    let aspect = f64::from(SIZE.width) / f64::from(SIZE.height);
    let clip = camera.matrix(aspect).expect("a sound camera");
    #[expect(clippy::cast_possible_truncation, reason = "as a mesh is loaded")]
    let vertex = |p: &[f64; 3]| Vertex {
        position: p.map(|v| v as f32),
        instance: 0,
    };
    let triangle = |(primitive, &vertices): (u32, &[u32; 3])| Triangle {
        vertices,
        instance: 0,
        primitive,
        colour: [1.0; 4],
    };
    Scene {
        samples: triptych_spec::raster::Samples::ONE,
        order: triptych_spec::abuffer::Order::Centroid,
        size: SIZE,
        instances: vec![clip.times(&world)],
        vertices: vertices.iter().map(vertex).collect(),
        triangles: (0..).zip(faces).map(triangle).collect(),
        background: [0.0; 3],
    }
}

/// A camera at the origin of a space of this scale, looking along -z.
pub fn camera(projection: Projection, scale: f64) -> Camera {
    Camera {
        eye: [0.0; 3],
        target: [0.1 * scale, 0.2 * scale, -scale],
        up: [0.0, 1.0, 0.0],
        projection,
        near: 0.1 * scale,
        far: 10.0 * scale,
    }
}

/// Vertices within a cube of half side `spread` around `centre`, no two triangles
/// sharing any.
fn scatter(seed: u64, count: u32, centre: [f64; 3], spread: f64) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut random = Random::new(seed);
    let vertices = (0..3 * count).map(|_| centre.map(|c| c + spread * random.signed()));
    let faces = (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
    (vertices.collect(), faces.collect())
}

/// Scenes by name. Each has triangles on all sides of every plane.
pub fn random() -> Vec<(String, Scene)> {
    let perspective = Projection::Perspective { fov: 60.0 };
    let mut scenes = Vec::new();
    for scale in [1.0, 1e-30, 1e18] {
        let parallel = Projection::Orthographic {
            height: 2.0 * scale,
        };
        for (seed, projection) in (1..).zip([perspective, parallel]) {
            // Around the camera, most triangles pass through some plane; far beyond the
            // guard (13 times the picture's height), many do not meet the picture.
            for (what, spread) in [("near", 0.5), ("around", 3.0), ("beyond", 60.0)] {
                let (vertices, faces) = scatter(seed, 2000, [0.0; 3], spread * scale);
                let name = format!("{projection:?} {what} at {scale:e}");
                scenes.push((name, scene(camera(projection, scale), &vertices, &faces)));
            }
        }
    }
    let offset = [300.0, -200.0, 100.0];
    let (vertices, faces) = scatter(9, 2000, offset, 3.0);
    let away = Camera {
        eye: offset,
        target: [301.0, -201.0, 99.0],
        ..camera(perspective, 1.0)
    };
    scenes.push(("large offset".into(), scene(away, &vertices, &faces)));
    let (vertices, faces) = scatter(10, 2000, [0.0; 3], 3.0);
    let turned = Matrix::rotate(1, 33.0).times(&Matrix::scale([1.0, -0.3, 2.0]));
    let turned = placed(camera(perspective, 1.0), turned, &vertices, &faces);
    scenes.push(("instance".into(), turned));
    scenes
}

/// A jittered grid under the camera, every edge shared, which the near plane and the
/// guard cut right across.
pub fn floor() -> Scene {
    const SIDE: u32 = 64;
    let mut random = Random::new(3);
    let mut vertices = Vec::new();
    let mut faces = Vec::new();
    for z in 0..SIDE {
        for x in 0..SIDE {
            let mut along = |i: u32| f64::from(i) / 8.0 - 4.0 + 0.05 * random.signed();
            vertices.push([along(x), -0.1 + 0.02 * along(0), along(z)]);
            if x + 1 < SIDE && z + 1 < SIDE {
                let at = z * SIDE + x;
                faces.extend([[at, at + 1, at + SIDE], [at + 1, at + SIDE + 1, at + SIDE]]);
            }
        }
    }
    let projection = Projection::Perspective { fov: 90.0 };
    scene(camera(projection, 1.0), &vertices, &faces)
}

/// Triangles with corners and edges on the near plane, the far plane and the guard's
/// edges, where f32 may see either side.
pub fn through_planes() -> Scene {
    let straight = Camera {
        eye: [0.0; 3],
        target: [0.0, 0.0, -1.0],
        up: [0.0, 1.0, 0.0],
        // A tenth of a unit is a pixel.
        projection: Projection::Orthographic { height: 20.0 },
        near: 0.1,
        far: 10.1,
    };
    let edge = f64::from(GUARD) / 20.0;
    let vertices = [
        [-5.0, -5.0, -0.1],
        [5.0, -5.0, -0.1],
        [0.0, 5.0, -0.1],
        [0.0, 5.0, -10.1],
        [0.0, 6.0, -0.05],
        [edge, 0.0, -5.0],
        [edge, 9.0, -5.0],
        [3.0, 3.0, -10.2],
        [edge + 10.0, 1.0, -7.0],
        [-1.0, -1.0, -10.1],
        [1.0, -1.0, -10.1],
    ];
    let faces = [
        [0, 1, 3],
        [0, 4, 3],
        [0, 1, 2],
        [0, 5, 3],
        [0, 5, 6],
        [5, 6, 2],
        [0, 3, 7],
        [5, 8, 2],
        [9, 10, 3],
    ];
    scene(straight, &vertices, &faces)
}

/// A fan around a vertex in the near plane, of which two spokes lead far behind it. The
/// point where either is cut is that vertex, but for the roundings of each.
pub fn hub_in_plane() -> Scene {
    let vertices = [
        [0.3217, 0.2093, 0.0],
        [-700.3, 40.1, -900.0],
        [-0.4, 0.6, 0.5],
        [-500.7, -30.9, -800.0],
        [0.1, -0.7, 0.4],
    ];
    let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4]];
    let camera = camera(Projection::Orthographic { height: 2.0 }, 1.0);
    let mut scene = scene(camera, &vertices, &faces);
    scene.instances = vec![Matrix::IDENTITY];
    scene
}

/// The last integer of an axis.
pub fn last(axis: usize, size: Size) -> i32 {
    match axis {
        0 => (guard_origin(size.width) + GUARD) << BITS,
        1 => (guard_origin(size.height) + GUARD) << BITS,
        _ => DEPTH_ONE,
    }
}
