//! Corners of OBJ faces: `a`, `a/b`, `a//c` or `a/b/c`, counted from 1, or from
//! the end when negative.

use super::quote;

/// An index that named something not yet defined when it was read.
struct Ahead {
    line: usize,
    what: usize,
    index: u64,
}

const WHAT: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// What is known of faces so far.
#[derive(Default)]
pub(super) struct Faces {
    /// Triangles after cutting polygons into fans.
    pub(super) triangles: u64,
    /// Texture coordinates so far.
    pub(super) textures: u64,
    /// Normals so far.
    pub(super) normals: u64,
    ahead: Vec<Ahead>,
}

impl Faces {
    /// Absolute vertex indices of a face, from 1.
    pub(super) fn corners<'w>(
        &mut self,
        line: usize,
        words: impl Iterator<Item = &'w [u8]>,
        vertices: u64,
    ) -> Result<Vec<u64>, String> {
        let counts = [vertices, self.textures, self.normals];
        words.map(|word| self.corner(line, word, counts)).collect()
    }

    fn corner(&mut self, line: usize, word: &[u8], counts: [u64; 3]) -> Result<u64, String> {
        let mut vertex = 0;
        for (what, part) in word.split(|b| *b == b'/').enumerate() {
            if what > 2 {
                return Err(format!("{} has more than three parts", quote(word)));
            }
            // Only the vertex is a must: `1//3` and `1//` are common.
            if what > 0 && part.is_empty() {
                continue;
            }
            let index = absolute(part, WHAT[what], counts[what])?;
            if index > counts[what] {
                self.ahead.push(Ahead { line, what, index });
            }
            if what == 0 {
                vertex = index;
            }
        }
        Ok(vertex)
    }

    /// The first index that names something the whole file does not have.
    pub(super) fn out_of_range(&self, vertices: u64) -> Option<(usize, String)> {
        let counts = [vertices, self.textures, self.normals];
        let bad = self.ahead.iter().find(|a| a.index > counts[a.what])?;
        let (what, index, count) = (WHAT[bad.what], bad.index, counts[bad.what]);
        let message = format!("{what} {index} is out of range; the file has {count}");
        Some((bad.line, message))
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
