//! Sweeps are what they say, and what is wrong is said.

use super::*;
use crate::corpus::Entry;
use crate::digest::tests::row;
use crate::row::{Class, Row};
use crate::scene::{LoadError, load_entry};
use crate::stress::Lines;

const LEG: &str = "gpu@x/compute";

fn step_of(sweep: &str, label: &str) -> (Sweep<LdmShot>, Step<LdmShot>) {
    let mut all = sweeps().into_iter();
    let sweep = all.find(|s| s.name == sweep).expect("a sweep");
    let step = sweep.steps().into_iter().find(|s| s.label == label);
    (sweep, step.expect("one of them"))
}

fn folder(name: &str) -> std::path::PathBuf {
    std::env::temp_dir().join(format!("triptych-stress-ldm-{name}-{}", std::process::id()))
}

/// A step's scene, as a run has it.
fn loaded(sweep: &str, label: &str) -> Result<crate::scene::Loaded, LoadError> {
    let (_, step) = step_of(sweep, label);
    let folder = folder(&format!("{sweep}-{label}"));
    let path = step.shot.write(&folder).expect("the folder is writable");
    let entry = Entry {
        name: "stress-ldm".to_owned(),
        family: FAMILY.to_owned(),
        path,
    };
    let loaded = load_entry(&entry, None);
    let _ = std::fs::remove_dir_all(&folder);
    loaded
}

/// What came of a step on no leg but Embree.
fn measured_on_cpu(sweep: &str, label: &str) -> Measured {
    let (sweep, step) = step_of(sweep, label);
    let folder = folder(&format!("cpu-{label}"));
    let options = Options {
        gpu: false,
        ..Options::default()
    };
    let measured = Maps::run(&sweep, &step, &folder, &[], &options);
    let _ = std::fs::remove_dir_all(&folder);
    measured.expect("a scene")
}

/// A row of a kernel's sums of which the largest error is this share of its bound.
fn sums(leg: &str, ratio: f64) -> Row {
    Row {
        class: Class::Interval,
        compared: 100,
        error: Some(1e-3),
        error_over_bound: Some(ratio),
        ..row("stress-ldm/layers/2^0", "occlusion", "spec", leg)
    }
}

/// One of which all holds, of a form.
fn sound(form: Form) -> Measured {
    let (sweep, step) = step_of("layers", "2^0");
    let entry = Entry {
        name: "stress-ldm/layers/2^0".to_owned(),
        family: FAMILY.to_owned(),
        path: "scene.toml".into(),
    };
    Measured {
        form,
        rows: vec![sums(LEG, 0.3)],
        counts: [10, 4, 100],
        ..Measured::new(sweep.name, &step, &entry)
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
        assert!((4..=16).contains(&steps.len()), "{}", sweep.name);
        let mut labels: Vec<&str> = steps.iter().map(|s| s.label.as_str()).collect();
        labels.sort_unstable();
        labels.dedup();
        assert_eq!(labels.len(), steps.len(), "{}: one scene each", sweep.name);
        assert_eq!(steps, sweep.steps(), "{}: drawn alike again", sweep.name);
        for step in steps {
            let (refused, label) = (step.shot.refused, &step.label);
            match (loaded(sweep.name, label), refused) {
                (Ok(loaded), None) => assert!(loaded.file.ldm.is_some(), "{label}"),
                (Err(LoadError::Input(error)), Some(part)) => {
                    assert!(error.message.contains(part), "{label}: {error}");
                }
                (loaded, _) => panic!("{} {label}: {:?}", sweep.name, loaded.err()),
            }
        }
    }
}

/// Each thing that must hold, made not to.
#[test]
fn what_does_not_hold_is_said() {
    type Plant = fn(&mut Measured);
    let cases: [(Form, Plant, &str); 11] = [
        (
            Form::Any,
            |m| m.rows = vec![sums(LEG, 1.5)],
            "error over bound is 1.5",
        ),
        (
            Form::Any,
            |m| m.rows[0].differ = 1,
            "1 of 100 fragments differ",
        ),
        (
            Form::Any,
            |m| m.rows = vec![sums("embree", 0.1)],
            "not a word of it",
        ),
        (Form::Any, |m| m.counts[0] = 0, "nobody asks"),
        (
            Form::Any,
            |m| m.found.wrong = 2,
            "2 of 0 sides are not as the file has them",
        ),
        (
            Form::Any,
            |m| (m.found.sides, m.found.key) = (1, 1.01),
            "error over bound of the key is 1.01",
        ),
        (
            Form::Any,
            |m| (m.found.sides, m.found.distance) = (1, f64::NAN),
            "error over bound of the distance is NaN",
        ),
        (
            Form::Any,
            |m| m.alone.wrong = 3,
            "3 of 0 points meet their own face",
        ),
        (
            Form::Any,
            |m| m.parts.rest = 1e-6,
            "the parts of an error miss 1e-6",
        ),
        (
            Form::Convex,
            |m| m.covered_more = 1,
            "1 of 10 points are not open",
        ),
        (
            Form::Sheets,
            |m| m.found.late = Some(0.5),
            "a sheet is lost at 0.5 keys more",
        ),
    ];
    for (form, plant, must) in cases {
        let mut measured = sound(form);
        assert_eq!(words(&measured), [""; 0], "{must}");
        plant(&mut measured);
        let said = words(&measured);
        assert!(
            said.len() == 1 && said[0].contains(must),
            "{must}: {said:?}"
        );
    }
    // What only scenes of a form must be.
    let mut any = sound(Form::Any);
    (any.covered_more, any.found.late) = (1, Some(0.5));
    assert_eq!(words(&any), [""; 0]);
}

#[test]
fn scenes_that_differ_by_a_power_of_two_are_alike() {
    let of = |open| Measured {
        open: vec![(open, 0)],
        ..sound(Form::Alike)
    };
    let steps = |all: Vec<Measured>| unlike(&all).len();
    assert_eq!(steps(vec![of(1), of(1)]), 0);
    assert_eq!(steps(vec![of(1), of(2), of(1)]), 1);
    assert_eq!(
        steps(vec![
            of(1),
            Measured {
                form: Form::Any,
                ..of(2)
            }
        ]),
        0
    );
    let all = ["2^-10", "2^10"].map(|label| measured_on_cpu("scale", label));
    assert!(!all[0].open.is_empty());
    assert_eq!(unlike(&all), Vec::<Wrong>::new());
}

#[test]
fn a_bound_that_is_nowhere_reached_is_of_no_use() {
    let found = useless(&[sound(Form::Any)]);
    let stages: Vec<&str> = found.iter().map(|w| w.stage.as_str()).collect();
    assert_eq!(stages, ["environment", "embree", "key", "distance"]);
}

#[test]
fn what_must_be_refused_is_told() {
    let m = measured_on_cpu("resolution", "725");
    assert_eq!(judge(&m, &[LEG.to_owned()]), []);
    let cells = Table::default().cells(&m);
    assert_eq!(cells.len(), Table::names().len());
    assert_eq!(
        cells.last().expect("a reason"),
        "refused: 725 is outside 8 to 724"
    );
    let csv = files::csv(&[m]);
    let counts: Vec<usize> = csv.lines().map(|line| line.split(',').count()).collect();
    assert_eq!(counts, [counts[0]; 2], "{csv}");
    assert!(csv.contains("refused: 725 is outside 8 to 724"), "{csv}");
}

/// Lists that are not the scene's: what points find there must not hold.
#[test]
fn lists_of_another_scene_are_wrong() {
    let loaded = loaded("layers", "2^3").expect("a scene");
    let mut run = LdmRun::new(&loaded, true).expect("maps");
    let exact = Exact::new(&loaded, &run.setup.lattice);
    let found = Found::of(&run, &exact);
    assert_eq!((found.wrong, found.first.as_deref()), (0, None));
    assert!(found.certain > found.sides / 2, "most are certain");
    assert!(
        found.key > 0.1 && found.farthest_lost.is_none(),
        "{found:?}"
    );
    let sound = run.turns[0].layers.clone();

    // A sheet that is a little farther than its corners' rounding allows.
    for key in &mut run.turns[0].layers.keys {
        *key += 1 << 20;
    }
    let farther = Found::of(&run, &exact);
    assert!(farther.key > 1.0 && farther.wrong > 0);
    let said = farther.first.expect("the first");
    assert!(
        said.contains("where nothing is") || said.contains("not found"),
        "{said}"
    );

    // Nothing in any list.
    run.turns[0].layers = sound;
    run.turns[0].layers.offsets.fill(0);
    let nothing = Found::of(&run, &exact);
    assert!(nothing.wrong > 0 && nothing.key == 0.0);
    assert!(nothing.first.expect("the first").ends_with("is not found"));
    assert!(nothing.late.expect("a sheet is lost") > 0.0);
}

/// A point without a band of its own meets its face.
#[test]
fn points_without_a_band_meet_their_face() {
    let loaded = loaded("grazing", "45").expect("a scene");
    let mut run = LdmRun::new(&loaded, true).expect("maps");
    let sound = Alone::of(&run).expect("maps");
    assert_eq!((sound.wrong, sound.lost), (0, 0.0));
    assert!(sound.pairs > 1000);
    for asker in &mut run.setup.receivers {
        asker.receiver.normal = [0; 3];
    }
    let bare = Alone::of(&run).expect("maps");
    assert!(bare.wrong > 100, "{bare:?}");
    assert!(bare.first.expect("the first").contains("slope"));
}

/// A floor under a sheet from which it is parted by half a step: all is lost to rounding, and
/// nothing to directions or pixels.
#[test]
fn parts_add_up_and_name_the_culprit() {
    let near = measured_on_cpu("layers", "2^-14").parts;
    assert!(
        near.quantisation.rmse > 0.5 && near.resolution.most < 1e-9,
        "{near:?}"
    );
    let coarse = measured_on_cpu("layers", "2^-3").parts;
    assert!(
        coarse.resolution.rmse > 0.5 && coarse.quantisation.most < 1e-9,
        "{coarse:?}"
    );
    let few = measured_on_cpu("directions", "4").parts;
    assert!(few.directions.rmse > 2.0 * few.resolution.rmse, "{few:?}");
    for parts in [near, coarse, few] {
        assert!(parts.rest < 1e-12 && parts.askers > 50, "{parts:?}");
    }
}
