//! Items of a PLY file: a vertex, a face, anything else.

use std::fmt::Write as _;

use ply_rs_bw::ply::{
    ElementDef, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType,
};

use super::super::text::{quote, words};
use super::ENTRIES_MAX;
use super::header::{CORNERS, width};

/// The position of a vertex.
pub(super) struct Vertex([f32; 3]);

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self([0.0; 3])
    }
    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        let axis = match name {
            "x" => 0,
            "y" => 1,
            "z" => 2,
            _ => return PropertyAccessResult::Ignored,
        };
        match value.to_f32_lossy() {
            Some(value) => self.0[axis] = value,
            None => return PropertyAccessResult::UnsupportedType,
        }
        PropertyAccessResult::Set
    }
}

impl Vertex {
    /// The position, if `f32` can hold it.
    pub(super) fn finite(&self) -> Result<[f32; 3], String> {
        match self.0.iter().find(|x| !x.is_finite()) {
            None => Ok(self.0),
            Some(x) => Err(format!("coordinate {x} is not finite in f32")),
        }
    }
}

/// The corners of a face.
pub(super) struct Face(Vec<i64>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(Vec::new())
    }
    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        if !CORNERS.contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        self.0 = match value {
            Property::ListChar(v) => v.into_iter().map(i64::from).collect(),
            Property::ListUChar(v) => v.into_iter().map(i64::from).collect(),
            Property::ListShort(v) => v.into_iter().map(i64::from).collect(),
            Property::ListUShort(v) => v.into_iter().map(i64::from).collect(),
            Property::ListInt(v) => v.into_iter().map(i64::from).collect(),
            Property::ListUInt(v) => v.into_iter().map(i64::from).collect(),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

impl Face {
    /// The corners, if there are so many vertices.
    pub(super) fn corners(&self, vertices: usize) -> Result<Vec<u32>, String> {
        let corner = |i: &i64| match u32::try_from(*i) {
            Ok(corner) if (corner as usize) < vertices => Ok(corner),
            _ => Err(format!(
                "vertex {i} is out of range; the file has {vertices}"
            )),
        };
        self.0.iter().map(corner).collect()
    }
}

/// An item that does not matter here.
pub(super) struct Other;

impl PropertyAccess for Other {
    fn new() -> Self {
        Self
    }
}

/// Refuses an item, in binary, whose lists have more than [`ENTRIES_MAX`] entries. The
/// parser would make room for all that the file has.
pub(super) fn check_lists(
    mut bytes: &[u8],
    big_endian: bool,
    element: &ElementDef,
) -> Result<(), String> {
    let mut entries = 0;
    for property in element.properties.values() {
        let length = match &property.data_type {
            PropertyType::Scalar(t) => width(t),
            PropertyType::List(counted, t) => {
                // What is missing, and a negative count, the parser names.
                let Some((count, rest)) = number(bytes, big_endian, counted) else {
                    return Ok(());
                };
                entries += count;
                if entries > ENTRIES_MAX {
                    return Err(too_many(entries));
                }
                bytes = rest;
                count * width(t)
            }
        };
        let Some(rest) = usize::try_from(length).ok().and_then(|n| bytes.get(n..)) else {
            return Ok(());
        };
        bytes = rest;
    }
    Ok(())
}

fn too_many(entries: u64) -> String {
    format!("its lists have {entries} entries or more, and {ENTRIES_MAX} are the limit")
}

/// The non-negative integer that bytes start with, and what follows it.
fn number<'a>(bytes: &'a [u8], big_endian: bool, t: &ScalarType) -> Option<(u64, &'a [u8])> {
    let (digits, rest) = bytes.split_at_checked(usize::try_from(width(t)).ok()?)?;
    let push = |n: u64, byte: &u8| n << 8 | u64::from(*byte);
    let number = match big_endian {
        true => digits.iter().fold(0, push),
        false => digits.iter().rev().fold(0, push),
    };
    let signed = matches!(t, ScalarType::Char | ScalarType::Short | ScalarType::Int);
    let negative = signed && number >> (8 * digits.len() - 1) == 1;
    (!negative).then_some((number, rest))
}

/// A line as the parser reads it: it knows neither `.5` nor `5.` nor `nan`, and
/// stops at bytes that are not UTF-8. What is not finite becomes `1e999`, which
/// matters in a coordinate only.
pub(super) fn rewrite(line: &[u8], element: &ElementDef) -> Result<String, String> {
    let scalars = |t: &PropertyType| matches!(t, PropertyType::Scalar(_));
    let plain = element.properties.values().all(|p| scalars(&p.data_type));
    // A list has a count, too.
    let most = ENTRIES_MAX + element.properties.len() as u64;
    let mut text = String::with_capacity(line.len() + 8);
    for (i, word) in words(line).enumerate() {
        if i as u64 == most {
            return Err(too_many(most));
        }
        let digits = word.strip_prefix(b"-").unwrap_or(word);
        let read = std::str::from_utf8(word).unwrap_or_default();
        if !digits.is_empty() && digits.iter().all(u8::is_ascii_digit) {
            text.push_str(read);
        } else {
            let Ok(value) = read.parse::<f64>() else {
                return Err(format!("{} is not a number", quote(word)));
            };
            let property = element
                .properties
                .get_index(i)
                .map(|(name, _)| name.as_str());
            let coordinate = plain && matches!(property, Some("x" | "y" | "z"));
            #[expect(clippy::cast_possible_truncation, reason = "asks whether it overflows")]
            let finite = (value as f32).is_finite();
            if !finite && coordinate {
                return Err(format!("{} is not finite", quote(word)));
            }
            match value.is_finite() {
                // The shortest digits that read back as the same number.
                true => write!(text, "{value:e}").expect("a string takes everything"),
                false => text.push_str("1e999"),
            }
        }
        text.push(' ');
    }
    Ok(text)
}
