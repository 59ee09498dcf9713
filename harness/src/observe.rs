//! What a leg saw, labelled by the leg in its type.
//!
//! [`crate::compare::compare`] takes two observations whose labels are declared to
//! be comparable, so that a leg cannot be compared with itself:
//!
//! ```
//! use triptych_harness::compare::{Judgement, compare};
//! use triptych_harness::observe::{Gpu, Observed, Spec};
//! let spec = Observed::<Spec, _>::new("spec", 1);
//! let gpu = Observed::<Gpu, _>::new("gpu@test/compute", 1);
//! let judgement = compare(&spec, &gpu, |a, b| Judgement::exact("items", 1, u64::from(a != b)));
//! assert_eq!(judgement.compared, 1);
//! ```
//!
//! The same with one leg twice does not compile:
//!
//! ```compile_fail,E0277
//! use triptych_harness::compare::{Judgement, compare};
//! use triptych_harness::observe::{Gpu, Observed, Spec};
//! let spec = Observed::<Spec, _>::new("spec", 1);
//! compare(&spec, &spec, |a, b| Judgement::exact("items", 1, u64::from(a != b)));
//! ```

use std::marker::PhantomData;
use std::time::Duration;

/// The scalar spec.
pub enum Spec {}
/// A GPU leg: an adapter and a path.
pub enum Gpu {}
/// A GPU leg that skipped nothing.
pub enum GpuUnskipped {}
/// Embree.
pub enum Embree {}
/// A closed-form answer that a scene states.
pub enum Analytic {}

/// Every ray against every triangle, without a grid.
pub enum Exhaustive {}

/// Labels that may stand on the two sides of a comparison.
pub trait Against<B> {}
impl Against<Gpu> for Spec {}
impl Against<Embree> for Spec {}
impl Against<Analytic> for Spec {}
impl Against<Exhaustive> for Spec {}
impl Against<GpuUnskipped> for Gpu {}

/// A value and the leg that it comes from.
pub struct Observed<L, T> {
    /// What was seen.
    pub value: T,
    /// The leg's name in results, such as `gpu@llvmpipe/fragment`.
    pub label: String,
    /// How long the leg took for it.
    pub time: Option<Duration>,
    leg: PhantomData<L>,
}

impl<L, T> Observed<L, T> {
    /// An observation of leg `L`.
    pub fn new(label: impl Into<String>, value: T) -> Self {
        Self {
            value,
            label: label.into(),
            time: None,
            leg: PhantomData,
        }
    }

    /// The same, with the time that the leg took.
    #[must_use]
    pub fn taking(mut self, time: Duration) -> Self {
        self.time = Some(time);
        self
    }

    /// Something that follows from the observation, under the same label.
    pub fn derive<U>(&self, value: U) -> Observed<L, U> {
        Observed {
            value,
            label: self.label.clone(),
            time: self.time,
            leg: PhantomData,
        }
    }

    /// The same label on a borrowed part.
    pub fn map<'a, U>(&'a self, f: impl FnOnce(&'a T) -> U) -> Observed<L, U> {
        self.derive(f(&self.value))
    }
}
