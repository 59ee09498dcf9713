//! The harness: corpus, legs, comparison, report. The binary `triptych` is a thin
//! command line over this library.

pub mod add;
pub mod again;
pub mod bench;
pub mod bundle;
pub mod cache;
pub mod calibrate;
pub mod cause;
pub mod cli;
pub mod compare;
pub mod corpus;
pub mod digest;
pub mod dump;
pub mod embree;
pub mod error;
pub mod findings;
pub mod generate;
pub mod json;
pub mod mesh;
pub mod mutants;
pub mod native;
pub mod observe;
pub mod output;
pub mod picture;
pub mod plan;
pub mod registry;
pub mod replay;
pub mod report;
pub mod row;
pub mod scene;
pub mod sheet;
pub mod snapshot;
pub mod stress;
pub mod terminal;
pub mod text;
pub mod vector;
