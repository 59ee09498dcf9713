//! Mistakes that only a scene's geometry brings out, and where in its file they stand.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use toml::de::{DeTable, DeValue};

use super::Parsed;
use crate::error::InputError;

/// What is wrong with a scene file, found after it was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// The key to change, with its tables: `rsm.lamp.height`. `None` where there is no such one.
    pub key: Option<&'static str>,
    /// What is wrong with it, and what would be right.
    pub message: String,
}

impl Mistake {
    /// One of a key.
    pub fn of(key: &'static str, message: impl Into<String>) -> Self {
        Self {
            key: Some(key),
            message: message.into(),
        }
    }
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.key {
            Some(key) => write!(f, "{key}: {}", self.message),
            None => f.write_str(&self.message),
        }
    }
}

impl std::error::Error for Mistake {}

impl From<String> for Mistake {
    fn from(message: String) -> Self {
        Self { key: None, message }
    }
}

impl From<Mistake> for String {
    fn from(mistake: Mistake) -> Self {
        mistake.to_string()
    }
}

impl Parsed<'_> {
    /// An error of a key, by name and line.
    pub(super) fn mistake(&self, key: &str, message: impl fmt::Display) -> InputError {
        InputError {
            file: self.path.to_owned(),
            line: self.keys.of(key),
            message: format!("{key}: {message}"),
        }
    }
}

/// On which line of a scene file each key stands, those of tables in tables as well. Tables in an
/// array go by their number: `mesh.0.scale`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lines(BTreeMap<String, usize>);

impl Lines {
    /// Of a text that is a scene file; of another, none. `line` knows which line a byte is on.
    pub(super) fn new(text: &str, line: impl Fn(usize) -> usize) -> Self {
        let mut lines = Self::default();
        if let Ok(table) = DeTable::parse(text) {
            lines.add("", table.get_ref(), &line);
        }
        lines
    }

    fn add(&mut self, before: &str, table: &DeTable<'_>, line: &impl Fn(usize) -> usize) {
        for (key, value) in table {
            let name = format!("{before}{}", key.get_ref());
            match value.get_ref() {
                DeValue::Table(inner) => self.add(&format!("{name}."), inner, line),
                DeValue::Array(items) => {
                    for (number, item) in items.iter().enumerate() {
                        if let DeValue::Table(inner) = item.get_ref() {
                            self.add(&format!("{name}.{number}."), inner, line);
                            self.0
                                .insert(format!("{name}.{number}"), line(item.span().start));
                        }
                    }
                }
                _ => {}
            }
            self.0.insert(name, line(key.span().start));
        }
    }

    /// The line of a key from 1, or of the innermost table around it that is there.
    pub fn of(&self, key: &str) -> Option<usize> {
        let line = |key: &str| self.0.get(key).copied();
        let outer = || key.rsplit_once('.').and_then(|(table, _)| self.of(table));
        line(key).or_else(outer)
    }

    /// Whether the file states a key.
    pub fn states(&self, key: &str) -> bool {
        self.0.contains_key(key)
    }
}

/// The line, from 1, that holds a byte.
pub(super) fn line_of(lines: &[usize], at: usize) -> usize {
    lines.partition_point(|start| *start <= at)
}

/// A file's text.
pub(super) fn utf8<'a>(path: &Path, bytes: &'a [u8]) -> Result<&'a str, InputError> {
    // A byte-order mark means nothing in UTF-8.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|e| {
        let line = 1 + bytes[..e.valid_up_to()]
            .iter()
            .filter(|b| **b == b'\n')
            .count();
        InputError::at(path, line, "is not UTF-8; a scene.toml is expected")
    })
}

#[cfg(test)]
mod tests {
    use super::Lines;

    #[test]
    fn keys_have_lines() {
        let text =
            "a = 1\nb.c = { d = 2,\n e = 3 }\n[f.g]\nh = [{ i = 1 }, 2]\n[[k]]\nl = 1\n[[k]]\n";
        let line = |at: usize| 1 + text[..at].matches('\n').count();
        let lines = Lines::new(text, line);
        let of = |key| lines.of(key);
        assert_eq!(
            [of("a"), of("b.c.d"), of("b.c.e")],
            [Some(1), Some(2), Some(3)]
        );
        assert_eq!(
            [of("f.g.h"), of("f.g.x"), of("f.g.x.y")],
            [Some(5), Some(4), Some(4)]
        );
        assert_eq!([of("f.g.h.0.i"), of("f.g.h.1")], [Some(5), Some(5)]);
        assert_eq!(
            [of("k.0.l"), of("k.1.l"), of("m")],
            [Some(7), Some(8), None]
        );
        assert!(lines.states("b.c") && !lines.states("b.x"));
        assert_eq!(Lines::new("a = ", line), Lines::default());
    }
}
