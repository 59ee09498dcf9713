//! Adapters that cannot be used: a driver of which one function fails, in place of one
//! of the two that set-up brings.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::{Value, json as object};

use super::{Place, Ran, SCENE};
use crate::results::{count, json};

/// The list of drivers that set-up adds, as Vulkan's loader reads it.
const ADDED: &str = "VK_ADD_DRIVER_FILES";

/// `VK_ERROR_INITIALIZATION_FAILED` and `VK_ERROR_DEVICE_LOST`.
const REFUSED: i32 = -3;
const LOST: i32 = -4;

/// A machine with a broken driver.
struct Machine {
    place: Place,
    drivers: String,
}

impl Machine {
    /// One function of the driver does nothing and gives this result.
    fn new(function: &str, result: i32) -> Self {
        let place = Place::new(&format!("driver-{function}"));
        let added = std::env::var(ADDED).unwrap_or_default();
        let mut drivers: Vec<PathBuf> = std::env::split_paths(&added).collect();
        let first = drivers.first_mut().expect("set-up adds a driver");
        let library = place.root.join("driver.so");
        let manifest = object!({
            "file_format_version": "1.0.0",
            "ICD": { "library_path": library, "api_version": "1.0.0" },
        });
        place
            .write("corpus/raster/quads/scene.toml", SCENE)
            .write("driver.c", include_str!("driver.c"))
            .write("driver.json", &manifest.to_string());
        let real = std::mem::replace(first, place.root.join("driver.json"));
        let compiled = Command::new("cc")
            .args(["-shared", "-fPIC", "driver.c", "-ldl", "-o"])
            .arg(&library)
            .arg(format!("-DREAL=\"{}\"", library_of(&real).display()))
            .arg(format!("-DFAILS=\"{function}\""))
            .arg(format!("-DRESULT={result}"))
            .current_dir(&place.root)
            .status();
        assert!(
            compiled.is_ok_and(|status| status.success()),
            "cc compiles a driver"
        );
        let drivers = std::env::join_paths(drivers).expect("they come from such a list");
        let drivers = drivers.into_string().expect("a path in UTF-8");
        Self { place, drivers }
    }

    fn run(&self, arguments: &[&str]) -> Ran {
        Ran::of(self.place.command(arguments).env(ADDED, &self.drivers))
    }

    /// Replays what is asked for, and gives the labels and rows of the GPU legs.
    #[track_caller]
    fn replay(&self, code: i32, options: &[&str]) -> (Ran, Vec<(String, Value)>) {
        let replay = ["replay", "--no-cache", "--leg", "gpu", "--json", "o"];
        let ran = self.run(&[&replay, options].concat()).expect(code);
        let lines = json(&self.place.root.join("o"));
        let label = |row: &Value| Some(row["b"].as_str()?.strip_prefix("gpu@")?.to_owned());
        let rows = lines.into_iter().filter_map(|r| Some((label(&r)?, r)));
        (ran, rows.collect())
    }
}

/// The library that a driver's manifest names.
fn library_of(manifest: &Path) -> PathBuf {
    let text = std::fs::read_to_string(manifest).expect("the driver's manifest");
    let value: Value = serde_json::from_str(&text).expect("it is JSON");
    let library = value["ICD"]["library_path"].as_str().expect("a path");
    manifest.with_file_name(library)
}

/// The row of the adapter that has no path, hence no leg that ran.
#[track_caller]
fn broken(rows: &[(String, Value)]) -> &(String, Value) {
    let mut broken = rows.iter().filter(|(label, _)| !label.contains('/'));
    let row = broken.next().expect("a row for the broken adapter");
    assert_eq!(broken.next(), None, "one row a scene is enough");
    assert_eq!(row.1["stage"], "leg", "the leg as a whole");
    assert_eq!(count(&row.1, "compared"), 0, "nothing ran");
    row
}

/// The name of an adapter of which something was compared.
#[track_caller]
fn whole(rows: &[(String, Value)]) -> &str {
    let compared = |row: &&(String, Value)| count(&row.1, "compared") > 0;
    let (label, _) = rows.iter().find(compared).expect("an adapter that works");
    label.split_once('/').expect("a path").0
}

/// Whatever a driver does while it is opened, the others are compared: without a word
/// about that adapter in the arguments it is skipped, else it fails.
#[test]
fn an_adapter_that_cannot_be_used_does_not_end_a_run() {
    for (function, result, reason, cause) in [
        ("vkCreateDevice", REFUSED, "no device: ", None),
        ("vkQueueSubmit", LOST, "device lost: ", Some("device-lost")),
        // Here wgpu panics.
        ("vkCreateComputePipelines", REFUSED, "panic: ", None),
    ] {
        let machine = Machine::new(function, result);
        let (ran, rows) = machine.replay(0, &[]);
        let (name, row) = broken(&rows);
        let line = format!("{name} cannot be used: {reason}");
        let said = row["skipped"].as_str().expect("a reason");
        assert!(said.starts_with(&line), "{said:?} is not {line:?}");
        assert_eq!(ran.stderr, format!("triptych: {said}\n"));
        let counted = format!("\n        1  {said}\n");
        assert!(ran.stdout.contains(&counted), "{}", ran.stdout);
        let report = machine.place.root.join("reports/out/index.html");
        let report = std::fs::read_to_string(report).expect("a report");
        assert!(report.contains("cannot be used"), "it lists the adapter");

        let other = whole(&rows);
        let (_, rows) = machine.replay(1, &["--adapter", name, "--adapter", other]);
        let (_, row) = broken(&rows);
        let causes = cause.map_or(object!({}), |cause| object!({ cause: 1 }));
        assert_eq!(row["causes"], causes, "{function}");
        assert_eq!(count(row, "unexplained"), u64::from(cause.is_none()));
        assert!(row["note"].as_str().is_some_and(|n| n.starts_with(&line)));
        assert_eq!(whole(&rows), other);

        let ran = machine.run(&["replay", "--adapter", name]).expect(2);
        assert_eq!(ran.stdout, "", "nothing was run");
        assert_eq!(ran.stderr, format!("triptych: {said}\n"));

        let ran = machine.run(&["doctor"]).expect(1);
        let listed = format!("\n  {said}\n");
        assert!(ran.stdout.contains(&listed), "{}", ran.stdout);
        let other = format!("\n  {other}: ");
        assert!(ran.stdout.contains(&other), "{}", ran.stdout);
        assert!(ran.stdout.contains("sub-pixel grid 1/"), "{}", ran.stdout);
        assert_eq!(ran.stderr, "");
    }
}
