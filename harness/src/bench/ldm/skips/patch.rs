//! Kernels that leave nothing.

use triptych_gpu::kernel::Kernels;
use triptych_gpu::wgsl::Sources;

/// A defect that is none: the same answers by more work.
pub(super) type Patch = (&'static str, &'static str, &'static str);

/// The key of a run of one is taken up and put down; longer runs are sorted as ever.
pub(super) const RUNS_OF_ONE: Patch = (
    "sort",
    "for (var i = 1u; i < run.length; i += 1u)",
    "for (var i = u32(run.length > 1u); i < run.length; i += 1u)",
);

/// A chain of one is merged like any other.
pub(super) const CHAINS_OF_ONE: Patch = (
    "relink",
    "    if !sorted {\n        sorted = next_of(head) == EOL;\n    }\n",
    "",
);

/// Our kernels, with a patch.
pub(super) fn patched(native: bool, patch: Option<Patch>) -> Kernels {
    let with = |sources: Sources| match patch {
        Some((file, find, replace)) => {
            let patched = sources.patched(file, find, replace);
            patched.expect("the text is in our own file, once")
        }
        None => sources,
    };
    Kernels::trusted(native, with)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_can_be_told_to_leave_nothing() {
        for patch in [RUNS_OF_ONE, CHAINS_OF_ONE] {
            patched(false, Some(patch));
        }
    }
}
