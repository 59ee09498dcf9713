//! The passes of a leg, by certificate: what one writes, a later one reads.
//!
//! Drivers seldom show that a boundary is missing, for the invocations that would race
//! happen to run one after the other. So this looks at what was recorded, not at what
//! came of it. A kernel that reads plain data which it also writes, where several
//! invocations may work on one pixel, is `stale-pass`, once for each variable.

use std::collections::BTreeSet;

use triptych_gpu::pass::Pass;

use super::Judgement;
use crate::cause::Cause;

/// Adds the passes that read what they write to what is known of their lists.
pub fn judge(passes: &[Pass], judgement: &mut Judgement) {
    let races = |pass: &Pass| {
        let stage = pass.stage.clone();
        let races: Vec<String> = pass.races().map(str::to_owned).collect();
        races.into_iter().map(move |name| (stage.clone(), name))
    };
    let found: BTreeSet<(String, String)> = passes.iter().flat_map(races).collect();
    for (stage, name) in found {
        judgement.differs(Cause::StalePass, None, || {
            format!("stage {stage} reads `{name}` in the pass that writes it")
        });
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use triptych_gpu::pass::Uses;

    use super::*;
    use crate::row::Class;

    fn pass(stage: &str, reads: &[&str], writes: &[&str]) -> Pass {
        let set = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect();
        Pass {
            stage: stage.into(),
            shared: true,
            uses: Arc::new(Uses {
                reads: set(reads),
                writes: set(writes),
            }),
        }
    }

    fn judged(passes: &[Pass]) -> Vec<String> {
        let mut judgement = Judgement::new(Class::Structure, "fragments");
        judge(passes, &mut judgement);
        judgement.described
    }

    #[test]
    fn what_a_later_pass_reads_is_in_order() {
        let build = pass("build", &[], &["nodes"]);
        let later = pass("count", &["nodes"], &["counts"]);
        assert_eq!(judged(&[build, later]), [""; 0], "nothing races");
    }

    #[test]
    fn a_list_read_where_it_is_built_is_found_once() {
        let build = pass("build", &["colours", "nodes"], &["nodes"]);
        let words = "stale-pass: stage build reads `nodes` in the pass that writes it";
        assert_eq!(
            judged(&[build.clone(), build]),
            [words],
            "two bands, one kernel"
        );
    }
}
