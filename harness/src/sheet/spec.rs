//! The spec's lists.

use triptych_spec::abuffer::NOTHING;
use triptych_spec::raster::Fragment;
use triptych_spec::scene::{Scene, Size};

use super::{Entry, Kind, Pixel, SPEC_BYTES, Sheet, pack, source, surfaces};
use crate::replay::spec::SpecRun;

/// Entries that are packed at most; they take four to eight bytes each.
const ENTRIES: u64 = 120_000;

/// The spec's lists, each with the opaque surface behind it.
pub fn spec(scene: &Scene, run: &SpecRun, leg: &str) -> Sheet {
    let size = run.primitives.size;
    let samples = run.primitives.samples.count() as usize;
    let shows = |pixel: usize| {
        let mut prims = run.opaque.prim[samples * pixel..][..samples].iter();
        prims.any(|prim| *prim != NOTHING)
    };
    let has = |pixel: usize| !run.sorted.list(pixel).is_empty() || shows(pixel);
    let with_entries = (0..size.pixels()).filter(|p| has(*p)).count() as u64;
    let entries = run.sorted.fragments.len() as u64 + with_entries;
    let mut stride = stride(entries, ENTRIES);
    loop {
        let pixels: Vec<Pixel> = lattice(size, stride)
            .filter(|pixel| has(*pixel as usize))
            .map(|pixel| (pixel, vec![list(scene, run, pixel, rounded)]))
            .collect();
        let data = pack(&pixels, 1);
        if data.len() <= SPEC_BYTES {
            let held = pixels.len() as u64;
            return Sheet {
                leg: leg.into(),
                bits: run.primitives.bits,
                stride,
                held,
                left_out: with_entries - held,
                data,
                ..Sheet::default()
            };
        }
        stride *= 2;
    }
}

/// The power of two by which columns and rows are thinned out so that no more than
/// `most` of so many entries are left, if they are spread evenly.
pub fn stride(entries: u64, most: u64) -> u32 {
    let mut stride = 1_u32;
    while entries / u64::from(stride).pow(2) > most {
        stride *= 2;
    }
    stride
}

/// Every `stride`-th pixel of every `stride`-th row.
pub(super) fn lattice(size: Size, stride: u32) -> impl Iterator<Item = u32> {
    let step = stride as usize;
    (0..size.height).step_by(step).flat_map(move |y| {
        (0..size.width)
            .step_by(step)
            .map(move |x| y * size.width + x)
    })
}

/// A pixel's list, nearest first, with the opaque surface behind it.
pub(super) fn list(
    scene: &Scene,
    run: &SpecRun,
    pixel: u32,
    shown: fn([f32; 4]) -> [f32; 4],
) -> Vec<Entry> {
    let entry = |f: &Fragment, kind| Entry {
        prim: f.prim,
        source: source(scene, &run.primitives, f.prim),
        key: f.key,
        mask: f.mask,
        colour: shown(run.faces[f.prim as usize]),
        kind,
    };
    let fragments = run.sorted.list(pixel as usize).iter();
    let mut list: Vec<Entry> = fragments.map(|f| entry(f, Kind::Listed)).collect();
    let surfaces = surfaces(&run.opaque, run.primitives.samples.count(), pixel);
    list.extend(surfaces.iter().map(|f| entry(f, Kind::Opaque)));
    list
}

/// A colour as it is, for comparing.
pub(super) fn exact(colour: [f32; 4]) -> [f32; 4] {
    colour
}

/// A colour to eight significant bits, for looking at: half the bytes.
pub(super) fn rounded(colour: [f32; 4]) -> [f32; 4] {
    colour.map(|c| f32::from_bits(c.to_bits() & 0xffff_0000))
}
