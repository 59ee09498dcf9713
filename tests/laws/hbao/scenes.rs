//! Planes and balls, seen and met by rays in closed form.

use triptych_gpu::hbao::{Pixel, Screen};
use triptych_spec::ldm::Falloff;
use triptych_spec::scene::Size;

/// A vector in view space: x right, y down, z away from the viewer.
pub type V = [f64; 3];

pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn plus(a: V, b: V, times: f64) -> V {
    [0, 1, 2].map(|i| a[i] + times * b[i])
}

pub fn unit(a: V) -> V {
    a.map(|c| c / dot(a, a).sqrt())
}

/// Two units at right angles to a unit and to each other.
pub fn around(n: V) -> [V; 2] {
    let least = (0..3).min_by(|i, j| n[*i].abs().total_cmp(&n[*j].abs()));
    let mut axis = [0.0; 3];
    axis[least.expect("three")] = 1.0;
    let a = unit(plus(axis, n, -dot(axis, n)));
    let b = [
        n[1] * a[2] - n[2] * a[1],
        n[2] * a[0] - n[0] * a[2],
        n[0] * a[1] - n[1] * a[0],
    ];
    [a, b]
}

/// What light does not go through.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// All `p` with `normal . p <= at`; a unit.
    Half {
        normal: V,
        at: f64,
    },
    Ball {
        centre: V,
        radius: f64,
    },
    /// A ball, and all that is behind it as seen along z.
    Post {
        centre: V,
        radius: f64,
    },
}

impl Shape {
    /// Where a ray first enters, and the normal there.
    fn met(self, from: V, way: V) -> Option<(f64, V)> {
        match self {
            Self::Half { normal, at } => {
                let towards = dot(normal, way);
                let t = (at - dot(normal, from)) / towards;
                (towards < 0.0 && t > 0.0).then_some((t, normal))
            }
            Self::Ball { centre, radius } => {
                let t = entered(plus(from, centre, -1.0), way, radius)?;
                let off = plus(plus(from, way, t), centre, -1.0);
                Some((t, unit(off)))
            }
            Self::Post { centre, radius } => {
                let ball = Self::Ball { centre, radius }.met(from, way);
                let flat = |p: V| [p[0], p[1], 0.0];
                let off = flat(plus(from, centre, -1.0));
                let side = entered(off, flat(way), radius).and_then(|t| {
                    let p = plus(from, way, t);
                    let normal = unit(flat(plus(p, centre, -1.0)));
                    (p[2] > centre[2]).then_some((t, normal))
                });
                let first = |a: (f64, V), b: (f64, V)| if b.0 < a.0 { b } else { a };
                ball.into_iter().chain(side).reduce(first)
            }
        }
    }
}

/// When a point that moves so enters a ball around the origin.
fn entered(off: V, way: V, radius: f64) -> Option<f64> {
    let (a, b) = (dot(way, way), dot(off, way));
    let root = b * b - a * (dot(off, off) - radius * radius);
    let t = (-b - root.max(0.0).sqrt()) / a;
    (root > 0.0 && t > 0.0).then_some(t)
}

/// The first of all shapes.
pub fn first(shapes: &[Shape], from: V, way: V) -> Option<(f64, V)> {
    let met = shapes.iter().filter_map(|shape| shape.met(from, way));
    met.reduce(|a, b| if b.0 < a.0 { b } else { a })
}

/// Who looks.
#[derive(Clone, Copy, Debug)]
pub struct Eye {
    pub size: Size,
    pub near: bool,
    /// Pixels of a step, for a perspective at depth 1.
    pub scale: f64,
}

impl Eye {
    /// Of so many pixels a side.
    pub fn square(side: u32, near: bool, scale: f64) -> Self {
        let size = Size {
            width: side,
            height: side,
        };
        Self { size, near, scale }
    }

    /// From where, and which way, a pixel looks; one step along z at a time.
    pub fn ray(&self, pixel: usize) -> (V, V) {
        let width = self.size.width as usize;
        let half = [self.size.width, self.size.height].map(|side| f64::from(side) / 2.0);
        let x = ((pixel % width) as f64 + 0.5 - half[0]) / self.scale;
        let y = ((pixel / width) as f64 + 0.5 - half[1]) / self.scale;
        match self.near {
            true => ([0.0; 3], [x, y, 1.0]),
            false => ([x, y, 0.0], [0.0, 0.0, 1.0]),
        }
    }

    /// Point and normal of what each pixel sees.
    pub fn sees(&self, shapes: &[Shape], pixel: usize) -> Option<(V, V)> {
        let (from, way) = self.ray(pixel);
        let (t, normal) = first(shapes, from, way)?;
        Some((plus(from, way, t), normal))
    }

    pub fn screen(&self, shapes: &[Shape]) -> Screen {
        let pixel = |pixel: usize| match self.sees(shapes, pixel) {
            None => Pixel::NOTHING,
            Some((point, normal)) => Pixel {
                normal: normal.map(rounded),
                depth: rounded(point[2]),
            },
        };
        Screen {
            size: self.size,
            near: self.near,
            scale: [rounded(self.scale); 2],
            pixels: (0..self.size.pixels()).map(pixel).collect(),
        }
    }
}

pub fn rounded(c: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
    let c = c as f32;
    c
}

/// What a hit at a distance keeps away.
pub fn kept(falloff: Falloff, distance: f64) -> f64 {
    match falloff {
        Falloff::None => 1.0,
        Falloff::Distance { most, power } => {
            let part = distance / f64::from(most);
            match power {
                _ if part >= 1.0 => 0.0,
                0 => 1.0,
                _ => 1.0 - part.powi(power.cast_signed()),
            }
        }
    }
}

/// What is open over a point by `count` squared rays, one in the middle of each part of the
/// hemisphere's disc: of each ring's area by each part of the turn.
pub fn traced(shapes: &[Shape], point: V, normal: V, falloff: Falloff, count: u32) -> f64 {
    let [a, b] = around(normal);
    let mut open = 0.0;
    for i in 0..count {
        let square = (f64::from(i) + 0.5) / f64::from(count);
        let (sine, cosine) = (square.sqrt(), (1.0 - square).sqrt());
        for j in 0..count {
            let turn = (f64::from(j) + 0.5) / f64::from(count) * std::f64::consts::TAU;
            let flat = plus(a.map(|c| c * turn.cos()), b, turn.sin());
            let way = plus(normal.map(|c| c * cosine), flat, sine);
            let from = plus(point, normal, 1e-6);
            let met = first(shapes, from, way).map_or(0.0, |(t, _)| kept(falloff, t));
            open += 1.0 - met;
        }
    }
    open / f64::from(count) / f64::from(count)
}
