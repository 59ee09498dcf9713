//! Sets of directions: what the theory says of them.

use std::f64::consts::PI;

use triptych_spec::ldm::{DIRECTIONS_MAX, Rotation, Zone, directions, rotated, zones};

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Every region is as large as all others, and pole and pole are alike, for each set there is.
#[test]
fn regions_have_equal_areas_and_small_diameters() {
    let mut largest = 0.0_f64;
    for n in 1..=DIRECTIONS_MAX {
        let regions = 2 * n;
        let zones = zones(regions);
        let counts: Vec<u32> = zones.iter().map(|zone| zone.regions).collect();
        assert_eq!(counts.iter().sum::<u32>(), regions, "of {n}");
        assert!(counts.iter().eq(counts.iter().rev()), "{n}: {counts:?}");
        assert_eq!(zones[0].from, 0.0);
        assert!((zones[zones.len() - 1].to - PI).abs() < 1e-7);
        let area = 4.0 * PI / f64::from(regions);
        for zone in &zones {
            let own = 2.0 * PI * (zone.from.cos() - zone.to.cos()) / f64::from(zone.regions);
            assert!(
                (own / area - 1.0).abs() < 1e-9,
                "{n}: {zone:?} {own} {area}"
            );
            largest = largest.max(diameter(zone) * f64::from(regions).sqrt());
        }
    }
    // Leopardi's theorem has some constant; his figure 5 shows 7 as what is never exceeded.
    assert!((5.0..7.0).contains(&largest), "{largest}");
}

/// At least the distance of any two points of a region.
fn diameter(zone: &Zone) -> f64 {
    if zone.regions == 1 {
        return 2.0
            * (zone.to - zone.from)
                .min(PI)
                .sin()
                .abs()
                .max((zone.to - zone.from).min(PI / 2.0).sin());
    }
    let wide = PI / f64::from(zone.regions);
    let nearest_to_equator = PI / 2.0;
    let widest = match (zone.from..=zone.to).contains(&nearest_to_equator) {
        true => 1.0,
        false => zone.from.sin().max(zone.to.sin()),
    };
    let across = 2.0 * widest * wide.min(PI / 2.0).sin();
    let down = zone.to - zone.from;
    across.hypot(down)
}

/// The set of the paper: 483 directions above the equator, and half of the 58 on it.
#[test]
fn the_papers_set() {
    let set = directions(512).unwrap();
    assert_eq!(set.len(), 512);
    let level = set.iter().filter(|d| d[2] == 0.0).count();
    assert_eq!(
        [level, set.iter().filter(|d| d[2] > 0.0).count()],
        [29, 483]
    );
    let counts: Vec<u32> = zones(1024).iter().map(|zone| zone.regions).collect();
    let upper = [1, 7, 13, 19, 25, 31, 35, 41, 45, 48, 52, 54, 56, 56, 58];
    assert_eq!(counts[..15], upper);
}

/// Some of the directions that the author's renderer reads from a file, with four digits; those
/// on the equator are the antipodes of ours.
#[test]
fn the_authors_directions() {
    let set = directions(512).unwrap();
    for (at, theirs) in [
        (1, [0.1076, 0.0518, 0.9928]),
        (9, [0.1959, 0.1207, 0.9732]),
        (21, [0.3351, -0.0238, 0.9419]),
        (100, [0.5468, 0.3056, 0.7795]),
        (300, [-0.6061, -0.6676, 0.4323]),
        (482, [0.9451, -0.3072, 0.1115]),
        (483, [-0.9793, 0.2026, 0.0]),
        (500, [0.0668, -0.9978, 0.0]),
        (511, [0.9516, -0.3073, 0.0]),
    ] {
        let sign = if theirs[2] == 0.0 { -1.0 } else { 1.0 };
        let off = |i: usize| (set[at][i] - sign * theirs[i]).abs();
        assert!((0..3).all(|i| off(i) < 1e-4), "{at}: {:?}", set[at]);
    }
}

/// A map serves two directions; no two maps serve the same.
#[test]
fn no_two_directions_are_one_line() {
    for n in [
        1,
        2,
        3,
        4,
        7,
        16,
        29,
        64,
        128,
        333,
        512,
        1024,
        DIRECTIONS_MAX,
    ] {
        let set = directions(n).unwrap();
        assert_eq!(set.len(), n as usize);
        let mut nearest = 0.0_f64;
        for (at, a) in set.iter().enumerate() {
            assert!((dot(*a, *a) - 1.0).abs() < 1e-14 && a[2] >= 0.0);
            let others = set[at + 1..].iter().map(|b| dot(*a, *b).abs());
            nearest = others.fold(nearest, f64::max);
        }
        // Centres of regions are about the square root of an area apart.
        let apart = (4.0 * PI / f64::from(2 * n)).sqrt();
        assert!(
            nearest <= (0.6 * apart).cos(),
            "{n}: {}",
            nearest.acos() / apart
        );
    }
}

/// How far the sum of cosines over a set is from the half that it should be: at most so far,
/// over all normals. It is farthest at the pole, where a whole cap has its centre.
pub(super) const FURNACE: [(u32, f64); 6] = [
    (16, 4.66e-2),
    (64, 1.27e-2),
    (128, 5.88e-3),
    (256, 3.08e-3),
    (512, 1.66e-3),
    (1024, 7.63e-4),
];

#[test]
fn cosines_sum_up_to_a_half() {
    let normal = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 20_000.0;
        let turn = f64::from(i) * PI * (3.0 - 5.0_f64.sqrt());
        let out = (1.0 - z * z).sqrt();
        [out * turn.cos(), out * turn.sin(), z]
    };
    let axes = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let normals: Vec<[f64; 3]> = (0..20_000).map(normal).chain(axes).collect();
    for (n, table) in FURNACE {
        let set = directions(n).unwrap();
        let off = |normal: &[f64; 3]| {
            let sum: f64 = set.iter().map(|d| dot(*d, *normal).abs()).sum();
            (2.0 / f64::from(n) * sum - 1.0).abs()
        };
        let most = normals.iter().map(off).fold(0.0, f64::max);
        assert!(
            (0.99 * table..table).contains(&most),
            "{n}: {most:e} for {table:e}"
        );
    }
}

#[test]
fn what_makes_no_set_is_named() {
    for n in [0, DIRECTIONS_MAX + 1] {
        let error = directions(n).unwrap_err().to_string();
        assert!(
            error.contains("the number of directions") && error.contains("4096"),
            "{error}"
        );
    }
}

/// A turned set is the same set elsewhere; frames differ, a frame does not.
#[test]
fn rotations_keep_angles() {
    let set = directions(64).unwrap();
    assert_eq!(
        rotated(&set, 9, 0),
        set,
        "the first frame is the set itself"
    );
    let mut mean = [0.0; 3];
    for frame in 1..400 {
        let turned = rotated(&set, 9, frame);
        assert_eq!(turned, rotated(&set, 9, frame));
        assert_ne!(turned, rotated(&set, 10, frame));
        for (a, b) in [(0, 1), (3, 60), (17, 42)] {
            let kept = dot(turned[a], turned[b]) - dot(set[a], set[b]);
            assert!(kept.abs() < 1e-14, "{kept}");
        }
        // Right-handed.
        let r = Rotation::of(9, frame);
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|v| r.turn(v));
        let volume = x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0])
            + x[2] * (y[0] * z[1] - y[1] * z[0]);
        assert!((volume - 1.0).abs() < 1e-14, "{volume}");
        mean = [0, 1, 2].map(|i| mean[i] + turned[5][i] / 399.0);
    }
    // One direction goes everywhere: its mean has a deviation of 1 / sqrt(3 * 399) = 0.029.
    assert!(mean.iter().all(|c| c.abs() < 0.12), "{mean:?}");
}
