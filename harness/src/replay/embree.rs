//! The Embree leg of one scene.

use std::time::Instant;

use triptych_spec::scene::Scene;

use super::rows::Rows;
use super::spec::SpecRun;
use crate::compare::{self, Judgement, compare};
use crate::embree::{EmbreeError, EmbreeScene, Hit, RayHits};
use crate::observe::{Embree, Observed, Spec};
use crate::row::Class;

/// Asks Embree for its vote and adds the row; gives the scene for a picture.
pub fn run(
    spec: &Observed<Spec, SpecRun>,
    edge_budget: Option<f64>,
    rows: &mut Rows,
) -> Option<EmbreeScene> {
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
    let mut vote = Ok(());
    let judgement = compare(spec, &embree, |spec, scene| match compare::embree::compare(
        &spec.primitives,
        scene,
    ) {
        Ok(vote) => judge(&vote, edge_budget),
        Err(error) => {
            vote = Err(error);
            Judgement::new(Class::Vote, "pairs")
        }
    });
    if let Err(error) = vote {
        failed(rows, &error);
        return None;
    }
    let embree = embree.taking(start.elapsed());
    let spec = spec.map(|_| ()).taking(spec.value.times.cover);
    rows.add("cover", &spec, &embree, judgement);
    Some(embree.value)
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

/// What Embree saw: its hits in order of distance, blended like a list.
pub fn picture(scene: &Scene, spec: &SpecRun, embree: &EmbreeScene) -> Vec<[f32; 3]> {
    let mut hits: Vec<Hit> = Vec::new();
    let mut pixel = |x, y| {
        if embree.hits(x, y, &mut hits).is_err() {
            return scene.background;
        }
        hits.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.prim.cmp(&b.prim)));
        hits.dedup_by_key(|h| h.prim);
        let mut sum = [0.0; 3];
        let mut transmittance = 1.0;
        for hit in &hits {
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
    };
    let rows = 0..scene.size.height;
    rows.flat_map(|y| (0..scene.size.width).map(move |x| (x, y)))
        .map(|(x, y)| pixel(x, y))
        .collect()
}
