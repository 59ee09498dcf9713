//! Whether pictures are the spec's to the bit, however often they are made, by whatever queue, with
//! however many threads.

use super::Method;
use super::scene::Scene;
use crate::bench::Progress;
use crate::corpus::Entry;
use crate::dispatch::crew::{Crew, Ending};
use crate::replay::dispatch::DispatchRun;
use crate::scene::load_entry;

/// Numbers of threads: one, as many as there are cores on small machines, an odd one, and more than there are
/// cores on most.
pub const THREADS: [usize; 5] = [1, 2, 3, 8, 32];

/// Every queue whose sums are exact.
pub const METHODS: [Method; 6] = [
    Method::Lock,
    Method::Lfree,
    Method::Local,
    Method::Segments,
    Method::Stealing,
    Method::Rayon,
];

/// What was found of a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// Pictures that were made.
    pub pictures: u64,
    /// Those that are not the spec's, in words.
    pub wrong: Vec<String>,
}

/// Makes so many pictures of a scene with each queue, each number of threads, and both endings; `rayon`
/// has an ending of its own.
///
/// # Errors
/// One line for a scene that cannot be traced.
pub fn identical(entry: &Entry, runs: u32, progress: &Progress) -> Result<Found, String> {
    let loaded = load_entry(entry, None).map_err(|e| e.to_string())?;
    let run = DispatchRun::new(&loaded).map_err(|e| e.to_string())?;
    let scene = Scene::new(&loaded.name, run)?;
    let trials: Vec<(Method, Crew)> = trials().collect();
    let steps = u32::try_from(trials.len()).expect("few");
    progress.begin(&format!("{}: {runs} pictures of each", loaded.name), steps);
    let mut found = Found::default();
    for (method, crew) in trials {
        for number in 1..=runs {
            found.pictures += 1;
            if let Err(why) = scene.render(method, crew, 1) {
                let Crew {
                    threads, ending, ..
                } = crew;
                found.wrong.push(format!(
                    "{}, {}, {threads} threads, {}, picture {number}: {why}",
                    loaded.name,
                    method.name(),
                    ending.name()
                ));
            }
        }
        progress.step();
    }
    progress.end();
    Ok(found)
}

fn trials() -> impl Iterator<Item = (Method, Crew)> {
    METHODS.into_iter().flat_map(|method| {
        let endings = match method {
            Method::Rayon => &Ending::ALL[..1],
            _ => &Ending::ALL[..],
        };
        THREADS.into_iter().flat_map(move |threads| {
            endings.iter().map(move |ending| {
                let crew = Crew {
                    threads,
                    ending: *ending,
                    watched: false,
                };
                (method, crew)
            })
        })
    })
}
