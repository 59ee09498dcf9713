//! What is open around a point: furnaces, walls, and skies.

use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{
    Falloff, Hits, Layers, Map, Maps, Open, Receiver, Sky, environment, layers, neighbours,
    occlusion, openness, weight,
};

use super::directions::FURNACE;
use super::{empty, maps_of, normal_of, quad, sphere};

/// What a receiver finds in all maps.
pub(super) fn found<'m>(
    maps: &'m Maps,
    layers: &Layers,
    receiver: &Receiver,
) -> Vec<(&'m Map, Hits)> {
    let hit = |map: &'m Map| (map, neighbours(maps, map, layers, receiver));
    maps.maps.iter().map(hit).collect()
}

fn open(maps: &Maps, layers: &Layers, receiver: &Receiver, falloff: Falloff) -> Open {
    let found = found(maps, layers, receiver);
    occlusion(found.into_iter(), receiver.normal, falloff)
}

pub(super) fn part(maps: &Maps, layers: &Layers, receiver: &Receiver, falloff: Falloff) -> f64 {
    let count = u32::try_from(maps.maps.len()).unwrap();
    openness(&open(maps, layers, receiver, falloff), count).value
}

fn floor() -> (Blockers, Receiver) {
    let mut mesh = empty();
    quad(&mut mesh, [-4_000_000; 2], [4_000_000; 2], 0);
    let receiver = Receiver {
        point: [54_321, 12_345, 0],
        normal: normal_of(&mesh, 0),
        off: 0,
    };
    (mesh, receiver)
}

/// Furnace: over a floor alone all is open, within what a set of directions and 19 bits can say.
#[test]
fn a_floor_is_open() {
    let (mesh, receiver) = floor();
    for (count, table) in FURNACE {
        for frame in 0..3 {
            let maps = maps_of(&mesh, count, 24, frame);
            let layers = layers(&maps, &mesh).unwrap();
            let part = part(&maps, &layers, &receiver, Falloff::None);
            assert!((part - 1.0).abs() < table + 2e-5, "{count}: {part}");
        }
    }
}

/// What a square of half side `a` at height `h` takes of a point's hemisphere right below it
/// (form factor of a rectangle parallel to a patch, Howell's C-1).
fn square(a: f64, h: f64) -> f64 {
    let x = a / h;
    let side = (1.0 + x * x).sqrt();
    4.0 / std::f64::consts::PI * (x / side) * (x / side).atan()
}

/// A ceiling, with and without a distance from which on it does not count.
#[test]
fn ceilings() {
    let (mut mesh, receiver) = floor();
    let height = 1_000_000;
    quad(&mut mesh, [-4_000_000; 2], [4_000_000; 2], height);
    let maps = maps_of(&mesh, 512, 300, 0);
    let layers = layers(&maps, &mesh).unwrap();
    let part_of = |falloff| part(&maps, &layers, &receiver, falloff);
    let taken = square(4e6, f64::from(height));
    assert!(
        (part_of(Falloff::None) - (1.0 - taken)).abs() < 3e-3,
        "{} {taken}",
        part_of(Falloff::None)
    );
    let near = Falloff::Distance {
        most: height.unsigned_abs() - 1000,
        power: 0,
    };
    assert!((part_of(near) - 1.0).abs() < 3e-3);
    // A hit at cosine c is h / c away. Within 2 h that is c from 1/2 to 1, of 2 c dc each; the
    // rest, a quarter, is open: with power 2 there is 2 c (h / (2 h c))^2, or (ln 2) / 2.
    let most = 2 * height.unsigned_abs();
    let square = part_of(Falloff::Distance { most, power: 2 });
    assert!(
        (square - (2.0_f64.ln() / 2.0 + 0.25)).abs() < 5e-3,
        "{square}"
    );
    let linear = part_of(Falloff::Distance { most, power: 1 });
    assert!((linear - 0.75).abs() < 5e-3, "{linear}");
    // Cut off at once, along a ring of directions or between two: the part of a ring is open.
    let step = part_of(Falloff::Distance { most, power: 0 });
    assert!((step - 0.25).abs() < 0.04, "{step}");
}

#[test]
fn a_wall_takes_a_half() {
    // A wall around the z axis' plane x = 1000, of which the floor is the plane z = 0.
    let mesh = Blockers {
        vertices: vec![
            [-4_000_000, -4_000_000, 0],
            [1000, -4_000_000, 0],
            [1000, 4_000_000, 0],
            [-4_000_000, 4_000_000, 0],
            [1000, -4_000_000, 4_000_000],
            [1000, 4_000_000, 4_000_000],
        ],
        triangles: vec![[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]],
    };
    let receiver = Receiver {
        point: [-199_000, 777, 0],
        normal: normal_of(&mesh, 0),
        off: 0,
    };
    assert!(receiver.normal[2] > 0);
    let maps = maps_of(&mesh, 512, 724, 0);
    let layers = layers(&maps, &mesh).unwrap();
    let part = part(&maps, &layers, &receiver, Falloff::None);
    // It ends 20 times as high as it is far away: half of 1 - 1 / 20, nearly, is taken.
    let taken = (1.0 - 1.0 / 401.0_f64.sqrt()) / 2.0;
    assert!((part - (1.0 - taken)).abs() < 0.01, "{part}");
}

/// A ball over a floor, and points around it.
pub(super) fn ball() -> (Blockers, Vec<Receiver>) {
    let (mut mesh, floor) = floor();
    let first = u32::try_from(mesh.vertices.len()).unwrap();
    let ball = sphere([1_000_000.0; 3], 24, 16);
    mesh.vertices.extend(
        ball.vertices
            .iter()
            .map(|[x, y, z]| [*x, *y, z + 1_200_000]),
    );
    mesh.triangles
        .extend(ball.triangles.iter().map(|t| t.map(|row| first + row)));
    let receivers = (0..24).map(|n| Receiver {
        point: [110_000 * n - 900_000, 70_001 * (n % 7), 0],
        ..floor
    });
    (mesh, receivers.collect())
}

/// A sky of one colour is what is open; one that grows with height gives two thirds of its slope.
#[test]
fn skies() {
    let (mesh, receivers) = ball();
    let maps = maps_of(&mesh, 512, 60, 0);
    let layers = layers(&maps, &mesh).unwrap();
    let count = u32::try_from(maps.maps.len()).unwrap();
    let lit = |receiver: &Receiver, layers: &Layers, radiance: &dyn Fn([f64; 3]) -> [f32; 3]| {
        let skies: Vec<Sky> = maps
            .maps
            .iter()
            .map(|map| [radiance(map.direction), radiance(map.direction.map(|c| -c))])
            .collect();
        let found = found(&maps, layers, receiver);
        let all = found
            .into_iter()
            .zip(&skies)
            .map(|((map, hits), sky)| (map, hits, sky));
        environment(all, receiver.normal, count)
    };
    for receiver in &receivers {
        let one = lit(receiver, &layers, &|_| [1.0, 0.5, 0.0]);
        let part = part(&maps, &layers, receiver, Falloff::None);
        for (channel, times) in [(0, 1.0), (1, 0.5), (2, 0.0)] {
            assert!((one[channel].value - times * part).abs() < 1e-12, "{one:?}");
        }
    }
    // With nothing in the way: 1 + slope 2/3, from above.
    let nothing = Layers {
        offsets: vec![0; maps.pixels as usize + 1],
        keys: Vec::new(),
    };
    #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
    let light = lit(&receivers[0], &nothing, &|d| {
        [(1.0 + d[2]) as f32, d[0] as f32 + 1.0, 0.0]
    });
    assert!((light[0].value - 5.0 / 3.0).abs() < 3e-3, "{light:?}");
    assert!((light[1].value - 1.0).abs() < 3e-3, "{light:?}");
}

/// Turned over, a surface sees the other half: both together have all directions' weights.
#[test]
fn both_sides_see_everything_once() {
    let (mesh, receivers) = ball();
    let maps = maps_of(&mesh, 128, 40, 3);
    let layers = layers(&maps, &mesh).unwrap();
    for receiver in &receivers {
        let over = Receiver {
            normal: receiver.normal.map(|c| -c),
            ..*receiver
        };
        for map in &maps.maps {
            assert_eq!(weight(map, receiver.normal), -weight(map, over.normal));
            // The same layers are its own.
            let [a, b] = [receiver, &over].map(|r| neighbours(&maps, map, &layers, r));
            assert_eq!(a, b);
        }
        let under = part(&maps, &layers, &over, Falloff::None);
        assert!(
            (under - 1.0).abs() < 1e-2,
            "nothing is below the floor: {under}"
        );
    }
}
