//! Stage `compose`: the picture.

use super::{Coarse, Colour, Gbuffer, Model, Parameters, Surface, same};
use crate::bound::{Bounded, Real, TINY};

/// Stage `compose`: the colour of each pixel, linear: the surface's colour times the sum of
/// direct light and of indirect light that is not blocked, A - B; `background` where nothing
/// is seen.
///
/// B is taken from one of the four pixels of the blurred buffer around the pixel: the
/// nearest that sees the same surface ([`same`]), else the nearest, by squared distance in
/// pixels, the first of equals row by row. Before the blur A is at least B wherever B has a
/// pixel, since B's terms are some of A's. After it B may come from neighbours that are
/// brighter than the pixel's whole A. A negative light would darken what the lamp lights
/// directly, and say nothing of the scene, so the difference is taken to be at least 0.
pub fn compose(
    model: &Model,
    seen: &Gbuffer,
    [direct, all]: [&[Colour]; 2],
    (coarse, blurred): (&Coarse, &[Colour]),
    parameters: &Parameters,
    background: [f32; 3],
) -> Vec<Colour> {
    let pixel = |pixel: usize| {
        let Some(surface) = &seen.surfaces[pixel] else {
            return background.map(|c| Bounded {
                value: f64::from(c),
                bound: TINY,
            });
        };
        let width = seen.size.width as usize;
        let at = [pixel % width, pixel / width];
        let blocked = blurred[nearest(model, coarse, surface, at, parameters)];
        let colour = model.colours[surface.triangle as usize];
        [0, 1, 2].map(|i| {
            let indirect = all[pixel][i].sub(blocked[i]).at_least(0.0);
            let light = direct[pixel][i].add(indirect);
            light.mul(Bounded::exact(f64::from(colour[i])))
        })
    };
    (0..seen.surfaces.len()).map(pixel).collect()
}

/// The pixel of buffer B from which a pixel of the picture takes.
fn nearest(
    model: &Model,
    coarse: &Coarse,
    surface: &Surface,
    [x, y]: [usize; 2],
    parameters: &Parameters,
) -> usize {
    let (divisor, width) = (parameters.divisor as usize, coarse.size.width as usize);
    let around = |at: usize, end: u32| {
        let first = at / divisor;
        first..=(first + 1).min(end as usize - 1)
    };
    let rows = around(y, coarse.size.height);
    let columns = around(x, coarse.size.width);
    let cells = rows.flat_map(|row| columns.clone().map(move |column| [column, row]));
    let ranked = cells.map(|[column, row]| {
        let cell = row * width + column;
        let other = coarse.surfaces[cell].as_ref();
        let belongs = other.is_some_and(|o| same(model, surface, o, parameters.edge));
        let (dx, dy) = (x.abs_diff(column * divisor), y.abs_diff(row * divisor));
        (!belongs, dx * dx + dy * dy, cell)
    });
    let (_, _, cell) = ranked.min().expect("a picture has pixels");
    cell
}
