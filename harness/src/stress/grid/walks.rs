//! How far rays walk, of the most that they may, and what empty bricks save.

use triptych_spec::grid::Grid;
use triptych_spec::grid::brick_counts;
use triptych_spec::grid::bricks;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::Closest;
use triptych_spec::grid::walk::{Walk, step_bound};

/// Walks of a step's rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Walks {
    /// Most cells that a ray may pass.
    pub bound: u32,
    /// Most that one did, up to the end of ray and grid.
    pub longest: u32,
    /// Cells that all rays pass until their search for the closest hit ends.
    pub cells: u64,
    /// The same where an empty brick is one step.
    pub steps: u64,
}

impl Walks {
    /// Walks all rays. The walk itself stops the run if a ray exceeds the bound.
    pub fn of(grid: &Grid, rays: &[Ray], answers: &[Option<Closest>]) -> Self {
        let mut walks = Self {
            bound: step_bound(grid),
            ..Self::default()
        };
        let bricks = bricks(&grid.axes, &grid.offsets);
        let [across, down, _] = brick_counts(&grid.axes);
        let brick = |[i, j, k]: [u32; 3]| i / 4 + across * (j / 4 + down * (k / 4));
        for (ray, answer) in rays.iter().zip(answers) {
            let (mut passed, mut searching, mut crossed) = (0, true, None);
            for step in Walk::new(grid, *ray) {
                passed += 1;
                if searching {
                    let own = brick(step.cell);
                    let empty = bricks[own as usize] == [0; 2];
                    walks.cells += 1;
                    walks.steps += u64::from(!empty || crossed != Some(own));
                    crossed = Some(own);
                    searching = answer.is_none_or(|first| first.time >= step.exit);
                }
            }
            walks.longest = walks.longest.max(passed);
        }
        walks
    }

    /// The longest walk over the bound.
    pub fn share(&self) -> f64 {
        f64::from(self.longest) / f64::from(self.bound.max(1))
    }

    /// The share of steps that empty bricks save.
    pub fn saved(&self) -> f64 {
        1.0 - self.steps as f64 / self.cells.max(1) as f64
    }
}
