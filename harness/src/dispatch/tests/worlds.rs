//! Random worlds.

use triptych_spec::camera::{Camera, Projection};
use triptych_spec::dispatch::{Eye, Lamp, Material, World};
use triptych_spec::grid::lattice::{Lattice, Point};
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::{Blockers, Grid, Membership};
use triptych_spec::scene::Size;

/// Numbers that look random (Steele, Lea and Flood 2014, `splitmix64`).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From `-most` to `most`.
    pub fn within(&mut self, most: i32) -> i32 {
        let span = 2 * u64::from(most.unsigned_abs()) + 1;
        i32::try_from(self.next() % span).expect("fits") - most
    }

    pub fn point(&mut self, most: i32) -> Point {
        [0; 3].map(|_: i32| self.within(most))
    }
}

/// Triangles anywhere in a box, a third of them large, some slivers and some that share corners.
pub fn blockers(random: &mut Random, count: usize, most: i32) -> Blockers {
    let mut blockers = Blockers::default();
    for number in 0..count {
        let first = u32::try_from(blockers.vertices.len()).expect("few");
        let base = random.point(most);
        let size = if number % 3 == 0 { most } else { most / 16 };
        let near = |random: &mut Random| {
            let by = random.point(size);
            [0, 1, 2].map(|i| (base[i] + by[i]).clamp(-most, most))
        };
        let corners = [base, near(random), near(random)];
        let corners = match number % 7 {
            // A sliver.
            0 => [
                corners[0],
                corners[1],
                corners[1].map(|c| (c + 1).min(most)),
            ],
            _ => corners,
        };
        blockers.vertices.extend(corners);
        let shared = first.checked_sub(2).filter(|_| number % 5 == 0);
        blockers
            .triangles
            .push([shared.unwrap_or(first), first + 1, first + 2]);
    }
    blockers
}

/// A world of random triangles, half of them mirrors, with a few lamps, and its grid.
pub fn world(seed: u64, count: usize, size: Size) -> (World, Grid) {
    let mut random = Random(seed);
    let most = 1 << 20;
    let blockers = blockers(&mut random, count, most);
    let grid = Grid::build(&blockers, Resolution::FromScene, Membership::Box).expect("a grid");
    let lattice = Lattice {
        centre: [0.0; 3],
        exponent: 0,
    };
    let camera = Camera {
        eye: [0.0, 0.0, 3.0 * f64::from(most)],
        target: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        projection: Projection::Perspective { fov: 40.0 },
        near: 1.0,
        far: 1e9,
    };
    let eye = Eye::new(&camera, &lattice, size).expect("an eye");
    let material = |number: usize| Material {
        diffuse: [0.8, 0.5, 0.3],
        mirror: if number.is_multiple_of(2) {
            [0.0; 3]
        } else {
            [0.9, 0.6, 0.3]
        },
    };
    let materials: Vec<Material> = (0..count).map(material).collect();
    let lamp = |random: &mut Random| {
        Lamp::new(random.point(2 * most), [1.5, 1.0, 0.5], 1 << 20, 1 << 16).expect("a lamp")
    };
    let lamps = (0..4).map(|_| lamp(&mut random)).collect();
    let world = World::new(blockers, &materials, lamps, [0.1, 0.2, 0.4], eye, 5);
    (world.expect("a world"), grid)
}
