//! Laws of matrices.

use proptest::prelude::*;
use triptych_spec::matrix::Matrix;

use super::config;

fn coordinates() -> impl Strategy<Value = [f64; 3]> {
    [-8_i8..8, -8..8, -8..8].prop_map(|p| p.map(f64::from))
}

/// Matrices of small whole numbers, so that products are exact.
fn matrix() -> impl Strategy<Value = Matrix> {
    let turn = (0_usize..3, 0_i8..4);
    (coordinates(), coordinates(), turn).prop_map(|(scale, shift, (axis, quarters))| {
        let turned = Matrix::rotate(axis, 90.0 * f64::from(quarters));
        let scaled = turned.times(&Matrix::scale(scale));
        Matrix::translate(shift).times(&scaled)
    })
}

/// Right-handed: x turns to y about z, and so on around.
#[test]
fn a_quarter_turn_takes_an_axis_to_the_next() {
    for axis in 0..3 {
        let unit = |at: usize| [0, 1, 2].map(|i| f64::from(i == at % 3));
        let quarter = Matrix::rotate(axis, 90.0);
        assert_eq!(quarter.point(unit(axis)), unit(axis), "the axis stays");
        assert_eq!(quarter.point(unit(axis + 1)), unit(axis + 2), "to the next");
        let back = unit(axis + 1).map(|x| -x);
        assert_eq!(quarter.point(unit(axis + 2)), back, "and that one back");
        for (quarters, degrees) in [(2, 180.0), (3, 270.0), (4, -360.0)] {
            let one_by_one = (1..quarters).fold(quarter, |m, _| quarter.times(&m));
            assert_eq!(Matrix::rotate(axis, degrees), one_by_one, "{degrees}");
        }
    }
}

#[test]
fn a_shift_is_added() {
    let shifted = Matrix::translate([1.0, -2.0, 4.0]).point([8.0, 16.0, 32.0]);
    assert_eq!(shifted, [9.0, 14.0, 36.0]);
}

#[test]
fn any_angle_turns_as_its_sine_and_cosine_say() {
    for degrees in [30.0_f64, -200.5, 719.0] {
        let turned = Matrix::rotate(2, degrees).point([3.0, -2.0, 5.0]);
        let (sin, cos) = degrees.to_radians().sin_cos();
        for (seen, expected) in
            turned
                .iter()
                .zip([3.0 * cos + 2.0 * sin, 3.0 * sin - 2.0 * cos, 5.0])
        {
            assert!((seen - expected).abs() < 1e-14, "{degrees}: {turned:?}");
        }
    }
}

proptest! {
    #![proptest_config(config(500))]

    /// A product is one matrix after the other.
    #[test]
    fn a_product_applies_both(a in matrix(), b in matrix(), p in coordinates()) {
        prop_assert_eq!(a.times(&b).point(p), a.point(b.point(p)));
    }
}
