//! Each comparer catches what is planted, and nothing else.

use std::path::Path;

use triptych_spec::abuffer::NOTHING;
use triptych_spec::rsm::{Frame, Gbuffer, PLACE_MAX, Place, Surface, place};

use super::*;
use crate::corpus::Entry;
use crate::mesh::Intake;
use crate::replay::rsm::RsmRun;
use crate::row::Verdict;
use crate::scene::load_text;

const SCENE: &str = "
purpose = 'a corner with a box before it'
size = [16, 12]
camera = { eye = [2.4, 2.6, 4.6], target = [-0.2, 0.6, 0], fov = 36, near = 0.5, far = 20 }
[[mesh]]
generate.faces = { vertices = [[-1.5, 0, -2], [-1.5, 0, 2], [-1.5, 2.4, 2], [-1.5, 2.4, -2]], faces = [[0, 1, 2, 3]] }
[[mesh]]
generate.faces = { vertices = [[-1.5, 0, -2], [2, 0, -2], [2, 0, 2], [-1.5, 0, 2]], faces = [[0, 1, 2, 3]] }
[[mesh]]
generate.box = { size = [0.5, 0.5, 0.5] }
translate = [-0.3, 0.5, 0]
blocks = true
[rsm]
map = [8, 8]
radius = 6
lamp = { eye = [3, 2.2, 0], target = [-1.5, 1.5, 0], fov = 30, near = 0.5, far = 10 }
";

fn run() -> RsmRun {
    let entry = Entry {
        family: "rsm".to_owned(),
        ..Entry::outside(Path::new("planted/scene.toml"))
    };
    let loaded = load_text(&mut Intake::from_disk(), &entry, None, SCENE).expect("a scene");
    RsmRun::new(&loaded, true).expect("within the limits")
}

fn frame(run: &RsmRun) -> &Frame {
    &run.frames[0].frame
}

/// Whether a judgement would pass as a row.
fn passes(judgement: &Judgement) -> bool {
    judgement.differ() == 0 && judgement.compared > judgement.admitted
}

/// One item differs, by this cause, and at this pixel if it has one.
fn caught(judgement: &Judgement, cause: Cause, pixel: Option<usize>) {
    assert_eq!(judgement.causes.get(&cause), Some(&1), "{judgement:?}");
    assert_eq!(judgement.differ(), 1, "{judgement:?}");
    let marks: Vec<usize> = judgement.marks.iter().map(|m| m.0 as usize).collect();
    assert_eq!(
        marks,
        pixel.into_iter().collect::<Vec<_>>(),
        "{judgement:?}"
    );
    assert!(!judgement.described.is_empty());
}

/// A pixel that the light reaches.
fn chosen(frame: &Frame) -> usize {
    let mut lit = frame.direct.lit.iter();
    lit.position(|lit| *lit).expect("one is lit")
}

#[test]
fn surfaces_differ_by_triangle_side_or_distance() {
    let run = run();
    let seen = &frame(&run).seen;
    assert!(passes(&surfaces(seen, &seen.surfaces)));
    let pixel = chosen(frame(&run));
    let with = |change: &dyn Fn(&mut Surface)| {
        let mut other = seen.surfaces.clone();
        change(other[pixel].as_mut().expect("seen"));
        surfaces(seen, &other)
    };
    caught(&with(&|s| s.triangle += 1), Cause::Coverage, Some(pixel));
    caught(&with(&|s| s.side = -s.side), Cause::Coverage, Some(pixel));
    for axis in 0..3 {
        let most = seen.stray[pixel][axis].cast_signed();
        let strayed = with(&|s| s.point[axis] += most);
        assert!(passes(&strayed));
        // A wall's points stray along the wall alone.
        let along = Some(if axis == 0 { 0.0 } else { 1.0 });
        assert_eq!(strayed.error_over_bound, along);
        caught(
            &with(&|s| s.point[axis] += most + 1),
            Cause::Interval,
            Some(pixel),
        );
        caught(
            &with(&|s| s.point[axis] = i32::MIN),
            Cause::Interval,
            Some(pixel),
        );
    }
    let mut other = seen.surfaces.clone();
    other[pixel] = None;
    caught(&surfaces(seen, &other), Cause::Coverage, Some(pixel));
    let short = &seen.surfaces[..seen.surfaces.len() - 1];
    caught(&surfaces(seen, short), Cause::ReferenceMissing, None);
}

#[test]
fn what_is_visible_is_exact() {
    let run = run();
    let seen = &frame(&run).rsm.seen;
    let row = |surface: &Option<Surface>| surface.map_or(NOTHING, |surface| surface.triangle);
    let triangles: Vec<u32> = seen.surfaces.iter().map(row).collect();
    let judged = |keys: &[u32], triangles: &[u32]| visible("texels", seen, keys, triangles);
    let same = judged(&seen.keys, &triangles);
    assert!(passes(&same) && same.compared == 64, "{same:?}");
    let [mut keys, mut rows] = [seen.keys.clone(), triangles.clone()];
    let texel = triangles.iter().position(|row| *row != NOTHING);
    let texel = texel.expect("one sees something");
    keys[texel] -= 1;
    caught(&judged(&keys, &triangles), Cause::DepthKey, None);
    rows[texel] += 1;
    caught(&judged(&seen.keys, &rows), Cause::TieOrder, None);
    caught(&judged(&keys, &rows), Cause::Coverage, None);
    let short = (&seen.keys[1..], &triangles[1..]);
    assert!(judged(&seen.keys, short.1).causes[&Cause::ReferenceMissing] == 1);
    assert!(judged(short.0, &triangles).causes[&Cause::ReferenceMissing] == 1);
}

/// What `f32` may not hold is not judged, and no row that has any of it passes.
#[test]
fn a_colour_without_bound_is_not_judged() {
    let run = run();
    let spec = frame(&run).direct.light.clone();
    let seen = vec![[0.0; 3]; spec.len()];
    let unbounded = |items: usize| {
        let mut spec = spec.clone();
        for colour in &mut spec[..items] {
            colour[1].bound = f64::INFINITY;
        }
        colours("pixels", &spec, &seen, |_| None)
    };
    assert_eq!(unbounded(0).admitted_budget, None);
    let some = unbounded(5);
    assert_eq!((some.admitted, some.admitted_budget), (5, Some(0.0)));
    let all = unbounded(spec.len());
    assert_eq!((all.differ(), all.admitted), (0, all.compared));
    // So it is where one frame of several has some.
    let total = Judgement::sum([unbounded(0), some]);
    assert_eq!((total.admitted, total.admitted_budget), (5, Some(0.0)));
}

#[test]
fn places_are_floors_within_the_bound() {
    let run = run();
    let (frame, light) = (frame(&run), &run.setup.lamp.view);
    let judged = |seen: &[Option<Place>]| places(light, &frame.seen.surfaces, &frame.places, seen);
    let same = judged(&frame.places);
    assert!(passes(&same) && same.admitted == 0);
    let pixel = chosen(frame);
    let with = |change: &dyn Fn(&mut Place)| {
        let mut other = frame.places.clone();
        change(other[pixel].as_mut().expect("placed"));
        judged(&other)
    };
    caught(&with(&|p| p.texel[0] += 1), Cause::Coverage, Some(pixel));
    caught(&with(&|p| p.texel[1] -= 1), Cause::Coverage, Some(pixel));
    caught(
        &with(&|p| p.texel[1] = PLACE_MAX + 1),
        Cause::Coverage,
        Some(pixel),
    );
    // Keys are 2^31 to the depth, of which f32 has 24 bits: some are within, a percent is not.
    let near = with(&|p| p.key += 1);
    assert!(passes(&near) && near.admitted == 0 && near.error == Some(1.0));
    caught(&with(&|p| p.key += 1 << 24), Cause::Coverage, Some(pixel));
    let mut other = frame.places.clone();
    other[pixel] = None;
    caught(&judged(&other), Cause::Coverage, Some(pixel));
    caught(
        &judged(&frame.places[..frame.places.len() - 1]),
        Cause::ReferenceMissing,
        None,
    );
}

/// A point on the border of two texels may lie in either, and is counted.
#[test]
fn a_border_is_a_decision() {
    let run = run();
    let (frame, light) = (frame(&run), &run.setup.lamp.view);
    let surface = frame.seen.surfaces[chosen(frame)].expect("seen");
    // The light looks along x and z = 0 is its middle, the border of columns 3 and 4.
    let point = [surface.point[0], surface.point[1], {
        let lattice = run.setup.lattice;
        lattice.snap([0.0; 3]).expect("inside")[2]
    }];
    let surfaces = [Some(Surface { point, ..surface })];
    let seen = Gbuffer {
        surfaces: surfaces.to_vec(),
        ..frame.seen.clone()
    };
    let spec = place(light, &seen);
    let mut other = spec[0].expect("placed");
    assert!((3..=4).contains(&other.texel[0]), "{other:?}");
    other.texel[0] = 7 - other.texel[0];
    let judged = places(light, &surfaces, &spec, &[Some(other)]);
    assert_eq!((judged.differ(), judged.admitted), (0, 1), "{judged:?}");
    other.texel[0] = 2;
    assert_eq!(places(light, &surfaces, &spec, &[Some(other)]).differ(), 1);
}

#[test]
fn lit_pixels_are_exact() {
    let run = run();
    let spec = &frame(&run).direct.lit;
    assert!(passes(&lit(spec, spec)));
    let pixel = chosen(frame(&run));
    let mut other = spec.clone();
    other[pixel] = false;
    caught(&lit(spec, &other), Cause::Coverage, Some(pixel));
    caught(
        &lit(spec, &spec[..spec.len() - 1]),
        Cause::ReferenceMissing,
        None,
    );
    assert_eq!(
        row_verdict(lit(&[], &[])),
        Verdict::Diverge,
        "nothing compared"
    );
}

#[test]
fn colours_are_within_their_bounds() {
    let run = run();
    let spec = &frame(&run).picture;
    #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
    let seen: Vec<[f32; 3]> = spec.iter().map(|c| c.map(|c| c.value as f32)).collect();
    let judged = |seen: &[[f32; 3]]| colours("pixels", spec, seen, |at| Some(number(at)));
    assert!(passes(&judged(&seen)));
    let pixel = chosen(frame(&run));
    for channel in 0..3 {
        for wrong in [f32::NAN, f32::INFINITY, -1.0, 2.0 * seen[pixel][channel]] {
            let mut other = seen.clone();
            other[pixel][channel] = wrong;
            caught(&judged(&other), Cause::Interval, Some(pixel));
        }
        // Twice the bound, the least that a canary must be caught by.
        let must = spec[pixel][channel];
        let mut other = seen.clone();
        #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
        let off = (must.value + 2.0 * must.bound) as f32;
        other[pixel][channel] = off;
        caught(&judged(&other), Cause::Interval, Some(pixel));
    }
    caught(
        &judged(&seen[..seen.len() - 1]),
        Cause::ReferenceMissing,
        None,
    );
}

#[test]
fn blocked_texels_are_exact() {
    let run = run();
    let spec = &frame(&run).blocked;
    let judged = |bits: &[u32], rays| blocked(spec, (bits, rays), |pixel| number(10 * pixel));
    assert!(passes(&judged(&spec.bits, spec.rays)));
    let word = spec
        .bits
        .iter()
        .position(|word| *word != 0)
        .expect("some are blocked");
    let words = spec.bits.len() / spec.size.pixels();
    let pixel = 10 * (word / words);
    for bits in [0, !spec.bits[word], spec.bits[word] ^ (1 << 31)] {
        let mut other = spec.bits.clone();
        other[word] = bits;
        caught(&judged(&other, spec.rays), Cause::Coverage, Some(pixel));
    }
    caught(&judged(&spec.bits, spec.rays - 1), Cause::Coverage, None);
    caught(
        &judged(&spec.bits[..spec.bits.len() - words], spec.rays),
        Cause::ReferenceMissing,
        None,
    );
}

fn row_verdict(judgement: Judgement) -> Verdict {
    use crate::observe::{Gpu, Observed, Spec};
    let mut rows = crate::replay::rows::Rows::new("rsm/planted", "rsm");
    let a = Observed::<Spec, _>::new("spec", ());
    let b = Observed::<Gpu, _>::new("gpu@test/compute", ());
    rows.add("direct", &a, &b, judgement);
    rows.rows[0].verdict()
}
