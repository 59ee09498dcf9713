//! A kernel steps through cells in `f32`, whose rounding WGSL leaves open.

use proptest::prelude::*;
use triptych_spec::grid::Grid;
use triptych_spec::grid::axis::WIDENED;
use triptych_spec::grid::hit::crossing;
use triptych_spec::grid::lattice::REACH;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::walk::step_bound;

use super::aimed;
use crate::config;
use crate::loose::Loose;

/// The steps of the kernel in `gpu/src/trace.wgsl`, in arithmetic of its own.
struct Kernel<'a> {
    grid: &'a Grid,
    ray: Ray,
    inverse: [f32; 3],
}

impl<'a> Kernel<'a> {
    fn new(grid: &'a Grid, ray: Ray, loose: &mut Loose) -> Self {
        let inverse = ray.direction.map(|d| match d {
            0 => 0.0,
            d => loose.div(1.0, d as f32),
        });
        Self { grid, ray, inverse }
    }

    fn time(&self, axis: usize, boundary: usize, loose: &mut Loose) -> f32 {
        let boundary = self.grid.axes[axis].boundaries()[boundary] as f32;
        let way = loose.sub(boundary, self.ray.origin[axis] as f32);
        loose.mul(way, self.inverse[axis])
    }

    fn forward(&self, axis: usize) -> bool {
        self.ray.direction[axis] > 0
    }

    fn cells(&self, axis: usize) -> usize {
        self.grid.axes[axis].cells() as usize
    }

    /// Cells in the order of the ray, `n` from 0.
    fn nth(&self, axis: usize, n: usize) -> usize {
        if self.forward(axis) {
            n
        } else {
            self.cells(axis) - 1 - n
        }
    }

    fn near(&self, axis: usize, n: usize) -> usize {
        if self.forward(axis) {
            n
        } else {
            self.cells(axis) - n
        }
    }

    fn moving(&self) -> impl Iterator<Item = usize> + use<> {
        let direction = self.ray.direction;
        (0..3).filter(move |axis| direction[*axis] != 0)
    }

    fn start(&self, loose: &mut Loose) -> Option<[usize; 3]> {
        let mut entry = 0.0_f32;
        for axis in self.moving() {
            entry = entry.max(self.time(axis, self.near(axis, 0), loose));
        }
        if self.ray.segment && entry > 1.0 {
            return None;
        }
        let mut ns = [0; 3];
        for (axis, n) in ns.iter_mut().enumerate() {
            let boundaries = self.grid.axes[axis].boundaries();
            let passed = match self.ray.direction[axis] {
                0 => boundaries.partition_point(|b| *b <= self.ray.origin[axis]),
                _ => {
                    // The first is passed by the choice of `entry`; evaluated again, its
                    // time may come out later.
                    let (mut low, mut high) = (1, self.cells(axis) + 1);
                    while low < high {
                        let middle = usize::midpoint(low, high);
                        let time = self.time(axis, self.near(axis, middle), loose);
                        if time <= entry {
                            low = middle + 1
                        } else {
                            high = middle
                        }
                    }
                    low
                }
            };
            // At its very end the ray is still at the grid.
            *n = passed
                .checked_sub(1)
                .filter(|n| *n <= self.cells(axis))?
                .min(self.cells(axis) - 1);
        }
        Some(ns)
    }

    /// Every triangle that is listed where the kernel comes along.
    fn seen(&self, loose: &mut Loose) -> Vec<u32> {
        let mut seen = Vec::new();
        let Some(mut ns) = self.start(loose) else {
            return seen;
        };
        // On an axis without movement `n` counts boundaries upwards.
        let index = |axis: usize, n: usize| match self.ray.direction[axis] {
            0 => n,
            _ => self.nth(axis, n),
        };
        for _ in 0..step_bound(self.grid) {
            let cell = [0, 1, 2].map(|axis| u32::try_from(index(axis, ns[axis])).unwrap());
            seen.extend_from_slice(self.grid.list(cell));
            let mut exit = (f32::INFINITY, 3);
            for axis in self.moving() {
                let time = self.time(axis, self.near(axis, ns[axis] + 1), loose);
                if time < exit.0 {
                    exit = (time, axis);
                }
            }
            ns[exit.1] += 1;
            if self.ray.segment && exit.0 > 1.0 || ns[exit.1] == self.cells(exit.1) {
                return seen;
            }
        }
        panic!("more steps than the bound");
    }
}

proptest! {
    #![proptest_config(config(3000))]

    /// Whatever a ray meets is listed in a cell that a kernel looks into, and a kernel ends
    /// within the bound.
    #[test]
    fn misses_nothing((blockers, grid, rays) in aimed(), seed in any::<u64>()) {
        for ray in rays.iter().filter(|ray| ray.moves()) {
            let mut loose = Loose::new(seed);
            let seen = Kernel::new(&grid, *ray, &mut loose).seen(&mut loose);
            for prim in 0..u32::try_from(blockers.triangles.len()).unwrap() {
                let met = crossing(ray, blockers.corners(prim)).is_some();
                prop_assert!(!met || seen.contains(&prim), "{:?} misses {}", ray, prim);
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
