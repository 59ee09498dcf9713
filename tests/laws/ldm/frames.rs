//! Progressive pictures: sets of directions in one frame after another.

use std::f64::consts::PI;

use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::Point;
use triptych_spec::ldm::{
    DIRECTIONS_MAX, Falloff, Hits, Map, Maps, Open, Receiver, Rotation, WEIGHT_BITS, directions,
    layers, neighbours, occlusion, openness, rotated, weight,
};

use super::light::ball;
use super::traces::whole;
use super::{around, empty, quad};

const UP: Point = [0, 0, 16_384];

/// What is open at a receiver, with only these of the maps.
fn open(maps: &Maps, mesh: &Blockers, receiver: &Receiver, falloff: Falloff) -> Open {
    let layers = layers(maps, mesh).unwrap();
    let hits = |map| (map, neighbours(maps, map, &layers, receiver));
    occlusion(maps.maps.iter().map(hits), receiver.normal, falloff)
}

/// Maps of all frames together sum up to what those of each do: integers to the last bit, parts
/// within bounds.
#[test]
fn frames_together_are_the_sum_of_frames() {
    let (mesh, receivers) = ball();
    let bounds = around(&mesh.vertices);
    let set = directions(24).unwrap();
    let frames: Vec<Vec<[f64; 3]>> = (0..5).map(|frame| rotated(&set, 3, frame)).collect();
    let new = |set: &[[f64; 3]]| Maps::new(set, bounds, bounds, 40).unwrap();
    let union = new(&frames.concat());
    let each: Vec<Maps> = frames.iter().map(|set| new(set)).collect();
    let maps = each.iter().flat_map(|maps| &maps.maps);
    for (one, other) in union.maps.iter().zip(maps) {
        let first = other.first;
        assert_eq!(
            &Map {
                first,
                ..one.clone()
            },
            other
        );
    }
    let falloff = Falloff::Distance {
        most: 2_000_000,
        power: 2,
    };
    for receiver in &receivers[..8] {
        for falloff in [Falloff::None, falloff] {
            let all = open(&union, &mesh, receiver, falloff);
            let parts: Vec<Open> = each
                .iter()
                .map(|m| open(m, &mesh, receiver, falloff))
                .collect();
            assert_eq!(all.whole, parts.iter().map(|part| part.whole).sum::<u32>());
            let mean = parts.iter().map(|part| openness(part, 24));
            let (value, bound) = mean.fold((0.0, 0.0), |(value, bound), part| {
                (value + part.value / 5.0, bound + part.bound / 5.0)
            });
            let all = openness(&all, 5 * 24);
            assert!(
                (all.value - value).abs() <= all.bound + bound,
                "{all:?} {value} {bound}"
            );
        }
    }
}

/// A weight is at most 2^19 + 55: both vectors are rounded by up to half in each component, so
/// they are at most `sqrt(3) / 2` longer than 2^14. As many of them as there may be directions fit
/// in 32 bits.
#[test]
fn sums_of_weights_fit() {
    let bounds = [[-9; 3], [9; 3]];
    let set: Vec<[f64; 3]> = (1..=DIRECTIONS_MAX)
        .map(|frame| Rotation::of(5, frame).turn([0.0, 0.0, 1.0]))
        .collect();
    let maps = Maps::new(&set, bounds, bounds, 8).unwrap();
    let of_length_one = set.iter().map(|d| d.map(|c| whole(16_384.0 * c)));
    let own = maps.maps.iter().zip(of_length_one).map(|(map, normal)| {
        assert_eq!(weight(map, normal), -weight(map, normal.map(|c| -c)));
        (weight(map, normal), normal, map.direction)
    });
    let (most, normal, direction) = own.max_by_key(|own| own.0).unwrap();
    let one = 1 << WEIGHT_BITS;
    assert!((one + 30..=one + 55).contains(&most), "{most}");
    let same = vec![direction; DIRECTIONS_MAX as usize];
    let maps = Maps::new(&same, bounds, bounds, 8).unwrap();
    let nothing = maps.maps.iter().map(|map| (map, Hits::default()));
    let open = occlusion(nothing, normal, Falloff::None);
    assert_eq!(open.whole, DIRECTIONS_MAX * most.unsigned_abs());
    // All directions are one: twice the mean cosine of a hemisphere.
    let all = openness(&open, DIRECTIONS_MAX);
    assert!(
        all.admits(2.0 * f64::from(most) / f64::from(one)),
        "{all:?}"
    );
    let more = [&same[..], &[direction]].concat();
    let error = Maps::new(&more, bounds, bounds, 8).unwrap_err().to_string();
    assert!(
        error.contains("the number of directions is 4097; 1 to 4096"),
        "{error}"
    );
}

/// What a rectangle parallel to a patch takes of its hemisphere, the height of which is 1: of one
/// whose corner is right above, with signs (Howell's C-11).
fn rectangle([x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> f64 {
    let corner = |x: f64, y: f64| {
        let [a, b] = [x, y].map(|c| (1.0 + c * c).sqrt());
        (x / a * (y / a).atan() + y / b * (x / b).atan()) / (2.0 * PI)
    };
    corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)
}

/// A ceiling over receivers, and nothing else: what is open over each of them, exactly, and how
/// much pixels may add or take away.
struct Ceiling {
    mesh: Blockers,
    receivers: Vec<Receiver>,
    open: Vec<f64>,
    blurred: Vec<f64>,
}

const HEIGHT: i32 = 1_000_000;
const RESOLUTION: u32 = 100;

fn ceiling() -> Ceiling {
    let mut mesh = empty();
    quad(
        &mut mesh,
        [-1_200_000, -700_000],
        [1_200_000, 700_000],
        HEIGHT,
    );
    let at = |n: i32| [260_000 * n - 900_000, 150_000 * (n % 3)];
    let taken = |[x, y]: [i32; 2], wider: f64| {
        let [x, y, w, d] =
            [f64::from(x), f64::from(y), 1.2e6 + wider, 7e5 + wider].map(|c| c / f64::from(HEIGHT));
        rectangle([-w - x, -d - y], [w - x, d - y])
    };
    // A border is seen half a pixel's diagonal off, and that is longer on a ceiling that is not at
    // right angles: its farthest corner is 2.2 beside the farthest receiver, by 1.
    let diagonal = 2.0 * 1.2e6_f64.hypot(7e5);
    let half = diagonal / f64::from(RESOLUTION) * 0.5_f64.sqrt();
    let off = half * (1.0 + 2.2_f64.powi(2) + 1.0).sqrt();
    let blurred = |at: [i32; 2]| {
        let [less, exact, more] = [-off, 0.0, off].map(|wider| taken(at, wider));
        (more - exact).max(exact - less)
    };
    let receiver = |[x, y]: [i32; 2]| Receiver {
        point: [x, y, 0],
        normal: UP,
        off: 0,
    };
    Ceiling {
        mesh,
        receivers: (0..8).map(|n| receiver(at(n))).collect(),
        open: (0..8).map(|n| 1.0 - taken(at(n), 0.0)).collect(),
        blurred: (0..8).map(|n| blurred(at(n))).collect(),
    }
}

/// The more frames, the less is wrong: each is a fair sample of all rotations, so the error falls
/// as the square root of their number, to what resolution leaves.
#[test]
fn frames_converge() {
    const FRAMES: u32 = 64;
    const SEEDS: u64 = 8;
    let ceiling = ceiling();
    let scene = around(&ceiling.mesh.vertices);
    let points: Vec<Point> = ceiling.receivers.iter().map(|r| r.point).collect();
    let set = directions(16).unwrap();
    let (mut squares, mut frames) = ([0.0; 4], vec![Vec::new(); 8]);
    for seed in 0..SEEDS {
        let mut sums = [0.0; 8];
        for frame in 0..FRAMES {
            let turned = rotated(&set, seed, frame);
            let maps = Maps::new(&turned, scene, around(&points), RESOLUTION).unwrap();
            let layers = layers(&maps, &ceiling.mesh).unwrap();
            for (n, receiver) in ceiling.receivers.iter().enumerate() {
                let hits = maps
                    .maps
                    .iter()
                    .map(|map| (map, neighbours(&maps, map, &layers, receiver)));
                let part = openness(&occlusion(hits, UP, Falloff::None), 16).value;
                sums[n] += part;
                if frame > 0 {
                    frames[n].push(part - ceiling.open[n]);
                }
            }
            if let Some(at) = [1, 4, 16, 64].iter().position(|count| *count == frame + 1) {
                let off = |n: usize| sums[n] / f64::from(frame + 1) - ceiling.open[n];
                squares[at] += (0..8).map(|n| off(n).powi(2)).sum::<f64>() / 8.0 / SEEDS as f64;
            }
        }
    }
    for (offs, blurred) in frames.iter().zip(&ceiling.blurred) {
        let count = offs.len() as f64;
        let mean = offs.iter().sum::<f64>() / count;
        let spread = (offs.iter().map(|off| (off - mean).powi(2)).sum::<f64>() / count).sqrt();
        // Four deviations of a mean of so many.
        assert!(
            mean.abs() < 4.0 * spread / count.sqrt() + blurred,
            "{mean} {spread} {blurred}"
        );
    }
    // A half at each step is expected, an eighth in all.
    let errors = squares.map(f64::sqrt);
    assert!(
        errors.windows(2).all(|pair| pair[1] < 0.75 * pair[0]),
        "{errors:?}"
    );
    assert!(errors[3] < errors[0] / 5.0, "{errors:?}");
}
