//! Where commands leave their results.

use std::fs::{self, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

use anyhow::Context;

use crate::corpus;

/// The folder of the report and all beside it: `reports/out`, beside the corpus.
pub fn out() -> PathBuf {
    corpus::root().with_file_name("reports").join("out")
}

/// The report.
pub fn page() -> PathBuf {
    out().join("index.html")
}

/// The last run of all mutants, which the report shows.
pub fn mutants() -> PathBuf {
    out().join("mutants.json")
}

/// The folder of what `bench` measured.
pub fn bench() -> PathBuf {
    out().join("bench")
}

/// Writes a file; its folder is made if absent.
pub fn write(file: &Path, text: impl AsRef<[u8]>) -> anyhow::Result<()> {
    let written = make_folder(file).and_then(|()| fs::write(file, text));
    written.with_context(|| cannot(file))
}

/// Whether files can be written, to be told before what comes into them is worked out at
/// length. Their folders are made if absent, and none of the files is changed or left.
///
/// # Errors
/// The first that cannot.
pub fn can_write<'f>(files: impl IntoIterator<Item = &'f PathBuf>) -> anyhow::Result<()> {
    for file in files {
        opens(file).with_context(|| cannot(file))?;
    }
    Ok(())
}

fn opens(file: &Path) -> io::Result<()> {
    make_folder(file)?;
    // A pipe's reader would take this for the end.
    if fs::metadata(file).is_ok_and(|found| !found.is_file() && !found.is_dir()) {
        return Ok(());
    }
    let is_new = fs::symlink_metadata(file).is_err();
    OpenOptions::new().append(true).create(true).open(file)?;
    match is_new {
        true => fs::remove_file(file),
        false => Ok(()),
    }
}

fn make_folder(file: &Path) -> io::Result<()> {
    file.parent().map_or(Ok(()), fs::create_dir_all)
}

fn cannot(file: &Path) -> String {
    format!("cannot write {}", file.display())
}
