//! Files just beyond a limit: refused by its name. What is much larger must not be
//! read to its end first.

use std::fs::File;
use std::io::Write as _;

use flate2::Compression;
use flate2::write::GzEncoder;

use super::{Folder, attempt};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const SCENE: &str = "purpose = 'x'\nsize = [4, 4]\n";

/// Loads a file and compares the error, less the path of the file.
#[track_caller]
fn refused(folder: &Folder, name: &str, bytes: &[u8], expected: &str) {
    let path = folder.write(name, bytes);
    let message = attempt(&path).map(|_| ()).expect_err("beyond a limit");
    let folder = format!("{}/", folder.0.display());
    let message = message.replace(&folder, "");
    assert_eq!(message, format!("{name}{expected}"), "names the limit");
}

fn repeated(start: &str, unit: &str, times: usize, end: &str) -> Vec<u8> {
    [start, &unit.repeat(times), end].concat().into_bytes()
}

#[test]
fn triangles_of_an_obj() {
    let folder = Folder::new("triangles");
    let face = repeated(TRIANGLE, " 3", 4_194_306, "\n");
    let face = [&face[..TRIANGLE.len()], b"f", &face[TRIANGLE.len()..]].concat();
    let limit = ":5: after 1 triangles, this face exceeds the limit of 4194304";
    refused(&folder, "face.obj", &face, limit);
    // Nothing after the limit is looked at, so the nonsense is not either.
    let nonsense = [&face[..face.len() - 1], b" nonsense\n"].concat();
    refused(&folder, "nonsense.obj", &nonsense, limit);
}

#[test]
fn materials_of_an_obj() {
    let folder = Folder::new("materials");
    let used: String = (0..=65_536).map(|i| format!("usemtl {i}\n")).collect();
    let text = [TRIANGLE, &used].concat();
    let limit = ":65541: 65537 materials exceed the limit of 65536";
    refused(&folder, "used.obj", text.as_bytes(), limit);
    let long = repeated("usemtl ", "x", 1025, "\n");
    let limit =
        ":1: `xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx...` has 1025 bytes; names have at most 1024";
    refused(&folder, "name.obj", &long, limit);
}

#[test]
fn libraries_of_an_obj() {
    let folder = Folder::new("libraries");
    let text: String = (0..65).map(|i| format!("mtllib {i}.mtl\n")).collect();
    let limit = ":65: more than 64 material libraries, the limit";
    refused(&folder, "many.obj", text.as_bytes(), limit);
    let text = format!("mtllib a.mtl\n{TRIANGLE}");
    let obj = folder.write("a.obj", text.as_bytes());
    let mut library = repeated("", "newmtl a\n", 65_536, "");
    folder.write("a.mtl", &library);
    attempt(&obj).expect("as many as there may be");
    library.extend(b"newmtl a\n");
    let library = folder.write("a.mtl", &library);
    let message = attempt(&obj).map(|_| ()).expect_err("one too many");
    let limit = "65537: the materials exceed the limit of 65536";
    assert_eq!(message, format!("{}:{limit}", library.display()));
}

/// Some exporters name the library before every object. Read each time, these would
/// take hours.
#[test]
fn a_library_is_read_once() {
    let folder = Folder::new("once");
    folder.write("a.mtl", &repeated("newmtl a\n", "Kd 1 1 1\n", 100_000, ""));
    let text = repeated("", "mtllib a.mtl\n", 100_000, TRIANGLE);
    let path = folder.write("a.obj", &text);
    let stats = attempt(&path).expect("a sound library").stats;
    assert_eq!(stats.meshes[0].notes.warnings, [""; 0], "nothing is amiss");
}

#[test]
fn lists_of_a_ply() {
    let folder = Folder::new("lists");
    let header = |format: &str, other: &str, list: &str| {
        format!(
            "ply\nformat {format} 1.0\n{other}element vertex 1\nproperty uchar x\nproperty uchar y\nproperty uchar z\nelement face 1\nproperty list {list} vertex_indices\nend_header\n"
        )
    };
    let text = header("ascii", "", "uint uint") + "0 0 0\n4194307";
    let limit = ":11: its lists have 4194307 entries or more, and 4194306 are the limit";
    refused(
        &folder,
        "ascii.ply",
        &repeated(&text, " 0", 4_194_307, "\n"),
        limit,
    );
    let other = "element x 1\nproperty list uint uchar y\n";
    let mut bytes = header("binary_big_endian", other, "uchar uchar").into_bytes();
    bytes.extend(4_194_307_u32.to_be_bytes());
    bytes.resize(bytes.len() + 4_194_307, 0);
    bytes.extend(b"\0\0\0\x03\0\0\0");
    let limit = ": x 0 of 1: its lists have 4194307 entries or more, and 4194306 are the limit";
    refused(&folder, "binary.ply", &bytes, limit);
}

#[test]
fn members_of_a_gz() {
    let folder = Folder::new("members");
    let packed = |text: &str| {
        let mut packer = GzEncoder::new(Vec::new(), Compression::fast());
        packer.write_all(text.as_bytes()).expect("memory");
        packer.finish().expect("memory")
    };
    let (start, end) = TRIANGLE.split_at(9);
    let path = folder.write("two.obj.gz", &[packed(start), packed(end)].concat());
    let loaded = attempt(&path).expect("members are joined");
    assert_eq!(loaded.stats.triangles, 1, "of both members");
    let empty = packed("").repeat(65_536);
    let text = [packed(TRIANGLE), empty].concat();
    let limit = ": has more than 65536 gzip members, the limit";
    refused(&folder, "many.obj.gz", &text, limit);
}

/// Files are as long as they say, but for what fills them up.
#[test]
fn bytes_of_a_file_and_of_a_scene() {
    let folder = Folder::new("bytes");
    let long = |name: &str, length: u64| {
        let text = [TRIANGLE, "#"].concat();
        let file = File::options()
            .write(true)
            .open(folder.write(name, text.as_bytes()));
        let lengthened = file.and_then(|f| f.set_len(length));
        lengthened.expect("the temporary folder takes files with holes");
    };
    long("huge.obj", (1 << 29) + 1);
    let message = attempt(&folder.0.join("huge.obj")).map(|_| ());
    let message = message.expect_err("one byte too many");
    let limit = "huge.obj: has more than 536870912 bytes, the limit";
    assert!(message.ends_with(limit), "{message}");
    long("a.obj", 1 << 28);
    long("b.obj", (1 << 28) - 99);
    let mesh = |name: &str| format!("[[mesh]]\nfile = '{name}.obj'\n");
    let text = [SCENE, &mesh("a"), &mesh("b")].concat();
    let path = folder.write("scene.toml", text.as_bytes());
    attempt(&path).expect("just under the limit");
    long("b.obj", 1 << 28);
    let message = attempt(&path).map(|_| ()).expect_err("just beyond it");
    let left = (1 << 28) - text.len();
    let limit = format!(
        "b.obj: has more than {left} bytes, which is what the files before it leave of 536870912"
    );
    assert!(message.ends_with(&limit), "{message}");
}

#[test]
fn sums_of_a_scene() {
    let folder = Folder::new("sums");
    let unseen =
        "[[mesh]]\ngenerate.grid = { cells = [1024, 1024], cell = [1, 1] }\ninstances = []\n";
    let text = repeated(SCENE, unseen, 3, "");
    let limit = ":9: 6291456 triangles and 3151875 vertices up to here exceed the limits of 4194304 and 12582912";
    refused(&folder, "unseen.toml", &text, limit);
    let used: String = (0..40_000).map(|i| format!("usemtl {i}\n")).collect();
    folder.write("a.obj", [&used, TRIANGLE].concat().as_bytes());
    let text = repeated(SCENE, "[[mesh]]\nfile = 'a.obj'\n", 2, "");
    let limit = ":5: 80000 materials of meshes up to here exceed the limit of 65536";
    refused(&folder, "materials.toml", &text, limit);
}

#[test]
fn lists_of_a_scene() {
    let folder = Folder::new("arrays");
    let start = [SCENE, "mesh = []\n"].concat();
    let light = "[[light]]\nambient = { intensity = [1, 1, 1] }\n";
    let path = folder.write("lights.toml", &repeated(&start, light, 64, ""));
    attempt(&path).expect("as many as there may be");
    let text = repeated(&start, light, 65, "");
    refused(
        &folder,
        "lights.toml",
        &text,
        ":4: more than 64 items, the limit",
    );
    let cover = "{ x = [0, 4], y = [0, 4], times = 0 }, ";
    let list = "{ at = [0, 0], prims = [] }, ";
    for (key, item) in [("cover", cover), ("lists", list)] {
        let start = format!("{start}[expect]\n{key} = [");
        let text = repeated(&start, item, 1025, "]\n");
        refused(
            &folder,
            "expect.toml",
            &text,
            ":5: more than 1024 items, the limit",
        );
    }
    let text = repeated(&start, "#", 1 << 20, "\n");
    refused(
        &folder,
        "long.toml",
        &text,
        ": has more than 1048576 bytes, the limit",
    );
}
