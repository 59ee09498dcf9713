//! Which rivals of the lists a scene asks for.

use triptych_spec::abuffer::{Lens, Reduction};

use super::Pass;
use crate::registry::RIVALS;
use crate::scene::Loaded;

/// What a scene asks for beside its lists.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Asked {
    /// The techniques that need no lists.
    pub rivals: bool,
    /// A medium between the layers, of this density over the depth range.
    pub density: Option<f32>,
    /// A lens.
    pub defocus: Option<Lens>,
    /// Fragments at a resolution that is reduced so far.
    pub reduced: Option<Reduction>,
}

impl Asked {
    /// Scenes of family `raster` are about coverage and keys: they have rivals only if they
    /// state what those need.
    pub fn by(loaded: &Loaded) -> Self {
        let stated = loaded.file.abuffer;
        Self {
            rivals: loaded.family != "raster",
            density: stated.density.map(|density| density.0),
            defocus: stated.defocus.map(|defocus| defocus.0),
            reduced: stated.reduced.map(|reduced| reduced.0),
        }
    }

    /// A pass for each rival. Nothing of the picture needs it, so that it is left out also
    /// where nothing is skipped.
    pub(super) fn passes(self, transparent: usize, samples: u32) -> impl Iterator<Item = Pass> {
        RIVALS.into_iter().map(move |name| {
            let needed = self.needed(name, transparent, samples);
            Pass {
                name,
                runs: needed.is_ok(),
                reason: needed.unwrap_or_else(str::to_owned),
            }
        })
    }

    fn needed(self, name: &str, transparent: usize, samples: u32) -> Result<String, &'static str> {
        match name {
            _ if samples > 1 => Err("rivals have one sample a pixel"),
            _ if transparent == 0 => Err("no transparent triangles"),
            "density" => {
                let density = self.density.ok_or("the scene states no density")?;
                Ok(format!("a medium of density {density}"))
            }
            "defocus" => {
                let lens = self.defocus.ok_or("the scene states no defocus")?;
                Ok(format!("a lens of aperture {}", lens.aperture))
            }
            "reduced" => {
                let reduction = self.reduced.ok_or("the scene states no reduction")?;
                Ok(format!("pixels of {0} x {0}", reduction.side()))
            }
            _ if !self.rivals => Err("scenes of raster are about coverage"),
            _ => Ok(format!("{transparent} transparent triangles")),
        }
    }
}
