//! What the spec found, for a snapshot.

use std::collections::BTreeMap;

use triptych_spec::abuffer::NOTHING;
use triptych_spec::dispatch::{Carried, Met, Ray};
use triptych_spec::rsm::Surface;

use super::spec::{Bounce, DispatchRun};
use crate::replay::facts::{Facts, hash, runs};
use crate::scene::Loaded;

/// The facts of a scene with rays in queues; hashes are over all bounces.
pub(super) fn of(loaded: &Loaded, run: &DispatchRun, skip: bool) -> Facts {
    let world = &run.setup.world;
    let size = world.eye.size;
    let cells = run.setup.grid.axes.each_ref();
    let cells = cells.map(|axis| axis.cells().to_string()).join(" x ");
    let mut counts = vec![
        ("size", format!("{} x {}", size.width, size.height)),
        ("triangles", loaded.stats.triangles.to_string()),
        ("degenerate", loaded.stats.degenerate.to_string()),
        ("lamps", world.lamps.len().to_string()),
        ("cells", cells),
        ("lattice", format!("2^{}", run.setup.lattice.exponent)),
    ];
    for bounce in &run.bounces {
        let met = bounce.surfaces.iter().flatten().count();
        let lit = bounce.lit.iter().filter(|lit| **lit).count();
        counts.push((
            "bounce",
            format!(
                "{met} of {} rays meet something, {lit} of {} lamps are seen",
                bounce.rays.len(),
                bounce.shadows.len()
            ),
        ));
    }
    let all = |of: fn(&Bounce) -> &[Ray]| run.bounces.iter().flat_map(of).flat_map(words);
    let met = run.bounces.iter().flat_map(|b| &b.met);
    let met = met.map(|met| match met {
        Met::Triangle(triangle) => *triangle,
        Met::Nothing | Met::Something => NOTHING,
    });
    let points = run.bounces.iter().flat_map(|b| b.surfaces.iter().flatten());
    let lit = run.bounces.iter().flat_map(|b| &b.lit);
    let picture = run.sums.pixels.iter().flatten();
    #[expect(clippy::cast_possible_truncation, reason = "both words of each")]
    let steps = picture.flat_map(|c| [*c as u32, (*c >> 32) as u32]);
    Facts {
        counts,
        runs: runs(&crate::replay::passes(loaded, skip)),
        hashes: BTreeMap::from([
            ("rays", hash(all(|b| &b.rays))),
            ("met", hash(met)),
            ("points", hash(points.flat_map(located))),
            ("shadows", hash(all(|b| &b.shadows))),
            ("lit", hash(lit.map(|lit| u32::from(*lit)))),
            ("picture", hash(steps)),
        ]),
    }
}

/// What is exact of a ray.
fn words(ray: &Ray) -> Vec<u32> {
    let way = ray.way.origin.into_iter().chain(ray.way.direction);
    let mut words: Vec<u32> = way.map(i32::cast_unsigned).collect();
    words.extend([ray.pixel, ray.depth]);
    if let Carried::Weight(weight) = ray.carried {
        words.extend(weight);
    }
    words
}

fn located(surface: &Surface) -> Vec<u32> {
    let mut words = vec![surface.triangle, surface.side.cast_unsigned()];
    words.extend(surface.point.map(i32::cast_unsigned));
    words
}
