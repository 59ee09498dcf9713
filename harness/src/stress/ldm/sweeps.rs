//! The sweeps, and the scene of each of their steps.

use triptych_spec::ldm::directions;

use super::super::shot::Vertex;
use super::super::sweeps::{Step, Sweep, power, step};
use super::scenes::{ball, comb, cuboid, floor, in_plane, rectangle, room, square};
use super::shot::{Form, LdmShot};
use super::sizes::{aspect, eye_far_away, offset_over_size, scale_of_scene, size_in_pixels};
use crate::vector::{add, normalize, scale};

/// All of them.
pub fn sweeps() -> Vec<Sweep<LdmShot>> {
    let sweep = Sweep::new;
    vec![
        sweep(
            "grazing",
            "degrees between a plane and a direction of the set",
            angle,
        ),
        sweep("convex", "faces of a ball", faces_of_ball),
        sweep(
            "slope",
            "keys a key by which a surface's depth changes",
            slope_of_surface,
        ),
        sweep(
            "layers",
            "distance of two sheets in halves of a pixel",
            distance_of_sheets,
        ),
        sweep(
            "resolution",
            "pixels of a map across the scene",
            pixels_across,
        ),
        sweep("directions", "directions of the set", number_of_directions),
        sweep("scale", "size of the scene in units", scale_of_scene),
        sweep(
            "offset",
            "distance from the origin over size",
            offset_over_size,
        ),
        sweep(
            "lattice",
            "distance of the eye over the scene's size",
            eye_far_away,
        ),
        sweep("sliver", "length of a triangle over its width", aspect),
        sweep(
            "tiny",
            "size of triangles in pixels of a map",
            size_in_pixels,
        ),
    ]
}

/// A camera that looks at the origin along a normal, a little from aside.
fn facing(normal: Vertex, distance: f64) -> Vertex {
    let [u, v] = in_plane(normal);
    let aside = add(scale(u, 0.2), scale(v, -0.15));
    scale(normalize(add(normal, aside)), distance)
}

/// A plane by itself, ever nearer to a direction: nothing is in its way, and its own surface is
/// never met in maps that tell its slope apart.
fn angle() -> Vec<Step<LdmShot>> {
    let count = 16;
    let of = |(label, degrees): (String, f64)| {
        let set = directions(count).unwrap_or_default();
        let along = set[set.len() * 5 / 8];
        let [aside, _] = in_plane(along);
        let (sin, cos) = libm::sincos(f64::to_radians(degrees));
        let normal = add(scale(aside, cos), scale(along, sin));
        let shot = LdmShot {
            purpose: format!("a plane at {label} degrees from a direction"),
            eye: facing(normal, 4.0),
            seen: square([0.0; 3], 1.0, in_plane(normal)),
            directions: count,
            // Where a plane as steep as is told apart is still seen more than a pixel wide.
            resolution: 200,
            form: Form::Convex,
            ..LdmShot::default()
        };
        step(label, degrees, shot)
    };
    let whole = [
        90.0, 45.0, 20.0, 10.0, 5.0, 2.0, 1.0, 0.6, 0.5, 0.4, 0.2, 0.1,
    ];
    let steps = whole.map(|d| (format!("{d}"), d)).into_iter();
    steps
        .chain([-10, -14].map(power))
        .chain([("0".to_owned(), 0.0)])
        .map(of)
        .collect()
}

/// A ball by itself: nothing is in the way of any of its points.
fn faces_of_ball() -> Vec<Step<LdmShot>> {
    let of = |cuts: u32| {
        let seen = ball(cuts);
        let faces = seen.len();
        let shot = LdmShot {
            purpose: format!("a ball of {faces} faces"),
            eye: [1.4, 1.8, 2.4],
            seen,
            form: Form::Convex,
            ..LdmShot::default()
        };
        step(faces.to_string(), faces as f64, shot)
    };
    (0..=3).map(of).collect()
}

/// A surface with a box before it, ever steeper in the map of the pole, whose axes are those of the
/// scene; up to 127 keys a key slopes are told apart.
fn slope_of_surface() -> Vec<Step<LdmShot>> {
    let of = |(label, slope): (String, f64)| {
        let normal = normalize([slope, 0.0, 1.0]);
        let [u, v] = in_plane(normal);
        let raised = add(scale(normal, 0.25), scale(u, 0.2));
        let lid = rectangle(raised, [scale(u, 0.3), scale(v, 0.5)]);
        let shot = LdmShot {
            purpose: format!("a surface of slope {label} before a lid"),
            eye: facing(normal, 4.0),
            seen: square([0.0; 3], 1.0, [u, v]),
            hidden: [lid, cuboid(scale(normal, -0.4), [0.1; 3])].concat(),
            far: Some(0.9),
            ..LdmShot::default()
        };
        step(label, slope, shot)
    };
    let steps = (-4..=6).step_by(2).map(power);
    let limit = [120.0, 126.0, 127.0, 128.0].map(|s| (format!("{s}"), s));
    steps
        .chain(limit)
        .chain([8, 10, 14].map(power))
        .map(of)
        .collect()
}

/// A sheet that is not seen over half of a floor, ever nearer. Within half a pixel depth changes by
/// the slope times half a pixel, and a sheet is `1 / cos` times as far along a direction; so it is
/// told apart where `distance / half a pixel` is well beyond `|sin|` of the two axes.
fn distance_of_sheets() -> Vec<Step<LdmShot>> {
    let of = |(label, halves): (String, f64)| {
        // Both sheets' box is as good as flat.
        let half_pixel = libm::sqrt(8.0) / 64.0 / 2.0;
        let height = halves * half_pixel;
        let sheet = rectangle([-0.4, height, 0.0], [[0.6, 0.0, 0.0], [0.0, 0.0, -1.0]]);
        let shot = LdmShot {
            purpose: format!("sheets {label} halves of a pixel apart"),
            eye: [0.6, 3.6, 0.9],
            seen: floor(),
            hidden: sheet,
            form: Form::Sheets,
            ..LdmShot::default()
        };
        step(label, halves, shot)
    };
    let steps = (-6..=3).rev().map(power);
    steps
        .chain([-8, -10, -12, -14, -16].map(power))
        .map(of)
        .collect()
}

/// From fewer pixels than a map may have to more.
fn pixels_across() -> Vec<Step<LdmShot>> {
    let of = |pixels: u32| {
        let refused = (!(8..=724).contains(&pixels)).then_some("is outside 8 to 724");
        let shot = LdmShot {
            purpose: format!("{pixels} pixels across a comb of thin faces"),
            seen: comb(),
            directions: 16,
            resolution: pixels,
            refused,
            ..LdmShot::default()
        };
        step(pixels.to_string(), f64::from(pixels), shot)
    };
    [7, 8, 12, 25, 50, 100, 200, 362, 363, 400, 724, 725]
        .map(of)
        .to_vec()
}

/// From none to more than there may be.
fn number_of_directions() -> Vec<Step<LdmShot>> {
    let of = |count: u32| {
        let refused = (!(1..=4096).contains(&count)).then_some("is outside 1 to 4096");
        let shot = LdmShot {
            purpose: format!("{count} directions"),
            seen: room(),
            directions: count,
            resolution: 32,
            refused,
            ..LdmShot::default()
        };
        step(count.to_string(), f64::from(count), shot)
    };
    [0, 1, 4, 16, 32, 64, 128, 256, 512, 1024, 4096, 4097]
        .map(of)
        .to_vec()
}
