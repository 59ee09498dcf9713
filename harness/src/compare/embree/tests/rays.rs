//! The comparer of rays on scenes whose answer is known.

mod bunny;
mod planted;

use triptych_spec::grid::lattice::Point;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::trace::Query;
use triptych_spec::grid::{Blockers, Grid, Membership};

use super::Random;
use crate::compare::embree::{OfKind, RayVote, compare_kinds, compare_rays};
use crate::dispatch::share;
use crate::embree::rays::bound::{Pair, pair};
use crate::embree::rays::{RayAnswers, RayScene};
use crate::embree::{EmbreeError, Hit};

const QUERIES: [Query; 2] = [Query::Any, Query::Closest];

/// Blockers with all that is made of them.
struct Scene {
    blockers: Blockers,
    grid: Grid,
    embree: RayScene,
}

impl Scene {
    fn new(blockers: Blockers) -> Self {
        let grid = Grid::build(&blockers, Resolution::FromScene, Membership::Overlap);
        Self {
            grid: grid.expect("within the limits"),
            embree: RayScene::new(&blockers).expect("Embree builds"),
            blockers,
        }
    }

    fn of(triangles: &[[Point; 3]]) -> Self {
        let rows = (0_u32..).zip(triangles).map(|(row, _)| row);
        Self::new(Blockers {
            vertices: triangles.concat(),
            triangles: rows.map(|r| [3 * r, 3 * r + 1, 3 * r + 2]).collect(),
        })
    }

    fn vote(&self, rays: &[Ray], query: Query) -> RayVote {
        self.against(rays, query, &self.embree)
    }

    fn against(&self, rays: &[Ray], query: Query, embree: &impl RayAnswers) -> RayVote {
        compare_rays(&self.grid, &self.blockers, rays, query, embree).expect("Embree traces")
    }

    /// Embree's closest hits after a change.
    fn changed<F: Fn(&Ray, Option<Hit>) -> Option<Hit> + Sync>(&self, change: F) -> Changed<'_, F> {
        Changed(&self.embree, change)
    }

    fn pair(&self, ray: &Ray, prim: u32) -> Pair {
        pair(ray, self.blockers.corners(prim))
    }
}

/// Embree's answers after a change: what is closest, and is anything.
struct Changed<'a, F>(&'a RayScene, F);

impl<F: Fn(&Ray, Option<Hit>) -> Option<Hit> + Sync> RayAnswers for Changed<'_, F> {
    fn occluded(&self, ray: &Ray) -> bool {
        self.closest(ray).is_some()
    }

    fn closest(&self, ray: &Ray) -> Option<Hit> {
        (self.1)(ray, self.0.closest(ray))
    }

    fn check(&self) -> Result<(), EmbreeError> {
        self.0.check()
    }
}

fn point(random: &mut Random, reach: i32) -> Point {
    [0; 3].map(|_| random.within(-reach, reach))
}

/// 200 triangles anywhere, large and small.
fn soup() -> Scene {
    let mut random = Random(5);
    let mut triangle = |row: i32| {
        let size = 1 << (12 + row % 10);
        let centre = point(&mut random, 1 << 22);
        [0; 3].map(|_| {
            let off = point(&mut random, size);
            [0, 1, 2].map(|i| centre[i] + off[i])
        })
    };
    let triangles: Vec<_> = (0..200).map(&mut triangle).collect();
    Scene::of(&triangles)
}

/// Segments and rays anywhere.
fn anywhere(count: usize) -> Vec<Ray> {
    let mut random = Random(6);
    let mut ray = |row| Ray {
        segment: row % 2 == 0,
        ..Ray::between(point(&mut random, 1 << 23), point(&mut random, 1 << 22))
    };
    (0..count).map(&mut ray).collect()
}

/// Two sheets, the second behind the first, and one that no ray below meets.
fn sheets() -> Scene {
    let sheet = |z| [[-4096, -4096, z], [8192, -4096, z], [-4096, 8192, z]];
    let aside = sheet(512).map(|[x, y, z]| [x + 100_000, y, z]);
    Scene::of(&[sheet(0), sheet(1000), aside])
}

/// Through both sheets; beside both; between them.
fn straight() -> [Ray; 3] {
    let along = |x, from, to| Ray::between([x, 17, from], [x + 5, 20, to]);
    [
        along(100, -999, 3001),
        along(50_000, -999, 3001),
        along(100, 400, 600),
    ]
}

#[test]
fn anything_agrees() {
    let (scene, rays) = (soup(), anywhere(50_000));
    for query in QUERIES {
        let vote = scene.vote(&rays, query);
        assert_eq!((vote.rays, vote.disagree), (50_000, 0), "{vote}");
        assert!(vote.edge * 1000 < vote.rays, "{vote}");
        if query == Query::Closest {
            assert!(vote.times > 10_000, "{vote}");
            assert!((0.1..=1.0).contains(&vote.error_over_bound), "{vote}");
        }
    }
}

#[test]
fn what_is_in_class_edge_is_so_without_being_listed() {
    let mut scene = sheets();
    // Along the first sheet's edge: through its border, and nothing else.
    let border = [Ray::between([-4096, 17, -999], [-4096, 17, 999])];
    let listed = QUERIES.map(|query| scene.vote(&border, query));
    scene.grid.prims.fill(2);
    for (query, listed) in QUERIES.into_iter().zip(listed) {
        assert_eq!((listed.edge, listed.disagree), (1, 0), "{listed}");
        let claim = scene.changed(|_, _| Some(Hit { prim: 0, t: 0.5 }));
        let vote = scene.against(&border, query, &claim);
        assert_eq!((vote.edge, vote.disagree), (1, 0), "{vote}");
    }
}

/// A sheet of hills, seen from above: rays at its corners, and at points of its edges.
#[test]
fn rays_at_corners_and_edges_are_in_class_edge() {
    const SIDE: u32 = 40;
    let mut random = Random(7);
    let step = 100_000;
    let mut hill = |row: u32| {
        let [x, y] = [row % SIDE, row / SIDE].map(|i| step * i32::try_from(i).expect("few"));
        [x - 2_000_000, y - 2_000_000, random.within(0, step)]
    };
    let vertices: Vec<Point> = (0..SIDE * SIDE).map(&mut hill).collect();
    let corners = (0..SIDE - 1).flat_map(|j| (0..SIDE - 1).map(move |i| j * SIDE + i));
    let halves = corners.flat_map(|c| [[c, c + 1, c + SIDE], [c + 1, c + SIDE + 1, c + SIDE]]);
    let triangles: Vec<[u32; 3]> = halves.collect();
    let scene = Scene::new(Blockers {
        vertices: vertices.clone(),
        triangles: triangles.clone(),
    });
    let mut at = |target: Point| {
        let from = [
            target[0] + random.within(-step, step),
            target[1] + random.within(-step, step),
            1 << 22,
        ];
        let segment = false;
        Ray {
            segment,
            ..Ray::between(from, target)
        }
    };
    let middle = |[a, b, _]: [u32; 3]| {
        let [a, b] = [a, b].map(|v| vertices[v as usize]);
        [0, 1, 2].map(|i| i32::midpoint(a[i], b[i]))
    };
    let mut rays: Vec<Ray> = vertices.iter().map(|v| at(*v)).collect();
    rays.extend(triangles.iter().map(|t| at(middle(*t))));
    for query in QUERIES {
        let vote = scene.vote(&rays, query);
        assert_eq!((vote.edge, vote.disagree), (vote.rays, 0), "{vote}");
        assert!(vote.judgement(None).skipped.is_some(), "nothing judged");
        assert!(
            query == Query::Any || vote.agreed_in_edge < vote.edge,
            "neighbours tie: {vote}"
        );
    }
}

/// One ray along the border of a sheet, two through both, two that do not move, one beside.
#[test]
fn class_edge_is_counted_for_each_kind() {
    let scene = sheets();
    let border = Ray::between([-4096, 17, -999], [-4096, 17, 999]);
    let still = Ray::between([0, 0, 0], [0, 0, 0]);
    let [through, beside, _] = straight();
    let rays = [border, through, through, still, still, beside];
    let kinds = [
        ("one", 2),
        ("none", 2),
        ("two", 3),
        ("still", 5),
        ("last", 6),
    ];
    let nothing = scene.changed(|_, _| None);
    for query in QUERIES {
        let Scene { grid, blockers, .. } = &scene;
        let vote = compare_kinds(grid, blockers, &rays, kinds, query, &nothing);
        let vote = vote.expect("no error");
        let kind = |name, asked, edge| OfKind { name, asked, edge };
        let expected = [kind("one", 2, 1), kind("two", 1, 0), kind("last", 1, 0)];
        assert_eq!(vote.kinds, expected, "{vote}");
        assert_eq!((vote.rays, vote.still, vote.edge), (6, 2, 1), "{vote}");
        let missed: Vec<usize> = vote.first.iter().map(|d| d.ray).collect();
        assert_eq!(missed, [1, 2], "numbers are those of all rays: {vote}");
        let note = vote.judgement(None).note;
        let words = "; edge: one 50.0 %, two 0 %, last 0 %; 2 disagree, first: ray 1: ";
        assert!(note.contains(words), "{note}");
    }
}

#[test]
fn rays_that_do_not_move_are_not_asked() {
    let scene = sheets();
    let still = [Ray::between([0, 0, 0], [0, 0, 0])];
    let claim = scene.changed(|_, _| Some(Hit { prim: 0, t: 0.0 }));
    for query in QUERIES {
        let vote = scene.against(&still, query, &claim);
        assert_eq!((vote.rays, vote.still, vote.disagree), (1, 1, 0), "{vote}");
        let skipped = vote.judgement(None).skipped;
        assert_eq!(skipped.as_deref(), Some("no ray moves"), "{vote}");
    }
}

#[test]
fn the_result_does_not_depend_on_threads() {
    let (scene, rays) = (soup(), anywhere(20_000));
    let late = scene.changed(|_, hit| hit.map(|hit| Hit { prim: 0, ..hit }));
    let asked = || scene.against(&rays, Query::Closest, &late);
    let [alone, many] = [1, 5].map(|threads| share::with_threads(threads, asked));
    assert!(many.disagree > 1000 && many.first.len() == 4, "{many}");
    assert_eq!(alone, many, "one thread against many");
}
