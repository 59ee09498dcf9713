//! PLY through ply-rs-bw: ASCII, binary of either byte order.
//!
//! The header is checked before anything is allocated for what it promises, and
//! items are read one by one, so that an error names the line or the item.

mod header;
mod row;

use std::path::Path;

use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{ElementDef, Encoding, PropertyAccess};

use super::text::{lines, quote};
use super::{Mesh, Notes, TRIANGLES_MAX, too_large};
use crate::error::InputError;
use header::Header;
use row::{Face, Other, Vertex};

/// Most entries that the lists of one item may have together: the corners of a face of
/// as many triangles as a mesh may have.
const ENTRIES_MAX: u64 = TRIANGLES_MAX + 2;

/// Loads a PLY file.
pub(super) fn load(path: &Path, bytes: &[u8]) -> Result<Mesh, InputError> {
    let header = Header::read(path, bytes)?;
    let mut body = Body::new(path, &header, bytes);
    let mut positions: Vec<[f32; 3]> = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let mut notes = Notes::default();
    for element in header.elements() {
        match element.name.as_str() {
            "vertex" => {
                positions.reserve_exact(element.count);
                body.each::<Vertex>(element, |v| v.finite().map(|p| positions.push(p)))?;
            }
            "face" => body.each::<Face>(element, |f| {
                match f.corners(header.vertices)?[..] {
                    [] | [_] => notes.points += 1,
                    [_, _] => notes.lines += 1,
                    [a, ref others @ ..] => {
                        triangles.extend(others.windows(2).map(|w| [a, w[0], w[1]]));
                    }
                }
                too_large(triangles.len() as u64, 0).map_or(Ok(()), Err)
            })?,
            _ => body.each::<Other>(element, |_| Ok(()))?,
        }
    }
    if triangles.is_empty() {
        let n = positions.len();
        let message = format!("no triangles, only {n} vertices");
        return Err(InputError::new(path, message));
    }
    let mut mesh = Mesh::of_triangles(positions, triangles);
    notes.warnings.extend(body.left_over());
    mesh.notes = notes;
    Ok(mesh)
}

/// What follows the header.
enum Body<'a> {
    Ascii {
        path: &'a Path,
        lines: Box<dyn Iterator<Item = (usize, &'a [u8])> + 'a>,
        /// Lines of the header.
        before: usize,
    },
    Binary {
        path: &'a Path,
        /// What has not been read yet.
        bytes: &'a [u8],
        big_endian: bool,
    },
}

impl<'a> Body<'a> {
    fn new(path: &'a Path, header: &Header, bytes: &'a [u8]) -> Self {
        let rest = &bytes[header.bytes..];
        match header.encoding() {
            Encoding::Ascii => Self::Ascii {
                path,
                lines: Box::new(lines(rest).filter(|(_, line)| !line.trim_ascii().is_empty())),
                before: header.lines,
            },
            encoding => Self::Binary {
                path,
                bytes: rest,
                big_endian: encoding == Encoding::BinaryBigEndian,
            },
        }
    }

    /// Reads all items of an element.
    fn each<E: PropertyAccess>(
        &mut self,
        element: &ElementDef,
        mut take: impl FnMut(E) -> Result<(), String>,
    ) -> Result<(), InputError> {
        let (name, count) = (&element.name, element.count);
        let parser = Parser::<E>::new();
        for item in 0..count {
            match self {
                Self::Ascii {
                    path,
                    lines,
                    before,
                } => {
                    let Some((line, text)) = lines.next() else {
                        let message = format!("ends after {item} of {count} items `{name}`");
                        return Err(InputError::new(path, message));
                    };
                    let error = |message| InputError::at(&path, *before + line, message);
                    let text = row::rewrite(text, element).map_err(error)?;
                    let read = parser.read_ascii_element(&text, element);
                    let read = read.map_err(|_| error(unreadable(&text, name)))?;
                    take(read).map_err(error)?;
                }
                Self::Binary {
                    path,
                    bytes,
                    big_endian,
                } => {
                    let error = |what: String| {
                        let message = format!("{name} {item} of {count}: {what}");
                        InputError::new(&path, message)
                    };
                    row::check_lists(bytes, *big_endian, element).map_err(error)?;
                    let read = match big_endian {
                        true => parser.read_big_endian_element(bytes, element),
                        false => parser.read_little_endian_element(bytes, element),
                    };
                    let read = read.map_err(|e| error(first_line(&e.to_string())))?;
                    take(read).map_err(error)?;
                }
            }
        }
        Ok(())
    }

    /// A remark about what follows the last item.
    fn left_over(self) -> Option<String> {
        let (n, what) = match self {
            Self::Ascii { lines, .. } => (lines.count(), "lines"),
            Self::Binary { bytes, .. } => (bytes.len(), "bytes"),
        };
        (n > 0).then(|| format!("{n} {what} after the last item ignored"))
    }
}

/// The parser adds lines of details that say no more.
fn first_line(message: &str) -> String {
    message.lines().next().unwrap_or_default().to_owned()
}

fn unreadable(text: &str, name: &str) -> String {
    format!(
        "{} is no item `{name}` as the header defines it",
        quote(text.as_bytes())
    )
}
