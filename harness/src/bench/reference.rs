//! What the spec says on one sub-pixel grid: the pictures that are compared with.

use triptych_spec::abuffer::{nearest_layers, resolve};
use triptych_spec::bound::Bounded;
use triptych_spec::scene::Scene;
use triptych_spec::vertex::primitives;

use super::Method;
use super::counts::Counts;
use super::error::{Error, psnr};
use crate::compare::{compare, image};
use crate::observe::{Gpu, Observed, Spec};
use crate::plan::Plan;
use crate::replay::spec::SpecRun;

/// The spec's picture, with bounds.
type Picture = Observed<Spec, Vec<[Bounded; 3]>>;

/// The spec on one grid.
pub(super) struct Grid {
    pub(super) run: SpecRun,
    pub(super) counts: Counts,
    /// The numbers of layers that are measured.
    pub(super) layers: Vec<u32>,
    /// The picture of so many nearest layers, where that is not the exact one.
    pictures: Vec<(u32, Picture)>,
    exact: Picture,
}

impl Grid {
    /// Runs the spec with all layers.
    pub(super) fn new(scene: &Scene, plan: &Plan, bits: u32) -> Result<Self, String> {
        let mut run = SpecRun::new(scene, primitives(scene, bits), plan)?;
        Ok(Self {
            counts: Counts::of(&run),
            layers: Vec::new(),
            pictures: Vec::new(),
            exact: Observed::new("spec", std::mem::take(&mut run.image)),
            run,
        })
    }

    /// Draws the pictures of fewer layers.
    pub(super) fn draw(&mut self, scene: &Scene, wanted: Option<&[u32]>) {
        self.layers = layers(wanted, self.counts.longest());
        let SpecRun {
            primitives,
            opaque,
            lists,
            ..
        } = &self.run;
        for n in self.layers.iter().filter(|n| **n < self.counts.longest()) {
            let picture = resolve(scene, primitives, opaque, &nearest_layers(lists, *n));
            self.pictures.push((*n, Observed::new("spec", picture)));
        }
    }

    /// The picture of so many nearest layers.
    pub(super) fn picture(&self, layers: u32) -> &Picture {
        let drawn = self.pictures.iter().find(|(n, _)| *n == layers);
        drawn.map_or(&self.exact, |(_, picture)| picture)
    }

    /// What is wrong with a leg's picture of so many nearest layers.
    pub(super) fn wrong(
        &self,
        label: &str,
        layers: u32,
        method: Method,
        picture: Vec<[f32; 3]>,
    ) -> Option<String> {
        let width = self.run.primitives.size.width;
        let seen = Observed::<Gpu, _>::new(label, picture);
        let must = self.picture(layers);
        let judgement = compare(must, &seen, |a, b| image::compare(a, b, width));
        let (differ, compared) = (judgement.differ(), judgement.compared);
        (differ > 0 || compared == 0).then(|| {
            let first = judgement.described.first().cloned().unwrap_or_default();
            let method = method.name();
            format!(
                "{label}, {layers} layers by {method}: {differ} of {compared} channels differ; {first}"
            )
        })
    }

    /// How far a picture is from the exact one.
    pub(super) fn error(&self, seen: impl IntoIterator<Item = [f64; 3]>) -> Error {
        psnr(&self.exact.value, seen)
    }
}

/// The numbers of layers that are measured on lists of up to `longest`: those that are
/// wanted, else 1, 2, 4, …; and all, of which there are not more.
fn layers(wanted: Option<&[u32]>, longest: u32) -> Vec<u32> {
    let powers = || {
        (0..32)
            .map(|i| 1 << i)
            .take_while(|n| *n < longest)
            .collect()
    };
    let mut layers: Vec<u32> = wanted.map_or_else(powers, <[u32]>::to_vec);
    layers.iter_mut().for_each(|n| *n = longest.min(*n));
    layers.push(longest);
    layers.sort_unstable();
    layers.dedup();
    layers
}

#[cfg(test)]
mod tests {
    use super::layers;

    #[test]
    fn all_layers_are_always_among_them() {
        assert_eq!(layers(None, 1), [1]);
        assert_eq!(layers(None, 8), [1, 2, 4, 8]);
        assert_eq!(layers(None, 13), [1, 2, 4, 8, 13]);
        assert_eq!(layers(Some(&[20, 3, 3]), 13), [3, 13]);
    }
}
