//! What the spec found, for a snapshot.

use std::collections::BTreeMap;

use triptych_spec::bound::Bounded;

use super::spec::LdmRun;
use crate::replay::facts::{Facts, hash, runs};
use crate::scene::Loaded;

/// The facts of a scene with maps; counts and hashes are over all rotations.
pub(super) fn of(loaded: &Loaded, run: &LdmRun, skip: bool) -> Facts {
    Facts {
        counts: counts(loaded, run),
        runs: runs(&crate::replay::passes(loaded, skip)),
        hashes: hashes(run),
    }
}

fn counts(loaded: &Loaded, run: &LdmRun) -> Vec<(&'static str, String)> {
    let setup = &run.setup;
    let tally = &run.tally;
    let [seen, blocking] = loaded.parts();
    let directions = u64::from(setup.directions) * u64::from(setup.rotations);
    let receivers = setup.receivers.len();
    let open = (0..receivers).filter(|i| run.open[*i].whole == run.weights(*i));
    let needed = format!(
        "{} of {directions} directions by the receivers' normals",
        tally.maps
    );
    vec![
        (
            "size",
            format!("{} x {}", setup.eye.size.width, setup.eye.size.height),
        ),
        ("triangles", loaded.stats.triangles.to_string()),
        ("degenerate", loaded.stats.degenerate.to_string()),
        ("seen_triangles", seen.to_string()),
        ("blockers", blocking.to_string()),
        ("lattice", format!("2^{}", setup.lattice.exponent)),
        (
            "directions",
            format!("{} in {} sets", setup.directions, setup.rotations),
        ),
        (
            "needed",
            match run.lit {
                true => format!("{needed}, {} of them without light", tally.dark),
                false => needed,
            },
        ),
        ("resolution", setup.resolution.to_string()),
        (
            "pixels",
            format!(
                "{} in all maps, {} of them empty, {} with one key",
                tally.pixels, tally.empty, tally.ones
            ),
        ),
        (
            "keys",
            format!("{}, the longest list has {}", tally.keys, tally.longest),
        ),
        (
            "receivers",
            format!(
                "{receivers}, {} of them with nothing in the way",
                open.count()
            ),
        ),
        (
            "hits",
            format!("{} before, {} behind", tally.before, tally.behind),
        ),
    ]
}

fn hashes(run: &LdmRun) -> BTreeMap<&'static str, String> {
    let receivers = run.setup.receivers.iter().flat_map(|asker| {
        let mut words = vec![asker.pixel, asker.triangle];
        words.extend(asker.receiver.point.map(i32::cast_unsigned));
        words.extend(asker.receiver.normal.map(i32::cast_unsigned));
        words
    });
    let maps = run.turns.iter().flat_map(|turn| {
        turn.maps.maps.iter().flat_map(|map| {
            let numbers = map.rows.iter().chain(&map.planes).flatten();
            let numbers = numbers.chain(&map.origin).map(|c| c.cast_unsigned());
            numbers.chain([map.size.width, map.size.height, map.first])
        })
    });
    let mut hashes = BTreeMap::from([
        ("receivers", hash(receivers)),
        ("maps", hash(maps)),
        ("whole", hash(run.open.iter().map(|open| open.whole))),
        ("openness", hash(run.openness.iter().map(fixed))),
    ]);
    if run.lit {
        hashes.insert("picture", hash(run.picture().iter().flatten().map(fixed)));
    }
    hashes.extend(run.tally.hashes());
    hashes
}

/// In steps of 2^-16: an integer.
fn fixed(number: &Bounded) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "saturates"
    )]
    let steps = libm::floor(number.value * 65536.0 + 0.5) as u32;
    steps
}
