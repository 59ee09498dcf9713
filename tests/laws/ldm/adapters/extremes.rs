//! Long lists, large triangles, too little room.

use triptych_spec::grid::lattice::REACH;
use triptych_spec::ldm::RESOLUTION_MAX;

use super::*;

pub(super) fn maps_around(mesh: &Blockers, sets: &[[f64; 3]], resolution: u32) -> Maps {
    let bounds = around(&mesh.vertices);
    Maps::new(sets, bounds, bounds, resolution).expect("within the limits")
}

fn longest(maps: &Maps, made: &Layers) -> usize {
    let all = (0..maps.pixels).map(|pixel| made.list(pixel).len());
    all.max().unwrap_or(0)
}

/// Lists longer than an invocation sorts, of equal keys and of others, and short ones beside them.
#[test]
fn long_lists() {
    for length in [33, 100, 500, 513, 2 * LONG.cast_signed() + 70] {
        long_lists_of(length);
    }
}

fn long_lists_of(length: i32) {
    let mut mesh = sphere([3e6; 3], 9, 7);
    for i in 0..length {
        // Three at a time lie in one plane.
        let z = 1000 * (i - i % 3) % 70_001;
        quad(&mut mesh, [-900_000, -700_000], [1_000_000, 500_000], z);
    }
    let sets = [[0.0, 0.0, 1.0], [0.6, 0.0, -0.8]];
    let maps = maps_around(&mesh, &sets, 31);
    let made = layers(&maps, &mesh).unwrap();
    let found = longest(&maps, &made);
    assert!(found > length.unsigned_abs() as usize, "{found}");
    let check = everywhere((&maps, &mesh), AMPLE, |stages, name| {
        lists_agree(stages, &maps, &made, name)
    });
    check.unwrap();
}

/// A chain that one dispatch does not sort goes on in the next.
#[test]
fn chains_in_parts() {
    let mut mesh = empty();
    for i in 0..4000 {
        quad(&mut mesh, [-9000, -9000], [9000, 9000], i * 7919 % 8192);
    }
    let maps = maps_around(&mesh, &[[0.0, 0.0, 1.0]], 8);
    let made = layers(&maps, &mesh).unwrap();
    let length = longest(&maps, &made);
    assert!(length as u64 * 11 > STEPS, "{length}");
    let check = everywhere((&maps, &mesh), AMPLE, |stages, name| {
        lists_agree(stages, &maps, &made, name)
    });
    check.unwrap();
}

/// Deep lists: pixels of all maps fit in a buffer, and entries of one map alone.
#[test]
fn chains_map_by_map() {
    let mut mesh = empty();
    for i in 0..60 {
        quad(&mut mesh, [-9000, -9000], [9000, 9000], i * 7919 % 8192);
    }
    let sets = [[0.0, 0.0, 1.0], [0.0, 0.6, 0.8], [0.6, 0.0, 0.8]];
    let maps = maps_around(&mesh, &sets, 8);
    let made = layers(&maps, &mesh).unwrap();
    let keys = maps.maps.iter().map(|map| {
        let end = map.first + map.size.width * map.size.height;
        made.offsets[end as usize] - made.offsets[map.first as usize]
    });
    let most = u64::from(keys.max().unwrap());
    assert!(8 * most > 32 * u64::from(maps.pixels), "{most}");
    let check = everywhere((&maps, &mesh), 8 * most, |stages, name| {
        lists_agree(stages, &maps, &made, name)
    });
    check.unwrap();
    let total = u32::try_from(made.keys.len()).unwrap();
    let check = everywhere((&maps, &mesh), 8 * most - 1, |stages, name| {
        let refused = stages.chain(total, |_, _| true).map(|_| ());
        let words = refused.expect_err("a map's entries").to_string();
        prop_assert!(
            words.contains("entries of a map's lists"),
            "{}: {}",
            name,
            words
        );
        Ok(())
    });
    check.unwrap();
}

/// The finest maps, with more large triangles than a workgroup has.
#[test]
fn large_triangles() {
    let mut mesh = empty();
    for i in 0..9 {
        let z = (i - 4) * 5_000;
        quad(&mut mesh, [-REACH, -REACH], [REACH, REACH], z);
    }
    let sets = [[0.0, 0.0, 1.0], [0.36, 0.48, 0.8]];
    for resolution in [362, RESOLUTION_MAX] {
        let maps = maps_around(&mesh, &sets, resolution);
        let made = layers(&maps, &mesh).unwrap();
        let check = everywhere((&maps, &mesh), AMPLE, |stages, name| {
            let seen = stages.layers().expect("room");
            prop_assert!(seen == made, "{}: {}", name, first_apart(&seen, &made));
            Ok(())
        });
        check.unwrap();
    }
}

/// What has no room is left out, and nothing else.
#[test]
fn overflowing_chains() {
    let mesh = sphere([3e6; 3], 12, 8);
    let sets = [[0.0, 0.6, 0.8], [1.0, 0.0, 0.0]];
    let maps = maps_around(&mesh, &sets, 20);
    let made = layers(&maps, &mesh).unwrap();
    let total = u32::try_from(made.keys.len()).unwrap();
    // In one batch and in two.
    let budgets = [AMPLE, 32 * u64::from(maps.maps[1].first + 1)];
    let cases = [0, 1, total / 2, total - 1].map(|c| budgets.map(|b| (c, b)));
    for (capacity, budget) in cases.into_iter().flatten() {
        let check = everywhere((&maps, &mesh), budget, |stages, name| {
            let chains = stages.chain(capacity, |_, _| true).expect("room");
            prop_assert_eq!(chains.attempts, u64::from(total), "{}", name);
            prop_assert_eq!(chains.links.len(), capacity as usize);
            let mut held = 0;
            for pixel in 0..maps.pixels {
                let mut rest = made.list(pixel).iter();
                let keys = linked(&chains, pixel as usize);
                held += keys.len();
                let is_part = keys.iter().all(|key| rest.any(|own| own == key));
                prop_assert!(is_part, "{}: {:?}", name, keys);
            }
            prop_assert_eq!(held, capacity as usize);
            Ok(())
        });
        check.unwrap();
    }
}
