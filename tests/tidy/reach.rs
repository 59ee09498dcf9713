//! Dead files: whatever nothing leads to.

use std::collections::BTreeSet;

use super::{File, assert_none, files, root};
use crate::manifests::targets;

/// A path with its `..` taken out.
fn normal(path: &str) -> String {
    let mut parts: Vec<&str> = Vec::new();
    for part in path.split('/') {
        match part {
            ".." => drop(parts.pop()),
            "" | "." => {}
            _ => parts.push(part),
        }
    }
    parts.join("/")
}

/// The files that a file's `mod` lines name, each with whether its own modules lie
/// beside it (as those of a crate's root do) or in a folder of its name.
fn modules(file: &File, beside: bool) -> Vec<(String, bool)> {
    let (folder, name) = file.name.rsplit_once('/').unwrap_or(("", &file.name));
    let own = match beside {
        true => folder.to_owned(),
        false => format!("{folder}/{}", name.trim_end_matches(".rs")),
    };
    let mut found = Vec::new();
    let mut path = None;
    for line in file.text().lines().map(str::trim) {
        if let Some(given) = line.strip_prefix("#[path = \"") {
            path = given.strip_suffix("\"]");
        } else if line.starts_with("#[") {
            continue;
        } else {
            // Whoever may see it.
            let line = match line.strip_prefix("pub") {
                Some(rest) => rest.split_once(' ').map_or("", |(_, rest)| rest),
                None => line,
            };
            let module = line.strip_prefix("mod ").and_then(|l| l.strip_suffix(';'));
            found.extend(module.map(|module| match path {
                Some(path) => (normal(&format!("{folder}/{path}")), true),
                None => (normal(&format!("{own}/{module}.rs")), false),
            }));
            path = None;
        }
    }
    found
}

#[test]
fn every_module_is_reached() {
    let files = files();
    let mut open: Vec<(String, bool)> = targets().into_iter().map(|t| (t, true)).collect();
    let mut reached = BTreeSet::new();
    let mut missing = Vec::new();
    while let Some((name, beside)) = open.pop() {
        match files.iter().find(|f| f.name == name) {
            Some(file) if reached.insert(name.clone()) => open.extend(modules(file, beside)),
            Some(_) => {}
            None => missing.push(format!(
                "{name}: named as a module or target, and not there"
            )),
        }
    }
    assert_none(&missing);
    let dead = files
        .iter()
        .filter(|f| f.extension() == "rs" && !reached.contains(&f.name));
    let dead: Vec<String> = dead
        .map(|f| format!("{}: no `mod` and no target leads to it", f.name))
        .collect();
    assert_none(&dead);
}

/// Every file of WGSL is a family's, or measured, or imported, or stands in for one that
/// is; one of a test is taken in by the file of Rust beside it.
#[test]
fn every_wgsl_file_is_reached() {
    let mut files = files();
    let linker = files.iter().find(|f| f.name == "gpu/src/wgsl/shipped.rs");
    let linker = linker.expect("there is a linker").text().to_owned();
    let readme = files.iter().find(|f| f.name == "README.md");
    let readme = readme.expect("there is a README").text().to_owned();
    let sources: Vec<_> = files.extract_if(.., |f| f.extension() == "rs").collect();
    files.retain(|f| f.extension() == "wgsl");
    let of_tests = files.extract_if(.., |f| f.name.starts_with("tests/"));
    let alone: Vec<String> = of_tests
        .filter(|f| {
            let rust = f.name.replace(".wgsl", ".rs");
            let file = f.name.rsplit('/').next().unwrap_or_default();
            let taken = format!("include_str!(\"{file}\")");
            let beside = sources.iter().find(|own| own.name == rust);
            beside.is_none_or(|own| !own.text().contains(&taken))
        })
        .map(|f| format!("{}: no test takes it in", f.name))
        .collect();
    assert_none(&alone);
    let examples = files.extract_if(.., |f| f.name.starts_with("harness/examples/"));
    let unnamed: Vec<String> = examples
        .filter(|f| !readme.contains(&f.name))
        .map(|f| format!("{}: the README does not lead to it", f.name))
        .collect();
    assert_none(&unnamed);
    let mut violations = Vec::new();
    for file in &files {
        let stem = file
            .name
            .trim_start_matches("gpu/src/")
            .trim_end_matches(".wgsl");
        let family = triptych_harness::registry::FAMILIES
            .iter()
            .any(|f| f.name == stem || f.files.contains(&stem));
        let measured = triptych_harness::registry::MEASURED
            .iter()
            .any(|m| m.file == stem);
        let import = format!("//#import {stem}");
        let in_place = format!("{import} for ");
        let leads = |line: &str| line == import || line.starts_with(&in_place);
        let imported = files.iter().any(|f| f.text().lines().any(leads));
        // What a variant has in place of an import: pixels with several samples ask for it, or rays
        // whose nearest triangles must be the spec's.
        let places = [
            ("drawn_samples", "drawn"),
            ("covered_samples", "covered"),
            ("first_exact", "first"),
        ];
        let variant = places.iter().any(|(own, other)| {
            file.text()
                .contains(&format!("//#import {own} for {other}"))
        });
        let stands_in = ["remove", "get"]
            .iter()
            .any(|call| linker.contains(&format!("{call}(\"{stem}\")")));
        let stands_in = variant || stands_in;
        if !linker.contains(&format!("\"{stem}\",")) {
            violations.push(format!("{}: not in Sources::shipped", file.name));
        }
        if !family && !measured && !imported && !stands_in {
            violations.push(format!("{}: nothing imports it", file.name));
        }
    }
    assert_none(&violations);
}

/// A case has a scene.toml, or a finding a finding.toml, that names every other file beside
/// it, and a row in the README; a row has a case.
#[test]
fn every_corpus_file_is_used() {
    let all = files();
    let find = |name: &str| all.iter().find(|f| f.name == name);
    let readme = find("corpus/README.md")
        .expect("the corpus has a README")
        .text();
    let mut violations = Vec::new();
    let mut cases = BTreeSet::new();
    for file in &all {
        let parts: Vec<&str> = file.name.split('/').collect();
        let ["corpus", family, case, rest @ ..] = &parts[..] else {
            continue;
        };
        cases.insert(*case);
        let own = match *family {
            "findings" => "finding.toml",
            _ => "scene.toml",
        };
        let scene = find(&format!("corpus/{family}/{case}/{own}"));
        let beside = rest.join("/");
        let stem = beside.split('.').next().unwrap_or_default();
        // A material library goes by the stem of its mesh.
        let named = scene.is_some_and(|s| s.text().contains(stem));
        if beside != own && !named {
            violations.push(format!("{}: its {own} does not name it", file.name));
        }
        if !readme.contains(&format!("| `{case}` |")) {
            violations.push(format!("{}: {case} is not in corpus/README.md", file.name));
        }
    }
    for row in readme.lines().filter_map(|l| l.strip_prefix("| `")) {
        let case = row.split('`').next().unwrap_or_default();
        if !case.ends_with('/') && !cases.contains(case) {
            violations.push(format!("corpus/README.md: {case} is not in the corpus"));
        }
    }
    assert_none(&violations);
}

/// Whoever looks around finds every folder explained.
#[test]
fn every_folder_is_in_the_architecture() {
    let page = root().join("ARCHITECTURE.md");
    let page = std::fs::read_to_string(page).expect("there is an ARCHITECTURE.md");
    let mut violations = BTreeSet::new();
    for file in files() {
        if let Some((folder, _)) = file.name.split_once('/')
            && !folder.starts_with('.')
            && !page.contains(&format!("{folder}/"))
        {
            violations.insert(format!("{folder}/ is not in ARCHITECTURE.md"));
        }
    }
    assert_none(&violations.into_iter().collect::<Vec<_>>());
}
