//! How many cells a grid has along each axis.

use super::axis::{Axis, CELLS_MAX};
use super::lattice::Point;

/// Cells for each triangle, where the scene decides. A handful of triangles to a full cell
/// is the usual optimum (Wald, Ize, Kensler, Knoll and Parker 2006 take 4 to 8 cells a
/// triangle); empty cells cost a step, full ones an intersection for each triangle.
pub const DENSITY: f64 = 5.0;

/// Most cells of a grid: their offsets fill 64 MiB, half of what WebGPU binds by default.
pub const TOTAL_MAX: u64 = 1 << 24;

/// How a resolution is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resolution {
    /// From the number of triangles and the shape of their bounds: cubes, [`DENSITY`] of
    /// them for each triangle.
    FromScene,
    /// As given; an axis that is too short for so many gets as many as it can hold
    /// ([`super::axis::WIDTH_MIN`]).
    Given([u32; 3]),
}

/// Axes around blockers between two corners of their box.
///
/// # Errors
/// More than [`CELLS_MAX`] or none given for an axis, or more than [`TOTAL_MAX`] in all: the
/// number.
pub fn axes(
    resolution: Resolution,
    triangles: usize,
    low: Point,
    high: Point,
) -> Result<[Axis; 3], u64> {
    let cells = match resolution {
        Resolution::FromScene => cubes(triangles, low, high),
        Resolution::Given(cells) => cells,
    };
    if let Some(wrong) = cells.iter().find(|c| !(1..=CELLS_MAX).contains(*c)) {
        return Err(u64::from(*wrong));
    }
    let axes = [0, 1, 2].map(|axis| Axis::around(low[axis], high[axis], cells[axis]));
    let total = axes.iter().map(|axis| u64::from(axis.cells())).product();
    match total <= TOTAL_MAX {
        true => Ok(axes),
        false => Err(total),
    }
}

/// Sides of the box over the edge of a cube of which [`DENSITY`] times the triangles fill
/// it. Axes on which the box is thinner than that edge get one cell, and the others share
/// the cells among them.
fn cubes(triangles: usize, low: Point, high: Point) -> [u32; 3] {
    let sides = [0, 1, 2].map(|axis| f64::from(high[axis]) - f64::from(low[axis]) + 1.0);
    let wanted = (DENSITY * triangles as f64).clamp(1.0, TOTAL_MAX as f64);
    let mut thin = [false; 3];
    loop {
        let thick: Vec<f64> = (0..3).filter(|i| !thin[*i]).map(|i| sides[i]).collect();
        let volume: f64 = thick.iter().product();
        let edge = libm::pow(volume / wanted, 1.0 / thick.len().max(1) as f64);
        match (0..3).find(|i| !thin[*i] && sides[*i] < edge) {
            Some(axis) => thin[axis] = true,
            None => {
                return [0, 1, 2].map(|i| match thin[i] {
                    true => 1,
                    false => whole(sides[i] / edge),
                });
            }
        }
    }
}

/// Rounded down, so that the product of three is no more than was wanted.
fn whole(cells: f64) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to 1..=CELLS_MAX"
    )]
    let cells = cells.clamp(1.0, f64::from(CELLS_MAX)) as u32;
    cells
}
