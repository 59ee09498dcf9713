//! What faces are made of: materials of the scene, of mesh libraries, or the default.

use std::collections::{BTreeMap, BTreeSet};

use toml::Spanned;

use super::Parsed;
use super::file::{MaterialEntry, MeshEntry};
use super::source::Source;
use crate::error::InputError;
use crate::mesh::Named;
use crate::text::plural;

/// What a face is made of if neither scene nor mesh says so: it lets light
/// through, so that a bare mesh shows its layers.
const DEFAULT: Surface = Surface {
    reflectance: [0.8; 3],
    opacity: 0.5,
    mirror: [0.0; 3],
    stated: false,
};

/// What a face is made of.
#[derive(Clone, Copy)]
pub(super) struct Surface {
    /// The part of the light that it gives back.
    pub(super) reflectance: [f64; 3],
    /// 1 is opaque.
    pub(super) opacity: f64,
    /// The part of the light from its mirror direction that it gives back.
    pub(super) mirror: [f64; 3],
    /// Whether somebody asked for it.
    pub(super) stated: bool,
}

/// The scene's materials by name.
pub(super) type Materials<'a> = BTreeMap<&'a str, Surface>;

/// The scene's materials by name. Refuses two of one name.
pub(super) fn materials<'a>(parsed: &'a Parsed) -> Result<Materials<'a>, InputError> {
    let mut materials = Materials::new();
    for MaterialEntry {
        name,
        colour,
        opacity,
        mirror,
    } in &parsed.file.material
    {
        let surface = Surface {
            reflectance: colour.0,
            opacity: opacity.0,
            mirror: mirror.unwrap_or_default().0,
            stated: true,
        };
        if materials.insert(name.get_ref(), surface).is_some() {
            let message = format!("material `{}` is defined twice", name.get_ref());
            return Err(parsed.error(name.span(), message));
        }
    }
    Ok(materials)
}

/// The surface of every material of a mesh: named in `materials`, else
/// `material`, else what the mesh's library defines, else [`DEFAULT`].
pub(super) fn surfaces(
    parsed: &Parsed,
    materials: &Materials,
    entry: &MeshEntry,
    source: &Source,
) -> Result<Vec<Surface>, InputError> {
    let named = &source.mesh.materials;
    let names: BTreeSet<&str> = named[1..].iter().map(|n| n.name.as_str()).collect();
    for key in entry.materials.keys() {
        if !names.contains(key.get_ref().as_str()) {
            let known = listed(names.iter().copied());
            let message = format!(
                "the mesh has no material `{}`; it has: {known}",
                key.get_ref()
            );
            return Err(parsed.error(key.span(), message));
        }
    }
    let resolve = |n: &Named| {
        let single = entry.materials.get(n.name.as_str());
        match (single.or(entry.material.as_ref()), n.defined) {
            (Some(material), _) => find_material(parsed, materials, material),
            (None, Some((reflectance, opacity))) => Ok(Surface {
                reflectance,
                opacity,
                mirror: [0.0; 3],
                stated: true,
            }),
            (None, None) => Ok(DEFAULT),
        }
    };
    named.iter().map(resolve).collect()
}

fn find_material(
    parsed: &Parsed,
    materials: &Materials,
    name: &Spanned<String>,
) -> Result<Surface, InputError> {
    materials
        .get(name.get_ref().as_str())
        .copied()
        .ok_or_else(|| {
            let known = listed(materials.keys().copied());
            let message = format!(
                "no [[material]] is named `{}`; there are: {known}",
                name.get_ref()
            );
            parsed.error(name.span(), message)
        })
}

/// Names as an error shows them: not all of a thousand.
fn listed<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    const SHOWN: usize = 12;
    let more = names.len().saturating_sub(SHOWN);
    let mut shown = names.take(SHOWN).collect::<Vec<_>>().join(", ");
    if more > 0 {
        shown += &format!(" and {more} more");
    }
    shown
}

/// A remark about triangles that are to let light through, and do not in a scene with `[rsm]`,
/// `[ldm]` or `[dispatch]`.
pub(super) fn made_opaque(surfaces: &[Surface], source: &Source, section: &str) -> Option<String> {
    let clear = |row: &&u32| {
        let surface = surfaces[**row as usize];
        surface.stated && surface.opacity < 1.0
    };
    let count = source.mesh.material.iter().filter(clear).count();
    (count > 0).then(|| {
        let of = plural(count as u64, "triangle");
        format!(
            "{of} with an opacity below 1 taken as opaque: {section} has no transparent surfaces"
        )
    })
}
