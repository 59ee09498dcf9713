//! Where a GPU leg's lists are not the spec's.

use std::collections::BTreeMap;

use triptych_gpu::abuffer::BandResult;
use triptych_spec::abuffer::Sorted;
use triptych_spec::scene::Scene;

use super::spec::{exact, list};
use super::{Entry, GPU_BYTES, Kind, Pixel, Sheet, pack, source, surfaces};
use crate::compare::fragments::at;
use crate::compare::lists::{Certificate, Fault, certify};
use crate::replay::gpu::GpuSeen;
use crate::replay::spec::SpecRun;
use crate::report::Difference;

/// Entries that are packed at most, the spec's and the leg's together.
const ENTRIES: usize = 80_000;

/// The pixels at which a leg's lists differ from the spec's, with both lists; the worst
/// ones if they are too many.
pub fn gpu(scene: &Scene, spec: &SpecRun, against: &str, leg: &str, seen: &GpuSeen) -> Sheet {
    let mut sheet = Sheet {
        leg: leg.into(),
        against: against.into(),
        bits: spec.primitives.bits,
        ..Sheet::default()
    };
    if !equal(spec, seen) {
        let mut pixels = differing(scene, spec, seen);
        let all = pixels.len() as u64;
        // The most entries that differ first; then by rows, as they came.
        pixels.sort_by_key(|(apart, _)| std::cmp::Reverse(*apart));
        let mut entries = 0;
        let keep = pixels.iter().take_while(|(_, (_, lists))| {
            let first = entries == 0;
            entries += lists.iter().map(Vec::len).sum::<usize>();
            first || entries <= ENTRIES
        });
        let mut keep = keep.count();
        loop {
            let mut kept: Vec<Pixel> = pixels[..keep].iter().map(|(_, p)| p.clone()).collect();
            kept.sort_by_key(|(pixel, _)| *pixel);
            sheet.data = pack(&kept, 2);
            if sheet.data.len() <= GPU_BYTES {
                break;
            }
            keep /= 2;
        }
        sheet.held = keep as u64;
        sheet.left_out = all - sheet.held;
        let width = spec.primitives.size.width;
        let first = pixels.first();
        sheet.worst = first.map(|(apart, pixel)| words(*apart, pixel, width, [against, leg]));
    }
    if seen.sorted.is_none() {
        sheet.note =
            "damaged, so not sorted: in order of links, up to where they lead astray".into();
    }
    sheet
}

/// Entries of a list in words; more are counted.
const WORDS: usize = 40;

fn words(apart: usize, (pixel, lists): &Pixel, width: u32, legs: [&str; 2]) -> Difference {
    let line = |e: &Entry| match e.kind {
        Kind::Astray => format!("a link leads to address {}", e.key),
        Kind::Opaque => format!("prim {} key {} opaque", e.prim, e.key),
        _ => format!(
            "prim {} key {} mask {} {:?}",
            e.prim, e.key, e.mask, e.colour
        ),
    };
    let side = |(leg, list): (&str, &Vec<Entry>)| {
        let mut lines: Vec<String> = list.iter().take(WORDS).map(line).collect();
        let more = list.len().saturating_sub(WORDS);
        lines.extend((more > 0).then(|| format!("and {more} more")));
        (leg.to_owned(), lines)
    };
    Difference {
        words: format!("{}: {apart} entries differ", at(*pixel, width)),
        sides: legs.into_iter().zip(lists).map(side).collect(),
    }
}

/// Whether lists, surfaces and colours are the spec's, bit for bit.
fn equal(spec: &SpecRun, seen: &GpuSeen) -> bool {
    let sorted = |sorted: &Sorted| {
        let none = sorted.fragments.is_empty() && spec.sorted.fragments.is_empty();
        none || *sorted == spec.sorted
    };
    let coloured = |band: &BandResult| {
        let mut nodes = band.built.nodes.iter().zip(&band.built.colours);
        nodes.all(|(node, colour)| spec.faces.get(node.prim as usize) == Some(colour))
    };
    let abuffer = &seen.abuffer;
    seen.sorted.as_ref().is_some_and(sorted)
        && abuffer.opaque == spec.opaque
        && abuffer.bands.iter().all(coloured)
}

/// Every pixel that differs with its two lists, and by how many entries.
fn differing(scene: &Scene, spec: &SpecRun, seen: &GpuSeen) -> Vec<(usize, Pixel)> {
    let width = spec.primitives.size.width;
    let mut found = Vec::new();
    for band in &seen.abuffer.bands {
        let ordered = band.sorted.is_some();
        let certificate = certify(band.sorted.as_ref().unwrap_or(&band.built));
        let mut faults = certificate.faults.iter().peekable();
        for local in 0..band.band.rows * width {
            let fault = faults.next_if(|fault| fault.pixel == local);
            let pixel = band.band.first * width + local;
            let must = list(scene, spec, pixel, exact);
            let is = Seen {
                scene,
                spec,
                seen,
                band,
            }
            .list(&certificate, local, pixel, fault);
            let apart = apart(&must, &is, ordered);
            if apart > 0 {
                found.push((apart, (pixel, vec![must, is])));
            }
        }
    }
    found
}

/// How many entries only one of two lists has; of the same ones in another order, how
/// many stand elsewhere.
fn apart(must: &[Entry], is: &[Entry], ordered: bool) -> usize {
    let word = |e: &Entry| (e.prim, e.key, e.mask, e.kind, e.colour.map(f32::to_bits));
    let mut count: BTreeMap<_, i64> = BTreeMap::new();
    must.iter()
        .for_each(|e| *count.entry(word(e)).or_default() += 1);
    is.iter()
        .for_each(|e| *count.entry(word(e)).or_default() -= 1);
    let lone: u64 = count.values().map(|n| n.unsigned_abs()).sum();
    if lone > 0 || !ordered {
        return usize::try_from(lone).unwrap_or(usize::MAX);
    }
    must.iter()
        .zip(is)
        .filter(|(a, b)| word(a) != word(b))
        .count()
}

/// A band as a leg left it.
struct Seen<'a> {
    scene: &'a Scene,
    spec: &'a SpecRun,
    seen: &'a GpuSeen,
    band: &'a BandResult,
}

impl Seen<'_> {
    fn list(
        &self,
        certificate: &Certificate,
        local: u32,
        pixel: u32,
        fault: Option<&Fault>,
    ) -> Vec<Entry> {
        let lists = self.band.sorted.as_ref().unwrap_or(&self.band.built);
        let blank = |prim| Entry {
            prim,
            source: source(self.scene, &self.spec.primitives, prim),
            key: 0,
            mask: 0,
            colour: [0.0; 4],
            kind: Kind::Listed,
        };
        // Sorting changes links alone, so that colours stay where `build` put them.
        let colours = &self.band.built.colours;
        let node = |&address: &u32| {
            let node = lists.nodes[address as usize];
            Entry {
                key: node.key,
                mask: node.mask,
                colour: colours.get(address as usize).copied().unwrap_or_default(),
                ..blank(node.prim)
            }
        };
        let mut list: Vec<Entry> = certificate.list(local).iter().map(node).collect();
        list.extend(fault.map(|fault| Entry {
            key: fault.address,
            kind: Kind::Astray,
            ..blank(u32::MAX)
        }));
        let samples = self.spec.primitives.samples.count();
        let surfaces = surfaces(&self.seen.abuffer.opaque, samples, pixel);
        list.extend(surfaces.iter().map(|f| {
            Entry {
                key: f.key,
                mask: f.mask,
                kind: Kind::Opaque,
                colour: self
                    .spec
                    .faces
                    .get(f.prim as usize)
                    .copied()
                    .unwrap_or_default(),
                ..blank(f.prim)
            }
        }));
        list
    }
}
