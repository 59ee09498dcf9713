//! What a tree says of rays is what the grid says.

use triptych_spec::dispatch::{Searched, Tracer};
use triptych_spec::grid::Grid;
use triptych_spec::grid::Membership;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::resolution::Resolution;

use super::worlds::{Random, blockers};
use crate::dispatch::tree::Tree;

/// Rays of a scene: anywhere, along axes, from and to corners and the middles of edges.
fn rays(random: &mut Random, points: &[[i32; 3]], most: i32) -> Vec<Ray> {
    let mut rays = Vec::new();
    for number in 0..3000 {
        let pick = |random: &mut Random| {
            let at = usize::try_from(random.next() % points.len() as u64).expect("fits");
            points[at]
        };
        let from = match number % 3 {
            0 => pick(random),
            _ => random.point(most),
        };
        let to = match number % 4 {
            0 | 1 => pick(random),
            2 => {
                let [a, b] = [pick(random), pick(random)];
                [0, 1, 2].map(|i| i32::midpoint(a[i], b[i]))
            }
            _ => {
                let mut to = from;
                to[number % 3] = random.within(most);
                to
            }
        };
        let segment = Ray::between(from, to);
        rays.push(Ray {
            segment: number % 2 == 0,
            ..segment
        });
    }
    rays
}

#[test]
fn a_tree_answers_as_a_grid_does() {
    for (seed, most) in [(1, 1 << 22), (2, 1 << 10), (3, 40), (4, 5)] {
        let mut random = Random(seed);
        let blockers = blockers(&mut random, 200, most);
        let grid = Grid::build(&blockers, Resolution::FromScene, Membership::Box).expect("a grid");
        let searched = Searched {
            grid: &grid,
            blockers: &blockers,
        };
        let tree = Tree::new(&blockers);
        let mut met = 0;
        for ray in rays(&mut random, &blockers.vertices, most) {
            let closest = searched.closest(ray);
            assert_eq!(tree.closest(ray), closest, "{ray:?} at {most}");
            assert_eq!(
                tree.blocked(ray),
                searched.blocked(ray),
                "{ray:?} at {most}"
            );
            met += u32::from(closest.is_some());
        }
        assert!(met > 300, "only {met} rays meet anything at {most}");
    }
}

#[test]
fn nothing_is_met_where_nothing_is() {
    let tree = Tree::new(&triptych_spec::grid::Blockers::default());
    let ray = Ray::between([0; 3], [5, 0, 0]);
    assert_eq!(tree.closest(ray), None, "no triangles");
    assert!(!tree.blocked(ray), "no triangles");
}
