//! How many of a scene's numbers `f32` cannot hold well.

use triptych_spec::bound::{Bounded, TINY};
use triptych_spec::scene::Scene;
use triptych_spec::vertex;

/// Vertices with a component, before or after `transform`, of which this is true.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Numbers {
    /// All vertices.
    pub vertices: u64,
    /// On which WGSL promises nothing: the bound is infinite.
    pub unbounded: u64,
    /// Not zero, and subnormal in `f32`: a device may flush it.
    pub subnormal: u64,
    /// Beyond the largest `f32`.
    pub overflow: u64,
}

impl Numbers {
    /// Counts them.
    pub fn of(scene: &Scene) -> Self {
        let positions = vertex::transform::<Bounded>(scene);
        let mut numbers = Self {
            vertices: positions.len() as u64,
            ..Self::default()
        };
        for (vertex, position) in scene.vertices.iter().zip(&positions) {
            let given = vertex.position.map(f64::from);
            let values = given.into_iter().chain(position.map(|n| n.value));
            let is = |test: fn(f64) -> bool| u64::from(values.clone().any(test));
            numbers.subnormal += is(|v| v != 0.0 && v.abs() < TINY);
            numbers.overflow += is(|v| v.abs() > f64::from(f32::MAX));
            numbers.unbounded += u64::from(position.iter().any(|n| n.bound.is_infinite()));
        }
        numbers
    }
}
