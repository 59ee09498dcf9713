//! Laws of bounded numbers: every evaluation in `f32` that WGSL allows stays inside.

#[path = "bound/closed_forms.rs"]
mod closed_forms;

use proptest::prelude::*;
use triptych_spec::bound::{Bounded, Real};

use super::config;
use super::loose::Loose;

/// An expression.
#[derive(Clone, Debug)]
enum Expression {
    Number(f32),
    Two(char, Box<[Self; 2]>),
}

use Expression::{Number, Two};

impl Expression {
    fn bounded<T: Real>(&self) -> T {
        match self {
            Number(x) => T::exact(f64::from(*x)),
            Two(operation, ab) => {
                let [a, b] = [ab[0].bounded::<T>(), ab[1].bounded()];
                match operation {
                    '+' => a.add(b),
                    '-' => a.sub(b),
                    '*' => a.mul(b),
                    _ => a.div(b),
                }
            }
        }
    }

    fn loose(&self, machine: &mut Loose) -> f32 {
        match self {
            Number(x) => *x,
            Two(operation, ab) => {
                let [a, b] = [ab[0].loose(machine), ab[1].loose(machine)];
                match operation {
                    '+' => machine.add(a, b),
                    '-' => machine.sub(a, b),
                    '*' => machine.mul(a, b),
                    _ => machine.div(a, b),
                }
            }
        }
    }
}

/// Numbers of all magnitudes, plain ones more often; no subnormals, which nothing
/// that is given exactly may be.
fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => -1000_f32..1000.0,
        2 => (-20_i16..20).prop_map(f32::from),
        2 => prop::num::f32::NORMAL | prop::num::f32::ZERO,
    ]
}

/// Coordinates: numbers, and tiny ones with subnormals among them.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![2 => number(), 1 => prop::num::f32::SUBNORMAL, 1 => -1e-18_f32..1e-18]
}

fn expression() -> impl Strategy<Value = Expression> {
    number().prop_map(Number).prop_recursive(6, 40, 2, |part| {
        let operation = prop::sample::select(vec!['+', '-', '*', '/']);
        (operation, part.clone(), part).prop_map(|(o, a, b)| Two(o, Box::new([a, b])))
    })
}

proptest! {
    #![proptest_config(config(20_000))]

    /// Whatever the rounding, flushing and division, a result is admitted.
    #[test]
    fn expressions(expression in expression(), seed in any::<u64>()) {
        let bounded: Bounded = expression.bounded();
        if bounded.bound.is_finite() {
            let seen = expression.loose(&mut Loose::new(seed));
            prop_assert!(bounded.admits(f64::from(seen)), "{seen:e} against {bounded:?}");
        }
    }

    /// The number itself is that of plain arithmetic.
    #[test]
    fn values_are_plain(expression in expression()) {
        let bounded: Bounded = expression.bounded();
        let plain: f64 = expression.bounded();
        prop_assert_eq!(bounded.value.to_bits(), plain.to_bits());
    }

    /// So is a sum of products, in any order, fused or not, with rounded coefficients.
    #[test]
    fn sums_of_products(
        c in prop_oneof![
            [-1e6..1e6, -1.0..1.0, -1e-3..1e-3, -1e30..1e30],
            [-1e-38..1e-38, -1e-20..1e-20, -1e-40..1e-40, -1e-38..1e-38],
        ],
        [x, y, z] in [coordinate(), coordinate(), coordinate()],
        order in Just([0, 1, 2, 3]).prop_shuffle(),
        seed in any::<u64>(),
    ) {
        let t = [x, y, z, 1.0];
        let bounded = Bounded::sum_of_products(c, t.map(f64::from));
        prop_assume!(bounded.bound.is_finite());
        let mut machine = Loose::new(seed);
        let c = c.map(|c| machine.round(c));
        let products: Vec<f32> = order.iter().map(|i| machine.mul(c[*i], t[*i])).collect();
        let seen = machine.sum(&products);
        prop_assert!(bounded.admits(f64::from(seen)), "{seen:e} against {bounded:?}");
        let first = machine.mul(c[order[0]], t[order[0]]);
        let chain = order[1..].iter().fold(first, |sum, i| machine.mul_add(c[*i], t[*i], sum));
        prop_assert!(bounded.admits(f64::from(chain)), "{chain:e} against {bounded:?}");
    }

    /// A share between numbers of different sign, seen with its errors, is admitted.
    #[test]
    fn fractions(a in 0_f32..1000.0, b in -1000_f32..0.0, seed in any::<u64>(), swap in any::<bool>()) {
        let (a, b) = if swap { (b, a) } else { (a, b) };
        prop_assume!(!a.is_subnormal() && !b.is_subnormal() && a != b);
        let bounded = Bounded::exact(f64::from(a)).fraction(Bounded::exact(f64::from(b)));
        let mut machine = Loose::new(seed);
        let difference = machine.sub(a, b);
        let seen = machine.div(a, difference);
        prop_assert!(bounded.admits(f64::from(seen)), "{seen:e} against {bounded:?}");
        prop_assert_eq!(bounded.value, f64::from(a).fraction(f64::from(b)));
    }
}
