//! All adapters of the machine, for tests that may leave none out.

use triptych_harness::replay::gpu::{Adapter, Adapters};

/// Opened and calibrated.
///
/// # Errors
/// One line if there is no adapter, or one cannot be used.
pub fn open() -> Result<Vec<Adapter>, String> {
    let Adapters { open, broken } = Adapters::open(&[]);
    // What is skipped in a replay would go untested here in silence.
    if let Some(broken) = broken.first() {
        return Err(broken.to_string());
    }
    if open.is_empty() {
        return Err(
            "no GPU adapter: `./x setup` installs two software drivers, \
                    `./x doctor` says what is missing"
                .into(),
        );
    }
    Ok(open)
}
