//! The header of a PLY file: what it promises, checked against the file's size.

use std::io::Cursor;
use std::path::Path;

use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{
    DefaultElement, ElementDef, Encoding, Header as Parsed, PropertyType, ScalarType,
};

use super::super::text::{lines, quote, words};
use super::super::{TRIANGLES_MAX, VERTICES_MAX};
use crate::error::InputError;

/// Largest header in bytes.
const HEADER_MAX: usize = 1 << 16;

/// Names that the corners of a face go by.
pub(super) const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// A header that the rest of the file can satisfy.
pub(super) struct Header {
    parsed: Parsed,
    /// Length including the end of its last line.
    pub(super) bytes: usize,
    /// Number of lines.
    pub(super) lines: usize,
    /// Vertices promised.
    pub(super) vertices: usize,
}

impl Header {
    /// Reads and checks a header.
    pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<Self, InputError> {
        let (clean, end, count) = rewrite(path, bytes)?;
        let mut reader = Reader::new(Cursor::new(clean.as_bytes()));
        let parsed = Parser::<DefaultElement>::new().read_header(&mut reader);
        let parsed = parsed.map_err(|e| match e.line() {
            Some(line) => {
                let text = clean.lines().nth(line - 1).unwrap_or_default();
                let message = format!("{} is no PLY header statement", quote(text.as_bytes()));
                InputError::at(path, line, message)
            }
            None => InputError::new(path, e.to_string()),
        })?;
        let mut header = Self {
            parsed,
            bytes: end,
            lines: count,
            vertices: 0,
        };
        let rest = (bytes.len() - end) as u64;
        header.check(rest).map_err(|e| InputError::new(path, e))?;
        Ok(header)
    }

    /// Elements in the order of the file.
    pub(super) fn elements(&self) -> impl Iterator<Item = &ElementDef> {
        self.parsed.elements.values()
    }

    /// How the body is written.
    pub(super) fn encoding(&self) -> Encoding {
        self.parsed.encoding
    }

    fn check(&mut self, rest: u64) -> Result<(), String> {
        let find = |name: &str| {
            let element = self.parsed.elements.get(name);
            element.ok_or_else(|| format!("the header has no element `{name}`"))
        };
        let (vertex, face) = (find("vertex")?, find("face")?);
        for axis in ["x", "y", "z"] {
            let property = vertex.properties.get(axis).map(|p| &p.data_type);
            if !matches!(property, Some(PropertyType::Scalar(_))) {
                return Err(format!("vertices have no number `{axis}`"));
            }
        }
        let corners = CORNERS.iter().find_map(|name| face.properties.get(*name));
        let corners = corners.map(|p| &p.data_type);
        if !matches!(corners, Some(PropertyType::List(_, t)) if is_integer(t)) {
            return Err("faces have no list of integers `vertex_indices`".to_owned());
        }
        for (element, limit) in [(vertex, VERTICES_MAX), (face, TRIANGLES_MAX)] {
            if element.count as u64 > limit {
                let (count, name) = (element.count, &element.name);
                let message = format!("{count} items `{name}` exceed the limit of {limit}");
                return Err(message);
            }
        }
        let vertices = vertex.count;
        self.check_size(rest)?;
        self.vertices = vertices;
        Ok(())
    }

    /// Whether the shortest items that the header allows fit into the file.
    fn check_size(&self, rest: u64) -> Result<(), String> {
        let ascii = self.encoding() == Encoding::Ascii;
        // The last line of a text needs no end.
        let mut left = rest + u64::from(ascii);
        for element in self.elements() {
            let (name, count) = (&element.name, element.count as u64);
            let properties = element.properties.values().map(|p| &p.data_type);
            let mut least = 0;
            for t in properties {
                if matches!(t, PropertyType::List(n, _) if !is_integer(n)) {
                    return Err(format!("a list of `{name}` is counted in fractions"));
                }
                // A digit and a blank, at the least.
                least += if ascii { 2 } else { bytes_of(t) };
            }
            if least == 0 && count > 0 {
                return Err(format!("element `{name}` has no properties"));
            }
            let needed = least.checked_mul(count).filter(|n| *n <= left);
            left -= needed.ok_or_else(|| {
                format!("{count} items `{name}` are promised, and {rest} bytes follow the header")
            })?;
        }
        Ok(())
    }
}

/// Bytes of a property in binary; of a list, its count alone.
fn bytes_of(property: &PropertyType) -> u64 {
    let (PropertyType::Scalar(t) | PropertyType::List(t, _)) = property;
    width(t)
}

/// Bytes of a number in binary.
pub(super) fn width(t: &ScalarType) -> u64 {
    match t {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    }
}

fn is_integer(t: &ScalarType) -> bool {
    !matches!(t, ScalarType::Float | ScalarType::Double)
}

/// The header with plain line ends, in UTF-8, without remarks; its length and its
/// number of lines. Repeated names are refused: the parser would keep the last.
fn rewrite(path: &Path, bytes: &[u8]) -> Result<(String, usize, usize), InputError> {
    let start = &bytes[..bytes.len().min(HEADER_MAX)];
    if !matches!(lines(start).next(), Some((_, b"ply"))) {
        let first = lines(start).next().map_or(&[][..], |(_, line)| line);
        let message = format!("starts with {}, not with `ply`", quote(first));
        return Err(InputError::at(path, 1, message));
    }
    let (mut clean, mut elements, mut properties) = (String::new(), Vec::new(), Vec::new());
    for (number, line) in lines(start) {
        let repeated = |what: &[u8]| {
            let message = format!("{} is defined twice", quote(what));
            Err(InputError::at(path, number, message))
        };
        let line = line.trim_ascii();
        let mut named = words(line);
        match named.next().unwrap_or_default() {
            // Line numbers must stay.
            b"comment" | b"obj_info" => {
                clean.push_str("comment\n");
                continue;
            }
            b"format" => {
                let version = named.nth(1).unwrap_or_default();
                if version != b"1.0" {
                    let message = format!("version {} of PLY; only 1.0 is known", quote(version));
                    return Err(InputError::at(path, number, message));
                }
            }
            b"element" => {
                let name = named.next().unwrap_or_default();
                if elements.contains(&name) {
                    return repeated(name);
                }
                elements.push(name);
                properties.clear();
            }
            b"property" => {
                let name = named.last().unwrap_or_default();
                if properties.contains(&name) {
                    return repeated(name);
                }
                properties.push(name);
            }
            _ => {}
        }
        clean.push_str(&String::from_utf8_lossy(line));
        clean.push('\n');
        if line == b"end_header" {
            return Ok((clean, end_of(start, line), number));
        }
    }
    let message = format!("no line `end_header` in the first {} bytes", start.len());
    Err(InputError::new(path, message))
}

/// Where the body starts: after the end of the line that `last` is a part of. A
/// header with bare CR says so in its first line; otherwise a CR LF ends a line.
fn end_of(bytes: &[u8], last: &[u8]) -> usize {
    let bare_cr = bytes.iter().position(|b| *b == b'\r');
    let bare_cr = bare_cr.is_some_and(|at| bytes.get(at + 1) != Some(&b'\n'));
    let mut at = last.as_ptr().addr() - bytes.as_ptr().addr() + last.len();
    while bytes.get(at).is_some_and(|b| matches!(b, b' ' | b'\t')) {
        at += 1;
    }
    match (bytes.get(at), bytes.get(at + 1)) {
        (Some(b'\r'), Some(b'\n')) if !bare_cr => at + 2,
        (Some(_), _) => at + 1,
        (None, _) => at,
    }
}
