//! One test per scene of the corpus: every leg on every adapter agrees, and what the
//! spec found is what its snapshot says.
//!
//! A scene without its mesh is ignored, and says so; asked for all the same
//! (`--include-ignored`), it fails. A snapshot that differs or is missing is left pending
//! for `cargo insta review`. With `TRIPTYCH_ROWS=DIR` every scene leaves its rows there as
//! JSON lines, which `triptych report` merges, whatever machine or shard tested it.

#[path = "scenes/closed.rs"]
mod closed;
#[path = "scenes/contributor.rs"]
mod contributor;
mod devices;

use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs::File;
use std::io::BufWriter;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

use devices::Devices;
use libtest_mimic::{Arguments, Failed, Trial};
use triptych_harness::corpus::{self, Entry};
use triptych_harness::json;
use triptych_harness::registry::{Chain, stages_of};
use triptych_harness::replay::gpu::Adapter;
use triptych_harness::replay::{Extent, Options, Outcome, replay};
use triptych_harness::row::{Row, Verdict};
use triptych_harness::scene::file::SceneFile;
use triptych_harness::snapshot;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let entries = match corpus::list(&corpus::root()) {
        Ok(entries) => entries,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::from(2);
        }
    };
    let devices = Arc::new(Devices::default());
    let mut trials: Vec<Trial> = entries
        .iter()
        .map(|entry| {
            let missing = missing_mesh(entry);
            if let (Some(mesh), false) = (&missing, arguments.list) {
                let name = &entry.name;
                eprintln!("{name} is ignored: mesh {mesh} is not there; `./x setup` installs it");
            }
            let (devices, entry) = (devices.clone(), entry.clone());
            Trial::test(entry.name.clone(), move || test(&entry, &devices))
                .with_ignored_flag(missing.is_some())
        })
        .collect();
    let closed = entries
        .iter()
        .filter(|entry| closed::SCENES.contains(&&entry.name[..]));
    trials.extend(closed.map(|entry| {
        let missing = missing_mesh(entry).is_some();
        let (entry, name) = (entry.clone(), format!("closed/{}", entry.name));
        Trial::test(name, move || closed::nothing_leaves(&entry)).with_ignored_flag(missing)
    }));
    trials.push(Trial::test("snapshots/every-one-has-a-scene", move || {
        dangling(&snapshots(), &entries)
    }));
    // The tests of this one run it on a corpus that is not ours.
    if std::env::var_os("TRIPTYCH_CORPUS").is_none() {
        trials.push(Trial::test(
            "contributor/added-reviewed-and-in-shards",
            contributor::added_reviewed_and_in_shards,
        ));
    }
    libtest_mimic::run(&arguments, trials).exit_code()
}

/// The first package that a scene wants and that is not installed. A scene that
/// cannot be read is none of them: its test says why.
fn missing_mesh(entry: &Entry) -> Option<String> {
    let text = std::fs::read_to_string(&entry.path).ok()?;
    let scene: SceneFile = toml::from_str(&text).ok()?;
    let mut packages = scene
        .mesh
        .iter()
        .filter_map(|m| m.get_ref().package.as_ref());
    let absent = packages.find(|p| !corpus::meshes().join(p.get_ref()).exists())?;
    Some(absent.get_ref().clone())
}

fn test(entry: &Entry, devices: &Devices) -> Result<(), Failed> {
    let mut adapters = devices.take()?;
    let start = Instant::now();
    let options = Options {
        world: Extent::All,
        ..Options::default()
    };
    let rows = rows_file(entry)?;
    let outcome = replay(entry, &adapters, &options)?;
    if let Some(mut json) = rows {
        json.rows(&outcome.rows)?;
        json.finish(start.elapsed().as_secs_f64())?;
    }
    let mut wrong = judge(&outcome, &adapters);
    if !wrong.is_empty() {
        adapters.spoil(false);
    }
    drop(adapters);
    // insta prints the difference before it panics.
    if catch_unwind(|| assert_snapshot(entry, &outcome)).is_err() {
        wrong.push("the spec found what its snapshot does not say: cargo insta review".into());
    }
    if wrong.is_empty() {
        return Ok(());
    }
    let mut message = wrong.join("\n");
    let _ = write!(
        message,
        "\nreplay it: cargo triptych replay --exact {}",
        entry.name
    );
    Err(message.into())
}

/// Where `TRIPTYCH_ROWS` says that rows go, a file of the scene's. It is begun before the
/// scene is replayed: what fails leaves it without an end, and the report refuses it.
fn rows_file(entry: &Entry) -> std::io::Result<Option<json::Writer<BufWriter<File>>>> {
    let Some(folder) = std::env::var_os("TRIPTYCH_ROWS").map(PathBuf::from) else {
        return Ok(None);
    };
    std::fs::create_dir_all(&folder)?;
    let file = folder.join(entry.name.replace('/', "-") + ".json");
    json::Writer::create(&file).map(Some)
}

/// What is wrong with an outcome: rows that diverge, legs that compared nothing and
/// do not say why, adapters on which skipping was not tested.
fn judge(outcome: &Outcome, adapters: &[Adapter]) -> Vec<String> {
    if outcome.facts.is_none() {
        let reasons = outcome.rows.iter().filter_map(|r| r.skipped.clone());
        return reasons
            .chain(["the scene was not replayed".into()])
            .collect();
    }
    let diverging = outcome
        .rows
        .iter()
        .filter(|r| r.verdict() == Verdict::Diverge);
    let mut wrong: Vec<String> = diverging.map(describe).collect();
    let gpus = adapters.iter().flat_map(|adapter| {
        let label =
            |path: &triptych_gpu::raster::Path| format!("gpu@{}/{}", adapter.gpu.name, path.name());
        Options::default()
            .paths
            .iter()
            .map(label)
            .collect::<Vec<_>>()
    });
    // Compared or skipped for a reason: every stage says what became of it.
    let chain = chain_of(outcome);
    wrong.extend(misplaced(outcome, chain));
    let all = adapters
        .iter()
        .flat_map(|a| stages_of(chain).map(move |s| (a, s)));
    for (adapter, stage) in all {
        let leg = format!("gpu@{}/compute", adapter.gpu.name);
        let row = |r: &Row| r.b == leg && r.stage == stage.name;
        if !outcome.rows.iter().any(row) {
            wrong.push(format!("no row of stage {} for {leg}", stage.name));
        }
    }
    for leg in gpus.chain(["embree".to_owned()]) {
        let rows: Vec<&Row> = outcome.rows.iter().filter(|r| r.b == leg).collect();
        let compared = rows.iter().any(|r| r.compared > 0);
        if rows.is_empty() || (!compared && rows.iter().any(|r| r.skipped.is_none())) {
            wrong.push(format!("nothing was compared with {leg}, for no reason"));
        }
    }
    if chain != Chain::Frame {
        return wrong;
    }
    // Embree is asked twice.
    if outcome.rows.iter().all(|r| r.stage != "world") {
        wrong.push("Embree was not asked in world space".into());
    }
    for adapter in adapters {
        let label = format!("gpu@{}/", adapter.gpu.name);
        let mut rows = outcome.rows.iter().filter(|r| r.stage == "plan");
        if !rows.any(|r| r.compared > 0 && r.a.starts_with(&label)) {
            wrong.push(format!("skipping was not tested on {}", adapter.gpu.name));
        }
    }
    wrong
}

/// Families with scenes of their own, and a stage that they alone have.
const OWN: [(&str, &str, Chain); 4] = [
    ("grid", "trace", Chain::Rays),
    ("rsm", "gather", Chain::Indirect),
    ("ldm", "layers", Chain::Maps),
    ("dispatch", "locate", Chain::Traced),
];

/// As what a scene was replayed, by its passes.
fn chain_of(outcome: &Outcome) -> Chain {
    let has = |stage: &str| outcome.passes.iter().any(|pass| pass.name == stage);
    let found = OWN.into_iter().find(|(_, stage, _)| has(stage));
    found.map_or(Chain::Frame, |(.., chain)| chain)
}

/// The folder says what a scene is for.
fn misplaced(outcome: &Outcome, chain: Chain) -> Vec<String> {
    let strange = |(family, _, its_own): &(&str, &str, Chain)| {
        let mut rows = outcome.rows.iter();
        rows.any(|r| (r.family == *family) != (chain == *its_own))
    };
    let told = |(name, ..): (&str, &str, Chain)| {
        format!("a scene has [{name}] if and only if its family is {name}")
    };
    OWN.into_iter().filter(strange).map(told).collect()
}

fn describe(row: &Row) -> String {
    let causes: Vec<String> = row
        .causes
        .iter()
        .map(|(c, n)| format!("{} {n}", c.name()))
        .collect();
    format!(
        "{} of {}: {} of {} {} differ ({}; {} unexplained); {} admitted{}: {}",
        row.stage,
        row.b,
        row.differ,
        row.compared,
        row.unit,
        causes.join(", "),
        row.unexplained,
        row.admitted,
        row.admitted_budget
            .map_or(String::new(), |b| format!(" of a share of {b}")),
        row.note,
    )
}

fn snapshots() -> PathBuf {
    snapshot::folder(&corpus::root())
}

/// Holds the facts against `snapshots/<family>/<case>.snap`. A missing snapshot
/// fails, too, and leaves a pending one for review.
fn assert_snapshot(entry: &Entry, outcome: &Outcome) {
    let Some(facts) = &outcome.facts else { return };
    let case = entry.name.rsplit('/').next().unwrap_or(&entry.name);
    let mut settings = insta::Settings::new();
    settings.set_snapshot_path(snapshots().join(&entry.family));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.set_description(&outcome.purpose);
    settings.set_input_file(&entry.path);
    settings.bind(|| insta::assert_snapshot!(case, snapshot::text(facts)));
}

/// Fails for files under `snapshots/` that belong to no scene.
fn dangling(folder: &Path, entries: &[Entry]) -> Result<(), Failed> {
    let scenes: BTreeSet<PathBuf> = entries
        .iter()
        .map(|e| folder.join(format!("{}.snap", e.name)))
        .collect();
    let mut left = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for file in std::fs::read_dir(&folder)? {
            let path = file?.path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            // A pending one is its scene's, and for review.
            let snapshot = match path.extension() {
                Some(extension) if extension == "new" => path.with_extension(""),
                _ => path.clone(),
            };
            if !scenes.contains(&snapshot) {
                left.push(path.display().to_string());
            }
        }
    }
    left.sort();
    match left.is_empty() {
        true => Ok(()),
        false => Err(format!(
            "no scene has these snapshots; delete them:\n{}",
            left.join("\n")
        )
        .into()),
    }
}
