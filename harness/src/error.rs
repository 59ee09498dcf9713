//! Errors that a user can mend: one line, with the file, the line and the value.

use std::fmt;
use std::path::{Path, PathBuf};

use crate::text;

/// Characters of a path that an error shows; no system has longer ones.
const FILE_SHOWN: usize = 4096;

/// Characters of a message that an error shows.
const MESSAGE_SHOWN: usize = 1000;

/// Bad input: where it is, and what would be right.
///
/// Displays as `file:line: message` (or less, where there is less to say).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputError {
    /// The file that holds the mistake.
    pub file: PathBuf,
    /// Line number from 1, where one is known.
    pub line: Option<usize>,
    /// What is wrong, with the offending value, and what would be right.
    pub message: String,
}

impl InputError {
    /// An error in a file as a whole.
    pub fn new(file: impl AsRef<Path>, message: impl Into<String>) -> Self {
        Self {
            file: file.as_ref().to_owned(),
            line: None,
            message: message.into(),
        }
    }

    /// An error on a line, counted from 1.
    pub fn at(file: impl AsRef<Path>, line: usize, message: impl Into<String>) -> Self {
        Self {
            line: Some(line),
            ..Self::new(file, message)
        }
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // One line that a terminal can show, whatever the file held.
        let file = self.file.to_string_lossy();
        let file = text::cut(&file, FILE_SHOWN);
        let message = self.message.replace(['\n', '\r'], " ");
        let message = text::cut(&message, MESSAGE_SHOWN);
        match self.line {
            Some(line) => write!(f, "{file}:{line}: {message}"),
            None => write!(f, "{file}: {message}"),
        }
    }
}

impl std::error::Error for InputError {}
