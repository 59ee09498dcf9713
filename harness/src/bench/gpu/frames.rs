//! The frames of a leg that were measured, from the times of their parts.

use triptych_gpu::abuffer::{NODE, Part};

use super::Leg;
use crate::bench::Method;
use crate::bench::counts::Work;
use crate::bench::error::Error;
use crate::bench::scene::Measured;

impl Leg<'_> {
    /// How many bands the lists are made in.
    fn bands(&self) -> u32 {
        u32::try_from(self.timed.bands()).unwrap_or(u32::MAX)
    }

    /// The frames that were measured.
    pub(in crate::bench) fn measured(&self) -> Vec<Measured> {
        let frame = |(part, error): &(Part, Error)| {
            let (method, layers) = self.variant(*part);
            let sorts = method == Method::Sort;
            self.frame(method, (layers, *error), |other| {
                is_before(other) || (other == Part::Sort && sorts) || other == *part
            })
        };
        let mut frames: Vec<Measured> = self.errors.iter().map(frame).collect();
        if self.grid.layers.contains(&0) {
            let error = self.grid.error_of_spec(0);
            frames.push(self.frame(Method::Insertion, (0, error), is_before));
        }
        for tiles in &self.tiles {
            frames.extend(tiles.measured(&self.surfaces()));
        }
        let surfaces = self.surfaces();
        frames.extend(self.beside.iter().map(|b| b.measured(&surfaces)));
        frames
    }

    /// The frame of some parts.
    fn frame(
        &self,
        method: Method,
        (layers, error): (u32, Error),
        belongs: impl Fn(Part) -> bool,
    ) -> Measured {
        let own = self.parts.iter().enumerate().filter(|(_, p)| belongs(**p));
        let seconds = |at: usize| self.rounds.iter().map(|r| r[at]).collect();
        let counts = &self.grid.counts;
        let works = own.clone().map(|(_, part)| counts.work(*part));
        Measured {
            method,
            layers,
            parts: own.map(|(at, p)| (name(*p), seconds(at))).collect(),
            error,
            memory: counts.triangles() + self.timed.bytes(method == Method::Sort),
            of_fragment: Some(NODE),
            bands: self.bands(),
            work: works.fold(Work::default(), Work::and),
        }
    }

    /// The surfaces alone, where there are any: what other techniques are in front of.
    fn surfaces(&self) -> Measured {
        let has = self.parts.contains(&Part::Opaque);
        let error = self.grid.error_of_spec(0);
        let mut surfaces = self.frame(Method::Sort, (0, error), |part| {
            has && matches!(part, Part::Clear | Part::Opaque)
        });
        surfaces.memory = 8 * self.grid.primitives.size.pixels() as u64;
        surfaces
    }
}

/// Whether a part comes before whatever is made of the lists.
fn is_before(part: Part) -> bool {
    matches!(part, Part::Clear | Part::Opaque | Part::Build)
}

/// A part's name in results.
fn name(part: Part) -> &'static str {
    match part {
        Part::Clear => "clear",
        Part::Opaque => "opaque",
        Part::Build => "build",
        Part::Sort => "sort",
        Part::Nearest(_) | Part::NearestSorted(_) | Part::Resolve => "blend",
    }
}
