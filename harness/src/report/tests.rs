use std::collections::BTreeMap;

use triptych_spec::scene::Size;

use super::*;
use crate::cause::Cause;
use crate::digest::tests::row;
use crate::picture;

const HOSTILE: &str = "</title><script>alert(1)</script>\" onload='x' &amp; \u{202e}\x1b";

fn input() -> ReportInput {
    let size = Size {
        width: 2,
        height: 1,
    };
    let colours = |c| picture::linear(size, &[[c; 3], [0.5; 3]]);
    let shown = |title: &str, image| Picture {
        title: title.to_owned(),
        caption: "what is seen".to_owned(),
        image,
    };
    let bad = Row {
        differ: 3,
        unexplained: 1,
        causes: [(Cause::LostNode, 2)].into(),
        ms_a: Some(1.5),
        again: "cargo triptych replay --exact --seed 7 abuffer/bad".to_owned(),
        ..row("abuffer/bad", "build", "spec", "gpu@x/compute")
    };
    let marks = [(0, Some(Cause::LostNode)), (1, None)];
    let bad = SceneReport {
        name: "abuffer/bad".to_owned(),
        purpose: "shows something".to_owned(),
        rows: vec![bad],
        pictures: vec![
            shown("causes", picture::causes(size, None, marks)),
            shown("embree", picture::counts(size, &[0, 9])),
            shown("spec", colours(0.25)),
            shown("gpu@x/compute", colours(0.25)),
            shown("gpu@y/compute", colours(0.25)),
            shown("gpu@z/compute", colours(0.75)),
        ],
        plan: vec![PlanLine {
            pass: "opaque".to_owned(),
            runs: false,
            reason: "no opaque triangles".to_owned(),
            saved_ms: Some(12.5),
        }],
        differences: vec![Difference {
            words: "lost-node: pixel (0, 0)\nsecond line".to_owned(),
            sides: vec![("spec".to_owned(), vec!["key 7".to_owned()])],
        }],
    };
    let good = SceneReport {
        name: "abuffer/good".to_owned(),
        rows: vec![row("abuffer/good", "build", "spec", "embree")],
        ..SceneReport::default()
    };
    ReportInput {
        run: RunInfo {
            command: "./x replay".to_owned(),
            seconds: 61.0,
            ..RunInfo::default()
        },
        scenes: vec![bad, good],
        mutants: vec![mutants::tests::example()],
        bench: Some(bench::tests::example()),
    }
}

fn count_of(page: &str, what: &str) -> usize {
    page.matches(what).count()
}

#[test]
fn everything_that_was_given_is_shown() {
    let page = page(&input()).into_string();
    let shown = [
        "1 of 2 scenes diverges",
        "shows something",
        "1 min 1 s",
        "lost-node: pixel (0, 0)\nsecond line",
        "key 7",
        "cargo triptych replay --exact --seed 7 abuffer/bad",
        "no opaque triangles",
        "12.5 ms saved",
        "1 without a cause",
        "first at column 1, row 0",
        "1.50 ms",
        "./x replay",
    ];
    for text in shown {
        assert!(page.contains(text), "{text} is missing");
    }
    assert_eq!(
        count_of(&page, " open data-verdict"),
        1,
        "only the bad scene"
    );
}

#[test]
fn equal_pictures_of_gpu_legs_are_shown_once_and_spec_always() {
    let page = page(&input()).into_string();
    assert_eq!(
        count_of(&page, "<figure>"),
        5,
        "six, of which two are the same"
    );
    assert!(page.contains("<strong>gpu@x/compute</strong>, <strong>gpu@y/compute</strong>"));
    assert_eq!(count_of(&page, "byte for byte"), 1);
    let at = |title: &str| page.find(&format!("<strong>{title}</strong>"));
    assert!(at("spec") < at("gpu@z/compute"), "legs in order");
    assert!(at("gpu@z/compute") < at("embree"), "legs in order");
    assert!(at("embree") < at("causes"), "legs before maps");
}

#[test]
fn what_comes_from_outside_is_text() {
    let hostile = || HOSTILE.to_owned();
    let mut input = input();
    let facts = vec![(hostile(), hostile())];
    input.run = RunInfo {
        command: hostile(),
        date: hostile(),
        seconds: 0.0,
        versions: facts.clone(),
        machine: facts.clone(),
        adapters: vec![AdapterInfo {
            name: hostile(),
            facts,
        }],
    };
    let scene = &mut input.scenes[0];
    scene.name = hostile();
    scene.purpose = hostile();
    scene.differences[0].words = hostile();
    scene.differences[0].sides = vec![(hostile(), vec![hostile()])];
    scene.plan[0].pass = hostile();
    scene.plan[0].reason = hostile();
    scene.pictures[0].title = hostile();
    scene.pictures[0].caption = hostile();
    let bad = &mut scene.rows[0];
    (bad.scene, bad.stage, bad.a) = (hostile(), hostile(), hostile());
    (bad.b, bad.unit, bad.note) = (hostile(), hostile(), hostile());
    (bad.skipped, bad.again) = (Some(hostile()), hostile());
    let page = page(&input).into_string();
    assert_eq!(count_of(&page, "<script"), 1, "ours");
    assert!(!page.contains("alert(1)</"), "a closing tag got through");
    assert!(!page.contains("\" onload"), "a quote got through");
    assert!(!page.contains(['\u{202e}', '\x1b']), "a control character");
    assert!(page.contains("&lt;script&gt;alert(1)"), "shown as text");
}

#[test]
fn the_page_needs_nothing_else() {
    let page = page(&input()).into_string();
    for attribute in ["src=\"", "href=\"", "url("] {
        for (at, _) in page.match_indices(attribute) {
            let rest = &page[at + attribute.len()..];
            let own = rest.starts_with("data:image/png;base64,") || rest.starts_with('#');
            assert!(own, "{attribute}{}", &rest[..rest.len().min(60)]);
        }
    }
    assert!(
        !page.contains("http:") && !page.contains("https:"),
        "an address"
    );
    assert!(!STYLE.contains('<') && !STYLE.contains("@import"), "style");
    assert!(!SCRIPT.contains("</") && !SCRIPT.contains("<!--"), "script");
}

#[test]
fn links_lead_somewhere_and_identifiers_are_unique() {
    let page = page(&input()).into_string();
    let mut ids: BTreeMap<&str, usize> = BTreeMap::new();
    for (at, start) in page.match_indices(" id=\"") {
        let rest = &page[at + start.len()..];
        *ids.entry(&rest[..rest.find('"').expect("closed")])
            .or_default() += 1;
    }
    assert!(ids.values().all(|n| *n == 1), "twice: {ids:?}");
    for (at, start) in page.match_indices("href=\"#") {
        let rest = &page[at + start.len()..];
        let id = &rest[..rest.find('"').expect("closed")];
        assert!(ids.contains_key(id), "#{id} leads nowhere");
    }
}

#[test]
fn classes_and_headings_are_accessible() {
    let page = page(&input()).into_string();
    assert_eq!(count_of(&page, "<th>"), 0, "a heading without a scope");
    assert_eq!(count_of(&page, "<img"), count_of(&page, " alt=\""));
    for class in [
        "exact",
        "structure",
        "tie",
        "interval",
        "decision",
        "band",
        "vote",
    ] {
        let known: crate::row::Class = serde_json::from_value(class.into()).expect("a class");
        assert_eq!(glossary::class_name(known), class);
        assert!(page.contains(&format!("id=\"class-{class}\"")), "{class}");
    }
}

#[test]
fn a_budget_is_shown_and_a_broken_one_stands_out() {
    let page_of = |admitted| {
        let mut input = input();
        input.scenes[1].rows[0] = Row {
            admitted,
            admitted_budget: Some(0.01),
            ..row("abuffer/good", "cover", "spec", "embree")
        };
        page(&input).into_string()
    };
    let within = page_of(10);
    assert!(within.contains("10 (1.00 % of 1.00 % allowed)"), "within");
    assert_eq!(count_of(&within, "over budget"), 0, "just within");
    let over = page_of(11);
    assert_eq!(count_of(&over, "over budget"), 2, "index and row");
}

#[test]
fn a_report_of_rows_alone() {
    let asked = |path: &str, mut row: Row| {
        row.again = format!("cargo triptych replay --path {path} a.obj");
        row
    };
    let rows = vec![
        asked("fragment", row("a", "build", "spec", "embree")),
        row("abuffer/b", "build", "spec", "embree"),
        asked("compute", row("a", "build", "spec", "gpu@x/compute")),
        asked("compute", row("a", "sort", "spec", "gpu@x/compute")),
    ];
    let summary = Summary::of(&rows, 7.0);
    let merged = Merged {
        rows,
        summary,
        mutants: Vec::new(),
    };
    let input = ReportInput::from_rows(RunInfo::default(), &merged);
    assert_eq!(input.summary(), merged.summary);
    let page = page(&input).into_string();
    assert!(page.contains("2 scenes agree"), "headline");
    for (command, times) in [
        ("replay --exact --no-cache abuffer/b", 1),
        ("replay --path fragment a.obj", 1),
        ("replay --path compute a.obj", 1),
    ] {
        assert_eq!(count_of(&page, command), times, "{command}");
    }
    assert_eq!(count_of(&page, "<figure"), 0);
}

#[test]
fn nothing_is_never_good_news() {
    let empty = ReportInput::default();
    let page_of = |input: &ReportInput| page(input).into_string();
    let page = page_of(&empty);
    assert!(page.contains("Nothing was compared"), "no scenes");
    assert!(page.contains("verdict diverge"), "not in green");
    let silent = SceneReport {
        name: "abuffer/silent".to_owned(),
        ..SceneReport::default()
    };
    let page = page_of(&ReportInput {
        scenes: vec![silent],
        ..empty
    });
    assert!(page.contains("1 of 1 scene diverges"), "no rows");
    assert!(page.contains("no reason is known"), "no rows");
}

#[test]
fn the_file_appears_whole_and_errors_name_it() {
    let folder = std::env::temp_dir().join(format!("triptych-report-{}", std::process::id()));
    let path = folder.join("out/index.html");
    write(&path, &input()).expect("written");
    write(&path, &input()).expect("written again");
    let names: Vec<_> = fs::read_dir(folder.join("out"))
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name())
        .collect();
    assert_eq!(names, ["index.html"], "nothing is left beside it");
    let blocked = path.join("index.html");
    let error = write(&blocked, &input()).expect_err("a file is in the way");
    fs::remove_dir_all(&folder).expect("removed");
    assert!(
        error.to_string().contains("index.html/index.html: "),
        "{error}"
    );
}
