//! The order of hits along a ray.

/// A pair inside, reported by Embree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// Row in the list of primitives.
    pub prim: u32,
    /// Least depth key that the bound allows.
    pub low: f64,
    /// Largest depth key that the bound allows.
    pub high: f64,
    /// Embree's distance.
    pub t: f32,
}

/// Counts the steps of a ray's list, and the hits whose t contradicts them.
///
/// Hits whose intervals overlap, directly or through others, form a tie run. From
/// one run to the next is a step: every t must be larger than those before it.
/// One hit that is much too deep puts all behind it out of order.
pub(super) fn judge(seen: &mut [Seen], mut disorder: impl FnMut(u32)) -> (u64, u64) {
    seen.sort_unstable_by(|a, b| a.low.total_cmp(&b.low).then(a.prim.cmp(&b.prim)));
    let (mut steps, mut disordered) = (0, 0);
    let mut high = f64::INFINITY; // of all hits so far; none makes no step
    let mut farthest = f32::NEG_INFINITY; // largest t of the runs before this one
    let mut reached = f32::NEG_INFINITY; // largest t so far
    for hit in seen {
        if high < hit.low {
            steps += 1;
            farthest = reached;
        }
        // NaN is before and behind nothing; its depth is reported as outside.
        if hit.t <= farthest {
            disordered += 1;
            disorder(hit.prim);
        }
        high = if high.is_finite() {
            high.max(hit.high)
        } else {
            hit.high
        };
        reached = reached.max(hit.t);
    }
    (steps, disordered)
}

#[cfg(test)]
mod tests {
    use super::{Seen, judge};

    fn list(hits: &[(f64, f64, f32)]) -> (u64, u64, Vec<u32>) {
        let mut seen: Vec<Seen> = (0_u32..)
            .zip(hits)
            .map(|(prim, &(low, high, t))| Seen { prim, low, high, t })
            .collect();
        let mut wrong = Vec::new();
        let (steps, disordered) = judge(&mut seen, |prim| wrong.push(prim));
        (steps, disordered, wrong)
    }

    #[test]
    fn runs_are_joined_by_overlap_and_steps_must_rise() {
        let tie = [(0.0, 4.0, 3.0), (3.0, 7.0, 2.0), (6.0, 9.0, 1.0)];
        assert_eq!(list(&tie), (0, 0, vec![]), "one run, any order");
        let touching = [(0.0, 1.0, 2.0), (1.0, 2.0, 1.0)];
        assert_eq!(list(&touching), (0, 0, vec![]), "both may have the key 1");
        let rising = [(0.0, 1.0, 1.0), (2.0, 3.0, 2.0), (4.0, 5.0, 3.0)];
        assert_eq!(list(&rising), (2, 0, vec![]), "two steps");
        let falling = [(0.0, 1.0, 1.0), (2.0, 3.0, 3.0), (4.0, 5.0, 2.0)];
        assert_eq!(list(&falling), (2, 1, vec![2]), "the last is too near");
        let equal = [(0.0, 1.0, 1.0), (2.0, 3.0, 1.0)];
        assert_eq!(list(&equal), (1, 1, vec![1]), "clearly apart, yet equal");
        let nested = [(0.0, 9.0, 5.0), (1.0, 2.0, 1.0), (8.0, 9.0, 4.0)];
        assert_eq!(
            list(&nested),
            (0, 0, vec![]),
            "a wide one holds the run together"
        );
    }
}
