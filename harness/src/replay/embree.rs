//! The Embree leg of one scene.

mod samples;

use std::collections::BTreeSet;
use std::time::Instant;

use triptych_spec::raster;
use triptych_spec::scene::Scene;

use super::Extent;
use super::rows::Rows;
use super::spec::SpecRun;
use crate::compare::{self, Judgement, compare};
use crate::embree::view::View;
use crate::embree::world::{World, WorldScene};
use crate::embree::{EmbreeError, EmbreeScene, Hit, RayHits};
use crate::observe::{Embree, Observed, Spec};
use crate::row::Class;
use crate::scene::Loaded;
pub use samples::run_samples;

/// The row of Embree's vote in world space.
pub const WORLD: &str = "world";

/// Asks Embree for its vote and adds the row; gives the scene for a picture, and the
/// first pixels at which it disagrees.
pub fn run(
    spec: &Observed<Spec, SpecRun>,
    edge_budget: Option<f64>,
    rows: &mut Rows,
) -> Option<(EmbreeScene, BTreeSet<u32>)> {
    let primitives = &spec.value.primitives;
    if primitives.prims.is_empty() {
        let reason = "no triangles reach the rasteriser".to_owned();
        rows.skip("cover", &spec.label, "embree", Class::Vote, reason);
        return None;
    }
    let start = Instant::now();
    let failed = |rows: &mut Rows, error: &EmbreeError| {
        rows.fail("cover", &spec.label, "embree", None, error.to_string());
    };
    let scene = match EmbreeScene::new(primitives) {
        Ok(scene) => scene,
        Err(error) => {
            failed(rows, &error);
            return None;
        }
    };
    let embree = Observed::<Embree, _>::new("embree", scene);
    let mut vote = Ok(BTreeSet::new());
    let judgement = compare(spec, &embree, |spec, scene| match compare::embree::compare(
        &spec.primitives,
        scene,
    ) {
        Ok(found) => {
            vote = Ok(found.first.iter().map(|d| d.pixel).collect());
            judge(&found, edge_budget)
        }
        Err(error) => {
            vote = Err(error);
            Judgement::new(Class::Vote, "pairs")
        }
    });
    let unlike = match vote {
        Ok(unlike) => unlike,
        Err(error) => {
            failed(rows, &error);
            return None;
        }
    };
    let embree = embree.taking(start.elapsed());
    let spec = spec.map(|_| ()).taking(spec.value.times.cover);
    rows.add("cover", &spec, &embree, judgement);
    Some((embree.value, unlike))
}

fn judge(vote: &compare::embree::EmbreeVote, edge_budget: Option<f64>) -> Judgement {
    let mut judgement = Judgement {
        compared: vote.pairs,
        causes: vote.causes(),
        admitted: vote.admitted(),
        admitted_budget: edge_budget,
        error: Some(vote.error_keys),
        error_over_bound: Some(vote.error_over_bound),
        described: vote.first.iter().map(ToString::to_string).collect(),
        note: vote.to_string(),
        ..Judgement::new(Class::Vote, "pairs")
    };
    // Rays that meet nothing agree, too; without a pair they are what was compared.
    if judgement.compared == 0 {
        judgement.unit = "rays";
        judgement.compared = vote.rays;
    } else if judgement.compared == judgement.admitted && vote.disagreeing() == 0 {
        let reason = format!("all {} pairs are in class edge", vote.pairs);
        judgement.skipped = Some(reason);
    }
    judgement
}

/// Triangles, pixels and fragments of a scene that Embree is asked of in world space by
/// default. There a pair costs about twice what it does in screen space.
pub const WORLD_MAX: u64 = 1 << 17;

/// Asks Embree in world space and adds row [`WORLD`].
pub fn run_world(
    Loaded { scene, world, .. }: &Loaded,
    extent: Extent,
    spec: &Observed<Spec, SpecRun>,
    rows: &mut Rows,
) {
    let skip = |rows: &mut Rows, reason: String| {
        rows.skip(WORLD, &spec.label, "embree", Class::Vote, reason);
    };
    if scene.triangles.is_empty() {
        return skip(rows, "plan: no triangles".to_owned());
    }
    if scene.samples.count() > 1 {
        let reason = "in world space Embree is asked of one sample a pixel".to_owned();
        return skip(rows, reason);
    }
    if extent == Extent::Small {
        let counts = [scene.triangles.len(), scene.size.pixels()];
        let counts: u64 = counts.into_iter().map(|n| n as u64).sum();
        let items = counts + raster::count(&spec.value.primitives);
        if items > WORLD_MAX {
            let reason = "in world space only if asked for: --leg embree".to_owned();
            return skip(rows, reason);
        }
    }
    let world = &World::new(&world.points(scene), View::new(world.camera, scene.size));
    let start = Instant::now();
    let failed = |rows: &mut Rows, error: &EmbreeError| {
        rows.fail(WORLD, &spec.label, "embree", None, error.to_string());
    };
    let seen = match WorldScene::new(scene, world) {
        Ok(seen) => Observed::<Embree, _>::new("embree", seen),
        Err(error) => return failed(rows, &error),
    };
    let mut vote = Ok(());
    let judgement = compare(spec, &seen, |spec, seen| {
        let voted = compare::embree::compare_world(scene, world, &spec.primitives, seen);
        match voted {
            Ok((vote, share)) => {
                let mut judgement = judge(&vote, None);
                let share = 100.0 * share;
                let note = &judgement.note;
                judgement.note =
                    format!("{note}; the band of class edge is {share:.3} % of the area");
                judgement
            }
            Err(error) => {
                vote = Err(error);
                Judgement::new(Class::Vote, "pairs")
            }
        }
    });
    if let Err(error) = vote {
        return failed(rows, &error);
    }
    let spec = spec.map(|_| ()).taking(spec.value.times.cover);
    rows.add(WORLD, &spec, &seen.taking(start.elapsed()), judgement);
}

/// What Embree saw.
pub struct EmbreeSeen {
    /// Its hits in order of distance, blended like lists.
    pub picture: Vec<[f32; 3]>,
    /// How many hits there are, each triangle once a ray.
    pub hits: u64,
    /// How many rays hit something.
    pub pixels: u64,
}

/// Asks Embree for every ray's hits.
///
/// # Errors
/// The first error that Embree reports.
pub fn look(
    scene: &Scene,
    spec: &SpecRun,
    embree: &EmbreeScene,
) -> Result<EmbreeSeen, EmbreeError> {
    let mut seen = EmbreeSeen {
        picture: Vec::with_capacity(scene.size.pixels()),
        hits: 0,
        pixels: 0,
    };
    let mut hits: Vec<Hit> = Vec::new();
    let rows = 0..scene.size.height;
    for (x, y) in rows.flat_map(|y| (0..scene.size.width).map(move |x| (x, y))) {
        embree.hits(x, y, &mut hits)?;
        hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.prim.cmp(&b.prim)));
        hits.dedup_by_key(|h| h.prim);
        seen.hits += hits.len() as u64;
        seen.pixels += u64::from(!hits.is_empty());
        seen.picture.push(blend(scene, spec, &hits));
    }
    Ok(seen)
}

fn blend(scene: &Scene, spec: &SpecRun, hits: &[Hit]) -> [f32; 3] {
    let mut sum = [0.0; 3];
    let mut transmittance = 1.0;
    for hit in hits {
        let [r, g, b, a] = spec.faces[hit.prim as usize];
        for (sum, c) in sum.iter_mut().zip([r, g, b]) {
            *sum += transmittance * a * c;
        }
        transmittance *= 1.0 - a;
    }
    for (sum, c) in sum.iter_mut().zip(scene.background) {
        *sum += transmittance * c;
    }
    sum
}
