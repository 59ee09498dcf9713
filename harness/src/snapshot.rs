//! Snapshots: what the spec found in a scene, as reviewers read it.
//!
//! `tests/scenes.rs` holds every scene against its snapshot through insta, and
//! `triptych add` leaves a pending one; both take the text from here.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{fs, io};

use crate::corpus::Entry;
use crate::replay::facts::Facts;

/// Where the snapshots of a corpus lie: `tests/snapshots` beside it.
pub fn folder(corpus: &Path) -> PathBuf {
    corpus.with_file_name("tests").join("snapshots")
}

/// The facts, one a line. Nothing of it is a float.
pub fn text(facts: &Facts) -> String {
    let Facts {
        counts,
        runs,
        hashes,
    } = facts;
    let mut text = String::new();
    for (of, count) in counts {
        let _ = writeln!(text, "{of}: {count}");
    }
    text.push_str("runs:\n");
    for run in runs {
        let _ = writeln!(text, "  - {run}");
    }
    text.push_str("hashes:\n");
    for (of, hash) in hashes {
        let _ = writeln!(text, "  {of}: {hash}");
    }
    text.truncate(text.trim_end().len());
    text
}

/// Leaves a pending snapshot for `cargo insta review`, and says where; `None` if the
/// accepted one says the same. Then nothing is pending any more.
///
/// # Errors
/// A folder that cannot be written to.
pub fn leave(
    corpus: &Path,
    entry: &Entry,
    purpose: &str,
    facts: &Facts,
) -> io::Result<Option<PathBuf>> {
    let accepted = folder(corpus).join(format!("{}.snap", entry.name));
    let pending = accepted.with_extension("snap.new");
    let text = text(facts);
    let same = fs::read_to_string(&accepted).is_ok_and(|old| contents(&old) == text);
    if same {
        return match fs::remove_file(&pending) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => Err(e),
            _ => Ok(None),
        };
    }
    if let Some(parent) = pending.parent() {
        fs::create_dir_all(parent)?;
    }
    // A string of JSON is one of YAML.
    let purpose = serde_json::to_string(purpose)?;
    let head = format!(
        "---\nsource: tests/scenes.rs\ndescription: {purpose}\ninput_file: corpus/{}/scene.toml\n---\n",
        entry.name
    );
    fs::write(&pending, head + &text + "\n")?;
    Ok(Some(pending))
}

/// What follows the two lines of dashes.
fn contents(snapshot: &str) -> &str {
    let mut parts = snapshot.splitn(3, "---\n");
    parts.nth(2).map_or("", str::trim_end)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    fn facts(fragments: u64) -> Facts {
        Facts {
            counts: vec![
                ("size", "8 x 4".into()),
                ("fragments", fragments.to_string()),
            ],
            runs: vec!["build".into()],
            hashes: BTreeMap::from([("vertex", "0123456789abcdef".into())]),
        }
    }

    #[test]
    fn what_is_accepted_is_no_longer_pending() {
        let root = std::env::temp_dir().join(format!("triptych-snapshot-{}", std::process::id()));
        let corpus = root.join("corpus");
        let entry = Entry {
            name: "abuffer/mine".into(),
            family: "abuffer".into(),
            path: corpus.join("abuffer/mine/scene.toml"),
        };
        let leave = |fragments| {
            leave(&corpus, &entry, "it \"says\" so", &facts(fragments)).expect("a folder of ours")
        };
        let pending = leave(7).expect("there is none yet");
        assert!(
            pending.ends_with("tests/snapshots/abuffer/mine.snap.new"),
            "{pending:?}"
        );
        let accepted = pending.with_extension("");
        fs::rename(&pending, &accepted).expect("as a review does it");
        assert_eq!(leave(7), None, "the same once more");
        let changed = leave(8).expect("another number");
        assert!(changed.exists(), "and it is pending");
        assert_eq!(leave(7), None, "back again");
        assert!(!changed.exists(), "nothing is pending");
        fs::remove_dir_all(root).expect("ours");
    }
}
