//! The sweeps, and the scene of each of their steps.

use triptych_spec::grid::axis::{Axis, WIDENED};

use super::super::shot::Vertex;
use super::super::sweeps::{Step, Sweep, power, scaled, step};
use super::super::triangles::{mix, slivers};
use super::near::{NEAREST, PARTS};
use super::shot::{GridShot, Own};
use crate::generate::Random;
use crate::vector::{add, scale};

/// Seed of everything that is drawn: a step is the same scene on every machine.
const SEED: u64 = 4;

/// Half the width of a scene whose units are the steps of its lattice: five quarters of it
/// still fit ([`triptych_spec::grid::lattice::EXTENT`]), and do not with steps half as long.
pub(super) const HALF: i32 = 6 << 20;

/// All of them.
pub fn sweeps() -> Vec<Sweep<GridShot>> {
    let sweep = Sweep::new;
    vec![
        sweep(
            "aligned",
            "lattice steps between triangles and the cells' faces, edges and corners",
            aligned_but_for,
        ),
        sweep("cells", "cells along an axis", cells_along),
        sweep("scale", "size of the scene in units", scale_of_scene),
        sweep(
            "offset",
            "distance from the origin over size",
            offset_over_size,
        ),
        sweep(
            "near",
            "distance of rays from faces, edges and corners over the lattice's size",
            near_to,
        ),
        sweep("length", "lattice steps that a ray goes", length_of_rays),
        sweep("sliver", "length of a triangle over its width", aspect),
        sweep(
            "tiny",
            "size of small triangles over large ones'",
            tiny_beside_huge,
        ),
        sweep("sparse", "triangles in a grid of 64 x 64 x 64", few_in_many),
    ]
}

/// Triangles that lie in faces of cells, have an edge on an edge, or a corner in a corner,
/// all of them moved by so many steps along each axis; and two small ones at the ends of the
/// scene, which hold cells and lattice where they are.
pub(super) fn aligned(random: &mut Random, count: usize, cells: u32, by: i32) -> Vec<[Vertex; 3]> {
    let axis = Axis::around(-HALF, HALF, cells);
    let boundaries = axis.boundaries();
    let cells = axis.cells() as usize;
    let one = |number: usize, random: &mut Random| {
        let cell = [0; 3].map(|_: usize| random.below(cells));
        let way = [0; 3].map(|_: usize| random.below(2));
        let sign = [0; 3].map(|_: i32| [-by, by][random.below(2)]);
        // Corner `n` of the cell: bit `i` is the end on axis `i`.
        let corner = |n: usize| -> Vertex {
            let on = |i: usize| {
                let end = (n >> i & 1) ^ way[i];
                (boundaries[cell[i] + end] + sign[i]).clamp(-HALF, HALF)
            };
            [0, 1, 2].map(|i| f64::from(on(i)))
        };
        let mut any = || {
            let near = corner(random.below(8));
            let size = f64::from(HALF) / cells as f64;
            let at = [0, 1, 2].map(|i| near[i] + (2.0 * size * random.signed()).round());
            at.map(|c| c.clamp(f64::from(-HALF), f64::from(HALF)))
        };
        match number % 3 {
            0 => [
                corner(0),
                corner(1 << (number / 3 % 3)),
                corner(1 << ((number / 3 + 1) % 3)),
            ],
            1 => [corner(0), corner(1 << (number / 3 % 3)), any()],
            _ => [corner(0), any(), any()],
        }
    };
    let mut all: Vec<_> = (0..count).map(|number| one(number, random)).collect();
    all.extend(ends(f64::from(HALF)));
    all
}

/// A small triangle at each end of a scene of this half-width.
fn ends(half: f64) -> [[Vertex; 3]; 2] {
    let small = half / 4096.0;
    [-1.0, 1.0].map(|sign| {
        [
            [half; 3],
            [half - small, half, half],
            [half, half - small, half],
        ]
        .map(|v| scale(v, sign))
    })
}

/// From exactly on to beyond what cells take in, and a good deal further.
fn aligned_but_for() -> Vec<Step<GridShot>> {
    let of = |steps: i32| {
        let shot = GridShot {
            purpose: format!("triangles {steps} steps beside the cells' faces, edges and corners"),
            triangles: aligned(&mut Random::new(SEED), 120, 8, steps),
            cells: Some([8; 3]),
            ..GridShot::default()
        };
        step(steps.to_string(), f64::from(steps), shot)
    };
    let around = [-1, 0, 1].map(|by| WIDENED + by);
    [0, 1, 2, 4]
        .into_iter()
        .chain(around)
        .chain([16, 32, 64])
        .map(of)
        .collect()
}

/// From one cell to as many as a grid may have, and more than that.
fn cells_along() -> Vec<Step<GridShot>> {
    let of = |label: String, cells: [u32; 3], refused| {
        let along = cells.into_iter().max().unwrap_or(1);
        let shot = GridShot {
            purpose: format!("{label} cells along an axis, triangles on their faces"),
            triangles: aligned(&mut Random::new(SEED), 120, along, 0),
            cells: Some(cells),
            refused,
            ..GridShot::default()
        };
        step(label, f64::from(along), shot)
    };
    let mut steps: Vec<_> = (0..=8)
        .map(|e| of(format!("2^{e}"), [1 << e; 3], None))
        .collect();
    steps.push(of("1024x1x1".to_owned(), [1024, 1, 1], None));
    steps.push(of("4x1024x512".to_owned(), [4, 1024, 512], None));
    let refused = Some("a grid of 134217728 cells");
    steps.push(of("2^9".to_owned(), [1 << 9; 3], refused));
    steps
}

/// From the smallest subnormal numbers to the largest of `f32`, and beyond.
fn scale_of_scene() -> Vec<Step<GridShot>> {
    let triangles = mix(&mut Random::new(SEED), 160, 1.0);
    let of = |exponent: i32| {
        let factor = libm::pow(10.0, f64::from(exponent));
        let shot = GridShot {
            purpose: format!("a scene of 1e{exponent} units"),
            triangles: scaled(&triangles, factor),
            refused: (exponent > 38).then_some("is not finite"),
            ..GridShot::default()
        };
        step(format!("1e{exponent}"), factor, shot)
    };
    let small = [-44, -42, -40, -38, -34];
    let stated = (-5..=3).map(|sixes| 6 * sixes);
    small
        .into_iter()
        .chain(stated)
        .chain([24, 30, 36, 38, 39])
        .map(of)
        .collect()
}

/// A scene moved from the origin; from 2^24 times its size on, all corners are one or two
/// points of `f32`, and beyond `f32` it is refused.
fn offset_over_size() -> Vec<Step<GridShot>> {
    let triangles = mix(&mut Random::new(SEED), 160, 1.0);
    let of = |exponent: i32| {
        let factor = libm::pow(10.0, f64::from(exponent));
        // The scene is two units wide.
        let by = scale([1.0, -0.75, 0.5], 2.0 * factor);
        let moved = |t: &[Vertex; 3]| t.map(|v| add(v, by));
        let shot = GridShot {
            purpose: format!("a scene at 1e{exponent} times its size from the origin"),
            triangles: triangles.iter().map(moved).collect(),
            refused: (exponent > 38).then_some("is not finite"),
            ..GridShot::default()
        };
        step(format!("1e{exponent}"), factor, shot)
    };
    (0..=8).chain([12, 24, 38, 39]).map(of).collect()
}

/// Rays ever nearer to faces, edges and corners, down to where no `f32` tells them apart.
fn near_to() -> Vec<Step<GridShot>> {
    let parts = f64::from(PARTS);
    let triangles = mix(&mut Random::new(SEED), 60, 0.45 * f64::from(HALF));
    let on_lattice = |t: &[Vertex; 3]| t.map(|v| v.map(|c| (c / parts).round() * parts));
    let mut triangles: Vec<_> = triangles.iter().map(on_lattice).collect();
    triangles.extend(ends(f64::from(HALF)));
    let of = |k: u32| {
        let exponent = i32::try_from(k).expect("small");
        let (label, distance) = power(-exponent);
        let shot = GridShot {
            purpose: format!("rays at 2^-{k} of the lattice from faces, edges and corners"),
            triangles: triangles.clone(),
            cells: Some([16; 3]),
            rays: 20,
            own: Own::Near(k),
            ..GridShot::default()
        };
        step(label, distance, shot)
    };
    (1..=NEAREST / 2).map(|k| of(2 * k)).collect()
}

/// From none, by which nothing is met, to as far as the lattice goes.
fn length_of_rays() -> Vec<Step<GridShot>> {
    let triangles = mix(&mut Random::new(SEED), 160, 0.5 * f64::from(HALF));
    let of = |steps: i32| {
        let shot = GridShot {
            purpose: format!("rays of {steps} lattice steps"),
            triangles: triangles.clone(),
            rays: 20,
            own: Own::Long(steps),
            ..GridShot::default()
        };
        step(steps.to_string(), f64::from(steps), shot)
    };
    [0, 1, 2, 3]
        .into_iter()
        .chain((1..=6).map(|e| 1 << (4 * e - 1)))
        .map(of)
        .collect()
}

/// Needles of one length, ever thinner, until the lattice has no width for them.
fn aspect() -> Vec<Step<GridShot>> {
    let of = |exponent| {
        let (label, aspect) = power(exponent);
        let shot = GridShot {
            purpose: format!("triangles 2^{exponent} times as long as wide"),
            triangles: slivers(&mut Random::new(SEED), 200, [1.5, 1.5 / aspect]),
            overlap: true,
            ..GridShot::default()
        };
        step(label, aspect, shot)
    };
    (0..=13).map(|twos| of(2 * twos)).collect()
}

/// Huge triangles, and beside and on them ever smaller ones, down to single points.
fn tiny_beside_huge() -> Vec<Step<GridShot>> {
    let huge = mix(&mut Random::new(SEED), 24, 1.0);
    let of = |exponent: i32| {
        let (label, size) = power(-exponent);
        let mut random = Random::new(SEED + 1);
        let mut triangles = huge.clone();
        for small in mix(&mut random, 160, 1.0) {
            // About a corner of a huge one, its middle, or where it is.
            let on = huge[random.below(huge.len())];
            let middle = scale(add(add(on[0], on[1]), on[2]), 1.0 / 3.0);
            let at = [on[0], middle, small[0]][random.below(3)];
            triangles.push(small.map(|v| add(at, scale(add(v, scale(small[0], -1.0)), size))));
        }
        let shot = GridShot {
            purpose: format!("triangles of 2^-{exponent} beside such of 1"),
            triangles,
            overlap: exponent % 4 == 0,
            ..GridShot::default()
        };
        step(label, size, shot)
    };
    (0..=13).map(|twos| of(2 * twos)).collect()
}

/// From nothing at all, of which the plan makes nothing, to some in every brick.
fn few_in_many() -> Vec<Step<GridShot>> {
    let of = |count: usize| {
        let mut triangles = Vec::new();
        if count > 0 {
            let mut random = Random::new(SEED);
            let small = mix(&mut random, count, 0.02);
            let at = |random: &mut Random| [0.95; 3].map(|side| side * random.signed());
            triangles = small
                .iter()
                .map(|t| {
                    let at = at(&mut random);
                    t.map(|v| add(v, at))
                })
                .collect();
            triangles.extend(ends(1.0));
        }
        let shot = GridShot {
            purpose: format!("{count} triangles in many cells"),
            triangles,
            cells: Some([64; 3]),
            ..GridShot::default()
        };
        step(count.to_string(), count as f64, shot)
    };
    [0, 1, 4, 16, 64, 256, 1024, 4096].map(of).to_vec()
}
