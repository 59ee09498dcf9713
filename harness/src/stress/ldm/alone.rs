//! Every face by itself: a plane is in nobody's way.
//!
//! For each triangle that somebody asks from, maps of it alone are made, with the borders and
//! keys of the scene's: a cropped map is a part of the whole one. A point's own surface must then
//! be within its own band in every map, whatever the tilt, wherever the scene is and however large:
//! nothing is before it, and nothing behind. The exception is stated
//! ([`triptych_spec::ldm::own_band`]): what is steeper than [`STEEPEST`] is taken for this steep, so
//! its surface may be met. How often that happens, and what it weighs, is told.

use std::collections::BTreeMap;

use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::Point;
use triptych_spec::ldm::{Map, Maps, Receiver, layers, neighbours, weight};

use super::super::shot::Vertex;
use crate::replay::ldm::{Asker, LdmRun, bounds};
use crate::vector::{dot, length, scale};

/// Keys a key up to which a slope is told apart: as the spec states it.
pub const STEEPEST: f64 = 127.0;

/// What came of faces by themselves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Alone {
    /// Pairs of an asker and a map.
    pub pairs: u64,
    /// Of these, such in which the face is steeper than is told apart.
    pub steep: u64,
    /// Of those, such that meet their own face.
    pub met: u64,
    /// The most that one asker loses to that, of what is open.
    pub lost: f64,
    /// The largest slope that is told apart.
    pub steepest: f64,
    /// Pairs that meet their own face, and must not.
    pub wrong: u64,
    /// The first of these, in words.
    pub first: Option<String>,
}

impl Alone {
    /// Of all faces that somebody asks from.
    ///
    /// # Errors
    /// What the spec says of its limits.
    pub(super) fn of(run: &LdmRun) -> Result<Self, String> {
        let mut faces: BTreeMap<u32, Vec<Receiver>> = BTreeMap::new();
        for asker in &run.setup.receivers {
            faces
                .entry(asker.triangle)
                .or_default()
                .push(asker.receiver);
        }
        let mut all = Self::default();
        for (triangle, receivers) in faces {
            if run.setup.model.face(triangle).normal != [0; 3] {
                all.face(run, triangle, &receivers)?;
            }
        }
        Ok(all)
    }

    fn face(&mut self, run: &LdmRun, triangle: u32, receivers: &[Receiver]) -> Result<(), String> {
        let blockers = &run.setup.blockers;
        let corners = blockers.triangles.iter().flatten();
        let scene = bounds(corners.map(|row| blockers.vertices[*row as usize]));
        let asking = bounds(receivers.iter().map(|r| r.point));
        let (Some(scene), Some(asking)) = (scene, asking) else {
            return Ok(());
        };
        let of_turns = run.turns.iter().flat_map(|turn| &turn.maps.maps);
        let directions: Vec<Vertex> = of_turns.map(|map| map.direction).collect();
        let told = |e: triptych_spec::ldm::LdmError| e.to_string();
        let maps = Maps::new(&directions, scene, asking, run.setup.resolution).map_err(told)?;
        let own = Blockers {
            vertices: run.setup.model.corners(triangle).to_vec(),
            triangles: vec![[0, 1, 2]],
        };
        let layers = layers(&maps, &own).map_err(told)?;
        let normal = run.setup.model.face(triangle).normal.map(|c| c as f64);
        let slopes: Vec<f64> = maps.maps.iter().map(|map| slope(map, normal)).collect();
        let whole = f64::from(run.setup.directions) / 2.0 * f64::from(1 << 19);
        for receiver in receivers {
            let mut lost = 0.0;
            for (map, slope) in maps.maps.iter().zip(&slopes) {
                let hits = neighbours(&maps, map, &layers, receiver);
                let weight = weight(map, receiver.normal);
                let met = [hits.before, hits.behind];
                self.pair(*slope, met, || named(map, receiver.point, *slope));
                if met[usize::from(weight < 0)].is_some() {
                    lost += f64::from(weight.unsigned_abs()) / whole;
                }
            }
            self.lost = self.lost.max(lost);
        }
        Ok(())
    }

    fn pair(&mut self, slope: f64, met: [Option<u32>; 2], named: impl Fn() -> String) {
        self.pairs += 1;
        let met = met.iter().any(Option::is_some);
        if slope > STEEPEST {
            self.steep += 1;
            self.met += u64::from(met);
            return;
        }
        self.steepest = self.steepest.max(slope);
        if met {
            self.wrong += 1;
            self.first.get_or_insert_with(named);
        }
    }
}

/// The weight of all maps in which an asker's face is steeper than is told apart: what it may lose
/// to its own surface, at most.
pub(super) fn steep(run: &LdmRun, asker: &Asker) -> u32 {
    let normal = run
        .setup
        .model
        .face(asker.triangle)
        .normal
        .map(|c| c as f64);
    let maps = run.turns.iter().flat_map(|turn| &turn.maps.maps);
    let steep = maps.filter(|map| slope(map, normal) > STEEPEST);
    steep
        .map(|map| weight(map, asker.receiver.normal).unsigned_abs())
        .sum()
}

fn named(map: &Map, point: Point, slope: f64) -> String {
    format!("{point:?} along {:?}, slope {slope:.3}", map.direction)
}

/// The slope of a plane in a map, in keys a key: as the exact normal has it.
pub(super) fn slope(map: &Map, normal: Vertex) -> f64 {
    let along = |axis: usize| {
        let row = map.rows[axis].map(f64::from);
        dot(scale(row, 1.0 / length(row)), normal).abs()
    };
    (along(0) + along(1)) / dot(map.direction, normal).abs()
}
