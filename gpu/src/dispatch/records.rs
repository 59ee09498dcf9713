//! What the kernels keep of triangles, lamps and rays.

use bytemuck::{Pod, Zeroable};
use triptych_spec::abuffer::NOTHING;
use triptych_spec::dispatch::{self as spec, LAMPS_MAX, Met, Ray, World};
use triptych_spec::grid::ray::Ray as Way;

use super::{DEPTH_AT, LIGHT};
use crate::grid::{Hit, Packed, TRACED, exact, integers};

/// A triangle, its plane and its material. Twin: `Facet` in `task.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Facet {
    /// The first corner, in lattice steps.
    pub a: [f32; 3],
    /// The axis along which the normal is longest, from 1, with its component's sign; or 0.
    pub axis: i32,
    /// The second corner; the fourth number of this and those that follow is not used.
    pub b: [f32; 4],
    /// The third corner.
    pub c: [f32; 4],
    /// The normal at length 1, or 0.
    pub unit: [f32; 4],
    /// The normal at length 2^14.
    pub coarse: [i32; 4],
    /// Linear.
    pub colour: [f32; 4],
    /// What it mirrors, in units of 2^-15.
    pub mirror: [u32; 4],
}

/// All triangles of a world; one of no area where there are none, as no binding may be empty.
pub(super) fn triangles(world: &World) -> Vec<Facet> {
    let model = &world.model;
    let rows = (0..).take(model.triangles.len());
    let triangle = |row: u32| {
        let (face, at) = (model.face(row), row as usize);
        let axis = face.axis();
        let sign = face.normal[axis].signum();
        let [a, b, c] = model.corners(row).map(exact);
        let padded = |[x, y, z]: [f32; 3]| [x, y, z, 0.0];
        let [x, y, z] = face.coarse;
        let [red, green, blue] = world.mirrors[at];
        Facet {
            a,
            axis: match sign {
                1 => [1, 2, 3][axis],
                -1 => [-1, -2, -3][axis],
                _ => 0,
            },
            b: padded(b),
            c: padded(c),
            unit: padded(face.unit),
            coarse: [x, y, z, 0],
            colour: padded(model.colours[at]),
            mirror: [red, green, blue, 0],
        }
    };
    let all: Vec<Facet> = rows.map(triangle).collect();
    match all.is_empty() {
        true => vec![Facet::zeroed()],
        false => all,
    }
}

/// A lamp. Twin: `Lamp` in `lit.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Lamp {
    /// In lattice steps.
    pub position: [f32; 3],
    /// Where the strength is meant.
    pub reference: f32,
    /// Linear.
    pub strength: [f32; 3],
    /// Least squared distance, rounded.
    pub least: f32,
}

/// As many lamps as there may be; what is not there gives nothing.
pub(super) fn lamps(world: &World) -> [Lamp; LAMPS_MAX] {
    let mut all = [Lamp::default(); LAMPS_MAX];
    for (packed, lamp) in all.iter_mut().zip(&world.lamps) {
        let least = u64::from(lamp.least);
        *packed = Lamp {
            position: exact(lamp.position),
            // At most 2^24.
            reference: lamp.reference as f32,
            strength: lamp.strength,
            least: (least * least) as f32,
        };
    }
    all
}

/// What a ray carries. Twin: `Carried` in `task.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct Carried {
    /// A weight, or the bits of light.
    pub parts: [u32; 3],
    /// Its pixel, its depth from bit [`DEPTH_AT`] on, and [`LIGHT`] if it carries that.
    pub whose: u32,
}

/// A ray as kernels read it.
pub(super) fn packed(ray: &Ray) -> (Packed, Carried) {
    let way = Packed {
        origin: exact(ray.way.origin),
        segment: ray.way.segment.into(),
        direction: exact(ray.way.direction),
        owner: ray.pixel,
    };
    let (parts, kind) = match ray.carried {
        spec::Carried::Weight(weight) => (weight, 0),
        spec::Carried::Light(light) => (light.map(f32::to_bits), LIGHT),
    };
    let whose = ray.pixel | (ray.depth << DEPTH_AT) | kind;
    (way, Carried { parts, whose })
}

/// A ray as the spec has it; what is no integer of the lattice comes out as `i32::MIN`.
pub(super) fn unpacked(way: &Packed, carried: &Carried) -> Ray {
    let Carried { parts, whose } = *carried;
    Ray {
        way: Way {
            origin: integers(way.origin),
            direction: integers(way.direction),
            segment: way.segment != 0,
        },
        pixel: whose & ((1 << DEPTH_AT) - 1),
        depth: (whose & !LIGHT) >> DEPTH_AT,
        carried: match whose & LIGHT {
            0 => spec::Carried::Weight(parts),
            _ => spec::Carried::Light(parts.map(f32::from_bits)),
        },
    }
}

/// A search that found what a ray met.
pub(super) fn hit(met: Met) -> Hit {
    let prim = match met {
        Met::Nothing => NOTHING,
        Met::Something => 0,
        Met::Triangle(triangle) => triangle,
    };
    Hit {
        prim,
        time: 0.0,
        state: TRACED,
        at: 0,
    }
}

/// What a ray met, by the search's answer.
pub(super) fn met(ray: &Ray, prim: u32) -> Met {
    match (prim, ray.carried) {
        (NOTHING, _) => Met::Nothing,
        (triangle, spec::Carried::Weight(_)) => Met::Triangle(triangle),
        (_, spec::Carried::Light(_)) => Met::Something,
    }
}
