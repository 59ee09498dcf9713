use std::sync::{Arc, Mutex};

use super::*;
use crate::cause::Cause;
use crate::digest::tests::row;
use crate::row::Class;

/// An output that tests read while the reporter owns it.
#[derive(Clone, Default)]
struct Page(Arc<Mutex<Vec<u8>>>);

impl Write for Page {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().expect("one thread").write(bytes)
    }
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn printed(width: usize, colour: bool, scenes: &[SceneResult]) -> String {
    let page = Page::default();
    let reporter = Reporter::to(Box::new(page.clone()), width, colour);
    let mut reporter = reporter.with_again(Again {
        legs: Vec::new(),
        options: vec!["--no-skip".to_owned()],
    });
    for scene in scenes {
        reporter.scene_started(&scene.name);
        reporter.scene_done(scene).expect("printed");
    }
    let rows: Vec<Row> = scenes.iter().flat_map(|s| s.rows.clone()).collect();
    let summary = Summary::of(&rows, 12.0);
    let report = Some(Path::new("reports/out/index.html"));
    reporter.finish(&summary, report).expect("printed");
    let bytes = page.0.lock().expect("one thread").clone();
    String::from_utf8(bytes).expect("UTF-8")
}

fn scene(name: &str, rows: Vec<Row>) -> SceneResult {
    SceneResult {
        name: name.to_owned(),
        argument: name.to_owned(),
        purpose: "shows \x1b[2J something".to_owned(),
        rows,
    }
}

fn sample() -> Vec<SceneResult> {
    let pair = |scene, b| Row {
        compared: 1_234_567,
        ..row(scene, "build", "spec", b)
    };
    let bad = Row {
        differ: 12,
        unexplained: 2,
        causes: [(Cause::Overflow, 9), (Cause::Duplicate, 1)].into(),
        note: "first: pixel (1, 2)".to_owned(),
        ..pair("abuffer/b", "gpu@llvmpipe/compute")
    };
    let later = Row {
        stage: "sort".to_owned(),
        ..bad.clone()
    };
    let absent = Row {
        compared: 0,
        skipped: Some("no Embree".to_owned()),
        ..pair("abuffer/b", "embree")
    };
    let edge = Row {
        admitted: 1234,
        admitted_budget: Some(0.01),
        cached: true,
        ms_a: Some(2.5),
        ..pair("abuffer/a", "embree")
    };
    vec![
        scene(
            "abuffer/a",
            vec![pair("abuffer/a", "gpu@llvmpipe/compute"), edge],
        ),
        scene("abuffer/b", vec![bad, later, absent]),
    ]
}

#[test]
fn the_table_on_a_wide_terminal() {
    let expected = "\
✓ agrees, items compared   ✗ items that differ   – skipped, see [n]   c from the cache

                               spec against      llvmpipe        embree
   scene                                          compute                    edge     spec      gpu
───────────────────────────────────────────────────────────────────────────────────────────────────
✓c abuffer/a                                  ✓ 1,234,567   ✓ 1,234,567   0.100 %  2.50 ms
✗  abuffer/b                                         ✗ 12         – [1]
   [1] no Embree
   for: shows \u{fffd}[2J something
   spec against gpu@llvmpipe/compute, build: 12 of 1,234,567 fragments differ; overflow 9, duplicate 1; 2 items without a cause
     first: pixel (1, 2)
     later stages diverge too: sort
     again: cargo triptych replay --exact --leg gpu --adapter llvmpipe --path compute --no-skip abuffer/b

1 of 2 scenes diverges, 4,938,268 items compared, 4 unexplained, 12.0 s
Causes, over all stages: overflow 18, duplicate 2
Counted but not judged (edge, MAY, admitted): 1,234
From the cache: 1 row
Skipped: 1 row
        1  no Embree
Report: reports/out/index.html
";
    let actual = printed(120, false, &sample());
    assert_eq!(actual, expected, "\n{actual}");
}

#[test]
fn no_line_of_the_table_is_wider_than_the_window() {
    let mut ruled = 0;
    for width in 40..160 {
        let text = printed(width, false, &sample());
        if !text.contains('─') {
            continue;
        }
        ruled += 1;
        let table = text.split("   for:").next().expect("the table comes first");
        for line in table.lines() {
            let wide = console::measure_text_width(line);
            assert!(wide <= width, "{wide} > {width}: {line}");
        }
    }
    assert!(ruled > 90, "columns fit in nearly every window: {ruled}");
}

/// A stage with two rows that diverge is one stage, and no later one than itself.
#[test]
fn stages_that_diverge_are_told_once() {
    let diverges = |stage: &str| Row {
        differ: 1,
        unexplained: 1,
        ..row("rsm/a", stage, "spec", "gpu@llvmpipe/compute")
    };
    let rows = ["block", "block", "end to end", "end to end"].map(diverges);
    let text = printed(120, false, &[scene("rsm/a", rows.to_vec())]);
    let later: Vec<&str> = text
        .lines()
        .filter(|l| l.contains("later stages"))
        .collect();
    assert_eq!(later, ["     later stages diverge too: end to end"]);
}

#[test]
fn a_narrow_window_gets_sentences_and_full_names() {
    let text = printed(36, false, &sample());
    assert!(
        text.contains("✓c abuffer/a, 2 of 2 pairs agree, 2.46M items, edge 0.100 %"),
        "{text}"
    );
    assert!(
        text.contains("✗  abuffer/b, 1 of 2 pairs diverge, 2.46M items, – embree [1]"),
        "{text}"
    );
    let long = "abuffer/a-name-that-is-longer-than-any-column-of-names";
    let text = printed(
        120,
        false,
        &[scene(long, vec![row(long, "sort", "spec", "embree")])],
    );
    let own_line = format!("\n✓  {long}\n");
    assert!(text.contains(&own_line), "{text}");
}

#[test]
fn escape_codes_come_from_us_or_not_at_all() {
    let mut hostile = sample();
    hostile[1].name = "\x1b]0;title\x07".to_owned();
    hostile[1].rows[0].note = "a\x1b[31mb\r\nc".to_owned();
    hostile[1].rows[0].b = "gpu@\x1b[5m/x".to_owned();
    hostile[1].rows[2].skipped = Some("\x1b[1mno".to_owned());
    let plain = printed(100, false, &hostile);
    let control = |c: char| c.is_control() && c != '\n';
    assert!(!plain.contains(control), "{plain:?}");
    let coloured = printed(100, true, &hostile);
    assert!(
        coloured.contains("\x1b["),
        "colours where they are asked for"
    );
    assert_eq!(console::strip_ansi_codes(&coloured), plain, "only colours");
}

#[test]
fn nothing_compared_is_not_good_news() {
    let nothing = printed(100, false, &[scene("abuffer/a", vec![])]);
    assert!(nothing.contains("✗  abuffer/a"), "{nothing}");
    assert!(nothing.contains("no reason is known"), "{nothing}");
    assert!(nothing.contains("1 of 1 scene diverges"), "{nothing}");
    let skipped = Row {
        compared: 0,
        skipped: Some("no adapter".to_owned()),
        ..row("abuffer/a", "build", "spec", "gpu")
    };
    let skipped = printed(100, false, &[scene("abuffer/a", vec![skipped])]);
    assert!(
        skipped.contains("Nothing was compared, 0 items"),
        "{skipped}"
    );
    assert!(!skipped.contains("agree:"), "{skipped}");
}

#[test]
fn a_broken_budget_says_so() {
    let mut over = Row {
        admitted: 100,
        admitted_budget: Some(0.001),
        ..row("abuffer/a", "cover", "spec", "embree")
    };
    let told = "10.0 % not judged, the budget is 0.100 %";
    let key = "; budget.edge in its scene.toml states another";
    for (class, key) in [(Class::Vote, key), (Class::Decision, "")] {
        over.class = class;
        let text = printed(200, false, &[scene("abuffer/a", vec![over.clone()])]);
        assert!(text.contains(&format!("{told}{key}\n")), "{text}");
        assert!(text.contains("10.0 %!"), "{text}");
    }
}

#[test]
fn a_pair_that_turns_up_late_gets_a_new_header() {
    let scenes = [
        scene(
            "abuffer/a",
            vec![row("abuffer/a", "sort", "spec", "embree")],
        ),
        scene(
            "abuffer/b",
            vec![row("abuffer/b", "sort", "spec", "gpu@x/compute")],
        ),
    ];
    let text = printed(100, false, &scenes);
    assert_eq!(text.matches("scene  ").count(), 2, "{text}");
}

#[test]
fn columns_that_look_alike_are_told_apart_below_the_legend() {
    let against = |a, b| row("abuffer/a", "sort", a, b);
    let rows = vec![
        against("spec", "gpu@a-long-adapter-name-1/compute"),
        against("spec", "gpu@a-long-adapter-name-2/compute"),
        against("gpu@x/compute", "gpu@x/fragment"),
        against("spec", "embree"),
    ];
    let text = printed(80, false, &[scene("abuffer/a", rows)]);
    assert!(text.contains("column 1: spec against gpu@a-long-adapter-name-1/compute\n"));
    assert!(text.contains("column 4: gpu@x/compute against gpu@x/fragment\n"));
    assert!(!text.contains("column 3"), "embree is clear: {text}");
}

/// However many legs test skipping, they share a column; what diverges is named.
#[test]
fn legs_against_themselves_share_a_column() {
    let plan = |leg: &str, differ| Row {
        differ,
        causes: [(Cause::LostNode, differ)]
            .into_iter()
            .filter(|c| c.1 > 0)
            .collect(),
        ..row("abuffer/a", "plan", leg, &format!("{leg} --no-skip"))
    };
    let built =
        ["gpu@x/compute", "gpu@y/fragment"].map(|leg| row("abuffer/a", "build", "spec", leg));
    for (differ, cell) in [(0, "✓ 2,000"), (3, "✗ 7")] {
        let mut rows = built.to_vec();
        rows.extend([
            plan("gpu@x/compute", differ),
            plan("gpu@y/fragment", differ + differ / 3),
        ]);
        let text = printed(120, false, &[scene("abuffer/a", rows)]);
        let line = "column 3: each GPU leg against itself with --no-skip\n";
        assert!(text.contains(line), "{text}");
        let header = text
            .lines()
            .find(|l| l.contains("against  "))
            .expect("a header");
        let names: Vec<&str> = header.split_whitespace().collect();
        assert_eq!(names, ["spec", "against", "x", "y", "plan"], "{text}");
        let cells = text
            .lines()
            .find(|l| l.contains("  abuffer/a "))
            .expect("its line");
        assert!(cells.trim_end().ends_with(cell), "{cells} lacks {cell}");
        let told = "gpu@y/fragment against gpu@y/fragment --no-skip, plan: 4 of 1,000";
        assert_eq!(text.contains(told), differ > 0, "{text}");
    }
}

#[test]
fn the_progress_bar_has_a_valid_template() {
    for colour in [false, true] {
        let _ = style(colour);
    }
}
