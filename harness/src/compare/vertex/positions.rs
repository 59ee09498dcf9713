//! Stage `transform` by itself: every component inside its bound.

use triptych_spec::bound::{Bounded, TINY};
use triptych_spec::scene::Scene;
use triptych_spec::vertex::{self, Position};

use super::TOLD_MAX;
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

/// What comparing positions gave. Every difference has cause
/// [`crate::cause::Cause::Vertex`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TransformReport {
    /// Vertices compared.
    pub vertices: u64,
    /// Vertices with a component outside its bound; all, if the counts differ.
    pub outside: u64,
    /// The first [`TOLD_MAX`] of them.
    pub told: Vec<Stray>,
    /// Vertices with a component on which WGSL promises nothing.
    pub unbounded: u64,
    /// Largest error of a component with a bound, in homogeneous pixels.
    pub error: f64,
    /// Largest error over its bound.
    pub error_over_bound: f64,
}

impl TransformReport {
    /// The report as a judgement over vertices. The budget for what is admitted is
    /// the caller's.
    pub fn judgement(&self) -> Judgement {
        let mut judgement = Judgement::new(Class::Interval, "vertices");
        judgement.compared = self.vertices;
        judgement.admitted = self.unbounded;
        judgement.error = Some(self.error);
        judgement.error_over_bound = Some(self.error_over_bound);
        for stray in &self.told {
            judgement.differs(Cause::Vertex, None, || stray.to_string());
        }
        let further = self.outside - self.told.len() as u64;
        if further > 0 {
            *judgement.causes.entry(Cause::Vertex).or_default() += further;
        }
        judgement.note = format!("off by up to {:.2} of the bound", self.error_over_bound);
        judgement
    }
}

/// A component outside its bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stray {
    /// Row in [`Scene::vertices`].
    pub vertex: usize,
    /// 0 to 3 for x, y, z, w.
    pub component: usize,
    /// What it should be.
    pub expected: Bounded,
    /// What it is.
    pub observed: f32,
}

/// Compares a device's positions, one for each of [`Scene::vertices`], with the
/// spec's.
pub fn compare_transform(scene: &Scene, observed: &[Position<f32>]) -> TransformReport {
    let expected: Vec<Position<Bounded>> = vertex::transform(scene);
    let mut report = TransformReport {
        vertices: expected.len() as u64,
        ..TransformReport::default()
    };
    if expected.len() != observed.len() {
        report.outside = expected.len().max(observed.len()) as u64;
        return report;
    }
    for (vertex, (expected, observed)) in expected.iter().zip(observed).enumerate() {
        let mut strays = (0..4).filter(|&i| !admits(expected[i], observed[i]));
        if let Some(component) = strays.next() {
            report.outside += 1;
            if report.told.len() < TOLD_MAX {
                report.told.push(Stray {
                    vertex,
                    component,
                    expected: expected[component],
                    observed: observed[component],
                });
            }
        }
        report.unbounded += u64::from(expected.iter().any(|e| e.bound.is_infinite()));
        for (e, o) in expected.iter().zip(observed) {
            let error = (f64::from(*o) - e.value).abs();
            let ratio = error / e.bound;
            if ratio.is_finite() && e.bound.is_finite() {
                report.error = report.error.max(error);
                report.error_over_bound = report.error_over_bound.max(ratio);
            }
        }
    }
    report
}

/// A device's number as the given one of the stage that follows: from equal inputs. A
/// subnormal number may be flushed when it is read; on what is not finite nothing is
/// promised.
pub fn exact(observed: Position<f32>) -> Position<Bounded> {
    observed.map(|v| Bounded {
        value: if v.is_finite() { f64::from(v) } else { 0.0 },
        bound: match v {
            _ if !v.is_finite() => f64::INFINITY,
            _ if v.is_subnormal() => TINY,
            _ => 0.0,
        },
    })
}

/// Where nothing is promised, NaN and infinity conform as well.
fn admits(expected: Bounded, observed: f32) -> bool {
    expected.bound.is_infinite() || expected.admits(f64::from(observed))
}
