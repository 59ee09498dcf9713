//! The layout of rays in queues: bounce after bounce, what they meet and what they bring.

use std::io;

use triptych_spec::abuffer::NOTHING;
use triptych_spec::dispatch::{Carried, Met, Ray, Sums};
use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::Lattice;
use triptych_spec::rsm::Surface;

use super::LegDump;

/// Rays that have seen as many mirrors, in a leg's own order.
#[derive(Clone, Copy)]
pub struct BounceArrays<'a> {
    /// Those that ask for the nearest triangle.
    pub rays: &'a [Ray],
    /// What they meet.
    pub met: &'a [Met],
    /// The point of each, where there is one.
    pub surfaces: &'a [Option<Surface>],
    /// Rays to lamps.
    pub shadows: &'a [Ray],
    /// Whether they reach them.
    pub lit: &'a [bool],
}

impl LegDump {
    /// Writes `dispatch/lattice`, `triangles`, `sums` and `image`.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub fn traced(&self, lattice: &Lattice, blockers: &Blockers, sums: &Sums) -> io::Result<()> {
        self.lattice("dispatch", lattice)?;
        let count = blockers.triangles.len();
        let rows = (0_u32..).take(count);
        let corners: Vec<i32> = rows
            .flat_map(|row| blockers.corners(row).into_iter().flatten())
            .collect();
        self.i32("dispatch", "triangles", &[count, 3, 3], &corners)?;
        let size = sums.size;
        let [width, height] = [size.width, size.height].map(|side| side as usize);
        let all = sums.pixels.as_flattened();
        self.u64("dispatch", "sums", &[height, width, 3], all)?;
        #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
        let light = |pixel: usize| sums.light(pixel).map(|c| c as f32);
        let pixels: Vec<[f32; 3]> = (0..size.pixels()).map(light).collect();
        self.image("dispatch", "image", size, &pixels)
    }

    /// Writes the folder of a bounce, from 0.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub fn bounce(&self, number: usize, bounce: &BounceArrays<'_>) -> io::Result<()> {
        let stage = format!("dispatch-{number}");
        let rays: Vec<i32> = bounce.rays.iter().flat_map(way).collect();
        self.i32(&stage, "rays", &[bounce.rays.len(), 6], &rays)?;
        let [pixels, of_shadows] = [bounce.rays, bounce.shadows].map(pixels);
        self.u32(&stage, "pixel", &[pixels.len()], &pixels)?;
        let weights: Vec<u32> = bounce.rays.iter().flat_map(weight).collect();
        self.u32(&stage, "weight", &[bounce.rays.len(), 3], &weights)?;
        let met: Vec<u32> = bounce.met.iter().map(triangle).collect();
        self.u32(&stage, "met", &[met.len()], &met)?;
        let points: Vec<i32> = bounce.surfaces.iter().flat_map(point).collect();
        self.i32(&stage, "point", &[bounce.surfaces.len(), 4], &points)?;
        let shadows: Vec<i32> = bounce.shadows.iter().flat_map(way).collect();
        self.i32(&stage, "shadows", &[bounce.shadows.len(), 6], &shadows)?;
        self.u32(&stage, "shadow_pixel", &[of_shadows.len()], &of_shadows)?;
        let light: Vec<f32> = bounce.shadows.iter().flat_map(light).collect();
        self.f32(&stage, "light", &[bounce.shadows.len(), 3], &light)?;
        let lit: Vec<u32> = bounce.lit.iter().map(|lit| u32::from(*lit)).collect();
        self.u32(&stage, "lit", &[lit.len()], &lit)
    }
}

fn way(ray: &Ray) -> impl Iterator<Item = i32> {
    ray.way.origin.into_iter().chain(ray.way.direction)
}

fn pixels(rays: &[Ray]) -> Vec<u32> {
    rays.iter().map(|ray| ray.pixel).collect()
}

fn weight(ray: &Ray) -> [u32; 3] {
    match ray.carried {
        Carried::Weight(weight) => weight,
        Carried::Light(_) => [0; 3],
    }
}

fn light(ray: &Ray) -> [f32; 3] {
    match ray.carried {
        Carried::Light(light) => light,
        Carried::Weight(_) => [0.0; 3],
    }
}

fn triangle(met: &Met) -> u32 {
    match met {
        Met::Triangle(triangle) => *triangle,
        Met::Nothing | Met::Something => NOTHING,
    }
}

/// Side and point; zeros for none.
fn point(surface: &Option<Surface>) -> [i32; 4] {
    surface.map_or([0; 4], |s| {
        let [x, y, z] = s.point;
        [s.side, x, y, z]
    })
}
