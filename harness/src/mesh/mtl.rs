//! MTL material libraries through tobj: `Kd`, `d` and `Tr`; nothing else matters
//! here, and what other statements say is not looked at.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Component, Path, PathBuf};

use super::read::read;
use super::text::{number, quote, rest, statements, words};
use crate::error::InputError;

/// Largest library in bytes.
const LIBRARY_MAX: u64 = 1 << 24;

/// Reflectance where a library leaves it out.
const REFLECTANCE: f64 = 0.8;

/// Everything that the libraries of a mesh define; of two definitions of one name
/// the first counts.
#[derive(Default)]
pub(super) struct Library {
    defined: BTreeMap<String, ([f64; 3], f64)>,
}

impl Library {
    /// Reflectance and opacity by name.
    pub(super) fn find(&self, name: &str) -> Option<([f64; 3], f64)> {
        self.defined.get(name).copied()
    }

    /// Reads what an `mtllib` statement names. A library that is missing, or not
    /// in or below the mesh's folder, is a warning.
    pub(super) fn add(
        &mut self,
        mesh: &Path,
        names: &str,
        warnings: &mut Vec<String>,
    ) -> Result<(), InputError> {
        let folder = mesh.parent().unwrap_or(Path::new(""));
        // One name with blanks, or several names.
        let whole = local(names).filter(|path| folder.join(path).exists());
        let paths: Vec<(&str, Option<PathBuf>)> = match whole {
            Some(path) => vec![(names, Some(path))],
            None => names.split_whitespace().map(|n| (n, local(n))).collect(),
        };
        for (name, path) in paths {
            let shown = quote(name.as_bytes());
            let Some(path) = path.map(|p| folder.join(p)) else {
                warnings.push(format!(
                    "material library {shown} lies outside the mesh's folder"
                ));
                continue;
            };
            if !path.exists() {
                warnings.push(format!("material library {shown} is not there"));
                continue;
            }
            let bytes = read(&path, LIBRARY_MAX)?;
            for (name, surface) in parse(&path, &bytes)? {
                self.defined.entry(name).or_insert(surface);
            }
        }
        Ok(())
    }
}

/// A path that stays in or below the folder; Windows' separators count too.
fn local(name: &str) -> Option<PathBuf> {
    let path = PathBuf::from(name.replace('\\', "/"));
    let inside = |c: Component| matches!(c, Component::Normal(_) | Component::CurDir);
    (!name.is_empty() && path.components().all(inside)).then_some(path)
}

type Defined = Vec<(String, ([f64; 3], f64))>;

/// Checks a library and rewrites it for tobj, whose errors name no line.
fn parse(path: &Path, bytes: &[u8]) -> Result<Defined, InputError> {
    let mut names = Vec::new();
    let mut clean = String::new();
    for s in statements(bytes) {
        let error = |message: String| InputError::at(path, s.line, message);
        let mut values = words(&s.text);
        let keyword = values.next().unwrap_or_default();
        if !matches!(keyword, b"newmtl" | b"Kd" | b"d" | b"Tr") {
            continue;
        }
        if keyword == b"newmtl" {
            let _ = writeln!(clean, "newmtl {}", names.len());
            names.push(rest(&s.text));
            continue;
        }
        if names.is_empty() {
            let message = format!("{} comes before any newmtl", quote(keyword));
            return Err(error(message));
        }
        match keyword {
            b"Kd" => {
                let [r, g, b] = reflectance(values).map_err(error)?;
                let _ = writeln!(clean, "Kd {r} {g} {b}");
            }
            // tobj knows `d` and keeps other statements as text.
            _ => {
                let share = share(values).map_err(error)?;
                let keyword = if keyword == b"d" { "d" } else { "Tr" };
                let _ = writeln!(clean, "{keyword} {share}");
            }
        }
    }
    let (materials, _) = tobj::load_mtl_buf(&mut clean.as_bytes())
        .map_err(|e| InputError::new(path, format!("tobj refuses it: {e}")))?;
    let surface = |m: &tobj::Material| {
        let reflectance = m.diffuse.map_or([REFLECTANCE; 3], |kd| kd.map(f64::from));
        // Tr is 1 - d. Where both stand and disagree, exporters got Tr wrong.
        let clear = m
            .unknown_param
            .get("Tr")
            .and_then(|t| t.parse::<f64>().ok());
        let opacity = m.dissolve.map(f64::from).or(clear.map(|t| 1.0 - t));
        (reflectance, opacity.unwrap_or(1.0))
    };
    Ok(names
        .into_iter()
        .zip(materials.iter().map(surface))
        .collect())
}

/// Red, green and blue, or one number for all three, each from 0 to 1.
fn reflectance<'w>(values: impl Iterator<Item = &'w [u8]>) -> Result<[f32; 3], String> {
    let values: Vec<&[u8]> = values.take(4).collect();
    let numbers: Vec<f32> = values.iter().map(|v| unit(v)).collect::<Result<_, _>>()?;
    match numbers[..] {
        [grey] => Ok([grey; 3]),
        [r, g, b] => Ok([r, g, b]),
        _ => Err(format!(
            "Kd has one or three numbers, and this has {}",
            values.len()
        )),
    }
}

/// One number from 0 to 1.
fn share<'w>(values: impl Iterator<Item = &'w [u8]>) -> Result<f32, String> {
    let values: Vec<&[u8]> = values.take(3).collect();
    match values[..] {
        [value] | [b"-halo", value] => unit(value),
        _ => Err("an opacity is one number from 0 to 1".to_owned()),
    }
}

fn unit(word: &[u8]) -> Result<f32, String> {
    let x = number(word)?;
    match (0.0..=1.0).contains(&x) {
        true => Ok(x),
        false => Err(format!("{} is outside 0 to 1", quote(word))),
    }
}
