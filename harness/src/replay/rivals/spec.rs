//! What the spec makes of the rivals, each once, when it is first asked for.

use std::sync::OnceLock;
use std::time::Duration;

use triptych_gpu::abuffer::rivals::Technique;
use triptych_spec::abuffer::{self, Sorted};
use triptych_spec::bound::Bounded;
use triptych_spec::scene::Scene;

use crate::replay::spec::{SpecRun, timed};

/// Layers, and their picture.
pub struct Layered {
    /// Every pixel's fragments, as they are peeled.
    pub sorted: Sorted,
    /// The picture, with bounds.
    pub image: Vec<[Bounded; 3]>,
    /// How long both took.
    pub time: Duration,
}

/// The spec's rivals of one set of triangles.
#[derive(Default)]
pub struct Rivals {
    peel: OnceLock<Layered>,
    dual: OnceLock<Layered>,
}

impl Rivals {
    /// What is peeled, and its picture.
    pub fn layered(&self, technique: Technique, scene: &Scene, spec: &SpecRun) -> &Layered {
        let SpecRun {
            primitives, opaque, ..
        } = spec;
        let layered = |(sorted, peeling), (image, blending)| Layered {
            sorted,
            image,
            time: peeling + blending,
        };
        match technique {
            Technique::Peel => self.peel.get_or_init(|| {
                let most = abuffer::LAYERS_MAX;
                let peeled = timed(|| abuffer::peel(scene, primitives, opaque, most));
                let image = timed(|| abuffer::resolve(scene, primitives, opaque, &peeled.0));
                layered(peeled, image)
            }),
            Technique::Dual => self.dual.get_or_init(|| {
                let peeled = timed(|| abuffer::dual(scene, primitives, opaque));
                let image = timed(|| abuffer::halves(scene, primitives, opaque, &peeled.0));
                layered(peeled, image)
            }),
            Technique::Alpha => todo!(),
        }
    }
}
