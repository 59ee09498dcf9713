//! What has no effect on scenes of a family of its own.

use std::ops::Range;

use super::Parsed;
use super::file::{Abuffer, SampleCount, SceneFile};
use crate::error::InputError;

/// Refuses keys that nothing of a scene with this section depends on.
///
/// # Errors
/// The first of them that is stated, at `span`, where the section is, or at its own line.
pub(super) fn check(parsed: &Parsed, section: &str, span: Range<usize>) -> Result<(), InputError> {
    if let Some(key) = other(&parsed.file, section) {
        let message =
            format!("{key} has no effect on a scene with {section}; leave one of them out");
        return Err(parsed.error(span, message));
    }
    match parsed.keys.states("budget.vertex") {
        false => Ok(()),
        true => Err(parsed.mistake(
            "budget.vertex",
            format!("has no effect on a scene with {section}; leave it out"),
        )),
    }
}

fn other(file: &SceneFile, section: &str) -> Option<&'static str> {
    let keys = [
        ("[rsm]", file.rsm.is_some()),
        ("[ldm]", file.ldm.is_some()),
        ("[dispatch]", file.dispatch.is_some()),
        ("[grid]", file.grid.is_some()),
        ("[[light]]", file.light != SceneFile::default_lights()),
        ("samples", file.samples != SampleCount::default()),
        ("[abuffer]", file.abuffer != Abuffer::default()),
        ("[expect]", file.expect.stated() > 0),
    ];
    let stated = |(key, stated): &(&str, bool)| *stated && *key != section;
    keys.into_iter().find(stated).map(|(key, _)| key)
}
