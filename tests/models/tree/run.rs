//! Scripts on the queues of this tree.

use super::arena::Arena;
use super::frame;
use super::held::Held;
use super::lfree::Lfree;
use super::local::Local;
use super::lock::Lock;
use super::sync::Shim;
use super::tracked::Tracked;
use crate::support::how::{Checker, Count, How};
use crate::support::kind::Kind;
use crate::support::script::{Script, play};

/// Explores one model; panics at what is wrong.
pub fn run(kind: Kind, script: Script, how: How, count: &Count) {
    let threads = script.threads.len();
    match kind {
        Kind::Lock => Shim::explore(how, count, move || play::<Shim, _>(script, Lock::new)),
        Kind::Held => Shim::explore(how, count, move || {
            play::<Shim, _>(script, || Lfree::with(Held::new()));
        }),
        Kind::Tracked => Shim::explore(how, count, move || {
            play::<Shim, _>(script, || Lfree::with(Tracked::new()));
        }),
        Kind::Epochs => {
            let script = Script {
                late: true,
                ..script
            };
            Shim::explore(how, count, move || play::<Shim, _>(script, Lfree::new));
        }
        Kind::Freed { looks } => Shim::explore(how, count, move || {
            play::<Shim, _>(script, || Lfree::with(Arena::new(looks)));
        }),
        Kind::Local => {
            let script = Script {
                one: false,
                ..script
            };
            Shim::explore(how, count, move || {
                play::<Shim, _>(script, || Local::new(threads));
            });
        }
        Kind::Frame => {
            let early = frame::run(frame::Rule::Counted, threads, how, count);
            assert_eq!(early, 0, "a thread left early");
        }
    }
}
