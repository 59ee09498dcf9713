//! A stage's bindings and empty entry points as WGSL, for whoever writes a kernel.

use std::collections::BTreeSet;
use std::fmt::Write;

use naga::{AddressSpace, BuiltIn, Handle, Module, StorageAccess, Type, TypeInner};

use super::layout::type_name;
use super::stage::Stage;
use crate::frame::WORKGROUP;
use crate::wgsl::{Program, Sources, WgslError};

/// Columns of a comment.
const WIDTH: usize = 90;

/// WGSL that passes as a kernel of the stage: what it is to do, its types and
/// bindings, and entry points that do nothing yet.
///
/// # Errors
/// None for the files that ship.
pub fn skeleton(stage: &Stage) -> Result<String, WgslError> {
    let program = Sources::shipped(false).link(stage.file)?.parse()?;
    let mut text = format!("// Stage {}, a kernel of your own.\n//\n", stage.name);
    comment(&mut text, &stage.invocation());
    text.push_str("//\n");
    comment(
        &mut text,
        "Variables and types may have other names; numbers, address spaces and the words in \
         memory must be these, and what is not needed may be left out. Lines such as \
         `//#import walk` insert files of gpu/src, with the bindings that they declare.",
    );
    let variables = used(&program, stage);
    let mut seen = BTreeSet::new();
    for variable in &variables {
        structs(&mut text, &program.module, variable.ty, &mut seen);
    }
    text.push('\n');
    for variable in &variables {
        declare(&mut text, &program.module, variable);
    }
    let attributes = format!("@compute @workgroup_size({WORKGROUP})");
    for entry in stage.compute {
        let (arguments, guard) = invocation(&program.module, stage, entry);
        function(&mut text, &attributes, entry, &arguments, &guard);
    }
    for entry in stage.fragment {
        let arguments = "@builtin(position) position: vec4<f32>, \
                         @location(0) @interpolate(flat) prim: u32";
        blended(&mut text, &program.module, entry, arguments);
    }
    Ok(text)
}

/// A fragment kernel, with as many colours as ours returns.
fn blended(text: &mut String, module: &Module, entry: &str, arguments: &str) {
    let ours = module.entry_points.iter().find(|e| e.name == entry);
    let colours = match ours.and_then(|e| e.function.result.as_ref()) {
        None => return function(text, "@fragment", entry, arguments, ""),
        Some(result) => match &module.types[result.ty].inner {
            TypeInner::Struct { members, .. } => members.len(),
            _ => 1,
        },
    };
    text.push_str("\n// What the hardware blends.\nstruct Blended {\n");
    for at in 0..colours {
        let _ = writeln!(text, "    @location({at}) colour_{at}: vec4<f32>,");
    }
    let none = vec!["vec4(0.0)"; colours].join(", ");
    let _ = write!(
        text,
        "}}\n\n@fragment\nfn {entry}({arguments}) -> Blended {{\n    return Blended({none});\n}}\n"
    );
}

/// What a compute entry point of ours is given, and how it leaves out what is too many. Where
/// invocations of a workgroup meet at a barrier, none may leave before.
fn invocation(module: &Module, stage: &Stage, entry: &str) -> (String, String) {
    let inputs = inputs(module, entry);
    let given: Vec<String> = inputs.iter().map(|input| argument(*input)).collect();
    // Of the rivals, what goes through the triangles has walks over them.
    let walks = [
        "peel_nearest",
        "peel_first",
        "dual_nearest",
        "dual_first",
        "alpha_next",
        "weighted",
    ];
    let of_pixels =
        matches!(stage.file, "peel" | "dual" | "alpha" | "weighted") && !walks.contains(&entry);
    let items = match (stage.file, stage.name) {
        ("layouts" | "packed" | "regions" | "ordered", _) => of_layouts(entry),
        // The first invocation alone.
        ("dispatch", "intersect") => "1u",
        ("dispatch", _) => "task.items",
        ("grid", _) => "cells.items",
        ("rsm", _) => "parameters.items",
        ("tiles", _) => "tiled.items",
        ("ldm", "neighbours") => "told.maps * told.items",
        ("ldm", _) => "told.items",
        (_, "sort" | "resolve" | "density" | "defocus" | "reduced") => "frame.width * frame.rows",
        _ if of_pixels => "frame.width * frame.rows",
        _ => "frame.items",
    };
    let has = |input| inputs.contains(&input);
    let body = match (
        has(BuiltIn::GlobalInvocationId),
        has(BuiltIn::NumWorkGroups),
    ) {
        _ if has(BuiltIn::LocalInvocationIndex) => format!(
            "    // Of {items}; a workgroup may share its work, and none of it may leave before a \
             barrier.\n"
        ),
        (true, true) => format!(
            "    let i = id.x + id.y * groups.x * {WORKGROUP}u;\n    if i >= {items} {{\n        \
             return;\n    }}\n"
        ),
        _ => format!("    if id.x >= {items} {{\n        return;\n    }}\n"),
    };
    (given.join(", "), body)
}

/// How many items a kernel of a layout has.
fn of_layouts(entry: &str) -> &'static str {
    match entry {
        "rank_runs" | "rank_merge" | "ordered_clear" => "listing.items",
        "bucket" | "precalc_count" | "precalc_fill" | "packed" | "regions" | "ordered"
        | "ordered_ties" => "frame.items",
        _ => "frame.width * frame.rows",
    }
}

/// What our own entry point is told of the invocation.
fn inputs(module: &Module, entry: &str) -> Vec<BuiltIn> {
    let ours = module.entry_points.iter().find(|e| e.name == entry);
    let arguments = ours.map_or(&[][..], |e| &e.function.arguments);
    let builtin = |argument: &naga::FunctionArgument| match argument.binding {
        Some(naga::Binding::BuiltIn(builtin)) => Some(builtin),
        _ => None,
    };
    arguments.iter().filter_map(builtin).collect()
}

fn argument(input: BuiltIn) -> String {
    let (name, variable, ty) = match input {
        BuiltIn::GlobalInvocationId => ("global_invocation_id", "id", "vec3<u32>"),
        BuiltIn::LocalInvocationIndex => ("local_invocation_index", "lane", "u32"),
        BuiltIn::NumWorkGroups => ("num_workgroups", "groups", "vec3<u32>"),
        // No kernel of ours asks for another one: a test makes every skeleton.
        _ => ("workgroup_id", "group", "vec3<u32>"),
    };
    format!("@builtin({name}) {variable}: {ty}")
}

/// Variables of all the stage's entry points, in order of binding.
fn used<'p>(program: &'p Program, stage: &Stage) -> Vec<&'p naga::GlobalVariable> {
    let entries = stage.compute.iter().chain(stage.fragment);
    let numbers: BTreeSet<u32> = entries
        .filter_map(|entry| program.bindings(entry))
        .flatten()
        .map(|b| b.1)
        .collect();
    let variables = program.module.global_variables.iter().map(|(_, v)| v);
    let number = |v: &naga::GlobalVariable| v.binding.as_ref().map(|b| b.binding);
    let mut all: Vec<_> = variables
        .filter(|v| number(v).is_some_and(|n| numbers.contains(&n)))
        .collect();
    all.sort_by_key(|v| number(v));
    all
}

fn declare(text: &mut String, module: &Module, variable: &naga::GlobalVariable) {
    let space = match variable.space {
        AddressSpace::Storage { access } if access.contains(StorageAccess::STORE) => {
            "storage, read_write"
        }
        AddressSpace::Storage { .. } => "storage, read",
        _ => "uniform",
    };
    let number = variable.binding.as_ref().map_or(0, |b| b.binding);
    let name = variable.name.as_deref().unwrap_or("unnamed");
    let ty = type_name(module, variable.ty);
    let _ = writeln!(
        text,
        "@group(0) @binding({number}) var<{space}> {name}: {ty};"
    );
}

/// The structs that a type is made of, inner ones first.
fn structs(
    text: &mut String,
    module: &Module,
    ty: Handle<Type>,
    seen: &mut BTreeSet<Handle<Type>>,
) {
    if !seen.insert(ty) {
        return;
    }
    match &module.types[ty].inner {
        TypeInner::Array { base, .. } => structs(text, module, *base, seen),
        TypeInner::Struct { members, .. } => {
            for member in members {
                structs(text, module, member.ty, seen);
            }
            let _ = writeln!(text, "\nstruct {} {{", type_name(module, ty));
            for member in members {
                let name = member.name.as_deref().unwrap_or("unnamed");
                let _ = writeln!(text, "    {name}: {},", type_name(module, member.ty));
            }
            text.push_str("}\n");
        }
        _ => {}
    }
}

fn function(text: &mut String, attributes: &str, name: &str, arguments: &str, body: &str) {
    let _ = write!(
        text,
        "\n{attributes}\nfn {name}({arguments}) {{\n{body}}}\n"
    );
}

/// Words as a comment of several lines.
fn comment(text: &mut String, words: &str) {
    let mut line = String::from("//");
    for word in words.split_whitespace() {
        if line.len() + 1 + word.len() > WIDTH {
            text.push_str(&line);
            text.push('\n');
            line = String::from("//");
        }
        line.push(' ');
        line.push_str(word);
    }
    text.push_str(&line);
    text.push('\n');
}
