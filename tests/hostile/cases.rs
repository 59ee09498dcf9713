//! Files that nobody vouches for, and what is to come of each.

#[path = "obj.rs"]
pub mod obj;
#[path = "ply.rs"]
pub mod ply;
#[path = "toml.rs"]
pub mod toml;

/// What is to come of a file.
pub enum Outcome {
    /// It loads with so many triangles.
    Loads(usize),
    /// It fails; the error is the file's path followed by this.
    Fails(&'static str),
}

use Outcome::{Fails, Loads};

/// Name, bytes, outcome.
pub type Case = (&'static str, &'static [u8], Outcome);
