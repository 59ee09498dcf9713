//! What all frames may take together.

use std::path::Path;

use super::*;
use crate::corpus::Entry;
use crate::dispatch::share;
use crate::mesh::Intake;
use crate::replay::rsm::{RsmRun, Setup};
use crate::scene::{Loaded, load_text};

/// A wall and a floor before it, with more keys and meshes.
fn scene(size: [u32; 2], keys: &str, meshes: &str) -> Loaded {
    let text = format!(
        "
purpose = 'a wall and a floor'
size = {size:?}
camera = {{ eye = [0, 0, 4], target = [0, 0, 0], height = 4, near = 1, far = 9 }}
[rsm]
map = [64, 64]
stride = 1
{keys}
lamp = {{ eye = [0, 0, 4], target = [0, 0, 0], height = 4, near = 1, far = 9 }}
[[mesh]]
generate.faces = {{ vertices = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], faces = [[0, 1, 2, 3]] }}
[[mesh]]
generate.faces = {{ vertices = [[-2, -2, 0], [2, -2, 0], [2, -2, 2], [-2, -2, 2]], faces = [[0, 1, 2, 3]] }}
rotate = [15, 0, 0]
translate = [0, 0.6, 0.6]
{meshes}
"
    );
    let entry = Entry {
        family: "rsm".to_owned(),
        ..Entry::outside(Path::new("wall/scene.toml"))
    };
    load_text(&mut Intake::from_disk(), &entry, None, &text).expect("a scene")
}

fn refused(loaded: &Loaded) -> String {
    let error = RsmRun::new(loaded, true).map(|_| ());
    error.expect_err("beyond a limit").to_string()
}

#[test]
fn entries_of_all_frames_are_held_together() {
    let loaded = scene([4, 4], "radius = 1\nframes = 3", "");
    let setup = Setup::new(&loaded).expect("a lattice");
    let mut limits = Limits::new(&setup);
    let mut parts = setup.parts(&loaded, 0).expect("a frame");
    parts.grid.prims = vec![0; 1 << 25];
    for _ in 0..2 {
        limits.add(&setup, &parts).expect("exactly the limit");
    }
    parts.grid.prims = vec![0];
    let error = limits
        .add(&setup, &parts)
        .expect_err("one more")
        .to_string();
    let words = "rsm.frames: the blockers have 67108865 entries in the cells of the frames so far";
    assert!(error.starts_with(words), "{error}");
}

/// A stack of quads over the whole picture, and over the lamp's map.
#[test]
fn fragments_of_all_frames_are_bounded() {
    let of = |frames: u32, layers: u32| {
        let keys = format!("radius = 1\nframes = {frames}");
        let quads = format!(
            "[[mesh]]\ngenerate.stack = {{ layers = {layers}, spacing = 0, size = [4, 4] }}"
        );
        scene([64, 64], &keys, &quads)
    };
    // 64 x 64 pixels and texels of each quad, and those of wall and floor.
    RsmRun::new(&of(1, 2000), true).expect("sixteen millions");
    let error = refused(&of(7, 2000));
    let words = "rsm: the triangles cover ";
    assert!(
        error.starts_with(words) && error.contains("67108864"),
        "{error}"
    );
}

/// Two hundred thousand specks at the one point from which rays of buffer B start: they are few,
/// but each pixel of the picture without noise asks as often.
#[test]
fn the_rays_of_embree_count_as_well() {
    let specks = "[[mesh]]\ngenerate.scatter = { count = 200_000, extent = [1e-4, 1e-4, 1e-4], \
                  length = 1e-5, width = 1e-5 }\ntranslate = [-1.97, 1.965, 0.01]\nseen = false\n\
                  blocks = true\n[[mesh]]\ngenerate.box = { size = [4, 4, 4] }\nseen = false\n\
                  blocks = true";
    let loaded = scene([64, 64], "radius = 64\ndivisor = 64", specks);
    let told = |threads| share::with_threads(threads, || refused(&loaded));
    let error = told(1);
    assert!(
        error.starts_with("rsm: the rays of all frames pass more than 34359738368 cells"),
        "{error}"
    );
    assert_eq!(error, told(3), "whatever the number of threads");
}

#[test]
fn a_ray_stands_for_those_of_its_square() {
    let ray = |size: [u32; 2], divisor: u32| {
        let loaded = scene(size, &format!("divisor = {divisor}"), "");
        let limits = Limits::new(&Setup::new(&loaded).expect("a lattice"));
        limits.of(Work {
            cells: 5,
            entries: 80,
        })
    };
    assert_eq!(ray([64, 64], 1), 5 + 80 + 10, "its own pixel");
    assert_eq!(ray([64, 64], 4), 5 + 80 + 160, "sixteen pixels");
    assert_eq!(ray([1, 1], 64), 5 + 80 + 10, "there are no more");
}
