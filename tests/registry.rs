//! The registry and the code say the same: stems, stages of the spec, entry points,
//! passes of a plan, names on the command line.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use naga::ShaderStage;
use triptych_gpu::wgsl::Sources;
use triptych_harness::corpus::FINDINGS;
use triptych_harness::plan::Plan;
use triptych_harness::registry::{
    Chain, FAMILIES, Family, MEASURED, PLACE, PLACE_HANDED, stages, stages_of,
};
use triptych_spec::scene::{Scene, Size};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("")
}

/// Files of a folder with an extension, sorted; none if there is no such folder.
fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let paths = entries.map(|e| e.expect("a folder can be listed").path());
    let mut paths: Vec<PathBuf> = paths
        .filter(|p| p.extension().is_some_and(|e| e == extension))
        .collect();
    paths.sort();
    paths
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Functions whose documentation begins with "Stage `name`", with that name.
fn documented_stages(family: &Family) -> Vec<(String, String)> {
    documented(family, "/// Stage `")
}

/// Functions whose documentation begins so, with the name that follows.
fn documented(family: &Family, beginning: &str) -> Vec<(String, String)> {
    let source = root().join("spec/src").join(family.name);
    let mut paths = vec![source.with_extension("rs")];
    paths.extend(files(&source, "rs"));
    let mut stages = Vec::new();
    for path in paths {
        let mut named: Option<String> = None;
        for line in read(&path).lines() {
            if let Some(rest) = line.strip_prefix(beginning) {
                named = rest.split('`').next().map(str::to_owned);
            } else if let Some(rest) = line.strip_prefix("pub fn ") {
                let end = rest.find(['(', '<']).expect("a function has parameters");
                stages.extend(named.take().map(|named| (named, rest[..end].to_owned())));
            } else if !line.starts_with("///") {
                named = None;
            }
        }
    }
    stages.sort();
    stages
}

#[test]
fn stages_are_functions_of_the_spec() {
    for family in FAMILIES {
        let name = |s: &triptych_harness::registry::Stage| (s.name.to_owned(), s.name.to_owned());
        let mut listed: Vec<_> = family.stages.iter().map(name).collect();
        listed.sort();
        assert_eq!(
            documented_stages(family),
            listed,
            "spec/src/{0}.rs (documented stage, function) against the registry's {0}",
            family.name
        );
    }
}

#[test]
fn entry_points_are_those_of_the_wgsl() {
    let families = FAMILIES.iter().filter(|family| family.has_twins());
    for (family, native) in families.flat_map(|f| [(f, false), (f, true)]) {
        let files = family.files.iter().chain([&family.name]);
        let modules: Vec<_> = files
            .map(|file| {
                let linked = Sources::shipped(native).link(file);
                let program = linked.and_then(triptych_gpu::wgsl::Linked::parse);
                program.unwrap_or_else(|e| panic!("{e}")).module
            })
            .collect();
        let points = || modules.iter().flat_map(|module| &module.entry_points);
        let entries = |stage: ShaderStage| -> BTreeSet<&str> {
            let all = points().filter(|e| e.stage == stage);
            all.map(|e| e.name.as_str()).collect()
        };
        let of = |twin: fn(&triptych_harness::registry::Stage) -> &'static [&'static str]| {
            let all = family.stages.iter().flat_map(twin).copied();
            all.collect::<BTreeSet<&str>>()
        };
        let fragment = of(|s| s.fragment.entries());
        let place = (!fragment.is_empty()).then_some([PLACE, PLACE_HANDED]);
        let name = family.name;
        assert_eq!(
            entries(ShaderStage::Compute),
            of(|s| s.compute.entries()),
            "{name}, compute"
        );
        assert_eq!(entries(ShaderStage::Fragment), fragment, "{name}, fragment");
        assert_eq!(
            entries(ShaderStage::Vertex),
            place.into_iter().flatten().collect(),
            "{name}, vertex"
        );
        let stages = [
            ShaderStage::Compute,
            ShaderStage::Fragment,
            ShaderStage::Vertex,
        ];
        assert!(
            points().all(|e| stages.contains(&e.stage)),
            "{name}: an entry point of another kind"
        );
    }
}

/// What is measured beside the stages: its entry points, and what the spec says of it.
#[test]
fn measured_kernels_are_those_of_the_wgsl() {
    let compute = |file: &str| -> BTreeSet<String> {
        let program = Sources::shipped(false).link(file);
        let program = program.and_then(triptych_gpu::wgsl::Linked::parse);
        let module = program.unwrap_or_else(|e| panic!("{e}")).module;
        let all = module.entry_points.iter();
        let compute = all.filter(|e| e.stage == ShaderStage::Compute);
        compute.map(|e| e.name.clone()).collect()
    };
    for measured in MEASURED {
        let others = measured.over.map(compute).unwrap_or_default();
        let own: BTreeSet<String> = compute(measured.file)
            .difference(&others)
            .cloned()
            .collect();
        let listed: BTreeSet<String> = measured.entries.iter().map(|e| (*e).to_owned()).collect();
        assert_eq!(own, listed, "{}", measured.file);
    }
    let of_spec = FAMILIES
        .iter()
        .flat_map(|f| documented(f, "/// Technique `"));
    let listed = MEASURED.iter().filter_map(|m| m.spec);
    let listed: Vec<_> = listed.map(|s| (s.to_owned(), s.to_owned())).collect();
    assert_eq!(
        of_spec.collect::<Vec<_>>(),
        listed,
        "techniques of the spec"
    );
}

/// Of the A-buffer's fragments that are tested before they run.
const EARLY: &str = "early";

/// Only a family's own file, what is measured, place.wgsl and early.wgsl may have entry points: what is in
/// others would be seen by no family, or by several.
#[test]
fn entry_points_are_in_the_families_files() {
    let mut checked = 0;
    for path in files(&root().join("gpu/src"), "wgsl") {
        let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned());
        let stem = stem.expect("a file has a name");
        let kinds = ["@compute", "@fragment", "@vertex"];
        let text = read(&path);
        let has = text.lines().any(|l| kinds.iter().any(|k| l.starts_with(k)));
        let measured = MEASURED.iter().any(|m| m.file == stem);
        let may = [PLACE, EARLY].contains(&stem.as_str())
            || measured
            || FAMILIES
                .iter()
                .any(|f| f.name == stem || f.files.contains(&stem.as_str()));
        assert_eq!(
            has,
            may,
            "{} has entry points: {has}; may have: {may}",
            path.display()
        );
        checked += 1;
    }
    assert!(
        checked > FAMILIES.len(),
        "{checked} files of WGSL are not all"
    );
}

#[test]
fn families_have_one_stem() {
    for family in FAMILIES {
        let name = family.name;
        for file in [
            format!("spec/src/{name}.rs"),
            format!("tests/laws/{name}.rs"),
        ] {
            assert!(root().join(&file).is_file(), "{file} is missing");
        }
        // Kernels that are there and listed nowhere would be seen by no test.
        for file in [format!("gpu/src/{name}.rs"), format!("gpu/src/{name}.wgsl")] {
            let is_there = root().join(&file).is_file();
            assert_eq!(is_there, family.has_twins(), "{file} is there");
        }
        let corpus = root().join("corpus").join(name).is_dir();
        assert_eq!(
            corpus,
            family.no_corpus.is_none(),
            "corpus/{name} exists: {corpus}"
        );
    }
    for folder in ["corpus", "tests/snapshots"] {
        let Ok(entries) = fs::read_dir(root().join(folder)) else {
            continue;
        };
        for entry in entries {
            let entry = entry.expect("a folder can be listed");
            let name = entry.file_name().to_string_lossy().into_owned();
            // What drivers do wrong is a folder of the corpus, and no family.
            let findings = folder == "corpus" && name == FINDINGS;
            let known = findings || FAMILIES.iter().any(|f| f.name == name);
            let is_dir = entry.path().is_dir();
            assert!(!is_dir || known, "{folder}/{name} is no family");
        }
    }
}

#[test]
fn names_are_unique() {
    let names: Vec<&str> = stages().map(|s| s.name).collect();
    let unique: BTreeSet<&str> = names.iter().copied().collect();
    assert_eq!(names.len(), unique.len(), "{names:?}");
}

/// A plan has a pass for each stage, in the order of the registry.
#[test]
fn passes_are_stages() {
    let scene = Scene {
        samples: triptych_spec::raster::Samples::ONE,
        order: triptych_spec::abuffer::Order::Centroid,
        size: Size {
            width: 1,
            height: 1,
        },
        instances: Vec::new(),
        vertices: Vec::new(),
        triangles: Vec::new(),
        background: [0.0; 3],
    };
    let plan = Plan::new(&scene, false);
    let passes: Vec<&str> = plan.passes.iter().map(|p| p.name).collect();
    let mut expected: Vec<&str> = stages_of(Chain::Frame).map(|s| s.name).collect();
    // A condition inside stage build, which a plan decides on like a pass.
    expected.push("depth test");
    assert_eq!(passes, expected, "passes against stages");
}
