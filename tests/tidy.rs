//! Rules of the repository that a reader should not have to look after.

#[path = "tidy/manifests.rs"]
mod manifests;
#[path = "tidy/reach.rs"]
mod reach;
#[path = "tidy/text.rs"]
mod text;

use std::fs;
use std::path::{Path, PathBuf};

/// A file of the repository.
struct File {
    /// From the repository's root, with `/`.
    name: String,
    bytes: Vec<u8>,
}

impl File {
    fn text(&self) -> &str {
        std::str::from_utf8(&self.bytes).unwrap_or_default()
    }

    fn extension(&self) -> &str {
        let (_, file) = self.name.rsplit_once('/').unwrap_or(("", &self.name));
        file.rsplit_once('.').map_or("", |(_, extension)| extension)
    }

    /// Shell scripts, by the first line or the ending.
    fn is_script(&self) -> bool {
        self.bytes.starts_with(b"#!") || self.extension() == "sh"
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("")
}

/// Every file that git does not ignore, by name. What is ignored are whole folders, by
/// everybody or in this clone.
fn files() -> Vec<File> {
    let mut ignored = fs::read_to_string(root().join(".gitignore")).expect("there is one");
    ignored += &fs::read_to_string(root().join(".git/info/exclude")).unwrap_or_default();
    let mut ignored: Vec<&str> = ignored.lines().map(|l| l.trim_matches('/')).collect();
    ignored.push(".git");
    let (mut folders, mut files) = (vec![String::new()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(root().join(&folder)).expect("a folder can be listed") {
            let entry = entry.expect("a folder can be listed");
            let file = entry.file_name().to_string_lossy().into_owned();
            let name = if folder.is_empty() {
                file
            } else {
                format!("{folder}/{file}")
            };
            let path = entry.path();
            if ignored.contains(&name.as_str()) {
                continue;
            } else if path.is_dir() {
                folders.push(name);
            } else {
                // An editor may take a file away meanwhile.
                files.extend(fs::read(path).ok().map(|bytes| File { name, bytes }));
            }
        }
    }
    files.sort_by(|a, b| a.name.cmp(&b.name));
    assert!(
        files.len() > 100,
        "only {} files: not all were found",
        files.len()
    );
    files
}

/// Fails with a line for each violation.
#[track_caller]
fn assert_none(violations: &[String]) {
    let all = violations.join("\n");
    assert!(
        violations.is_empty(),
        "{} violations:\n{all}",
        violations.len()
    );
}
