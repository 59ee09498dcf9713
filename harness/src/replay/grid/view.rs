//! A grid as people look at it: along one axis, without perspective.

use triptych_spec::grid::Grid;
use triptych_spec::grid::axis::Axis;
use triptych_spec::grid::lattice::{Point, REACH};
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::Query;
use triptych_spec::scene::{Scene, Size};

pub(super) use size::MOST;
use size::{SIDE, sized};

/// Where the light is, seen from the picture: to the right, up, and towards the eye.
const LIGHT: [f64; 3] = [-0.5, 0.7, 1.0];

/// By how many lattice steps the way to the light starts before the surface, so that a surface
/// seldom shades itself. It decides what is shown, and judges nothing.
const OFF: i32 = 64;

/// What remains of a colour where the light is blocked.
const SHADE: f32 = 0.4;

/// Triangles and times: what one of the legs says of some rays.
pub(super) type Met = Vec<Option<(u32, f64)>>;

/// A direction of the picture: an axis of the lattice, and whether it runs backwards there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Along {
    axis: usize,
    back: bool,
}

/// The box of a grid, seen along the axis on which it is shortest, so that most of it shows:
/// its largest coordinates are nearest.
#[derive(Clone, Debug)]
pub(super) struct View<'a> {
    grid: &'a Grid,
    /// In pixels.
    pub(super) size: Size,
    right: Along,
    up: Along,
    depth: usize,
    /// Where rays start: the nearest boundary, or one in the middle of what is closed in front.
    near: i32,
}

/// Share of the columns that must list something in their front for a grid to count as closed,
/// as a house is from outside; and which part the front is.
const CLOSED: (f64, u32) = (0.9, 8);

impl<'a> View<'a> {
    /// `None` if even the smallest picture would take too long.
    pub(super) fn new(grid: &'a Grid) -> Option<Self> {
        let side = |axis: usize| {
            let [low, high] = ends(&grid.axes[axis]);
            f64::from(high) - f64::from(low)
        };
        let shortest = |a: usize, b: usize| if side(b) < side(a) { b } else { a };
        let depth = [2, 1, 0].into_iter().reduce(shortest).unwrap_or(2);
        let along = |axis, back| Along { axis, back };
        // y is up wherever it is seen, and what lies to the right would to the eye.
        let [right, up] = match depth {
            0 => [along(2, true), along(1, false)],
            1 => [along(0, false), along(2, true)],
            _ => [along(0, false), along(1, false)],
        };
        let mut view = Self {
            grid,
            size: sized([right, up].map(|along| side(along.axis)), SIDE),
            right,
            up,
            depth,
            near: ends(&grid.axes[depth])[1],
        };
        view = view.affordable()?;
        if view.is_closed() {
            let boundaries = grid.axes[depth].boundaries();
            view.near = boundaries[boundaries.len() / 2];
        }
        Some(view)
    }

    /// Whether there is nothing to see from outside but a front.
    fn is_closed(&self) -> bool {
        let (share, parts) = CLOSED;
        let cells = self.grid.axes[self.depth].cells();
        let front = cells - cells / parts;
        let listed = self.columns_of(|cell| cell[self.depth] >= front, u32::max);
        let full = listed.iter().filter(|list| **list > 0).count();
        cells >= parts && full as f64 > share * listed.len() as f64
    }

    /// Whether rays start inside the grid.
    pub(super) fn is_cut(&self) -> bool {
        self.near < ends(&self.grid.axes[self.depth])[1]
    }

    /// How a person would say it: `−z`.
    pub(super) fn direction(&self) -> &'static str {
        ["−x", "−y", "−z"][self.depth]
    }

    /// Middles of the pixels on the two axes, row by row from the top left.
    fn pixels(&self) -> impl Iterator<Item = [i32; 2]> {
        let middle = |along: Along, share: f64| {
            let [low, high] = ends(&self.grid.axes[along.axis]).map(f64::from);
            let share = if along.back { 1.0 - share } else { share };
            round(low + (high - low) * share)
        };
        let share = |n: u32, of: u32| (f64::from(n) + 0.5) / f64::from(of);
        let Size { width, height } = self.size;
        let rows = (0..height).map(move |y| middle(self.up, 1.0 - share(y, height)));
        rows.flat_map(move |up| (0..width).map(move |x| [middle(self.right, share(x, width)), up]))
    }

    /// The pixel that shows a point; `None` beside the grid.
    pub(super) fn pixel(&self, point: [f64; 3]) -> Option<usize> {
        let share = |along: Along| {
            let [low, high] = ends(&self.grid.axes[along.axis]).map(f64::from);
            let share = (point[along.axis] - low) / (high - low);
            let share = if along.back { 1.0 - share } else { share };
            (0.0..1.0).contains(&share).then_some(share)
        };
        let at = |share: f64, of: u32| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a share of the side"
            )]
            let at = (share * f64::from(of)) as usize;
            at
        };
        let (right, up) = (share(self.right)?, share(self.up)?);
        let Size { width, height } = self.size;
        let (x, y) = (at(right, width), at(1.0 - up, height));
        Some(y.min(height as usize - 1) * width as usize + x)
    }

    /// A ray for each pixel, row by row.
    fn rays(&self) -> Vec<Ray> {
        let ray = |[right, up]: [i32; 2]| {
            let (mut origin, mut direction) = ([self.near; 3], [0; 3]);
            origin[self.right.axis] = right;
            origin[self.up.axis] = up;
            direction[self.depth] = -1;
            Ray {
                origin,
                direction,
                segment: false,
            }
        };
        self.pixels().map(ray).collect()
    }

    /// From a point before a surface to the light.
    fn to_light(&self, mut from: Point) -> Ray {
        from[self.depth] = (from[self.depth] + OFF).min(REACH);
        let mut direction = [0.0; 3];
        let [right, up, near] = LIGHT;
        for (along, part) in [(self.right, right), (self.up, up)] {
            direction[along.axis] = if along.back { -part } else { part };
        }
        direction[self.depth] = near;
        Ray::along(from, direction)
    }

    /// What a leg sees: the colour of the first triangle of each ray, darker where the way to
    /// the light is blocked. `ask` is the leg.
    pub(super) fn seen<E>(
        &self,
        scene: &Scene,
        mut ask: impl FnMut(&[Ray], Query) -> Result<Met, E>,
    ) -> Result<Vec<[f32; 3]>, E> {
        let rays = self.rays();
        let first = ask(&rays, Query::Closest)?;
        let point = |(ray, met): (&Ray, &Option<(u32, f64)>)| {
            let (_, time) = (*met)?;
            let mut at = ray.origin;
            // The direction is a step long, so times are steps.
            at[self.depth] -= round(time);
            Some(self.to_light(at))
        };
        let to_light: Vec<Ray> = rays.iter().zip(&first).filter_map(point).collect();
        let mut blocked = ask(&to_light, Query::Any)?.into_iter();
        let colour = |met: &Option<(u32, f64)>| {
            let Some((prim, _)) = met else {
                return scene.background;
            };
            let lit = blocked.next().flatten().is_none();
            let colour = scene.triangles.get(*prim as usize).map(|t| t.colour);
            let [r, g, b, _] = colour.unwrap_or([f32::NAN; 4]);
            let part = if lit { 1.0 } else { SHADE };
            [r, g, b].map(|c| c * part)
        };
        Ok(first.iter().map(colour).collect())
    }

    /// A number for each pixel, of the lists of the cells behind each other there: folded by
    /// `fold` from 0.
    pub(super) fn columns(&self, fold: impl Fn(u32, u32) -> u32) -> Vec<u32> {
        self.columns_of(|_| true, fold)
    }

    /// The same of the cells of which this is true.
    fn columns_of(
        &self,
        is_of: impl Fn([u32; 3]) -> bool,
        fold: impl Fn(u32, u32) -> u32,
    ) -> Vec<u32> {
        let axes = &self.grid.axes;
        let cells = axes.each_ref().map(Axis::cells);
        let across = cells[self.right.axis] as usize;
        let mut columns = vec![0; across * cells[self.up.axis] as usize];
        let rows = (0..cells[2]).flat_map(|k| (0..cells[1]).map(move |j| [j, k]));
        for cell in rows.flat_map(|[j, k]| (0..cells[0]).map(move |i| [i, j, k])) {
            if !is_of(cell) {
                continue;
            }
            let at = cell[self.right.axis] as usize + across * cell[self.up.axis] as usize;
            let list = u32::try_from(self.grid.list(cell).len()).expect("at most ENTRIES_MAX");
            columns[at] = fold(columns[at], list);
        }
        let cell = |along: Along, at: i32| {
            let boundaries = axes[along.axis].boundaries();
            boundaries[1..boundaries.len() - 1].partition_point(|b| *b <= at)
        };
        let of =
            |[right, up]: [i32; 2]| columns[cell(self.right, right) + across * cell(self.up, up)];
        self.pixels().map(of).collect()
    }
}

/// The outermost boundaries.
fn ends(axis: &Axis) -> [i32; 2] {
    let boundaries = axis.boundaries();
    [boundaries[0], boundaries[boundaries.len() - 1]]
}

fn round(x: f64) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "saturates")]
    let integer = x.round() as i32;
    integer
}

mod size;
#[cfg(test)]
mod tests;
