//! Files that are not there, not files, or too large.

use std::io::Write as _;
use std::process::Command;

use super::{Folder, attempt};

fn fails(folder: &Folder, name: &str, expected: &str) {
    let path = folder.0.join(name);
    let message = attempt(&path).map(|_| ()).expect_err("it must not load");
    assert_eq!(
        message,
        format!("{}: {expected}", path.display()),
        "for {name}"
    );
}

#[test]
fn missing_files_folders_and_pipes_are_named() {
    let folder = Folder::new("files");
    fails(&folder, "nowhere.obj", "does not exist");
    fails(&folder, "nowhere.toml", "does not exist");
    std::fs::create_dir(folder.0.join("folder.ply")).expect("a new folder");
    fails(&folder, "folder.ply", "is not a regular file");
    let pipe = Command::new("mkfifo")
        .arg(folder.0.join("pipe.obj"))
        .status();
    assert!(
        pipe.is_ok_and(|s| s.success()),
        "mkfifo is part of every Unix"
    );
    fails(&folder, "pipe.obj", "is not a regular file");
    std::os::unix::fs::symlink("/dev/zero", folder.0.join("zero.obj")).expect("a new link");
    fails(&folder, "zero.obj", "is not a regular file");
    std::os::unix::fs::symlink("loop.obj", folder.0.join("loop.obj")).expect("a new link");
    let path = folder.0.join("loop.obj");
    let message = attempt(&path).map(|_| ()).expect_err("a link to itself");
    assert!(message.contains("cannot be read"), "{message}");
}

/// Reading one of the kernel's may wait for an event; they have no length.
#[test]
fn files_without_length_are_not_read() {
    let folder = Folder::new("kernel");
    let link = folder.0.join("status.obj");
    std::os::unix::fs::symlink("/proc/self/status", link).expect("a new link");
    let nothing = "no triangles, only 0 lines and 0 points";
    fails(&folder, "status.obj", nothing);
}

#[test]
fn errors_are_one_short_line() {
    let folder = Folder::new("line");
    let start = "purpose = 'x'\nsize = [4, 4]\n";
    let long = "k".repeat(1 << 19);
    let texts = [
        format!("{start}[[mesh]]\nfile = \"a\\n\\u001b[31mb.obj\"\n"),
        format!("{start}[[mesh]]\nfile = '{long}.obj'\n"),
        format!("{start}{long} = 1\n"),
        format!("{start}\"\\u001b[31m\" = 1\n"),
    ];
    for text in texts {
        let path = folder.write("scene.toml", text.as_bytes());
        let message = attempt(&path).map(|_| ()).expect_err("a bad scene");
        let plain = !message.contains(char::is_control);
        assert!(plain && message.len() < 6000, "{message:?}");
    }
}

#[test]
fn a_mesh_that_a_scene_names_is_found_beside_it() {
    let folder = Folder::new("beside");
    let scene = "purpose = 'x'\nsize = [4, 4]\n[[mesh]]\nfile = 'a b.obj'\n";
    let path = folder.write("scene.toml", scene.as_bytes());
    let message = attempt(&path).map(|_| ()).expect_err("there is no mesh");
    let mesh = folder.0.join("a b.obj");
    assert_eq!(
        message,
        format!("{}: does not exist", mesh.display()),
        "names the mesh"
    );
    folder.write("a b.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let loaded = attempt(&path).expect("now it is there");
    assert_eq!(
        loaded.stats.meshes[0].source, "file a b.obj",
        "names its source"
    );
}

#[test]
fn libraries_give_materials_or_one_line() {
    let folder = Folder::new("library");
    let obj = "mtllib my lib.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red wine\nf 1 2 3\nusemtl b\nf 1 2 3\n";
    let path = folder.write("a.obj", obj.as_bytes());
    let library = "newmtl red wine # comment\nKd 1 0 \\\n0\nKs nonsense\nillum many\nd 0.25\nTr 0.5\nnewmtl b\nTr 0.25\nKd .5\n";
    folder.write("my lib.mtl", library.as_bytes());
    let scene = attempt(&path).expect("a sound library").scene;
    let opacities: Vec<f32> = scene.triangles.iter().map(|t| t.colour[3]).collect();
    assert_eq!(
        opacities,
        [0.25, 0.75],
        "d wins over Tr, and Tr is its complement"
    );
    let [r, g, _, _] = scene.triangles[0].colour;
    assert!(r > 0.0 && g == 0.0, "Kd is red");
    let bad = [
        ("Kd 1 1 1\n", ":1: `Kd` comes before any newmtl"),
        (
            "newmtl a\nKd 1 1\n",
            ":2: Kd has one or three numbers, and this has 2",
        ),
        ("newmtl a\nKd 1 nan 1\n", ":2: `nan` is not finite"),
        ("newmtl a\n\nd 1.5\n", ":3: `1.5` is outside 0 to 1"),
        ("newmtl a\nd\n", ":2: an opacity is one number from 0 to 1"),
        (
            "newmtl a\nmap_Kd a\0b\n",
            ":2: byte 0x00 is not text; a material library is expected",
        ),
    ];
    for (text, expected) in bad {
        let library = folder.write("my lib.mtl", text.as_bytes());
        let message = attempt(&path).map(|_| ()).expect_err("a bad library");
        assert_eq!(
            message,
            format!("{}{expected}", library.display()),
            "for {text:?}"
        );
    }
}

#[test]
fn libraries_outside_the_mesh_folder_are_not_read() {
    let folder = Folder::new("outside");
    let library = folder.write("outside.mtl", b"newmtl a\nKd nonsense\n");
    let inner = Folder::new("outside/inner");
    let absolute = library.display().to_string();
    for name in ["../outside.mtl", "..\\outside.mtl", absolute.as_str()] {
        let obj = format!("mtllib {name}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        let path = inner.write("a.obj", obj.as_bytes());
        let stats = attempt(&path).expect("the library is not looked at").stats;
        let warnings = &stats.meshes[0].notes.warnings;
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(
            warnings[0].ends_with("lies outside the mesh's folder"),
            "{warnings:?}"
        );
    }
}

#[test]
fn a_polygon_of_a_million_corners_loads() {
    let folder = Folder::new("polygon");
    let mut text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf".to_vec();
    for corner in 0..1_000_000 {
        write!(text, " {}", corner % 3 + 1).expect("a vector takes everything");
    }
    let path = folder.write("polygon.obj", &text);
    let loaded = attempt(&path).expect("a fan");
    assert_eq!(loaded.stats.triangles, 999_998, "a fan of all corners");
}

#[test]
fn gzip_cannot_unpack_without_end() {
    let folder = Folder::new("bomb");
    let file = std::fs::File::create(folder.0.join("bomb.ply.gz")).expect("a new file");
    let mut packer = flate2::write::GzEncoder::new(file, flate2::Compression::fast());
    let zeros = vec![0; 1 << 20];
    for _ in 0..513 {
        packer
            .write_all(&zeros)
            .expect("the temporary folder is writable");
    }
    packer.finish().expect("the temporary folder is writable");
    let limit = "unpacks to more than 536870912 bytes, the limit";
    fails(&folder, "bomb.ply.gz", limit);
}
