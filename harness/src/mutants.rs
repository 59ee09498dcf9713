//! The harness tests itself: kernels, or what the host does around them, with one
//! defect each, which a scene must bring to light.
//!
//! A mutant is *killed by result* where some stage gives another value than the spec,
//! *by structure* where a certificate is broken (of lists, of the counter, of the
//! passes that were recorded), and *not observable* where everything agrees, which
//! proves nothing. It survives if no leg kills it. A canary is a mutant that states the
//! one cause that it must be reported as.

mod ground;
mod lab;
mod matrix;
mod table;
mod text;

pub use lab::Lab;
pub use matrix::{Cell, Matrix, Outcome, by_mutant, legs};
pub use table::{Mutant, mutants, select};
pub use text::Columns;
