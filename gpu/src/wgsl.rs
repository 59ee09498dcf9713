//! A small linker for WGSL: `//#import name` is replaced, once, by the file of
//! that name, and every line of the result remembers where it came from. After
//! `//#import name for other` no import leads to `other` any more.

pub mod network;
mod shipped;

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use naga::front::wgsl;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

/// WGSL that does not link, parse or validate.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: {message}")]
pub struct WgslError {
    /// File name.
    pub file: String,
    /// Line from 1.
    pub line: usize,
    /// What is wrong.
    pub message: String,
}

/// The WGSL files by name, without their ending.
#[derive(Clone, Debug)]
pub struct Sources(BTreeMap<Cow<'static, str>, Cow<'static, str>>);

/// Marks a file that does not ship. An import's name is trimmed, so none has it.
const FOREIGN: &str = " ";

fn file_name(name: &str) -> String {
    match name.strip_prefix(FOREIGN) {
        Some(path) => path.to_owned(),
        None => format!("{name}.wgsl"),
    }
}

/// A linked text and the origin of each line.
#[derive(Clone, Debug)]
pub struct Linked {
    /// The whole program.
    pub text: String,
    origins: Vec<(String, usize)>,
}

/// A linked program that parsed and validated.
pub struct Program {
    /// The linked text.
    pub linked: Linked,
    /// Its IR.
    pub module: naga::Module,
    /// What validation found out about it.
    pub info: ModuleInfo,
}

impl Sources {
    /// A copy with one defect: `find`, which must occur exactly once in `file`,
    /// replaced.
    ///
    /// # Errors
    /// The file is unknown, or `find` does not occur exactly once.
    pub fn patched(&self, file: &str, find: &str, replace: &str) -> Result<Self, WgslError> {
        let fail = |message: String| WgslError {
            file: format!("{file}.wgsl"),
            line: 1,
            message,
        };
        let mut files = self.0.clone();
        let text = files
            .get_mut(file)
            .ok_or_else(|| fail("no such file".into()))?;
        match text.matches(find).count() {
            1 => *text = Cow::Owned(text.replacen(find, replace, 1)),
            n => {
                return Err(fail(format!(
                    "the text to replace occurs {n} times: {find}"
                )));
            }
        }
        Ok(Self(files))
    }

    /// The texts by name.
    pub fn files(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0
            .iter()
            .map(|(name, text)| (name.as_ref(), text.as_ref()))
    }

    /// These files and one more, which may import them.
    pub fn with(mut self, name: String, text: String) -> Self {
        self.0.insert(name.into(), text.into());
        self
    }

    /// The name among the sources of a file that does not ship. No import leads to it.
    pub fn foreign_name(file: &str) -> String {
        format!("{FOREIGN}{file}")
    }

    /// Links `root` with everything that it imports.
    ///
    /// # Errors
    /// An import that names no file, with its place.
    pub fn link(&self, root: &str) -> Result<Linked, WgslError> {
        let mut linked = Linked {
            text: String::new(),
            origins: Vec::new(),
        };
        self.append(root, &mut BTreeSet::new(), &mut linked, ("", 1))?;
        Ok(linked)
    }

    fn append<'s>(
        &'s self,
        name: &'s str,
        seen: &mut BTreeSet<&'s str>,
        linked: &mut Linked,
        from: (&str, usize),
    ) -> Result<(), WgslError> {
        if !seen.insert(name) {
            return Ok(());
        }
        let text = self.0.get(name).ok_or_else(|| WgslError {
            file: file_name(from.0),
            line: from.1,
            message: format!("import of an unknown file: {name}"),
        })?;
        for (number, line) in (1..).zip(text.lines()) {
            if let Some(import) = line.strip_prefix("//#import ") {
                let (import, stands_for) = parts(import);
                self.append(import, seen, linked, (name, number))?;
                seen.extend(stands_for);
            } else {
                linked.text.push_str(line);
                linked.text.push('\n');
                linked.origins.push((file_name(name), number));
            }
        }
        Ok(())
    }
}

/// The file that an import names, and the one in whose place it stands, if it says so.
fn parts(import: &str) -> (&str, Option<&str>) {
    match import.split_once(" for ") {
        Some((file, other)) => (file.trim(), Some(other.trim())),
        None => (import.trim(), None),
    }
}

impl Linked {
    /// Parses and validates, with errors at their file and line.
    ///
    /// # Errors
    /// The first thing that naga refuses.
    pub fn parse(self) -> Result<Program, WgslError> {
        let module = wgsl::parse_str(&self.text).map_err(|e| {
            let line = e.location(&self.text).map_or(1, |l| l.line_number);
            self.error(line, e.message())
        })?;
        let capabilities = Capabilities::default()
            | Capabilities::SHADER_INT64
            | Capabilities::SHADER_INT64_ATOMIC_MIN_MAX
            | Capabilities::SHADER_INT64_ATOMIC_ALL_OPS
            | Capabilities::EARLY_DEPTH_TEST;
        let info = Validator::new(ValidationFlags::all(), capabilities)
            .validate(&module)
            .map_err(|e| {
                let line = e.location(&self.text).map_or(1, |l| l.line_number);
                self.error(line, &chain(e.as_inner()))
            })?;
        Ok(Program {
            linked: self,
            module,
            info,
        })
    }

    fn error(&self, line: u32, message: &str) -> WgslError {
        let (file, line) = self
            .origins
            .get((line as usize).saturating_sub(1))
            .cloned()
            .unwrap_or_else(|| ("?".into(), 1));
        WgslError {
            file,
            line,
            message: message.into(),
        }
    }
}

/// What a fragment entry point has to do with depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Depth {
    /// Nothing.
    Unused,
    /// It gives the depth of its pixel.
    Written,
    /// It runs where a triangle is not behind it.
    Tested,
}

impl Program {
    /// A mistake at a line of the linked text, as a mistake at its origin.
    pub fn error(&self, line: u32, message: &str) -> WgslError {
        self.linked.error(line, message)
    }

    /// The line of the linked text where a span starts.
    pub fn line_at(&self, span: naga::Span) -> u32 {
        span.location(&self.linked.text).line_number
    }

    /// The first line of the linked text that contains `words`, or the first of all.
    pub fn line_of(&self, words: &str) -> u32 {
        let mut lines = (1..).zip(self.linked.text.lines());
        lines
            .find(|(_, line)| line.contains(words))
            .map_or(1, |(number, _)| number)
    }

    /// Whether an entry point returns anything.
    pub fn returns(&self, entry: &str) -> bool {
        let mut entries = self.module.entry_points.iter();
        entries.any(|e| e.name == entry && e.function.result.is_some())
    }

    /// What a fragment entry point has to do with depth.
    pub fn depth(&self, entry: &str) -> Depth {
        let mut entries = self.module.entry_points.iter();
        let Some(entry) = entries.find(|e| e.name == entry) else {
            return Depth::Unused;
        };
        let result = entry.function.result.as_ref();
        let binding = result.and_then(|result| result.binding.as_ref());
        match (entry.early_depth_test, binding) {
            (Some(_), _) => Depth::Tested,
            (None, Some(naga::Binding::BuiltIn(naga::BuiltIn::FragDepth))) => Depth::Written,
            _ => Depth::Unused,
        }
    }

    /// The names of all resource variables by their bindings.
    pub fn names(&self) -> BTreeMap<u32, String> {
        let variables = self.module.global_variables.iter();
        let named = |v: &naga::GlobalVariable| Some((v.binding.as_ref()?.binding, v.name.clone()?));
        variables.filter_map(|(_, v)| named(v)).collect()
    }

    /// The resource variables that an entry point uses: name and binding, in order
    /// of binding. `None` if there is no such entry point.
    pub fn bindings(&self, entry: &str) -> Option<Vec<(String, u32)>> {
        let index = self
            .module
            .entry_points
            .iter()
            .position(|e| e.name == entry)?;
        let used = self.info.get_entry_point(index);
        let mut bindings: Vec<(String, u32)> = self
            .module
            .global_variables
            .iter()
            .filter(|(handle, _)| !used[*handle].is_empty())
            .filter_map(|(_, v)| Some((v.name.clone()?, v.binding.as_ref()?.binding)))
            .collect();
        bindings.sort_by_key(|b| b.1);
        Some(bindings)
    }
}

/// An error with all its sources, on one line.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(e) = source {
        text.push_str(": ");
        text.push_str(&e.to_string());
        source = e.source();
    }
    text
}
