//! How a scene's frames are sampled, and options of the A-buffer.

use serde::Deserialize;
use triptych_spec::abuffer::Order;
use triptych_spec::raster::Samples;

use super::blending::{Defocus, Density, Reduced};
use super::value::Capacity;
use super::{InputError, Parsed};

/// Samples of a pixel, in the standard pattern of their number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(try_from = "i64")]
pub struct SampleCount(pub Samples);

impl TryFrom<i64> for SampleCount {
    type Error = String;
    fn try_from(v: i64) -> Result<Self, String> {
        let count = u32::try_from(v).ok();
        let samples = count.and_then(Samples::standard);
        samples
            .map(Self)
            .ok_or_else(|| format!("{v} is not 1, 2, 4 or 8 samples a pixel"))
    }
}

/// Options of the A-buffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Abuffer {
    /// Nodes of the first attempt; fewer than needed makes it overflow.
    #[serde(default)]
    pub capacity: Capacity,
    /// In which order layers lie at each sample of a pixel; needs several.
    #[serde(default)]
    pub order: LayerOrder,
    /// A medium between the layers; without it stage `density` does not run.
    pub density: Option<Density>,
    /// A lens; without it stage `defocus` does not run.
    pub defocus: Option<Defocus>,
    /// A reduced resolution; without it stage `reduced` does not run.
    pub reduced: Option<Reduced>,
}

/// In which order layers lie at each sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LayerOrder {
    /// That of their lists, by the keys at the lowest covered samples.
    #[default]
    Centroid,
    /// By their keys at the sample itself.
    Sample,
}

impl LayerOrder {
    /// As the legs know it.
    pub fn order(self) -> Order {
        match self {
            Self::Centroid => Order::Centroid,
            Self::Sample => Order::Sample,
        }
    }
}

/// Whether something is judged where other families are, with its line.
pub(super) fn is_judged_later(file: &super::file::SceneFile) -> bool {
    file.abuffer.order == LayerOrder::Sample
}

/// Refuses an order of layers for each sample where there is one.
pub(super) fn check(parsed: &Parsed) -> Result<(), InputError> {
    let file = &parsed.file;
    let each = file.abuffer.order == LayerOrder::Sample;
    match each && file.samples.0.count() == 1 {
        true => Err(parsed.mistake(
            "abuffer.order",
            "needs several samples a pixel; state samples = 4 beside the size",
        )),
        false => Ok(()),
    }
}
