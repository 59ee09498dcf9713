//! Embree's C interface as far as it is needed here: a scene of triangles, and all hits
//! of a ray.
//!
//! The bindings are older than the library, which is why a hit gets more room than they
//! know of ([`Room`]). [`Bare::trace`] is one call of `rtcIntersect1` and nothing else;
//! whether Embree reports an error is asked when many rays are through ([`Bare::check`]).

use std::ffi::c_void;

use embree4_sys::{
    RTC_INVALID_GEOMETRY_ID, RTCBufferType, RTCBuildQuality, RTCDevice, RTCError, RTCFeatureFlags,
    RTCFilterFunctionNArguments, RTCFormat, RTCGeometry, RTCGeometryType, RTCHit,
    RTCIntersectArguments, RTCRay, RTCRayHit, RTCRayQueryContext, RTCRayQueryFlags, RTCScene,
    RTCSceneFlags, rtcAttachGeometry, rtcCommitGeometry, rtcCommitScene, rtcGetDeviceError,
    rtcIntersect1, rtcNewDevice, rtcNewGeometry, rtcNewScene, rtcReleaseDevice, rtcReleaseGeometry,
    rtcReleaseScene, rtcSetNewGeometryBuffer, rtcSetSceneBuildQuality, rtcSetSceneFlags,
};

use super::EmbreeError;
use super::scene::{CONFIG, Hit};

/// Triangles, committed to Embree.
pub struct Bare {
    device: RTCDevice,
    scene: RTCScene,
}

/// A ray with room for its hit: since 4.4 Embree's own is four bytes longer than that of
/// the bindings, and it is aligned to 16.
#[repr(C, align(16))]
struct Room {
    ray: RTCRayHit,
    spare: [u32; 4],
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

impl Bare {
    /// Copies triangles and builds the tree: robust mode, filter in the arguments, medium
    /// quality (high quality may report a triangle of several leaves several times).
    ///
    /// # Errors
    /// If a triangle names a corner that is not there, if there are none, or if Embree
    /// reports an error.
    #[expect(unsafe_code, reason = "a foreign interface")]
    pub fn new(corners: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<Self, EmbreeError> {
        let named = triangles.iter().flatten();
        if let Some(corner) = named.max().filter(|c| **c as usize >= corners.len()) {
            let reason = format!("no corner {corner}, there are {}", corners.len());
            return Err(EmbreeError::new("check of the triangles", reason));
        }
        // SAFETY: CONFIG ends in NUL. `bare` owns device and scene from where they are made.
        // What Embree gives without an error is not null. The geometry is released here,
        // once, as the scene keeps a reference of its own; its items are what `copy` is told,
        // and name corners that are there.
        unsafe {
            let device = rtcNewDevice(CONFIG.as_ptr().cast());
            if device.is_null() {
                return Err(EmbreeError::new("new device", "refused on this machine"));
            }
            let scene = rtcNewScene(device);
            let bare = Self { device, scene };
            bare.check()?;
            let mesh = rtcNewGeometry(device, RTCGeometryType::TRIANGLE);
            bare.check()?;
            let flags = RTCSceneFlags::ROBUST | RTCSceneFlags::FILTER_FUNCTION_IN_ARGUMENTS;
            rtcSetSceneFlags(scene, flags);
            rtcSetSceneBuildQuality(scene, RTCBuildQuality::MEDIUM);
            let copied = copy(mesh, RTCBufferType::VERTEX, RTCFormat::FLOAT3, corners)
                && copy(mesh, RTCBufferType::INDEX, RTCFormat::UINT3, triangles);
            if copied {
                rtcCommitGeometry(mesh);
                rtcAttachGeometry(scene, mesh);
                rtcCommitScene(scene);
            }
            rtcReleaseGeometry(mesh);
            bare.check()?;
            match copied {
                true => Ok(bare),
                false => Err(EmbreeError::new("copy of the triangles", "no memory")),
            }
        }
    }

    /// Adds every hit of a ray to `hits`, in the order in which Embree finds them; a
    /// triangle may be reported more than once. False if a hit went past the filter.
    #[expect(unsafe_code, reason = "a foreign interface")]
    pub fn trace(&self, ray: RTCRay, hits: &mut Vec<Hit>) -> bool {
        let mut collector = Collector {
            context: RTCRayQueryContext {
                instID: [RTC_INVALID_GEOMETRY_ID],
            },
            instance_primitive: RTC_INVALID_GEOMETRY_ID,
            hits,
        };
        let mut arguments = RTCIntersectArguments {
            flags: RTCRayQueryFlags::INVOKE_ARGUMENT_FILTER,
            feature_mask: RTCFeatureFlags(u32::MAX), // all: the default of Embree's initialiser
            context: (&raw mut collector).cast(),
            filter: Some(keep_and_reject),
            intersect: None,
        };
        let hit = RTCHit::default();
        let mut room = Room {
            ray: RTCRayHit { ray, hit },
            spare: [RTC_INVALID_GEOMETRY_ID; 4],
        };
        // SAFETY: the scene is committed and lives as long as `self`. Embree writes within
        // `room`, which is as long and as aligned as its own structure, reads `arguments`,
        // and calls the filter on this thread, with the context, until it returns.
        unsafe {
            rtcIntersect1(self.scene, (&raw mut room).cast(), &raw mut arguments);
        }
        // A hit that is rejected is not written back.
        room.ray.hit.geomID == RTC_INVALID_GEOMETRY_ID
    }

    /// What Embree has to report of this thread's calls since it was last asked.
    ///
    /// # Errors
    /// The first error since then.
    #[expect(unsafe_code, reason = "a foreign interface")]
    pub fn check(&self) -> Result<(), EmbreeError> {
        // SAFETY: the device lives as long as `self`.
        match unsafe { rtcGetDeviceError(self.device) } {
            RTCError::NONE => Ok(()),
            error => Err(EmbreeError::new("rays or triangles", format!("{error:?}"))),
        }
    }
}

/// Copies items into a new buffer of a geometry; false if Embree gives none.
///
/// # Safety
/// `mesh` is a geometry, and an item is what `format` says.
#[expect(unsafe_code, reason = "a foreign interface")]
unsafe fn copy<T: Copy>(
    mesh: RTCGeometry,
    kind: RTCBufferType,
    format: RTCFormat,
    items: &[T],
) -> bool {
    // SAFETY: Embree's buffer has room for all items and is aligned to 16 bytes; nobody
    // else knows of it yet.
    unsafe {
        let stride = size_of::<T>();
        let buffer = rtcSetNewGeometryBuffer(mesh, kind, 0, format, stride, items.len());
        if !buffer.is_null() {
            buffer
                .cast::<T>()
                .copy_from_nonoverlapping(items.as_ptr(), items.len());
        }
        !buffer.is_null()
    }
}

/// The filter: notes the hit and rejects it, so that the ray goes on.
#[expect(unsafe_code, reason = "called by Embree with raw pointers")]
unsafe extern "C" fn keep_and_reject(arguments: *const RTCFilterFunctionNArguments) {
    // SAFETY: Embree calls this inside `rtcIntersect1` with valid pointers and N = 1,
    // for which ray and hit have the layout of the single structures (the fields
    // read here lie at the same place in every Embree 4). The context is the
    // `Collector` that `trace` borrows mutably for the length of that call, on
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

// SAFETY: Embree's handles belong to no thread.
#[expect(unsafe_code, reason = "a foreign interface")]
unsafe impl Send for Bare {}

// SAFETY: nothing changes the scene once it is committed; Embree allows rays through it,
// and questions for errors, from many threads at once.
#[expect(unsafe_code, reason = "a foreign interface")]
unsafe impl Sync for Bare {}

impl Drop for Bare {
    #[expect(unsafe_code, reason = "a foreign interface")]
    fn drop(&mut self) {
        // SAFETY: both handles are this structure's own; Embree takes null for nothing to
        // release but reports it, so that is left out.
        unsafe {
            if !self.scene.is_null() {
                rtcReleaseScene(self.scene);
            }
            rtcReleaseDevice(self.device);
        }
    }
}
