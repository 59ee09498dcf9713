//! Class edge: which pairs are too close to an edge to be judged.

use triptych_spec::vertex::Primitives;

/// Class edge: `2^-EDGE_BITS` of the sum of the edge functions.
pub(super) const EDGE_BITS: u32 = 22;

/// Class edge, decided exactly. For integers, `a <= b / 2^k` is `a <= floor(b / 2^k)`.
pub(super) fn is_edge(edges: [i64; 3]) -> bool {
    let [a, b, c] = edges;
    let sum = a.abs() + b.abs() + c.abs();
    a.min(b).min(c).abs() <= sum >> EDGE_BITS
}

/// The edge functions of a triangle without area, which has no [`Setup`]: they
/// sum to 0, and are all 0 on its line.
pub(super) fn flat_edges(spec: &Primitives, prim: u32, point: [i64; 2]) -> [i64; 3] {
    let corners = spec.prims[prim as usize]
        .map(|c| spec.snapped[c as usize])
        .map(|c| [i64::from(c[0]) - point[0], i64::from(c[1]) - point[1]]);
    [(1, 2), (2, 0), (0, 1)].map(|(a, b)| {
        let (a, b): ([i64; 2], [i64; 2]) = (corners[a], corners[b]);
        a[0] * b[1] - a[1] * b[0]
    })
}

#[cfg(test)]
mod tests {
    use triptych_spec::scene::Size;
    use triptych_spec::vertex::Primitives;

    use super::{flat_edges, is_edge};

    #[test]
    fn the_threshold_is_exact() {
        let unit = 1 << 20;
        // The sum is 4 units: the threshold is 1.
        assert!(is_edge([1, unit, 3 * unit - 1]), "inside");
        assert!(is_edge([unit, -1, 3 * unit - 1]), "outside");
        assert!(!is_edge([1, unit, 3 * unit - 2]), "one less in the sum");
        assert!(!is_edge([2, unit, 3 * unit - 2]), "inside, one farther");
        assert!(!is_edge([-2, unit, 3 * unit - 2]), "outside, one farther");
    }

    #[test]
    fn another_edge_excludes_what_is_on_the_line_of_this_one() {
        assert!(!is_edge([0, -1000, 3000]), "beyond the end of edge 0");
        assert!(is_edge([0, 1000, 3000]), "on edge 0");
        assert!(is_edge([0, 0, 0]), "on a triangle without area");
    }

    #[test]
    fn without_area_edge_functions_sum_to_nothing() {
        let spec = Primitives {
            samples: triptych_spec::raster::Samples::ONE,
            size: Size {
                width: 1,
                height: 1,
            },
            bits: 8,
            snapped: vec![[9, 9, 0], [1, 2, 0], [4, 8, 0], [3, 6, 0]],
            prims: vec![[0, 1, 2], [1, 2, 3]],
            source: vec![0, 1],
        };
        assert_eq!(
            flat_edges(&spec, 1, [5, 3]),
            [7, 14, -21],
            "beside its line"
        );
        for on_line in [[2, 4], [3, 6], [50, 100]] {
            assert_eq!(flat_edges(&spec, 1, on_line), [0; 3], "{on_line:?}");
        }
    }
}
