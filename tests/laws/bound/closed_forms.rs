//! Bounds worked out by hand, so that one that has grown or shrunk is seen, and not only
//! one that is exceeded.

use triptych_spec::bound::{Bounded, Real, TINY, U, gamma};

fn number(value: f64, bound: f64) -> Bounded {
    Bounded { value, bound }
}

fn exact(value: f64) -> Bounded {
    Bounded::exact(value)
}

/// Sums of a few powers of two, so that the order in which they are added is all the same
/// up to the last place.
fn same(seen: Bounded, value: f64, bound: f64) {
    assert_eq!(seen.value.to_bits(), value.to_bits(), "{seen:?}");
    let apart = (seen.bound - bound).abs();
    assert!(apart <= bound * 1e-15, "{seen:?}, must be {bound:e}");
}

#[test]
fn one_rounding_of_exact_numbers() {
    same(exact(1.0).add(exact(2.0)), 3.0, 3.0 * U + TINY);
    same(exact(1.0).sub(exact(2.0)), -1.0, U + TINY);
    same(exact(-3.0).mul(exact(5.0)), -15.0, 15.0 * U + TINY);
    same(exact(1.0).div(exact(-4.0)), -0.25, 2.5 * 0.25 * U + TINY);
    same(exact(0.0).mul(exact(5.0)), 0.0, TINY);
}

#[test]
fn errors_of_operands_are_handed_on() {
    let (a, b) = (number(3.0, 0.5), number(-4.0, 1.0));
    same(a.add(b), -1.0, 1.5 + 2.5 * U + TINY);
    same(a.sub(b), 7.0, 1.5 + 8.5 * U + TINY);
    let product = 3.0 * 1.0 + 4.0 * 0.5 + 0.5;
    same(a.mul(b), -12.0, product + (12.0 + product) * U + TINY);
    let quotient = (0.5 + 0.75) / 3.0;
    same(
        a.div(b),
        -0.75,
        quotient + 2.5 * (0.75 + quotient) * U + TINY,
    );
}

#[test]
fn gamma_is_the_sum_of_a_geometric_series() {
    for k in [1, 5, 1000] {
        let (ku, seen) = (f64::from(k) * U, gamma(k));
        let series = ku + ku.powi(2) + ku.powi(3) + ku.powi(4);
        let apart = (seen - series).abs();
        assert!(
            apart <= 1e-15 * series,
            "gamma({k}) is {seen:e}, must be {series:e}"
        );
    }
}

#[test]
fn sums_of_products() {
    // Each term is of a rounded coefficient, a product and three additions; flushed may be
    // the coefficient, which the other factor multiplies, the product and the sum.
    let seen = Bounded::sum_of_products([1.0, -2.0, 4.0, 0.5], [3.0, 4.0, -1.0, 2.0]);
    let sizes = 3.0 + 8.0 + 4.0 + 1.0;
    let flushed = TINY * (3.0 + 4.0 + 1.0 + 2.0 + 4.0 * 2.0);
    same(seen, 3.0 - 8.0 - 4.0 + 1.0, gamma(5) * sizes + flushed);
    let plain = f64::sum_of_products([1.0, -2.0, 4.0, 0.5], [3.0, 4.0, -1.0, 2.0]);
    assert_eq!(plain, -8.0, "of plain numbers");
}

#[test]
fn a_subnormal_coordinate_may_vanish_with_its_term() {
    let (big, half) = (f64::from(2_u32.pow(30)), TINY / 2.0);
    let seen = Bounded::sum_of_products([big, 0.0, 0.0, 0.0], [half, 0.0, 0.0, 1.0]);
    let term = big * half;
    let flushed = TINY * (half + 1.0 + 4.0 * 2.0);
    same(seen, term, term + gamma(5) * term + flushed);
    let normal = Bounded::sum_of_products([big, 0.0, 0.0, 0.0], [TINY, 0.0, 0.0, 1.0]);
    let flushed = TINY * (TINY + 1.0 + 4.0 * 2.0);
    same(normal, big * TINY, gamma(5) * big * TINY + flushed);
}

#[test]
fn nothing_is_promised_beyond_the_range() {
    let (most, half) = (f64::from(f32::MAX), f64::from(f32::MAX) / 2.0);
    let infinite = |seen: Bounded| assert!(seen.bound.is_infinite(), "{seen:?}");
    let finite = |seen: Bounded| assert!(seen.bound.is_finite(), "{seen:?}");
    infinite(exact(most).add(exact(most)));
    finite(exact(half).sub(exact(-half / 2.0)));
    infinite(number(half, half).add(exact(0.0)));
    infinite(number(half, half / 2.0).mul(exact(4.0 / 3.0)));
    infinite(Bounded::sum_of_products([most, 0.0, 0.0, 0.0], [1.0; 4]));
    finite(Bounded::sum_of_products([half, 0.0, 0.0, 0.0], [1.0; 4]));
    infinite(Bounded::sum_of_products(
        [0.0; 4],
        [most * 2.0, 0.0, 0.0, 1.0],
    ));
    let [least, largest] = [-126, 126].map(|exponent| 2_f64.powi(exponent));
    finite(exact(1.0).div(exact(largest)));
    infinite(exact(1.0).div(exact(largest * 2.0)));
    infinite(exact(1.0).div(number(largest, 1.0 + largest * f64::EPSILON)));
    finite(exact(least).div(exact(-least)));
    infinite(exact(least).div(exact(least / 2.0)));
    infinite(exact(least).div(number(least, least / 8.0)));
    infinite(exact(1.0).div(exact(0.0)));
}

#[test]
fn what_is_admitted() {
    let one = number(1.0, 0.5);
    assert!(one.admits(1.5) && one.admits(0.5), "the ends");
    let beyond = [1.5_f32.next_up(), 0.5_f32.next_down()].map(f64::from);
    assert!(!beyond.map(|x| one.admits(x)).contains(&true), "beyond");
    assert!(!one.admits(f64::NAN), "no number");
    assert!(number(1.0, f64::INFINITY).admits(-1e300), "without a bound");
}

#[test]
fn what_is_certain() {
    for (value, bound, certain) in [
        (0.0, 0.0, true),
        (2.0, 0.0, true),
        (0.0, 1.0, false),
        (-1.0, 1.0, false),
        (-1.0, 0.5, true),
        (0.5, 1.0, false),
    ] {
        let seen = number(value, bound).sign_is_certain();
        assert_eq!(seen, certain, "{value} to within {bound}");
    }
    let one = number(1.0, 0.25);
    assert!(one.certainly_differs(number(2.0, 0.5)), "apart");
    assert!(!one.certainly_differs(number(1.75, 0.5)), "they touch");
    assert!(!one.certainly_differs(one), "the same");
    assert!(
        1.0.certainly_differs(2.0) && !1.0.certainly_differs(1.0),
        "plain"
    );
}

#[test]
fn either_of_two_ways() {
    same(number(1.0, 0.5).or(number(1.25, 0.125)), 1.0, 0.5);
    same(number(1.0, 0.125).or(number(1.5, 0.25)), 1.0, 0.75);
    same(number(1.0, 0.125).or(number(0.5, 0.25)), 1.0, 0.75);
}

#[test]
fn fractions_end_where_their_range_does() {
    // 1 / (1 + 3): a difference and a quotient.
    let difference = 4.0 * U + TINY;
    let strayed = 0.25 * difference / (4.0 - difference);
    let bound = strayed + 2.5 * U * (0.25 + strayed) + TINY;
    same(exact(1.0).fraction(exact(-3.0)), 0.25, bound);
    // -1 / 8 is moved to the range's end, and may be seen as far away as it was.
    let difference = 3.0 + 11.0 * U + TINY;
    let strayed = (2.0 + 0.125 * difference) / (8.0 - difference);
    let bound = strayed + 2.5 * U * (0.125 + strayed) + TINY + 0.125;
    same(number(-1.0, 2.0).fraction(number(-9.0, 1.0)), 0.0, bound);
    // Signs that differ in an evaluation alone, and a divisor below all that WGSL defines.
    let outside = number(-1.0, 2.0).fraction(number(-3.0, 4.0));
    same(outside, 0.0, 1.0 + 4.0 * U);
    let beyond = number(2.0, 2.0).fraction(number(1.0, 2.0));
    same(beyond, 1.0, 1.0 + 4.0 * U);
    same(exact(0.0).fraction(exact(0.0)), 0.0, 1.0 + 4.0 * U);
}
