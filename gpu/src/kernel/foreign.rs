//! A user's kernel in place of ours: the same entry points and bindings, checked
//! before anything runs.

use naga::{AddressSpace, Binding, EntryPoint, Module, ShaderStage, StorageAccess, TypeInner};

use super::layout::{Layout, type_name};
use super::stage::Stage;
use crate::frame::WORKGROUP;
use crate::wgsl::{Program, Sources, WgslError};

/// A stage's kernels from a file of the user's.
#[derive(Clone, Debug)]
pub struct Foreign {
    /// The stage that they implement.
    pub stage: &'static Stage,
    /// The file, for messages.
    pub file: String,
    pub(super) text: String,
    compute: bool,
    fragment: bool,
}

/// A resource variable of an entry point.
struct Resource<'p> {
    number: u32,
    name: &'p str,
    space: AddressSpace,
    ty: naga::Handle<naga::Type>,
    line: u32,
}

impl Foreign {
    /// Links, parses and validates a text, and holds it against what the stage is.
    ///
    /// # Errors
    /// All that differs, each at its line. One that is found before naga has parsed the
    /// text comes alone.
    pub fn new(stage: &'static Stage, file: &str, text: &str) -> Result<Self, Vec<WgslError>> {
        let mut foreign = Self {
            stage,
            file: file.to_owned(),
            text: text.to_owned(),
            compute: false,
            fragment: false,
        };
        let sources = foreign.add_to(Sources::shipped(false));
        let parsed = |root: &str| sources.link(root)?.parse();
        let ours = parsed(stage.file).map_err(|e| vec![e])?;
        let theirs = parsed(&foreign.key()).map_err(|e| vec![e])?;
        let has = |names: &[&str]| names.iter().filter(|n| entry(&theirs, n).is_some()).count();
        let counts = [stage.compute, stage.fragment].map(has);
        foreign.compute = counts[0] > 0;
        foreign.fragment = counts[1] > 0;
        let mut errors = Vec::new();
        if counts == [0, 0] {
            let all = [stage.compute, stage.fragment].concat().join(" or ");
            let words = format!("stage {} needs an entry point {all}", stage.name);
            errors.push(theirs.error(1, &words));
        }
        for (names, count) in [stage.compute, stage.fragment].into_iter().zip(counts) {
            for name in names.iter().filter(|_| count > 0) {
                errors.extend(check(&ours, &theirs, name));
            }
        }
        errors.sort_by_key(|e| e.line);
        errors.dedup();
        if errors.is_empty() {
            Ok(foreign)
        } else {
            Err(errors)
        }
    }

    /// Whether it has the stage's kernels for the hardware's rasteriser, or else for
    /// compute. A stage without a rasteriser has the same kernels for both.
    pub fn serves(&self, fragment: bool) -> bool {
        match fragment && !self.stage.fragment.is_empty() {
            true => self.fragment,
            false => self.compute,
        }
    }

    /// The entry points that it has.
    pub(super) fn entries(&self) -> impl Iterator<Item = &'static str> {
        let compute = self.stage.compute.iter().filter(|_| self.compute);
        let fragment = self.stage.fragment.iter().filter(|_| self.fragment);
        compute.chain(fragment).copied()
    }

    /// Its name among the sources.
    pub(super) fn key(&self) -> String {
        Sources::foreign_name(&self.file)
    }

    pub(super) fn add_to(&self, sources: Sources) -> Sources {
        sources.with(self.key(), self.text.clone())
    }
}

fn entry<'p>(program: &'p Program, name: &str) -> Option<(usize, &'p EntryPoint)> {
    let mut all = program.module.entry_points.iter().enumerate();
    all.find(|(_, entry)| entry.name == name)
}

/// What of one entry point differs from ours.
fn check(ours: &Program, theirs: &Program, name: &str) -> Vec<WgslError> {
    let (_, must) = entry(ours, name).expect("the stage's own entry point");
    let Some((_, seen)) = entry(theirs, name) else {
        return vec![theirs.error(1, &format!("entry point {name} is missing"))];
    };
    let line = theirs.line_of(&format!("fn {name}"));
    let mut errors = Vec::new();
    let mut differs = |message: String| errors.push(theirs.error(line, &message));
    if seen.stage != must.stage {
        differs(format!("{name} is {:?}, not {:?}", seen.stage, must.stage));
        return errors;
    }
    if seen.stage == ShaderStage::Compute && seen.workgroup_size != must.workgroup_size {
        let size = seen.workgroup_size;
        differs(format!(
            "{name} has workgroups of {size:?}, not [{WORKGROUP}, 1, 1]"
        ));
    }
    let colours = [(ours, must), (theirs, seen)].map(|(program, entry)| returned(program, entry));
    if seen.stage == ShaderStage::Fragment && colours[0] != colours[1] {
        differs(match colours[0].len() {
            0 => format!("{name} returns a value; a pass that builds lists writes no colour"),
            n => format!("{name} returns no {n} colours, at locations 0 to {}", n - 1),
        });
    }
    for location in locations(theirs, seen).into_iter().filter(|l| *l != 0) {
        differs(format!(
            "{name} reads location {location}; there is only 0, the triangle"
        ));
    }
    let known = resources(ours, name);
    for resource in resources(theirs, name) {
        let message = match known.iter().find(|k| k.number == resource.number) {
            Some(known) => unlike(&ours.module, known, &theirs.module, &resource),
            None => {
                let words = known.iter().map(|k| describe(&ours.module, k));
                let all = words.collect::<Vec<_>>().join(", ");
                let number = resource.number;
                Some(format!("binding {number} is none of {name}'s: {all}"))
            }
        };
        errors.extend(message.map(|message| theirs.error(resource.line, &message)));
    }
    errors
}

/// The resource variables of an entry point, in order of binding.
fn resources<'p>(program: &'p Program, name: &str) -> Vec<Resource<'p>> {
    let Some((index, _)) = entry(program, name) else {
        return Vec::new();
    };
    let used = program.info.get_entry_point(index);
    let variables = &program.module.global_variables;
    let resource = |(handle, v): (naga::Handle<naga::GlobalVariable>, &'p naga::GlobalVariable)| {
        let at = v.binding.as_ref().filter(|_| !used[handle].is_empty())?;
        Some(Resource {
            // Another group than 0 is no binding of any stage.
            number: at.binding + (at.group << 16),
            name: v.name.as_deref().unwrap_or_default(),
            space: v.space,
            ty: v.ty,
            line: program.line_at(variables.get_span(handle)),
        })
    };
    let mut all: Vec<_> = variables.iter().filter_map(resource).collect();
    all.sort_by_key(|r| r.number);
    all
}

/// Why a variable cannot stand for one of ours with the same number.
fn unlike(
    our_module: &Module,
    ours: &Resource<'_>,
    their_module: &Module,
    theirs: &Resource<'_>,
) -> Option<String> {
    let (must, seen) = (describe(our_module, ours), describe(their_module, theirs));
    let message = |why: &str| Some(format!("{seen} {why}; the stage has {must}"));
    match (ours.space, theirs.space) {
        (AddressSpace::Uniform, AddressSpace::Uniform) => {}
        (AddressSpace::Storage { access: a }, AddressSpace::Storage { access: b }) => {
            if b.contains(StorageAccess::STORE) && !a.contains(StorageAccess::STORE) {
                return message("is written");
            }
        }
        _ => return message("is in another address space"),
    }
    let layout = Layout::of(their_module, theirs.ty);
    match layout.stands_for(&Layout::of(our_module, ours.ty)) {
        true => None,
        false => message("lies otherwise in memory"),
    }
}

fn describe(module: &Module, resource: &Resource<'_>) -> String {
    let Resource {
        number,
        name,
        space,
        ty,
        ..
    } = resource;
    let space = match space {
        AddressSpace::Storage { access } if access.contains(StorageAccess::STORE) => {
            "storage, read_write"
        }
        AddressSpace::Storage { .. } => "storage, read",
        _ => "uniform",
    };
    format!(
        "@binding({number}) var<{space}> {name}: {}",
        type_name(module, *ty)
    )
}

/// Locations that an entry point reads.
fn locations(program: &Program, entry: &EntryPoint) -> Vec<u32> {
    let mut found = Vec::new();
    let mut add = |binding: &Option<Binding>| {
        if let Some(Binding::Location { location, .. }) = binding {
            found.push(*location);
        }
    };
    for argument in &entry.function.arguments {
        add(&argument.binding);
        if let TypeInner::Struct { members, .. } = &program.module.types[argument.ty].inner {
            members.iter().for_each(|member| add(&member.binding));
        }
    }
    found
}

/// Locations of the colours that an entry point returns; a value without one has the last.
fn returned(program: &Program, entry: &EntryPoint) -> Vec<u32> {
    let Some(result) = &entry.function.result else {
        return Vec::new();
    };
    let place = |binding: &Option<Binding>| match binding {
        Some(Binding::Location { location, .. }) => *location,
        _ => u32::MAX,
    };
    match &program.module.types[result.ty].inner {
        TypeInner::Struct { members, .. } => members.iter().map(|m| place(&m.binding)).collect(),
        _ => vec![place(&result.binding)],
    }
}

#[cfg(test)]
mod tests;
