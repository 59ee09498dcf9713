//! Triangles at random: needles, slivers, duplicates, triangles without area.

use super::{Generator, Random, Shape};
use crate::vector::{add, cross, dot, normalize, scale};

/// See [`Generator::Scatter`].
pub(super) fn scatter(generator: &Generator, random: &mut Random) -> Result<Shape, String> {
    let Generator::Scatter {
        count,
        extent,
        length,
        width,
        copies,
        flat,
    } = generator
    else {
        return Err("not a scatter".to_owned());
    };
    let different = u128::from(*count);
    let mut shape = Shape::with(3 * different, different * u128::from(*copies))?;
    for _ in 0..*count {
        let centre = extent.0.map(|side| side / 2.0 * random.signed());
        let (along, across) = axes(*flat, random);
        // Where the altitude's foot lies on the longest edge: between the ends, so
        // that it stays the longest.
        let foot = random.unit() - 0.5;
        let ends = [-0.5, 0.5].map(|s| add(centre, scale(along, s * length.0)));
        let apex = add(
            add(centre, scale(along, foot * length.0)),
            scale(across, width.0),
        );
        let corners = [ends[0], ends[1], apex].map(|p| shape.vertex(p));
        shape.triangles.push(corners);
    }
    let once = shape.triangles.clone();
    for _ in 1..*copies {
        shape.triangles.extend_from_slice(&once);
    }
    Ok(shape)
}

/// Two perpendicular unit vectors in a random plane, or in the xy plane.
fn axes(flat: bool, random: &mut Random) -> ([f64; 3], [f64; 3]) {
    let along = direction(flat, random);
    let normal = match flat {
        true => [0.0, 0.0, 1.0],
        false => loop {
            let other = direction(false, random);
            let normal = cross(along, other);
            if dot(normal, normal) > 0.01 {
                break normalize(normal);
            }
        },
    };
    (along, cross(normal, along))
}

/// Uniform on the sphere, or on the circle in the xy plane: points of the cube
/// that lie in the ball (von Neumann), which it fills to more than a half.
fn direction(flat: bool, random: &mut Random) -> [f64; 3] {
    loop {
        let z = if flat { 0.0 } else { random.signed() };
        let v = [random.signed(), random.signed(), z];
        if (0.01..=1.0).contains(&dot(v, v)) {
            return normalize(v);
        }
    }
}
