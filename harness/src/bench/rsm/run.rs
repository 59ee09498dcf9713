//! All scenes and settings.

use std::path::PathBuf;

use triptych_spec::rsm::{Frame, Parameters, RsmError};

use super::super::legs::stations;
use super::super::{Machine, Progress, Spread, named};
use super::case::{Case, error};
use super::{Frames, PAPER, Row, SCENES, gpu};
use crate::corpus::Entry;
use crate::mesh::Intake;
use crate::replay::gpu::Adapter;
use crate::replay::rsm::values;
use crate::replay::spec::timed;
use crate::scene::{LoadError, Loaded, load_entry, load_text};

/// Pairs of a pixel and a texel, of both buffers, up to which the spec draws a picture of its
/// own, half a minute on one core. Beyond them software drivers run the scene's own setting
/// only, and once.
const PAIRS_OF_SPEC: u64 = 1 << 24;

/// What is measured, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scenes; `None`: [`PAPER`] and [`SCENES`].
    pub scenes: Option<Vec<Entry>>,
    /// Rounds that count, at least one.
    pub runs: u32,
    /// Today, year-month-day.
    pub date: String,
}

/// Measures frames on these adapters, and by the spec.
///
/// # Errors
/// One line for a scene that cannot be read; a mesh that is missing skips its scene, as does
/// one of our own choice that the corpus lacks.
pub fn run(
    corpus: &[Entry],
    adapters: &[Adapter],
    options: &Options,
    progress: &Progress,
) -> Result<Frames, String> {
    let mut frames = Frames {
        date: options.date.clone(),
        machine: Machine::here(adapters),
        runs: options.runs,
        rows: Vec::new(),
        remarks: Vec::new(),
    };
    let stations = stations(adapters, &mut frames.remarks);
    let all = frames.load(corpus, options)?;
    for loaded in &all {
        let case = match Case::new(loaded) {
            Ok(case) => case,
            Err(why) => {
                frames.not(&format!("{}: {why}", loaded.name));
                continue;
            }
        };
        let settings = case.settings();
        let steps = settings.len() * (1 + stations.len());
        progress.begin(&case.name, u32::try_from(steps).unwrap_or(u32::MAX));
        for (number, parameters) in settings.into_iter().enumerate() {
            let large = pairs(&case, parameters) > PAIRS_OF_SPEC;
            if !large {
                match of_spec(&case, parameters) {
                    Ok(row) => frames.rows.push(row),
                    Err(why) => frames.not(&format!("{}: spec: {why}", case.name)),
                }
            }
            progress.step();
            for station in &stations {
                let software = station.adapter.gpu.info.device_type == wgpu::DeviceType::Cpu;
                let runs = match (large && software, number) {
                    (false, _) => options.runs,
                    (true, 0) => 1,
                    (true, _) => 0,
                };
                if runs == 0 {
                    progress.step();
                    continue;
                }
                match gpu::measure(station, &case, parameters, runs) {
                    Ok(row) => frames.rows.push(row),
                    Err(why) => {
                        let (scene, adapter) = (&case.name, &station.adapter.gpu.name);
                        frames.not(&format!("{scene}: gpu@{adapter}: {why}"));
                    }
                }
                progress.step();
            }
        }
    }
    progress.end();
    Ok(frames)
}

impl Frames {
    /// The scenes that can be read.
    fn load(&mut self, corpus: &[Entry], options: &Options) -> Result<Vec<Loaded>, String> {
        let mut all = Vec::new();
        let entries = match &options.scenes {
            Some(scenes) => scenes.clone(),
            None => {
                all.push(paper()?);
                named(corpus, &SCENES, &mut self.remarks)
            }
        };
        for entry in &entries {
            match load_entry(entry, None) {
                Ok(loaded) => all.push(loaded),
                Err(missing @ LoadError::Missing { .. }) => {
                    self.not(&format!("{}: {missing}", entry.name));
                }
                Err(error) => return Err(error.to_string()),
            }
        }
        Ok(all)
    }

    fn not(&mut self, why: &str) {
        self.remarks.push(format!("not measured: {why}"));
    }
}

/// The scene of the paper's size.
fn paper() -> Result<Loaded, String> {
    let path = PathBuf::from("harness/src/bench/rsm/paper.toml");
    let entry = Entry {
        name: "paper".to_owned(),
        ..Entry::outside(&path)
    };
    let loaded = load_text(&mut Intake::from_disk(), &entry, None, PAPER);
    loaded.map_err(|error| error.to_string())
}

/// Pairs of a pixel of either buffer and a texel.
fn pairs(case: &Case, parameters: Parameters) -> u64 {
    let eye = case.base.seen.size;
    let pixels = (eye.pixels() + parameters.coarse(eye).pixels()) as u64;
    pixels * u64::from(parameters.side()).pow(2)
}

/// The spec's picture, drawn once.
fn of_spec(case: &Case, parameters: Parameters) -> Result<Row, RsmError> {
    let (frame, time) = timed(|| Frame::render(&case.setting(parameters)));
    let frame = frame?;
    let error = error(&case.reference, &values(&frame.picture));
    Ok(Row {
        rays: frame.blocked.rays,
        frame: Spread::of([1000.0 * time.as_secs_f64()]),
        ..row(case, parameters, error)
    })
}

/// A row of the spec without times.
pub(super) fn row(case: &Case, parameters: Parameters, [rmse, largest]: [f64; 2]) -> Row {
    Row {
        scene: case.name.clone(),
        leg: "spec".to_owned(),
        clock: "host",
        kernel: parameters.side(),
        stride: parameters.stride,
        divisor: parameters.divisor,
        blur: parameters.blur,
        pixels: case.base.seen.size.pixels() as u64,
        blockers: case.parts.blockers.triangles.len() as u64,
        rays: 0,
        frame: Spread::of([]),
        parts: Vec::new(),
        rmse,
        largest,
        own: None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::case::Case;
    use super::paper;

    #[test]
    fn the_papers_scene_is_of_its_size() {
        let loaded = paper().unwrap_or_else(|error| panic!("{error}"));
        let size = loaded.scene.size;
        assert_eq!([size.width, size.height], [1024, 768]);
        let small = crate::scene::Loaded {
            scene: triptych_spec::scene::Scene {
                samples: triptych_spec::raster::Samples::ONE,
                order: triptych_spec::abuffer::Order::Centroid,
                size: triptych_spec::scene::Size {
                    width: 32,
                    height: 24,
                },
                ..loaded.scene.clone()
            },
            ..loaded
        };
        let case = Case::new(&small).unwrap_or_else(|error| panic!("{error}"));
        let lit = case.base.direct.lit.iter().filter(|lit| **lit).count();
        let indirect = case.base.all.iter().filter(|c| c[0].value > 0.0).count();
        assert!(
            lit > 32 && indirect > 256,
            "{lit} lit, {indirect} indirectly"
        );
    }
}
