//! Items of a PLY file: a vertex, a face, anything else.

use std::fmt::Write as _;

use ply_rs_bw::ply::{ElementDef, Property, PropertyAccess, PropertyAccessResult, PropertyType};

use super::super::text::{quote, words};
use super::header::CORNERS;

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

/// A line as the parser reads it: it knows neither `.5` nor `5.` nor `nan`, and
/// stops at bytes that are not UTF-8. What is not finite becomes `1e999`, which
/// matters in a coordinate only.
pub(super) fn rewrite(line: &[u8], element: &ElementDef) -> Result<String, String> {
    let scalars = |t: &PropertyType| matches!(t, PropertyType::Scalar(_));
    let plain = element.properties.values().all(|p| scalars(&p.data_type));
    let mut text = String::with_capacity(line.len() + 8);
    for (i, word) in words(line).enumerate() {
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
