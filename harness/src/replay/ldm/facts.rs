//! What the spec found, for a snapshot.

use std::collections::BTreeMap;

use triptych_spec::abuffer::NOTHING;
use triptych_spec::bound::Bounded;
use triptych_spec::ldm::{Mirrored, openness};

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
    let mut counts = vec![
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
    ];
    if let Some(flicker) = flicker(run) {
        counts.push(("flicker", format!("{flicker:.1e} from one set to the next")));
    }
    if !run.mirrored.is_empty() {
        counts.push(("mirrored", mirrored(run)));
    }
    counts
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
    if !run.mirrored.is_empty() {
        let words = run.turns.iter().flat_map(|turn| turn.mirrored.iter());
        hashes.insert("mirrored", hash(words.flat_map(words_of)));
    }
    hashes.extend(run.tally.hashes());
    hashes
}

/// By how much what is open over a receiver changes from one rotation to the next, which is what
/// fixed directions would save (paper section 3.2): root of the mean square. `None` of a single set.
fn flicker(run: &LdmRun) -> Option<f64> {
    let value = |open| openness(open, run.setup.directions).value;
    let pairs = run.turns.iter().zip(run.turns.iter().skip(1));
    let changes = pairs.flat_map(|(a, b)| a.open.iter().zip(&b.open));
    let changes = changes.map(|(a, b)| value(a) - value(b));
    let squares: Vec<f64> = changes.map(|change| change * change).collect();
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    (!squares.is_empty()).then(|| libm::sqrt(mean))
}

/// What receivers see in the nearest direction of all rotations.
fn mirrored(run: &LdmRun) -> String {
    let count = |holds: fn(&Mirrored) -> bool| run.mirrored.iter().filter(|m| holds(m)).count();
    format!(
        "{} see something, {} nothing, {} have no direction",
        count(|m| m.hit.is_some()),
        count(|m| m.map.is_some() && m.hit.is_none()),
        count(|m| m.map.is_none())
    )
}

fn words_of(mirrored: &Mirrored) -> [u32; 7] {
    let [r, g, b] = mirrored.light.map(f32::to_bits);
    let some = |number: Option<u32>| number.unwrap_or(NOTHING);
    let key = mirrored.key.cast_unsigned();
    let map = some(mirrored.map);
    [
        map,
        mirrored.opposite.into(),
        key,
        some(mirrored.hit),
        r,
        g,
        b,
    ]
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
