//! Stage `place`: where in the light's map each point of the eye's lies.

use super::{Gbuffer, View};
use crate::bound::Real;
use crate::grid::lattice::Point;
use crate::vertex::{DEPTH_ONE, grid_position, viewport};

/// Largest number of a texel that a point has, in x and y, to either side; beyond it, no
/// kernel reaches the map, and which texel it is makes no difference.
pub const PLACE_MAX: i32 = 1 << 20;

/// Where a point lies in a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Column and row of a texel, also beyond the map.
    pub texel: [i32; 2],
    /// Depth key, 0 before the light's near plane, [`DEPTH_ONE`] beyond its far plane.
    pub key: u32,
}

/// A point in a view, before it is rounded: columns, rows, and depth in keys. `None` for
/// what is not in front of a perspective.
pub fn project<T: Real>(view: &View, point: Point) -> Option<[T; 3]> {
    let [x, y, z] = point.map(f64::from);
    let rows = viewport(view.size).times(&view.matrix).rows;
    let position = rows.map(|row| T::sum_of_products(row, [x, y, z, 1.0]));
    (position[3].value() > 0.0).then(|| grid_position(position, 0))
}

/// Stage `place`: the texel and the depth key of each point, in the light's view.
///
/// Both are rounded down, once; the shadow test and the place of the kernel are decided on
/// them. An evaluation in `f32` may take a neighbour where a floor lies within the bound of
/// [`project`]; later stages are compared from these.
pub fn place(light: &View, seen: &Gbuffer) -> Vec<Option<Place>> {
    let surfaces = seen.surfaces.iter();
    surfaces.map(|s| at(light, s.as_ref()?.point)).collect()
}

fn at(light: &View, point: Point) -> Option<Place> {
    let [x, y, z] = project::<f64>(light, point)?;
    #[expect(clippy::cast_possible_truncation, reason = "clamped")]
    let clamped =
        |c: f64, low: i32, high: i32| libm::floor(c).clamp(f64::from(low), f64::from(high)) as i32;
    let texel = [x, y].map(|c| clamped(c, -PLACE_MAX, PLACE_MAX));
    let key = clamped(z, 0, DEPTH_ONE).cast_unsigned();
    Some(Place { texel, key })
}
