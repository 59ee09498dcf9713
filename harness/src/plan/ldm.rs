//! Passes of layered depth maps.

use super::{Pass, decided, skipped};
use crate::registry::Chain;
use crate::scene::Loaded;
use crate::scene::ldm::Ldm;

/// What a scene with an `[ldm]` needs. Which directions its receivers' normals need is known only
/// once they are seen: the spec's facts count those that are left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LdmPlan {
    /// Every pass of the family, in order.
    pub passes: Vec<Pass>,
}

impl LdmPlan {
    /// Without surfaces nobody asks what is open; without blockers there is nothing in any map,
    /// and everything is; without a sky there is no light; only what the scene says mirrors.
    pub fn new(loaded: &Loaded, skip: bool) -> Self {
        let [seen, blocking] = loaded.parts();
        let ldm = loaded.file.ldm.as_ref().map(|l| l.get_ref());
        let maps = ldm.map_or(0, Ldm::maps);
        let mirrors = ldm.is_some_and(|l| l.mirror);
        let needed = |name: &str| match name {
            _ if seen == 0 => Err("nothing is seen"),
            "environment" if loaded.sky.is_none() => Err("there is no sky"),
            "mirror" if !mirrors => Err("nothing mirrors"),
            "layers" | "chain" | "neighbours" if blocking == 0 => Err("nothing blocks"),
            "layers" | "chain" => Ok(format!("{blocking} triangles in {maps} maps")),
            _ => Ok(format!("{seen} triangles are seen")),
        };
        Self {
            passes: decided(Chain::Maps, skip, needed),
        }
    }

    /// Why a pass does not run; `None` if it does.
    pub fn skipped(&self, name: &str) -> Option<String> {
        skipped(&self.passes, name)
    }
}
