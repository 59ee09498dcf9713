//! Whatever WGSL allows a kernel stays inside the bounds.

use proptest::prelude::*;
use triptych_spec::bound::Bounded;
use triptych_spec::ldm::{
    Falloff, Hits, KEYS_PER_STEP, Map, Maps, Open, Sky, WEIGHT_BITS, environment, occlusion,
    openness, weight,
};

use super::direction;
use crate::config;
use crate::loose::Loose;

/// Maps in any directions, of which only those matter.
fn maps(directions: &[[f64; 3]]) -> Maps {
    let bounds = [[-9; 3], [9; 3]];
    Maps::new(directions, bounds, bounds, 8).expect("within the limits")
}

fn scale(m: &mut Loose, count: usize) -> f32 {
    m.round(2.0 / count as f64 / f64::from(1_u32 << WEIGHT_BITS))
}

fn passed(m: &mut Loose, keys: u32, most: u32, power: u32) -> f32 {
    let [keys, most] = [keys, most].map(|n| m.round(f64::from(n)));
    let part = m.div(keys, most);
    (1..power).fold(part, |all, _| m.mul(all, part))
}

fn over(bounded: Bounded, observed: f32) -> f64 {
    assert!(
        bounded.admits(f64::from(observed)),
        "{observed} for {bounded:?}"
    );
    (f64::from(observed) - bounded.value).abs() / bounded.bound.max(f64::MIN_POSITIVE)
}

/// What is found in a direction: nothing, or something at so many keys.
fn hit() -> impl Strategy<Value = Option<u32>> {
    prop_oneof![1 => Just(None), 3 => (0..60_000_u32).prop_map(Some), 1 => (0..1_u32 << 28).prop_map(Some)]
}

proptest! {
    #![proptest_config(config(1500))]

    #[test]
    fn obscurance(
        found in prop::collection::vec((direction(), hit(), hit()), 1..40),
        normal in direction(),
        (most, power) in (1..8_000_u32, 0..=8_u32),
        seed in any::<u64>(),
    ) {
        let (directions, hits): (Vec<_>, Vec<_>) = found
            .into_iter()
            .map(|(d, before, behind)| (d, Hits { key: 0, before, behind }))
            .unzip();
        let maps = maps(&directions);
        #[expect(clippy::cast_possible_truncation, reason = "14 bits")]
        let normal = normal.map(|c| (c * 16_384.0).round() as i32);
        let asked = || maps.maps.iter().zip(hits.iter().copied());
        let falloff = Falloff::Distance { most, power };
        let open = occlusion(asked(), normal, falloff);
        let m = &mut Loose::new(seed);
        let (mut whole, mut terms) = (0_u32, Vec::new());
        for (map, hits) in asked() {
            let weight = weight(map, normal);
            let found = if weight >= 0 { hits.before } else { hits.behind };
            let most = most * KEYS_PER_STEP.unsigned_abs();
            match found {
                Some(keys) if keys < most => if power > 0 {
                    let passed = passed(m, keys, most, power);
                    terms.push(m.mul(weight.unsigned_abs() as f32, passed));
                },
                _ => whole += weight.unsigned_abs(),
            }
        }
        prop_assert_eq!(open.whole, whole);
        let part = m.sum(&terms);
        over(open.part, part);
        let count = u32::try_from(maps.maps.len()).unwrap();
        let all = m.round(f64::from(whole));
        let all = m.add(all, part);
        let scale = scale(m, maps.maps.len());
        over(openness(&open, count), m.mul(all, scale));
        // Without a distance only integers count.
        let Open { part, .. } = occlusion(asked(), normal, Falloff::None);
        prop_assert_eq!((part.value, part.bound), (0.0, 0.0));
    }

    #[test]
    fn skies(
        found in prop::collection::vec((direction(), hit(), [0.0..1e3_f32, 0.0..1e3, 0.0..1e3], [0.0..1.0_f32, 0.0..1.0, 0.0..1.0]), 1..40),
        normal in direction(),
        seed in any::<u64>(),
    ) {
        let directions: Vec<[f64; 3]> = found.iter().map(|f| f.0).collect();
        let maps = maps(&directions);
        let skies: Vec<Sky> = found.iter().map(|f| [f.2, f.3]).collect();
        #[expect(clippy::cast_possible_truncation, reason = "14 bits")]
        let normal = normal.map(|c| (c * 16_384.0).round() as i32);
        let hits = |n: usize| Hits { key: 0, before: found[n].1, behind: None };
        let asked = maps.maps.iter().enumerate().map(|(n, map)| (map, hits(n), &skies[n]));
        let count = u32::try_from(maps.maps.len()).unwrap();
        let light = environment(asked, normal, count);
        let m = &mut Loose::new(seed);
        for (channel, light) in light.into_iter().enumerate() {
            let term = |m: &mut Loose, (n, map): (usize, &Map)| {
                let weight = weight(map, normal);
                let open = weight < 0 || hits(n).before.is_none();
                let radiance = skies[n][usize::from(weight < 0)][channel];
                open.then(|| m.mul(weight.unsigned_abs() as f32, radiance))
            };
            let terms: Vec<f32> = maps.maps.iter().enumerate().filter_map(|map| term(m, map)).collect();
            let sum = m.sum(&terms);
            let scale = scale(m, maps.maps.len());
            over(light, m.mul(sum, scale));
        }
    }
}

/// An error of the bounds comes near them: a chain of products that are all rounded one way.
#[test]
fn bounds_are_of_use() {
    let maps = maps(&[[0.0, 0.0, 1.0]]);
    let falloff = Falloff::Distance {
        most: 5_000,
        power: 8,
    };
    let most = 5_000 * KEYS_PER_STEP.unsigned_abs();
    let mut largest = 0.0_f64;
    for seed in 0..400 {
        let m = &mut Loose::new(seed);
        let keys = 39_001 + u32::try_from(seed).unwrap();
        let hits = Hits {
            key: 0,
            before: Some(keys),
            behind: None,
        };
        let open = occlusion(
            std::iter::once((&maps.maps[0], hits)),
            [0, 0, 16_384],
            falloff,
        );
        let passed = passed(m, keys, most, 8);
        let weight = weight(&maps.maps[0], [0, 0, 16_384]).unsigned_abs();
        largest = largest.max(over(open.part, m.mul(weight as f32, passed)));
    }
    assert!(largest > 0.2, "{largest}");
}
