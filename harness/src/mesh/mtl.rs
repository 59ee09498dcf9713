//! MTL material libraries through tobj: `Kd`, `d` and `Tr`; nothing else matters
//! here, and what other statements say is not looked at, as long as it is text.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Component, Path, PathBuf};

use super::text::{check_text, name, number, quote, statements, words};
use super::{Intake, MATERIALS_MAX};
use crate::error::InputError;

/// Largest library in bytes.
const LIBRARY_MAX: u64 = 1 << 24;

/// Most libraries of a mesh.
const LIBRARIES_MAX: usize = 64;

/// Reflectance where a library leaves it out.
const REFLECTANCE: f64 = 0.8;

/// Everything that the libraries of a mesh define; of two definitions of one name
/// the first counts.
#[derive(Default)]
pub(super) struct Library {
    defined: BTreeMap<String, ([f64; 3], f64)>,
    /// Statements so far: some exporters name their library before every object.
    statements: BTreeSet<String>,
    /// Libraries so far.
    count: usize,
}

impl Library {
    /// Reflectance and opacity by name.
    pub(super) fn find(&self, name: &str) -> Option<([f64; 3], f64)> {
        self.defined.get(name).copied()
    }

    /// Reads what an `mtllib` statement names, on a line of a mesh. A library that is
    /// missing, or not in or below the mesh's folder, is a warning.
    pub(super) fn add(
        &mut self,
        intake: &mut Intake,
        (mesh, line): (&Path, usize),
        names: &str,
        warnings: &mut Vec<String>,
    ) -> Result<(), InputError> {
        if !self.statements.insert(names.to_owned()) {
            return Ok(());
        }
        let folder = mesh.parent().unwrap_or(Path::new(""));
        // One name with blanks, or several names.
        let whole = local(names).filter(|path| intake.has(&folder.join(path)));
        let paths: Vec<(&str, Option<PathBuf>)> = match whole {
            Some(path) => vec![(names, Some(path))],
            None => names.split_whitespace().map(|n| (n, local(n))).collect(),
        };
        for (name, path) in paths {
            self.count += 1;
            if self.count > LIBRARIES_MAX {
                let message = format!("more than {LIBRARIES_MAX} material libraries, the limit");
                return Err(InputError::at(mesh, line, message));
            }
            let shown = quote(name.as_bytes());
            let Some(path) = path.map(|p| folder.join(p)) else {
                warnings.push(format!(
                    "material library {shown} lies outside the mesh's folder"
                ));
                continue;
            };
            if !intake.has(&path) {
                warnings.push(format!("material library {shown} is not there"));
                continue;
            }
            let bytes = intake.read(&path, LIBRARY_MAX)?;
            for (name, surface) in parse(&path, &bytes)? {
                self.defined.entry(name).or_insert(surface);
            }
            if self.defined.len() as u64 > MATERIALS_MAX {
                return Err(InputError::new(&path, too_many()));
            }
        }
        Ok(())
    }
}

fn too_many() -> String {
    format!("the materials exceed the limit of {MATERIALS_MAX}")
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
        check_text(&s.text, "a material library").map_err(error)?;
        let mut values = words(&s.text);
        let keyword = values.next().unwrap_or_default();
        if !matches!(keyword, b"newmtl" | b"Kd" | b"d" | b"Tr") {
            continue;
        }
        if keyword == b"newmtl" {
            if names.len() as u64 == MATERIALS_MAX {
                return Err(error(too_many()));
            }
            let _ = writeln!(clean, "newmtl {}", names.len());
            names.push(name(&s.text).map_err(error)?);
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
