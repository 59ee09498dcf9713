//! Rays that come ever nearer to what they must not confuse.

use triptych_spec::grid::exact::minus;
use triptych_spec::grid::lattice::{Point, REACH};
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::{Blockers, Grid};

use crate::generate::Random;

/// Seed of what is drawn here.
const SEED: u64 = 44;

/// The lattice is 2^24 steps wide, so from here on 2^-k of it is less than a step.
pub const STEP: u32 = 24;

/// The nearest: a ray passes its target at 2^-22 of a step, a start's direction having four
/// steps left to differ in.
pub const NEAREST: u32 = STEP + 22;

/// Rays of each target that start near it, and as many that pass.
const EACH: usize = 64;

/// Parts of an edge or a side at which points of triangles are taken: corners that are
/// multiples of it have these on the lattice.
pub const PARTS: i32 = 16;

/// What is come near to: the face, edge or corner of a cell or of a triangle.
#[derive(Clone, Copy)]
enum Target {
    Cell { axes: usize },
    Triangle { corners: usize },
}

/// Rays that start at 2^-k of the lattice's size from a target, and such that pass it.
///
/// Up to [`STEP`] the distance is a whole number of steps, along an axis. Beyond it no start
/// differs from the target any more, and those rays start on it; what passes is aimed from a
/// few steps away at the target and then `2^(k - STEP)` times as far, where it is one step
/// beside: it passes the target at about `2^(STEP - k)` of a step.
pub fn near(grid: &Grid, blockers: &Blockers, k: u32) -> Vec<Ray> {
    let mut source = Source {
        grid,
        blockers,
        random: Random::new(SEED),
    };
    let cells = [1, 2, 3].map(|axes| Target::Cell { axes });
    let triangles = [1, 2, 3].map(|corners| Target::Triangle { corners });
    let targets = cells.into_iter().chain(triangles);
    let both = targets.flat_map(|target| {
        let pair: Vec<Ray> = (0..EACH).flat_map(|_| source.pair(target, k)).collect();
        pair
    });
    both.collect()
}

struct Source<'a> {
    grid: &'a Grid,
    blockers: &'a Blockers,
    random: Random,
}

impl Source<'_> {
    /// A ray that starts near a target, and one that passes another.
    fn pair(&mut self, target: Target, k: u32) -> [Ray; 2] {
        let [start, through] = [self.target(target), self.target(target)];
        let axis = self.random.below(3);
        let sign = [-1, 1][self.random.below(2)];
        if k > STEP {
            let mut way = self.way(1 << (STEP - 1 - (k - STEP)));
            for axis in 0..3 {
                if (through[axis] - way[axis]).abs() > REACH {
                    way[axis] = -way[axis];
                }
            }
            let mut direction = way.map(|c| c << (k - STEP));
            direction[axis] += sign;
            let passes = Ray {
                origin: minus(through, way),
                direction,
                segment: false,
            };
            return [self.starting(start), passes];
        }
        let off = |at: Point| beside(at, axis, sign * (1 << (STEP - k).min(22)));
        // As far before the point as behind it, and on the lattice.
        let (at, mut way) = (off(through), self.way(1 << 21));
        for axis in 0..3 {
            let room = REACH - at[axis].abs();
            way[axis] = way[axis].clamp(-room, room);
        }
        let passes = Ray {
            segment: self.random.below(2) == 0,
            ..Ray::between(minus(at, way), minus(at, way.map(|c| -c)))
        };
        [self.starting(off(start)), passes]
    }

    /// From a point: along an axis, so along faces, or towards any other.
    fn starting(&mut self, from: Point) -> Ray {
        if self.random.below(2) == 0 {
            let mut direction = [0; 3];
            direction[self.random.below(3)] = [-1, 1][self.random.below(2)];
            return Ray {
                origin: from,
                direction,
                segment: false,
            };
        }
        let to = within(minus(from, self.way(1 << 22)));
        Ray {
            segment: self.random.below(2) == 0,
            ..Ray::between(from, to)
        }
    }

    /// A difference of at most so many steps on each axis, and not 0.
    fn way(&mut self, reach: i32) -> Point {
        loop {
            let way = [0; 3].map(|_: i32| round(f64::from(reach) * self.random.signed()));
            if way != [0; 3] {
                return way;
            }
        }
    }

    fn target(&mut self, target: Target) -> Point {
        match target {
            Target::Cell { axes } => {
                let first = self.random.below(3);
                let mut at = self.way(REACH / 2);
                for axis in (0..axes).map(|n| (first + n) % 3) {
                    let boundaries = self.grid.axes[axis].boundaries();
                    at[axis] = boundaries[self.random.below(boundaries.len())];
                }
                at
            }
            Target::Triangle { corners } => {
                let row = self.random.below(self.blockers.triangles.len());
                let row = u32::try_from(row).expect("fewer than 2^32 triangles");
                let [a, b, c] = self.blockers.corners(row);
                // Shares of b and c: none of either at a corner, one of them on an edge.
                let mut part = |most: i32| {
                    let parts = usize::try_from(most).expect("at most PARTS");
                    i32::try_from(self.random.below(parts + 1)).expect("at most PARTS")
                };
                let (u, v) = match corners {
                    3 => (0, 0),
                    2 => (part(PARTS), 0),
                    _ => {
                        let u = part(PARTS);
                        (u, part(PARTS - u))
                    }
                };
                let along = |axis: usize| {
                    let sum = i64::from(b[axis] - a[axis]) * i64::from(u)
                        + i64::from(c[axis] - a[axis]) * i64::from(v);
                    a[axis] + i32::try_from(sum / i64::from(PARTS)).expect("inside the triangle")
                };
                [0, 1, 2].map(along)
            }
        }
    }
}

/// Rays of so many lattice steps from points near triangles; half of them go on.
pub fn long(blockers: &Blockers, steps: i32) -> Vec<Ray> {
    let mut random = Random::new(SEED);
    let count = 12 * EACH;
    let one = |number: usize| {
        let row = u32::try_from(random.below(blockers.triangles.len())).expect("a row");
        let corners = blockers.corners(row);
        let [u, v] = [random.unit(), random.unit()];
        let at = [0, 1, 2].map(|axis| {
            let [a, b, c] = corners.map(|corner| f64::from(corner[axis]));
            round(a + 0.5 * (u * (b - a) + v * (c - a)))
        });
        let mut direction = [0; 3].map(|_: i32| round(f64::from(steps) * random.signed()));
        direction[random.below(3)] = [-steps, steps][random.below(2)];
        let origin = within([0, 1, 2].map(|axis| at[axis] - direction[axis] / 2));
        let end = within([0, 1, 2].map(|axis| origin[axis] + direction[axis]));
        let segment = Ray::between(origin, end);
        let endless = Ray {
            segment: false,
            ..segment
        };
        [segment, endless][number % 2]
    };
    (0..count).map(one).collect()
}

/// Moved along an axis; the other way where it would leave the lattice.
fn beside(mut at: Point, axis: usize, by: i32) -> Point {
    let moved = at[axis] + by;
    at[axis] = match moved.abs() <= REACH {
        true => moved,
        false => at[axis] - by,
    };
    within(at)
}

fn within(at: Point) -> Point {
    at.map(|c| c.clamp(-REACH, REACH))
}

fn round(x: f64) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "saturates")]
    let integer = x.round() as i32;
    integer
}

#[cfg(test)]
mod tests {
    use triptych_spec::grid::Membership;
    use triptych_spec::grid::resolution::Resolution;

    use super::*;
    use crate::vector::{cross, length};

    /// A triangle that is all corner: what comes near to a corner comes near to that point.
    fn point(at: Point) -> (Grid, Blockers) {
        let blockers = Blockers {
            vertices: vec![at],
            triangles: vec![[0; 3]],
        };
        let grid = Grid::build(&blockers, Resolution::Given([1; 3]), Membership::Box);
        (grid.expect("one cell"), blockers)
    }

    /// How far a ray's line is from a point.
    fn distance(ray: &Ray, at: Point) -> f64 {
        let [way, d] = [minus(at, ray.origin), ray.direction].map(|v| v.map(f64::from));
        length(cross(way, d)) / length(d)
    }

    #[test]
    fn rays_come_as_near_as_they_say() {
        let at = [12_345, -70_000, 4_000_000];
        let (grid, blockers) = point(at);
        for k in [2, 8, STEP - 1, STEP, STEP + 1, STEP + 10, NEAREST] {
            let must = f64::from(STEP.cast_signed() - k.cast_signed()).exp2();
            // The last target is a triangle's corner; starts and passing rays take turns.
            let rays = near(&grid, &blockers, k);
            assert_eq!(rays.len(), 2 * 6 * EACH);
            let mut largest = 0.0_f64;
            for pair in rays[2 * 5 * EACH..].chunks(2) {
                let start = length(minus(pair[0].origin, at).map(f64::from));
                let steps = if k > STEP { 0.0 } else { must };
                assert!((start - steps).abs() < 1e-6, "2^-{k}: {:?}", pair[0]);
                let passes = distance(&pair[1], at);
                assert!(
                    passes <= must * (1.0 + 1e-9),
                    "2^-{k}: {passes} {:?}",
                    pair[1]
                );
                largest = largest.max(passes / must);
            }
            assert!(largest > 0.5, "2^-{k}: {largest}");
        }
    }

    #[test]
    fn rays_are_as_long_as_they_say() {
        let (_, blockers) = point([0; 3]);
        for steps in [0, 1, 1 << 20] {
            let rays = long(&blockers, steps);
            for ray in &rays {
                let most = ray.direction.iter().map(|c| c.abs()).max();
                assert_eq!(most, Some(steps), "{ray:?}");
            }
            assert!(rays.iter().any(|r| r.segment) && rays.iter().any(|r| !r.segment));
        }
    }
}
