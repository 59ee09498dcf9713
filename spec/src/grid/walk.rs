//! Which cells a ray passes, in order.
//!
//! Three-dimensional digital differential analysis (Amanatides and Woo 1987) with integer
//! cells, and the time of the next boundary worked out anew at each step instead of
//! accumulated. Times are compared as fractions, hence exactly.

use super::Grid;
use super::exact::Time;
use super::ray::Ray;

/// When a ray crosses a boundary: `num / den`, not before it starts.
#[derive(Clone, Copy)]
struct Crossing {
    num: i64,
    den: i64,
}

impl Crossing {
    /// Whether it comes before another. Products are at most 2^49.
    fn before(self, other: Self) -> bool {
        self.num * other.den < other.num * self.den
    }

    fn time(self) -> Time {
        Time::new(i128::from(self.num), i128::from(self.den))
    }
}

/// A cell that a ray passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Passed {
    /// Number of the cell on each axis.
    pub cell: [u32; 3],
    /// When the ray leaves it.
    pub exit: Time,
}

/// The cells of a ray. Between the exit of the cell before and its own exit, the ray is in
/// the closed cell.
pub struct Walk<'a> {
    grid: &'a Grid,
    ray: Ray,
    /// The next cell, or `None` at the end.
    cell: Option<[u32; 3]>,
    /// Cells that may yet be passed.
    left: u32,
}

impl<'a> Walk<'a> {
    /// Starts where a ray enters the grid.
    pub fn new(grid: &'a Grid, ray: Ray) -> Self {
        let mut walk = Self {
            grid,
            ray,
            cell: None,
            left: step_bound(grid),
        };
        walk.cell = walk.entered();
        walk
    }

    /// When the ray crosses a boundary of an axis on which it moves.
    fn crossing(&self, axis: usize, boundary: usize) -> Crossing {
        let way = i64::from(self.grid.axes[axis].boundaries()[boundary])
            - i64::from(self.ray.origin[axis]);
        let direction = i64::from(self.ray.direction[axis]);
        Crossing {
            num: way * direction.signum(),
            den: direction.abs(),
        }
    }

    /// The boundaries of a cell, in the order in which a ray crosses them.
    fn passed(&self, axis: usize, cell: usize) -> [usize; 2] {
        match self.ray.direction[axis] > 0 {
            true => [cell, cell + 1],
            false => [cell + 1, cell],
        }
    }

    fn cells(&self, axis: usize) -> usize {
        self.grid.axes[axis].cells() as usize
    }

    /// The first cell, if the ray reaches the grid.
    fn entered(&self) -> Option<[u32; 3]> {
        if !self.ray.moves() {
            return None;
        }
        let moving = || (0..3).filter(|axis| self.ray.direction[*axis] != 0);
        let mut entry = Crossing { num: 0, den: 1 };
        for axis in moving() {
            let outermost = match self.ray.direction[axis] > 0 {
                true => 0,
                false => self.cells(axis),
            };
            let outer = self.crossing(axis, outermost);
            if entry.before(outer) {
                entry = outer;
            }
        }
        if self.ray.segment && entry.num > entry.den {
            return None;
        }
        let mut cell = [0; 3];
        for (axis, cell) in cell.iter_mut().enumerate() {
            let found = match self.ray.direction[axis] {
                0 => self.beside(axis),
                _ => self.at(axis, entry),
            };
            *cell = u32::try_from(found?).expect("at most CELLS_MAX");
        }
        Some(cell)
    }

    /// The cell of a ray that does not move along the axis.
    fn beside(&self, axis: usize) -> Option<usize> {
        let boundaries = self.grid.axes[axis].boundaries();
        let passed = boundaries.partition_point(|b| *b <= self.ray.origin[axis]);
        (1..boundaries.len()).contains(&passed).then(|| passed - 1)
    }

    /// The last cell whose near boundary is crossed no later than `entry`; none if that is
    /// only after the grid.
    fn at(&self, axis: usize, entry: Crossing) -> Option<usize> {
        let cells = self.cells(axis);
        let forward = self.ray.direction[axis] > 0;
        let nth = |n: usize| if forward { n } else { cells - 1 - n };
        // Near boundaries of the cells in the order of the ray; their times rise.
        let (mut low, mut high) = (0, cells);
        while low < high {
            let middle = usize::midpoint(low, high);
            let [near, _] = self.passed(axis, nth(middle));
            match entry.before(self.crossing(axis, near)) {
                true => high = middle,
                false => low = middle + 1,
            }
        }
        let cell = nth(low.checked_sub(1)?);
        let [_, far] = self.passed(axis, cell);
        let over = self.crossing(axis, far).before(entry);
        (!over).then_some(cell)
    }
}

impl Iterator for Walk<'_> {
    type Item = Passed;

    fn next(&mut self) -> Option<Passed> {
        let cell = self.cell?;
        self.left = self
            .left
            .checked_sub(1)
            .expect("a step leads to a new cell of one axis");
        let mut least: Option<(usize, Crossing)> = None;
        for axis in (0..3).filter(|axis| self.ray.direction[*axis] != 0) {
            let [_, far] = self.passed(axis, cell[axis] as usize);
            let crossing = self.crossing(axis, far);
            if least.is_none_or(|(_, other)| crossing.before(other)) {
                least = Some((axis, crossing));
            }
        }
        let (axis, exit) = least.expect("only rays that move enter a grid");
        self.cell = self.beyond(cell, axis, exit);
        Some(Passed {
            cell,
            exit: exit.time(),
        })
    }
}

impl Walk<'_> {
    /// The neighbour across the boundary that is crossed next, unless the grid or the
    /// segment ends before.
    fn beyond(&self, mut cell: [u32; 3], axis: usize, exit: Crossing) -> Option<[u32; 3]> {
        if self.ray.segment && exit.num > exit.den {
            return None;
        }
        let at = i64::from(cell[axis]) + i64::from(self.ray.direction[axis].signum());
        cell[axis] = u32::try_from(at).ok()?;
        (cell[axis] < self.grid.axes[axis].cells()).then_some(cell)
    }
}

/// Most cells that a ray passes: each step leads one cell on along one axis, and never
/// back.
pub fn step_bound(grid: &Grid) -> u32 {
    grid.axes.iter().map(|axis| axis.cells() - 1).sum::<u32>() + 1
}
