//! From a scene file to the spec's numbers.

use std::path::Path;

use triptych_spec::camera::Projection;
use triptych_spec::grid::ray::Ray;
use triptych_spec::rsm::{Frame, OFFSET_MIN, Viewpoint};

use super::embree::ask_of;
use super::*;
use crate::corpus::Entry;
use crate::embree::Hit;
use crate::embree::rays::{RayAnswers, RayScene};
use crate::mesh::Intake;
use crate::scene::{Loaded, load_text};

/// A corner of four units, a blocker that moves, and keys beside.
fn scene(keys: &str, lamp: &str) -> Loaded {
    let text = format!(
        "
purpose = 'a corner with a box before it'
size = [16, 12]
camera = {{ eye = [2.4, 2.6, 4.6], target = [-0.2, 0.6, 0], height = 4, near = 0.5, far = 20 }}
[[mesh]]
generate.faces = {{ vertices = [[-2, 0, -2], [-2, 0, 2], [-2, 4, 2], [-2, 4, -2]], faces = [[0, 1, 2, 3]] }}
[[mesh]]
generate.faces = {{ vertices = [[-2, 0, -2], [2, 0, -2], [2, 0, 2], [-2, 0, 2]], faces = [[0, 1, 2, 3]] }}
[[mesh]]
generate.box = {{ size = [0.5, 0.5, 0.5] }}
translate = [-0.5, 0.5, 0]
seen = false
blocks = true
moves = {{ rotate = [0, 90, 0], translate = [0.25, 0, 0] }}
[rsm]
map = [8, 8]
radius = 6
{keys}
lamp = {{ {lamp} }}
"
    );
    let entry = Entry {
        family: "rsm".to_owned(),
        ..Entry::outside(Path::new("corner/scene.toml"))
    };
    load_text(&mut Intake::from_disk(), &entry, None, &text).expect("a scene")
}

const SUN: &str = "eye = [2, 2, 0], target = [-2, 2, 0], height = 2, near = 1, far = 9";
const SPOT: &str = "eye = [2, 2, 0], target = [-2, 2, 0], fov = 90, near = 1, far = 9";

/// Four units are 2^24 steps, but for a few at the ends.
fn unit(setup: &Setup) -> f64 {
    let unit = libm::scalbn(1.0, -setup.lattice.exponent);
    assert!((2_097_152.0..=4_194_304.0).contains(&unit), "{unit}");
    unit
}

#[test]
fn lengths_are_steps() {
    let keys = "bias = 0.5\nclamp = 0.25\nedge = 0.125\noffset = 3\nstride = 2";
    let setup = Setup::new(&scene(keys, SUN)).expect("within the limits");
    let (unit, p) = (unit(&setup), setup.parameters);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "exact"
    )]
    let (clamp, edge) = ((unit / 4.0) as u64, (unit / 8.0) as u32);
    assert_eq!(
        (p.clamp, p.edge, p.offset, p.stride),
        (clamp * clamp, edge, 3, 2)
    );
    // Half a unit of the eight from near to far.
    assert_eq!(p.bias, 1 << 27);
    let Projection::Orthographic { height } = setup.lamp.view.projection else {
        panic!("not orthographic");
    };
    assert!((height - 2.0 * unit).abs() < 1e-6 * unit);
}

#[test]
fn defaults_follow_the_lamp() {
    let setup = Setup::new(&scene("stride = 1", SUN)).expect("within the limits");
    let (unit, p) = (unit(&setup), setup.parameters);
    // A texel is a quarter of a unit, and two of them are a half.
    assert_eq!(p.bias, 1 << 27);
    let clamp = p.clamp as f64;
    assert!((clamp - unit * unit / 4.0).abs() <= 1e-6 * clamp, "{clamp}");
    assert_eq!(p.edge, 1 << 16);
    assert!(p.offset >= OFFSET_MIN);
    let spot = Setup::new(&scene("", SPOT)).expect("within the limits");
    assert!(matches!(spot.lamp.view.viewpoint, Viewpoint::Near(_)));
    // At its target, four units away.
    assert!((f64::from(spot.lamp.reference) - 4.0 * unit).abs() <= 1.0);
    // Depth is f / (f - n) (1 - n / d): 9 / 8 / 16 of it a unit at d = 4, of which a texel
    // takes one.
    let keys = f64::from(spot.parameters.bias);
    let expected = 2.0 * 9.0 / 8.0 / 16.0 * 2_147_483_647.0;
    assert!((keys - expected).abs() <= 1.0, "{keys} {expected}");
}

/// A light that is told by another distance is the same light.
#[test]
fn a_reference_beyond_the_lattice_is_halved() {
    let near = Setup::new(&scene("reference = 4\nstrength = [16, 16, 16]", SPOT)).expect("fits");
    let far = Setup::new(&scene("reference = 16\nstrength = [1, 1, 1]", SPOT)).expect("fits");
    let [a, b] = [near.lamp, far.lamp].map(|lamp| {
        let reference = f64::from(lamp.reference);
        f64::from(lamp.strength[0]) * reference * reference
    });
    assert!((a - b).abs() <= 1e-6 * a, "{a} {b}");
}

/// What is wrong, by key, in the scene's own units.
#[test]
fn limits_are_told_by_key() {
    let error = |keys: &str, lamp: &str| {
        let loaded = scene(keys, lamp);
        let error = Setup::new(&loaded).err().expect("beyond a limit");
        let line = error.key.and_then(|key| loaded.lines.of(key));
        (line.expect("a line"), error.to_string())
    };
    // The keys are on line 18, the lamp is on the line after them.
    let told = |keys: &str, lamp: &str, line: usize, words: &str| {
        let (at, error) = error(keys, lamp);
        assert_eq!(error, words);
        assert_eq!(at, line, "{error}");
    };
    let light = "rsm.reference: a strength of [1.0, 1.0, 1.0] at a distance of 1e300 is more light \
                 than 32-bit numbers hold; a shorter one, or a smaller strength, is right";
    told("reference = 1e300", SPOT, 18, light);
    let none = "rsm.reference: 0e0 is no distance of a light; 2.384e-7, half a step of \
                the lattice, or more is right";
    told("reference = 0", SPOT, 18, none);
    let edge = "rsm.edge: 1e0 is outside 0 to 5.000e-1, a 16th of the lattice's side";
    told("edge = 1", SUN, 18, edge);
    let clamp = "rsm.clamp: 1e300 is outside 0 to 1.386e1, the lattice's diagonal";
    told("clamp = 1e300", SUN, 18, clamp);
    let huge = "eye = [2, 2, 0], target = [-2, 2, 0], height = 1e30, near = 1, far = 9";
    let (line, words) = error("", huge);
    assert_eq!(line, 19, "{words}");
    assert!(
        words.starts_with("rsm.lamp.height: two texels of the kernel"),
        "{words}"
    );
    assert!(
        words.ends_with("state clamp or a smaller height"),
        "{words}"
    );
    let wide = "eye = [2, 2, 0], target = [-2, 2, 0], fov = 179.999999, near = 1, far = 9";
    let (line, words) = error("", wide);
    assert_eq!(line, 19, "{words}");
    assert!(words.ends_with("state clamp or a smaller fov"), "{words}");
    // All depths are equal from the largest bias on.
    assert!(Setup::new(&scene("bias = 1e9", SUN)).is_ok());
}

/// One lattice holds all frames; what does not move stays, and what does is where it should be.
#[test]
fn frames_move_what_moves() {
    let loaded = scene("frames = 3", SUN);
    let run = RsmRun::new(&loaded, true).expect("within the limits");
    let [first, second, third] = [0, 1, 2].map(|i| &run.frames[i].parts);
    assert_eq!(first.model, second.model);
    assert_eq!(first.blockers.triangles, third.blockers.triangles);
    let quarter = unit(&run.setup) / 4.0;
    for (number, other) in [(1.0, second), (2.0, third)] {
        // A box turned by a right angle is the same box, elsewhere.
        let corners = |parts: &Parts, by: f64| {
            let moved = |p: &[i32; 3]| {
                #[expect(clippy::cast_possible_truncation, reason = "an integer")]
                let by = by as i32;
                [p[0] + by, p[1], p[2]]
            };
            let mut all: Vec<[i32; 3]> = parts.blockers.vertices.iter().map(moved).collect();
            all.sort_unstable();
            all
        };
        for (a, b) in corners(first, number * quarter)
            .iter()
            .zip(corners(other, 0.0))
        {
            assert!((0..3).all(|i| a[i].abs_diff(b[i]) <= 1), "{a:?} {b:?}");
        }
        assert_ne!(first.blockers.vertices, other.blockers.vertices);
    }
    assert_ne!(first.grid.axes, third.grid.axes, "built anew");
}

/// Stages one by one are the spec's whole frame, with and without what the plan leaves out.
#[test]
fn stages_make_the_frame() {
    for keys in ["", "blur = 0", "divisor = 3\nblur = 2"] {
        let loaded = scene(keys, SPOT);
        for skip in [true, false] {
            let run = RsmRun::new(&loaded, skip).expect("within the limits");
            let frame = &run.frames[0];
            let whole = Frame::render(&run.setting(frame)).expect("within the limits");
            // Not shown where they differ: a frame is long.
            assert!(frame.frame == whole, "{keys} {skip}");
        }
    }
}

/// Where every pixel asks for itself and nothing is blurred, the spec's picture is the one
/// without noise; where blockers are asked less often, it is not, and Embree's of the same
/// samples is as far from it.
#[test]
fn the_reference_is_the_limit_of_the_picture() {
    let off = |keys: &str| {
        let run = RsmRun::new(&scene(keys, SPOT), true).expect("within the limits");
        let frame = &run.frames[0];
        let seen = ask(&run, frame).expect("an answer");
        assert_eq!(
            (seen.vote.disagree, seen.vote.rays),
            (0, frame.frame.blocked.rays)
        );
        assert!(frame.frame.blocked.light.iter().any(|c| c[0].value > 0.0));
        let picture = values(&frame.frame.picture);
        // The same samples have the same answers here, and sums of the same order.
        assert_eq!(picture, seen.picture);
        rmse(&picture, &seen.reference)
    };
    assert!(off("divisor = 1\nblur = 0") < 1e-15);
    assert!(off("divisor = 2\nblur = 1") > 1e-6);
}

/// An observation that says the opposite of every ray from one direction.
struct Lying(RayScene);

impl RayAnswers for Lying {
    fn occluded(&self, ray: &Ray) -> bool {
        self.0.occluded(ray) != (ray.direction[2] > 0)
    }
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.0.closest(ray)
    }
    fn check(&self) -> Result<(), EmbreeError> {
        self.0.check()
    }
}

#[test]
fn an_oracle_that_lies_is_noticed() {
    let run = RsmRun::new(&scene("", SPOT), true).expect("within the limits");
    let frame = &run.frames[0];
    let scene = RayScene::new(&frame.parts.blockers).expect("within the lattice");
    let seen = ask_of(&Lying(scene), &run, frame).expect("an answer");
    assert!(seen.vote.disagree > 10, "{:?}", seen.vote);
    let judged = judge(&run, &[seen], 1.0);
    assert!(judged.differ() > 10);
    assert!(
        judged.note.contains("RMSE against the reference"),
        "{}",
        judged.note
    );
}
