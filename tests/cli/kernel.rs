//! `--kernel`: a user's WGSL in place of ours. The scenes are of family `raster`, in which rivals of
//! the lists have no part: drivers take seconds to compile them, in every process again.

use super::{Place, SCENE, deep, repository};

/// Our own kernel, as a file of a user's that only imports it.
const OURS: &str = "//#import abuffer\n";

#[test]
fn the_example_with_first_k_is_rejected() {
    let place = Place::new("kernel-first-k");
    place.write("corpus/raster/deep/scene.toml", &deep());
    place.write("corpus/raster/flat/scene.toml", SCENE);
    let example = repository().join("harness/examples/first-k/build.wgsl");
    let kernel = format!("build={}", example.display());
    let command = ["replay", "--leg", "gpu", "--kernel", &kernel];
    let run = |scene| place.run(&[&command[..], &[scene]].concat());
    // Up to eight layers all fragments are there; the race is seen in what it does.
    let flat = run("flat").expect(1).stdout;
    let causes = flat.split("Causes, over all stages: ").nth(1);
    let causes = causes.and_then(|c| c.lines().next()).unwrap_or_default();
    assert!(
        causes.starts_with("stale-pass ") && !causes.contains(", "),
        "a race on every path, and nothing else:\n{flat}"
    );
    let deep = run("deep").expect(1).stdout;
    assert!(
        deep.contains("not our kernel"),
        "the run says whose kernel runs:\n{deep}"
    );
    assert!(deep.contains(", build: "), "the stage is to blame:\n{deep}");
    assert!(deep.contains("coverage"), "fragments are missing:\n{deep}");
    assert!(
        deep.contains(&format!("--kernel {kernel}")),
        "again with it:\n{deep}"
    );
}

#[test]
fn our_own_kernel_from_a_file_agrees() {
    let place = Place::new("kernel-ours");
    place.write("corpus/raster/deep/scene.toml", &deep());
    place.write("mine.wgsl", OURS);
    let stages = ["opaque", "build", "sort", "resolve"];
    let kernels = stages.map(|stage| format!("{stage}=mine.wgsl"));
    let mut command = vec!["replay", "--no-skip", "--leg", "gpu"];
    for kernel in &kernels {
        command.extend(["--kernel", kernel]);
    }
    place.run(&command).expect(0);
}

#[test]
fn a_skeleton_is_printed_and_accepted() {
    let place = Place::new("kernel-skeleton");
    place.write("corpus/raster/deep/scene.toml", &deep());
    let text = place
        .run(&["replay", "--kernel", "resolve=?"])
        .expect(0)
        .stdout;
    assert!(
        text.contains("var<storage, read_write> picture: array<vec4<f32>>"),
        "{text}"
    );
    place.write("empty.wgsl", &text);
    let command = ["replay", "--leg", "gpu", "--kernel", "resolve=empty.wgsl"];
    let ran = place.run(&command).expect(1);
    assert!(
        ran.stdout.contains(", resolve: "),
        "an empty kernel draws nothing:\n{}",
        ran.stdout
    );
}

#[test]
fn a_path_without_a_kernel_is_skipped_and_says_so() {
    let place = Place::new("kernel-path");
    place.write("corpus/raster/deep/scene.toml", &deep());
    let compute = "@compute @workgroup_size(64) fn build() {}";
    place.write("compute.wgsl", compute);
    let command = ["replay", "--leg", "gpu", "--json", "out.json"];
    let kernel = ["--kernel", "build=compute.wgsl"];
    place.run(&[&command[..], &kernel].concat()).expect(1);
    let json = std::fs::read_to_string(place.root.join("out.json")).expect("written");
    let reason = "compute.wgsl has no kernel of stage build for the hardware's rasteriser";
    assert!(json.contains(reason), "{json}");
    // With no leg left that runs it, nothing is judged.
    for legs in [["--path", "fragment"], ["--leg", "spec"]] {
        let command = [&["replay"][..], &kernel, &legs].concat();
        let stderr = place.run(&command).expect(2).stderr;
        assert!(
            stderr.contains("no leg that was asked for runs its kernels"),
            "{stderr}"
        );
    }
}

/// A kernel whose stage the scene does not need has not been judged.
#[test]
fn a_kernel_that_never_runs_has_not_agreed() {
    let place = Place::new("kernel-idle");
    place.write("corpus/raster/deep/scene.toml", &deep());
    for stage in ["opaque", "build", "transform"] {
        let skeleton = place.run(&["replay", "--kernel", &format!("{stage}=?")]);
        place.write(&format!("{stage}.wgsl"), &skeleton.expect(0).stdout);
    }
    for (stage, from) in [
        ("opaque", &[][..]),
        ("build", &["--gpu-from", "sort"]),
        ("transform", &["--gpu-from", "snap"]),
    ] {
        let kernel = format!("{stage}={stage}.wgsl");
        let command = [&["replay", "--leg", "gpu", "--kernel", &kernel][..], from].concat();
        let stderr = place.run(&command).expect(2).stderr;
        let part = format!("stage {stage} was skipped everywhere");
        assert!(stderr.contains(&part), "{stderr}");
    }
    // The scene has nothing opaque, but all of it may be asked for.
    let command = [
        "replay",
        "--leg",
        "gpu",
        "--no-skip",
        "--kernel",
        "build=build.wgsl",
    ];
    place.run(&command).expect(1);
}

#[test]
fn mistakes_have_a_line_each() {
    let place = Place::new("kernel-mistakes");
    place
        .write("corpus/raster/deep/scene.toml", &deep())
        .write("broken.wgsl", "fn build() {\n    let x = ;\n}\n")
        .write("size.wgsl", "@compute @workgroup_size(32) fn build() {}\n")
        .write("mine.wgsl", OURS);
    for (values, part) in [
        (&["build"][..], "not STAGE=FILE"),
        (
            &["built=mine.wgsl"],
            "no stage is called built; there are transform, clip",
        ),
        (&["build=gone.wgsl"], "gone.wgsl: does not exist"),
        (&["build=corpus"], "corpus: is not a regular file"),
        (&["build=broken.wgsl"], "broken.wgsl:2: "),
        (
            &["build=size.wgsl"],
            "size.wgsl:1: build has workgroups of [32, 1, 1], not [64, 1, 1]",
        ),
        (
            &["sort=size.wgsl"],
            "size.wgsl:1: stage sort needs an entry point sort",
        ),
        (
            &["build=?", "build=mine.wgsl"],
            "prints a skeleton; leave the other --kernel out",
        ),
        (
            &["build=mine.wgsl", "build=mine.wgsl"],
            "stage build has a kernel already",
        ),
    ] {
        let mut arguments = vec!["replay"];
        for value in values {
            arguments.extend(["--kernel", value]);
        }
        let ran = place.run(&arguments).expect(2);
        assert_eq!(ran.stderr.lines().count(), 1, "{}", ran.stderr);
        assert!(
            ran.stderr.contains(part),
            "{part:?} is not in {:?}",
            ran.stderr
        );
    }
}
