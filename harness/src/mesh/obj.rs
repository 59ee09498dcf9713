//! Wavefront OBJ through tobj.
//!
//! tobj says neither where nor what is wrong, takes NaN for a coordinate, turns
//! lines and points into triangles, and stumbles over trailing comments, continued
//! lines, byte-order marks, bare CR and bytes that are not UTF-8. So each statement
//! is first checked and rewritten into what tobj reads well: positions, and faces
//! with absolute position indices. Materials are kept apart, since tobj makes a mesh
//! of its own at each change.

mod face;
mod material;
mod rewritten;

use std::fmt::Write as _;
use std::path::Path;

use super::text::{Statement, check_text, name, number, quote, statements, words};
use super::{Intake, Mesh, Notes, too_large};
use crate::error::InputError;
use crate::text::plural;
use face::{Counts, Faces};
use material::Materials;
use rewritten::Rewritten;

/// Statements without meaning here: other vertex data, grouping, display, and
/// free-form curves and surfaces.
const IGNORED: [&str; 37] = [
    "vp",
    "o",
    "g",
    "s",
    "mg",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "maplib",
    "usemap",
    "cstype",
    "deg",
    "bmat",
    "step",
    "curv",
    "curv2",
    "surf",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "call",
    "csh",
    "bsp",
    "bzp",
    "cdc",
    "cdp",
    "res",
    "usemat",
];

/// Loads an OBJ file and the material libraries that it names.
pub(super) fn load(intake: &mut Intake, path: &Path, text: &[u8]) -> Result<Mesh, InputError> {
    let mut reader = Reader::new(intake, path, Counts::of(text));
    let rewritten = Rewritten::new(statements(text), |s, clean| reader.statement(s, clean));
    let parsed = rewritten.parse(path)?;
    reader.finish(&parsed)
}

struct Reader<'a, 'i> {
    intake: &'a mut Intake<'i>,
    path: &'a Path,
    faces: Faces,
    materials: Materials,
    notes: Notes,
    unknown: u64,
    first_unknown: Option<(usize, String)>,
}

impl<'a, 'i> Reader<'a, 'i> {
    fn new(intake: &'a mut Intake<'i>, path: &'a Path, counts: Counts) -> Self {
        Self {
            intake,
            path,
            faces: Faces::new(counts),
            materials: Materials::default(),
            notes: Notes::default(),
            unknown: 0,
            first_unknown: None,
        }
    }

    /// Checks a statement and appends to `clean` what tobj is to read of it.
    fn statement(&mut self, s: &Statement, clean: &mut String) -> Result<(), InputError> {
        let text = &*s.text;
        let path = self.path;
        let error = |message: String| InputError::at(path, s.line, message);
        check_text(text, "an OBJ file").map_err(error)?;
        let Some(keyword) = words(text).next() else {
            return Ok(());
        };
        let values = words(text).skip(1);
        match keyword {
            b"v" => self.vertex(values, clean).map_err(error)?,
            b"vt" => self.faces.seen.textures += 1,
            b"vn" => self.faces.seen.normals += 1,
            b"f" | b"fo" => self.face(values, clean).map_err(error)?,
            b"l" => self.notes.lines += 1,
            b"p" => self.notes.points += 1,
            b"usemtl" => {
                let chosen = name(text).and_then(|name| self.materials.choose(name));
                chosen.map_err(error)?;
            }
            b"mtllib" => {
                let names = name(text).map_err(error)?;
                let warnings = &mut self.notes.warnings;
                let place = (path, s.line);
                let library = &mut self.materials.library;
                library.add(self.intake, place, &names, warnings)?;
            }
            b"ply" if self.faces.seen.vertices == 0 => {
                return Err(error("is a PLY file named .obj".to_owned()));
            }
            _ => self.other(s.line, keyword),
        }
        Ok(())
    }

    /// `v x y z`, `v x y z w` or `v x y z r g b`.
    fn vertex<'w>(
        &mut self,
        values: impl Iterator<Item = &'w [u8]>,
        clean: &mut String,
    ) -> Result<(), String> {
        // Seven are enough to see that there are too many.
        let values: Vec<&[u8]> = values.take(7).collect();
        let [x, y, z, others @ ..] = &values[..] else {
            let n = values.len();
            return Err(format!(
                "a vertex needs three coordinates, and this has {n}"
            ));
        };
        let position = [number(x)?, number(y)?, number(z)?];
        let weight = match others {
            [] | [_, _, _] => 1.0,
            [w] => number(w)?,
            _ => {
                let n = values.len();
                return Err(format!(
                    "a vertex has 3, 4 or 6 numbers, and this has {n} or more"
                ));
            }
        };
        let position = position.map(|c| c / weight);
        if position.iter().any(|c| !c.is_finite()) {
            return Err(format!(
                "dividing by the weight {weight} gives {position:?}"
            ));
        }
        self.faces.seen.vertices += 1;
        if let Some(message) = too_large(0, self.faces.seen.vertices) {
            return Err(message);
        }
        let [x, y, z] = position;
        // Rust prints the shortest digits that read back as the same number.
        let _ = writeln!(clean, "v {x} {y} {z}");
        Ok(())
    }

    fn face<'w>(
        &mut self,
        values: impl Iterator<Item = &'w [u8]>,
        clean: &mut String,
    ) -> Result<(), String> {
        let corners = self.faces.corners(values)?;
        match corners.len() {
            0 => return Err("a face without corners".to_owned()),
            1 => self.notes.points += 1,
            2 => self.notes.lines += 1,
            n => {
                self.materials.add(n - 2);
                clean.push('f');
                for corner in corners {
                    let _ = write!(clean, " {corner}");
                }
                clean.push('\n');
            }
        }
        Ok(())
    }

    fn other(&mut self, line: usize, keyword: &[u8]) {
        if !IGNORED.iter().any(|known| known.as_bytes() == keyword) {
            self.unknown += 1;
            self.first_unknown.get_or_insert((line, quote(keyword)));
        }
    }

    fn finish(mut self, parsed: &tobj::Mesh) -> Result<Mesh, InputError> {
        let (positions, _) = parsed.positions.as_chunks::<3>();
        let (triangles, _) = parsed.indices.as_chunks::<3>();
        if triangles.is_empty() {
            return Err(self.no_triangles());
        }
        if let Some((line, word)) = &self.first_unknown {
            let n = self.unknown;
            let what = plural(n, "unknown statement");
            let warning = format!("{what} ignored, the first on line {line}: {word}");
            self.notes.warnings.push(warning);
        }
        let (material, materials) = self.materials.finish();
        if material.len() != triangles.len() {
            let (got, expected) = (triangles.len(), material.len());
            let message = format!("tobj makes {got} triangles of {expected}");
            return Err(InputError::new(self.path, message));
        }
        Ok(Mesh {
            positions: positions.to_vec(),
            triangles: triangles.to_vec(),
            material,
            materials,
            notes: self.notes,
        })
    }

    fn no_triangles(&self) -> InputError {
        let Notes { lines, points, .. } = self.notes;
        let mut message = format!("no triangles, only {lines} lines and {points} points");
        if let Some((line, word)) = &self.first_unknown {
            let _ = write!(
                message,
                "; line {line} starts with {word}, which OBJ does not know"
            );
        }
        InputError::new(self.path, message)
    }
}
