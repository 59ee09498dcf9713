//! What the passes of a leg were recorded to do.
//!
//! WGSL's atomics order nothing but themselves: plain data that one invocation writes
//! may be read by another only in a later pass. Drivers seldom show a missing boundary,
//! so it is looked for here. A pass holds one kernel, and what that does to which
//! variable is naga's finding, not our word.

use std::collections::BTreeSet;
use std::sync::Arc;

use naga::valid::GlobalUse;
use naga::{Module, StorageAccess, TypeInner};

use crate::wgsl::Program;

/// Storage variables of plain data that a kernel touches. Variables that hold nothing
/// but atomics are left out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Uses {
    /// Read.
    pub reads: BTreeSet<String>,
    /// Written.
    pub writes: BTreeSet<String>,
}

impl Uses {
    /// What some entry points of a program do together.
    pub fn of(program: &Program, entries: &[&str]) -> Self {
        let mut uses = Self::default();
        for (index, entry) in program.module.entry_points.iter().enumerate() {
            if !entries.contains(&entry.name.as_str()) {
                continue;
            }
            let used = program.info.get_entry_point(index);
            for (handle, variable) in program.module.global_variables.iter() {
                let writable = matches!(
                    variable.space,
                    naga::AddressSpace::Storage { access } if access.contains(StorageAccess::STORE)
                );
                let Some(name) = variable.name.as_ref().filter(|_| writable) else {
                    continue;
                };
                if is_atomic(&program.module, variable.ty) {
                    continue;
                }
                if used[handle].contains(GlobalUse::READ) {
                    uses.reads.insert(name.clone());
                }
                if used[handle].contains(GlobalUse::WRITE) {
                    uses.writes.insert(name.clone());
                }
            }
        }
        uses
    }
}

fn is_atomic(module: &Module, of: naga::Handle<naga::Type>) -> bool {
    match module.types[of].inner {
        TypeInner::Atomic(_) => true,
        TypeInner::Array { base, .. } => is_atomic(module, base),
        _ => false,
    }
}

/// A pass, as it was recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pass {
    /// The stage whose kernel it runs.
    pub stage: String,
    /// Whether several invocations may work on one pixel, as where triangles are drawn.
    pub shared: bool,
    /// What the kernel does to plain data.
    pub uses: Arc<Uses>,
}

impl Pass {
    /// What the kernel may read while another invocation of the same pass writes it.
    pub fn races(&self) -> impl Iterator<Item = &str> {
        let both = self.uses.reads.intersection(&self.uses.writes);
        both.filter(|_| self.shared).map(String::as_str)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wgsl::Sources;

    fn uses(stage: &str) -> Uses {
        let program = Sources::shipped(false).link("abuffer");
        let program = program.and_then(crate::wgsl::Linked::parse);
        Uses::of(&program.unwrap_or_else(|e| panic!("{e}")), &[stage])
    }

    #[test]
    fn a_kernel_uses_what_its_text_says() {
        let set = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect();
        for (stage, reads, writes) in [
            ("build", vec![], vec!["colours", "nodes"]),
            ("build_fragment", vec![], vec!["colours", "nodes"]),
            ("opaque_first", vec![], vec![]),
            ("sort", vec!["nodes", "progress"], vec!["nodes", "progress"]),
            (
                "resolve",
                vec!["colours", "nodes", "picture", "progress"],
                vec!["picture", "progress"],
            ),
        ] {
            let must = Uses {
                reads: set(&reads),
                writes: set(&writes),
            };
            assert_eq!(uses(stage), must, "{stage}");
        }
    }

    #[test]
    fn only_shared_pixels_race() {
        let pass = |shared| Pass {
            stage: "sort".into(),
            shared,
            uses: Arc::new(uses("sort")),
        };
        let races = |shared| pass(shared).races().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(races(false), [""; 0], "each pixel has one invocation");
        assert_eq!(races(true), ["nodes", "progress"], "nobody owns a list");
    }
}
