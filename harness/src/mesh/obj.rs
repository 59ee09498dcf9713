//! Wavefront OBJ through tobj.
//!
//! tobj says neither where nor what is wrong, takes NaN for a coordinate, turns
//! lines and points into triangles, and stumbles over trailing comments, continued
//! lines, byte-order marks, bare CR and bytes that are not UTF-8. So the text is
//! first checked and rewritten into what tobj reads well: positions, faces with
//! absolute position indices, and materials by number.

mod face;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use super::text::{Statement, number, quote, rest, statements, words};
use super::{Mesh, Named, Notes, mtl, read, too_large};
use crate::error::InputError;
use face::Faces;

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
pub(super) fn load(path: &Path, bytes: &[u8]) -> Result<Mesh, InputError> {
    let text = read::unpacked(path, bytes)?;
    let mut reader = Reader::new(path);
    for statement in statements(&text) {
        reader.statement(&statement)?;
    }
    reader.finish()
}

struct Reader<'a> {
    path: &'a Path,
    /// What tobj is given.
    clean: String,
    vertices: u64,
    faces: Faces,
    /// Materials by name; numbers count from 1 in order of first use.
    used: BTreeMap<String, u32>,
    defined: mtl::Library,
    notes: Notes,
    unknown: u64,
    first_unknown: Option<(usize, String)>,
}

impl<'a> Reader<'a> {
    fn new(path: &'a Path) -> Self {
        Self {
            path,
            clean: String::from("mtllib all\n"),
            vertices: 0,
            faces: Faces::default(),
            used: BTreeMap::new(),
            defined: mtl::Library::default(),
            notes: Notes::default(),
            unknown: 0,
            first_unknown: None,
        }
    }

    fn statement(&mut self, s: &Statement) -> Result<(), InputError> {
        let text = &*s.text;
        if let Some(byte) = text.iter().find(|b| b.is_ascii_control() && !is_blank(**b)) {
            let message = format!("byte {byte:#04x} is not text; an OBJ file is expected");
            return Err(self.error(s.line, message));
        }
        let Some(keyword) = words(text).next() else {
            return Ok(());
        };
        let values = words(text).skip(1);
        match keyword {
            b"v" => self.vertex(values).map_err(|e| self.error(s.line, e))?,
            b"vt" => self.faces.textures += 1,
            b"vn" => self.faces.normals += 1,
            b"f" | b"fo" => self.face(s.line, values)?,
            b"l" => self.notes.lines += 1,
            b"p" => self.notes.points += 1,
            b"usemtl" => self.use_material(rest(text)),
            b"mtllib" => {
                let warnings = &mut self.notes.warnings;
                self.defined.add(self.path, &rest(text), warnings)?;
            }
            b"ply" if self.vertices == 0 => {
                return Err(self.error(s.line, "is a PLY file named .obj".to_owned()));
            }
            _ => self.other(s.line, keyword),
        }
        Ok(())
    }

    fn error(&self, line: usize, message: String) -> InputError {
        InputError::at(self.path, line, message)
    }

    /// `v x y z`, `v x y z w` or `v x y z r g b`.
    fn vertex<'w>(&mut self, values: impl Iterator<Item = &'w [u8]>) -> Result<(), String> {
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
        self.vertices += 1;
        if let Some(message) = too_large(0, self.vertices) {
            return Err(message);
        }
        let [x, y, z] = position;
        // Rust prints the shortest digits that read back as the same number.
        let _ = writeln!(self.clean, "v {x} {y} {z}");
        Ok(())
    }

    fn face<'w>(
        &mut self,
        line: usize,
        values: impl Iterator<Item = &'w [u8]>,
    ) -> Result<(), InputError> {
        let error = |message: String| InputError::at(self.path, line, message);
        let corners = self
            .faces
            .corners(line, values, self.vertices)
            .map_err(error)?;
        match corners.len() {
            0 => return Err(error("a face without corners".to_owned())),
            1 => self.notes.points += 1,
            2 => self.notes.lines += 1,
            n => {
                self.faces.triangles += n as u64 - 2;
                if let Some(message) = too_large(self.faces.triangles, 0) {
                    return Err(error(message));
                }
                self.clean.push('f');
                for corner in corners {
                    let _ = write!(self.clean, " {corner}");
                }
                self.clean.push('\n');
            }
        }
        Ok(())
    }

    fn use_material(&mut self, name: String) {
        let next = u32::try_from(self.used.len() + 1).expect("fewer names than bytes");
        let number = *self.used.entry(name).or_insert(next);
        let _ = writeln!(self.clean, "usemtl {number}");
    }

    fn other(&mut self, line: usize, keyword: &[u8]) {
        if !IGNORED.iter().any(|known| known.as_bytes() == keyword) {
            self.unknown += 1;
            self.first_unknown.get_or_insert((line, quote(keyword)));
        }
    }

    fn finish(mut self) -> Result<Mesh, InputError> {
        if let Some((line, message)) = self.faces.out_of_range(self.vertices) {
            return Err(InputError::at(self.path, line, message));
        }
        if self.faces.triangles == 0 {
            return Err(self.no_triangles());
        }
        if let Some((line, word)) = &self.first_unknown {
            let n = self.unknown;
            let warning =
                format!("{n} unknown statements ignored, the first on line {line}: {word}");
            self.notes.warnings.push(warning);
        }
        let mut named = vec![Named::default(); self.used.len() + 1];
        for (name, number) in &self.used {
            named[*number as usize] = Named {
                name: name.clone(),
                defined: self.defined.find(name),
            };
        }
        let undefined = named[1..].iter().filter(|n| n.defined.is_none()).count();
        if undefined > 0 {
            let warning = format!(
                "{undefined} of {} materials are not defined",
                named.len() - 1
            );
            self.notes.warnings.push(warning);
        }
        let mesh = through_tobj(&self.clean, named, self.notes);
        mesh.map_err(|e| InputError::new(self.path, format!("tobj refuses it: {e}")))
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

fn is_blank(byte: u8) -> bool {
    // Vertical tab is blank to many a reader, if not to Rust.
    byte.is_ascii_whitespace() || byte == 0x0b
}

fn through_tobj(clean: &str, named: Vec<Named>, notes: Notes) -> Result<Mesh, tobj::LoadError> {
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_lines: true,
        ignore_points: true,
        ..tobj::LoadOptions::default()
    };
    // Row n of the library is the material that the rewritten text calls n.
    let library = |_: &Path| {
        let rows = (0..named.len()).map(|n| (n.to_string(), n));
        Ok((vec![tobj::Material::default(); named.len()], rows.collect()))
    };
    let (models, _) = tobj::load_obj_buf(&mut clean.as_bytes(), &options, library)?;
    let mut mesh = Mesh {
        notes,
        ..Mesh::default()
    };
    for tobj::Model { mesh: part, .. } in models {
        let first = row(mesh.positions.len());
        let (positions, _) = part.positions.as_chunks::<3>();
        let (triangles, _) = part.indices.as_chunks::<3>();
        mesh.positions.extend_from_slice(positions);
        mesh.triangles
            .extend(triangles.iter().map(|t| t.map(|v| first + v)));
        let material = row(part.material_id.unwrap_or(0));
        mesh.material.resize(mesh.triangles.len(), material);
    }
    mesh.materials = named;
    Ok(mesh)
}

/// A row number: [`too_large`] has bounded triangles, and with them what tobj
/// returns, which is at most three vertices for each.
fn row(n: usize) -> u32 {
    u32::try_from(n).expect("at most three rows per triangle")
}
