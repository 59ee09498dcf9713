use std::fmt::Debug;

use triptych_spec::abuffer::{build, opaque, sort};
use triptych_spec::grid::lattice::Lattice;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::{Blockers, Grid, Membership};
use triptych_spec::matrix::Matrix;
use triptych_spec::scene::{Scene, Triangle, Vertex};
use triptych_spec::vertex::primitives;

use triptych_spec::abuffer::Sorted;
use triptych_spec::raster::Fragment;

use super::*;

/// A folder of a test's own, removed when it ends.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let dir = std::env::temp_dir().join(format!("triptych-dump-{name}-{}", std::process::id()));
        Self(dir)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A test that failed early may have left nothing to remove.
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn read<T: npyz::Deserialize>(path: PathBuf) -> (Vec<u64>, String, Vec<T>) {
    let bytes = fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let file = npyz::NpyFile::new(&bytes[..]).expect("a NumPy array");
    assert_eq!(file.order(), npyz::Order::C, "row-major");
    let (shape, dtype) = (file.shape().to_vec(), file.dtype().descr());
    (shape, dtype, file.into_vec().expect("its numbers"))
}

fn is<T: npyz::Deserialize + PartialEq + Debug>(
    path: PathBuf,
    shape: &[u64],
    dtype: &str,
    data: &[T],
) {
    let name = path.display().to_string();
    let actual = read::<T>(path);
    assert_eq!(actual.0, shape, "shape of {name}");
    assert_eq!(actual.1, format!("'{dtype}'"), "type of {name}");
    assert_eq!(actual.2, data, "numbers of {name}");
}

/// Two transparent triangles that cover all of 4 × 2 pixels, the first nearer.
fn scene() -> Scene {
    let corner = |x, y, z| Vertex {
        position: [x, y, z],
        instance: 0,
    };
    let corners = |z| {
        [
            corner(-1.0, -1.0, z),
            corner(3.0, -1.0, z),
            corner(-1.0, 3.0, z),
        ]
    };
    let face = |vertices, primitive| Triangle {
        vertices,
        instance: 0,
        primitive,
        colour: [0.25, 0.5, 1.0, 0.5],
    };
    let identity = [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| f64::from(u8::from(i == j))));
    Scene {
        samples: triptych_spec::raster::Samples::ONE,
        order: triptych_spec::abuffer::Order::Centroid,
        size: Size {
            width: 4,
            height: 2,
        },
        instances: vec![Matrix { rows: identity }],
        vertices: [corners(0.25), corners(0.75)].concat(),
        triangles: vec![face([0, 1, 2], 7), face([3, 4, 5], 9)],
        background: [0.0; 3],
    }
}

#[test]
fn stages_come_back_with_their_shapes_and_types() {
    let folder = Folder::new("stages");
    let scene = scene();
    let prims = primitives(&scene, 8);
    let nearest = opaque(&scene, &prims);
    let sorted = sort(&build(&scene, &prims, &nearest, true, 100));
    let leg = Dump::new(&folder.0).leg("abuffer/two", "gpu@llvmpipe/fragment");
    leg.primitives(&prims, &scene).expect("written");
    leg.sorted(&scene, &prims, &sorted).expect("written");

    let dir = folder.0.join("abuffer/two/gpu@llvmpipe-fragment");
    assert_eq!(leg.path(), dir);
    let snapped = prims.snapped.as_flattened();
    let corners = prims.snapped.len() as u64;
    is(
        dir.join("vertex/snapped.npy"),
        &[corners, 3],
        "<i4",
        snapped,
    );
    let rows = prims.prims.len() as u64;
    is(
        dir.join("vertex/prims.npy"),
        &[rows, 3],
        "<u4",
        prims.prims.as_flattened(),
    );
    let (shape, _, source) = read::<u32>(dir.join("vertex/source.npy"));
    assert_eq!(shape, [rows, 2]);
    assert_eq!(source[..2], [0, 7], "instance, then source triangle");
    assert_eq!(source[source.len() - 1], 9);

    let starts: Vec<u32> = (0..=8).map(|pixel| 2 * pixel).collect();
    is(dir.join("abuffer/offsets.npy"), &[9], "<u4", &starts);
    let keys: Vec<u32> = sorted.fragments.iter().map(|f| f.key).collect();
    assert!(keys[0] < keys[1], "nearest first");
    is(dir.join("abuffer/depth.npy"), &[16], "<u4", &keys);
    is(dir.join("abuffer/mask.npy"), &[16], "<u4", &[1_u32; 16]);
    let rgba = [0.25_f32, 0.5, 1.0, 0.5].repeat(16);
    is(dir.join("abuffer/rgba.npy"), &[16, 4], "<f4", &rgba);
}

/// A cell around a triangle, and a ray that meets it half way, beside one that does not.
#[test]
fn grids_come_back_with_their_shapes_and_types() {
    let folder = Folder::new("grid");
    let blockers = Blockers {
        vertices: vec![[0, 0, 0], [90, 0, 0], [0, 90, 0]],
        triangles: vec![[0, 1, 2]],
    };
    let grid = Grid::build(&blockers, Resolution::Given([1; 3]), Membership::Box);
    let grid = grid.expect("a cell");
    let rays = [
        Ray::between([10, 10, -5], [10, 10, 5]),
        Ray {
            segment: false,
            ..Ray::between([80, 80, -5], [80, 80, 5])
        },
    ];
    let hits = [
        GridHit {
            any: Some(0),
            closest: Some((0, 0.5)),
        },
        GridHit::default(),
    ];
    let leg = Dump::new(&folder.0).leg("grid/one", "gpu@x/compute");
    leg.grid(&GridArrays {
        lattice: &Lattice {
            centre: [1.0, 2.0, 3.0],
            exponent: -2,
        },
        axes: &grid.axes,
        blockers: &blockers,
        offsets: &grid.offsets,
        prims: &grid.prims,
        rays: &rays,
        hits: &hits,
    })
    .expect("written");
    let file = |name: &str| leg.path().join(format!("grid/{name}.npy"));
    is(file("dims"), &[3], "<u4", &[1_u32; 3]);
    let boundaries = [-16, 106, -16, 106, -16, 16];
    is(file("boundaries"), &[6], "<i4", &boundaries);
    is(file("lattice"), &[4], "<f8", &[1.0, 2.0, 3.0, 0.25]);
    let corners = [0, 0, 0, 90, 0, 0, 0, 90, 0];
    is(file("triangles"), &[1, 3, 3], "<i4", &corners);
    is(file("offsets"), &[2], "<u4", &[0_u32, 1]);
    is(file("prims"), &[1], "<u4", &[0_u32]);
    let flat = [10, 10, -5, 0, 0, 10, 1, 80, 80, -5, 0, 0, 10, 0];
    is(file("rays"), &[2, 7], "<i4", &flat);
    is(file("hit"), &[2, 2], "<u4", &[0, 0, u32::MAX, u32::MAX]);
    let (shape, kind, times) = read::<f64>(file("t"));
    assert_eq!((&shape[..], &kind[..]), (&[2][..], "'<f8'"));
    assert!(times[0] == 0.5 && times[1].is_nan(), "{times:?}");
}

#[test]
fn wrong_results_of_a_leg_are_written_too() {
    let folder = Folder::new("wrong");
    let scene = scene();
    let mut prims = primitives(&scene, 8);
    *prims.source.last_mut().expect("two triangles") = 99;
    let sorted = Sorted {
        offsets: vec![0, 1],
        fragments: vec![Fragment {
            pixel: 0,
            prim: u32::MAX,
            key: 1,
            mask: 1,
        }],
    };
    let leg = Dump::new(&folder.0).leg("s", "gpu");
    leg.primitives(&prims, &scene).expect("written");
    leg.sorted(&scene, &prims, &sorted).expect("written");
    let (_, _, source) = read::<u32>(leg.path().join("vertex/source.npy"));
    assert_eq!(source[source.len() - 2..], [u32::MAX; 2]);
    let (_, _, rgba) = read::<f32>(leg.path().join("abuffer/rgba.npy"));
    assert!(rgba.iter().all(|c| c.is_nan()), "{rgba:?}");
}

#[test]
fn images_come_back_from_all_three_files() {
    let folder = Folder::new("image");
    let size = Size {
        width: 3,
        height: 2,
    };
    let pixels: Vec<[f32; 3]> = [0.0, 0.1, 0.2, 0.3, 1.5, -1.0]
        .map(|c| [c, 0.5, 1e-30])
        .to_vec();
    let leg = Dump::new(&folder.0).leg("s", "spec");
    leg.image("abuffer", "image", size, &pixels)
        .expect("written");
    let file = |extension| leg.path().join(format!("abuffer/image.{extension}"));
    is(file("npy"), &[2, 3, 3], "<f4", pixels.as_flattened());

    let read = exr::prelude::read_first_rgba_layer_from_file(
        file("exr"),
        |size, _| vec![[0.0_f32; 3]; size.area()],
        |pixels: &mut Vec<[f32; 3]>, at, (r, g, b, _): (f32, f32, f32, f32)| {
            pixels[at.y() * 3 + at.x()] = [r, g, b];
        },
    );
    let exr = read.expect("an EXR").layer_data.channel_data.pixels;
    assert_eq!(exr, pixels, "bit for bit");

    let png = image::open(file("png")).expect("a PNG").to_rgb8();
    assert_eq!(png.dimensions(), (3, 2));
    assert_eq!(png.get_pixel(1, 1).0, [255, 188, 0], "clamped, sRGB");
}

#[test]
fn empty_and_wide_arrays_and_wrong_shapes() {
    let folder = Folder::new("shapes");
    let leg = Dump::new(&folder.0).leg("s", "spec");
    leg.u32("a", "none", &[0, 3], &[]).expect("written");
    is::<u32>(leg.path().join("a/none.npy"), &[0, 3], "<u4", &[]);
    leg.u64("a", "wide", &[1], &[u64::MAX]).expect("written");
    is(leg.path().join("a/wide.npy"), &[1], "<u8", &[u64::MAX]);
    leg.f64("a", "real", &[2], &[0.1, -0.0]).expect("written");
    is(leg.path().join("a/real.npy"), &[2], "<f8", &[0.1, -0.0]);
    let wrong = leg.u32("a", "x", &[2, 3], &[1]).expect_err("refused");
    assert!(
        wrong.to_string().contains("a/x.npy: shape [2, 3] for 1"),
        "{wrong}"
    );
    let huge = leg
        .u32("a", "x", &[usize::MAX, 2], &[])
        .expect_err("refused");
    assert!(huge.to_string().contains("for 0 numbers"), "{huge}");
}

#[test]
fn meta_says_what_the_arrays_do_not() {
    let folder = Folder::new("meta");
    let meta = Meta {
        scene: "../evil".to_owned(),
        leg: "spec".to_owned(),
        width: 4,
        height: 2,
        subpixel_bits: 8,
        sample_positions: vec![[0.5, 0.5]],
        versions: [("triptych".to_owned(), "0.1.0".to_owned())].into(),
    };
    let leg = Dump::new(&folder.0).leg(&meta.scene, &meta.leg);
    leg.meta(&meta).expect("written");
    assert_eq!(leg.path(), folder.0.join("%2e./evil/spec"), "stays inside");
    let text = fs::read_to_string(leg.path().join("meta.json")).expect("read");
    let back: Meta = serde_json::from_str(&text).expect("JSON");
    assert_eq!(back, meta);
}

#[test]
fn an_error_names_the_file() {
    let folder = Folder::new("error");
    fs::create_dir_all(&folder.0).expect("created");
    fs::write(folder.0.join("s"), "in the way").expect("written");
    let leg = Dump::new(&folder.0).leg("s", "spec");
    let error = leg.u32("a", "x", &[1], &[1]).expect_err("refused");
    assert!(error.to_string().contains("spec/a/x.npy: "), "{error}");
}
