//! The front of `bench abuffer`: numbers of nearest layers, and all of them in several layouts.

use super::super::paper::{LaidOut, laid_out};
use super::super::{Bench, Row, table};
use super::{Bar, Bars, Line, Panel, Plot};

/// The front of a run.
pub(super) fn plot(bench: &Bench) -> Plot {
    let legs = bench.legs();
    let (date, machine) = (&bench.date, &bench.machine);
    Plot {
        title: "Time against error: A-buffer, nearest layers".to_owned(),
        words: format!(
            "Time against error of the A-buffer with 1, 2, 4, … nearest layers, {date}, {}",
            machine.slug
        ),
        place: format!("{date}, {}", machine.cpu),
        legend: legs.iter().map(|leg| (*leg).to_owned()).collect(),
        panels: bench
            .scenes()
            .iter()
            .map(|scene| panel(bench, &legs, scene))
            .collect(),
        bars: laid_out(bench).iter().map(bars).collect(),
    }
}

fn bars(own: &LaidOut<'_>) -> Bars {
    let bar = |row: &&Row| {
        let bytes = match row.of_fragment {
            Some(bytes) => format!("{bytes} B a fragment, "),
            None => String::new(),
        };
        let parts = [row.of_parts(&["opaque"]), row.build(), row.resolve()];
        let (ms, memory) = (parts.iter().sum::<f64>(), table::mebibytes(row.memory));
        Bar {
            name: row.method.name().to_owned(),
            words: format!("{ms:.2} ms, {bytes}{memory}"),
            parts,
        }
    };
    let leg = |(leg, rows): &(&str, Vec<&Row>)| ((*leg).to_owned(), rows.iter().map(bar).collect());
    Bars {
        heading: format!("{}: all layers, lists in several layouts", own.scene),
        legs: own.legs.iter().map(leg).collect(),
    }
}

fn panel(bench: &Bench, legs: &[&str], scene: &str) -> Panel {
    let rows: Vec<&Row> = bench.fastest().filter(|row| row.scene == scene).collect();
    let line = |(style, leg): (usize, &&str)| Line {
        style,
        points: rows
            .iter()
            .filter(|row| row.leg == *leg)
            .map(|row| (row.time.median, row.psnr))
            .collect(),
    };
    Panel {
        heading: table::heading(bench, scene),
        lines: legs.iter().enumerate().map(line).collect(),
        levels: levels(&rows),
    }
}

/// The numbers of layers, beside where the first leg's points lie.
fn levels(rows: &[&Row]) -> Vec<(Option<f64>, String)> {
    let leg = rows.first().map(|row| row.leg.as_str());
    let mut own: Vec<&&Row> = rows
        .iter()
        .filter(|row| Some(row.leg.as_str()) == leg)
        .collect();
    // All layers first, then one, then the others from there on.
    own.sort_by_key(|row| (!row.all, row.layers));
    let words = |row: &&&Row| match (row.all, row.layers) {
        (true, n) => format!("all {n}"),
        (false, 1) => "1 layer".to_owned(),
        (false, n) => n.to_string(),
    };
    own.iter().map(|row| (row.psnr, words(row))).collect()
}
