//! Which scenes a command is about.

use crate::corpus::{self, Entry};
use crate::error::InputError;

/// Patterns of scenes; a command that takes others than the whole corpus without one says
/// so in its help.
#[derive(clap::Args)]
pub struct Scenes {
    /// Parts of scene names; all scenes without one
    #[arg(value_name = "PATTERN")]
    patterns: Vec<String>,
    /// Patterns are whole names
    #[arg(long)]
    exact: bool,
}

impl Scenes {
    /// The scenes that the patterns select, among these or outside the corpus.
    ///
    /// # Errors
    /// A pattern that selects nothing.
    pub fn select(&self, corpus: &[Entry]) -> Result<Vec<Entry>, InputError> {
        corpus::select(corpus, &self.patterns, self.exact)
    }

    /// The same, or `None` without a pattern, for a command that then has its own scenes.
    ///
    /// # Errors
    /// A pattern that selects nothing.
    pub fn if_any(&self, corpus: &[Entry]) -> Result<Option<Vec<Entry>>, InputError> {
        let any = !self.patterns.is_empty();
        any.then(|| self.select(corpus)).transpose()
    }
}
