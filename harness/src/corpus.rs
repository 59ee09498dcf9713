//! Finding scenes: the corpus, and files outside it.

mod name;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::error::InputError;

/// A scene that can be replayed.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    /// `family/case` in the corpus; outside it the file's stem, or as much of its
    /// path as tells it apart.
    pub name: String,
    /// `raster`, `abuffer`, `grid`, `rsm` or `ldm`; files outside the corpus count as `abuffer`, the
    /// family that runs every stage.
    pub family: String,
    /// The scene.toml, or a bare mesh.
    pub path: PathBuf,
}

/// The corpus folder: `TRIPTYCH_CORPUS`, else the one that the harness was built
/// from, else `corpus` in the working directory.
pub fn root() -> PathBuf {
    if let Some(root) = std::env::var_os("TRIPTYCH_CORPUS") {
        return root.into();
    }
    let built = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("corpus");
    if built.is_dir() {
        built
    } else {
        "corpus".into()
    }
}

/// What set-up installed: `$TRIPTYCH_NATIVE`, else `.native` beside the corpus.
pub fn native() -> PathBuf {
    match std::env::var_os("TRIPTYCH_NATIVE") {
        Some(native) => native.into(),
        None => root().with_file_name(".native"),
    }
}

/// Where packages' meshes lie.
pub fn meshes() -> PathBuf {
    native().join("meshes")
}

/// The folder of the corpus that holds no scenes for every leg, but what single drivers do
/// wrong ([`crate::findings`]).
pub const FINDINGS: &str = "findings";

/// Every scene of the corpus, by name.
///
/// # Errors
/// A folder that cannot be read, or a case without a scene.toml.
pub fn list(root: &Path) -> Result<Vec<Entry>, InputError> {
    let mut entries = Vec::new();
    for family in folders(root)? {
        if family == FINDINGS {
            continue;
        }
        for case in folders(&root.join(&family))? {
            let path = root.join(&family).join(&case).join("scene.toml");
            if !path.is_file() {
                return Err(InputError::new(
                    path,
                    "missing: every case has a scene.toml",
                ));
            }
            entries.push(Entry {
                name: format!("{family}/{case}"),
                family: family.clone(),
                path,
            });
        }
    }
    Ok(entries)
}

/// Names of the folders in a folder, sorted; hidden ones left out.
pub(crate) fn folders(at: &Path) -> Result<Vec<String>, InputError> {
    let fail = |e: std::io::Error| InputError::new(at, format!("cannot be read: {e}"));
    let mut names = Vec::new();
    for entry in std::fs::read_dir(at).map_err(fail)? {
        let entry = entry.map_err(fail)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.path().is_dir() && !name.starts_with('.') {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}

/// The entries that any pattern selects, each once; all of them without a
/// pattern. A pattern is a part of a name, or with `exact` the whole name; or the
/// path of a scene.toml, of its folder, or of a bare mesh. No two have one name.
///
/// # Errors
/// A pattern that selects nothing.
pub fn select(
    entries: &[Entry],
    patterns: &[String],
    exact: bool,
) -> Result<Vec<Entry>, InputError> {
    if patterns.is_empty() {
        return Ok(entries.to_vec());
    }
    let mut selected = Vec::new();
    for pattern in patterns {
        let matches = |e: &&Entry| match exact {
            true => e.name == *pattern,
            false => e.name.contains(pattern.as_str()),
        };
        let before = selected.len();
        selected.extend(entries.iter().filter(matches).cloned());
        if selected.len() == before {
            selected.push(outside(entries, pattern)?);
        }
    }
    let mut seen = BTreeSet::new();
    selected.retain(|e| seen.insert(place(&e.path)));
    name::tell_apart(entries, &mut selected)?;
    Ok(selected)
}

/// The scene that a path leads to.
fn outside(entries: &[Entry], pattern: &str) -> Result<Entry, InputError> {
    let given = Path::new(pattern);
    let path = match given.is_dir() {
        true => given.join("scene.toml"),
        false => given.to_owned(),
    };
    // What looks like a file is taken for one even if it is missing: the loader
    // then says so, which helps more than "no scene matches".
    let file = path.exists() || is_mesh(&path) || has_extension(&path, "toml");
    if !file {
        let message = "matches no scene of the corpus (see `triptych list`) and is no file";
        return Err(InputError::new(given, message));
    }
    let here = place(&path);
    if let Some(entry) = entries.iter().find(|e| place(&e.path) == here) {
        return Ok(entry.clone());
    }
    Ok(Entry::outside(&path))
}

impl Entry {
    /// What selects this scene alone by `--exact`: its name in the corpus, its file
    /// outside it.
    pub fn argument(&self, corpus: &[Self]) -> String {
        match corpus.contains(self) {
            true => self.name.clone(),
            false => self.path.to_string_lossy().into_owned(),
        }
    }

    /// A scene outside the corpus, as if it were the only one.
    pub fn outside(path: &Path) -> Self {
        Self {
            name: name::stem(&place(path)),
            family: "abuffer".to_owned(),
            path: path.to_owned(),
        }
    }
}

/// Where a file lies, however one gets there. A file that is a link stays what it
/// is: meshes and materials are looked for beside the link.
fn place(path: &Path) -> PathBuf {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    match (whole.parent().map(Path::canonicalize), whole.file_name()) {
        (Some(Ok(folder)), Some(file)) => folder.join(file),
        _ => whole,
    }
}

/// Whether a path names a mesh by its extension.
pub fn is_mesh(path: &Path) -> bool {
    let name = path.to_string_lossy().to_lowercase();
    let name = name.strip_suffix(".gz").unwrap_or(&name);
    name.ends_with(".obj") || name.ends_with(".ply")
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case(extension))
}
