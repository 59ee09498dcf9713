//! Means over pixels of the same surface.

use triptych_gpu::hbao::Settings;
use triptych_spec::ldm::Falloff;
use triptych_spec::scene::Size;

use super::scenes::{Eye, Shape, V, dot, plus, unit};
use super::{openness, settings};

/// Of the picture.
const SIZE: [usize; 2] = [50, 40];

/// The shape that a pixel is on, its point and its normal.
type Seen = (usize, V, V);

/// A corner, and a ball in front of it.
fn shapes() -> [Shape; 3] {
    let wall = |up: f64| {
        let normal = unit([0.0, up, -1.0]);
        Shape::Half {
            normal,
            at: normal[2] * 1000.0,
        }
    };
    let ball = Shape::Ball {
        centre: [100.0, 60.0, 500.0],
        radius: 150.0,
    };
    [wall(-1.0), wall(1.0), ball]
}

fn seen(eye: &Eye, pixel: usize) -> Seen {
    let shapes = shapes();
    let (point, normal) = eye.sees(&shapes, pixel).expect("planes are everywhere");
    let lies = |shape: &Shape| match shape {
        Shape::Half { normal, at } => (dot(*normal, point) - at).abs() < 1e-6,
        _ => true,
    };
    (
        shapes.iter().position(lies).expect("the ball at last"),
        point,
        normal,
    )
}

/// What one pixel takes of another, so far off.
fn weight(a: &Seen, b: &Seen, off: [usize; 2]) -> f64 {
    let way = plus(b.1, a.1, -1.0);
    let long = dot(way, way).sqrt().max(1e-9);
    let apart = dot(a.2, way).abs().max(dot(b.2, way).abs()) / long;
    let ends = off.map(|by| if by == 2 { 0.5 } else { 1.0 });
    match dot(a.2, b.2) > 0.0 {
        true => ends[0] * ends[1] * (1.0 - 4.0 * apart).max(0.0),
        false => 0.0,
    }
}

/// A pixel's mean, and how many of those around it are on another shape.
fn mean(all: &[Seen], of: &[f32], pixel: usize) -> (f64, usize) {
    let [width, height] = SIZE;
    let [x, y] = [pixel % width, pixel / width];
    let (mut sum, mut total, mut across) = (0.0, 0.0, 0);
    for row in y.max(2) - 2..height.min(y + 3) {
        for column in x.max(2) - 2..width.min(x + 3) {
            let other = width * row + column;
            let (own, there) = (&all[pixel], &all[other]);
            let weight = weight(own, there, [column.abs_diff(x), row.abs_diff(y)]);
            // Neither plane takes from the other.
            let corner = own.0 + there.0 == 1;
            assert!(weight == 0.0 || !corner, "pixel {pixel} takes from {other}");
            across += usize::from(own.0 != there.0);
            sum += weight * f64::from(of[other]);
            total += weight;
        }
    }
    (sum / total, across)
}

/// Each pixel's mean by the definition, of what the adapter found without it.
#[test]
fn means_are_of_the_same_surface() {
    let eye = Eye {
        size: Size {
            width: 50,
            height: 40,
        },
        near: false,
        scale: 0.06,
    };
    let all: Vec<Seen> = (0..2000).map(|pixel| seen(&eye, pixel)).collect();
    let screen = eye.screen(&shapes());
    let plain = settings(
        Falloff::Distance {
            most: 300,
            power: 1,
        },
        2,
        8,
    );
    let made = [0, 1, 2].map(|denoise| openness(&screen, Settings { denoise, ..plain }));
    // Weights are off by roundings of points, 64 of a distance of at most 80 pixels, four
    // times; what they weigh lies within 1 of each other.
    let bound = 4.0 * 64.0 * 80.0 / 16_777_216.0;
    for two in made.windows(2) {
        for ((name, rough), (_, smooth)) in two[0].iter().zip(&two[1]) {
            let mut across = 0;
            for (pixel, smooth) in smooth.iter().enumerate() {
                let (mean, others) = mean(&all, rough, pixel);
                let off = (f64::from(*smooth) - mean).abs();
                assert!(off < bound, "{name} pixel {pixel}: {smooth} for {mean}");
                across += others;
            }
            assert!(across > 500, "{across} neighbours across an edge");
        }
    }
}
