//! Stage `layers`: where every list starts, and its keys.

use triptych_spec::ldm::{Layers, Maps};

use super::{list, listed, named, shown};
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

/// Every offset and every key is the spec's. A pixel whose list differs is counted once, by its
/// first cause; so is each offset that is wrong.
pub fn layers(maps: &Maps, spec: &Layers, offsets: &[u32], keys: &[u32]) -> Judgement {
    let mut judgement = listed(Class::Exact, "numbers", spec.offsets.len(), offsets.len());
    for (pixel, (must, is)) in spec.offsets.iter().zip(offsets).enumerate() {
        if must != is {
            judgement.differs(Cause::CorruptLink, None, || {
                let named = named(maps, pixel.min(spec.offsets.len().saturating_sub(2)));
                format!("the list of {named} starts at {is}, must at {must}")
            });
        }
    }
    let mut of_keys = listed(Class::Exact, "numbers", spec.keys.len(), keys.len());
    for pixel in 0..spec.offsets.len().saturating_sub(1) {
        let must = &spec.keys[list(&spec.offsets, &spec.keys, pixel)];
        // By the spec's offsets: the leg's own are compared above.
        let is = &keys[list(&spec.offsets, keys, pixel)];
        if must != is {
            of_keys.differs(cause(must, is), None, || {
                let named = named(maps, pixel);
                format!("{named} lists {}, must list {}", shown(is), shown(must))
            });
        }
    }
    let mut judgement = Judgement::sum([judgement, of_keys]);
    judgement.note = format!(
        "{} pixels, {} keys",
        spec.offsets.len().saturating_sub(1),
        spec.keys.len()
    );
    judgement
}

/// Why two lists differ, of which the first is right.
pub(super) fn cause(must: &[u32], is: &[u32]) -> Cause {
    let mut sorted = is.to_vec();
    sorted.sort_unstable();
    if sorted == must {
        return Cause::SortOrder;
    }
    let times = |list: &[u32], key: u32| list.iter().filter(|other| **other == key).count();
    let foreign = is.iter().any(|key| must.binary_search(key).is_err());
    let twice = is.iter().any(|key| times(is, *key) > times(must, *key));
    match (foreign, twice, is.len() < must.len()) {
        (true, ..) => Cause::DepthKey,
        (_, _, true) => Cause::LostNode,
        (_, true, _) => Cause::Duplicate,
        _ => Cause::LostNode,
    }
}
