//! Cache lines of one's own.

/// What stands alone in its cache lines, so that those who write it do not slow those who
/// use its neighbour. Two lines of 64 bytes, as processors fetch them in pairs.
#[repr(align(128))]
pub(super) struct Line<T>(pub(super) T);
