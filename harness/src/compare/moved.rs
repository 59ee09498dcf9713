//! What moved vertices change: the lists and opaque surfaces that a leg made of its own
//! triangles, against the spec's own.
//!
//! An item is a triangle of the scene at a pixel: its fragments in the lists, or the
//! opaque surface there. One that differs has cause *vertex* if and only if
//!
//! 1. the triangle itself lies elsewhere: its rows of snapped corners are not those of
//!    the spec; or
//! 2. it is a fragment of a list, the opaque surfaces at its pixel differ, and one of
//!    these is such a triangle: it hides the fragment, or does so no more.
//!
//! How far corners may move is what the rows of the vertex stages judge, from bounds.
//! So cause vertex is counted here, not judged. Whatever else differs is judged: its
//! triangle and what hides it are the same on both sides, and so must the rest be.

use std::collections::BTreeMap;

use triptych_spec::abuffer::{NOTHING, Opaque, Sorted};
use triptych_spec::raster::Fragment;
use triptych_spec::vertex::Primitives;

use crate::cause::Cause;
use crate::compare::Judgement;
use crate::compare::fragments::at;
use crate::row::Class;

/// The triangles of one side, and what became of them.
#[derive(Clone, Copy)]
pub struct Side<'a> {
    /// On the grid.
    pub primitives: &'a Primitives,
    /// The nearest opaque surfaces.
    pub opaque: &'a Opaque,
    /// The sorted lists of the whole target.
    pub sorted: &'a Sorted,
}

/// Compares the spec's own results with a leg's from its own triangles.
pub fn compare(spec: Side<'_>, own: Side<'_>) -> Judgement {
    let moved = Moved::new(spec.primitives, own.primitives);
    let mut judgement = Judgement::new(Class::Decision, "fragments");
    // Those without a counterpart; of the others that change, only the key does.
    let mut alone = 0_u64;
    // In order, as pixels are.
    let elsewhere = opaque(spec, own, &moved, &mut alone, &mut judgement);
    let (a, b) = (fragments(spec), fragments(own));
    for key in keys(&a, &b) {
        judgement.compared += 1;
        let [a, b] = [&a, &b].map(|side| side.get(&key).map_or(&[][..], Vec::as_slice));
        if a == b {
            continue;
        }
        let (pixel, source) = key;
        if moved.is(source) || elsewhere.binary_search(&pixel).is_ok() {
            judgement.admitted += 1;
            alone += u64::from(a.len() != b.len());
            continue;
        }
        judgement.differs(cause(a, b), Some(pixel), || {
            format!(
                "{} differs in triangle {source}, which did not move",
                at(pixel, spec.primitives.size.width)
            )
        });
    }
    finish(&mut judgement, spec.primitives, alone);
    judgement
}

/// Which triangles of the scene lie elsewhere.
struct Moved(Vec<bool>);

impl Moved {
    fn new(a: &Primitives, b: &Primitives) -> Self {
        let rows = |p: &Primitives| {
            let mut all = BTreeMap::<u32, Vec<[[i32; 3]; 3]>>::new();
            for (prim, source) in p.prims.iter().zip(&p.source) {
                let corners = prim.map(|c| p.snapped[c as usize]);
                all.entry(*source).or_default().push(corners);
            }
            all
        };
        let (a, b) = (rows(a), rows(b));
        let last = a.keys().chain(b.keys()).max();
        let all = 0..last.map_or(0, |last| last + 1);
        Self(all.map(|t| a.get(&t) != b.get(&t)).collect())
    }

    /// No surface at all did not move.
    fn is(&self, source: u32) -> bool {
        self.0.get(source as usize).is_some_and(|moved| *moved)
    }
}

/// Compares the opaque surfaces; gives, in order, the pixels where a moved triangle
/// changes them.
fn opaque(
    spec: Side<'_>,
    own: Side<'_>,
    moved: &Moved,
    alone: &mut u64,
    judgement: &mut Judgement,
) -> Vec<u32> {
    let seen = |side: Side<'_>, place: usize| {
        let [key, prim] = [&side.opaque.key, &side.opaque.prim].map(|of| of.get(place).copied());
        let prim = prim.filter(|p| *p != NOTHING);
        let source = prim.map(|p| side.primitives.source[p as usize]);
        (key.unwrap_or(NOTHING), source.unwrap_or(NOTHING))
    };
    let mut elsewhere = Vec::new();
    let samples = spec.primitives.samples.count();
    for place in 0..spec.opaque.key.len().max(own.opaque.key.len()) {
        let (a, b) = (seen(spec, place), seen(own, place));
        if (a.1, b.1) == (NOTHING, NOTHING) {
            continue;
        }
        judgement.compared += 1;
        let number = u32::try_from(place).expect("at most 2^22 pixels, of 8 samples") / samples;
        if a == b {
            continue;
        } else if moved.is(a.1) || moved.is(b.1) {
            judgement.admitted += 1;
            *alone += u64::from(a.1 != b.1);
            elsewhere.push(number);
        } else {
            let cause = if a.1 == b.1 {
                Cause::DepthKey
            } else {
                Cause::Coverage
            };
            judgement.differs(cause, Some(number), || {
                let pixel = at(number, spec.primitives.size.width);
                format!("{pixel} shows another opaque surface, and no triangle moved")
            });
        }
    }
    elsewhere
}

/// Key and mask of the fragments by pixel and triangle of the scene.
type Fragments = BTreeMap<(u32, u32), Vec<[u32; 2]>>;

fn fragments(side: Side<'_>) -> Fragments {
    let mut all = Fragments::new();
    for Fragment {
        pixel,
        prim,
        key,
        mask,
    } in &side.sorted.fragments
    {
        let source = side.primitives.source[*prim as usize];
        all.entry((*pixel, source)).or_default().push([*key, *mask]);
    }
    all.values_mut().for_each(|list| list.sort_unstable());
    all
}

/// All keys of either, in order.
fn keys(a: &Fragments, b: &Fragments) -> Vec<(u32, u32)> {
    let mut all: Vec<_> = a.keys().chain(b.keys()).copied().collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Why fragments of a triangle that did not move differ at a pixel.
fn cause(spec: &[[u32; 2]], own: &[[u32; 2]]) -> Cause {
    let depths = |list: &[[u32; 2]]| list.iter().map(|f| f[0]).collect::<Vec<_>>();
    if own.len() < spec.len() {
        Cause::LostNode
    } else if own.len() > spec.len() && !spec.is_empty() {
        Cause::Duplicate
    } else if own.len() > spec.len() {
        Cause::Coverage
    } else if depths(spec) != depths(own) {
        Cause::DepthKey
    } else {
        Cause::SampleMask
    }
}

/// Says what was counted: `alone` fragments and surfaces that come or go; the rest of what
/// changes keeps its place. No share is a fault: a key of 31 bits changes with almost any
/// rounding of a corner.
fn finish(judgement: &mut Judgement, spec: &Primitives, alone: u64) {
    if judgement.compared == 0 {
        judgement.unit = "empty pixels";
        judgement.compared = spec.size.pixels() as u64;
    }
    let (changed, all) = (judgement.admitted, judgement.compared);
    let unit = judgement.unit;
    let keys = changed - alone;
    judgement.note =
        format!("cause vertex: of {all} {unit} {alone} come or go, {keys} have another key");
    if changed == all && judgement.differ() == 0 {
        let reason = format!("nothing to judge: moved vertices change all {all} {unit}");
        judgement.skipped = Some(reason);
    }
}

#[cfg(test)]
mod tests;
