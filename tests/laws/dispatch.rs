//! Rays as tasks: a ray tracer whose rays are the same on every leg, bounce after bounce.

#[path = "dispatch/adapters.rs"]
mod adapters;
#[path = "dispatch/early.rs"]
mod early;
#[path = "dispatch/extremes.rs"]
mod extremes;
#[path = "dispatch/eyes.rs"]
mod eyes;
#[path = "dispatch/halves.rs"]
mod halves;
#[path = "dispatch/pictures.rs"]
mod pictures;
#[path = "dispatch/points.rs"]
mod points;
#[path = "dispatch/worlds.rs"]
mod worlds;

use triptych_spec::dispatch::{
    Met, Ray, Searched, World, intersect, light, locate, primary, reflect,
};
use triptych_spec::grid::Grid;
use triptych_spec::rsm::{Colour, Surface};

use worlds::{plains, scenes};

/// A world and the cells of its triangles.
#[derive(Clone, Debug)]
struct Scene {
    world: World,
    grid: Grid,
}

impl Scene {
    fn tracer(&self) -> Searched<'_> {
        Searched {
            grid: &self.grid,
            blockers: &self.world.blockers,
        }
    }

    /// What rays of one bounce meet, and what comes of them.
    fn bounce(&self, rays: Vec<Ray>) -> Bounce {
        let (world, tracer) = (&self.world, self.tracer());
        let met: Vec<Met> = rays.iter().map(|ray| intersect(&tracer, ray)).collect();
        let see = |(ray, met): (&Ray, &Met)| match met {
            Met::Triangle(triangle) => Some(locate(world, ray.way, *triangle)),
            Met::Nothing | Met::Something => None,
        };
        let seen: Vec<Option<Surface>> = rays.iter().zip(&met).map(see).collect();
        let mut bounce = Bounce::default();
        for (ray, surface) in rays.iter().zip(&seen) {
            let Some(surface) = surface else { continue };
            bounce.shadows.extend(light(world, ray, surface));
            bounce.mirrors.extend(reflect(world, ray, surface));
        }
        let blocked = bounce
            .shadows
            .iter()
            .map(|(ray, _)| intersect(&tracer, ray));
        Bounce {
            blocked: blocked.collect(),
            rays,
            met,
            seen,
            ..bounce
        }
    }

    /// All bounces, while there are rays.
    fn bounces(&self) -> Vec<Bounce> {
        let mut all: Vec<Bounce> = Vec::new();
        let mut rays: Vec<Ray> = primary(&self.world.eye).collect();
        while !rays.is_empty() {
            let bounce = self.bounce(rays);
            rays = bounce.mirrors.clone();
            all.push(bounce);
        }
        all
    }
}

/// Rays of one depth, and what comes of them.
#[derive(Clone, Debug, Default)]
struct Bounce {
    rays: Vec<Ray>,
    met: Vec<Met>,
    seen: Vec<Option<Surface>>,
    /// With the bounds of their light.
    shadows: Vec<(Ray, Colour)>,
    blocked: Vec<Met>,
    mirrors: Vec<Ray>,
}
