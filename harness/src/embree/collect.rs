//! All hits of a ray through triangles that are committed to Embree.

use std::ffi::c_void;

use embree4_rs::geometry::TriangleMeshGeometry;
use embree4_rs::{CommittedScene, Device, Scene, SceneOptions};
use embree4_sys::{
    RTC_INVALID_GEOMETRY_ID, RTCBuildQuality, RTCFeatureFlags, RTCFilterFunctionNArguments, RTCHit,
    RTCIntersectArguments, RTCRay, RTCRayQueryContext, RTCRayQueryFlags, RTCSceneFlags,
};

use super::EmbreeError;
use super::scene::Hit;

/// How the device is configured; the wrapper passes it on without adding a NUL.
///
/// SSE2 is part of x86-64 and of every build of Embree for it, so the same code
/// runs on any machine (Embree's results depend on the instruction set: its
/// issue 423). One thread builds, so the tree does not depend on the machine
/// either; rays are traced on many threads by the comparer.
pub(super) const CONFIG: &str = "isa=sse2,threads=1\0";

/// Medium, as a tree of high quality may report a triangle of several leaves several times.
pub(super) const QUALITY: RTCBuildQuality = RTCBuildQuality::MEDIUM;

/// Robust mode, and a filter in the arguments of each query.
pub(super) fn flags() -> RTCSceneFlags {
    RTCSceneFlags::ROBUST | RTCSceneFlags::FILTER_FUNCTION_IN_ARGUMENTS
}

/// Hands triangles to Embree.
///
/// # Errors
/// If a triangle names a corner that is not there, or if Embree reports an error.
pub(super) fn commit(
    corners: &[[f32; 3]],
    triangles: &[[u32; 3]],
) -> Result<CommittedScene, EmbreeError> {
    check(corners.len(), triangles)?;
    let corners: Vec<(f32, f32, f32)> = corners.iter().map(|c| (*c).into()).collect();
    let triangles: Vec<(u32, u32, u32)> = triangles.iter().map(|t| (*t).into()).collect();
    let options = SceneOptions {
        build_quality: QUALITY,
        flags: flags(),
    };
    let failed = |step| move |e| EmbreeError::new(step, e);
    let device = Device::try_new(Some(CONFIG)).map_err(failed("new device"))?;
    let mesh = TriangleMeshGeometry::try_new(&device, &corners, &triangles)
        .map_err(failed("copy of the triangles"))?;
    let scene = Scene::try_new(device, options).map_err(failed("new scene"))?;
    scene
        .attach_geometry(&mesh)
        .map_err(failed("attaching the triangles"))?;
    scene.commit().map_err(failed("building the tree"))
}

/// What makes Embree's reads safe.
pub(super) fn check(corners: usize, triangles: &[[u32; 3]]) -> Result<(), EmbreeError> {
    let missing = triangles.iter().flatten().find(|c| **c as usize >= corners);
    missing.map_or(Ok(()), |corner| {
        let reason = format!("no corner {corner}, there are {corners}");
        Err(EmbreeError::new("check of the triangles", reason))
    })
}

/// Every hit of one ray, in order of `(prim, t)`.
///
/// # Errors
/// If Embree reports one.
pub(super) fn collect(
    scene: &CommittedScene,
    ray: RTCRay,
    hits: &mut Vec<Hit>,
) -> Result<(), EmbreeError> {
    let mut collector = Collector::new(hits);
    let arguments = collector.arguments();
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

/// A query context with the vector that the filter fills.
///
/// Embree passes the pointer through, so a context may be longer than Embree
/// knows. `instance_primitive` is a field that newer headers than embree4-sys's
/// have in the context (`instPrimID`): the library reads it.
#[repr(C)]
pub(super) struct Collector<'a> {
    context: RTCRayQueryContext,
    instance_primitive: u32,
    hits: &'a mut Vec<Hit>,
}

impl<'a> Collector<'a> {
    /// Adds what is found to `hits`.
    pub(super) fn new(hits: &'a mut Vec<Hit>) -> Self {
        Self {
            context: RTCRayQueryContext {
                instID: [RTC_INVALID_GEOMETRY_ID],
            },
            instance_primitive: RTC_INVALID_GEOMETRY_ID,
            hits,
        }
    }

    /// Arguments of a query that ends before the collector moves.
    pub(super) fn arguments(&mut self) -> RTCIntersectArguments {
        RTCIntersectArguments {
            flags: RTCRayQueryFlags::INVOKE_ARGUMENT_FILTER,
            feature_mask: RTCFeatureFlags(u32::MAX), // all: the default of Embree's initialiser
            context: (&raw mut *self).cast(),
            filter: Some(keep_and_reject),
            intersect: None,
        }
    }
}

/// The filter: notes the hit and rejects it, so that the ray goes on.
#[expect(unsafe_code, reason = "called by Embree with raw pointers")]
unsafe extern "C" fn keep_and_reject(arguments: *const RTCFilterFunctionNArguments) {
    // SAFETY: Embree calls this inside the query with valid pointers and N = 1,
    // for which ray and hit have the layout of the single structures (the fields
    // read here lie at the same place in every Embree 4). The context is the
    // `Collector` that the query's caller borrows mutably for its length, on
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
