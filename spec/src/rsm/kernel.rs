//! Which texels light a pixel, and how much one of them gives.

use super::{Colour, Light, Model, Parameters, Surface};
use crate::bound::{Bounded, Real, U, gamma};
use crate::grid::exact::minus;
use crate::grid::lattice::Point;
use crate::scene::Size;

/// The texels of the kernel around a place that belong to a map: each one's number in the
/// kernel, and in the map. Row by row; texels beyond the map's border are left out.
pub fn texels(
    parameters: &Parameters,
    [x, y]: [i32; 2],
    map: Size,
) -> impl Iterator<Item = (usize, usize)> {
    let side = parameters.side();
    let (radius, stride) = (
        parameters.radius.cast_signed(),
        parameters.stride.cast_signed(),
    );
    let inside = move |at: i32, step: u32, most: u32| {
        let texel = at + (step.cast_signed() - radius) * stride;
        u32::try_from(texel).ok().filter(|texel| *texel < most)
    };
    (0..side).flat_map(move |j| {
        let row = inside(y, j, map.height);
        // Rows beyond the border have no columns to try.
        let columns = if row.is_some() { 0..side } else { 0..0 };
        columns.filter_map(move |i| {
            let (row, column) = (row?, inside(x, i, map.width)?);
            let texel = row as usize * map.width as usize + column as usize;
            Some((j as usize * side as usize + i as usize, texel))
        })
    })
}

/// Whether a surface and another's point face each other: `n . (to - from) > 0` for the
/// normal on the side that is seen, exactly. A point was moved off its own face to that
/// side, so a segment from it to whatever it faces never meets the plane of the face. It is
/// a triple product of lattice differences, as those that a ray is judged by.
pub fn faces(model: &Model, from: &Surface, to: Point) -> bool {
    let along = model.face(from.triangle).along(minus(to, from.point));
    along.signum() == i128::from(from.side)
}

/// What a texel gives to a surface in free space: irradiance, `None` if either is turned
/// away from the other.
///
/// With `d` from the surface's point to the texel's, `p = n . d`, `q = n_t . -d` and
/// `D = max(|d|^2, clamp)` it is `(p / D) (q / D)` times the texel's intensity (Dachsbacher
/// and Stamminger 2005, equation 1). Differences are exact in `f32`, normals and intensity
/// are given; a kernel takes 0 for a `p` or `q` that its rounding made negative. An
/// evaluation as `p q / (D D)` meets fewer roundings, and stays inside as well.
pub fn term(model: &Model, to: &Surface, light: &Light, clamp: u64) -> Option<Colour> {
    let source = &light.surface;
    if !(faces(model, to, source.point) && faces(model, source, to.point)) {
        return None;
    }
    let d = minus(source.point, to.point);
    let p = projected(model, to, d);
    let q = projected(model, source, d.map(|c| -c));
    let distance = squared(d, clamp);
    let geometry = p.div(distance).mul(q.div(distance));
    Some(
        light
            .intensity
            .map(|c| geometry.mul(Bounded::exact(f64::from(c)))),
    )
}

/// A difference along the unit normal on the side that is seen, not negative.
pub(crate) fn projected(model: &Model, surface: &Surface, d: Point) -> Bounded {
    let side = f64::from(surface.side);
    let unit = model.face(surface.triangle).unit;
    dot(unit.map(|c| side * f64::from(c)), d).at_least(0.0)
}

/// The squared length of a difference, or `least` if that is more. The larger of the two is
/// rounded to `f32` in either case.
pub(crate) fn squared(d: Point, least: u64) -> Bounded {
    let length = dot(d.map(f64::from), d);
    // Up to 3 * 2^48, which `f64` holds; a kernel has it rounded once.
    let least = least as f64;
    Bounded {
        value: length.value.max(least),
        bound: length.bound.max(U * least),
    }
}

/// Numbers that `f32` holds times integers that it holds. A term meets its product and two
/// additions, fused or in any order. Nothing is flushed: components of unit normals that
/// are not 0 are above 2^-50, so all products and sums are multiples of 2^-74.
fn dot(a: [f64; 3], d: Point) -> Bounded {
    let terms = [0, 1, 2].map(|i| a[i] * f64::from(d[i]));
    Bounded {
        value: terms[0] + terms[1] + terms[2],
        bound: gamma(3) * (terms[0].abs() + terms[1].abs() + terms[2].abs()),
    }
}
