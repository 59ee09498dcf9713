//! A new scene of the corpus, from a mesh or from a folder that holds a scene.
//!
//! What is put into the corpus loads, is small, and lies there whole or not at all.

use std::path::{Path, PathBuf};
use std::{fs, io};

use crate::corpus::{self, Entry};
use crate::error::InputError;
use crate::mesh::Intake;
use crate::registry::FAMILIES;
use crate::scene::{self, LoadError};

/// Most bytes of a scene's own files: some hundred lines. What is larger comes from a
/// package, as a row of `meshes.lock`.
pub const BYTES_MAX: u64 = 1 << 18;

/// What a new scene is called and for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct New {
    /// The folder in the corpus.
    pub family: String,
    /// The folder in the family's.
    pub case: String,
    /// What the scene is for; `None` if a scene file says so.
    pub purpose: Option<String>,
}

/// A scene that was added.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Added {
    /// The scene.
    pub entry: Entry,
    /// Its files, relative to its folder.
    pub files: Vec<PathBuf>,
}

/// Puts a scene into the corpus: its files, and its row in the corpus' README. `from` is
/// a mesh, or a folder with a `scene.toml` and the meshes that it names.
///
/// # Errors
/// A name that is taken or none, files that do not load or are too large, a scene of
/// packages that are not there, and whatever the system says.
pub fn add(corpus: &Path, from: &Path, new: &New) -> Result<Added, InputError> {
    let place = corpus.join(&new.family).join(&new.case);
    check_name(&place, new)?;
    let source = Source::of(from, new)?;
    let files = source.files(corpus, new)?;
    let readme = corpus.join("README.md");
    let page = read(&readme)?;
    let row = (new.case.as_str(), source.purpose.as_str());
    let page = with_row(&page, &new.family, row)
        .ok_or_else(|| InputError::new(&readme, format!("has no table of {}", new.family)))?;
    // Aside first, then into its place as a whole; hidden folders are no scenes.
    let aside = corpus.join(&new.family).join(format!(".{}", new.case));
    let put = || -> io::Result<()> {
        for (name, bytes) in &files {
            let path = aside.join(name);
            fs::create_dir_all(path.parent().unwrap_or(&aside))?;
            fs::write(path, bytes)?;
        }
        fs::rename(&aside, &place)?;
        fs::write(&readme, &page)
    };
    put().map_err(|e| {
        // What is left of it is in nobody's way, and the error is what matters.
        let _ = fs::remove_dir_all(&aside);
        InputError::new(&place, format!("cannot be written: {e}"))
    })?;
    Ok(Added {
        entry: Entry {
            name: format!("{}/{}", new.family, new.case),
            family: new.family.clone(),
            path: place.join("scene.toml"),
        },
        files: files.into_iter().map(|(name, _)| name).collect(),
    })
}

/// A case that an existing family does not have yet.
fn check_name(place: &Path, new: &New) -> Result<(), InputError> {
    let fail = |message: String| Err(InputError::new(place, message));
    let families = FAMILIES.iter().filter(|f| f.no_corpus.is_none());
    let families: Vec<&str> = families.map(|f| f.name).collect();
    if !families.contains(&new.family.as_str()) {
        return fail(format!("families with scenes are {}", families.join(", ")));
    }
    let kept = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if !new.case.starts_with(|c: char| c.is_ascii_lowercase()) || !new.case.chars().all(kept) {
        return fail("a case is called by small letters, digits and `-`, a letter first".into());
    }
    match place.exists() {
        true => fail("is there already; edit it, or choose another name".into()),
        false => Ok(()),
    }
}

/// What a scene is made from.
struct Source {
    /// The folder from which files are copied.
    folder: PathBuf,
    /// The scene file.
    text: String,
    purpose: String,
}

impl Source {
    fn of(from: &Path, new: &New) -> Result<Self, InputError> {
        let fail = |message: &str| Err(InputError::new(from, message));
        if from.is_dir() {
            let path = from.join("scene.toml");
            let purpose = scene::purpose(&path)?;
            if new.purpose.is_some() {
                return fail("its scene.toml says what it is for; leave out --purpose");
            }
            let (folder, text) = (from.to_owned(), read(&path)?);
            return Ok(Self {
                folder,
                text,
                purpose,
            });
        }
        if !corpus::is_mesh(from) {
            return fail("is neither a mesh (.obj, .ply, or .gz of either) nor a folder");
        }
        let Some(purpose) = new.purpose.clone() else {
            return fail("say with --purpose, in one sentence, what the scene shows");
        };
        let name = from.file_name().and_then(|n| n.to_str());
        let Some(name) = name else {
            return fail("has a name that a scene.toml cannot hold; rename it");
        };
        Ok(Self {
            folder: from.parent().unwrap_or(Path::new("")).to_owned(),
            text: scaffold(&purpose, name),
            purpose,
        })
    }

    /// The files that the scene reads, each with its bytes, once it has been loaded.
    fn files(&self, corpus: &Path, new: &New) -> Result<Vec<(PathBuf, Vec<u8>)>, InputError> {
        let path = self.folder.join("scene.toml");
        let entry = Entry {
            name: format!("{}/{}", new.family, new.case),
            family: new.family.clone(),
            path: path.clone(),
        };
        let mut intake = Intake::from_disk();
        let loaded = scene::load_text(&mut intake, &entry, None, &self.text);
        loaded.map_err(|e| match e {
            LoadError::Input(e) => e,
            missing @ LoadError::Missing { .. } => InputError::new(&path, missing.to_string()),
        })?;
        let mut files = vec![(PathBuf::from("scene.toml"), self.text.clone().into_bytes())];
        let mut bytes = self.text.len() as u64;
        let (packages, lock) = (corpus::meshes(), corpus.join("meshes.lock"));
        let own = |f: &&PathBuf| !f.starts_with(&packages) && **f != lock;
        for file in intake.taken().iter().filter(own) {
            let Ok(name) = file.strip_prefix(&self.folder) else {
                let message = "lies outside the scene's folder, and a scene holds what it reads";
                return Err(InputError::new(file, message));
            };
            let read = Intake::from_disk().read(file, BYTES_MAX)?;
            bytes += read.len() as u64;
            if bytes > BYTES_MAX {
                let message = format!(
                    "with it the scene's own files have more than {BYTES_MAX} bytes, the limit; what \
                     is larger comes from a package ({} says how)",
                    corpus.join("README.md").display()
                );
                return Err(InputError::new(file, message));
            }
            if !files.iter().any(|(known, _)| known == name) {
                files.push((name.to_owned(), read));
            }
        }
        Ok(files)
    }
}

fn read(path: &Path) -> Result<String, InputError> {
    fs::read_to_string(path).map_err(|e| InputError::new(path, format!("cannot be read: {e}")))
}

/// The scene of a bare mesh.
fn scaffold(purpose: &str, mesh: &str) -> String {
    let string = |text: &str| toml::Value::from(text).to_string();
    format!(
        "purpose = {}\nsize = [256, 256]\n\n\
         # Left out, the camera shows everything, lights are the default ones, and faces without\n\
         # a material are light grey at opacity 0.5. corpus/README.md has every key. What can be\n\
         # worked out on paper goes under [expect].\n\n\
         [[mesh]]\nfile = {}\n",
        string(purpose),
        string(mesh),
    )
}

/// The page with another row in a family's table, which is in order of cases.
fn with_row(page: &str, family: &str, (case, purpose): (&str, &str)) -> Option<String> {
    let head = format!("| `{family}/` |");
    let purpose = purpose.trim().replace('|', "\\|");
    let row = format!("| `{case}` | {purpose} |");
    let mut lines: Vec<&str> = page.lines().collect();
    let table = lines.iter().position(|l| l.starts_with(&head))? + 2;
    let rows = lines.get(table..)?;
    let length = rows.iter().take_while(|l| l.starts_with('|')).count();
    let name = |line: &str| line.split('`').nth(1).unwrap_or_default().to_owned();
    let after = rows[..length].iter().position(|l| name(l).as_str() > case);
    lines.insert(table + after.unwrap_or(length), &row);
    Some(lines.join("\n") + "\n")
}
