//! Sweeps are what they say, and what is wrong is said.

use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::Path;
use triptych_gpu::wgsl::Sources;

use super::*;
use crate::corpus::Entry;
use crate::digest::tests::row;
use crate::replay::gpu::Adapters;
use crate::row::{Class, Row};

/// A row of a stage with a bound, of which the largest error is this share.
fn interval(stage: &str, ratio: f64) -> Row {
    Row {
        class: Class::Interval,
        compared: 100,
        admitted: 0,
        admitted_budget: Some(0.01),
        error_over_bound: Some(ratio),
        ..row("stress/scale/2^0", stage, "spec", "gpu@x/compute")
    }
}

/// Embree's rows in screen and in world space, of which the largest errors are these.
fn votes(ratios: [f64; 2]) -> [Row; 2] {
    let stages = ["cover", "world"].into_iter().zip(ratios);
    let mut rows = stages.map(|(stage, ratio)| Row {
        class: Class::Vote,
        b: "embree".to_owned(),
        admitted_budget: None,
        ..interval(stage, ratio)
    });
    [(); 2].map(|()| rows.next().expect("two rows"))
}

fn measured(rows: Vec<Row>) -> Measured {
    let scale = sweeps().swap_remove(0);
    let entry = Entry {
        name: "stress/scale/2^0".to_owned(),
        family: FAMILY.to_owned(),
        path: "scene.toml".into(),
    };
    let step = scale.steps().swap_remove(0);
    Measured::new(scale.name, &step, &entry, rows, Numbers::default())
}

fn words(rows: Vec<Row>) -> Vec<String> {
    let wrong = judge(&measured(rows), &["gpu@x/compute".to_owned()]);
    wrong.iter().map(ToString::to_string).collect()
}

#[test]
fn every_sweep_has_a_curve() {
    for sweep in sweeps() {
        let steps = sweep.steps();
        assert!((8..=20).contains(&steps.len()), "{}", sweep.name);
        let mut labels: Vec<&str> = steps.iter().map(|s| s.label.as_str()).collect();
        labels.sort_unstable();
        labels.dedup();
        assert_eq!(labels.len(), steps.len(), "{}: one scene each", sweep.name);
        for step in steps {
            assert_eq!(step, sweep_step(&sweep, &step.label), "drawn alike again");
        }
    }
}

fn sweep_step(sweep: &Sweep, label: &str) -> Step {
    let mut steps = sweep.steps().into_iter();
    steps.find(|s| s.label == label).expect("one of them")
}

#[test]
fn what_is_no_sweep_is_named() {
    let one = select(sweeps(), &["lay".to_owned()]).expect("a part of a name");
    assert_eq!(one.iter().map(|s| s.name).collect::<Vec<_>>(), ["layers"]);
    let error = select(sweeps(), &["no-such".to_owned()]).err();
    let must = "no-such: no sweep is called so; there are: scale, offset, sliver, depth, edge-on, \
                layers";
    assert_eq!(error.as_deref(), Some(must));
}

#[test]
fn an_error_over_its_bound_is_wrong() {
    assert_eq!(words(vec![interval("clip", 0.3)]), [""; 0]);
    // The same error against a quarter of the bound.
    let must =
        "scale 2^-148, stage clip, gpu@x/compute: error over bound is 1.2, must be at most 1";
    assert_eq!(words(vec![interval("clip", 4.0 * 0.3)]), [must]);
    assert_eq!(words(vec![interval("clip", f64::NAN)]).len(), 1);
}

#[test]
fn what_differs_or_goes_unjudged_or_is_not_said_is_wrong() {
    let sound = interval("snap", 0.5);
    let differs = Row {
        differ: 3,
        ..sound.clone()
    };
    let silent = Row {
        compared: 0,
        ..sound.clone()
    };
    let over = Row {
        admitted: 2,
        ..sound.clone()
    };
    for (bad, part) in [
        (differs, "3 of 100"),
        (silent, "nothing was compared"),
        (over, "share unjudged is 0.02, at most 0.01"),
    ] {
        let said = words(vec![sound.clone(), bad]);
        assert_eq!(said.len(), 1, "{said:?}");
        assert!(said[0].contains(part), "{said:?}");
    }
    let of_another = Row {
        b: "embree".to_owned(),
        ..sound.clone()
    };
    assert_eq!(words(vec![of_another]).len(), 1, "a leg says nothing");
    // Whatever a step allows to go unjudged is skipped, with a reason.
    let all = Row {
        admitted: 100,
        admitted_budget: Some(1.0),
        ..sound
    };
    let measured = measured(vec![all]);
    assert_eq!(
        measured.rows[0].skipped.as_deref(),
        Some("all 100 fragments unjudged")
    );
    assert_eq!(measured.worst(Bound::Snap), None, "it has no error");
}

#[test]
fn a_bound_that_is_nowhere_reached_is_of_no_use() {
    let rows = |ratio| {
        let stages = ["transform", "clip", "snap", "resolve"];
        stages.map(|stage| interval(stage, ratio)).to_vec()
    };
    let with = |mut rows: Vec<Row>| {
        rows.extend(votes([0.5, 0.5]));
        useless(&[measured(rows)])
    };
    assert_eq!(with(rows(0.001)), []);
    let four = with(rows(0.0009));
    let stages: Vec<&str> = four.iter().map(|w| w.stage.as_str()).collect();
    assert_eq!(stages, ["transform", "clip", "snap", "resolve"]);
}

/// The second vote is worse, and neither hides the other.
#[test]
fn both_votes_are_shown() {
    let [mut screen, mut world] = votes([0.25, 0.5]);
    (screen.admitted, world.admitted) = (1, 20);
    let mut larger = world.clone();
    larger.error_over_bound = Some(0.75);
    let steps = [
        measured(vec![screen.clone(), world.clone()]),
        measured(vec![screen, world, larger]),
    ];
    let edge = |stage| steps[0].edge(stage);
    assert_eq!(edge(Bound::Embree), Some(0.01));
    assert_eq!(edge(Bound::World), Some(0.2));
    let page = files::largest(&steps);
    let rows: Vec<&str> = page.lines().filter(|l| l.contains("embree")).collect();
    assert_eq!(
        rows,
        [
            "| embree | embree | 0.2500 | scale 2^-148 |  |",
            "| world | embree | 0.7500 | scale 2^-148 |  |"
        ]
    );
    let names = Table::names();
    let cells = Table::default().cells(&steps[1]);
    let cell = |name: &str| {
        let at = names.iter().position(|n| *n == name);
        cells[at.expect("a column")].as_str()
    };
    let shown = ["embree", "world", "worst", "edge", "world edge", "unjudged"].map(cell);
    assert_eq!(
        shown,
        ["0.2500", "0.7500", "world", "1.00 %", "20.0 %", "0 %"]
    );
    let csv = files::csv(&steps[..1]);
    for part in [",cover,spec,embree,vote,", ",world,spec,embree,vote,"] {
        assert_eq!(csv.matches(part).count(), 1, "{csv}");
    }
    for part in [",0.01,,", ",0.2,,"] {
        assert_eq!(csv.matches(part).count(), 1, "share of each: {csv}");
    }
    // A leg's name may hold what ends a cell.
    let mut marked = measured(votes([0.5, 0.5]).to_vec());
    marked.rows[0].b = "a|b".to_owned();
    assert!(files::largest(&[marked]).contains("| a\\|b |"));
    // What was not asked for has no share.
    let mut silent = votes([0.5, 0.5]).to_vec();
    silent[1].skipped = Some("plan: no triangles".to_owned());
    assert_eq!(measured(silent).edge(Bound::World), None);
}

/// A kernel with a defect, on the smallest step: the step does not hold.
#[test]
fn a_defect_of_a_kernel_is_wrong() {
    let scale = sweeps().swap_remove(0);
    let step = sweep_step(&scale, "2^0");
    let folder = std::env::temp_dir().join(format!("triptych-stress-{}", std::process::id()));
    let Adapters { mut open, .. } = Adapters::open(&[]);
    assert!(!open.is_empty(), "no adapter: `./x setup` installs two");
    open.truncate(1);
    let options = Options {
        paths: vec![Path::Compute],
        ..Options::default()
    };
    let legs = [
        format!("gpu@{}/compute", open[0].gpu.name),
        "embree".to_owned(),
    ];
    let sound = Frame::run(&scale, &step, &folder, &open, &options).expect("the step is sound");
    assert_eq!(judge(&sound, &legs), []);
    let patched = Sources::shipped(false).patched("vertex", "+ row.w;", "+ row.w * 1.00001;");
    open[0].kernels = Kernels::new(patched.expect("the kernel has this text"));
    let broken = Frame::run(&scale, &step, &folder, &open, &options).expect("it runs");
    let _ = std::fs::remove_dir_all(&folder);
    let wrong = judge(&broken, &legs);
    let first = wrong.first().expect("the defect is seen").to_string();
    assert!(
        first.starts_with("scale 2^0, stage transform, gpu@"),
        "{first}"
    );
}
