//! Planted defects of the kernels, each found as what it is.

use super::scenes::floor;
use super::*;
use crate::cause::Cause;

pub fn patched(find: &str, replace: &str) -> Sources {
    let shipped = Sources::shipped(false);
    shipped
        .patched("vertex", find, replace)
        .expect("the kernel has this text")
}

/// Defects in `clip` and `snap`, which positions do not show.
pub const DEFECTS: [(&str, &str, &str); 9] = [
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

/// Defects in `transform`.
pub const TRANSFORM: [(&str, &str, &str); 3] = [
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

/// Whose defect it is.
fn stage_of(what: &str) -> &'static str {
    match what {
        "rounding down" | "24-bit depth" => "snap",
        _ if TRANSFORM.iter().any(|(name, ..)| *name == what) => "transform",
        _ => "clip",
    }
}

#[test]
fn a_defect_is_charged_to_its_stage_alone() {
    for gpu in devices() {
        for (what, find, replace) in DEFECTS.into_iter().chain(TRANSFORM) {
            let mut found = 0;
            for (name, scene) in random().iter().take(3) {
                let run = run_with(&gpu, patched(find, replace), scene);
                let stages = Judged::new(scene, &run);
                let diverging = stages.diverging();
                let at = format!("{what}, {name} on {}", gpu.name);
                assert!(
                    diverging.iter().all(|d| *d == stage_of(what)),
                    "{at}: {diverging:?}: {:?} {:?}",
                    stages.clip.told,
                    stages.snap.told
                );
                let judgements = [
                    stages.transform.judgement(),
                    stages.clip.judgement(),
                    stages.snap.judgement(),
                ];
                let causes = judgements.iter().flat_map(|j| j.causes.keys());
                assert!(causes.into_iter().all(|c| *c == Cause::Vertex), "{at}");
                found += diverging.len();
            }
            assert!(found > 0, "{what} survives on {}", gpu.name);
        }
    }
}

/// Where neighbours compute their common point from different ends, every corner
/// stays inside its bound, and yet they no longer meet.
#[test]
fn an_order_that_depends_on_the_triangle_tears_neighbours_apart() {
    let scene = floor();
    for gpu in devices() {
        let sound = run_with(&gpu, Sources::shipped(false), &scene);
        let sound = Judged::new(&scene, &sound);
        assert!(sound.diverging().is_empty(), "{:?}", sound.clip.told);
        let torn = run_with(&gpu, patched("if precedes(a, b) {", "if true {"), &scene);
        let torn = Judged::new(&scene, &torn);
        println!("{}: {}", gpu.name, torn.clip);
        assert_eq!(torn.clip.outside, 0, "inside: {:?}", torn.clip.told);
        assert!(torn.clip.cracks > 0, "survives on {}", gpu.name);
        assert_eq!(torn.diverging(), ["clip"], "{:?}", torn.snap.told);
    }
}

/// A rounding that depends on the triangle is inside, too, and tears what `clip` left
/// equal to the bit.
#[test]
fn a_rounding_that_depends_on_the_triangle_tears_neighbours_apart() {
    let scene = floor();
    for gpu in devices() {
        let torn = patched(
            "snapped[at + 2u] = depth_key(p.z / p.w);",
            "snapped[at + 2u] = depth_key(p.z / p.w) ^ select(0, i32(t & 1u), p.z > 0.01 * p.w);",
        );
        let torn = Judged::new(&scene, &run_with(&gpu, torn, &scene));
        println!("{}: {}", gpu.name, torn.snap);
        assert_eq!(torn.snap.outside, 0, "inside: {:?}", torn.snap.told);
        assert!(torn.snap.cracks > 0, "survives on {}", gpu.name);
        assert_eq!(torn.diverging(), ["snap"], "{:?}", torn.clip.told);
    }
}
