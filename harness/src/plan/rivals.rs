//! Which rivals of the lists a scene asks for.

use super::Pass;
use crate::registry::RIVALS;
use crate::scene::Loaded;

/// What a scene asks for beside its lists.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Asked {
    /// The techniques that need no lists.
    pub rivals: bool,
}

impl Asked {
    /// Scenes of family `raster` are about coverage and keys, and ask for nothing.
    pub fn by(loaded: &Loaded) -> Self {
        Self {
            rivals: loaded.family != "raster",
        }
    }

    /// A pass for each rival. Nothing of the picture needs it, so that it is left out also
    /// where nothing is skipped.
    pub(super) fn passes(self, transparent: usize) -> impl Iterator<Item = Pass> {
        RIVALS.into_iter().map(move |name| {
            let needed = self.needed(transparent);
            Pass {
                name,
                runs: needed.is_ok(),
                reason: needed.unwrap_or_else(str::to_owned),
            }
        })
    }

    fn needed(self, transparent: usize) -> Result<String, &'static str> {
        match transparent {
            0 => Err("no transparent triangles"),
            _ if !self.rivals => Err("the scenes of the A-buffer are for its rivals"),
            n => Ok(format!("{n} transparent triangles, beside their lists")),
        }
    }
}
