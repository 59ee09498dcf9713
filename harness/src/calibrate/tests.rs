//! Drivers that are simulated: right ones are found out, wrong ones are not trusted.

use std::convert::Infallible;

use triptych_spec::raster::{Samples, Setup};
use triptych_spec::vertex::{GUARD, guard_origin};

use super::*;

fn grid_of(driver: impl Fn(&Primitives) -> Vec<Fragment>) -> Grid {
    let Ok(grid) = finest(|probe| Ok::<_, Infallible>(driver(probe)));
    grid
}

fn exact(primitives: &Primitives) -> Vec<Fragment> {
    let mut fragments = Vec::new();
    raster::cover(primitives, |fragment| fragments.push(fragment));
    fragments
}

/// The corners after `change`, which has the axis and the number.
fn moved(probe: &Primitives, change: impl Fn(usize, i32) -> i32) -> Primitives {
    let mut moved = probe.clone();
    for corner in &mut moved.snapped {
        for (axis, number) in corner.iter_mut().take(2).enumerate() {
            *number = change(axis, *number);
        }
    }
    moved
}

/// Covers every sample whose edge functions pass.
fn by_hand(probe: &Primitives, passes: impl Fn(&Setup, [i64; 2]) -> bool) -> Vec<Fragment> {
    let (size, bits) = (probe.size, probe.bits);
    let mut fragments = Vec::new();
    for &prim in &probe.source {
        let Some(setup) = Setup::new(probe, prim) else {
            continue;
        };
        for y in setup.rows(size, bits) {
            for x in 0..size.width {
                let point = [x, y].map(|i| (2 * i64::from(i) + 1) << (bits - 1));
                fragments.extend(passes(&setup, point).then_some(Fragment {
                    pixel: y * size.width + x,
                    prim,
                    key: 0,
                    mask: 1,
                }));
            }
        }
    }
    fragments
}

/// Whichever way a driver rounds to its grid.
#[test]
fn every_grid_is_found() {
    for own in BITS_MIN..=SUBPIXEL_BITS {
        for nearest in [false, true] {
            let grid = grid_of(|probe| {
                let lost = probe.bits.saturating_sub(own);
                let half = if nearest { (1 << lost) / 2 } else { 0 };
                exact(&moved(probe, |_, x| (x + half) >> lost << lost))
            });
            assert_eq!(grid, Grid::Bits(own), "to the nearest: {nearest}");
        }
    }
}

/// One step off is seen at dozens of places, not by luck at one.
#[test]
fn a_coarser_grid_is_far_off() {
    for bits in BITS_MIN + 1..=SUBPIXEL_BITS {
        let probe = probe(bits);
        let must = places(&exact(&probe));
        let seen = places(&exact(&moved(&probe, |_, x| (x + 1) >> 1 << 1)));
        let differ = seen.iter().filter(|p| must.binary_search(p).is_err());
        let differ = differ.count();
        assert!(differ > 50, "{differ} of {} at {bits} bits", must.len());
    }
}

/// Interior fragments cost time and tell nothing.
#[test]
fn a_probe_is_cheap() {
    for bits in BITS_MIN..=SUBPIXEL_BITS {
        let fragments = exact(&probe(bits)).len();
        assert!(fragments < 100_000, "{fragments} at {bits} bits");
    }
}

/// The device is handed nothing that a scene could not hand it.
#[test]
fn a_probe_stays_inside_the_guard() {
    for bits in BITS_MIN..=SUBPIXEL_BITS {
        let probe = probe(bits);
        let low = [probe.size.width, probe.size.height].map(|side| guard_origin(side) << bits);
        for corner in &probe.snapped {
            for axis in 0..2 {
                let inside = low[axis]..=low[axis] + (GUARD << bits);
                assert!(inside.contains(&corner[axis]), "{corner:?} at {bits} bits");
            }
        }
    }
}

#[test]
fn keys_and_repetitions_do_not_matter() {
    let grid = grid_of(|probe| {
        let mut fragments = exact(probe);
        fragments[0].key ^= 1;
        fragments.push(fragments[0]);
        fragments.reverse();
        fragments
    });
    assert_eq!(grid, Grid::Bits(SUBPIXEL_BITS));
}

#[test]
fn wrong_drivers_have_no_grid() {
    // Both sides of an edge have it, or neither.
    let closed = |setup: &Setup, point| setup.edges(point).iter().all(|e| *e >= 0);
    let open = |setup: &Setup, point| setup.edges(point).iter().all(|e| *e > 0);
    for grid in [
        grid_of(|probe| by_hand(probe, closed)),
        grid_of(|probe| by_hand(probe, open)),
    ] {
        assert_eq!(grid, Grid::Unknown, "without the top-left rule");
    }
    let lost = grid_of(|probe| exact(probe).split_off(1));
    assert_eq!(lost, Grid::Unknown, "a fragment is lost");
    let few = grid_of(|probe| {
        let far = 1800 << probe.bits;
        exact(&moved(probe, |_, x| x.clamp(-far, far)))
    });
    assert_eq!(few, Grid::Unknown, "a guard band that is too narrow");
    let half = grid_of(|probe| exact(&moved(probe, |axis, x| x + i32::from(axis == 1))));
    assert_eq!(half, Grid::Unknown, "all is one step too low");
}

/// Single precision holds no edge function of a long edge.
#[test]
fn edges_in_single_precision_are_seen() {
    let grid = grid_of(|probe| {
        by_hand(probe, |setup, point| {
            let exact = setup.edges(point);
            let rounded = exact.map(|e| e as f32);
            // The third from the other two and the area, as rasterisers do it.
            let third = setup.area as f32 - rounded[0] - rounded[1];
            let sign = i64::from(third > 0.0) - i64::from(third < 0.0);
            setup.covers([exact[0], exact[1], sign])
        })
    });
    assert_eq!(grid, Grid::Unknown);
}

/// Drivers with samples of their own, which they have in place of those that they are asked for.
fn samples_of_driver(
    bits: u32,
    count: u32,
    driver: impl Fn(&Primitives) -> Vec<Fragment>,
) -> Option<Samples> {
    let Ok(found) = samples::found(bits, count, |probe| Ok::<_, Infallible>(driver(probe)));
    found
}

fn standard(count: u32) -> Samples {
    Samples::standard(count).expect("a pattern")
}

#[test]
fn samples_are_found_on_every_grid() {
    for bits in BITS_MIN..=SUBPIXEL_BITS {
        for count in [2, 4, 8] {
            assert_eq!(samples_of_driver(bits, count, exact), Some(standard(count)));
        }
    }
}

/// Also where they are not standard, and in another order.
#[test]
fn samples_are_found_wherever_they_are() {
    for places in [
        [[14, 6], [6, 2], [2, 10], [10, 14]],
        [[0, 0], [15, 15], [8, 8], [3, 12]],
    ] {
        let own = Samples::found(&places, 4).expect("inside the pixel");
        for bits in [4, 8] {
            let seen = samples_of_driver(bits, 4, |probe| {
                exact(&Primitives {
                    samples: own,
                    ..probe.clone()
                })
            });
            assert_eq!(seen, Some(own), "{places:?} at {bits} bits");
        }
    }
}

#[test]
fn masks_of_no_samples_are_not_trusted() {
    let own = |probe: &Primitives| {
        exact(&Primitives {
            samples: standard(4),
            ..probe.clone()
        })
    };
    let masked = |mask: fn(&Fragment) -> u32| {
        samples_of_driver(8, 4, |probe| {
            let fragments = own(probe).into_iter();
            fragments
                .map(|f| Fragment {
                    mask: mask(&f),
                    ..f
                })
                .collect()
        })
    };
    assert_eq!(masked(|_| 15), None, "always all");
    assert_eq!(masked(|f| f.mask & 7), None, "one is never covered");
    assert_eq!(masked(|f| f.mask.min(7)), None, "all but one at the most");
    let one = |f: &Fragment| f.mask ^ u32::from(f.pixel == 1700);
    assert_eq!(masked(one), None, "one pixel of the target is wrong");
    let lost = samples_of_driver(8, 4, |probe| own(probe).split_off(1));
    assert_eq!(lost, None, "a fragment is lost");
    assert_eq!(samples_of_driver(8, 3, exact), None, "three");
}
