//! Some rows of a target by themselves: what a scene of a thousand million fragments is compared
//! by.

use triptych_gpu::frame::Band;
use triptych_spec::abuffer::{Lists, Sorted};
use triptych_spec::raster::Fragment;
use triptych_spec::vertex::Primitives;

use super::gpu::Refusal;
use crate::compare::{compare, order};
use crate::observe::{Gpu, Observed, Spec};
use crate::replay::pieces::bands::{self, Rows};

/// Fragments of all rows that are looked at, about.
const LOOKED_AT: u64 = 1 << 23;

/// Whether lists of a target of some width are sorted as the spec sorts them.
///
/// # Errors
/// How many are not, and the first of them.
pub(super) fn in_order(
    what: &str,
    (must, width): (&Sorted, u32),
    lists: &Lists,
) -> Result<(), Refusal> {
    let must = Observed::<Spec, _>::new("spec", must);
    let seen = Observed::<Gpu, _>::new(what, lists);
    let judgement = compare(&must, &seen, |a, b| order::compare(a, b, width));
    if judgement.differ() == 0 && judgement.compared > 0 {
        return Ok(());
    }
    let (differ, unit) = (judgement.differ(), judgement.unit);
    let first = judgement.described.first().cloned().unwrap_or_default();
    Err(Refusal::Wrong(format!(
        "{what}: {differ} {unit} differ; {first}"
    )))
}

/// The rows that are looked at, of a target with so many fragments in each: as many as hold
/// [`LOOKED_AT`] together, at least one, one by one and evenly apart.
pub(super) fn looked_at(rows: &[u32]) -> Vec<Band> {
    let height = rows.len() as u64;
    let all: u64 = rows.iter().map(|row| u64::from(*row)).sum();
    let count = (LOOKED_AT * height / all.max(1)).clamp(1, height);
    let row = |i: u64| u32::try_from((2 * i + 1) * height / (2 * count)).expect("a row");
    let band = |first| Band { first, rows: 1 };
    (0..count).map(|i| band(row(i))).collect()
}

/// The triangles as they lie in a target of these rows alone.
pub(super) fn of_rows(primitives: &Primitives, band: Band) -> Primitives {
    let (first, count) = (band.first, band.rows);
    bands::of_rows(primitives, Rows { first, count })
}

/// The sorted lists of some rows; pixels count from their first.
pub(super) fn sorted_rows(sorted: &Sorted, rows: Band, width: u32) -> Sorted {
    let first = rows.first * width;
    let ends = first as usize..=(first + rows.rows * width) as usize;
    let ends = &sorted.offsets[ends];
    let (start, end) = (ends[0], ends[ends.len() - 1]);
    let moved = |f: &Fragment| Fragment {
        pixel: f.pixel - first,
        ..*f
    };
    Sorted {
        offsets: ends.iter().map(|at| at - start).collect(),
        fragments: sorted.fragments[start as usize..end as usize]
            .iter()
            .map(moved)
            .collect(),
    }
}

/// The heads of some rows.
pub(super) fn lists_of_rows(heads: &[u32], rows: Band, width: u32) -> Vec<u32> {
    let first = (rows.first * width) as usize;
    let end = first + (rows.rows * width) as usize;
    heads.get(first..end).unwrap_or_default().to_vec()
}

/// Rows that two bands have in common.
pub(super) fn common(a: Band, b: Band) -> Option<Band> {
    let first = a.first.max(b.first);
    let end = (a.first + a.rows).min(b.first + b.rows);
    (first < end).then(|| Band {
        first,
        rows: end - first,
    })
}

/// Rows of a target as a band that holds them counts them.
pub(super) fn within(rows: Band, band: Band) -> Band {
    Band {
        first: rows.first - band.first,
        ..rows
    }
}

/// Where rows begin that a comparer counts from 0.
pub(super) fn from_row(band: Band) -> String {
    match band.first {
        0 => String::new(),
        first => format!(", from row {first} on"),
    }
}

#[cfg(test)]
mod tests {
    use triptych_spec::vertex::primitives;

    use super::*;
    use crate::corpus;
    use crate::plan::Plan;
    use crate::replay::spec::SpecRun;
    use crate::scene::load;

    #[test]
    fn rows_are_evenly_apart() {
        let firsts = |rows: &[u32]| looked_at(rows).iter().map(|b| b.first).collect::<Vec<_>>();
        assert_eq!(firsts(&[1; 4]), [0, 1, 2, 3], "all of few");
        assert_eq!(firsts(&[1 << 22; 8]), [2, 6], "two rows have as many");
        assert_eq!(firsts(&[u32::MAX; 9]), [4], "one at least");
    }

    /// Lists, surfaces and picture of rows alone are those of the whole target.
    #[test]
    fn rows_alone_are_as_in_the_whole() {
        for name in ["mixed", "msaa-mixed"] {
            let file = corpus::root().join("abuffer").join(name).join("scene.toml");
            let loaded = load(&file).unwrap_or_else(|e| panic!("{e}"));
            let (scene, plan) = (&loaded.scene, Plan::new(&loaded.scene, true));
            let prims = primitives(scene, 8);
            let run = |prims: &Primitives| SpecRun::new(scene, prims.clone(), &plan).unwrap();
            let whole = run(&prims);
            let width = scene.size.width;
            let height = scene.size.height;
            for (first, rows) in [(0, 1), (height / 2, 3), (height - 2, 2)] {
                let band = Band { first, rows };
                let alone = run(&of_rows(&prims, band));
                let must = sorted_rows(&whole.sorted, band, width);
                assert!(alone.sorted == must, "{name}: lists of {band:?}");
                let pixels = (first * width) as usize..((first + rows) * width) as usize;
                assert!(
                    alone.image == whole.image[pixels.clone()],
                    "{name}: {band:?}"
                );
                let samples = scene.samples.count() as usize;
                let places = pixels.start * samples..pixels.end * samples;
                assert!(
                    alone.opaque.key == whole.opaque.key[places],
                    "{name}: {band:?}"
                );
            }
        }
    }
}
