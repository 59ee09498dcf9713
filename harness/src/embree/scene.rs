//! Snapped triangles as an Embree scene, and all hits of a ray.

use std::ffi::c_void;

use embree4_rs::geometry::TriangleMeshGeometry;
use embree4_rs::{CommittedScene, Device, Scene, SceneOptions};
use embree4_sys::{
    RTC_INVALID_GEOMETRY_ID, RTCBuildQuality, RTCFeatureFlags, RTCFilterFunctionNArguments, RTCHit,
    RTCIntersectArguments, RTCRay, RTCRayQueryContext, RTCRayQueryFlags, RTCSceneFlags,
};
use triptych_spec::raster::sample;
use triptych_spec::scene::Size;
use triptych_spec::vertex::{Primitives, SUBPIXEL_BITS};

use super::EmbreeError;

/// How the device is configured; the wrapper passes it on without adding a NUL.
///
/// SSE2 is part of x86-64 and of every build of Embree for it, so the same code
/// runs on any machine (Embree's results depend on the instruction set: its
/// issue 423). One thread builds, so the tree does not depend on the machine
/// either; rays are traced on many threads by the comparer.
pub(super) const CONFIG: &str = "isa=sse2,threads=1\0";

/// Coordinates beyond this are refused: differences and sums of two of them must
/// be exact in `f32`. The guard rectangle keeps the spec's own far below.
const COORDINATE_MAX: i32 = 1 << 21;

/// A triangle that Embree reports along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Row in [`Primitives::prims`]; in world space, in the scene's triangles.
    pub prim: u32,
    /// Distance along the ray; [`Depth::key`] translates it.
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
    fn new(primitives: &Primitives) -> Self {
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
            let corner = |&[x, y, z]: &[i32; 3]| (x as f32, y as f32, depth.z(z));
            let corners: Vec<_> = primitives.snapped.iter().map(corner).collect();
            let prims = primitives.prims.iter().map(|prim| (*prim).into());
            Some(commit(&corners, &prims.collect::<Vec<_>>())?)
        };
        Ok(Self {
            scene,
            depth,
            size: primitives.size,
            bits: primitives.bits,
        })
    }
}

/// What makes the exactness claims of [`super::bound`] true, and Embree's reads safe.
fn check(primitives: &Primitives) -> Result<(), EmbreeError> {
    let step = "check of the triangles";
    if !(1..=SUBPIXEL_BITS).contains(&primitives.bits) {
        let reason = format!("{} sub-pixel bits, 1 to 8 expected", primitives.bits);
        return Err(EmbreeError::new(step, reason));
    }
    let reach = -COORDINATE_MAX..=COORDINATE_MAX;
    let far = |c: &&[i32; 3]| !(reach.contains(&c[0]) && reach.contains(&c[1]));
    if let Some(corner) = primitives.snapped.iter().find(far) {
        let reason = format!("corner {corner:?} lies beyond the guard rectangle");
        return Err(EmbreeError::new(step, reason));
    }
    let corners = primitives.snapped.len();
    let missing = primitives
        .prims
        .iter()
        .flatten()
        .find(|&&c| c as usize >= corners);
    missing.map_or(Ok(()), |c| {
        Err(EmbreeError::new(
            step,
            format!("no corner {c}, there are {corners}"),
        ))
    })
}

/// Hands triangles to Embree: robust mode, filter in the arguments, medium quality (high
/// quality may report a triangle of several leaves several times). The corners that
/// `prims` names must be there.
pub(super) fn commit(
    corners: &[(f32, f32, f32)],
    prims: &[(u32, u32, u32)],
) -> Result<CommittedScene, EmbreeError> {
    let options = SceneOptions {
        build_quality: RTCBuildQuality::MEDIUM,
        flags: RTCSceneFlags::ROBUST | RTCSceneFlags::FILTER_FUNCTION_IN_ARGUMENTS,
    };
    let failed = |step| move |e| EmbreeError::new(step, e);
    let device = Device::try_new(Some(CONFIG)).map_err(failed("new device"))?;
    let mesh = TriangleMeshGeometry::try_new(&device, corners, prims)
        .map_err(failed("copy of the triangles"))?;
    let scene = Scene::try_new(device, options).map_err(failed("new scene"))?;
    scene
        .attach_geometry(&mesh)
        .map_err(failed("attaching the triangles"))?;
    scene.commit().map_err(failed("building the tree"))
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
        let [x, y] = [column, row].map(|pixel| sample(pixel, self.bits) as f32);
        let ray = RTCRay {
            org_x: x,
            org_y: y,
            dir_z: 1.0,
            ..RTCRay::default()
        };
        collect(scene, ray, hits)
    }
}

/// A query context with the vector that the filter fills.
///
/// Embree passes the pointer through, so a context may be longer than Embree
/// knows. `instance_primitive` is a field that newer headers than embree4-sys's
/// have in the context (`instPrimID`): the library reads it.
#[repr(C)]
struct Collector<'a> {
    context: RTCRayQueryContext,
    instance_primitive: u32,
    hits: &'a mut Vec<Hit>,
}

/// Every hit of one ray, in order of `(prim, t)`.
pub(super) fn collect(
    scene: &CommittedScene,
    ray: RTCRay,
    hits: &mut Vec<Hit>,
) -> Result<(), EmbreeError> {
    let mut collector = Collector {
        context: RTCRayQueryContext {
            instID: [RTC_INVALID_GEOMETRY_ID],
        },
        instance_primitive: RTC_INVALID_GEOMETRY_ID,
        hits,
    };
    let arguments = RTCIntersectArguments {
        flags: RTCRayQueryFlags::INVOKE_ARGUMENT_FILTER,
        feature_mask: RTCFeatureFlags(u32::MAX), // all: the default of Embree's initialiser
        context: (&raw mut collector).cast(),
        filter: Some(keep_and_reject),
        intersect: None,
    };
    // Every hit is rejected, so Embree never writes one into the wrapper's
    // `RTCRayHit`, whose type is 16 bytes shorter than the newer library's.
    let closest = scene
        .intersect_1(ray, Some(&arguments))
        .map_err(|e| EmbreeError::new("ray", e))?;
    if closest.is_some() {
        return Err(EmbreeError::new("ray", "a hit went past the filter"));
    }
    hits.sort_unstable_by(|a, b| a.prim.cmp(&b.prim).then(a.t.total_cmp(&b.t)));
    Ok(())
}

/// The filter: notes the hit and rejects it, so that the ray goes on.
#[expect(unsafe_code, reason = "called by Embree with raw pointers")]
unsafe extern "C" fn keep_and_reject(arguments: *const RTCFilterFunctionNArguments) {
    // SAFETY: Embree calls this inside `intersect_1` with valid pointers and N = 1,
    // for which ray and hit have the layout of the single structures (the fields
    // read here lie at the same place in every Embree 4). The context is the
    // `Collector` that `collect` borrows mutably for the length of that call, on
    // this thread alone.
    unsafe {
        let arguments = &*arguments;
        let collector = &mut *arguments.context.cast::<Collector<'_>>();
        let hit = arguments.hit.cast::<c_void>().cast::<RTCHit>();
        let ray = arguments.ray.cast::<c_void>().cast::<RTCRay>();
        collector.hits.push(Hit {
            prim: (*hit).primID,
            t: (*ray).tfar,
        });
        *arguments.valid = 0;
    }
}
