//! What the spec makes of the rivals, each once, when it is first asked for.

use std::sync::OnceLock;
use std::time::Duration;

use triptych_spec::abuffer::{self, LAYERS_MAX, Lens, Opaque, Sorted, Target};
use triptych_spec::bound::Bounded;
use triptych_spec::layouts;
use triptych_spec::scene::Scene;
use triptych_spec::vertex::Primitives;

use super::reduced::Halved;
use crate::plan::Asked;
use crate::replay::pieces::bands;
use crate::replay::spec::{SpecRun, timed};

/// A picture.
pub struct Picture {
    /// Row by row, with bounds.
    pub image: Vec<[Bounded; 3]>,
    /// How long it took, with what it needs.
    pub time: Duration,
}

/// Layers, and their picture.
pub struct Layered {
    /// Every pixel's fragments, as they are peeled.
    pub sorted: Sorted,
    /// What they show.
    pub picture: Picture,
}

/// The spec's rivals of one set of triangles, and of one scene's parameters.
#[derive(Default)]
pub struct Rivals {
    asked: Asked,
    peel: OnceLock<Layered>,
    dual: OnceLock<Layered>,
    single: OnceLock<Picture>,
    half: OnceLock<Picture>,
    weighted: OnceLock<Picture>,
    density: OnceLock<Picture>,
    defocus: OnceLock<Picture>,
    listed: OnceLock<Listed>,
    packed: OnceLock<Listed>,
    reduced: OnceLock<Halved>,
}

/// Numbers of nearest layers that pictures are made of, beside that of all: the paper's.
pub const NEAREST: [u32; 7] = [0, 2, 4, 8, 16, 32, 64];

/// What lists show in the order that they are in.
pub struct Listed {
    /// The picture of all layers.
    pub all: Vec<[Bounded; 3]>,
    /// How many nearest ones are shown alone: of [`NEAREST`], the most that leave any out.
    pub layers: u32,
    /// The picture of these.
    pub nearest: Vec<[Bounded; 3]>,
}

impl Listed {
    fn of(sorted: &Sorted, blend: impl Fn(&Sorted) -> Vec<[Bounded; 3]>) -> Self {
        let longest = sorted.longest();
        let fewer = NEAREST.into_iter().rev().find(|n| *n < longest);
        let layers = fewer.unwrap_or(0);
        Self {
            all: blend(sorted),
            layers,
            nearest: blend(&abuffer::nearest_of(sorted, layers)),
        }
    }
}

fn picture(image: impl FnOnce() -> Vec<[Bounded; 3]>) -> Picture {
    let (image, time) = timed(image);
    Picture { image, time }
}

fn layered(
    peel: impl FnOnce() -> Sorted,
    blend: impl FnOnce(&Sorted) -> Vec<[Bounded; 3]>,
) -> Layered {
    let (sorted, peeling) = timed(peel);
    let mut picture = picture(|| blend(&sorted));
    picture.time += peeling;
    Layered { sorted, picture }
}

impl Rivals {
    /// Nothing yet, of what a plan asks for.
    pub fn new(asked: Asked) -> Self {
        Self {
            asked,
            ..Self::default()
        }
    }

    /// Stage `reduced`, if the scene states a reduction.
    pub fn reduced(&self, scene: &Scene, spec: &SpecRun) -> Option<&Halved> {
        let reduction = self.asked.reduced?;
        let halved = || Halved::of(reduction, scene, spec);
        Some(self.reduced.get_or_init(halved))
    }

    /// Pictures of lists, whatever their layout, in the order that they are in.
    pub fn listed(&self, scene: &Scene, spec: &SpecRun) -> &Listed {
        let (prims, opaque) = (&spec.primitives, &spec.opaque);
        let blend = |sorted: &Sorted| abuffer::resolve_pixels(scene, prims, opaque, sorted);
        self.listed.get_or_init(|| Listed::of(&spec.sorted, blend))
    }

    /// Stage `packed`.
    pub fn packed(&self, scene: &Scene, spec: &SpecRun) -> &Listed {
        let (prims, opaque) = (&spec.primitives, &spec.opaque);
        let blend = |sorted: &Sorted| layouts::packed(scene, prims, opaque, sorted);
        self.packed.get_or_init(|| Listed::of(&spec.sorted, blend))
    }

    /// Stage `peel`, all layers.
    pub fn peel(&self, scene: &Scene, spec: &SpecRun) -> &Layered {
        let (prims, opaque) = (&spec.primitives, &spec.opaque);
        self.peel.get_or_init(|| {
            layered(
                || abuffer::peel(scene, prims, opaque, LAYERS_MAX),
                |sorted| abuffer::resolve(scene, prims, opaque, sorted),
            )
        })
    }

    /// Stage `dual`.
    pub fn dual(&self, scene: &Scene, spec: &SpecRun) -> &Layered {
        let (prims, opaque) = (&spec.primitives, &spec.opaque);
        self.dual.get_or_init(|| {
            layered(
                || abuffer::dual(scene, prims, opaque),
                |sorted| abuffer::halves(scene, prims, opaque, sorted),
            )
        })
    }

    /// Stage `alpha`.
    pub fn alpha(&self, target: Target, scene: &Scene, spec: &SpecRun) -> &Picture {
        let of = match target {
            Target::Single => &self.single,
            Target::Half => &self.half,
        };
        let alpha =
            |prims: &Primitives, opaque: &Opaque| abuffer::alpha(scene, prims, opaque, target);
        of.get_or_init(|| picture(|| bands::picture(&spec.primitives, &spec.opaque, alpha)))
    }

    /// Stage `weighted`.
    pub fn weighted(&self, scene: &Scene, spec: &SpecRun) -> &Picture {
        let weighted =
            |prims: &Primitives, opaque: &Opaque| abuffer::weighted(scene, prims, opaque);
        let made = || picture(|| bands::picture(&spec.primitives, &spec.opaque, weighted));
        self.weighted.get_or_init(made)
    }

    /// Stage `density` and its density, if there is one.
    pub fn density(&self, scene: &Scene, spec: &SpecRun) -> Option<(f32, &Picture)> {
        let (prims, opaque, sorted) = (&spec.primitives, &spec.opaque, &spec.sorted);
        let sigma = self.asked.density?;
        let shade = || picture(|| abuffer::density(scene, prims, opaque, sorted, sigma));
        Some((sigma, self.density.get_or_init(shade)))
    }

    /// Stage `defocus` and its lens, if there is one.
    pub fn defocus(&self, scene: &Scene, spec: &SpecRun) -> Option<(Lens, &Picture)> {
        let (prims, opaque, sorted) = (&spec.primitives, &spec.opaque, &spec.sorted);
        let lens = self.asked.defocus?;
        let shade = || picture(|| abuffer::defocus(scene, prims, opaque, sorted, lens));
        Some((lens, self.defocus.get_or_init(shade)))
    }
}
