use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::trace::{blocked, closest};
use triptych_spec::grid::{Blockers, Membership};
use triptych_spec::scene::Triangle;

use super::*;

/// A large triangle in the middle, and a small one above its left part that keeps the light
/// off, seen from `+z`: twice as wide as high, and flat.
fn scene() -> (Blockers, Scene) {
    let blockers = Blockers {
        vertices: vec![
            [-40_000, -20_000, 0],
            [40_000, -20_000, 0],
            [-40_000, 20_000, 0],
            // In front by 4000, so its shadow falls 2000 to the right and 2800 below.
            [-40_000, -20_000, 4_000],
            [-30_000, -20_000, 4_000],
            [-40_000, 0, 4_000],
        ],
        triangles: vec![[0, 1, 2], [3, 4, 5]],
    };
    let face = |vertices, colour| Triangle {
        vertices,
        instance: 0,
        primitive: 0,
        colour,
    };
    let scene = Scene {
        samples: triptych_spec::raster::Samples::ONE,
        order: triptych_spec::abuffer::Order::Centroid,
        size: Size {
            width: 8,
            height: 8,
        },
        instances: Vec::new(),
        vertices: Vec::new(),
        triangles: vec![
            face([0, 1, 2], [0.5, 0.5, 1.0, 1.0]),
            face([3, 4, 5], [1.0, 0.0, 0.0, 1.0]),
        ],
        background: [0.0, 0.25, 0.0],
    };
    (blockers, scene)
}

fn grid(blockers: &Blockers, cells: [u32; 3]) -> Grid {
    let grid = Grid::build(blockers, Resolution::Given(cells), Membership::Box);
    grid.expect("within the limits")
}

fn shown(grid: &Grid) -> View<'_> {
    View::new(grid).expect("a cheap picture")
}

#[test]
fn a_view_is_along_the_shortest_side() {
    let (mut blockers, _) = scene();
    for (turn, direction) in ["−z", "−x", "−y"].into_iter().enumerate() {
        let grid = grid(&blockers, [4, 4, 1]);
        let view = shown(&grid);
        assert_eq!(view.direction(), direction, "turned {turn} times");
        assert_eq!(view.size.width.max(view.size.height), 256);
        assert_eq!(view.size.width.min(view.size.height), 128);
        for vertex in &mut blockers.vertices {
            let [x, y, z] = *vertex;
            *vertex = [z, x, y];
        }
    }
}

/// What is at the top left of the picture, and that points come back to their pixels.
#[test]
fn pixels_and_points_belong_together() {
    let (blockers, _) = scene();
    let grid = grid(&blockers, [4, 2, 1]);
    let view = shown(&grid);
    let pixels: Vec<[i32; 2]> = view.pixels().collect();
    assert_eq!(pixels.len(), view.size.pixels());
    let [right, up] = pixels[0];
    assert!(
        right < -39_000 && up > 19_000,
        "left and up: {:?}",
        pixels[0]
    );
    for (number, [right, up]) in pixels.iter().enumerate() {
        let point = [*right, *up, 0].map(f64::from);
        assert_eq!(view.pixel(point), Some(number), "{point:?}");
    }
    assert_eq!(view.pixel([1e6, 0.0, 0.0]), None, "beside it");
}

#[test]
fn a_leg_is_seen_with_its_shadows() {
    let (blockers, scene) = scene();
    let grid = grid(&blockers, [8, 4, 1]);
    let view = shown(&grid);
    let ask = |rays: &[Ray], query: Query| -> Result<Met, ()> {
        let met = |ray: &Ray| match query {
            Query::Any => blocked(&grid, &blockers, *ray).then_some((0, 0.0)),
            Query::Closest => {
                closest(&grid, &blockers, *ray).map(|first| (first.prim, first.time.value()))
            }
        };
        Ok(rays.iter().map(met).collect())
    };
    let seen = view.seen(&scene, ask).expect("the spec does not fail");
    let at = |x: f64, y: f64| seen[view.pixel([x, y, 0.0]).expect("in view")];
    assert_eq!(
        at(-39_000.0, -19_000.0),
        [1.0, 0.0, 0.0],
        "in front, and lit"
    );
    assert_eq!(at(0.0, -15_000.0), [0.5, 0.5, 1.0], "behind, and lit");
    assert_eq!(at(39_000.0, 19_000.0), [0.0, 0.25, 0.0], "background");
    let shaded = [0.5, 0.5, 1.0].map(|c| c * SHADE);
    // Where the small one is not in front any more, but in the way of the light.
    assert_eq!(at(-29_500.0, -19_900.0), shaded);
}

#[test]
fn columns_fold_the_cells_behind_each_other() {
    // Two triangles behind each other on the left, one of them twice; nothing on the right but
    // one small one, which makes the box wide.
    let small = |x: i32, z: i32| [[x, -900, z], [x + 90, -900, z], [x, 900, z]];
    let corners = [
        small(0, 0),
        small(0, 1_000),
        small(0, 1_000),
        small(8_000, 0),
    ];
    let blockers = Blockers {
        vertices: corners.concat(),
        triangles: (0..4).map(|n| [3 * n, 3 * n + 1, 3 * n + 2]).collect(),
    };
    let grid = grid(&blockers, [8, 1, 2]);
    let view = shown(&grid);
    assert_eq!(view.direction(), "−z");
    let pixel = |x: f64| view.pixel([x, 0.0, 0.0]).expect("in view");
    let sum = view.columns(|sum, list| sum + list);
    assert_eq!(
        (sum[pixel(45.0)], sum[pixel(4_000.0)], sum[pixel(8_045.0)]),
        (3, 0, 1)
    );
    let longest = view.columns(u32::max);
    assert_eq!((longest[pixel(45.0)], longest[pixel(8_045.0)]), (2, 1));
}

/// All triangles in one cell: a picture of fewer pixels, not a replay of minutes.
#[test]
fn what_would_take_long_has_fewer_pixels() {
    let (blockers, _) = scene();
    let mut many = blockers.clone();
    let list = 1 + u32::try_from(size::WORK / (256 * 128)).expect("small");
    many.triangles = blockers.triangles.repeat(list as usize / 2 + 1);
    let sides = [blockers, many].map(|blockers| {
        let grid = grid(&blockers, [1; 3]);
        shown(&grid).size
    });
    let [full, half] = sides.map(|size| [size.width, size.height]);
    assert_eq!(full, [256, 128]);
    assert_eq!(half, [128, 64]);
}

/// Shadows may cost much more than what is seen: a light from the side passes more cells. Where
/// both are too much, there is no picture.
#[test]
fn what_would_take_hours_is_not_shown() {
    let (blockers, _) = scene();
    let of = |copies: usize, cells| {
        let mut many = blockers.clone();
        many.triangles = blockers.triangles.repeat(copies);
        let grid = grid(&many, cells);
        View::new(&grid).map(|view| [view.size.width, view.size.height])
    };
    // As many triangles behind each pixel, and in 26 cells of them on the way to the light.
    assert_eq!(of(200, [1; 3]), Some([256, 128]));
    assert_eq!(of(400, [1024, 1, 1]), Some([128, 64]));
    // 16 x 16 pixels of so many triangles are as many as may be.
    assert_eq!(of(1 << 17, [1; 3]), Some([16, 16]));
    assert_eq!(of(1 << 19, [1; 3]), None);
}

/// A house of which the front hides the inside is cut open; an open one is not.
#[test]
fn what_is_closed_in_front_is_cut() {
    let wall = |z: i32| {
        let corners = [[-400, -300], [400, -300], [400, 300], [-400, 300]];
        corners.map(|[x, y]| [x * 100, y * 100, z * 100])
    };
    let of = |walls: &[[Point; 4]]| {
        let vertices = walls.concat();
        let quad = |n: u32| [[4 * n, 4 * n + 1, 4 * n + 2], [4 * n, 4 * n + 2, 4 * n + 3]];
        let walls = u32::try_from(walls.len()).expect("few");
        Blockers {
            vertices,
            triangles: (0..walls).flat_map(quad).collect(),
        }
    };
    let floor = |y: i32| {
        [[-400, -200], [400, -200], [400, 200], [-400, 200]].map(|[x, z]| [x * 100, y, z * 100])
    };
    let closed = of(&[wall(-200), wall(200)]);
    let open = of(&[wall(-200), floor(-30_000)]);
    for (blockers, cut) in [(closed, true), (open, false)] {
        let grid = grid(&blockers, [8, 8, 16]);
        let view = shown(&grid);
        assert_eq!((view.direction(), view.is_cut()), ("−z", cut));
        let [_, near] = ends(&grid.axes[2]);
        let start = view.rays()[0].origin[2];
        assert_eq!(start < near, cut, "{start}, {near}");
    }
}
