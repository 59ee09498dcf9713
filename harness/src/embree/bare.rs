//! Bare calls of Embree's C interface.
//!
//! `triptych bench legs` measures our own cost beside them, with the same triangles,
//! options, rays and filter as the leg's (`embree::collect`), without the wrapper, which
//! asks for the device's error after every ray. Rays through blockers ([`super::rays`]) are
//! asked here as well: the wrapper has no room for a closest hit, and no `rtcOccluded1`.

use std::ffi::c_void;
use std::ptr;
use std::sync::atomic::{AtomicIsize, Ordering};

use embree4_sys::{
    RTC_INVALID_GEOMETRY_ID, RTCBufferType, RTCDevice, RTCError, RTCFormat, RTCGeometry,
    RTCGeometryType, RTCHit, RTCRay, RTCRayHit, RTCScene, rtcAttachGeometry, rtcCommitGeometry,
    rtcCommitScene, rtcGetDeviceError, rtcIntersect1, rtcNewDevice, rtcNewGeometry, rtcNewScene,
    rtcOccluded1, rtcReleaseDevice, rtcReleaseGeometry, rtcReleaseScene,
    rtcSetDeviceMemoryMonitorFunction, rtcSetNewGeometryBuffer, rtcSetSceneBuildQuality,
    rtcSetSceneFlags,
};
use triptych_spec::vertex::Primitives;

use super::EmbreeError;
use super::collect::{CONFIG, Collector, QUALITY, check, flags};
use super::scene::{Depth, Hit, corners, ray};

/// Triangles, committed to Embree.
pub struct Bare {
    device: RTCDevice,
    scene: RTCScene,
    /// Bytes that Embree holds; where they are, it remembers as long as the device lives.
    held: Box<AtomicIsize>,
}

/// A ray with room for its hit: since 4.4 Embree's own is four bytes longer than that of
/// the bindings, and it is aligned to 16.
#[repr(C, align(16))]
struct Room {
    ray: RTCRayHit,
    spare: [u32; 4],
}

impl Room {
    fn new(ray: RTCRay) -> Self {
        let hit = RTCHit::default();
        Self {
            ray: RTCRayHit { ray, hit },
            spare: [RTC_INVALID_GEOMETRY_ID; 4],
        }
    }

    /// The triangle that was hit, and when.
    fn found(&self) -> Option<Hit> {
        (self.ray.hit.geomID != RTC_INVALID_GEOMETRY_ID).then_some(Hit {
            prim: self.ray.hit.primID,
            t: self.ray.ray.tfar,
        })
    }
}

impl Bare {
    /// The spec's snapped triangles.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn snapped(primitives: &Primitives) -> Result<Self, EmbreeError> {
        let corners = corners(primitives, &Depth::new(primitives));
        Self::new(&corners, &primitives.prims)
    }

    /// Copies triangles and builds the tree.
    ///
    /// # Errors
    /// If a triangle names a corner that is not there, if there are none, or if Embree
    /// reports an error.
    #[expect(unsafe_code, reason = "a foreign interface")]
    pub fn new(corners: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<Self, EmbreeError> {
        check(corners.len(), triangles)?;
        // SAFETY: CONFIG ends in NUL. `bare` owns device and scene from where they are made.
        // What Embree gives without an error is not null. The geometry is released here,
        // once, as the scene keeps a reference of its own; its items are what `copy` is told,
        // and name corners that are there. `held` stays where it is until the device is gone.
        unsafe {
            let device = rtcNewDevice(CONFIG.as_ptr().cast());
            if device.is_null() {
                return Err(EmbreeError::new("new device", "refused on this machine"));
            }
            let held = Box::new(AtomicIsize::new(0));
            let counter = ptr::from_ref(&*held).cast_mut().cast();
            rtcSetDeviceMemoryMonitorFunction(device, Some(counts), counter);
            let scene = rtcNewScene(device);
            let bare = Self {
                device,
                scene,
                held,
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

    /// Bytes that Embree has taken for buffers and tree, and not given back.
    pub fn bytes(&self) -> u64 {
        u64::try_from(self.held.load(Ordering::Relaxed)).unwrap_or(0)
    }

    /// One call: every hit of the ray through a pixel's sample is added to `hits`, in the
    /// order in which Embree finds them; a triangle may be reported more than once. False if
    /// a hit went past the filter.
    pub fn trace(&self, [column, row]: [u32; 2], bits: u32, hits: &mut Vec<Hit>) -> bool {
        // A hit that is rejected is not written back.
        self.all(ray(column, row, bits), hits)
    }

    /// The same of any ray.
    pub fn all(&self, ray: RTCRay, hits: &mut Vec<Hit>) -> bool {
        self.intersect(ray, Some(&mut Collector::new(hits)))
            .is_none()
    }

    /// One call of `rtcIntersect1`: what Embree finds first.
    pub fn closest(&self, ray: RTCRay) -> Option<Hit> {
        self.intersect(ray, None)
    }

    /// One call of `rtcOccluded1`: whether Embree finds anything.
    #[expect(unsafe_code, reason = "a foreign interface")]
    pub fn occluded(&self, mut ray: RTCRay) -> bool {
        // SAFETY: the scene is committed and lives as long as `self`. A ray has the same
        // layout and alignment in every Embree 4, and Embree writes nothing else. Null
        // arguments are the defaults.
        unsafe {
            rtcOccluded1(self.scene, &raw mut ray, ptr::null_mut());
        }
        ray.tfar == f32::NEG_INFINITY
    }

    /// One call, with the collector's filter or with the default arguments.
    #[expect(unsafe_code, reason = "a foreign interface")]
    fn intersect(&self, ray: RTCRay, collector: Option<&mut Collector>) -> Option<Hit> {
        let mut room = Room::new(ray);
        let mut arguments = collector.map(Collector::arguments);
        let arguments = arguments.as_mut().map_or(ptr::null_mut(), ptr::from_mut);
        // SAFETY: the scene is committed and lives as long as `self`. Embree writes within
        // `room`, which is as long and as aligned as its own structure. It takes null for
        // the default arguments; others it reads, and calls their filter on this thread,
        // with the collector as context, until it returns.
        unsafe {
            rtcIntersect1(self.scene, (&raw mut room).cast(), arguments);
        }
        room.found()
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

/// Embree takes memory, or gives it back; true: it may.
///
/// # Safety
/// `counter` is an [`AtomicIsize`] that outlives the device.
#[expect(unsafe_code, reason = "a foreign interface")]
unsafe extern "C" fn counts(counter: *mut c_void, bytes: isize, _post: bool) -> bool {
    // SAFETY: as above; nothing else than loads and additions is done to it.
    let held = unsafe { &*counter.cast::<AtomicIsize>() };
    held.fetch_add(bytes, Ordering::Relaxed);
    true
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
