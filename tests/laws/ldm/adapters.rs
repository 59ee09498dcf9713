//! Random maps on every adapter, with words and with native integers: the spec's lists and what is
//! before and behind each receiver to the bit, sums within their bounds.

use proptest::prelude::*;
use triptych_gpu::abuffer::STEPS;
use triptych_gpu::ldm::{Chains, Stages};
use triptych_gpu::lists::LONG;
use triptych_spec::abuffer::EOL;
use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{
    Falloff, Hits, Layers, Map, Maps, Receiver, Sky, environment, layers, mirror, neighbours,
    occlusion, view,
};

use super::{around, direction, empty, point, quad, sphere};
use crate::adapters::devices;
use crate::config;

#[path = "adapters/extremes.rs"]
mod extremes;
#[path = "adapters/replica.rs"]
mod replica;

/// Room for everything.
const AMPLE: u64 = u64::MAX;

/// Runs a check with the stages of every adapter and kind of integers.
fn everywhere(
    (maps, mesh): (&Maps, &Blockers),
    budget: u64,
    mut check: impl FnMut(&mut Stages, &str) -> Result<(), TestCaseError>,
) -> Result<(), TestCaseError> {
    for (gpu, kernels) in devices() {
        for kernels in kernels {
            let mut stages = Stages::new(gpu, kernels, maps, mesh, budget).expect("room");
            check(&mut stages, &gpu.name)?;
        }
    }
    Ok(())
}

/// The keys of a list, in the order in which they are linked.
fn linked(chains: &Chains, pixel: usize) -> Vec<u32> {
    let mut keys = Vec::new();
    let mut at = chains.heads[pixel];
    while at != EOL {
        let link = chains.links[at as usize];
        keys.push(link.key);
        at = link.next;
        assert!(keys.len() <= chains.links.len(), "a cycle");
    }
    keys
}

/// Lists made by an adapter from triangles.
fn lists_agree(
    stages: &mut Stages,
    maps: &Maps,
    made: &Layers,
    name: &str,
) -> Result<(), TestCaseError> {
    let seen = stages.layers().expect("room");
    prop_assert!(seen == *made, "{}: {}", name, first_apart(&seen, made));
    let total = u32::try_from(made.keys.len()).unwrap();
    let chains = stages.chain(total, |_, _| true).expect("room");
    prop_assert_eq!(chains.attempts, u64::from(total));
    for pixel in 0..maps.pixels {
        let keys = linked(&chains, pixel as usize);
        prop_assert_eq!(&keys[..], made.list(pixel), "{}, pixel {}", name, pixel);
    }
    Ok(())
}

fn first_apart(a: &Layers, b: &Layers) -> String {
    let apart = |x: &[u32], y: &[u32]| {
        let at = x.iter().zip(y).position(|(x, y)| x != y);
        format!("{} and {} of them, first apart: {at:?}", x.len(), y.len())
    };
    format!(
        "offsets {}; keys {}",
        apart(&a.offsets, &b.offsets),
        apart(&a.keys, &b.keys)
    )
}

type Found<'m> = Vec<(&'m Map, Hits)>;

fn hits<'m>(maps: &'m Maps, made: &Layers, receiver: &Receiver) -> Found<'m> {
    let all = maps.maps.iter();
    all.map(|map| (map, neighbours(maps, map, made, receiver)))
        .collect()
}

/// What receivers find in given lists.
fn answers_agree(
    stages: &mut Stages,
    (maps, made): (&Maps, &Layers),
    receivers: &[Receiver],
    name: &str,
) -> Result<(), TestCaseError> {
    stages.give_layers(made).expect("room");
    let must: Vec<Found> = receivers.iter().map(|r| hits(maps, made, r)).collect();
    let found = stages.neighbours(receivers).expect("room");
    prop_assert_eq!(found.len(), receivers.len() * maps.maps.len());
    for (i, found) in found.iter().enumerate() {
        let (map, at) = (i / receivers.len(), i % receivers.len());
        let must = must[at][map].1;
        prop_assert_eq!(*found, must, "{}: {:?}, map {}", name, receivers[at], map);
    }
    let far = |power| Falloff::Distance {
        most: 4_000_000,
        power,
    };
    let near = Falloff::Distance {
        most: 3_000,
        power: 0,
    };
    for falloff in [Falloff::None, near, far(1), far(3)] {
        let seen = stages.occlusion(receivers, falloff).expect("room");
        for ((receiver, hits), seen) in receivers.iter().zip(&must).zip(seen) {
            let open = occlusion(hits.iter().copied(), receiver.normal, falloff);
            prop_assert_eq!(seen.whole, open.whole, "{}: {:?}", name, receiver);
            let is_in = open.part.admits(seen.part.into());
            prop_assert!(is_in, "{}: {:?} {:?}", name, seen, open);
        }
    }
    lights_agree(stages, receivers, &must, name)?;
    mirrors_agree(stages, receivers, &must, name)
}

fn lights_agree(
    stages: &mut Stages,
    receivers: &[Receiver],
    must: &[Found],
    name: &str,
) -> Result<(), TestCaseError> {
    let numbers = (0_u8..).take(must[0].len()).map(f32::from);
    let skies: Vec<Sky> = numbers
        .map(|n| [[n, 0.3, 7.0], [0.0, n * 0.7, 1e-3]])
        .collect();
    let count = u32::try_from(skies.len()).unwrap() + 3;
    let lit: Vec<bool> = (0..skies.len()).map(|map| map % 5 != 1).collect();
    let light = stages.environment(receivers, (&skies, &lit), count);
    let light = light.expect("room");
    for ((receiver, hits), light) in receivers.iter().zip(must).zip(light) {
        let through = hits.iter().zip(&skies).zip(&lit).filter(|(_, lit)| **lit);
        let lit = through.map(|(((map, hits), sky), _)| (*map, *hits, sky));
        for (must, seen) in environment(lit, receiver.normal, count).iter().zip(light) {
            let is_in = must.admits(seen.into());
            prop_assert!(is_in, "{}: {} {:?}", name, seen, must);
        }
    }
    Ok(())
}

/// An eye anywhere, and what points mirror.
fn mirrors_agree(
    stages: &mut Stages,
    receivers: &[Receiver],
    must: &[Found],
    name: &str,
) -> Result<(), TestCaseError> {
    let numbers = (0_u8..).take(must[0].len()).map(f32::from);
    let skies: Vec<Sky> = numbers
        .map(|n| [[n, 0.3, 7.0], [0.0, n * 0.7, 1e-3]])
        .collect();
    let eye = [0, 1, 2].map(|i| receivers[0].point[2 - i] / 2 + receivers[0].point[i] / 2);
    let towards = |receiver: &Receiver| view([0, 1, 2].map(|i| eye[i] - receiver.point[i]));
    let views: Vec<[i32; 3]> = receivers.iter().map(towards).collect();
    let seen = stages.mirror(receivers, &views, &skies).expect("room");
    for (at, seen) in seen.iter().enumerate() {
        let hits = must[at].iter().zip(&skies);
        let hits = hits.map(|((map, hits), sky)| (*map, *hits, sky));
        let must = mirror(hits, receivers[at].normal, views[at]);
        prop_assert_eq!(*seen, must, "{}: {:?}", name, receivers[at]);
    }
    Ok(())
}

fn receiver() -> impl Strategy<Value = Receiver> {
    let parts = (point(), direction(), 0..40_u32, any::<bool>());
    parts.prop_map(|(point, normal, off, on)| Receiver {
        point,
        normal: match on {
            #[expect(clippy::cast_possible_truncation, reason = "at most 2^14")]
            true => normal.map(|c| (c * 16_384.0).round() as i32),
            false => [0; 3],
        },
        off,
    })
}

/// Triangles between random points: large ones, and small ones beside them.
fn soup() -> impl Strategy<Value = Blockers> {
    let corner = || (point(), prop::array::uniform3(-40_000..40_000_i32));
    let triangle = (point(), corner(), corner(), any::<bool>());
    prop::collection::vec(triangle, 1..90).prop_map(|all| {
        let end = triptych_spec::grid::lattice::REACH;
        let mut vertices = Vec::new();
        for (a, (b, by), (c, more), small) in all {
            let near = |by: [i32; 3]| [0, 1, 2].map(|i| (a[i] + by[i]).clamp(-end, end));
            vertices.extend(match small {
                true => [a, near(by), near(more)],
                false => [a, b, c],
            });
        }
        let rows = 0..u32::try_from(vertices.len() / 3).unwrap();
        Blockers {
            triangles: rows.map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
            vertices,
        }
    })
}

proptest! {
    #![proptest_config(config(24))]

    #[test]
    fn random_maps(
        mesh in soup(),
        directions in prop::collection::vec(direction(), 1..7),
        receivers in prop::collection::vec(receiver(), 1..70),
        resolution in 8..=48_u32,
        part in 1..=4_u64,
        cropped in any::<bool>(),
    ) {
        let receiving = receivers.iter().map(|r| r.point);
        let points: Vec<_> = mesh.vertices.iter().copied().chain(receiving).collect();
        // Some are beside what is cropped to, where everything is open.
        let some = receivers.len().div_ceil(2);
        let asking: Vec<_> = receivers[..some].iter().map(|r| r.point).collect();
        let crop = around(if cropped { &asking } else { &points });
        let maps = Maps::new(&directions, around(&points), crop, resolution).unwrap();
        let made = layers(&maps, &mesh).unwrap();
        let sizes = maps.maps.iter().map(|m| (m.first, m.first + m.size.width * m.size.height));
        let most = sizes.map(|(first, end)| {
            let keys = made.offsets[end as usize] - made.offsets[first as usize];
            keys.max(end - first + 1)
        });
        // Room for one map or some.
        let budget = 4 * part * u64::from(most.max().unwrap());
        everywhere((&maps, &mesh), budget, |stages, name| {
            let seen = stages.layers().expect("room");
            prop_assert!(seen == made, "{}: {}", name, first_apart(&seen, &made));
            answers_agree(stages, (&maps, &made), &receivers, name)
        })?;
        everywhere((&maps, &mesh), AMPLE, |stages, name| {
            lists_agree(stages, &maps, &made, name)?;
            answers_agree(stages, (&maps, &made), &receivers, name)
        })?;
    }
}
