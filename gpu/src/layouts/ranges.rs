//! Ranges of depth that are halved until they fit.

use std::ops::Range;

use triptych_spec::layouts::Entry;

/// The middle of what lies both in a range and among the depths; `None` if the range has no two entries.
pub(super) fn middle(range: &Range<Entry>, depths: &Range<Entry>) -> Option<Entry> {
    let number = |[key, face]: Entry| u64::from(key) << 32 | u64::from(face);
    let [from, until] = [range.start, range.end].map(number);
    let [near, far] = [depths.start, depths.end].map(number);
    let middle = from.max(near).midpoint(until.min(far).max(from.max(near)));
    let middle = middle.clamp(from, until);
    // Beyond the depths, a range is halved as it is.
    let middle = match from < middle && middle < until {
        true => middle,
        false => from.midpoint(until),
    };
    let halves = |n: u64| u32::try_from(n & u64::from(u32::MAX)).expect("32 bits");
    (from < middle).then(|| [halves(middle >> 32), halves(middle)])
}

#[cfg(test)]
mod tests {
    use triptych_spec::layouts::ALL;

    use super::*;

    /// However ranges are split, they end: at one entry at the latest.
    #[test]
    fn ranges_split_until_one_entry_is_left() {
        let depths = [1000, 0]..[1011, 0];
        for target in [
            [1000, 0],
            [1010, 77],
            [1010, u32::MAX],
            [0, 0],
            [u32::MAX, 3],
        ] {
            let (mut range, mut splits) = (ALL, 0);
            while let Some(middle) = middle(&range, &depths) {
                assert!(range.start < middle && middle < range.end, "{range:?}");
                range = match target < middle {
                    true => range.start..middle,
                    false => middle..range.end,
                };
                splits += 1;
                assert!(splits < 200, "{range:?}");
            }
            assert!(range.contains(&target), "{target:?} in {range:?}");
        }
        assert_eq!(
            middle(&ALL, &depths).map(|m| m[0]),
            Some(1005),
            "of the depths"
        );
    }
}
