//! Runs of mutants among the lines.

use super::*;
use crate::mutants::{Matrix, Outcome};

fn run() -> MutantRun {
    let cell = |leg: &str, outcome| Cell {
        mutant: "farthest-first".into(),
        defect: "sorted from back to front".into(),
        scene: "abuffer/quads".into(),
        leg: leg.into(),
        outcome,
        causes: [(Cause::SortOrder, 7)].into(),
        unexplained: 0,
        stages: [].into(),
        note: String::new(),
    };
    let cells = vec![
        cell("gpu@a/compute", Outcome::Result),
        cell("gpu@a/fragment", Outcome::NotObservable),
    ];
    MutantRun {
        matrix: Matrix::of(&cells, 3.0, "2026-01-02".into()),
        cells,
    }
}

fn text(run: &MutantRun) -> String {
    let name = format!("triptych-mutants-{:?}", std::thread::current().id());
    let path = std::env::temp_dir().join(format!("{name}-{}", std::process::id()));
    write_mutants(&path, run).expect("written");
    let text = std::fs::read_to_string(&path).expect("read");
    std::fs::remove_file(&path).expect("removed");
    text
}

fn lines(text: &str) -> Result<Lines, InputError> {
    let mut lines = Lines::default();
    read_run(Path::new("m.json"), text.as_bytes(), &mut lines)?;
    Ok(lines)
}

#[test]
fn mutants_come_back_as_they_were() {
    let run = run();
    let text = text(&run);
    assert_eq!(
        lines(&text).map(|l| l.mutants).ok(),
        Some(vec![run.clone()])
    );
    let first: serde_json::Value =
        serde_json::from_str(text.lines().next().expect("a line")).expect("an object");
    assert_eq!(first["type"], "mutant");
    assert_eq!(first["outcome"], "result");
    // Beside a replay, before or after it.
    let (replay, _) = written(&[row("a", 5, 0)], 2.0);
    for both in [format!("{text}{replay}"), format!("{replay}{text}")] {
        let read = lines(&both).expect("two runs in a file");
        assert_eq!((read.rows.len(), read.mutants.len()), (1, 1));
    }
}

#[test]
fn mutants_that_were_lost_are_missed() {
    let text = text(&run());
    let (first, rest) = text.split_once('\n').expect("lines");
    let refused = |text: &str| lines(text).err().expect("must be refused").to_string();
    let message = refused(rest);
    assert!(
        message.starts_with("m.json:2: the summary of the mutants"),
        "{message}"
    );
    assert!(refused(first).contains("cut off"), "no summary");
    let (replay, _) = written(&[row("a", 5, 0)], 2.0);
    assert!(
        refused(&format!("{first}\n{replay}")).contains("cut off"),
        "no summary of theirs"
    );
}
