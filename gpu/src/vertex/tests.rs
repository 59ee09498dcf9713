use triptych_spec::matrix::Matrix;
use triptych_spec::raster::Samples;
use triptych_spec::scene::{Size, Triangle, Vertex};

use super::stages::VERTICES;
use super::*;
use crate::context::adapters;
use crate::frame::Band;
use crate::raster::{Reach, heights};
use crate::wgsl::Sources;

/// Every Vulkan adapter with kernels.
fn devices(sources: &Sources) -> Vec<(Gpu, Kernels)> {
    let all = adapters(wgpu::Backends::VULKAN);
    assert!(!all.is_empty(), "no adapter: `./x setup` installs two");
    all.iter()
        .map(|a| {
            (
                Gpu::open(a).expect("a device"),
                Kernels::new(sources.clone()),
            )
        })
        .collect()
}

/// Triangles in clip space on a spiral; every third one is cut, every third is out of
/// view. A vertex more than the triangles use comes last.
fn spiral(triangles: u32, spare: u32) -> Scene {
    let vertex = |i: u32| {
        let t = i as f32 / 8.0;
        let depth = [0.5, 1.0, 3.0][(i / 3 % 3) as usize] + (i % 3) as f32 / 8.0;
        Vertex {
            position: [t.cos() / 2.0, t.sin() / 2.0, depth - 0.125],
            instance: 0,
        }
    };
    let triangle = |t: u32| Triangle {
        vertices: [3 * t, 3 * t + 1, 3 * t + 2],
        instance: 0,
        primitive: t,
        colour: [1.0; 4],
    };
    Scene {
        samples: Samples::ONE,
        order: triptych_spec::abuffer::Order::Centroid,
        size: Size {
            width: 64,
            height: 48,
        },
        instances: vec![Matrix::IDENTITY],
        vertices: (0..3 * triangles + spare).map(vertex).collect(),
        triangles: (0..triangles).map(triangle).collect(),
        background: [0.0; 3],
    }
}

#[test]
fn batches_do_not_show() {
    let scene = spiral(300, 0);
    for (gpu, kernels) in devices(&Sources::shipped(false)) {
        let whole = run(&gpu, &kernels, &scene, 8, Given::Nothing, true).expect("small");
        let corners = whole.primitives.snapped.len();
        assert!(corners > 400 && corners != 600, "some are cut: {corners}");
        assert_eq!(
            whole.primitives.source.first(),
            Some(&0),
            "the first is in view"
        );
        assert_eq!(
            whole.primitives.source.iter().max(),
            Some(&298),
            "the third is not"
        );
        for batch in [1, 7, 299, 300] {
            let stages = Stages::new(&gpu, &kernels, &scene, 8, batch).expect("small");
            let parts = in_batches(stages, &scene, Given::Nothing, true).expect("small");
            assert_eq!(parts.primitives, whole.primitives, "batches of {batch}");
            assert_eq!(parts.polygons, whole.polygons, "batches of {batch}");
        }
    }
}

/// What a device made of a stage, handed back to it, gives what it gave before.
#[test]
fn given_results_take_the_place_of_the_stages_before() {
    let scene = spiral(300, 0);
    for (gpu, kernels) in devices(&Sources::shipped(false)) {
        let whole = run(&gpu, &kernels, &scene, 8, Given::Nothing, true).expect("small");
        let polygons = whole.polygons.as_ref().expect("they were asked for");
        for batch in [7, 300] {
            let from = |given, show| {
                let stages = Stages::new(&gpu, &kernels, &scene, 8, batch).expect("small");
                in_batches(stages, &scene, given, show).expect("small")
            };
            let clipped = from(Given::Positions(&whole.positions), true);
            assert_eq!(clipped.polygons.as_ref(), Some(polygons), "{}", gpu.name);
            assert_eq!(clipped.primitives, whole.primitives, "{}", gpu.name);
            assert!(clipped.positions.is_empty() && clipped.times.transform.is_zero());
            let snapped = from(Given::Polygons(polygons), true);
            assert_eq!(snapped.primitives, whole.primitives, "{}", gpu.name);
            assert!(snapped.polygons.is_none() && snapped.times.clip.is_zero());
        }
        let unseen = run(&gpu, &kernels, &scene, 8, Given::Nothing, false).expect("small");
        assert!(unseen.polygons.is_none(), "nobody asked for them");
    }
}

#[test]
fn vertices_beyond_one_dispatch_are_transformed() {
    let spare = VERTICES + 1;
    let scene = spiral(1, spare);
    let last = scene.vertices[scene.vertices.len() - 1].position;
    // 64 x 48 pixels, y down; the coordinates are short enough to be exact.
    let expected = [32.0 * last[0] + 32.0, 24.0 - 24.0 * last[1], last[2], 1.0];
    for (gpu, kernels) in devices(&Sources::shipped(false)) {
        let run = run(&gpu, &kernels, &scene, 8, Given::Nothing, true).expect("67 MB of vertices");
        let reached = run.positions.iter().filter(|p| p[3] == 1.0).count();
        assert_eq!(reached, scene.vertices.len(), "{}", gpu.name);
        let position = run.positions.last().expect("one for each vertex");
        assert!(
            position
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-4),
            "{position:?}, not {expected:?}"
        );
    }
}

#[test]
fn what_does_not_fit_its_slots_is_refused_by_name() {
    let shipped = Sources::shipped(false);
    let greedy = shipped.patched("vertex", "    if !outside {\n        return;\n    }\n", "");
    let greedy = greedy.and_then(|s| {
        s.patched(
            "vertex",
            "        if da >= 0.0 {\n",
            "        push(&kept, a);\n        if da >= 0.0 {\n",
        )
    });
    for (gpu, kernels) in devices(&greedy.expect("the kernel has these texts")) {
        let error = run(&gpu, &kernels, &spiral(9, 0), 8, Given::Nothing, false)
            .expect_err("corners double");
        let GpuError::Limit { what, limit, .. } = error else {
            panic!("{error}");
        };
        assert_eq!((what, limit), ("corners of a clipped triangle", 9));
    }
}

#[test]
fn a_scene_without_triangles_or_vertices_gives_nothing() {
    for (gpu, kernels) in devices(&Sources::shipped(false)) {
        let run = run(&gpu, &kernels, &spiral(0, 0), 8, Given::Nothing, true).expect("empty");
        assert_eq!((run.positions.len(), run.primitives.snapped.len()), (0, 0));
        assert_eq!(run.primitives.prims, [[0; 3]; 0]);
    }
}

/// Walks over a triangle: rows in which a sample lies within its height, times how many share its
/// longest row, 64 columns or fewer each, as far as a target is so wide.
fn walks(corners: &[[i32; 3]; 3], (bits, samples): (u32, Samples), size: Size) -> u32 {
    let down: Vec<i64> = samples.offsets(bits).map(|[_, down]| down).collect();
    let [a, b, c] = corners.map(|corner| corner.map(i64::from));
    let ends = [a[1].min(b[1]).min(c[1]), a[1].max(b[1]).max(c[1])];
    let within = |row: &i64| {
        let sample = |down: &i64| (row << bits) + down;
        let lies = |below: fn(i64, i64) -> bool, end| down.iter().any(|d| below(sample(d), end));
        lies(|y, top| y >= top, ends[0]) && lies(|y, bottom| y <= bottom, ends[1])
    };
    let rows = (0..i64::from(size.height)).filter(within).count();
    // Through the middle corner in height.
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let longest = area.abs() as f64 / ((ends[1] - ends[0]).max(1) << bits) as f64;
    let longest = longest.min(size.width.into());
    let sharing = [1, 2, 4, 8, 16, 32].into_iter();
    let sharing = sharing.filter(|n| f64::from(*n) * 64.0 >= longest).min();
    let rows = u32::try_from(rows).expect("a target's");
    let walks = rows * sharing.expect("2,048 columns or fewer");
    let host = Reach::of(corners, (size, bits), heights(samples, bits));
    assert_eq!(host.map_or(0, |host| host.walks(Band::whole(size))), walks);
    walks
}

/// Whether corners and walks of what is timed are what the host makes of the same stages.
fn as_the_host(gpu: &Gpu, kernels: &Kernels, scene: &Scene, samples: Samples) -> [bool; 2] {
    let must = run(gpu, kernels, scene, 8, Given::Nothing, false).expect("small");
    let must = must.primitives;
    let corner = |at: u32| must.snapped[at as usize];
    let corners: Vec<[[i32; 3]; 3]> = must.prims.iter().map(|p| p.map(corner)).collect();
    let grid = (8, samples);
    let timed = Timed::new(gpu, kernels, scene, grid, true).expect("small");
    let (fanned, starts) = timed.made().expect("it runs");
    let mut sum = 0;
    let mut begins = Vec::new();
    for opaque in [false, true] {
        for (corners, source) in corners.iter().zip(&must.source) {
            begins.push(sum);
            let own = scene.triangles[*source as usize].is_opaque() == opaque;
            sum += u32::from(own) * walks(corners, grid, scene.size);
        }
    }
    assert!(sum > 300, "{sum} walks");
    [fanned == corners, starts == begins]
}

/// What is timed gives what the host makes of the same stages, triangle by triangle and walk by
/// walk, with some triangles cut, some out of view, and every other opaque; and does not with a
/// defect.
#[test]
fn fans_and_walks_are_made_without_the_host() {
    let mut scene = spiral(300, 1);
    scene.size.width = 1_200;
    // Some reach far across.
    for vertex in scene.vertices.iter_mut().step_by(9) {
        vertex.position[0] = -0.25;
    }
    for triangle in scene.triangles.iter_mut().step_by(2) {
        triangle.colour[3] = 0.5;
    }
    let sources = Sources::shipped(false);
    for (gpu, kernels) in devices(&sources) {
        for samples in [1, 4, 8] {
            let samples = Samples::standard(samples).expect("a pattern");
            let seen = as_the_host(&gpu, &kernels, &scene, samples);
            assert_eq!(seen, [true; 2], "{}", gpu.name);
        }
    }
    for (file, find, replace, wrong) in [
        ("fans", "offsets[t] + i - 2u", "offsets[t]", 0),
        ("fans", "colour.a >= 1.0", "false", 1),
        (
            "fans",
            "max(bottom - top + 1, 0)",
            "max(bottom - top, 0)",
            1,
        ),
        ("fans", "return wide_sub(wide(0), area);", "return area;", 1),
        (
            "stride",
            "wide_less(wide_scale(most, stride), double_area)",
            "false",
            1,
        ),
    ] {
        let patched = sources.patched(file, find, replace);
        let patched = patched.unwrap_or_else(|error| panic!("{error}"));
        for (gpu, kernels) in devices(&patched) {
            let seen = as_the_host(&gpu, &kernels, &scene, Samples::ONE);
            assert!(!seen[wrong], "{find:?} is not seen on {}", gpu.name);
        }
    }
}
