//! Flattening, shading, the default camera, selection.

use std::path::Path;

use triptych_spec::camera::Camera;

use super::value::{Capacity, Colour, Direction, Point};
use super::{Loaded, file::Light, fit, load_entry, shade};
use crate::corpus::{Entry, select};

/// Loads a scene from text.
fn scene(name: &str, text: &str) -> Loaded {
    let file = format!("triptych-{name}-{}.toml", std::process::id());
    let path = std::env::temp_dir().join(file);
    std::fs::write(&path, text).expect("the temporary folder is writable");
    let entry = Entry {
        name: name.to_owned(),
        family: "abuffer".to_owned(),
        path: path.clone(),
    };
    let loaded = load_entry(&entry, None).expect("the scene is sound");
    std::fs::remove_file(path).expect("the file is there");
    loaded
}

#[test]
fn triangles_are_in_order_of_primitive_and_instance() {
    let text = "purpose = 'x'\nsize = [8, 8]\n\
        [[mesh]]\ngenerate.box = { size = [1, 1, 1] }\ninstances = [{}, { translate = [1, 0, 0] }]\n\
        [[mesh]]\ngenerate.fan = { spokes = 3, radius = 1 }\n";
    let scene = scene("order", text).scene;
    let keys: Vec<(u32, u32)> = scene
        .triangles
        .iter()
        .map(|t| (t.primitive, t.instance))
        .collect();
    assert!(keys.is_sorted(), "{keys:?}");
    assert_eq!(keys.len(), 2 * 12 + 3, "two boxes and a fan");
    assert_eq!(
        keys.last(),
        Some(&(14, 2)),
        "numbers run on from mesh to mesh"
    );
    for t in &scene.triangles {
        let owners = t.vertices.map(|v| scene.vertices[v as usize].instance);
        assert_eq!(
            owners, [t.instance; 3],
            "a triangle has its instance's vertices"
        );
    }
}

#[test]
fn placements_scale_then_rotate_then_translate() {
    // (1, 0, 0) doubled is (2, 0, 0), about z by 90 degrees (0, 2, 0), about x first
    // nothing; moved by (3, 0, 0) it is (3, 2, 0). The instance moves it up by 5.
    let text = "purpose = 'x'\nsize = [16, 16]\n\
        [camera]\neye = [0, 0, 10]\ntarget = [0, 0, 0]\nheight = 16\nnear = 0\nfar = 20\n\
        [[mesh]]\ngenerate.faces = { vertices = [[1, 0, 0]], faces = [[0, 0, 0]] }\n\
        scale = 2\nrotate = [90, 0, 90]\ntranslate = [3, 0, 0]\ninstances = [{ translate = [0, 5, 0] }]\n";
    let scene = scene("placement", text).scene;
    let clip = scene.instances[0].point(scene.vertices[0].position.map(f64::from));
    assert_eq!(clip, [3.0 / 8.0, 7.0 / 8.0, 0.5], "clip space, exactly");
}

#[test]
fn shading_is_flat_two_sided_and_the_same_at_every_scale() {
    let light = |direction| Light::Directional {
        direction: Direction(direction),
        intensity: Colour([1.0; 3]),
    };
    let corners = |s: f64| [[0.0, 0.0, 0.0], [s, 0.0, 0.0], [0.0, s, 0.0]];
    let [a, b, c] = corners(1.0);
    let grey = [0.5; 3];
    let head_on = shade::face(&[light([0.0, 0.0, -3.0])], grey, [a, b, c]);
    assert_eq!(head_on, Ok([0.5; 3]), "the cosine is 1");
    let behind = shade::face(&[light([0.0, 0.0, -3.0])], grey, [a, c, b]);
    assert_eq!(behind, Ok([0.5; 3]), "from behind as well");
    let grazing = shade::face(&[light([1.0, 0.0, 0.0])], grey, [a, b, c]);
    assert_eq!(grazing, Ok([0.0; 3]), "the cosine is 0");
    for s in [1e-45, 1e-30, 1e18, 1e38, 1e80] {
        let scaled = shade::face(&[light([0.0, 0.0, -3.0])], grey, corners(s));
        assert_eq!(scaled, Ok([0.5; 3]), "at {s:e}");
    }
    let none = shade::face(&[light([0.0, 0.0, 1.0])], grey, [a, b, b]);
    assert_eq!(none, Ok([0.0; 3]), "no area, no light");
}

#[test]
fn point_lights_fall_off_with_the_square() {
    let light = |height: f64| Light::Point {
        position: Point([0.0, 0.0, height]),
        intensity: Colour([1.0; 3]),
    };
    let around = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 2.0, 0.0]];
    let at = |height| shade::face(&[light(height)], [1.0; 3], around);
    assert_eq!(at(2.0), Ok([0.25; 3]), "a quarter at twice the distance");
    assert_eq!(at(-4.0), Ok([0.0625; 3]), "from either side");
    assert_eq!(at(0.0), Ok([0.0; 3]), "in the plane there is no cosine");
    assert!(at(1e-9).is_err(), "and too near is too bright");
}

/// Whether a camera sees a point, far from the picture's edges or not.
fn sees(camera: &Camera, aspect: f64, p: [f64; 3]) -> bool {
    let m = camera.matrix(aspect).expect("the default camera is sound");
    let row = |r: usize| (0..3).map(|i| m.rows[r][i] * p[i]).sum::<f64>() + m.rows[r][3];
    let [x, y, z, w] = [0, 1, 2, 3].map(row);
    w > 0.0 && x.abs() <= w && y.abs() <= w && z >= 0.0 && z <= w
}

#[test]
fn the_default_camera_sees_everything() {
    let mut random = crate::generate::Random::new(5);
    for case in 0..200 {
        let size = libm::pow(10.0, 30.0 * random.signed());
        let offset = size * libm::pow(10.0, 4.0 * random.unit());
        let mut number = |by: f64| by * random.signed();
        let centre = [number(offset), number(offset), number(offset)];
        let extent = [number(size), number(size), number(size)];
        let points: Vec<[f64; 3]> = (0..20)
            .map(|_| [0, 1, 2].map(|i| centre[i] + number(extent[i])))
            .collect();
        for aspect in [1.0, 2048.0, 1.0 / 2048.0, 1.5] {
            let camera = fit::camera(|| points.iter().copied(), aspect);
            let blind = points.iter().find(|p| !sees(&camera, aspect, **p));
            assert_eq!(blind, None, "case {case}, aspect {aspect}");
        }
    }
    let one = [3.0, 4.0, 5.0];
    assert!(
        sees(&fit::camera(|| [one].into_iter(), 1.0), 1.0, one),
        "a point"
    );
    assert!(
        sees(&fit::camera(|| [].into_iter(), 1.0), 1.0, [0.0; 3]),
        "nothing"
    );
}

#[test]
fn capacities_are_relative_or_absolute() {
    let nodes = |c: Capacity| [c.nodes(0), c.nodes(10)];
    assert_eq!(nodes(Capacity::All), [0, 10], "as many as are needed");
    assert_eq!(
        nodes(Capacity::AllBut(1)),
        [0, 9],
        "one fewer, never less than none"
    );
    assert_eq!(nodes(Capacity::Nodes(4)), [4, 4], "whatever is needed");
}

#[test]
fn patterns_select_parts_whole_names_and_files() {
    let entry = |name: &str| Entry {
        name: name.to_owned(),
        family: "abuffer".to_owned(),
        path: Path::new(name).join("scene.toml"),
    };
    let entries = ["abuffer/fan", "abuffer/fan-two", "raster/fan"].map(entry);
    let names = |patterns: &[&str], exact| {
        let patterns: Vec<String> = patterns.iter().map(|p| (*p).to_owned()).collect();
        let selected = select(&entries, &patterns, exact);
        selected.map(|s| s.into_iter().map(|e| e.name).collect::<Vec<_>>())
    };
    let all = Ok(entries.iter().map(|e| e.name.clone()).collect());
    assert_eq!(names(&[], false), all, "no pattern selects all");
    assert_eq!(names(&["fan"], false), all, "a part of a name");
    let one = Ok(vec!["abuffer/fan".to_owned()]);
    assert_eq!(names(&["abuffer/fan"], true), one, "a whole name");
    assert_eq!(names(&["abuffer/fan", "abuffer/fan"], true), one, "once");
    assert!(names(&["fam"], false).is_err(), "nothing is an error");
    let file = names(&["some/mesh.ply.gz"], false);
    assert_eq!(
        file,
        Ok(vec!["mesh".to_owned()]),
        "a path is left to the loader"
    );
}
