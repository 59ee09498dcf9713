//! The harness: corpus, legs, comparison, report. The binary `triptych` is a thin
//! command line over this library.

pub mod cause;
pub mod error;
pub mod row;
