//! The cells of blockers, slabs of layers by themselves.

use std::ops::Range;
use std::time::Duration;

use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::{
    Blockers, Cells, Grid, GridError, Membership, Slab, axes, count_slab, fill_slab, scan,
};

use crate::dispatch::share;
use crate::replay::spec::timed;

/// Triangles from which on slabs are worth it, and whose layers are found by themselves.
const TRIANGLES: usize = 1 << 12;

/// Slabs for each thread: in some of them there is more than in others.
const EACH: usize = 4;

/// A grid, and what came before it.
pub struct Built {
    /// After stage count.
    pub counts: Vec<u32>,
    /// The grid.
    pub grid: Grid,
    /// Time of stages count, scan and fill on one core, without finding the slabs.
    pub times: [Duration; 3],
}

/// [`Grid::build`] over the cores.
///
/// # Errors
/// A limit that would be exceeded.
pub fn build(
    blockers: &Blockers,
    resolution: Resolution,
    membership: Membership,
) -> Result<Built, GridError> {
    let axes = axes(blockers, resolution)?;
    let cells = Cells {
        axes: &axes,
        membership,
    };
    let slabs = slabs(blockers, &cells);
    let (counts, count) = together(&slabs, |slab| count_slab(blockers, &cells, slab));
    let (offsets, scan) = timed(|| scan(&counts));
    let offsets = offsets?;
    let (prims, fill) = together(&slabs, |slab| fill_slab(blockers, &cells, &offsets, slab));
    let grid = Grid {
        axes,
        offsets,
        prims,
    };
    Ok(Built {
        counts,
        grid,
        times: [count, scan, fill],
    })
}

/// What comes of all slabs, in order, and how long it takes on one core.
fn together(slabs: &[Slab], of: impl Fn(&Slab) -> Vec<u32> + Sync) -> (Vec<u32>, Duration) {
    let each = share::map(slabs, 1, |slab| timed(|| of(slab)));
    let (each, times): (Vec<_>, Vec<Duration>) = each.into_iter().unzip();
    (each.concat(), times.iter().sum())
}

/// All layers in order. How many slabs they are makes no difference to what comes of them.
fn slabs(blockers: &Blockers, cells: &Cells) -> Vec<Slab> {
    let (triangles, threads) = (blockers.triangles.len(), share::threads());
    if triangles < TRIANGLES || threads == 1 {
        return vec![Slab::whole(blockers, cells)];
    }
    let prims: Vec<u32> = Slab::whole(blockers, cells).prims;
    let touched = share::map(&prims, TRIANGLES, |p| cells.layers(blockers.corners(*p)));
    let parts = even(&touched, cells.axes[2].cells(), EACH * threads);
    share::map(&parts, 1, |layers| {
        let own = |prim: &u32| {
            let touched = &touched[*prim as usize];
            touched.start < layers.end && layers.start < touched.end
        };
        Slab {
            layers: layers.clone(),
            prims: prims.iter().copied().filter(own).collect(),
        }
    })
}

/// All of so many layers in about so many parts, which triangles touch about equally often. No layer is cut.
fn even(touched: &[Range<u32>], layers: u32, parts: usize) -> Vec<Range<u32>> {
    let mut more = vec![0_i64; layers as usize + 1];
    for own in touched {
        more[own.start as usize] += 1;
        more[own.end as usize] -= 1;
    }
    let touched: i64 = touched.iter().map(|own| own.len() as i64).sum();
    let (mut all, mut first) = (Vec::new(), 0);
    let (mut here, mut since) = (0, 0);
    for (layer, more) in (0..layers).zip(more) {
        here += more;
        since += here;
        if since * parts as i64 >= touched || layer + 1 == layers {
            all.push(first..layer + 1);
            (first, since) = (layer + 1, 0);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use std::ops::Range;

    use triptych_spec::grid::{Grid, Membership, count, resolution::Resolution};

    use super::{TRIANGLES, build, even, slabs};
    use crate::corpus;
    use crate::dispatch::share::with_threads;
    use crate::replay::grid::blockers;
    use crate::scene::load;

    #[test]
    fn parts_are_even() {
        let touched: Vec<_> = (0..60).map(|n| n / 10..n / 10 + 2).collect();
        let ends = |touched: &[Range<u32>], layers, parts| -> Vec<[u32; 2]> {
            let even = even(touched, layers, parts).into_iter();
            even.map(|part| [part.start, part.end]).collect()
        };
        assert_eq!(ends(&touched, 7, 1), [[0, 7]], "whole");
        let thirds = [[0, 3], [3, 5], [5, 7]];
        assert_eq!(ends(&touched, 7, 3), thirds, "10, 20, 20 and so on, 10");
        assert_eq!(ends(&touched, 7, 100).len(), 7, "no layer is cut");
        let nothing = [[0, 1], [1, 2], [2, 3]];
        assert_eq!(ends(&[], 3, 2), nothing, "nothing to spread");
        let rest = [[0, 1], [1, 2], [2, 9]];
        assert_eq!(ends(&touched[..1], 9, 2), rest, "the last are empty");
    }

    #[test]
    fn slabs_together_are_the_whole() {
        let file = corpus::root().join("grid/bunny/scene.toml");
        let loaded = load(&file).unwrap_or_else(|e| panic!("{e}"));
        let (_, blockers) = blockers(&loaded).expect("finite");
        assert!(blockers.triangles.len() >= TRIANGLES, "taken apart");
        for (resolution, layers) in [
            (Resolution::FromScene, None),
            (Resolution::Given([9, 7, 1]), Some(1)),
            (Resolution::Given([1, 2, 37]), Some(37)),
        ] {
            for membership in [Membership::Box, Membership::Overlap] {
                let whole = Grid::build(&blockers, resolution, membership).expect("within limits");
                let cells = super::Cells {
                    axes: &whole.axes,
                    membership,
                };
                for threads in [1, 2, 3, 40] {
                    let (slabs, made) = with_threads(threads, || {
                        let made = build(&blockers, resolution, membership);
                        (slabs(&blockers, &cells), made.expect("within limits"))
                    });
                    assert_eq!(slabs.len() > 1, threads > 1 && layers != Some(1));
                    assert_eq!(made.counts, count(&blockers, &cells), "{threads} threads");
                    assert_eq!(made.grid, whole, "{threads} threads");
                }
            }
        }
    }
}
