use triptych_spec::grid::Membership;
use triptych_spec::grid::hit::sides;
use triptych_spec::grid::resolution::Resolution;

use super::*;
use crate::scene::grid::Count;

fn scene() -> (Blockers, Grid) {
    let blockers = Blockers {
        vertices: vec![[0, 0, 0], [9000, 0, 300], [100, 8000, 0], [70, 10, -9000]],
        triangles: vec![[0, 1, 2], [0, 1, 3]],
    };
    let grid = Grid::build(&blockers, Resolution::Given([4; 3]), Membership::Box);
    let grid = grid.expect("a small one");
    (blockers, grid)
}

#[test]
fn kinds_are_what_they_are_called() {
    let (blockers, grid) = scene();
    let counts = Rays {
        cell: Count(200),
        ..Rays::default()
    };
    let (rays, ends) = draw(&blockers, &grid, 3, &counts);
    assert_eq!(ends, [250, 500, 750, 1000, 1250, 1450], "ends of kinds");
    let of = |i: usize| &rays[ends[i] - 200..ends[i]];
    // As many products of three sides as rays are 0 on the way through edges.
    let zeros = |ray: &Ray| {
        let all = (0..2).flat_map(|prim| sides(ray, blockers.corners(prim)));
        all.filter(|side| *side == 0).count()
    };
    assert!(of(3).iter().all(|ray| zeros(ray) >= 2), "through corners");
    let near = of(2).iter().filter(|ray| zeros(ray) > 0).count();
    assert!(near > 0, "some edges are hit to the step");
    let boundary = |ray: &&Ray| {
        let [x, ..] = grid.axes.each_ref().map(Axis::boundaries);
        x.contains(&ray.origin[0])
    };
    assert!(
        of(5).iter().filter(boundary).count() > 100,
        "from boundaries"
    );
    assert_eq!(draw(&blockers, &grid, 3, &counts).0, rays, "the same again");
    assert_ne!(draw(&blockers, &grid, 4, &counts).0, rays, "another seed");
}

#[test]
fn rays_stay_on_the_lattice() {
    let (mut blockers, _) = scene();
    let limit = triptych_spec::grid::lattice::EXTENT;
    blockers.vertices.extend([[limit; 3], [-limit; 3]]);
    blockers.triangles.push([0, 4, 5]);
    let grid = Grid::build(&blockers, Resolution::FromScene, Membership::Box);
    let grid = grid.expect("a small one");
    let (rays, _) = draw(&blockers, &grid, 1, &Rays::default());
    for ray in rays {
        let end = if ray.segment { ray.direction } else { [0; 3] };
        let end = [0, 1, 2].map(|i| ray.origin[i] + end[i]);
        let within = |p: Point| p.iter().all(|c| c.abs() <= REACH);
        assert!(within(ray.origin) && within(end), "{ray:?}");
        assert!(
            ray.direction.iter().all(|c| c.abs() <= 2 * REACH),
            "{ray:?}"
        );
    }
}
