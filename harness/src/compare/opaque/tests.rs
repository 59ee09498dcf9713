use triptych_spec::abuffer::{NOTHING, Opaque};
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use super::{compare, key_at};
use crate::cause::Cause;
use crate::compare::Judgement;

/// Two rows of two pixels. Triangles 0 and 1 cover all at key 7, 2 at key 9; 3 lies outside,
/// 4 has no area, 5 covers the first pixel of the second row at key 4.
fn primitives() -> Primitives {
    let all = |key| [[-2048, -2048, key], [4096, -2048, key], [-2048, 4096, key]];
    let outside = [[4096, 0, 1], [8192, 0, 1], [4096, 4096, 1]];
    let one = [[0, 256, 4], [300, 256, 4], [0, 556, 4]];
    let corners = [all(7), all(7), all(9), outside, [[0, 0, 1]; 3], one];
    Primitives {
        samples: triptych_spec::raster::Samples::ONE,
        size: Size {
            width: 2,
            height: 2,
        },
        bits: 8,
        snapped: corners.concat(),
        prims: (0..6)
            .map(|row| [3 * row, 3 * row + 1, 3 * row + 2])
            .collect(),
        source: (0..6).collect(),
    }
}

/// Row 0 in the first pixel, and this in the second.
fn shown(key: u32, prim: u32) -> Opaque {
    Opaque {
        key: vec![7, key],
        prim: vec![0, prim],
    }
}

/// Judges what the second pixel shows; it must show row 0.
fn judge(key: u32, prim: u32) -> Judgement {
    compare(&shown(7, 0), &shown(key, prim), &primitives())
}

fn cause(key: u32, prim: u32) -> Option<Cause> {
    let judgement = judge(key, prim);
    assert_eq!((judgement.compared, judgement.differ()), (2, 1));
    assert_eq!(judgement.marks.len(), 1);
    assert_eq!(judgement.marks[0].0, 1, "the second pixel");
    judgement.causes.into_keys().next()
}

#[test]
fn every_difference_has_its_cause() {
    assert_eq!(judge(7, 0).differ(), 0, "the same");
    assert_eq!(
        cause(7, 1),
        Some(Cause::TieOrder),
        "another of the same key"
    );
    assert_eq!(
        cause(9, 2),
        Some(Cause::Coverage),
        "one behind shows through"
    );
    assert_eq!(
        cause(8, 0),
        Some(Cause::DepthKey),
        "the same at another key"
    );
    assert_eq!(
        cause(7, 2),
        Some(Cause::DepthKey),
        "one behind at a key that it has not"
    );
    assert_eq!(cause(1, 3), Some(Cause::Coverage), "one that is not there");
    assert_eq!(cause(1, 4), Some(Cause::Coverage), "one without area");
    assert_eq!(cause(7, 6), Some(Cause::Coverage), "a row that nobody has");
    assert_eq!(cause(NOTHING, NOTHING), Some(Cause::Coverage), "nothing");
}

#[test]
fn differences_are_told_in_words() {
    let first = |judgement: Judgement| judgement.described[0].clone();
    let words = "tie-order: pixel (1, 0) shows triangle row 1 at key 7, \
                 must show triangle row 0 at key 7";
    assert_eq!(first(judge(7, 1)), words);
    let words = "coverage: pixel (1, 0) shows nothing, must show triangle row 0 at key 7";
    assert_eq!(first(judge(NOTHING, NOTHING)), words);
}

#[test]
fn surfaces_of_another_size_are_not_compared() {
    let (mut keys, mut prims) = (shown(7, 0), shown(7, 0));
    keys.key.pop();
    prims.prim.pop();
    for other in [keys, prims] {
        let judgement = compare(&shown(7, 0), &other, &primitives());
        assert_eq!(judgement.causes.get(&Cause::ReferenceMissing), Some(&1));
        assert_eq!(judgement.compared, 0);
    }
}

#[test]
fn a_key_is_that_of_the_pixel() {
    let seen = [0, 1, 2, 3].map(|pixel| key_at(&primitives(), 5, pixel, 0));
    assert_eq!(seen, [None, None, Some(4), None]);
}

/// With four samples a pixel, every one of them is compared, and named.
#[test]
fn surfaces_of_samples_are_told_apart() {
    let primitives = Primitives {
        samples: triptych_spec::raster::Samples::standard(4).expect("a pattern"),
        ..primitives()
    };
    let must = Opaque {
        key: vec![7; 16],
        prim: vec![0; 16],
    };
    let mut seen = must.clone();
    seen.prim[4 + 3] = 1;
    seen.key[2 * 4] = 9;
    let judgement = compare(&must, &seen, &primitives);
    assert_eq!((judgement.compared, judgement.unit), (16, "samples"));
    let marks: Vec<u32> = judgement.marks.iter().map(|mark| mark.0).collect();
    assert_eq!(marks, [1, 2], "pixels");
    let words = [
        "tie-order: pixel (1, 0) sample 3 shows triangle row 1 at key 7, \
         must show triangle row 0 at key 7",
        "depth-key: pixel (0, 1) sample 0 shows triangle row 0 at key 9, \
         must show triangle row 0 at key 7",
    ];
    assert_eq!(judgement.described, words);
}

/// The corner pixel's triangle has its longest edge through the pixel: two samples of four.
#[test]
fn a_key_is_that_of_the_sample() {
    let primitives = Primitives {
        samples: triptych_spec::raster::Samples::standard(4).expect("a pattern"),
        ..primitives()
    };
    let seen = [0, 1, 2, 3].map(|s| key_at(&primitives, 5, 2, s));
    assert_eq!(seen, [Some(4), None, Some(4), None]);
}
