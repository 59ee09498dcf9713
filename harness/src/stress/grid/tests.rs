//! Sweeps are what they say, and what is wrong is said.

use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::Path as RasterPath;
use triptych_gpu::wgsl::Sources;
use triptych_spec::grid::axis::Axis;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::trace::trace;
use triptych_spec::grid::{Blockers, Grid, Membership};

use super::*;
use crate::corpus::Entry;
use crate::digest::tests::row;
use crate::replay::gpu::Adapters;
use crate::row::Class;
use crate::scene::load_entry;
use crate::stress::Lines;

const LEG: &str = "gpu@x/compute";

fn step_of(sweep: &str, label: &str) -> (Sweep<GridShot>, Step<GridShot>) {
    let mut all = sweeps().into_iter();
    let sweep = all.find(|s| s.name == sweep).expect("a sweep");
    let step = sweep.steps().into_iter().find(|s| s.label == label);
    (sweep, step.expect("one of them"))
}

/// What came of a step on no leg but Embree, and only if that is asked for.
fn measured_on_cpu(sweep: &str, label: &str, embree: bool) -> Measured {
    let (sweep, step) = step_of(sweep, label);
    let folder = folder(label);
    let options = Options {
        gpu: false,
        embree,
        ..Options::default()
    };
    let measured = Rays::run(&sweep, &step, &folder, &[], &options);
    let _ = std::fs::remove_dir_all(&folder);
    measured.expect("a scene")
}

fn folder(name: &str) -> std::path::PathBuf {
    std::env::temp_dir().join(format!(
        "triptych-stress-grid-{name}-{}",
        std::process::id()
    ))
}

fn measured(rows: Vec<Row>) -> Measured {
    let (sweep, step) = step_of("scale", "1e0");
    let entry = Entry {
        name: "stress-grid/scale/1e0".to_owned(),
        family: FAMILY.to_owned(),
        path: "scene.toml".into(),
    };
    Measured {
        rows,
        ..Measured::new(sweep.name, &step, &entry)
    }
}

/// A row of closest hits of which the largest error is this share of its bound.
fn closest(leg: &str, ratio: f64) -> Row {
    let class = match leg {
        "embree" => Class::Vote,
        _ => Class::Decision,
    };
    Row {
        class,
        unit: "rays".to_owned(),
        compared: 100,
        admitted: 0,
        admitted_budget: None,
        error: Some(1e-7),
        error_over_bound: Some(ratio),
        ..row("stress-grid/scale/1e0", "trace", "spec", leg)
    }
}

fn words(measured: &Measured) -> Vec<String> {
    let wrong = judge(measured, &[LEG.to_owned()]);
    wrong.iter().map(ToString::to_string).collect()
}

#[test]
fn every_sweep_has_a_curve() {
    for sweep in sweeps() {
        let steps = sweep.steps();
        assert!((8..=24).contains(&steps.len()), "{}", sweep.name);
        let mut labels: Vec<&str> = steps.iter().map(|s| s.label.as_str()).collect();
        labels.sort_unstable();
        labels.dedup();
        assert_eq!(labels.len(), steps.len(), "{}: one scene each", sweep.name);
        assert_eq!(steps, sweep.steps(), "{}: drawn alike again", sweep.name);
    }
}

#[test]
fn what_does_not_hold_is_said() {
    assert_eq!(words(&measured(vec![closest(LEG, 0.3)])), [""; 0]);
    let over = words(&measured(vec![closest(LEG, 1.5)]));
    let must = "scale 1e0, stage trace, gpu@x/compute: error over bound is 1.5, must be at most 1";
    assert_eq!(over, [must]);
    let differs = Row {
        differ: 1,
        ..closest(LEG, 0.3)
    };
    let said = words(&measured(vec![differs]));
    assert!(said[0].contains("1 of 100 rays differ"), "{said:?}");
    let silent = words(&measured(vec![closest("embree", 0.1)]));
    assert_eq!(silent.len(), 1, "a leg says nothing");
    let mut far = measured(vec![closest(LEG, 0.3)]);
    far.walks = Walks {
        bound: 9,
        longest: 10,
        ..Walks::default()
    };
    let must = "scale 1e0, stage trace, spec: a ray passes 10 cells, may at most 9";
    assert_eq!(words(&far), [must]);
}

#[test]
fn what_must_be_refused_is_and_nothing_else() {
    let wrong = |must_refuse, refused: Option<&str>| {
        let m = Measured {
            must_refuse,
            refused: refused.map(str::to_owned),
            ..measured(vec![closest(LEG, 0.3)])
        };
        words(&m).len()
    };
    assert_eq!(wrong(None, None), 0);
    assert_eq!(wrong(Some("too many"), Some("9 are too many")), 0);
    assert_eq!(wrong(Some("too many"), Some("something else")), 1);
    assert_eq!(wrong(Some("too many"), None), 1, "it must be");
    assert_eq!(wrong(None, Some("9 are too many")), 1, "it must not be");
    let m = measured_on_cpu("cells", "2^9", true);
    assert_eq!(judge(&m, &[]), []);
    let cells = Table::default().cells(&m);
    assert_eq!(cells.len(), Table::names().len());
    let said = cells.last().expect("a reason");
    assert!(
        said.starts_with("refused: grid.resolution: a grid of 134217728"),
        "{said}"
    );
    let csv = files::csv(&[m]);
    assert!(
        csv.contains("refused: grid.resolution: a grid of 134217728 cells"),
        "{csv}"
    );
}

#[test]
fn a_bound_that_is_nowhere_reached_is_of_no_use() {
    let rows = |gpu, embree| vec![measured(vec![closest(LEG, gpu), closest("embree", embree)])];
    assert_eq!(useless(&rows(0.001, 0.5)), []);
    let found = useless(&rows(0.0009, 0.0));
    let stages: Vec<&str> = found.iter().map(|w| w.stage.as_str()).collect();
    assert_eq!(stages, ["gpu", "embree"]);
}

/// The generator knows where the cells will lie: a unit is a step of the lattice.
#[test]
fn aligned_triangles_lie_on_boundaries() {
    for (label, off) in [("0", 0), ("7", 7)] {
        let (_, step) = step_of("aligned", label);
        let folder = folder(&format!("aligned-{label}"));
        let path = step.shot.write(&folder).expect("the folder is writable");
        let entry = Entry {
            name: "aligned".to_owned(),
            family: FAMILY.to_owned(),
            path,
        };
        let loaded = load_entry(&entry, None).expect("a scene");
        let _ = std::fs::remove_dir_all(&folder);
        let run = GridRun::new(&loaded).expect("a grid");
        assert_eq!(run.lattice.exponent, 0);
        assert_eq!(run.lattice.centre, [0.0; 3]);
        let axis = Axis::around(-sweeps::HALF, sweeps::HALF, 8);
        assert_eq!(run.grid.axes, [(); 3].map(|()| axis.clone()));
        // All corners of every third are a cell's, but for those steps; the outermost
        // boundaries lie beyond every triangle.
        let on = |c: i32| {
            let mut boundaries = axis.boundaries().iter();
            boundaries.any(|b| (b - c).abs() == off) || c.abs() == sweeps::HALF
        };
        for prim in (0..120).step_by(3) {
            let corners = run.blockers.corners(prim);
            assert!(corners.as_flattened().iter().all(|c| on(*c)), "{corners:?}");
            assert_ne!(corners[0], corners[1], "not without length");
        }
    }
}

/// A row of 16 cells of which the first and the last list something: an empty brick is a
/// step.
#[test]
fn empty_bricks_are_one_step() {
    let far = 6000;
    let corners = [[far, -9, -9], [far, 9, -9], [far, 0, 9]];
    let blockers = Blockers {
        vertices: [corners, corners.map(|[x, y, z]| [-x, y, z])].concat(),
        triangles: vec![[0, 1, 2], [3, 4, 5]],
    };
    let grid = Grid::build(&blockers, Resolution::Given([16, 1, 1]), Membership::Box);
    let grid = grid.expect("a row");
    let ray = Ray::between([-7000, 0, 0], [7000, 0, 0]);
    let answers = trace(&grid, &blockers, &[ray]);
    assert_eq!(
        answers[0].map(|first| first.prim),
        Some(1),
        "the nearer one"
    );
    let first = Walks::of(&grid, &[ray], &answers);
    assert_eq!((first.bound, first.longest), (16, 16));
    assert_eq!((first.cells, first.steps), (1, 1), "the first cell has it");
    let none = Walks::of(&grid, &[ray], &[None]);
    // Four in the first brick, two bricks in one step each, four in the last.
    assert_eq!((none.cells, none.steps), (16, 10));
    assert!((none.saved() - 6.0 / 16.0).abs() < 1e-12, "six of sixteen");
}

#[test]
fn the_page_tells_legs_apart() {
    let mut edge = closest("embree", 0.5);
    edge.admitted = 25;
    let of_spec = Row {
        error_over_bound: None,
        ..closest(EVERY, 0.0)
    };
    let all = [measured(vec![of_spec, closest(LEG, 0.25), edge])];
    let page = files::legs(&all);
    for must in [
        "| spec | 100 | 0 | – | – | – | – |",
        "| gpu@x/compute | 100 | 0 | 0.2500 | scale 1e0 | 1.000e-7 | – |",
        "| embree | 100 | 0 | 0.5000 | scale 1e0 | 1.000e-7 | 25.0 % |",
    ] {
        assert!(page.contains(must), "{page} lacks {must}");
    }
}

/// A kernel that decides in `f32` alone, on rays nearer than that can tell: the step does not
/// hold.
#[test]
fn a_defect_of_a_kernel_is_wrong() {
    let (sweep, step) = step_of("near", "2^-26");
    let folder = folder("defect");
    let Adapters { mut open, .. } = Adapters::open(&[]);
    assert!(!open.is_empty(), "no adapter: `./x setup` installs two");
    open.truncate(1);
    let options = Options {
        paths: vec![RasterPath::Compute],
        ..Options::default()
    };
    let legs = [
        format!("gpu@{}/compute", open[0].gpu.name),
        "embree".to_owned(),
        EVERY.to_owned(),
    ];
    let sound = Rays::run(&sweep, &step, &folder, &open, &options).expect("the step is sound");
    assert_eq!(judge(&sound, &legs), []);
    assert_eq!(
        sound.rays, 888,
        "six kinds of 20, and 12 times 64 of its own"
    );
    let error = "VOLUME_ERROR: f32 = 12.0 / 8388608.0;";
    let patched = Sources::shipped(false).patched("volume", error, "VOLUME_ERROR: f32 = 0.0;");
    open[0].kernels = Kernels::new(patched.expect("the kernel has this text"));
    let broken = Rays::run(&sweep, &step, &folder, &open, &options).expect("it runs");
    let _ = std::fs::remove_dir_all(&folder);
    let wrong = judge(&broken, &legs);
    let first = wrong.first().expect("the defect is seen").to_string();
    assert!(
        first.starts_with("near 2^-26, stage trace, gpu@"),
        "{first}"
    );
}

/// Without triangles the plan skips all, and running all the same agrees.
#[test]
fn what_the_plan_saves_is_told() {
    let m = measured_on_cpu("sparse", "0", true);
    assert_eq!(judge(&m, &["embree".to_owned(), EVERY.to_owned()]), []);
    let saved = m.saved().expect("something is skipped");
    assert_eq!(saved.passes, 1, "Embree's vote");
    assert!(saved.ms > 0.0, "it takes time");
    let mut table = Table::default();
    table.cells(&m);
    let notes = table.notes();
    assert_eq!(notes.len(), 2, "{notes:?}");
    assert!(notes[0].contains("plan: nothing blocks a ray"), "{notes:?}");
    let one = measured_on_cpu("sparse", "1", true);
    assert_eq!(one.saved(), None, "what runs is not saved");
    assert!(one.walks.saved() > 0.5, "most bricks are empty");
}
