//! Files that made loaders take many times their size, loaded by a process that may
//! not take so much.

use std::io::Write as _;
use std::process::Command;

use flate2::Compression;
use flate2::write::GzEncoder;

use super::{Folder, attempt};

/// Marks the process that loads.
const CHILD: &str = "TRIPTYCH_TESTS_MEMORY";

/// Bytes that each file unpacks to.
const BYTES: usize = 100 << 20;

/// Address space of the process that loads, in KiB: the program and its libraries, the
/// file, and once more the file.
const KIBIBYTES: &str = "900000";

const VERTICES: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const HEADER: &str = "element vertex 1\nproperty uchar x\nproperty uchar y\nproperty uchar z\nelement face 1\nproperty list uint uchar vertex_indices\nend_header\n";

/// `name` holds `start`, as many `unit`s as fit, and `end`.
fn write(folder: &Folder, name: &str, start: &[u8], unit: &str, end: &str) {
    let mut packer = GzEncoder::new(Vec::new(), Compression::fast());
    let body = unit.repeat(BYTES / unit.len());
    for part in [start, body.as_bytes(), end.as_bytes()] {
        packer.write_all(part).expect("memory");
    }
    folder.write(name, &packer.finish().expect("memory"));
}

/// What is to come of each: loads, or fails.
const FILES: [(&str, bool); 8] = [
    ("huge.obj", false),
    ("corners.obj.gz", false),
    ("corners-ahead.obj.gz", false),
    ("points.obj.gz", true),
    ("names.obj.gz", false),
    ("name.obj.gz", false),
    ("ascii.ply.gz", false),
    ("binary.ply.gz", false),
];

fn load(folder: &Folder) {
    for (name, loads) in FILES {
        let result = attempt(&folder.0.join(name)).map(|_| ());
        assert_eq!(result.is_ok(), loads, "{name}: {result:?}");
    }
}

#[test]
fn memory_is_bounded() {
    let parent = std::env::var_os(CHILD);
    if let Some(path) = parent {
        return load(&Folder(path.into()));
    }
    let folder = Folder::new("memory");
    let ply = |format: &str| format!("ply\nformat {format} 1.0\n{HEADER}");
    let mut list = ply("binary_little_endian").into_bytes();
    list.extend(b"\0\0\0");
    list.extend(u32::try_from(BYTES).expect("a small file").to_le_bytes());
    let text = ply("ascii") + "0 0 0\n50000000";
    let face = format!("{VERTICES}f");
    let name = format!("{VERTICES}usemtl ");
    write(&folder, "corners.obj.gz", face.as_bytes(), " 1 2 3", "\n");
    write(
        &folder,
        "corners-ahead.obj.gz",
        b"f",
        " 1 2 3",
        &format!("\n{VERTICES}"),
    );
    write(
        &folder,
        "points.obj.gz",
        b"",
        "f 3\n",
        &format!("{VERTICES}f 1 2 3\n"),
    );
    write(&folder, "name.obj.gz", name.as_bytes(), "x", "\nf 1 2 3\n");
    write(&folder, "ascii.ply.gz", text.as_bytes(), " 0", "\n");
    write(&folder, "binary.ply.gz", &list, "\0", "");
    let names: String = (0..BYTES / 16).map(|i| format!("usemtl {i:8}\n")).collect();
    write(&folder, "names.obj.gz", names.as_bytes(), "\n", "");
    let huge = std::fs::File::create(folder.0.join("huge.obj"));
    let huge = huge.and_then(|file| file.set_len(1 << 40));
    huge.expect("the temporary folder takes files with holes");
    let test = concat!(module_path!(), "::memory_is_bounded");
    let (_, test) = test.split_once("::").expect("a module of the test's crate");
    let status = Command::new("sh")
        .args(["-c", "ulimit -v \"$0\" && exec \"$@\"", KIBIBYTES])
        .arg(std::env::current_exe().expect("this program has a path"))
        .args(["--exact", test, "--test-threads", "1"])
        .env(CHILD, &folder.0)
        .status();
    let status = status.expect("every Unix has a shell");
    assert!(status.success(), "the process that loads: {status}");
}
