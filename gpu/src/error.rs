//! What can go wrong on the way to a result.

/// Why a kernel gave no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GpuError {
    /// An adapter refused to give a device.
    #[error("{adapter}: no device: {reason}")]
    NoDevice {
        /// The adapter.
        adapter: String,
        /// The driver's words.
        reason: String,
    },
    /// The device went away; its results are worth nothing.
    #[error("{adapter}: device lost: {reason}")]
    Lost {
        /// The adapter.
        adapter: String,
        /// The driver's words.
        reason: String,
    },
    /// The API refused a call.
    #[error("{adapter}: {reason}")]
    Refused {
        /// The adapter.
        adapter: String,
        /// The API's words.
        reason: String,
    },
    /// The scene needs more than the adapter has, also in the smallest parts.
    #[error("{adapter}: {what} needs {needed}, the adapter's limit is {limit}")]
    Limit {
        /// The adapter.
        adapter: String,
        /// What is too large.
        what: &'static str,
        /// How much the scene needs, in the limit's unit.
        needed: u64,
        /// What the adapter offers.
        limit: u64,
    },
    /// The device has no memory for what a stage needs; it lives on.
    #[error("{adapter}: out of memory: {what} needs {bytes} bytes")]
    Memory {
        /// The adapter.
        adapter: String,
        /// What there is no room for.
        what: &'static str,
        /// Its size.
        bytes: u64,
    },
    /// A kernel that follows lists did not come to their ends.
    #[error("{adapter}: stage {stage} follows a list that does not end")]
    Endless {
        /// The adapter.
        adapter: String,
        /// Which kernel.
        stage: &'static str,
    },
    /// WGSL that does not link, parse or validate.
    #[error(transparent)]
    Wgsl(#[from] crate::wgsl::WgslError),
}
