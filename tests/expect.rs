//! The corpus says true things: every scene loads, and closed-form answers agree
//! with the spec.

use std::time::Instant;

use triptych_harness::corpus;
use triptych_harness::scene::{LoadError, Loaded, expect, load_entry};
use triptych_spec::vertex::SUBPIXEL_BITS;
use triptych_spec::{abuffer, vertex};

/// What the spec contradicts, and the number of transparent fragments.
fn check(loaded: &Loaded) -> (Vec<String>, usize) {
    let scene = &loaded.scene;
    let primitives = vertex::primitives(scene, SUBPIXEL_BITS);
    let opaque = abuffer::opaque(scene, &primitives);
    let lists = abuffer::build(scene, &primitives, &opaque, true, u32::MAX);
    let sorted = abuffer::sort(&lists);
    let wrong = expect::check(&loaded.file.expect, scene, &primitives, &opaque, &sorted);
    let fragments = sorted.fragments.len();
    (wrong, fragments)
}

#[test]
fn the_corpus_agrees_with_its_closed_forms() {
    let entries = corpus::list(&corpus::root()).expect("the corpus is sound");
    assert!(entries.len() >= 28, "only {} scenes", entries.len());
    let (mut wrong, mut missing, mut total) = (Vec::new(), Vec::new(), 0);
    for entry in &entries {
        let start = Instant::now();
        let loaded = match load_entry(entry, None) {
            Ok(loaded) => loaded,
            Err(LoadError::Input(e)) => {
                wrong.push(e.to_string());
                continue;
            }
            Err(missing_mesh @ LoadError::Missing { .. }) => {
                missing.push(format!("{}: {missing_mesh}", entry.name));
                continue;
            }
        };
        let loading = start.elapsed().as_secs_f64();
        let (contradictions, fragments) = check(&loaded);
        wrong.extend(
            contradictions
                .iter()
                .map(|c| format!("{}: {c}", entry.name)),
        );
        total += fragments;
        println!(
            "{:<32} {:>8} triangles {fragments:>9} fragments, {loading:.2} s loading, {:.2} s in all",
            entry.name,
            loaded.stats.triangles,
            start.elapsed().as_secs_f64(),
        );
    }
    println!(
        "{total} fragments, {} scenes without their mesh",
        missing.len()
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // What the whole corpus may cost: half a minute on lavapipe's slowest path.
    assert!(total < 25_000_000, "{total} fragments are too many");
}

#[test]
fn the_readme_says_what_each_scene_is_for() {
    let root = corpus::root();
    let readme = std::fs::read_to_string(root.join("README.md")).expect("the corpus has a README");
    for entry in corpus::list(&root).expect("the corpus is sound") {
        let text = std::fs::read_to_string(&entry.path).expect("a scene is text");
        let purpose = text.lines().find_map(|l| l.strip_prefix("purpose = "));
        let purpose = purpose.expect("purpose stands on a line of its own");
        let case = entry.name.trim_start_matches(&entry.family);
        let row = format!("| `{}` | {} |", &case[1..], purpose.trim_matches('"'));
        assert!(
            readme.contains(&row),
            "corpus/README.md needs the row {row}"
        );
    }
}
