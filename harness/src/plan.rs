//! What a scene needs, decided before anything runs.

mod dispatch;
mod grid;
mod layouts;
mod ldm;
mod rivals;
mod rsm;

use triptych_gpu::abuffer::Options;
use triptych_spec::abuffer::Order;
use triptych_spec::scene::Scene;

use crate::registry::{Chain, stages_of};
use crate::scene::Loaded;
pub use dispatch::DispatchPlan;
pub use grid::GridPlan;
pub use ldm::LdmPlan;
pub use rivals::Asked;
pub use rsm::RsmPlan;

/// A condition inside stage resolve, where pixels have several samples.
pub const ONCE: &str = "shade once";

/// One pass: whether it runs, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pass {
    /// Stage name.
    pub name: &'static str,
    /// Whether it runs.
    pub runs: bool,
    /// One clause.
    pub reason: String,
}

/// Which passes a scene needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Every pass of the family, in order.
    pub passes: Vec<Pass>,
    /// Whether opaque triangles are drawn.
    pub opaque: bool,
    /// Whether lists are built, sorted and blended.
    pub lists: bool,
    /// Whether fragments at or behind an opaque surface are left out.
    pub depth_test: bool,
    /// Whether every fragment is streamed out and compared.
    pub cover: bool,
    /// Which rivals of the lists are asked for.
    pub asked: Asked,
    /// Whether pixels whose samples are all alike are shaded once.
    pub once: bool,
}

impl Plan {
    /// The plan of a scene that is loaded, with the rivals that it asks for.
    pub fn of(loaded: &Loaded, skip: bool) -> Self {
        Self::asking(&loaded.scene, skip, Asked::by(loaded))
    }

    /// The plan of a scene, without rivals. With `skip` false everything runs and every
    /// transparent fragment is stored.
    pub fn new(scene: &Scene, skip: bool) -> Self {
        Self::asking(scene, skip, Asked::default())
    }

    /// The same with these rivals.
    pub fn asking(scene: &Scene, skip: bool, asked: Asked) -> Self {
        let opaque = scene.triangles.iter().filter(|t| t.is_opaque()).count();
        let transparent = scene.triangles.len() - opaque;
        let mut passes = Vec::new();
        let mut decide = |name, needed: bool, why: String, why_not: &str| {
            let runs = needed || !skip;
            let reason = match (needed, skip) {
                (true, _) => why,
                (false, true) => why_not.to_owned(),
                (false, false) => format!("not needed ({why_not}), but nothing is skipped"),
            };
            passes.push(Pass { name, runs, reason });
            runs
        };
        let any = !scene.triangles.is_empty();
        let all = format!("{} triangles", scene.triangles.len());
        for name in ["transform", "clip", "snap"] {
            decide(name, any, all.clone(), "no triangles");
        }
        let cover = decide(
            "cover",
            opaque > 0,
            format!("{opaque} opaque triangles are in no list"),
            if any {
                "the lists hold every fragment"
            } else {
                "no triangles"
            },
        );
        let opaque_runs = decide(
            "opaque",
            opaque > 0,
            format!("{opaque} opaque triangles"),
            "no opaque triangles",
        );
        let mut lists = false;
        for name in ["build", "sort"] {
            let why = format!("{transparent} transparent triangles");
            lists = decide(name, transparent > 0, why, "no transparent triangles");
        }
        decide("resolve", true, "the picture".into(), "");
        passes.extend(asked.passes(transparent, scene.samples.count()));
        passes.extend(by_tiles(transparent, scene, skip));
        passes.extend(layouts::passes(asked.rivals, transparent));
        let depth_test = skip && opaque > 0 && transparent > 0;
        passes.push(Pass {
            name: "depth test",
            runs: depth_test,
            reason: match (skip, depth_test) {
                (true, true) => "fragments at or behind an opaque surface are not stored".into(),
                (true, false) => "opaque and transparent triangles do not meet".into(),
                (false, _) => "nothing is skipped: hidden fragments are stored".into(),
            },
        });
        let shading = shading(scene, skip);
        let once = shading.as_ref().is_some_and(|pass| pass.runs);
        passes.extend(shading);
        Self {
            passes,
            once,
            opaque: opaque_runs,
            lists,
            depth_test,
            cover,
            asked,
        }
    }

    /// What lists and their picture are made by.
    pub fn abuffer(&self, scene: &Scene) -> Options<'static> {
        Options {
            given: None,
            capacity: None,
            opaque: self.opaque,
            lists: self.lists,
            depth_test: self.depth_test,
            order: scene.order,
            once: self.once,
            background: scene.background,
        }
    }

    /// Why a pass does not run; `None` if it does.
    pub fn skipped(&self, name: &str) -> Option<String> {
        skipped(&self.passes, name)
    }
}

/// The passes of lists by tiles, which have one order for all samples of a pixel.
fn by_tiles(transparent: usize, scene: &Scene, skip: bool) -> impl Iterator<Item = Pass> {
    let by_sample = scene.samples.count() > 1 && scene.order == Order::Sample;
    let none = "no transparent triangles";
    let reason = move || match (by_sample, transparent, skip) {
        (true, ..) => "layers lie by their keys at each sample".to_owned(),
        (_, 0, true) => none.to_owned(),
        (_, 0, false) => format!("not needed ({none}), but nothing is skipped"),
        _ => format!("{transparent} transparent triangles"),
    };
    let stages = ["bin", "jagged", "shade", "local", "linked"];
    stages.into_iter().map(move |name| Pass {
        name,
        runs: !by_sample && (transparent > 0 || !skip),
        reason: reason(),
    })
}

/// Whether pixels whose samples are all alike are shaded once; `None` with one sample a pixel.
fn shading(scene: &Scene, skip: bool) -> Option<Pass> {
    let samples = scene.samples.count();
    (samples > 1).then(|| Pass {
        name: ONCE,
        runs: skip,
        reason: match skip {
            true => format!("pixels whose {samples} samples are alike are shaded once"),
            false => "nothing is skipped: every sample is shaded".into(),
        },
    })
}

/// What a scene needs.
pub fn passes(loaded: &Loaded, skip: bool) -> Vec<Pass> {
    match loaded.chain() {
        Chain::Frame => Plan::of(loaded, skip).passes,
        Chain::Rays => GridPlan::new(loaded, skip).passes,
        Chain::Indirect => RsmPlan::new(loaded, skip).passes,
        Chain::Maps => LdmPlan::new(loaded, skip).passes,
        Chain::Traced => DispatchPlan::new(loaded, skip).passes,
    }
}

/// Every stage of a chain, by what needs it, or by why nothing does.
fn decided(
    chain: Chain,
    skip: bool,
    needed: impl Fn(&str) -> Result<String, &'static str>,
) -> Vec<Pass> {
    let pass = |stage: &crate::registry::Stage| {
        let needed = needed(stage.name);
        Pass {
            name: stage.name,
            runs: needed.is_ok() || !skip,
            reason: match (needed, skip) {
                (Ok(why), _) => why,
                (Err(why), true) => why.to_owned(),
                (Err(why), false) => format!("{why}, but nothing is skipped"),
            },
        }
    };
    stages_of(chain).map(pass).collect()
}

/// Why a pass does not run; `None` if it does.
fn skipped(passes: &[Pass], name: &str) -> Option<String> {
    let pass = passes.iter().find(|pass| pass.name == name)?;
    (!pass.runs).then(|| format!("plan: {}", pass.reason))
}
