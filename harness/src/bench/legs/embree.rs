//! The Embree leg beside bare calls.

use rayon::prelude::*;
use triptych_spec::vertex::{Primitives, SUBPIXEL_BITS, primitives};

use super::super::{Progress, WARM_UP};
use super::{Row, Taken, order};
use crate::compare::embree::{BAND, EmbreeVote, compare};
use crate::embree::bare::Bare;
use crate::embree::{EmbreeError, EmbreeScene, RayHits};
use crate::replay::spec::timed;
use crate::scene::Loaded;

/// How Embree is asked: bare and as a replay does, on one thread and on all.
const NAMES: [&str; 4] = [
    "bare rtcIntersect1, one thread",
    "hits, one thread",
    "bare rtcIntersect1, all threads",
    "the whole leg, all threads",
];

/// What each is held against, by its number.
const AGAINST: [Option<usize>; 4] = [None, Some(0), None, Some(2)];

/// How much longer than bare calls the leg may take.
const MOST: f64 = 1.5;

/// Measures a scene.
///
/// # Errors
/// Why it cannot be measured.
pub(super) fn measure(loaded: &Loaded, runs: u32, progress: &Progress) -> Result<Vec<Row>, String> {
    let spec = primitives(&loaded.scene, SUBPIXEL_BITS);
    let embree = EmbreeScene::new(&spec).map_err(|error| error.to_string())?;
    let calls = Bare::snapped(&spec).map_err(|error| error.to_string())?;
    let hits = bare(&calls, &spec, 0..spec.size.height);
    if hits == 0 {
        return Err("Embree hits nothing".to_owned());
    }
    let mut taken = NAMES.map(|name| Taken::new(name, "host", hits));
    progress.begin(&format!("{}: Embree", loaded.name), WARM_UP + runs);
    for round in 0..WARM_UP + runs {
        for at in order(round, NAMES.len()) {
            let (counted, time) = timed(|| ask(at, &calls, &embree, &spec));
            match counted.map_err(|error| error.to_string())? {
                Counted::Hits(counted) if counted != hits => {
                    return Err(format!("{}: {counted} hits, must be {hits}", NAMES[at]));
                }
                Counted::Vote(vote) if vote.disagreeing() > 0 => {
                    return Err(format!("{}: {vote}", NAMES[at]));
                }
                Counted::Hits(_) | Counted::Vote(_) => {}
            }
            if round >= WARM_UP {
                taken[at].seconds.push(time.as_secs_f64());
            }
        }
        progress.step();
    }
    let rows = taken.iter().zip(AGAINST).map(|(own, against)| {
        let against = against.map(|at| (&taken[at], Some(MOST)));
        own.row(&loaded.name, "hits", against)
    });
    Ok(rows.collect())
}

/// What came of asking.
enum Counted {
    Hits(u64),
    Vote(EmbreeVote),
}

/// Asks in one of the four ways.
fn ask(
    how: usize,
    calls: &Bare,
    embree: &EmbreeScene,
    spec: &Primitives,
) -> Result<Counted, EmbreeError> {
    let height = spec.size.height;
    match how {
        0 => Ok(Counted::Hits(bare(calls, spec, 0..height))),
        1 => {
            let (mut hits, mut counted) = (Vec::new(), 0);
            for row in 0..height {
                for column in 0..spec.size.width {
                    embree.hits(column, row, &mut hits)?;
                    counted += hits.len() as u64;
                }
            }
            Ok(Counted::Hits(counted))
        }
        2 => {
            let bands = (0..height.div_ceil(BAND)).into_par_iter();
            let rows = |band: u32| band * BAND..((band + 1) * BAND).min(height);
            let counted = bands.map(|band| bare(calls, spec, rows(band)));
            Ok(Counted::Hits(counted.sum()))
        }
        _ => compare(spec, embree).map(Counted::Vote),
    }
}

/// Bare calls through all samples of some rows; gives the number of hits.
fn bare(calls: &Bare, spec: &Primitives, rows: std::ops::Range<u32>) -> u64 {
    let (mut hits, mut counted) = (Vec::new(), 0);
    for row in rows {
        for column in 0..spec.size.width {
            hits.clear();
            calls.trace([column, row], spec.bits, &mut hits);
            counted += hits.len() as u64;
        }
    }
    counted
}
