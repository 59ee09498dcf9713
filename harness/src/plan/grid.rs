//! Passes of rays through a grid.

use super::Pass;
use crate::registry::{Chain, Stage, stages_of};
use crate::scene::Loaded;

/// What a scene with a grid needs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GridPlan {
    /// Every pass of the family, in order.
    pub passes: Vec<Pass>,
}

impl GridPlan {
    /// Without triangles there is no grid, and no ray meets anything.
    pub fn new(loaded: &Loaded, skip: bool) -> Self {
        let triangles = loaded.scene.triangles.len();
        let needed = triangles > 0;
        let pass = |stage: &Stage| Pass {
            name: stage.name,
            runs: needed || !skip,
            reason: match (needed, skip) {
                (true, _) => format!("{triangles} triangles block rays"),
                (false, true) => "nothing blocks a ray".to_owned(),
                (false, false) => "nothing blocks a ray, but nothing is skipped".to_owned(),
            },
        };
        Self {
            passes: stages_of(Chain::Rays).map(pass).collect(),
        }
    }

    /// Why nothing runs; `None` if all does.
    pub fn skipped(&self) -> Option<String> {
        let idle = self.passes.iter().find(|pass| !pass.runs)?;
        Some(format!("plan: {}", idle.reason))
    }
}
