//! Broken legs that no kernel can stand for: nothing to compare, an oracle that errs.

use libtest_mimic::{Failed, Trial};
use triptych_harness::cause::Cause;
use triptych_harness::compare::{Judgement, embree, fragments, image, lists, opaque};
use triptych_harness::corpus::{self, Entry};
use triptych_harness::embree::EmbreeScene;
use triptych_harness::plan::Plan;
use triptych_harness::replay::spec::SpecRun;
use triptych_harness::scene::load_entry;
use triptych_spec::abuffer::{EOL, Lists, Opaque};
use triptych_spec::vertex::{SUBPIXEL_BITS, primitives};

/// The causes that are shown here.
pub const CAUSES: [Cause; 3] = [
    Cause::Coverage,
    Cause::ReferenceMissing,
    Cause::OracleDisagreement,
];

/// One test each.
pub fn trials() -> Vec<Trial> {
    let trial = |name, test: fn(&SpecRun) -> Result<(), Failed>| {
        Trial::test(name, move || test(&spec("abuffer/mixed")?))
    };
    vec![
        trial("coverage/a-leg-without-fragments", no_fragments),
        trial("reference-missing/a-leg-without-pixels", no_pixels),
        trial("oracle-disagreement/one-sub-pixel-off", oracle_off),
        trial(
            "oracle-disagreement/a-triangle-less",
            oracle_without_a_triangle,
        ),
    ]
}

fn spec(scene: &str) -> Result<SpecRun, Failed> {
    let path = corpus::root().join(scene).join("scene.toml");
    let entry = Entry {
        name: scene.into(),
        family: "abuffer".into(),
        path,
    };
    let scene = load_entry(&entry, None)?.scene;
    Ok(SpecRun::new(
        &scene,
        primitives(&scene, SUBPIXEL_BITS),
        &Plan::new(&scene, true),
    )?)
}

fn exactly(cause: Cause, count: u64, judgement: &Judgement) -> Result<(), Failed> {
    if judgement.causes == [(cause, count)].into() && judgement.unexplained == 0 {
        return Ok(());
    }
    let (causes, unexplained) = (&judgement.causes, judgement.unexplained);
    Err(format!(
        "not {count} of {}: {causes:?}, {unexplained} unexplained",
        cause.name()
    )
    .into())
}

fn no_fragments(spec: &SpecRun) -> Result<(), Failed> {
    let (size, width) = (spec.primitives.size, spec.primitives.size.width);
    let stream = fragments::compare(&spec.cover, &[], size, &fragments::Rule::Exact);
    exactly(Cause::Coverage, spec.cover.len() as u64, &stream)?;
    let expected = lists::Expected {
        sorted: &spec.sorted,
        first_pixel: 0,
        faces: &spec.faces,
        width,
    };
    let nothing = Lists {
        heads: vec![EOL; size.pixels()],
        nodes: vec![],
        colours: vec![],
        attempts: 0,
        capacity: 1,
    };
    exactly(
        Cause::Coverage,
        spec.sorted.fragments.len() as u64,
        &lists::compare(&expected, &nothing),
    )
}

fn no_pixels(spec: &SpecRun) -> Result<(), Failed> {
    let width = spec.primitives.size.width;
    exactly(
        Cause::ReferenceMissing,
        1,
        &image::compare(&spec.image, &[], width),
    )?;
    let nothing = Opaque {
        key: vec![],
        prim: vec![],
    };
    exactly(
        Cause::ReferenceMissing,
        1,
        &opaque::compare(&spec.opaque, &nothing, &spec.primitives),
    )
}

fn oracle_off(spec: &SpecRun) -> Result<(), Failed> {
    let mut moved = spec.primitives.clone();
    moved.snapped.iter_mut().for_each(|corner| corner[0] += 1);
    disagrees(spec, &EmbreeScene::new(&moved)?)
}

fn oracle_without_a_triangle(spec: &SpecRun) -> Result<(), Failed> {
    let seen = spec
        .sorted
        .fragments
        .first()
        .ok_or("a scene with layers")?
        .prim as usize;
    let mut fewer = spec.primitives.clone();
    fewer.prims[seen] = [fewer.prims[seen][0]; 3];
    disagrees(spec, &EmbreeScene::new(&fewer)?)
}

fn disagrees(spec: &SpecRun, oracle: &EmbreeScene) -> Result<(), Failed> {
    let whole = embree::compare(&spec.primitives, &EmbreeScene::new(&spec.primitives)?)?;
    let broken = embree::compare(&spec.primitives, oracle)?;
    let causes: Vec<Cause> = broken.causes().into_keys().collect();
    if whole.disagreeing() == 0 && causes == [Cause::OracleDisagreement] {
        return Ok(());
    }
    Err(format!("whole: {whole}\nbroken: {broken}").into())
}
