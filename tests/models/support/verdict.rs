//! Models that are expected to fail.

use std::any::Any;
use std::thread;

use super::how::Count;

/// Runs a model on a thread of its own, as a checker that panicked leaves its thread in
/// disorder. How many schedules it took, and what the panic said, if there was one.
pub fn verdict(model: impl FnOnce(&Count) + Send + 'static) -> (usize, Option<String>) {
    let count = Count::default();
    let own = count.clone();
    let outcome = thread::spawn(move || model(&own)).join();
    (count.get(), outcome.err().map(said))
}

fn said(panic: Box<dyn Any + Send>) -> String {
    let owned = panic.downcast::<String>().map(|said| *said);
    owned.unwrap_or_else(|panic| match panic.downcast_ref::<&str>() {
        Some(said) => (*said).to_owned(),
        None => "a panic without words".to_owned(),
    })
}
