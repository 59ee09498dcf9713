use std::fs;
use std::path::PathBuf;

use super::super::{Entry, select};

/// A folder with files, removed when dropped.
struct Place(PathBuf);

impl Place {
    fn new(name: &str, files: &[&str]) -> Self {
        let folder = format!("triptych-name-{name}-{}", std::process::id());
        let place = Self(std::env::temp_dir().join(folder));
        for file in files {
            let path = place.0.join(file);
            let folder = path.parent().expect("a file in a folder");
            fs::create_dir_all(folder).expect("the temporary folder is writable");
            fs::write(path, "").expect("the temporary folder is writable");
        }
        place
    }

    fn corpus(&self) -> Vec<Entry> {
        super::super::list(&self.0.join("corpus")).expect("a corpus")
    }

    /// The names of the scenes that these paths select.
    fn names(&self, paths: &[&str]) -> Vec<String> {
        let path = |p: &&str| self.0.join(p).to_string_lossy().into_owned();
        let patterns: Vec<String> = paths.iter().map(path).collect();
        let selected = select(&self.corpus(), &patterns, false).expect("they are there");
        selected.into_iter().map(|e| e.name).collect()
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        // A folder that stays behind hurts nobody.
        let _ = fs::remove_dir_all(&self.0);
    }
}

const FILES: [&str; 9] = [
    "corpus/raster/fan/scene.toml",
    "corpus/raster/fan.obj/scene.toml",
    "raster/fan.obj",
    "a/fan.obj",
    "a/fan.ply",
    "b/fan.obj",
    "a/fan/scene.toml",
    "b/fan/scene.toml",
    "a/cup.obj",
];

#[test]
fn a_stem_is_enough_where_it_is_the_only_one() {
    let place = Place::new("stem", &FILES);
    assert_eq!(place.names(&["a/fan.obj"]), ["fan"]);
    assert_eq!(place.names(&["a/fan/scene.toml"]), ["fan"]);
    assert_eq!(place.names(&["a/fan"]), ["fan"], "the folder of a scene");
    let two = place.names(&["a/fan.obj", "a/cup.obj"]);
    assert_eq!(two, ["fan", "cup"]);
}

#[test]
fn equal_stems_get_the_shortest_tail_that_differs() {
    let place = Place::new("tail", &FILES);
    let meshes = ["a/fan.obj", "b/fan.obj"];
    assert_eq!(place.names(&meshes), meshes);
    let swapped = ["b/fan.obj", "a/fan.obj"];
    assert_eq!(place.names(&swapped), swapped, "whatever the order");
    let kinds = place.names(&["a/fan.obj", "a/fan.ply", "a/cup.obj"]);
    assert_eq!(kinds, ["fan.obj", "fan.ply", "cup"], "no more than needed");
    let scenes = ["a/fan/scene.toml", "b/fan/scene.toml"];
    assert_eq!(place.names(&scenes), scenes);
    let mixed = place.names(&["a/fan/scene.toml", "b/fan.obj"]);
    assert_eq!(mixed, ["fan/scene.toml", "fan.obj"]);
}

#[test]
fn no_scene_outside_has_the_name_of_one_inside() {
    let place = Place::new("inside", &FILES);
    // The tail `raster/fan.obj` is a scene of the corpus, so it needs one part more.
    let names = place.names(&["raster/fan.obj", "a/fan.obj"]);
    let folder = place.0.file_name().expect("a name").to_string_lossy();
    let longer = format!("{folder}/raster/fan.obj");
    assert_eq!(names, [longer.as_str(), "a/fan.obj"]);
    // The corpus by its path is the corpus.
    let inside = place.names(&["corpus/raster/fan/scene.toml", "a/fan.obj"]);
    assert_eq!(inside, ["raster/fan", "fan"]);
}

#[test]
fn a_file_given_twice_is_one_scene() {
    let place = Place::new("twice", &FILES);
    let ways = ["a/fan.obj", "b/../a/fan.obj", "a/./fan.obj"];
    assert_eq!(place.names(&ways), ["fan"]);
    let folder = ["a/fan", "a/fan/scene.toml"];
    assert_eq!(place.names(&folder), ["fan"]);
}

/// A linked folder is the folder; a linked file has other neighbours, which may hold
/// other meshes and materials.
#[cfg(unix)]
#[test]
fn links() {
    let place = Place::new("links", &FILES);
    let link = |to: &str, at: &str| {
        std::os::unix::fs::symlink(place.0.join(to), place.0.join(at)).expect("a link");
    };
    link("a", "c");
    assert_eq!(place.names(&["a/fan.obj", "c/fan.obj"]), ["fan"]);
    link("a/cup.obj", "b/cup.obj");
    let names = place.names(&["a/cup.obj", "b/cup.obj"]);
    assert_eq!(names, ["a/cup.obj", "b/cup.obj"]);
}

/// Text cannot tell these paths apart, so the run is refused rather than mixed up.
#[cfg(target_os = "linux")]
#[test]
fn names_that_no_text_tells_apart() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    use super::tell_apart;

    let place = Place::new("bytes", &FILES);
    let path = |byte: u8| place.0.join(OsStr::from_bytes(&[byte])).join("fan.obj");
    let mut entries = [Entry::outside(&path(0xfe)), Entry::outside(&path(0xff))];
    let error = tell_apart(&[], &mut entries).expect_err("both are the same text");
    assert!(error.to_string().contains("one at a time"), "{error}");
    tell_apart(&[], &mut entries[..1]).expect("one alone is no trouble");
}
