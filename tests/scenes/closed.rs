//! Closed real meshes: the spec meets them from inside, whatever it is aimed at.

use std::collections::BTreeMap;

use libtest_mimic::Failed;
use triptych_harness::corpus::Entry;
use triptych_harness::replay::grid::blockers;
use triptych_harness::scene::load_entry;
use triptych_spec::grid::lattice::Point;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::trace::{blocked, closest};
use triptych_spec::grid::{Blockers, Grid, Membership};

/// The meshes without a hole.
pub const SCENES: [&str; 2] = ["grid/bunny", "grid/dragon"];

/// Points inside, and what each looks at: corners, and middles of edges.
const POINTS: usize = 48;
const TARGETS: usize = 400;

/// No ray leaves a closed mesh unseen. That it is closed, and which points are inside, is found
/// without a ray.
pub fn nothing_leaves(entry: &Entry) -> Result<(), Failed> {
    let loaded = load_entry(entry, None)?;
    let (_, mesh) = blockers(&loaded)?;
    let open = open_edges(&mesh);
    if open > 0 {
        return Err(format!("{open} edges have no triangle on the other side").into());
    }
    let grid = Grid::build(&mesh, Resolution::FromScene, Membership::Box)?;
    let (mut inside, mut rays) = (0, 0);
    for point in points(&mesh)
        .filter(|point| is_inside(&mesh, *point))
        .take(POINTS)
    {
        inside += 1;
        for target in targets(&mesh, inside) {
            if target == point {
                continue;
            }
            let ray = Ray {
                segment: false,
                ..Ray::between(point, target)
            };
            rays += 1;
            if !blocked(&grid, &mesh, ray) || closest(&grid, &mesh, ray).is_none() {
                return Err(format!("nothing is met from {point:?} to {target:?}").into());
            }
        }
    }
    // Nothing asked is no pass.
    match (inside, rays > POINTS * TARGETS / 2) {
        (POINTS, true) => Ok(()),
        _ => Err(format!("{inside} points inside, {rays} rays").into()),
    }
}

/// How many edges are not used as often in one direction as in the other. Corners are one if
/// they are at one place; triangles that snapping made flat have two ways along an edge.
fn open_edges(mesh: &Blockers) -> usize {
    let mut used = BTreeMap::<[Point; 2], i64>::new();
    for rows in &mesh.triangles {
        let [a, b, c] = rows.map(|row| mesh.vertices[row as usize]);
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let (edge, way) = if from <= to {
                ([from, to], 1)
            } else {
                ([to, from], -1)
            };
            *used.entry(edge).or_default() += if from == to { 0 } else { way };
        }
    }
    used.values().filter(|count| **count != 0).count()
}

/// Whether the mesh goes around a point: the sum of the solid angles that its triangles take,
/// by van Oosterom and Strackee (1983), is 4 pi, not 0.
fn is_inside(mesh: &Blockers, point: Point) -> bool {
    let angle = |rows: &[u32; 3]| {
        let [a, b, c] = rows.map(|row| {
            let corner = mesh.vertices[row as usize];
            [0, 1, 2].map(|i| f64::from(corner[i] - point[i]))
        });
        let [la, lb, lc] = [a, b, c].map(|v| dot(v, v).sqrt());
        let volume = dot(a, cross(b, c));
        let way = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        2.0 * volume.atan2(way)
    };
    let sum: f64 = mesh.triangles.iter().map(angle).sum();
    sum.abs() > 2.0 * std::f64::consts::PI
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

/// Points all over the mesh's box.
fn points(mesh: &Blockers) -> impl Iterator<Item = Point> {
    let ends = [0, 1, 2].map(|axis| {
        let along = mesh.vertices.iter().map(move |v| v[axis]);
        (along.clone().min().unwrap_or(0), along.max().unwrap_or(0))
    });
    // A Halton sequence.
    (1..4096_u32).map(move |n| {
        let at = [2, 3, 5].map(|base| radical_inverse(n, base));
        #[expect(clippy::cast_possible_truncation, reason = "within the lattice")]
        [0, 1, 2].map(|axis| {
            let (low, high) = ends[axis];
            low + (f64::from(high - low) * at[axis]) as i32
        })
    })
}

fn radical_inverse(mut n: u32, base: u32) -> f64 {
    let (mut digits, mut scale) = (0.0, 1.0);
    while n > 0 {
        scale /= f64::from(base);
        digits += f64::from(n % base) * scale;
        n /= base;
    }
    digits
}

/// Corners and middles of edges, others for each point.
fn targets(mesh: &Blockers, number: usize) -> impl Iterator<Item = Point> {
    let apart = mesh.triangles.len() / TARGETS + 1;
    let chosen = mesh.triangles.iter().skip(number % apart).step_by(apart);
    chosen.flat_map(|rows| {
        let [a, b, _] = rows.map(|row| mesh.vertices[row as usize]);
        [a, [0, 1, 2].map(|i| i32::midpoint(a[i], b[i]))]
    })
}
