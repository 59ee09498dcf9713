//! Passes of rays in queues.

use super::{Pass, decided, skipped};
use crate::registry::Chain;
use crate::scene::Loaded;

/// What a scene with a `[dispatch]` needs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DispatchPlan {
    /// Every pass of the family, in order.
    pub passes: Vec<Pass>,
}

impl DispatchPlan {
    /// Without triangles no ray meets anything; without lamps nothing is lit; where nothing mirrors, or no
    /// mirror may be seen, no ray is sent on. Rays towards lamps that cannot light a point, and mirror
    /// rays of what does not mirror, are left out point by point, skipping or not.
    pub fn new(loaded: &Loaded, skip: bool) -> Self {
        let triangles = loaded.scene.triangles.len();
        let section = loaded.file.dispatch.as_ref().map(|d| d.get_ref());
        let lamps = section.map_or(0, |d| d.lamp.len());
        let depth = section.map_or(0, |d| d.depth.0);
        let mirrors = loaded.world.mirrors.iter();
        let mirrors = mirrors.filter(|m| m.iter().any(|c| *c > 0.0)).count();
        let needed = |name: &str| match name {
            "primary" | "deposit" => Ok("the picture".to_owned()),
            _ if triangles == 0 => Err("there are no triangles"),
            "light" if lamps == 0 => Err("there are no lamps"),
            "light" => Ok(format!("{lamps} lamps")),
            "reflect" if mirrors == 0 => Err("nothing mirrors"),
            "reflect" if depth == 0 => Err("no mirror may be seen"),
            "reflect" => Ok(format!("{mirrors} triangles mirror")),
            _ => Ok(format!("{triangles} triangles")),
        };
        Self {
            passes: decided(Chain::Traced, skip, needed),
        }
    }

    /// Why a pass does not run; `None` if it does.
    pub fn skipped(&self, name: &str) -> Option<String> {
        skipped(&self.passes, name)
    }
}
