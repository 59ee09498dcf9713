//! Names of scenes outside the corpus.
//!
//! Rows, dumps, the cache and the report go by the name, so a run has each only once.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::{Entry, place};
use crate::error::InputError;

/// The short name of a scene: its folder for a scene.toml, the file's stem
/// otherwise.
pub fn stem(path: &Path) -> String {
    let named = match (path.file_name(), path.parent()) {
        (Some(file), Some(folder)) if file == "scene.toml" => folder.file_name().or(Some(file)),
        (file, _) => file,
    };
    let name = named.map_or_else(|| path.to_string_lossy(), |n| n.to_string_lossy());
    let stem = name.split('.').next().unwrap_or_default();
    if stem.is_empty() {
        name.into_owned()
    } else {
        stem.to_owned()
    }
}

/// What a scene may be called, shortest first: its stem, then ever longer tails of
/// its path, up to all of it.
fn names(path: &Path) -> Vec<String> {
    let path = place(path);
    // Every scene's file is called scene.toml; its folder tells more.
    let shortest = match path.ends_with("scene.toml") {
        true => 2,
        false => 1,
    };
    let tails = path.ancestors().skip(shortest).map(|above| {
        let tail = path.strip_prefix(above).expect("an ancestor leads to it");
        tail.to_string_lossy().into_owned()
    });
    let whole = path.to_string_lossy().into_owned();
    std::iter::once(stem(&path))
        .chain(tails)
        .chain([whole])
        .collect()
}

/// Gives each scene outside the corpus the shortest name that no scene of the corpus
/// has and no other scene could have: names do not depend on the order of scenes.
///
/// # Errors
/// Paths that are the same once what is not UTF-8 in them is replaced.
pub fn tell_apart(corpus: &[Entry], selected: &mut [Entry]) -> Result<(), InputError> {
    let inside: BTreeSet<&str> = corpus.iter().map(|e| e.name.as_str()).collect();
    let outside = selected.iter_mut().filter(|e| !corpus.contains(e));
    let mut outside: Vec<_> = outside.map(|e| (names(&e.path), e)).collect();
    let mut claims: BTreeMap<String, usize> = BTreeMap::new();
    for (names, _) in &outside {
        // A scene may have a name twice, as a file without an extension does.
        for name in names.iter().collect::<BTreeSet<_>>() {
            *claims.entry(name.clone()).or_default() += 1;
        }
    }
    for (names, entry) in &mut outside {
        let free = |name: &&String| claims[*name] == 1 && !inside.contains(name.as_str());
        let Some(name) = names.iter().find(free) else {
            let message = "two scenes cannot be told apart by their paths; replay one at a time";
            return Err(InputError::new(&entry.path, message));
        };
        entry.name.clone_from(name);
    }
    Ok(())
}

#[cfg(test)]
mod tests;
