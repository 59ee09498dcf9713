//! Bare calls of Embree's C interface, for `triptych bench legs` alone: what our own cost
//! is measured beside them.
//!
//! The same triangles, options, rays and filter as the leg's (`embree::collect`), without
//! the wrapper, which asks for the device's error after every ray.

use embree4_sys::{
    RTC_INVALID_GEOMETRY_ID, RTCBufferType, RTCDevice, RTCError, RTCFormat, RTCGeometry,
    RTCGeometryType, RTCHit, RTCRayHit, RTCScene, rtcAttachGeometry, rtcCommitGeometry,
    rtcCommitScene, rtcGetDeviceError, rtcIntersect1, rtcNewDevice, rtcNewGeometry, rtcNewScene,
    rtcReleaseDevice, rtcReleaseGeometry, rtcReleaseScene, rtcSetNewGeometryBuffer,
    rtcSetSceneBuildQuality, rtcSetSceneFlags,
};
use triptych_spec::vertex::Primitives;

use super::EmbreeError;
use super::collect::{CONFIG, Collector, QUALITY, check, flags};
use super::scene::{Depth, Hit, corners, ray};

/// Triangles, committed to Embree.
pub struct Bare {
    device: RTCDevice,
    scene: RTCScene,
    bits: u32,
}

/// A ray with room for its hit: since 4.4 Embree's own is four bytes longer than that of
/// the bindings, and it is aligned to 16.
#[repr(C, align(16))]
struct Room {
    ray: RTCRayHit,
    spare: [u32; 4],
}

impl Bare {
    /// Copies the spec's snapped triangles and builds the tree.
    ///
    /// # Errors
    /// If a triangle names a corner that is not there, if there are none, or if Embree
    /// reports an error.
    #[expect(unsafe_code, reason = "a foreign interface")]
    pub fn new(primitives: &Primitives) -> Result<Self, EmbreeError> {
        let (corners, triangles) = (
            &corners(primitives, &Depth::new(primitives)),
            &primitives.prims,
        );
        check(corners.len(), triangles)?;
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
            let bare = Self {
                device,
                scene,
                bits: primitives.bits,
            };
            bare.check()?;
            let mesh = rtcNewGeometry(device, RTCGeometryType::TRIANGLE);
            bare.check()?;
            rtcSetSceneFlags(scene, flags());
            rtcSetSceneBuildQuality(scene, QUALITY);
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

    /// One call: every hit of the ray through a pixel's sample is added to `hits`, in the
    /// order in which Embree finds them; a triangle may be reported more than once. False if
    /// a hit went past the filter.
    #[expect(unsafe_code, reason = "a foreign interface")]
    pub fn trace(&self, column: u32, row: u32, hits: &mut Vec<Hit>) -> bool {
        let mut collector = Collector::new(hits);
        let mut arguments = collector.arguments();
        let ray = ray(column, row, self.bits);
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
