//! Corners of OBJ faces: `a`, `a/b`, `a//c` or `a/b/c`, counted from 1, or from
//! the end when negative.

use super::super::TRIANGLES_MAX;
use super::{quote, statements, words};

/// How many there are of what a corner names.
#[derive(Clone, Copy, Default)]
pub(super) struct Counts {
    pub(super) vertices: u64,
    pub(super) textures: u64,
    pub(super) normals: u64,
}

impl Counts {
    /// Of a whole file: a face may name what comes after it.
    pub(super) fn of(bytes: &[u8]) -> Self {
        let mut counts = Self::default();
        for statement in statements(bytes) {
            match words(&statement.text).next() {
                Some(b"v") => counts.vertices += 1,
                Some(b"vt") => counts.textures += 1,
                Some(b"vn") => counts.normals += 1,
                _ => {}
            }
        }
        counts
    }
}

/// What is known of faces so far.
pub(super) struct Faces {
    /// What precedes.
    pub(super) seen: Counts,
    /// What the whole file has.
    all: Counts,
    /// Triangles after cutting polygons into fans.
    triangles: u64,
}

impl Faces {
    pub(super) fn new(all: Counts) -> Self {
        Self {
            seen: Counts::default(),
            all,
            triangles: 0,
        }
    }

    /// Absolute vertex indices of a face, from 1. Stops where its triangles exceed the
    /// limit.
    pub(super) fn corners<'w>(
        &mut self,
        words: impl Iterator<Item = &'w [u8]>,
    ) -> Result<Vec<u64>, String> {
        let most = TRIANGLES_MAX - self.triangles + 2;
        let mut corners = Vec::new();
        for word in words {
            if corners.len() as u64 == most {
                return Err(format!(
                    "after {} triangles, this face exceeds the limit of {TRIANGLES_MAX}",
                    self.triangles
                ));
            }
            corners.push(self.corner(word)?);
        }
        self.triangles += (corners.len() as u64).saturating_sub(2);
        Ok(corners)
    }

    fn corner(&self, word: &[u8]) -> Result<u64, String> {
        let Self { seen, all, .. } = self;
        let kinds = [
            ("vertex", seen.vertices, all.vertices),
            ("texture coordinate", seen.textures, all.textures),
            ("normal", seen.normals, all.normals),
        ];
        let mut vertex = 0;
        for (at, part) in word.split(|b| *b == b'/').enumerate() {
            let Some(&(what, seen, all)) = kinds.get(at) else {
                return Err(format!("{} has more than three parts", quote(word)));
            };
            // Only the vertex is a must: `1//3` and `1//` are common.
            if at > 0 && part.is_empty() {
                continue;
            }
            let index = absolute(part, what, seen)?;
            if index > all {
                return Err(format!(
                    "{what} {index} is out of range; the file has {all}"
                ));
            }
            if at == 0 {
                vertex = index;
            }
        }
        Ok(vertex)
    }
}

/// An index counted from 1.
fn absolute(word: &[u8], what: &str, count: u64) -> Result<u64, String> {
    let parsed = std::str::from_utf8(word)
        .ok()
        .and_then(|w| w.parse::<i64>().ok());
    match parsed {
        None => Err(format!("{} is no {what} index", quote(word))),
        Some(0) => Err(format!("{what} index 0; indices count from 1")),
        Some(index) if index > 0 => Ok(index.unsigned_abs()),
        Some(back) => match (count + 1).checked_sub(back.unsigned_abs()) {
            None | Some(0) => Err(format!("{what} {back} is out of range; {count} precede it")),
            Some(index) => Ok(index),
        },
    }
}
