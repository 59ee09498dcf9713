//! Triptych's algorithms in WGSL with atomics, and the least host code that runs
//! them.
//!
//! Baseline kernels keep to WebGPU's default limits and features. Each stage of
//! the spec has an entry point of the same name; nothing here calls an algorithm of
//! the spec, only its data types.

pub mod abuffer;
pub mod ceiling;
pub mod context;
pub mod dispatch;
pub mod error;
pub mod frame;
pub mod grid;
pub mod hbao;
pub mod kernel;
pub mod layouts;
pub mod ldm;
pub mod lists;
mod named;
pub mod pass;
pub mod raster;
mod ready;
pub mod rsm;
pub mod tiles;
pub mod timer;
pub mod vertex;
pub mod wgsl;
