//! What a machine without a toolchain needs: the program, Embree, scenes with their
//! meshes, and a script that starts it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{env, fs, io};

use crate::bench::paper;
use crate::corpus::{self, Entry, FINDINGS};
use crate::embree;
use crate::error::InputError;
use crate::mesh::Intake;
use crate::scene::{self, LoadError, Loaded};

/// Starts the program beside it, with everything that it looks for beside it.
const RUN: &str = r#"#!/bin/sh
# Replays the scenes beside this script: ./run. Or does what it is told: ./run doctor,
# ./run replay raster/ --json out.json. The report comes to reports/out/ beside it.
#
# Vulkan's loader and a driver are the machine's own; ./run doctor says what it finds.
set -eu
here=$(CDPATH='' cd -- "$(dirname "$0")" && pwd -P)
LD_LIBRARY_PATH=$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
export LD_LIBRARY_PATH TRIPTYCH_CORPUS="$here/corpus" TRIPTYCH_NATIVE="$here/native"
export TRIPTYCH_AS="$0"
[ $# -gt 0 ] || set -- replay --no-cache
exec "$here/triptych" "$@"
"#;

/// What came into a bundle.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Bundled {
    /// Files relative to the bundle, with their bytes, in the order in which they came.
    pub files: Vec<(PathBuf, u64)>,
    /// What was left out, or is as it should not be, one line each.
    pub remarks: Vec<String>,
}

/// Packs this program and some scenes into a new folder; if they are `all`, what `bench` reads beside
/// them, too.
///
/// # Errors
/// A folder that is there already and not empty, a scene that does not load, an Embree
/// whose file the system does not tell, whatever the system says.
pub fn bundle(to: &Path, scenes: &[Entry], all: bool) -> Result<Bundled, InputError> {
    let fail = |e: io::Error| InputError::new(to, format!("cannot be written: {e}"));
    if fs::read_dir(to).is_ok_and(|mut inside| inside.next().is_some()) {
        return Err(InputError::new(to, "is not empty; name a new folder"));
    }
    fs::create_dir_all(to).map_err(fail)?;
    let mut packer = Packer {
        to,
        bundled: Bundled::default(),
    };
    let mut pack = || -> Result<(), InputError> {
        packer.program().map_err(fail)?;
        for library in libraries().map_err(|message| InputError::new(to, message))? {
            let name = library.file_name().unwrap_or_default();
            packer
                .copy(&library, &Path::new("lib").join(name))
                .map_err(fail)?;
        }
        for entry in scenes {
            packer.scene(&entry.name, |intake| scene::load_from(intake, entry, None))?;
        }
        for measured in paper::SCENES.iter().filter(|_| all) {
            packer.scene(measured.name, |intake| measured.load_from(intake))?;
        }
        packer.findings()?;
        let lock = corpus::root().join("meshes.lock");
        packer
            .copy(&lock, Path::new("corpus/meshes.lock"))
            .map_err(fail)
    };
    pack()?;
    Ok(packer.bundled)
}

/// Copies into a bundle, each file once.
struct Packer<'a> {
    to: &'a Path,
    bundled: Bundled,
}

impl Packer<'_> {
    fn copy(&mut self, from: &Path, name: &Path) -> io::Result<()> {
        if self.bundled.files.iter().any(|(known, _)| known == name) {
            return Ok(());
        }
        let path = self.to.join(name);
        fs::create_dir_all(path.parent().unwrap_or(self.to))?;
        let bytes = fs::copy(from, path)?;
        self.bundled.files.push((name.to_owned(), bytes));
        Ok(())
    }

    /// The program without what only debuggers read, and the script.
    fn program(&mut self) -> io::Result<()> {
        self.copy(&env::current_exe()?, Path::new("triptych"))?;
        let program = self.to.join("triptych");
        let strip = Command::new("strip")
            .arg(&program)
            .stdin(Stdio::null())
            .output();
        match strip {
            Ok(output) if output.status.success() => {}
            Ok(output) => {
                let why = String::from_utf8_lossy(&output.stderr).into_owned();
                self.remark(format!("triptych keeps its symbols: strip: {}", why.trim()));
            }
            Err(error) => self.remark(format!("triptych keeps its symbols: strip: {error}")),
        }
        self.bundled.files[0].1 = program.metadata()?.len();
        let script = self.to.join("run");
        fs::write(&script, RUN)?;
        executable(&script)?;
        self.bundled.files.push(("run".into(), RUN.len() as u64));
        Ok(())
    }

    /// What drivers do wrong, all of it: `doctor` looks for it on the other machine, too.
    fn findings(&mut self) -> Result<(), InputError> {
        let (corpus, name) = (corpus::root(), Path::new("corpus"));
        let fail = |e: io::Error| InputError::new(corpus.join(FINDINGS), e.to_string());
        if !corpus.join(FINDINGS).is_dir() {
            return Ok(());
        }
        for case in corpus::folders(&corpus.join(FINDINGS))? {
            let folder = Path::new(FINDINGS).join(case);
            for file in fs::read_dir(corpus.join(&folder)).map_err(fail)? {
                let file = file.map_err(fail)?;
                let to = name.join(&folder).join(file.file_name());
                self.copy(&file.path(), &to).map_err(fail)?;
            }
        }
        Ok(())
    }

    fn remark(&mut self, line: String) {
        self.bundled.remarks.push(line.replace('\n', " "));
    }

    /// A scene's folder, and the packages' meshes that it reads. A scene whose package
    /// is not there is left out, and said to be.
    fn scene(
        &mut self,
        name: &str,
        load: impl FnOnce(&mut Intake) -> Result<Loaded, LoadError>,
    ) -> Result<(), InputError> {
        let mut intake = Intake::from_disk();
        match load(&mut intake) {
            Ok(_) => {}
            Err(LoadError::Input(error)) => return Err(error),
            Err(missing) => {
                self.remark(format!("{name} is left out: {missing}"));
                return Ok(());
            }
        }
        let fail =
            |file: &Path, e: io::Error| InputError::new(file, format!("cannot be packed: {e}"));
        let (meshes, corpus) = (corpus::meshes(), corpus::root());
        let read: BTreeSet<&PathBuf> = intake.taken().iter().collect();
        for file in read {
            let name = match (file.strip_prefix(&corpus), file.strip_prefix(&meshes)) {
                (Ok(name), _) => Path::new("corpus").join(name),
                (_, Ok(name)) => Path::new("native/meshes").join(name),
                _ => {
                    let message = "is not in the corpus; `triptych add` puts a scene there";
                    return Err(InputError::new(file, message));
                }
            };
            self.copy(file, &name).map_err(|e| fail(file, e))?;
        }
        Ok(())
    }
}

#[cfg(unix)]
fn executable(script: &Path) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(script, fs::Permissions::from_mode(0o755))
}

#[cfg(not(unix))]
fn executable(_: &Path) -> io::Result<()> {
    Ok(())
}

/// Embree and the library of threads that it needs, by each name that they go by in
/// their folder: a linker may want any of them.
fn libraries() -> Result<Vec<PathBuf>, String> {
    let library = embree::library().map_err(|e| e.to_string())?;
    let path = library
        .path
        .ok_or("this system does not tell which file Embree is")?;
    let folder = path.parent().unwrap_or(Path::new("/"));
    let fail = |e: io::Error| format!("{}: {e}", folder.display());
    let mut found = Vec::new();
    for file in fs::read_dir(folder).map_err(fail)? {
        let file = file.map_err(fail)?;
        let name = file.file_name().to_string_lossy().into_owned();
        // A name without a version is for linking only.
        let ours = ["libembree4", "libtbb"].iter().any(|l| name.starts_with(l));
        if ours && name.contains(".so.") {
            found.push(file.path());
        }
    }
    found.sort();
    Ok(found)
}
