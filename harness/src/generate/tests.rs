//! What the generators promise.

use std::collections::BTreeMap;

use super::{Generator, Order};
use crate::mesh::Mesh;
use crate::scene::value::{Number, Point};
use crate::vector::{add, cross, dot, length, scale, sub};

fn make(generator: &Generator) -> Mesh {
    generator.mesh(1).expect("the parameters are in range")
}

fn corners(mesh: &Mesh, triangle: [u32; 3]) -> [[f64; 3]; 3] {
    triangle.map(|v| mesh.positions[v as usize].map(f64::from))
}

/// Twice the area, as a vector.
fn area([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    cross(sub(b, a), sub(c, a))
}

fn sphere() -> Generator {
    Generator::Sphere {
        radius: Number(2.0),
        segments: [7, 9],
    }
}

fn scatter(count: u32, copies: u32, flat: bool) -> Generator {
    Generator::Scatter {
        count,
        extent: Point([4.0, 2.0, 6.0]),
        length: Number(3.0),
        width: Number(0.25),
        copies,
        flat,
    }
}

/// Every edge has two triangles, which walk it in opposite directions.
#[test]
fn solids_are_closed_and_face_outward() {
    let torus = Generator::Torus {
        radii: [Number(2.0), Number(0.5)],
        segments: [8, 5],
    };
    let cuboid = Generator::Box {
        size: Point([1.0, 2.0, 3.0]),
    };
    for generator in [sphere(), torus, cuboid] {
        let (mesh, name) = (make(&generator), generator.name());
        let mut edges = BTreeMap::new();
        for [a, b, c] in &mesh.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((*from, *to)).or_insert(0) += 1;
            }
        }
        for ((from, to), count) in &edges {
            assert_eq!(*count, 1, "{name}: {from} to {to} occurs once");
            assert!(edges.contains_key(&(*to, *from)), "{name}: {to} to {from}");
        }
        // The divergence theorem: six times the volume is positive.
        let volumes = mesh.triangles.iter().map(|t| {
            let [a, b, c] = corners(&mesh, *t);
            dot(a, cross(b, c))
        });
        assert!(volumes.sum::<f64>() > 0.0, "{name} faces outward");
    }
}

#[test]
fn a_jittered_grid_keeps_its_area_and_orientation() {
    let grid = Generator::Grid {
        cells: [9, 7],
        cell: [Number(2.0), Number(3.0)],
        jitter: Number(0.2499),
        relief: Number(0.0),
    };
    let mesh = make(&grid);
    let areas = mesh.triangles.iter().map(|t| area(corners(&mesh, *t))[2]);
    let areas: Vec<f64> = areas.collect();
    assert!(areas.iter().all(|a| *a > 0.0), "no triangle turns over");
    // Twice 9 * 7 cells of 2 * 3. Coordinates up to 10.5 are rounded to f32, each by
    // 2^-21 at most; a triangle's doubled area has two products of differences up to
    // 4.5, so it moves by less than 4 * 2 * 4.5 * 2^-21, and there are 126.
    let bound = 126.0 * 36.0 * f64::from(f32::EPSILON) / 4.0;
    let error = areas.iter().sum::<f64>() - 2.0 * 9.0 * 7.0 * 6.0;
    assert!(error.abs() <= bound, "the sum is off by {error}");
}

#[test]
fn scattered_triangles_have_their_length_and_width() {
    for flat in [false, true] {
        let mesh = make(&scatter(100, 3, flat));
        assert_eq!(mesh.triangles.len(), 300, "a hundred, three times");
        assert_eq!(
            mesh.triangles[..100],
            mesh.triangles[200..],
            "copies coincide"
        );
        for t in &mesh.triangles {
            let [a, b, c] = corners(&mesh, *t);
            let longest = length(sub(b, a));
            let width = length(area([a, b, c])) / longest;
            // Coordinates below 8 are rounded to f32 by 2^-22 at most; a distance of
            // two rounded points is off by 2 sqrt(3) times that, a width by twice it.
            let bound = 7.0 / f64::from(1 << 22);
            assert!((longest - 3.0).abs() <= bound, "length {longest}");
            assert!((width - 0.25).abs() <= bound, "width {width}");
            assert!(
                !flat || a[2] == c[2],
                "flat ones are parallel to the xy plane"
            );
        }
    }
}

#[test]
fn seeds_make_sequences() {
    let shape = scatter(10, 1, false);
    let mesh = |seed| shape.mesh(seed).expect("in range").positions;
    assert_eq!(mesh(7), mesh(7), "one seed, one mesh");
    assert_ne!(mesh(7), mesh(8), "other seed, other mesh");
    // The reference sequence of SplitMix64 for seed 1234567.
    let mut random = super::Random::new(1_234_567);
    let first = [random.bits(), random.bits(), random.bits()];
    let known = [
        6_457_827_717_110_365_317,
        3_203_168_211_198_807_973,
        9_817_491_932_198_370_423,
    ];
    assert_eq!(first, known, "a change would change every random scene");
}

#[test]
fn a_shuffled_stack_has_every_layer_once() {
    let stack = |order| Generator::Stack {
        layers: 50,
        size: [Number(1.0), Number(1.0)],
        spacing: Number(0.5),
        order,
    };
    let depths = |order| -> Vec<f32> {
        let mesh = make(&stack(order));
        mesh.triangles
            .iter()
            .map(|t| mesh.positions[t[0] as usize][2])
            .collect()
    };
    let front = depths(Order::FrontToBack);
    let mut shuffled = depths(Order::Shuffled);
    assert_ne!(front, shuffled, "it is shuffled");
    shuffled.sort_by(|a, b| b.total_cmp(a));
    assert_eq!(front, shuffled, "and complete");
    let mut back = depths(Order::BackToFront);
    back.reverse();
    assert_eq!(front, back, "the other order is the reverse");
}

#[test]
fn a_fan_closes_around_its_hub() {
    let fan = Generator::Fan {
        spokes: 12,
        radius: Number(2.0),
        hub: Number(0.5),
    };
    let mesh = make(&fan);
    let sum = mesh.triangles.iter().fold([0.0; 3], |sum, t| {
        add(sum, scale(area(corners(&mesh, *t)), 0.5))
    });
    // A regular polygon of n corners at radius r: n r^2 sin(2 pi / n) / 2 = 12. Its
    // coordinates, 2 at most, are rounded by 2^-24, which moves each of 12 areas by
    // less than 8 times that.
    let bound = 12.0 * 8.0 / f64::from(1 << 24);
    assert!((sum[2] - 12.0).abs() <= bound, "area {}", sum[2]);
    assert!(
        sum[0].abs() <= bound && sum[1].abs() <= bound,
        "closed: {sum:?}"
    );
}
