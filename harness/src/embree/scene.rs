//! Snapped triangles as an Embree scene, and all hits of a ray.

use embree4_rs::CommittedScene;
use embree4_sys::RTCRay;
use triptych_spec::raster::sample;
use triptych_spec::scene::Size;
use triptych_spec::vertex::{Primitives, SUBPIXEL_BITS};

use super::EmbreeError;
use super::collect::{collect, commit};

/// Coordinates beyond this are refused: differences and sums of two of them must
/// be exact in `f32`. The guard rectangle keeps the spec's own far below.
const COORDINATE_MAX: i32 = 1 << 21;

/// A triangle that Embree reports along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Row in [`Primitives::prims`]; in world space, in the scene's triangles; on a lattice,
    /// in those of the blockers.
    pub prim: u32,
    /// Distance along the ray; [`Depth::key`] translates it. On a lattice, a time.
    pub t: f32,
}

/// An observation by rays through samples: Embree's, or a test's corruption of it.
pub trait RayHits: Sync {
    /// Replaces `hits` by every hit of the ray through a pixel's sample, in order of
    /// `(prim, t)`; a triangle may be reported more than once.
    ///
    /// # Errors
    /// If Embree reports one.
    fn hits(&self, column: u32, row: u32, hits: &mut Vec<Hit>) -> Result<(), EmbreeError>;
}

/// An observation in screen space.
pub trait ScreenHits: RayHits {
    /// The scale of [`Hit::t`].
    fn depth(&self) -> Depth;
}

/// How depth keys became Embree's z: `z = f32(key - base) * 2^-exponent`.
///
/// Keys are counted from the nearest corner, which makes the most of the 24 bits
/// of an `f32`. Rays start at z = 0, so one eighth of the range is left free
/// before the nearest corner: Embree drops hits behind the start, and t has an
/// error. The power of two only brings z to the magnitude of x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Depth {
    base: i64,
    scale: f64,
}

impl Depth {
    pub(super) fn new(primitives: &Primitives) -> Self {
        let keys = || primitives.snapped.iter().map(|corner| i64::from(corner[2]));
        let (near, far) = (keys().min().unwrap_or(0), keys().max().unwrap_or(0));
        let free = (far - near) / 8 + 1;
        let bits = (far - near + free).ilog2();
        Self {
            base: near - free,
            scale: f64::from(1_u32 << bits.saturating_sub(20)),
        }
    }

    /// Embree's z of a corner. Rounds once; scaling by a power of two is exact.
    pub fn z(&self, key: i32) -> f32 {
        #[expect(clippy::cast_possible_truncation, reason = "a power of two below 2^13")]
        let scale = self.scale as f32;
        (i64::from(key) - self.base) as f32 / scale
    }

    /// A corner's z before rounding.
    pub fn exact_z(&self, key: i32) -> f64 {
        (i64::from(key) - self.base) as f64 / self.scale
    }

    /// The depth key, as a real number, at a distance along the ray.
    pub fn key(&self, t: f32) -> f64 {
        f64::from(t) * self.scale + self.base as f64
    }

    /// Keys per unit of z.
    pub fn scale(&self) -> f64 {
        self.scale
    }
}

/// The spec's snapped triangles, committed to Embree.
pub struct EmbreeScene {
    /// Absent if there are no triangles: Embree refuses empty buffers.
    scene: Option<CommittedScene>,
    depth: Depth,
    size: Size,
    bits: u32,
}

impl EmbreeScene {
    /// Builds the scene.
    ///
    /// # Errors
    /// If coordinates are not those of a guard rectangle with at most
    /// [`SUBPIXEL_BITS`], if a triangle names a missing corner, or if Embree
    /// reports an error.
    pub fn new(primitives: &Primitives) -> Result<Self, EmbreeError> {
        check(primitives)?;
        let depth = Depth::new(primitives);
        let scene = if primitives.prims.is_empty() {
            None
        } else {
            Some(commit(&corners(primitives, &depth), &primitives.prims)?)
        };
        Ok(Self {
            scene,
            depth,
            size: primitives.size,
            bits: primitives.bits,
        })
    }
}

/// The snapped corners as Embree has them: x and y in sub-pixels, which are exact.
pub(super) fn corners(primitives: &Primitives, depth: &Depth) -> Vec<[f32; 3]> {
    let corner = |&[x, y, z]: &[i32; 3]| [x as f32, y as f32, depth.z(z)];
    primitives.snapped.iter().map(corner).collect()
}

/// The ray through a pixel's sample.
pub(super) fn ray(column: u32, row: u32, bits: u32) -> RTCRay {
    let [x, y] = [column, row].map(|pixel| sample(pixel, bits) as f32);
    RTCRay {
        org_x: x,
        org_y: y,
        dir_z: 1.0,
        ..RTCRay::default()
    }
}

/// What makes the exactness claims of [`super::bound`] true.
fn check(primitives: &Primitives) -> Result<(), EmbreeError> {
    let step = "check of the triangles";
    if !(1..=SUBPIXEL_BITS).contains(&primitives.bits) {
        let reason = format!("{} sub-pixel bits, 1 to 8 expected", primitives.bits);
        return Err(EmbreeError::new(step, reason));
    }
    let reach = -COORDINATE_MAX..=COORDINATE_MAX;
    let far = |c: &&[i32; 3]| !(reach.contains(&c[0]) && reach.contains(&c[1]));
    primitives
        .snapped
        .iter()
        .find(far)
        .map_or(Ok(()), |corner| {
            let reason = format!("corner {corner:?} lies beyond the guard rectangle");
            Err(EmbreeError::new(step, reason))
        })
}

impl ScreenHits for EmbreeScene {
    fn depth(&self) -> Depth {
        self.depth
    }
}

impl RayHits for EmbreeScene {
    fn hits(&self, column: u32, row: u32, hits: &mut Vec<Hit>) -> Result<(), EmbreeError> {
        hits.clear();
        if column >= self.size.width || row >= self.size.height {
            return Err(EmbreeError::new("ray", format!("no pixel {column}, {row}")));
        }
        let Some(scene) = &self.scene else {
            return Ok(());
        };
        collect(scene, ray(column, row, self.bits), hits)
    }
}
