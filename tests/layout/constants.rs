//! Numbers that are written down twice.

use naga::{Expression, Literal, Module};
use triptych_gpu::abuffer::STEPS;
use triptych_gpu::dispatch::{DEPTH_AT, LIGHT};
use triptych_gpu::frame::WORKGROUP;
use triptych_gpu::grid::{CHUNK, FRESH, SMALL, TRACED};
use triptych_gpu::layouts::{BEGINS, ENDS, FOLLOWS, GOES_ON, SAMPLED};
use triptych_gpu::ldm::{LARGE_AT_ONCE, MAPS_AT_ONCE};
use triptych_gpu::lists::{LONG, RUN, TILE};
use triptych_gpu::raster::{SATURATED, WALKED};
use triptych_gpu::tiles::{AS_IT_IS, CONTIGUOUS, FINISHED, IN_MEMORY, IN_ORDER};
use triptych_gpu::wgsl::network::SIZES;
use triptych_spec::abuffer::{EOL, NOTHING};
use triptych_spec::dispatch::{LAMPS_MAX, OFFSET, WEIGHT_ONE};
use triptych_spec::grid::axis::WIDENED;
use triptych_spec::grid::hit::{FOR_TIME, VOLUME_ERROR};
use triptych_spec::layouts::MASK_BITS;
use triptych_spec::ldm::{PLANE_BITS, WEIGHT_BITS};
use triptych_spec::rsm::{COARSE_BITS, PLACE_MAX};
use triptych_spec::tiles::{BIN_SORTED, ROWS, SIDE, WINDOW};
use triptych_spec::vertex::{CORNERS_MAX, DEPTH_ONE, GUARD};

use super::everywhere;

/// A module constant; all that cross over are integers of 32 bits.
fn constant(module: &Module, name: &str) -> Option<i64> {
    let named = |c: &naga::Constant| c.name.as_deref() == Some(name);
    let (_, constant) = module.constants.iter().find(|(_, c)| named(c))?;
    match module.global_expressions[constant.init] {
        Expression::Literal(Literal::U32(v)) => Some(v.into()),
        Expression::Literal(Literal::I32(v)) => Some(v.into()),
        ref other => panic!("{name} is no integer: {other:?}"),
    }
}

#[test]
fn constants_are_those_of_rust() {
    let steps = i64::try_from(STEPS).expect("a word");
    let corners = i64::try_from(CORNERS_MAX).expect("a word");
    let lamps = i64::try_from(LAMPS_MAX).expect("few");
    let constants = [
        ("EOL", i64::from(EOL)),
        ("NOTHING", i64::from(NOTHING)),
        ("GUARD", i64::from(GUARD)),
        ("SATURATED", i64::from(SATURATED)),
        ("WORKGROUP", i64::from(WORKGROUP)),
        ("WALKED", i64::from(WALKED)),
        ("STEPS", steps),
        ("CORNERS_MAX", corners),
        ("DEPTH_ONE", i64::from(DEPTH_ONE)),
        ("TILE", i64::from(TILE)),
        ("LONG", i64::from(LONG)),
        ("LONG", i64::from(BIN_SORTED)),
        ("WINDOW", i64::from(WINDOW)),
        ("RUN", i64::from(RUN)),
        ("SMALL", i64::from(SMALL)),
        ("CHUNK", i64::from(CHUNK)),
        ("FRESH", i64::from(FRESH)),
        ("TRACED", i64::from(TRACED)),
        ("PLACE_MAX", i64::from(PLACE_MAX)),
        ("COARSE_BITS", i64::from(COARSE_BITS)),
        ("MAPS_AT_ONCE", i64::from(MAPS_AT_ONCE)),
        ("LARGE_AT_ONCE", i64::from(LARGE_AT_ONCE)),
        ("PLANE_BITS", i64::from(PLANE_BITS)),
        ("WEIGHT_BITS", i64::from(WEIGHT_BITS)),
        ("DEPTH_AT", i64::from(DEPTH_AT)),
        ("LIGHT", i64::from(LIGHT)),
        ("LAMPS_MAX", lamps),
        ("WEIGHT_ONE", i64::from(WEIGHT_ONE)),
        ("SIDE", i64::from(SIDE)),
        ("ROWS", i64::from(ROWS)),
        ("IN_REGISTERS", i64::from(SIZES[3])),
        // Networks have the numbers of their sizes.
        ("IN_MEMORY", i64::from(IN_MEMORY)),
        ("AS_IT_IS", i64::from(AS_IT_IS)),
        ("CONTIGUOUS", i64::from(CONTIGUOUS)),
        ("IN_ORDER", i64::from(IN_ORDER)),
        ("FINISHED", i64::from(FINISHED)),
        ("MASK_BITS", i64::from(MASK_BITS)),
        ("BEGINS", i64::from(BEGINS)),
        ("ENDS", i64::from(ENDS)),
        ("FOLLOWS", i64::from(FOLLOWS)),
        ("GOES_ON", i64::from(GOES_ON)),
        ("SAMPLED", i64::from(SAMPLED)),
    ];
    for (name, value) in constants {
        everywhere(name, &value, constant);
    }
}

#[test]
fn thresholds_are_those_of_the_spec() {
    let real = |module: &Module, name: &str| {
        let named = |c: &naga::Constant| c.name.as_deref() == Some(name);
        let (_, constant) = module.constants.iter().find(|(_, c)| named(c))?;
        match module.global_expressions[constant.init] {
            Expression::Literal(Literal::F32(v)) => Some(f64::from(v)),
            ref other => panic!("{name} is no number: {other:?}"),
        }
    };
    everywhere("WIDENED", &f64::from(WIDENED), real);
    everywhere("VOLUME_ERROR", &VOLUME_ERROR, real);
    everywhere("FOR_TIME", &FOR_TIME, real);
    everywhere("OFFSET", &f64::from(OFFSET), real);
}
