//! Generators of closed surfaces.

use super::flat::circle;
use super::{Shape, check_radius};

/// A sphere, poles on the y axis.
pub(super) fn sphere(radius: f64, [down, around]: [u32; 2]) -> Result<Shape, String> {
    if down < 2 || around < 3 {
        return Err(format!(
            "segments = [{down}, {around}] must be at least [2, 3]"
        ));
    }
    check_radius("radius", radius)?;
    let (d, a) = (u128::from(down), u128::from(around));
    let mut shape = Shape::with((d - 1) * a + 2, 2 * a * (d - 1))?;
    let north = shape.vertex([0.0, radius, 0.0]);
    for ring in 1..down {
        let (sin, cos) = circle(ring, 2 * down);
        for segment in 0..around {
            let (s, c) = circle(segment, around);
            shape.vertex([radius * sin * c, radius * cos, radius * sin * s]);
        }
    }
    let south = shape.vertex([0.0, -radius, 0.0]);
    let number = |ring: u32, segment: u32| 1 + (ring - 1) * around + segment % around;
    for s in 0..around {
        shape
            .triangles
            .push([north, number(1, s + 1), number(1, s)]);
    }
    for ring in 1..down - 1 {
        for s in 0..around {
            let (upper, lower) = (number(ring, s), number(ring + 1, s));
            shape.quad([upper, number(ring, s + 1), number(ring + 1, s + 1), lower]);
        }
    }
    for s in 0..around {
        let last = down - 1;
        shape
            .triangles
            .push([south, number(last, s), number(last, s + 1)]);
    }
    Ok(shape)
}

/// A torus around the y axis.
pub(super) fn torus([ring, tube]: [f64; 2], [around, along]: [u32; 2]) -> Result<Shape, String> {
    if around < 3 || along < 3 {
        return Err(format!(
            "segments = [{around}, {along}] must be at least [3, 3]"
        ));
    }
    check_radius("radius of the ring", ring)?;
    check_radius("radius of the tube", tube)?;
    let vertices = u128::from(around) * u128::from(along);
    let mut shape = Shape::with(vertices, 2 * vertices)?;
    for i in 0..around {
        let (s, c) = circle(i, around);
        for j in 0..along {
            let (sin, cos) = circle(j, along);
            let from_axis = ring + tube * cos;
            shape.vertex([from_axis * c, tube * sin, from_axis * s]);
        }
    }
    let number = |i: u32, j: u32| (i % around) * along + j % along;
    for i in 0..around {
        for j in 0..along {
            let (here, next) = (number(i, j), number(i + 1, j));
            shape.quad([here, number(i, j + 1), number(i + 1, j + 1), next]);
        }
    }
    Ok(shape)
}

/// A box of 12 triangles, outward faces counter-clockwise.
pub(super) fn cuboid(size: [f64; 3]) -> Result<Shape, String> {
    let mut shape = Shape::with(8, 12)?;
    for corner in 0..8_u32 {
        let side = |axis: usize| match corner >> axis & 1 {
            0 => -size[axis] / 2.0,
            _ => size[axis] / 2.0,
        };
        shape.vertex([side(0), side(1), side(2)]);
    }
    let faces = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    for face in faces {
        shape.quad(face);
    }
    Ok(shape)
}
