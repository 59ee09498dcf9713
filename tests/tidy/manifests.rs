//! Cargo.toml: what it pins, and which files it makes targets of.

use toml::{Table, Value};

use super::{assert_none, root};

/// The workspace's members.
const MEMBERS: [&str; 5] = ["gpu", "harness", "spec", "tests", "tests/models"];

fn manifest(folder: &str) -> Table {
    let path = root().join(folder).join("Cargo.toml");
    let text = std::fs::read_to_string(&path).expect("a package has a Cargo.toml");
    text.parse()
        .unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// A package of a workspace of its own.
const FUZZ: &str = "tests/fuzz";

/// The crates' roots from the repository's, with `/`.
pub fn targets() -> Vec<String> {
    let packages = MEMBERS.iter().chain([&FUZZ]);
    packages.flat_map(|package| targets_of(package)).collect()
}

fn targets_of(member: &str) -> Vec<String> {
    let manifest = manifest(member);
    let mut targets = Vec::new();
    for kind in ["bin", "test", "bench", "example"] {
        let all = manifest.get(kind).and_then(Value::as_array);
        for target in all.into_iter().flatten() {
            let path = target.get("path").and_then(Value::as_str);
            let path = path.unwrap_or_else(|| panic!("{member}: a {kind} without path"));
            targets.push(match path.strip_prefix("../") {
                Some(path) => path.to_owned(),
                None => format!("{member}/{path}"),
            });
        }
    }
    let build = manifest["package"].get("build").and_then(Value::as_str);
    targets.extend(build.map(|build| format!("{member}/{build}")));
    let library = manifest.get("lib").and_then(|lib| lib.get("path"));
    let library = library.and_then(Value::as_str).unwrap_or("src/lib.rs");
    let library = format!("{member}/{library}");
    targets.extend(root().join(&library).is_file().then_some(library));
    targets
}

/// The tool that reviews snapshots is of the version that writes them.
#[test]
fn the_reviewing_tool_fits() {
    let pinned = &manifest("")["workspace"]["dependencies"]["insta"];
    let version = pinned.as_str().expect("a version").trim_start_matches('=');
    let command = format!("cargo install cargo-insta --version {version} --locked");
    let page = std::fs::read_to_string(root().join("CONTRIBUTING.md")).expect("there is one");
    assert!(page.contains(&command), "CONTRIBUTING.md lacks {command}");
}

/// `cargo insta` looks for pending snapshots below the folder of every target. Below
/// two packages' it would ask about each snapshot twice.
#[test]
fn snapshots_are_below_one_package() {
    let below = |target: &String| {
        let folder = target.rsplit_once('/').map_or("", |(folder, _)| folder);
        "tests/snapshots".starts_with(&format!("{folder}/"))
    };
    let mut packages = MEMBERS.to_vec();
    packages.retain(|member| targets_of(member).iter().any(below));
    assert_eq!(packages, ["tests"], "packages with a target above");
}

#[test]
fn members_are_known() {
    let workspace = manifest("");
    let members = workspace["workspace"]["members"]
        .as_array()
        .expect("a workspace");
    let mut members: Vec<&str> = members.iter().filter_map(Value::as_str).collect();
    members.sort_unstable();
    assert_eq!(members, MEMBERS);
}

/// A version is exact and stands in one place.
#[test]
fn dependencies_are_pinned() {
    let mut violations = Vec::new();
    let workspace = manifest("");
    let all = workspace["workspace"]["dependencies"]
        .as_table()
        .expect("a table");
    for (name, given) in all {
        let version = given
            .as_str()
            .or_else(|| given.get("version").and_then(Value::as_str));
        let ours = given.get("path").is_some();
        if !ours && !version.is_some_and(|v| v.starts_with('=')) {
            violations.push(format!(
                "Cargo.toml: {name} has {version:?}, not an exact version"
            ));
        }
    }
    let fuzz = manifest(FUZZ);
    for (name, given) in fuzz["dependencies"].as_table().expect("a table") {
        let exact = given.as_str().is_some_and(|v| v.starts_with('='));
        if !exact && given.get("path").is_none() {
            violations.push(format!("{FUZZ}/Cargo.toml: {name} is not exact"));
        }
    }
    for member in MEMBERS {
        let manifest = manifest(member);
        for kind in ["dependencies", "dev-dependencies", "build-dependencies"] {
            let given = manifest.get(kind).and_then(Value::as_table);
            for (name, given) in given.into_iter().flatten() {
                if given.get("workspace") != Some(&Value::Boolean(true)) {
                    violations.push(format!(
                        "{member}/Cargo.toml: {name} is not the workspace's"
                    ));
                }
            }
        }
        let lints = manifest.get("lints").and_then(|l| l.get("workspace"));
        if lints != Some(&Value::Boolean(true)) {
            violations.push(format!(
                "{member}/Cargo.toml: without the workspace's lints"
            ));
        }
    }
    assert_none(&violations);
}

/// Every dependency of the workspace is some member's, and so is used.
#[test]
fn dependencies_are_taken() {
    let members: Vec<Table> = MEMBERS.iter().map(|m| manifest(m)).collect();
    let workspace = manifest("");
    let all = workspace["workspace"]["dependencies"]
        .as_table()
        .expect("a table");
    let taken = |name: &str| {
        let kinds = ["dependencies", "dev-dependencies", "build-dependencies"];
        let tables = members
            .iter()
            .flat_map(|m| kinds.iter().filter_map(|k| m.get(*k)));
        tables.into_iter().any(|table| table.get(name).is_some())
    };
    let unused = all.keys().filter(|name| !taken(name));
    let unused: Vec<String> = unused
        .map(|name| format!("Cargo.toml: no member takes {name}"))
        .collect();
    assert_none(&unused);
}
