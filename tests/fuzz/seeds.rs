//! Writes inputs to begin with: the files that the tests of the loaders know, and the
//! corpus. `./x fuzz` runs it.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

#[path = "../hostile/cases.rs"]
#[expect(dead_code, reason = "only names and bytes matter here")]
mod cases;

use triptych_harness::corpus;

fn main() -> io::Result<()> {
    let Some(out) = env::args_os().nth(1).map(PathBuf::from) else {
        return Err(io::Error::other("say where the seeds go"));
    };
    let tables = [
        ("obj", cases::obj::CASES),
        ("ply", cases::ply::CASES),
        ("scene", cases::toml::CASES),
    ];
    for (target, cases) in tables {
        for (name, bytes, _) in cases {
            write(&out.join(target), name.as_ref(), bytes)?;
        }
    }
    for entry in corpus::list(&corpus::root()).map_err(io::Error::other)? {
        let name = entry.name.replace('/', "-");
        write(&out.join("scene"), name.as_ref(), &fs::read(entry.path)?)?;
    }
    for folder in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("seeds"))? {
        let folder = folder?;
        let target = folder.file_name();
        for file in fs::read_dir(folder.path())? {
            let path = file?.path();
            let bytes = fs::read(&path)?;
            loads(&target, &bytes).map_err(|e| {
                io::Error::other(format!("{}: a seed must load: {e}", path.display()))
            })?;
            write(
                &out.join(&target),
                path.file_name().unwrap_or_default(),
                &bytes,
            )?;
        }
    }
    Ok(())
}

fn write(folder: &Path, name: &OsStr, bytes: &[u8]) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    fs::write(folder.join(name), bytes)
}

/// What is ours leads a fuzzer past the front door, or it finds nothing behind it.
fn loads(target: &OsStr, bytes: &[u8]) -> Result<(), String> {
    let text = |e: &dyn std::fmt::Display| e.to_string();
    match target.to_str() {
        Some("obj") => triptych_fuzz::obj(bytes).map(drop).map_err(|e| text(&e)),
        Some("hair") => triptych_fuzz::hair(bytes).map(drop).map_err(|e| text(&e)),
        Some("scene") => triptych_fuzz::scene(bytes).map(drop).map_err(|e| text(&e)),
        Some("json") => triptych_fuzz::json(bytes).map(drop).map_err(|e| text(&e)),
        _ => Err("no target is called as its folder".to_owned()),
    }
}
