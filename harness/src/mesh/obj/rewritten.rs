//! A file as tobj is given it: statement by statement, so that the rewritten text is
//! never in memory as a whole.

use std::io::{self, BufReader, Read};
use std::path::Path;

use super::Statement;
use crate::error::InputError;

/// Statements, and what makes of each the text that tobj reads.
pub(super) struct Rewritten<S, R> {
    statements: S,
    rewrite: R,
    /// What was made of the last statement, and how much of it has been read.
    clean: String,
    read: usize,
    /// Why there is no more.
    refused: Option<InputError>,
}

impl<'a, S, R> Rewritten<S, R>
where
    S: Iterator<Item = Statement<'a>>,
    R: FnMut(&Statement, &mut String) -> Result<(), InputError>,
{
    /// `rewrite` appends text to a string, or refuses a statement.
    pub(super) fn new(statements: S, rewrite: R) -> Self {
        Self {
            statements,
            rewrite,
            clean: String::new(),
            read: 0,
            refused: None,
        }
    }

    /// What tobj makes of it: one mesh, polygons cut into fans.
    pub(super) fn parse(mut self, path: &Path) -> Result<tobj::Mesh, InputError> {
        let options = tobj::LoadOptions {
            triangulate: true,
            ..tobj::LoadOptions::default()
        };
        let no_library = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
        let parsed = tobj::load_obj_buf(&mut BufReader::new(&mut self), &options, no_library);
        match (self.refused, parsed) {
            (Some(refused), _) => Err(refused),
            (None, Ok((models, _))) => {
                let first = models.into_iter().next();
                Ok(first.map(|model| model.mesh).unwrap_or_default())
            }
            (None, Err(e)) => Err(InputError::new(path, format!("tobj refuses it: {e}"))),
        }
    }
}

impl<'a, S, R> Read for Rewritten<S, R>
where
    S: Iterator<Item = Statement<'a>>,
    R: FnMut(&Statement, &mut String) -> Result<(), InputError>,
{
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        while self.read == self.clean.len() {
            self.clean.clear();
            self.read = 0;
            let Some(statement) = self.statements.next() else {
                return Ok(0);
            };
            if let Err(refused) = (self.rewrite)(&statement, &mut self.clean) {
                self.refused = Some(refused);
                return Err(io::ErrorKind::InvalidData.into());
            }
        }
        let rest = &self.clean.as_bytes()[self.read..];
        let n = rest.len().min(into.len());
        into[..n].copy_from_slice(&rest[..n]);
        self.read += n;
        Ok(n)
    }
}
