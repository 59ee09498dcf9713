//! What the kernels keep of pixels, texels and triangles.

use bytemuck::{Pod, Zeroable};
use triptych_spec::abuffer::NOTHING;
use triptych_spec::grid::lattice::Point;
use triptych_spec::rsm::{self as spec, Model};

use crate::grid::{exact, integers};

/// The plane and colour of a triangle. Twin: `Face` in `surface.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Face {
    /// The normal at length 1, or 0.
    pub unit: [f32; 3],
    /// The axis along which the normal is longest, from 1, with its component's sign; or 0.
    pub axis: i32,
    /// The normal at length 2^14.
    pub coarse: Point,
    /// Up to a multiple of 16 bytes.
    pub unused: u32,
    /// Linear; the fourth number is not used.
    pub colour: [f32; 4],
}

/// The planes and colours of all triangles; one of no triangle where there are none, as no
/// binding may be empty.
pub(super) fn faces(model: &Model) -> Vec<Face> {
    let face = |(face, [r, g, b]): (&spec::Face, &[f32; 3])| {
        let axis = face.axis();
        let sign = face.normal[axis].signum();
        let number = [1, 2, 3][axis];
        Face {
            unit: face.unit,
            axis: match sign {
                1 => number,
                -1 => -number,
                _ => 0,
            },
            coarse: face.coarse,
            unused: 0,
            colour: [*r, *g, *b, 0.0],
        }
    };
    let faces: Vec<Face> = model.faces.iter().zip(&model.colours).map(face).collect();
    match faces.is_empty() {
        true => vec![Face::zeroed()],
        false => faces,
    }
}

/// A point that is seen. Twins: `Surface` in `surface.wgsl` and in `task.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Surface {
    /// In lattice steps, integers.
    pub point: [f32; 3],
    /// Twice the triangle, and 1 if its normal points away from where it is seen from; or
    /// [`NOTHING`].
    pub face: u32,
}

impl Surface {
    /// As kernels read it.
    pub(crate) fn packed(surface: Option<&spec::Surface>) -> Self {
        surface.map_or(
            Self {
                point: [0.0; 3],
                face: NOTHING,
            },
            |surface| Self {
                point: exact(surface.point),
                face: 2 * surface.triangle + u32::from(surface.side < 0),
            },
        )
    }

    /// As the spec has it; what is no integer of the lattice comes out as `i32::MIN`. The
    /// triangle is whatever the device says.
    pub(crate) fn unpacked(self) -> Option<spec::Surface> {
        (self.face != NOTHING).then(|| spec::Surface {
            triangle: self.face / 2,
            side: if self.face & 1 == 1 { -1 } else { 1 },
            point: integers(self.point),
        })
    }
}

/// Where a point lies in the light's map. Twin: `Place` in `texel.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Place {
    /// Column and row.
    pub texel: [i32; 2],
    /// Depth key.
    pub key: u32,
    /// 1, or 0: nowhere.
    pub known: u32,
}

impl Place {
    pub(super) fn packed(place: Option<&spec::Place>) -> Self {
        place.map_or(Self::default(), |place| Self {
            texel: place.texel,
            key: place.key,
            known: 1,
        })
    }

    pub(super) fn unpacked(self) -> Option<spec::Place> {
        (self.known != 0).then_some(spec::Place {
            texel: self.texel,
            key: self.key,
        })
    }
}

/// A texel as a light. Twin: `Light` in `texel.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Light {
    /// Its surface's point.
    pub point: [f32; 3],
    /// As a surface's.
    pub face: u32,
    /// The unit normal on the side that is seen.
    pub unit: [f32; 3],
    /// Up to a multiple of 16 bytes.
    pub unused: u32,
}

impl Light {
    pub(super) fn packed(model: &Model, light: Option<&spec::Light>) -> Self {
        let Surface { point, face } = Surface::packed(light.map(|light| &light.surface));
        let unit = light.map_or([0.0; 3], |light| {
            let flip = light.surface.side < 0;
            let unit = model.face(light.surface.triangle).unit;
            unit.map(|c| if flip { -c } else { c })
        });
        Self {
            point,
            face,
            unit,
            unused: 0,
        }
    }

    pub(crate) fn unpacked(self) -> Option<spec::Surface> {
        let Self { point, face, .. } = self;
        Surface { point, face }.unpacked()
    }
}
