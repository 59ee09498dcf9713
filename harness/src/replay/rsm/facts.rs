//! What the spec found, for a snapshot.

use std::collections::BTreeMap;

use triptych_spec::rsm::{Blocked, Colour, Surface};

use super::spec::RsmRun;
use crate::replay::facts::{Facts, hash, runs};
use crate::scene::Loaded;

/// The facts of a scene with indirect light; hashes are over all frames.
pub(super) fn of(loaded: &Loaded, run: &RsmRun, skip: bool) -> Facts {
    let [eye, map] = [run.setup.eye.size, run.setup.lamp.view.size];
    let [seen, blocking] = loaded.parts();
    let mut counts = vec![
        ("size", format!("{} x {}", eye.width, eye.height)),
        ("map", format!("{} x {}", map.width, map.height)),
        ("triangles", loaded.stats.triangles.to_string()),
        ("degenerate", loaded.stats.degenerate.to_string()),
        ("seen_triangles", seen.to_string()),
        ("blockers", blocking.to_string()),
        ("lattice", format!("2^{}", run.setup.lattice.exponent)),
    ];
    for frame in &run.frames {
        let axes = frame.parts.grid.axes.each_ref();
        let cells = axes.map(|axis| axis.cells().to_string()).join(" x ");
        let frame = &frame.frame;
        let surfaces = [&frame.seen, &frame.rsm.seen];
        let [pixels, texels] = surfaces.map(|s| s.surfaces.iter().flatten().count());
        let lit = frame.direct.lit.iter().filter(|lit| **lit).count();
        let bits = frame.blocked.bits.iter();
        let blocked: u64 = bits.map(|word| u64::from(word.count_ones())).sum();
        let rays = frame.blocked.rays;
        counts.push((
            "frame",
            format!(
                "{pixels} pixels and {texels} texels see something, {lit} pixels are lit; \
                 {cells} cells, {blocked} of {rays} rays blocked"
            ),
        ));
    }
    let frames = || run.frames.iter().map(|f| &f.frame);
    let places = frames().flat_map(|f| f.places.iter().flatten());
    let places = places.flat_map(|p| {
        [
            p.texel[0].cast_unsigned(),
            p.texel[1].cast_unsigned(),
            p.key,
        ]
    });
    let lit = frames().flat_map(|f| f.direct.lit.iter().map(|lit| u32::from(*lit)));
    let bits = frames().flat_map(|f| {
        let Blocked { bits, .. } = &f.blocked;
        bits.iter().copied()
    });
    Facts {
        counts,
        runs: runs(&crate::replay::passes(loaded, skip)),
        hashes: BTreeMap::from([
            ("seen", hash(frames().flat_map(|f| words(&f.seen.surfaces)))),
            (
                "map",
                hash(frames().flat_map(|f| words(&f.rsm.seen.surfaces))),
            ),
            ("places", hash(places)),
            ("lit", hash(lit)),
            ("blocked", hash(bits)),
            ("picture", hash(frames().flat_map(|f| fixed(&f.picture)))),
        ]),
    }
}

fn words(surfaces: &[Option<Surface>]) -> impl Iterator<Item = u32> {
    let word = |surface: &Option<Surface>| {
        let Some(Surface {
            triangle,
            side,
            point,
        }) = surface
        else {
            return vec![u32::MAX];
        };
        let mut words = vec![*triangle, side.cast_unsigned()];
        words.extend(point.map(i32::cast_unsigned));
        words
    };
    surfaces.iter().flat_map(word)
}

/// Colours in steps of 2^-16: integers.
fn fixed(picture: &[Colour]) -> impl Iterator<Item = u32> {
    let steps = |value: f64| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "saturates"
        )]
        let steps = libm::floor(value * 65536.0 + 0.5) as u32;
        steps
    };
    picture.iter().flatten().map(move |c| steps(c.value))
}
