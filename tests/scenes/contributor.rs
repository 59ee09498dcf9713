//! The way of a new scene: added, replayed, reviewed, held; on one machine or in
//! shards. Runs this very program on a corpus of its own.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use libtest_mimic::Failed;
use triptych_harness::add::{New, add};
use triptych_harness::json;
use triptych_harness::row::Row;

/// A scene that holds four fragments, and says that there are five.
const WRONG: &str = "purpose = 'what it expects is wrong'\nsize = [2, 2]\n\
    [camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nheight = 2\nnear = 1\nfar = 10\n\
    [[mesh]]\ngenerate.stack = { layers = 1, size = [4, 4], spacing = 1 }\n\
    [budget]\nedge = 1\n[expect]\nfragments = 5\n";

/// A folder with a corpus, removed when dropped.
struct Place(PathBuf);

impl Drop for Place {
    fn drop(&mut self) {
        // A folder that stays behind hurts nobody.
        let _ = fs::remove_dir_all(&self.0);
    }
}

impl Place {
    fn corpus(&self) -> PathBuf {
        self.0.join("corpus")
    }

    fn write(&self, name: &str, text: &str) -> Result<PathBuf, Failed> {
        let path = self.0.join(name);
        fs::create_dir_all(path.parent().unwrap_or(&self.0))?;
        fs::write(&path, text)?;
        Ok(path)
    }

    /// Tests the scenes, so many, whose names hold the filter, as `cargo test` and nextest
    /// do, with their rows in a folder; says whether they passed.
    fn test(&self, filter: &str, scenes: usize, rows: &str) -> Result<bool, Failed> {
        let mut command = Command::new(std::env::current_exe()?);
        command
            .arg(filter)
            .env("TRIPTYCH_CORPUS", self.corpus())
            .env("TRIPTYCH_ROWS", self.0.join(rows))
            // insta writes nothing where CI is set, and looks for the workspace by itself.
            .env("INSTA_UPDATE", "new")
            .env_remove("NEXTEST");
        let output = command.output()?;
        let text = String::from_utf8_lossy(&output.stdout);
        let ran = format!("running {scenes} test");
        match text.contains(&ran) {
            true => Ok(output.status.success()),
            false => {
                let errors = String::from_utf8_lossy(&output.stderr);
                Err(format!("`{ran}` is not in\n{text}{errors}").into())
            }
        }
    }

    /// What a folder's rows come to: those that diverge, and all, without times.
    fn merged(&self, rows: &str) -> Result<(u64, Vec<Row>), Failed> {
        let files = fs::read_dir(self.0.join(rows))?;
        let files: Result<Vec<PathBuf>, _> = files.map(|f| Ok(f?.path())).collect();
        let mut files = files.map_err(|e: std::io::Error| e)?;
        files.sort();
        let merged = json::read(&files)?;
        let rows = merged.rows.into_iter().map(|row| Row {
            ms_a: None,
            ms_b: None,
            ..row
        });
        Ok((merged.summary.diverging, rows.collect()))
    }
}

/// A snapshot without the line of the test that wrote it.
fn read(snapshot: &Path) -> Result<String, Failed> {
    let text = fs::read_to_string(snapshot)?;
    let lines = text.lines().filter(|l| !l.starts_with("assertion_line:"));
    Ok(lines.collect::<Vec<_>>().join("\n"))
}

/// A scene that was added fails until its snapshot is accepted, and then passes; two
/// shards come to the same verdict as one run.
pub fn added_reviewed_and_in_shards() -> Result<(), Failed> {
    let name = format!("triptych-contributor-{}", std::process::id());
    let place = Place(std::env::temp_dir().join(name));
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("corpus");
    let lock = fs::read_to_string(own.join("meshes.lock"))?;
    place.write("corpus/meshes.lock", &lock)?;
    place.write("corpus/README.md", "| `abuffer/` | purpose |\n|---|---|\n")?;
    place.write("corpus/abuffer/wrong/scene.toml", WRONG)?;
    let broken = WRONG.replace("generate.stack", "generate.stick");
    place.write("corpus/raster/broken/scene.toml", &broken)?;
    let mesh = place.write("mine.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")?;
    let new = New {
        family: "abuffer".into(),
        case: "mine".into(),
        purpose: Some("one triangle".into()),
    };
    let added = add(&place.corpus(), &mesh, &new)?;
    if place.test("abuffer/", 2, "one")? {
        return Err("passed without snapshots".into());
    }
    let pending = place.0.join("tests/snapshots/abuffer/mine.snap.new");
    let text = read(&pending)?;
    fs::rename(&pending, pending.with_extension(""))?;
    if !place.test("abuffer/mine", 1, "shards")? {
        return Err(format!("{} fails after its review:\n{text}", added.entry.name).into());
    }
    if place.test("abuffer/wrong", 1, "shards")? {
        return Err("five fragments were found where there are four".into());
    }
    // What cannot be replayed has no rows that could agree.
    if place.test("raster/broken", 1, "broken")? || place.merged("broken").is_ok() {
        return Err("a scene that does not load came to a verdict".into());
    }
    let (one, shards) = (place.merged("one")?, place.merged("shards")?);
    if one.0 == 0 {
        return Err(format!("none of {} rows diverges", one.1.len()).into());
    }
    match one == shards {
        true => Ok(()),
        false => Err(format!("one run: {one:?}\nshards: {shards:?}").into()),
    }
}
