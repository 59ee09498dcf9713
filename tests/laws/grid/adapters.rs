//! Random grids on every adapter, with words and with native integers: the spec's lists to the
//! bit, and its answer to every ray.

use std::sync::OnceLock;

use proptest::prelude::*;
use triptych_gpu::context::{Gpu, adapters};
use triptych_gpu::grid::{Device, STEPS, Stages};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::wgsl::Sources;
use triptych_spec::abuffer::{EOL, NOTHING};
use triptych_spec::grid::hit::{crossing, timed};
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::{Query, closest};
use triptych_spec::grid::{Blockers, Cells, Grid, Membership, count};

use super::aimed;
use crate::config;

/// Opened once, with kernels of both kinds.
fn devices() -> &'static [(Gpu, Vec<Kernels>)] {
    static DEVICES: OnceLock<Vec<(Gpu, Vec<Kernels>)>> = OnceLock::new();
    DEVICES.get_or_init(|| {
        let open = |adapter: wgpu::Adapter| {
            let gpu = Gpu::open(&adapter).expect("a device");
            let natives = [false, true]
                .into_iter()
                .take(1 + usize::from(gpu.has_int64()));
            let kernels = natives.map(|native| Kernels::new(Sources::shipped(native)));
            let kernels = kernels.collect();
            (gpu, kernels)
        };
        let all: Vec<_> = adapters(wgpu::Backends::VULKAN)
            .into_iter()
            .map(open)
            .collect();
        assert!(
            !all.is_empty(),
            "no adapter; `triptych doctor` says what is missing"
        );
        all
    })
}

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

/// So many triangles beside a ray's way, in the first of two cells, and a last one across it, in
/// either.
fn beside_and_across(beside: u32, x: i32) -> Blockers {
    let corners = |x: i32, y: i32| [[x, y, -40], [x, y + 80, 0], [x, y, 40]];
    let across = (0..beside).map(|_| [0, 1, 2]).chain([[3, 4, 5], [6, 7, 8]]);
    Blockers {
        vertices: [corners(-4000, 400), corners(x, -40), corners(4000, 400)].concat(),
        triangles: across.collect(),
    }
}

/// A search that a dispatch cannot end goes on in the next, wherever it stopped: before the last
/// triangle of a list, after it, and before the next cell.
#[test]
fn searches_in_parts() {
    let two_cells = triptych_spec::grid::resolution::Resolution::Given([2, 1, 1]);
    let ray = Ray::between([-9000, 0, 0], [9000, 0, 0]);
    let around = STEPS - 3..STEPS + 3;
    let all = around.chain([2 * STEPS - 1, 3 * STEPS + 7]);
    for (beside, x) in all.flat_map(|beside| [(beside, -4000), (beside, 4000)]) {
        let blockers = beside_and_across(beside, x);
        let grid = Grid::build(&blockers, two_cells, Membership::Box).expect("within the limits");
        let listed = beside + u32::from(x < 0);
        assert_eq!(grid.list([0, 0, 0]).len(), listed as usize);
        for (gpu, kernels) in devices() {
            let device = Device::new(gpu, &kernels[0], &blockers, &grid.axes, Membership::Box);
            let mut stages = Stages::new(device.expect("small")).expect("small");
            stages.give_offsets(&grid.offsets).expect("small");
            stages.give_prims(&grid.prims).expect("small");
            for query in [Query::Any, Query::Closest] {
                let hits = stages.trace(&[ray, ray], query).expect("an end");
                let prims = hits.iter().map(|hit| hit.prim);
                assert_eq!(
                    prims.collect::<Vec<_>>(),
                    [beside; 2],
                    "{beside}, {query:?}"
                );
                let least = beside.div_ceil(STEPS);
                assert!(
                    stages.dispatches >= least,
                    "{beside}: {}",
                    stages.dispatches
                );
            }
        }
    }
}
