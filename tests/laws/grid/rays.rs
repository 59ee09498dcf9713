//! What a ray meets does not depend on how it is asked for.

use proptest::prelude::*;
use triptych_spec::grid::exact::{Time, triple};
use triptych_spec::grid::hit::crossing;
use triptych_spec::grid::lattice::{EXTENT, Lattice, LatticeError, Point, REACH};
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::trace::{blocked, closest};
use triptych_spec::grid::walk::{Walk, step_bound};
use triptych_spec::grid::{Blockers, Grid, Membership};

use super::{aimed, blockers, nearest, point, resolution};
use crate::config;

/// Both answers of a scene without a grid.
fn met(blockers: &Blockers, ray: &Ray) -> bool {
    nearest(blockers, ray).is_some()
}

fn plus(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

proptest! {
    #![proptest_config(config(2000))]

    /// Through cells, a ray meets what it meets without: the same nearest triangle at the
    /// same time, and something if and only if there is something.
    #[test]
    fn brute_force((blockers, grid, rays) in aimed()) {
        for ray in rays {
            let expected = nearest(&blockers, &ray);
            prop_assert_eq!(closest(&grid, &blockers, ray), expected, "{:?}", ray);
            prop_assert_eq!(blocked(&grid, &blockers, ray), expected.is_some(), "{:?}", ray);
        }
    }

    /// A walk leads from cell to neighbour, its times never fall, and the ray is in each
    /// closed cell until it leaves.
    #[test]
    fn walks((_, grid, rays) in aimed()) {
        for ray in rays {
            let mut enter = Time::START;
            let mut last: Option<[u32; 3]> = None;
            let mut steps = 0;
            for passed in Walk::new(&grid, ray) {
                steps += 1;
                if let Some(last) = last {
                    let moved: u32 = (0..3).map(|i| last[i].abs_diff(passed.cell[i])).sum();
                    prop_assert_eq!(moved, 1);
                    prop_assert!(inside(&grid, &ray, passed.cell, enter), "enters {:?}", passed);
                    prop_assert!(enter <= passed.exit);
                }
                prop_assert!(inside(&grid, &ray, passed.cell, passed.exit), "leaves {:?}", passed);
                enter = passed.exit;
                last = Some(passed.cell);
            }
            prop_assert!(steps <= step_bound(&grid));
        }
    }

    /// A segment backwards is blocked as it is forwards.
    #[test]
    fn reversed(blockers in blockers(), from in point(), to in point()) {
        let there = met(&blockers, &Ray::between(from, to));
        prop_assert_eq!(there, met(&blockers, &Ray::between(to, from)));
    }

    /// A segment in two parts is blocked if a part is; a triangle that contains the joint
    /// blocks both.
    #[test]
    fn in_parts(blockers in blockers(), from in point(), step in [-9..9_i32, -9..9, -9..9], cut in 1..20_i32) {
        let from = from.map(|c| c.clamp(-EXTENT / 2, EXTENT / 2));
        let at = |n: i32| plus(from, step.map(|s| s * n));
        let whole = met(&blockers, &Ray::between(at(0), at(20)));
        let parts = [Ray::between(at(0), at(cut)), Ray::between(at(cut), at(20))];
        prop_assert_eq!(whole, parts.iter().any(|part| met(&blockers, part)));
    }

    /// Moving triangles, cells and rays together changes nothing.
    #[test]
    fn moved((blockers, grid, rays) in aimed(), by in point()) {
        let halved = |p: Point| p.map(|c| c / 2);
        let by = by.map(|c| c / 4);
        let still = Blockers { vertices: blockers.vertices.iter().map(|p| halved(*p)).collect(), ..blockers.clone() };
        let moved = Blockers { vertices: still.vertices.iter().map(|p| plus(*p, by)).collect(), ..blockers };
        let cells = Resolution::Given(grid.axes.each_ref().map(|axis| axis.cells()));
        let build = |b| Grid::build(b, cells, Membership::Overlap).expect("within the limits");
        let (a, b) = (build(&still), build(&moved));
        prop_assert_eq!(&a.offsets, &b.offsets);
        prop_assert_eq!(&a.prims, &b.prims);
        for ray in rays {
            let here = Ray { origin: halved(ray.origin), ..ray };
            let there = Ray { origin: plus(here.origin, by), ..ray };
            prop_assert_eq!(closest(&a, &still, here), closest(&b, &moved, there));
        }
    }

    /// A triangle in two, cut through a corner and a point of the opposite edge, is met
    /// where it was, and at the same time.
    #[test]
    fn split(a in point(), b in point(), step in point(), cut in 1..8_i32, n in 9..12_i32, from in point(), to in point()) {
        let step = step.map(|c| c / 32);
        let b = b.map(|c| c / 2);
        let on = |k: i32| plus(b, step.map(|s| s * k));
        for ray in [Ray::between(from, to), Ray::between(from, on(cut)), Ray::between(a, to)] {
            let whole = crossing(&ray, [a, b, on(n)]);
            let parts = [[a, b, on(cut)], [a, on(cut), on(n)]];
            let parts = parts.into_iter().filter_map(|part| crossing(&ray, part)).min();
            prop_assert_eq!(whole, parts);
        }
    }

    /// How fine the grid is and which cells list a triangle changes no answer.
    #[test]
    fn any_resolution((blockers, grid, rays) in aimed(), other in resolution()) {
        let other = Grid::build(&blockers, other, Membership::Box).expect("within the limits");
        for ray in rays {
            prop_assert_eq!(closest(&grid, &blockers, ray), closest(&other, &blockers, ray));
        }
    }

    /// The order of fractions is that of their quotients, where these tell them apart, and
    /// multiples are equal.
    #[test]
    fn times(a in -1_i128 << 76..1 << 76, b in 1_i128..1 << 76, c in -1_i128 << 76..1 << 76, d in 1_i128..1 << 76, k in 1_i128..1 << 24) {
        let (left, right) = (Time::new(a, b), Time::new(-c, -d));
        let gap = (left.value() - right.value()).abs();
        if gap > 1e-14 * left.value().abs().max(right.value().abs()) {
            prop_assert_eq!(left < right, left.value() < right.value());
        }
        prop_assert_eq!(left, Time::new(a * k, b * k));
        // As far as a fraction can be from its neighbour: 1 / (b * (b + 1)).
        prop_assert!(Time::new(b, b + 1) < Time::new(b + 1, b + 2));
        prop_assert!(Time::new(-b, b + 1) > Time::new(-b - 1, b + 2));
    }

    /// A triple product of the largest differences is what the rule of Sarrus gives.
    #[test]
    fn volumes(v in prop::array::uniform9(prop_oneof![-1 << 24..=1 << 24, prop::sample::select(vec![-1 << 24, 1 << 24])])) {
        let m = v.map(i128::from);
        let sarrus = m[0] * m[4] * m[8] + m[1] * m[5] * m[6] + m[2] * m[3] * m[7]
            - m[2] * m[4] * m[6] - m[1] * m[3] * m[8] - m[0] * m[5] * m[7];
        prop_assert_eq!(triple([v[0], v[1], v[2]], [v[3], v[4], v[5]], [v[6], v[7], v[8]]), sarrus);
    }

    /// Points come within half a step of where they were, whatever their scale and offset,
    /// and use more than half of the lattice.
    #[test]
    fn lattices(points in prop::collection::vec([-1.0..1.0_f64, -1.0..1.0, -1.0..1.0], 2..9), power in -90..60_i32, offset in -1e6..1e6_f64) {
        let scale = f64::from(power).exp2();
        let points: Vec<_> = points.into_iter().map(|p| p.map(|c| (c + offset) * scale)).collect();
        let lattice = Lattice::around(points.iter().copied()).expect("finite");
        let step = f64::from(lattice.exponent).exp2();
        let mut reach = 0;
        for point in points {
            let snapped = lattice.snap(point).expect("inside");
            reach = snapped.iter().fold(reach, |m, c| m.max(c.abs()));
            let back = lattice.world(snapped);
            for i in 0..3 {
                // Both the difference and the sum round once.
                let off = 0.5 * step + 4.0 * f64::EPSILON * point[i].abs().max(lattice.centre[i].abs());
                prop_assert!((back[i] - point[i]).abs() <= off);
            }
        }
        prop_assert!((EXTENT / 2 - 2..=EXTENT).contains(&reach), "{reach}");
    }
}

/// Whether a ray is in the closed cell at a time.
fn inside(grid: &Grid, ray: &Ray, cell: [u32; 3], time: Time) -> bool {
    (0..3).all(|axis| {
        let origin = i128::from(ray.origin[axis]);
        let direction = i128::from(ray.direction[axis]);
        let boundaries = grid.axes[axis].boundaries();
        let [low, high] = [0, 1].map(|i| i128::from(boundaries[cell[axis] as usize + i]) - origin);
        match direction {
            0 => low <= 0 && 0 <= high,
            d if d > 0 => Time::new(low, d) <= time && time <= Time::new(high, d),
            d => Time::new(high, d) <= time && time <= Time::new(low, d),
        }
    })
}

/// What makes no lattice is named.
#[test]
fn no_lattice() {
    assert_eq!(Lattice::around([]), Err(LatticeError::Empty));
    let nan = [0.0, f64::INFINITY, 0.0];
    assert_eq!(
        Lattice::around([nan]),
        Err(LatticeError::NotFinite(f64::INFINITY))
    );
    let lattice = Lattice::around([[1.0; 3]]).expect("a point is enough");
    assert_eq!(lattice.snap([1.0; 3]), Some([0; 3]));
    assert_eq!(lattice.snap([3.0; 3]), None, "beyond the lattice");
    assert_eq!(lattice.snap([1.0, f64::NAN, 1.0]), None);
    assert_eq!(lattice.snap([2.0; 3]), Some([REACH; 3]), "its very end");
}

/// Directions keep 24 bits of their longest component; what has none goes nowhere.
#[test]
fn directions() {
    let along = |d| Ray::along([0; 3], d).direction;
    assert_eq!(along([1.0, -0.0, 0.0]), [1 << 23, 0, 0]);
    let small = [-3.0, 1.5, 0.0].map(|c: f64| c * f64::MIN_POSITIVE);
    assert_eq!(along(small), along([-3.0, 1.5, 0.0]));
    assert_eq!(along([1.0, 1e-30, 0.0]), [1 << 23, 0, 0]);
    for none in [[0.0; 3], [f64::NAN, 1.0, 0.0], [f64::INFINITY, 1.0, 0.0]] {
        assert!(!Ray::along([0; 3], none).moves());
    }
}
