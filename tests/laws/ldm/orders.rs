//! How what is wrong falls with the resolution.

use triptych_spec::grid::lattice::Point;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::trace::blocked;
use triptych_spec::grid::{Blockers, Grid, Membership};
use triptych_spec::ldm::{Falloff, Map, Maps, Receiver, Rotation, layers, weight};

use super::light::{ball, found, part};
use super::maps_of;
use super::traces::whole;

/// Whether a ray in a map's direction meets anything, exactly.
fn ray_is_blocked(mesh: &Blockers, grid: &Grid, map: &Map, receiver: &Receiver) -> bool {
    let side = f64::from(weight(map, receiver.normal).signum());
    #[expect(clippy::cast_possible_truncation, reason = "within the lattice")]
    let along = map.direction.map(|c| (c * 8e6 * side).round() as i32);
    let mut start = receiver.point;
    start[2] += 2;
    let ray = Ray {
        origin: start,
        direction: along,
        segment: false,
    };
    blocked(grid, mesh, ray)
}

/// Points of the plane z = 0, anywhere around the ball, independently of each other: a component of
/// a random unit vector is uniform.
fn around_the_ball(count: u32, normal: Point) -> Vec<Receiver> {
    let uniform = |seed, n| Rotation::of(seed, n).turn([0.0, 0.0, 1.0])[2];
    let at = |n| Receiver {
        point: [whole(2e6 * uniform(1, n)), whole(2e6 * uniform(2, n)), 0],
        normal,
        off: 0,
    };
    (1..=count).map(at).collect()
}

/// Mean of numbers, and its standard error.
fn mean(numbers: &[f64]) -> [f64; 2] {
    let count = numbers.len() as f64;
    let mean = numbers.iter().sum::<f64>() / count;
    let squares = numbers.iter().map(|n| (n - mean) * (n - mean));
    [mean, (squares.sum::<f64>() / (count - 1.0) / count).sqrt()]
}

/// Against exact rays in the same directions, what is wrong falls as pixels do.
///
/// A direction is wrong where its ray passes an outline within about half a pixel, or meets what
/// is within the band of half a pixel's slope: shares of all points that are as wide as a pixel,
/// so their number is of first order. Each errs by at most `2 cos / N` of what is open; so the mean
/// error falls as fast at least, and an RMSE, in which signs cancel or a single one decides, with
/// the square root at least.
#[test]
fn wrong_directions_are_of_first_order() {
    let count = 48;
    let (scene, floor) = ball();
    // Of the floor, which is in nobody's way, there are no maps: they are as large as the ball.
    let mut mesh = scene;
    mesh.triangles.drain(..2);
    mesh.vertices.drain(..4);
    for row in mesh.triangles.iter_mut().flatten() {
        *row -= 4;
    }
    let receivers = around_the_ball(6000, floor[0].normal);
    let grid = Grid::build(&mesh, Resolution::FromScene, Membership::Box).unwrap();
    let of = |maps: &Maps, receiver| -> Vec<bool> {
        let maps = maps.maps.iter();
        maps.map(|map| ray_is_blocked(&mesh, &grid, map, receiver))
            .collect()
    };
    let any = maps_of(&mesh, count, 25, 1);
    let rays: Vec<Vec<bool>> = receivers.iter().map(|r| of(&any, r)).collect();
    let mut wrong = Vec::new();
    for resolution in [25, 50, 100, 200] {
        let maps = maps_of(&mesh, count, resolution, 1);
        let layers = layers(&maps, &mesh).unwrap();
        let off = |(receiver, rays): (&Receiver, &Vec<bool>)| {
            let (mut must, mut wrong) = (0.0, 0);
            for ((map, hits), ray) in found(&maps, &layers, receiver).into_iter().zip(rays) {
                let weight = weight(map, receiver.normal);
                let hit = if weight < 0 { hits.behind } else { hits.before };
                wrong += u32::from(hit.is_some() != *ray);
                must += if *ray {
                    0.0
                } else {
                    f64::from(weight.unsigned_abs())
                };
            }
            let must = must * 2.0 / f64::from(count) / 524_288.0;
            let off = (part(&maps, &layers, receiver, Falloff::None) - must).abs();
            // A weight is at most 2^19 + 55, see `sums_of_weights_fit`.
            let most = f64::from(wrong) * 2.0 / f64::from(count) * (1.0 + 55.0 / 524_288.0);
            assert!(off <= most + 1e-12, "{off} of {wrong}");
            f64::from(wrong)
        };
        let all: Vec<f64> = receivers.iter().zip(&rays).map(off).collect();
        wrong.push(mean(&all));
    }
    // An eighth of a pixel has an eighth of the wrong ones. Points are independent, so the two means
    // are off by four of their standard errors once in 16,000; to that comes what is of second
    // order: a pixel over the ball's radius, which is 7 pixels at the coarsest. With a square root
    // more than a third would be left, and the margin tells the two apart.
    let ([coarse, a], [fine, b]) = (wrong[0], wrong[3]);
    let margin = 4.0 * a.hypot(8.0 * b) + coarse / 7.0;
    assert!((coarse - 8.0 * fine).abs() < margin, "{wrong:?}");
    assert!(
        coarse - 8.0_f64.sqrt() * fine > margin,
        "{wrong:?}: tells nothing"
    );
}
