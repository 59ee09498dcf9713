//! A kernel steps through cells in `f32`, whose rounding WGSL leaves open.

use proptest::prelude::*;
use triptych_spec::grid::axis::WIDENED;
use triptych_spec::grid::hit::{crossing, timed};
use triptych_spec::grid::lattice::REACH;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::walk::step_bound;
use triptych_spec::grid::{Blockers, Grid};

use super::aimed;
use crate::config;
use crate::loose::Loose;

/// A ray's way through the cells as `gpu/src/{march,bricks,search}.wgsl` go it, in arithmetic of
/// its own: exits are kept but for the axis that was stepped on, empty bricks are crossed at once,
/// and a hit ends the search once a cell is left after it.
struct Kernel<'a> {
    grid: &'a Grid,
    blockers: &'a Blockers,
    ray: Ray,
    inverse: [f32; 3],
}

/// What a kernel found: everything that was listed on its way, and of what is met the first by
/// times of its own.
#[derive(Default)]
struct Found {
    listed: Vec<u32>,
    nearest: Option<(f32, u32)>,
}

impl<'a> Kernel<'a> {
    fn new(grid: &'a Grid, blockers: &'a Blockers, ray: Ray, loose: &mut Loose) -> Self {
        let inverse = ray.direction.map(|d| match d {
            0 => 0.0,
            d => loose.div(1.0, d as f32),
        });
        Self {
            grid,
            blockers,
            ray,
            inverse,
        }
    }

    fn cells(&self, axis: usize) -> i32 {
        self.grid.axes[axis].cells().cast_signed()
    }

    /// When a boundary is crossed, evaluated anew.
    fn time(&self, axis: usize, boundary: i32, loose: &mut Loose) -> f32 {
        let boundaries = self.grid.axes[axis].boundaries();
        let boundary = boundaries[usize::try_from(boundary).unwrap()] as f32;
        let way = loose.sub(boundary, self.ray.origin[axis] as f32);
        loose.mul(way, self.inverse[axis])
    }

    fn step(&self, axis: usize) -> i32 {
        self.ray.direction[axis].signum()
    }

    fn up(&self, axis: usize) -> i32 {
        i32::from(self.step(axis) > 0)
    }

    fn moving(&self) -> impl Iterator<Item = usize> + use<> {
        let direction = self.ray.direction;
        (0..3).filter(move |axis| direction[*axis] != 0)
    }

    fn is_inside(&self, cell: [i32; 3]) -> bool {
        (0..3).all(|axis| (0..self.cells(axis)).contains(&cell[axis]))
    }

    fn exits(&self, cell: [i32; 3], loose: &mut Loose) -> [f32; 3] {
        [0, 1, 2].map(|axis| match self.step(axis) {
            0 => NEVER,
            _ => self.time(axis, cell[axis] + self.up(axis), loose),
        })
    }

    fn entrance(&self, loose: &mut Loose) -> Option<[i32; 3]> {
        let mut entry = 0.0_f32;
        for axis in self.moving() {
            let first = if self.step(axis) > 0 {
                0
            } else {
                self.cells(axis)
            };
            entry = entry.max(self.time(axis, first, loose));
        }
        if self.ray.segment && entry > 1.0 {
            return None;
        }
        let cell = [0, 1, 2].map(|axis| self.cell_on(axis, entry, loose));
        self.is_inside(cell).then_some(cell)
    }

    fn cell_on(&self, axis: usize, entry: f32, loose: &mut Loose) -> i32 {
        let count = self.cells(axis);
        if self.step(axis) == 0 {
            let boundaries = self.grid.axes[axis].boundaries();
            let passed = boundaries.partition_point(|b| *b <= self.ray.origin[axis]);
            let passed = i32::try_from(passed).unwrap();
            return if passed <= count { passed - 1 } else { -1 };
        }
        // The first is passed by the choice of `entry`; evaluated again, its time may come out
        // later.
        let (mut low, mut high) = (1, count + 1);
        let forward = self.step(axis) > 0;
        while low < high {
            let middle = i32::midpoint(low, high);
            let boundary = if forward { middle } else { count - middle };
            match self.time(axis, boundary, loose) <= entry {
                true => low = middle + 1,
                false => high = middle,
            }
        }
        let nth = low.min(count) - 1;
        if forward { nth } else { count - 1 - nth }
    }

    fn list(&self, cell: [i32; 3]) -> &[u32] {
        self.grid.list(cell.map(i32::cast_unsigned))
    }

    fn is_empty_brick(&self, cell: [i32; 3]) -> bool {
        let ranges = [0, 1, 2].map(|axis| {
            let first = cell[axis] & -4;
            first..(first + 4).min(self.cells(axis))
        });
        let [xs, ys, zs] = ranges;
        zs.into_iter().all(|z| {
            let (xs, ys) = (xs.clone(), ys.clone());
            ys.into_iter()
                .all(|y| xs.clone().all(|x| self.list([x, y, z]).is_empty()))
        })
    }

    /// The neighbour of an empty brick; `None` if the search ends in it.
    fn over_brick(&self, cell: [i32; 3], found: &Found, loose: &mut Loose) -> Option<[i32; 3]> {
        let last = [0, 1, 2].map(|axis| {
            let first = cell[axis] & -4;
            let end = (first + 3).min(self.cells(axis) - 1);
            if self.up(axis) == 1 { end } else { first }
        });
        let exit = self.exits(last, loose);
        let time = soonest(exit);
        if self.ends(found, time) {
            return None;
        }
        let mut next =
            [0, 1, 2].map(|axis| self.settled(axis, cell[axis], last[axis], time, loose));
        let axis = first_of(exit);
        next[axis] = last[axis] + self.step(axis);
        Some(next)
    }

    /// The cell of an axis at a time, in steps of two and one.
    fn settled(&self, axis: usize, cell: i32, last: i32, time: f32, loose: &mut Loose) -> i32 {
        let (step, up) = (self.step(axis), self.up(axis));
        let mut at = cell;
        if (last - at) * step >= 2 && self.time(axis, at + step + up, loose) <= time {
            at += 2 * step;
        }
        if (last - at) * step >= 1 && self.time(axis, at + up, loose) <= time {
            at += step;
        }
        at
    }

    fn ends(&self, found: &Found, exit: f32) -> bool {
        let hit = found.nearest.map_or(NEVER, |(time, _)| time);
        hit < exit || self.ray.segment && exit > 1.0
    }

    /// Looks a list through; times are anywhere within their bounds.
    fn look(&self, cell: [i32; 3], found: &mut Found, loose: &mut Loose) {
        for &prim in self.list(cell) {
            let Some(time) = timed(&self.ray, self.blockers.corners(prim)) else {
                continue;
            };
            let off = [0.0, -time.bound, time.bound][usize::try_from(loose.choose(3)).unwrap()];
            // Within the bound once more, where rounding left it.
            let time = single(time.value + off);
            if found.nearest.is_none_or(|nearest| (time, prim) < nearest) {
                found.nearest = Some((time, prim));
            }
        }
    }

    /// The whole way; with `hits` it ends after the first, else where the grid does.
    fn found(&self, hits: bool, loose: &mut Loose) -> Found {
        let mut found = Found::default();
        let Some(mut cell) = self.entrance(loose) else {
            return found;
        };
        let mut exit = self.exits(cell, loose);
        for _ in 0..step_bound(self.grid) {
            if self.is_empty_brick(cell) {
                let Some(next) = self.over_brick(cell, &found, loose) else {
                    return found;
                };
                cell = next;
                if !self.is_inside(cell) {
                    return found;
                }
                exit = self.exits(cell, loose);
                continue;
            }
            found.listed.extend_from_slice(self.list(cell));
            if hits {
                self.look(cell, &mut found, loose);
            }
            if self.ends(&found, soonest(exit)) {
                return found;
            }
            let axis = first_of(exit);
            cell[axis] += self.step(axis);
            if !self.is_inside(cell) {
                return found;
            }
            exit[axis] = self.time(axis, cell[axis] + self.up(axis), loose);
        }
        panic!("more steps than the bound");
    }
}

#[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
fn single(x: f64) -> f32 {
    x as f32
}

fn soonest([x, y, z]: [f32; 3]) -> f32 {
    x.min(y).min(z)
}

/// The axis of the soonest exit.
fn first_of([x, y, z]: [f32; 3]) -> usize {
    usize::from(x > y.min(z)) * (1 + usize::from(y > z))
}

/// Later than anything that a ray meets. Twin: `NEVER` in `march.wgsl`.
const NEVER: f32 = 3e38;

proptest! {
    #![proptest_config(config(3000))]

    /// Whatever a ray meets is listed in a cell that a kernel looks into, and a kernel ends
    /// within the bound.
    #[test]
    fn misses_nothing((blockers, grid, rays) in aimed(), seed in any::<u64>()) {
        for ray in rays.iter().filter(|ray| ray.moves()) {
            let mut loose = Loose::new(seed);
            let kernel = Kernel::new(&grid, &blockers, *ray, &mut loose);
            let seen = kernel.found(false, &mut loose).listed;
            for prim in 0..u32::try_from(blockers.triangles.len()).unwrap() {
                let met = crossing(ray, blockers.corners(prim)).is_some();
                prop_assert!(!met || seen.contains(&prim), "{:?} misses {}", ray, prim);
            }
        }
    }

    /// A search that ends with a hit has met something if anything is met, and nothing that is
    /// left is certainly before it.
    #[test]
    fn ends_with_the_first((blockers, grid, rays) in aimed(), seed in any::<u64>()) {
        for ray in rays.iter().filter(|ray| ray.moves()) {
            let mut loose = Loose::new(seed);
            let kernel = Kernel::new(&grid, &blockers, *ray, &mut loose);
            let nearest = kernel.found(true, &mut loose).nearest;
            let latest = nearest.map_or(f64::INFINITY, |(time, _)| f64::from(time));
            for prim in 0..u32::try_from(blockers.triangles.len()).unwrap() {
                let Some(time) = timed(ray, blockers.corners(prim)) else { continue };
                // `look` rounds once more.
                let may = single(time.value + time.bound);
                prop_assert!(latest <= f64::from(may), "{:?}: {} for {:?}", ray, latest, time);
            }
        }
    }
}

/// How far the ray is from a boundary when a kernel takes it to be there: never as much as
/// cells are widened by, and sometimes half of it.
#[test]
fn crossings() {
    let mut loose = Loose::new(1);
    let mut most = 0.0_f64;
    for d in (1 << 23..1 << 24).step_by(4999) {
        for way in [2 * REACH, 12_345_678, 3 * (1 << 22) - 1] {
            let inverse = loose.div(1.0, d as f32);
            let time = f64::from(loose.mul(way as f32, inverse));
            most = most.max((time * f64::from(d) - f64::from(way)).abs());
        }
    }
    assert!((3.0..7.02).contains(&most), "{most}");
    assert!(most < f64::from(WIDENED), "{most}");
}
