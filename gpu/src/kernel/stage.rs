//! What a stage is, as far as its kernels go.

use super::STAGES;

/// A stage as far as its kernels go.
#[derive(Debug, PartialEq, Eq)]
pub struct Stage {
    /// Its name, as in the spec and on the command line.
    pub name: &'static str,
    /// The WGSL file that ships its entry points.
    pub file: &'static str,
    /// Its compute kernels, in the order in which they run.
    pub compute: &'static [&'static str],
    /// Its fragment kernels; none where the stage needs no rasteriser.
    pub fragment: &'static [&'static str],
    /// What one invocation does, in sentences.
    pub contract: &'static str,
}

const ROW: &str = "Compute: item `i` below frame.items is a row of a triangle, or a share of one: \
    of the last entry of `work` from frame.work_first, frame.work_count of them, whose y is at \
    most i; its x is the triangle, whose corners are nine numbers of `corners`. Of its items, \
    which begin at that y, so many share each row as stride_of of stride.wgsl says, from the row \
    of the band on that first_row of walk.wgsl says, and take one column of so many each. \
    Fragment: the hardware's rasteriser calls it for every covered pixel, with the triangle at \
    location 0.";

impl Stage {
    /// The stage of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        STAGES.iter().find(|stage| stage.name == name)
    }

    /// What one invocation does, in full.
    pub fn invocation(&self) -> String {
        match self.fragment {
            [] => self.contract.to_owned(),
            _ => format!("{} {ROW}", self.contract),
        }
    }
}
