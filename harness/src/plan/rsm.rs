//! Passes of indirect light.

use super::{Pass, decided, skipped};
use crate::registry::Chain;
use crate::scene::Loaded;

/// What a scene with an `[rsm]` needs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RsmPlan {
    /// Every pass of the family, in order.
    pub passes: Vec<Pass>,
}

impl RsmPlan {
    /// Without surfaces there is no light to gather; without blockers no grid, no buffer B and
    /// nothing to blur; with a blur over no neighbours, buffer B is what it was.
    pub fn new(loaded: &Loaded, skip: bool) -> Self {
        let [seen, blocking] = loaded.parts();
        let radius = loaded.file.rsm.as_ref().map_or(0, |r| r.get_ref().blur.0);
        let see = || Ok(format!("{seen} triangles are seen"));
        let needed = |name: &str| match name {
            "gbuffer" | "compose" => see(),
            _ if seen == 0 => Err("nothing is seen"),
            "block" | "blur" if blocking == 0 => Err("nothing blocks indirect light"),
            "blur" if radius == 0 => Err("a mean over one pixel is that pixel"),
            "block" | "blur" => Ok(format!("{blocking} triangles block indirect light")),
            _ => see(),
        };
        Self {
            passes: decided(Chain::Indirect, skip, needed),
        }
    }

    /// Why a pass does not run; `None` if it does.
    pub fn skipped(&self, name: &str) -> Option<String> {
        skipped(&self.passes, name)
    }
}
