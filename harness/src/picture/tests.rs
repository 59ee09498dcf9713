use super::colour::scale;
use super::*;
use crate::cause::Cause;

fn size(width: u32, height: u32) -> Size {
    Size { width, height }
}

fn decode(image: &Image) -> image::RgbImage {
    let decoded = image::load_from_memory(&image.png)
        .expect("a PNG")
        .to_rgb8();
    assert_eq!(decoded.dimensions(), (image.width, image.height), "size");
    decoded
}

#[test]
fn the_transfer_function_is_srgb() {
    // Codes of IEC 61966-2-1 for black, the end of the linear part, 2 % and 18 %
    // grey, half and white.
    let codes = [0.0, 0.003_130_8, 0.02, 0.18, 0.5, 1.0, 7.0, -1.0].map(srgb);
    assert_eq!(codes, [0, 10, 39, 118, 188, 255, 255, 0]);
}

#[test]
fn luminance_rises_along_the_heat_scale() {
    let linear = |byte: u8| libm::pow(f64::from(byte) / 255.0, 2.2);
    let luminance = |i: u32| {
        let [r, g, b] = scale(f64::from(i) / 100.0).map(linear);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    for i in 1..=100 {
        assert!(luminance(i) > luminance(i - 1), "falls at {i} %");
    }
    assert!(luminance(100) > 0.9, "the last is nearly white");
}

#[test]
fn heat_separates_none_from_one_and_reaches_both_ends() {
    assert_eq!(heat(0, 300), [0, 0, 0]);
    assert_ne!(heat(1, 300), [0, 0, 0], "one fragment is seen");
    assert_eq!(heat(300, 300), scale(1.0));
    assert_eq!(heat(0, 0), [0, 0, 0], "an empty scene");
    assert_eq!(heat(u32::MAX, u32::MAX), scale(1.0));
}

#[test]
fn pixels_keep_their_place() {
    let mut pixels = vec![[0.0; 3]; 6];
    pixels[1] = [1.0, 0.0, 0.0];
    pixels[5] = [0.0, 0.5, f32::NAN];
    let image = linear(size(3, 2), &pixels);
    let decoded = decode(&image);
    assert_eq!(decoded.get_pixel(1, 0).0, [255, 0, 0]);
    assert_eq!(decoded.get_pixel(2, 1).0, NOT_FINITE);
    assert!(
        image.note.contains("1 pixels are not finite"),
        "{}",
        image.note
    );
}

#[test]
fn large_pictures_shrink_by_whole_blocks() {
    let size = size(1281, 3);
    assert_eq!(reduction(size), 3);
    // Block 0 is half white in linear light; the last column's block is cut.
    let pixels: Vec<[f32; 3]> = (0..1281 * 3)
        .map(|i| if i % 1281 == 0 { [1.0; 3] } else { [0.0; 3] })
        .collect();
    let decoded = decode(&linear(size, &pixels));
    assert_eq!(decoded.dimensions(), (427, 1));
    assert_eq!(decoded.get_pixel(0, 0).0, [srgb(1.0 / 3.0); 3], "the mean");
    let mut one = vec![0; 1281 * 3];
    one[1280 + 2 * 1281] = 7;
    let image = counts(size, &one);
    assert_eq!(image.legend, Legend::Heat { max: 7 });
    assert_eq!(
        decode(&image).get_pixel(426, 0).0,
        scale(1.0),
        "the largest"
    );
    assert!(image.note.contains("1/3"), "{}", image.note);
}

#[test]
fn differences_are_amplified_by_a_stated_power_of_two() {
    let a = [[0.5, 0.5, 0.5], [0.25; 3]];
    let b = [[0.5, 0.5 + 0.001, 0.5], [0.25; 3]];
    let image = difference(size(2, 1), &a, &b);
    // 0.001 * 512 is above half, 0.001 * 1024 above one.
    assert!(image.note.contains("amplified 512 times"), "{}", image.note);
    let decoded = decode(&image);
    assert_eq!(decoded.get_pixel(0, 0).0, [srgb(0.001 * 512.0); 3]);
    assert_eq!(decoded.get_pixel(1, 0).0, [0; 3]);
    let same = difference(size(2, 1), &a, &a);
    assert!(same.note.contains("no difference"), "{}", same.note);
    let nan = [[f32::NAN, 0.5, 0.5], [0.25; 3]];
    let image = difference(size(2, 1), &a, &nan);
    assert_eq!(decode(&image).get_pixel(0, 0).0, NOT_FINITE);
}

#[test]
fn a_single_differing_pixel_of_a_large_picture_is_seen() {
    let size = size(1280, 720);
    let image = causes(size, None, [(1280 * 700 + 9, Some(Cause::Vertex))]);
    let decoded = decode(&image);
    assert_eq!(decoded.dimensions(), (640, 360));
    let ground = decoded.get_pixel(600, 10);
    let marked = decoded.pixels().filter(|p| *p != ground).count();
    assert_eq!(marked, 25, "five by five");
    assert_ne!(decoded.get_pixel(4, 350), ground, "in its place");
    let first = Mark {
        cause: Some(Cause::Vertex),
        pixels: 1,
        first: [9, 700],
    };
    assert_eq!(image.legend, Legend::Causes(vec![first]));
}

#[test]
fn what_has_no_cause_is_on_top_and_counts_pixels_once() {
    let marks = [
        (0, Some(Cause::Coverage)),
        (0, None),
        (3, Some(Cause::Coverage)),
        (3, Some(Cause::Coverage)),
    ];
    let image = causes(size(2, 2), Some(&[[1.0; 3]; 4]), marks);
    let decoded = decode(&image);
    assert_eq!(decoded.get_pixel(0, 0).0, [255, 0, 0]);
    let Legend::Causes(legend) = &image.legend else {
        panic!("a legend of causes");
    };
    let counts: Vec<_> = legend.iter().map(|m| (m.cause, m.pixels)).collect();
    assert_eq!(counts, [(None, 1), (Some(Cause::Coverage), 2)]);
}

#[test]
fn every_cause_has_its_own_look() {
    let unknown = serde_json::from_str::<Cause>("\"?\"").expect_err("no cause");
    let known = unknown.to_string().matches('`').count() / 2 - 1;
    assert_eq!(Cause::ALL.len(), known, "a cause is missing from the list");
    let mut looks = std::collections::BTreeSet::from([swatch(None)]);
    for (i, cause) in Cause::ALL.into_iter().enumerate() {
        assert_eq!(cause as usize, i, "{} is out of order", cause.name());
        let new = looks.insert(swatch(Some(cause)));
        assert!(new, "{} looks like another", cause.name());
    }
}
