//! scene.toml as written: strict, every key documented here.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

pub use super::abuffer::{Abuffer, LayerOrder, SampleCount};
use super::dispatch::Dispatch;
use super::expect::Expect;
use super::grid::Grid;
use super::ldm::Ldm;
use super::rsm::{Motion, Rsm};
use super::value::{
    Colour, Direction, ImageSize, Number, Point, Scale, Sentence, Share, Shares, at_most,
};
use crate::generate::Generator;

/// Most lights of a scene: each shines on every triangle.
const LIGHTS_MAX: usize = 64;

/// A scene.toml.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// What the scene is for, in one sentence.
    pub purpose: Sentence,
    /// Seed of whatever the scene draws at random.
    #[serde(default)]
    pub seed: u64,
    /// Width and height in pixels.
    pub size: ImageSize,
    /// Samples of a pixel, in their standard places: 1, 2, 4 or 8.
    #[serde(default)]
    pub samples: SampleCount,
    /// Linear colour behind everything; black if left out.
    #[serde(default)]
    pub background: Colour,
    /// Left out: a perspective view of everything.
    pub camera: Option<Spanned<CameraEntry>>,
    /// Left out: [`SceneFile::default_lights`].
    #[serde(
        default = "SceneFile::default_lights",
        deserialize_with = "at_most::<LIGHTS_MAX, _, _>"
    )]
    pub light: Vec<Light>,
    /// What meshes are made of.
    #[serde(default)]
    pub material: Vec<MaterialEntry>,
    /// The geometry. `mesh = []` says that a scene is empty on purpose.
    pub mesh: Vec<Spanned<MeshEntry>>,
    /// Options of the A-buffer.
    #[serde(default)]
    pub abuffer: Abuffer,
    /// Its triangles block rays; with it the family `grid` runs in place of the others.
    pub grid: Option<Grid>,
    /// Its triangles light each other; with it the family `rsm` runs in place of the others.
    pub rsm: Option<Spanned<Rsm>>,
    /// What is open around its points; with it the family `ldm` runs in place of the others.
    pub ldm: Option<Spanned<Ldm>>,
    /// Its triangles are lit by lamps and mirror each other; with it the family `dispatch` runs in
    /// place of the others.
    pub dispatch: Option<Spanned<Dispatch>>,
    /// Shares of what may go unjudged.
    #[serde(default)]
    pub budget: Budget,
    /// Closed-form answers.
    #[serde(default)]
    pub expect: Expect,
}

impl SceneFile {
    /// Whether its light is worked out by its legs, and passes through nothing.
    pub fn is_lit_later(&self) -> bool {
        self.rsm.is_some() || self.ldm.is_some() || self.dispatch.is_some()
    }

    /// Dim light from everywhere and a stronger one from above, behind the
    /// default camera's right shoulder.
    pub fn default_lights() -> Vec<Light> {
        vec![
            Light::Ambient {
                intensity: Colour([0.3; 3]),
            },
            Light::Directional {
                direction: Direction([-0.6, -1.0, -0.8]),
                intensity: Colour([0.7; 3]),
            },
        ]
    }
}

/// A camera: `fov` makes it a perspective, `height` orthographic.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraEntry {
    /// Position.
    pub eye: Point,
    /// Point in the middle of the picture.
    pub target: Point,
    /// Upward, not parallel to the view; y if left out.
    #[serde(default = "CameraEntry::y")]
    pub up: Direction,
    /// Full vertical angle in degrees.
    pub fov: Option<Number>,
    /// World units from the bottom of the picture to its top.
    pub height: Option<Number>,
    /// Distance at which depth is 0.
    pub near: Number,
    /// Distance at which depth is 1.
    pub far: Number,
}

impl CameraEntry {
    fn y() -> Direction {
        Direction([0.0, 1.0, 0.0])
    }
}

/// A light. Intensities are radiances that a white Lambertian face reflects where
/// the light strikes it head-on: irradiance over pi.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Light {
    /// The same on every face.
    Ambient {
        /// Radiance.
        intensity: Colour,
    },
    /// Parallel light.
    Directional {
        /// The way the light travels; any length.
        direction: Direction,
        /// Radiance.
        intensity: Colour,
    },
    /// Light from a point; falls off with the square of the distance.
    Point {
        /// Where it is.
        position: Point,
        /// Radiance at distance 1.
        intensity: Colour,
    },
}

/// A material.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialEntry {
    /// What meshes call it by.
    pub name: Spanned<String>,
    /// Linear reflectance.
    pub colour: Colour,
    /// 1 is opaque, 0 invisible (but still in the lists).
    pub opacity: Share,
    /// With `[dispatch]`: the part of the light from its mirror direction that it gives back, for each
    /// colour 0 to 1; none if left out.
    pub mirror: Option<Shares>,
}

/// A mesh and where it stands. Exactly one of `file`, `package` and `generate`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshEntry {
    /// A mesh file, relative to the scene.
    pub file: Option<String>,
    /// A row of corpus/meshes.lock.
    pub package: Option<Spanned<String>>,
    /// A generator and its parameters.
    pub generate: Option<Spanned<Generator>>,
    /// How strands of hair become triangles; for a `.bin.gz` only.
    pub hair: Option<Hair>,
    /// Overrides every material of the mesh.
    pub material: Option<Spanned<String>>,
    /// Overrides single materials of the mesh, by the mesh's names.
    #[serde(default)]
    pub materials: BTreeMap<Spanned<String>, Spanned<String>>,
    /// Factor, applied first.
    #[serde(default)]
    pub scale: Scale,
    /// Degrees about x, then y, then z, applied second.
    #[serde(default)]
    pub rotate: Point,
    /// Offset, applied last.
    #[serde(default)]
    pub translate: Point,
    /// Copies, each placed by its own transform after the mesh's.
    #[serde(default = "MeshEntry::once")]
    pub instances: Vec<Transform>,
    /// With `[rsm]` or `[ldm]`: whether eye and lamp see it; true if left out.
    pub seen: Option<bool>,
    /// With `[rsm]`: whether it blocks indirect light; false if left out. With `[ldm]`: whether
    /// it is in the maps; true if left out.
    pub blocks: Option<bool>,
    /// With `[rsm]`: how it moves from frame to frame.
    pub moves: Option<Motion>,
}

impl Default for MeshEntry {
    fn default() -> Self {
        Self {
            file: None,
            package: None,
            generate: None,
            hair: None,
            material: None,
            materials: BTreeMap::new(),
            scale: Scale::default(),
            rotate: Point::default(),
            translate: Point::default(),
            instances: Self::once(),
            seen: None,
            blocks: None,
            moves: None,
        }
    }
}

impl MeshEntry {
    fn once() -> Vec<Transform> {
        vec![Transform::default()]
    }
}

/// A placement: scale, rotate, translate, in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Transform {
    /// Factor.
    #[serde(default)]
    pub scale: Scale,
    /// Degrees about x, then y, then z.
    #[serde(default)]
    pub rotate: Point,
    /// Offset.
    #[serde(default)]
    pub translate: Point,
}

/// Which strands of hair become prisms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hair {
    /// Every how manieth strand is kept.
    #[serde(default = "Hair::every")]
    pub stride: std::num::NonZeroU32,
}

impl Hair {
    fn every() -> std::num::NonZeroU32 {
        std::num::NonZeroU32::MIN
    }
}

impl Default for Hair {
    fn default() -> Self {
        Self {
            stride: Self::every(),
        }
    }
}

/// Shares of what may go unjudged.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Budget {
    /// Pairs of ray and triangle too close to an edge for Embree's vote. Left out:
    /// [`Budget::EDGE`], and with `[grid]` what its rays are drawn for.
    pub edge: Option<Share>,
    /// Triangles that stage clip may decide either way, or on whose corners WGSL
    /// promises nothing in clip or snap; vertices on which it promises nothing in transform.
    #[serde(default = "Budget::default_vertex")]
    pub vertex: Share,
}

impl Budget {
    /// Share of pairs in class edge where nothing is aimed at edges.
    pub const EDGE: f64 = 0.001;

    /// The share of `edge` as stated, or by default.
    pub fn edge(&self) -> f64 {
        self.edge.map_or(Self::EDGE, |share| share.0)
    }

    fn default_vertex() -> Share {
        Share(0.01)
    }
}

impl Default for Budget {
    fn default() -> Self {
        Self {
            edge: None,
            vertex: Self::default_vertex(),
        }
    }
}
