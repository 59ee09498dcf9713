//! Writes the mutants out: each a copy of one source with its edits, in a tree of modules like
//! those of `trees/`.

#[path = "support/kind.rs"]
#[expect(dead_code, reason = "the table names some")]
mod kind;
#[path = "mutants/table.rs"]
#[expect(dead_code, reason = "the models read the rest")]
mod table;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

use table::{MUTANTS, Mutant};

/// Sources of the queues that are in every tree.
const SHIPPED: [&str; 8] = [
    "lfree",
    "line",
    "local",
    "lock",
    "node",
    "outstanding",
    "part",
    "reclaim",
];

/// Sources of models that are in every tree.
const MODELS: [&str; 5] = ["arena", "frame", "held", "run", "tracked"];

/// A source with a mutant's edits.
fn edited(mutant: &Mutant, path: &Path) -> String {
    let Mutant { name, file, .. } = mutant;
    let mut text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{name}: {file}: {e}"));
    for (find, replace) in mutant.edits {
        let times = text.matches(find).count();
        assert_eq!(
            times, 1,
            "{name}: in {file} once, not {times} times: {find}"
        );
        text = text.replace(find, replace);
    }
    text
}

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=mutants/table.rs");
    println!("cargo::rerun-if-changed=support/kind.rs");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it"));
    let own = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let shipped = own.join("../../harness/src/dispatch/queue");
    let mut sources: Vec<(&str, PathBuf)> = Vec::new();
    sources.extend(SHIPPED.map(|name| (name, shipped.join(format!("{name}.rs")))));
    sources.extend(MODELS.map(|name| (name, own.join(format!("tree/{name}.rs")))));
    for (_, path) in &sources {
        println!("cargo::rerun-if-changed={}", path.display());
    }
    let (mut trees, mut arms) = (String::new(), String::new());
    for (number, mutant) in MUTANTS.iter().enumerate() {
        let name = mutant.file.trim_end_matches(".rs");
        let source = sources.iter().find(|(source, _)| *source == name);
        let (_, path) = source.unwrap_or_else(|| panic!("{}: no {}", mutant.name, mutant.file));
        let copy = out.join(format!("{number}.rs"));
        fs::write(&copy, edited(mutant, path)).expect("cargo's folder can be written");
        let both = [
            ("loom", mutant.loom.is_some()),
            ("shuttle", mutant.shuttle.is_some()),
        ];
        for (checker, _) in both.iter().filter(|(_, used)| *used) {
            writeln!(trees, "pub mod {checker}_{number} {{").expect("a string grows");
            let shim = own.join(format!("shim/{checker}.rs"));
            let modules = sources.iter().map(|(module, path)| match *module == name {
                true => (*module, &copy),
                false => (*module, path),
            });
            for (module, path) in modules.chain([("sync", &shim)]) {
                writeln!(trees, "#[path = {path:?}] pub mod {module};").expect("a string grows");
            }
            trees += "pub use crate::support::traits;\n}\n";
            writeln!(
                arms,
                "({number}, \"{checker}\") => {checker}_{number}::run::run,"
            )
            .expect("a string grows");
        }
    }
    let all = format!(
        "{trees}\npub fn run(number: usize, checker: &str) -> Run {{\n\
         match (number, checker) {{\n{arms}_ => unreachable!(),\n}}\n}}\n"
    );
    fs::write(out.join("mutants.rs"), all).expect("cargo's folder can be written");
}
