//! What the loaders make of files that nobody vouches for: each loads with so
//! many triangles, or gives one error line. Never a panic, never a hang.

use std::path::{Path, PathBuf};
use std::sync::mpsc;
use std::time::Duration;

use triptych_harness::scene::{Loaded, load};

#[path = "hostile/cases.rs"]
mod cases;
#[path = "hostile/files.rs"]
mod files;
#[path = "hostile/limits.rs"]
mod limits;
#[path = "hostile/memory.rs"]
mod memory;
#[path = "hostile/mutate.rs"]
mod mutate;
#[path = "hostile/sound.rs"]
mod sound;

use cases::Outcome::{Fails, Loads};
use cases::{Case, obj, ply, toml};
use sound::assert_sound;

/// Longer than any small file may take, on the slowest machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// A folder of its own for a test, removed when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let parent = format!("triptych-{}", std::process::id());
        let path = std::env::temp_dir().join(parent).join(name);
        std::fs::create_dir_all(&path).expect("the temporary folder is writable");
        Self(path)
    }

    fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, bytes).expect("the temporary folder is writable");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A folder that stays behind hurts nobody.
        let _ = std::fs::remove_dir_all(&self.0);
        let _ = self.0.parent().map(std::fs::remove_dir);
    }
}

/// Loads a file in a thread of its own. An error is a message; so is a panic, or
/// running out of patience.
fn attempt(path: &Path) -> Result<Loaded, String> {
    let (sender, receiver) = mpsc::channel();
    let file = path.to_owned();
    let thread = std::thread::spawn(move || {
        // Nobody listens any more once patience has run out.
        let _ = sender.send(load(&file).map_err(|e| e.to_string()));
    });
    match receiver.recv_timeout(PATIENCE) {
        Ok(result) => result,
        Err(mpsc::RecvTimeoutError::Timeout) => Err(format!("no end after {PATIENCE:?}")),
        Err(mpsc::RecvTimeoutError::Disconnected) => {
            let _ = thread.join();
            Err("a panic".to_owned())
        }
    }
}

/// What contradicts the table, one line each.
fn run(name: &str, cases: &[Case]) -> Vec<String> {
    let folder = Folder::new(name);
    let mut wrong = Vec::new();
    for (file, bytes, outcome) in cases {
        let path = folder.write(file, bytes);
        let got = attempt(&path).map(|loaded| loaded.scene.triangles.len());
        let shown = path.display();
        match (got, outcome) {
            (Ok(got), Loads(expected)) if got == *expected => {}
            (Err(got), Fails(expected)) if got == format!("{shown}{expected}") => {}
            (Ok(got), _) => wrong.push(format!("{file}: loads with {got} triangles")),
            (Err(got), _) => {
                let got = got.replace(&shown.to_string(), "");
                wrong.push(format!("{file}: fails with {got:?}"));
            }
        }
        std::fs::remove_file(path).expect("the file is there");
    }
    wrong
}

fn assert_none(wrong: &[String]) {
    assert!(
        wrong.is_empty(),
        "{} are wrong:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

#[test]
fn there_are_a_hundred_cases() {
    let cases = obj::CASES.len() + ply::CASES.len() + toml::CASES.len();
    assert!(cases >= 100, "only {cases} cases");
}

#[test]
fn hostile_obj() {
    assert_none(&run("obj", obj::CASES));
}

#[test]
fn hostile_ply() {
    assert_none(&run("ply", ply::CASES));
}

#[test]
fn hostile_scenes() {
    assert_none(&run("scene", toml::CASES));
}
