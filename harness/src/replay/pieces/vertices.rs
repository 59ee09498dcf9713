//! The spec's vertex stages, runs of vertices and of triangles by themselves.

use std::time::Duration;

use triptych_spec::scene::{Scene, Vertex};
use triptych_spec::vertex::{self, Position, Primitives};

use crate::dispatch::share;
use crate::replay::spec::timed;

/// Vertices or triangles that are looked at together.
const RUN: usize = 1 << 13;

/// Stages transform, clip and snap, and how long each takes on one core.
pub fn primitives(scene: &Scene, bits: u32) -> (Primitives, [Duration; 3]) {
    let (positions, transform) = transformed(scene);
    let runs = share::each(scene.triangles.len().div_ceil(RUN), |number| {
        Run::new(scene, &positions, number * RUN, bits)
    });
    let sum = |of: fn(&Run) -> usize| runs.iter().map(of).sum();
    let mut all = Primitives {
        size: scene.size,
        bits,
        samples: scene.samples,
        snapped: Vec::with_capacity(sum(|run| run.primitives.snapped.len())),
        prims: Vec::with_capacity(sum(|run| run.primitives.prims.len())),
        source: Vec::with_capacity(sum(|run| run.primitives.source.len())),
    };
    let mut times = [transform, Duration::ZERO, Duration::ZERO];
    for run in runs {
        let first = row(all.snapped.len());
        let follow = |corners: [u32; 3]| corners.map(|corner| first + corner);
        all.snapped.extend(run.primitives.snapped);
        all.prims
            .extend(run.primitives.prims.into_iter().map(follow));
        all.source.extend(run.primitives.source);
        times[1] += run.times[0];
        times[2] += run.times[1];
    }
    (all, times)
}

/// Stage transform.
fn transformed(scene: &Scene) -> (Vec<Position<f64>>, Duration) {
    let (matrices, first) = timed(|| vertex::to_pixels(scene));
    let runs: Vec<_> = scene.vertices.chunks(RUN).collect();
    let run = |run: &&[Vertex]| timed(|| vertex::transform_run(&matrices, run));
    let (positions, times): (Vec<_>, Vec<Duration>) = share::map(&runs, 1, run).into_iter().unzip();
    (positions.concat(), first + times.iter().sum::<Duration>())
}

/// What comes of a run of triangles.
struct Run {
    /// Corners are those of the run, but `source` has the scene's triangles.
    primitives: Primitives,
    /// Of stages clip and snap.
    times: [Duration; 2],
}

impl Run {
    fn new(scene: &Scene, positions: &[Position<f64>], first: usize, bits: u32) -> Self {
        let end = scene.triangles.len().min(first + RUN);
        let triangles = &scene.triangles[first..end];
        let (polygons, clip) = timed(|| vertex::clip_run(scene.size, triangles, positions));
        let (mut primitives, snap) = timed(|| vertex::snap(scene, &polygons, bits));
        primitives.source.iter_mut().for_each(|n| *n += row(first));
        Self {
            primitives,
            times: [clip, snap],
        }
    }
}

fn row(n: usize) -> u32 {
    u32::try_from(n).expect("a scene has fewer than 2^32 corners")
}

#[cfg(test)]
mod tests {
    use triptych_spec::vertex;

    use super::{RUN, primitives};
    use crate::corpus;
    use crate::dispatch::share::with_threads;
    use crate::scene::load;

    #[test]
    fn runs_together_are_the_whole() {
        for (name, runs) in [
            ("abuffer/layers-20000", true),
            ("abuffer/out-of-view", false),
            ("abuffer/empty", false),
        ] {
            let file = corpus::root().join(name).join("scene.toml");
            let scene = load(&file).unwrap_or_else(|e| panic!("{e}")).scene;
            assert_eq!(scene.triangles.len() > RUN, runs, "{name}: several runs");
            for threads in [1, 3] {
                let (made, _) = with_threads(threads, || primitives(&scene, 8));
                assert_eq!(made, vertex::primitives(&scene, 8), "{name}");
            }
        }
    }
}
