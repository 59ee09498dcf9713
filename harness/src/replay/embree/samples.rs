//! Embree's vote where pixels have several samples: parallel rays through each of them.

use std::time::Instant;

use triptych_spec::scene::Scene;

use super::{judge, look};
use crate::compare::{self, Judgement, compare};
use crate::embree::{EmbreeError, EmbreeScene};
use crate::observe::{Embree, Observed, Spec};
use crate::replay::rows::Rows;
use crate::replay::spec::SpecRun;
use crate::row::Class;

/// Asks Embree for its vote on every sample and adds the row; gives the mean of what its rays
/// see, if that is to be shown. The rays through one sample of all pixels are those through the
/// middles at triangles that are moved by as much.
pub fn run_samples(
    scene: &Scene,
    spec: &Observed<Spec, SpecRun>,
    edge_budget: Option<f64>,
    shown: bool,
    rows: &mut Rows,
) -> Option<Vec<[f32; 3]>> {
    let primitives = &spec.value.primitives;
    if primitives.prims.is_empty() {
        let reason = "no triangles reach the rasteriser".to_owned();
        rows.skip("cover", &spec.label, "embree", Class::Vote, reason);
        return None;
    }
    let start = Instant::now();
    let samples = 0..primitives.samples.count();
    let voted: Result<Vec<_>, EmbreeError> = samples
        .map(|s| sample(scene, spec, edge_budget, shown, s))
        .collect();
    let voted = match voted {
        Ok(voted) => voted,
        Err(error) => {
            rows.fail("cover", &spec.label, "embree", None, error.to_string());
            return None;
        }
    };
    let (votes, pictures): (Vec<Judgement>, Vec<_>) = voted.into_iter().unzip();
    let notes = votes.iter().zip(0_u32..);
    let notes: Vec<String> = notes
        .map(|(vote, s)| format!("sample {s}: {}", vote.note))
        .collect();
    let judgement = Judgement {
        note: notes.join("; "),
        ..Judgement::sum(votes)
    };
    let embree = Observed::<Embree, _>::new("embree", ()).taking(start.elapsed());
    let spec = spec.map(|_| ()).taking(spec.value.times.cover);
    rows.add("cover", &spec, &embree, judgement);
    shown.then(|| mean(&pictures))
}

/// One sample's vote, and what its rays see, if that is to be shown.
fn sample(
    scene: &Scene,
    spec: &Observed<Spec, SpecRun>,
    edge_budget: Option<f64>,
    shown: bool,
    s: u32,
) -> Result<(Judgement, Vec<[f32; 3]>), EmbreeError> {
    let moved = spec.value.primitives.of_sample(s);
    let embree = Observed::<Embree, _>::new("embree", EmbreeScene::new(&moved)?);
    let mut vote = Ok(());
    let judgement =
        compare(
            &spec.derive(&moved),
            &embree,
            |moved, embree| match compare::embree::compare(moved, embree) {
                Ok(found) => judge(&found, edge_budget),
                Err(error) => {
                    vote = Err(error);
                    Judgement::new(Class::Vote, "pairs")
                }
            },
        );
    vote?;
    let picture = match shown {
        true => look(scene, &spec.value, &embree.value)?.picture,
        false => Vec::new(),
    };
    Ok((judgement, picture))
}

/// The mean of pictures of one size.
fn mean(pictures: &[Vec<[f32; 3]>]) -> Vec<[f32; 3]> {
    let share = 1.0 / pictures.len() as f32;
    let pixel =
        |pixel: usize| [0, 1, 2].map(|c| pictures.iter().map(|p| share * p[pixel][c]).sum::<f32>());
    (0..pictures.first().map_or(0, Vec::len))
        .map(pixel)
        .collect()
}
