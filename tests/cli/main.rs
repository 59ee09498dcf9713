//! The command `triptych` as a user meets it: exit codes, one line for a mistake,
//! what it prints and writes.
//!
//! A target of the harness, whose binary it runs; each test works in a folder of its
//! own, with a corpus of its own, so that no report of the user's is touched.

mod bench;
mod contributor;
mod corpus;
mod drivers;
mod frames;
mod grids;
mod kernel;
mod legs;
mod maps;
mod measured;
mod mistakes;
mod mutants;
mod output;
mod outside;
mod queues;
mod results;
mod stress;
mod techniques;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A folder with a corpus, removed when dropped.
struct Place {
    root: PathBuf,
}

/// What came of a run.
struct Ran {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

impl Place {
    /// A place of the test of this name.
    fn new(name: &str) -> Self {
        let name = format!("triptych-cli-{name}-{}", std::process::id());
        let root = std::env::temp_dir().join(name);
        fs::create_dir_all(root.join("corpus")).expect("the temporary folder is writable");
        let lock = repository().join("corpus/meshes.lock");
        fs::copy(lock, root.join("corpus/meshes.lock")).expect("the corpus has a lock");
        Self { root }
    }

    /// Writes a file and the folders that it needs.
    fn write(&self, name: &str, text: &str) -> &Self {
        let path = self.root.join(name);
        let folder = path.parent().expect("a file in a folder");
        fs::create_dir_all(folder).expect("the temporary folder is writable");
        fs::write(path, text).expect("the temporary folder is writable");
        self
    }

    /// The command, about this place's corpus and in its folder.
    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_triptych"));
        command
            .args(arguments)
            .current_dir(&self.root)
            .env("TRIPTYCH_CORPUS", self.root.join("corpus"))
            // A user's mistake gives no backtrace, even to those who want them.
            .env("RUST_BACKTRACE", "1")
            .env("TERM", "xterm-256color")
            .env_remove("NO_COLOR")
            .stdin(Stdio::null());
        command
    }

    fn run(&self, arguments: &[&str]) -> Ran {
        Ran::of(&mut self.command(arguments))
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        // A folder that stays behind hurts nobody.
        let _ = fs::remove_dir_all(&self.root);
    }
}

impl Ran {
    fn of(command: &mut Command) -> Self {
        let output = command.output().expect("the command can be run");
        let text = |bytes| String::from_utf8(bytes).expect("output is UTF-8");
        Self {
            code: output.status.code(),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }

    /// The run, which must have come to this.
    #[track_caller]
    fn expect(self, code: i32) -> Self {
        let Self { stdout, stderr, .. } = &self;
        assert_eq!(
            self.code,
            Some(code),
            "exit code; out:\n{stdout}err:\n{stderr}"
        );
        self
    }
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("")
}

/// Two triangles that cover 4 x 4 of 8 x 8 pixels, one of them twice.
const SCENE: &str = r#"
purpose = "a quad in front of half of another"
size = [8, 8]
[camera]
eye = [0, 0, 5]
target = [0, 0, 0]
height = 8
near = 1
far = 10
[[material]]
name = "glass"
colour = [0.3, 0.6, 0.9]
opacity = 0.5
[[mesh]]
generate.stack = { layers = 2, size = [4, 4], spacing = 1 }
material = "glass"
[budget]
edge = 1
[expect]
fragments = 32
layers_max = 2
"#;

/// The scene with twelve layers, numbered from back to front: the nearest come last.
fn deep() -> String {
    let deep = SCENE
        .replace("layers = 2", "layers = 12")
        .replace("spacing = 1", "spacing = 0.25");
    let deep = deep.replace("fragments = 32", "fragments = 192");
    deep.replace("layers_max = 2", "layers_max = 12")
}

/// A scene of a packaged mesh.
const PACKAGED: &str = r#"
purpose = "a mesh that set-up brings"
size = [16, 16]
[[mesh]]
package = "bunny.obj"
"#;
