//! A folder with a corpus, and the report of its replay.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Text of a scene that tries to get out of wherever it is put.
const HOSTILE: &str = r#"</template><img src=x onerror=\"document.title='caught'\">"#;

/// A folder of the tests' own.
pub struct Place {
    root: PathBuf,
    /// The report of a replay whose kernel has a defect.
    pub page: PathBuf,
}

impl Place {
    /// Replays two scenes with the kernel of `harness/examples/first-k`, which keeps
    /// eight fragments of a pixel: one scene has nine, the other one.
    pub fn new() -> Self {
        let repository = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("");
        let root = std::env::temp_dir().join(format!("triptych-page-{}", std::process::id()));
        let copy = |from: &str, to: &str, edit: &dyn Fn(String) -> String| {
            let text = fs::read_to_string(repository.join(from)).expect("a file of the corpus");
            let to = root.join(to);
            fs::create_dir_all(to.parent().expect("a folder")).expect("a writable folder");
            fs::write(to, edit(text)).expect("a writable folder");
        };
        let same = |text| text;
        copy("corpus/meshes.lock", "corpus/meshes.lock", &same);
        let reversed = "corpus/abuffer/reversed/scene.toml";
        copy(reversed, reversed, &same);
        let quiet = |text: String| {
            let purpose = text.lines().next().unwrap_or_default().to_owned();
            text.replace(&purpose, &format!("purpose = \"{HOSTILE}\""))
        };
        let out_of_view = "corpus/abuffer/out-of-view/scene.toml";
        copy(out_of_view, out_of_view, &quiet);
        let kernel = repository.join("harness/examples/first-k/build.wgsl");
        let output = Command::new(env!("CARGO_BIN_EXE_triptych"))
            .args(["replay", "--kernel"])
            .arg(format!("build={}", kernel.display()))
            .current_dir(&root)
            .env("TRIPTYCH_CORPUS", root.join("corpus"))
            .output()
            .expect("the command can be run");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "the defect is found: {said}");
        let page = root.join("reports/out/index.html");
        Self { root, page }
    }

    /// Removes the folder; one that stays behind hurts nobody.
    pub fn remove(&self) {
        let _ = fs::remove_dir_all(&self.root);
    }
}
