//! Lanes side by side.

use std::path::Path as File;
use std::time::Duration;

use super::*;
use crate::cause::Cause;
use crate::corpus::Entry;
use crate::mesh::Intake;
use crate::replay::Options;
use crate::replay::rows::Spot;
use crate::scene::{Loaded, load_text};

fn nothing() -> Loaded {
    let entry = Entry::outside(File::new("a/b/scene.toml"));
    let text = "purpose = \"nothing\"\nsize = [4, 4]\nmesh = []\n";
    load_text(&mut Intake::from_disk(), &entry, None, text).unwrap_or_else(|e| panic!("{e}"))
}

/// Notes its name, later than pieces of other lanes that are given after it.
fn noted<'a>(lane: usize, name: &'static str, wait: u64) -> Task<'a> {
    let work = move |run: &mut Run<'a>| {
        thread::sleep(Duration::from_millis(wait));
        run.rows
            .skip("all", "spec", name, Class::Exact, String::new());
        run.rows.seen_by.push(("all".into(), name.into()));
        run.rows.spots.push(Spot {
            pixel: 0,
            cause: Cause::Coverage,
            by: run.rows.seen_by.len() - 1,
        });
        Ok(())
    };
    Task {
        lane,
        work: Box::new(work),
    }
}

#[test]
fn what_comes_of_lanes_is_in_the_order_of_the_pieces() {
    let (loaded, options) = (nothing(), Options::default());
    let mut run = Run::new(&loaded, &[], &options);
    let tasks = vec![
        noted(1, "a", 30),
        noted(0, "b", 0),
        noted(2, "c", 10),
        noted(1, "d", 0),
        noted(0, "e", 0),
    ];
    assert!(run.side_by_side(tasks).is_ok());
    let rows: Vec<&str> = run.rows.rows.iter().map(|row| row.b.as_str()).collect();
    assert_eq!(rows, ["a", "b", "c", "d", "e"]);
    let by = |spot: &Spot| run.rows.seen_by[spot.by].1.clone();
    let spots: Vec<String> = run.rows.spots.iter().map(by).collect();
    assert_eq!(spots, rows, "each differs in its own leg");
}

#[test]
fn the_first_piece_that_stops_is_told() {
    let (loaded, options) = (nothing(), Options::default());
    let mut run = Run::new(&loaded, &[], &options);
    let stops = |lane, words: &'static str, wait| Task {
        lane,
        work: Box::new(move |_: &mut Run<'_>| {
            thread::sleep(Duration::from_millis(wait));
            Err(Stop::Input(words.to_owned().into()))
        }),
    };
    let tasks = vec![stops(1, "first", 30), stops(0, "second", 0)];
    let Err(Stop::Input(mistake)) = run.side_by_side(tasks) else {
        panic!("it stops");
    };
    assert_eq!(mistake.message, "first");
}
