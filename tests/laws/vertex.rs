//! Laws of the vertex stages.

#[path = "vertex/clip.rs"]
mod clip;

use proptest::prelude::*;
use triptych_spec::bound::Bounded;
use triptych_spec::camera::Projection;
use triptych_spec::matrix::Matrix;
use triptych_spec::scene::Size;
use triptych_spec::vertex::{
    DEPTH_ONE, GUARD, Polygons, Position, clip, guard_origin, primitives, snap, transform,
};

use super::config;
use super::loose::Loose;
use super::world::{World, scene, world};

/// A position's bits: equal bits are equal points.
fn bits(p: &Position<f64>) -> [u64; 4] {
    p.map(f64::to_bits)
}

/// Corners on the grid, as if they were a scene's only polygon.
fn snapped(size: Size, corners: Vec<Position<f64>>, bits: u32) -> Vec<[i32; 3]> {
    let empty = scene(size, Matrix::IDENTITY, &[], &[]);
    let end = u32::try_from(corners.len()).expect("few corners");
    snap(
        &empty,
        &Polygons {
            offsets: vec![0, end],
            corners,
        },
        bits,
    )
    .snapped
}

/// Homogeneous positions around the guard's corners, in front and behind.
fn position() -> impl Strategy<Value = Position<f64>> {
    let across =
        || prop_oneof![3 => -9000.0..9000.0, 1 => (-5_i32..5).prop_map(|n| f64::from(n) * 1024.0)];
    let w = prop_oneof![3 => 0.01..10.0, 1 => -10.0..10.0, 1 => Just(1.0)];
    let z = prop_oneof![3 => -1.0..2.0, 1 => Just(0.0), 1 => Just(1.0)];
    (across(), across(), z, w).prop_map(|(x, y, z, w)| [x * w, y * w, z * w, w])
}

/// Positions that no plane cuts off; some lie in a plane. Divisors are powers of two,
/// so that this holds exactly.
fn visible(size: Size) -> impl Strategy<Value = Position<f64>> {
    let across = |side| {
        let low = guard_origin(side);
        prop_oneof![3 => low..=low + GUARD, 1 => prop::sample::select(vec![low, low + GUARD])]
    };
    let z = prop_oneof![2 => 0.0..=1.0, 1 => Just(0.0), 1 => Just(1.0)];
    (across(size.width), across(size.height), z, -3_i32..4).prop_map(|(x, y, z, w)| {
        let w = f64::from(w).exp2();
        [f64::from(x) * w, f64::from(y) * w, z * w, w]
    })
}

fn target() -> impl Strategy<Value = Size> {
    (1_u32..2049, 1_u32..2049).prop_map(|(width, height)| Size { width, height })
}

/// The snapped corners of each source triangle's pieces.
fn pieces(world: &World) -> Vec<Vec<[[i32; 3]; 3]>> {
    let p = primitives(&world.scene(), 8);
    let mut pieces = vec![Vec::new(); world.triangles.len()];
    for (row, source) in p.prims.iter().zip(&p.source) {
        pieces[*source as usize].push(row.map(|v| p.snapped[v as usize]));
    }
    pieces
}

proptest! {
    #![proptest_config(config(4000))]

    /// A point of the grid is snapped to itself; a depth to its key, rounded down.
    #[test]
    fn grid_points_stay(
        [width, height] in [0_u32..12, 0..12],
        sub in 1_u32..=8,
        [x, y] in [0_f64..=1.0, 0.0..=1.0],
        z in 0_u32..=1 << 20,
    ) {
        let size = Size { width: 1 << width, height: 1 << height };
        let on_grid = |share: f64, side: u32| (share * f64::from(side << sub)).round();
        let (x, y) = (on_grid(x, size.width), on_grid(y, size.height));
        // All powers of two: clip space holds the same points exactly.
        let clip = |at: f64, side: u32| 2.0 * at / f64::from(side << sub) - 1.0;
        #[expect(clippy::cast_possible_truncation, reason = "at most 20 bits")]
        let place = [clip(x, size.width), -clip(y, size.height)].map(|v| v as f32);
        let point = [place[0], place[1], z as f32 / (1 << 20) as f32];
        let scene = scene(size, Matrix::IDENTITY, &[point], &[[0; 3]]);
        let key = (u64::from(z) * u64::from(DEPTH_ONE.cast_unsigned())) >> 20;
        for [seen_x, seen_y, seen_z] in primitives(&scene, sub).snapped {
            prop_assert_eq!([seen_x, seen_y].map(f64::from), [x, y]);
            prop_assert_eq!(seen_z.cast_unsigned(), u32::try_from(key).expect("31 bits"));
        }
    }

    /// A polygon moved by whole sub-pixels: its corners on the grid move by as many, and
    /// their keys stay. By an even number, as ties go to the even one.
    #[test]
    fn translation_by_sub_pixels(
        corners in prop::collection::vec(
            ([-80_000_i32..80_000, -80_000..80_000], 0_u32..=1 << 20, -3_i32..3),
            3..6,
        ),
        [dx, dy] in [-20_000_i32..20_000, -20_000..20_000],
        sub in 4_u32..=8, // no corner leaves the guard
    ) {
        let size = Size { width: 100, height: 80 };
        let grid = f64::from(1_u32 << sub);
        // In sixteenths of a sub-pixel, and w a power of two: nothing rounds but `snap`.
        let at = |[x, y]: [i32; 2], z: u32, w: i32| {
            let [x, y] = [x, y].map(|n| f64::from(n) / (16.0 * grid));
            [x, y, f64::from(z) / f64::from(1 << 20), 1.0].map(|c| c * f64::from(w).exp2())
        };
        let by = |[x, y]: [i32; 2]| [x + 32 * (dx / 16), y + 32 * (dy / 16)];
        let plain = corners.iter().map(|(p, z, w)| at(*p, *z, *w)).collect();
        let moved = corners.iter().map(|(p, z, w)| at(by(*p), *z, *w)).collect();
        let mut must = snapped(size, plain, sub);
        for corner in &mut must {
            corner[0] += 2 * (dx / 16);
            corner[1] += 2 * (dy / 16);
        }
        prop_assert_eq!(snapped(size, moved, sub), must);
    }

    /// World and camera scaled by a power of two: the same corners on the grid.
    #[test]
    fn powers_of_two(world in world(1..5), exponent in -20_i32..20) {
        let factor = f64::from(exponent).exp2();
        let mut scaled = world.clone();
        scaled.camera.eye = world.camera.eye.map(|x| x * factor);
        scaled.camera.target = world.camera.target.map(|x| x * factor);
        scaled.camera.near *= factor;
        scaled.camera.far *= factor;
        if let Projection::Orthographic { height } = &mut scaled.camera.projection {
            *height *= factor;
        }
        #[expect(clippy::cast_possible_truncation, reason = "a power of two is exact")]
        let short = factor as f32;
        scaled.vertices.iter_mut().flatten().for_each(|x| *x *= short);
        prop_assert_eq!(primitives(&scaled.scene(), 8), primitives(&world.scene(), 8));
    }

    /// Reordered triangles are clipped and snapped as before.
    #[test]
    fn permutation(
        (world, order) in world(0..6).prop_flat_map(|world| {
            let order: Vec<usize> = (0..world.triangles.len()).collect();
            (Just(world), Just(order).prop_shuffle())
        })
    ) {
        let mut shuffled = world.clone();
        shuffled.triangles = order.iter().map(|t| world.triangles[*t]).collect();
        let (plain, shuffled) = (pieces(&world), pieces(&shuffled));
        for (now, before) in order.iter().enumerate() {
            prop_assert_eq!(&shuffled[now], &plain[*before]);
        }
    }

    /// Every corner lies in the guard rectangle and on the depth scale, every row names
    /// corners that exist, and rows come in order of their source.
    #[test]
    fn corners_are_in_range(
        mut world in world(0..6),
        wild in prop::option::of([prop::num::f32::NORMAL, prop::num::f32::NORMAL, prop::num::f32::NORMAL]),
        sub in 1_u32..=8,
    ) {
        world.vertices[0] = wild.unwrap_or(world.vertices[0]);
        let p = primitives(&world.scene(), sub);
        let sides = [world.size.width, world.size.height].map(|side| {
            let low = guard_origin(side) << sub;
            low..=low + (GUARD << sub)
        });
        for [x, y, z] in &p.snapped {
            prop_assert!(sides[0].contains(x) && sides[1].contains(y), "{x}, {y}");
            prop_assert!((0..=DEPTH_ONE).contains(z), "{z}");
        }
        prop_assert!(p.prims.iter().flatten().all(|v| (*v as usize) < p.snapped.len()));
        prop_assert!(p.source.is_sorted());
        prop_assert_eq!(p.source.len(), p.prims.len());
    }

    /// With bounds or without, the stages compute the same numbers.
    #[test]
    fn bounded_values_are_plain(world in world(0..6)) {
        let scene = world.scene();
        let (plain, bounded) = (transform::<f64>(&scene), transform::<Bounded>(&scene));
        let value = |p: &Position<Bounded>| bits(&p.map(|c| c.value));
        prop_assert_eq!(
            plain.iter().map(bits).collect::<Vec<_>>(),
            bounded.iter().map(value).collect::<Vec<_>>()
        );
        let (plain, bounded) = (clip(&scene, &plain), clip(&scene, &bounded));
        prop_assert_eq!(plain.offsets, bounded.offsets);
        prop_assert_eq!(
            plain.corners.iter().map(bits).collect::<Vec<_>>(),
            bounded.corners.iter().map(value).collect::<Vec<_>>()
        );
    }

    /// Positions computed in `f32`, as loosely as WGSL allows, are inside the bounds.
    #[test]
    fn transform_in_f32(world in world(0..2), seed in any::<u64>()) {
        let scene = world.scene();
        let matrix = triptych_spec::vertex::viewport(scene.size).times(&scene.instances[0]);
        let mut machine = Loose::new(seed);
        for (vertex, bounded) in scene.vertices.iter().zip(transform::<Bounded>(&scene)) {
            let [x, y, z] = vertex.position;
            for (row, bounded) in matrix.rows.iter().zip(bounded) {
                let row = row.map(|c| machine.round(c));
                let terms = [(row[0], x), (row[1], y), (row[2], z), (row[3], 1.0)];
                let products = terms.map(|(c, t)| machine.mul(c, t));
                let seen = machine.sum(&products);
                prop_assert!(bounded.admits(f64::from(seen)), "{seen:e} against {bounded:?}");
            }
        }
    }
}
