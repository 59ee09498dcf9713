use std::collections::BTreeMap;

mod mutants;

use super::*;
use crate::cause::Cause;
use crate::row::Class;

fn row(scene: &str, compared: u64, differ: u64) -> Row {
    let cause = (differ > 0).then_some((Cause::LostNode, differ));
    Row {
        scene: scene.to_owned(),
        family: "abuffer".to_owned(),
        stage: "build".to_owned(),
        a: "spec".to_owned(),
        b: "gpu@llvmpipe/fragment".to_owned(),
        class: Class::Structure,
        unit: "fragments".to_owned(),
        compared,
        differ,
        causes: cause.into_iter().collect::<BTreeMap<_, _>>(),
        unexplained: 0,
        admitted: compared.min(3),
        admitted_budget: Some(0.001),
        error: Some(0.5),
        error_over_bound: Some(0.25),
        skipped: (compared == 0).then(|| "no \"mesh\"\n".to_owned()),
        cached: true,
        ms_a: Some(1.5),
        ms_b: None,
        again: String::new(),
        note: "é \u{1f}".to_owned(),
    }
}

fn written(rows: &[Row], seconds: f64) -> (String, Summary) {
    let mut out = Vec::new();
    let mut writer = Writer::new(&mut out);
    writer.rows(rows).expect("written");
    let summary = writer.finish(seconds).expect("finished");
    (String::from_utf8(out).expect("JSON is UTF-8"), summary)
}

fn parse(text: &str) -> Result<(Vec<Row>, f64), InputError> {
    let mut lines = Lines::default();
    let seconds = read_run(Path::new("a.jsonl"), text.as_bytes(), &mut lines)?;
    Ok((lines.rows, seconds))
}

fn message(text: &str) -> String {
    parse(text).expect_err("must be refused").to_string()
}

#[test]
fn the_fields_are_the_documented_ones() {
    let (text, _) = written(&[row("abuffer/x", 10_000, 1)], 2.0);
    let lines: Vec<BTreeMap<String, serde_json::Value>> = text
        .lines()
        .map(|l| serde_json::from_str(l).expect("an object"))
        .collect();
    let interface = [
        "scene",
        "family",
        "stage",
        "a",
        "b",
        "class",
        "compared",
        "differ",
        "causes",
        "unexplained",
        "skipped",
        "cached",
        "ms_a",
        "ms_b",
    ];
    for field in interface {
        assert!(lines[0].contains_key(field), "`{field}` is missing");
    }
    assert_eq!(lines[0]["type"], "row");
    assert_eq!(lines[0]["causes"], serde_json::json!({"lost-node": 1}));
    assert_eq!(lines[0]["skipped"], serde_json::Value::Null);
    assert_eq!(lines[1]["type"], "summary");
    for field in ["scenes", "compared", "unexplained", "skipped", "seconds"] {
        assert!(lines[1].contains_key(field), "`{field}` is missing");
    }
}

#[test]
fn rows_come_back_as_they_were() {
    let rows = [row("a", 1 << 60, 0), row("b", 0, 0), row("c", 5, 5)];
    let (text, summary) = written(&rows, 1.25);
    assert_eq!(summary.diverging, 1, "c differs; a is within its budget");
    assert_eq!(parse(&text), Ok((rows.to_vec(), 1.25)));
    let windows = format!("\u{feff}{}", text.replace('\n', "\r\n\r\n"));
    assert_eq!(parse(&windows), Ok((rows.to_vec(), 1.25)), "CRLF, a mark");
}

#[test]
fn several_files_merge_into_one_summary() {
    let folder = std::env::temp_dir().join(format!("triptych-json-{}", std::process::id()));
    let paths = ["1/a.jsonl", "2/b.jsonl"].map(|name| folder.join(name));
    for (path, scene) in paths.iter().zip(["a", "b"]) {
        let mut writer = Writer::create(path).expect("created");
        writer.rows(&[row("both", 100_000, 0)]).expect("written");
        writer.rows(&[row(scene, 1, 1)]).expect("written");
        writer.finish(2.0).expect("finished");
    }
    let merged = read(&paths).expect("read");
    std::fs::remove_dir_all(&folder).expect("removed");
    let scenes: Vec<_> = merged.rows.iter().map(|r| r.scene.as_str()).collect();
    assert_eq!(scenes, ["both", "a", "both", "b"]);
    let expected = Summary {
        scenes: 3,
        compared: 200_002,
        unexplained: 0,
        skipped: 0,
        seconds: 4.0,
        diverging: 2,
    };
    assert_eq!(merged.summary, expected);
}

#[test]
fn malformed_lines_are_named_by_file_and_line() {
    let (text, _) = written(&[row("a", 9_000, 0)], 1.0);
    let good = text.lines().next().expect("a row");
    let cases = [
        (
            good.replace("\"stage\"", "\"stagey\""),
            "missing field `stage`",
        ),
        (
            good.replace("\"type\":\"row\",", ""),
            "missing field `type`",
        ),
        (
            good.replace("\"row\"", "\"rows\""),
            "unknown variant `rows`",
        ),
        (good.replace("9000", "-1"), "`-1`"),
        (
            good.replace("structure", "strict"),
            "unknown variant `strict`",
        ),
        (good[..50].to_owned(), "column 50: EOF"),
        ("[1]".to_owned(), "not a result line"),
    ];
    for (bad, expected) in cases {
        let said = message(&format!("{good}\n{bad}\n"));
        assert!(said.starts_with("a.jsonl:2: not a result line"), "{said}");
        assert!(said.contains(expected), "{said} lacks {expected}");
        assert!(!said.contains("at line"), "a second line number: {said}");
    }
    let unknown = text.replace("\"stage\"", "\"later_field\":[1],\"stage\"");
    assert!(parse(&unknown).is_ok(), "unknown fields are tolerated");
}

#[test]
fn what_is_incomplete_does_not_merge() {
    let rows = [row("a", 9_000, 0), row("b", 7_000, 0)];
    let (text, _) = written(&rows, 1.0);
    let lines: Vec<&str> = text.lines().collect();
    assert!(message("").contains("without a summary"), "empty");
    let cut = lines[..2].join("\n");
    assert!(message(&cut).contains("without a summary"), "cut off");
    let lost = [lines[0], lines[2]].join("\n");
    assert!(message(&lost).contains("`scenes` 2, the rows above it amount to 1"));
    let twice = format!("{text}{text}");
    let (both, seconds) = parse(&twice).expect("concatenated files");
    assert_eq!((both.len(), seconds), (4, 2.0));
    let more = format!("{text}{}", lines[0]);
    assert!(
        message(&more).contains("without a summary"),
        "rows after it"
    );
}

#[test]
fn a_line_without_end_is_refused() {
    let said = message(&"x".repeat(LINE_MAX + 1));
    assert!(said.starts_with("a.jsonl:1: a line of more than"), "{said}");
}
