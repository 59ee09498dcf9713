//! Keys against the intervals that they must be in.
//!
//! Every key needs an interval of its own, and every interval that must have a key needs one of
//! its own. A matching that serves all keys and one that serves all those intervals are enough:
//! where both are, one serves all together (Mendelsohn and Dulmage 1958). Each is found greedily:
//! from the least key on, the interval that ends first.

use super::vote::MapConflict;

/// Where a key is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Whether there must be one.
    pub(super) must: bool,
}

/// What is wrong with a list, if anything is.
pub(super) fn matched(keys: &[u32], intervals: &[Interval]) -> Option<MapConflict> {
    if keys.windows(2).any(|pair| pair[0] > pair[1]) {
        return Some(MapConflict::Order);
    }
    if let Some(key) = unmatched(keys, intervals).0 {
        return Some(MapConflict::Key { key });
    }
    let must: Vec<Interval> = intervals.iter().filter(|i| i.must).copied().collect();
    let lost = unmatched(keys, &must).1;
    lost.map(|interval| MapConflict::Lost {
        low: interval.low,
        high: interval.high,
    })
}

/// The first key without an interval, and an interval without a key.
fn unmatched(keys: &[u32], intervals: &[Interval]) -> (Option<u32>, Option<Interval>) {
    let mut free = intervals.to_vec();
    free.sort_by(|a, b| a.high.total_cmp(&b.high));
    let mut alone = None;
    for &key in keys {
        let at = f64::from(key);
        let fits = free.iter().position(|i| i.low <= at && at <= i.high);
        match fits {
            Some(fits) => drop(free.remove(fits)),
            None => alone = alone.or(Some(key)),
        }
    }
    (alone, free.first().copied())
}

#[cfg(test)]
mod tests {
    use super::{Interval, matched};
    use crate::compare::embree::maps::MapConflict;

    fn of(low: f64, high: f64, must: bool) -> Interval {
        Interval { low, high, must }
    }

    #[test]
    fn keys_and_intervals_find_each_other() {
        let sure = [of(0.0, 9.0, true), of(2.0, 4.0, true), of(8.0, 9.0, true)];
        assert_eq!(matched(&[3, 4, 8], &sure), None, "4 is in the first");
        assert_eq!(matched(&[3, 3, 8], &sure), None, "equal keys");
        assert_eq!(matched(&[4, 3, 8], &sure), Some(MapConflict::Order));
        let lost = MapConflict::Lost {
            low: 8.0,
            high: 9.0,
        };
        assert_eq!(matched(&[3, 4], &sure), Some(lost), "nothing at 8");
        let extra = MapConflict::Key { key: 8 };
        assert_eq!(matched(&[2, 3, 8, 8], &sure), Some(extra), "three for two");
        let beside = MapConflict::Key { key: 10 };
        assert_eq!(matched(&[3, 8, 10], &sure), Some(beside));
    }

    #[test]
    fn what_may_have_a_key_needs_none() {
        let open = [of(0.0, 5.0, false), of(4.0, 6.0, true)];
        assert_eq!(matched(&[5], &open), None, "it is the second's");
        assert_eq!(matched(&[4, 5], &open), None);
        let lost = MapConflict::Lost {
            low: 4.0,
            high: 6.0,
        };
        assert_eq!(matched(&[1], &open), Some(lost));
        assert_eq!(matched(&[], &[of(0.0, 1.0, false)]), None);
    }
}
