//! Scenes whose light is known.

use triptych_spec::camera::{Camera, Projection};
use triptych_spec::grid::lattice::Lattice;
use triptych_spec::rsm::{Frame, Lamp, Model, Parameters, View};
use triptych_spec::scene::Size;

use super::{Scene, quad, rows};

const LATTICE: Lattice = Lattice {
    centre: [0.0; 3],
    exponent: 0,
};

/// Steps from a lamp at which its strength is what it is.
const REFERENCE: u32 = 1 << 20;

fn square(side: u32) -> Size {
    Size {
        width: side,
        height: side,
    }
}

/// Looks along y from a height, up or down.
fn vertical(from: i32, way: f64, near: f64, projection: Projection, size: Size) -> View {
    let camera = Camera {
        eye: [0.0, f64::from(from), 0.0],
        target: [0.0, f64::from(from) + way, 0.0],
        up: [0.0, 0.0, 1.0],
        projection,
        near,
        far: f64::from(1 << 23),
    };
    View::new(&camera, &LATTICE, size).expect("a view")
}

fn orthographic(height: i32) -> Projection {
    let height = f64::from(height);
    Projection::Orthographic { height }
}

/// A square at some height around the y axis.
fn tile(half: i32, y: i32) -> [[[i32; 3]; 3]; 2] {
    quad([
        [-half, y, -half],
        [half, y, -half],
        [half, y, half],
        [-half, y, half],
    ])
}

fn scene(
    tiles: &[[[[i32; 3]; 3]; 2]],
    colour: f32,
    eye: View,
    light: View,
    blockers: &[[[[i32; 3]; 3]; 2]],
) -> Scene {
    let corners = |tiles: &[[[[i32; 3]; 3]; 2]]| tiles.concat().concat();
    let triangles = 2 * tiles.len();
    let model = Model::new(
        corners(tiles),
        rows(triangles),
        vec![[colour; 3]; triangles],
    );
    let parameters = Parameters {
        radius: 64,
        stride: 1,
        divisor: 1,
        blur: 0,
        bias: 1 << 16,
        clamp: 1,
        offset: 2,
        edge: 16,
    };
    let scene = Scene {
        model: model.expect("within the limits"),
        eye,
        lamp: Lamp::new(light, [1.0, 2.0, 0.5], REFERENCE).expect("a lamp"),
        blockers: triptych_spec::grid::Blockers::default(),
        grid: super::Grid::build(
            &super::Blockers::default(),
            super::Resolution::FromScene,
            super::Membership::Box,
        )
        .expect("an empty grid"),
        parameters,
    };
    scene.with(corners(blockers))
}

/// Form factor of a rectangle `0..x, 0..z` at distance 1, seen from a parallel plane right
/// above its corner at 0: irradiance over what the rectangle sends out (Siegel and Howell,
/// configuration B-3), odd in both.
fn corner(x: f64, z: f64) -> f64 {
    let part = |a: f64, b: f64| {
        let root = (1.0 + a * a).sqrt();
        a / root * (b / root).atan()
    };
    (part(x, z) + part(z, x)) / std::f64::consts::TAU
}

/// A small patch on the floor, lit from above, and a ceiling that only it lights.
///
/// Each texel stands for a square of side `s` of the patch by the value in its middle. The
/// form factor's density `h^2 / (pi (h^2 + r^2)^2)` has second derivatives of at most
/// `4 / (pi h^4)` in both directions, so a texel is off by at most `s^4 / 24` times both,
/// and the patch of side `a` by `a^2 s^2 / (3 pi h^4)`.
#[test]
fn patch() {
    let (a, s, h) = (1 << 20, 1 << 17, 1 << 21);
    // The light and the eye are between floor and ceiling: each sees one of them.
    let light = vertical(h / 2, -1.0, 0.0, orthographic(16 * s), square(16));
    let eye = vertical(h / 4, 1.0, 0.0, orthographic(4 * h), square(9));
    let colour = 0.75;
    let scene = scene(&[tile(a / 2, 0), tile(2 * h, h)], colour, eye, light, &[]);
    let frame = scene.frame();
    let mut least = f64::INFINITY;
    let mut most: f64 = 0.0;
    for (pixel, all) in frame.all.iter().enumerate() {
        let point = frame.seen.surfaces[pixel].expect("the ceiling").point;
        // Both points were moved towards each other.
        let height = f64::from(point[1] - 2);
        let [x, z] = [point[0], point[2]].map(f64::from);
        let ends = |at: f64| [-1.0_f64, 1.0].map(|sign| (sign * f64::from(a / 2) - at) / height);
        let ([x0, x1], [z0, z1]) = (ends(x), ends(z));
        let factor = corner(x1, z1) - corner(x0, z1) - corner(x1, z0) + corner(x0, z0);
        let [a, s] = [a, s].map(f64::from);
        let off = a * a * s * s / (3.0 * std::f64::consts::PI * height.powi(4));
        for (channel, strength) in all.iter().zip([1.0, 2.0, 0.5]) {
            let sent = strength * f64::from(colour);
            let error = (channel.value - sent * factor).abs();
            assert!(
                error <= off * sent + channel.bound,
                "{error:e} at {point:?}, {off:e} is allowed"
            );
            most = most.max(error / (off * sent));
        }
        least = least.min(factor);
    }
    assert!(
        least > 0.0 && most > 1e-2,
        "a bound that is never nearly reached says little: {most}"
    );
}

/// A ceiling's point right above a blocker sees none of the patch; one whose segments all
/// pass beside it, all of it.
#[test]
fn umbra() {
    let (a, s, h) = (1 << 20, 1 << 17, 1 << 21);
    let light = vertical(h / 2, -1.0, 0.0, orthographic(16 * s), square(16));
    let eye = vertical(3 * h / 4, 1.0, 0.0, orthographic(4 * h), square(9));
    let tiles = [tile(a / 2, 0), tile(2 * h, h)];
    // Half way up, as large as the patch: segments to x pass it at x / 2 +- a / 4.
    let scene = scene(&tiles, 1.0, eye, light, &[tile(a / 2, h / 2)]);
    let frame = scene.frame();
    let (mut dark, mut bright) = (0, 0);
    for (pixel, all) in frame.all.iter().enumerate() {
        let point = frame.seen.surfaces[pixel].expect("the ceiling").point;
        let reach = point[0].abs().max(point[2].abs());
        let blocked = frame.blocked.light[pixel];
        if reach < a / 2 {
            dark += 1;
            assert_eq!(blocked, *all, "in the umbra");
            let direct = frame.picture[pixel][0].value;
            assert_eq!(direct, 0.0, "nothing else lights the ceiling");
        } else if reach > 3 * a / 2 + 8 {
            bright += 1;
            assert_eq!(blocked, triptych_spec::rsm::DARK, "beside it");
        }
    }
    assert!(dark > 0 && bright > 0, "both are seen");
}

/// What all texels of a map are weighed sums up to the light that goes through it: the area
/// of a directional light's, the solid angle of a spot light's `4 asin(sin^2 (fov / 2))`.
///
/// The midpoint rule's error is at most `s^4 / 24` times both second derivatives of
/// `(1 + x^2 + y^2)^(-3/2)`, at most 3 each, for each of the `(2 t / s)^2` texels of side
/// `s`, `t` the tangent of half the angle.
#[test]
fn through_the_map() {
    let total = |projection, size: Size| {
        let lamp = Lamp::new(
            vertical(0, -1.0, 1.0, projection, size),
            [1.0; 3],
            REFERENCE,
        );
        let lamp = lamp.expect("a lamp");
        let weights = (0..size.pixels()).map(|texel| lamp.weight(texel, 1));
        weights.sum::<f64>() * std::f64::consts::PI
    };
    let wide = Size {
        width: 24,
        height: 8,
    };
    let area = total(orthographic(800), wide);
    assert!((area / (2400.0 * 800.0) - 1.0).abs() < 1e-14, "{area}");
    for fov in [20.0_f64, 60.0, 90.0] {
        let (n, half) = (32.0, fov.to_radians() / 2.0);
        let t = half.tan();
        let s = 2.0 * t / n;
        let sum = total(Projection::Perspective { fov }, square(32)) / f64::from(REFERENCE).powi(2);
        let angle = 4.0 * (half.sin() * half.sin()).asin();
        let room = n * n * s.powi(4) / 24.0 * 6.0;
        let error = (sum - angle).abs();
        assert!(
            error <= room && error > room / 1000.0,
            "{sum}, {angle} expected within {room}"
        );
    }
}

/// The floor under a lamp: `strength cos^4` times (reference / height)^2 from a spot light,
/// strength from a directional one; none in the shadow of a tile above.
#[test]
fn under_a_lamp() {
    let h = 1 << 21;
    let shade = tile(h / 8, h / 2);
    let eye = vertical(h / 4, -1.0, 0.0, orthographic(h), square(9));
    for (projection, spot) in [
        (orthographic(2 * h), false),
        (Projection::Perspective { fov: 90.0 }, true),
    ] {
        // Near enough for keys of floor and tile to differ by far more than the bias.
        let light = vertical(h, -1.0, f64::from(h / 8), projection, square(64));
        let frame: Frame = scene(&[tile(h, 0), shade], 1.0, eye, light, &[]).frame();
        let (mut lit, mut dark) = (0, 0);
        for (pixel, direct) in frame.direct.light.iter().enumerate() {
            let [x, y, z] = frame.seen.surfaces[pixel]
                .expect("the floor")
                .point
                .map(f64::from);
            assert_eq!(y, 2.0, "two steps above");
            // From a spot light, the shadow is twice the tile; texels are h / 32.
            let reach = x.abs().max(z.abs()) / if spot { 2.0 } else { 1.0 };
            let edge = f64::from(h / 8);
            let texel = f64::from(h / 32);
            let height = f64::from(h) - y;
            let square = x * x + z * z + height * height;
            let factor = match spot {
                true => height / square.sqrt() * f64::from(REFERENCE).powi(2) / square,
                false => 1.0,
            };
            if frame.direct.lit[pixel] {
                lit += 1;
                assert!(reach > edge - texel, "{x} {z}");
                assert!((direct[1].value - 2.0 * factor).abs() <= 1e-6 * factor);
                assert!(direct[1].admits(2.0 * factor));
            } else {
                dark += 1;
                assert!(reach < edge + texel, "{x} {z}");
            }
        }
        assert!(lit > 0 && dark > 0, "{lit} lit, {dark} dark");
    }
}
