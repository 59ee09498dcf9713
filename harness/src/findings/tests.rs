//! Findings are read, seen on the drivers that they name, and an error once they are not.

use super::*;
use crate::mutants::Lab;
use crate::replay::gpu::Adapters;

fn all() -> Vec<Finding> {
    list(&corpus::root()).expect("the findings are sound")
}

/// Each on every adapter: those that it names show it, the others agree.
#[test]
fn every_finding_is_seen_where_it_says() {
    let Adapters { open, .. } = Adapters::open(&[]);
    assert!(open.len() >= 2, "`./x setup` installs two drivers");
    let mut lab = Lab::new(open);
    let findings = all();
    assert!(findings.len() >= 3, "they are there");
    for finding in findings {
        let cells = lab.run(&finding.case).expect("it runs");
        assert_eq!(finding.judge(&cells), [""; 0]);
        let shows = cells.iter().filter(|c| c.outcome.kills()).count();
        let agrees = cells.iter().filter(|c| !c.outcome.kills()).count();
        assert!(
            shows > 0 && agrees > 0,
            "one driver of each kind: {cells:?}"
        );

        // A driver that has been fixed is one that is named and agrees; and one that is
        // not named, and shows it, is news.
        let turned = |drivers: &[&str]| Finding {
            drivers: drivers.iter().map(|d| (*d).to_owned()).collect(),
            allowed: false,
            ..finding.clone()
        };
        let name = &finding.case.name;
        let said = turned(&["swiftshader"]).judge(&cells);
        let fixed = format!(
            "does not show {name} any more: the driver has been fixed; remove the finding \
             corpus/findings/{name}"
        );
        assert_eq!(
            said.iter().filter(|line| line.ends_with(&fixed)).count(),
            agrees
        );
        let news = format!("shows {name}, too, and is none of its drivers");
        assert_eq!(
            said.iter().filter(|line| line.contains(&news)).count(),
            shows
        );
        assert_eq!(said.len(), agrees + shows, "{said:?}");
        let lawful = Finding {
            allowed: true,
            ..turned(&["swiftshader"])
        };
        assert_eq!(
            lawful.judge(&cells).len(),
            agrees,
            "no news where it is allowed"
        );
    }
}

#[test]
fn another_stage_or_cause_is_not_what_was_found() {
    let finding = all().swap_remove(0);
    let cell = |stage: &str, cause| Cell {
        outcome: Outcome::of(cause),
        causes: [(cause, 1)].into(),
        stages: [stage.to_owned()].into(),
        ..Cell::blank(
            &finding.case,
            "gpu@llvmpipe/compute".to_owned(),
            String::new(),
        )
    };
    let (stage, cause) = (finding.case.stage.as_deref(), finding.case.cause);
    let (stage, cause) = (stage.expect("stated"), cause.expect("stated"));
    assert_eq!(finding.judge(&[cell(stage, cause)]), [""; 0]);
    let others = [
        cell("snap", cause),
        cell(stage, crate::cause::Cause::TieOrder),
    ];
    for other in others {
        let said = finding.judge(&[other]);
        assert!(said[0].contains("otherwise"), "{said:?}");
    }
}

#[test]
fn a_mistake_in_a_finding_is_told() {
    let root = std::env::temp_dir().join(format!("triptych-findings-{}", std::process::id()));
    assert!(list(&root).is_ok_and(|none| none.is_empty()), "no folder");
    let folder = root.join("findings/x");
    std::fs::create_dir_all(&folder).expect("the temporary folder is writable");
    let told = || list(&root).expect_err("a mistake").to_string();
    assert!(
        told().ends_with("finding.toml: does not exist"),
        "{}",
        told()
    );
    let text = "drivers = []\nknown = \"\"\nreason = \"\"\n[case]\nname = \"y\"\ndefect = \"\"\n";
    std::fs::write(folder.join("finding.toml"), text).expect("writable");
    assert!(
        told().ends_with("must be called x, and state a cause"),
        "{}",
        told()
    );
    std::fs::write(folder.join("finding.toml"), "driver = 1\n").expect("writable");
    assert!(told().contains("unknown field"), "{}", told());
    std::fs::remove_dir_all(&root).expect("it was made here");
}
