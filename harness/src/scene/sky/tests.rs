//! Radiance from directions, and files that are no pictures.

use std::collections::BTreeMap;
use std::path::PathBuf;

use triptych_spec::scene::Size;

use super::*;
use crate::corpus::Entry;
use crate::scene::load_text;

const UP: [f64; 3] = [0.0, 1.0, 0.0];

fn panorama(width: u32, texels: &[f32]) -> Panorama {
    let height = u32::try_from(texels.len()).expect("few") / width;
    let texels = texels.iter().map(|t| [*t, 0.0, 2.0 * t]).collect();
    Panorama::new(Size { width, height }, texels).expect("texels")
}

fn image(panorama: Panorama, filter: Filter) -> Sky {
    Sky::Image {
        panorama,
        axes: axes(UP, [0.0, 0.0, -1.0]).expect("at right angles"),
        filter,
    }
}

#[test]
fn a_gradient_goes_by_the_cosine() {
    let sky = Sky::Gradient {
        zenith: [4.0, 2.0, 0.0],
        nadir: [0.0, 2.0, 8.0],
        up: UP,
    };
    assert_eq!(sky.radiance(UP), [4.0, 2.0, 0.0]);
    assert_eq!(sky.radiance([0.0, -1.0, 0.0]), [0.0, 2.0, 8.0]);
    assert_eq!(sky.radiance([0.8, 0.0, 0.6]), [2.0, 2.0, 4.0]);
    assert_eq!(sky.sides(UP), [[4.0, 2.0, 0.0], [0.0, 2.0, 8.0]]);
}

/// Four columns: behind on the left, on the left, in front on the right, on the right.
#[test]
fn the_nearest_texel_is_the_one_around_a_direction() {
    let sky = image(
        panorama(4, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]),
        Filter::Nearest,
    );
    let at = |d: [f64; 3]| sky.radiance(normalize(d))[0];
    // A little above and below the horizon, and all around from the front to the right.
    for (d, above) in [
        ([0.1, 0.1, -1.0], 3.0),
        ([1.0, 0.1, -0.1], 3.0),
        ([1.0, 0.1, 0.1], 4.0),
        ([0.1, 0.1, 1.0], 4.0),
        ([-0.1, 0.1, 1.0], 1.0),
        ([-1.0, 0.1, 0.1], 1.0),
        ([-1.0, 0.1, -0.1], 2.0),
        ([-0.1, 0.1, -1.0], 2.0),
    ] {
        assert_eq!(at(d), above, "{d:?}");
        assert_eq!(at([d[0], -d[1], d[2]]), above + 4.0, "{d:?}, below");
    }
    // At a pole any column will do, and the lowest row is the last.
    assert!((1.0..=4.0).contains(&at(UP)));
    assert!((5.0..=8.0).contains(&at([0.0, -1.0, 0.0])));
    assert_eq!(sky.radiance(normalize([0.1, 0.1, -1.0])), [3.0, 0.0, 6.0]);
}

#[test]
fn bilinear_texels_mix_around_the_seam_and_end_at_the_poles() {
    let sky = image(
        panorama(4, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]),
        Filter::Bilinear,
    );
    let near = |d: [f64; 3], is: f64| {
        let found = sky.radiance(normalize(d))[0];
        assert!((found - is).abs() < 1e-12, "{d:?}: {found}, not {is}");
    };
    // On the horizon before the viewer: between two columns and two rows.
    near([0.0, 0.0, -1.0], (2.0 + 3.0 + 6.0 + 7.0) / 4.0);
    // Behind: the last column and the first.
    near([0.0, 0.0, 1.0], (4.0 + 1.0 + 8.0 + 5.0) / 4.0);
    // The middle of texel (2, 0): an eighth of a turn to the right, and as much up.
    near([1.0, libm::sqrt(2.0), -1.0], 3.0);
    // Nearer to the pole than the first row's middle: nothing but that row.
    near([0.2, 2.0, -0.2], 3.0);
}

#[test]
fn up_and_front_may_be_any_two() {
    let axes = axes([0.0, 0.0, 3.0], [5.0, 0.0, 1.0]).expect("not parallel");
    assert_eq!(axes, [[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]);
    assert_eq!(super::axes(UP, [0.0, -2.0, 0.0]), None);
    assert_eq!(super::axes([1e300, 0.0, 0.0], [1e-300, 0.0, 0.0]), None);
}

fn loaded(name: &str, bytes: &[u8]) -> Result<Option<Sky>, String> {
    let text =
        format!("purpose = 'x'\nsize = [4, 4]\nmesh = []\nldm.sky.image = {{ file = '{name}' }}\n");
    let files = BTreeMap::from([(PathBuf::from(name), bytes.to_vec())]);
    let entry = Entry::outside(Path::new("scene.toml"));
    let loaded = load_text(&mut Intake::from_memory(&files), &entry, None, &text);
    loaded.map(|l| l.sky).map_err(|e| e.to_string())
}

fn refused(name: &str, bytes: &[u8], words: &str) {
    let error = loaded(name, bytes).expect_err("is no sky");
    assert!(error.contains(words), "{error}");
    assert!(!error.contains(char::is_control), "{error:?}");
}

const HDR: &[u8] =
    b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x40\x20\x81\x00\x00\x00\x00";

#[test]
fn an_hdr_has_shared_exponents() {
    let Ok(Some(Sky::Image { panorama, .. })) = loaded("a.hdr", HDR) else {
        panic!("a picture");
    };
    assert_eq!(panorama.at([0.0, 0.0], Filter::Nearest), [1.0, 0.5, 0.25]);
    assert_eq!(panorama.at([0.9, 0.0], Filter::Nearest), [0.0; 3]);
    refused("a.hdr", &HDR[..HDR.len() - 2], "a.hdr: ");
    refused("a.hdr", b"", "a.hdr: ");
    refused("a.hdr", b"#?RADIANCE\n\x1b[31m\n\n-Y 1 +X 1\n", "a.hdr: ");
    let huge = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 99999 +X 99999\n";
    refused(
        "a.hdr",
        huge,
        "has 99999 x 99999 texels; 1 to 33554432 are allowed",
    );
    let none = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 7\n";
    refused("a.hdr", none, "a.hdr: ");
    let bright = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x40\x20\xa0";
    refused("a.hdr", bright, "texel (0, 0) is [2147483600.0");
    refused("a.png", HDR, "a sky is an .exr or .hdr");
}

#[test]
fn an_exr_is_as_it_is() {
    let folder = std::env::temp_dir().join(format!("triptych-sky-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join("a.exr");
    let written = |set: &(dyn Sync + Fn(usize, usize) -> (f32, f32, f32))| {
        exr::prelude::write_rgb_file(&path, 3, 2, set).expect("written");
        std::fs::read(&path).expect("read")
    };
    let bytes = written(&|x, y| (x as f32, y as f32, 0.125));
    let Ok(Some(Sky::Image { panorama, .. })) = loaded("a.exr", &bytes) else {
        panic!("a picture");
    };
    assert_eq!(panorama.at([0.5, 0.6], Filter::Nearest), [1.0, 1.0, 0.125]);
    for end in [0, 4, 100, bytes.len() - 1] {
        refused("a.exr", &bytes[..end], "a.exr: ");
    }
    let negative = written(&|_, _| (0.0, -1.0, 0.0));
    refused("a.exr", &negative, "texel (0, 0) is [0.0, -1.0, 0.0]");
    let nan = written(&|x, _| (0.0, 0.0, if x == 2 { f32::NAN } else { 0.0 }));
    refused("a.exr", &nan, "texel (2, 0) is [0.0, 0.0, NaN]");
    // The data window's far corner.
    let at = bytes
        .windows(10)
        .position(|w| w == b"dataWindow")
        .expect("there");
    let mut huge = bytes.clone();
    let corner = at + b"dataWindow\0box2i\0".len() + 4 + 8;
    huge[corner..corner + 4].copy_from_slice(&1_000_000_i32.to_le_bytes());
    huge[corner + 4..corner + 8].copy_from_slice(&1_000_000_i32.to_le_bytes());
    refused("a.exr", &huge, "a.exr: ");
    std::fs::remove_dir_all(&folder).expect("removed");
}

/// A tile is unpacked in all its channels: how large it says that it is, times how many they are, is
/// counted before.
#[test]
fn a_tile_of_an_exr_has_room_for_three_channels_not_for_all() {
    use exr::prelude::*;
    let named = |n: usize| AnyChannel::new(&*format!("{n:02}"), FlatSamples::F32(vec![1.0; 16]));
    let written = |channels: Vec<AnyChannel<FlatSamples>>| {
        let blocks = Blocks::Tiles(Vec2(4, 4));
        let layer = Layer::new(
            (4, 4),
            LayerAttributes::named("sky"),
            Encoding {
                compression: Compression::ZIP16,
                blocks,
                line_order: LineOrder::Increasing,
            },
            AnyChannels::sort(channels.into_iter().collect()),
        );
        let mut bytes = std::io::Cursor::new(Vec::new());
        Image::from_layer(layer)
            .write()
            .to_buffered(&mut bytes)
            .expect("written");
        bytes.into_inner()
    };
    let rgb = ["R", "G", "B"].map(|name| AnyChannel::new(name, FlatSamples::F32(vec![1.0; 16])));
    // The tile that the file says it has is larger than its picture.
    let grown = |channels, side: u32| {
        let mut bytes = written(channels);
        let name = b"tiles\0tiledesc\0";
        let at = bytes
            .windows(name.len())
            .position(|w| w == name)
            .expect("there");
        let sides = at + name.len() + 4;
        bytes[sides..sides + 8].copy_from_slice(&[side.to_le_bytes(); 2].concat());
        bytes
    };
    assert!(loaded("a.exr", &grown(rgb.to_vec(), 2048)).is_ok());
    let all = || (0..60).map(named).chain(rgb.clone()).collect::<Vec<_>>();
    assert!(loaded("a.exr", &grown(all(), 512)).is_ok());
    let words = "has blocks of 1056964608 bytes in 63 channels; 134217728 are allowed";
    refused("a.exr", &grown(all(), 2048), words);
}
