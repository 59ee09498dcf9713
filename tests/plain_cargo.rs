//! Plain cargo suffices: what `./x setup` wrote into `.native/config.toml` is all that
//! building and running need, without a variable of the user's.
//!
//! The last test runs the others again, by a cargo that is given nothing but the way
//! to itself. Cargo does not hold its lock while tests run, and it finds everything
//! built: the second cargo takes a second or two, and changes nothing.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Whether a folder has a file whose name starts so.
fn has(folder: &Path, start: &str) -> bool {
    let entries = std::fs::read_dir(folder);
    let entries = entries.unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    entries
        .flatten()
        .any(|e| e.file_name().to_string_lossy().starts_with(start))
}

fn variable(name: &str) -> String {
    std::env::var(name)
        .unwrap_or_else(|_| panic!("{name} is not set; run ./x setup, and this by cargo"))
}

/// The linker found Embree, and so does the loader.
#[test]
fn embree_is_linked() {
    let library = triptych_harness::embree::library();
    library.unwrap_or_else(|e| panic!("{e}"));
}

#[test]
fn drivers_are_visible() {
    for driver in variable("VK_ADD_DRIVER_FILES").split(':') {
        assert!(Path::new(driver).is_file(), "{driver} is missing");
    }
    let adapters = triptych_gpu::context::adapters(wgpu::Backends::VULKAN);
    let names: Vec<String> = adapters.iter().map(|a| a.get_info().name).collect();
    let swiftshader = names.iter().any(|name| name.contains("SwiftShader"));
    assert!(swiftshader, "SwiftShader is not among {names:?}");
}

/// What bindgen reads C headers with, and the headers that it takes from the compiler.
#[test]
fn bindgen_has_what_it_needs() {
    let folder = PathBuf::from(variable("LIBCLANG_PATH"));
    assert!(
        has(&folder, "libclang"),
        "no libclang in {}",
        folder.display()
    );
    let arguments = variable("BINDGEN_EXTRA_CLANG_ARGS");
    let headers = arguments
        .strip_prefix("-isystem ")
        .expect("a folder of headers");
    assert!(
        has(Path::new(headers), "stddef.h"),
        "no stddef.h in {headers}"
    );
}

#[test]
fn plain_cargo_test_suffices() {
    let mut cargo = Command::new("cargo");
    cargo.env_clear().current_dir(env!("CARGO_MANIFEST_DIR"));
    for name in ["PATH", "HOME", "CARGO_HOME", "RUSTUP_HOME"] {
        if let Some(value) = std::env::var_os(name) {
            cargo.env(name, value);
        }
    }
    // All packages, as ./x test has it: of fewer, cargo would unite fewer features,
    // and build much of it again.
    cargo.args(["test", "--workspace", "--offline", "--test", "plain_cargo"]);
    cargo.args(same_target());
    cargo.args(["--", "--skip", "plain_cargo_test_suffices"]);
    let output = cargo.output().expect("cargo is in PATH");
    let [out, err] =
        [output.stdout, output.stderr].map(|b| String::from_utf8_lossy(&b).into_owned());
    assert!(output.status.success(), "{cargo:?}\n{err}\n{out}");
    assert!(out.contains("test result: ok. 3 passed"), "{out}");
}

/// Options that make cargo use what this test was built with.
fn same_target() -> Vec<PathBuf> {
    let program = std::env::current_exe().expect("a program knows where it is");
    let profile = program
        .ancestors()
        .nth(2)
        .expect("TARGET/PROFILE/deps/program");
    let name = profile.file_name().expect("a profile has a name");
    let above = profile.parent().expect("a profile is in a folder");
    let mut options = Vec::new();
    match name.to_str() {
        Some("debug") => {}
        _ => options.extend(["--profile".into(), name.into()]),
    }
    let target = if above.join("CACHEDIR.TAG").is_file() {
        above
    } else {
        let triple = above.file_name().expect("a target has a name");
        options.extend(["--target".into(), triple.into()]);
        above.parent().expect("a target is in a folder")
    };
    options.extend(["--target-dir".into(), target.into()]);
    options
}
