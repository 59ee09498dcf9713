//! What crosses from Rust to WGSL is laid out alike on both sides: constants, structs,
//! workgroup sizes, bindings. Every program is linked and taken apart by naga, in the
//! baseline form and in the one with native 64-bit integers.

#[path = "layout/constants.rs"]
mod constants;
#[path = "layout/records.rs"]
mod records;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{
    AddressSpace, BinaryOperator, Expression, Function, Module, ScalarKind, ShaderStage,
    StorageAccess, TypeInner,
};
use triptych_gpu::frame::WORKGROUP;
use triptych_gpu::wgsl::{Linked, Program, Sources};

/// The files with entry points.
const ROOTS: [&str; 32] = [
    "abuffer",
    "alpha",
    "ceiling",
    "defocus",
    "density",
    "dispatch",
    "dual",
    "early",
    "fan_scan",
    "fans",
    "grid",
    "hbao",
    "layouts",
    "layouts_samples",
    "ldm",
    "linked",
    "local",
    "multisample",
    "nearest",
    "ordered",
    "ordered_samples",
    "packed",
    "packed_samples",
    "peel",
    "raster",
    "reduced",
    "regions",
    "regions_samples",
    "rsm",
    "tiles",
    "vertex",
    "weighted",
];

/// The files that have entry points of others, with other imports.
const VARIANTS: [&str; 7] = [
    "abuffer_samples",
    "early_samples",
    "grid_exact",
    "linked_samples",
    "local_samples",
    "raster_samples",
    "tiles_samples",
];

/// WebGPU's default for `maxStorageBuffersPerShaderStage`.
const STORAGE_BUFFERS: usize = 8;

/// WebGPU's default for `maxComputeWorkgroupStorageSize`, in bytes.
const WORKGROUP_STORAGE: u32 = 16_384;

/// A program and where it comes from.
struct Root {
    name: String,
    native: bool,
    program: Program,
}

fn programs() -> Vec<Root> {
    let link = |(root, native): (&str, bool)| {
        let name = format!("{root} ({})", if native { "native" } else { "baseline" });
        let program = Sources::shipped(native).link(root).and_then(Linked::parse);
        let program = program.unwrap_or_else(|e| panic!("{name}: {e}"));
        Root {
            name,
            native,
            program,
        }
    };
    let all = ROOTS
        .iter()
        .chain(&VARIANTS)
        .flat_map(|root| [(*root, false), (*root, true)]);
    all.map(link).collect()
}

/// Looks something up in every program, and demands that it is as expected wherever it
/// occurs, and that it occurs.
fn everywhere<T: PartialEq + std::fmt::Debug>(
    name: &str,
    expected: &T,
    find: impl Fn(&Module, &str) -> Option<T>,
) {
    let mut seen = 0;
    for root in programs() {
        if let Some(found) = find(&root.program.module, name) {
            assert_eq!(found, *expected, "{name} in {}, not as in Rust", root.name);
            seen += 1;
        }
    }
    assert!(seen > 0, "{name} is in no program");
}

#[test]
fn workgroups_have_the_size_that_the_host_counts_with() {
    for root in programs() {
        for entry in &root.program.module.entry_points {
            let size = match entry.stage {
                ShaderStage::Compute => [WORKGROUP, 1, 1],
                _ => [0; 3],
            };
            assert_eq!(
                entry.workgroup_size, size,
                "{} of {}",
                entry.name, root.name
            );
        }
    }
}

#[test]
fn bindings_of_an_entry_point_are_unique_and_few() {
    for root in programs() {
        let module = &root.program.module;
        for (number, entry) in module.entry_points.iter().enumerate() {
            let at = format!("{} of {}", entry.name, root.name);
            let info = root.program.info.get_entry_point(number);
            let used = module
                .global_variables
                .iter()
                .filter(|(v, _)| !info[*v].is_empty());
            let bound: Vec<_> = used
                .map(|(_, v)| v)
                .filter(|v| v.binding.is_some())
                .collect();
            let mut places: Vec<u32> = Vec::new();
            for variable in &bound {
                let place = variable.binding.expect("only those with one");
                assert_eq!(place.group, 0, "{at}: {:?}", variable.name);
                assert!(
                    !places.contains(&place.binding),
                    "{at}: binding {} twice",
                    place.binding
                );
                places.push(place.binding);
                let AddressSpace::Storage { access } = variable.space else {
                    continue;
                };
                // WebGPU has no writable storage in the vertex stage.
                let writes = access.contains(StorageAccess::STORE);
                assert!(
                    entry.stage != ShaderStage::Vertex || !writes,
                    "{at} may write {:?}",
                    variable.name
                );
            }
            let is_storage =
                |v: &&&naga::GlobalVariable| matches!(v.space, AddressSpace::Storage { .. });
            let storage = bound.iter().filter(is_storage).count();
            assert!(
                storage <= STORAGE_BUFFERS,
                "{at} binds {storage} storage buffers"
            );
        }
    }
}

/// Nobody else looks: a driver may give more than was asked for, and another less.
#[test]
fn workgroups_share_no_more_memory_than_every_adapter_has() {
    let mut most = 0;
    for root in programs() {
        let module = &root.program.module;
        let mut layouter = naga::proc::Layouter::default();
        layouter.update(module.to_ctx()).expect("it has sizes");
        for (number, entry) in module.entry_points.iter().enumerate() {
            let info = root.program.info.get_entry_point(number);
            let shared = module.global_variables.iter().filter(|(handle, variable)| {
                variable.space == AddressSpace::WorkGroup && !info[*handle].is_empty()
            });
            // Each is aligned for itself; 16 bytes are the largest alignment.
            let size =
                |(_, v): (_, &naga::GlobalVariable)| layouter[v.ty].size.next_multiple_of(16);
            let bytes: u32 = shared.map(size).sum();
            let at = format!("{} of {}", entry.name, root.name);
            assert!(bytes <= WORKGROUP_STORAGE, "{at} shares {bytes} bytes");
            most = most.max(bytes);
        }
    }
    assert!(most > 8192, "the most is {most} bytes: they were not found");
}

#[test]
fn baseline_programs_need_no_capability() {
    for root in programs() {
        let mut capabilities = match root.native {
            true => Capabilities::SHADER_INT64,
            false => Capabilities::empty(),
        };
        if root.name.starts_with("early") {
            capabilities |= Capabilities::EARLY_DEPTH_TEST;
        }
        let valid =
            Validator::new(ValidationFlags::all(), capabilities).validate(&root.program.module);
        assert!(valid.is_ok(), "{}: {:?}", root.name, valid.err());
        // The two forms differ, so that both are tested: 64-bit integers prove it.
        let wide = |t: &naga::Type| matches!(t.inner, TypeInner::Scalar(s) if s.width == 8);
        let has_wide = root.program.module.types.iter().any(|(_, t)| wide(t));
        let narrow = ["ceiling", "fan_scan", "hbao", "vertex"];
        let expects_wide = root.native && !narrow.iter().any(|n| root.name.starts_with(n));
        assert_eq!(has_wide, expects_wide, "64-bit integers in {}", root.name);
    }
}

/// Vertices are placed by what WGSL rounds correctly, products and conversions: a
/// quotient and most functions may be off even where they have an exact value.
#[test]
fn vertices_are_placed_without_inexact_operations() {
    let mut seen = 0;
    for root in programs() {
        let (module, info) = (&root.program.module, &root.program.info);
        let entries = module.entry_points.iter().enumerate();
        let entries = entries.filter(|(_, e)| e.stage == ShaderStage::Vertex);
        let entries = entries.map(|(n, e)| (&e.function, info.get_entry_point(n)));
        let shared = module.functions.iter().map(|(h, f)| (f, &info[h]));
        let shared = shared.filter(|(f, _)| {
            let names = ["power_of_half", "placed", "depth_of"];
            f.name.as_deref().is_some_and(|name| names.contains(&name))
        });
        for (function, info) in entries.chain(shared) {
            let inexact = |(at, expression): &(naga::Handle<Expression>, &Expression)| {
                let kind = info[*at].ty.inner_with(&module.types).scalar_kind();
                let quotient = matches!(
                    expression,
                    Expression::Binary {
                        op: BinaryOperator::Divide | BinaryOperator::Modulo,
                        ..
                    }
                );
                let math = matches!(expression, Expression::Math { .. });
                kind == Some(ScalarKind::Float) && (quotient || math)
            };
            let found = function.expressions.iter().find(inexact);
            let name = |f: &Function| f.name.clone().unwrap_or("the vertex stage".into());
            assert!(
                found.is_none(),
                "{} of {}: {found:?}",
                name(function),
                root.name
            );
            seen += 1;
        }
    }
    assert_eq!(
        seen, 196,
        "four functions in twenty-one programs of two forms each, and seven in two more"
    );
}

#[test]
fn no_file_with_entry_points_is_left_out() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("gpu");
    let files = std::fs::read_dir(folder.join("src")).expect("the folder of the kernels");
    let mut roots: Vec<String> = Vec::new();
    for path in files.map(|f| f.expect("a file").path()) {
        if path.extension().is_some_and(|e| e == "wgsl") {
            let text = std::fs::read_to_string(&path).expect("text");
            if text.contains("@compute") || text.contains("@fragment") {
                let stem = path.file_stem().expect("it has an extension");
                roots.push(stem.to_string_lossy().into_owned());
            }
        }
    }
    roots.sort();
    assert_eq!(roots, ROOTS, "files with entry points");
}
