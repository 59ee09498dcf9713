//! The meaning of Triptych's algorithms.
//!
//! Scalar, single-threaded, without `unsafe`, without hidden state and without a
//! GPU; written to be read beside the papers. Whatever *decides* (coverage,
//! depth keys, list order) is integer arithmetic and therefore exact. Whatever is
//! *reported* (positions, colours) is an `f64` together with a bound on what an
//! `f32` evaluation under WGSL's accuracy rules may return ([`bound`]).
//!
//! | module | stages | twin |
//! |---|---|---|
//! | [`vertex`] | transform, clip, snap | `gpu/src/vertex.wgsl` |
//! | [`raster`] | cover | `gpu/src/raster.wgsl` |
//! | [`abuffer`] | opaque, build, sort, resolve | `gpu/src/abuffer.wgsl` |
//! | | peel, dual, alpha, weighted, density, defocus, reduced | `gpu/src/peel.wgsl` and so on |
//! | [`tiles`] | bin, jagged, shade | `gpu/src/tiles.wgsl` |
//! | [`layouts`] | bucket, precalc, rank, packed, regions, ordered | `gpu/src/layouts.wgsl` and so on |
//! | [`grid`] | count, scan, fill, link, trace | `gpu/src/grid.wgsl` |
//! | [`rsm`] | gbuffer, rsm, place, direct, gather, block, blur, compose | `gpu/src/rsm.wgsl` |
//! | [`ldm`] | layers, chain, neighbours, occlusion, environment | `gpu/src/ldm.wgsl` |
//! | [`dispatch`] | primary, intersect, locate, light, reflect, deposit | `gpu/src/dispatch.wgsl` |
#![forbid(unsafe_code)]

pub mod abuffer;
pub mod bound;
pub mod camera;
pub mod dispatch;
pub mod grid;
pub mod layouts;
pub mod ldm;
pub mod matrix;
pub mod raster;
pub mod rsm;
pub mod scene;
pub mod tiles;
pub mod vertex;
