use super::super::{STAGES, skeleton};
use super::*;

fn stage(name: &str) -> &'static Stage {
    Stage::named(name).expect("a stage")
}

/// The messages about a text, with lines.
fn mistakes(name: &str, text: &str) -> Vec<String> {
    let errors = Foreign::new(stage(name), "mine.wgsl", text).expect_err("a mistake");
    errors.iter().map(WgslError::to_string).collect()
}

/// The skeleton of `build` with one thing changed.
fn changed(from: &str, to: &str) -> String {
    let text = skeleton(stage("build")).expect("ours");
    // Variables count where they are used.
    let text = text.replace(
        "        return;\n    }\n}",
        "        return;\n    }\n    nodes[faces_of(id.x)].next = atomicLoad(&heads[0]);\n}",
    );
    let text = format!("{text}\nfn faces_of(i: u32) -> u32 {{ return u32(faces[i].x); }}\n");
    assert!(text.contains(from), "{from} is in\n{text}");
    text.replace(from, to)
}

#[test]
fn every_skeleton_is_a_kernel() {
    for stage in &STAGES {
        let text = skeleton(stage).expect("ours");
        let foreign = Foreign::new(stage, "mine.wgsl", &text);
        let foreign = foreign.unwrap_or_else(|e| panic!("{}: {e:?}\n{text}", stage.name));
        assert!(
            foreign.serves(false) && foreign.serves(true),
            "{}",
            stage.name
        );
        let block = match stage.file {
            "dispatch" => "task: Task",
            "grid" => "cells: Cells",
            "rsm" => "parameters: Parameters",
            "ldm" => "told: Told",
            _ => "frame: Frame",
        };
        let block = format!("@binding(0) var<uniform> {block}");
        assert!(text.contains(&block), "{text}");
    }
}

/// An entry point is told what ours is; where a workgroup works together, none of it leaves.
#[test]
fn skeletons_are_told_what_our_kernels_are() {
    let function = |stage_name: &str, entry: &str| {
        let text = skeleton(stage(stage_name)).expect("ours");
        let from = text.find(&format!("fn {entry}(")).expect("an entry point");
        text[from..].split("\n}").next().unwrap_or("").to_owned()
    };
    let scan = function("scan", "scan");
    let group =
        "@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32";
    assert!(scan.contains(group) && !scan.contains("return"), "{scan}");
    let chunks = function("count", "count_chunks");
    assert!(
        chunks.contains(group.split(',').next().unwrap_or("")),
        "{chunks}"
    );
    let count = function("count", "count");
    assert!(count.contains("if i >= cells.items"), "{count}");
}

#[test]
fn our_own_files_are_kernels() {
    for stage in &STAGES {
        let text = format!("//#import {}\n", stage.file);
        Foreign::new(stage, "mine.wgsl", &text).expect("ours");
    }
}

#[test]
fn words_in_memory_count_names_do_not() {
    let renamed = changed("struct Node {", "struct Thing {").replace("array<Node>", "array<Thing>");
    Foreign::new(stage("build"), "mine.wgsl", &renamed).expect("another name");
    let words = changed("array<Node>", "array<u32>").replace(".next", "");
    Foreign::new(stage("build"), "mine.wgsl", &words).expect("the same words");
    let short = changed("    mask: u32,\n", "    mask: u32,\n    more: u32,\n");
    let [message] = &mistakes("build", &short)[..] else {
        panic!("one mistake");
    };
    assert!(message.starts_with("mine.wgsl:"), "{message}");
    assert!(
        message.contains("nodes: array<Node> lies otherwise in memory"),
        "{message}"
    );
    let float = changed("key: u32", "key: f32");
    assert!(
        mistakes("build", &float)[0].contains("lies otherwise"),
        "another kind"
    );
}

#[test]
fn what_differs_is_named() {
    let neither = changed("fn build(", "fn built(").replace("build_fragment", "built_fragment");
    let cases = [
        (
            neither,
            "stage build needs an entry point build or build_fragment",
        ),
        (
            changed("@workgroup_size(64)", "@workgroup_size(32)"),
            "not [64, 1, 1]",
        ),
        (
            changed("@binding(8)", "@binding(11)"),
            "binding 11 is none of build's: @binding(0)",
        ),
        (
            changed("var<storage, read> faces", "var<storage, read_write> faces"),
            "is written",
        ),
        (changed("@location(0)", "@location(3)"), "reads location 3"),
        (
            changed("@group(0) @binding(8)", "@group(1) @binding(8)"),
            "is none of build's",
        ),
    ];
    for (text, part) in cases {
        let all = mistakes("build", &text);
        assert!(
            all.iter().any(|m| m.contains(part)),
            "{part} is not in {all:#?}"
        );
    }
    let half = "@compute @workgroup_size(64) fn opaque_first() {}";
    assert_eq!(
        mistakes("opaque", half),
        ["mine.wgsl:1: entry point opaque_nearest is missing"]
    );
    let broken = mistakes("build", "fn build() {\n    let x = 1 +;\n}\n");
    assert!(broken[0].starts_with("mine.wgsl:2: "), "{broken:?}");
}

#[test]
fn a_path_without_kernels_is_not_served() {
    let only = "@compute @workgroup_size(64) fn build() {}";
    let foreign = Foreign::new(stage("build"), "mine.wgsl", only).expect("a kernel");
    assert!(
        foreign.serves(false) && !foreign.serves(true),
        "compute only"
    );
    let sort = "@compute @workgroup_size(64) fn sort() {}";
    let foreign = Foreign::new(stage("sort"), "mine.wgsl", sort).expect("a kernel");
    assert!(foreign.serves(true), "sort needs no rasteriser");
}
