//! Skipping, tested differentially: the same leg with and without it.

use std::borrow::Cow;

use triptych_gpu::error::GpuError;
use triptych_gpu::raster::{self, Path};
use triptych_spec::abuffer::{Opaque, Sorted, visible};
use triptych_spec::raster::Fragment;
use triptych_spec::vertex::Primitives;

use super::gpu::{GpuLeg, GpuSeen};
use super::rows::Rows;
use crate::cause::Cause;
use crate::compare::fragments::at;
use crate::compare::lists::{Fault, certify};
use crate::compare::order::words;
use crate::compare::{Judgement, compare};
use crate::observe::{Gpu, GpuUnskipped, Observed};
use crate::plan::Plan;
use crate::row::Class;

/// The path on which an adapter tests skipping for a scene: `fragment` or `compute`, by
/// the sum of the bytes of both names, so that it depends on nothing else of a run but
/// on the paths that were asked for. Both for every scene would be most of what the
/// row costs twice over. `native` is left to `compute`, from which it differs in the
/// arithmetic of keys only, unless it was asked for alone.
pub fn turn(scene: &str, adapter: &str, paths: &[Path]) -> Option<Path> {
    let alone = paths.len() == 1;
    let paths = paths.iter().filter(|p| alone || **p != Path::Native);
    let paths: Vec<Path> = paths.copied().collect();
    let sum: usize = scene.bytes().chain(adapter.bytes()).map(usize::from).sum();
    paths.get(sum % paths.len().max(1)).copied()
}

/// Runs the leg's lists and picture again without skipping anything, compares the two,
/// and gives the milliseconds that skipping saved on the device. The stream of all
/// fragments is one of the things that a plan skips: then it is run for its time.
///
/// # Errors
/// Whatever the device reports.
pub fn run(
    leg: &GpuLeg<'_>,
    skipped: &Observed<Gpu, GpuSeen>,
    rows: &mut Rows,
) -> Result<Option<f64>, GpuError> {
    let plan = Plan::new(leg.scene, false);
    let everything = GpuLeg {
        plan: &plan,
        capacity: None,
        ..*leg
    };
    let rasterizer = everything.rasterizer()?;
    let seen = everything.abuffer(&rasterizer)?;
    let stream = match leg.plan.cover {
        true => std::time::Duration::ZERO,
        false => raster::cover(&rasterizer)?.time,
    };
    let (time, own_time) = (seen.time + stream, skipped.value.time);
    let label = format!("{} --no-skip", leg.label());
    let full = Observed::<GpuUnskipped, _>::new(label, seen).taking(time);
    let skipped = skipped.map(|s| s).taking(own_time);
    let primitives = &leg.spec.value.primitives;
    if skipped.value.sorted.is_none() {
        let reason = "the lists are damaged, see build".to_owned();
        rows.skip("plan", &skipped.label, &full.label, Class::Exact, reason);
        return Ok(None);
    }
    let judgement = compare(&skipped, &full, |a, b| judge(a, b, primitives));
    rows.add("plan", &skipped, &full, judgement);
    Ok(Some((time.as_secs_f64() - own_time.as_secs_f64()) * 1e3))
}

/// Equal pictures to the bit, and equal lists once what lies at or behind the
/// opaque surface is removed.
fn judge(skipped: &GpuSeen, full: &GpuSeen, primitives: &Primitives) -> Judgement {
    let width = primitives.size.width;
    let mut judgement = Judgement::new(Class::Exact, "pixels");
    let (Some(a), Some(b)) = (&skipped.sorted, &full.sorted) else {
        judge_damage(full, &mut judgement);
        return judgement;
    };
    let images = skipped.abuffer.image.iter().zip(&full.abuffer.image);
    for (pixel, (x, y)) in (0_u32..).zip(images) {
        judgement.compared += 1;
        let opaque = &full.abuffer.opaque;
        let (a, b) = (list(a, pixel), in_front(primitives, opaque, list(b, pixel)));
        if let Some(cause) = difference(a, &b) {
            judgement.differs(cause, Some(pixel), || {
                let (a, b) = (words(a), words(&b));
                format!("{} holds {a} with skipping, {b} without", at(pixel, width))
            });
        } else if x.map(f32::to_bits) != y.map(f32::to_bits) {
            // From equal lists only: other lists give another picture.
            judgement.differs(Cause::BlendRounding, Some(pixel), || {
                format!("{} is {x:?} with skipping, {y:?} without", at(pixel, width))
            });
        }
    }
    judgement
}

/// What of a pixel's list lies in front of the opaque surface: of each fragment the samples that
/// do, where there are several; else the beginning of the list.
fn in_front<'f>(
    primitives: &Primitives,
    opaque: &Opaque,
    list: &'f [Fragment],
) -> Cow<'f, [Fragment]> {
    if primitives.samples.count() == 1 {
        let before = |f: &&Fragment| f.key < opaque.key[f.pixel as usize];
        return Cow::Borrowed(&list[..list.iter().take_while(before).count()]);
    }
    let shown = list.iter().map(|f| Fragment {
        mask: visible(primitives, opaque, f),
        ..*f
    });
    Cow::Owned(shown.filter(|f| f.mask != 0).collect())
}

/// Why two sorted lists of a pixel differ; `None` if they do not.
fn difference(a: &[Fragment], b: &[Fragment]) -> Option<Cause> {
    let ordered = |list: &[Fragment]| {
        let mut list = list.to_vec();
        list.sort_unstable();
        list
    };
    if a == b {
        None
    } else if ordered(a) != ordered(b) {
        Some(Cause::LostNode)
    } else if a.iter().map(|f| f.key).eq(b.iter().map(|f| f.key)) {
        Some(Cause::TieOrder)
    } else {
        Some(Cause::SortOrder)
    }
}

/// Lists that only the run without skipping damages: its certificates say how.
fn judge_damage(full: &GpuSeen, judgement: &mut Judgement) {
    let lists = full
        .abuffer
        .bands
        .iter()
        .map(|b| b.sorted.as_ref().unwrap_or(&b.built));
    let faults = lists.flat_map(|lists| certify(lists).faults);
    for Fault { cause, address, .. } in faults {
        judgement.differs(cause, None, || {
            format!("without skipping a link leads to address {address}")
        });
    }
}

fn list(sorted: &Sorted, pixel: u32) -> &[Fragment] {
    sorted.list(pixel as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corpus;

    #[test]
    fn every_path_has_its_turn_on_every_adapter() {
        let corpus = corpus::list(&corpus::root()).expect("the corpus is sound");
        for adapter in ["llvmpipe", "SwiftShader", "SwiftShader#2"] {
            let turns = corpus.iter().map(|e| turn(&e.name, adapter, &Path::ALL));
            let turns: Vec<Path> = turns.map(|t| t.expect("a path")).collect();
            for path in [Path::Fragment, Path::Compute] {
                let share = turns.iter().filter(|t| **t == path).count();
                let least = turns.len() / 3;
                assert!(share >= least, "{adapter}: {share} on {}", path.name());
            }
        }
    }

    #[test]
    fn a_path_that_is_asked_for_alone_is_tested() {
        for path in Path::ALL {
            assert_eq!(turn("abuffer/quads", "x", &[path]), Some(path));
        }
        assert_eq!(turn("abuffer/quads", "x", &[]), None);
    }
}
