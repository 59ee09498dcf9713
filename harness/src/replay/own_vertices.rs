//! `--vertex gpu`: what the GPU's own vertices change.

use super::end_to_end::moved;
use super::gpu::{GpuLeg, GpuSeen};
use super::rows::Rows;
use super::spec::SpecRun;
use crate::compare::compare;
use crate::compare::moved::{self, Side};
use crate::observe::{Gpu, Observed, Spec};
use crate::row::Class;

/// The row's name.
pub const ROW: &str = "vertex";

/// Compares the lists that a leg made of its own triangles with the spec's own. That the
/// leg made of them what the spec makes of them is what its other rows say.
pub fn run(
    leg: &GpuLeg<'_>,
    own: &Observed<Spec, SpecRun>,
    seen: &Observed<Gpu, GpuSeen>,
    rows: &mut Rows,
) {
    let reason = if leg.by_band() {
        Some("the driver's sub-pixel grid is unknown")
    } else if seen.value.sorted.is_none() {
        Some("the lists are damaged, see build")
    } else {
        None
    };
    if let Some(reason) = reason {
        rows.skip(ROW, &own.label, &seen.label, Class::Decision, reason.into());
        return;
    }
    let primitives = &leg.spec.value.primitives;
    // Without times: the stages' own rows have them.
    let spec = Observed::<Spec, _>::new(own.label.clone(), &own.value);
    let seen = Observed::<Gpu, _>::new(seen.label.clone(), &seen.value);
    let mut judgement = compare(&spec, &seen, |spec, seen| {
        let sorted = seen.sorted.as_ref().expect("asked for above");
        let opaque = &seen.abuffer.opaque;
        moved::compare(
            Side {
                primitives: &spec.primitives,
                opaque: &spec.opaque,
                sorted: &spec.sorted,
            },
            Side {
                primitives,
                opaque,
                sorted,
            },
        )
    });
    let corners = moved(&own.value.primitives, primitives);
    judgement.note = format!("{}; {corners}", judgement.note);
    rows.add(ROW, &spec, &seen, judgement);
}
