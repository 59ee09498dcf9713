//! Adapters that are there and of no use.

use std::any::Any;
use std::cell::Cell;
use std::fmt;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

use triptych_gpu::error::GpuError;

/// An adapter that cannot be opened or calibrated.
#[derive(Clone, Debug, PartialEq)]
pub struct Broken {
    /// Its name.
    pub name: String,
    /// Whether it was asked for by name: then it fails, else it is skipped.
    pub asked: bool,
    /// What kept it from being used.
    pub error: GpuError,
}

impl Broken {
    /// Why, in one line without the adapter's name.
    pub fn reason(&self) -> String {
        let text = self.error.to_string();
        let reason = text.strip_prefix(&self.name);
        let reason = reason.and_then(|rest| rest.strip_prefix(": "));
        let words = reason.unwrap_or(&text).split_whitespace();
        words.collect::<Vec<_>>().join(" ")
    }
}

impl fmt::Display for Broken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} cannot be used: {}", self.name, self.reason())
    }
}

/// Opens what was found; what fails is kept with its reason.
pub(super) fn each<F, A>(
    found: Vec<(String, F)>,
    asked: bool,
    open: impl Fn(&str, &F) -> Result<A, GpuError>,
) -> (Vec<A>, Vec<Broken>) {
    let (mut opened, mut broken) = (Vec::new(), Vec::new());
    for (name, found) in found {
        match caught(&name, || open(&name, &found)) {
            Ok(adapter) => opened.push(adapter),
            Err(error) => broken.push(Broken { name, asked, error }),
        }
    }
    (opened, broken)
}

thread_local! {
    /// Whether a panic of this thread is caught, and told in one line.
    static CAUGHT: Cell<bool> = const { Cell::new(false) };
}

/// wgpu hands most of a driver's failures on, and panics at others, such as a driver
/// that compiles none of wgpu's own kernels.
fn caught<A>(name: &str, open: impl FnOnce() -> Result<A, GpuError>) -> Result<A, GpuError> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            if !CAUGHT.get() {
                before(panic);
            }
        }));
    });
    CAUGHT.set(true);
    // What `open` leaves behind half done is its own device, which nobody gets.
    let result = panic::catch_unwind(AssertUnwindSafe(open));
    CAUGHT.set(false);
    result.unwrap_or_else(|payload| {
        Err(GpuError::Refused {
            adapter: name.to_owned(),
            reason: format!("panic: {}", words(payload.as_ref())),
        })
    })
}

/// What a panic says.
fn words(payload: &(dyn Any + Send)) -> &str {
    let formatted = payload.downcast_ref::<String>().map(String::as_str);
    let literal = || payload.downcast_ref::<&str>().copied();
    formatted.or_else(literal).unwrap_or("without words")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(name: &str) -> GpuError {
        GpuError::NoDevice {
            adapter: name.to_owned(),
            reason: "not\ntoday".to_owned(),
        }
    }

    #[test]
    fn an_adapter_that_fails_keeps_no_other_from_a_run() {
        let names = ["x", "x#2", "y"];
        let found = names.map(|name| (name.to_owned(), ()));
        for bad in names {
            let (opened, broken) = each(found.to_vec(), true, |name, ()| match name == bad {
                true => Err(refused(name)),
                false => Ok(name.to_owned()),
            });
            let others = names.into_iter().filter(|name| *name != bad);
            assert!(others.eq(opened.iter()), "without {bad}: {opened:?}");
            let said: Vec<String> = broken.iter().map(Broken::to_string).collect();
            let line = format!("{bad} cannot be used: no device: not today");
            assert_eq!(said, [line], "one line, and the name once");
        }
    }

    #[test]
    fn a_panic_is_a_reason_like_any_other() {
        let found = ["x", "y"].map(|name| (name.to_owned(), name == "x"));
        let (opened, broken) = each(found.into(), false, |name, bad| {
            assert!(!bad, "{name} is bad");
            Ok(name.to_owned())
        });
        assert_eq!(opened, ["y"]);
        let said: Vec<String> = broken.iter().map(Broken::to_string).collect();
        assert_eq!(said, ["x cannot be used: panic: x is bad"]);
    }
}
