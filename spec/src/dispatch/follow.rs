//! The loop that all of it serves: a task's rays, one after another.

use super::queue::{Fifo, TASK_RAYS};
use super::ray::{Carried, Ray, WEIGHT_ONE, Weight};
use super::{Met, Sums, Tracer, World, deposit, intersect, light, locate, primary, reflect};

/// What comes of a ray beside the rays that it shoots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shot {
    /// Light for its pixel.
    Light([f32; 3]),
    /// None: it was blocked, or its surface gives only what other rays may bring.
    Dark,
}

/// Traces a ray and shades what it meets (paper listing 2, lines 6 to 9): what it adds to its
/// pixel, and in `shot` the rays that it asks for, shadow rays in order of lamps, then the mirror ray.
pub fn follow(world: &World, tracer: &impl Tracer, ray: &Ray, shot: &mut Vec<Ray>) -> Shot {
    match (intersect(tracer, ray), ray.carried) {
        (Met::Nothing, Carried::Light(light)) => Shot::Light(light),
        (Met::Nothing, Carried::Weight(weight)) => Shot::Light(behind(world, weight)),
        (Met::Triangle(triangle), Carried::Weight(_)) => {
            let surface = locate(world, ray.way, triangle);
            shot.extend(light(world, ray, &surface).map(|(ray, _)| ray));
            shot.extend(reflect(world, ray, &surface));
            Shot::Dark
        }
        (Met::Something | Met::Triangle(_), _) => Shot::Dark,
    }
}

/// The background along a ray, rounded to `f32` once.
pub fn behind(world: &World, weight: Weight) -> [f32; 3] {
    [0, 1, 2].map(|i| {
        let part = f64::from(weight[i]) / f64::from(WEIGHT_ONE);
        #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is meant")]
        let light = (f64::from(world.background[i]) * part) as f32;
        light
    })
}

/// Rays in tasks of at most [`TASK_RAYS`], in order.
pub fn tasks(rays: &[Ray]) -> impl Iterator<Item = Vec<Ray>> + '_ {
    rays.chunks(TASK_RAYS).map(<[Ray]>::to_vec)
}

/// The picture, one task after another in the order of [`Fifo`], so bounce after bounce.
pub fn render(world: &World, tracer: &impl Tracer) -> Sums {
    let mut sums = Sums::new(world.eye.size);
    let mut queue = Fifo::default();
    let first: Vec<Ray> = primary(&world.eye).collect();
    tasks(&first).for_each(|task| queue.add(task));
    while let Some(task) = queue.get() {
        let mut shot = Vec::new();
        for ray in &task {
            if let Shot::Light(light) = follow(world, tracer, ray, &mut shot) {
                deposit(&mut sums, ray.pixel, light);
            }
        }
        tasks(&shot).for_each(|task| queue.add(task));
    }
    sums
}
