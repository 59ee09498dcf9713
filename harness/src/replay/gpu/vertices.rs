//! Whose vertices the later stages start from.

use clap::ValueEnum;

use super::From;

/// Whose vertices the later stages of the GPU leg get.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Vertices {
    /// The spec's snapped triangles: every stage from equal inputs
    #[default]
    Spec,
    /// The GPU's own; what they change is counted in row `vertex`
    Gpu,
    /// Clip space: the driver divides, clips and snaps; coverage by must, may, must not
    Hardware,
}

impl Vertices {
    /// Where the GPU takes over, where that was (or was not) stated as well.
    ///
    /// # Errors
    /// In one line, if the two contradict each other.
    pub fn from(self, stated: Option<From>) -> Result<From, String> {
        let default = match self {
            Self::Spec | Self::Hardware => From::default(),
            Self::Gpu => From::Transform,
        };
        let Some(from) = stated else {
            return Ok(default);
        };
        let fits = match self {
            Self::Spec => true,
            Self::Gpu => from < From::Cover,
            Self::Hardware => false,
        };
        if fits {
            return Ok(from);
        }
        let [vertex, from] = [self.name(), from.name()];
        let right = match self {
            Self::Gpu => "only transform, clip and snap can come first with it",
            _ => "leave --gpu-from out",
        };
        Err(format!(
            "--vertex {vertex} and --gpu-from {from} contradict each other; {right}"
        ))
    }

    /// The name on the command line.
    pub fn name(self) -> String {
        let value = self.to_possible_value().expect("none is hidden");
        value.get_name().to_owned()
    }
}
