//! From a scene file to the spec's numbers, and what is left out on the way.

use std::path::Path;

use triptych_spec::ldm::{FAR_MAX, Falloff, openness};

use super::*;
use crate::corpus::Entry;
use crate::mesh::Intake;
use crate::scene::{Loaded, Mistake, load_text};

/// A floor whose normal is the directions' pole, with keys and meshes beside.
fn scene(keys: &str, meshes: &str) -> Loaded {
    let text = format!(
        "
purpose = 'a floor'
size = [16, 12]
background = [0.5, 0.25, 0]
camera = {{ eye = [0, -3, 3], target = [0, 0, 0], up = [0, 0, 1], height = 3, near = 0.5, far = 20 }}
[[mesh]]
generate.faces = {{ vertices = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], faces = [[0, 1, 2, 3]] }}
{meshes}
[ldm]
{keys}
"
    );
    let entry = Entry {
        family: "ldm".to_owned(),
        ..Entry::outside(Path::new("floor/scene.toml"))
    };
    load_text(&mut Intake::from_disk(), &entry, None, &text).expect("a scene")
}

const BOX: &str = "[[mesh]]\ngenerate.box = { size = [0.8, 0.8, 0.8] }\ntranslate = [0, 0, 0.6]";

fn run(loaded: &Loaded, skip: bool) -> LdmRun {
    LdmRun::new(loaded, skip).expect("within the limits")
}

fn refused(loaded: &Loaded) -> Mistake {
    LdmRun::new(loaded, true)
        .map(|_| ())
        .expect_err("beyond a limit")
}

#[test]
fn lengths_are_steps() {
    let loaded = scene("far = 0.5\npower = 3\noffset = 5", "");
    let setup = Setup::new(&loaded).expect("a lattice");
    let unit = libm::scalbn(1.0, -setup.lattice.exponent);
    assert!((2_097_152.0..=4_194_304.0).contains(&unit), "{unit}");
    let Falloff::Distance { most, power } = setup.falloff else {
        panic!("far is stated");
    };
    assert_eq!((f64::from(most), power), (0.5 * unit, 3));
    let long = |far: f64| scene(&format!("far = {far:e}"), "");
    let longest = f64::from(FAR_MAX) / unit;
    let far = Setup::new(&long(longest)).expect("a lattice").falloff;
    assert!(
        matches!(far, Falloff::Distance { most: FAR_MAX, .. }),
        "{far:?}"
    );
    for far in [longest + 1.0, 1e300] {
        let refused = refused(&long(far));
        assert_eq!(refused.key, Some("ldm.far"));
        assert!(refused.message.contains("leave it out"), "{refused}");
    }
    let none = Setup::new(&scene("", "")).expect("a lattice");
    assert_eq!(none.falloff, Falloff::None);
    let short = refused(&scene("far = 1e-9", ""));
    assert_eq!(short.key, Some("ldm.far"));
    assert!(
        short.message.starts_with("1e-9 is less than half a step"),
        "{short}"
    );
}

/// The floor's plane is z = 0, and a receiver is moved off it along z, by 5 steps here.
#[test]
fn receivers_are_as_far_off_their_faces_as_they_say() {
    let loaded = scene("offset = 5", "");
    let setup = Setup::new(&loaded).expect("a lattice");
    let floor = setup.model.vertices[0][2];
    assert!(setup.receivers.len() > 100);
    for asker in &setup.receivers {
        assert_eq!(asker.receiver.point[2] - floor, 5);
        assert_eq!(asker.receiver.off, 6);
        assert_eq!(
            asker.receiver.normal,
            [0, 0, 1 << 14],
            "to the viewer's side"
        );
    }
    let mut seen = setup.seen.surfaces.iter().flatten();
    assert!(seen.all(|s| s.side == 1), "from above");
}

/// What is left out changes nothing but what it takes: on the equator the floor's weights are 0,
/// and with an up along x no light comes from half of the others.
#[test]
fn what_is_left_out_adds_nothing() {
    let dark = "sky.gradient = { zenith = [1, 0.5, 0.25], nadir = [0, 0, 0], up = [1, 0, 0] }";
    for keys in ["", "far = 1", dark, "rotations = 3"] {
        let keys = format!("directions = 62\nresolution = 24\nmirror = true\n{keys}");
        let [loaded, flat] = [BOX, ""].map(|mesh| scene(&keys, mesh));
        for loaded in [&loaded, &flat] {
            let [skipped, all] = [true, false].map(|skip| run(loaded, skip));
            let whole = |run: &LdmRun| run.open.iter().map(|o| o.whole).collect::<Vec<_>>();
            assert_eq!(whole(&skipped), whole(&all), "{keys}");
            let values = |run: &LdmRun| run.openness.iter().map(|o| o.value).collect::<Vec<_>>();
            assert_eq!(values(&skipped), values(&all), "{keys}");
            let lit = |run: &LdmRun| {
                let picture = run.picture();
                picture
                    .iter()
                    .flatten()
                    .map(|c| c.value)
                    .collect::<Vec<_>>()
            };
            assert!(!skipped.lit || lit(&skipped) == lit(&all), "{keys}");
            let mirrored = |run: &LdmRun| {
                let all = run.mirrored.iter();
                all.map(|m| (m.opposite, m.key, m.hit, m.light))
                    .collect::<Vec<_>>()
            };
            assert_eq!(mirrored(&skipped), mirrored(&all), "{keys}");
            assert!(mirrored(&all).len() == all.open.len());
            assert_eq!(all.tally.maps, 62 * u64::from(all.setup.rotations));
        }
        let flat = run(&flat, true);
        let all = 62 * u64::from(flat.setup.rotations);
        assert!(flat.tally.maps < all, "{} of {all}", flat.tally.maps);
    }
    // A picture of a sky that is dark but for one texel.
    let loaded = scene("directions = 62\nsky.constant = [0, 0, 0]", "");
    let run = run(&loaded, true);
    assert_eq!(run.tally.dark, run.tally.maps, "no light at all");
}

#[test]
fn nothing_to_see_and_nothing_in_the_way() {
    let sky = "directions = 20\nsky.constant = [1, 1, 1]";
    let loaded = scene(sky, "blocks = false");
    let open = run(&loaded, true);
    assert_eq!(
        (open.tally.keys, open.setup.blockers.triangles.len()),
        (0, 0)
    );
    assert!((0..open.open.len()).all(|i| open.open[i].whole == open.weights(i)));
    let plan = LdmPlan::new(&loaded, true);
    let why = |stage| plan.skipped(stage);
    assert_eq!(why("layers").as_deref(), Some("plan: nothing blocks"));
    assert_eq!((why("occlusion"), why("environment")), (None, None));
    let loaded = scene(sky, "seen = false");
    let unseen = run(&loaded, true);
    assert_eq!((unseen.turns.len(), unseen.setup.receivers.len()), (0, 0));
    let background = unseen.picture();
    assert!(
        background
            .iter()
            .all(|p| p.map(|c| c.value) == [0.5, 0.25, 0.0])
    );
    assert_eq!(run(&loaded, false).turns.len(), 1);
    let plan = LdmPlan::new(&loaded, true);
    assert_eq!(
        plan.skipped("occlusion").as_deref(),
        Some("plan: nothing is seen")
    );
    let dark = scene("", "");
    let plan = LdmPlan::new(&dark, true);
    assert_eq!(
        plan.skipped("environment").as_deref(),
        Some("plan: there is no sky")
    );
    assert_eq!(
        plan.skipped("mirror").as_deref(),
        Some("plan: nothing mirrors")
    );
    let plan = LdmPlan::new(&scene("mirror = true", ""), true);
    assert_eq!(plan.skipped("mirror"), None, "with or without a sky");
    let plan = LdmPlan::new(&dark, false);
    assert_eq!(plan.skipped("environment"), None);
}

/// A set in 3 rotations is the sum of the three, each by itself.
#[test]
fn rotations_add_up() {
    let loaded = scene(
        "directions = 24\nrotations = 3\nresolution = 24\nfar = 3\nsky.constant = [1, 2, 4]",
        BOX,
    );
    let run = run(&loaded, true);
    assert_eq!(run.turns.len(), 3);
    let first: Vec<_> = run.turns.iter().map(|t| t.maps.maps[0].direction).collect();
    assert!(
        first[0] == [0.0, 0.0, 1.0] && first[1] != first[2],
        "{first:?}"
    );
    for (at, total) in run.open.iter().enumerate() {
        let parts = run.turns.iter().map(|turn| turn.open[at].whole);
        assert_eq!(total.whole, parts.sum::<u32>());
        let mean: f64 = run
            .turns
            .iter()
            .map(|t| openness(&t.open[at], 24).value)
            .sum();
        assert!((run.openness[at].value - mean / 3.0).abs() < 1e-12);
        let light: f64 = run.turns.iter().map(|t| t.light[at][2].value).sum();
        assert!((run.light[at][2].value - light / 3.0).abs() < 1e-12);
    }
}

#[test]
fn limits_are_counted_before_anything_is_drawn() {
    let most = "directions = 4096\nresolution = 724";
    let pixels = refused(&scene(most, BOX));
    assert_eq!(pixels.key, Some("ldm.resolution"));
    assert!(
        pixels
            .message
            .contains("pixels in all maps, and 134217728 are the limit"),
        "{pixels}"
    );
    let many = "[[mesh]]\ngenerate.grid = { cells = [1200, 1000], cell = [0.001, 0.001] }";
    let rows = refused(&scene("directions = 2048\nresolution = 8", many));
    assert_eq!(rows.key, Some("ldm.directions"));
    assert!(rows.message.contains("triangles in "), "{rows}");
    let layers = "[[mesh]]\ngenerate.stack = { layers = 60000, size = [4, 4], spacing = 0.00001 }";
    let keys = refused(&scene("directions = 8\nresolution = 100", layers));
    assert_eq!(keys.key, Some("ldm.resolution"));
    assert!(keys.message.contains("more than 134217728 keys"), "{keys}");
}

#[test]
fn embree_is_near() {
    let loaded = scene("directions = 32\nresolution = 100", BOX);
    let seen = ask(&run(&loaded, true), 0).expect("Embree is there");
    assert_eq!(seen.vote.disagree, 0, "{:?}", seen.vote.first);
    let off = seen.off.expect("somebody asks");
    // The largest variance of a yes or no is a quarter, and that of a mean of 256 a 256th of it.
    assert!(off.noise > 0.0 && off.noise <= 0.5 / 15.9, "{off}");
    let again = ask(&run(&loaded, true), 0);
    assert_eq!(again.map(|s| s.off), Ok(Some(off)), "seeded");
    let other = ask(&run(&loaded, true), 1).expect("Embree is there").off;
    assert_ne!(other.map(|o| o.random), Some(off.random), "by another seed");
    let same = other.map(|o| o.same);
    assert_eq!(same, Some(off.same), "the directions are the scene's");
}

/// Nothing is in the way of a ray over a convex mesh, whichever side of it a point is on; what is
/// left of the distance is that of the directions' own sum from 1.
#[test]
fn rays_over_a_ball_meet_nothing() {
    let ball = "generate.sphere = { radius = 1, segments = [12, 20] }";
    let text = format!(
        "purpose = 'x'\nsize = [24, 24]\n[[mesh]]\n{ball}\n[ldm]\ndirections = 64\nresolution = 60"
    );
    let entry = Entry::outside(Path::new("ball/scene.toml"));
    let loaded = load_text(&mut Intake::from_disk(), &entry, None, &text).expect("a scene");
    let run = run(&loaded, true);
    let off = ask(&run, 0).expect("Embree is there").off.expect("points");
    assert!(off.receivers > 100 && off.noise == 0.0, "{off}");
    // Sums of 64 numbers in f64.
    assert!(off.same[1] < 1e-12, "{off}");
    let sums = run.openness.iter().map(|o| (o.value - 1.0).abs());
    let most = sums.fold(0.0, f64::max);
    assert!(
        off.random[1] <= most && off.random[0] > 0.0,
        "{off}, {most}"
    );
}
