//! Random grids on every adapter, with words and with native integers: the spec's lists to the
//! bit, and its answer to every ray.

use proptest::prelude::*;
use triptych_gpu::grid::{Device, Stages};
use triptych_spec::abuffer::{EOL, NOTHING};
use triptych_spec::grid::hit::{crossing, timed};
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::{Query, closest};
use triptych_spec::grid::{Blockers, Cells, Grid, Membership, count};

use super::aimed;
use crate::adapters::devices;
use crate::config;

/// Each stage from the spec's input.
fn agrees(
    stages: &mut Stages,
    blockers: &Blockers,
    grid: &Grid,
    rays: &[Ray],
) -> Result<(), TestCaseError> {
    let cells = Cells {
        axes: &grid.axes,
        membership: Membership::Box,
    };
    let counts = count(blockers, &cells);
    let entries = u32::try_from(grid.prims.len()).unwrap();
    prop_assert_eq!(stages.count().unwrap(), &counts[..]);
    stages.give_counts(&counts).unwrap();
    prop_assert_eq!(stages.scan().unwrap(), &grid.offsets[..]);
    prop_assert_eq!(stages.fill(entries, entries).unwrap(), &grid.prims[..]);
    let linked = stages.link(entries).unwrap();
    prop_assert_eq!(linked.attempts, entries);
    for (cell, head) in linked.heads.iter().enumerate() {
        let mut list = Vec::new();
        let mut at = *head;
        while at != EOL {
            list.push(linked.entries[at as usize].prim);
            at = linked.entries[at as usize].next;
            prop_assert!(list.len() <= linked.entries.len(), "a cycle");
        }
        list.sort_unstable();
        prop_assert_eq!(
            &list[..],
            &grid.prims[grid.offsets[cell] as usize..grid.offsets[cell + 1] as usize]
        );
    }
    let any = stages.trace(rays, Query::Any).unwrap();
    let nearest = stages.trace(rays, Query::Closest).unwrap();
    for ((ray, any), nearest) in rays.iter().zip(any).zip(nearest) {
        let expected = closest(grid, blockers, *ray);
        prop_assert_eq!(any.prim != NOTHING, expected.is_some(), "{:?}", ray);
        prop_assert_eq!(nearest.prim != NOTHING, expected.is_some(), "{:?}", ray);
        if let Some(expected) = expected {
            prop_assert!(crossing(ray, blockers.corners(any.prim)).is_some());
            let seen = timed(ray, blockers.corners(nearest.prim)).expect("it is met");
            prop_assert!(
                seen.admits(f64::from(nearest.time)),
                "{:?}: {:?}",
                nearest,
                seen
            );
            let first = timed(ray, blockers.corners(expected.prim)).expect("it is met");
            prop_assert!(seen.value - seen.bound <= first.value + first.bound);
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(48))]

    #[test]
    fn random_grids((blockers, grid, rays) in aimed()) {
        let cells = triptych_spec::grid::resolution::Resolution::Given(grid.axes.each_ref().map(|a| a.cells()));
        let grid = Grid::build(&blockers, cells, Membership::Box).expect("as before");
        for (gpu, kernels) in devices() {
            for kernels in kernels {
                let device = Device::new(gpu, kernels, &blockers, &grid.axes, Membership::Box).unwrap();
                let mut stages = Stages::new(device).unwrap();
                agrees(&mut stages, &blockers, &grid, &rays)?;
            }
        }
    }
}
