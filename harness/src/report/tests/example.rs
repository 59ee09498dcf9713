//! A report to look at in tests.

use triptych_spec::scene::Size;

use crate::cause::Cause;
use crate::digest::tests::row;
use crate::picture;
use crate::replay::worst::{Worst, WorstPixel};
use crate::report::{Difference, Picture, PlanLine, ReportInput, RunInfo, SceneReport};
use crate::row::Row;
use crate::sheet::Sheet;

const SIZE: Size = Size {
    width: 2,
    height: 1,
};

/// A run of one scene that diverges, and one that agrees.
pub fn input() -> ReportInput {
    let bad = Row {
        differ: 3,
        unexplained: 1,
        causes: [(Cause::LostNode, 2)].into(),
        ms_a: Some(1.5),
        again: "cargo triptych replay --exact --seed 7 abuffer/bad".to_owned(),
        ..row("abuffer/bad", "build", "spec", "gpu@x/compute")
    };
    let bad = SceneReport {
        name: "abuffer/bad".to_owned(),
        purpose: "shows something".to_owned(),
        rows: vec![bad],
        size: Some(SIZE),
        sheets: vec![sheet("spec", ""), sheet("gpu@x/compute", "spec")],
        worst: Worst {
            pixels: vec![WorstPixel {
                at: [1, 0],
                causes: [(Cause::LostNode, 2)].into(),
                seen_by: vec![("build".to_owned(), "gpu@x/compute".to_owned())],
                error: Some(0.25),
            }],
            all: 9,
        },
        left_out: vec!["something is left out".to_owned()],
        pictures: pictures(),
        plan: vec![PlanLine {
            pass: "opaque".to_owned(),
            runs: false,
            reason: "no opaque triangles".to_owned(),
            saved_ms: Some(12.5),
        }],
        differences: vec![Difference {
            words: "lost-node: pixel (0, 0)\nsecond line".to_owned(),
            sides: vec![("spec".to_owned(), vec!["key 7".to_owned()])],
        }],
    };
    let good = SceneReport {
        name: "abuffer/good".to_owned(),
        rows: vec![row("abuffer/good", "build", "spec", "embree")],
        ..SceneReport::default()
    };
    ReportInput {
        run: RunInfo {
            command: "./x replay".to_owned(),
            seconds: 61.0,
            ..RunInfo::default()
        },
        scenes: vec![bad, good],
        mutants: vec![crate::report::mutants::tests::example()],
        bench: Some(crate::report::bench::tests::example()),
    }
}

/// A leg's sheet; nobody reads its bytes.
fn sheet(leg: &str, against: &str) -> Sheet {
    Sheet {
        leg: leg.to_owned(),
        against: against.to_owned(),
        bits: 8,
        stride: 4,
        held: 1,
        left_out: 1234,
        data: vec![1, 2, 3],
        ..Sheet::default()
    }
}

/// Three GPU legs, two of which show the same, and two maps, not in order.
fn pictures() -> Vec<Picture> {
    let colours = |c| picture::linear(SIZE, &[[c; 3], [0.5; 3]]);
    let shown = |title: &str, image| Picture {
        title: title.to_owned(),
        caption: "what is seen".to_owned(),
        image,
    };
    let marks = [(0, Some(Cause::LostNode)), (1, None)];
    vec![
        shown("causes", picture::causes(SIZE, None, marks)),
        shown("embree", picture::counts(SIZE, &[0, 9])),
        shown("spec", colours(0.25)),
        shown("gpu@x/compute", colours(0.25)),
        shown("gpu@y/compute", colours(0.25)),
        shown("gpu@z/compute", colours(0.75)),
    ]
}
