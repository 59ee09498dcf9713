//! Planted defects of the kernels, each found as what it is.

use super::scenes::floor;
use super::*;
use crate::cause::Cause;

fn patched(find: &str, replace: &str) -> Sources {
    let shipped = Sources::shipped(false);
    shipped
        .patched("vertex", find, replace)
        .expect("the kernel has this text")
}

/// Defects in `clip` and `snap`, which positions do not show.
const DEFECTS: [(&str, &str, &str); 9] = [
    (
        "rounding down",
        "round(pixels * f32(1u << frame.bits))",
        "floor(pixels * f32(1u << frame.bits))",
    ),
    (
        "near plane skipped",
        "case 0u: { return p.z; }",
        "case 0u: { return p.w; }",
    ),
    (
        "far plane skipped",
        "case 1u: { return p.w - p.z; }",
        "case 1u: { return p.w; }",
    ),
    (
        "depth of OpenGL",
        "case 0u: { return p.z; }",
        "case 0u: { return p.w + p.z; }",
    ),
    (
        "guard half as wide",
        "f32(frame.guard_x + GUARD) * p.w",
        "f32(frame.guard_x + GUARD / 2) * p.w",
    ),
    (
        "planes of x and y swapped",
        "case 4u: { return p.y",
        "case 4u: { return p.x",
    ),
    (
        "cut at the middle",
        "clamp(da / select(1.0, apart, defined), 0.0, 1.0)",
        "0.5",
    ),
    (
        "24-bit depth",
        "i32(max(depth, 0.0) * DEPTH_SCALE)",
        "i32(max(depth, 0.0) * 16777215.0) << 7u",
    ),
    (
        "corner lost",
        "if da >= 0.0 {\n            push(&kept, a);",
        "if da >= 0.0 && kept.count < 4u {\n            push(&kept, a);",
    ),
];

#[test]
fn defects_of_clip_and_snap_are_outside() {
    for gpu in devices() {
        for (what, find, replace) in DEFECTS {
            let mut differing = 0;
            for (_, scene) in random().iter().take(3) {
                let run = run_with(&gpu, patched(find, replace), scene);
                let transform = compare_transform(scene, &run.positions);
                assert_eq!(transform.outside, 0, "{what}: transform is not to blame");
                let own = exact_positions(&run.positions);
                let report = compare_from(scene, &own, BITS, &run.primitives);
                differing += report.differing;
                let judgement = compare(scene, BITS, &run.primitives).judgement();
                let causes: Vec<Cause> = judgement.causes.keys().copied().collect();
                assert!(
                    causes.iter().all(|&c| c == Cause::Vertex),
                    "{what}: {causes:?}"
                );
            }
            assert!(differing > 0, "{what} survives on {}", gpu.name);
        }
    }
}

#[test]
fn defects_of_transform_are_outside() {
    let rows = [
        (
            "rows swapped",
            "row_times(matrices[m], v)",
            "row_times(matrices[m + 1u], v)",
        ),
        ("translation lost", "row.z * v.z + row.w", "row.z * v.z"),
        (
            "16 bits of mantissa",
            "row.x * v.x +",
            "bitcast<f32>(bitcast<u32>(row.x * v.x) & 0xffffff80u) +",
        ),
    ];
    for gpu in devices() {
        for (what, find, replace) in rows {
            let (_, scene) = random().swap_remove(1);
            let run = run_with(&gpu, patched(find, replace), &scene);
            let transform = compare_transform(&scene, &run.positions);
            assert!(transform.outside > 0, "{what} survives on {}", gpu.name);
            let causes = transform.judgement().causes;
            assert_eq!(
                causes,
                [(Cause::Vertex, transform.outside)].into(),
                "{what}"
            );
            assert!(
                !compare(&scene, BITS, &run.primitives).agrees(),
                "{what}, end to end"
            );
            // The stages that follow did their work on what they were given.
            let own = exact_positions(&run.positions);
            let later = compare_from(&scene, &own, BITS, &run.primitives);
            assert!(
                later.agrees(),
                "{what}: clip and snap are not to blame: {:?}",
                later.told
            );
        }
    }
}

/// Where neighbours compute their common point from different ends, every corner
/// stays inside its bound, and yet they no longer meet.
#[test]
fn an_order_that_depends_on_the_triangle_tears_neighbours_apart() {
    let scene = floor();
    let spec = compare(&scene, BITS, &vertex::primitives(&scene, BITS));
    assert!(spec.agrees(), "{:?}", spec.told);
    for gpu in devices() {
        let sound = run_with(&gpu, Sources::shipped(false), &scene);
        let sound = compare(&scene, BITS, &sound.primitives);
        assert!(sound.agrees(), "{}: {:?}", gpu.name, sound.told);
        let torn = patched("if precedes(a, b) {", "if true {");
        let torn = run_with(&gpu, torn, &scene);
        let torn = compare(&scene, BITS, &torn.primitives);
        println!("{}: {torn}", gpu.name);
        assert_eq!(torn.outside, 0, "every corner is inside: {:?}", torn.told);
        assert!(
            torn.cracks > 0 && !torn.agrees(),
            "survives on {}",
            gpu.name
        );
    }
}
