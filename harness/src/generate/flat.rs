//! Generators of flat things: faces as written, stacks, fans, grids.

use super::{Order, Random, Shape, check_radius};
use crate::scene::value::Point;

/// The polygons as written.
pub(super) fn faces(vertices: &[Point], faces: &[Vec<u32>]) -> Result<Shape, String> {
    let corners: u128 = faces.iter().map(|f| f.len() as u128).sum();
    let mut shape = Shape::with(vertices.len() as u128, corners)?;
    shape.vertices = vertices.iter().map(|p| p.0).collect();
    for (number, face) in faces.iter().enumerate() {
        if face.len() < 3 {
            return Err(format!(
                "face {number} has {} corners, not 3 or more",
                face.len()
            ));
        }
        if let Some(corner) = face.iter().find(|c| **c as usize >= vertices.len()) {
            let n = vertices.len();
            return Err(format!("face {number} names vertex {corner} of {n}"));
        }
        let fan = face[1..].windows(2).map(|w| [face[0], w[0], w[1]]);
        shape.triangles.extend(fan);
    }
    Ok(shape)
}

/// Quads one behind the other.
pub(super) fn stack(
    layers: u32,
    [width, height]: [f64; 2],
    spacing: f64,
    order: Order,
    random: &mut Random,
) -> Result<Shape, String> {
    let mut shape = Shape::with(4 * u128::from(layers), 2 * u128::from(layers))?;
    let mut depths: Vec<u32> = (0..layers).collect();
    match order {
        Order::FrontToBack => {}
        Order::BackToFront => depths.reverse(),
        // Fisher and Yates: every order is equally likely.
        Order::Shuffled => {
            for last in (1..depths.len()).rev() {
                depths.swap(last, random.below(last + 1));
            }
        }
    }
    let (x, y) = (width / 2.0, height / 2.0);
    for depth in depths {
        let z = -f64::from(depth) * spacing;
        let corners = [[-x, -y, z], [x, -y, z], [x, y, z], [-x, y, z]];
        let quad = corners.map(|c| shape.vertex(c));
        shape.quad(quad);
    }
    Ok(shape)
}

/// Triangles around a hub.
pub(super) fn fan(spokes: u32, radius: f64, hub: f64) -> Result<Shape, String> {
    if spokes < 3 {
        return Err(format!(
            "spokes = {spokes} does not close a circle; 3 or more do"
        ));
    }
    check_radius("radius", radius)?;
    let mut shape = Shape::with(u128::from(spokes) + 1, spokes.into())?;
    let centre = shape.vertex([0.0, 0.0, hub]);
    for spoke in 0..spokes {
        let (sin, cos) = circle(spoke, spokes);
        shape.vertex([radius * cos, radius * sin, 0.0]);
    }
    let rim = |spoke: u32| 1 + spoke % spokes;
    shape.triangles = (0..spokes).map(|s| [centre, rim(s), rim(s + 1)]).collect();
    Ok(shape)
}

/// A rectangle of cells.
pub(super) fn grid(
    [columns, rows]: [u32; 2],
    [width, height]: [f64; 2],
    [jitter, relief]: [f64; 2],
    random: &mut Random,
) -> Result<Shape, String> {
    // With every vertex moved by at most j cells along either axis, twice a
    // triangle's area is at least (1 - 2j)^2 - (2j)^2 = 1 - 4j cells.
    if !(0.0..0.25).contains(&jitter) {
        return Err(format!("jitter = {jitter} is outside 0 to 0.25"));
    }
    let (across, down) = (u128::from(columns) + 1, u128::from(rows) + 1);
    let cells = 2 * u128::from(columns) * u128::from(rows);
    let mut shape = Shape::with(across * down, cells)?;
    for row in 0..=rows {
        for column in 0..=columns {
            let inner = column % columns != 0 && row % rows != 0;
            let stray = if inner { jitter } else { 0.0 };
            let x = f64::from(column) - f64::from(columns) / 2.0 + stray * random.signed();
            let y = f64::from(row) - f64::from(rows) / 2.0 + stray * random.signed();
            let z = relief * random.signed();
            shape.vertex([x * width, y * height, z]);
        }
    }
    let number = |column: u32, row: u32| row * (columns + 1) + column;
    for row in 0..rows {
        for column in 0..columns {
            let (right, above) = (column + 1, row + 1);
            shape.quad([
                number(column, row),
                number(right, row),
                number(right, above),
                number(column, above),
            ]);
        }
    }
    Ok(shape)
}

/// Sine and cosine of `i / n` of a circle, exact at its quarters.
pub(super) fn circle(i: u32, n: u32) -> (f64, f64) {
    match 4 * u128::from(i) % u128::from(n) {
        0 => match 4 * u128::from(i) / u128::from(n) % 4 {
            0 => (0.0, 1.0),
            1 => (1.0, 0.0),
            2 => (0.0, -1.0),
            _ => (-1.0, 0.0),
        },
        _ => libm::sincos(std::f64::consts::TAU * f64::from(i) / f64::from(n)),
    }
}
